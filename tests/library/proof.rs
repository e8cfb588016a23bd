//! Bounds that hold for every choice of points: against the search at all densities, random paths, and a dense sampling attack.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{Draw, explicit, line};
use chta::{
    ballistics::{TakeoffChoice, TakeoffSpeeds},
    chain::{ConstrainedChain, ContactRule, GroundForm, PolygonalChain, SegmentGround, Station},
    graph::{
        Outcome, PointSpacing, SearchOptions,
        proof::{Bounds, BoundsOptions, ProofVerdict, bounds},
        search,
    },
    hop::{HopTest, Split},
    path::{execute, generate},
    quantity::{Angle, ChainPoint, VertexId},
    world::{Contact, Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// A chain with its hopper, gravity, start and goal.
struct Journey {
    chain: ConstrainedChain,
    hopper: Hopper,
    g: f64,
    start: Station,
    goal: Station,
}

impl Journey {
    /// Adversarial chains: explicit constraints that differ by segment and direction, machine limits, bends, tiny segments.
    fn adversarial(draw: &mut Draw) -> Self {
        let segments = 2 + draw.below(6);
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-1, 1e2));
        let points = draw.profile(segments, size);
        let speed = (g * size).sqrt() * draw.log_uniform(0.4, 1.5);
        let cone = |draw: &mut Draw| {
            let takeoff = if draw.chance(0.3) { (-90.0, 90.0) } else { (draw.uniform(-20.0, 70.0), draw.uniform(70.0, 95.0)) };
            let landing = if draw.chance(0.3) { (-90.0, 90.0) } else { (-95.0, draw.uniform(-70.0, 20.0)) };
            let fast = if draw.chance(0.1) { 0.0 } else { draw.uniform(0.6, 1.4) };
            line(takeoff, speed * fast, landing, speed * draw.uniform(0.7, 1.6))
        };
        let lines: Vec<_> = (0..segments).map(|_| (cone(draw), cone(draw))).collect();
        let mut limits = HopperLimits {
            clearance_m: if draw.chance(0.5) { 0.0 } else { size * draw.log_uniform(1e-3, 1e-1) },
            clearance_rule: draw.clearance_rule(),
            ..HopperLimits::UNLIMITED
        };
        if draw.chance(0.2) {
            limits.apex_height_max_m = Some(size * draw.uniform(0.05, 0.6));
        }
        if draw.chance(0.2) {
            limits.flight_time_max_s = Some((size / g).sqrt() * draw.uniform(0.5, 2.0));
        }
        if draw.chance(0.2) {
            limits.takeoff_angle_max = Some(Angle::from_degrees(draw.uniform(40.0, 89.0)));
        }
        draw.commands(&mut limits, 1.2 * speed);
        let hopper = Hopper::new(limits).unwrap();
        let bent = segments > 2 && draw.chance(0.2);
        let chain = if bent {
            let grounds = lines
                .iter()
                .map(|&(f, r)| SegmentGround {
                    form: GroundForm::Explicit { forward: Some(f), reverse: Some(r) },
                    keep_out: draw.chance(0.1),
                })
                .collect();
            let bend = VertexId(1 + draw.below(segments - 1));
            let geometry = PolygonalChain::new(points, grounds, None).unwrap().with_bends(vec![bend]).unwrap();
            ConstrainedChain::new(
                geometry,
                &hopper,
                Gravity::new(g).unwrap(),
                &SurfaceProperties { grip: None, rest: RestSlope::Unlimited },
            )
            .unwrap()
        } else {
            explicit(&points, &lines, RestSlope::Unlimited)
        };
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        Self { chain, hopper, g, start, goal }
    }

    /// Chains like the prototype's: eight segments of rough ground with a friction cone, from end to end.
    fn rough(draw: &mut Draw, segments: usize) -> Self {
        let mut points = vec![ChainPoint::new(0.0, 0.0)];
        for i in 0..segments {
            let run = draw.uniform(2.0, 10.0);
            points.push(ChainPoint::new(points[i].x_m + run, points[i].z_m + draw.uniform(-0.5, 0.5) * run));
        }
        let hopper = Hopper::new(HopperLimits {
            clearance_m: 0.1,
            ..HopperLimits::with_speeds(draw.uniform(4.0, 9.0), draw.uniform(4.0, 9.0))
        })
        .unwrap();
        let grip = Some(Grip::Friction(FrictionCone::new(draw.uniform(0.5, 1.0)).unwrap()));
        let geometry = PolygonalChain::bare(points).unwrap();
        let chain = ConstrainedChain::new(
            geometry,
            &hopper,
            Gravity::new(3.711).unwrap(),
            &SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds },
        )
        .unwrap();
        let (first, last) = chain.geometry().extent_m();
        let (start, goal) = (chain.geometry().station(first).unwrap(), chain.geometry().station(last).unwrap());
        Self { chain, hopper, g: 3.711, start, goal }
    }

    fn test(&self) -> HopTest {
        HopTest::new(self.chain.with_hopper(&self.hopper, Gravity::new(self.g).unwrap()).unwrap())
    }

    fn bounds(&self, budget_cells: usize) -> Bounds {
        let options = BoundsOptions { budget_cells, ..BoundsOptions::default() };
        bounds(&self.test(), self.start, self.goal, &options, &()).unwrap()
    }

    /// The fewest hops with a number of points inside each segment.
    fn fewest(&self, points: u32) -> Option<u64> {
        let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(points)), ..SearchOptions::default() };
        search(&self.test(), self.start, self.goal, &options, &()).unwrap().hops()
    }

    /// The upper bound's path must be valid: flown again, it violates nothing and joins start and goal in that many hops.
    fn verify(&self, found: &Bounds) {
        let Outcome::Path { legs, cost } = &found.answer.outcome else { return };
        let path = generate(&self.test(), legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap();
        assert_eq!(path.hops.len() as u64, cost.hops());
        let execution = execute(self.test().chain(), &path, Some((self.start, self.goal)));
        assert!(execution.passes(), "{:?}", execution.violations);
    }
}

