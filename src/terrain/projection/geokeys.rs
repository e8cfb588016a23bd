//! Converts `GeoKeys` (OGC GeoTIFF 1.1) to a projection and back.

use super::codes;
use super::definition::{Definition, Ellipsoid, Method};
use crate::terrain::CoordinateSystem;
use crate::terrain::geotiff::{double_key, short_key};

/// Numbers of keys.
mod key {
    pub(super) const MODEL_TYPE: u16 = 1024;
    pub(super) const CITATION: u16 = 1026;
    pub(super) const GEOGRAPHIC_CRS: u16 = 2048;
    pub(super) const DATUM: u16 = 2050;
    pub(super) const ANGULAR_UNITS: u16 = 2054;
    pub(super) const ELLIPSOID: u16 = 2056;
    pub(super) const SEMI_MAJOR: u16 = 2057;
    pub(super) const SEMI_MINOR: u16 = 2058;
    pub(super) const INVERSE_FLATTENING: u16 = 2059;
    pub(super) const PRIME_MERIDIAN: u16 = 2061;
    pub(super) const PROJECTED_CRS: u16 = 3072;
    pub(super) const PROJECTION: u16 = 3074;
    pub(super) const METHOD: u16 = 3075;
    pub(super) const LINEAR_UNITS: u16 = 3076;
    pub(super) const PARALLEL_1: u16 = 3078;
    pub(super) const PARALLEL_2: u16 = 3079;
    pub(super) const ORIGIN_LONGITUDE: u16 = 3080;
    pub(super) const ORIGIN_LATITUDE: u16 = 3081;
    pub(super) const EASTING: u16 = 3082;
    pub(super) const NORTHING: u16 = 3083;
    pub(super) const FALSE_ORIGIN_LONGITUDE: u16 = 3084;
    pub(super) const FALSE_ORIGIN_LATITUDE: u16 = 3085;
    pub(super) const FALSE_ORIGIN_EASTING: u16 = 3086;
    pub(super) const FALSE_ORIGIN_NORTHING: u16 = 3087;
    pub(super) const CENTER_LONGITUDE: u16 = 3088;
    pub(super) const CENTER_LATITUDE: u16 = 3089;
    pub(super) const CENTER_EASTING: u16 = 3090;
    pub(super) const CENTER_NORTHING: u16 = 3091;
    pub(super) const ORIGIN_SCALE: u16 = 3092;
    pub(super) const CENTER_SCALE: u16 = 3093;
    pub(super) const POLE_LONGITUDE: u16 = 3095;

    pub(super) const USER_DEFINED: u16 = 32767;
    pub(super) const DEGREE: u16 = 9102;
    pub(super) const METRE: u16 = 9001;
}

/// The projection of the keys, or why it cannot be used.
#[derive(Debug)]
pub(super) enum Reading {
    /// There is no projected map.
    Local,
    /// A projection.
    Known {
        /// Its parameters.
        definition: Definition,
        /// The EPSG code, if the keys give one.
        epsg: Option<u16>,
    },
    /// An unsupported projection, and the reason.
    Unknown(String),
}

/// Reads the keys.
pub(super) fn read(system: &CoordinateSystem) -> Reading {
    const PROJECTED: u16 = 1;
    if short_key(system, key::MODEL_TYPE) != Some(PROJECTED) {
        return Reading::Local;
    }
    let code = short_key(system, key::PROJECTED_CRS).filter(|code| *code != key::USER_DEFINED);
    if let Some(code) = code {
        return match codes::epsg(code) {
            Some(definition) => Reading::Known { definition, epsg: Some(code) },
            None => Reading::Unknown(format!("its EPSG code {code} is not supported")),
        };
    }
    if short_key(system, key::METHOD).is_none() && short_key(system, key::PROJECTION).is_none() {
        return Reading::Local;
    }
    match user_defined(system) {
        Ok((definition, epsg)) => match definition.fault() {
            None => Reading::Known { definition, epsg },
            Some(fault) => Reading::Unknown(format!("its keys give {fault}")),
        },
        Err(reason) => Reading::Unknown(reason),
    }
}

