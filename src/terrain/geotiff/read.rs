//! Reading a GeoTIFF.

use std::path::Path;

use tiff_reader::ifd::ParseBudgets;
use tiff_reader::{OpenOptions, TiffError, TiffFile};

use super::image::{Images, damaged};
use super::keys::{GeoTags, Placement};
use super::metadata::{NoData, Scaling, read_scaling};
use super::samples::{Elevations, largest_unpacked, read_elevations};
use super::tag;
use crate::terrain::georeference::refuse_degrees;
use crate::terrain::{Dem, DemReader, TerrainError};

/// GeoTIFF as a format.
pub(in crate::terrain) struct GeoTiffReader;

impl DemReader for GeoTiffReader {
    fn name(&self) -> &'static str {
        "GeoTIFF"
    }

    fn recognises(&self, beginning: &[u8]) -> bool {
        [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| beginning.starts_with(*magic))
    }

    fn read_bytes(&self, bytes: Vec<u8>) -> Result<Dem, TerrainError> {
        read_geotiff_bytes(bytes)
    }

    fn read_path(&self, path: &Path) -> Result<Dem, TerrainError> {
        let length = std::fs::metadata(path).map_err(TerrainError::reading)?.len();
        read_tiff(&TiffFile::open_with_options(path, open_options(length)).map_err(open_error)?)
    }
}

/// Reads a GeoTIFF held in memory.
///
/// One band of integers or floats, in strips or tiles, in the compressions and predictors that `tiff-reader` knows (deflate, LZW,
/// `PackBits`, ZSTD, LERC); scale and offset applied; gaps from the no-data value, from a transparency mask, from NaN and from
/// blocks that were never written. Rows stored from the south are turned round. A TIFF without a map projection is a local map in metres.
///
/// # Errors
/// [`TerrainError::Damaged`] where the bytes are no whole TIFF; [`TerrainError::Unsuitable`] where they are, but hold colours, several
/// bands or images, degrees, other units, a rotated map or none; [`TerrainError::InvalidDem`] where the numbers make no raster.
pub fn read_geotiff_bytes(bytes: Vec<u8>) -> Result<Dem, TerrainError> {
    let options = open_options(bytes.len() as u64);
    read_tiff(&TiffFile::from_bytes_with_options(bytes, options).map_err(open_error)?)
}

/// Tighter than the defaults: a DEM has a handful of images, and nothing in it unpacks to more than its length can hold.
fn open_options(length: u64) -> OpenOptions {
    OpenOptions {
        parse_budgets: ParseBudgets { max_ifds: 256, max_ifd_entries: 1024, ..ParseBudgets::default() },
        decode_output_bytes: usize::try_from(largest_unpacked(length)).unwrap_or(usize::MAX),
        ..OpenOptions::default()
    }
}

fn open_error(error: TiffError) -> TerrainError {
    match error {
        TiffError::Io(reason, _) => TerrainError::reading(reason),
        other => damaged(other.to_string()),
    }
}

fn read_tiff(file: &TiffFile) -> Result<Dem, TerrainError> {
    let images = Images::of(file)?;
    let tags = GeoTags::of(images.elevations);
    let no_data = tags.transform.no_data.as_deref().map(NoData::parse).transpose()?.flatten();
    let metadata = images.elevations.tag(tag::GDAL_METADATA).and_then(|tag| tag.value.as_str());
    let scaling = metadata.map_or(Ok(Scaling::NONE), read_scaling)?;
    let (rows, cols) = (images.layout.height, images.layout.width);
    let Placement { georeference, south_up, states_metres } = tags.place(rows)?;
    let dem = match read_elevations(file, &images, no_data, scaling)? {
        Elevations::Single(mut posts) => {
            turn_round(&mut posts, cols, south_up);
            Dem::from_single(rows, cols, posts, georeference)?
        }
        Elevations::Double(mut posts) => {
            turn_round(&mut posts, cols, south_up);
            Dem::new(rows, cols, posts, georeference)?
        }
    };
    if !states_metres {
        refuse_degrees(&dem)?;
    }
    Ok(dem)
}

/// The last row first.
fn turn_round<T>(posts: &mut [T], cols: usize, south_up: bool) {
    if south_up {
        posts.reverse();
        posts.chunks_mut(cols).for_each(<[T]>::reverse);
    }
}
