//! Compares the estimate with counted flights, and with cases that have a known result.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its chain should stop")]

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use super::*;
use crate::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain},
    quantity::ChainPoint,
    world::{Contact, FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};

const G: f64 = 3.711;

fn chain(points: &[(f64, f64)], friction: f64, landing_speed_max_m_s: f64) -> ConstrainedChain {
    let geometry = PolygonalChain::bare(points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect()).unwrap();
    let hopper = Hopper::with_speeds(10.0, landing_speed_max_m_s).unwrap();
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(friction).unwrap())), rest: RestSlope::AsFrictionHolds };
    ConstrainedChain::new(geometry, &hopper, Gravity::new(3.711).unwrap(), &surface).unwrap()
}

fn planned(test: &HopTest, from_m: f64, to_m: f64, choice: TakeoffChoice) -> PlannedHop {
    let station = |x_m| test.chain().geometry().station(x_m).unwrap();
    let (takeoff, landing) = (station(from_m), station(to_m));
    let lofts = test.lofts(&takeoff, &landing).unwrap();
    let sight = test.line_of_sight(&takeoff, &landing).unwrap();
    PlannedHop { takeoff, landing, arc: Arc::new(sight, choice.loft(sight, lofts), test.gravity_m_s2()), lofts, tolerance_m: None }
}

/// Counts hops towards +x that fail, flown by numerical integration of Newton's equations, without slopes or derivatives.
fn counted(test: &HopTest, hop: &PlannedHop, deviations: &HopDeviations, flights: u32) -> f64 {
    let mut source = ChaCha8Rng::seed_from_u64(5);
    let mut normal = || {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - source.random::<f64>()));
        radius * libm::cos(std::f64::consts::TAU * source.random::<f64>())
    };
    let geometry = test.chain().geometry();
    let failed = (0..flights).filter(|_| {
        let speed = hop.arc.takeoff_speed_m_s() * (1.0 + deviations.takeoff_speed_fraction * normal());
        let angle = hop.arc.takeoff_angle().radians() + deviations.takeoff_angle.radians() * normal();
        let Ok(from) = geometry.station(hop.takeoff.point.x_m + deviations.place_m * normal()) else { return true };
        let within = |station: &Station, contact, angle: f64, speed: f64| {
            test.chain().check_contact(station, contact, Direction::Forward).is_ok_and(|rule| {
                rule.angles().min.radians() <= angle && angle <= rule.angles().max.radians() && speed <= rule.speed_max_m_s()
            })
        };
        if !within(&from, Contact::Takeoff, angle, 0.0) {
            return true;
        }
        let (across, mut up) = (speed * libm::cos(angle), speed * libm::sin(angle));
        let (mut x, mut z) = (from.point.x_m, from.point.z_m);
        let step_s = 8e-3;
        loop {
            let next = (x + across * step_s, z + up * step_s - 0.5 * G * step_s * step_s);
            up -= G * step_s;
            let Ok(ground) = geometry.station(next.0) else { return true };
            if next.1 <= ground.point.z_m {
                let landing = libm::atan2(up, across);
                return !within(&ground, Contact::Landing, landing, libm::hypot(across, up))
                    || hop.tolerance_m.is_some_and(|tolerance_m| (next.0 - hop.landing.point.x_m).abs() > tolerance_m);
            }
            (x, z) = next;
        }
    });
    #[expect(clippy::cast_precision_loss, reason = "some thousands")]
    let share = failed.count() as f64 / f64::from(flights);
    share
}

#[test]
fn the_estimate_agrees_with_counted_flights() {
    let rough = [(0.0, 0.0), (6.0, 0.6), (9.0, 0.2), (14.0, 1.5), (17.0, 1.0), (22.0, 2.0), (26.0, 0.4), (40.0, 0.9)];
    let flat = [(0.0, 0.0), (40.0, 0.0)];
    let small = HopDeviations {
        takeoff_speed_fraction: 0.02,
        takeoff_angle: Angle::from_degrees(1.5),
        place_m: 0.3,
        ..HopDeviations::default()
    };
    let pushed =
        HopDeviations { takeoff_speed_fraction: 0.05, takeoff_angle: Angle::from_degrees(4.0), ..HopDeviations::default() };
    let mut differences = Vec::new();
    for (points, friction, landing_max) in [(&rough[..], 0.9, 10.0), (&rough[..], 0.7, 7.5), (&flat[..], 0.8, 8.0)] {
        let chain = chain(points, friction, landing_max);
        let test = HopTest::new(chain.clone());
        for (from_m, to_m) in [(3.0, 11.0), (5.0, 15.5), (12.0, 20.0), (2.0, 8.0), (20.0, 30.0)] {
            let station = |x_m| chain.geometry().station(x_m).unwrap();
            if test.lofts(&station(from_m), &station(to_m)).is_err() {
                continue;
            }
            for deviations in [small, pushed] {
                for (choice, tolerance_m) in [(TakeoffChoice::MidRange, None), (TakeoffChoice::LeastSpeed, Some(0.8))] {
                    let hop = PlannedHop { tolerance_m, ..planned(&test, from_m, to_m, choice) };
                    let estimate = RiskModel::Deviations(deviations).failure_probability(&test, &hop);
                    let counted = counted(&test, &hop, &deviations, 400);
                    // 400 flights have a standard error of 0.025 at most.
                    differences.push(estimate - counted);
                }
            }
        }
    }
    // On the very edge of both cones the estimate is too pessimistic, since take-off and landing then fail together; a
    // landing at a kink of the ground is evaluated on the straight ground before it.
    let worst = differences.iter().fold(0.0_f64, |worst, difference| worst.max(difference.abs()));
    #[expect(clippy::cast_precision_loss, reason = "some dozens")]
    let mean = differences.iter().map(|difference| difference.abs()).sum::<f64>() / differences.len() as f64;
    assert!(differences.len() > 20 && worst < 0.25 && mean < 0.07, "{worst} {mean} of {}", differences.len());
}

