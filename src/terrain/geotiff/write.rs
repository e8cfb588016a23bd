//! Writing a GeoTIFF.

use std::io::{Cursor, Write};

use tiff_reader::constants::{Compression, Predictor};
use tiff_reader::{Tag, TagValue};
use tiff_writer::{ImageBuilder, TiffWriteSample, TiffWriter, WriteOptions};

use super::keys::{GeoTags, with_raster_type};
use super::{key, tag};
use crate::terrain::dem::Posts;
use crate::terrain::{Dem, GeoReference, TerrainError};

/// Side of a tile, posts: the usual one, a multiple of 16 as the format asks.
const TILE: usize = 256;

/// A raster of floats that goes with a [`GeoReference`].
struct Raster<'a, T> {
    rows: usize,
    cols: usize,
    samples: &'a [T],
    /// Fills what sticks out of the raster in its last tiles.
    filler: T,
    georeference: &'a GeoReference,
}

/// Writes a DEM as a GeoTIFF: tiles of 256 posts, deflate, float predictor, 32-bit floats where they hold every elevation exactly and
/// 64-bit floats otherwise, gaps as NaN.
///
/// The map projection is written back as it was read. So is the transform, unless the raster was turned round or moved: then the
/// north-west post itself becomes the tie point (`PixelIsPoint`), which loses no digit.
///
/// # Errors
/// [`TerrainError::Io`] where `out` refuses; [`TerrainError::InvalidDem`] where the raster is beyond what TIFF can hold.
pub fn write_geotiff(dem: &Dem, mut out: impl Write) -> Result<(), TerrainError> {
    out.write_all(&geotiff_bytes(dem)?).and_then(|()| out.flush()).map_err(TerrainError::writing)
}

/// The same in memory.
///
/// # Errors
/// As [`write_geotiff`].
///
/// # Examples
/// ```
/// use chta::terrain::{SyntheticTerrain, geotiff_bytes, read_geotiff_bytes, synthesise};
/// let dem = synthesise(&SyntheticTerrain { rows: 20, cols: 30, ..SyntheticTerrain::default() })?;
/// let again = read_geotiff_bytes(geotiff_bytes(&dem)?)?;
/// assert!(again.elevations().eq(dem.elevations()));
/// assert_eq!(again.georeference().north_west(), dem.georeference().north_west());
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn geotiff_bytes(dem: &Dem) -> Result<Vec<u8>, TerrainError> {
    let (rows, cols, georeference) = (dem.rows(), dem.cols(), dem.georeference());
    match dem.posts() {
        Posts::Single(samples) => raster_bytes(&Raster { rows, cols, samples, filler: f32::NAN, georeference }),
        Posts::Double(samples) => raster_bytes(&Raster { rows, cols, samples, filler: f64::NAN, georeference }),
    }
}

fn raster_bytes<T: TiffWriteSample>(raster: &Raster<'_, T>) -> Result<Vec<u8>, TerrainError> {
    let refused = |error: tiff_writer::Error| TerrainError::InvalidDem(format!("the raster does not go into a TIFF: {error}"));
    let mut writer = TiffWriter::new(Cursor::new(Vec::new()), WriteOptions::auto()).map_err(refused)?;
    let handle = writer.add_image(image(raster)?).map_err(refused)?;
    let mut tile = vec![raster.filler; TILE * TILE];
    let across = raster.cols.div_ceil(TILE);
    for block in 0..across * raster.rows.div_ceil(TILE) {
        fill_tile(&mut tile, raster, (block / across) * TILE, (block % across) * TILE);
        writer.write_block(&handle, block, &tile).map_err(refused)?;
    }
    Ok(writer.finish().map_err(refused)?.into_inner())
}

fn image<T: TiffWriteSample>(raster: &Raster<'_, T>) -> Result<ImageBuilder, TerrainError> {
    let side = |posts: usize| {
        u32::try_from(posts)
            .map_err(|_| TerrainError::InvalidDem(format!("the raster has {posts} rows or columns, expected fewer than 2^32")))
    };
    let tile = side(TILE)?;
    let image = ImageBuilder::new(side(raster.cols)?, side(raster.rows)?)
        .sample_type::<T>()
        .compression(Compression::Deflate)
        .predictor(Predictor::FloatingPoint)
        .tiles(tile, tile)
        .tag(Tag::new(tag::GDAL_NO_DATA, TagValue::Ascii("nan".to_owned())));
    Ok(map_tags(raster.georeference, raster.rows).into_iter().fold(image, ImageBuilder::tag))
}

fn fill_tile<T: Copy>(tile: &mut [T], raster: &Raster<'_, T>, first_row: usize, first_col: usize) {
    tile.fill(raster.filler);
    let width = TILE.min(raster.cols - first_col);
    let lines = raster.samples.chunks_exact(raster.cols).skip(first_row);
    for (to, from) in tile.chunks_exact_mut(TILE).zip(lines) {
        to[..width].copy_from_slice(&from[first_col..first_col + width]);
    }
}

/// The tags of the map: as they were where they still say the same, else with the north-west post as the tie point.
fn map_tags(map: &GeoReference, rows: usize) -> Vec<Tag> {
    let system = &map.coordinate_system;
    let old = GeoTags { coordinate_system: system.clone(), transform: map.transform_tags.clone() }.place(rows);
    let still_true = old.is_ok_and(|placement| !placement.south_up && placement.georeference == *map);
    let mut tags = Vec::new();
    let directory = if still_true {
        let transform = &map.transform_tags;
        tags.extend(doubles(tag::PIXEL_SCALE, &transform.pixel_scale));
        tags.extend(doubles(tag::TIE_POINTS, &transform.tie_points));
        tags.extend(doubles(tag::TRANSFORMATION, &transform.transformation));
        system.key_directory.clone()
    } else {
        tags.extend(doubles(tag::PIXEL_SCALE, &[map.dx_m(), map.dy_m(), 0.0]));
        tags.extend(doubles(tag::TIE_POINTS, &[0.0, 0.0, 0.0, map.north_west().x, map.north_west().y, 0.0]));
        with_raster_type(&system.key_directory, key::PIXEL_IS_POINT)
    };
    if !directory.is_empty() {
        tags.push(Tag::new(tag::KEY_DIRECTORY, TagValue::Short(directory)));
    }
    tags.extend(doubles(tag::DOUBLE_PARAMETERS, &system.double_parameters));
    if !system.ascii_parameters.is_empty() {
        tags.push(Tag::new(tag::ASCII_PARAMETERS, TagValue::Ascii(system.ascii_parameters.clone())));
    }
    tags
}

fn doubles(code: u16, values: &[f64]) -> Option<Tag> {
    (!values.is_empty()).then(|| Tag::new(code, TagValue::Double(values.to_vec())))
}
