//! Tallies of the parts of a run merge to the whole.

use chta::{
    report::SimulationRecord,
    uncertainty::{MergeProblem, Policy, Simulation, Summary, Tally, TrialOptions, Uncertainty},
};

use super::scene::Scene;
use crate::support::Draw;

/// Errors of everything that a trial draws.
fn errors(on_a_map: bool) -> Uncertainty {
    Uncertainty {
        takeoff_speed_sigma_fraction: 0.01,
        takeoff_angle_sigma: chta::quantity::Angle::from_degrees(0.4),
        heading_sigma: chta::quantity::Angle::from_degrees(if on_a_map { 0.5 } else { 0.0 }),
        position_sigma_m: 0.05,
        drift_along_sigma_m: 0.1,
        friction_sigma: 0.02,
        ..Uncertainty::NONE
    }
}

/// The bytes that a result has for these trials.
fn json(summary: &Summary, hops: usize) -> String {
    serde_json::to_string_pretty(&SimulationRecord::new(summary, hops)).unwrap()
}

/// The trials between cuts.
fn parts(simulation: &Simulation, options: &TrialOptions, cuts: &[u64]) -> Vec<Tally> {
    let part = |pair: &[u64]| {
        let options = TrialOptions { first_trial: pair[0], trials: pair[1] - pair[0], ..*options };
        simulation.tally(&options, &mut (), &()).unwrap()
    };
    cuts.windows(2).map(part).collect()
}

#[test]
fn parts_merged_in_any_order_give_the_whole_to_the_byte() {
    let mut draw = Draw::seeded(15);
    for (scene, trials) in [(Scene::rolling(), 2300), (Scene::craters(), 1200)] {
        let planned = scene.planned();
        let hops = planned.path.hops.len();
        let simulation = Simulation::new(&planned.mission(), errors(scene.dem.is_some())).unwrap();
        for policy in Policy::ALL {
            let options = TrialOptions { trials, policy, goal_tolerance_m: 1.0, ..TrialOptions::default() };
            let whole = simulation.run(&options, &mut (), &()).unwrap();
            let ways = whole.outcomes.each().filter(|(_, count)| *count > 5).count();
            assert!(ways >= 2 && whole.landings.iter().all(|landing| landing.error.mean_m > 0.0), "{:?}", whole.outcomes);
            assert_eq!(whole.landings.iter().any(|landing| landing.ellipse.is_some()), scene.dem.is_some());
            for round in 0..3 {
                let mut cuts: Vec<u64> = (0..=round * 2).map(|_| 1 + draw.below(trials as usize - 1) as u64).collect();
                cuts.extend([0, trials]);
                cuts.sort_unstable();
                cuts.dedup();
                let mut tallies = parts(&simulation, &options, &cuts);
                let mut merged = tallies.swap_remove(draw.below(tallies.len()));
                while !tallies.is_empty() {
                    let mut next = tallies.swap_remove(draw.below(tallies.len()));
                    if draw.chance(0.5) {
                        std::mem::swap(&mut merged, &mut next);
                    }
                    let text = serde_json::to_string(&next).unwrap();
                    let read: Tally = serde_json::from_str(&text).unwrap();
                    assert_eq!(read, next);
                    merged.merge(&read).unwrap();
                }
                assert_eq!(merged.trials(), std::slice::from_ref(&(0..trials)));
                assert_eq!(json(&merged.summary(), hops), json(&whole, hops), "{policy:?}, cut at {cuts:?}");
                assert_eq!(merged, simulation.tally(&options, &mut (), &()).unwrap(), "{policy:?}, cut at {cuts:?}");
            }
        }
    }
}

#[test]
fn tallies_of_other_trials_do_not_merge() {
    let planned = Scene::rolling();
    let planned = planned.planned();
    let simulation = |errors| Simulation::new(&planned.mission(), errors).unwrap();
    let options = TrialOptions { trials: 30, goal_tolerance_m: 1.0, ..TrialOptions::default() };
    let tally = |simulation: &Simulation, options: &TrialOptions| simulation.tally(options, &mut (), &()).unwrap();
    let usual = simulation(errors(false));
    let first = tally(&usual, &options);
    let later = TrialOptions { first_trial: 30, ..options };
    let shorter = chta::path::HopPath { hops: planned.path.hops[..1].to_vec(), ..planned.path.clone() };
    let shorter = Simulation::new(&planned.without_replanning(planned.test.clone(), shorter), errors(false)).unwrap();
    let limit = TrialOptions { hop_limit: Some(9), ..later };
    let others = [
        ("missions", tally(&shorter, &later)),
        ("errors", tally(&simulation(Uncertainty { friction_sigma: 0.01, ..errors(false) }), &later)),
        ("seeds", tally(&usual, &TrialOptions { seed: 2, ..later })),
        ("policies", tally(&usual, &TrialOptions { policy: Policy::Replan, ..later })),
        ("hop limits", tally(&usual, &limit)),
        ("goal tolerances (m)", tally(&usual, &TrialOptions { goal_tolerance_m: 2.0, ..later })),
    ];
    for (what, other) in others {
        let mut merged = first.clone();
        let found = merged.merge(&other);
        assert!(matches!(&found, Err(MergeProblem::Differ { what: found, .. }) if *found == what), "{what}: {found:?}");
        assert_eq!(merged, first, "{what}: a refused merge changes nothing");
    }
    for (first_trial, trials, overlap) in [(0, 1, (0, 0)), (29, 5, (29, 29)), (10, 5, (10, 14))] {
        let mut merged = first.clone();
        let found = merged.merge(&tally(&usual, &TrialOptions { first_trial, trials, ..options }));
        assert_eq!(found, Err(MergeProblem::Overlap { first: overlap.0, last: overlap.1 }));
        assert_eq!(merged, first);
    }
}
