//! Texts that people mean as numbers but that the program's notation does not allow: decimal commas, separators of thousands,
//! typographic signs. The advice never chooses where a text has two meanings.

use super::excerpt;

/// Characters that separate groups of three digits: apostrophes, blanks (also those that do not break), underscores.
const GROUPERS: [char; 9] = ['\'', '\u{2019}', ' ', '\u{a0}', '\u{202f}', '\u{2007}', '\u{2009}', '_', '\u{fffd}'];

/// A number with a comma, read with the comma as the decimal sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DecimalComma {
    pub(crate) value: f64,
    /// Whether the comma cannot separate thousands: `0,125` and `1,25` are certain, `1,000` is not.
    pub(crate) certain: bool,
}

/// The number that a text means if its single comma is a decimal sign.
pub(crate) fn decimal_comma(text: &str) -> Option<DecimalComma> {
    let (whole, fraction) = text.split_once(',')?;
    if fraction.contains(',') || text.contains('.') || !fraction.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let value = format!("{whole}.{fraction}").parse().ok()?;
    let digits = whole.strip_prefix(['+', '-']).unwrap_or(whole);
    let group = fraction.len() == 3 && fraction.bytes().all(|byte| byte.is_ascii_digit());
    let certain = !(group && (1..=3).contains(&digits.len()) && !digits.starts_with('0'));
    Some(DecimalComma { value, certain })
}

/// How to mend a text that is not a number.
pub(crate) fn number_help(text: &str) -> String {
    let shown = |number: &str| excerpt(number, 40);
    if let Some(DecimalComma { certain, .. }) = decimal_comma(text) {
        let point = text.replacen(',', ".", 1);
        return if certain {
            format!("write a decimal point, not a comma: {}", shown(&point))
        } else {
            format!(
                "its comma separates thousands (then write {}) or decimals (then write {}): find out which, and write numbers with a \
                 decimal point and without separators of thousands",
                shown(&text.replacen(',', "", 1)),
                shown(&point)
            )
        };
    }
    if let Some(plain) = without_thousands(text) {
        return format!(
            "write it without separators of thousands and with a decimal point: {}; mend every number of the file in the same way, \
             also those that are read as they stand",
            shown(&plain)
        );
    }
    let ascii = text.replace(['\u{2212}', '\u{2013}', '\u{2010}', '\u{2011}'], "-");
    if ascii != text && ascii.parse::<f64>().is_ok() {
        return format!("write the minus sign as the hyphen of the keyboard: {}", shown(&ascii));
    }
    let exponent = text.replacen(['D', 'd'], "e", 1);
    if text.starts_with(is_number_start) && exponent != text && exponent.parse::<f64>().is_ok() {
        return format!("write the exponent with e: {}", shown(&exponent));
    }
    let number = text.trim_end_matches(|c: char| !(c.is_ascii_digit() || c == '.')).trim_end();
    if text.starts_with(is_number_start) && number.parse::<f64>().is_ok() {
        return format!("write the number alone, {}: its unit is given by the column's name", shown(number));
    }
    "write a plain number such as 12.5 or 1e-3".to_owned()
}

fn is_number_start(letter: char) -> bool {
    letter.is_ascii_digit() || "+-.".contains(letter)
}

