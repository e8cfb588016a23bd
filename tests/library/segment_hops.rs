//! Many hops along one segment: their least number, their lengths and their arcs, against flights simulated one by one.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{Draw, line, uniform};
use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, LineConstraints, Station},
    graph::{Edge, Leg},
    hop::{HopTest, SegmentHops, Split},
    path::generate,
    quantity::{Angle, ChainPoint, SegmentId, VertexId},
    world::{Direction, Gravity, Hopper, HopperLimits, Limit, SPEED_TOLERANCE},
};

/// One straight segment with its limits.
struct Slope {
    chain: ConstrainedChain,
    line: LineConstraints,
    hopper: Hopper,
    g: f64,
    /// In the direction of travel.
    b: f64,
    direction: Direction,
}

impl Slope {
    fn new(run: f64, slope: f64, line: LineConstraints, hopper: Hopper, g: f64, direction: Direction) -> Self {
        let chain = uniform(&[ChainPoint::new(0.0, 0.0), ChainPoint::new(run, slope * run)], line);
        let b = direction.sign() * chain.geometry().slopes()[0];
        Self { chain, line, hopper, g, b, direction }
    }

    /// A segment from flat to steep, with or without machine limits.
    fn draw(draw: &mut Draw, machine: bool) -> Self {
        let (g, run) = (draw.gravity(), draw.log_uniform(1e-1, 1e4));
        let slope = if draw.chance(0.2) { 0.0 } else { draw.uniform(-1.5, 1.5) };
        let speed = (g * run / draw.log_uniform(0.5, 30.0)).sqrt();
        let line = draw.line(speed);
        let mut limits = HopperLimits::UNLIMITED;
        if machine {
            limits.takeoff_angle_max = draw.chance(0.5).then(|| Angle::from_degrees(draw.uniform(20.0, 85.0)));
            limits.apex_height_max_m = draw.chance(0.5).then(|| speed * speed / g * draw.log_uniform(1e-2, 1.0));
            limits.flight_time_max_s = draw.chance(0.5).then(|| speed / g * draw.log_uniform(1e-1, 3.0));
        }
        if machine && draw.chance(0.3) {
            limits.clearance_m = run * draw.log_uniform(1e-5, 1.0);
            limits.clearance_rule = draw.clearance_rule();
        }
        let hopper = Hopper::new(limits).unwrap();
        Self::new(run, slope, line, hopper, g, Direction::BOTH[draw.below(2)])
    }

    fn test(&self) -> HopTest {
        HopTest::new(self.chain.with_hopper(&self.hopper, Gravity::new(self.g).unwrap()).unwrap())
    }

    /// Take-off and landing of the whole segment.
    fn ends(&self) -> (Station, Station) {
        let (a, b) = (self.chain.geometry().vertex_station(VertexId(0)), self.chain.geometry().vertex_station(VertexId(1)));
        if self.direction == Direction::Forward { (a, b) } else { (b, a) }
    }

    fn run(&self) -> f64 {
        let (a, b) = self.ends();
        (a.point.x_m - b.point.x_m).abs()
    }

    /// Whether a flight of this length at this angle keeps every limit, within the tolerances.
    fn flies(&self, length: f64, theta: f64, hair: f64) -> bool {
        let v = length / theta.cos() * (self.g / (2.0 * length * (theta.tan() - self.b))).sqrt();
        let (vx, end) = (v * theta.cos(), length / (v * theta.cos()));
        let vz = v * theta.sin() - self.g * end;
        let (down, landing_speed) = (vz.atan2(vx), vx.hypot(vz));
        let top = v * theta.sin() / self.g;
        let highest = if top <= 0.0 { 0.0 } else { v * theta.sin() * top.min(end) - 0.5 * self.g * top.min(end).powi(2) };
        let within = |angle: f64, rule: chta::chain::ContactRule| {
            rule.angles().min.radians() - hair <= angle && angle <= rule.angles().max.radians() + hair
        };
        let more = (1.0 + SPEED_TOLERANCE) * (1.0 + hair);
        within(theta, self.line.takeoff)
            && within(down, self.line.landing)
            && v <= self.line.takeoff.speed_max_m_s() * more
            && landing_speed <= self.line.landing.speed_max_m_s() * more
            && self.clears(length, theta, hair)
            && self.hopper.limits().takeoff_angle_max.is_none_or(|max| theta <= max.radians() + hair)
            && self.hopper.limits().apex_height_max_m.is_none_or(|max| highest <= max * (1.0 + hair))
            && self.hopper.limits().flight_time_max_s.is_none_or(|max| end <= max * (1.0 + hair))
    }

