//! Bounds on the fewest hops: time against segments. `cargo bench --bench proof`
#![expect(clippy::unwrap_used, reason = "a bench that cannot build its ground should stop")]

use chta::{
    chain::{ConstrainedChain, PolygonalChain},
    graph::proof::{Bounds, BoundsOptions, bounds},
    hop::HopTest,
    quantity::ChainPoint,
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

fn main() {
    divan::main();
}

fn hopper() -> Hopper {
    Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(8.0, 8.0) }).unwrap()
}

/// Rough ground of segments about a metre long, as in slices of a DEM with 1 m posts.
fn rough(segments: u32) -> ConstrainedChain {
    let mut points = vec![ChainPoint::new(0.0, 0.0)];
    for i in 0..segments {
        let last = points[points.len() - 1];
        let (a, b) = ((f64::from(i) * 0.37).sin(), (f64::from(i) * 1.73).sin());
        points.push(ChainPoint::new(last.x_m + 0.6 + 0.3 * b.abs(), last.z_m + 0.25 * a + 0.1 * b));
    }
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.7).unwrap())), rest: RestSlope::AsFrictionHolds };
    ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper(), Gravity::new(3.711).unwrap(), &surface).unwrap()
}

#[divan::bench(args = [12, 25, 50, 100, 200, 400, 800])]
fn bounds_from_end_to_end(bencher: divan::Bencher<'_, '_>, segments: u32) {
    let chain = rough(segments);
    let test = HopTest::new(chain.clone());
    let (first_m, last_m) = chain.geometry().extent_m();
    let (start, goal) = (chain.geometry().station(first_m).unwrap(), chain.geometry().station(last_m).unwrap());
    let prove = || -> Bounds { bounds(&test, start, goal, &BoundsOptions::default(), &()).unwrap() };
    assert!(prove().is_proved(), "a bench of proofs left open");
    bencher.bench(prove);
}
