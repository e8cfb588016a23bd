//! Decoding the posts, a band of rows at a time.

use tiff_reader::{Ifd, RasterLayout, TiffFile, TiffSample};

use super::image::{Images, damaged};
use super::metadata::{NoData, Scaling};
use crate::terrain::TerrainError;

/// Rows decoded at once, at least: enough for the decoder's threads, little beside the raster.
const ROWS_AT_ONCE: usize = 256;

/// A compressed file may hold this many times its own length, and in any case [`FREE_BYTES`]. Rough ground reaches 2 to 4, so more than this
/// is a raster empty but for a sixtieth, or a trap for memory.
const LARGEST_RATIO: u64 = 256;
const FREE_BYTES: u64 = 64 << 20;

/// TIFF's number for no compression.
const UNCOMPRESSED: u16 = 1;

/// Elevations as they come out of a file: NaN is a gap.
pub(super) enum Elevations {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

/// Reads all posts in the file's order.
pub(super) fn read_elevations(
    file: &TiffFile,
    images: &Images<'_>,
    no_data: Option<NoData>,
    scaling: Scaling,
) -> Result<Elevations, TerrainError> {
    check_size(file, images)?;
    let missing = Missing::of(file, images, no_data)?;
    let read = Reading { file, image: images.elevations, layout: &images.layout };
    let layout = &images.layout;
    if layout.sample_format == 3 && layout.bits_per_sample == 32 && scaling == Scaling::NONE {
        let mut posts =
            read.all(|sample: f32| if no_data.is_some_and(|mark| mark.is_single(sample)) { f32::NAN } else { sample })?;
        missing.blank(&mut posts, f32::NAN);
        return Ok(Elevations::Single(posts));
    }
    let scaled = |is_mark: bool, sample: f64| if is_mark { f64::NAN } else { scaling.apply(sample) };
    let marks_whole = |sample: i128| no_data.is_some_and(|mark| mark.is_whole(sample));
    #[expect(clippy::cast_precision_loss, reason = "64-bit samples beyond 2^53 are no elevations and refused by their size")]
    let mut posts = match (layout.sample_format, layout.bits_per_sample) {
        (1, ..=8) => read.all(|z: u8| scaled(marks_whole(z.into()), z.into())),
        (1, 9..=16) => read.all(|z: u16| scaled(marks_whole(z.into()), z.into())),
        (1, 32) => read.all(|z: u32| scaled(marks_whole(z.into()), z.into())),
        (1, 64) => read.all(|z: u64| scaled(marks_whole(z.into()), z as f64)),
        (2, 8) => read.all(|z: i8| scaled(marks_whole(z.into()), z.into())),
        (2, 16) => read.all(|z: i16| scaled(marks_whole(z.into()), z.into())),
        (2, 32) => read.all(|z: i32| scaled(marks_whole(z.into()), z.into())),
        (2, 64) => read.all(|z: i64| scaled(marks_whole(z.into()), z as f64)),
        (3, 32) => read.all(|z: f32| scaled(no_data.is_some_and(|mark| mark.is_single(z)), z.into())),
        (3, 64) => read.all(|z: f64| scaled(no_data.is_some_and(|mark| mark.is_double(z)), z)),
        (format, bits) => Err(TerrainError::Unsuitable {
            found: format!("samples of {bits} bits in sample format {format}"),
            expected: "integers of 1 to 16, 32 or 64 bits or floats of 32 or 64 bits",
            mend: "gdal_translate -ot Float32 in.tif out.tif".to_owned(),
        }),
    }?;
    missing.blank(&mut posts, f64::NAN);
    Ok(Elevations::Double(posts))
}

/// What a file of so many bytes may unpack to.
pub(super) fn largest_unpacked(length: u64) -> u64 {
    length.saturating_mul(LARGEST_RATIO).max(FREE_BYTES)
}

/// Refuses a declared size that the file's length cannot back, before anything is allocated for it.
fn check_size(file: &TiffFile, images: &Images<'_>) -> Result<(), TerrainError> {
    let RasterLayout { width, height, bits_per_sample, .. } = images.layout;
    let length = file.source().len();
    let posts = (width as u64).checked_mul(height as u64);
    let declared = posts.and_then(|posts| posts.checked_mul(u64::from(bits_per_sample))).map(|bits| bits / 8);
    let stored_as_is =
        images.elevations.compression() == UNCOMPRESSED && block_lengths(images.elevations).iter().all(|bytes| *bytes > 0);
    let allowed = if stored_as_is { length } else { largest_unpacked(length) };
    match declared {
        Some(bytes) if bytes <= allowed => Ok(()),
        _ => Err(damaged(format!(
            "it declares {height} rows of {width} posts of {bits_per_sample} bits, which its {length} bytes cannot hold (of a raster that is nearly all no-data, cut out the part that is not with gdal_translate -projwin)"
        ))),
    }
}

/// Encoded lengths of the image's tiles or strips, bytes; 0 for one that was never written.
fn block_lengths(image: &Ifd) -> Vec<u64> {
    let lengths = if image.is_tiled() { image.tile_byte_counts() } else { image.strip_byte_counts() };
    lengths.unwrap_or_default()
}

struct Reading<'a> {
    file: &'a TiffFile,
    image: &'a Ifd,
    layout: &'a RasterLayout,
}

