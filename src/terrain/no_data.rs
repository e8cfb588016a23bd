//! No-data values: what a file or the user states, and how samples compare with it.

use crate::quantity::format_number;

/// A no-data value beyond this belongs to the "largest float" family, which programs print with as few as two digits.
///
/// No elevation is as large, so every sample beyond it on the same side is a gap.
const LARGEST_FLOAT_FAMILY: f64 = 1.0e30;

/// Half a unit of the last digit of a no-data text counts only beyond the elevations: -9999.3 m is not -9999 m.
const BEYOND_ELEVATIONS: f64 = super::ELEVATION_LIMIT_M;

/// A value that marks missing elevations, before it is cast to the samples' type.
///
/// # Examples
/// ```
/// use chta::terrain::NoData;
/// let mark: NoData = "-9999.9".parse()?;
/// assert!(mark.is_double(f64::from(-9999.9_f32))); // the same number, stored in 32 bits
/// assert!(!mark.is_double(-9999.0));
/// # Ok::<(), chta::terrain::InvalidNoData>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct NoData {
    value: f64,
    whole: Option<i128>,
    /// Half a unit of the last digit of the text.
    tolerance: f64,
}

/// A text that is neither a number nor `nan`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("found the no-data value '{found}', expected a number or nan")]
pub struct InvalidNoData {
    /// The beginning of the text.
    pub found: String,
}

impl std::str::FromStr for NoData {
    type Err = InvalidNoData;

    fn from_str(text: &str) -> Result<Self, InvalidNoData> {
        let trimmed = text.trim_matches(|letter: char| letter == '\0' || letter.is_whitespace());
        let lower = trimmed.to_ascii_lowercase();
        let value = if lower.contains("nan") || lower.contains("#ind") { Some(f64::NAN) } else { lower.parse().ok() };
        let value = value.ok_or_else(|| InvalidNoData { found: crate::quantity::excerpt(trimmed, 40) })?;
        Ok(Self { value, whole: trimmed.parse().ok(), tolerance: last_digit(&lower) / 2.0 })
    }
}

/// The value of one unit of the last digit of a decimal number; 0 for anything else.
pub(super) fn last_digit(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let Ok(exponent) = exponent.parse::<i32>() else { return 0.0 };
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
    i32::try_from(decimals).map_or(0.0, |decimals| 10_f64.powi(exponent.saturating_sub(decimals)))
}

impl From<f64> for NoData {
    /// A number, with the digits of its shortest text.
    fn from(value: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "taken only for whole numbers that a float represents")]
        let whole = (value.fract() == 0.0 && value.abs() < 9.0e15).then_some(value as i128);
        Self { value, whole, tolerance: last_digit(&format!("{value:e}")) / 2.0 }
    }
}

/// Equal are values that mark the same samples, whatever the digits of their texts.
impl PartialEq for NoData {
    fn eq(&self, other: &Self) -> bool {
        self.is_double(other.value) || other.is_double(self.value) || (self.value.is_nan() && other.value.is_nan())
    }
}

impl std::fmt::Display for NoData {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&format_number(self.value))
    }
}

impl NoData {
    /// The number; NaN for `nan`.
    pub const fn value(self) -> f64 {
        self.value
    }

    /// Whether the value is a number: NaN samples are gaps in any case.
    pub(super) fn is_a_number(self) -> bool {
        !self.value.is_nan()
    }

    /// Whether a 64-bit sample, or a number of a text, equals the no-data value.
    ///
    /// Equal are the same number, the same number in 32 bits, and beyond [`ELEVATION_LIMIT_M`](super::ELEVATION_LIMIT_M), where
    /// no elevation is mistaken, a number within half a unit of the last digit of the no-data text.
    #[expect(clippy::cast_possible_truncation, reason = "a sample that was once stored in 32 bits is compared in 32 bits")]
    pub fn is_double(self, sample: f64) -> bool {
        let size = self.value.abs();
        sample == self.value
            || (sample as f32 == self.value as f32 && size < BEYOND_ELEVATIONS && size > 0.0)
            || (size > BEYOND_ELEVATIONS && (sample - self.value).abs() <= self.tolerance)
            || (size > LARGEST_FLOAT_FAMILY && sample.abs() > LARGEST_FLOAT_FAMILY && sample.signum() == self.value.signum())
    }

