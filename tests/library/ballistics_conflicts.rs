//! The explanations of a take-off set: the limits that it names as binding or in conflict are those whose removal changes the
//! result.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{Draw, uniform};
use chta::{
    ballistics::Arc,
    chain::{ContactRule, LineConstraints, Station},
    hop::{Conflict, HopTest, TakeoffSet},
    quantity::{Angle, AngleInterval, ChainPoint, SlopeInterval},
    world::{Gravity, Hopper, HopperLimits, Limit},
};

/// One pair in a world with the same limits everywhere, so that each limit can be removed separately.
#[derive(Clone)]
struct Case {
    points: Vec<ChainPoint>,
    line: LineConstraints,
    limits: HopperLimits,
    g: f64,
    reverse: bool,
}

impl Case {
    fn draw(draw: &mut Draw) -> Self {
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let segments = 1 + draw.below(5);
        let points = draw.profile(segments, size);
        let width = points[segments].x_m - points[0].x_m;
        let speed = (g * width).sqrt() * draw.log_uniform(0.8, 3.0);
        let line = draw.line(speed);
        let limits = HopperLimits {
            clearance_m: if draw.chance(0.5) { 0.0 } else { width * draw.log_uniform(1e-4, 1e-1) },
            clearance_rule: draw.clearance_rule(),
            takeoff_angle_min: Some(Angle::from_degrees(draw.uniform(-30.0, 60.0))),
            takeoff_angle_max: Some(Angle::from_degrees(draw.uniform(60.0, 89.0))),
            apex_height_max_m: Some(width * draw.log_uniform(1e-1, 3.0)),
            flight_time_max_s: Some((width / g).sqrt() * draw.log_uniform(0.5, 4.0)),
            ..HopperLimits::UNLIMITED
        };
        Self { points, line, limits, g, reverse: draw.chance(0.5) }
    }

    fn set(&self) -> TakeoffSet {
        let chain = uniform(&self.points, self.line);
        let test = HopTest::new(chain.with_hopper(&Hopper::new(self.limits).unwrap(), Gravity::new(self.g).unwrap()).unwrap());
        let end = |i: usize| -> Station { chain.geometry().station(self.points[i].x_m).unwrap() };
        let last = self.points.len() - 1;
        if self.reverse { test.takeoff_set(&end(last), &end(0)).unwrap() } else { test.takeoff_set(&end(0), &end(last)).unwrap() }
    }

    /// The same case without one limit.
    fn without(&self, limit: Limit) -> Self {
        let mut other = self.clone();
        let open = AngleInterval::from_degrees(-90.0, 90.0);
        let fast = 1e6 * (self.line.takeoff.speed_max_m_s() + self.line.landing.speed_max_m_s());
        match limit {
            Limit::TakeoffCone => other.line.takeoff = ContactRule::new(open, self.line.takeoff.speed_max_m_s()),
            Limit::LandingCone => other.line.landing = ContactRule::new(open, self.line.landing.speed_max_m_s()),
            Limit::TakeoffSpeed => other.line.takeoff = ContactRule::new(self.line.takeoff.angles(), fast),
            Limit::LandingSpeed => other.line.landing = ContactRule::new(self.line.landing.angles(), fast),
            Limit::Terrain => {
                other.points = vec![self.points[0], self.points[self.points.len() - 1]];
                other.limits.clearance_m = 0.0;
            }
            Limit::MechanicalAngle => (other.limits.takeoff_angle_min, other.limits.takeoff_angle_max) = (None, None),
            Limit::ApexHeight => other.limits.apex_height_max_m = None,
            Limit::FlightTime => other.limits.flight_time_max_s = None,
            Limit::TakeoffSpeedMin => other.limits.takeoff_speed_min_m_s = None,
            Limit::TakeoffSpeedLevels => other.limits.takeoff_speed_levels = None,
            Limit::Direction
            | Limit::Stroke
            | Limit::Force
            | Limit::Spin
            | Limit::KeepOut
            | Limit::RestSlope
            | Limit::FootprintSlope
            | Limit::Roughness
            | Limit::Touchdown
            | Limit::Bend
            | Limit::LineOfSight
            | Limit::TakeoffAngleStep
            | Limit::TakeoffSpeedStep
            | Limit::HeadingStep
            | Limit::Layer(_) => {
                panic!("{limit} cannot be removed")
            }
        }
        other
    }
}

const REMOVABLE: [Limit; 8] = [
    Limit::TakeoffCone,
    Limit::LandingCone,
    Limit::TakeoffSpeed,
    Limit::LandingSpeed,
    Limit::Terrain,
    Limit::MechanicalAngle,
    Limit::ApexHeight,
    Limit::FlightTime,
];

#[test]
fn the_binding_limits_move_their_end_and_no_other_limit_does() {
    let draw = &mut Draw::seeded(11);
    let mut lower_seen = std::collections::BTreeSet::new();
    let mut upper_seen = std::collections::BTreeSet::new();
    for _ in 0..6000 {
        let case = Case::draw(draw);
        let set = case.set();
        let (Some(lofts), Some(binding)) = (set.lofts(), set.binding()) else { continue };
        for limit in REMOVABLE {
            let wider = case.without(limit).set().lofts().unwrap();
            assert_eq!(wider.lower < lofts.lower, binding.lower.limit == limit, "lower end without {limit}: {set:?}");
            assert_eq!(wider.upper > lofts.upper, binding.upper.limit == limit, "upper end without {limit}: {set:?}");
        }
        if let Some(vertex) = binding.lower.vertex {
            assert_eq!(binding.lower.limit, Limit::Terrain);
            // Lowering the deciding vertex moves the lower end; lowering any other vertex does not.
            for i in 1..case.points.len() - 1 {
                let mut lowered = case.clone();
                lowered.points[i].z_m -= 1e-3 * (case.points[1].x_m - case.points[0].x_m);
                let lower = lowered.set().lofts().unwrap().lower;
                assert_eq!(lower < lofts.lower, vertex.index() == i, "vertex {i}");
            }
        }
        lower_seen.insert(binding.lower.limit);
        upper_seen.insert(binding.upper.limit);
    }
    assert!(lower_seen.len() >= 6 && upper_seen.len() >= 7, "only {lower_seen:?} below and {upper_seen:?} above were seen");
}

