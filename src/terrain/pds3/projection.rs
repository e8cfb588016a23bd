//! The `IMAGE_MAP_PROJECTION` object: the position of the posts, and their map.

use super::label::{Label, shown, unsuitable};
use crate::quantity::MapPoint;
use crate::terrain::{CoordinateSystem, GeoReference, TerrainError};

const OBJECT: &str = "IMAGE_MAP_PROJECTION";

/// The largest rotation of a map that still counts as north up, degrees: rounding in the label.
const STRAIGHT_DEG: f64 = 1.0e-9;

/// The position of the posts: `LINE_PROJECTION_OFFSET` and `SAMPLE_PROJECTION_OFFSET` count from the centre of the first post
/// to the origin of the map,
///
/// ```text
/// x = (column - SAMPLE_PROJECTION_OFFSET) * MAP_SCALE,   y = (LINE_PROJECTION_OFFSET - row) * MAP_SCALE,   row and column from 0
/// ```
///
/// (PDS data dictionary; GDAL's PDS driver puts the corner half a post outside the same centre).
///
/// # Errors
/// [`TerrainError::Unsuitable`] if the object or one of its keys is missing, its scale is not a length, or the map is
/// rotated.
pub(super) fn place(label: &Label) -> Result<GeoReference, TerrainError> {
    let missing = |key: &str| {
        unsuitable(
            format!("no {key} in an {OBJECT} object"),
            "MAP_SCALE, LINE_PROJECTION_OFFSET and SAMPLE_PROJECTION_OFFSET (some products keep them in DSMAP.CAT)",
        )
    };
    if let Some(turn) = label.number(OBJECT, "MAP_PROJECTION_ROTATION")?.filter(|turn| turn.abs() > STRAIGHT_DEG) {
        return Err(unsuitable(format!("MAP_PROJECTION_ROTATION {turn}"), "a north-up map"));
    }
    let scale_m = scale_m(label)?.ok_or_else(|| missing("MAP_SCALE"))?;
    let offset = |key: &str| label.number(OBJECT, key)?.ok_or_else(|| missing(key));
    let north_west = MapPoint::new(-offset("SAMPLE_PROJECTION_OFFSET")? * scale_m, offset("LINE_PROJECTION_OFFSET")? * scale_m);
    let mut georeference = GeoReference::local(north_west, scale_m, scale_m)?;
    georeference.coordinate_system = coordinate_system(label)?;
    Ok(georeference)
}

/// `MAP_SCALE` in m per post; without a unit it is in km, as the data dictionary defines.
fn scale_m(label: &Label) -> Result<Option<f64>, TerrainError> {
    let (Some(value), Some(number)) = (label.value(OBJECT, "MAP_SCALE")?, label.number(OBJECT, "MAP_SCALE")?) else {
        return Ok(None);
    };
    let unit = value.unit.clone().unwrap_or_else(|| "KM/PIXEL".to_owned());
    let length = unit.split('/').next().unwrap_or_default().trim();
    match length {
        "M" | "METER" | "METERS" => Ok(Some(number)),
        "KM" | "KILOMETER" | "KILOMETERS" => Ok(Some(number * 1000.0)),
        _ => Err(unsuitable(format!("MAP_SCALE in {}", shown(&unit)), "<KM/PIXEL> or <M/PIXEL>")),
    }
}

/// `GeoTIFF` codes of a projection: its method, then key and value in degrees of each parameter.
struct Method {
    code: u16,
    parameters: Vec<(u16, f64)>,
}

/// "User-defined", which as a method means one that the keys cannot state.
const USER_DEFINED: u16 = 32767;

