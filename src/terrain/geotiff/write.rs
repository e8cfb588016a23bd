//! Writes a GeoTIFF.

use std::io::{Cursor, Write};

use tiff_reader::constants::{Compression, ExtraSample, Predictor};
use tiff_reader::{Tag, TagValue};
use tiff_writer::{ImageBuilder, TiffWriteSample, TiffWriter, WriteOptions};

use super::keys::{GeoTags, with_raster_type};
use super::{key, tag};
use crate::terrain::dem::Posts;
use crate::terrain::stored::Scaling;
use crate::terrain::{Dem, GeoReference, TerrainError};

/// Side of a tile, posts: the usual size, and a multiple of 16 as the format requires.
const TILE: usize = 256;

/// Numbers of one type for every post of a raster, one or several per post.
struct Raster<'a, T> {
    rows: usize,
    cols: usize,
    bands: Vec<&'a [T]>,
    /// The value for the parts of the last tiles outside the raster.
    filler: T,
    /// The text that declares the no-data value.
    no_data: &'a str,
    predictor: Predictor,
    /// The names and units of the bands; empty for a raster of elevations.
    names: Vec<(&'a str, &'a str)>,
    georeference: &'a GeoReference,
}

/// A band of a result raster: a name, a unit and a number for every post, row after row from the north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band<'a, T> {
    /// What the numbers mean.
    pub name: &'a str,
    /// Their unit; empty if it is not stated.
    pub unit: &'a str,
    /// The numbers.
    pub samples: &'a [T],
}