/// The ellipsoid of the keys, projected or not.
pub(super) fn ellipsoid(system: &CoordinateSystem) -> Result<Ellipsoid, String> {
    if let Some(semi_major_m) = double_key(system, key::SEMI_MAJOR) {
        let semi_minor_m = double_key(system, key::SEMI_MINOR);
        let inverse_flattening = double_key(system, key::INVERSE_FLATTENING);
        return match (semi_minor_m, inverse_flattening) {
            (Some(semi_minor_m), _) => Ok(Ellipsoid { semi_major_m, semi_minor_m }),
            (None, Some(inverse)) => Ok(Ellipsoid::with_inverse_flattening(semi_major_m, inverse)),
            (None, None) => Err("its keys give the semi-major axis alone (2057 without 2058 or 2059)".to_owned()),
        };
    }
    [key::ELLIPSOID, key::DATUM, key::GEOGRAPHIC_CRS]
        .into_iter()
        .find_map(|wanted| codes::ellipsoid(short_key(system, wanted)?))
        .ok_or_else(|| "its keys give no radius of the body (2057) and no known ellipsoid (2056)".to_owned())
}

/// A projection with explicit parameters, with its EPSG code if it is a UTM zone of WGS 84.
fn user_defined(system: &CoordinateSystem) -> Result<(Definition, Option<u16>), String> {
    match short_key(system, key::ANGULAR_UNITS) {
        None | Some(key::DEGREE) => {}
        Some(unit) => return Err(format!("its angles are in the unit EPSG:{unit}, not in degrees")),
    }
    let ellipsoid = ellipsoid(system)?;
    match short_key(system, key::PROJECTION) {
        Some(zone @ 16_001..=16_060) => return Ok(utm_zone(zone - 16_000, false, ellipsoid)),
        Some(zone @ 16_101..=16_160) => return Ok(utm_zone(zone - 16_100, true, ellipsoid)),
        _ => {}
    }
    let number = short_key(system, key::METHOD).ok_or("its keys name no method (3075)")?;
    let method = method(number).ok_or_else(|| format!("its projection method (key 3075) is number {number}"))?;
    let only = |keys: &[u16], what: &str| one_of(system, keys, what);
    let latitudes = [key::ORIGIN_LATITUDE, key::FALSE_ORIGIN_LATITUDE, key::CENTER_LATITUDE];
    let longitudes = [key::ORIGIN_LONGITUDE, key::FALSE_ORIGIN_LONGITUDE, key::CENTER_LONGITUDE, key::POLE_LONGITUDE];
    let meridian_deg = double_key(system, key::PRIME_MERIDIAN).unwrap_or(0.0);
    let longitude_deg = only(&longitudes, "longitudes of the origin")?.unwrap_or(0.0) + meridian_deg;
    let latitude_deg = only(&latitudes, "latitudes of the origin")?.unwrap_or(0.0);
    let eastings = [key::EASTING, key::FALSE_ORIGIN_EASTING, key::CENTER_EASTING];
    let northings = [key::NORTHING, key::FALSE_ORIGIN_NORTHING, key::CENTER_NORTHING];
    let mut definition = Definition {
        false_easting_m: only(&eastings, "false eastings")?.unwrap_or(0.0),
        false_northing_m: only(&northings, "false northings")?.unwrap_or(0.0),
        ..Definition::about(method, latitude_deg, longitude_deg, ellipsoid)
    };
    if method.has_scale() {
        definition.scale = only(&[key::ORIGIN_SCALE, key::CENTER_SCALE], "scales")?.unwrap_or(1.0);
    }
    resolve_definition(&mut definition, system)?;
    Ok((definition, None))
}

