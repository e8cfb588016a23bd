//! Round numbers for axes, and numbers in texts.

/// Round numbers within a range.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Their values.
    pub(super) values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    /// Multiples of 1, 2 or 5 times a power of ten, at most `most` of them.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "exponents of f64 are small")]
    pub(super) fn round(from: f64, to: f64, most: f64) -> Self {
        let step = round_step((to - from) / most.max(1.0));
        let exponent = libm::floor(libm::log10(step) + 1e-9);
        let decimals = (-exponent).max(0.0) as usize;
        let first = (from / step - 1e-9).ceil();
        let mut values = Vec::new();
        let mut i = 0.0;
        while (first + i) * step <= to + 1e-9 * step && i < 200.0 {
            // Adding 0.0 turns -0 into 0.
            values.push((first + i) * step + 0.0);
            i += 1.0;
        }
        Self { values, decimals }
    }

    /// A tick's number.
    pub(super) fn text(&self, value: f64) -> String {
        format!("{value:.*}", self.decimals)
    }

    /// The number of characters of the longest number.
    pub(super) fn longest(&self) -> String {
        self.values.iter().map(|&v| self.text(v)).max_by_key(String::len).unwrap_or_default()
    }
}

/// The least of 1, 2, 5 times a power of ten that is at least the given value.
fn round_step(least: f64) -> f64 {
    let least = if least.is_finite() && least > 0.0 { least } else { 1.0 };
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|&step| step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// The least of 1, 2, 5, 10, 20, ... that is at least the given value, as n for writing every n-th number.
pub(super) fn one_in(least: f64) -> usize {
    [1, 2, 5, 10, 20, 50, 100, 200].into_iter().find(|&n| f64::from(n) >= least).map_or(500, |n: u16| n.into())
}

/// A number with four significant digits, without trailing zeros.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let exponent = libm::floor(libm::log10(value.abs()));
    if !(-3.0..7.0).contains(&exponent) {
        let text = format!("{value:.3e}");
        return match text.split_once('e') {
            Some((digits, power)) => format!("{}e{power}", trimmed(digits)),
            None => text,
        };
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 6")]
    let decimals = (3.0 - exponent).max(0.0) as usize;
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

/// A number without trailing zeros of its fraction.
fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let ticks = Ticks::round(-0.3, 76.2, 8.0);
        assert_eq!(ticks.values, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0]);
        let small = Ticks::round(800.0, 800.01, 5.0);
        assert_eq!(small.text(small.values[1]), "800.002");
        assert_eq!(Ticks::round(-1.0, 1.0, 2.0).text(0.0), "0");
    }

    #[test]
    fn short_numbers_keep_four_digits() {
        let written = [0.0, 3.711, 1.624_222, 76.0, 12_345.6, 6.12e-6, -0.5, 2.5e9].map(short);
        assert_eq!(written, ["0", "3.711", "1.624", "76", "12346", "6.12e-6", "-0.5", "2.5e9"]);
    }
}
