//! The path as rows: one set of columns for JSON and CSV.

use std::io::{self, Write};

use serde::Serialize;

use crate::path::{Hop, HopPath, Totals};

/// One hop of a path, as plain data. The columns of path.csv and the keys of `path` in JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HopRecord {
    /// Number, from 1.
    pub hop: usize,
    /// Direction of travel.
    pub direction: &'static str,
    /// Where it takes off, along the chain.
    pub takeoff_x_m: f64,
    /// Its height.
    pub takeoff_z_m: f64,
    /// Where it lands, along the chain.
    pub landing_x_m: f64,
    /// Its height.
    pub landing_z_m: f64,
    /// Take-off angle above the horizontal, as seen by the traveller.
    pub takeoff_angle_deg: f64,
    /// Take-off speed.
    pub takeoff_speed_m_s: f64,
    /// Landing angle, negative on the way down.
    pub landing_angle_deg: f64,
    /// Landing speed.
    pub landing_speed_m_s: f64,
    /// Flight time.
    pub flight_time_s: f64,
    /// Height of the highest point of the flight.
    pub apex_z_m: f64,
    /// The least feasible take-off angle.
    pub takeoff_angle_min_deg: f64,
    /// The greatest feasible take-off angle.
    pub takeoff_angle_max_deg: f64,
    /// The smaller of the margins that take-off and landing speed leave.
    pub speed_margin_m_s: f64,
    /// Which limits set the least and the greatest feasible angle, `lower/upper`.
    pub binding: String,
    /// On a map: direction of flight, clockwise from grid north.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub map: Option<MapRecord>,
}

/// The columns of a hop on a map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MapRecord {
    /// Direction of flight, clockwise from grid north.
    pub heading_deg: f64,
    /// Where it takes off, easting.
    pub takeoff_map_x_m: f64,
    /// Where it takes off, northing.
    pub takeoff_map_y_m: f64,
    /// Where it lands, easting.
    pub landing_map_x_m: f64,
    /// Where it lands, northing.
    pub landing_map_y_m: f64,
}

/// What the hops of a path add up to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TotalsRecord {
    /// Time in flight.
    pub flight_time_s: f64,
    /// Energy per unit mass.
    pub energy_j_kg: f64,
    /// The greatest take-off speed.
    pub peak_takeoff_speed_m_s: f64,
    /// The sum of horizontal distances.
    pub ground_distance_m: f64,
    /// Energy, with a mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_j: Option<f64>,
    /// Flight and rest, with a rest time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mission_time_s: Option<f64>,
}

impl HopRecord {
    /// The rows of a path.
    pub fn rows(path: &HopPath) -> Vec<Self> {
        path.hops.iter().enumerate().map(|(i, hop)| Self::new(i + 1, hop)).collect()
    }

    fn new(number: usize, hop: &Hop) -> Self {
        Self {
            hop: number,
            direction: hop.direction.name(),
            takeoff_x_m: hop.takeoff.point.x_m,
            takeoff_z_m: hop.takeoff.point.z_m,
            landing_x_m: hop.landing.point.x_m,
            landing_z_m: hop.landing.point.z_m,
            takeoff_angle_deg: hop.takeoff_angle.degrees(),
            takeoff_speed_m_s: hop.takeoff_speed_m_s,
            landing_angle_deg: hop.landing_angle.degrees(),
            landing_speed_m_s: hop.landing_speed_m_s,
            flight_time_s: hop.flight_time_s,
            apex_z_m: hop.apex_z_m,
            takeoff_angle_min_deg: hop.takeoff_angles.min.degrees(),
            takeoff_angle_max_deg: hop.takeoff_angles.max.degrees(),
            speed_margin_m_s: hop.speed_margin_m_s,
            binding: format!("{}/{}", hop.lower_limit, hop.upper_limit),
            map: hop.map.map(|map| MapRecord {
                heading_deg: map.heading_deg,
                takeoff_map_x_m: map.takeoff.x,
                takeoff_map_y_m: map.takeoff.y,
                landing_map_x_m: map.landing.x,
                landing_map_y_m: map.landing.y,
            }),
        }
    }
}

impl From<&Totals> for TotalsRecord {
    fn from(totals: &Totals) -> Self {
        Self {
            flight_time_s: unsigned_zero(totals.flight_time_s),
            energy_j_kg: unsigned_zero(totals.energy_j_kg),
            peak_takeoff_speed_m_s: totals.peak_takeoff_speed_m_s,
            ground_distance_m: unsigned_zero(totals.ground_distance_m),
            energy_j: totals.energy_j.map(unsigned_zero),
            mission_time_s: totals.mission_time_s.map(unsigned_zero),
        }
    }
}

/// The sum over no hop at all is a negative zero in floating point, and so is a level line of sight seen backwards; nobody wants to read that.
pub(super) fn unsigned_zero(number: f64) -> f64 {
    if number == 0.0 { 0.0 } else { number }
}

/// The columns of path.csv that every chain has.
const COLUMNS: [&str; 16] = [
    "hop",
    "direction",
    "takeoff_x_m",
    "takeoff_z_m",
    "landing_x_m",
    "landing_z_m",
    "takeoff_angle_deg",
    "takeoff_speed_m_s",
    "landing_angle_deg",
    "landing_speed_m_s",
    "flight_time_s",
    "apex_z_m",
    "takeoff_angle_min_deg",
    "takeoff_angle_max_deg",
    "speed_margin_m_s",
    "binding",
];

/// The further columns of a chain on a map.
const MAP_COLUMNS: [&str; 5] = ["heading_deg", "takeoff_map_x_m", "takeoff_map_y_m", "landing_map_x_m", "landing_map_y_m"];

/// Writes a path as CSV, the header also where there is no hop.
///
/// # Errors
/// What the writer says.
pub fn write_path_csv(rows: &[HopRecord], on_map: bool, out: impl Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let columns = COLUMNS.iter().chain(MAP_COLUMNS.iter().filter(|_| on_map));
    writer.write_record(columns)?;
    for row in rows {
        let numbers = [
            row.takeoff_x_m,
            row.takeoff_z_m,
            row.landing_x_m,
            row.landing_z_m,
            row.takeoff_angle_deg,
            row.takeoff_speed_m_s,
            row.landing_angle_deg,
            row.landing_speed_m_s,
            row.flight_time_s,
            row.apex_z_m,
            row.takeoff_angle_min_deg,
            row.takeoff_angle_max_deg,
            row.speed_margin_m_s,
        ];
        let mut record = vec![row.hop.to_string(), row.direction.to_owned()];
        record.extend(numbers.iter().map(ToString::to_string));
        record.push(row.binding.clone());
        if let Some(map) = row.map.filter(|_| on_map) {
            let numbers = [map.heading_deg, map.takeoff_map_x_m, map.takeoff_map_y_m, map.landing_map_x_m, map.landing_map_y_m];
            record.extend(numbers.iter().map(ToString::to_string));
        }
        writer.write_record(&record)?;
    }
    writer.flush()
}
