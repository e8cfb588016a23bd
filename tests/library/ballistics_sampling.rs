//! The feasible take-off set against brute force: flights simulated in time and checked without any closed form of a limit.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{Draw, explicit, line, uniform};
use chta::{
    chain::{ConstrainedChain, GroundRefusal, Site, Station},
    hop::{HopTest, TakeoffSet},
    quantity::{Angle, ChainPoint, VertexId},
    world::{
        Contact, Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SPEED_TOLERANCE, SpeedLevels,
        SurfaceProperties,
    },
};

/// If a flight is closer to a limit than this (relative), rounding may decide and the sample is ignored.
const TOO_CLOSE: f64 = 3e-8;

/// The verdict of brute force on one flight.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Feasible,
    Infeasible(Limit),
    TooClose,
}

/// The tightest limit so far: slack is relative, negative if the limit is violated.
struct Slack {
    least: f64,
    by: Limit,
}

impl Slack {
    fn at_most(&mut self, value: f64, limit: f64, scale: f64, by: Limit) {
        let slack = (limit - value) / scale;
        if slack < self.least {
            *self = Self { least: slack, by };
        }
    }
}

/// A flight in time: speed, elevation, gravity.
#[derive(Clone, Copy)]
struct Flight {
    v: f64,
    theta: f64,
    g: f64,
}

impl Flight {
    /// The flight at this elevation that passes through (run, rise).
    fn through(run: f64, rise: f64, theta: f64, g: f64) -> Self {
        // rise = run tan - g run^2 / (2 v^2 cos^2)
        let v = run / theta.cos() * (g / (2.0 * (run * theta.tan() - rise))).sqrt();
        Self { v, theta, g }
    }

    fn time_to(&self, distance: f64) -> f64 {
        distance / (self.v * self.theta.cos())
    }

    fn height(&self, time: f64) -> f64 {
        self.v * self.theta.sin() * time - 0.5 * self.g * time * time
    }

    /// The highest point up to a time.
    fn highest(&self, end: f64) -> f64 {
        let top = self.v * self.theta.sin() / self.g;
        if top <= 0.0 { 0.0 } else { self.height(top.min(end)) }
    }
}

/// Evaluates one take-off angle by flying it and checking every limit.
fn evaluate(test: &HopTest, takeoff: &Station, landing: &Station, theta: f64) -> Verdict {
    let (run, rise) = ((landing.point.x_m - takeoff.point.x_m).abs(), landing.point.z_m - takeoff.point.z_m);
    let flight = Flight::through(run, rise, theta, test.gravity_m_s2());
    let end = flight.time_to(run);
    let (vx, vz) = (flight.v * theta.cos(), flight.v * theta.sin() - flight.g * end);
    let (landing_angle, landing_speed) = (vz.atan2(vx), vx.hypot(vz));
    let direction = Direction::between(takeoff.point.x_m, landing.point.x_m).unwrap();
    let (Ok(from), Ok(to)) = (
        test.chain().check_contact(takeoff, Contact::Takeoff, direction),
        test.chain().check_contact(landing, Contact::Landing, direction),
    ) else {
        return Verdict::Infeasible(Limit::Direction);
    };
    let mut slack = Slack { least: f64::INFINITY, by: Limit::LineOfSight };
    slack.at_most(flight.v, from.speed_max_m_s() * (1.0 + SPEED_TOLERANCE), flight.v, Limit::TakeoffSpeed);
    slack.at_most(landing_speed, to.speed_max_m_s() * (1.0 + SPEED_TOLERANCE), landing_speed, Limit::LandingSpeed);
    slack.at_most(theta, from.angles().max.radians(), 1.0, Limit::TakeoffCone);
    slack.at_most(from.angles().min.radians(), theta, 1.0, Limit::TakeoffCone);
    slack.at_most(landing_angle, to.angles().max.radians(), 1.0, Limit::LandingCone);
    slack.at_most(to.angles().min.radians(), landing_angle, 1.0, Limit::LandingCone);
    machine(test.hopper(), &flight, end, run.hypot(rise), &mut slack);
    terrain(test, takeoff, landing, &flight, &mut slack);
    if slack.least.abs() < TOO_CLOSE || slack.least.is_nan() {
        Verdict::TooClose
    } else if slack.least > 0.0 {
        Verdict::Feasible
    } else {
        Verdict::Infeasible(slack.by)
    }
}

