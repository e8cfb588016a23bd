//! A random field of height errors.

use std::f64::consts::TAU;

use crate::quantity::standard_normals;

/// Number of waves of a field. Variance and correlation are right for any number; with more waves, the joint distribution of
/// heights at several positions is closer to Gaussian. 32 give fourth moments within some per cent.
const WAVES: usize = LANES * 8;

/// So many waves are evaluated side by side.
const LANES: usize = 4;

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
    waves: [Waves; WAVES / LANES],
}

/// Some waves, each value of all of them side by side.
#[derive(Clone, Copy, Debug, Default)]
struct Waves {
    /// Turns per metre.
    east: [f64; LANES],
    north: [f64; LANES],
    /// Turns.
    phase: [f64; LANES],
    amplitude_m: [f64; LANES],
}

impl HeightField {
    /// A field of this deviation and correlation length, m, from uniforms in [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "32 waves")]
    pub fn drawn(mut uniform: impl FnMut() -> f64, sigma_m: f64, correlation_m: f64) -> Self {
        let (scale_m, turn_m) = (sigma_m / (WAVES as f64).sqrt(), TAU * correlation_m);
        let mut waves = [Waves::default(); WAVES / LANES];
        for number in 0..WAVES {
            let (waves, lane) = (&mut waves[number / LANES], number % LANES);
            [waves.east[lane], waves.north[lane]] = standard_normals([uniform(), uniform()]).map(|normal| normal / turn_m);
            waves.amplitude_m[lane] = scale_m * (-2.0 * libm::log(1.0 - uniform())).sqrt();
            waves.phase[lane] = uniform();
        }
        Self { waves }
    }

    /// The height error at a position, m from any fixed origin.
    pub fn at(&self, east_m: f64, north_m: f64) -> f64 {
        let mut sums_m = [0.0; LANES];
        for waves in &self.waves {
            for (lane, sum_m) in sums_m.iter_mut().enumerate() {
                let turns = waves.east[lane] * east_m + waves.north[lane] * north_m + waves.phase[lane];
                *sum_m += waves.amplitude_m[lane] * cos_of_turns(turns);
            }
        }
        (sums_m[0] + sums_m[1]) + (sums_m[2] + sums_m[3])
    }
}

/// The cosine of an angle in turns, to some 1e-15.
///
/// A trial asks for the heights of all posts under its flights: a branch for the quadrant, as a library has it, would keep waves from being
/// evaluated side by side, and takes several times as long.
#[inline]
fn cos_of_turns(turns: f64) -> f64 {
    // The sum has no digits behind the point left: it rounds to the nearest whole number.
    const ROUNDS: f64 = 1.5 / f64::EPSILON;
    // cos(2 pi t) = sin(2 pi y) with y = 1/4 - |t|, by its Taylor series: the first term left out is below 3e-16.
    const TERMS: [f64; 10] = [
        TAU,
        -41.341_702_240_399_76,
        81.605_249_276_075_06,
        -76.705_859_753_061_39,
        42.058_693_944_897_655,
        -15.094_642_576_822_99,
        3.819_952_584_848_282,
        -0.718_122_301_778_500_6,
        0.104_229_162_208_139_84,
        -0.012_031_585_942_120_627,
    ];
    let part = turns - ((turns + ROUNDS) - ROUNDS);
    let y = 0.25 - part.abs();
    let y2 = y * y;
    y * TERMS.iter().rev().fold(0.0, |sum, term| sum * y2 + term)
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
    fn cosines_are_those_of_the_library() {
        let mut draw = Draw::seeded(5);
        let edges = (-8..=8).map(|eighths| f64::from(eighths) / 8.0);
        let any = (0..100_000).map(|_| draw.uniform(-1.0, 1.0) * 10_f64.powf(draw.uniform(-6.0, 4.0)));
        for turns in edges.chain(any) {
            let exact = libm::cos(TAU * (turns - turns.round()));
            assert!((cos_of_turns(turns) - exact).abs() < 2e-15, "{turns} turns: {} for {exact}", cos_of_turns(turns));
        }
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
