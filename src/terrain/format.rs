//! The raster formats that can be read, recognised by content.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use super::ascii_grid::AsciiGridReader;
use super::foreign;
use super::geotiff::GeoTiffReader;
use super::pds3::Pds3Reader;
use super::sidecar::Sidecars;
use super::xyz::XyzReader;
use super::{Dem, DemFile, NoDataRule, TerrainError};

/// Number of bytes of a file that readers get to recognise their format.
const PROBE_BYTES: u64 = 4096;

/// A reader of one file format. To add a format, implement this trait and add the reader to `READERS` and [`FORMATS`].
pub trait DemReader: Sync {
    /// The format's name.
    fn name(&self) -> &'static str;

    /// Whether a file with this beginning has the format. The content decides, never the extension.
    fn recognises(&self, beginning: &[u8]) -> bool;

    /// Reads a whole file from memory.
    ///
    /// # Errors
    /// [`TerrainError`] with what was found, what was expected, and how to correct it.
    fn read_bytes(&self, bytes: Vec<u8>, context: &ReadContext) -> Result<Dem, TerrainError>;

    /// Reads a file from disk.
    ///
    /// # Errors
    /// As [`DemReader::read_bytes`], and if the file cannot be read.
    fn read_path(&self, path: &Path, context: &ReadContext) -> Result<Dem, TerrainError>;

    /// Opens a file from disk to read parts of it. Formats that can only be read as a whole are read as a whole.
    ///
    /// # Errors
    /// As [`DemReader::read_path`], except for problems of posts that are not requested.
    fn open_path(&self, path: &Path, context: ReadContext) -> Result<Box<dyn DemFile>, TerrainError> {
        Ok(Box::new(self.read_path(path, &context)?))
    }
}

/// The readers, in the order in which they are tried.
static READERS: [&dyn DemReader; 4] = [&GeoTiffReader, &AsciiGridReader, &Pds3Reader, &XyzReader];

/// Names of the formats and one line about each, for help texts.
pub const FORMATS: [(&str, &str); 4] = [
    ("GeoTIFF", "one band of integer or float elevations in metres, on a map in metres, north up (also BigTIFF, COG)"),
    ("ESRI ASCII grid", "ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize or dx and dy, NODATA_value"),
    ("PDS3 image", "an IMAGE object with its IMAGE_MAP_PROJECTION, label attached or beside it (give the label)"),
    (
        "XYZ grid",
        "x, y, z in m, one post per line in any order, on a regular lattice; separated by comma, semicolon or white space",
    ),
];

/// Reads a DEM file with any extension. With the feature `gdal`, files in none of the formats are passed to GDAL.
///
/// # Errors
/// [`TerrainError::InFile`] with the cause: the file cannot be read, has no known format, is damaged, or does not hold
/// elevations in metres on a north-up map in metres.
pub fn read_dem(path: &Path) -> Result<Dem, TerrainError> {
    DemOptions::default().read(path)
}

/// Opens a DEM file with any extension to read parts of it: from a GeoTIFF or PDS3 image only the parts requested, from a
/// text file everything.
///
/// # Errors
/// As [`read_dem`], but problems of posts that are not requested are not detected.
pub fn open_dem(path: &Path) -> Result<Box<dyn DemFile>, TerrainError> {
    DemOptions::default().open(path)
}

/// How a DEM file is read, where the file does not say everything itself.
///
/// # Examples
/// A trench at -9 999 m in a file that states no no-data value: a usual mark of missing data, but ground here.
/// ```
/// use chta::terrain::{DemOptions, NoDataRule};
/// let file = tempfile::NamedTempFile::new().unwrap();
/// std::fs::write(file.path(), "7000 0 -9999\n8000 0 -5000\n7000 1000 -5001\n8000 1000 -5000\n").unwrap();
/// assert!(DemOptions::default().read(file.path()).unwrap_err().to_string().contains("terrain.no_data"));
/// let dem = DemOptions::default().no_data(NoDataRule::Nothing).read(file.path())?;
/// assert_eq!(dem.elevation(1, 0), Some(-9999.0));
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DemOptions {
    no_data: NoDataRule,
    of_any_unit: bool,
}

impl DemOptions {
    /// The same with this rule for missing elevations.
    #[must_use]
    pub const fn no_data(self, no_data: NoDataRule) -> Self {
        Self { no_data, ..self }
    }

    /// The same for values that are no elevations: a `GeoTIFF` may state any unit of them.
    #[must_use]
    pub const fn of_any_unit(self) -> Self {
        Self { of_any_unit: true, ..self }
    }

    /// The rule for missing elevations.
    pub const fn no_data_rule(self) -> NoDataRule {
        self.no_data
    }

