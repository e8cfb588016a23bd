//! Converts `GeoKeys` (OGC GeoTIFF 1.1) to a projection and back.

use super::definition::{Definition, Ellipsoid, Method};
use super::{MapProjection, codes, epsg_units, stated};
use crate::terrain::CoordinateSystem;
use crate::terrain::geotiff::{double_key, short_key};

/// Numbers of keys.
mod key {
    pub(super) const MODEL_TYPE: u16 = 1024;
    pub(super) const CITATION: u16 = 1026;
    pub(super) const GEOGRAPHIC_CRS: u16 = 2048;
    pub(super) const DATUM: u16 = 2050;
    pub(super) const PRIME_MERIDIAN_CODE: u16 = 2051;
    pub(super) const RADIUS_UNITS: u16 = 2052;
    pub(super) const RADIUS_UNIT_SIZE: u16 = 2053;
    pub(super) const ANGULAR_UNITS: u16 = 2054;
    pub(super) const ANGULAR_UNIT_SIZE: u16 = 2055;
    pub(super) const ELLIPSOID: u16 = 2056;
    pub(super) const SEMI_MAJOR: u16 = 2057;
    pub(super) const SEMI_MINOR: u16 = 2058;
    pub(super) const INVERSE_FLATTENING: u16 = 2059;
    pub(super) const PRIME_MERIDIAN: u16 = 2061;
    pub(super) const PROJECTED_CRS: u16 = 3072;
    pub(super) const PROJECTED_CITATION: u16 = 3073;
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
    /// "Degree (supplier to define representation)".
    pub(super) const DEGREE_IN_ANY_FORM: u16 = 9122;
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

/// Whether the keys state a projected map. Files without a model type, or with one of their own, may do so by other keys.
pub(super) fn states_a_map(system: &CoordinateSystem) -> bool {
    const PROJECTED: u16 = 1;
    const UNDEFINED: u16 = 0;
    let by_other_keys = || {
        let coded = short_key(system, key::PROJECTED_CRS).is_some_and(|code| code != UNDEFINED && code != key::USER_DEFINED);
        let by_text = stated::pe_string(system).is_some_and(|text| text.starts_with("PROJ"));
        coded || by_text || short_key(system, key::METHOD).is_some()
    };
    match short_key(system, key::MODEL_TYPE) {
        Some(PROJECTED) => true,
        None | Some(UNDEFINED | key::USER_DEFINED) => by_other_keys(),
        Some(_) => false,
    }
}

/// The code of the map, unless it is user-defined.
pub(super) fn projected_code(system: &CoordinateSystem) -> Option<u16> {
    short_key(system, key::PROJECTED_CRS).filter(|code| *code != key::USER_DEFINED && *code != 0)
}

/// Reads the keys.
pub(super) fn read(system: &CoordinateSystem) -> Reading {
    if !states_a_map(system) {
        return Reading::Local;
    }
    if let Some((code, definition)) = by_code(system) {
        return Reading::Known { definition, epsg: Some(code) };
    }
    if let Some(code) = projected_code(system) {
        return Reading::Unknown(format!("its EPSG code {code} is not supported"));
    }
    if let Some(text) = stated::pe_string(system) {
        return match MapProjection::from_wkt(text) {
            Ok(map) => Reading::Known { definition: *map.definition(), epsg: map.code().and_then(codes::epsg_number) },
            Err(reason) => Reading::Unknown(format!("its text after 'ESRI PE String =': {reason}")),
        };
    }
    if short_key(system, key::METHOD).is_none() && short_key(system, key::PROJECTION).is_none() {
        return match short_key(system, key::PROJECTED_CRS) {
            None => Reading::Local,
            Some(_) => Reading::Unknown("its keys say that it is user-defined, and name no method (3075)".to_owned()),
        };
    }
    match user_defined(system) {
        Ok((definition, epsg)) => match definition.fault() {
            None => Reading::Known { definition, epsg },
            Some(fault) => Reading::Unknown(format!("its keys give {fault}")),
        },
        Err(reason) => Reading::Unknown(reason),
    }
}

/// The map of the code, if it is known.
pub(super) fn by_code(system: &CoordinateSystem) -> Option<(u16, Definition)> {
    let code = projected_code(system)?;
    Some((code, codes::epsg(code)?))
}

/// The map of the method and its numbers, if they are given and known.
pub(super) fn by_numbers(system: &CoordinateSystem) -> Option<Definition> {
    short_key(system, key::METHOD)?;
    let figure = ellipsoid(system).ok().or_else(|| Some(by_code(system)?.1.ellipsoid))?;
    by_method(system, figure).ok()
}

/// The UTM zone of key 3074, if there is one.
pub(super) fn utm_by_key(system: &CoordinateSystem) -> Option<Definition> {
    let figure = ellipsoid(system).ok().or_else(|| Some(by_code(system)?.1.ellipsoid))?;
    Some(utm_of(short_key(system, key::PROJECTION)?, figure)?.0)
}

/// The ellipsoid of the keys, projected or not.
pub(super) fn ellipsoid(system: &CoordinateSystem) -> Result<Ellipsoid, String> {
    if let Some(semi_major_m) = double_key(system, key::SEMI_MAJOR) {
        let size_m = match short_key(system, key::RADIUS_UNITS) {
            None | Some(0 | key::METRE) => 1.0,
            Some(key::USER_DEFINED) => double_key(system, key::RADIUS_UNIT_SIZE)
                .ok_or("its radii (2057) are in a user-defined unit without a size (2053)")?,
            Some(unit) => epsg_units::length_unit(unit)
                .1
                .ok_or_else(|| format!("its radii (2057) are in the unit EPSG:{unit} (key 2052), which is not known here"))?,
        };
        let semi_major_m = semi_major_m * size_m;
        let semi_minor_m = double_key(system, key::SEMI_MINOR).map(|length| length * size_m);
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
    let ellipsoid = ellipsoid(system)?;
    if let Some(utm) = short_key(system, key::PROJECTION).and_then(|code| utm_of(code, ellipsoid)) {
        let meridian_deg = prime_meridian_deg(system)?;
        if meridian_deg != 0.0 {
            return Err(format!(
                "its UTM zone (key 3074) counts from Greenwich, and its prime meridian is at {meridian_deg:.6} degrees"
            ));
        }
        return Ok(utm);
    }
    Ok((by_method(system, ellipsoid)?, None))
}

/// The UTM zone of a code of key 3074.
fn utm_of(code: u16, ellipsoid: Ellipsoid) -> Option<(Definition, Option<u16>)> {
    match code {
        16_001..=16_060 => Some(utm_zone(code - 16_000, false, ellipsoid)),
        16_101..=16_160 => Some(utm_zone(code - 16_100, true, ellipsoid)),
        _ => None,
    }
}

/// How far east of the reference meridian longitudes are counted from, degrees: by its longitude, its code, or the code of the geographic
/// map or of the datum, which must agree where several are given.
fn prime_meridian_deg(system: &CoordinateSystem) -> Result<f64, String> {
    /// Degrees by which two statements of one meridian may differ: the rounding of seconds to hundredths.
    const TOLERANCE_DEG: f64 = 1.0e-5;
    let mut stated = Vec::new();
    if let Some(longitude_deg) = double_key(system, key::PRIME_MERIDIAN) {
        stated.push(("key 2061".to_owned(), longitude_deg));
    }
    match short_key(system, key::PRIME_MERIDIAN_CODE) {
        None | Some(0 | key::USER_DEFINED) => {}
        Some(code) => match codes::meridian_deg(code) {
            Some(longitude_deg) => stated.push((format!("key 2051 = {code}"), longitude_deg)),
            None if stated.is_empty() => {
                return Err(format!("its prime meridian (key 2051) is number {code}, whose longitude is not known here"));
            }
            None => {}
        },
    }
    for wanted in [key::GEOGRAPHIC_CRS, key::DATUM] {
        let Some(code) = short_key(system, wanted) else { continue };
        let Some(longitude_deg) = codes::base_meridian_deg(code) else { continue };
        stated.push((format!("key {wanted} = {code}"), longitude_deg));
        if codes::counts_in_grads(code) && short_key(system, key::ANGULAR_UNITS).is_none() {
            return Err(format!("its geographic code or datum {code} (key {wanted}) counts angles in grads, not in degrees"));
        }
    }
    let Some((first, longitude_deg)) = stated.first().cloned() else { return Ok(0.0) };
    match stated.iter().find(|(_, other_deg)| (other_deg - longitude_deg).abs() > TOLERANCE_DEG) {
        None => Ok(longitude_deg),
        Some((other, other_deg)) => Err(format!(
            "its keys state two prime meridians, {longitude_deg:.6} degrees ({first}) and {other_deg:.6} degrees ({other})"
        )),
    }
}

/// Refuses angles in another unit than the degree.
fn check_angles(system: &CoordinateSystem) -> Result<(), String> {
    match (short_key(system, key::ANGULAR_UNITS), double_key(system, key::ANGULAR_UNIT_SIZE)) {
        (None | Some(0 | key::DEGREE | key::DEGREE_IN_ANY_FORM), _) => Ok(()),
        (Some(key::USER_DEFINED), Some(size)) if (size.to_degrees() - 1.0).abs() < 1.0e-8 => Ok(()),
        (Some(unit), _) => Err(format!("its angles are in the unit EPSG:{unit}, not in degrees")),
    }
}

/// A projection from its method and numbers.
fn by_method(system: &CoordinateSystem, ellipsoid: Ellipsoid) -> Result<Definition, String> {
    check_angles(system)?;
    let number = short_key(system, key::METHOD).ok_or("its keys name no method (3075)")?;
    if number == key::USER_DEFINED {
        let name = system.description.as_deref().unwrap_or("without a name");
        return Err(format!("its projection method (key 3075) is user-defined: '{name}'"));
    }
    let method =
        method(number).ok_or_else(|| format!("its projection method (key 3075) is number {number}{}", method_name(number)))?;
    let only = |keys: &[u16], what: &str| one_of(system, keys, what);
    let latitudes = [key::ORIGIN_LATITUDE, key::FALSE_ORIGIN_LATITUDE, key::CENTER_LATITUDE];
    let longitudes = [key::ORIGIN_LONGITUDE, key::FALSE_ORIGIN_LONGITUDE, key::CENTER_LONGITUDE, key::POLE_LONGITUDE];
    let meridian_deg = prime_meridian_deg(system)?;
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
    Ok(definition)
}

/// The names of methods that are not supported (OGC GeoTIFF 1.1, annex C; GDAL).
fn method_name(number: u16) -> &'static str {
    match number {
        2 => ", transverse Mercator of the oblique Alaska grid",
        3 => ", oblique Mercator",
        4 => ", oblique Mercator (Laborde)",
        5 => ", oblique Mercator (Rosenmund)",
        6 => ", oblique Mercator (spherical)",
        13 => ", equidistant conic",
        18 => ", Cassini-Soldner",
        19 => ", gnomonic",
        20 => ", Miller cylindrical",
        22 => ", polyconic",
        23 => ", Robinson",
        25 => ", Van der Grinten",
        26 => ", New Zealand map grid",
        27 => ", transverse Mercator to the south",
        28 => ", cylindrical equal-area",
        9815 => ", oblique Mercator (azimuth at the centre)",
        _ => "",
    }
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
pub(super) const fn method_number(method: Method) -> u16 {
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
        | Method::AlbersEqualArea => [key::ORIGIN_LATITUDE, key::ORIGIN_LONGITUDE, key::EASTING, key::NORTHING],
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

/// The same keys with another citation, which GDAL shows as the name of the map.
pub(super) fn with_citation(system: &CoordinateSystem, name: &str) -> CoordinateSystem {
    const TEXTS: u16 = 34737;
    let name = plain_text(name);
    let number = |count: usize| u16::try_from(count).ok();
    let entries = || {
        let header = system.key_directory.get(..3)?;
        let mut entries: Vec<[u16; 4]> =
            system.key_directory.get(4..)?.chunks_exact(4).filter_map(|entry| entry.try_into().ok()).collect();
        entries.retain(|entry| entry[0] != key::CITATION && entry[0] != key::PROJECTED_CITATION);
        entries.push([key::CITATION, TEXTS, number(name.len() + 1)?, number(system.ascii_parameters.len())?]);
        entries.sort_by_key(|entry| entry[0]);
        let count = number(entries.len())?;
        Some(header.iter().copied().chain([count]).chain(entries.into_iter().flatten()).collect())
    };
    match entries() {
        Some(key_directory) => CoordinateSystem {
            key_directory,
            double_parameters: system.double_parameters.clone(),
            ascii_parameters: format!("{}{name}|", system.ascii_parameters),
            description: Some(name),
        },
        None => system.clone(),
    }
}

/// A text as it may stand among the keys, where a `|` ends it.
fn plain_text(name: &str) -> String {
    name.replace(|letter: char| !letter.is_ascii() || letter.is_ascii_control() || letter == '|', "_")
}

/// The directory of a projected map in metres with all entries in the order of their numbers.
fn directory(stated: &[(u16, u16)], doubles: &[(u16, f64)], name: &str) -> CoordinateSystem {
    const DOUBLES: u16 = 34736;
    const TEXTS: u16 = 34737;
    let name = plain_text(name);
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