impl Reading<'_> {
    fn all<T: TiffSample, U>(&self, convert: impl Fn(T) -> U) -> Result<Vec<U>, TerrainError> {
        let RasterLayout { width, height, .. } = *self.layout;
        let mut posts = Vec::new();
        let step = rows_at_once(self.image, height);
        for first in (0..height).step_by(step) {
            let rows = step.min(height - first);
            let band = self
                .file
                .read_window_from_ifd::<T>(self.image, first, 0, rows, width)
                .map_err(|error| damaged(error.to_string()))?;
            // Not before the first rows have shown that the file holds any.
            posts.try_reserve_exact((width * height).saturating_sub(posts.len())).map_err(|error| damaged(error.to_string()))?;
            posts.extend(band.into_iter().map(&convert));
        }
        if posts.len() == width * height {
            Ok(posts)
        } else {
            Err(damaged(format!("it holds {} of {} posts", posts.len(), width * height)))
        }
    }
}

/// Whole blocks, so that none is decoded twice.
fn rows_at_once(image: &Ifd, height: usize) -> usize {
    let block = image.tile_height().unwrap_or_else(|| image.rows_per_strip());
    let block = usize::try_from(block).unwrap_or(height).clamp(1, height.max(1));
    block * ROWS_AT_ONCE.div_ceil(block)
}

/// Posts that the file leaves out otherwise than by their value.
struct Missing {
    /// Of the transparency mask: one byte per post, 0 where there is nothing.
    mask: Option<Vec<u8>>,
    /// Rectangles of blocks that were never written: first row, first column, rows, columns.
    holes: Vec<[usize; 4]>,
    width: usize,
    height: usize,
}

impl Missing {
    fn of(file: &TiffFile, images: &Images<'_>, no_data: Option<NoData>) -> Result<Self, TerrainError> {
        let RasterLayout { width, height, .. } = images.layout;
        let mask = match images.mask {
            Some(image) => {
                let layout = image.raster_layout().map_err(|error| damaged(error.to_string()))?;
                Some(Reading { file, image, layout: &layout }.all(|shown: u8| shown)?)
            }
            None => None,
        };
        // A block that was never written stands for the no-data value where there is one, for zeros where there is none.
        let holes = if no_data.is_some() { holes(images) } else { Vec::new() };
        Ok(Self { mask, holes, width, height })
    }

    fn blank<T: Copy>(&self, posts: &mut [T], gap: T) {
        if let Some(mask) = &self.mask {
            for (post, _) in posts.iter_mut().zip(mask).filter(|(_, shown)| **shown == 0) {
                *post = gap;
            }
        }
        for &[first_row, first_col, rows, cols] in &self.holes {
            for row in first_row..(first_row + rows).min(self.height) {
                let start = row * self.width;
                let end = (first_col + cols).min(self.width);
                if let Some(part) = posts.get_mut(start + first_col.min(end)..start + end) {
                    part.fill(gap);
                }
            }
        }
    }
}

fn holes(images: &Images<'_>) -> Vec<[usize; 4]> {
    let image = images.elevations;
    let RasterLayout { width, height, .. } = images.layout;
    let whole = |value: u32| usize::try_from(value).unwrap_or(usize::MAX).max(1);
    let (cols, rows) = match (image.tile_width(), image.tile_height()) {
        (Some(cols), Some(rows)) => (whole(cols), whole(rows)),
        _ => (width, whole(image.rows_per_strip()).min(height)),
    };
    let across = width.div_ceil(cols);
    let empty = block_lengths(image).into_iter().enumerate().filter(|(_, length)| *length == 0);
    empty
        .map(|(block, _)| [(block / across).saturating_mul(rows), (block % across) * cols, rows, cols])
        .filter(|hole| hole[0] < height)
        .collect()
}
