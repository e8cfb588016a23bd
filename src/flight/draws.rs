//! The random draws of one trial: a function of seed and trial number only.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use super::Distribution;
use crate::quantity::standard_normals;

/// 32-bit words in a block of the cipher: eight draws of 64 bits, as many as one hop uses.
const WORDS_PER_BLOCK: u128 = 16;

/// The first block of the draws of the whole trial: no trial has so many hops.
const WHOLE_TRIAL: u128 = 1 << 40;

/// The first block of the draws of measured rows, one for each hop: no height field has so many waves.
const ROWS: u128 = 1 << 41;

/// The first block of the draws of uncontrolled headings, one for each hop: there are no so many rows.
const HEADINGS: u128 = 1 << 42;

/// 32-bit words of the draws of friction, behind which those of the biases follow.
const WORDS_OF_FRICTION: u128 = 4;

/// The stream of one trial.
///
/// ```text
///   block 0, 1, 2 ..      hop 1, 2, 3 ..: speed (2 draws), direction (2), drift (2), position (2)
///   block 2^40            friction (2), biases of speed and take-off angle (2), of heading (2)
///   blocks from 2^40 + 4  terrain height (4 for each wave)
///   blocks from 2^41      measured rows (1 for each hop)
///   blocks from 2^42      uncontrolled headings (1 for each hop)
/// ```
///
/// Every hop uses its whole block, even if a deviation is zero and whatever the policy, so that runs with different deviations or
/// policies share the same draws.
pub(crate) struct TrialDraws {
    source: ChaCha8Rng,
    /// The same, at the draws of measured rows.
    rows: ChaCha8Rng,
    /// The same, at the draws of uncontrolled headings.
    headings: ChaCha8Rng,
}

/// Which pairs of errors are used, and their distribution; the others are set to zero without being computed.
#[derive(Clone, Copy, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "one for each pair of draws, all independent")]
pub(crate) struct Wanted {
    pub(crate) speed: bool,
    pub(crate) direction: bool,
    pub(crate) drift: bool,
    pub(crate) position: bool,
    pub(crate) distribution: Distribution,
}

/// Independent errors of one hop, of mean 0 and deviation 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HopDraws {
    /// For the absolute and the relative error of speed.
    pub(crate) speed: [f64; 2],
    /// For elevation and heading.
    pub(crate) direction: [f64; 2],
    /// For the bounce-and-roll displacement along and across.
    pub(crate) drift: [f64; 2],
    /// For the position estimate: along, or east, and north.
    pub(crate) position: [f64; 2],
}

impl TrialDraws {
    pub(crate) fn seeded(seed: u64) -> Self {
        let source = || ChaCha8Rng::seed_from_u64(seed);
        Self { source: source(), rows: source(), headings: source() }
    }

    /// Moves to the first hop of a trial.
    pub(crate) fn begin(&mut self, trial: u64) {
        self.source.set_stream(trial);
    }

    /// The draws of the next hop.
    pub(crate) fn hop(&mut self, wanted: Wanted) -> HopDraws {
        let mut pair = |is_wanted: bool| {
            let uniforms = [self.uniform(), self.uniform()];
            if is_wanted { wanted.distribution.standard_pair(uniforms) } else { [0.0; 2] }
        };
        HopDraws {
            speed: pair(wanted.speed),
            direction: pair(wanted.direction),
            drift: pair(wanted.drift),
            position: pair(wanted.position),
        }
    }

    /// The friction draw of a trial, a standard normal.
    pub(crate) fn friction(&mut self, trial: u64) -> f64 {
        self.source.set_stream(trial);
        self.source.set_word_pos(WHOLE_TRIAL * WORDS_PER_BLOCK);
        standard_normals([self.uniform(), self.uniform()])[0]
    }

    /// The biases of a trial, of mean 0 and deviation 1: of speed, take-off angle and heading.
    pub(crate) fn biases(&mut self, trial: u64, distribution: Distribution) -> [f64; 3] {
        self.source.set_stream(trial);
        self.source.set_word_pos(WHOLE_TRIAL * WORDS_PER_BLOCK + WORDS_OF_FRICTION);
        let [speed, angle] = distribution.standard_pair([self.uniform(), self.uniform()]);
        let [heading, _] = distribution.standard_pair([self.uniform(), self.uniform()]);
        [speed, angle, heading]
    }

    /// Moves to the measured row of the first hop of a trial.
    pub(crate) fn begin_rows(&mut self, trial: u64) {
        self.rows.set_stream(trial);
        self.rows.set_word_pos(ROWS * WORDS_PER_BLOCK);
    }

    /// The measured row of the next hop, as a share of all rows in [0, 1).
    pub(crate) fn row(&mut self) -> f64 {
        self.rows.random::<f64>()
    }

    /// Moves to the uncontrolled heading of the first hop of a trial.
    pub(crate) fn begin_headings(&mut self, trial: u64) {
        self.headings.set_stream(trial);
        self.headings.set_word_pos(HEADINGS * WORDS_PER_BLOCK);
    }

