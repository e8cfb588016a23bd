//! Fixed draws that fill the space of a hop's errors evenly.

use super::draws::HopDraws;
use crate::quantity::normal_quantile;

/// The errors of one fixed draw, standard normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FixedDraw {
    /// Those of the hop.
    pub(crate) hop: HopDraws,
    /// Of the take-off position, along and across (on a map east and north).
    pub(crate) takeoff: [f64; 2],
    /// Of the friction coefficient.
    pub(crate) friction: f64,
}

/// A number of draws from an Owen-scrambled Sobol sequence, the same for every question.
///
/// A share estimated from them has an error of some `1 / count` where pseudo-random draws have `1 / sqrt(count)`. `count` should be a
/// power of two, for which every one of the `count` equal slices of each error holds one draw.
pub(crate) fn fixed_draws(count: u32) -> Vec<FixedDraw> {
    let normal = |draw: u32, dimension: u32| {
        // The samples are multiples of 2^-24; half a step more keeps them off 0.
        let share = f64::from(sobol_burley::sample(draw, dimension, SCRAMBLE)) + 0.5 / f64::from(1 << 24);
        normal_quantile(share)
    };
    let draw = |i: u32| {
        let pair = |first: u32| [normal(i, first), normal(i, first + 1)];
        FixedDraw {
            hop: HopDraws { speed: pair(0), direction: pair(2), drift: pair(4), position: [0.0; 2] },
            takeoff: pair(6),
            friction: normal(i, 8),
        }
    };
    (0..count).map(draw).collect()
}

/// The scrambling of the sequence. A fixed one makes answers repeat; of 200 000 this one has the least correlation between any two of its
/// first fourteen dimensions: 0.12 over 64 draws and half of that over 256, where most have 0.3.
const SCRAMBLE: u32 = 102_774;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::normal_cdf;

    #[test]
    fn every_slice_of_every_error_holds_one_draw() {
        for count in [64, 256] {
            let draws = fixed_draws(count);
            let columns: [fn(&FixedDraw) -> f64; 9] = [
                |d| d.hop.speed[0],
                |d| d.hop.speed[1],
                |d| d.hop.direction[0],
                |d| d.hop.direction[1],
                |d| d.hop.drift[0],
                |d| d.hop.drift[1],
                |d| d.takeoff[0],
                |d| d.takeoff[1],
                |d| d.friction,
            ];
            for (number, column) in columns.iter().enumerate() {
                let mut filled = vec![0; count as usize];
                for draw in &draws {
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a slice, from 0 to count - 1")]
                    let slice = (normal_cdf(column(draw)) * f64::from(count)) as usize;
                    filled[slice] += 1;
                }
                assert!(filled.iter().all(|&draws| draws == 1), "error {number} of {count} draws: {filled:?}");
            }
            // Two errors are not tied to one another.
            let mean = |product: &dyn Fn(&FixedDraw) -> f64| draws.iter().map(product).sum::<f64>() / f64::from(count);
            for (i, a) in columns.iter().enumerate() {
                for b in &columns[..i] {
                    let correlation = mean(&|draw| a(draw) * b(draw));
                    let most = if count == 64 { 0.125 } else { 0.0625 };
                    assert!(correlation.abs() < most, "{correlation} over {count} draws");
                }
            }
        }
    }
}