#[test]
fn risk_is_zero_without_deviations_and_grows_with_them() {
    let chain = chain(&[(0.0, 0.0), (20.0, 1.0), (40.0, 0.0)], 0.8, 10.0);
    let test = HopTest::new(chain.clone());
    let hop = planned(&test, 3.0, 14.0, TakeoffChoice::MidRange);
    assert_eq!(RiskModel::Deviations(HopDeviations::default()).failure_probability(&test, &hop), 0.0);
    let at = |scale: f64| {
        let deviations = HopDeviations {
            takeoff_speed_m_s: 0.1 * scale,
            takeoff_angle: Angle::from_degrees(scale),
            place_m: 0.2 * scale,
            friction: 0.02 * scale,
            height_m: 0.05 * scale,
            ..HopDeviations::default()
        };
        RiskModel::Deviations(deviations).failure_probability(&test, &hop)
    };
    let risks = [1.0, 2.0, 4.0, 8.0].map(at);
    assert!(risks.windows(2).all(|pair| pair[0] < pair[1]), "{risks:?}");
}

#[test]
fn a_flat_hop_to_a_goal_misses_as_its_landing_spreads() {
    // 45 degrees over flat ground with open cones: X = v^2 / g, so dX = 2 X dv / v; a tolerance of one standard deviation
    // contains 68.27 %.
    let chain = chain(&[(0.0, 0.0), (60.0, 0.0)], 50.0, 20.0);
    let test = HopTest::new(chain.clone());
    let hop = PlannedHop { tolerance_m: Some(2.0 * 20.0 * 0.01), ..planned(&test, 10.0, 30.0, TakeoffChoice::LeastSpeed) };
    let deviations = HopDeviations { takeoff_speed_fraction: 0.01, ..HopDeviations::default() };
    let failed = RiskModel::Deviations(deviations).failure_probability(&test, &hop);
    assert!((failed - 0.317_310_507_863).abs() < 0.03, "{failed}");
}

#[test]
fn the_cells_have_the_moments_of_the_normal_distribution() {
    let density = |x: f64| libm::exp(-0.5 * x * x) / std::f64::consts::TAU.sqrt();
    let ends = [-40.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 40.0_f64];
    let cells: Vec<_> = cells(1.0).collect();
    for (ends, cell) in ends.windows(2).zip(&cells) {
        let probability = flight::normal(ends[1]) - flight::normal(ends[0]);
        let mean = (density(ends[0]) - density(ends[1])) / probability;
        let square = 1.0 + (ends[0] * density(ends[0]) - ends[1] * density(ends[1])) / probability;
        let found = [cell.probability, cell.mean, cell.sigma * cell.sigma + cell.mean * cell.mean];
        let expected = [probability, mean, square];
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-8),
            "{ends:?}: {found:?} {expected:?}"
        );
    }
    assert!((cells.iter().map(|cell| cell.probability).sum::<f64>() - 1.0).abs() < 1e-9);
}

#[test]
fn a_margin_of_one_degree_on_either_side_is_one_standard_deviation() {
    let chain = chain(&[(0.0, 0.0), (60.0, 0.0)], 50.0, 20.0);
    let test = HopTest::new(chain.clone());
    let hop = planned(&test, 10.0, 30.0, TakeoffChoice::LeastSpeed);
    let around = SlopeInterval { lower: Angle::from_degrees(44.0).slope(), upper: Angle::from_degrees(46.0).slope() };
    let failed = RiskModel::Slack.failure_probability(&test, &PlannedHop { lofts: around, ..hop });
    assert!((failed - 0.317_310_507_863).abs() < 1e-9, "{failed}");
    assert!(RiskModel::Slack.failure_probability(&test, &hop) < 1e-9, "the whole set is wide");
}

#[test]
fn deviations_that_are_no_numbers_are_refused_and_never_a_success() {
    let test = HopTest::new(chain(&[(0.0, 0.0), (40.0, 0.0)], 0.8, 10.0));
    let hop = planned(&test, 3.0, 14.0, TakeoffChoice::MidRange);
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let zero = HopDeviations::default();
        for (what, deviations) in [
            ("takeoff_speed_m_s", HopDeviations { takeoff_speed_m_s: bad, ..zero }),
            ("takeoff_speed_fraction", HopDeviations { takeoff_speed_fraction: bad, ..zero }),
            ("takeoff_angle", HopDeviations { takeoff_angle: Angle::from_radians(bad), ..zero }),
            ("place_m", HopDeviations { place_m: bad, ..zero }),
            ("friction", HopDeviations { friction: bad, ..zero }),
            ("height_m", HopDeviations { height_m: bad, ..zero }),
        ] {
            let model = RiskModel::Deviations(deviations);
            assert_eq!(model.check().unwrap_err().what, what, "{bad}");
            assert_eq!(model.failure_probability(&test, &hop), 1.0, "{what} {bad}");
        }
    }
    assert!(RiskModel::Slack.check().is_ok() && !RiskModel::Slack.tells_nothing());
}
