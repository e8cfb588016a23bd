//! Rasters read where they are needed.

use super::{Dem, GeoReference, MapBounds, TerrainError};

/// A rectangle of posts, counted from the north-west.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Northernmost row.
    pub first_row: usize,
    /// Westernmost column.
    pub first_col: usize,
    /// How many rows.
    pub rows: usize,
    /// How many columns.
    pub cols: usize,
}

impl Window {
    /// The place of a post among the window's own, row after row; `None` outside.
    fn index(&self, row: usize, col: usize) -> Option<usize> {
        let (row, col) = (row.checked_sub(self.first_row)?, col.checked_sub(self.first_col)?);
        (row < self.rows && col < self.cols).then_some(row * self.cols + col)
    }
}

/// A DEM that is open: its place is known, its posts are read when asked for.
pub trait DemFile {
    /// Number of rows, north to south.
    fn rows(&self) -> usize;

    /// Number of columns, west to east.
    fn cols(&self) -> usize;

    /// Where the posts lie.
    fn georeference(&self) -> &GeoReference;

    /// The elevations of a window inside the raster, row after row from the north, NaN for gaps.
    ///
    /// # Errors
    /// [`TerrainError`] where the file cannot be read or is damaged there, or holds what is no elevation.
    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError>;
}

impl DemFile for Dem {
    fn rows(&self) -> usize {
        self.rows()
    }

    fn cols(&self) -> usize {
        self.cols()
    }

    fn georeference(&self) -> &GeoReference {
        self.georeference()
    }

    fn window(&self, Window { first_row, first_col, rows, cols }: Window) -> Result<Vec<f64>, TerrainError> {
        let posts = (first_row..first_row + rows).flat_map(|row| (first_col..first_col + cols).map(move |col| (row, col)));
        Ok(posts.map(|(row, col)| self.elevation(row, col).unwrap_or(f64::NAN)).collect())
    }
}

/// What a slice asks of a terrain.
pub(super) trait Posts {
    fn rows(&self) -> usize;
    fn cols(&self) -> usize;
    fn georeference(&self) -> &GeoReference;
    fn elevation(&self, row: usize, col: usize) -> Option<f64>;

    fn bounds(&self) -> MapBounds {
        self.georeference().bounds(self.rows(), self.cols())
    }
}

impl Posts for Dem {
    fn rows(&self) -> usize {
        self.rows()
    }

    fn cols(&self) -> usize {
        self.cols()
    }

    fn georeference(&self) -> &GeoReference {
        self.georeference()
    }

    fn elevation(&self, row: usize, col: usize) -> Option<f64> {
        self.elevation(row, col)
    }
}

/// One window's posts under the numbers of the whole raster; outside the window there are none.
pub(super) struct Part<'a> {
    file: &'a dyn DemFile,
    window: Window,
    elevations_m: Vec<f64>,
}

impl<'a> Part<'a> {
    /// No posts yet: enough to know where the lattice lies.
    pub(super) fn none_of(file: &'a dyn DemFile) -> Self {
        Self { file, window: Window { first_row: 0, first_col: 0, rows: 0, cols: 0 }, elevations_m: Vec::new() }
    }

    pub(super) fn of(file: &'a dyn DemFile, window: Window) -> Result<Self, TerrainError> {
        let elevations_m = file.window(window)?;
        for (index, z_m) in elevations_m.iter().enumerate() {
            super::dem::check_elevation(*z_m, window.first_row + index / window.cols, window.first_col + index % window.cols)?;
        }
        Ok(Self { file, window, elevations_m })
    }
}

impl Posts for Part<'_> {
    fn rows(&self) -> usize {
        self.file.rows()
    }

    fn cols(&self) -> usize {
        self.file.cols()
    }

    fn georeference(&self) -> &GeoReference {
        self.file.georeference()
    }

    fn elevation(&self, row: usize, col: usize) -> Option<f64> {
        let index = self.window.index(row, col)?;
        self.elevations_m.get(index).copied().filter(|z_m| !z_m.is_nan())
    }
}