/// The number of a text whose separators of thousands are beyond doubt: at least two of one kind, or one of a kind that is no
/// decimal sign, or a decimal sign after them.
fn without_thousands(text: &str) -> Option<String> {
    let (sign, unsigned) = match text.strip_prefix(['-', '+']) {
        Some(rest) => (text.get(..1)?, rest),
        None => ("", text),
    };
    let separator = unsigned.chars().find(|letter| !letter.is_ascii_digit())?;
    if !(GROUPERS.contains(&separator) || matches!(separator, ',' | '.')) {
        return None;
    }
    // The decimal sign is the last comma or point, if the groups have another separator.
    let decimal = unsigned.rfind([',', '.']).filter(|&at| !unsigned[at..].starts_with(separator));
    let (groups, fraction) = decimal.map_or((unsigned, None), |at| (&unsigned[..at], unsigned.get(at + 1..)));
    let parts: Vec<&str> = groups.split(separator).collect();
    let (first, others) = parts.split_first()?;
    let is_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    // India groups by two before the last three.
    let last = others.len().checked_sub(1)?;
    let grouped = (1..=3).contains(&first.len())
        && is_digits(first)
        && others
            .iter()
            .enumerate()
            .all(|(at, part)| is_digits(part) && (part.len() == 3 || (at < last && part.len() == 2 && separator == ',')));
    let certain = GROUPERS.contains(&separator) || others.len() > 1 || fraction.is_some();
    if !grouped || !certain || fraction.is_some_and(|fraction| fraction.is_empty() || !is_digits(fraction)) {
        return None;
    }
    let fraction = fraction.map_or_else(String::new, |fraction| format!(".{fraction}"));
    Some(format!("{sign}{}{fraction}", parts.concat()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Groupings: Unicode CLDR (en, de, fr, de-CH, hi).
    #[test]
    fn the_advice_gives_both_meanings_where_there_are_two() {
        for (text, expected, absent) in [
            ("1,000", &["thousands (then write 1000)", "decimals (then write 1.000)"][..], "not a comma:"),
            ("-12,345", &["write -12345", "write -12.345"], "not a comma:"),
            ("0,125", &["not a comma: 0.125"], "thousands"),
            ("1,5", &["not a comma: 1.5"], "thousands"),
            ("1234,567", &["not a comma: 1234.567"], "thousands"),
            ("12,50", &["not a comma: 12.50"], "thousands"),
            ("1,5e3", &["not a comma: 1.5e3"], "thousands"),
            ("1.234,5", &["decimal point: 1234.5;", "every number of the file"], "1.234"),
            ("1,234.5", &["decimal point: 1234.5;"], "1.234"),
            ("1,234,567", &["decimal point: 1234567;"], "1.234"),
            ("12,34,567", &["decimal point: 1234567;"], "12.34"),
            ("1.234.567", &["decimal point: 1234567;"], "1.234"),
            ("1 000", &["decimal point: 1000;"], "1.000"),
            ("1 000,5", &["decimal point: 1000.5;"], "1.000"),
            ("1'000.25", &["decimal point: 1000.25;"], "1.000"),
            ("1\u{2019}000", &["decimal point: 1000;"], "1.000"),
            ("-1\u{a0}000", &["decimal point: -1000;"], "1.000"),
            ("1\u{202f}234\u{202f}567,25", &["decimal point: 1234567.25;"], "1.234"),
            ("1_000", &["decimal point: 1000;"], "1.000"),
            ("\u{2212}5.5", &["keyboard: -5.5"], "thousands"),
            ("1.5D+03", &["with e: 1.5e+03"], "thousands"),
            ("12.5 m", &["the number alone, 12.5"], "thousands"),
            ("1,2,3", &["a plain number"], "thousands"),
            ("1,2345,678", &["a plain number"], "thousands"),
            ("far", &["a plain number"], "thousands"),
            (",", &["a plain number"], "thousands"),
            ("", &["a plain number"], "thousands"),
        ] {
            let help = number_help(text);
            assert!(expected.iter().all(|part| help.contains(part)) && !help.contains(absent), "{text}: {help}");
        }
    }

    #[test]
    fn a_comma_is_certainly_decimal_unless_three_digits_follow_up_to_three() {
        for (text, value, certain) in [
            ("0,00", 0.0, true),
            ("0,000", 0.0, true),
            ("-0,125", -0.125, true),
            ("1,000", 1.0, false),
            ("999,999", 999.999, false),
            ("1000,000", 1000.0, true),
            ("1,0000", 1.0, true),
            ("445000,5", 445_000.5, true),
            (",5", 0.5, true),
            ("1,5e2", 150.0, true),
        ] {
            assert_eq!(decimal_comma(text), Some(DecimalComma { value, certain }), "{text}");
        }
        for text in ["1.5", "1,2,3", "1.234,5", "a,b", "1,", ",", "1, 5", "inf,5"] {
            assert_eq!(decimal_comma(text), None, "{text}");
        }
    }
}
