//! The hop kernel allocates nothing and takes no tangent.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

use std::{alloc::System, fs, path::Path};

use chta::{
    ballistics::HopTest,
    chain::{ConstrainedChain, PolygonalChain},
    quantity::{ChainPoint, VertexId},
    world::{FrictionCone, Grip, Hopper, RestSlope, Surface},
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

#[test]
fn ten_thousand_pairs_are_judged_without_an_allocation() {
    let vertices = (0..=100).map(|i| ChainPoint::new(f64::from(i), 0.3 * f64::from(i * i % 7))).collect();
    let hopper =
        Hopper { clearance_m: 0.05, apex_height_max_m: Some(20.0), flight_time_max_s: Some(10.0), ..Hopper::with_speeds(9.0, 9.0) };
    let grip = Some(Grip::Friction(FrictionCone::new(0.9).unwrap()));
    let surface = Surface { grip, rest: RestSlope::AsFrictionHolds };
    let chain = ConstrainedChain::new(PolygonalChain::bare(vertices).unwrap(), &hopper, &surface).unwrap();
    let test = HopTest::new(&chain, &hopper, 3.711);
    let (mut feasible, mut refused) = (0, 0);
    let region = Region::new(ALLOCATOR);
    for i in 0..=100 {
        let takeoff = chain.geometry().vertex_station(VertexId(i));
        for j in 0..=100 {
            match test.loft(&takeoff, &chain.geometry().vertex_station(VertexId(j))) {
                Ok(_) => feasible += 1,
                Err(_) => refused += 1,
            }
        }
    }
    let change = region.change();
    assert_eq!((change.allocations, change.reallocations), (0, 0), "{change:?}");
    assert!(feasible > 300 && refused > 3000, "the pairs are all alike: {feasible} feasible, {refused} refused");
}

#[test]
fn the_limits_name_no_trigonometric_function() {
    let limits = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/ballistics/limits");
    let mut read = 0;
    for entry in fs::read_dir(limits).unwrap() {
        let path = entry.unwrap().path();
        let source = fs::read_to_string(&path).unwrap();
        let code: String = source.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        for function in ["sin(", "cos(", "tan(", "atan", "libm", "Angle", "Vec"] {
            assert!(!code.contains(function), "{} calls {function}", path.display());
        }
        read += 1;
    }
    assert!(read >= 5, "only {read} limits found");
}