    /// Reads a whole file.
    ///
    /// # Errors
    /// As [`read_dem`].
    pub fn read(self, path: &Path) -> Result<Dem, TerrainError> {
        let read = || reader_of(path)?.read_path(path, &self.context(path)?);
        read().map_err(|error| error.in_file(path))
    }

    /// Opens a file to read parts of it.
    ///
    /// # Errors
    /// As [`open_dem`].
    pub fn open(self, path: &Path) -> Result<Box<dyn DemFile>, TerrainError> {
        let open = || reader_of(path)?.open_path(path, self.context(path)?);
        open().map_err(|error| error.in_file(path))
    }

    fn context(self, path: &Path) -> Result<ReadContext, TerrainError> {
        let sidecars = Arc::new(Sidecars::beside(path)?);
        Ok(ReadContext { no_data: self.no_data, of_any_unit: self.of_any_unit, sidecars })
    }
}

/// What the user and the files beside a raster state of it.
#[derive(Clone, Debug, Default)]
pub struct ReadContext {
    pub(super) no_data: NoDataRule,
    pub(super) of_any_unit: bool,
    pub(super) sidecars: Arc<Sidecars>,
}

/// The name of the format of a file with this beginning, if one of the readers knows it.
pub(crate) fn format_name(beginning: &[u8]) -> Option<&'static str> {
    READERS.iter().find(|reader| reader.recognises(beginning)).map(|reader| reader.name())
}

fn reader_of(path: &Path) -> Result<&'static dyn DemReader, TerrainError> {
    let beginning = read_beginning(path)?;
    if let Some(reader) = READERS.iter().copied().find(|reader| reader.recognises(&beginning)) {
        return Ok(reader);
    }
    #[cfg(feature = "gdal")]
    if !beginning.is_empty() && super::gdal::can_open(path) {
        return Ok(&super::gdal::GdalReader);
    }
    if let Some(name) = foreign::name(&beginning) {
        return Err(foreign::refusal(name));
    }
    Err(label_beside(path).unwrap_or_else(|| not_recognised(&beginning)))
}

/// The error for an image whose PDS3 label is a separate file next to it.
fn label_beside(path: &Path) -> Option<TerrainError> {
    let is_label = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("lbl"));
    let mut labels = ["lbl", "LBL"].map(|extension| path.with_extension(extension)).into_iter();
    let label = labels.find(|label| label.is_file() && !is_label)?;
    Some(TerrainError::Unsuitable {
        found: "an image without a label in it".to_owned(),
        expected: "the label, which names its image",
        mend: format!("give {} instead", label.file_name()?.to_string_lossy()),
    })
}

fn read_beginning(path: &Path) -> Result<Vec<u8>, TerrainError> {
    let mut beginning = Vec::new();
    let file = File::open(path).map_err(TerrainError::reading)?;
    file.take(PROBE_BYTES).read_to_end(&mut beginning).map_err(TerrainError::reading)?;
    Ok(beginning)
}

fn not_recognised(beginning: &[u8]) -> TerrainError {
    let found = if beginning.is_empty() {
        "nothing: the file is empty".to_owned()
    } else if beginning.len() >= 64 && beginning.iter().all(|byte| *byte == 0) {
        "zero bytes only, as a file does whose download was not finished: copy or download it again".to_owned()
    } else {
        format!(
            "'{}'",
            beginning.iter().take(24).flat_map(|&byte| std::ascii::escape_default(byte)).map(char::from).collect::<String>()
        )
    };
    let expected = FORMATS.map(|(name, _)| name).join(", ");
    TerrainError::NotRecognised { found, expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reader_is_named_in_the_list_of_formats() {
        let names: Vec<&str> = READERS.iter().map(|reader| reader.name()).collect();
        assert_eq!(names, FORMATS.map(|(name, _)| name));
    }

    #[test]
    fn files_of_no_format_are_refused_with_their_first_bytes() {
        let directory = tempfile::tempdir().unwrap();
        for (content, expected) in [
            (&b""[..], "the file is empty"),
            (b"\x00\x01junk", "\\x00\\x01junk"),
            (b"x_m,z_m\n0,1\n", "x_m,z_m"),
            (&[0; 100], "zero bytes only"),
        ] {
            let path = directory.path().join("a.tif");
            std::fs::write(&path, content).unwrap();
            let message = read_dem(&path).unwrap_err().to_string();
            assert!(message.contains(expected) && message.contains("a.tif") && message.contains("GeoTIFF"), "{message}");
        }
        assert!(read_dem(directory.path()).is_err());
        assert!(read_dem(&directory.path().join("absent")).unwrap_err().to_string().contains("absent"));
    }
}
