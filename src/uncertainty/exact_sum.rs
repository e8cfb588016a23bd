//! Sums of floating-point numbers that do not depend on the order of their terms.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// Bits of the exponents that share a block: the terms of a block, shifted to a common exponent, have at most 84 bits, so that 2^43 of
/// them fit into 128.
const BLOCK_BITS: u32 = 32;

/// One more than the last block: exponents of doubles have 11 bits.
const BLOCKS: u8 = 64;

/// The exponent of the last bit of a subnormal double.
const LAST_BIT: i32 = -1074;

/// The exact sum of finite doubles: any order of terms and any grouping give the same sum, rounded once.
///
/// Every term is a whole multiple of `2^-1074`. Terms whose exponents lie within the same 32 are added as whole numbers of 128 bits
/// (Kulisch's long accumulator, divided into blocks). Memory: 32 bytes for every block that occurs, one to three in practice.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct ExactSum(Vec<(u8, i128)>);

impl ExactSum {
    /// Adds a finite number; others, which no landing has, are not counted.
    pub(super) fn add(&mut self, number: f64) {
        debug_assert!(number.is_finite(), "{number} has no exact sum");
        if number == 0.0 || !number.is_finite() {
            return;
        }
        let bits = number.to_bits();
        let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        let (significand, shift) = if exponent == 0 { (fraction, 0) } else { (fraction | (1 << 52), exponent - 1) };
        let block = u8::try_from(shift / u64::from(BLOCK_BITS)).unwrap_or(BLOCKS - 1);
        let whole = i128::from(significand) << (shift % u64::from(BLOCK_BITS));
        self.add_to(block, if number < 0.0 { -whole } else { whole });
    }

    fn add_to(&mut self, block: u8, whole: i128) {
        match self.0.binary_search_by_key(&block, |(block, _)| *block) {
            Ok(place) => self.0[place].1 = self.0[place].1.saturating_add(whole),
            Err(place) => self.0.insert(place, (block, whole)),
        }
    }

    /// Adds all terms of another sum.
    pub(super) fn merge(&mut self, other: &Self) {
        for &(block, whole) in &other.0 {
            self.add_to(block, whole);
        }
    }

    /// The sum, rounded to the nearest double.
    pub(super) fn value(&self) -> f64 {
        let (digits, is_negative) = self.digits(1);
        if is_negative { -magnitude(&self.digits(-1).0) } else { magnitude(&digits) }
    }

    /// The sum times `sign` as digits of 32 bits from the lowest, and whether it is below zero.
    fn digits(&self, sign: i128) -> (Vec<u32>, bool) {
        let mut carry = 0_i128;
        let mut blocks = self.0.iter().peekable();
        let digits = (0..BLOCKS + 4).map(|block| {
            let whole = blocks.next_if(|(found, _)| *found == block).map_or(0, |(_, whole)| *whole);
            let digit = carry + sign * whole;
            carry = digit >> BLOCK_BITS;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the lowest 32 bits")]
            let low = digit as u32;
            low
        });
        (digits.collect(), carry < 0)
    }
}

/// A number of such digits, rounded to the nearest double, ties to even.
fn magnitude(digits: &[u32]) -> f64 {
    let Some(top) = digits.iter().rposition(|digit| *digit != 0) else { return 0.0 };
    // The first three digits hold at least 65 bits; what lies below only decides ties.
    let digit = |below: usize| top.checked_sub(below).map_or(0, |place| u128::from(digits[place]));
    let first = (digit(0) << 64) | (digit(1) << 32) | digit(2);
    let below = u128::from(digits[..top.saturating_sub(2)].iter().any(|digit| *digit != 0));
    #[expect(clippy::cast_precision_loss, reason = "rounds to the nearest")]
    let rounded = (first | below) as f64;
    let exponent = i32::try_from(top).unwrap_or(i32::MAX).saturating_sub(2).saturating_mul(32).saturating_add(LAST_BIT);
    libm::ldexp(rounded, exponent)
}

impl Serialize for ExactSum {
    /// A list of `[block, sum]`; the sums are texts, since JSON readers keep no 128 bits.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(|(block, whole)| (block, whole.to_string())))
    }
}

impl<'de> Deserialize<'de> for ExactSum {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut sum = Self::default();
        for (block, whole) in Vec::<(u8, String)>::deserialize(deserializer)? {
            let whole = whole.parse::<i128>().ok().filter(|_| block < BLOCKS);
            sum.add_to(block, whole.ok_or_else(|| D::Error::custom("found no block of an exact sum"))?);
        }
        Ok(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::ToPrimitive;

    fn sum(terms: &[f64]) -> ExactSum {
        let mut sum = ExactSum::default();
        for term in terms {
            sum.add(*term);
        }
        sum
    }

    #[test]
    fn the_sum_is_that_of_exact_arithmetic_in_any_order() {
        let mut draw = crate::draw::Draw::seeded(7);
        for _ in 0..300 {
            let scale = draw.uniform(-40.0, 40.0);
            let mut terms: Vec<f64> =
                (0..=draw.below(40)).map(|_| draw.uniform(-1.0, 1.0) * libm::exp2(draw.uniform(scale - 60.0, scale))).collect();
            if draw.below(3) == 0 {
                // Nearly all cancel.
                let opposite: Vec<f64> = terms.iter().skip(1).map(|term| -term).collect();
                terms.extend(opposite);
            }
            let exact: BigRational = terms.iter().filter_map(|term| BigRational::from_float(*term)).sum();
            let found = sum(&terms);
            let nearest = exact.to_f64().unwrap();
            assert!((found.value() - nearest).abs() <= f64::EPSILON * nearest.abs(), "{terms:?}");
            // Correctly rounded: no neighbour is nearer.
            let off = |value: f64| {
                let off = BigRational::from_float(value).unwrap() - &exact;
                if off < BigRational::from_integer(0.into()) { -off } else { off }
            };
            assert!(off(found.value()) <= off(found.value().next_up()) && off(found.value()) <= off(found.value().next_down()));
            let cut = draw.below(terms.len());
            let (mut last, first) = (sum(&terms[cut..]), sum(&terms[..cut]));
            last.merge(&first);
            assert_eq!(last, found);
            let text = serde_json::to_string(&found).unwrap();
            assert_eq!(serde_json::from_str::<ExactSum>(&text).unwrap(), found);
        }
    }

    #[test]
    fn ends_of_the_range_are_exact() {
        let tiny = f64::from_bits(1);
        for (terms, expected) in [
            (vec![], 0.0),
            (vec![tiny, tiny], f64::from_bits(2)),
            (vec![f64::MAX, tiny, -f64::MAX], tiny),
            (vec![f64::MAX, f64::MAX], f64::INFINITY),
            (vec![1e300, 1.0, -1e300, -1.0, -3.5], -3.5),
        ] {
            assert_eq!(sum(&terms).value(), expected, "{terms:?}");
        }
    }
}