    /// The uncontrolled heading of the next hop, as a share of a whole turn in [0, 1).
    pub(crate) fn heading(&mut self) -> f64 {
        self.headings.random::<f64>()
    }

    /// Moves to the draws of a trial's height field; returns a source of uniforms in [0, 1).
    pub(crate) fn height_field(&mut self, trial: u64) -> impl FnMut() -> f64 + '_ {
        self.source.set_stream(trial);
        self.source.set_word_pos((WHOLE_TRIAL + 4) * WORDS_PER_BLOCK);
        || self.uniform()
    }

    /// A uniform in [0, 1): 53 random bits.
    fn uniform(&mut self) -> f64 {
        self.source.random::<f64>()
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small counts")]
mod tests {
    use super::*;

    const ALL: Wanted = Wanted { speed: true, direction: true, drift: true, position: true, distribution: Distribution::Normal };

    #[test]
    fn a_hop_takes_the_same_draws_whatever_else_is_wanted_or_came_before() {
        let mut draws = TrialDraws::seeded(5);
        draws.begin(17);
        let all: Vec<HopDraws> = (0..9).map(|_| draws.hop(ALL)).collect();
        let _ = draws.friction(17);
        let _ = draws.height_field(17)();
        let biases = draws.biases(17, Distribution::Normal);
        draws.begin_rows(17);
        let rows = [draws.row(), draws.row()];
        draws.begin_headings(17);
        let headings = [draws.heading(), draws.heading()];
        draws.begin(17);
        for known in &all {
            let drift = draws.hop(Wanted { drift: true, ..Wanted::default() });
            assert_eq!(drift, HopDraws { drift: known.drift, ..HopDraws::default() });
        }
        draws.begin_rows(17);
        assert_eq!((draws.biases(17, Distribution::Normal), [draws.row(), draws.row()]), (biases, rows));
        draws.begin_headings(17);
        assert!([draws.heading(), draws.heading()] == headings && headings[0] != headings[1] && headings[0] != rows[0]);
        draws.begin(18);
        assert_ne!(draws.hop(ALL), all[0]);
        draws.begin_rows(18);
        assert!(draws.row() != rows[0] && draws.biases(18, Distribution::Normal) != biases);
        let mut other = TrialDraws::seeded(6);
        other.begin(17);
        assert_ne!(other.hop(ALL), all[0]);
    }

    /// E x^4 of deviation 1: 3 for a normal error, 9/5 for a uniform one.
    #[test]
    fn errors_are_standard_and_uncorrelated_hop_by_hop_and_trial_by_trial() {
        for (distribution, of_fourth) in [(Distribution::Normal, 3.0), (Distribution::Uniform, 1.8)] {
            let mut draws = TrialDraws::seeded(1);
            let mut columns = [[0.0; 4]; 11];
            let count = 20_000;
            for trial in 0..count {
                let biases = draws.biases(trial, distribution);
                draws.begin(trial);
                let d = draws.hop(Wanted { distribution, ..ALL });
                let row: Vec<f64> = [d.speed, d.direction, d.drift, d.position].concat().into_iter().chain(biases).collect();
                for (i, column) in columns.iter_mut().enumerate() {
                    let (x, next) = (row[i], row[(i + 1) % 11]);
                    assert!(distribution == Distribution::Normal || x.abs() <= 3.0_f64.sqrt(), "{x}");
                    for (sum, value) in column.iter_mut().zip([x, x * x, x * x * x * x, x * next]) {
                        *sum += value / count as f64;
                    }
                }
            }
            // Five standard errors of each moment of 20 000 normals.
            for [mean, square, fourth, mixed] in columns {
                let is_standard = mean.abs() < 0.036 && (square - 1.0).abs() < 0.05 && mixed.abs() < 0.036;
                assert!(is_standard && (fourth - of_fourth).abs() < 0.35, "{distribution}: {mean} {square} {fourth} {mixed}");
            }
        }
    }

    /// A change of these bits changes every answer of trials.
    #[test]
    fn the_draws_of_a_trial_keep_their_bits() {
        let mut draws = TrialDraws::seeded(5);
        draws.begin(17);
        let first = draws.hop(ALL);
        let bits = [first.speed, first.direction, first.drift, first.position].concat();
        let expected: [u64; 8] = [
            0xbff7_3bc7_cae8_3833,
            0xbfc6_eb7f_5b98_cd34,
            0x3ff2_4a3e_4029_0c22,
            0xbfe1_2e1e_d6f8_73a3,
            0xbffc_7296_826b_aa62,
            0x3ffc_2cfb_d679_9c69,
            0xbff1_3f16_4a6e_3e8d,
            0xbff8_2afd_8d3b_fed5,
        ];
        assert_eq!(bits.into_iter().map(f64::to_bits).collect::<Vec<_>>(), expected);
        assert_eq!(draws.hop(ALL).position[1].to_bits(), 0xc005_0bcf_7235_dfc1);
        assert_eq!(draws.friction(17).to_bits(), 0xbfc1_2ba0_d1b7_4615);
        assert_eq!(draws.height_field(17)().to_bits(), 0x3fda_98ca_b2d5_6c58);
    }
}
