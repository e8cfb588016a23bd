//! The known columns, their meaning, and the values that each accepts.

use super::degrees::read_degrees;
use crate::quantity::{Measure, format_number, number_help, split_unit, unit_named};

/// A column that the program reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CsvColumn {
    /// Its name in the header, which ends in its unit.
    pub name: &'static str,
    /// One line on its meaning.
    pub help: &'static str,
    /// Whether a file must have it.
    pub required: bool,
    kind: Kind,
}

/// The values that a column accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Any finite number.
    Finite,
    /// A friction coefficient, at least 0.
    Friction,
    /// A speed limit, at least 0.
    Speed,
    /// An error of speed, of either sign.
    SpeedError,
    /// A share, of either sign.
    Share,
    /// An angle in degrees between two bounds.
    Degrees { least: f64, greatest: f64 },
    /// 0 or 1.
    Flag,
}

/// The largest absolute value of an angle. The cone of a slope of nearly 90 degrees with a half-angle of nearly 90 reaches
/// 270 degrees; a larger value is a typing error. A smaller bound would refuse cones that the program itself computes.
const ANGLE_MAX_DEG: f64 = 270.0;

const fn required(name: &'static str, help: &'static str) -> CsvColumn {
    CsvColumn { name, help, required: true, kind: Kind::Finite }
}

const fn optional(name: &'static str, kind: Kind, help: &'static str) -> CsvColumn {
    CsvColumn { name, help, required: false, kind }
}

const fn angle(name: &'static str, help: &'static str) -> CsvColumn {
    optional(name, Kind::Degrees { least: -ANGLE_MAX_DEG, greatest: ANGLE_MAX_DEG }, help)
}

const fn error_angle(name: &'static str, help: &'static str) -> CsvColumn {
    optional(name, Kind::Degrees { least: -180.0, greatest: 180.0 }, help)
}

pub(super) const X: usize = 0;
pub(super) const Z: usize = 1;
pub(super) const FRICTION: usize = 2;
pub(super) const CROSS_SLOPE: usize = 3;
pub(super) const KEEP_OUT: usize = 4;
/// The first of the six columns for travel towards +x: least and greatest take-off angle and take-off speed, then the same
/// for landing.
pub(super) const FORWARD: usize = 5;
/// The first of the six columns for travel towards -x.
pub(super) const REVERSE: usize = FORWARD + SIX;
pub(super) const SIX: usize = 6;
pub(super) const MAP_X: usize = REVERSE + SIX;
pub(super) const MAP_Y: usize = MAP_X + 1;
/// A property of the vertex, as are the two columns before it.
pub(super) const BEND: usize = MAP_Y + 1;

/// All columns of a chain CSV.
pub const CHAIN_COLUMNS: [CsvColumn; 20] = [
    required("x_m", "along the plane of travel, strictly increasing (required)"),
    required("z_m", "elevation (required)"),
    optional("friction_coefficient", Kind::Friction, "of the segment that begins here; else that of the scenario's [surface]"),
    optional(
        "cross_slope_deg",
        Kind::Degrees { least: 0.0, greatest: 90.0 },
        "angle between the surface normal and the plane of travel, 0 to 90; absent: 0",
    ),
    optional("keep_out", Kind::Flag, "1: no take-off and no landing on the segment, flying over is allowed; else 0"),
    angle("takeoff_min_deg", "least take-off elevation towards +x; the six explicit columns come together or not at all"),
    angle("takeoff_max_deg", "greatest take-off elevation towards +x"),
    optional("takeoff_speed_max_m_s", Kind::Speed, "greatest take-off speed towards +x; 0: not allowed there"),
    angle("landing_min_deg", "least landing elevation towards +x, negative downwards"),
    angle("landing_max_deg", "greatest landing elevation towards +x"),
    optional("landing_speed_max_m_s", Kind::Speed, "greatest landing speed towards +x; 0: not allowed there"),
    angle("reverse_takeoff_min_deg", "the six for travel towards -x, elevations as seen by the traveller"),
    angle("reverse_takeoff_max_deg", "greatest take-off elevation towards -x"),
    optional("reverse_takeoff_speed_max_m_s", Kind::Speed, "greatest take-off speed towards -x; 0: not allowed there"),
    angle("reverse_landing_min_deg", "least landing elevation towards -x, negative downwards"),
    angle("reverse_landing_max_deg", "greatest landing elevation towards -x"),
    optional("reverse_landing_speed_max_m_s", Kind::Speed, "greatest landing speed towards -x; 0: not allowed there"),
    optional("map_x_m", Kind::Finite, "easting of the vertex on the map; with map_y_m in every row, or neither"),
    optional("map_y_m", Kind::Finite, "northing of the vertex on the map"),
    optional(
        "bend",
        Kind::Flag,
        "1: the plane of travel turns at the vertex, and no hop spans it; else 0; absent: the chain lies in one plane",
    ),
];

/// All columns of a CSV of pairs.
pub const PAIRS_COLUMNS: [CsvColumn; 2] = [
    required("start_x_m", "where on the chain the path starts (required)"),
    required("goal_x_m", "where on the chain the path ends (required)"),
];