#[test]
fn a_limit_that_refuses_alone_is_the_only_cause() {
    let draw = &mut Draw::seeded(12);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..6000 {
        let case = Case::draw(draw);
        let Some(Conflict::Alone(alone)) = case.set().conflict() else { continue };
        let only_it = REMOVABLE.into_iter().filter(|l| *l != alone.limit).fold(case.clone(), |case, limit| case.without(limit));
        assert!(
            matches!(only_it.set().conflict(), Some(Conflict::Alone(again)) if again.limit == alone.limit),
            "{} alone does not refuse",
            alone.limit
        );
        let without = case.without(alone.limit).set();
        let again = matches!(without.conflict(), Some(Conflict::Alone(other)) if other.limit == alone.limit);
        assert!(!again, "{} is reported after its removal", alone.limit);
        seen.insert(alone.limit);
    }
    for limit in [Limit::TakeoffSpeed, Limit::LandingSpeed, Limit::ApexHeight] {
        assert!(seen.contains(&limit), "{limit} never refused alone");
    }
}

#[test]
fn take_off_speeds_that_leave_no_arc_name_the_speeds_that_the_others_leave() {
    let draw = &mut Draw::seeded(14);
    let mut seen = [0; 2];
    for _ in 0..8000 {
        let mut case = Case::draw(draw);
        let fastest_m_s = case.line.takeoff.speed_max_m_s();
        draw.commands(&mut case.limits, fastest_m_s);
        let Some(Conflict::Commands { limit, other, left_m_s: [least, greatest], nearest_m_s }) = case.set().conflict() else {
            continue;
        };
        assert!(least <= greatest && !(least..=greatest).contains(&nearest_m_s), "{nearest_m_s} of {least} to {greatest}");
        let free = case.without(limit).set();
        assert!(free.conflict().is_none(), "without {limit}: {:?}", free.conflict());
        // Every arc that the others leave has a speed between the two.
        let (sight, lofts) = (free.line_of_sight(), free.lofts().unwrap());
        for i in 0..=20 {
            let top = if lofts.upper.is_finite() { lofts.upper } else { lofts.lower + 10.0 };
            let loft = (lofts.lower + (top - lofts.lower) * f64::from(i) / 20.0).max(1e-12);
            let speed = Arc::new(sight, loft, case.g).takeoff_speed_m_s();
            assert!(least * (1.0 - 1e-12) <= speed && speed <= greatest * (1.0 + 1e-12), "{speed} of {least} to {greatest}");
        }
        let binding = free.binding().unwrap();
        if binding.lower == binding.upper {
            // One limit sets both ends.
            continue;
        }
        // Beyond the end that the other limit sets, the speeds go on towards the nearest one of the machine.
        let end = if other == binding.lower { lofts.lower } else { lofts.upper };
        let beyond = if end == lofts.lower { end * (1.0 - 1e-6) } else { end * (1.0 + 1e-6) };
        let [at, on] = [end, beyond].map(|loft| Arc::new(sight, loft, case.g).takeoff_speed_m_s());
        // At the end nearest to the slowest arc of all, speeds hardly change.
        assert!(
            (on > at) == (nearest_m_s > greatest) || (on / at - 1.0).abs() < 1e-9,
            "{at} goes to {on}, away from {nearest_m_s}"
        );
        seen[usize::from(limit == Limit::TakeoffSpeedLevels)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}

#[test]
fn two_conflicting_limits_have_a_gap_that_shrinks_without_either() {
    let draw = &mut Draw::seeded(13);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..8000 {
        let case = Case::draw(draw);
        let set = case.set();
        let Some(Conflict::Pair { lower, upper, gap_deg }) = set.conflict() else { continue };
        assert!(gap_deg >= 0.0, "a negative gap: {gap_deg} deg");
        let between = SlopeInterval { lower: lower.lofts.lower, upper: upper.lofts.upper };
        assert!(between.is_empty() || between.upper <= 0.0, "{between:?} is left between {} and {}", lower.limit, upper.limit);
        // These two limits still conflict when all others are removed.
        let only_both = REMOVABLE
            .into_iter()
            .filter(|l| *l != lower.limit && *l != upper.limit)
            .fold(case.clone(), |case, limit| case.without(limit))
            .set();
        assert!(only_both.conflict().is_some(), "{} and {} alone do not conflict", lower.limit, upper.limit);
        for limit in [lower.limit, upper.limit].into_iter().filter(|l| *l != Limit::LineOfSight) {
            match case.without(limit).set().conflict() {
                None | Some(Conflict::Alone(_) | Conflict::Commands { .. }) => {}
                Some(Conflict::Pair { gap_deg: smaller, .. }) => {
                    assert!(smaller < gap_deg, "{smaller} deg without {limit}, {gap_deg} deg with it");
                }
            }
        }
        seen.insert((lower.limit, upper.limit));
    }
    assert!(seen.len() >= 15, "only {seen:?}");
}
