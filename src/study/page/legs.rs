//! The legs of a path on the map, and the ground under them.

use serde_json::Value;

use super::{PageError, drawn};
use crate::{
    quantity::MapPoint,
    report::ProfilePiece,
    terrain::{Dem, slice},
};

/// A place of a leg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// On the map.
    pub(super) at: MapPoint,
    /// Its height, m.
    pub(super) z_m: f64,
}

/// The places of every leg of a document: take-off and landing of a hop, the waypoints of a drive; empty for a leg that lies on no map.
pub(super) fn places(path: &[Value]) -> Vec<Vec<Place>> {
    path.iter().map(|leg| of_leg(leg).unwrap_or_default()).collect()
}

fn of_leg(leg: &Value) -> Option<Vec<Place>> {
    let number = |key: &str| leg[key].as_f64();
    if let Some(waypoints) = leg["waypoints_m"].as_array() {
        let place = |at: &Value| Some(Place { at: MapPoint::new(at[0].as_f64()?, at[1].as_f64()?), z_m: at[2].as_f64()? });
        return waypoints.iter().map(place).collect();
    }
    let place = |which: &str| {
        let at = MapPoint::new(number(&format!("{which}_map_x_m"))?, number(&format!("{which}_map_y_m"))?);
        Some(Place { at, z_m: number(&format!("{which}_z_m"))? })
    };
    Some(vec![place("takeoff")?, place("landing")?])
}

/// All places on the map.
pub(super) fn on_map(legs: &[Vec<Place>]) -> Vec<MapPoint> {
    legs.iter().flatten().map(|place| place.at).collect()
}

/// The ground of a DEM under every leg.
///
/// # Errors
/// [`PageError::Leg`]: a leg off the DEM, or over a gap of it.
pub(super) fn pieces_over(dem: &Dem, legs: &[Vec<Place>]) -> Result<Vec<ProfilePiece>, PageError> {
    let piece = |(leg, places): (usize, &Vec<Place>)| {
        let mut piece = ProfilePiece { leg: Some(leg), ..ProfilePiece::default() };
        let mut from_m = 0.0;
        for ends in places.windows(2).filter(|ends| ends[0].at != ends[1].at) {
            let profile = slice(dem, ends[0].at, ends[1].at).map_err(|problem| PageError::Leg { leg, problem })?;
            piece.x_m.extend(profile.points.iter().map(|point| drawn(from_m + point.x_m)));
            piece.z_m.extend(profile.points.iter().map(|point| drawn(point.z_m)));
            from_m += profile.length_m();
        }
        Ok(piece)
    };
    let pieces: Result<Vec<_>, PageError> = legs.iter().enumerate().map(piece).collect();
    Ok(pieces?.into_iter().filter(|piece| piece.x_m.len() > 1).collect())
}
