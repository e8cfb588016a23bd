//! Values of TOML as what they stand for.

use super::{
    Kind,
    face_groups::face_groups,
    kind::{SPEED_LEAST, SPEED_MOST},
};
use crate::{
    planner::{Amount, Objective},
    terrain::NoDataRule,
    world::{SlipCurve, SpeedLevels},
};

/// An integer or float as a number.
#[expect(clippy::cast_precision_loss, reason = "counts and metres stay below 2^53")]
pub(super) fn number(value: &toml::Value) -> Option<f64> {
    match value {
        toml::Value::Integer(integer) => Some(*integer as f64),
        toml::Value::Float(float) => Some(*float),
        _ => None,
    }
}

/// A rule for missing data: a number, its text, or `none`.
pub(super) fn no_data(value: &toml::Value) -> Option<NoDataRule> {
    match value.as_str() {
        Some(text) if text.eq_ignore_ascii_case("none") => Some(NoDataRule::Nothing),
        Some(text) => text.parse().ok().map(NoDataRule::Value),
        None => number(value).map(|number| NoDataRule::Value(number.into())),
    }
}

/// A whole number of at least 0.
pub(super) fn count(value: &toml::Value) -> Option<u64> {
    value.as_integer().and_then(|integer| u64::try_from(integer).ok())
}

/// An array of two numbers.
pub(super) fn pair(value: &toml::Value) -> Option<[f64; 2]> {
    match value.as_array()?.as_slice() {
        [a, b] => Some([number(a)?, number(b)?]),
        _ => None,
    }
}

/// An array of three numbers.
pub(super) fn triple(value: &toml::Value) -> Option<[f64; 3]> {
    match value.as_array()?.as_slice() {
        [a, b, c] => Some([number(a)?, number(b)?, number(c)?]),
        _ => None,
    }
}

/// An array of two arrays of three numbers.
pub(super) fn corners(value: &toml::Value) -> Option<[[f64; 3]; 2]> {
    match value.as_array()?.as_slice() {
        [low, high] => Some([triple(low)?, triple(high)?]),
        _ => None,
    }
}

/// An array of ascending speeds.
pub(super) fn speeds(value: &toml::Value) -> Option<SpeedLevels> {
    let speeds: Option<Vec<f64>> = value.as_array()?.iter().map(number).collect();
    let speeds = speeds.filter(|speeds| speeds.iter().all(|speed| (SPEED_LEAST..=SPEED_MOST).contains(speed)))?;
    SpeedLevels::new(&speeds).ok()
}

/// An array of pairs of a slope and a share.
pub(super) fn slip(value: &toml::Value) -> Option<SlipCurve> {
    let points: Option<Vec<[f64; 2]>> = value.as_array()?.iter().map(pair).collect();
    SlipCurve::new(&points?).ok()
}

/// An array of names of amounts that are an objective.
pub(super) fn objective(value: &toml::Value) -> Option<Objective> {
    let named = |name: &toml::Value| name.as_str().and_then(Amount::named);
    Objective::new(value.as_array()?.iter().map(named).collect::<Option<Vec<_>>>()?).ok()
}

/// Whether a number may be a coordinate, m.
fn is_coordinate(number: f64) -> bool {
    number.abs() <= 1e12
}

/// Whether a value is of a kind.
pub(crate) fn fits(value: &toml::Value, kind: Kind) -> bool {
    match kind {
        Kind::Number { min, max } => number(value).is_some_and(|n| min <= n && n <= max),
        Kind::AngleOrUnlimited => {
            value.as_str() == Some("inf") || number(value).is_some_and(|n| (0.0..=90.0).contains(&n) || n == f64::INFINITY)
        }
        Kind::AngleRange => pair(value).is_some_and(|[a, b]| -360.0 <= a && a <= b && b <= 360.0),
        Kind::MapPoint => pair(value).is_some_and(|p| p.iter().copied().all(is_coordinate)),
        Kind::MapOrSpacePoint => fits(value, Kind::MapPoint) || triple(value).is_some_and(|p| p.iter().copied().all(is_coordinate)),
        Kind::SpaceBounds => corners(value).is_some_and(|[low, high]| {
            low.iter().zip(&high).all(|(low, high)| is_coordinate(*low) && is_coordinate(*high) && low < high)
        }),
        Kind::LonLat => pair(value).is_some_and(|[lon, lat]| (-180.0..=360.0).contains(&lon) && (-90.0..=90.0).contains(&lat)),
        Kind::Flag => value.as_bool().is_some(),
        Kind::LonLats => value.as_array().is_some_and(|places| places.iter().all(|place| fits(place, Kind::LonLat))),
        Kind::MapPoints => value.as_array().is_some_and(|points| points.iter().all(|point| fits(point, Kind::MapPoint))),
        Kind::CountOrAuto => value.as_str() == Some("auto") || value.as_integer().is_some_and(|k| (0..=100_000).contains(&k)),
        Kind::NumberOrNone => no_data(value).is_some(),
        Kind::Count { min, max } => count(value).is_some_and(|n| (min..=max).contains(&n)),
        Kind::Word(words) => value.as_str().is_some_and(|word| words.contains(&word)),
        Kind::Speeds => speeds(value).is_some(),
        Kind::Amounts => objective(value).is_some(),
        Kind::SlipCurve => slip(value).is_some(),
        Kind::FaceGroups => face_groups(value).is_some(),
        Kind::Layer => value.as_table().is_some_and(|table| !table.is_empty()),
        Kind::Text => value.as_str().is_some_and(|text| !text.trim().is_empty()),
    }
}
