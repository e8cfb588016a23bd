//! A path in time as CSV.

use std::io::{self, Write};

use super::path_record::{MapKnowledge, tenth_digit};
use crate::{
    path::{TimedState, Timetable},
    quantity::MapPoint,
    terrain::MapProjection,
};

/// The columns that every path has.
const COLUMNS: [&str; 7] = ["time_s", "hop", "phase", "x_m", "z_m", "vx_m_s", "vz_m_s"];

/// The additional columns on a map; velocities along its axes.
const MAP_COLUMNS: [&str; 4] = ["map_x_m", "map_y_m", "v_map_x_m_s", "v_map_y_m_s"];

/// The additional columns on a map of a known projection; velocities to true east and north.
const PROJECTION_COLUMNS: [&str; 4] = ["lon_deg", "lat_deg", "v_east_m_s", "v_north_m_s"];

/// The columns of a path in time.
pub fn trajectory_columns(known: MapKnowledge) -> Vec<&'static str> {
    let map: &[&str] = if known >= MapKnowledge::Metres { &MAP_COLUMNS } else { &[] };
    let of_projection: &[&str] = if known >= MapKnowledge::Projection { &PROJECTION_COLUMNS } else { &[] };
    COLUMNS.iter().chain(map).chain(of_projection).copied().collect()
}

/// Writes a path in time as CSV, with a header even without hops.
///
/// # Errors
/// An error of the writer.
pub fn write_trajectory_csv(
    table: &Timetable<'_>,
    known: MapKnowledge,
    projection: Option<&MapProjection>,
    out: impl Write,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(trajectory_columns(known))?;
    for state in table.states() {
        let hop = state.hop.to_string();
        let numbers = [state.x_m, state.z_m, state.vx_m_s, state.vz_m_s].map(|number| number.to_string());
        writer.write_field(state.time_s.to_string())?;
        for field in [hop.as_str(), state.phase.name()].into_iter().chain(numbers.iter().map(String::as_str)) {
            writer.write_field(field)?;
        }
        if known >= MapKnowledge::Metres {
            let velocity = state.map_velocity_m_s;
            for number in [state.map.map(|at| at.x), state.map.map(|at| at.y), velocity.map(|v| v.x), velocity.map(|v| v.y)] {
                writer.write_field(text(number))?;
            }
        }
        if known >= MapKnowledge::Projection {
            let on_body = state.map.zip(projection).map(|(at, projection)| on_body(&state, at, projection));
            for number in on_body.unwrap_or_default() {
                writer.write_field(text(number))?;
            }
        }
        writer.write_record(None::<&[u8]>)?;
    }
    writer.flush()
}

/// An absent number is an empty field.
fn text(number: Option<f64>) -> String {
    number.map(|number| number.to_string()).unwrap_or_default()
}

/// Longitude, latitude and the velocities to east and north; those are unknown at a pole.
fn on_body(state: &TimedState, at: MapPoint, projection: &MapProjection) -> [Option<f64>; 4] {
    let place = projection.lon_lat(at);
    let speed_m_s = state.map_velocity_m_s.map_or(0.0, |velocity| velocity.norm());
    let velocity = if speed_m_s == 0.0 {
        Some((0.0, 0.0))
    } else {
        projection.true_heading_deg(at, state.heading_deg).map(|heading_deg| libm::sincos(heading_deg.to_radians()))
    };
    [
        place.map(|place| tenth_digit(place.lon_deg)),
        place.map(|place| tenth_digit(place.lat_deg)),
        velocity.map(|(east, _)| tenth_digit(speed_m_s * east)),
        velocity.map(|(_, north)| tenth_digit(speed_m_s * north)),
    ]
}
