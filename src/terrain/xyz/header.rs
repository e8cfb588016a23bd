//! The columns of an XYZ text: named by a header or a comment, or x, y and z in this order.

use crate::quantity::{Measure, excerpt, split_unit, unit_named};

const X_NAMES: [&str; 6] = ["x", "east", "easting", "eastings", "x_coord", "xcoord"];
const Y_NAMES: [&str; 6] = ["y", "north", "northing", "northings", "y_coord", "ycoord"];
const Z_NAMES: [&str; 11] =
    ["z", "elevation", "height", "altitude", "elev", "alt", "topography", "z_coord", "zcoord", "dem", "dtm"];
/// Names of columns that count downwards.
const DEPTH_NAMES: [&str; 4] = ["depth", "depths", "sounding", "soundings"];
const LONGITUDE_NAMES: [&str; 4] = ["lon", "long", "longitude", "lng"];
const LATITUDE_NAMES: [&str; 3] = ["lat", "latitude", "lat."];

/// What a line may begin with to be a comment.
const COMMENTS: [&str; 5] = ["#", "//", ";", "%", "!"];

/// The sign between fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Semicolon,
    Comma,
    Blank,
    /// Blanks that do not break, in a line without others.
    FixedBlank,
}

/// The places of the three numbers in a line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) z: usize,
    /// The number of columns of the header or, without one, of the first line.
    pub(super) count: usize,
    /// Whether a header names them.
    pub(super) named: bool,
}

/// A line of names.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Header {
    /// Columns in metres.
    Columns(Columns),
    /// x and y are longitude and latitude.
    Degrees(String),
    /// A column in another unit, counted downwards or given twice: what was found, and what was expected.
    OtherUnit(String, String),
}

/// The text after the sign of a comment; `None` if a line is none.
pub(super) fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    COMMENTS.iter().find_map(|sign| line.strip_prefix(sign)).map(|text| text.trim_start_matches(['#', '/', '%', '!', ';']))
}

/// The separator of a line of numbers: semicolons if there are any; commas unless each stands inside a number of a line of
/// three or more numbers separated by blanks; else blanks.
pub(super) fn separator_of(line: &str) -> Separator {
    if line.contains(';') {
        return Separator::Semicolon;
    }
    if !line.contains(',') {
        let text = line.trim();
        let is_fixed = !text.contains(|letter: char| letter.is_ascii_whitespace()) && text.contains(char::is_whitespace);
        return if is_fixed { Separator::FixedBlank } else { Separator::Blank };
    }
    let inside_number = |word: &str| match word.split_once(',') {
        None => true,
        Some((whole, fraction)) => {
            !fraction.contains(',')
                && whole.ends_with(|c: char| c.is_ascii_digit())
                && fraction.starts_with(|c: char| c.is_ascii_digit())
        }
    };
    let mut words = line.split_ascii_whitespace();
    if words.by_ref().take(3).filter(|word| inside_number(word)).count() == 3 && words.all(inside_number) {
        Separator::Blank
    } else {
        Separator::Comma
    }
}

/// The fields of a line. Blanks that do not break are no separators beside others: they separate thousands.
pub(super) fn fields(line: &str, separator: Separator) -> Vec<&str> {
    let sign = match separator {
        Separator::FixedBlank => return line.split_whitespace().map(unquoted).collect(),
        Separator::Blank => return line.split_ascii_whitespace().map(unquoted).collect(),
        Separator::Semicolon => ';',
        Separator::Comma => ',',
    };
    if !line.contains('"') {
        return line.split(sign).map(str::trim).collect();
    }
    let mut quoted = false;
    let outside = |letter: char| {
        quoted ^= letter == '"';
        letter == sign && !quoted
    };
    line.split(outside).map(unquoted).collect()
}

fn unquoted(field: &str) -> &str {
    field.trim().trim_matches('"').trim()
}

