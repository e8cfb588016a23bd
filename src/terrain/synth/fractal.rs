//! Rough ground: a random field with a power-law spectrum.

use super::Canvas;
use super::options::{at_least, within};
use super::random::{Draws, Layer};
use crate::terrain::TerrainError;

/// Self-affine ground: the root mean square difference of heights at a distance L is
///
/// ```text
/// nu(L) = rms_deviation_m (L / baseline_m)^hurst_exponent
/// ```
///
/// Source: Shepard et al., The roughness of natural terrain, J. Geophys. Res. 106 (2001) 32777, eqs. 3 and 5. Planetary surfaces
/// have Hurst exponents of some 0.5 to 0.95 at metres to hundreds of metres.
///
/// Method: independent complex normal variables for all wave vectors k of a periodic square, weighted by |k|^-(H + 1), and
/// their inverse Fourier transform (Voss, in Peitgen and Saupe, The Science of Fractal Images, 1988, section 1.6). The weight
/// is scaled so that the expected deviation is exact at the baseline, limited to between one post and a quarter of the
/// square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FractalGround {
    /// H, the Hurst exponent, above 0 (rough at all scales) and below 1 (smooth at short distances).
    pub hurst_exponent: f64,
    /// Root mean square height difference at the baseline, m.
    pub rms_deviation_m: f64,
    /// The baseline: the distance for this deviation, m.
    pub baseline_m: f64,
}

impl Default for FractalGround {
    /// A smooth regolith plain: 0.1 m over 1 m, H = 0.8.
    fn default() -> Self {
        Self { hurst_exponent: 0.8, rms_deviation_m: 0.1, baseline_m: 1.0 }
    }
}

impl FractalGround {
    pub(super) fn add(&self, heights_m: &mut [f64], canvas: Canvas, seed: u64) -> Result<(), TerrainError> {
        within("hurst_exponent", self.hurst_exponent, 0.01, 0.99, "")?;
        within("rms_deviation_m", self.rms_deviation_m, 0.0, 1.0e6, "m")?;
        at_least("baseline_m", self.baseline_m, 1.0e-6, "m")?;
        // A margin of a quarter keeps opposite edges of the periodic field from adjoining on the map.
        let side = (canvas.rows.max(canvas.cols) * 5).div_ceil(4).next_power_of_two();
        let spectrum = Spectrum { side, exponent: -(self.hurst_exponent + 1.0) };
        let mut draws = Draws::of(seed, Layer::Ground);
        let (mut field, column_powers) = spectrum.draw(&mut draws);
        transform_square(&mut field, side);
        let amplitude = self.amplitude(spectrum, &column_powers, canvas.spacing_m);
        for (row, line) in heights_m.chunks_exact_mut(canvas.cols).enumerate() {
            for (height_m, wave) in line.iter_mut().zip(&field[row * side..]) {
                *height_m += amplitude * wave.re;
            }
        }
        Ok(())
    }

    /// The factor from the unit field's deviation at a lag to the required one.
    fn amplitude(&self, spectrum: Spectrum, column_powers: &[f64], spacing_m: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "sides stay below 2^30")]
        let lag = (self.baseline_m / spacing_m).clamp(1.0, spectrum.side as f64 / 4.0);
        let wanted_m = self.rms_deviation_m * libm::pow(lag * spacing_m / self.baseline_m, self.hurst_exponent);
        wanted_m / libm::sqrt(spectrum.expected_square_deviation(column_powers, lag))
    }
}

#[derive(Clone, Copy)]
struct Spectrum {
    side: usize,
    exponent: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Complex {
    re: f64,
    im: f64,
}

impl Spectrum {
    /// Wave number along one axis: 0 up to half the side, then from minus half back to -1.
    #[expect(clippy::cast_precision_loss, reason = "sides stay below 2^30")]
    fn wave_number(self, index: usize) -> f64 {
        if index <= self.side / 2 { index as f64 } else { index as f64 - self.side as f64 }
    }

    fn weight(self, row: usize, col: usize) -> f64 {
        let (ky, kx) = (self.wave_number(row), self.wave_number(col));
        let square = kx * kx + ky * ky;
        if square == 0.0 { 0.0 } else { libm::pow(square, 0.5 * self.exponent) }
    }

    /// The Fourier coefficients, and the sum of squared weights of each column.
    fn draw(self, draws: &mut Draws) -> (Vec<Complex>, Vec<f64>) {
        let mut column_powers = vec![0.0; self.side];
        let mut field = Vec::with_capacity(self.side * self.side);
        for row in 0..self.side {
            for (col, power) in column_powers.iter_mut().enumerate() {
                let weight = self.weight(row, col);
                *power += weight * weight;
                let [re, im] = draws.normal_pair();
                field.push(Complex { re: weight * re, im: weight * im });
            }
        }
        (field, column_powers)
    }

