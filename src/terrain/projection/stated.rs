//! What a file says of its map more than once: by code, by numbers, by citations. Two statements that cannot both be true are reported.

use super::definition::{Ellipsoid, RADIUS_TOLERANCE};
use super::{MapProjection, codes, epsg_units, geokeys, stated_ellipsoid};
use crate::terrain::CoordinateSystem;
use crate::terrain::geotiff::{double_key, short_key, text_key};
use crate::world::KNOWN_BODIES;

/// Radii of the Earth's ellipsoids, m: all geodetic codes of EPSG are of the Earth.
const EARTH: Ellipsoid = Ellipsoid::WGS84;

/// Keys with texts about the map: general, projected, geographic.
const CITATIONS: [u16; 3] = [1026, 3073, 2049];

/// The prefix of well-known text among the citations, as ESRI and GDAL write it where the keys cannot state a map.
const PE_STRING: &str = "ESRI PE String = ";

/// The well-known text among the citations.
pub(super) fn pe_string(system: &CoordinateSystem) -> Option<&str> {
    CITATIONS.into_iter().find_map(|key| text_key(system, key)?.split_once(PE_STRING)).map(|(_, text)| text.trim())
}

/// The citations, without well-known text.
fn citations(system: &CoordinateSystem) -> impl Iterator<Item = (u16, &str)> {
    let cited = CITATIONS.into_iter().filter_map(|key| Some((key, text_key(system, key)?)));
    cited.filter(|(_, text)| !text.contains(PE_STRING))
}

/// Two statements about the map that exclude one another, as a phrase; `None` if there are none.
pub(in crate::terrain) fn contradiction(system: &CoordinateSystem) -> Option<String> {
    radii_contradict(system).or_else(|| maps_contradict(system)).or_else(|| citation_contradicts(system))
}

/// A code of the Earth beside the radius of another body.
fn radii_contradict(system: &CoordinateSystem) -> Option<String> {
    let radius_m = double_key(system, 2057)?;
    if EARTH.is_within(radius_m, RADIUS_TOLERANCE) || radius_m.is_nan() || radius_m <= 0.0 {
        return None;
    }
    let coded = [3072, 2048, 2050, 2056].into_iter().find_map(|key| {
        let code = short_key(system, key)?;
        let of_earth = match key {
            3072 => codes::epsg(code).is_some() || epsg_units::is_map_in_metres(code),
            2048 => epsg_units::is_geodetic(code),
            2050 => (6001..=6999).contains(&code),
            _ => (7001..=7060).contains(&code),
        };
        of_earth.then_some((key, code))
    });
    let (key, code) = coded?;
    Some(format!(
        "the code {code} (key {key}), which is of the Earth ({} m), and a radius of {radius_m} m (key 2057)",
        EARTH.semi_major_m
    ))
}

/// A code, numbers and well-known text that state different maps.
fn maps_contradict(system: &CoordinateSystem) -> Option<String> {
    let statements = [
        geokeys::by_code(system).map(|(code, definition)| (format!("the code EPSG:{code} (key 3072)"), definition)),
        geokeys::utm_by_key(system).map(|definition| ("the UTM zone of key 3074".to_owned(), definition)),
        geokeys::by_numbers(system).map(|definition| ("the numbers of keys 3075 to 3095".to_owned(), definition)),
        pe_string(system)
            .and_then(|text| MapProjection::from_wkt(text).ok())
            .map(|map| ("the text after 'ESRI PE String ='".to_owned(), *map.definition())),
    ];
    let maps: Vec<(String, MapProjection)> = statements
        .into_iter()
        .flatten()
        .filter_map(|(statement, definition)| Some((statement, MapProjection::new(definition, None).ok()?)))
        .collect();
    let (first, second) = maps
        .iter()
        .enumerate()
        .flat_map(|(i, first)| maps[i + 1..].iter().map(move |second| (first, second)))
        .find(|(first, second)| !first.1.is_same_map(&second.1) && !first.1.definition.replaces(&second.1.definition))?;
    Some(format!("{}, which is '{}', and {}, which are '{}'", first.0, first.1.proj_string(), second.0, second.1.proj_string()))
}