/// The machine's own limits.
fn machine(hopper: &Hopper, flight: &Flight, end: f64, size: f64, slack: &mut Slack) {
    if let Some(min) = hopper.limits().takeoff_angle_min {
        slack.at_most(min.radians(), flight.theta, 1.0, Limit::MechanicalAngle);
    }
    if let Some(max) = hopper.limits().takeoff_angle_max {
        slack.at_most(flight.theta, max.radians(), 1.0, Limit::MechanicalAngle);
    }
    if let Some(min) = hopper.limits().takeoff_speed_min_m_s {
        slack.at_most(min * (1.0 - SPEED_TOLERANCE), flight.v, flight.v, Limit::TakeoffSpeedMin);
    }
    if let Some(max) = hopper.limits().apex_height_max_m {
        slack.at_most(flight.highest(end), max, size.max(max), Limit::ApexHeight);
    }
    if let Some(max) = hopper.limits().flight_time_max_s {
        slack.at_most(end, max, end, Limit::FlightTime);
    }
}

/// The height to keep at these distances from both ends.
fn kept_m(hopper: &Hopper, d: f64, e: f64) -> f64 {
    let taper = hopper.limits().clearance_rule.taper();
    taper.map_or(hopper.limits().clearance_m, |taper| hopper.limits().clearance_m.min(taper * d.min(e)))
}

/// Clearance over vertices, and no earlier contact with the ground.
fn terrain(test: &HopTest, takeoff: &Station, landing: &Station, flight: &Flight, slack: &mut Slack) {
    let geometry = test.chain().geometry();
    let (left, right) = (takeoff.point.x_m.min(landing.point.x_m), takeoff.point.x_m.max(landing.point.x_m));
    let run = right - left;
    let above = |x: f64, ground: f64| takeoff.point.z_m + flight.height(flight.time_to((x - takeoff.point.x_m).abs())) - ground;
    for vertex in geometry.vertices().iter().filter(|v| left < v.x_m && v.x_m < right) {
        // A change of angle moves a height in proportion to its distance from the nearer end: that is the scale.
        let arm = (vertex.x_m - left).min(right - vertex.x_m);
        let steep = arm * (1.0 + flight.theta.tan().powi(2)).max(1.0);
        slack.at_most(
            kept_m(test.hopper(), vertex.x_m - left, right - vertex.x_m),
            above(vertex.x_m, vertex.z_m),
            steep,
            Limit::Terrain,
        );
    }
    // A tapered clearance over the ground between vertices: many points, and the two where it stops growing.
    let limits = test.hopper().limits();
    if let Some(taper) = limits.clearance_rule.taper().filter(|_| limits.clearance_m > 0.0) {
        let full = (limits.clearance_m / taper).min(0.5 * run);
        let places = (1..48).map(|i| run * f64::from(i) / 48.0).chain([full, run - full]);
        for (d, x) in places.map(|d| (d, left + d)).filter(|(_, x)| left < *x && *x < right) {
            let steep = d.min(run - d) * (1.0 + flight.theta.tan().powi(2)).max(1.0);
            let ground = geometry.station(x).unwrap().point.z_m;
            slack.at_most(kept_m(test.hopper(), d, run - d), above(x, ground), steep, Limit::Terrain);
        }
    }
    for i in 1..24 {
        let x = left + run * f64::from(i) / 24.0;
        let ground = geometry.station(x).unwrap().point.z_m;
        // The arc is concave and the ground straight, so an arc above all vertices meets nothing in between.
        if slack.least > 0.0 {
            assert!(
                above(x, ground) > -1e-6 * run * (1.0 + flight.theta.tan().abs()),
                "the arc meets the ground between clear vertices"
            );
        }
    }
}

