//! Compares the estimate with counted flights of its own, with closed forms, and with itself over the same ground described otherwise.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its chain should stop")]

use std::fmt::Write as _;

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use super::*;
use crate::{
    chain::{ConstrainedChain, PolygonalChain, csv::read_measured_csv},
    flight::{ErrorKey, MeasuredErrors},
    quantity::ChainPoint,
    world::{Contact, FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};

const G: f64 = 3.711;

/// What is scaled and mirrored in the tests of symmetry.
#[derive(Clone, Copy)]
struct Frame {
    scale: f64,
    shift_m: f64,
    sign: f64,
}

const PLAIN: Frame = Frame { scale: 1.0, shift_m: 0.0, sign: 1.0 };

fn test_over(points: &[(f64, f64)], friction: f64, landing_speed_max_m_s: f64, frame: Frame) -> HopTest {
    let Frame { scale, shift_m, sign } = frame;
    let mut points: Vec<ChainPoint> = points.iter().map(|&(x, z)| ChainPoint::new(shift_m + sign * scale * x, scale * z)).collect();
    points.sort_by(|a, b| a.x_m.total_cmp(&b.x_m));
    let hopper = Hopper::with_speeds(10.0 * scale.sqrt(), landing_speed_max_m_s * scale.sqrt()).unwrap();
    let grip = Some(Grip::Friction(FrictionCone::new(friction).unwrap()));
    let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
    let chain = ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper, Gravity::new(G).unwrap(), &surface).unwrap();
    HopTest::new(chain)
}

fn scatter() -> Uncertainty {
    Uncertainty {
        takeoff_speed_sigma_fraction: 0.02,
        takeoff_angle_sigma: Angle::from_degrees(1.5),
        position_sigma_m: 0.3,
        ..Uncertainty::NONE
    }
}

/// A hop of a test, judged.
struct Case<'a> {
    test: &'a HopTest,
    errors: Uncertainty,
    choice: TakeoffChoice,
    tolerance_m: Option<f64>,
}

impl Case<'_> {
    fn judge(&self) -> Judge {
        let options = SearchOptions { takeoff: self.choice, ..SearchOptions::default() };
        let model = RiskModel::Flown { errors: self.errors.clone(), takeoffs: TakeoffScatter::OfPosition, over: None, whole: None };
        Judge::new(self.test, &options, &model, self.tolerance_m)
    }

    fn planned(&self, from_m: f64, to_m: f64) -> Option<Planned> {
        let geometry = self.test.chain().geometry();
        let [takeoff, landing] = [from_m, to_m].map(|x_m| geometry.station(x_m).unwrap());
        let lofts = self.test.lofts(&takeoff, &landing).ok()?;
        let sight = self.test.line_of_sight(&takeoff, &landing)?;
        let takeoff_m2 = [self.errors.position_sigma_m * self.errors.position_sigma_m; 2];
        Some(Planned { takeoff, landing, sight, lofts, takeoff_m2, is_last: true })
    }

    /// The share of draws that fail.
    fn failing(&self, from_m: f64, to_m: f64) -> Option<f64> {
        let planned = self.planned(from_m, to_m)?;
        let judge = self.judge();
        let loft = self.test.loft(self.choice, planned.sight, planned.lofts);
        let Survival { of, failed, .. } = judge.survival(&planned, loft, u32::MAX);
        Some(f64::from(failed) / f64::from(of))
    }

    /// Counts hops towards +x that fail, flown by numerical integration of Newton's equations, without slopes or closed forms.
    fn counted(&self, from_m: f64, to_m: f64, flights: u32) -> f64 {
        let planned = self.planned(from_m, to_m).unwrap();
        let (test, errors) = (self.test, &self.errors);
        let arc = Arc::new(planned.sight, test.loft(self.choice, planned.sight, planned.lofts), G);
        let mut source = ChaCha8Rng::seed_from_u64(5);
        let normal = |source: &mut ChaCha8Rng| {
            let radius = libm::sqrt(-2.0 * libm::log(1.0 - source.random::<f64>()));
            radius * libm::cos(std::f64::consts::TAU * source.random::<f64>())
        };
        let standard = |source: &mut ChaCha8Rng| match errors.distribution {
            Distribution::Normal => normal(source),
            Distribution::Uniform => 12.0_f64.sqrt() * (source.random::<f64>() - 0.5),
        };
        let geometry = test.chain().geometry();
        let failed = (0..flights).filter(|_| {
            let mut fraction = errors.takeoff_speed_sigma_fraction * standard(&mut source);
            let mut turned = errors.takeoff_angle_sigma.radians() * standard(&mut source);
            let along_m = errors.position_sigma_m * standard(&mut source);
            if errors.has(ErrorKey::TakeoffSpeedBias) || errors.has(ErrorKey::TakeoffAngleBias) {
                fraction += errors.takeoff_speed_bias_sigma_fraction * standard(&mut source);
                turned += errors.takeoff_angle_bias_sigma.radians() * standard(&mut source);
            }
            let row = errors.measured.as_ref().map(|measured| measured.row(source.random()));
            let (of_row, turned_of_row) = row.map_or((0.0, 0.0), |row| (row.speed_fraction, row.angle_rad));
            let speed = arc.takeoff_speed_m_s() * (1.0 + fraction + of_row);
            let angle = arc.takeoff_angle().radians() + turned + turned_of_row;
            let (first_m, last_m) = geometry.extent_m();
            let from_m = (planned.takeoff.point.x_m + along_m).clamp(first_m, last_m);
            let from = geometry.station(from_m).unwrap();
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
            let step_s = 4e-3;
            loop {
                let next = (x + across * step_s, z + up * step_s - 0.5 * G * step_s * step_s);
                up -= G * step_s;
                let Ok(ground) = geometry.station(next.0) else { return true };
                if next.1 <= ground.point.z_m {
                    let landing = libm::atan2(up, across);
                    return !within(&ground, Contact::Landing, landing, libm::hypot(across, up))
                        || self.tolerance_m.is_some_and(|tolerance_m| (next.0 - planned.landing.point.x_m).abs() > tolerance_m);
                }
                (x, z) = next;
            }
        });
        #[expect(clippy::cast_precision_loss, reason = "some thousands")]
        let share = failed.count() as f64 / f64::from(flights);
        share
    }
}

