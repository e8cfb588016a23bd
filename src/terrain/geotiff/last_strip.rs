//! A last strip that is stored at the height of the others.
//!
//! TIFF lets the last strip have fewer rows; some writers (GDAL, for rows that were only filled) store all rows of it, of which those below
//! the image have no meaning. The decoder of `tiff-reader` takes the rest for too much data in compressed strips. For such an image its
//! directory is read again with a height of whole strips.

use tiff_reader::header::TiffHeader;
use tiff_reader::ifd::parse_ifd_at;
use tiff_reader::source::TiffSource;
use tiff_reader::{ByteOrder, Ifd, RasterLayout, TiffError, TiffFile};

const IMAGE_LENGTH: u16 = 257;
/// The longest strip for which this is tried, bytes: a strip of GDAL has some 8 KiB, and one of a whole image ends with it.
const LONGEST_STRIP: usize = 64 << 20;

/// The image with a last strip of full height, if it has strips and its last one is lower.
pub(super) fn with_full_strips(file: &TiffFile, image: &Ifd, layout: &RasterLayout) -> Option<Ifd> {
    let rows = image.rows_per_strip();
    let height = image.height();
    let strip_bytes = usize::try_from(rows).ok()?.checked_mul(layout.checked_row_bytes().ok()?)?;
    if image.is_tiled() || rows == 0 || height.is_multiple_of(rows) || strip_bytes > LONGEST_STRIP {
        return None;
    }
    let full = height.div_ceil(rows).checked_mul(rows)?;
    let source = file.source();
    let header = TiffHeader::parse(&source.read_exact_at(0, usize::try_from(source.len().min(16)).ok()?).ok()?).ok()?;
    let patched = Patched::new(source, &header, image.offset(), full)?;
    parse_ifd_at(&patched, &header, image.offset()).ok()
}

/// A source in which one entry of a directory is another.
struct Patched<'a> {
    source: &'a dyn TiffSource,
    at: u64,
    entry: Vec<u8>,
}

impl<'a> Patched<'a> {
    /// With another height of the image whose directory begins at an offset.
    fn new(source: &'a dyn TiffSource, header: &TiffHeader, directory: u64, height: u32) -> Option<Self> {
        let big = header.is_bigtiff();
        let (count_bytes, entry_bytes) = if big { (8, 20) } else { (2, 12) };
        let number = |bytes: &[u8]| {
            let join = |all: u64, byte: &u8| (all << 8) | u64::from(*byte);
            match header.byte_order {
                ByteOrder::LittleEndian => bytes.iter().rev().fold(0, join),
                ByteOrder::BigEndian => bytes.iter().fold(0, join),
            }
        };
        let two = |value: u16| if number(&[1, 0]) == 1 { value.to_le_bytes() } else { value.to_be_bytes() };
        let four = |value: u32| if number(&[1, 0]) == 1 { value.to_le_bytes() } else { value.to_be_bytes() };
        let eight = |value: u64| if number(&[1, 0]) == 1 { value.to_le_bytes() } else { value.to_be_bytes() };
        let entries = number(&source.read_exact_at(directory, count_bytes).ok()?);
        let at = (0..entries)
            .map(|entry| directory + count_bytes as u64 + entry * entry_bytes)
            .find(|at| source.read_exact_at(*at, 2).is_ok_and(|tag| number(&tag) == u64::from(IMAGE_LENGTH)))?;
        // Type 4: an integer of 32 bits.
        let mut entry = [two(IMAGE_LENGTH), two(4)].concat();
        if big {
            entry.extend(eight(1));
            entry.extend(four(height));
            entry.extend([0; 4]);
        } else {
            entry.extend(four(1));
            entry.extend(four(height));
        }
        Some(Self { source, at, entry })
    }
}

impl TiffSource for Patched<'_> {
    fn len(&self) -> u64 {
        self.source.len()
    }

    fn read_exact_at(&self, offset: u64, len: usize) -> Result<Vec<u8>, TiffError> {
        let mut bytes = self.source.read_exact_at(offset, len)?;
        for (byte, place) in bytes.iter_mut().zip(offset..) {
            let inside = place.checked_sub(self.at).and_then(|index| self.entry.get(usize::try_from(index).ok()?));
            *byte = inside.copied().unwrap_or(*byte);
        }
        Ok(bytes)
    }
}
