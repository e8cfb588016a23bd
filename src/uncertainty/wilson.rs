//! A proportion with its confidence interval.

/// The standard normal's 97.5 % quantile, to the nearest double.
pub(super) const Z_95: f64 = 1.959_963_984_540_054;

/// A proportion of successes with its 95 % interval by Wilson's score.
///
/// ```text
///     (p + z^2/2n -+ z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n)
/// ```
///
/// Source: Wilson, J. Am. Stat. Assoc. 22, 1927. Unlike the normal approximation, it is valid for proportions close to 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wilson {
    /// The proportion; 0 without trials.
    pub rate: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Wilson {
    /// The interval for a number of successes in a number of trials; 0 to 1 without trials.
    ///
    /// # Examples
    /// ```
    /// use chta::uncertainty::Wilson;
    /// // The classic: 0 of 10.
    /// let none = Wilson::of(0, 10);
    /// assert!(none.low == 0.0 && (none.high - 0.277_532_799_862_888_6).abs() < 1e-12);
    /// // 8 of 10: 0.490 to 0.943
    /// let most = Wilson::of(8, 10);
    /// assert!((most.low - 0.490_162_47).abs() < 1e-8 && (most.high - 0.943_317_85).abs() < 1e-8);
    /// ```
    #[expect(clippy::cast_precision_loss, reason = "fewer trials than 2^53")]
    pub fn of(successes: u64, trials: u64) -> Self {
        if trials == 0 {
            return Self { rate: 0.0, low: 0.0, high: 1.0 };
        }
        let n = trials as f64;
        let rate = successes as f64 / n;
        let z2 = Z_95 * Z_95;
        let centre = rate + z2 / (2.0 * n);
        let half = Z_95 * (rate * (1.0 - rate) / n + z2 / (4.0 * n * n)).sqrt();
        let scale = 1.0 + z2 / n;
        // The ends are exactly 0 and 1 if none or all succeed; rounding must not change them.
        let low = if successes == 0 { 0.0 } else { ((centre - half) / scale).max(0.0) };
        let high = if successes == trials { 1.0 } else { ((centre + half) / scale).min(1.0) };
        Self { rate, low, high }
    }

    /// Half the interval's width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high - self.low)
    }
}