/// Fills in what depends on the method: standard parallels, and the form in which a pole is given.
fn resolve_definition(definition: &mut Definition, system: &CoordinateSystem) -> Result<(), String> {
    let parallel_1_deg = double_key(system, key::PARALLEL_1);
    match definition.method {
        Method::Equirectangular => definition.parallels_deg[0] = Some(parallel_1_deg.unwrap_or(0.0)),
        Method::Mercator => {
            if definition.latitude_deg != 0.0 {
                return Err(format!("its keys put the origin of a Mercator map at latitude {}", definition.latitude_deg));
            }
            definition.parallels_deg[0] = parallel_1_deg;
        }
        Method::LambertConformalTwoParallels | Method::AlbersEqualArea => {
            let parallels_deg = [parallel_1_deg, double_key(system, key::PARALLEL_2)];
            if parallels_deg.contains(&None) {
                return Err("its keys lack one of the two standard parallels (3078, 3079)".to_owned());
            }
            definition.parallels_deg = parallels_deg;
        }
        // The latitude of a polar map is that of true scale; the pole is the one in its hemisphere.
        Method::PolarStereographic => {
            let true_scale_deg = definition.latitude_deg;
            if true_scale_deg == 0.0 {
                return Err("its keys name no pole (3081)".to_owned());
            }
            definition.latitude_deg = 90.0_f64.copysign(true_scale_deg);
            definition.parallels_deg[0] = (true_scale_deg.abs() != 90.0).then_some(true_scale_deg);
        }
        Method::ObliqueStereographic if definition.latitude_deg.abs() == 90.0 => definition.method = Method::PolarStereographic,
        _ => {}
    }
    Ok(())
}

/// The number that some of these keys give; all given values must agree.
fn one_of(system: &CoordinateSystem, keys: &[u16], what: &str) -> Result<Option<f64>, String> {
    let given: Vec<f64> = keys.iter().filter_map(|wanted| double_key(system, *wanted)).collect();
    match given.as_slice() {
        [first, rest @ ..] if rest.iter().any(|other| other != first) => Err(format!("its keys give several {what}: {given:?}")),
        numbers => Ok(numbers.first().copied()),
    }
}

fn utm_zone(zone: u16, south: bool, ellipsoid: Ellipsoid) -> (Definition, Option<u16>) {
    let epsg = (ellipsoid == Ellipsoid::WGS84).then_some(zone + if south { 32_700 } else { 32_600 });
    (codes::utm(zone, south, ellipsoid), epsg)
}

/// The method with this number in key 3075.
fn method(number: u16) -> Option<Method> {
    Method::ALL.into_iter().find(|method| method_number(*method) == number && number != key::USER_DEFINED)
}

/// The number of a method in key 3075.
const fn method_number(method: Method) -> u16 {
    match method {
        Method::TransverseMercator => 1,
        Method::Mercator => 7,
        Method::LambertConformalTwoParallels => 8,
        Method::LambertConformalOneParallel => 9,
        Method::LambertAzimuthalEqualArea => 10,
        Method::AlbersEqualArea => 11,
        Method::AzimuthalEquidistant => 12,
        Method::ObliqueStereographic => 14,
        Method::PolarStereographic => 15,
        Method::DoubleStereographic => 16,
        Method::Equirectangular => 17,
        Method::Orthographic => 21,
        Method::Sinusoidal => 24,
        // No number means it: EPSG:3857 is written by its code.
        Method::PseudoMercator => key::USER_DEFINED,
    }
}

/// The keys for latitude, longitude, easting and northing of the origin of a method, as written by GDAL.
const fn origin_keys(method: Method) -> [u16; 4] {
    match method {
        Method::TransverseMercator
        | Method::Mercator
        | Method::LambertConformalOneParallel
        | Method::DoubleStereographic
        | Method::AlbersEqualArea => {
            [key::ORIGIN_LATITUDE, key::ORIGIN_LONGITUDE, key::EASTING, key::NORTHING]
        }
        Method::PolarStereographic => [key::ORIGIN_LATITUDE, key::POLE_LONGITUDE, key::EASTING, key::NORTHING],
        Method::LambertConformalTwoParallels => {
            [key::FALSE_ORIGIN_LATITUDE, key::FALSE_ORIGIN_LONGITUDE, key::FALSE_ORIGIN_EASTING, key::FALSE_ORIGIN_NORTHING]
        }
        _ => [key::CENTER_LATITUDE, key::CENTER_LONGITUDE, key::EASTING, key::NORTHING],
    }
}