/// The header of a line, if it names x, y and z.
pub(super) fn header(line: &str) -> Option<Header> {
    let separator = if line.contains(';') {
        Separator::Semicolon
    } else if line.contains(',') {
        Separator::Comma
    } else {
        separator_of(line)
    };
    let separated = fields(line, separator);
    // A unit in brackets may be a word of its own, as in `X [m] Y [m] Z [m]`.
    let mut names: Vec<String> = Vec::new();
    for field in separated {
        match names.last_mut() {
            Some(last) if separator == Separator::Blank && field.starts_with(['[', '(']) => {
                last.push(' ');
                last.push_str(field);
            }
            _ => names.push(field.to_owned()),
        }
    }
    let bases: Vec<String> = names.iter().map(|name| split_unit(name).0).collect();
    let columns_of = |known: &[&str]| bases.iter().filter(|base| known.contains(&base.as_str())).count();
    let has_map = columns_of(&X_NAMES) > 0 && columns_of(&Y_NAMES) > 0;
    for (axis, known) in [("x", &X_NAMES[..]), ("y", &Y_NAMES), ("z", &Z_NAMES)] {
        let own = columns_of(known);
        if has_map && own > 1 {
            let found: Vec<&str> = bases.iter().map(String::as_str).filter(|base| known.contains(base)).collect();
            let expected = format!("one column for {axis}: rename the others, for instance to {}_other", excerpt(found[1], 40));
            return Some(Header::OtherUnit(format!("{own} columns for {axis} ({})", excerpt(&found.join(", "), 80)), expected));
        }
    }
    if let Some(depth) = bases.iter().find(|base| has_map && columns_of(&Z_NAMES) == 0 && DEPTH_NAMES.contains(&base.as_str())) {
        let expected = "heights, which count upwards: change the sign of its numbers, then name the column z".to_owned();
        return Some(Header::OtherUnit(format!("the column '{}', which counts downwards", excerpt(depth, 40)), expected));
    }
    let find = |known: &[&str]| bases.iter().position(|base| known.contains(&base.as_str()));
    let z = find(&Z_NAMES)?;
    let Some((x, y)) = find(&X_NAMES).zip(find(&Y_NAMES)) else {
        let (x, y) = find(&LONGITUDE_NAMES).zip(find(&LATITUDE_NAMES))?;
        return Some(Header::Degrees(format!("columns '{}' and '{}'", excerpt(&names[x], 40), excerpt(&names[y], 40))));
    };
    for (axis, column) in [("x", x), ("y", y), ("z", z)] {
        let Some(text) = split_unit(&names[column]).1 else { continue };
        let unit = unit_named(&text);
        let shown = excerpt(&names[column], 40);
        match unit {
            Some(unit) if unit.measure == Measure::Length && unit.is_ours() => {}
            Some(unit) if unit.measure == Measure::Length => {
                let expected = format!(
                    "{axis} in metres: multiply its numbers by {}, then write the unit as [m]",
                    crate::quantity::format_number(unit.factor)
                );
                return Some(Header::OtherUnit(format!("the column '{shown}' in {}", unit.name), expected));
            }
            Some(unit) if unit.measure == Measure::Angle && axis != "z" => {
                return Some(Header::Degrees(format!("the column '{shown}'")));
            }
            _ => {
                let expected = format!("{axis} in metres: if its numbers are metres, write [m] or nothing, else convert them");
                return Some(Header::OtherUnit(format!("the column '{shown}', whose unit is not known here"), expected));
            }
        }
    }
    Some(Header::Columns(Columns { x, y, z, count: names.len(), named: true }))
}

/// Whether a text begins with a header of x, y and z, or with a line of three or more fields the first three of which are
/// meant as numbers.
pub(super) fn begins_with_post(beginning: &[u8]) -> bool {
    let text = String::from_utf8_lossy(beginning);
    let text = text.trim_start_matches('\u{feff}');
    let (mut named, mut counted) = (false, false);
    for line in text.split(['\n', '\r']).filter(|line| !line.trim().is_empty()) {
        if let Some(text) = comment(line) {
            named |= header(text).is_some();
            continue;
        }
        if header(line).is_some() {
            return true;
        }
        let fields = fields(line, separator_of(line));
        if !counted && stated_count(&fields).is_some() {
            counted = true;
            continue;
        }
        // Other columns may come before x where a comment names the columns.
        return fields.len() >= 3 && (named || fields.iter().take(3).all(|field| is_meant_as_number(field)));
    }
    named
}

