//! Ground for the benches: a fractal chain of one-metre segments, from a seed.

#![allow(dead_code, clippy::expect_used, reason = "not every bench uses all of it; a bench that cannot set its scene should stop")]

pub(crate) mod plain;

use chta::{
    chain::{ConstrainedChain, PolygonalChain},
    quantity::{ChainPoint, MapPoint},
    terrain::{FractalGround, SyntheticTerrain, slice, synthesise},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

/// Gravity of Mars, m/s^2.
pub(crate) const MARS_M_S2: f64 = 3.711;

/// Rough Martian ground along a row of posts in one-metre segments, a hopper of 10 m/s with 5 cm of clearance, friction 0.6.
pub(crate) fn fractal_chain(segments: usize) -> (ConstrainedChain, Hopper) {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(10.0, 10.0) }).expect("a valid hopper");
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

/// The vertices of a chain of any length in one-metre segments: fractal ground along a line, heights to the millimetre.
///
/// Random midpoint displacement: over a distance `L` heights differ by `0.12 m (L / 1 m)^0.75` (root mean square). One-metre slopes
/// are about 7 degrees, none of a hundred thousand is near the 31 degrees of friction 0.6, and the relief over 100 km is hundreds
/// of metres. Up to 131 072 segments, a shorter chain is the beginning of a longer one with the same seed.
#[expect(clippy::cast_precision_loss, reason = "far fewer vertices than 2^53")]
pub(crate) fn long_chain(segments: usize, seed: u64) -> Vec<ChainPoint> {
    const HURST: f64 = 0.75;
    const DEVIATION_AT_1_M: f64 = 0.12;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || {
        let (radius, turn): (f64, f64) = (random.random(), random.random());
        (-2.0 * libm::log(1.0 - radius)).sqrt() * libm::cos(std::f64::consts::TAU * turn)
    };
    let length = segments.next_power_of_two().max(1 << 17);
    let deviation_m = |distance: usize| DEVIATION_AT_1_M * libm::pow(distance as f64, HURST);
    let mut heights_m = vec![0.0; length + 1];
    heights_m[length] = deviation_m(length) * normal();
    let mut step = length;
    while step > 1 {
        let half = step / 2;
        // The mean of two known heights, plus a random displacement.
        let around_m = deviation_m(half) * (1.0 - libm::pow(2.0, 2.0 * HURST - 2.0)).sqrt();
        for at in (half..length).step_by(step) {
            heights_m[at] = 0.5 * (heights_m[at - half] + heights_m[at + half]) + around_m * normal();
        }
        step = half;
    }
    let vertex = |(i, z_m): (usize, &f64)| ChainPoint::new(i as f64, (z_m * 1e3).round() / 1e3);
    heights_m.iter().take(segments + 1).enumerate().map(vertex).collect()
}

/// Constraints with friction 0.6 everywhere.
pub(crate) fn constrained(geometry: PolygonalChain, hopper: &Hopper) -> ConstrainedChain {
    constrained_by(geometry, hopper, 0.6)
}

/// Constraints with the same friction everywhere.
pub(crate) fn constrained_by(geometry: PolygonalChain, hopper: &Hopper, friction: f64) -> ConstrainedChain {
    let grip = Some(Grip::Friction(FrictionCone::new(friction).expect("a friction coefficient")));
    ConstrainedChain::new(
        geometry,
        hopper,
        Gravity::new(MARS_M_S2).expect("a gravity"),
        &SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds },
    )
    .expect("sound constraints")
}
