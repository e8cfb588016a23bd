//! Random draws with the same bytes on every platform.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// The layers with random draws, each with its own stream.
#[derive(Clone, Copy, Debug)]
pub(super) enum Layer {
    Ground = 1,
    Craters = 2,
    Rille = 3,
    Boulders = 4,
    Solids = 5,
}

/// A serial stream of draws.
pub(super) struct Draws {
    source: ChaCha8Rng,
}

impl Draws {
    pub(super) fn of(seed: u64, layer: Layer) -> Self {
        let mut source = ChaCha8Rng::seed_from_u64(seed);
        source.set_stream(layer as u64);
        Self { source }
    }

    /// Uniform in [0, 1), from 53 random bits.
    pub(super) fn uniform(&mut self) -> f64 {
        self.source.random::<f64>()
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Two independent standard normal variables (Box and Muller 1958), with `libm` so that the logarithm is the same on
    /// every platform.
    pub(super) fn normal_pair(&mut self) -> [f64; 2] {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.uniform()));
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * self.uniform());
        [radius * cosine, radius * sine]
    }

    /// `expected` rounded up or down at random, so that the mean is exact.
    pub(super) fn count(&mut self, expected: f64) -> usize {
        let whole = expected.floor();
        let extra = if self.uniform() < expected - whole { 1.0 } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked against the largest count before")]
        let count = (whole + extra) as usize;
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_have_mean_zero_and_variance_one() {
        let mut draws = Draws::of(7, Layer::Ground);
        let values: Vec<f64> = (0..20_000).flat_map(|_| draws.normal_pair()).collect();
        let mean = values.iter().sum::<f64>() / 40_000.0;
        let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / 40_000.0;
        // Standard errors: 0.005 and 0.007.
        assert!(mean.abs() < 0.02 && (variance - 1.0).abs() < 0.03, "{mean} {variance}");
    }

    #[test]
    fn counts_keep_their_mean_and_streams_differ() {
        let mut draws = Draws::of(7, Layer::Craters);
        let total: usize = (0..10_000).map(|_| draws.count(2.25)).sum();
        assert!((22_300..22_700).contains(&total), "{total}");
        assert_ne!(Draws::of(7, Layer::Rille).uniform(), Draws::of(7, Layer::Boulders).uniform());
    }
}
