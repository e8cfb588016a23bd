//! Formats that this crate does not read itself. They are recognised by name, so that the error can say what the file is and
//! what to do.
//!
//! The `gdal` feature reads them, and all other formats of GDAL (`src/terrain/gdal.rs`).

#[cfg(not(feature = "gdal"))]
use super::TerrainError;

/// The first bytes of files of a format, and its name.
const BEGINNINGS: [(&[u8], &str); 12] = [
    (b"Object = IsisCube", "an ISIS cube"),
    (b"LBLSIZE=", "a VICAR image"),
    (b"\x89HDF\r\n", "an HDF5 or NetCDF-4 file"),
    (b"CDF", "a NetCDF file"),
    (b"\0\0\0\x0cjP  ", "a JPEG 2000 picture"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"SIMPLE  =", "a FITS file"),
    (b"DSBB", "a Surfer grid"),
    (b"EHFA_HEADER_TAG", "an ERDAS Imagine image"),
    (b"GRIB", "a GRIB file"),
    (b"<VRTDataset", "a virtual raster of GDAL"),
];

/// The name of a format with an article, if the file begins like one of these.
pub(crate) fn name(beginning: &[u8]) -> Option<&'static str> {
    let text = beginning.trim_ascii_start();
    let label = text.starts_with(b"<") && contains(text, b"Product_Observational");
    if label || (text.starts_with(b"<") && contains(text, b"pds.nasa.gov/pds4")) {
        return Some("a PDS4 label");
    }
    BEGINNINGS.iter().find(|(start, _)| beginning.starts_with(start) || text.starts_with(start)).map(|(_, name)| *name)
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window == word)
}

/// The error of a build without GDAL.
#[cfg(not(feature = "gdal"))]
pub(super) fn refusal(name: &str) -> TerrainError {
    TerrainError::Unsuitable {
        found: format!("{name}, which this build does not read"),
        expected: "GeoTIFF, ESRI ASCII grid, PDS3 image or XYZ grid, or a build with the feature gdal (cargo install chta --features gdal)",
        mend: "gdal_translate in out.tif".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_formats_are_known_by_content() {
        assert_eq!(name(b"Object = IsisCube\n  Object = Core"), Some("an ISIS cube"));
        let label = b"<?xml version=\"1.0\"?>\n<Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\">";
        assert_eq!(name(label), Some("a PDS4 label"));
        assert_eq!(name(b"<html>"), None);
        assert_eq!(name(b""), None);
    }
}
