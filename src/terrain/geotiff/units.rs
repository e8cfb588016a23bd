//! What the `GeoKeys` say of the kind of map, of its units and of the unit of its elevations. What is stated and not known is refused:
//! it must not count as the default.

use super::key;
use super::keys::{double_key, short_key, text_key, unsuitable};
use crate::quantity::is_metre;
use crate::terrain::georeference::mend_degrees;
use crate::terrain::projection::{
    MapProjection, Vertical, contradiction, is_compound, is_geodetic, is_map_in_metres, length_unit, projected_code, states_a_map,
    states_degrees_in_text, unit_of_depths, vertical,
};
use crate::terrain::stored::{Scaling, convert_heights};
use crate::terrain::{CoordinateSystem, TerrainError};

/// A user-defined unit of another size is no metre.
const UNIT_ROUNDING: f64 = 1.0e-9;

/// Checks kind, units and statements about the map.
///
/// The elevations come first: the commands that mend a map drop what a file says of its elevations.
///
/// # Errors
/// [`TerrainError::Unsuitable`] or [`TerrainError::NotProjected`], with a command that makes a usable file.
pub(super) fn check(system: &CoordinateSystem, scaling: Scaling) -> Result<(), TerrainError> {
    check_kinds(system)?;
    check_elevations(system, scaling)?;
    check_kind_of_map(system)?;
    check_map_unit(system)?;
    match contradiction(system) {
        None => Ok(()),
        Some(found) => Err(unsuitable(
            format!("two statements about the map that exclude one another: {found}"),
            "one map",
            "gdal_translate -a_srs 'THE RIGHT CODE OR PROJ STRING' in.tif out.tif",
        )),
    }
}

/// Refuses numbers of the kind of map and of the kind of raster that have no meaning.
fn check_kinds(system: &CoordinateSystem) -> Result<(), TerrainError> {
    let model = short_key(system, key::MODEL_TYPE);
    if let Some(number) = model
        && !matches!(number, key::UNDEFINED | key::PROJECTED | key::GEOGRAPHIC | key::GEOCENTRIC | key::USER_DEFINED)
    {
        return Err(unsuitable(
            format!("a map of kind {number} (key 1024), which is not known here"),
            "1 (a projected map), or no such key for a local map in metres",
            "gdal_translate -a_srs 'PROJ STRING' in.tif out.tif",
        ));
    }
    match short_key(system, key::RASTER_TYPE) {
        None | Some(key::PIXEL_IS_AREA | key::PIXEL_IS_POINT) => Ok(()),
        Some(number) => Err(unsuitable(
            format!("posts of kind {number} (key 1025), so that they may lie half a post aside"),
            "1 (posts are areas) or 2 (posts are points)",
            "gdal_translate -mo AREA_OR_POINT=Area in.tif out.tif (or Point, if the tie point is the centre of a post)",
        )),
    }
}

/// Refuses longitudes and latitudes, and places in space.
fn check_kind_of_map(system: &CoordinateSystem) -> Result<(), TerrainError> {
    let not_projected = |found: &str| Err(TerrainError::NotProjected { found: found.to_owned(), mend: mend_degrees(system) });
    let in_degrees = "a map in degrees of longitude and latitude";
    match short_key(system, key::MODEL_TYPE) {
        Some(key::GEOGRAPHIC) => return not_projected(in_degrees),
        Some(key::GEOCENTRIC) => return not_projected("geocentric coordinates"),
        _ => {}
    }
    let coded_degrees = short_key(system, key::GEOGRAPHIC_CRS).is_some_and(is_geodetic);
    if !states_a_map(system) && (coded_degrees || states_degrees_in_text(system)) {
        return not_projected(in_degrees);
    }
    match projected_code(system) {
        Some(code) if is_geodetic(code) => {
            not_projected(&format!("the code EPSG:{code} (key 3072), which is of longitude and latitude"))
        }
        Some(code) if is_compound(code) => Err(unsuitable(
            format!("the code EPSG:{code} (key 3072), which is of a map together with heights in units of its own"),
            "the code of a projected map in metres, with elevations in metres",
            "gdal_translate -a_srs EPSG:CODE_OF_THE_MAP in.tif out.tif, if the elevations are in metres (projinfo EPSG:CODE names both parts)",
        )),
        _ => Ok(()),
    }
}

