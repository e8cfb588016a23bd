//! Flown hops per second: the simulation on one thread, on the shipped chain of 100 vertices and on the shipped crater field, with
//! errors of speed, angle and drift (on the map of heading too); and the cost of replanning compared with open loop.
//!
//! `cargo bench --bench fly`. Items are flown hops, so the throughput is hops per second per core. Compare lines of one run with
//! each other.
//!
//! The hopper does not bounce. That its trials are as fast as before there were bounces, both measured in one run:
//!
//! ```sh
//! BENCHES=fly benches/against_commit.sh "$(git log -1 --diff-filter=A --format=%h -- src/flight/bounce.rs)~1" --assert
//! ```

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "the outcomes of the trials are needed to read the times")]

mod support;

use std::{path::Path, sync::Arc};

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain, csv::read_chain_csv_file},
    graph::{CostToGo, NodeSet, Outcome, PointSpacing, SearchOptions, search},
    ground::{DemGround, Surface},
    hop::{HopTest, Split},
    path::generate,
    quantity::{Angle, MapPoint},
    terrain::{Dem, OverlaidDem, Overlays, read_dem, slice},
    uncertainty::{Mission, Policy, Simulation, TrialOptions, Uncertainty},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};
use divan::{Bencher, black_box, counter::ItemsCount};

fn main() {
    divan::main();
}

/// Errors with which most trials fly all their hops.
const ERRORS: Uncertainty = Uncertainty {
    takeoff_speed_sigma_fraction: 0.01,
    takeoff_angle_sigma: Angle::from_radians(0.01),
    drift_along_sigma_m: 0.1,
    ..Uncertainty::NONE
};

/// The plan is for a slower robot on ground with less friction, so that the real robot has a margin of both.
fn robots() -> [(Hopper, SurfaceProperties); 2] {
    [(7.0, 0.8), (10.0, 3.0)].map(|(speed_m_s, friction)| {
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) })
            .expect("a valid hopper");
        let grip = Some(Grip::Friction(FrictionCone::new(friction).expect("a friction coefficient")));
        (hopper, SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds })
    })
}

/// Plans with the first robot and flies with the second, 1 000 trials on one thread.
fn fly(
    bencher: Bencher<'_, '_>,
    geometry: &PolygonalChain,
    dem: Option<&Dem>,
    spacing_m: f64,
    errors: Uncertainty,
    policy: Policy,
) {
    let [planner, flier] = robots();
    let constrained = |(hopper, surface)| {
        ConstrainedChain::new(geometry.clone(), hopper, Gravity::new(support::MARS_M_S2).expect("a gravity"), surface)
            .expect("a chain")
    };
    let chains = [constrained((&planner.0, &planner.1)), constrained((&flier.0, &flier.1))];
    let test = HopTest::new(chains[0].clone());
    let (first_m, last_m) = geometry.extent_m();
    let station = |x_m| geometry.station(x_m).expect("an end of the chain");
    // Ground behind the start and beyond the goal, for flights that are too short or too long.
    let (start, goal) = (station(first_m + 5.0), station(last_m - 10.0));
    let spacing = PointSpacing::AtMostM(spacing_m);
    let options = SearchOptions { spacing: Some(spacing), takeoff: TakeoffChoice::MidRange, ..SearchOptions::default() };
    let answer = search(&test, start, goal, &options, &()).expect("few nodes");
    let Outcome::Path { legs, .. } = answer.outcome else { panic!("no path") };
    let path = generate(&test, &legs, options.takeoff, Split::FullReach).expect("few hops");
    let real = HopTest::new(chains[1].clone());
    let nodes = NodeSet::new(&chains[1], start, goal, spacing).expect("few nodes");
    let to_go = Arc::new(CostToGo::of(&real, nodes, &options, &()).expect("not cancelled"));
    let mission = match dem {
        None => Mission::along_chain(real.clone(), path.clone(), start, goal),
        Some(dem) => {
            let terrain = OverlaidDem::new(dem.clone(), Overlays::default());
            let ground = DemGround::new(terrain, &flier.0, real.chain().gravity(), &flier.1);
            let [start, goal] = [start, goal].map(|station| real.chain().contact_point(&station));
            Mission::over_dem(ground, path.clone(), start, goal)
        }
    };
    let simulation = Simulation::new(&mission.with_replanning(real, to_go), errors).expect("sound errors");
    let trials = TrialOptions { trials: 1000, policy, goal_tolerance_m: 3.0, ..TrialOptions::default() };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let run = || one.install(|| simulation.run(black_box(&trials), &mut (), &())).expect("a simulation");
    let summary = run();
    println!(
        "    {} hops planned; {} flown by 1000 trials; {}",
        path.hops.len(),
        summary.hops_flown,
        summary.outcomes.each().map(|(outcome, count)| format!("{} {count}", outcome.name())).collect::<Vec<_>>().join(", ")
    );
    bencher.counter(ItemsCount::new(summary.hops_flown)).bench_local(run);
}

fn data(file: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(file)
}

/// The shipped chain with its vertices, a metre apart, as nodes.
#[divan::bench(args = ["open-loop", "replan"])]
fn on_the_chain(bencher: Bencher<'_, '_>, policy: &str) {
    let chain = read_chain_csv_file(data("chains/rolling_100.csv")).expect("the shipped chain").chain;
    fly(bencher, &chain, None, 2.0, ERRORS, named(policy));
}

/// Replanning over more nodes: their spacing, m.
#[divan::bench(args = [0.5, 0.25])]
fn on_the_chain_replanned_over(bencher: Bencher<'_, '_>, spacing_m: f64) {
    let chain = read_chain_csv_file(data("chains/rolling_100.csv")).expect("the shipped chain").chain;
    fly(bencher, &chain, None, spacing_m, ERRORS, Policy::Replan);
}

/// The shipped crater field.
#[divan::bench(args = ["open-loop", "replan"])]
fn on_the_map(bencher: Bencher<'_, '_>, policy: &str) {
    let dem = read_dem(&data("terrain/mars_crater_field.tif")).expect("the shipped DEM");
    let profile = slice(&dem, MapPoint::new(12.0, 84.0), MapPoint::new(114.0, 50.0)).expect("a slice");
    let chain = PolygonalChain::from_profile(&profile, None).expect("a chain");
    let errors = Uncertainty { heading_sigma: Angle::from_radians(0.01), drift_across_sigma_m: 0.1, ..ERRORS };
    fly(bencher, &chain, Some(&dem), 2.0, errors, named(policy));
}

fn named(policy: &str) -> Policy {
    Policy::ALL.into_iter().find(|known| known.name() == policy).expect("a policy")
}
