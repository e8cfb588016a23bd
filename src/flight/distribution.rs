//! The distribution of the errors of execution.

use crate::quantity::{normal_quantile, standard_normals};

/// The distribution of an error about its mean, of the given standard deviation.
///
/// It holds for the errors of command, heading, position and drift, and for the biases. The friction coefficient and the height of the
/// terrain are Gaussian under either.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Distribution {
    /// Gaussian.
    #[default]
    Normal,
    /// Even from -sqrt(3) to sqrt(3) standard deviations, and nothing beyond.
    Uniform,
}

impl Distribution {
    /// All variants.
    pub const ALL: [Self; 2] = [Self::Normal, Self::Uniform];

    /// The name in scenarios.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Uniform => "uniform",
        }
    }

    /// Two independent errors of deviation 1, from two uniforms in [0, 1).
    pub(crate) fn standard_pair(self, uniforms: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Normal => standard_normals(uniforms),
            Self::Uniform => uniforms.map(even),
        }
    }

    /// The error of deviation 1 that a share of all errors does not exceed.
    pub(crate) fn standard_quantile(self, share: f64) -> f64 {
        match self {
            Self::Normal => normal_quantile(share),
            Self::Uniform => even(share),
        }
    }
}

impl Distribution {
    /// The share of the sums of two independent errors that does not exceed a bound, both even and of these deviations; the second at most the
    /// first, which is above 0.
    ///
    /// With half widths a and b, the density rises from -(a + b) to -(a - b), is level up to a - b, and falls.
    pub(crate) fn share_of_two_even(bound: f64, deviations: [f64; 2]) -> f64 {
        let [a, b] = deviations.map(|deviation| HALF_WIDTH * deviation);
        let size = bound.abs();
        let above = if size >= a + b {
            0.0
        } else if size <= a - b {
            0.5 * (1.0 - size / a)
        } else {
            let left = a + b - size;
            left * left / (8.0 * a * b)
        };
        if bound < 0.0 { above } else { 1.0 - above }
    }
}

crate::quantity::by_name!(Distribution, Distribution::ALL);

/// Half the width of a uniform distribution of deviation 1: its variance is a third of the square of that.
const HALF_WIDTH: f64 = 1.732_050_807_568_877_2;

fn even(share: f64) -> f64 {
    HALF_WIDTH * (2.0 * share - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of the whole distribution, over 4096 equal slices of it: E x^2 = 1, E x^4 = 3 (normal) and 9/5 (uniform).
    #[test]
    fn quantiles_have_the_moments_of_their_distribution() {
        for (distribution, fourth, greatest) in [(Distribution::Normal, 3.0, 4.0), (Distribution::Uniform, 1.8, 1.7321)] {
            let slices = 4096;
            let errors = (0..slices).map(|i| distribution.standard_quantile((f64::from(i) + 0.5) / f64::from(slices)));
            let sums = errors.fold([0.0; 4], |[mean, square, power, most]: [f64; 4], x| {
                [mean + x, square + x * x, power + x * x * x * x, most.max(x.abs())]
            });
            let [mean, square, power, _] = sums.map(|sum| sum / f64::from(slices));
            assert!(mean.abs() < 1e-12 && (square - 1.0).abs() < 2e-3 && (power - fourth).abs() < 0.05, "{sums:?}");
            assert!(sums[3] < greatest, "{sums:?}");
        }
    }
}