/// A position on a chain, often a vertex.
fn place(draw: &mut Draw, chain: &ConstrainedChain) -> Station {
    let geometry = chain.geometry();
    let (first, last) = geometry.extent_m();
    if draw.chance(0.5) {
        geometry.vertex_station(VertexId(draw.below(geometry.segment_count() + 1)))
    } else {
        geometry.station(draw.uniform(first, last)).unwrap()
    }
}

/// The vertices, start, goal and some random positions, sorted by x, without duplicates.
fn drawn_stations(draw: &mut Draw, journey: &Journey, count: usize) -> Vec<Station> {
    let geometry = journey.chain.geometry();
    let (first, last) = geometry.extent_m();
    let mut stations: Vec<_> = (0..=geometry.segment_count()).map(|i| geometry.vertex_station(VertexId(i))).collect();
    stations.extend((0..count).map(|_| geometry.station(draw.uniform(first, last)).unwrap()));
    stations.extend([journey.start, journey.goal]);
    stations.sort_by(|a, b| a.point.x_m.total_cmp(&b.point.x_m));
    stations.dedup_by(|a, b| a.point.x_m == b.point.x_m);
    stations
}

/// The fewest hops from start to goal over some stations by breadth-first search; `joined` tells which pairs have an edge.
fn fewest_over(stations: &[Station], journey: &Journey, joined: &dyn Fn(&Station, &Station) -> bool) -> Option<u64> {
    let mut hops: Vec<Option<u64>> = stations.iter().map(|s| (s == &journey.start).then_some(0)).collect();
    let mut queue: std::collections::VecDeque<usize> = hops.iter().position(Option::is_some).into_iter().collect();
    while let Some(here) = queue.pop_front() {
        if stations[here] == journey.goal {
            return hops[here];
        }
        for there in 0..stations.len() {
            if hops[there].is_none() && joined(&stations[here], &stations[there]) {
                hops[there] = hops[here].map(|count| count + 1);
                queue.push_back(there);
            }
        }
    }
    None
}

