//! Whether zones and rasters lie on the terrain's map: what they say of their reference system against what the terrain says.

use serde_json::Value;

use super::cells::disagreement;
use crate::terrain::projection::{iau_radius_m, is_geodetic, projected_code, states_a_map};
use crate::terrain::{CoordinateSystem, Ellipsoid, MapProjection, NoProjection};

/// The command that brings zones onto the terrain's map.
///
/// `degrees`: whether they are longitudes and latitudes that GDAL would take for those of the Earth, and refuse to convert for
/// another body.
pub(super) fn mend_zones(terrain: Option<&CoordinateSystem>, degrees: bool) -> String {
    let own = terrain.and_then(|system| MapProjection::of(system).ok());
    let target = own.as_ref().map_or_else(|| "'PROJ STRING OF THE TERRAIN'".to_owned(), |map| format!("'{}'", map.proj_string()));
    let source = match own.map(|map| map.definition().ellipsoid) {
        Some(figure) if degrees && !figure.may_be_of(None, Ellipsoid::WGS84.semi_major_m) => {
            format!("-s_srs '+proj=longlat {} +no_defs' ", figure.proj())
        }
        _ => String::new(),
    };
    format!("bring the zones onto the terrain's map with: ogr2ogr {source}-t_srs {target} out.geojson in.geojson")
}

/// How to drop a reference system that is not that of the coordinates.
const MEND_LABEL: &str = "if the coordinates are the terrain's, remove the member `crs`";

/// What a comparison of two reference systems gave.
pub(super) enum SameMap {
    /// They are the same, or one of the two says nothing.
    Agreed,
    /// They cannot be compared: the reason, for a warning.
    NotCompared(String),
}

/// Compares the `crs` member of a `GeoJSON` (2008) with the terrain's map. A file without one is on the terrain's map.
///
/// # Errors
/// A sentence if it states degrees, another map, or a system that is not understood.
pub(super) fn of_geojson(crs: &Value, terrain: Option<&CoordinateSystem>) -> Result<SameMap, String> {
    let name = name_of(crs, terrain)?;
    let code = code_of(&name);
    let mend = || mend_zones(terrain, false);
    let stated = code.clone().unwrap_or_else(|| name.clone());
    let own = terrain.map_or(Err(NoProjection::Local), MapProjection::of);
    if code.as_deref().is_some_and(is_in_degrees) {
        let figure = code.as_deref().and_then(iau_sphere);
        if let (Some(figure), Ok(own)) = (figure, &own)
            && of_other_body(figure, own)
        {
            return Err(format!(
                "its crs is {stated}, in degrees of another body than the terrain's, {}, expected the terrain's map in metres; draw the zones \
                 on it",
                shown(own)
            ));
        }
        let of_earth = code.as_deref().is_some_and(|code| code.starts_with("OGC:") || code.starts_with("EPSG:"));
        return Err(format!(
            "its crs is {stated}, in degrees, expected the terrain's map in metres; {}",
            mend_zones(terrain, of_earth)
        ));
    }
    let own_code = terrain.and_then(projected_code).map(|code| format!("EPSG:{code}"));
    // The same code of a map that is not supported is still the same.
    if code.is_some() && code == own_code {
        return Ok(SameMap::Agreed);
    }
    let theirs = code.as_deref().unwrap_or(&name).parse::<MapProjection>();
    match (theirs, own) {
        (Ok(theirs), Ok(own)) if own.is_same_map(&theirs) => Ok(SameMap::Agreed),
        (Ok(theirs), Ok(own)) if of_other_body(theirs.definition().ellipsoid, &own) => Err(format!(
            "its crs is {stated}, of another body than the terrain's, {}, expected the terrain's map; draw the zones on it, or {MEND_LABEL}",
            shown(&own)
        )),
        (Ok(_), Ok(own)) => Err(format!("its crs is {stated}, expected that of the terrain, {}; {}", shown(&own), mend())),
        (theirs, Err(NoProjection::Local)) => {
            let known = if theirs.is_ok() { "" } else { " (which is not known here)" };
            Ok(SameMap::NotCompared(format!(
                "the crs is {stated}{known}, and the terrain states none: that both are the same map was not checked"
            )))
        }
        (_, Err(unknown)) => match own_code {
            Some(own) if code.is_some() => {
                Err(format!("its crs is {stated}, expected that of the terrain, {own}; {}, or {MEND_LABEL}", mend()))
            }
            _ => {
                Ok(SameMap::NotCompared(format!("the crs is {stated}, and {unknown}: that both are the same map was not checked")))
            }
        },
        (Err(_), Ok(own)) => Err(format!(
            "its crs is {stated}, which is not known here, expected that of the terrain, {}; {}, or {MEND_LABEL}",
            shown(&own),
            mend()
        )),
    }
}

/// Whether a figure is of another body than a map: GDAL converts nothing between two bodies.
fn of_other_body(figure: Ellipsoid, own: &MapProjection) -> bool {
    !figure.may_be_of(None, own.definition().ellipsoid.semi_major_m)
}

