//! Every outcome, in a scene that causes it; early stopping; bad input.

use std::{ops::ControlFlow, sync::Mutex};

use chta::{
    chain::{ConstrainedChain, PolygonalChain},
    progress::{Cancelled, Detail, Progress, Stage, Step},
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint},
    terrain::{Dem, GeoReference, KeepOut, Overlays, read_keep_out},
    uncertainty::{Mission, MissionPoint, Policy, Simulation, SimulationError, TrialOptions, TrialOutcome, Uncertainty},
    world::{Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

use super::{
    plans::Listener,
    scene::{Scene, friction},
};

fn count(scene: &Scene, uncertainty: Uncertainty, options: &TrialOptions, outcome: TrialOutcome) -> u64 {
    let summary = scene.planned().run(uncertainty, options);
    assert_eq!(summary.outcomes.total(), options.trials);
    summary.outcomes.of(outcome)
}

const HUNDRED: TrialOptions = TrialOptions {
    first_trial: 0,
    trials: 100,
    seed: 1,
    policy: Policy::OpenLoop,
    hop_limit: None,
    goal_tolerance_m: 0.5,
    until_half_width: None,
    trajectories: 0,
};

const REPLAN: TrialOptions = TrialOptions { policy: Policy::Replan, ..HUNDRED };

/// Two plateaus with a ravine between them, deeper than the robot can jump.
fn ravine() -> Scene {
    let mut scene =
        Scene::of_chain(&[(0.0, 0.0), (20.0, 0.0), (20.1, -30.0), (31.9, -30.0), (32.0, 0.0), (60.0, 0.0)], 8.0, friction(0.9));
    scene.hopper = Hopper::new(HopperLimits { landing_speed_max_m_s: 60.0, ..*scene.hopper.limits() }).unwrap();
    scene.chain = ConstrainedChain::new(
        scene.chain.geometry().clone(),
        &scene.hopper,
        Gravity::new(scene.gravity_m_s2).unwrap(),
        &scene.surface,
    )
    .unwrap();
    scene.ends_m = (19.0, 34.0);
    scene
}

#[test]
fn every_outcome_occurs_where_it_is_planted() {
    let none = Uncertainty::NONE;
    let flat = Scene::flat();
    assert_eq!(count(&flat, none.clone(), &HUNDRED, TrialOutcome::Reached), 100);
    // 1 m/s of 15 m/s moves the landing by some metres of 40 m.
    let speed = Uncertainty { takeoff_speed_sigma_m_s: 1.0, ..Uncertainty::NONE };
    assert!(count(&flat, speed.clone(), &HUNDRED, TrialOutcome::Missed) > 80);
    // The chain extends 300 m to one side and 100 m to the other.
    let wild = Uncertainty { takeoff_speed_sigma_m_s: 40.0, ..Uncertainty::NONE };
    assert!(count(&flat, wild, &HUNDRED, TrialOutcome::Lost) > 20);
    // Cones of 2 degrees about the planned directions.
    let mut narrow = Scene::flat();
    let about = |deg: f64| AngleInterval::from_degrees(deg - 1.0, deg + 1.0);
    let of_cones =
        |takeoff, landing| SurfaceProperties { grip: Some(Grip::FromSlope { takeoff, landing }), rest: RestSlope::Unlimited };
    let open = AngleInterval::from_degrees(0.0, 180.0);
    let turned = Uncertainty { takeoff_angle_sigma: Angle::from_degrees(3.0), ..Uncertainty::NONE };
    for (surface, outcome) in [
        (of_cones(about(45.0), AngleInterval::from_degrees(-180.0, 0.0)), TrialOutcome::SlidAtTakeoff),
        (of_cones(open, about(-45.0)), TrialOutcome::SlidAtLanding),
    ] {
        narrow.surface = surface;
        narrow.chain = ConstrainedChain::new(
            narrow.chain.geometry().clone(),
            &narrow.hopper,
            Gravity::new(narrow.gravity_m_s2).unwrap(),
            &surface,
        )
        .unwrap();
        assert!(count(&narrow, turned.clone(), &HUNDRED, outcome) > 50);
    }
    // Landing 1 % over the speed of the planned landing is too fast.
    let mut brittle = Scene::flat();
    let planned_m_s = brittle.planned().path.hops[0].landing_speed_m_s;
    brittle.hopper = Hopper::new(HopperLimits { landing_speed_max_m_s: planned_m_s * 1.01, ..*brittle.hopper.limits() }).unwrap();
    brittle.chain = ConstrainedChain::new(
        brittle.chain.geometry().clone(),
        &brittle.hopper,
        Gravity::new(brittle.gravity_m_s2).unwrap(),
        &brittle.surface,
    )
    .unwrap();
    assert!(count(&brittle, speed, &HUNDRED, TrialOutcome::Damaged) > 20);
    // A robot that falls into the ravine cannot leave it.
    let slow = Uncertainty { takeoff_speed_sigma_fraction: 0.2, ..Uncertainty::NONE };
    assert!(count(&ravine(), slow, &REPLAN, TrialOutcome::Stuck) > 5);
    // It needs several hops and may fly one.
    let one_hop = TrialOptions { hop_limit: Some(1), ..HUNDRED };
    assert_eq!(count(&Scene::rolling(), none, &one_hop, TrialOutcome::HopLimit), 100);
}

/// A plain of 100 m by 100 m with a plan along its middle.
fn plain() -> Scene {
    let map = GeoReference::local(MapPoint::new(0.0, 100.0), 10.0, 10.0).unwrap();
    let dem = Dem::new(11, 11, vec![5.0; 121], map).unwrap();
    Scene::of_dem(dem, [(15.0, 47.0), (93.0, 47.0)], Hopper::with_speeds(12.0, 12.0).unwrap(), friction(1.5), 3.711)
}

#[test]
fn zones_gaps_and_borders_lose_the_robot() {
    let scene = plain();
    let planned = scene.planned();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("zones.geojson");
    // Zones on both sides of the planned line, which is free itself.
    let ring = |low: f64, high: f64| format!("[[[0, {low}], [100, {low}], [100, {high}], [0, {high}], [0, {low}]]]");
    let text = format!(r#"{{"type": "MultiPolygon", "coordinates": [{}, {}]}}"#, ring(47.5, 60.0), ring(40.0, 46.5));
    std::fs::write(&file, text).unwrap();
    let zones: KeepOut = read_keep_out(&file, None, scene.dem.as_ref().unwrap().bounds()).unwrap();
    let aside = Uncertainty { heading_sigma: Angle::from_degrees(3.0), ..Uncertainty::NONE };
    let lost = |mission: Mission, uncertainty| {
        let options = TrialOptions { trials: 200, goal_tolerance_m: 8.0, ..HUNDRED };
        let mut listener = Listener::default();
        let summary = Simulation::new(&mission, uncertainty).unwrap().run(&options, &mut listener, &()).unwrap();
        (summary.outcomes.of(TrialOutcome::Lost), listener)
    };
    let robot = (&scene.hopper, &scene.surface);
    let dem = scene.dem.clone().unwrap();
    let (in_zones, listener) =
        lost(planned.over_dem(dem, Overlays::new(None, Some(zones)), planned.path.clone(), robot), aside.clone());
    assert!(in_zones > 50, "{in_zones} in the zones");
    for hop in listener.hops.iter().filter(|hop| hop.outcome == Some(TrialOutcome::Lost)) {
        assert!(hop.landed && (hop.contact_m.y >= 47.5 || hop.contact_m.y <= 46.5), "{hop:?}");
    }
    assert_eq!(lost(planned.mission(), aside).0, 0, "all trials stay on the map without zones");
    // At twice the speed it flies over the border 7 m behind the goal.
    let fast = Uncertainty { takeoff_speed_sigma_fraction: 0.3, ..Uncertainty::NONE };
    let strong = Hopper::with_speeds(50.0, 50.0).unwrap();
    let chain = PolygonalChain::new(
        scene.chain.geometry().vertices().to_vec(),
        scene.chain.geometry().grounds().to_vec(),
        scene.chain.geometry().map_points().map(<[_]>::to_vec),
    )
    .unwrap();
    let chain = ConstrainedChain::new(chain, &strong, Gravity::new(scene.gravity_m_s2).unwrap(), &scene.surface).unwrap();
    let test = chta::hop::HopTest::new(chain.with_hopper(&strong, Gravity::new(scene.gravity_m_s2).unwrap()).unwrap());
    let (off, listener) = lost(planned.without_replanning(test, planned.path.clone()), fast);
    assert!(off > 20, "{off} trials left the map");
    let beyond = listener.hops.iter().find(|hop| hop.outcome == Some(TrialOutcome::Lost)).unwrap();
    assert!(!beyond.landed && (beyond.contact_m.x - 100.0).abs() < 1e-9 && beyond.contact_m.z > 5.0, "{beyond:?}");
}

#[test]
fn trials_that_fly_over_a_bend_are_lost() {
    let points = [0.0, 100.0, 140.0, 400.0].map(|x| ChainPoint::new(x, 2.0)).to_vec();
    let mut scene = Scene::flat();
    let bent = PolygonalChain::bare(points).unwrap().with_bends(vec![chta::quantity::VertexId(2)]).unwrap();
    scene.chain = ConstrainedChain::new(bent, &scene.hopper, Gravity::new(scene.gravity_m_s2).unwrap(), &scene.surface).unwrap();
    let speed = Uncertainty { takeoff_speed_sigma_m_s: 0.3, ..Uncertainty::NONE };
    let lost = count(&scene, speed, &HUNDRED, TrialOutcome::Lost);
    assert!((30..70).contains(&lost), "about half must overshoot: {lost}");
}

#[test]
fn a_precise_rate_ends_the_run_after_a_whole_batch() {
    let scene = Scene::flat();
    let speed = Uncertainty { takeoff_speed_sigma_m_s: 0.1, ..Uncertainty::NONE };
    let options = TrialOptions { trials: 50_000, until_half_width: Some(0.012), trajectories: 3, ..HUNDRED };
    let summary = scene.planned().run(speed, &options);
    assert!(summary.trials.is_multiple_of(1000) && (2000..20_000).contains(&summary.trials), "{} trials", summary.trials);
    assert!(summary.success.half_width() <= 0.012);
    let before = summary.convergence[summary.convergence.len() - 2];
    assert!(before.trials == summary.trials - 1000 && before.success.half_width() > 0.012);
    assert_eq!(summary.trajectories.len(), 3);
    assert!(summary.trajectories.iter().all(|t| t.hops.len() == t.trial.hops as usize));
}

#[test]
fn a_map_needs_grip_and_the_path_must_lie_on_it() {
    let scene = plain();
    let planned = scene.planned();
    let bare = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    let over = |dem: &Dem, path: &chta::path::HopPath, surface: &SurfaceProperties| {
        let mission = planned.over_dem(dem.clone(), Overlays::default(), path.clone(), (&scene.hopper, surface));
        Simulation::new(&mission, Uncertainty::NONE).unwrap_err()
    };
    let dem = scene.dem.as_ref().unwrap();
    let error = over(dem, &planned.path, &bare);
    assert!(matches!(error, SimulationError::NoGrip), "{error}");
    let map = GeoReference::local(MapPoint::new(0.0, 100.0), 10.0, 10.0).unwrap();
    let small = Dem::new(11, 6, vec![5.0; 66], map).unwrap();
    let error = over(&small, &planned.path, &scene.surface).to_string();
    assert!(error.contains("the goal lies at (93 m, 47 m)"), "{error}");
    let mut path = planned.path.clone();
    path.hops[0].takeoff.frame = chta::ground::Frame::Chain;
    let error = over(dem, &path, &scene.surface);
    assert!(matches!(error, SimulationError::NotOnMap { which: MissionPoint::Hop(1) }), "{error}");
}

/// Cancels after the second batch; the first report is made at the start.
#[derive(Default)]
struct Impatient(Mutex<Vec<Step>>);

impl Progress for Impatient {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        let mut steps = self.0.lock().unwrap();
        steps.push(*step);
        if steps.len() == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[test]
fn invalid_options_are_refused_by_name() {
    let scene = Scene::flat();
    let planned = scene.planned();
    let simulation = planned.simulation(Uncertainty::NONE);
    let refused = |options: TrialOptions| simulation.run(&options, &mut (), &()).unwrap_err().to_string();
    assert!(refused(TrialOptions { trials: 0, ..HUNDRED }).contains("trials is 0"));
    assert!(refused(TrialOptions { hop_limit: Some(0), ..HUNDRED }).contains("hop_limit"));
    assert!(refused(TrialOptions { goal_tolerance_m: f64::NAN, ..HUNDRED }).contains("goal_tolerance_m"));
    assert!(refused(TrialOptions { until_half_width: Some(0.5), ..HUNDRED }).contains("0.5"));
    let without = planned.without_replanning(planned.test.clone(), planned.path.clone());
    let error = Simulation::new(&without, Uncertainty::NONE).unwrap().run(&REPLAN, &mut (), &()).unwrap_err();
    assert!(matches!(error, SimulationError::NoCostsToGo));
    let refused = |uncertainty: Uncertainty| Simulation::new(&planned.mission(), uncertainty).unwrap_err().to_string();
    let none = Uncertainty::NONE;
    for (key, _, _) in none.by_key() {
        assert!(!key.is_empty());
    }
    assert!(refused(Uncertainty { friction_sigma: -0.1, ..Uncertainty::NONE }).contains("friction_sigma is -0.1"));
    assert!(refused(Uncertainty { position_sigma_m: f64::INFINITY, ..Uncertainty::NONE }).contains("position_sigma_m"));
    assert!(refused(Uncertainty { height_correlation_m: 3.0, ..Uncertainty::NONE }).contains("height_correlation_m is 3 m"));
    assert!(refused(Uncertainty { height_sigma_m: 3.0, ..Uncertainty::NONE }).contains("height_sigma_m is 3 m"));
    assert!(refused(Uncertainty { heading_sigma: Angle::from_degrees(2.0), ..Uncertainty::NONE }).contains("heading_sigma_deg"));
    let impatient = Impatient::default();
    let error = simulation.run(&TrialOptions { trials: 9000, ..HUNDRED }, &mut (), &impatient).unwrap_err();
    assert!(matches!(error, SimulationError::Cancelled(Cancelled { stage: Stage::Trials, done: 2000, .. })));
    let last = impatient.0.into_inner().unwrap()[2];
    assert_eq!((last.done, last.of, last.detail), (2000, Some(9000), Detail::Trials { reached_goal: 2000 }));
}
