//! Without errors, trials follow the plan; with errors, their necessary consequences.

use chta::uncertainty::{HopRecord, Observer, Policy, Summary, TrialOptions, TrialOutcome, TrialRecord, Uncertainty};

use super::scene::{Planned, Scene, each_error};

/// Collects all records.
#[derive(Default)]
pub(crate) struct Listener {
    pub(crate) hops: Vec<HopRecord>,
    pub(crate) trials: Vec<TrialRecord>,
}

impl Observer for Listener {
    fn wants_records(&self) -> bool {
        true
    }

    fn hop(&mut self, hop: &HopRecord) {
        self.hops.push(*hop);
    }

    fn trial(&mut self, trial: &TrialRecord) {
        self.trials.push(*trial);
    }
}

pub(crate) fn exactly_planned(planned: &Planned<'_>, policy: Policy) {
    let mut listener = Listener::default();
    let options = TrialOptions { trials: 3, policy, goal_tolerance_m: 0.0, ..TrialOptions::default() };
    let summary = planned.simulation(Uncertainty::NONE).run(&options, &mut listener, &()).unwrap();
    assert_eq!(summary.outcomes.of(TrialOutcome::Reached), 3, "{:?} {:?}", summary.outcomes, listener.hops.last());
    let hops = planned.path.hops.len();
    assert!(hops >= 1);
    assert_eq!(listener.hops.len(), 3 * hops);
    for (i, flown) in listener.hops.iter().enumerate() {
        let plan = &planned.path.hops[i % hops];
        let place = match plan.landing.map() {
            Some(map) if planned.scene.dem.is_some() => (map.x, map.y),
            _ => (plan.landing.along_m, 0.0),
        };
        assert_eq!((flown.contact_m.x, flown.contact_m.y, flown.contact_m.z), (place.0, place.1, plan.landing.point_m.z));
        assert_eq!((flown.error_m, flown.rest_m), (0.0, flown.contact_m));
        assert!((flown.takeoff_speed_m_s() - plan.takeoff_speed_m_s).abs() <= 1e-12 * plan.takeoff_speed_m_s);
        assert!((flown.landing_speed_m_s() - plan.landing_speed_m_s).abs() < 1e-9);
        assert!((flown.flight_time_s - plan.flight_time_s).abs() < 1e-9);
    }
}

#[test]
fn without_errors_every_trial_is_the_plan_to_the_last_digit() {
    for scene in [Scene::flat(), Scene::rolling(), Scene::craters()] {
        for policy in Policy::ALL {
            exactly_planned(&scene.planned(), policy);
        }
    }
}

fn options(trials: u64, policy: Policy) -> TrialOptions {
    TrialOptions { trials, policy, goal_tolerance_m: 2.0, ..TrialOptions::default() }
}

#[test]
fn each_error_alone_changes_the_outcomes() {
    for scene in [Scene::rolling(), Scene::craters()] {
        let planned = scene.planned();
        let on_a_map = scene.dem.is_some();
        for (name, uncertainty) in each_error(on_a_map) {
            let policy = if name == "position" { Policy::Replan } else { Policy::OpenLoop };
            let summary = planned.run(uncertainty, &options(300, policy));
            assert_eq!(summary.outcomes.total(), 300);
            assert!(summary.outcomes.of(TrialOutcome::Reached) < 300, "{name} changes nothing");
        }
    }
}

fn several() -> Uncertainty {
    Uncertainty {
        takeoff_speed_sigma_fraction: 0.01,
        takeoff_angle_sigma: chta::quantity::Angle::from_degrees(1.0),
        drift_along_sigma_m: 0.2,
        drift_across_sigma_m: 0.2,
        position_sigma_m: 0.1,
        friction_sigma: 0.02,
        height_sigma_m: 0.05,
        height_correlation_m: 10.0,
        ..Uncertainty::NONE
    }
}