/// The number of posts, if a line has nothing but a whole number, as `CloudCompare` and point clouds in PTS have before the first post.
pub(super) fn stated_count(fields: &[&str]) -> Option<usize> {
    match fields {
        [one] if one.bytes().all(|byte| byte.is_ascii_digit()) => one.parse().ok(),
        _ => None,
    }
}

/// A number in any notation: digits with signs, points, commas, apostrophes and an exponent; also `nan` and `inf`.
fn is_meant_as_number(field: &str) -> bool {
    let in_number = |letter: char| {
        letter.is_ascii_digit()
            || "+-.,'eEdD".contains(letter)
            || matches!(letter, '\u{2212}' | '\u{2019}' | '\u{a0}' | '\u{202f}' | '\u{2009}' | '\u{fffd}')
    };
    field.parse::<f64>().is_ok() || (field.contains(|c: char| c.is_ascii_digit()) && field.chars().all(in_number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_name_columns_and_units() {
        let named = |x, y, z, count| Some(Header::Columns(Columns { x, y, z, count, named: true }));
        for (line, expected) in [
            ("x,y,z", named(0, 1, 2, 3)),
            ("X[m],Y[m],Z[m]", named(0, 1, 2, 3)),
            ("X [m] Y [m] Z [m] R G B", named(0, 1, 2, 6)),
            ("Easting (m); Northing (m); Elevation (m)", named(0, 1, 2, 3)),
            ("id\tz_m\teasting_m\tnorthing_m", named(2, 3, 1, 4)),
            ("\"x\" \"y\" \"z\"", named(0, 1, 2, 3)),
            ("x_m,z_m", None),
            ("x_m,z_m,friction_coefficient", None),
            ("0 0 1", None),
        ] {
            assert_eq!(header(line), expected, "{line}");
        }
        for (line, part) in [
            ("x,y,z[ft]", "by 0.3048"),
            ("X (km),Y (km),Z (m)", "by 1000"),
            ("x y z (us-ft)", "by 0.3048006096"),
            ("x_m,y_m,z_cm", "by 0.01"),
            ("x,y,z [parsec]", "if its numbers are metres"),
            ("x,y,z (NAVD88)", "if its numbers are metres"),
        ] {
            assert!(matches!(header(line), Some(Header::OtherUnit(_, expected)) if expected.contains(part)), "{line}");
        }
        for line in ["lon,lat,z", "Longitude [deg];Latitude [deg];Height [m]", "x [deg],y [deg],z"] {
            assert!(matches!(header(line), Some(Header::Degrees(_))), "{line}");
        }
    }

    #[test]
    fn separators_are_told_from_decimal_commas() {
        for (line, expected) in [
            ("0,0,10", Separator::Comma),
            ("0, 0, 10", Separator::Comma),
            ("0 ,0 ,10", Separator::Comma),
            ("0,00 0,00 10,00", Separator::Blank),
            ("0,00\t0,00\t10", Separator::Blank),
            ("0 0 10,5 128 128 128", Separator::Blank),
            ("0,5;0,5;10,5", Separator::Semicolon),
            ("0 0 10", Separator::Blank),
            ("1,2,3 4,5,6", Separator::Comma),
            ("1,2 3", Separator::Comma),
        ] {
            assert_eq!(separator_of(line), expected, "{line}");
        }
        assert_eq!(fields("\"1,5\", \"2,5\",3", Separator::Comma), ["1,5", "2,5", "3"]);
        assert_eq!(fields("1\u{a0}000 2 3", Separator::Blank), ["1\u{a0}000", "2", "3"]);
    }

    #[test]
    fn chain_tables_are_not_taken_for_grids() {
        for text in
            ["x_m,z_m\n0,1\n", "x_m,z_m,friction_coefficient\n0,1,0.6\n", "", "# x_m\nx_m,z_m\n0,1\n", "<html>", "v 0 0 1\n"]
        {
            assert!(!begins_with_post(text.as_bytes()), "{text}");
        }
    }
}
