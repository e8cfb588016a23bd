//! Units as people write them in the headers of tables, and their conversion to the unit that this program reads.

/// What a number measures, as far as conversions need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Measure {
    Length,
    Speed,
    Angle,
    /// A share: a coefficient without unit, or percent.
    Ratio,
}

/// A unit: its name for messages, what it measures, and how many units of this program (m, m/s, degrees, 1) it has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    pub(crate) name: &'static str,
    pub(crate) measure: Measure,
    pub(crate) factor: f64,
}

impl Unit {
    /// Whether numbers in this unit can be used as they stand.
    pub(crate) fn is_ours(&self) -> bool {
        self.factor.to_bits() == 1.0_f64.to_bits()
    }
}

const fn unit(name: &'static str, measure: Measure, factor: f64) -> Unit {
    Unit { name, measure, factor }
}

/// The spellings of each unit, in lower case. The international foot is exactly 0.3048 m, the US survey foot exactly
/// 1200/3937 m, the nautical mile 1852 m.
const UNITS: [(&[&str], Unit); 22] = [
    (&["m", "metre", "metres", "meter", "meters", "mtr"], unit("metres", Measure::Length, 1.0)),
    (&["km", "kilometre", "kilometres", "kilometer", "kilometers"], unit("kilometres", Measure::Length, 1000.0)),
    (&["dm", "decimetre", "decimetres", "decimeter", "decimeters"], unit("decimetres", Measure::Length, 0.1)),
    (&["cm", "centimetre", "centimetres", "centimeter", "centimeters"], unit("centimetres", Measure::Length, 0.01)),
    (&["mm", "millimetre", "millimetres", "millimeter", "millimeters"], unit("millimetres", Measure::Length, 0.001)),
    (&["um", "micron", "microns", "micrometre", "micrometer"], unit("micrometres", Measure::Length, 1.0e-6)),
    (&["ft", "foot", "feet", "ift", "'"], unit("feet", Measure::Length, 0.3048)),
    (
        &["ftus", "us-ft", "usft", "us_ft", "sft", "survey foot", "us survey foot", "us survey feet"],
        unit("US survey feet", Measure::Length, 1200.0 / 3937.0),
    ),
    (&["in", "inch", "inches", "\""], unit("inches", Measure::Length, 0.0254)),
    (&["yd", "yard", "yards"], unit("yards", Measure::Length, 0.9144)),
    (&["mi", "mile", "miles"], unit("miles", Measure::Length, 1609.344)),
    (&["nm", "nmi", "nautical mile", "nautical miles"], unit("nautical miles", Measure::Length, 1852.0)),
    (&["deg", "degree", "degrees", "\u{b0}"], unit("degrees", Measure::Angle, 1.0)),
    (&["rad", "radian", "radians"], unit("radians", Measure::Angle, 180.0 / std::f64::consts::PI)),
    (&["grad", "gon", "gons", "gradian", "gradians"], unit("gon", Measure::Angle, 0.9)),
    (&["arcmin"], unit("arc minutes", Measure::Angle, 1.0 / 60.0)),
    (&["m_s", "m/s", "mps", "ms-1", "m s-1", "m.s-1"], unit("m/s", Measure::Speed, 1.0)),
    (&["km_h", "km/h", "kmh", "kph"], unit("km/h", Measure::Speed, 1.0 / 3.6)),
    (&["ft_s", "ft/s", "fps"], unit("ft/s", Measure::Speed, 0.3048)),
    (&["cm_s", "cm/s"], unit("cm/s", Measure::Speed, 0.01)),
    (&["km_s", "km/s"], unit("km/s", Measure::Speed, 1000.0)),
    (&["pct", "percent", "%"], unit("percent", Measure::Ratio, 0.01)),
];

/// The unit of a name, in any case.
pub(crate) fn unit_named(name: &str) -> Option<Unit> {
    let name = name.trim().trim_end_matches('.').to_lowercase();
    UNITS.iter().find(|(spellings, _)| spellings.contains(&name.as_str())).map(|(_, unit)| *unit)
}