/// The numbers of a result raster: one or several bands of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum ResultBands<'a> {
    /// Integers, and the no-data value.
    Int16(Vec<Band<'a, i16>>, i16),
    /// Large integers, and the no-data value.
    Int32(Vec<Band<'a, i32>>, i32),
    /// Floats; NaN is no-data.
    Float32(Vec<Band<'a, f32>>),
}

/// Encodes a result for every post of a map as a GeoTIFF in memory: tiles of 256 posts, deflate, the map as it was read.
///
/// # Errors
/// [`TerrainError::InvalidDem`] if a band does not have `rows * cols` numbers, there is no band, or the raster exceeds the
/// limits of TIFF.
///
/// # Examples
/// ```
/// use chta::quantity::MapPoint;
/// use chta::terrain::{Band, GeoReference, ResultBands, read_geotiff_bytes, result_geotiff_bytes};
/// let map = GeoReference::local(MapPoint::new(5.0, 9.0), 2.0, 2.0)?;
/// let hops = ResultBands::Int16(vec![Band { name: "hops", unit: "", samples: &[0, 1, -1, -32768] }], -32768);
/// let read = read_geotiff_bytes(result_geotiff_bytes(2, 2, &map, &hops)?)?;
/// assert_eq!(read.elevations().collect::<Vec<_>>(), [Some(0.0), Some(1.0), Some(-1.0), None]);
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn result_geotiff_bytes(
    rows: usize,
    cols: usize,
    georeference: &GeoReference,
    bands: &ResultBands<'_>,
) -> Result<Vec<u8>, TerrainError> {
    match bands {
        ResultBands::Int16(bands, no_data) => raster_bytes(&Raster {
            rows,
            cols,
            bands: bands.iter().map(|band| band.samples).collect(),
            filler: *no_data,
            no_data: &no_data.to_string(),
            predictor: Predictor::Horizontal,
            names: bands.iter().map(|band| (band.name, band.unit)).collect(),
            georeference,
        }),
        ResultBands::Int32(bands, no_data) => raster_bytes(&Raster {
            rows,
            cols,
            bands: bands.iter().map(|band| band.samples).collect(),
            filler: *no_data,
            no_data: &no_data.to_string(),
            predictor: Predictor::Horizontal,
            names: bands.iter().map(|band| (band.name, band.unit)).collect(),
            georeference,
        }),
        ResultBands::Float32(bands) => raster_bytes(&Raster {
            rows,
            cols,
            bands: bands.iter().map(|band| band.samples).collect(),
            filler: f32::NAN,
            no_data: "nan",
            predictor: Predictor::FloatingPoint,
            names: bands.iter().map(|band| (band.name, band.unit)).collect(),
            georeference,
        }),
    }
}

/// Writes a DEM as a GeoTIFF: tiles of 256 posts, deflate, float predictor, 32-bit floats if they represent every elevation
/// exactly, else 64-bit floats, gaps as NaN.
///
/// The map projection is written as it was read. So is the transform, unless the raster's rows were reversed or it was moved:
/// then the north-west post becomes the tie point (`PixelIsPoint`), which loses no digit.
///
/// # Errors
/// [`TerrainError::Io`] if `out` cannot be written to; [`TerrainError::InvalidDem`] if the raster exceeds the limits of TIFF.
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
    match dem.posts() {
        Posts::Single(samples) => raster_bytes(&bare(dem, samples, f32::NAN)),
        Posts::Double(samples) => raster_bytes(&bare(dem, samples, f64::NAN)),
    }
}

/// A raster of elevations.
fn bare<'a, T>(dem: &'a Dem, samples: &'a [T], filler: T) -> Raster<'a, T> {
    Raster {
        rows: dem.rows(),
        cols: dem.cols(),
        bands: vec![samples],
        filler,
        no_data: "nan",
        predictor: Predictor::FloatingPoint,
        names: Vec::new(),
        georeference: dem.georeference(),
    }
}

fn raster_bytes<T: TiffWriteSample>(raster: &Raster<'_, T>) -> Result<Vec<u8>, TerrainError> {
    let posts = raster.rows.checked_mul(raster.cols);
    if raster.bands.is_empty() || raster.bands.iter().any(|band| Some(band.len()) != posts) {
        return Err(TerrainError::InvalidDem(format!(
            "the bands have {:?} numbers, expected {} rows times {} columns in each",
            raster.bands.iter().map(|band| band.len()).collect::<Vec<_>>(),
            raster.rows,
            raster.cols
        )));
    }
    let refused = |error: tiff_writer::Error| TerrainError::InvalidDem(format!("the raster cannot be stored in a TIFF: {error}"));
    let mut writer = TiffWriter::new(Cursor::new(Vec::new()), WriteOptions::auto()).map_err(refused)?;
    let handle = writer.add_image(image(raster)?).map_err(refused)?;
    let mut tile = vec![raster.filler; TILE * TILE * raster.bands.len()];
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
    let bands = u16::try_from(raster.bands.len())
        .map_err(|_| TerrainError::InvalidDem(format!("the raster has {} bands, expected fewer than 65536", raster.bands.len())))?;
    let mut image = ImageBuilder::new(side(raster.cols)?, side(raster.rows)?)
        .sample_type::<T>()
        .samples_per_pixel(bands)
        .compression(Compression::Deflate)
        .predictor(raster.predictor)
        .tiles(tile, tile)
        .tag(Tag::new(tag::GDAL_NO_DATA, TagValue::Ascii(raster.no_data.to_owned())));
    if bands > 1 {
        image = image.extra_samples(vec![ExtraSample::Unspecified; usize::from(bands) - 1]);
    }
    if !raster.names.is_empty() {
        image = image.tag(Tag::new(tag::GDAL_METADATA, TagValue::Ascii(band_names(&raster.names))));
    }
    Ok(map_tags(raster.georeference, raster.rows).into_iter().fold(image, ImageBuilder::tag))
}

/// The names and units of bands in GDAL's metadata.
fn band_names(names: &[(&str, &str)]) -> String {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    let item = |(band, (name, unit)): (usize, &(&str, &str))| {
        let name = format!("<Item name=\"DESCRIPTION\" sample=\"{band}\" role=\"description\">{}</Item>", escaped(name));
        if unit.is_empty() {
            return name;
        }
        format!("{name}<Item name=\"UNITTYPE\" sample=\"{band}\" role=\"unittype\">{}</Item>", escaped(unit))
    };
    format!("<GDALMetadata>{}</GDALMetadata>", names.iter().enumerate().map(item).collect::<String>())
}

/// The posts of a tile, with the numbers of a post side by side.
fn fill_tile<T: Copy>(tile: &mut [T], raster: &Raster<'_, T>, first_row: usize, first_col: usize) {
    tile.fill(raster.filler);
    let bands = raster.bands.len();
    let width = TILE.min(raster.cols - first_col);
    for (number, band) in raster.bands.iter().enumerate() {
        let lines = band.chunks_exact(raster.cols).skip(first_row);
        for (to, from) in tile.chunks_exact_mut(TILE * bands).zip(lines) {
            let posts = to.iter_mut().skip(number).step_by(bands);
            for (to, from) in posts.zip(&from[first_col..first_col + width]) {
                *to = *from;
            }
        }
    }
}

/// The tags of the map: the original ones if they still describe the raster, else the north-west post as the tie point.
fn map_tags(map: &GeoReference, rows: usize) -> Vec<Tag> {
    let system = &map.coordinate_system;
    let old = GeoTags { coordinate_system: system.clone(), transform: map.transform_tags.clone() }.place(rows, None, Scaling::NONE);
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