    /// Whether a flight over this segment keeps a tapered clearance: at the two places where it stops growing, and at many others.
    fn clears(&self, length: f64, theta: f64, hair: f64) -> bool {
        let limits = self.hopper.limits();
        let Some(taper) = limits.clearance_rule.taper().filter(|_| limits.clearance_m > 0.0) else { return true };
        let full = (limits.clearance_m / taper).min(0.5 * length);
        let places = (1..32).map(|i| length * f64::from(i) / 32.0).chain([full, length - full]);
        places.filter(|d| 0.0 < *d && *d < length).all(|d| {
            let over = (theta.tan() - self.b) * d * (length - d) / length;
            over >= limits.clearance_m.min(taper * d.min(length - d)) * (1.0 - hair - 1e-12)
        })
    }

    /// The longest flight at an angle, by bisection on flights: of those longer than one that is flown, if short ones are not.
    fn longest(&self, theta: f64) -> f64 {
        let (mut low, mut high) = (0.0, 100.0 * self.run());
        let least = 1e-9 * self.run();
        if !self.flies(least, theta, 0.0) {
            // Lengths that differ by 1 %: the possible ones are an interval.
            let lengths = (0..2600).map(|i| least * 1.01f64.powi(i));
            low = lengths.filter(|length| self.flies(*length, theta, 0.0)).fold(0.0, f64::max);
            if low == 0.0 {
                return 0.0;
            }
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.flies(middle, theta, 0.0) { low = middle } else { high = middle }
        }
        low
    }

    /// Angles from the slope to the vertical.
    fn angles(&self, count: u32) -> impl Iterator<Item = f64> {
        let beta = self.b.atan();
        (1..count).map(move |i| beta + (std::f64::consts::FRAC_PI_2 - beta) * f64::from(i) / f64::from(count))
    }
}

/// The hops of one leg along the segment.
fn flown(slope: &Slope, along: SegmentHops, choice: TakeoffChoice, split: Split) -> Vec<chta::path::Hop> {
    let (takeoff, landing) = slope.ends();
    generate(&slope.test(), &[Leg { takeoff, landing, edge: Edge::Along(along), loft: None }], choice, split).unwrap().hops
}

#[test]
fn no_simulated_hop_goes_farther_than_the_reach_and_some_come_close() {
    let draw = &mut Draw::seeded(21);
    let mut compared = 0;
    for i in 0..500 {
        let slope = Slope::draw(draw, i % 2 == 0);
        let best = slope.angles(800).map(|theta| slope.longest(theta)).fold(0.0, f64::max);
        match slope.test().segment_reach(SegmentId(0), slope.direction) {
            None => assert_eq!(best, 0.0, "{best} m were flown without a reach"),
            Some(reach) => {
                assert!(best <= reach.reach_m() * (1.0 + 1e-8), "{best} m flown, reach {} m", reach.reach_m());
                // The best angle lies within a sampling step of a sampled one, unless the cones leave less than that.
                let flies_best = slope.flies(reach.reach_m() * (1.0 - 1e-9), reach.takeoff_slope().atan(), 1e-8);
                assert!(flies_best, "the reach of {} m by {} cannot be flown", reach.reach_m(), reach.limit());
                compared += u32::from(best > 0.97 * reach.reach_m());
            }
        }
    }
    assert!(compared > 300, "only {compared} reaches met by sampling");
}

#[test]
fn no_mixture_of_hops_needs_fewer() {
    let draw = &mut Draw::seeded(22);
    let mut met = 0;
    for i in 0..400 {
        let slope = Slope::draw(draw, i % 2 == 0);
        let (takeoff, landing) = slope.ends();
        let Some(along) = slope.test().segment_hops(&takeoff, &landing) else { continue };
        if along.hops() > 40 {
            continue;
        }
        // For each sampled angle the longest hop; shorter ones are possible too. The fewest hops that cover the run are found
        // greedily, since all hops may be shortened; random mixtures must not need fewer.
        let longest: Vec<f64> = slope.angles(300).map(|theta| slope.longest(theta)).filter(|l| *l > 0.0).collect();
        let Some(best) = longest.iter().copied().reduce(f64::max) else { continue };
        let mut covered = 0.0;
        let mut hops = 0;
        while covered < slope.run() * (1.0 - 1e-12) {
            covered += best;
            hops += 1;
        }
        assert!(hops >= along.hops(), "{hops} hops flown, the least number given as {}", along.hops());
        met += u32::from(hops == along.hops());
        for _ in 0..20 {
            let (mut covered, mut hops) = (0.0, 0);
            while covered < slope.run() * (1.0 - 1e-12) && hops <= along.hops() {
                covered += longest[draw.below(longest.len())] * draw.uniform(0.5, 1.0).max(draw.unit());
                hops += 1;
            }
            assert!(hops >= along.hops());
        }
    }
    assert!(met > 100, "only {met} counts met by sampling");
}