#[test]
fn any_number_of_threads_gives_the_same() {
    for scene in [Scene::rolling(), Scene::craters()] {
        let planned = scene.planned();
        // Open loop over more than one batch; replanning on a map takes longer, so fewer trials.
        for (policy, trials) in [(Policy::OpenLoop, 1100), (Policy::Replan, 120)] {
            let run = |threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let mut listener = Listener::default();
                let options = TrialOptions { trajectories: 7, ..options(trials, policy) };
                let summary = pool.install(|| planned.simulation(several()).run(&options, &mut listener, &())).unwrap();
                (format!("{summary:?}"), format!("{:?} {:?}", listener.hops, listener.trials))
            };
            let one = run(1);
            assert!(one == run(2) && one == run(7), "{policy:?}");
        }
    }
}

#[test]
fn success_falls_as_errors_grow_on_the_same_draws() {
    let scene = Scene::rolling();
    let planned = scene.planned();
    for policy in Policy::ALL {
        let reached: Vec<u64> = [0.0, 0.003, 0.01, 0.03, 0.1]
            .map(|fraction| {
                let uncertainty = Uncertainty { takeoff_speed_sigma_fraction: fraction, ..Uncertainty::NONE };
                planned.run(uncertainty, &options(500, policy)).outcomes.of(TrialOutcome::Reached)
            })
            .to_vec();
        assert!(reached.windows(2).all(|pair| pair[1] <= pair[0]) && reached[0] == 500 && reached[4] < reached[0], "{reached:?}");
    }
}

#[test]
fn a_trial_depends_on_seed_and_number_alone() {
    let scene = Scene::rolling();
    let planned = scene.planned();
    let trials = |count, seed| {
        let mut listener = Listener::default();
        let options = TrialOptions { seed, ..options(count, Policy::OpenLoop) };
        planned.simulation(several()).run(&options, &mut listener, &()).unwrap();
        listener.trials
    };
    let (few, many, other) = (trials(60, 1), trials(1500, 1), trials(60, 2));
    assert_eq!(few, many[..60]);
    assert_ne!(few, other);
}

#[test]
fn replanning_makes_up_for_drift() {
    for scene in [Scene::rolling(), Scene::craters()] {
        let planned = scene.planned();
        let drift = Uncertainty { drift_along_sigma_m: 0.5, drift_across_sigma_m: 0.5, ..Uncertainty::NONE };
        let [open_loop, replan]: [Summary; 2] = planned
            .simulation(drift)
            .compare(&TrialOptions { goal_tolerance_m: 3.0, ..options(300, Policy::OpenLoop) }, &mut (), &())
            .unwrap();
        assert_eq!((open_loop.policy, replan.policy), (Policy::OpenLoop, Policy::Replan));
        assert!(replan.success.low > open_loop.success.high, "{:?} {:?}", open_loop.success, replan.success);
    }
}

/// Friction and height errors change the actual ground; the robot plans by its map.
#[test]
fn the_robot_plans_by_its_map_not_by_the_drawn_ground() {
    for scene in [Scene::rolling(), Scene::craters()] {
        let planned = scene.planned();
        let position = Uncertainty { position_sigma_m: 0.5, ..Uncertainty::NONE };
        let first_hops = |uncertainty| {
            let mut listener = Listener::default();
            planned.simulation(uncertainty).run(&options(60, Policy::Replan), &mut listener, &()).unwrap();
            listener.hops.into_iter().filter(|hop| hop.hop == 1).collect::<Vec<_>>()
        };
        let nominal = first_hops(position.clone());
        for other in [
            Uncertainty { friction_sigma: 0.2, ..position.clone() },
            Uncertainty { height_sigma_m: 0.1, height_correlation_m: 20.0, ..position },
        ] {
            let mut compared = 0;
            for hop in first_hops(other) {
                // Trials that slid at their first take-off have no hop, in either run.
                let Some(same) = nominal.iter().find(|known| known.trial == hop.trial) else { continue };
                assert_eq!((hop.heading, hop.horizontal_m_s), (same.heading, same.horizontal_m_s), "{hop:?}");
                assert_eq!(hop.takeoff_vertical_m_s, same.takeoff_vertical_m_s);
                compared += 1;
            }
            assert!(compared > 5, "only {compared} first hops in both");
        }
    }
}