/// A chain of extreme segments, a hopper with some limits of its own, a gravity.
fn world(draw: &mut Draw) -> (ConstrainedChain, Hopper, f64) {
    let (g, size) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
    let segments = 2 + draw.below(6);
    let points = draw.profile(segments, size);
    let speed = (g * size).sqrt() * draw.log_uniform(0.5, 4.0);
    let lines: Vec<_> = (0..segments).map(|_| (draw.line(speed), draw.line(speed))).collect();
    let rest =
        if draw.chance(0.2) { RestSlope::AtMost(Angle::from_degrees(draw.uniform(20.0, 80.0))) } else { RestSlope::Unlimited };
    let mut limits = HopperLimits {
        clearance_m: if draw.chance(0.5) { 0.0 } else { size * draw.log_uniform(1e-4, 1e-1) },
        clearance_rule: draw.clearance_rule(),
        ..HopperLimits::UNLIMITED
    };
    if draw.chance(0.3) {
        limits.takeoff_angle_min = Some(Angle::from_degrees(draw.uniform(-30.0, 50.0)));
        limits.takeoff_angle_max = Some(Angle::from_degrees(draw.uniform(50.0, 89.0)));
    }
    if draw.chance(0.3) {
        limits.apex_height_max_m = Some(size * draw.log_uniform(1e-1, 3.0));
    }
    if draw.chance(0.3) {
        limits.flight_time_max_s = Some((size / g).sqrt() * draw.log_uniform(0.5, 3.0));
    }
    if draw.chance(0.3) {
        limits.takeoff_speed_min_m_s = Some(speed * draw.log_uniform(0.4, 2.0));
    }
    (explicit(&points, &lines, rest), Hopper::new(limits).unwrap(), g)
}

/// A chain with friction and cross-slopes, as slices of terrain have.
fn rocky_world(draw: &mut Draw) -> (ConstrainedChain, Hopper, f64) {
    use chta::chain::{GroundForm, PolygonalChain, SegmentGround};
    let (g, size) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
    let points = draw.profile(5, size);
    let grounds = (0..5)
        .map(|_| SegmentGround {
            form: GroundForm::Surface { friction: None, cross_slope: Angle::from_degrees(draw.uniform(0.0, 35.0)) },
            keep_out: draw.chance(0.1),
        })
        .collect();
    let speed = (g * size).sqrt() * draw.log_uniform(0.7, 4.0);
    let hopper = Hopper::with_speeds(speed, speed * draw.uniform(0.7, 1.3)).unwrap();
    let friction = FrictionCone::new(draw.uniform(0.3, 1.2)).unwrap();
    let rest = [RestSlope::AsFrictionHolds, RestSlope::Unlimited][draw.below(2)];
    let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest };
    (
        ConstrainedChain::new(PolygonalChain::new(points, grounds, None).unwrap(), &hopper, Gravity::new(g).unwrap(), &surface)
            .unwrap(),
        hopper,
        g,
    )
}

/// A position on the chain: often a vertex, sometimes right beside one.
fn place(draw: &mut Draw, chain: &ConstrainedChain) -> Station {
    let geometry = chain.geometry();
    let vertex = geometry.vertex_station(VertexId(draw.below(geometry.segment_count() + 1)));
    let (first, last) = geometry.extent_m();
    match draw.below(4) {
        0 => vertex,
        1 => geometry
            .station((vertex.point.x_m + (last - first) * draw.sign() * draw.log_uniform(1e-7, 1e-2)).clamp(first, last))
            .unwrap(),
        _ => geometry.station(draw.uniform(first, last)).unwrap(),
    }
}

