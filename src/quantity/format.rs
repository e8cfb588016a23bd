//! Numbers and their units as text for readers, and text of users for messages.

/// The first characters of a user's text for a message, on one line, without control characters.
pub(crate) fn excerpt(text: &str, longest: usize) -> String {
    let mut letters = text.chars();
    let begin: String = letters.by_ref().take(longest).flat_map(char::escape_debug).collect();
    if letters.next().is_some() { begin + "..." } else { begin }
}

/// Formats a number for people: at most ten significant digits, no trailing zeros, and an exponent for very large and very
/// small numbers. Results meant for programs keep all digits.
///
/// ```
/// use chta::quantity::format_number;
/// assert_eq!(format_number(0.1 + 0.2), "0.3");
/// assert_eq!(format_number(120.69500000000001), "120.695");
/// assert_eq!(format_number(-6301862.204093784), "-6301862.204");
/// assert_eq!(format_number(1e-300), "1e-300");
/// assert_eq!(format_number(2.0), "2");
/// ```
pub fn format_number(number: f64) -> String {
    // Round to ten significant digits and parse again: the shortest text of the result has no more digits.
    // Numbers near f64::MAX would round to infinity and keep their value.
    let rounded = format!("{number:.9e}").parse().ok().filter(|rounded: &f64| rounded.is_finite()).unwrap_or(number);
    let size = f64::abs(rounded);
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e12).contains(&size) || !size.is_finite() {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// The unit given by the ending of a key's or column's name; empty for a dimensionless one.
///
/// ```
/// use chta::quantity::unit_of;
/// assert_eq!(unit_of("hopper.takeoff_speed_max_m_s"), "m/s");
/// assert_eq!(unit_of("surface.friction_coefficient"), "");
/// ```
pub fn unit_of(name: &str) -> &'static str {
    // `_m_s` ends in `_s` too: longer endings first.
    let units = [
        ("_m_s2", "m/s^2"),
        ("_m_s", "m/s"),
        ("_m2", "m^2"),
        ("_deg", "deg"),
        ("_j_kg", "J/kg"),
        ("_kg", "kg"),
        ("_j", "J"),
        ("_m", "m"),
        ("_s", "s"),
    ];
    units.into_iter().find(|(ending, _)| name.ends_with(ending)).map_or("", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::{format_number, unit_of};

    #[test]
    fn numbers_are_formatted_for_readers() {
        for (number, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (0.505_000_000_000_009_7, "0.505"),
            (1.0 / 3.0, "0.3333333333"),
            (1e-5, "1e-5"),
            (-2.5e-9, "-2.5e-9"),
            (f64::MIN_POSITIVE, "2.225073859e-308"),
            (123_456_789_012.0, "123456789000"),
            (1e12, "1e12"),
            (f64::MAX, "1.7976931348623157e308"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "NaN"),
            (9.999_999_999_9, "10"),
        ] {
            assert_eq!(format_number(number), text);
        }
    }

    #[test]
    fn units_are_those_of_the_endings() {
        for (name, unit) in [
            ("body.gravity_m_s2", "m/s^2"),
            ("hopper.rest_time_s", "s"),
            ("hopper.clearance_m", "m"),
            ("hopper.mass_kg", "kg"),
            ("surface.rest_slope_max_deg", "deg"),
            ("uncertainty.trials", ""),
        ] {
            assert_eq!(unit_of(name), unit, "{name}");
        }
    }
}
