//! GeoTIFF: `read` selects and checks the image, `samples` decodes it, `keys` interprets its map, `write` writes files.
//!
//! Only this module uses the crates `tiff-reader` and `tiff-writer`.

mod encoding;
mod image;
mod keys;
mod last_strip;
mod metadata;
mod read;
mod samples;
mod units;
mod write;

pub(super) use keys::{double_key, short_key, text_key};
pub use read::read_geotiff_bytes;
pub(super) use read::{GeoTiffReader, TiffImage};
#[cfg(feature = "gdal")]
pub(super) use read::{Placed, place_by_tags};
pub use write::{Band, ResultBands, geotiff_bytes, result_geotiff_bytes, write_geotiff};

/// Numbers of the tags that are read or written here (TIFF 6.0; OGC GeoTIFF 1.1, annex; GDAL's own).
mod tag {
    pub(super) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(super) const EXTRA_SAMPLES: u16 = 338;
    pub(super) const PIXEL_SCALE: u16 = 33550;
    pub(super) const TIE_POINTS: u16 = 33922;
    pub(super) const TRANSFORMATION: u16 = 34264;
    pub(super) const KEY_DIRECTORY: u16 = 34735;
    pub(super) const DOUBLE_PARAMETERS: u16 = 34736;
    pub(super) const ASCII_PARAMETERS: u16 = 34737;
    pub(super) const GDAL_METADATA: u16 = 42112;
    pub(super) const GDAL_NO_DATA: u16 = 42113;
}

/// Numbers of the `GeoKeys` and of their values (OGC GeoTIFF 1.1).
mod key {
    pub(super) const MODEL_TYPE: u16 = 1024;
    pub(super) const RASTER_TYPE: u16 = 1025;
    pub(super) const CITATION: u16 = 1026;
    pub(super) const GEOGRAPHIC_CITATION: u16 = 2049;
    pub(super) const GEOGRAPHIC_CRS: u16 = 2048;
    pub(super) const PROJECTED_CRS: u16 = 3072;
    pub(super) const PROJECTED_CITATION: u16 = 3073;
    pub(super) const LINEAR_UNITS: u16 = 3076;
    pub(super) const LINEAR_UNIT_SIZE: u16 = 3077;
    pub(super) const VERTICAL_CRS: u16 = 4096;
    pub(super) const VERTICAL_CITATION: u16 = 4097;
    pub(super) const VERTICAL_UNITS: u16 = 4099;

    pub(super) const UNDEFINED: u16 = 0;
    pub(super) const PROJECTED: u16 = 1;
    pub(super) const GEOGRAPHIC: u16 = 2;
    pub(super) const GEOCENTRIC: u16 = 3;
    pub(super) const PIXEL_IS_AREA: u16 = 1;
    pub(super) const PIXEL_IS_POINT: u16 = 2;
    pub(super) const METRE: u16 = 9001;
    pub(super) const USER_DEFINED: u16 = 32767;
}
