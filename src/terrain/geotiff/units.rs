//! What the `GeoKeys` say of the kind of map, of its units and of the unit of its elevations. What is stated and not known is refused:
//! it must not count as the default.

use super::key;
use super::keys::{double_key, short_key, text_key, unsuitable};
use crate::terrain::georeference::mend_degrees;
use crate::terrain::projection::{
    MapProjection, Vertical, contradiction, is_compound, is_geodetic, is_map_in_metres, length_unit, projected_code, states_a_map,
    states_degrees_in_text, vertical,
};
use crate::terrain::{CoordinateSystem, TerrainError};

/// A user-defined unit of another size is no metre.
const UNIT_ROUNDING: f64 = 1.0e-9;

/// Checks kind, units and statements about the map.
///
/// The elevations come first: the commands that mend a map drop what a file says of its elevations.
///
/// # Errors
/// [`TerrainError::Unsuitable`] or [`TerrainError::NotProjected`], with a command that makes a usable file.
pub(super) fn check(system: &CoordinateSystem) -> Result<(), TerrainError> {
    check_kinds(system)?;
    check_elevations(system)?;
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
fn check_elevations(system: &CoordinateSystem) -> Result<(), TerrainError> {
    let stated = |wanted| short_key(system, wanted).filter(|code| *code != key::UNDEFINED);
    let (unit, reference) = (stated(key::VERTICAL_UNITS), stated(key::VERTICAL_CRS));
    let implied = reference.and_then(vertical);
    let cited = cited_feet_of_heights(system);
    let by_reference = |code: u16| format!("EPSG:{code} (key 4096)");
    match (unit, reference, implied) {
        (_, Some(code), Some(Vertical::Depths)) => Err(in_unit(
            system,
            &format!("depths below a surface, counted downwards, by the code {}", by_reference(code)),
            Some(-unit.and_then(|unit| length_unit(unit).1).unwrap_or(1.0)),
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
            Err(in_unit(system, &format!("elevations in {name}"), size_m))
        }
        (None, Some(code), None) => Err(match cited {
            Some((text, feet)) => {
                let (name, size_m) = length_unit(feet);
                in_unit(system, &format!("elevations in {name} (citation '{text}')"), size_m)
            }
            None => {
                let which = if code == key::USER_DEFINED {
                    "heights of a user-defined reference system (key 4096)".to_owned()
                } else {
                    format!("heights of the reference system {}, whose unit is not known here,", by_reference(code))
                };
                unsuitable(
                    format!("{which} without a unit (key 4099)"),
                    "elevations in metres",
                    &format!("gdal_translate -a_srs {} in.tif out.tif, if the elevations are in metres", horizontal(system)),
                )
            }
        }),
        (None, ..) => match cited {
            Some((text, feet)) => {
                let (name, size_m) = length_unit(feet);
                Err(in_unit(system, &format!("elevations in {name} (citation '{text}')"), size_m))
            }
            None => Ok(()),
        },
    }
}

/// The refusal of elevations in a unit, with the command that converts them.
fn in_unit(system: &CoordinateSystem, found: &str, size_m: Option<f64>) -> TerrainError {
    let size = size_m.map_or_else(|| "METRES_PER_UNIT".to_owned(), |size_m| format!("{size_m}"));
    // A name of feet in the file's own reference system would be copied: it is replaced.
    let mend = format!(
        "gdal_calc.py -A in.tif --outfile=metres.tif --calc='A*{size}' --type=Float64 && gdal_translate -a_srs {} metres.tif out.tif",
        horizontal(system)
    );
    unsuitable(found.to_owned(), "elevations in metres", &mend)
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
        "gdalwarp -r bilinear -t_srs \"$(gdalsrsinfo -o proj4 in.tif | sed 's/+units=[^ ]*/+units=m/; s/+to_meter=[^ ]*/+units=m/')\" \
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
            (Some(unit), _) if !is_metre(unit) => Some(unit.to_owned()),
            (_, Some(unit)) => Some(length_unit(unit).0),
            _ => None,
        };
        Some((text.to_owned(), unit?))
    })
}

fn is_metre(unit: &str) -> bool {
    let unit = unit.trim().to_ascii_lowercase();
    matches!(unit.as_str(), "m" | "metre" | "metres" | "meter" | "meters" | "linear_meter")
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