const ROUGH: [(f64, f64); 8] =
    [(0.0, 0.0), (6.0, 0.6), (9.0, 0.2), (14.0, 1.5), (17.0, 1.0), (22.0, 2.0), (26.0, 0.4), (40.0, 0.9)];
const FLAT: [(f64, f64); 2] = [(0.0, 0.0), (40.0, 0.0)];
const HOPS: [(f64, f64); 5] = [(3.0, 11.0), (5.0, 15.5), (12.0, 20.0), (2.0, 8.0), (20.0, 30.0)];

/// The differences of estimate and count over all hops, grounds, commands and tolerances.
fn differences(all_errors: &[Uncertainty]) -> Vec<f64> {
    let mut differences = Vec::new();
    for (points, friction, landing_max) in [(&ROUGH[..], 0.9, 10.0), (&ROUGH[..], 0.7, 7.5), (&FLAT[..], 0.8, 8.0)] {
        let test = test_over(points, friction, landing_max, PLAIN);
        for errors in all_errors {
            for (choice, tolerance_m) in [(TakeoffChoice::MidRange, None), (TakeoffChoice::LeastSpeed, Some(0.8))] {
                let case = Case { test: &test, errors: errors.clone(), choice, tolerance_m };
                for (from_m, to_m) in HOPS {
                    let Some(estimate) = case.failing(from_m, to_m) else { continue };
                    differences.push(estimate - case.counted(from_m, to_m, 1600));
                }
            }
        }
    }
    differences
}

/// The greatest difference by size, and the mean of the sizes.
fn worst_and_mean(differences: &[f64]) -> (f64, f64) {
    let worst = differences.iter().fold(0.0_f64, |worst, difference| worst.max(difference.abs()));
    #[expect(clippy::cast_precision_loss, reason = "some dozens")]
    let mean = differences.iter().map(|difference| difference.abs()).sum::<f64>() / differences.len() as f64;
    (worst, mean)
}

#[test]
fn the_estimate_agrees_with_counted_flights() {
    let pushed =
        Uncertainty { takeoff_speed_sigma_fraction: 0.05, takeoff_angle_sigma: Angle::from_degrees(4.0), ..Uncertainty::NONE };
    let differences = differences(&[scatter(), pushed]);
    let (worst, mean) = worst_and_mean(&differences);
    // 1600 flights have a standard error of at most 0.0125, 64 fixed draws an error of some 0.02.
    assert!(differences.len() > 20 && worst < 0.07 && mean < 0.018, "{worst} {mean} of {}", differences.len());
}

/// Rows that a test stand might have: what is too fast is also too steep.
fn measured(rows: u32) -> Uncertainty {
    let mut source = ChaCha8Rng::seed_from_u64(9);
    let mut text = "takeoff_angle_error_deg,takeoff_speed_error_fraction\n".to_owned();
    for _ in 0..rows {
        let common: f64 = source.random::<f64>() - 0.4;
        let own: f64 = source.random::<f64>() - 0.5;
        writeln!(text, "{},{}", 5.0 * common + own, 0.07 * common).unwrap();
    }
    let file = read_measured_csv(text.as_bytes()).unwrap();
    Uncertainty { measured: Some(MeasuredErrors::of(&file)), ..Uncertainty::NONE }
}

