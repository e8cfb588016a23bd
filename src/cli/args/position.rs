//! Positions as typed: X along a chain, X,Y on a map, X,Y,Z on a mesh. One sentence where the count of numbers is wrong.

use chta::{
    quantity::MapPoint,
    terrain::{LonLat, MapPlace},
};

use crate::cli::Failure;

/// What each terrain takes, for the end of the sentence about a wrong count.
const COUNTS: &str = "a position is X along a chain, X,Y on a map and X,Y,Z on a mesh";

/// A position in the form that it was given in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Position {
    /// X along a chain, m.
    Along(f64),
    /// X,Y on a map, m.
    OnMap(MapPoint),
    /// X,Y,Z on a mesh, m.
    InSpace([f64; 3]),
}

/// What is expected where one number is.
const ONE: &str = "one number in metres, X, such as 12.5";

/// What is expected where two numbers are.
const TWO: &str = "two finite numbers in metres, X,Y, such as 12.5,-30";

/// What is expected where three numbers are.
const THREE: &str = "three finite numbers in metres, X,Y,Z, such as 12.5,-30,4";

impl Position {
    /// The sentence where the terrain is a chain.
    pub(crate) fn misfit_along_chain(self) -> String {
        format!("{}, expected {ONE}: {COUNTS}", self.found())
    }

    /// The sentence where the terrain is a map.
    pub(crate) fn misfit_on_map(self) -> String {
        format!("{}, expected {TWO}: {COUNTS}", self.found())
    }

    /// The sentence where the terrain is a mesh.
    pub(crate) fn misfit_in_space(self) -> String {
        format!("{}, expected {THREE}: {COUNTS}", self.found())
    }

    /// What was found, for a sentence.
    pub(crate) fn found(self) -> String {
        match self {
            Self::Along(x_m) => format!("found `{x_m}` (1 number)"),
            Self::OnMap(at) => format!("found `{},{}` (2 numbers)", at.x, at.y),
            Self::InSpace([x, y, z]) => format!("found `{x},{y},{z}` (3 numbers)"),
        }
    }
}

/// Reads `X` along a chain, `X,Y` on a map, or `X,Y,Z` on a mesh.
pub(super) fn position(text: &str) -> Result<Position, String> {
    match text.split(',').count() {
        1 => along_chain(text).map(Position::Along),
        2 => map_point(text).map(Position::OnMap),
        3 => numbers(text, THREE, f64::is_finite).map(Position::InSpace),
        count => Err(format!("found `{text}` ({count} numbers), expected one to three numbers in metres: {COUNTS}")),
    }
}

/// Reads `X`, a position along a chain.
pub(super) fn along_chain(text: &str) -> Result<f64, String> {
    // Whether it is finite and on the chain is said with the chain's extent.
    let [x_m] = numbers(text, ONE, |_| true)?;
    Ok(x_m)
}

/// Reads `X,Y`, a position on a map.
pub(super) fn map_point(text: &str) -> Result<MapPoint, String> {
    let [x_m, y_m] = numbers(text, TWO, f64::is_finite)?;
    Ok(MapPoint::new(x_m, y_m))
}

/// Reads so many numbers that are taken.
fn numbers<const N: usize>(text: &str, expected: &str, takes: impl Fn(f64) -> bool) -> Result<[f64; N], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|number| takes(*number));
    let Some(found) = text.split(',').map(number).collect::<Option<Vec<f64>>>() else {
        return Err(format!("found `{text}`, expected {expected}"));
    };
    let count = found.len();
    found.try_into().map_err(|_| {
        let s = if count == 1 { "" } else { "s" };
        format!("found `{text}` ({count} number{s}), expected {expected}: {COUNTS}")
    })
}

/// Reads `LON,LAT`.
pub(super) fn lon_lat(text: &str) -> Result<LonLat, String> {
    let number = |part: &str, range: std::ops::RangeInclusive<f64>| part.trim().parse::<f64>().ok().filter(|n| range.contains(n));
    let wanted = || {
        format!(
            "found `{text}`, expected longitude (-180 to 360, east positive) and latitude (-90 to 90) in degrees, such as 62.8,-87.18"
        )
    };
    let (lon, lat) = text.split_once(',').ok_or_else(wanted)?;
    let (lon_deg, lat_deg) = (number(lon, -180.0..=360.0).ok_or_else(wanted)?, number(lat, -90.0..=90.0).ok_or_else(wanted)?);
    Ok(LonLat { lon_deg, lat_deg })
}

/// A position given in one of the two forms; the command line requires one.
pub(crate) fn place(which: &str, point: Option<MapPoint>, place: Option<LonLat>) -> Result<MapPlace, Failure> {
    let missing = || Failure::message(format!("found no --{which}, expected --{which} X,Y or --{which}-lonlat LON,LAT"));
    point.map(MapPlace::Metres).or(place.map(MapPlace::LonLat)).ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_has_one_to_three_numbers() {
        assert_eq!(position("-3.5"), Ok(Position::Along(-3.5)));
        assert_eq!(position("-3.5, 2"), Ok(Position::OnMap(MapPoint::new(-3.5, 2.0))));
        assert_eq!(position("-3.5, 2,1e1"), Ok(Position::InSpace([-3.5, 2.0, 10.0])));
        for (text, said) in [
            ("1,2,3,4", "(4 numbers), expected one to three numbers in metres: a position is X along a chain, X,Y on a map"),
            ("1,2,inf", "expected three finite numbers in metres, X,Y,Z"),
            ("a", "expected one number in metres, X"),
            ("1,b", "expected two finite numbers in metres, X,Y"),
            ("1,inf", "expected two finite numbers in metres, X,Y"),
        ] {
            let sentence = position(text).unwrap_err();
            assert!(sentence.starts_with(&format!("found `{text}`")) && sentence.contains(said), "{sentence}");
        }
    }

    #[test]
    fn a_wrong_count_of_numbers_is_told_with_what_each_terrain_takes() {
        for (text, count) in [("1", "1 number"), ("1,2,3", "3 numbers"), ("1, 2,3,-4", "4 numbers")] {
            let sentence = map_point(text).unwrap_err();
            assert!(sentence.contains(&format!("found `{text}` ({count}), expected two")), "{sentence}");
            assert!(sentence.ends_with(COUNTS), "{sentence}");
        }
        for (text, count) in [("1,2", "2 numbers"), ("1,2,3", "3 numbers")] {
            let sentence = along_chain(text).unwrap_err();
            assert!(sentence.contains(&format!("({count}), expected one")) && sentence.ends_with(COUNTS), "{sentence}");
        }
        for text in ["", "a", "1,b", "1,", "nan,1", "1,inf"] {
            let sentence = map_point(text).unwrap_err();
            assert!(sentence.starts_with(&format!("found `{text}`, expected two")) && !sentence.contains(COUNTS), "{sentence}");
        }
        assert_eq!(map_point(" 1, -2e1 "), Ok(MapPoint::new(1.0, -20.0)));
        assert_eq!(along_chain("-7.5"), Ok(-7.5));
    }
}