#[test]
fn every_hop_of_both_splits_and_all_choices_flies_and_they_add_up_to_the_run() {
    let draw = &mut Draw::seeded(23);
    let mut hops_flown = 0;
    for i in 0..600 {
        let slope = Slope::draw(draw, i % 2 == 0);
        let (takeoff, landing) = slope.ends();
        let Some(along) = slope.test().segment_hops(&takeoff, &landing) else { continue };
        if along.hops() > 200 {
            continue;
        }
        for (split, choice) in Split::ALL.into_iter().flat_map(|s| TakeoffChoice::ALL.map(|c| (s, c))) {
            let hops = flown(&slope, along, choice, split);
            assert_eq!(hops.len() as u64, along.hops());
            assert_eq!((hops[0].takeoff.station, hops[hops.len() - 1].landing.station), (Some(takeoff), Some(landing)));
            for hop in &hops {
                let length = hop.run_m();
                assert!(
                    slope.flies(length, hop.takeoff_angle.radians(), 1e-7),
                    "{} of {length} m at {} deg, {}, {}",
                    hop.takeoff_speed_m_s,
                    hop.takeoff_angle.degrees(),
                    split.name(),
                    choice.name()
                );
                hops_flown += 1;
            }
        }
    }
    assert!(hops_flown > 5000, "only {hops_flown}");
}

#[test]
fn full_reach_has_the_least_sum_of_speeds_and_equal_hops_the_least_peak_for_the_same_energy() {
    let draw = &mut Draw::seeded(24);
    let mut compared = 0;
    for _ in 0..400 {
        let slope = Slope::draw(draw, false);
        let (takeoff, landing) = slope.ends();
        let Some(along) = slope.test().segment_hops(&takeoff, &landing) else { continue };
        if !(2..200).contains(&along.hops()) {
            continue;
        }
        let speeds = |split| -> Vec<f64> {
            flown(&slope, along, TakeoffChoice::LeastSpeed, split).iter().map(|h| h.takeoff_speed_m_s).collect()
        };
        let (full, equal) = (speeds(Split::FullReach), speeds(Split::Equal));
        let sum = |v: &[f64]| v.iter().sum::<f64>();
        let energy = |v: &[f64]| v.iter().map(|v| 0.5 * v * v).sum::<f64>();
        let peak = |v: &[f64]| v.iter().copied().fold(0.0, f64::max);
        assert!(sum(&full) <= sum(&equal) * (1.0 + 1e-9));
        assert!(peak(&equal) <= peak(&full) * (1.0 + 1e-9));
        assert!((energy(&full) / energy(&equal) - 1.0).abs() < 1e-8, "{} and {} J/kg", energy(&full), energy(&equal));
        compared += 1;
    }
    assert!(compared > 100, "only {compared}");
}

#[test]
#[expect(clippy::cast_precision_loss, reason = "small counts")]
fn a_run_of_exactly_so_many_reaches_takes_so_many_hops() {
    let draw = &mut Draw::seeded(25);
    for _ in 0..2000 {
        let slope = Slope::draw(draw, false);
        let Some(reach) = slope.test().segment_reach(SegmentId(0), slope.direction) else { continue };
        let count = 1 + draw.below(1000) as u64;
        let hops = |run: f64| reach.hops_over(run).unwrap().hops();
        let exactly = count as f64 * reach.reach_m();
        assert_eq!(hops(exactly), count);
        assert_eq!(hops(exactly * (1.0 + 1.9e-9)), count, "within the speeds' tolerance, v (1 + 1e-9)");
        assert_eq!(hops(exactly * (1.0 + 2.1e-9)), count + 1, "beyond it");
        // The hop test allows each of those hops too.
        let fresh =
            Slope::new(reach.reach_m(), slope.direction.sign() * slope.b, slope.line, slope.hopper, slope.g, slope.direction);
        let (takeoff, landing) = fresh.ends();
        assert!(fresh.test().lofts(&takeoff, &landing).is_ok(), "a hop of one reach, {} m, is refused", reach.reach_m());
    }
}

#[test]
fn pairs_that_the_papers_pseudo_code_loses_are_hopped() {
    let draw = &mut Draw::seeded(26);
    let mut lost = 0;
    for _ in 0..20_000 {
        let slope = Slope::draw(draw, false);
        let (takeoff, landing) = slope.ends();
        let test = slope.test();
        let sight = test.line_of_sight(&takeoff, &landing).unwrap();
        let within_r_max = chta::ballistics::least_takeoff_speed_m_s(sight, slope.g) <= slope.line.takeoff.speed_max_m_s()
            && chta::ballistics::least_landing_speed_m_s(sight, slope.g) <= slope.line.landing.speed_max_m_s();
        if !within_r_max || test.lofts(&takeoff, &landing).is_ok() {
            continue;
        }
        let Some(along) = test.segment_hops(&takeoff, &landing) else { continue };
        assert!(along.hops() >= 2);
        for hop in flown(&slope, along, TakeoffChoice::LeastSpeed, Split::FullReach) {
            let length = hop.run_m();
            assert!(slope.flies(length, hop.takeoff_angle.radians(), 1e-7));
        }
        lost += 1;
    }
    assert!(lost > 50, "only {lost} such pairs drawn");
}

