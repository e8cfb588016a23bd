//! The difference of two proportions over the same trials.

use super::wilson::Z_95;

/// The difference of two success rates over the same trials with its 95 % interval.
///
/// With b trials that only the second experiment survives and c that only the first survives, of n:
///
/// ```text
///     d = (b - c) / n,    interval about d' = (b' - c') / n':  d' -+ z sqrt(b' + c' - (b' - c')^2 / n') / n'
/// ```
///
/// with b' = b + 1/2, c' = c + 1/2, n' = n + 2. Source: Agresti and Min, Statistics in Medicine 24, 2005, the adjusted Wald interval for
/// matched pairs: unlike the plain one it is no point where no trial differs. The trials that both survive, or neither, cancel, so that
/// common draws tell a small difference that separate draws would not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedDifference {
    /// The rate of the second minus that of the first; 0 without trials.
    pub difference: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl PairedDifference {
    /// The difference of `trials` trials, of which `only_second` succeed in the second experiment alone and `only_first` in the first alone;
    /// -1 to 1 without trials.
    ///
    /// # Examples
    /// ```
    /// use chta::uncertainty::PairedDifference;
    /// let found = PairedDifference::of(30, 10, 1000);
    /// assert!((found.difference - 0.02).abs() < 1e-15);
    /// // sqrt(41 - 20^2 / 1002) = 6.372; 1.96 x 6.372 / 1002 = 0.01246 about 20 / 1002.
    /// assert!((found.low - 0.00750).abs() < 1e-5 && (found.high - 0.03242).abs() < 1e-5, "{found:?}");
    /// ```
    #[expect(clippy::cast_precision_loss, reason = "fewer trials than 2^53")]
    pub fn of(only_second: u64, only_first: u64, trials: u64) -> Self {
        if trials == 0 {
            return Self { difference: 0.0, low: -1.0, high: 1.0 };
        }
        let (b, c, n) = (only_second as f64, only_first as f64, trials as f64);
        let (sum, more, of) = (b + c + 1.0, b - c, n + 2.0);
        let half = Z_95 * (sum - more * more / of).max(0.0).sqrt() / of;
        let middle = more / of;
        Self { difference: (b - c) / n, low: (middle - half).max(-1.0), high: (middle + half).min(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of many samples of 400 pairs the interval holds the true difference in about 95 of 100.
    #[test]
    fn the_interval_holds_the_true_difference_as_often_as_it_says() {
        let mut draw = crate::draw::Draw::seeded(3);
        for (second, first) in [(0.02, 0.0), (0.05, 0.03), (0.3, 0.1), (0.01, 0.01)] {
            let samples = 2000;
            let held = (0..samples).filter(|_| {
                let (mut b, mut c) = (0, 0);
                for _ in 0..400 {
                    let share = draw.uniform(0.0, 1.0);
                    b += u64::from(share < second);
                    c += u64::from((second..second + first).contains(&share));
                }
                let found = PairedDifference::of(b, c, 400);
                (found.low..=found.high).contains(&(second - first))
            });
            let held = held.count();
            assert!((1860..=1990).contains(&held), "{second} against {first}: {held} of {samples}");
        }
    }
}
