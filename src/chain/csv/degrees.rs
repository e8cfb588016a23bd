//! Lossless text of angles in degrees.
//!
//! Degrees are converted to radians by one product, `d * (pi/180)`. Where this product stretches the significand by 1.117,
//! neighbouring doubles of degrees are 1.117 doubles of radians apart, so one radian double in eleven is not the product of
//! any double of degrees. Such an angle is written with more digits than a double holds; the reader adds the digits beyond
//! the double before it rounds.

use std::f64::consts::PI;

use super::write::number_text;
use crate::quantity::Angle;

/// The factor of [`f64::to_radians`].
const RADIANS_PER_DEGREE: f64 = PI / 180.0;

/// The most digits that a double needs; longer text means an angle between two doubles.
const DOUBLE_DIGITS: usize = 17;

/// The digits used of longer text: more than the 25 that any angle needs, fewer than the 38 of an `i128`.
const LONGEST_DIGITS: usize = 31;

/// Below this many degrees the part beyond a double would be subnormal. Such an angle is written as a double of degrees; if
/// no double of degrees gives it exactly, the text is off by one ulp, a relative error of some 1e-16.
const LONG_TEXT_MIN_DEG: f64 = 1e-270;

/// A decimal number `mantissa * 10^exponent`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Decimal {
    mantissa: i128,
    exponent: i32,
    /// Significant digits of the text.
    digits: usize,
}

impl Decimal {
    /// Parses text that [`f64`] accepts as a finite number; digits beyond [`LONGEST_DIGITS`] are dropped.
    fn parse(text: &str) -> Option<Self> {
        let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (negative, unsigned) = match number.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, number.strip_prefix('+').unwrap_or(number)),
        };
        let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
        let mut parsed = Self { mantissa: 0, exponent: exponent.parse().ok()?, digits: 0 };
        for (place, digit) in whole.chars().chain(fraction.chars()).enumerate() {
            let after_point = place >= whole.len();
            if parsed.digits < LONGEST_DIGITS {
                parsed.mantissa = parsed.mantissa * 10 + i128::from(digit.to_digit(10)?);
                parsed.digits += usize::from(parsed.mantissa != 0);
                parsed.exponent = parsed.exponent.checked_sub(i32::from(after_point))?;
            } else {
                parsed.exponent = parsed.exponent.checked_add(i32::from(!after_point))?;
            }
        }
        parsed.mantissa = if negative { -parsed.mantissa } else { parsed.mantissa };
        Some(parsed)
    }

    /// A double to [`LONGEST_DIGITS`] digits; the standard library prints each of them exactly.
    fn of_double(value: f64) -> Option<Self> {
        Self::parse(&format!("{value:.*e}", LONGEST_DIGITS - 1))
    }

    /// `self - other` as the nearest double; `None` if the two numbers are far apart.
    fn minus(self, other: Self) -> Option<f64> {
        let exponent = self.exponent.min(other.exponent);
        let aligned = |d: Self| {
            let shift = u32::try_from(d.exponent.checked_sub(exponent)?).ok()?;
            d.mantissa.checked_mul(10_i128.checked_pow(shift)?)
        };
        let difference = aligned(self)?.checked_sub(aligned(other)?)?;
        format!("{difference}e{exponent}").parse().ok()
    }

    /// The text of this number, rounded to fewer digits.
    fn text(self, digits: usize) -> Option<String> {
        let drop = u32::try_from(self.digits.checked_sub(digits)?).ok()?;
        let unit = 10_i128.checked_pow(drop)?;
        let rounded = (self.mantissa.abs() + unit / 2) / unit;
        let all = rounded.to_string();
        let sign = if self.mantissa < 0 { "-" } else { "" };
        let exponent = self.exponent + i32::try_from(drop).ok()?;
        // The power of ten of the first digit.
        let first = exponent + i32::try_from(all.len()).ok()? - 1;
        let split = usize::try_from(first).ok().and_then(|first| all.split_at_checked(first + 1));
        Some(match split {
            Some((whole, fraction)) if !fraction.is_empty() => format!("{sign}{whole}.{fraction}"),
            None if (-5..0).contains(&first) => format!("{sign}0.{}{all}", "0".repeat(usize::try_from(-1 - first).ok()?)),
            _ => format!("{sign}{all}e{exponent}"),
        })
    }
}

/// The angle that `text` gives in degrees; `degrees` is the same text parsed as a finite double.
pub(super) fn read_degrees(text: &str, degrees: f64) -> Angle {
    let beyond_double = || {
        let stated = Decimal::parse(text).filter(|stated| stated.digits > DOUBLE_DIGITS && degrees.abs() >= LONG_TEXT_MIN_DEG)?;
        stated.minus(Decimal::of_double(degrees)?)
    };
    match beyond_double() {
        None => Angle::from_degrees(degrees),
        Some(rest) => {
            let rounded = degrees * RADIANS_PER_DEGREE;
            let lost = libm::fma(degrees, RADIANS_PER_DEGREE, -rounded);
            Angle::from_radians(rounded + (lost + rest * RADIANS_PER_DEGREE))
        }
    }
}

