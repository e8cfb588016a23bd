//! Decodes the posts, several rows at a time.

use tiff_reader::{Ifd, RasterLayout, TiffError, TiffFile, TiffSample};

use super::encoding::unreadable;
use super::image::{Images, damaged};
use super::last_strip::with_full_strips;
use crate::terrain::stored::Scaling;
use crate::terrain::{NoData, TerrainError, Window};

/// The least number of rows decoded at once: enough work for the decoder's threads, little memory compared with the raster.
const ROWS_AT_ONCE: usize = 256;

/// The largest ratio of unpacked size to file length, beyond [`FREE_BYTES`]. Rough ground reaches 2 to 4, so a larger ratio
/// means that all but a sixtieth of the raster is empty, or that the file is malicious.
const LARGEST_RATIO: u64 = 256;
const FREE_BYTES: u64 = 64 << 20;

/// TIFF's code for no compression.
const UNCOMPRESSED: u16 = 1;

/// Elevations as decoded from a file: NaN is a gap.
pub(super) enum Elevations {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

/// Converts the samples of an image to elevations.
pub(super) struct Decoder {
    pub(super) no_data: Option<NoData>,
    pub(super) scaling: Scaling,
    /// Rectangles of blocks that were never written, if they mean gaps.
    holes: Vec<Window>,
}

impl Decoder {
    /// # Errors
    /// [`TerrainError::Damaged`] for a declared size that the file's length cannot justify.
    pub(super) fn new(
        file: &TiffFile,
        images: &Images<'_>,
        no_data: Option<NoData>,
        scaling: Scaling,
    ) -> Result<Self, TerrainError> {
        check_size(file, images)?;
        // A block that was never written means the no-data value if there is one, and zeros otherwise.
        let holes = if no_data.is_some() { holes(images) } else { Vec::new() };
        Ok(Self { no_data, scaling, holes })
    }

    /// All posts in the file's order.
    pub(super) fn all(&self, file: &TiffFile, images: &Images<'_>) -> Result<Elevations, TerrainError> {
        let RasterLayout { width, height, .. } = images.layout;
        let whole = |rows, first_row| Window { first_row, first_col: 0, rows, cols: width };
        let step = rows_at_once(images.elevations, height);
        let mut bands = (0..height).step_by(step).map(|first| self.window(file, images, whole(step.min(height - first), first)));
        let mut posts = bands.next().unwrap_or_else(|| Err(damaged("it has no rows".to_owned())))?;
        // Only after the first rows have shown that the file holds data.
        posts.reserve(width * height)?;
        for band in bands {
            posts.append(band?);
        }
        if posts.len() == width * height {
            Ok(posts)
        } else {
            Err(damaged(format!("it holds {} of {} posts", posts.len(), width * height)))
        }
    }

    /// The posts of a window, in rows and columns of the file.
    pub(super) fn window(&self, file: &TiffFile, images: &Images<'_>, window: Window) -> Result<Elevations, TerrainError> {
        let Self { no_data, scaling, .. } = *self;
        let read = Reading { file, image: images.elevations, window };
        let layout = &images.layout;
        if layout.sample_format == 3 && layout.bits_per_sample == 32 && scaling == Scaling::NONE {
            let mut posts = read.samples::<f32>()?;
            if let Some(mark) = no_data.filter(|mark| mark.is_a_number()) {
                posts.iter_mut().filter(|post| mark.is_single(**post)).for_each(|post| *post = f32::NAN);
            }
            self.blank_missing(file, images, window, &mut posts, f32::NAN)?;
            return Ok(Elevations::Single(posts));
        }
        let scaled = |is_mark: bool, sample: f64| if is_mark { f64::NAN } else { scaling.apply(sample) };
        let marks_whole = |sample: i128| no_data.is_some_and(|mark| mark.is_whole(sample));
        #[expect(
            clippy::cast_precision_loss,
            reason = "64-bit samples beyond 2^53 are not elevations and are refused as too large"
        )]
        let mut posts = match (layout.sample_format, layout.bits_per_sample) {
            (1, ..=8) => read.map(|z: u8| scaled(marks_whole(z.into()), z.into())),
            (1, 9..=16) => read.map(|z: u16| scaled(marks_whole(z.into()), z.into())),
            (1, 32) => read.map(|z: u32| scaled(marks_whole(z.into()), z.into())),
            (1, 64) => read.map(|z: u64| scaled(marks_whole(z.into()), z as f64)),
            (2, 8) => read.map(|z: i8| scaled(marks_whole(z.into()), z.into())),
            (2, 16) => read.map(|z: i16| scaled(marks_whole(z.into()), z.into())),
            (2, 32) => read.map(|z: i32| scaled(marks_whole(z.into()), z.into())),
            (2, 64) => read.map(|z: i64| scaled(marks_whole(z.into()), z as f64)),
            (3, 32) => read.map(|z: f32| scaled(no_data.is_some_and(|mark| mark.is_single(z)), z.into())),
            (3, 64) => read.map(|z: f64| scaled(no_data.is_some_and(|mark| mark.is_double(z)), z)),
            (format, bits) => Err(TerrainError::Unsuitable {
                found: format!("samples of {bits} bits in sample format {format}"),
                expected: "integers of 1 to 16, 32 or 64 bits or floats of 32 or 64 bits",
                mend: "gdal_translate -ot Float32 in.tif out.tif".to_owned(),
            }),
        }?;
        self.blank_missing(file, images, window, &mut posts, f64::NAN)?;
        Ok(Elevations::Double(posts))
    }

    /// Sets posts to NaN that are missing by other means than their value: a transparency mask (0: missing) or blocks never
    /// written.
    fn blank_missing<T: Copy>(
        &self,
        file: &TiffFile,
        images: &Images<'_>,
        window: Window,
        posts: &mut [T],
        gap: T,
    ) -> Result<(), TerrainError> {
        if let Some(image) = images.mask {
            let mask = Reading { file, image, window }.samples::<u8>()?;
            for (post, _) in posts.iter_mut().zip(&mask).filter(|(_, shown)| **shown == 0) {
                *post = gap;
            }
        }
        for hole in &self.holes {
            let rows = hole.first_row.max(window.first_row)..(hole.first_row + hole.rows).min(window.first_row + window.rows);
            let first = hole.first_col.clamp(window.first_col, window.first_col + window.cols) - window.first_col;
            let end = (hole.first_col + hole.cols).clamp(window.first_col, window.first_col + window.cols) - window.first_col;
            for row in rows {
                let start = (row - window.first_row) * window.cols;
                if let Some(part) = posts.get_mut(start + first..start + end.max(first)) {
                    part.fill(gap);
                }
            }
        }
        Ok(())
    }
}

