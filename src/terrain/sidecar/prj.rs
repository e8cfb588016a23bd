//! Reference systems in sidecar files: well-known text.

use std::io::Read;
use std::path::Path;

use super::text_of;
use crate::terrain::{MapProjection, TerrainError};

/// A reference system, or why it cannot be used; `None` for an empty text and for a local system in metres.
pub(super) type Stated = Option<Result<MapProjection, String>>;

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
            return Some(Err("a system of heights without a map, expected a projected map in metres; remove this file".to_owned()));
        }
        // A compound system in one bracket is read as a whole.
        Some(at) if !upper.starts_with("COMPD") => text.split_at(at),
        _ => (text, ""),
    };
    let map = map.trim_end_matches(|letter: char| letter == ',' || letter.is_whitespace());
    if let Some(unit) = unit_of_heights(heights).filter(|(_, size_m)| *size_m != 1.0) {
        return Some(Err(format!(
            "elevations in '{}', expected elevations in metres; convert them with: gdal_calc.py -A in.tif --outfile=out.tif --calc='A*{}'",
            unit.0, unit.1
        )));
    }
    let local = ["LOCAL_CS", "ENGCRS", "ENGINEERINGCRS"].iter().any(|keyword| upper.starts_with(keyword));
    if local {
        let metres = unit_of_heights(map).is_none_or(|(_, size_m)| size_m == 1.0);
        return (!metres)
            .then(|| Err("a local system in another unit than the metre, expected metres; convert the raster".to_owned()));
    }
    if !text.contains('[') && upper.starts_with("PROJECTION") {
        return Some(Err(
            "a reference system in the old form of ArcInfo, expected well-known text; write the raster with its system by: \
             gdal_translate -a_srs SYSTEM in out.tif, where gdalsrsinfo FILE shows the system"
                .to_owned(),
        ));
    }
    Some(MapProjection::from_wkt(map).map_err(|error| error.to_string()))
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
