//! A random field of height errors.

use crate::quantity::standard_normals;

/// Number of waves of a field. Variance and correlation are right for any number; with more waves, the joint distribution of
/// heights at several positions is closer to Gaussian. 32 give fourth moments within some per cent and cost half a microsecond per
/// position.
const WAVES: usize = 32;

/// One realisation of a homogeneous Gaussian random field of heights.
///
/// ```text
///     e(x) = sigma sqrt(1/M) sum R_i cos(k_i . x + p_i),   k_i ~ N(0, 1/d0^2),  R_i ~ Rayleigh,  p_i ~ uniform
///     E[e(x) e(y)] = sigma^2 exp(-|x - y|^2 / (2 d0^2))
/// ```
///
/// Random Fourier features (Rahimi and Recht 2007) with random amplitudes: at every position the height is exactly Gaussian with
/// deviation sigma, and the correlation is exact. The field is smooth, so its slopes have the deviation sigma/d0 for any division
/// of the ground; with an exponential correlation the slopes of short segments would grow without bound.
#[derive(Clone, Debug)]
pub struct HeightField {
    waves: [Wave; WAVES],
}

#[derive(Clone, Copy, Debug, Default)]
struct Wave {
    /// rad/m.
    east: f64,
    north: f64,
    amplitude_m: f64,
    phase: f64,
}

impl HeightField {
    /// A field of this deviation and correlation length, m, from uniforms in [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "32 waves")]
    pub fn drawn(mut uniform: impl FnMut() -> f64, sigma_m: f64, correlation_m: f64) -> Self {
        let scale_m = sigma_m / (WAVES as f64).sqrt();
        let waves = [(); WAVES].map(|()| {
            let [east, north] = standard_normals([uniform(), uniform()]).map(|normal| normal / correlation_m);
            let amplitude_m = scale_m * (-2.0 * libm::log(1.0 - uniform())).sqrt();
            Wave { east, north, amplitude_m, phase: std::f64::consts::TAU * uniform() }
        });
        Self { waves }
    }

    /// The height error at a position, m from any fixed origin.
    pub fn at(&self, east_m: f64, north_m: f64) -> f64 {
        self.waves.iter().map(|w| w.amplitude_m * libm::cos(w.east * east_m + w.north * north_m + w.phase)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    /// Moments over many realisations, at one position and between two, along both axes and across.
    #[test]
    fn variance_and_correlation_are_as_stated() {
        let (sigma_m, length_m) = (0.7, 5.0);
        let mut draw = Draw::seeded(3);
        let count = 8000;
        let places = [(0.0, 0.0), (5.0, 0.0), (0.0, 2.5), (3.0, -4.0), (30.0, 40.0)];
        let mut sums = [0.0; 5];
        let mut fourth = 0.0;
        for _ in 0..count {
            let field = HeightField::drawn(|| draw.unit(), sigma_m, length_m);
            let here = field.at(0.0, 0.0) / sigma_m;
            fourth += here.powi(4) / f64::from(count);
            for (sum, (x, y)) in sums.iter_mut().zip(places) {
                *sum += here * field.at(x, y) / sigma_m / f64::from(count);
            }
        }
        for (found, (x, y)) in sums.into_iter().zip(places) {
            let distance_m: f64 = libm::hypot(x, y);
            let expected = (-(distance_m / length_m).powi(2) / 2.0).exp();
            // Four standard errors of a mean product of two normals: at most sqrt(2 / 8000).
            assert!((found - expected).abs() < 0.064, "at ({x}, {y}): {found} for {expected}");
        }
        assert!((fourth - 3.0).abs() < 0.45, "fourth moment {fourth}");
    }

    #[test]
    fn slopes_have_the_deviation_of_height_over_correlation_length() {
        let mut draw = Draw::seeded(4);
        let step_m = 1e-4;
        let mean_square: f64 = (0..4000)
            .map(|_| {
                let field = HeightField::drawn(|| draw.unit(), 2.0, 10.0);
                ((field.at(7.0 + step_m, 1.0) - field.at(7.0, 1.0)) / step_m).powi(2) / 4000.0
            })
            .sum();
        // Slope deviation 2 / 10.
        assert!((mean_square.sqrt() - 0.2).abs() < 0.01, "{mean_square}");
    }
}
