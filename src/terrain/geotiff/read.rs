//! Reads a GeoTIFF.

use std::path::Path;

use tiff_reader::ifd::ParseBudgets;
use tiff_reader::{OpenOptions, TiffFile};

use super::encoding::unreadable;
use super::image::{Images, damaged};
use super::keys::{GeoTags, Placement};
use super::metadata::{Stored, check_unit, one_scaling, read_no_data, read_stored};
use super::samples::{Decoder, Elevations, largest_unpacked};
use super::tag;
use crate::terrain::dem::Posts;
use crate::terrain::format::ReadContext;
use crate::terrain::parts::{CheckedParts, StoredParts};
use crate::terrain::stored::{Scaling, StoredRaster, StoredStep};
use crate::terrain::window::turn_round;
use crate::terrain::{Dem, DemFile, DemReader, PostLattice, TerrainError, Window};

/// The reader of the GeoTIFF format.
pub(in crate::terrain) struct GeoTiffReader;

impl DemReader for GeoTiffReader {
    fn name(&self) -> &'static str {
        "GeoTIFF"
    }

    fn recognises(&self, beginning: &[u8]) -> bool {
        [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| beginning.starts_with(*magic))
    }

    fn read_bytes(&self, bytes: Vec<u8>, context: &ReadContext) -> Result<Dem, TerrainError> {
        let options = whole_options(bytes.len() as u64);
        read_tiff(&TiffFile::from_bytes_with_options(bytes, options).map_err(unreadable)?, context)
    }

    fn read_path(&self, path: &Path, context: &ReadContext) -> Result<Dem, TerrainError> {
        let length = std::fs::metadata(path).map_err(TerrainError::reading)?.len();
        read_tiff(&TiffFile::open_with_options(path, whole_options(length)).map_err(unreadable)?, context)
    }

    fn open_path(&self, path: &Path, context: ReadContext) -> Result<Box<dyn DemFile>, TerrainError> {
        open_tiff(path, context)
    }
}

/// Reads a GeoTIFF from memory.
///
/// Supports one band of integers or floats, in strips or tiles, with the compressions and predictors of `tiff-reader`
/// (deflate, LZW, `PackBits`, ZSTD, LERC). Scale and offset are applied. Gaps come from the no-data value, a transparency
/// mask, NaN, and blocks that were never written. Rows stored from the south are reversed. A TIFF without a map projection is
/// a local map in metres.
///
/// # Errors
/// [`TerrainError::Damaged`] if the bytes are not a complete TIFF; [`TerrainError::Unsuitable`] if it holds colours, several
/// bands or images, degrees, other units, or a rotated map or none; [`TerrainError::InvalidDem`] if the numbers do not form a
/// raster.
pub fn read_geotiff_bytes(bytes: Vec<u8>) -> Result<Dem, TerrainError> {
    GeoTiffReader.read_bytes(bytes, &ReadContext::default())
}

/// Stricter limits than the defaults: a DEM has few images, and its data must not unpack to more than the file's length can
/// justify.
fn open_options(length: u64) -> OpenOptions {
    OpenOptions {
        parse_budgets: ParseBudgets { max_ifds: 256, max_ifd_entries: 1024, ..ParseBudgets::default() },
        decode_output_bytes: usize::try_from(largest_unpacked(length)).unwrap_or(usize::MAX),
        ..OpenOptions::default()
    }
}

/// When the file is read as a whole, no block is decoded twice, so a cache would only cost memory and time.
fn whole_options(length: u64) -> OpenOptions {
    OpenOptions { block_cache_bytes: 0, ..open_options(length) }
}