/// All columns of a CSV of positions on a map.
pub const POSITION_COLUMNS: [CsvColumn; 2] =
    [required("x_m", "easting on the map (required)"), required("y_m", "northing on the map (required)")];

pub(super) const SPEED_ERROR_FRACTION: usize = 0;
pub(super) const SPEED_ERROR: usize = 1;

/// All columns of a CSV of measured errors, one hop a row.
pub const MEASURED_COLUMNS: [CsvColumn; 6] = [
    optional("takeoff_speed_error_fraction", Kind::Share, "flown take-off speed over the commanded one, less 1"),
    optional("takeoff_speed_error_m_s", Kind::SpeedError, "instead: flown take-off speed less the commanded one"),
    error_angle("takeoff_angle_error_deg", "flown take-off elevation less the commanded one"),
    error_angle("heading_error_deg", "flown heading less the commanded one, clockwise; on a DEM only"),
    optional("drift_along_m", Kind::Finite, "bounce and roll after the landing, along the direction of flight"),
    optional("drift_across_m", Kind::Finite, "the same to the left"),
];

/// The value that a field should have, and how to correct the file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) expected: String,
    pub(super) help: String,
}

impl CsvColumn {
    /// The value of a field; angles are returned in radians.
    pub(super) fn parse(&self, text: &str) -> Result<f64, Fault> {
        let fault = |help: String| Fault { expected: self.expected().to_owned(), help };
        let number: f64 = text.parse().map_err(|_| fault(number_help(text)))?;
        if !number.is_finite() {
            return Err(fault(self.help_for_infinite(text)));
        }
        match self.kind {
            Kind::Finite | Kind::SpeedError | Kind::Share => Ok(number),
            Kind::Friction | Kind::Speed if number >= 0.0 => Ok(number),
            Kind::Friction => Err(fault("dry rock and regolith have 0.3 to 1.2".to_owned())),
            Kind::Speed => Err(fault("speeds are given without sign: write the magnitude, or 0 for not allowed".to_owned())),
            Kind::Degrees { least, greatest } if least <= number && number <= greatest => Ok(read_degrees(text, number).radians()),
            Kind::Degrees { .. } => Err(fault("check the unit: angles are degrees".to_owned())),
            Kind::Flag if number == 0.0 || number == 1.0 => Ok(number),
            Kind::Flag => Err(fault("write 1 if neither take-off nor landing is allowed, else 0".to_owned())),
        }
    }

    /// What it measures; `None` of a flag.
    const fn measure(&self) -> Option<Measure> {
        match self.kind {
            Kind::Finite => Some(Measure::Length),
            Kind::Friction | Kind::Share => Some(Measure::Ratio),
            Kind::Speed | Kind::SpeedError => Some(Measure::Speed),
            Kind::Degrees { .. } => Some(Measure::Angle),
            Kind::Flag => None,
        }
    }

    /// A phrase that describes the accepted values.
    pub(super) fn expected(&self) -> &'static str {
        match self.kind {
            Kind::Finite | Kind::Share => "a finite number",
            Kind::SpeedError => "a finite speed, m/s",
            Kind::Friction => "a finite number of at least 0",
            Kind::Speed => "a finite speed of at least 0 m/s",
            Kind::Degrees { least, .. } if least < -180.0 => "a finite angle from -270 to 270 degrees",
            Kind::Degrees { least, .. } if least < 0.0 => "a finite angle from -180 to 180 degrees",
            Kind::Degrees { .. } => "a finite angle from 0 to 90 degrees",
            Kind::Flag => "0 or 1",
        }
    }

    fn help_for_infinite(&self, text: &str) -> String {
        if text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) && text.contains(|c: char| c.is_ascii_digit()) {
            return "numbers must be below 1.8e308: check the exponent".to_owned();
        }
        match self.kind {
            Kind::Speed => {
                "if the speed has no limit, write one that is never reached: the smaller of chain and [hopper] applies".to_owned()
            }
            Kind::Degrees { least, .. } if least < -180.0 => "if the angle has no limit, write -90 or 90".to_owned(),
            _ => "write a number, or remove the row".to_owned(),
        }
    }
}

/// User text for a message: short, on one line, without control characters.
pub(super) fn excerpt(text: &str) -> String {
    crate::quantity::excerpt(text, 40)
}

/// A known column whose quantity an unknown name states in another way, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct OtherUnit {
    pub(super) column: &'static str,
    /// The unit of the name, for a message.
    pub(super) unit: String,
    pub(super) help: String,
}