/// Refuses elevations in other units than metres, depths, and units that are stated in a way that is not known.
fn check_elevations(system: &CoordinateSystem, scaling: Scaling) -> Result<(), TerrainError> {
    let stated = |wanted| short_key(system, wanted).filter(|code| *code != key::UNDEFINED);
    let (unit, reference) = (stated(key::VERTICAL_UNITS), stated(key::VERTICAL_CRS));
    let implied = reference.and_then(vertical);
    let cited = cited_feet_of_heights(system);
    let by_reference = |code: u16| format!("EPSG:{code} (key 4096)");
    match (unit, reference, implied) {
        (_, Some(code), Some(Vertical::Depths)) => Err(in_unit(
            (system, scaling),
            &format!("depths below a surface, counted downwards, by the code {}", by_reference(code)),
            Some(-unit.or_else(|| unit_of_depths(code)).and_then(|unit| length_unit(unit).1).unwrap_or(1.0)),
        )),
        (Some(unit), Some(code), Some(implied))
            if implied != (if unit == key::METRE { Vertical::Metres } else { Vertical::Unit(unit) }) =>
        {
            let other = match implied {
                Vertical::Unit(other) => length_unit(other).0,
                _ => "metres".to_owned(),
            };
            Err(said_twice(
                system,
                &format!("elevations in {} (key 4099) and in {other} by the code {}", length_unit(unit).0, by_reference(code)),
            ))
        }
        (Some(key::METRE), ..) => match cited {
            Some((text, feet)) => Err(said_twice(
                system,
                &format!("elevations in metres (key 4099) and in {} (citation '{text}')", length_unit(feet).0),
            )),
            None => Ok(()),
        },
        (Some(unit), ..) | (None, _, Some(Vertical::Unit(unit))) => {
            let (name, size_m) = length_unit(unit);
            Err(in_unit((system, scaling), &format!("elevations in {name}"), size_m))
        }
        (None, ..) => match (cited, reference, implied) {
            (Some((text, feet)), Some(code), Some(Vertical::Metres)) => Err(said_twice(
                system,
                &format!(
                    "elevations in metres by the code {} and in {} (citation '{text}')",
                    by_reference(code),
                    length_unit(feet).0
                ),
            )),
            (Some((text, feet)), ..) => {
                let (name, size_m) = length_unit(feet);
                Err(in_unit((system, scaling), &format!("elevations in {name} (citation '{text}')"), size_m))
            }
            (None, Some(code), None) => {
                let which = if code == key::USER_DEFINED {
                    "heights of a user-defined reference system (key 4096)".to_owned()
                } else {
                    format!("heights of the reference system {}, whose unit is not known here,", by_reference(code))
                };
                Err(unsuitable(
                    format!("{which} without a unit (key 4099)"),
                    "elevations in metres",
                    &format!("gdal_translate -a_srs {} in.tif out.tif, if the elevations are in metres", horizontal(system)),
                ))
            }
            (None, ..) => Ok(()),
        },
    }
}

/// The refusal of elevations in a unit, with the command that converts them.
fn in_unit((system, scaling): (&CoordinateSystem, Scaling), found: &str, size_m: Option<f64>) -> TerrainError {
    unsuitable(found.to_owned(), "elevations in metres", &convert_heights(Some(&horizontal(system)), scaling, size_m))
}

/// The refusal of two units of elevations.
fn said_twice(system: &CoordinateSystem, found: &str) -> TerrainError {
    let mend = format!("gdal_translate -a_srs {} in.tif out.tif, if they are in metres", horizontal(system));
    unsuitable(found.to_owned(), "elevations in metres, and one unit", &mend)
}

/// The map without its heights, as a word of a command.
fn horizontal(system: &CoordinateSystem) -> String {
    match (projected_code(system), MapProjection::of(system)) {
        (Some(code), _) => format!("EPSG:{code}"),
        (None, Ok(map)) => format!("'{}'", map.proj_string()),
        _ => "'PROJ STRING OF THE MAP WITHOUT HEIGHTS'".to_owned(),
    }
}

