//! Trials allocate no memory: the allocations of a run do not grow with hops or trials.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

use chta::{
    chain::{ConstrainedChain, PolygonalChain},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    ground::{DemGround, Surface},
    hop::{HopTest, Split},
    path::generate,
    quantity::{Angle, MapPoint},
    terrain::{OverlaidDem, Overlays, SyntheticTerrain, slice, synthesise},
    uncertainty::{Mission, Simulation, TrialOptions, Uncertainty},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};
use stats_alloc::Region;

use crate::{ALLOCATOR, alone};

#[test]
fn a_thousand_trials_take_few_allocations_on_chain_and_map() {
    let _guard = alone();
    let dem = synthesise(&SyntheticTerrain { rows: 60, cols: 90, ..SyntheticTerrain::default() }).unwrap();
    let profile = slice(&dem, MapPoint::new(5.0, 30.0), MapPoint::new(85.0, 28.0)).unwrap();
    let hopper = Hopper::with_speeds(7.0, 12.0).unwrap();
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.4).unwrap())), rest: RestSlope::AsFrictionHolds };
    let chain =
        ConstrainedChain::new(PolygonalChain::from_profile(&profile, None).unwrap(), &hopper, Gravity::new(1.6).unwrap(), &surface)
            .unwrap();
    let test = HopTest::new(chain.clone());
    let station = |x_m| chain.geometry().station(x_m).unwrap();
    let (start, goal) = (station(2.0), station(70.0));
    let options = SearchOptions { spacing: Some(PointSpacing::AtMostM(1.0)), ..SearchOptions::default() };
    let Outcome::Path { legs, .. } = search(&test, start, goal, &options, &()).unwrap().outcome else { panic!("no path") };
    let path = generate(&test, &legs, options.takeoff, Split::FullReach).unwrap();
    let errors = Uncertainty {
        takeoff_speed_sigma_fraction: 0.01,
        takeoff_angle_sigma: Angle::from_degrees(0.5),
        drift_along_sigma_m: 0.1,
        ..Uncertainty::NONE
    };
    let terrain = OverlaidDem::new(dem, Overlays::default());
    let ground = DemGround::new(terrain, &hopper, Gravity::new(1.6).unwrap(), &surface);
    let [from, to] = [start, goal].map(|station| chain.contact_point(&station));
    let over_dem = Mission::over_dem(ground, path.clone(), from, to);
    for mission in [Mission::along_chain(test, path, start, goal), over_dem] {
        let simulation = Simulation::new(&mission, errors.clone()).unwrap();
        let trials = TrialOptions { trials: 1000, ..TrialOptions::default() };
        // The test harness has its own thread, so the round with the fewest allocations counts.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let rounds = [(); 3].map(|()| {
            let region = Region::new(ALLOCATOR);
            let hops = pool.install(|| simulation.run(&trials, &mut (), &())).unwrap().hops_flown;
            let change = region.change();
            (change.allocations + change.reallocations, hops)
        });
        let (allocations, hops) = rounds.into_iter().min().unwrap();
        assert!(hops > 1000, "only {hops} hops");
        // Lists that grow in doublings for each of twenty tasks, bins of the quantiles.
        assert!(allocations < 900, "{allocations} allocations for {hops} hops");
    }
}
