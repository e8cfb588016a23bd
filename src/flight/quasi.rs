//! Fixed draws that fill the space of a hop's errors evenly.

use super::{Distribution, draws::HopDraws};

/// The errors of one fixed draw, of mean 0 and deviation 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FixedDraw {
    /// Those of the hop.
    pub(crate) hop: HopDraws,
    /// Of the take-off position, along and across (on a map east and north).
    pub(crate) takeoff: [f64; 2],
    /// Of the friction coefficient.
    pub(crate) friction: f64,
    /// The biases: of speed, take-off angle and heading.
    pub(crate) biases: [f64; 3],
    /// The measured row, as a share of all rows in (0, 1).
    pub(crate) row: f64,
}

/// A number of draws from an Owen-scrambled Sobol sequence, the same for every question.
///
/// A share estimated from them has an error of some `1 / count` where pseudo-random draws have `1 / sqrt(count)`. `count` should be a
/// power of two, for which every one of the `count` equal slices of each error holds one draw.
///
/// `distribution`: that of the errors of the hop and of the biases; `of_takeoffs`: that of the take-off position.
pub(crate) fn fixed_draws(count: u32, distribution: Distribution, of_takeoffs: Distribution) -> Vec<FixedDraw> {
    // The samples are multiples of 2^-24; half a step more keeps them off 0.
    let share = |draw: u32, dimension: u32| f64::from(sobol_burley::sample(draw, dimension, SCRAMBLE)) + 0.5 / f64::from(1 << 24);
    let draw = |i: u32| {
        let one = |dimension: u32| distribution.standard_quantile(share(i, dimension));
        let pair = |first: u32| [one(first), one(first + 1)];
        FixedDraw {
            hop: HopDraws { speed: pair(0), direction: pair(2), drift: pair(4), position: [0.0; 2] },
            takeoff: [6, 7].map(|dimension| of_takeoffs.standard_quantile(share(i, dimension))),
            friction: Distribution::Normal.standard_quantile(share(i, 8)),
            biases: [9, 10, 11].map(one),
            row: share(i, 12),
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
    use crate::quantity::{normal_cdf, normal_quantile};

    #[test]
    fn every_slice_of_every_error_holds_one_draw() {
        for count in [64, 256] {
            let draws = fixed_draws(count, Distribution::Normal, Distribution::Normal);
            let columns: [fn(&FixedDraw) -> f64; 13] = [
                |d| d.hop.speed[0],
                |d| d.hop.speed[1],
                |d| d.hop.direction[0],
                |d| d.hop.direction[1],
                |d| d.hop.drift[0],
                |d| d.hop.drift[1],
                |d| d.takeoff[0],
                |d| d.takeoff[1],
                |d| d.friction,
                |d| d.biases[0],
                |d| d.biases[1],
                |d| d.biases[2],
                |d| normal_quantile(d.row),
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

    /// A change of these bits changes every estimate.
    #[test]
    fn the_first_nine_errors_of_64_draws_keep_their_bits() {
        let draws = fixed_draws(64, Distribution::Normal, Distribution::Normal);
        let bytes = draws.iter().flat_map(|draw| {
            let errors = [draw.hop.speed, draw.hop.direction, draw.hop.drift, draw.takeoff].concat();
            errors.into_iter().chain([draw.friction]).flat_map(|error| error.to_bits().to_le_bytes())
        });
        // The hash of Fowler, Noll and Vo.
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        assert_eq!(hash, 0xc448_9d29_81f0_9d97, "{hash:#x}");
    }
}