#[test]
fn the_estimate_of_biases_uniform_and_measured_errors_agrees_with_counted_flights() {
    let uniform = Uncertainty { distribution: Distribution::Uniform, ..scatter() };
    let biased = Uncertainty {
        takeoff_speed_bias_sigma_fraction: 0.02,
        takeoff_angle_bias_sigma: Angle::from_degrees(1.5),
        position_sigma_m: 0.3,
        ..Uncertainty::NONE
    };
    let both = Uncertainty { takeoff_speed_sigma_fraction: 0.03, distribution: Distribution::Uniform, ..biased.clone() };
    // Rows are one number of a draw, along which 64 draws are spread evenly: speed is, and what the rows have beside it is less.
    for (what, errors, mean_most) in [
        ("uniform", uniform, 0.02),
        ("biased", biased, 0.02),
        ("both", both, 0.02),
        ("12 measured hops", measured(12), 0.03),
        ("500 measured hops", measured(500), 0.03),
    ] {
        let differences = differences(&[errors]);
        let (worst, mean) = worst_and_mean(&differences);
        assert!(differences.len() > 10 && worst < 0.1 && mean < mean_most, "{what}: {worst} {mean} of {}", differences.len());
    }
}

#[test]
fn a_bias_alone_fails_a_hop_as_an_error_of_its_own_of_the_same_size() {
    let test = test_over(&[(0.0, 0.0), (60.0, 0.0)], 50.0, 20.0, PLAIN);
    let biased = Uncertainty { takeoff_speed_bias_sigma_fraction: 0.01, ..Uncertainty::NONE };
    let case = Case { test: &test, errors: biased, choice: TakeoffChoice::LeastSpeed, tolerance_m: Some(2.0 * 20.0 * 0.01) };
    // As for independent errors: 68.27 % are within one standard deviation of the landing.
    let failed = case.failing(10.0, 30.0).unwrap();
    assert!((failed - 0.317_310_507_863).abs() < 0.5 / 64.0 + 0.01, "{failed}");
    // Uniform: 1 - 1/sqrt(3) are beyond one standard deviation, and none beyond sqrt(3) of them.
    let uniform = Uncertainty { distribution: Distribution::Uniform, ..case.errors.clone() };
    for (sigmas, share) in [(1.0, 1.0 - 1.0 / 3.0_f64.sqrt()), (1.76, 0.0)] {
        let case = Case { errors: uniform.clone(), tolerance_m: Some(sigmas * 2.0 * 20.0 * 0.01), ..case };
        let failed = case.failing(10.0, 30.0).unwrap();
        assert!((failed - share).abs() < 0.5 / 64.0 + 0.01, "{sigmas}: {failed}");
    }
}

#[test]
fn a_flat_hop_to_a_goal_misses_as_its_landing_spreads() {
    // 45 degrees over flat ground with open cones: X = v^2 / g, so dX = 2 X dv / v; a tolerance of one standard deviation
    // contains 68.27 %.
    let test = test_over(&[(0.0, 0.0), (60.0, 0.0)], 50.0, 20.0, PLAIN);
    let errors = Uncertainty { takeoff_speed_sigma_fraction: 0.01, ..Uncertainty::NONE };
    let case = Case { test: &test, errors, choice: TakeoffChoice::LeastSpeed, tolerance_m: Some(2.0 * 20.0 * 0.01) };
    let failed = case.failing(10.0, 30.0).unwrap();
    assert!((failed - 0.317_310_507_863).abs() < 0.5 / 64.0 + 0.01, "{failed}");
}

#[test]
fn a_hop_without_errors_is_certain_and_its_risk_grows_with_them() {
    let test = test_over(&[(0.0, 0.0), (20.0, 1.0), (40.0, 0.0)], 0.8, 10.0, PLAIN);
    let weight = |factor: f64| {
        let errors = Uncertainty { friction_sigma: 0.02, height_sigma_m: 0.03, height_correlation_m: 3.0, ..scatter() };
        let case = Case { test: &test, errors: errors.scaled(factor), choice: TakeoffChoice::MidRange, tolerance_m: None };
        let planned = case.planned(3.0, 14.0).unwrap();
        case.judge().weighed(&planned, test.loft(TakeoffChoice::MidRange, planned.sight, planned.lofts), f64::INFINITY).weight
    };
    // All draws survive: (64 + 1/2) / 65.
    assert!((weight(0.0) + libm::log(64.5 / 65.0)).abs() < 1e-15, "{}", weight(0.0));
    let weights = [1.0, 2.0, 4.0, 8.0].map(weight);
    assert!(weights.windows(2).all(|pair| pair[0] < pair[1]), "{weights:?}");
}

