//! Trials in any direction: against the closed form on level ground, flight by flight, and cell by cell.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its scene stops")]
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small counts, cells of a map"
)]

use chta::{
    ground::DemGround,
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    uncertainty::{DriftCommand, RestDensity, Simulation, SimulationError, TrialOptions, TrialOutcome, Uncertainty},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};

use crate::fly::plans::Listener;

/// Posts 1 m apart; `height` of a post at (x, y).
fn ground(side: usize, height: impl Fn(f64, f64) -> f64, gravity_m_s2: f64) -> DemGround {
    let map = GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap();
    let heights = (0..side * side).map(|post| height((post % side) as f64, -((post / side) as f64))).collect();
    let dem = Dem::new(side, side, heights, map).unwrap();
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.5).unwrap())), rest: RestSlope::AsFrictionHolds };
    let hopper = Hopper::with_speeds(99.0, 99.0).unwrap();
    DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(gravity_m_s2).unwrap(), &surface)
}

/// The command that goes so far on level ground.
fn command(range_m: f64, angle_deg: f64, gravity_m_s2: f64, hops: u32) -> DriftCommand {
    let takeoff_angle = Angle::from_degrees(angle_deg);
    let takeoff_speed_m_s = (range_m * gravity_m_s2 / (2.0 * takeoff_angle.radians()).sin()).sqrt();
    DriftCommand { takeoff_speed_m_s, takeoff_angle, hops }
}

const TRIALS: u64 = 6_000;

fn options() -> TrialOptions {
    TrialOptions { trials: TRIALS, seed: 7, ..TrialOptions::default() }
}

/// One hop ends on a circle of radius R, anywhere on it with the same probability; after two, E d^2 = 2 R^2, and the distance is below R where
/// the second heading turns by more than 120 degrees, in one of three trials.
#[test]
fn on_level_ground_hops_end_on_a_circle_and_two_of_them_as_a_walk_of_two_steps() {
    for (gravity_m_s2, angle_deg) in [(1e-5, 45.0), (1.6, 40.0), (25.0, 70.0)] {
        let (start, range_m) = (MapPoint::new(50.0, -50.0), 12.0);
        let simulation = Simulation::drifting(
            &ground(101, |_, _| 3.0, gravity_m_s2),
            start,
            command(range_m, angle_deg, gravity_m_s2, 2),
            Uncertainty::NONE,
        )
        .unwrap();
        let mut kept = Listener::default();
        let summary = simulation.run(&options(), &mut kept, &()).unwrap();
        assert_eq!(summary.outcomes.of(TrialOutcome::Reached), TRIALS);
        let n = TRIALS as f64;
        let (mut sectors, mut sums, mut squares, mut near) = ([0.0; 12], [0.0; 2], 0.0, 0.0);
        for hop in &kept.hops {
            let away = hop.rest_m.xy() - start;
            if hop.hop == 1 {
                assert!((away.norm() - range_m).abs() < 1e-6 * range_m, "{away} for {gravity_m_s2}");
                let turn = away.x.atan2(away.y).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
                sectors[(turn * 12.0) as usize % 12] += 1.0;
                sums = [sums[0] + away.x / range_m, sums[1] + away.y / range_m];
            } else {
                squares += away.norm_squared() / (range_m * range_m);
                near += f64::from(u8::from(away.norm() < range_m));
            }
        }
        // Five deviations of a mean of sines; the quantile 0.99999 of chi squared with 11 degrees of freedom is 45.
        assert!(sums.iter().all(|sum| sum.abs() < 5.0 * (0.5 * n).sqrt()), "{sums:?}");
        let chi2: f64 = sectors.iter().map(|count| (count - n / 12.0).powi(2) / (n / 12.0)).sum();
        assert!(chi2 < 45.0, "{chi2}");
        // d^2 = 2 R^2 (1 + cos t) has the deviation sqrt(2) R^2.
        assert!((squares / n - 2.0).abs() < 5.0 * (2.0 / n).sqrt(), "{}", squares / n);
        assert!((near / n - 1.0 / 3.0).abs() < 5.0 * (2.0 / 9.0 / n).sqrt(), "{}", near / n);
    }
}