/// A citation with the UTM zone or the EPSG code of another map than the file's.
fn citation_contradicts(system: &CoordinateSystem) -> Option<String> {
    let own = MapProjection::of(system).ok()?;
    citations(system).filter(|(key, _)| *key != 2049).find_map(|(key, text)| {
        let cited = cited_map(text)?;
        let is_own = |shift_m: f64| {
            let meant = super::Definition { false_easting_m: cited.definition.false_easting_m + shift_m, ..cited.definition };
            MapProjection::new(meant, None).map(|map| own.is_same_map(&map))
        };
        // Zones in Germany are numbered in their eastings, by both digits or the last one (x_0 = 32500000, x_0 = 3500000 in zone 33).
        let shifts_m = [0.0, f64::from(cited.zone) * 1.0e6, f64::from(cited.zone % 10) * 1.0e6];
        shifts_m
            .into_iter()
            .all(|shift_m| is_own(shift_m) == Ok(false))
            .then(|| format!("the citation '{text}' (key {key}), which means {}, and a map '{}'", cited.name, own.proj_string()))
    })
}

/// The map that a citation names.
struct CitedMap {
    name: String,
    definition: super::Definition,
    /// The number of the UTM zone; 0 where the map is named by a code, which fixes the eastings.
    zone: u16,
}

/// The map that a citation names by a code of EPSG, or by a UTM zone of a datum that is known here.
fn cited_map(text: &str) -> Option<CitedMap> {
    let by_code = text.split("EPSG:").skip(1).find_map(|rest| {
        let digits = rest.find(|letter: char| !letter.is_ascii_digit()).map_or(rest, |end| &rest[..end]);
        let code = digits.parse().ok()?;
        Some(CitedMap { name: format!("EPSG:{code}"), definition: codes::epsg(code)?, zone: 0 })
    });
    by_code.or_else(|| {
        let plain = text.replace(['_', '='], " ").to_ascii_lowercase();
        let (_, rest) = plain.split_once("utm")?;
        let rest = rest.trim_start_matches([' ', ',']).trim_start_matches("zone").trim_start_matches([' ', ':']);
        let digits = rest.find(|letter: char| !letter.is_ascii_digit()).map_or(rest, |end| &rest[..end]);
        let zone = digits.parse().ok().filter(|zone| (1..=60).contains(zone))?;
        let after = rest[digits.len()..].trim_start();
        let side = after.split(|letter: char| !letter.is_ascii_alphabetic()).next().unwrap_or_default();
        let south = match side {
            "n" | "north" | "northern" => false,
            "s" | "south" | "southern" => true,
            // Without a side, or with a band of latitude in its place, the hemisphere is not certain.
            _ => return None,
        };
        // NAD83, ETRS89 and WGS 84 have the same map, but for the thickness of a hair; other datums are not certain.
        let known = ["wgs 84", "wgs84", "wgs 1984", "nad83", "nad 83", "nad 1983", "etrs89", "etrs 1989"];
        let datum = known.iter().any(|name| plain.contains(name)) || plain.trim_start().starts_with("utm");
        datum.then(|| CitedMap {
            name: format!("UTM zone {zone}{}", if south { 'S' } else { 'N' }),
            definition: codes::utm(zone, south, Ellipsoid::WGS84),
            zone,
        })
    })
}

/// Statements that are likely to be wrong: citations that name another body than the radii are of.
pub(in crate::terrain) fn doubts(system: &CoordinateSystem) -> Vec<String> {
    let Some(figure) = stated_ellipsoid(system) else { return Vec::new() };
    let mut doubts: Vec<String> = citations(system)
        .filter_map(|(key, text)| {
            let body = KNOWN_BODIES.iter().find(|body| names(text, body.name))?;
            (!figure.may_be_of(Some(body.name), body.radius_m)).then(|| {
                format!(
                    "the map's citation '{text}' (key {key}) names {}, of {} m, but its radius is {} m: one of the two is likely to be wrong; \
                     lengths follow the map's coordinates",
                    body.name, body.radius_m, figure.semi_major_m
                )
            })
        })
        .collect();
    doubts.dedup();
    doubts
}

/// Whether a citation has a body's name, or a datum of the Earth, as a word.
fn names(text: &str, body: &str) -> bool {
    let lower = text.to_ascii_lowercase();
    let datum = ["wgs 84", "wgs84", "wgs 1984", "wgs_1984", "nad83", "etrs89", "grs 1980", "grs80"];
    lower.split(|letter: char| !letter.is_ascii_alphanumeric()).any(|word| word == body)
        || (body == "earth" && datum.iter().any(|name| lower.contains(name)))
}
