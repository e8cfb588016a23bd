//! The kinds of values that keys of scenarios take.

use crate::{
    planner::{Amount, Objective},
    world::SpeedLevels,
};

/// Lengths and speeds beyond these bounds are mistakes of units.
pub(super) const SPEED_LEAST: f64 = 1e-9;
pub(super) const SPEED_MOST: f64 = 1e5;

/// The greatest whole number that TOML has.
pub(super) const MOST: u64 = i64::MAX as u64;

/// The kind of value that a key takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number between two bounds, both included.
    Number {
        /// The least.
        min: f64,
        /// The greatest.
        max: f64,
    },
    /// An angle from 0 to 90 degrees, or `inf`.
    AngleOrUnlimited,
    /// Two numbers `[min, max]`, in degrees.
    AngleRange,
    /// Two numbers `[x, y]` on the map, in metres.
    MapPoint,
    /// Two numbers `[x, y]` on the map, or three `[x, y, z]` in space, in metres.
    MapOrSpacePoint,
    /// Two points `[[x, y, z], [x, y, z]]` in space, in metres: the lowest and the highest corner of a box.
    SpaceBounds,
    /// Two numbers `[longitude, latitude]`, in degrees.
    LonLat,
    /// `true` or `false`.
    Flag,
    /// A list of points `[x, y]` on the map, in metres.
    MapPoints,
    /// A list of positions `[longitude, latitude]`, in degrees.
    LonLats,
    /// A whole number, or `"auto"`.
    CountOrAuto,
    /// A whole number between two bounds, both included.
    Count {
        /// The least.
        min: u64,
        /// The greatest.
        max: u64,
    },
    /// A number, or `"none"`.
    NumberOrNone,
    /// One of these words.
    Word(&'static [&'static str]),
    /// A list of speeds in m/s, ascending.
    Speeds,
    /// A list of amounts of a path, the first to be least, the next to break its ties.
    Amounts,
    /// A list of pairs `[slope, share]`, a slope in degrees and the share of the speed lost on it, slopes ascending.
    SlipCurve,
    /// Tables of groups of faces, by their names.
    FaceGroups,
    /// A table of a layer; its name is any, so that the key of the catalogue is called NAME.
    Layer,
    /// Any text.
    Text,
}

impl Kind {
    /// The expected value, for messages.
    pub fn expected(&self) -> String {
        match self {
            Self::Number { min, max } => format!("a number from {} to {}", bound(*min), bound(*max)),
            Self::AngleOrUnlimited => "an angle from 0 to 90 degrees, or inf".to_owned(),
            Self::AngleRange => "two angles in degrees, [min, max], from -360 to 360, min not above max".to_owned(),
            Self::MapPoint => "two finite numbers in metres, [x, y]".to_owned(),
            Self::MapOrSpacePoint => {
                "two finite numbers in metres, [x, y], or for a free route over a mesh three, [x, y, z]".to_owned()
            }
            Self::SpaceBounds => {
                "two corners of a box in metres, the lowest and the highest, [[x, y, z], [x, y, z]], each coordinate of the second above that of \
                 the first"
                    .to_owned()
            }
            Self::LonLat => "[longitude, latitude] in degrees, east positive, from -180 to 360 and from -90 to 90".to_owned(),
            Self::Flag => "true or false".to_owned(),
            Self::LonLats => "a list of positions, each [longitude, latitude] in degrees, [[lon, lat], ...]".to_owned(),
            Self::MapPoints => "a list of points, each two finite numbers in metres, [[x, y], ...]".to_owned(),
            Self::CountOrAuto => "a whole number from 0 to 100000, or \"auto\"".to_owned(),
            Self::NumberOrNone => "a number, or \"none\"".to_owned(),
            Self::Count { min, max } if *max == MOST => format!("a whole number of at least {min}"),
            Self::Count { min, max } => format!("a whole number from {min} to {max}"),
            Self::Word(words) => format!("one of {}", words.join(", ")),
            Self::Speeds => format!(
                "a list of 1 to {} speeds in m/s, ascending without repetition, each from {} to {}, such as [2.0, 4.0]",
                SpeedLevels::MOST,
                bound(SPEED_LEAST),
                bound(SPEED_MOST)
            ),
            Self::Amounts => format!(
                "a list of 1 to {} of {}, each once, {} last only, such as [\"hops\", \"energy\"]",
                Objective::MOST,
                Amount::all_names(),
                Amount::PeakSpeed
            ),
            Self::SlipCurve => {
                "a list of pairs [slope, share], slopes from -89 to 89 degrees ascending, shares of the speed lost from 0 to below 1, such as \
                 [[0.0, 0.0], [20.0, 0.4]]"
                    .to_owned()
            }
            Self::FaceGroups => {
                "a table for each group of faces, with friction_coefficient (a number from 0 to 1e6), rest_slope_max_deg (an angle \
                                 from 0 to 90 degrees, or inf) or keep_out (true or false), such as [surface.group.ice]"
                    .to_owned()
            }
            Self::Layer => {
                "a table with raster (a path), min, max or equals (numbers), applies_to (contact, flight or a list of both) and the keys of an outage, such as [layer.sun]"
                    .to_owned()
            }
            Self::Text => "a text in quotes, not empty".to_owned(),
        }
    }
}

/// A bound in the usual notation: with an exponent only where it has many zeros.
fn bound(number: f64) -> String {
    if number == 0.0 || (1e-3..1e4).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}