    /// Whether a 32-bit sample equals the no-data value, which was cast the same way when the file was written.
    #[expect(clippy::cast_possible_truncation, reason = "the cast is the comparison meant")]
    pub(super) fn is_single(self, sample: f32) -> bool {
        sample == self.value as f32 || (self.value.abs() > BEYOND_ELEVATIONS && self.is_double(f64::from(sample)))
    }

    /// Whether an integer sample equals the no-data value.
    pub(super) fn is_whole(self, sample: i128) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "a value that is not an integer is compared as a float")]
        self.whole.map_or_else(|| sample as f64 == self.value, |whole| whole == sample)
    }
}

/// Which value marks missing elevations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NoDataRule {
    /// What the file, its sidecar files or its format state. A usual mark that nothing states is refused.
    #[default]
    AsStated,
    /// No value: all finite numbers are elevations, whatever the file states.
    Nothing,
    /// This value, in the numbers that are stored, whatever the file states.
    Value(NoData),
}

impl NoDataRule {
    /// The value in force, where the file states `stated`.
    pub(super) const fn in_force(self, stated: Option<NoData>) -> Option<NoData> {
        match self {
            Self::AsStated => stated,
            Self::Nothing => None,
            Self::Value(value) => Some(value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(text: &str) -> NoData {
        text.parse().unwrap()
    }

    #[test]
    fn no_data_is_compared_after_the_cast_that_wrote_it() {
        let lola = f32::from_bits(0xff7f_fffb);
        assert_eq!(f64::from(lola), -3.402_822_655_088_904_5e38);
        assert!(mark("-3.4028226550889045e+38").is_single(lola));
        assert!(mark("-3.4028227e+38").is_single(lola));
        assert!(mark("-3.40282e+38").is_single(f32::MIN));
        assert!(mark("-3.4e+38").is_single(f32::from_bits(0xff7f_c99e)));
        assert!(!mark("-9999").is_single(-9998.999));
        assert!(mark("0.1").is_single(0.1));
        assert!(mark("9223372036854775807").is_whole(i128::from(i64::MAX)));
        assert!(!mark("9223372036854775807").is_whole(i128::from(i64::MAX) - 1));
        assert!(mark("-32768.0").is_whole(-32768));
        assert!(mark("nan\0").value.is_nan() && mark("-1.#IND").value.is_nan());
        assert!(mark("-inf").is_double(f64::NEG_INFINITY));
        assert!("none".parse::<NoData>().is_err() && "".parse::<NoData>().is_err());
    }

    /// Pairs of a no-data text and a number as another text has it, each the same value with other digits, or another value.
    #[test]
    fn digits_of_the_text_are_the_tolerance() {
        for (text, number, same) in [
            ("-9999", -9999.0, true),
            ("-9999.9", -9_999.900_390_625, true),
            ("-9999", -9999.3, false),
            ("-9999", -9998.999, false),
            ("-3.40282e+38", f64::from(f32::MIN), true),
            ("-3.4028235e38", -3.4e38, true),
            ("-3.4e38", -3.403e38, true),
            ("1e38", 1.0e38, true),
            ("1e38", -1.0e38, false),
            ("-2.147484e9", -2_147_483_648.0, true),
            ("-2147483648", -2_147_483_647.0, false),
            ("-1.797693e308", f64::MIN, true),
            ("0", 1.0e-300, false),
            ("0", 0.0, true),
        ] {
            assert_eq!(mark(text).is_double(number), same, "{text} {number}");
            assert!(NoData::from(mark(text).value()).is_double(mark(text).value()), "{text}");
        }
    }
}
