//! Selects the image of a TIFF that holds the elevations, and checks that it can hold elevations.

use tiff_reader::{Ifd, RasterLayout, TiffFile};

use super::encoding::{refuse_undecodable, unreadable};
use super::tag;
use crate::terrain::TerrainError;

/// Bits of `NewSubfileType`: a reduced image, a page of several, a transparency mask.
const REDUCED: u32 = 1;
const MASK: u32 = 4;

/// The images that are used.
pub(super) struct Images<'a> {
    pub(super) elevations: &'a Ifd,
    pub(super) layout: RasterLayout,
    /// A mask of the same size: 0 means no elevation.
    pub(super) mask: Option<&'a Ifd>,
}

impl<'a> Images<'a> {
    /// The one full-size image, with its mask.
    pub(super) fn of(file: &'a TiffFile) -> Result<Self, TerrainError> {
        let full: Vec<&Ifd> = file.ifds().iter().filter(|image| kind(image) & (REDUCED | MASK) == 0).collect();
        let elevations = match full[..] {
            [only] => only,
            [] => return Err(damaged("it has no image of full size".to_owned())),
            [..] => {
                return Err(TerrainError::Unsuitable {
                    found: format!("{} images in one file", full.len()),
                    expected: "one",
                    mend: "gdal_translate GTIFF_DIR:1:in.tif out.tif (or whichever image holds the elevations)".to_owned(),
                });
            }
        };
        refuse_colours(elevations)?;
        refuse_undecodable(elevations)?;
        let layout = elevations.raster_layout().map_err(unreadable)?;
        let mask = file.ifds().iter().find(|image| {
            kind(image) & (REDUCED | MASK) == MASK && image.width() == elevations.width() && image.height() == elevations.height()
        });
        if let Some(mask) = mask {
            refuse_undecodable(mask)?;
        }
        Ok(Self { elevations, layout, mask })
    }
}

pub(super) fn damaged(reason: String) -> TerrainError {
    TerrainError::Damaged { format: "TIFF", reason }
}

fn kind(image: &Ifd) -> u32 {
    image.tag(tag::NEW_SUBFILE_TYPE).and_then(|tag| tag.value.as_u32()).unwrap_or(0)
}

/// Whether the last band is stated to be opacity (`ExtraSamples` 1 or 2).
fn has_alpha(image: &Ifd) -> bool {
    let extra = image.tag(tag::EXTRA_SAMPLES).and_then(|tag| tag.value.as_u16_slice().map(<[u16]>::to_vec));
    extra.is_some_and(|extra| extra.last().is_some_and(|kind| matches!(kind, 1 | 2)))
}

/// One band of numbers can be elevations; colours, palettes and negatives are pictures.
fn refuse_colours(image: &Ifd) -> Result<(), TerrainError> {
    let bands = image.samples_per_pixel();
    let (found, mend) = match image.photometric_interpretation().unwrap_or(1) {
        2 => (format!("an RGB picture of {bands} bands"), "gdal_translate -b BAND -co PHOTOMETRIC=MINISBLACK in.tif out.tif"),
        5..=10 => {
            (format!("a colour picture of {bands} bands"), "gdal_translate -b BAND -co PHOTOMETRIC=MINISBLACK in.tif out.tif")
        }
        3 => (
            "a picture with a colour palette".to_owned(),
            "use the product's elevation file instead of its picture (a palette's numbers are colours)",
        ),
        0 => (
            "a picture whose samples count darkness (WhiteIsZero)".to_owned(),
            "gdal_translate -co PHOTOMETRIC=MINISBLACK in.tif out.tif, if its stored numbers are elevations",
        ),
        4 => (
            "a transparency mask".to_owned(),
            "use the file of the elevations; if the stored numbers are elevations: gdal_translate -co PHOTOMETRIC=MINISBLACK in.tif \
             out.tif",
        ),
        other if other > 10 => (
            format!("a picture with photometric interpretation {other} (such as raw camera data)"),
            "gdal_translate -b 1 -co PHOTOMETRIC=MINISBLACK in.tif out.tif, if its stored numbers are elevations",
        ),
        _ if bands > 1 && has_alpha(image) => (
            format!("{bands} bands, of which the last marks the valid posts (alpha)"),
            "gdal_translate -b 1 -mask 2 --config GDAL_TIFF_INTERNAL_MASK YES in.tif out.tif (the elevations' band, and that of the marks)",
        ),
        _ if bands > 1 => (
            format!("{bands} bands"),
            "gdal_translate -b 1 in.tif out.tif (or whichever band holds the elevations; if another band marks the valid posts, keep it with \
             -mask BAND --config GDAL_TIFF_INTERNAL_MASK YES, else missing posts become ground)",
        ),
        _ => return Ok(()),
    };
    Err(TerrainError::Unsuitable { found, expected: "one band of elevations", mend: mend.to_owned() })
}