/// The map as `GeoTIFF` keys, so that all outputs can carry it; without numbers where the projection or the radii are not known.
fn coordinate_system(label: &Label) -> Result<CoordinateSystem, TerrainError> {
    let Some(projection) = label.value(OBJECT, "MAP_PROJECTION_TYPE")? else { return Ok(CoordinateSystem::default()) };
    let name = projection.text.to_ascii_uppercase();
    let target = label.value("", "TARGET_NAME")?.map(|target| target.text.clone()).unwrap_or_default();
    let description = Some(format!("{target} {name}").trim().to_owned());
    let west = label.value(OBJECT, "POSITIVE_LONGITUDE_DIRECTION")?.is_some_and(|way| way.text.eq_ignore_ascii_case("WEST"));
    let latitude = label.number(OBJECT, "CENTER_LATITUDE")?.unwrap_or(0.0);
    let longitude = label.number(OBJECT, "CENTER_LONGITUDE")?.unwrap_or(0.0) * if west { -1.0 } else { 1.0 };
    let radii = (radius_m(label, "A_AXIS_RADIUS")?, radius_m(label, "C_AXIS_RADIUS")?);
    // A projection that is not known is stated as such, so that it is not taken for a local map.
    let method = method(&name, latitude, longitude).unwrap_or(Method { code: USER_DEFINED, parameters: Vec::new() });
    let mut doubles = Vec::new();
    // Projected, user-defined throughout, degrees and metres (OGC GeoTIFF 1.1).
    let mut entries = vec![
        [1024, 0, 1, 1],
        [1025, 0, 1, 2],
        [2048, 0, 1, USER_DEFINED],
        [2050, 0, 1, USER_DEFINED],
        [2054, 0, 1, 9102],
        [2056, 0, 1, USER_DEFINED],
        [3072, 0, 1, USER_DEFINED],
        [3074, 0, 1, USER_DEFINED],
        [3075, 0, 1, method.code],
        [3076, 0, 1, 9001],
    ];
    if let (Some(equator_m), pole_m) = radii {
        entries.extend([[2057, 34736, 1, 0], [2058, 34736, 1, 1]]);
        doubles.extend([equator_m, pole_m.unwrap_or(equator_m)]);
    }
    for (key, value) in method.parameters.into_iter().chain([(3082, 0.0), (3083, 0.0)]) {
        entries.push([key, 34736, 1, u16::try_from(doubles.len()).unwrap_or(u16::MAX)]);
        doubles.push(value);
    }
    let mut ascii_parameters = String::new();
    let citation = description.clone().filter(|text| text.is_ascii() && text.len() < 200 && !text.contains(['|', '\0']));
    if let Some(citation) = citation {
        entries.push([3073, 34737, u16::try_from(citation.len() + 1).unwrap_or(u16::MAX), 0]);
        ascii_parameters = citation + "|";
    }
    entries.sort_unstable();
    let mut key_directory = vec![1, 1, 0, u16::try_from(entries.len()).unwrap_or(u16::MAX)];
    key_directory.extend(entries.into_iter().flatten());
    Ok(CoordinateSystem { key_directory, double_parameters: doubles, ascii_parameters, description })
}

fn method(name: &str, latitude: f64, longitude: f64) -> Option<Method> {
    let (code, parameters) = match name {
        "SIMPLE_CYLINDRICAL" | "EQUIRECTANGULAR" => (17, vec![(3078, latitude), (3088, longitude), (3089, 0.0)]),
        "POLAR_STEREOGRAPHIC" | "POLAR STEREOGRAPHIC" => (15, vec![(3081, latitude), (3092, 1.0), (3095, longitude)]),
        "STEREOGRAPHIC" => (14, vec![(3088, longitude), (3089, latitude), (3092, 1.0)]),
        "SINUSOIDAL" => (24, vec![(3088, longitude)]),
        "ORTHOGRAPHIC" => (21, vec![(3088, longitude), (3089, latitude)]),
        "TRANSVERSE_MERCATOR" => (1, vec![(3080, longitude), (3081, latitude), (3092, 1.0)]),
        _ => return None,
    };
    Some(Method { code, parameters })
}

/// A radius in m; labels without a unit give km.
fn radius_m(label: &Label, key: &str) -> Result<Option<f64>, TerrainError> {
    let (Some(value), Some(number)) = (label.value(OBJECT, key)?, label.number(OBJECT, key)?) else { return Ok(None) };
    match value.unit.as_deref().unwrap_or("KM") {
        "KM" | "KILOMETER" | "KILOMETERS" => Ok(Some(number * 1000.0)),
        "M" | "METER" | "METERS" => Ok(Some(number)),
        unit => Err(unsuitable(format!("{key} in {}", shown(unit)), "<KM>")),
    }
}
