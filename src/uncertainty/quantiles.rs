//! Quantiles of distances in bounded memory.

use serde::{Deserialize, Deserializer, Serialize, de::Error};

/// Bits of the significand that a bin keeps: 256 bins for each factor of two, each 0.4 % wide.
const KEPT_BITS: u32 = 8;
const DROPPED_BITS: u32 = f64::MANTISSA_DIGITS - 1 - KEPT_BITS;

/// Distances below this are counted as zero: a billionth of a metre is below the rounding of any position on a map.
const LEAST_M: f64 = 1e-9;

/// A histogram with bins of equal relative width for quantiles: log-linear, like `HdrHistogram`, with a bounded relative error,
/// like `DDSketch`.
///
/// A bin is the exponent and the first eight bits of the significand of a double, so it is found by a shift. A quantile is the
/// middle of its bin, within 1/512 (0.2 %) of the true order statistic; zero below a nanometre. Bins hold counts, so merging is
/// exact and independent of the order. Memory: 8 bytes per bin between the smallest and the largest value, 2 kB for each factor of
/// two.
///
/// ```
/// use chta::uncertainty::QuantileSketch;
/// let mut sketch = QuantileSketch::default();
/// (1..=1001).for_each(|i| sketch.add(f64::from(i)));
/// assert!((sketch.quantile(0.5).unwrap() / 501.0 - 1.0).abs() < 1.0 / 512.0);
/// assert_eq!(QuantileSketch::default().quantile(0.5), None);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct QuantileSketch {
    count: u64,
    zeros: u64,
    /// The number of the first bin.
    #[serde(deserialize_with = "bin")]
    first: u64,
    bins: Vec<u64>,
}

/// The number of a bin: no number of a finite double is greater.
fn bin<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    let found = u64::deserialize(deserializer)?;
    if found > f64::MAX.to_bits() >> DROPPED_BITS {
        return Err(D::Error::custom(format!("found the first bin {found}, expected that of a finite distance")));
    }
    Ok(found)
}

impl QuantileSketch {
    /// Counts a finite distance of at least 0.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        if value < LEAST_M {
            self.zeros += 1;
        } else {
            let bin = value.to_bits() >> DROPPED_BITS;
            let place = self.place(bin);
            self.bins[place] += 1;
        }
    }

    /// The index of a bin, which is created if needed.
    fn place(&mut self, bin: u64) -> usize {
        let to_index = |bins: u64| usize::try_from(bins).unwrap_or(usize::MAX);
        if self.bins.is_empty() {
            self.first = bin;
        }
        if bin < self.first {
            let missing = to_index(self.first - bin);
            self.bins.splice(0..0, std::iter::repeat_n(0, missing));
            self.first = bin;
        }
        let place = to_index(bin - self.first);
        if place >= self.bins.len() {
            self.bins.resize(place + 1, 0);
        }
        place
    }

    /// Adds another sketch's counts.
    pub fn merge(&mut self, other: &Self) {
        self.count = self.count.saturating_add(other.count);
        self.zeros = self.zeros.saturating_add(other.zeros);
        if let Some(last) = (other.bins.len() as u64).checked_sub(1) {
            let (begin, _) = (self.place(other.first), self.place(other.first + last));
            let begin = if self.first < other.first { begin } else { 0 };
            for (mine, theirs) in self.bins[begin..].iter_mut().zip(&other.bins) {
                *mine = mine.saturating_add(*theirs);
            }
        }
    }

    /// The number of values counted.
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// The value of rank `share * (count - 1)`, rounded down; `None` without values.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a rank from a share")]
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let last = self.count.checked_sub(1)?;
        let rank = ((last as f64 * share) as u64).min(last);
        let mut below = self.zeros;
        if rank < below {
            return Some(0.0);
        }
        for (&count, bin) in self.bins.iter().zip(self.first..) {
            below += count;
            if rank < below {
                let edge = |bin: u64| f64::from_bits(bin << DROPPED_BITS);
                return Some(0.5 * (edge(bin) + edge(bin + 1)));
            }
        }
        None
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts")]
mod tests {
    use super::*;

    /// Values over twelve decades in a scrambled order.
    fn values() -> Vec<f64> {
        (0..5000u64).map(|i| libm::exp(((i * 7919) % 5000) as f64 / 5000.0 * 28.0 - 20.0)).collect()
    }

    #[test]
    fn quantiles_are_within_their_bound_of_the_sorted_values() {
        let mut sorted = values();
        let mut sketch = QuantileSketch::default();
        for &value in &sorted {
            sketch.add(value);
        }
        sorted.sort_by(f64::total_cmp);
        for share in [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0] {
            let exact = sorted[(share * 4999.0) as usize];
            let found = sketch.quantile(share).unwrap();
            if exact < LEAST_M {
                assert_eq!(found, 0.0);
            } else {
                assert!((found / exact - 1.0).abs() <= 1.0 / 512.0, "{share}: {found} for {exact}");
            }
        }
    }

    #[test]
    fn merged_parts_equal_the_whole_in_any_order() {
        let values = values();
        let of = |part: &[f64]| {
            let mut sketch = QuantileSketch::default();
            for &value in part {
                sketch.add(value);
            }
            sketch
        };
        let whole = of(&values);
        for cut in [0, 1, 700, 4999] {
            let (a, b) = (of(&values[..cut]), of(&values[cut..]));
            let merged = |first: &QuantileSketch, second: &QuantileSketch| {
                let mut sum = first.clone();
                sum.merge(second);
                sum
            };
            assert_eq!(merged(&a, &b), whole, "cut at {cut}");
            assert_eq!(merged(&b, &a), whole, "cut at {cut}, the other way round");
        }
    }
}
