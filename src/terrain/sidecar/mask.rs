//! A mask beside a raster: a TIFF of its size, 0 where there is no elevation.

use std::path::Path;

use super::refused;
use crate::terrain::geotiff::TiffImage;
use crate::terrain::{TerrainError, Window};

/// An open mask, of which windows are read.
#[derive(Debug)]
pub(super) struct MaskFile(TiffImage);

impl MaskFile {
    /// # Errors
    /// [`TerrainError::Sidecar`] if the file is not a TIFF of one band of 1 to 8 bits.
    pub(super) fn open(path: &Path) -> Result<Self, TerrainError> {
        let not = |reason: String| {
            refused(
                path,
                format!(
                    "it cannot be read as a mask ({reason}), expected a TIFF of one band, 0 where there is no elevation; write the raster \
                     with its mask in one file by: gdal_translate --config GDAL_TIFF_INTERNAL_MASK YES -co TILED=YES -mask mask in.tif out.tif, \
                     or remove this file"
                ),
            )
        };
        let image = TiffImage::open(path).map_err(|error| not(error.to_string()))?;
        if image.is_mask() { Ok(Self(image)) } else { Err(not("it has several bands, or samples of more than 8 bits".to_owned())) }
    }

    /// Number of rows and columns.
    pub(super) fn size(&self) -> (usize, usize) {
        self.0.size()
    }

    /// Whether each post of a window of the file is valid.
    pub(super) fn window(&self, window: Window) -> Result<Vec<bool>, String> {
        let samples = self.0.bytes(window).map_err(|error| format!("{error}; remove this file, or write it again"))?;
        Ok(samples.into_iter().map(|shown| shown != 0).collect())
    }
}