fn read_tiff(file: &TiffFile, context: &ReadContext) -> Result<Dem, TerrainError> {
    let images = Images::of(file)?;
    let (decoder, Placement { georeference, south_up, states_metres }) = check_tags(file, &images, context)?;
    let (rows, cols) = (images.layout.height, images.layout.width);
    let posts = match decoder.all(file, &images)? {
        Elevations::Single(mut posts) => {
            turn_round(&mut posts, cols, south_up);
            Posts::Single(posts)
        }
        Elevations::Double(mut posts) => {
            turn_round(&mut posts, cols, south_up);
            Posts::Double(posts)
        }
    };
    let (scaling, step) = (decoder.scaling, step(&images, decoder.scaling));
    StoredRaster { rows, cols, posts, georeference, states_metres, south_up, scaling, step }.finish(context)
}

/// The interpretation of the samples and their position.
fn check_tags(file: &TiffFile, images: &Images<'_>, context: &ReadContext) -> Result<(Decoder, Placement), TerrainError> {
    let ReadContext { no_data: rule, of_any_unit, sidecars } = context;
    let tags = GeoTags::of(images.elevations);
    let own = tags.transform.no_data.as_deref().map(read_no_data).transpose()?.flatten();
    let no_data = sidecars.no_data(*rule, own)?;
    let metadata = images.elevations.tag(tag::GDAL_METADATA).and_then(|tag| tag.value.as_str());
    let Stored { scaling: by_metadata, unit } = metadata.map(read_stored).transpose()?.unwrap_or_default();
    let own = one_scaling(by_metadata, tags.vertical_scaling()?)?;
    let scaling = sidecars.scaling(own)?;
    let placement = tags.place(images.layout.height, sidecars.transform(), scaling)?;
    if !of_any_unit {
        check_unit(&unit, scaling)?;
    }
    Ok((Decoder::new(file, images, no_data, scaling)?, placement))
}

/// The step of the stored samples.
fn step(images: &Images<'_>, scaling: Scaling) -> StoredStep {
    match (images.layout.sample_format, images.layout.bits_per_sample) {
        (3, 32) => StoredStep::Single(scaling),
        (3, _) => StoredStep::Fine,
        _ => StoredStep::Fixed(scaling.scale.abs()),
    }
}

/// A GeoTIFF whose tiles or strips are decoded on demand.
struct OpenGeoTiff {
    file: TiffFile,
    decoder: Decoder,
    lattice: PostLattice,
    south_up: bool,
    step: StoredStep,
}

/// The size of the cache of decoded blocks, in bytes and in blocks: a transect only returns to adjacent blocks.
const KEPT_BYTES: usize = 8 << 20;
const KEPT_BLOCKS: usize = 4;

fn open_tiff(path: &Path, context: ReadContext) -> Result<Box<dyn DemFile>, TerrainError> {
    let length = std::fs::metadata(path).map_err(TerrainError::reading)?.len();
    let mut options = open_options(length);
    let block = {
        let file = TiffFile::open_with_options(path, options).map_err(unreadable)?;
        let images = Images::of(&file)?;
        let (_, Placement { georeference, states_metres, .. }) = check_tags(&file, &images, &context)?;
        let (rows, cols) = (images.layout.height, images.layout.width);
        // Degrees can only be detected from the relief of the whole raster.
        if !states_metres && !context.sidecars.states_map() && georeference.bounds(rows, cols).may_be_degrees() {
            return Ok(Box::new(read_tiff(&file, &context)?));
        }
        block_bytes(&images)
    };
    options.block_cache_bytes = block.saturating_mul(KEPT_BLOCKS).max(KEPT_BYTES);
    let file = TiffFile::open_with_options(path, options).map_err(unreadable)?;
    let images = Images::of(&file)?;
    let (decoder, Placement { georeference, south_up, .. }) = check_tags(&file, &images, &context)?;
    let (rows, cols) = (images.layout.height, images.layout.width);
    let (georeference, _) = context.sidecars.place(georeference, (rows, cols), south_up)?;
    let lattice = PostLattice::new(rows, cols, georeference)?;
    let step = step(&images, decoder.scaling);
    Ok(Box::new(CheckedParts::new(OpenGeoTiff { file, decoder, lattice, south_up, step }, context)))
}

