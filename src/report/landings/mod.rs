//! One row per landing: one set of columns for CSV and Parquet.

mod csv;
#[cfg(feature = "parquet")]
mod parquet;

use std::io;

pub use self::csv::CsvLandings;
#[cfg(feature = "parquet")]
pub use self::parquet::ParquetLandings;
use super::path_record::{MapKnowledge, heading_true_deg};
use crate::{
    quantity::MapPoint,
    terrain::MapProjection,
    uncertainty::{HopRecord, Policy},
    world::Direction,
};

/// A writer that takes landings one by one, so that memory does not grow with their number.
pub trait LandingWriter {
    /// Writes one landing.
    ///
    /// # Errors
    /// An error of the file system.
    fn write(&mut self, row: &LandingRow) -> io::Result<()>;

    /// Writes the buffered rest and ends the file.
    ///
    /// # Errors
    /// An error of the file system.
    fn finish(&mut self) -> io::Result<()>;
}

/// One landing of one trial.
#[derive(Clone, Debug, PartialEq)]
pub struct LandingRow {
    /// The trial's number, from 0.
    pub trial: u64,
    /// The hop's number within the trial, from 1.
    pub hop: u32,
    /// The policy flown.
    pub policy: &'static str,
    /// The outcome of the trial, if this is the landing of its last hop; else empty. A trial whose last hop did not land has no such
    /// row.
    pub outcome: &'static str,
    /// The numbers, in the order of [`number_columns`].
    pub numbers: [f64; NUMBERS],
    /// The errors drawn for the hop, in the order of [`DRAWN_COLUMNS`].
    pub drawn: [f64; DRAWN_COLUMNS.len()],
    /// The heading from true north at the take-off, on a map of a known projection; absent at a pole.
    pub heading_true_deg: Option<f64>,
}

/// The columns of a table of landings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LandingColumns {
    /// How the landings are located on a map.
    pub known: MapKnowledge,
    /// Whether the errors drawn for each hop stand beside its landing.
    pub drawn: bool,
}

/// The errors drawn for a hop. On a chain a position is along it and to its left, on a map east and north.
pub const DRAWN_COLUMNS: [&str; 8] = [
    "drawn_takeoff_speed_m_s",
    "drawn_takeoff_angle_deg",
    "drawn_heading_deg",
    "drawn_drift_along_m",
    "drawn_drift_across_m",
    "drawn_position_x_m",
    "drawn_position_y_m",
    "drawn_friction_coefficient",
];

/// The last column, on a map of a known projection.
const TRUE_HEADING: &str = "heading_true_deg";

/// The number of numeric columns in a row.
const NUMBERS: usize = 16;

/// The columns before the numbers.
const FIRST_COLUMNS: [&str; 4] = ["trial", "hop", "policy", "outcome"];

/// The columns of numbers along a chain; y is to the left of the plane of travel, and `direction` is 1 towards +x, -1 towards -x.
const ON_CHAIN: [&str; NUMBERS] = [
    "takeoff_x_m",
    "takeoff_y_m",
    "takeoff_z_m",
    "direction",
    "takeoff_speed_m_s",
    "takeoff_angle_deg",
    "planned_x_m",
    "planned_y_m",
    "landing_x_m",
    "landing_y_m",
    "landing_z_m",
    "landing_speed_m_s",
    "landing_angle_deg",
    "rest_x_m",
    "rest_y_m",
    "error_m",
];

/// The same on a map: x is east and y north, the heading is clockwise from grid north.
const ON_MAP: [&str; NUMBERS] = [
    "takeoff_map_x_m",
    "takeoff_map_y_m",
    "takeoff_z_m",
    "heading_deg",
    "takeoff_speed_m_s",
    "takeoff_angle_deg",
    "planned_map_x_m",
    "planned_map_y_m",
    "landing_map_x_m",
    "landing_map_y_m",
    "landing_z_m",
    "landing_speed_m_s",
    "landing_angle_deg",
    "rest_map_x_m",
    "rest_map_y_m",
    "error_m",
];

/// The names of the numbers in a row.
pub const fn number_columns(known: MapKnowledge) -> &'static [&'static str; NUMBERS] {
    if matches!(known, MapKnowledge::Nothing) { &ON_CHAIN } else { &ON_MAP }
}

impl LandingRow {
    /// The row of a flown hop; `None` if it did not land.
    pub fn new(record: &HopRecord, policy: Policy, on_a_map: bool, projection: Option<&MapProjection>) -> Option<Self> {
        let direction = if on_a_map {
            let degrees = libm::atan2(record.heading.x, record.heading.y).to_degrees();
            if degrees < 0.0 { degrees + 360.0 } else { degrees }
        } else {
            (if record.heading.x < 0.0 { Direction::Reverse } else { Direction::Forward }).sign()
        };
        let takeoff = MapPoint::new(record.takeoff_m.x, record.takeoff_m.y);
        record.landed.then(|| Self {
            heading_true_deg: projection
                .filter(|_| on_a_map)
                .and_then(|projection| heading_true_deg(projection, takeoff, direction)),
            drawn: [
                record.drawn.takeoff_speed_m_s,
                record.drawn.takeoff_angle.degrees(),
                record.drawn.heading.degrees(),
                record.drawn.drift_m[0],
                record.drawn.drift_m[1],
                record.drawn.position_m[0],
                record.drawn.position_m[1],
                record.drawn.friction_coefficient,
            ],
            trial: record.trial,
            hop: record.hop,
            policy: policy.name(),
            outcome: record.outcome.map_or("", |outcome| outcome.name()),
            numbers: [
                record.takeoff_m.x,
                record.takeoff_m.y,
                record.takeoff_m.z,
                direction,
                record.takeoff_speed_m_s(),
                record.takeoff_angle().degrees(),
                record.planned_m.x,
                record.planned_m.y,
                record.contact_m.x,
                record.contact_m.y,
                record.contact_m.z,
                record.landing_speed_m_s(),
                record.landing_angle().degrees(),
                record.rest_m.x,
                record.rest_m.y,
                record.error_m,
            ],
        })
    }
}