/// Refuses a map whose coordinates are in other units than metres, or in one that is not known.
fn check_map_unit(system: &CoordinateSystem) -> Result<(), TerrainError> {
    let cited = || cited_unit_of_map(system);
    let found = match short_key(system, key::LINEAR_UNITS).filter(|unit| *unit != key::UNDEFINED) {
        Some(key::METRE) => match cited() {
            Some((text, unit)) => format!("map coordinates in metres (key 3076) and in {unit} (citation '{text}')"),
            None => return Ok(()),
        },
        Some(key::USER_DEFINED) => match double_key(system, key::LINEAR_UNIT_SIZE) {
            Some(size_m) if (size_m - 1.0).abs() < UNIT_ROUNDING => return Ok(()),
            Some(size_m) => format!("map units of {size_m} m"),
            None => "map units that are not stated".to_owned(),
        },
        Some(unit) => format!("map coordinates in {}", length_unit(unit).0),
        None => match (cited(), projected_code(system)) {
            // The citations of maps in feet mention it ("NAD83 / Texas Central (ftUS)").
            (Some((text, unit)), _) => format!("map coordinates in {unit} (citation '{text}')"),
            (None, Some(code)) if !is_map_in_metres(code) => {
                format!("the code EPSG:{code} (key 3072), which is not known here as a map in metres, without a unit (key 3076)")
            }
            _ => return Ok(()),
        },
    };
    let mend = if states_a_map(system) {
        "gdalwarp -r bilinear -ot Float64 -dstnodata nan -t_srs \"$(gdalsrsinfo -o proj4 in.tif | sed 's/+units=[^ ]*/+units=m/; s/+to_meter=[^ ]*/+units=m/')\" \
         in.tif out.tif"
    } else {
        "gdal_translate -a_srs 'LOCAL_CS[\"site\",UNIT[\"metre\",1]]' -a_ullr WEST NORTH EAST SOUTH in.tif out.tif, with the borders in metres \
         (gdalinfo prints them in the file's unit)"
    };
    Err(unsuitable(found, "a projected map in metres", mend))
}

/// The citation of the map that names another unit than the metre, and the unit's name.
fn cited_unit_of_map(system: &CoordinateSystem) -> Option<(String, String)> {
    [key::PROJECTED_CITATION, key::CITATION].into_iter().find_map(|wanted| {
        let text = text_key(system, wanted).filter(|text| !text.contains('['))?;
        // Heights stand behind the plus sign of a compound system.
        let map = text.split(" + ").next().unwrap_or_default();
        let named = map.split('|').find_map(|part| part.trim().strip_prefix("LUnits = "));
        let unit = match (named, feet(map)) {
            // GDAL's own name of the metre where a file states its number.
            (Some(unit), _) if !is_metre(unit) && !unit.trim().eq_ignore_ascii_case("linear_meter") => Some(unit.to_owned()),
            (_, Some(unit)) => Some(length_unit(unit).0),
            _ => None,
        };
        Some((text.to_owned(), unit?))
    })
}

/// The citation of the heights that names feet, and their unit.
fn cited_feet_of_heights(system: &CoordinateSystem) -> Option<(String, u16)> {
    let of_heights = |wanted: u16| match (wanted, text_key(system, wanted)?) {
        (key::VERTICAL_CITATION, text) => Some((text, text)),
        (_, text) => Some((text, text.split_once(" + ")?.1)),
    };
    [key::VERTICAL_CITATION, key::CITATION, key::PROJECTED_CITATION, key::GEOGRAPHIC_CITATION]
        .into_iter()
        .filter_map(of_heights)
        .find_map(|(text, heights)| Some((text.to_owned(), feet(heights)?)))
}

