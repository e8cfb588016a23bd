//! The chain of a free route that a result holds, unrolled along the places of its hops.

use super::{Case, ReadBackError, dem_ground::dem_ground, free_route::unrolled};
use crate::{
    ground::{DemGround, MapPosition, Surface},
    quantity::MapPoint,
    report::HopRecord,
    scenario::Route,
};

/// The ground over which a path has to hold as well as along its chain; `None` for a transect.
pub(super) fn over_dem(case: &Case) -> Result<Option<DemGround>, ReadBackError> {
    if case.scenario.route == Route::Transect {
        return Ok(None);
    }
    dem_ground(case).map_err(|error| ReadBackError::Dem(Box::new(error)))
}

/// The case over the chain along the hops of a result; the case itself without hops.
///
/// # Errors
/// [`ReadBackError::NoPlaces`], [`ReadBackError::OtherEnds`], and those of the raster and of its slices.
pub(super) fn unrolled_along(case: &Case, rows: &[HopRecord]) -> Result<Case, ReadBackError> {
    let ends = |row: &HopRecord| {
        let map = row.map.as_ref().ok_or(ReadBackError::NoPlaces { hop: row.hop })?;
        Ok::<_, ReadBackError>([
            (MapPoint::new(map.takeoff_map_x_m, map.takeoff_map_y_m), row.takeoff_z_m),
            (MapPoint::new(map.landing_map_x_m, map.landing_map_y_m), row.landing_z_m),
        ])
    };
    let mut places = Vec::with_capacity(rows.len() + 1);
    for (number, row) in rows.iter().enumerate() {
        let [takeoff, landing] = ends(row)?;
        places.extend((number == 0).then_some(takeoff));
        places.push(landing);
    }
    let places: Vec<MapPosition> = places.into_iter().map(|(at, z_m)| MapPosition { at, z_m }).collect();
    let [Some(first), Some(last)] = [places.first(), places.last()] else { return Ok(case.clone()) };
    let ground = over_dem(case)?;
    // The numbers of a result are those of its path, bit by bit; its ends may be given in another way.
    let rounding_m = ground.map_or(0.0, |ground| ground.position_rounding_m());
    let (start, goal) = case.ends()?;
    let geometry = case.prepared.chain.geometry();
    let asked = [start, goal].map(|station| geometry.map_point(&station));
    if let [Some(start), Some(goal)] = asked
        && [(start, first.at), (goal, last.at)].iter().any(|(asked, found)| (asked - found).norm() > rounding_m)
    {
        return Err(ReadBackError::OtherEnds { found: [first.at, last.at], asked: [start, goal] });
    }
    Ok(unrolled(case, &places)?)
}
