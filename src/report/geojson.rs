//! Paths and slices in three dimensions as GeoJSON, in the coordinates of the map.
//!
//! The reference system is written as the `crs` member of the format's 2008 edition, which GIS programs still read: as the uniform
//! resource name of an IAU or EPSG code if one is known, else as a PROJ string, which GDAL accepts there, with a `.prj` file beside
//! it.

use geojson::{Feature, FeatureCollection, Geometry, GeometryValue, JsonObject, Position};

use super::{
    TravelLegRecord,
    path_record::{HopRecord, tenth_digit},
};
use crate::{
    path::{Hop, HopPath},
    quantity::MapPoint,
    terrain::{MapProjection, Profile},
};

/// Points along each arc: the polyline deviates from the curve by less than a thousandth of the hop's length.
const POINTS_PER_ARC: u32 = 32;

/// A path over a map as a feature collection: an arc (a line in three dimensions) for each hop with all its columns, and a point
/// for each contact. `None` if the chain is not on a map.
///
/// Coordinates are easting, northing and height in metres of the input's map, not longitude and latitude; with a `projection`, the
/// properties have those too.
pub fn path_geojson(path: &HopPath, gravity_m_s2: f64, projection: Option<&MapProjection>) -> Option<String> {
    Some(document(path_features(path, None, gravity_m_s2, projection)?, projection))
}

/// The paths to several goals as one feature collection, as [`path_geojson`]. Each feature has the number of its `goal`: the index
/// of its path in the list, from 1.
pub fn paths_geojson(paths: &[&HopPath], gravity_m_s2: f64, projection: Option<&MapProjection>) -> Option<String> {
    let mut features = Vec::new();
    for (index, path) in paths.iter().enumerate() {
        features.extend(path_features(path, Some(index + 1), gravity_m_s2, projection)?);
    }
    Some(document(features, projection))
}

/// A mission over a map as a feature collection: a line over the waypoints of each drive leg and an arc for each hop, each with all its columns, and a
/// point for each contact of a hop. `hops`: those of the legs, in their order. `None` if they are not on a map.
///
/// Coordinates as in [`path_geojson`].
pub fn mission_geojson(
    legs: &[TravelLegRecord],
    hops: &[Hop],
    gravity_m_s2: f64,
    projection: Option<&MapProjection>,
) -> Option<String> {
    let (mut features, mut hops) = (Vec::new(), hops.iter());
    for leg in legs {
        let serde_json::Value::Object(mut properties) = serde_json::to_value(leg).ok()? else { return None };
        // They are the geometry.
        for key in ["takeoff_m", "landing_m", "waypoints_m", "steepest_at_m"] {
            properties.remove(key);
        }
        let properties = flat(properties);
        match leg {
            TravelLegRecord::Drive(drive) => {
                let coordinates = drive.waypoints_m.iter().map(|place| Position::from(*place)).collect();
                features.push(feature(GeometryValue::LineString { coordinates }, properties));
            }
            TravelLegRecord::Hop(leg) => {
                let hop = hops.next()?;
                let (takeoff, landing) = hop.map_ends()?;
                let coordinates = arc_positions(hop, (takeoff, landing), gravity_m_s2);
                features.push(feature(GeometryValue::LineString { coordinates }, properties));
                features.push(contact(leg.hop.hop - 1, takeoff, hop.takeoff.point_m.z, projection));
                features.push(contact(leg.hop.hop, landing, hop.landing.point_m.z, projection));
            }
        }
    }
    Some(document(features, projection))
}

/// Properties without an object, which a GIS shows as text: margins are under the names of the columns.
fn flat(mut properties: JsonObject) -> JsonObject {
    if let Some(serde_json::Value::Object(margins)) = properties.remove("margins") {
        properties.extend(margins.into_iter().map(|(key, value)| (format!("margin_{key}"), value)));
    }
    properties
}