impl Elevations {
    fn len(&self) -> usize {
        match self {
            Self::Single(posts) => posts.len(),
            Self::Double(posts) => posts.len(),
        }
    }

    fn reserve(&mut self, posts: usize) -> Result<(), TerrainError> {
        let more = posts.saturating_sub(self.len());
        match self {
            Self::Single(posts) => posts.try_reserve_exact(more),
            Self::Double(posts) => posts.try_reserve_exact(more),
        }
        .map_err(|error| damaged(error.to_string()))
    }

    /// All parts of one image have the same type.
    fn append(&mut self, band: Self) {
        match (self, band) {
            (Self::Single(posts), Self::Single(mut more)) => posts.append(&mut more),
            (Self::Double(posts), Self::Double(mut more)) => posts.append(&mut more),
            (Self::Double(posts), Self::Single(more)) => posts.extend(more.into_iter().map(f64::from)),
            (Self::Single(_), Self::Double(_)) => {}
        }
    }

    pub(super) fn into_double(self) -> Vec<f64> {
        match self {
            Self::Single(posts) => posts.into_iter().map(f64::from).collect(),
            Self::Double(posts) => posts,
        }
    }
}

/// The largest unpacked size accepted for a file of this length.
pub(super) fn largest_unpacked(length: u64) -> u64 {
    length.saturating_mul(LARGEST_RATIO).max(FREE_BYTES)
}

/// Refuses a declared size that the file's length cannot justify, before memory is allocated.
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

/// The 8-bit samples of a window of an image.
pub(super) fn bytes(file: &TiffFile, image: &Ifd, window: Window) -> Result<Vec<u8>, TerrainError> {
    Reading { file, image, window }.samples()
}

/// A window of one image.
struct Reading<'a> {
    file: &'a TiffFile,
    image: &'a Ifd,
    window: Window,
}

impl Reading<'_> {
    fn samples<T: TiffSample>(&self) -> Result<Vec<T>, TerrainError> {
        let Window { first_row, first_col, rows, cols } = self.window;
        let read = |image: &Ifd| self.file.read_window_from_ifd::<T>(image, first_row, first_col, rows, cols);
        let samples =
            read(self.image).or_else(|error| self.with_full_strips(&error).and_then(|image| read(&image).ok()).ok_or(error));
        let samples = samples.map_err(unreadable)?;
        let (samples, _) = samples.into_raw_vec_and_offset();
        if samples.len() == rows * cols {
            Ok(samples)
        } else {
            Err(damaged(format!("it holds {} of {} posts of a window", samples.len(), rows * cols)))
        }
    }

    /// The image with a last strip of full height, if the last strip could not be decoded without.
    fn with_full_strips(&self, error: &TiffError) -> Option<Ifd> {
        let TiffError::DecompressionFailed { index, .. } = error else { return None };
        let layout = self.image.raster_layout().ok()?;
        let is_last = self.image.strip_offsets().is_some_and(|strips| strips.len() == index + 1);
        is_last.then(|| with_full_strips(self.file, self.image, &layout)).flatten()
    }

    fn map<T: TiffSample>(&self, convert: impl Fn(T) -> f64) -> Result<Vec<f64>, TerrainError> {
        Ok(self.samples()?.into_iter().map(convert).collect())
    }
}

/// A multiple of the block height, so that no block is decoded twice.
fn rows_at_once(image: &Ifd, height: usize) -> usize {
    let block = image.tile_height().unwrap_or_else(|| image.rows_per_strip());
    let block = usize::try_from(block).unwrap_or(height).clamp(1, height.max(1));
    block * ROWS_AT_ONCE.div_ceil(block)
}

/// The blocks that were never written.
fn holes(images: &Images<'_>) -> Vec<Window> {
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
        .map(|(block, _)| Window {
            first_row: (block / across).saturating_mul(rows).min(height),
            first_col: (block % across) * cols,
            rows: rows.min(height),
            cols: cols.min(width),
        })
        .filter(|hole| hole.first_row < height)
        .collect()
}