#[test]
fn machine_limits_end_the_reach_where_hand_calculation_says() {
    // Flat, g = 10, 10 m/s, any angle: 10 m at 45 degrees.
    let reach = |hopper: Hopper| {
        let wide = line((-90.0, 90.0), 10.0, (-90.0, 90.0), 10.0);
        let slope = Slope::new(100.0, 0.0, wide, hopper, 10.0, Direction::Forward);
        let reach = slope.test().segment_reach(SegmentId(0), Direction::Forward).unwrap();
        (reach.reach_m(), reach.takeoff_slope().atan().to_degrees(), reach.limit())
    };
    let near = |found: (f64, f64, Limit), length: f64, degrees: f64, limit: &[Limit]| {
        assert!((found.0 - length).abs() < 1e-9 && (found.1 - degrees).abs() < 1e-6 && limit.contains(&found.2), "{found:?}");
    };
    near(reach(Hopper::UNLIMITED), 10.0, 45.0, &[Limit::TakeoffSpeed]);
    // 1 s in the air: 10 sin(theta) / 5 = 1, 30 degrees, 10 sin(60).
    let timed = Hopper::new(HopperLimits { flight_time_max_s: Some(1.0), ..HopperLimits::UNLIMITED }).unwrap();
    near(reach(timed), 75f64.sqrt(), 30.0, &[Limit::FlightTime, Limit::TakeoffSpeed]);
    // Half a metre high: 5 sin^2 = 0.5, 20 sin cos = 6.
    let low = Hopper::new(HopperLimits { apex_height_max_m: Some(0.5), ..HopperLimits::UNLIMITED }).unwrap();
    near(reach(low), 6.0, 0.1f64.sqrt().asin().to_degrees(), &[Limit::ApexHeight, Limit::TakeoffSpeed]);
    // No steeper than 15 degrees: 10 sin(30).
    let flat = Hopper::new(HopperLimits { takeoff_angle_max: Some(Angle::from_degrees(15.0)), ..HopperLimits::UNLIMITED }).unwrap();
    near(reach(flat), 5.0, 15.0, &[Limit::TakeoffSpeed]);
}

#[test]
fn mid_range_hops_fly_the_middle_of_their_own_set() {
    let draw = &mut Draw::seeded(27);
    let mut middles = 0;
    for i in 0..400 {
        let slope = Slope::draw(draw, i % 2 == 0);
        let (takeoff, landing) = slope.ends();
        let test = slope.test();
        let Some(along) = test.segment_hops(&takeoff, &landing) else { continue };
        if along.hops() > 100 {
            continue;
        }
        for hop in flown(&slope, along, TakeoffChoice::MidRange, Split::Equal) {
            // At full reach the set is one point, which rounding may make empty.
            let Some(set) =
                test.takeoff_set(&hop.takeoff.station.unwrap(), &hop.landing.station.unwrap()).and_then(|set| set.angles())
            else {
                continue;
            };
            let middle = 0.5 * (set.min.radians().max(slope.b.atan()) + set.max.radians());
            assert!((hop.takeoff_angle.radians() - middle).abs() < 1e-9, "{} against {middle}", hop.takeoff_angle.radians());
            middles += 1;
        }
    }
    assert!(middles > 500, "only {middles}");
}

#[test]
fn hops_of_full_reach_lie_in_their_own_set_whatever_limit_ends_the_reach() {
    let draw = &mut Draw::seeded(28);
    let mut seen = std::collections::BTreeSet::new();
    for i in 0..2000 {
        let slope = Slope::draw(draw, i % 4 != 0);
        let (takeoff, landing) = slope.ends();
        let test = slope.test();
        let Some(along) = test.segment_hops(&takeoff, &landing) else { continue };
        if !(2..=100).contains(&along.hops()) {
            continue;
        }
        for hop in flown(&slope, along, TakeoffChoice::LeastSpeed, Split::FullReach) {
            let set = test.takeoff_set(&hop.takeoff.station.unwrap(), &hop.landing.station.unwrap()).unwrap();
            let angles = set.angles().unwrap_or_else(|| panic!("{}: {}", along.reach().limit(), set.conflict().unwrap()));
            let angle = hop.takeoff_angle.radians();
            assert!(angles.min.radians() <= angle && angle <= angles.max.radians());
        }
        seen.insert(along.reach().limit());
    }
    assert_eq!(seen.len(), 4, "reaches ended by {seen:?} only");
}
