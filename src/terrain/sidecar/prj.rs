//! Reference systems in sidecar files: well-known text.

use std::io::Read;
use std::path::Path;

use super::{Unclear, text_of};
use crate::terrain::stored::{Scaling, convert_heights};
use crate::terrain::{CrsError, MapProjection, TerrainError};

/// A reference system, or why it cannot be used; `None` for an empty text and for a local system in metres.
pub(super) type Stated = Option<Result<MapProjection, Unclear>>;

/// Reads a `.prj` file.
///
/// # Errors
/// [`TerrainError::Sidecar`] if the file cannot be read.
pub(super) fn read(path: &Path) -> Result<Stated, TerrainError> {
    Ok(of_text(&text_of(path)?))
}

/// Reads well-known text, with heights of ESRI's `VERTCS` after it.
pub(super) fn of_text(text: &str) -> Stated {
    let text = text.trim_matches(|letter: char| letter.is_whitespace() || letter == '\0');
    if text.is_empty() {
        return None;
    }
    let upper = text.to_ascii_uppercase();
    let (map, heights) = match upper.find("VERTCS[") {
        Some(0) => {
            return wrong("a system of heights without a map, expected a projected map in metres; remove this file");
        }
        // A compound system in one bracket is read as a whole.
        Some(at) if !upper.starts_with("COMPD") => text.split_at(at),
        _ => (text, ""),
    };
    let map = map.trim_end_matches(|letter: char| letter == ',' || letter.is_whitespace());
    if let Some(unit) = unit_of_heights(heights).filter(|(_, size_m)| *size_m != 1.0) {
        let mend = convert_heights(Some("'WELL-KNOWN TEXT OF THE MAP ALONE'"), Scaling::NONE, Some(unit.1));
        return wrong(&format!("elevations in '{}', expected elevations in metres; convert them with: {mend}", unit.0));
    }
    for (parameter, allowed) in [("DIRECTION", 1.0), ("VERTICAL_SHIFT", 0.0)] {
        if let Some(value) = parameter_of(heights, parameter).filter(|value| *value != allowed) {
            return wrong(&format!(
                "heights with the parameter {parameter} {value}, expected {allowed}: elevations that grow upwards from the surface of \
                 reference; convert the raster and remove this file"
            ));
        }
    }
    let local = ["LOCAL_CS", "ENGCRS", "ENGINEERINGCRS"].iter().any(|keyword| upper.starts_with(keyword));
    if local {
        let metres = unit_of_heights(map).is_none_or(|(_, size_m)| size_m == 1.0);
        return if metres {
            None
        } else {
            wrong("a local system in another unit than the metre, expected metres; convert the raster")
        };
    }
    if !text.contains('[') && upper.starts_with("PROJECTION") {
        return wrong(
            "a reference system in the old form of ArcInfo, expected well-known text; write the raster with its system by: gdal_translate \
             -a_srs SYSTEM in out.tif, where gdalsrsinfo FILE shows the system",
        );
    }
    Some(MapProjection::from_wkt(map).map_err(|error| match error {
        CrsError::UnknownMethod { .. } | CrsError::UnknownCode { .. } => Unclear::Unsupported(error.to_string()),
        wrong => Unclear::Wrong(wrong.to_string()),
    }))
}

#[expect(clippy::unnecessary_wraps, reason = "the form in which every caller returns it")]
fn wrong(reason: &str) -> Stated {
    Some(Err(Unclear::Wrong(reason.to_owned())))
}

/// The value of a parameter of ESRI's heights.
fn parameter_of(heights: &str, name: &str) -> Option<f64> {
    let upper = heights.to_ascii_uppercase();
    let after = upper.split(&format!("PARAMETER[\"{name}\",")).nth(1)?;
    after.split(']').next()?.trim().parse().ok()
}

/// Name and size of the last unit of a text, m.
fn unit_of_heights(text: &str) -> Option<(String, f64)> {
    let at = ["LENGTHUNIT[", "UNIT["]
        .iter()
        .find_map(|keyword| text.to_ascii_uppercase().rfind(keyword).map(|at| at + keyword.len()))?;
    let inside = text.get(at..)?.split(']').next()?;
    let (name, size_m) = inside.split_once(',')?;
    let size_m = size_m.split(',').next()?.trim().parse().ok()?;
    Some((name.trim().trim_matches('"').to_owned(), size_m))
}

/// Whether a file begins with some bytes.
pub(super) fn begins_with(path: &Path, bytes: &[u8]) -> bool {
    let mut beginning = vec![0; bytes.len()];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut beginning)).is_ok() && beginning == bytes
}