    /// Mean square of the difference at `lag` posts along a row: sum of weight^2 |exp(2 pi i k lag / side) - 1|^2, since the
    /// real part of a circular normal variable has half the variance of its modulus squared, which is 2.
    fn expected_square_deviation(self, column_powers: &[f64], lag: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "sides stay below 2^30")]
        let unit = std::f64::consts::TAU * lag / self.side as f64;
        let mut sum = 0.0;
        for (col, power) in column_powers.iter().enumerate() {
            let swing = 2.0 - 2.0 * libm::cos(unit * self.wave_number(col));
            sum += swing * power;
        }
        sum
    }
}

/// Inverse Fourier transform of a square field, not normalised: rows, then columns by transposing.
fn transform_square(field: &mut [Complex], side: usize) {
    let roots = roots_of_unity(side);
    for _ in 0..2 {
        for line in field.chunks_exact_mut(side) {
            transform_line(line, &roots);
        }
        for row in 1..side {
            for col in 0..row {
                field.swap(row * side + col, col * side + row);
            }
        }
    }
}

fn roots_of_unity(side: usize) -> Vec<Complex> {
    #[expect(clippy::cast_precision_loss, reason = "sides stay below 2^30")]
    let root = |index: usize| {
        let (im, re) = libm::sincos(std::f64::consts::TAU * index as f64 / side as f64);
        Complex { re, im }
    };
    (0..side / 2).map(root).collect()
}

/// The transform of Cooley and Tukey for a power of two, in place.
fn transform_line(line: &mut [Complex], roots: &[Complex]) {
    let length = line.len();
    let shift = usize::BITS - length.trailing_zeros();
    for index in 1..length {
        let turned = index.reverse_bits() >> shift;
        if index < turned {
            line.swap(index, turned);
        }
    }
    let mut half = 1;
    while half < length {
        let stride = length / (2 * half);
        for block in line.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (offset, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let root = roots[offset * stride];
                let turned = Complex { re: b.re * root.re - b.im * root.im, im: b.re * root.im + b.im * root.re };
                *b = Complex { re: a.re - turned.re, im: a.im - turned.im };
                *a = Complex { re: a.re + turned.re, im: a.im + turned.im };
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::cast_precision_loss, reason = "small numbers")]
    fn the_fast_transform_equals_the_plain_sum() {
        let mut draws = Draws::of(3, Layer::Ground);
        let side = 16;
        let line: Vec<Complex> = (0..side).map(|_| draws.normal_pair()).map(|[re, im]| Complex { re, im }).collect();
        let mut fast = line.clone();
        transform_line(&mut fast, &roots_of_unity(side));
        for (x, wave) in fast.iter().enumerate() {
            let (mut re, mut im) = (0.0, 0.0);
            for (k, value) in line.iter().enumerate() {
                let angle = std::f64::consts::TAU * (k * x) as f64 / side as f64;
                re += value.re * angle.cos() - value.im * angle.sin();
                im += value.re * angle.sin() + value.im * angle.cos();
            }
            assert!((wave.re - re).abs() < 1e-12 && (wave.im - im).abs() < 1e-12);
        }
    }

    #[test]
    fn the_deviation_grows_with_distance_as_stated() {
        let ground = FractalGround { hurst_exponent: 0.7, rms_deviation_m: 0.5, baseline_m: 4.0 };
        let canvas = Canvas { rows: 256, cols: 256, spacing_m: 2.0 };
        let deviation = |lag: usize| {
            let (mut sum, mut count) = (0.0_f64, 0.0);
            for seed in 0..6 {
                let mut heights = vec![0.0; 256 * 256];
                ground.add(&mut heights, canvas, seed).unwrap();
                for line in heights.chunks_exact(256) {
                    for col in 0..256 - lag {
                        sum += (line[col + lag] - line[col]).powi(2);
                        count += 1.0;
                    }
                }
            }
            (sum / count).sqrt()
        };
        // The baseline is two posts, where the deviation is set; H is measured between it and 16 posts, with the scatter of
        // six fields and a finite band.
        assert!((deviation(2) / 0.5 - 1.0).abs() < 0.05, "{}", deviation(2));
        let slope = (deviation(16) / deviation(2)).ln() / 8.0_f64.ln();
        assert!((slope - 0.7).abs() < 0.08, "{slope}");
    }
}