/// Angles between the line of sight and the vertical: evenly spread, and concentrated around the ends of the set.
fn sampled_angles(draw: &mut Draw, set: &TakeoffSet) -> Vec<f64> {
    let (low, high) = (set.line_of_sight().angle().radians() + 1e-5, std::f64::consts::FRAC_PI_2 - 1e-4);
    let mut angles: Vec<f64> = (0..40).map(|i| low + (high - low) * (f64::from(i) + draw.unit()) / 40.0).collect();
    if let Some(ends) = set.angles() {
        let (min, max) = (ends.min.radians(), ends.max.radians());
        let windows = set.windows().iter().filter_map(|window| set.angles_of(window.lofts));
        for end in windows.flat_map(|angles| [angles.min.radians(), angles.max.radians()]).collect::<Vec<_>>() {
            angles.extend((0..6).map(|_| end + draw.sign() * draw.log_uniform(1e-6, 1e-2)));
        }
        angles.extend((0..6).map(|_| draw.uniform(min, max)));
    }
    angles.retain(|theta| low < *theta && *theta < high);
    angles
}

/// Samples pairs of one kind of world; returns (pairs, feasible pairs, evaluated flights, too close).
fn compare(seed: u64, worlds: u32, make: fn(&mut Draw) -> (ConstrainedChain, Hopper, f64)) -> (u32, u32, u32, u32) {
    let draw = &mut Draw::seeded(seed);
    let (mut pairs, mut feasible, mut evaluated, mut close) = (0, 0, 0, 0);
    for _ in 0..worlds {
        let (chain, hopper, g) = make(draw);
        let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap());
        for _ in 0..12 {
            let (takeoff, landing) = (place(draw, &chain), place(draw, &chain));
            let Some(set) = test.takeoff_set(&takeoff, &landing) else { continue };
            // Beyond this the simulation in double precision is not accurate enough.
            if set.line_of_sight().slope().abs() > 50.0 || set.line_of_sight().length_m() < 1e-6 * chain_length(&chain) {
                continue;
            }
            pairs += 1;
            feasible += u32::from(set.lofts().is_some());
            for theta in sampled_angles(draw, &set) {
                evaluated += 1;
                let windows = set.windows().iter().filter_map(|window| set.angles_of(window.lofts));
                let inside = windows.into_iter().any(|a| a.min.radians() <= theta && theta <= a.max.radians());
                match evaluate(&test, &takeoff, &landing, theta) {
                    Verdict::TooClose => close += 1,
                    Verdict::Feasible => {
                        assert!(inside, "flies at {theta} rad, which is not in {set:?}\n{chain:?}\n{hopper:?} g {g}");
                    }
                    Verdict::Infeasible(by) => {
                        assert!(!inside, "{by} violated at {theta} rad, which is in {set:?}\n{chain:?}\n{hopper:?} g {g}");
                    }
                }
            }
        }
    }
    (pairs, feasible, evaluated, close)
}

fn chain_length(chain: &ConstrainedChain) -> f64 {
    let (first, last) = chain.geometry().extent_m();
    last - first
}

#[test]
fn every_sampled_angle_is_in_the_set_exactly_if_it_flies() {
    let (pairs, feasible, evaluated, close) = compare(1, 700, world);
    assert!(pairs > 5000 && feasible > 400 && evaluated > 200_000, "{pairs} pairs, {feasible} feasible, {evaluated} flights");
    assert!(close * 50 < evaluated, "{close} of {evaluated} flights too close to call");
}

#[test]
fn every_sampled_angle_is_in_the_set_exactly_if_it_flies_on_rocky_ground() {
    let (pairs, feasible, evaluated, close) = compare(2, 700, rocky_world);
    assert!(pairs > 5000 && feasible > 400 && evaluated > 200_000, "{pairs} pairs, {feasible} feasible, {evaluated} flights");
    assert!(close * 50 < evaluated, "{close} of {evaluated} flights too close to call");
}

