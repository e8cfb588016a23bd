//! Polygons from `GeoJSON`.

use geojson::{Geometry, GeometryValue};
use serde_json::Value;

use super::polygons::Polygon;
use super::same_map::{SameMap, mend_zones, of_geojson};
use crate::{
    quantity::MapPoint,
    terrain::{CoordinateSystem, MapBounds, without_mark},
};

/// The polygons of a file, which holds a geometry, a feature or a collection of either, and how its map compares with the terrain's.
///
/// # Errors
/// One sentence: which feature (from 1), what is wrong, how to correct it.
pub(super) fn polygons(
    bytes: &[u8],
    terrain: Option<&CoordinateSystem>,
    bounds: MapBounds,
) -> Result<(Vec<Polygon>, SameMap), String> {
    let root: Value = serde_json::from_slice(without_mark(bytes)).map_err(|error| {
        format!(
            "this is not JSON ({error}), expected GeoJSON with polygons; export them with: ogr2ogr -f GeoJSON out.geojson in.shp"
        )
    })?;
    // A collection, its features and their geometries may each state it.
    let mut same = SameMap::Agreed;
    for crs in stated_systems(&root) {
        if let not_compared @ SameMap::NotCompared(_) = of_geojson(crs, terrain)? {
            same = not_compared;
        }
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
    check_place(&found, bounds, terrain)?;
    Ok((found, same))
}

/// The `crs` members of a collection, of its features and of their geometries; equal neighbours once.
fn stated_systems(root: &Value) -> Vec<&Value> {
    let members = |name: &str| root.get(name).and_then(Value::as_array).into_iter().flatten();
    let parts = members("features").chain(members("geometries")).chain([root]);
    let mut found: Vec<&Value> =
        parts.flat_map(|part| [part.get("crs"), part.pointer("/geometry/crs")]).flatten().filter(|crs| !crs.is_null()).collect();
    found.dedup();
    found
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

/// Refuses zones that all lie off the terrain: they would have no effect, and probably have another map or are in degrees.
fn check_place(polygons: &[Polygon], terrain: MapBounds, system: Option<&CoordinateSystem>) -> Result<(), String> {
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
    // Beside a small local map the numbers of both are small, and say nothing.
    let degrees = all.may_be_degrees() && !terrain.may_be_degrees();
    let why = if degrees { "; they look like degrees" } else { "" };
    Err(format!("all zones lie off the terrain{why}: they have {all}, expected some of {terrain}; {}", mend_zones(system, degrees)))
}