/// Text of an angle in degrees that reads back as the same double of radians (from [`LONG_TEXT_MIN_DEG`] up); `None` if the
/// angle is not finite.
pub(super) fn degrees_text(angle: Angle) -> Option<String> {
    if let Some(degrees) = angle.shortest_degrees() {
        return Some(number_text(degrees));
    }
    let degrees = angle.degrees();
    degrees.is_finite().then(|| longer_text(angle, degrees).unwrap_or_else(|| number_text(degrees)))
}

/// The shortest text of more than 17 digits that reads back exactly.
fn longer_text(angle: Angle, degrees: f64) -> Option<String> {
    let rounded = degrees * RADIANS_PER_DEGREE;
    let lost = libm::fma(degrees, RADIANS_PER_DEGREE, -rounded);
    let rest = ((angle.radians() - rounded) - lost) / RADIANS_PER_DEGREE;
    let double = Decimal::of_double(degrees)?;
    // `rest` in units of the last digit: some 1e15 units, which a double represents well enough.
    let unit: f64 = format!("1e{}", double.exponent).parse().ok()?;
    let units: i128 = format!("{:.0}", rest / unit).parse().ok()?;
    let exact = Decimal { mantissa: double.mantissa.checked_add(units)?, ..double };
    (DOUBLE_DIGITS + 1..LONGEST_DIGITS).find_map(|digits| {
        let text = exact.text(digits)?;
        let number: f64 = text.parse().ok()?;
        (read_degrees(&text, number).radians() == angle.radians()).then_some(text)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Angle {
        read_degrees(text, text.parse().unwrap())
    }

    #[test]
    fn short_text_is_the_double_it_names() {
        for (text, degrees) in
            [("63.5", 63.5), ("-90", -90.0), ("1e-3", 1e-3), ("0.1", 0.1), ("63.499999999999986", 63.5_f64.next_down().next_down())]
        {
            assert_eq!(read(text), Angle::from_degrees(degrees));
        }
        assert_eq!(degrees_text(Angle::from_degrees(63.5)).unwrap(), "63.5");
        assert_eq!(degrees_text(Angle::from_radians(f64::NAN)), None);
        assert_eq!(degrees_text(Angle::from_radians(f64::INFINITY)), None);
    }

    /// Every tenth of a degree from -270 to 270 is written without extra digits.
    #[test]
    fn tenths_of_a_degree_stay_short() {
        for tenths in -2700..=2700 {
            let text = number_text(f64::from(tenths) / 10.0);
            let written = degrees_text(read(&text)).unwrap();
            assert!(written.len() <= text.len(), "{text} was written as {written}");
            assert_eq!(read(&written), read(&text));
        }
    }

    /// Some doubles of radians have no double of degrees; they must survive writing and reading.
    #[test]
    fn unreachable_radians_take_more_digits() {
        let mut longer = 0;
        let mut radians = 1.2_f64;
        for _ in 0..2000 {
            radians = radians.next_up();
            let angle = Angle::from_radians(radians);
            let text = degrees_text(angle).unwrap();
            assert_eq!(read(&text).radians(), radians, "{text}");
            longer += usize::from(Decimal::parse(&text).unwrap().digits > DOUBLE_DIGITS);
        }
        // 1 - 1/1.117 = 10.5 % of the doubles here.
        assert!((190..230).contains(&longer), "{longer} of 2000 angles needed more digits");
    }

    #[test]
    fn trailing_zeros_do_not_change_the_angle() {
        assert_eq!(read("63.500000000000000000000000000000000000000000000"), Angle::from_degrees(63.5));
        assert_eq!(read("0.00000000000000000000000000000"), Angle::from_degrees(0.0));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn angles_read_back_as_they_were(exponent in -268.0..0.67_f64, significand in 1.0..2.0_f64, negative: bool) {
            let size = (significand * 10.0_f64.powf(exponent)).min(4.71);
            let angle = Angle::from_radians(if negative { -size } else { size });
            let text = degrees_text(angle).unwrap();
            prop_assert_eq!(read(&text).radians(), angle.radians(), "{}", text);
        }

        #[test]
        fn usual_angles_read_back_as_they_were(radians in -4.7..4.7_f64) {
            let text = degrees_text(Angle::from_radians(radians)).unwrap();
            prop_assert_eq!(read(&text).radians(), radians, "{}", text);
        }

        /// Any text that is a number gives an angle near the one that the parsed double gives.
        #[test]
        fn long_text_stays_near_the_parsed_double(text in "[+-]?[0-9]{0,40}\\.[0-9]{1,40}(e-?[0-9]{1,2})?") {
            let number: f64 = text.parse().unwrap();
            let (angle, plain) = (read(&text).radians(), Angle::from_degrees(number).radians());
            prop_assert!((angle - plain).abs() <= 2.3e-16 * plain.abs(), "{} gave {}, expected {}", text, angle, plain);
        }
    }
}