/// Flies from a station until the arc meets the chain again; returns the x of that point.
fn fly(points: &[ChainPoint], takeoff: &Station, direction: Direction, flight: &Flight) -> Option<f64> {
    let above = |d: f64, p: ChainPoint| takeoff.point.z_m + flight.height(flight.time_to(d)) - p.z_m;
    let order: Vec<ChainPoint> =
        if direction == Direction::Forward { points.to_vec() } else { points.iter().rev().copied().collect() };
    let away = |p: ChainPoint| direction.sign() * (p.x_m - takeoff.point.x_m);
    for pair in order.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if away(b) <= 0.0 || (away(a) <= 0.0 && above(away(b), b) > 0.0) {
            continue;
        }
        if above(away(b), b) > 0.0 {
            continue;
        }
        // Above the ground at the near end (or at the take-off itself), below it at the far end: bisect.
        let on = |d: f64| ChainPoint::new(0.0, a.z_m + (b.z_m - a.z_m) * ((d - away(a)) / (away(b) - away(a))));
        let (mut low, mut high) = (away(a).max(1e-4 * away(b)), away(b));
        if above(low, on(low)) <= 0.0 {
            return None;
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if above(middle, on(middle)) > 0.0 { low = middle } else { high = middle }
        }
        return Some(takeoff.point.x_m + direction.sign() * low);
    }
    None
}

#[test]
fn a_planted_flight_is_found_under_limits_that_touch_it() {
    let draw = &mut Draw::seeded(3);
    let mut planted = 0;
    for _ in 0..6000 {
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let points = draw.profile(6, size);
        let free = uniform(&points, line((-90.0, 90.0), 1e6, (-90.0, 90.0), 1e6));
        let takeoff = place(draw, &free);
        let direction = Direction::BOTH[draw.below(2)];
        let flight = Flight { v: (g * size).sqrt() * draw.log_uniform(0.5, 2.0), theta: draw.uniform(-0.5, 1.5), g };
        let Some(x) = fly(&points, &takeoff, direction, &flight) else { continue };
        let landing = free.geometry().station(x).unwrap();
        let (run, rise) = ((x - takeoff.point.x_m).abs(), landing.point.z_m - takeoff.point.z_m);
        if run < 1e-3 * size || (rise / run).abs() > 30.0 {
            continue;
        }
        let end = flight.time_to(run);
        let (vx, vz) = (flight.v * flight.theta.cos(), flight.v * flight.theta.sin() - g * end);
        // Limits that the flight just satisfies, except for the rounding of its simulation.
        let hair = 1e-7;
        let touching = |angle: f64, draw: &mut Draw| {
            let ends = if draw.chance(0.5) { (hair, draw.uniform(hair, 1.0)) } else { (draw.uniform(hair, 1.0), hair) };
            ((angle - ends.0).to_degrees(), (angle + ends.1).to_degrees())
        };
        let touched =
            line(touching(flight.theta, draw), flight.v * (1.0 + hair), touching(vz.atan2(vx), draw), vx.hypot(vz) * (1.0 + hair));
        let command = draw.below(3);
        let hopper = Hopper::new(HopperLimits {
            apex_height_max_m: Some(flight.highest(end) + hair * size),
            flight_time_max_s: Some(end * (1.0 + hair)),
            takeoff_angle_max: Some(Angle::from_radians(flight.theta + hair)),
            takeoff_speed_min_m_s: (command == 1).then_some(flight.v * (1.0 - hair)),
            takeoff_speed_levels: if command == 2 { SpeedLevels::new(&[0.5 * flight.v, flight.v]).ok() } else { None },
            ..HopperLimits::UNLIMITED
        })
        .unwrap();
        let chain = uniform(&points, touched);
        let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap());
        let set = test.takeoff_set(&takeoff, &landing).unwrap();
        let angles: Vec<_> = set.windows().iter().filter_map(|window| set.angles_of(window.lofts)).collect();
        assert!(!angles.is_empty(), "planted {} rad lost: {:?}", flight.theta, set.conflict());
        // The simulated landing is off by rounding; near the least speed an arc of a given speed turns with the square root of it.
        let (slope, near) = (set.line_of_sight().slope(), if command == 2 { 2e-4 } else { 1e-9 });
        let steep = (flight.theta.tan() - slope - (1.0 + slope * slope).sqrt()).abs();
        let near = if command == 2 && steep > 0.1 { 1e-6 } else { near };
        assert!(
            angles.iter().any(|a| a.min.radians() <= flight.theta + near && flight.theta - near <= a.max.radians()),
            "planted {} rad, found {angles:?}",
            flight.theta
        );
        planted += 1;
    }
    assert!(planted > 1500, "only {planted} flights met the ground");
}