/// Whether a name is that of a known column with another unit (`z_ft`, `X [km]`, `friction_pct`), whose numbers must be
/// converted before the column is renamed.
pub(super) fn in_other_unit(columns: &[CsvColumn], name: &str) -> Option<OtherUnit> {
    let (base, text) = split_unit(name);
    let text = text?;
    let is_meant = |column: &&CsvColumn| {
        let known = split_unit(column.name.trim_end_matches("_fraction")).0;
        known == base || (known == "friction_coefficient" && matches!(base.as_str(), "friction" | "mu"))
    };
    let unit = unit_named(&text);
    // A quantity may be known in several units.
    let in_this = columns.iter().filter(is_meant).find(|column| unit.is_some_and(|unit| column.measure() == Some(unit.measure)));
    let column = in_this.or_else(|| columns.iter().find(is_meant))?;
    let expected = column.measure()?;
    if unit.is_some_and(|unit| unit.measure == expected && unit.is_ours()) {
        return None;
    }
    let known = column.name;
    let (unit, help) = match unit.filter(|unit| unit.measure == expected) {
        Some(unit) => (
            unit.name.to_owned(),
            format!(
                "multiply its numbers by {}, then name it {known}; a new name alone changes no number",
                format_number(unit.factor)
            ),
        ),
        None => (
            format!("'{}'", excerpt(&text)),
            format!("convert its numbers to the unit of {known}, then name it so; a new name alone changes no number"),
        ),
    };
    Some(OtherUnit { column: known, unit, help })
}

/// The known name nearest to an unknown one; `None` if none is similar.
pub(super) fn nearest(columns: &[CsvColumn], name: &str) -> Option<&'static str> {
    /// Below this similarity the nearest name is unrelated to the text typed (`note` and `map_x_m`: 0.0; `x` and `x_m`: 0.8).
    const NEAR: f64 = 0.7;
    /// No column has a name half as long, and the comparison takes quadratic time.
    const LONGEST: usize = 64;
    if name.len() > LONGEST {
        return None;
    }
    let typed = name.to_lowercase();
    let scored = columns.iter().map(|column| (strsim::jaro_winkler(&typed, column.name), column.name));
    scored.filter(|&(score, _)| score >= NEAR).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_indices_match_the_names() {
        let named = [
            (X, "x_m"),
            (Z, "z_m"),
            (FRICTION, "friction_coefficient"),
            (CROSS_SLOPE, "cross_slope_deg"),
            (KEEP_OUT, "keep_out"),
            (FORWARD, "takeoff_min_deg"),
            (REVERSE, "reverse_takeoff_min_deg"),
            (MAP_X, "map_x_m"),
            (MAP_Y, "map_y_m"),
            (BEND, "bend"),
        ];
        for (index, name) in named {
            assert_eq!(CHAIN_COLUMNS[index].name, name);
        }
        assert_eq!(MEASURED_COLUMNS[SPEED_ERROR_FRACTION].name, "takeoff_speed_error_fraction");
        assert_eq!(MEASURED_COLUMNS[SPEED_ERROR].name, "takeoff_speed_error_m_s");
        for i in 0..SIX {
            assert_eq!(CHAIN_COLUMNS[REVERSE + i].name, format!("reverse_{}", CHAIN_COLUMNS[FORWARD + i].name));
        }
    }

    /// Factors: the definitions of the units.
    #[test]
    fn columns_in_other_units_are_converted_before_they_are_renamed() {
        for (name, column, help) in [
            ("x_ft", "x_m", "by 0.3048,"),
            ("X [km]", "x_m", "by 1000,"),
            ("z_km", "z_m", "by 1000,"),
            ("z (us-ft)", "z_m", "by 0.3048006096,"),
            ("friction_pct", "friction_coefficient", "by 0.01,"),
            ("friction_coefficient_percent", "friction_coefficient", "by 0.01,"),
            ("cross_slope_rad", "cross_slope_deg", "by 57.29577951,"),
            ("takeoff_speed_max_km_h", "takeoff_speed_max_m_s", "by 0.2777777778,"),
            ("reverse_landing_min_gon", "reverse_landing_min_deg", "by 0.9,"),
            ("map_x_km", "map_x_m", "by 1000,"),
            ("z [parsec]", "z_m", "convert its numbers"),
            ("x_deg", "x_m", "convert its numbers"),
            ("friction_deg", "friction_coefficient", "convert its numbers"),
        ] {
            let found = in_other_unit(&CHAIN_COLUMNS, name).unwrap_or_else(|| panic!("{name}"));
            assert!(found.column == column && found.help.contains(help), "{name}: {found:?}");
        }
        for name in ["x", "x_m", "z [m]", "X (metres)", "friction", "takeoff_speed_max_mps", "note", "length_ft", "keep_out_pct"] {
            assert_eq!(in_other_unit(&CHAIN_COLUMNS, name), None, "{name}");
        }
    }

    #[test]
    fn similar_names_are_found_and_unrelated_ones_are_not() {
        for (typed, known) in
            [("x", "x_m"), ("Z_M", "z_m"), ("friction", "friction_coefficient"), ("takeoff_speed_m_s", "takeoff_speed_max_m_s")]
        {
            assert_eq!(nearest(&CHAIN_COLUMNS, typed), Some(known));
        }
        assert_eq!(nearest(&CHAIN_COLUMNS, "note"), None);
        assert_eq!(nearest(&CHAIN_COLUMNS, ""), None);
    }
}