/// Whether one of some take-off angles flies from one station to another, by the original equations with limits relaxed by a
/// billionth: no loft, no interval, no quadratic.
fn flies(journey: &Journey, from: &Station, to: &Station, angles: u32) -> bool {
    const SLACK: f64 = 1.0 + 2e-9;
    let Some(direction) = Direction::between(from.point.x_m, to.point.x_m) else { return false };
    let (Ok(takeoff), Ok(landing)) = (
        journey.chain.check_contact(from, Contact::Takeoff, direction),
        journey.chain.check_contact(to, Contact::Landing, direction),
    ) else {
        return false;
    };
    if journey.chain.geometry().bend_between(from.point.x_m, to.point.x_m).is_some() {
        return false;
    }
    let (run, rise) = ((to.point.x_m - from.point.x_m).abs(), to.point.z_m - from.point.z_m);
    let (g, hopper) = (journey.g, &journey.hopper);
    let steepest = hopper.limits().takeoff_angle_max.map_or(90.0, Angle::degrees).min(89.999_999);
    (0..=angles).any(|i| {
        // Between the line of sight and the vertical.
        let sight = (rise / run).atan().to_degrees();
        let angle = sight + (steepest - sight) * f64::from(i) / f64::from(angles);
        let m = angle.to_radians().tan();
        let fall = m * run - rise;
        if fall <= 0.0 {
            return false;
        }
        let (along_squared, time) = (g * run * run / (2.0 * fall), (2.0 * fall / g).sqrt());
        let end_slope = m - 2.0 * fall / run;
        let [v_t, v_l] = [m, end_slope].map(|slope| (along_squared * (1.0 + slope * slope)).sqrt());
        let within = |slope: f64, rule: &ContactRule| {
            let angles = rule.angles();
            let at = slope.atan();
            angles.min.radians() - 1e-9 <= at && at <= angles.max.radians() + 1e-9
        };
        let top = if end_slope >= 0.0 {
            rise.max(0.0)
        } else if m <= 0.0 {
            0.0
        } else {
            m * m * run * run / (4.0 * fall)
        };
        let kept = |d: f64| {
            let limits = hopper.limits();
            limits.clearance_rule.taper().map_or(limits.clearance_m, |k| limits.clearance_m.min(k * d.min(run - d)))
        };
        let clear = journey.chain.geometry().vertices().iter().all(|p| {
            let d = (p.x_m - from.point.x_m) * direction.sign();
            !(d > 0.0 && d < run) || from.point.z_m + m * d - fall * (d / run) * (d / run) >= p.z_m + kept(d) / SLACK
        });
        let tapered = hopper.limits().clearance_rule.taper().is_some() && hopper.limits().clearance_m > 0.0;
        let full = hopper.limits().clearance_rule.taper().map_or(0.0, |k| (hopper.limits().clearance_m / k).min(0.5 * run));
        let clear = clear
            && (!tapered
                || (1..64).map(|i| run * f64::from(i) / 64.0).chain([full, run - full]).filter(|d| 0.0 < *d && *d < run).all(
                    |d| {
                        let x_m = from.point.x_m + direction.sign() * d;
                        let ground = journey.chain.geometry().station(x_m).map_or(f64::NEG_INFINITY, |station| station.point.z_m);
                        from.point.z_m + m * d - fall * (d / run) * (d / run) >= ground + kept(d) / SLACK - 1e-9 * run
                    },
                ));
        v_t <= takeoff.speed_max_m_s() * SLACK
            && v_l <= landing.speed_max_m_s() * SLACK
            && within(m, &takeoff)
            && within(end_slope, &landing)
            && hopper.limits().flight_time_max_s.is_none_or(|t| time <= t * SLACK)
            // No sampled angle has exactly a level: those are attacked in exact arithmetic (src/graph/proof/may/tests.rs).
            && hopper.limits().takeoff_speed_levels.is_none()
            && hopper.limits().takeoff_speed_min_m_s.is_none_or(|v| v_t >= v / SLACK)
            && hopper.limits().apex_height_max_m.is_none_or(|h| top <= h * SLACK)
            && clear
    })
}

#[test]
fn untraversable_survives_an_attack_by_points_and_angles() {
    let draw = &mut Draw::seeded(603);
    let (mut attacked, mut broken_open) = (0, 0);
    for i in 0..600 {
        let journey = Journey::adversarial(draw);
        let found = journey.bounds(300);
        let stations = drawn_stations(draw, &journey, 25);
        let attack = fewest_over(&stations, &journey, &|a, b| flies(&journey, a, b, 24));
        match found.verdict() {
            ProofVerdict::Untraversable => {
                attacked += 1;
                assert_eq!(attack, None, "journey {i}: proved untraversable, but a path of sampled angles reaches the goal");
            }
            _ => broken_open += u64::from(attack.is_some()),
        }
        if let Some(hops) = attack {
            assert!(found.lower.unwrap() <= hops, "journey {i}: bound {:?}, but sampled angles take {hops} hops", found.lower);
        }
    }
    assert!(attacked > 80 && broken_open > 150, "{attacked} attacked; {broken_open} of the others are solved by the attack");
}