/// A pair of a random world, with its test.
fn for_random_pairs(seed: u64, worlds: u32, mut check: impl FnMut(&mut Draw, &HopTest, &Station, &Station)) {
    let draw = &mut Draw::seeded(seed);
    for i in 0..worlds {
        let (chain, hopper, g) = if i % 2 == 0 { world(draw) } else { rocky_world(draw) };
        let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap());
        for _ in 0..12 {
            let (takeoff, landing) = (place(draw, &chain), place(draw, &chain));
            if takeoff.point.x_m != landing.point.x_m {
                check(draw, &test, &takeoff, &landing);
            }
        }
    }
}

#[test]
fn the_kernel_gives_the_lofts_of_the_explained_set() {
    let (mut feasible, mut refused) = (0, 0);
    for_random_pairs(4, 2000, |_, test, takeoff, landing| {
        let set = test.takeoff_set(takeoff, landing).unwrap();
        match test.lofts(takeoff, landing) {
            Ok(lofts) => {
                assert_eq!(set.lofts(), Some(lofts));
                feasible += 1;
            }
            Err(limit) => {
                assert_eq!(set.lofts(), None, "the kernel refuses by {limit}");
                let conflict = set.conflict().unwrap();
                if let chta::hop::Conflict::Alone(alone) = conflict
                    && matches!(alone.shortfall, Some(chta::hop::Shortfall::Ground { .. }))
                {
                    assert_eq!(alone.limit.index() <= Limit::LandingSpeed.index(), limit.index() <= Limit::LandingSpeed.index());
                }
                refused += 1;
            }
        }
    });
    assert!(feasible > 1500 && refused > 5000, "{feasible} feasible, {refused} refused");
}

#[test]
fn a_mirrored_chain_travelled_backwards_gives_the_same_set() {
    let draw = &mut Draw::seeded(5);
    for _ in 0..2000 {
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let points = draw.profile(5, size);
        let speed = (g * size).sqrt() * draw.log_uniform(0.5, 4.0);
        let lines: Vec<_> = (0..5).map(|_| (draw.line(speed), draw.line(speed))).collect();
        let mirrored: Vec<_> = points.iter().rev().map(|p| ChainPoint::new(-p.x_m, p.z_m)).collect();
        let swapped: Vec<_> = lines.iter().rev().map(|&(forward, reverse)| (reverse, forward)).collect();
        let (chain, mirror) =
            (explicit(&points, &lines, RestSlope::Unlimited), explicit(&mirrored, &swapped, RestSlope::Unlimited));
        let hopper =
            Hopper::new(HopperLimits { clearance_m: 0.01 * size, apex_height_max_m: Some(2.0 * size), ..HopperLimits::UNLIMITED })
                .unwrap();
        let (test, mirror_test) = (
            HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap()),
            HopTest::new(mirror.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap()),
        );
        for _ in 0..6 {
            let (a, b) = (place(draw, &chain), place(draw, &chain));
            let reflect = |s: &Station| mirror.geometry().station(-s.point.x_m).unwrap();
            assert_eq!(test.lofts(&a, &b), mirror_test.lofts(&reflect(&a), &reflect(&b)));
        }
    }
}

