//! Replanning beside the line of a slice: where staying on the line is not reliable, trials that leave it reach the goal more often.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]

use std::{fs, sync::Arc};

use chta::{
    graph::{CostToGo, NodeSet, RiskModel, TakeoffScatter},
    ground::Surface,
    quantity::Angle,
    scenario::{Entries, Scenario},
    study::{Case, Commands, PlanOptions, Planned, SimulateOptions, Trials, plan},
    terrain::{FractalGround, SyntheticTerrain, synthesise, write_ascii_grid},
    uncertainty::{Mission, Simulation},
};

/// A journey of some 40 m over rough ground of this seed; `None` without a path.
fn planned(seed: u64) -> Option<Planned> {
    let ground = FractalGround { hurst_exponent: 0.5, rms_deviation_m: 0.32, baseline_m: 1.0 };
    let terrain = SyntheticTerrain {
        rows: 36,
        cols: 56,
        seed,
        ground: Some(ground),
        craters: None,
        tilt: Angle::from_degrees(0.0),
        ..SyntheticTerrain::default()
    };
    let folder = std::env::temp_dir().join(format!("chta_beside_line_{}_{seed}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    write_ascii_grid(&synthesise(&terrain).unwrap(), &mut fs::File::create(folder.join("ground.asc")).unwrap()).unwrap();
    let toml = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n\
                [surface]\nfriction_coefficient = 0.7\n\
                [terrain]\ndem = \"ground.asc\"\naccept_map_scale = true\nstart_m = [7.0, 18.0]\ngoal_m = [47.0, 17.0]\n\
                [uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ntakeoff_angle_sigma_deg = 1.0\ngoal_tolerance_m = 2.0\n";
    let scenario = Scenario::new(Entries::from_toml(toml)).unwrap();
    let case = Case::new(scenario, &folder, Commands::OfTheMachine).unwrap();
    let planned = plan(&case, PlanOptions { estimate: true, ..PlanOptions::default() }, &()).unwrap();
    // The raster is read when trials first need it.
    planned.dem_ground().unwrap();
    fs::remove_dir_all(&folder).unwrap();
    Some(planned).filter(|planned| planned.path.is_some())
}

/// The success of the same path, replanned over the nodes of the line alone.
fn along_the_line(planned: &Planned) -> f64 {
    let Planned { case, test, ends, found, path, .. } = planned;
    let (scenario, ground) = (&case.scenario, planned.dem_ground().unwrap().unwrap());
    let nodes = NodeSet::new(test.chain(), ends.0, ends.1, found.spacing).unwrap();
    let mut reliability = scenario.reliability(Some(&ground)).unwrap();
    if let RiskModel::Flown { takeoffs, .. } = &mut reliability.model {
        *takeoffs = TakeoffScatter::OfPosition;
    }
    let to_go = CostToGo::with_reliability(test, nodes, &scenario.search, &reliability, &()).unwrap();
    let [start, goal] = [ends.0, ends.1].map(|station| test.chain().contact_point(&station));
    let mission = Mission::over_dem(ground, path.clone().unwrap(), start, goal)
        .with_replanning(test.clone(), Arc::new(to_go.with_hops(found.hops().unwrap())));
    let keys = scenario.uncertainty.clone().unwrap();
    Simulation::new(&mission, keys.errors.clone()).unwrap().estimated_success(&keys.options(), &()).unwrap()
}

#[test]
fn a_robot_leaves_the_line_where_that_is_more_reliable() {
    let (mut stayed, mut left) = (0, 0);
    for seed in 0..8 {
        let Some(planned) = planned(seed) else { continue };
        let stated = planned.answer.totals.as_ref().unwrap().estimate.unwrap().success_estimated;
        let on_line = along_the_line(&planned);
        assert!(stated >= on_line, "seed {seed}: {stated}, along the line {on_line}");
        if on_line >= 0.98 {
            assert_eq!(stated, on_line, "seed {seed}: a robot that is reliable on the line stays there");
            stayed += 1;
        }
        left += u32::from(stated > on_line + 0.05);
        // Other trials of the same plan fly the same robot.
        let trials = Trials::new(&Arc::new(planned), &SimulateOptions::default());
        let flown = trials.tally(0..800, &()).unwrap().unwrap().summary().success.rate;
        assert!((flown - stated).abs() < 0.07, "seed {seed}: estimated {stated}, flown {flown}");
    }
    assert!(left > 1, "only {left} journeys are more reliable beside the line, {stayed} stay on it");
}