/// Writes a projection as keys, in metres and degrees.
pub(super) fn write(definition: &Definition, name: &str) -> CoordinateSystem {
    let [latitude, longitude, easting, northing] = origin_keys(definition.method);
    let latitude_deg = match (definition.method, definition.parallels_deg[0]) {
        (Method::PolarStereographic, Some(true_scale_deg)) => true_scale_deg,
        _ => definition.latitude_deg,
    };
    let mut doubles = vec![
        (key::SEMI_MAJOR, definition.ellipsoid.semi_major_m),
        (key::SEMI_MINOR, definition.ellipsoid.semi_minor_m),
        (longitude, definition.longitude_deg),
        (easting, definition.false_easting_m),
        (northing, definition.false_northing_m),
    ];
    if definition.method != Method::Sinusoidal {
        doubles.push((latitude, latitude_deg));
    }
    let on_parallel = definition.method != Method::PolarStereographic && definition.parallels_deg[0].is_some();
    if definition.method.has_scale() && !on_parallel {
        doubles.push((key::ORIGIN_SCALE, definition.scale));
    }
    if on_parallel {
        let parallels = [key::PARALLEL_1, key::PARALLEL_2].into_iter().zip(definition.parallels_deg);
        doubles.extend(parallels.filter_map(|(wanted, degrees)| Some((wanted, degrees?))));
    }
    let stated = [
        (key::GEOGRAPHIC_CRS, key::USER_DEFINED),
        (key::DATUM, key::USER_DEFINED),
        (key::ANGULAR_UNITS, key::DEGREE),
        (key::ELLIPSOID, key::USER_DEFINED),
        (key::PROJECTED_CRS, key::USER_DEFINED),
        (key::PROJECTION, key::USER_DEFINED),
        (key::METHOD, method_number(definition.method)),
    ];
    directory(&stated, &doubles, name)
}

/// Writes the EPSG code of a projection as keys, in metres.
pub(super) fn write_epsg(code: u16, name: &str) -> CoordinateSystem {
    directory(&[(key::PROJECTED_CRS, code)], &[], name)
}

/// The directory of a projected map in metres with all entries in the order of their numbers.
fn directory(stated: &[(u16, u16)], doubles: &[(u16, f64)], name: &str) -> CoordinateSystem {
    const DOUBLES: u16 = 34736;
    const TEXTS: u16 = 34737;
    // A `|` ends a text among the keys.
    let name = name.replace(|letter: char| !letter.is_ascii() || letter.is_ascii_control() || letter == '|', "_");
    let text_length = u16::try_from(name.len() + 1).unwrap_or(u16::MAX);
    let mut entries =
        vec![[key::MODEL_TYPE, 0, 1, 1], [key::CITATION, TEXTS, text_length, 0], [key::LINEAR_UNITS, 0, 1, key::METRE]];
    entries.extend(stated.iter().map(|(wanted, value)| [*wanted, 0, 1, *value]));
    entries.extend(doubles.iter().zip(0..).map(|((wanted, _), offset)| [*wanted, DOUBLES, 1, offset]));
    entries.sort_by_key(|entry| entry[0]);
    let mut key_directory = vec![1, 1, 0, u16::try_from(entries.len()).unwrap_or(u16::MAX)];
    key_directory.extend(entries.into_iter().flatten());
    CoordinateSystem {
        key_directory,
        double_parameters: doubles.iter().map(|(_, value)| *value).collect(),
        ascii_parameters: format!("{name}|"),
        description: Some(name),
    }
}