/// Over craters every flight is flown again from its take-off, cells are counted again from the landings, and two halves are the whole.
#[test]
fn every_flight_is_that_of_its_command_and_every_cell_counts_its_rests() {
    let rough = |x: f64, y: f64| 2.0 * (0.31 * x).sin() * (0.23 * y).cos();
    let ground = ground(61, rough, 1.6);
    let start = MapPoint::new(30.3, -29.6);
    let errors = Uncertainty { takeoff_speed_sigma_fraction: 0.05, drift_along_sigma_m: 0.2, ..Uncertainty::NONE };
    let simulation = Simulation::drifting(&ground, start, command(8.0, 50.0, 1.6, 3), errors).unwrap();
    let mut kept = Listener::default();
    let summary = simulation.run(&options(), &mut kept, &()).unwrap();
    for hop in kept.hops.iter().take(2_000) {
        let liftoff = chta::uncertainty::LiftoffVelocity {
            heading: hop.heading,
            horizontal_m_s: hop.horizontal_m_s,
            vertical_m_s: hop.takeoff_vertical_m_s,
        };
        let flown = simulation.fly(hop.takeoff_m.xy(), liftoff).unwrap();
        assert!(flown.landed == hop.landed && (flown.at_m.xy() - hop.contact_m.xy()).norm() < 1e-6, "{hop:?}");
    }
    let mut density = RestDensity::over(&ground, 3, None);
    let again = simulation.run(&options(), &mut density, &()).unwrap();
    assert_eq!(again, summary);
    let ends = density.ends();
    let landed: Vec<bool> = kept
        .trials
        .iter()
        .map(|trial| kept.hops.iter().rfind(|hop| hop.trial == trial.trial).is_none_or(|hop| hop.landed))
        .collect();
    let mut counts = vec![0.0; 61 * 61];
    for (trial, _) in kept.trials.iter().zip(&landed).filter(|(_, landed)| **landed) {
        counts[(-trial.end_m.y).round() as usize * 61 + trial.end_m.x.round() as usize] += 1.0;
    }
    for (cell, (share, count)) in ends.iter().zip(&counts).enumerate() {
        assert!((share * TRIALS as f64 - count).abs() < 1e-6, "cell {cell}: {share} for {count}");
    }
    let kinds = summary.outcomes.each().filter(|(_, count)| *count > 0).count();
    assert!(kinds > 2, "trials end in several ways: {:?}", summary.outcomes);
    let half = |first_trial| TrialOptions { first_trial, trials: TRIALS / 2, ..options() };
    let mut tally = simulation.tally(&half(0), &mut (), &()).unwrap();
    tally.merge(&simulation.tally(&half(TRIALS / 2), &mut (), &()).unwrap()).unwrap();
    assert_eq!(tally.summary().outcomes, summary.outcomes);
}

#[test]
fn what_cannot_drift_is_refused() {
    let flat = ground(11, |_, _| 0.0, 1.6);
    let refused = |at: MapPoint, command: DriftCommand| Simulation::drifting(&flat, at, command, Uncertainty::NONE).unwrap_err();
    let usual = command(2.0, 45.0, 1.6, 1);
    assert!(matches!(refused(MapPoint::new(99.0, 0.0), usual), SimulationError::NoGround { .. }));
    assert!(matches!(refused(MapPoint::new(5.0, -5.0), DriftCommand { hops: 0, ..usual }), SimulationError::NoHops));
    for takeoff_speed_m_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refusal = refused(MapPoint::new(5.0, -5.0), DriftCommand { takeoff_speed_m_s, ..usual });
        assert!(matches!(refusal, SimulationError::CommandedSpeed { .. }), "{refusal}");
        assert!(refusal.to_string().ends_with("expected a finite number above 0"), "{refusal}");
    }
}