#[test]
fn gravity_times_four_and_speeds_times_two_change_no_bit() {
    let draw = &mut Draw::seeded(6);
    for _ in 0..2000 {
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let points = draw.profile(4, size);
        let speed = (g * size).sqrt() * draw.log_uniform(0.5, 4.0);
        let lines: Vec<_> = (0..4).map(|_| draw.line(speed)).collect();
        let power = [-3, -1, 1, 2, 5][draw.below(5)];
        let v = 2f64.powi(power);
        let faster = |l: &chta::chain::LineConstraints| {
            let rule = |r: chta::chain::ContactRule| chta::chain::ContactRule::new(r.angles(), r.speed_max_m_s() * v);
            chta::chain::LineConstraints { takeoff: rule(l.takeoff), landing: rule(l.landing) }
        };
        let both: Vec<_> = lines.iter().map(|l| (*l, *l)).collect();
        let scaled: Vec<_> = lines.iter().map(|l| (faster(l), faster(l))).collect();
        let (chain, other) = (explicit(&points, &both, RestSlope::Unlimited), explicit(&points, &scaled, RestSlope::Unlimited));
        let hopper = Hopper::new(HopperLimits {
            flight_time_max_s: Some((size / g).sqrt() * 3.0),
            apex_height_max_m: Some(size),
            takeoff_speed_min_m_s: draw.chance(0.3).then_some(0.7 * speed),
            takeoff_speed_levels: if draw.chance(0.3) { SpeedLevels::new(&[0.8 * speed, speed]).ok() } else { None },
            ..HopperLimits::UNLIMITED
        })
        .unwrap();
        let slower = Hopper::new(HopperLimits {
            flight_time_max_s: hopper.limits().flight_time_max_s.map(|t| t / v),
            takeoff_speed_min_m_s: hopper.limits().takeoff_speed_min_m_s.map(|speed| speed * v),
            takeoff_speed_levels: hopper.limits().takeoff_speed_levels.map(|levels| levels.scaled(v)),
            ..*hopper.limits()
        })
        .unwrap();
        let (test, other_test) = (
            HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap()),
            HopTest::new(other.with_hopper(&slower, Gravity::new(g * v * v).unwrap()).unwrap()),
        );
        for _ in 0..6 {
            let (a, b) = (place(draw, &chain), place(draw, &chain));
            assert_eq!(test.lofts(&a, &b), other_test.lofts(&a, &b), "gravity times {}", v * v);
            let windows = |test: &HopTest| test.takeoff_set(&a, &b).map(|set| set.windows().to_vec());
            assert_eq!(windows(&test), windows(&other_test), "gravity times {}", v * v);
        }
    }
}

#[test]
fn energy_is_conserved_and_the_tangents_add_up() {
    let mut arcs = 0;
    for_random_pairs(7, 1500, |draw, test, takeoff, landing| {
        let set = test.takeoff_set(takeoff, landing).unwrap();
        let choice = chta::ballistics::TakeoffChoice::ALL[draw.below(3)];
        let Some(arc) = set.arc(choice, test.gravity_m_s2()) else { return };
        let (v_t, v_l) = (arc.takeoff_speed_m_s(), arc.landing_speed_m_s());
        let potential = 2.0 * test.gravity_m_s2() * set.line_of_sight().rise_m();
        assert!((v_l * v_l - (v_t * v_t - potential)).abs() <= 1e-12 * (v_t * v_t + v_l * v_l), "v_l^2 = v_t^2 - 2 g Z");
        // The mean of the take-off and landing tangents is that of the line of sight (P eq. 10).
        let (up, down) = (arc.takeoff_angle().radians().tan(), arc.landing_angle().radians().tan());
        let sum = up + down - 2.0 * set.line_of_sight().slope();
        assert!(sum.abs() <= 1e-11 * (1.0 + up.abs() + up * up + down * down), "{up} + {down}");
        arcs += 1;
    });
    assert!(arcs > 1000, "only {arcs} arcs");
}