/// Metres per unit, of the metre and the kilometre: the units of elevations and maps that are read. `None` of all others.
pub(crate) fn metres_or_kilometres(name: &str) -> Option<f64> {
    let unit = unit_named(name).filter(|unit| unit.measure == Measure::Length)?;
    [1.0_f64, 1000.0].into_iter().find(|factor| factor.to_bits() == unit.factor.to_bits())
}

/// Whether a name is one of the metre.
pub(crate) fn is_metre(name: &str) -> bool {
    unit_named(name).is_some_and(|unit| unit.measure == Measure::Length && unit.is_ours())
}

/// How many metres a unit of length has; `None` for another unit, or one that is not known.
pub(crate) fn metres_per(name: &str) -> Option<f64> {
    unit_named(name).filter(|unit| unit.measure == Measure::Length).map(|unit| unit.factor)
}

/// A column's name without its unit, in lower case, and the text of its unit: `Z [ft]`, `z(ft)`, `z_ft` and `z ft` all give
/// `z` and `ft`. What stands in brackets is taken for a unit whatever it is; an ending only if it is one.
pub(crate) fn split_unit(name: &str) -> (String, Option<String>) {
    let lower = name.trim().to_lowercase();
    let tidy = |base: &str| base.trim().trim_end_matches(['_', ':', '-', ',']).trim_end().to_owned();
    if let Some((base, rest)) = lower.split_once(['[', '(', '{', '<'])
        && let Some(unit) = rest.trim_end().strip_suffix([']', ')', '}', '>'])
    {
        return (tidy(base), Some(unit.trim().to_owned()));
    }
    // `_m_s` ends in `_s` too: the longest ending that is a unit.
    let ends = lower.char_indices().filter(|(_, letter)| matches!(letter, '_' | ' ' | '.')).map(|(at, _)| at);
    let split = ends.filter(|at| *at > 0).find(|at| unit_named(&lower[at + 1..]).is_some());
    match split {
        Some(at) => (tidy(&lower[..at]), Some(lower[at + 1..].to_owned())),
        None => (tidy(&lower), None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metres_and_kilometres_are_told_from_other_units() {
        for (name, factor) in [
            ("m", Some(1.0)),
            (" METERS ", Some(1.0)),
            ("metre", Some(1.0)),
            ("KM", Some(1000.0)),
            ("Kilometers", Some(1000.0)),
            ("ft", None),
            ("cm", None),
            ("m/s", None),
            ("deg", None),
            ("", None),
        ] {
            assert_eq!((metres_or_kilometres(name), is_metre(name)), (factor, factor == Some(1.0)), "{name}");
        }
    }

    /// Factors: the definitions of the units (BIPM, and 1959 agreement on yard and pound).
    #[test]
    fn names_are_split_from_their_units() {
        for (name, base, unit, factor) in [
            ("x_m", "x", Some("m"), Some(1.0)),
            ("Z [ft]", "z", Some("ft"), Some(0.3048)),
            ("Elevation (m)", "elevation", Some("m"), Some(1.0)),
            ("z(km)", "z", Some("km"), Some(1000.0)),
            ("takeoff_speed_max_km_h", "takeoff_speed_max", Some("km_h"), Some(1.0 / 3.6)),
            ("takeoff_speed_max_m_s", "takeoff_speed_max", Some("m_s"), Some(1.0)),
            ("friction_pct", "friction", Some("pct"), Some(0.01)),
            ("cross_slope_rad", "cross_slope", Some("rad"), Some(57.295_779_513_082_32)),
            ("z [parsec]", "z", Some("parsec"), None),
            ("height us_ft", "height", Some("us_ft"), Some(0.304_800_609_601_219_2)),
            ("x", "x", None, None),
            ("x_coord", "x_coord", None, None),
            ("m", "m", None, None),
        ] {
            let (found, text) = split_unit(name);
            assert_eq!((found.as_str(), text.as_deref()), (base, unit), "{name}");
            let known = text.as_deref().and_then(unit_named).map(|unit| unit.factor);
            assert_eq!(known, factor, "{name}");
        }
    }
}