/// Number of bytes of a decoded tile or strip.
fn block_bytes(images: &Images<'_>) -> usize {
    let image = images.elevations;
    let whole = |value: u32| usize::try_from(value).unwrap_or(usize::MAX);
    let (rows, cols) = match (image.tile_height(), image.tile_width()) {
        (Some(rows), Some(cols)) => (whole(rows), whole(cols)),
        _ => (whole(image.rows_per_strip()).min(images.layout.height), images.layout.width),
    };
    rows.saturating_mul(cols).saturating_mul(usize::from(images.layout.bits_per_sample).div_ceil(8))
}

impl StoredParts for OpenGeoTiff {
    fn lattice(&self) -> &PostLattice {
        &self.lattice
    }

    fn south_up(&self) -> bool {
        self.south_up
    }

    fn scaling(&self) -> Scaling {
        self.decoder.scaling
    }

    fn step(&self) -> StoredStep {
        self.step
    }

    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError> {
        let images = Images::of(&self.file)?;
        let stored = window.stored(self.lattice.rows(), self.south_up);
        let mut posts = self.decoder.window(&self.file, &images, stored)?.into_double();
        turn_round(&mut posts, window.cols, self.south_up);
        Ok(posts)
    }
}

/// The position that the tags of a GeoTIFF give a raster with a number of rows.
#[cfg(feature = "gdal")]
pub(in crate::terrain) struct Placed {
    pub(in crate::terrain) georeference: crate::terrain::GeoReference,
    pub(in crate::terrain) south_up: bool,
    pub(in crate::terrain) states_metres: bool,
}

/// Checks the tags alone, without the image.
#[cfg(feature = "gdal")]
pub(in crate::terrain) fn place_by_tags(bytes: Vec<u8>, rows: usize) -> Result<Placed, TerrainError> {
    let options = open_options(bytes.len() as u64);
    let file = TiffFile::from_bytes_with_options(bytes, options).map_err(unreadable)?;
    let Placement { georeference, south_up, states_metres } =
        GeoTags::of(Images::of(&file)?.elevations).place(rows, None, Scaling::NONE)?;
    Ok(Placed { georeference, south_up, states_metres })
}

/// A single image without a place, of which windows are read: a mask beside a raster.
pub(in crate::terrain) struct TiffImage(TiffFile);

impl std::fmt::Debug for TiffImage {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("TiffImage")
    }
}

impl TiffImage {
    /// # Errors
    /// As [`read_geotiff_bytes`], for what makes a TIFF.
    pub(in crate::terrain) fn open(path: &Path) -> Result<Self, TerrainError> {
        let length = std::fs::metadata(path).map_err(TerrainError::reading)?.len();
        let file = TiffFile::open_with_options(path, open_options(length)).map_err(unreadable)?;
        let checked = file.ifds().first().ok_or_else(|| damaged("it has no image".to_owned()))?;
        checked.raster_layout().map_err(|error| damaged(error.to_string()))?;
        Ok(Self(file))
    }

    /// Whether its samples can be those of a mask.
    pub(in crate::terrain) fn is_mask(&self) -> bool {
        self.0.ifds().first().is_some_and(|image| {
            image.samples_per_pixel() == 1 && image.raster_layout().is_ok_and(|layout| layout.bits_per_sample <= 8)
        })
    }

    /// Number of rows and columns.
    pub(in crate::terrain) fn size(&self) -> (usize, usize) {
        let layout = self.0.ifds().first().and_then(|image| image.raster_layout().ok());
        layout.map_or((0, 0), |layout| (layout.height, layout.width))
    }

    /// The samples of a window.
    ///
    /// # Errors
    /// [`TerrainError::Damaged`].
    pub(in crate::terrain) fn bytes(&self, window: Window) -> Result<Vec<u8>, TerrainError> {
        let image = self.0.ifds().first().ok_or_else(|| damaged("it has no image".to_owned()))?;
        super::samples::bytes(&self.0, image, window)
    }
}
