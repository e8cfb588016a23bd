//! Polygons from `GeoJSON`.

use geojson::{Geometry, GeometryValue};
use serde_json::Value;

use super::polygons::Polygon;
use crate::{
    quantity::MapPoint,
    terrain::{CoordinateSystem, MapBounds},
};

/// How to convert zones in degrees to the terrain's map.
const MEND_DEGREES: &str = "bring the zones onto the terrain's map with: ogr2ogr -t_srs MAP.prj out.geojson in.geojson";

/// The polygons of a file, which holds a geometry, a feature or a collection of either.
///
/// # Errors
/// One sentence: which feature (from 1), what is wrong, how to correct it.
pub(super) fn polygons(bytes: &[u8], terrain: Option<&CoordinateSystem>, bounds: MapBounds) -> Result<Vec<Polygon>, String> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let root: Value = serde_json::from_slice(bytes).map_err(|error| {
        format!(
            "this is not JSON ({error}), expected GeoJSON with polygons; export them with: ogr2ogr -f GeoJSON out.geojson in.shp"
        )
    })?;
    if let Some(crs) = root.get("crs").filter(|crs| !crs.is_null()) {
        check_crs(crs, terrain)?;
    }
    let mut found = Vec::new();
    match root.get("type").and_then(Value::as_str) {
        Some("FeatureCollection") => {
            let features = root
                .get("features")
                .and_then(Value::as_array)
                .ok_or("the FeatureCollection has no array `features`; export it again")?;
            for (i, feature) in features.iter().enumerate() {
                add_feature(&format!("feature {}", i + 1), feature, &mut found)?;
            }
        }
        Some("Feature") => add_feature("feature 1", &root, &mut found)?,
        Some(_) => add_geometry("the geometry", &root, &mut found)?,
        None => {
            return Err("the JSON has no `type`, expected GeoJSON with polygons; export them with: ogr2ogr -f GeoJSON".to_owned());
        }
    }
    if found.is_empty() {
        return Err("found no polygon, expected at least one; leave out keep_out if nothing is kept out".to_owned());
    }
    check_place(&found, bounds)?;
    Ok(found)
}

/// The polygons of a feature.
fn add_feature(name: &str, feature: &Value, found: &mut Vec<Polygon>) -> Result<(), String> {
    if feature.get("type").and_then(Value::as_str) != Some("Feature") {
        return Err(format!("{name} has no `type` of `Feature`, expected a GeoJSON feature with a polygon; export the file again"));
    }
    match feature.get("geometry") {
        None | Some(Value::Null) => Err(format!("{name} has no geometry, expected a polygon; draw one or remove the feature")),
        Some(geometry) => add_geometry(name, geometry, found),
    }
}

/// The polygons of a geometry.
fn add_geometry(name: &str, geometry: &Value, found: &mut Vec<Polygon>) -> Result<(), String> {
    let geometry: Geometry = serde_json::from_value(geometry.clone()).map_err(|error| {
        format!("{name} is not a GeoJSON geometry ({error}), expected a Polygon or MultiPolygon; export the file again")
    })?;
    add(name, geometry.value, found)
}

fn add(name: &str, geometry: GeometryValue, found: &mut Vec<Polygon>) -> Result<(), String> {
    match geometry {
        GeometryValue::Polygon { coordinates } => found.push(polygon(name, &coordinates)?),
        GeometryValue::MultiPolygon { coordinates } => {
            for (i, rings) in coordinates.iter().enumerate() {
                found.push(polygon(&format!("{name}, polygon {}", i + 1), rings)?);
            }
        }
        GeometryValue::GeometryCollection { geometries } => {
            for (i, geometry) in geometries.into_iter().enumerate() {
                add(&format!("{name}, geometry {}", i + 1), geometry.value, found)?;
            }
        }
        other => {
            return Err(format!(
                "{name} is a {}, expected a Polygon or MultiPolygon; draw zones as areas (a buffer around lines and points)",
                other.type_name()
            ));
        }
    }
    Ok(())
}