/// The unit that a text names if it names feet: EPSG:9002, or EPSG:9003 for those of the US survey.
pub(super) fn feet(text: &str) -> Option<u16> {
    let lower = text.to_ascii_lowercase();
    let mut words = lower.split(|letter: char| !letter.is_ascii_alphabetic());
    let named = words.clone().any(|word| matches!(word, "ft" | "ftus" | "usft" | "feet" | "foot"));
    let survey = words.any(|word| matches!(word, "ftus" | "usft" | "us" | "survey"));
    named.then_some(if survey { 9003 } else { 9002 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys with numbers, and texts (key, text).
    fn keys(numbers: &[(u16, u16)], texts: &[(u16, &str)], doubles: &[(u16, f64)]) -> CoordinateSystem {
        let mut system = CoordinateSystem::default();
        let mut entries: Vec<[u16; 4]> = numbers.iter().map(|(key, value)| [*key, 0, 1, *value]).collect();
        for (key, text) in texts {
            let offset = u16::try_from(system.ascii_parameters.len()).unwrap();
            entries.push([*key, 34737, u16::try_from(text.len() + 1).unwrap(), offset]);
            system.ascii_parameters += text;
            system.ascii_parameters.push('|');
        }
        for (key, value) in doubles {
            entries.push([*key, 34736, 1, u16::try_from(system.double_parameters.len()).unwrap()]);
            system.double_parameters.push(*value);
        }
        entries.sort_unstable();
        system.key_directory = vec![1, 1, 0, u16::try_from(entries.len()).unwrap()];
        system.key_directory.extend(entries.into_iter().flatten());
        system
    }

    const UTM: [(u16, u16); 2] = [(1024, 1), (3072, 32614)];

    /// Each row: further keys, further texts, and the words of the refusal; no words: read. GDAL 3.6 (gdalinfo, "Unit Type") says the
    /// same unit of every row with a code of EPSG.
    #[test]
    fn the_unit_of_elevations_follows_from_key_code_and_citation() {
        let us = "-a_scale 0.3048006";
        for (numbers, texts, words) in [
            (&[(4096, 6360)][..], &[][..], &["US survey feet", us, "-a_srs EPSG:32614"][..]),
            (&[(4096, 8228)], &[], &["elevations in feet", "-a_scale 0.3048 "]),
            (&[(4096, 5702)], &[], &["US survey feet", us]),
            (&[(4096, 5754)], &[], &["British feet (1936)", "-a_scale 0.3048007491 "]),
            (&[(4096, 6131)], &[], &["elevations in feet"]),
            (&[(4096, 5703)], &[], &[]),
            (&[(4096, 5773), (4099, 9001)], &[], &[]),
            (&[(4099, 9001)], &[], &[]),
            (&[(4099, 9002)], &[], &["elevations in feet", "-a_scale 0.3048 "]),
            (&[(4099, 9036)], &[], &["elevations in kilometres", "-a_scale 1000 "]),
            (&[(4099, 1025)], &[], &["elevations in millimetres", "-a_scale 0.001 "]),
            (&[(4099, 9005)], &[], &["Clarke's feet"]),
            (&[(4099, 9999)], &[], &["EPSG:9999", "not known", "METRES_PER_UNIT"]),
            (&[(4099, 32767)], &[], &["user-defined", "METRES_PER_UNIT"]),
            // Unknown, user-defined and old codes (GeoTIFF 1.0: the unit stands beside them) imply no unit.
            (&[(4096, 9999)], &[], &["EPSG:9999 (key 4096)", "without a unit", "-a_srs EPSG:32614"]),
            (&[(4096, 5103)], &[], &["EPSG:5103 (key 4096)", "without a unit"]),
            (&[(4096, 5103), (4099, 9001)], &[], &[]),
            (&[(4096, 32767)], &[], &["user-defined reference system", "without a unit"]),
            (&[(4096, 32767)], &[(4097, "site datum (ft)")], &["elevations in feet", "site datum (ft)"]),
            (&[(4096, 32767), (4099, 9001)], &[(4097, "site datum")], &[]),
            // Downwards.
            (&[(4096, 5715)], &[], &["depths", "-a_scale -1 "]),
            (&[(4096, 6358)], &[], &["depths", "EPSG:6358"]),
            // Twice.
            (&[(4096, 6360), (4099, 9001)], &[], &["metres (key 4099)", "US survey feet", "6360"]),
            (&[(4096, 5703), (4099, 9003)], &[], &["US survey feet (key 4099)", "metres by the code EPSG:5703"]),
            (&[(4096, 6360), (4099, 9003)], &[], &["elevations in US survey feet", us]),
            (&[(4099, 9001)], &[(4097, "NAVD88 height (ftUS)")], &["metres (key 4099)", "NAVD88 height (ftUS)"]),
            (&[(4096, 5703)], &[(4097, "NAVD88 height (ftUS)")], &["metres by the code EPSG:5703", "US survey feet"]),
            // By citation alone: of the heights, not of the map.
            (&[], &[(1026, "WGS 84 / UTM zone 14N + NAVD88 height (ftUS)")], &["elevations in US survey feet", us]),
            (&[(4096, 6360)], &[(1026, "WGS 84 / UTM zone 14N + NAVD88 height (ftUS)")], &["elevations in US survey feet"]),
            (&[], &[(1026, "WGS 84 / UTM zone 14N + NAVD88 height")], &[]),
        ] {
            let system = keys(&[&UTM[..], numbers].concat(), texts, &[]);
            is_reported(&system, words, &format!("{numbers:?} {texts:?}"));
        }
        // Over degrees as well, and before them: the command that mends degrees drops the unit of the heights.
        is_reported(&keys(&[(1024, 2), (2048, 4326), (4096, 6360)], &[], &[]), &["elevations in US survey feet"], "degrees");
    }

    fn is_reported(system: &CoordinateSystem, words: &[&str], row: &str) {
        match (check(system, Scaling::NONE), words) {
            (Ok(()), []) => {}
            (Ok(()), _) => panic!("{row}: read, expected a refusal with {words:?}"),
            (Err(error), []) => panic!("{row}: {error}"),
            (Err(error), _) => {
                let message = error.to_string();
                assert!(words.iter().all(|word| message.contains(word)) && message.contains("gdal"), "{row}: {message}\n{words:?}");
            }
        }
    }

    /// Each row: keys, texts, numbers, and the words of the refusal; no words: read.
    #[test]
    fn what_is_stated_of_the_map_and_not_known_is_refused() {
        let web = "ESRI PE String = PROJCS[\"WGS_1984_Web_Mercator_Auxiliary_Sphere\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",\
                   SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],\
                   PROJECTION[\"Mercator_Auxiliary_Sphere\"],PARAMETER[\"Standard_Parallel_1\",0.0],\
                   PARAMETER[\"Auxiliary_Sphere_Type\",0.0],UNIT[\"Meter\",1.0]]";
        let degrees = "ESRI PE String = GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",1737400,0]],PRIMEM[\"p\",0],UNIT[\"Degree\",0.0174532925199433]]";
        let moon = [(2057, 1_737_400.0), (2058, 1_737_400.0)];
        for (numbers, texts, doubles, words) in [
            (&[][..], &[][..], &[][..], &[][..]),
            (&[(1024, 1)], &[], &[], &[]),
            (&[(1024, 32767)], &[(1026, "site")], &[], &[]),
            (&[(3076, 9001)], &[(1026, "Mars local grid")], &[], &[]),
            (&[(1024, 7)], &[], &[], &["kind 7 (key 1024)"]),
            (&[(1024, 2)], &[], &[], &["degrees"]),
            (&[(1024, 3)], &[], &[], &["geocentric"]),
            // Degrees without a kind of map.
            (&[(2048, 4326)], &[], &[], &["degrees"]),
            (&[(1024, 32767)], &[(2049, degrees)], &[], &["degrees"]),
            (&[(1024, 1), (3072, 4326)], &[], &[], &["EPSG:4326 (key 3072)", "longitude and latitude"]),
            (&[(1024, 1), (3072, 4326), (3076, 9001)], &[], &[], &["EPSG:4326 (key 3072)"]),
            (&[(1024, 1), (3072, 6349)], &[], &[], &["EPSG:6349", "heights in units of its own"]),
            (&[(1024, 1), (3072, 8720), (3076, 9001)], &[], &[], &["EPSG:8720", "heights in units of its own"]),
            // Units of the map.
            (&[(1024, 1), (3072, 2278)], &[], &[], &["EPSG:2278", "without a unit (key 3076)"]),
            (&[(1024, 1), (3072, 30000)], &[], &[], &["EPSG:30000", "without a unit (key 3076)"]),
            (&[(1024, 1), (3072, 27700)], &[], &[], &[]),
            (&[(1024, 1), (3072, 32614), (3076, 9003)], &[], &[], &["US survey feet", "gdalwarp"]),
            (&[(1024, 1), (3076, 9999)], &[], &[], &["EPSG:9999", "not known"]),
            (&[(1024, 1), (3076, 32767)], &[], &[], &["not stated"]),
            (&[(1024, 1), (3076, 32767)], &[], &[(3077, 0.3048)], &["0.3048 m"]),
            (&[(1024, 1), (3076, 32767)], &[], &[(3077, 1.0)], &[]),
            (&[(1024, 1)], &[(3073, "NAD83 / Texas South Central (ftUS)")], &[], &["map coordinates in US survey feet"]),
            (&[(1024, 1)], &[(3073, "PCS Name = site|LUnits = Intl_Foot|")], &[], &["Intl_Foot"]),
            (&[(1024, 1)], &[(3073, "PCS Name = site|LUnits = US_Survey_Yards|")], &[], &["US_Survey_Yards"]),
            (&[(1024, 1)], &[(3073, "PCS Name = site|LUnits = Meter|")], &[], &[]),
            (&[(1024, 1), (3076, 9001)], &[(1026, "NAD83 / Texas (ftUS)")], &[], &["metres (key 3076)", "US survey feet"]),
            (&[(3076, 9002)], &[(1026, "site")], &[], &["map coordinates in feet", "-a_ullr"]),
            // Said twice.
            (&[(1024, 1), (3072, 32614), (2048, 4326)], &[], &[(2057, 6_378_137.0)], &[]),
            (&[(1024, 1), (3072, 32614)], &[], &moon, &["32614 (key 3072)", "1737400 m (key 2057)"]),
            (&[(1024, 1), (3072, 32767), (2048, 4326)], &[], &moon, &["4326 (key 2048)", "1737400"]),
            (&[(1024, 1), (3072, 32633)], &[(1026, "WGS 84 / UTM zone 34N")], &[], &["UTM zone 34N", "+lon_0=15"]),
            (&[(1024, 1), (3072, 32633)], &[(3073, "WGS_1984_UTM_Zone_33S")], &[], &["UTM zone 33S"]),
            (&[(1024, 1), (3072, 32633)], &[(1026, "WGS 84 / UTM zone 33N")], &[], &[]),
            (&[(1024, 1), (3072, 32633)], &[(1026, "UTM 33 N, EPSG:32634")], &[], &["EPSG:32634"]),
            (&[(1024, 1), (3072, 3031)], &[(1026, "WGS 84 / UTM zone 33N")], &[], &["UTM zone 33N", "+proj=stere"]),
            (&[(1024, 1), (3072, 26914)], &[(1026, "NAD83 / UTM zone 14N")], &[], &[]),
            (&[(1024, 1), (3072, 32633)], &[(3073, web)], &[], &["EPSG:32633", "ESRI PE String"]),
            (&[(1024, 1), (3072, 3857)], &[(3073, web)], &[], &[]),
            (
                &[(1024, 32767), (3072, 32767), (3075, 7), (2048, 4326)],
                &[(3073, web)],
                &[(2057, 6_378_137.0), (2059, 298.257_223_563)],
                &[],
            ),
            (
                &[(1024, 1), (3072, 32633), (3075, 1)],
                &[],
                &[(3080, 21.0), (3092, 0.9996), (3082, 5e5)],
                &["EPSG:32633", "keys 3075 to 3095"],
            ),
            (&[(1024, 1), (3072, 32633), (3075, 1)], &[], &[(3080, 15.0), (3092, 0.9996), (3082, 5e5)], &[]),
            (
                &[(1024, 1), (3072, 32767), (3074, 16033), (3075, 1), (2056, 7030)],
                &[],
                &[(3080, 21.0), (3092, 0.9996), (3082, 5e5)],
                &["key 3074"],
            ),
        ] {
            is_reported(&keys(numbers, texts, doubles), words, &format!("{numbers:?} {texts:?} {doubles:?}"));
        }
    }

    #[test]
    fn kinds_of_posts_that_are_not_known_are_refused() {
        for (number, read) in [(1, true), (2, true), (0, false), (3, false), (32767, false)] {
            let found = check(&keys(&[(1024, 1), (1025, number)], &[], &[]), Scaling::NONE);
            assert_eq!(found.is_ok(), read, "{number}");
            assert!(found.err().is_none_or(|error| error.to_string().contains("AREA_OR_POINT")));
        }
    }

    /// The names of bodies beside radii: warnings only, since the numbers are what counts.
    #[test]
    fn a_citation_that_names_another_body_is_doubted() {
        for (text, radius_m, doubted) in [
            ("Moon 2000 south polar", 1_737_400.0, false),
            ("Moon 2000 south polar", 6_378_137.0, true),
            ("Mars sinusoidal", 3_396_190.0, false),
            ("Mars sinusoidal", 1_737_400.0, true),
            ("GCS Name = WGS 84|Datum = WGS 84|", 1_737_400.0, true),
            ("GCS Name = unknown|", 1_737_400.0, false),
            ("Phobos", 13_000.0, false),
            ("Eros", 5_500.0, false),
            ("moonstone quarry", 6_378_137.0, false),
        ] {
            let key = if text.starts_with("GCS") { 2049 } else { 1026 };
            let system = keys(&[(1024, 1)], &[(key, text)], &[(2057, radius_m), (2058, radius_m)]);
            assert_eq!(crate::terrain::projection::doubts(&system).len(), usize::from(doubted), "{text} {radius_m}");
        }
    }
}