#[test]
fn rest_slope_cross_slope_and_keep_out_refuse_at_the_end_that_has_them() {
    let mut seen = std::collections::BTreeSet::new();
    for_random_pairs(8, 1500, |_, test, takeoff, landing| {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m).unwrap();
        let ends = [(takeoff, Contact::Takeoff), (landing, Contact::Landing)];
        let refusals: Vec<_> =
            ends.iter().filter_map(|(s, c)| test.chain().check_contact(s, *c, direction).err().map(|r| r.limit(*c))).collect();
        if let Some(&first) = refusals.first() {
            assert_eq!(test.lofts(takeoff, landing), Err(first));
            let set = test.takeoff_set(takeoff, landing).unwrap();
            for refusal in &refusals {
                assert!(set.limits().iter().any(|l| l.limit == *refusal && l.lofts.is_empty()));
            }
            seen.insert(first);
        }
        // The steepness computed independently, from the two vertices of the segment under a point.
        if let Site::Inside(segment) = takeoff.site
            && let Err(GroundRefusal::TooSteep { tilt, max }) = test.chain().check_contact(takeoff, Contact::Takeoff, direction)
        {
            let v = &test.chain().geometry().vertices()[segment.index()..=segment.index() + 1];
            let alpha = ((v[1].z_m - v[0].z_m) / (v[1].x_m - v[0].x_m)).atan();
            assert!(tilt.radians() >= alpha.abs() - 1e-9 && tilt.radians() > max.radians());
        }
    });
    for limit in [Limit::RestSlope, Limit::KeepOut, Limit::TakeoffCone, Limit::LandingCone] {
        assert!(seen.contains(&limit), "{limit} never refused");
    }
}

#[test]
fn limits_that_touch_leave_exactly_one_arc() {
    let draw = &mut Draw::seeded(9);
    for _ in 0..500 {
        // Flat ground: no steeper than theta at take-off, no flatter than theta at landing.
        let (g, run, degrees) = (draw.gravity(), draw.log_uniform(1e-3, 1e5), draw.uniform(5.0, 85.0));
        let points = [ChainPoint::new(0.0, 0.0), ChainPoint::new(run, 0.0)];
        let chain = uniform(&points, line((-90.0, degrees), 1e6, (-90.0, -degrees), 1e6));
        let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(g).unwrap()).unwrap());
        let at = |i| chain.geometry().vertex_station(VertexId(i));
        let angles = test.takeoff_set(&at(0), &at(1)).unwrap().angles().expect("limits that touch still hold");
        assert_eq!(angles.min, angles.max);
        assert!((angles.min.degrees() - degrees).abs() < 1e-12 * degrees);
        // The least possible speed, as a double: the tolerance accepts it, and refuses a millionth less.
        let least = chta::ballistics::least_takeoff_speed_m_s(chta::ballistics::LineOfSight::new(run, 0.0), g);
        for (speed, reaches) in [(least, true), (least * (1.0 - 1e-6), false)] {
            let chain = uniform(&points, line((-90.0, 90.0), speed, (-90.0, 90.0), speed));
            let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(g).unwrap()).unwrap());
            assert_eq!(test.lofts(&at(0), &at(1)).is_ok(), reaches, "{speed} m/s over {run} m");
        }
    }
}

#[test]
fn a_landing_exactly_at_the_apex_limit_is_allowed_from_below() {
    // 3 m up a wall 1 m away: flights still rising at the landing have it as their highest point.
    let points = [ChainPoint::new(0.0, 0.0), ChainPoint::new(1.0, 3.0)];
    let chain = uniform(&points, line((-90.0, 90.0), 100.0, (-90.0, 90.0), 100.0));
    for (height, allowed) in [(3.0, true), (3.0f64.next_down(), false)] {
        let hopper = Hopper::new(HopperLimits { apex_height_max_m: Some(height), ..HopperLimits::UNLIMITED }).unwrap();
        let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(9.81).unwrap()).unwrap());
        let at = |i| chain.geometry().vertex_station(VertexId(i));
        let set = test.takeoff_set(&at(0), &at(1)).unwrap();
        assert_eq!(set.lofts().is_some(), allowed, "{height} m");
        // The steepest of them lands horizontally: b - n = 0.
        assert!(set.lofts().is_none_or(|lofts| (lofts.upper - 3.0).abs() < 1e-12));
    }
}
