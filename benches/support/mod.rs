//! Ground for the benches: a fractal chain of one-metre segments, from a seed.

#![allow(dead_code, clippy::expect_used, reason = "not every bench uses all of it; a bench that cannot set its scene should stop")]

pub(crate) mod plain;

use chta::{
    chain::{ConstrainedChain, PolygonalChain},
    quantity::MapPoint,
    terrain::{FractalGround, SyntheticTerrain, slice, synthesise},
    world::{FrictionCone, Grip, Hopper, RestSlope, Surface},
};

/// Gravity of Mars, m/s^2.
pub(crate) const MARS_M_S2: f64 = 3.711;

/// Rough Martian ground along a row of posts: as many one-metre segments, a hopper of 10 m/s with 5 cm of clearance, friction 0.6.
pub(crate) fn fractal_chain(segments: usize) -> (ConstrainedChain, Hopper) {
    let hopper = Hopper { clearance_m: 0.05, ..Hopper::with_speeds(10.0, 10.0) };
    let terrain = SyntheticTerrain {
        rows: 3,
        cols: segments + 1,
        seed: 42,
        ground: Some(FractalGround { hurst_exponent: 0.75, rms_deviation_m: 0.12, baseline_m: 1.0 }),
        craters: None,
        ..SyntheticTerrain::default()
    };
    let dem = synthesise(&terrain).expect("sound options");
    #[expect(clippy::cast_precision_loss, reason = "a few thousand segments")]
    let to = MapPoint::new(segments as f64, 1.0);
    let profile = slice(&dem, MapPoint::new(0.0, 1.0), to).expect("a row of the map");
    let geometry = PolygonalChain::from_profile(&profile, None).expect("a slice is a chain");
    (constrained(geometry, &hopper), hopper)
}

/// With friction 0.6 all over.
pub(crate) fn constrained(geometry: PolygonalChain, hopper: &Hopper) -> ConstrainedChain {
    constrained_by(geometry, hopper, 0.6)
}

/// With the same friction all over.
pub(crate) fn constrained_by(geometry: PolygonalChain, hopper: &Hopper, friction: f64) -> ConstrainedChain {
    let grip = Some(Grip::Friction(FrictionCone::new(friction).expect("a friction coefficient")));
    ConstrainedChain::new(geometry, hopper, &Surface { grip, rest: RestSlope::AsFrictionHolds }).expect("sound constraints")
}