#[test]
fn collinear_vertices_scale_shift_and_mirror_change_no_bit() {
    // Coordinates that powers of two and halving keep exact.
    let ground = [(0.0, 0.0), (8.0, 0.5), (12.0, 0.25), (20.0, 1.75), (28.0, 1.0), (40.0, 1.0)];
    let split: Vec<(f64, f64)> = ground
        .windows(2)
        .flat_map(|pair| {
            let [(ax, az), (bx, bz)] = [pair[0], pair[1]];
            [(ax, az), (0.75 * ax + 0.25 * bx, 0.75 * az + 0.25 * bz), (0.5 * (ax + bx), 0.5 * (az + bz))]
        })
        .chain([ground[5]])
        .collect();
    let frames = [
        ("the same ground with more vertices", &split[..], PLAIN),
        ("scaled by 4", &ground[..], Frame { scale: 4.0, ..PLAIN }),
        ("shifted by 64 m", &ground[..], Frame { shift_m: 64.0, ..PLAIN }),
        ("mirrored", &ground[..], Frame { sign: -1.0, ..PLAIN }),
    ];
    let plain = test_over(&ground, 0.8, 8.0, PLAIN);
    let mut compared = 0;
    for choice in TakeoffChoice::ALL {
        for (from_m, to_m) in [(3.0, 11.0), (5.0, 15.5), (13.0, 21.0), (2.0, 8.0), (20.0, 30.0)] {
            let case = Case { test: &plain, errors: scatter(), choice, tolerance_m: Some(0.5) };
            let Some(expected) = case.failing(from_m, to_m) else { continue };
            for (what, points, frame) in frames {
                let other = test_over(points, 0.8, 8.0, frame);
                let errors = Uncertainty { position_sigma_m: 0.3 * frame.scale, ..scatter() };
                let case = Case { test: &other, errors, choice, tolerance_m: Some(0.5 * frame.scale) };
                let at = |x_m: f64| frame.shift_m + frame.sign * frame.scale * x_m;
                assert_eq!(case.failing(at(from_m), at(to_m)), Some(expected), "{what}: {choice:?} from {from_m} to {to_m}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 40, "only {compared} hops");
}

#[test]
fn the_most_reliable_command_fails_no_more_often_than_the_others() {
    let test = test_over(&ROUGH, 0.8, 8.5, PLAIN);
    let mut gained = 0;
    for (from_m, to_m) in HOPS {
        let of = |choice| Case { test: &test, errors: scatter(), choice, tolerance_m: None };
        let Some(planned) = of(TakeoffChoice::MostReliable).planned(from_m, to_m) else { continue };
        let judge = of(TakeoffChoice::MostReliable).judge();
        let chosen = judge.single((&planned.takeoff, &planned.landing), planned.lofts, planned.takeoff_m2, true, f64::INFINITY);
        let chosen = judge.survival(&planned, chosen.loft.unwrap(), u32::MAX).failed;
        for choice in [TakeoffChoice::LeastSpeed, TakeoffChoice::MidRange] {
            let other = judge.survival(&planned, test.loft(choice, planned.sight, planned.lofts), u32::MAX).failed;
            // A least-speed command may lie between two of the nine angles.
            assert!(chosen <= other + 1, "{choice:?} from {from_m} to {to_m}: {chosen} and {other}");
            gained += u32::from(chosen < other);
        }
    }
    assert!(gained > 2, "the choice gained nothing: {gained}");
}

#[test]
fn a_margin_of_one_degree_on_either_side_is_one_standard_deviation() {
    let test = test_over(&[(0.0, 0.0), (60.0, 0.0)], 50.0, 20.0, PLAIN);
    let case = Case { test: &test, errors: Uncertainty::NONE, choice: TakeoffChoice::LeastSpeed, tolerance_m: None };
    let planned = case.planned(10.0, 30.0).unwrap();
    let loft = test.loft(TakeoffChoice::LeastSpeed, planned.sight, planned.lofts);
    let around = SlopeInterval { lower: Angle::from_degrees(44.0).slope(), upper: Angle::from_degrees(46.0).slope() };
    let success = slack_success(&Planned { lofts: around, ..planned }, loft);
    assert!((success - 0.682_689_492_137).abs() < 1e-9, "{success}");
    assert!(slack_success(&planned, loft) > 1.0 - 1e-9, "the whole set is wide");
}

#[test]
fn errors_that_are_no_numbers_are_refused() {
    let refused =
        |errors| RiskModel::Flown { errors, takeoffs: TakeoffScatter::OfPosition, over: None, whole: None }.check().is_err();
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        assert!(refused(Uncertainty { takeoff_speed_sigma_m_s: bad, ..Uncertainty::NONE }), "{bad}");
        assert!(refused(Uncertainty { height_sigma_m: bad, height_correlation_m: 1.0, ..Uncertainty::NONE }), "{bad}");
    }
    assert!(RiskModel::Slack.check().is_ok() && !refused(scatter()));
    assert!(!RiskModel::Slack.distinguishes_no_hops());
}