#[test]
fn no_path_over_random_points_beats_the_lower_bound() {
    let draw = &mut Draw::seeded(604);
    let mut found_paths = 0;
    for i in 0..600 {
        let journey = Journey::adversarial(draw);
        let found = journey.bounds(200);
        let (stations, test) = (drawn_stations(draw, &journey, 40), journey.test());
        let Some(hops) = fewest_over(&stations, &journey, &|a, b| test.lofts(a, b).is_ok()) else { continue };
        found_paths += 1;
        assert!(found.lower.is_some_and(|lower| lower <= hops), "journey {i}: bound {:?}, random points {hops}", found.lower);
    }
    assert!(found_paths > 250, "only {found_paths} paths");
}

/// The point densities with which the lower bound is compared.
const DENSITIES: [u32; 6] = [0, 1, 2, 3, 5, 8];

/// Those with which it is compared on every twentieth chain.
const DENSER: [u32; 3] = [13, 31, 64];

#[test]
fn no_density_of_points_beats_the_lower_bound() {
    let draw = &mut Draw::seeded(601);
    let (mut untraversable, mut met, mut open, mut open_commanded) = (0, 0, 0, 0);
    for i in 0..1000 {
        let journey = Journey::adversarial(draw);
        let found = journey.bounds(300);
        journey.verify(&found);
        assert!(found.lower.is_none() || found.upper().is_none_or(|upper| found.lower.unwrap() <= upper), "journey {i}: {found:?}");
        let denser = if i % 20 == 0 { &DENSER[..] } else { &[] };
        for &points in DENSITIES.iter().chain(denser) {
            let Some(hops) = journey.fewest(points) else { continue };
            let lower =
                found.lower.unwrap_or_else(|| panic!("journey {i}: proved untraversable, but {points} points find {hops} hops"));
            assert!(lower <= hops, "journey {i}: bound {lower}, but {points} points find {hops} hops");
        }
        match (found.verdict(), found.is_proved()) {
            (ProofVerdict::Untraversable, _) => untraversable += 1,
            (_, true) => met += 1,
            (_, false) if TakeoffSpeeds::of(journey.hopper.limits()).are_any() => open += 1,
            // Machines of few speeds: a cell that two windows of theirs overlap keeps both and all between.
            (_, false) => open_commanded += 1,
        }
    }
    assert!(
        untraversable > 150 && met > 550 && open < 40 && open_commanded < 60,
        "{untraversable} untraversable, {met} met, {open} open, with {open_commanded} of machines with few speeds"
    );
}

#[test]
fn bounds_meet_on_chains_of_the_prototypes_kind() {
    let draw = &mut Draw::seeded(602);
    let mut open = Vec::new();
    for i in 0..25 {
        let journey = Journey::rough(draw, 8);
        let found = journey.bounds(50_000);
        journey.verify(&found);
        if !found.is_proved() {
            open.push((i, found.lower, found.upper()));
        }
    }
    assert!(open.len() <= 1, "left open (number, lower, upper): {open:?}");
}

/// The bound by the speeds alone holds for every path that is found, and is never above the fewest hops where those are proved.
#[test]
fn the_bound_by_the_speeds_is_below_every_path_and_every_proof() {
    let mut draw = Draw::seeded(1704);
    let (mut paths, mut proved, mut tight) = (0, 0, 0);
    for round in 0..400 {
        let segments = 2 + draw.below(8);
        let journey = if round % 2 == 0 { Journey::adversarial(&mut draw) } else { Journey::rough(&mut draw, segments) };
        let lower = journey.test().chain().hops_lower_bound(&journey.start, &journey.goal);
        for points in [0, 3] {
            let Some(hops) = journey.fewest(points) else { continue };
            let lower = lower.expect("a path has speeds");
            assert!(lower <= hops, "{lower} by the speeds, {hops} found");
            paths += 1;
            tight += u32::from(lower == hops && hops > 1);
        }
        let found = journey.bounds(400);
        if let (Some(proof), Some(upper)) = (found.lower, found.upper())
            && proof == upper
        {
            assert!(lower.is_some_and(|lower| lower <= proof), "{lower:?} by the speeds, {proof} proved");
            proved += 1;
        }
    }
    assert!(paths > 200 && proved > 100 && tight > 20, "{paths} paths, {proved} proved, {tight} of as many hops as the bound");
}