/// Arcs and contacts of a path; `None` if it is not on a map.
fn path_features(
    path: &HopPath,
    goal: Option<usize>,
    gravity_m_s2: f64,
    projection: Option<&MapProjection>,
) -> Option<Vec<Feature>> {
    let rows = HopRecord::rows(path, projection);
    let mut features = Vec::new();
    for (hop, row) in path.hops.iter().zip(&rows) {
        let (takeoff, landing) = hop.map_ends()?;
        let serde_json::Value::Object(properties) = serde_json::to_value(row).ok()? else { return None };
        let mut properties = flat(properties);
        properties.insert("kind".to_owned(), "hop".into());
        features.push(feature(
            GeometryValue::LineString { coordinates: arc_positions(hop, (takeoff, landing), gravity_m_s2) },
            properties,
        ));
        if row.hop == 1 {
            features.push(contact(0, takeoff, hop.takeoff.point_m.z, projection));
        }
        features.push(contact(row.hop, landing, hop.landing.point_m.z, projection));
    }
    if let Some(goal) = goal {
        for properties in features.iter_mut().filter_map(|feature| feature.properties.as_mut()) {
            properties.insert("goal".to_owned(), goal.into());
        }
    }
    Some(features)
}

/// A slice, leg by leg, as one line in three dimensions, with the name of the sliced terrain and, with a `projection`, the
/// longitude and latitude of its ends.
pub fn slice_geojson(legs: &[Profile], source: &str, projection: Option<&MapProjection>) -> String {
    // A leg begins at the end of the previous one.
    let further = legs.iter().skip(1).flat_map(|leg| leg.points.iter().skip(1));
    let points: Vec<_> = legs.first().into_iter().flat_map(|leg| &leg.points).chain(further).collect();
    let coordinates = points.iter().map(|point| Position::from([point.map.x, point.map.y, point.z_m])).collect();
    let mut properties = JsonObject::new();
    properties.insert("kind".to_owned(), "slice".into());
    properties.insert("source".to_owned(), source.into());
    properties.insert("length_m".to_owned(), legs.iter().map(Profile::length_m).sum::<f64>().into());
    for (end, point) in [("from", points.first()), ("to", points.last())] {
        if let Some(point) = point {
            insert_lon_lat(&mut properties, &format!("{end}_"), point.map, projection);
        }
    }
    document(vec![feature(GeometryValue::LineString { coordinates }, properties)], projection)
}

/// Features with their reference system.
fn document(features: Vec<Feature>, projection: Option<&MapProjection>) -> String {
    let reference = projection.map(|projection| {
        let name = projection.urn().unwrap_or_else(|| projection.proj_string());
        let mut members = JsonObject::new();
        members.insert("crs".to_owned(), serde_json::json!({ "type": "name", "properties": { "name": name } }));
        members
    });
    let collection = FeatureCollection { bbox: None, features, foreign_members: reference };
    geojson::GeoJson::from(collection).to_string() + "\n"
}

/// Longitude and latitude as properties, if the projection is known and covers the point.
fn insert_lon_lat(properties: &mut JsonObject, prefix: &str, at: MapPoint, projection: Option<&MapProjection>) {
    if let Some(place) = projection.and_then(|projection| projection.lon_lat(at)) {
        properties.insert(format!("{prefix}lon_deg"), tenth_digit(place.lon_deg).into());
        properties.insert(format!("{prefix}lat_deg"), tenth_digit(place.lat_deg).into());
    }
}

/// The contact after the given number of hops.
fn contact(after_hops: usize, at: MapPoint, z_m: f64, projection: Option<&MapProjection>) -> Feature {
    let mut properties = JsonObject::new();
    properties.insert("kind".to_owned(), "contact".into());
    properties.insert("after_hops".to_owned(), after_hops.into());
    insert_lon_lat(&mut properties, "", at, projection);
    feature(GeometryValue::Point { coordinates: Position::from([at.x, at.y, z_m]) }, properties)
}

fn feature(geometry: GeometryValue, properties: JsonObject) -> Feature {
    Feature { bbox: None, geometry: Some(Geometry::new(geometry)), id: None, properties: Some(properties), foreign_members: None }
}

/// The arc of a hop, in three dimensions.
fn arc_positions(hop: &Hop, (takeoff, landing): (MapPoint, MapPoint), gravity_m_s2: f64) -> Vec<Position> {
    let along = landing - takeoff;
    hop.flight_points(gravity_m_s2, POINTS_PER_ARC + 1)
        .into_iter()
        .map(|(fraction, point)| {
            let place = takeoff + along * fraction;
            Position::from([place.x, place.y, point.z_m])
        })
        .collect()
}
