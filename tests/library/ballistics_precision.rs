//! Every limit of single hops against 60-digit arithmetic: `data/validation/hop_limits.py` and the table it wrote.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a broken table fails the test; quantiles are for the report")]

use std::collections::HashMap;

use crate::support::{line, quantile, uniform};
use chta::{
    ballistics::TakeoffChoice,
    chain::ConstrainedChain,
    hop::{HopTest, TakeoffSet},
    quantity::{Angle, AngleInterval, ChainPoint},
    world::{ClearanceRule, Gravity, Hopper, HopperLimits, Limit},
};

const TABLE: &str = include_str!("../../data/validation/hop_limits.csv");

/// One row: fields by column name.
struct Case(HashMap<&'static str, &'static str>);

impl Case {
    /// A number; `None` where blank or absent.
    fn number(&self, column: &str) -> Option<f64> {
        match self.0[column] {
            "" | "absent" => None,
            text => Some(text.parse().unwrap()),
        }
    }

    fn input(&self, column: &str) -> f64 {
        self.number(column).unwrap_or_else(|| panic!("no {column}"))
    }

    fn hopper(&self) -> Hopper {
        Hopper::new(HopperLimits {
            clearance_m: self.input("clearance_m"),
            // The equation of the paper, whose cases these are.
            clearance_rule: ClearanceRule::Vertex,
            takeoff_angle_min: self.number("mechanical_min_deg").map(Angle::from_degrees),
            takeoff_angle_max: self.number("mechanical_max_deg").map(Angle::from_degrees),
            apex_height_max_m: self.number("apex_height_max_m"),
            flight_time_max_s: self.number("flight_time_max_s"),
            ..HopperLimits::UNLIMITED
        })
        .unwrap()
    }

    /// The chain of take-off, vertex and landing, sorted by x.
    fn chain(&self) -> ConstrainedChain {
        let point = |name: &str| {
            let x = self.number(&format!("{name}_x_m"))?;
            Some(ChainPoint::new(x, self.input(&format!("{name}_z_m"))))
        };
        let mut points: Vec<_> = ["takeoff", "vertex", "landing"].into_iter().filter_map(point).collect();
        points.sort_by(|a, b| a.x_m.total_cmp(&b.x_m));
        let cone = |name: &str| (self.input(&format!("{name}_min_deg")), self.input(&format!("{name}_max_deg")));
        let speed = |name: &str| self.input(&format!("{name}_speed_max_m_s"));
        uniform(&points, line(cone("takeoff"), speed("takeoff"), cone("landing"), speed("landing")))
    }

    /// The library's result.
    fn answer(&self) -> TakeoffSet {
        let chain = self.chain();
        let test = HopTest::new(chain.with_hopper(&self.hopper(), Gravity::new(self.input("gravity_m_s2")).unwrap()).unwrap());
        let at = |name: &str| chain.geometry().station(self.input(&format!("{name}_x_m"))).unwrap();
        test.takeoff_set(&at("takeoff"), &at("landing")).unwrap()
    }
}

fn cases() -> Vec<Case> {
    let mut lines = TABLE.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(|line| Case(header.iter().copied().zip(line.split(',')).collect())).collect()
}

/// The larger of the errors of both ends; asserts that both sides are empty or neither is.
fn error_rad(case: &Case, name: &str, found: Option<AngleInterval>) -> Option<f64> {
    let expected = (case.number(&format!("{name}_min_rad")), case.number(&format!("{name}_max_rad")));
    match (expected, found) {
        ((Some(min), Some(max)), Some(found)) => Some((min - found.min.radians()).abs().max((max - found.max.radians()).abs())),
        ((None, None), None) => None,
        _ => panic!("{name}: expected {expected:?}, found {found:?} in {:?}", case.0),
    }
}

#[test]
fn every_limit_and_the_intersection_agree_with_60_digits_to_a_nanoradian() {
    let mut errors: HashMap<&str, Vec<f64>> = HashMap::new();
    let cases = cases();
    assert_eq!(cases.len(), 1000);
    for case in &cases {
        let set = case.answer();
        for limit in set.limits().iter().filter(|l| l.limit != Limit::LineOfSight) {
            let name = limit.limit.name();
            if case.0[format!("{name}_min_rad").as_str()] == "absent" {
                assert!(limit.limit == Limit::Terrain && limit.vertex.is_none(), "a limit {name} that was not set");
                continue;
            }
            errors.entry(name).or_default().extend(error_rad(case, name, set.angles_of(limit.lofts)));
        }
        errors.entry("all").or_default().extend(error_rad(case, "all", set.angles()));
    }
    assert_eq!(errors.len(), 9, "eight limits and their intersection");
    for (name, values) in &mut errors {
        assert!(values.len() > 200, "only {} cases of {name}", values.len());
        let [median, q99, max] = [0.5, 0.99, 1.0].map(|share| quantile(values, share));
        println!("{name:>16}: {:5} intervals, median {median:.1e}, q99 {q99:.1e}, max {max:.1e} rad", values.len());
        assert!(median < 1e-12 && q99 < 1e-10 && max < 1e-9, "{name}: median {median:e}, q99 {q99:e}, max {max:e} rad");
    }
}

#[test]
fn chosen_arcs_agree_with_60_digits_to_a_billionth() {
    let choices = [
        (TakeoffChoice::LeastSpeed, "least_speed"),
        (TakeoffChoice::MidRange, "mid_range"),
        (TakeoffChoice::LeastTime, "least_time"),
    ];
    for (choice, name) in choices {
        let mut errors = Vec::new();
        for case in &cases() {
            let g = case.input("gravity_m_s2");
            let expected = |what: &str| case.number(&format!("{name}_{what}"));
            let Some(arc) = case.answer().arc(choice, g) else {
                assert_eq!(expected("flight_time_s"), None, "{name} in {:?}", case.0);
                continue;
            };
            let pairs = [
                (arc.takeoff_speed_m_s(), "takeoff_speed_m_s"),
                (arc.landing_speed_m_s(), "landing_speed_m_s"),
                (arc.flight_time_s(), "flight_time_s"),
            ];
            for (found, what) in pairs {
                let error = (found / expected(what).unwrap() - 1.0).abs();
                assert!(error < 1e-9, "{name}, {what}: off by {error:e} in {:?}", case.0);
                errors.push(error);
            }
        }
        let [median, q99, max] = [0.5, 0.99, 1.0].map(|share| quantile(&mut errors, share));
        println!("{name:>12}: {} numbers, median {median:.1e}, q99 {q99:.1e}, max {max:.1e}", errors.len());
        assert!(errors.len() > 700 && median < 1e-14 && q99 < 1e-10, "{name}: median {median:e}, q99 {q99:e}");
    }
}