/// One polygon, its rings closed and with an area.
fn polygon(name: &str, coordinates: &[Vec<geojson::Position>]) -> Result<Polygon, String> {
    let mut rings = Vec::with_capacity(coordinates.len());
    for (i, positions) in coordinates.iter().enumerate() {
        let name = format!("{name}, ring {}", i + 1);
        let point = |position: &geojson::Position| match position.as_slice() {
            [x, y, ..] if x.is_finite() && y.is_finite() => Ok(MapPoint::new(*x, *y)),
            _ => Err(format!(
                "{name} has a position without two finite coordinates, expected [x, y] in metres; export the file again"
            )),
        };
        let mut ring = positions.iter().map(point).collect::<Result<Vec<_>, _>>()?;
        if ring.len() < 2 || ring.first() != ring.last() {
            return Err(format!(
                "{name} is not closed: its last position differs from its first; repeat the first position at the end"
            ));
        }
        ring.pop();
        ring.dedup();
        if !has_area(&ring) {
            return Err(format!(
                "{name} encloses no area, expected at least three corners not on one line; draw it again or remove it"
            ));
        }
        rings.push(ring);
    }
    Polygon::new(rings).ok_or_else(|| format!("{name} is an empty polygon, expected at least one ring; draw it or remove it"))
}

/// Whether three corners of a ring span a triangle.
fn has_area(ring: &[MapPoint]) -> bool {
    let Some(first) = ring.first() else { return false };
    let Some(second) = ring.iter().find(|point| *point != first) else { return false };
    let edge = second - first;
    ring.iter().any(|point| edge.perp(&(point - first)) != 0.0)
}

/// Refuses a `crs` member (`GeoJSON` 2008) that means degrees, or has another code than the terrain.
fn check_crs(crs: &Value, terrain: Option<&CoordinateSystem>) -> Result<(), String> {
    let name = crs.pointer("/properties/name").and_then(Value::as_str).unwrap_or_default();
    let upper = name.to_uppercase();
    let code = upper.rsplit(':').next().and_then(|code| code.parse::<u16>().ok()).filter(|_| upper.contains("EPSG"));
    if upper.contains("CRS84") || code.is_some_and(|code| (4001..=4999).contains(&code)) {
        return Err(format!("its crs is {name}, in degrees, expected the terrain's map in metres; {MEND_DEGREES}"));
    }
    // 3072 is the ProjectedCRSGeoKey of the terrain; 32767 means user-defined.
    let own = terrain.and_then(|system| system.key_directory.chunks_exact(4).skip(1).find(|key| key[0] == 3072 && key[1] == 0));
    match (code, own.map(|key| key[3]).filter(|code| *code != 32767)) {
        (Some(found), Some(expected)) if found != expected => {
            Err(format!("its crs is EPSG:{found}, expected EPSG:{expected}, that of the terrain; {MEND_DEGREES}"))
        }
        _ => Ok(()),
    }
}

/// Refuses zones that all lie off the terrain: they would have no effect, and probably have another map or are in degrees.
fn check_place(polygons: &[Polygon], terrain: MapBounds) -> Result<(), String> {
    let meets = |zone: MapBounds| {
        zone.min.x <= terrain.max.x && terrain.min.x <= zone.max.x && zone.min.y <= terrain.max.y && terrain.min.y <= zone.max.y
    };
    if polygons.iter().any(|polygon| meets(polygon.bounds())) {
        return Ok(());
    }
    let Some(all) =
        polygons.iter().map(Polygon::bounds).reduce(|a, b| MapBounds { min: a.min.inf(&b.min), max: a.max.sup(&b.max) })
    else {
        return Ok(());
    };
    let degrees = all.min.x >= -180.0 && all.max.x <= 360.0 && all.min.y >= -90.0 && all.max.y <= 90.0;
    let why = if degrees { "; they look like degrees" } else { "" };
    Err(format!("all zones lie off the terrain{why}: they have {all}, expected some of {terrain}; {MEND_DEGREES}"))
}
