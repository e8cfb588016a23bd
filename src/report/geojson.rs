//! The path in three dimensions as GeoJSON, in the coordinates of the map.

use geojson::{Feature, FeatureCollection, Geometry, GeometryValue, JsonObject, Position};

use super::path_record::HopRecord;
use crate::path::{Hop, HopPath, MapEnds};

/// Points drawn along each arc: under a thousandth of the hop's length off the true curve.
const POINTS_PER_ARC: u32 = 32;

/// A path over a map as a feature collection: an arc (a line in three dimensions) for each hop with all its columns, and a point for
/// each place that is touched. `None` where the chain lies on no map.
///
/// Coordinates are easting, northing and height in metres of the input's map, not longitude and latitude.
pub fn path_geojson(path: &HopPath, gravity_m_s2: f64) -> Option<String> {
    let rows = HopRecord::rows(path);
    let mut features = Vec::new();
    for (hop, row) in path.hops.iter().zip(&rows) {
        let map = hop.map?;
        let serde_json::Value::Object(mut properties) = serde_json::to_value(row).ok()? else { return None };
        properties.insert("kind".to_owned(), "hop".into());
        features.push(feature(GeometryValue::LineString { coordinates: arc_positions(hop, &map, gravity_m_s2) }, properties));
        if row.hop == 1 {
            features.push(contact(0, [map.takeoff.x, map.takeoff.y, hop.takeoff.point.z_m]));
        }
        features.push(contact(row.hop, [map.landing.x, map.landing.y, hop.landing.point.z_m]));
    }
    let collection = FeatureCollection { bbox: None, features, foreign_members: None };
    Some(geojson::GeoJson::from(collection).to_string() + "\n")
}

/// A place that is touched after so many hops.
fn contact(after_hops: usize, position: [f64; 3]) -> Feature {
    let mut properties = JsonObject::new();
    properties.insert("kind".to_owned(), "contact".into());
    properties.insert("after_hops".to_owned(), after_hops.into());
    feature(GeometryValue::Point { coordinates: Position::from(position) }, properties)
}

fn feature(geometry: GeometryValue, properties: JsonObject) -> Feature {
    Feature { bbox: None, geometry: Some(Geometry::new(geometry)), id: None, properties: Some(properties), foreign_members: None }
}

/// The arc of a hop, in three dimensions.
fn arc_positions(hop: &Hop, map: &MapEnds, gravity_m_s2: f64) -> Vec<Position> {
    let along = map.landing - map.takeoff;
    hop.flight_points(gravity_m_s2, POINTS_PER_ARC + 1)
        .into_iter()
        .map(|(fraction, point)| {
            let place = map.takeoff + along * fraction;
            Position::from([place.x, place.y, point.z_m])
        })
        .collect()
}