/// A map by its code, or by its proj string.
fn shown(map: &MapProjection) -> String {
    map.code().map_or_else(|| format!("'{}'", map.proj_string()), str::to_owned)
}

/// The name in a `crs` member: a name or a code, a link, or the old form with an authority and a code.
fn name_of(crs: &Value, terrain: Option<&CoordinateSystem>) -> Result<String, String> {
    let text = |value: &Value| match value {
        Value::String(text) => Some(text.trim().to_owned()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    if let Some(name) = text(crs) {
        return Ok(name);
    }
    let of = |pointer: &str| crs.pointer(pointer).and_then(text).filter(|name| !name.is_empty());
    let kind = crs.get("type").and_then(Value::as_str).unwrap_or_default();
    let old = || kind.eq_ignore_ascii_case("epsg").then(|| of("/properties/code")).flatten().map(|code| format!("EPSG:{code}"));
    of("/properties/name").or_else(old).or_else(|| of("/properties/href")).ok_or_else(|| {
        format!(
            "its crs has neither a name nor a code, expected that of the terrain's map; {MEND_LABEL}, or {}",
            mend_zones(terrain, false)
        )
    })
}

/// Authority and code of a name, `EPSG:32633` or `IAU_2015:30135`: plain, as a uniform resource name or as an address.
fn code_of(name: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    let parts: Vec<&str> = upper.trim_end_matches('/').split([':', '/', '#']).filter(|part| !part.is_empty()).collect();
    let code = *parts.last()?;
    let authority = parts.iter().rev().skip(1).find(|part| part.starts_with(|letter: char| letter.is_ascii_alphabetic()))?;
    match *authority {
        "EPSG.XML" | "EPSG" => code.parse::<u32>().ok().map(|code| format!("EPSG:{code}")),
        // `urn:ogc:def:crs:IAU:2015:30135` and `IAU_2015:30135`.
        "IAU" | "IAU_2015" | "IAU2000" | "IAU_2000" => Some(format!("IAU_2015:{code}")),
        "ESRI" => Some(format!("ESRI:{code}")),
        "OGC" | "CRS" => Some(format!("OGC:{code}")),
        _ => None,
    }
}

/// Whether a code is one of longitude and latitude.
fn is_in_degrees(code: &str) -> bool {
    match code.split_once(':') {
        Some(("OGC", code)) => code.starts_with("CRS") || matches!(code, "84" | "83" | "27"),
        Some(("EPSG", code)) => code.parse().is_ok_and(is_geodetic),
        // Of every body: 00 spherical, 01 planetographic, 02 planetocentric.
        Some(("IAU_2015", code)) => code.parse::<u64>().is_ok_and(|code| code % 100 <= 2),
        Some(("ESRI", code)) => {
            code.parse::<u32>().is_ok_and(|code| (37_000..38_000).contains(&code) || (104_000..105_000).contains(&code))
        }
        _ => false,
    }
}

/// The command that brings a raster onto the terrain's map.
pub(super) fn mend_raster(terrain: Option<&CoordinateSystem>) -> String {
    let own = terrain.and_then(|system| MapProjection::of(system).ok());
    let target = own.map_or_else(|| "'PROJ STRING OF THE TERRAIN'".to_owned(), |map| format!("'{}'", map.proj_string()));
    format!("warp it with: gdalwarp -r near -ot Float32 -dstnodata nan -t_srs {target} in.tif out.tif")
}

/// The sphere of a body that a code of the IAU is of, if it is known here.
fn iau_sphere(code: &str) -> Option<Ellipsoid> {
    let number: u32 = code.strip_prefix("IAU_2015:")?.parse().ok()?;
    iau_radius_m(number / 100).map(Ellipsoid::sphere)
}

/// Compares the map of a raster with the terrain's; a raster that states none is on the terrain's map.
///
/// # Errors
/// The difference, as a phrase.
pub(super) fn of_raster(raster: &CoordinateSystem, terrain: Option<&CoordinateSystem>) -> Result<SameMap, String> {
    let Some(terrain) = terrain else { return Ok(SameMap::Agreed) };
    let differ = disagreement(raster, terrain);
    match (MapProjection::of(raster), MapProjection::of(terrain)) {
        (Ok(theirs), Ok(own)) if own.is_same_map(&theirs) => Ok(SameMap::Agreed),
        (Ok(theirs), Ok(own)) => {
            let keys = differ.map_or_else(String::new, |differ| format!("; {differ}"));
            Err(format!("it is on {} and the terrain on {}{keys}", shown(&theirs), shown(&own)))
        }
        (Err(NoProjection::Local), _) => Ok(SameMap::Agreed),
        (theirs, own) => match differ {
            Some(differ) if states_a_map(terrain) => Err(differ),
            None if projected_code(raster).is_some() && projected_code(raster) == projected_code(terrain) => Ok(SameMap::Agreed),
            _ => {
                let why = own.err().or(theirs.err()).map_or_else(String::new, |reason| reason.to_string());
                Ok(SameMap::NotCompared(format!("{why}: that both are the same map was not checked")))
            }
        },
    }
}
