//! Rasters read where they are needed.

use super::{Dem, PostLattice, TerrainError};

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

    /// Where these posts stand in a file of so many rows, which may begin with the southernmost.
    pub(super) const fn stored(self, of_rows: usize, south_up: bool) -> Self {
        let first_row = if south_up { of_rows - self.first_row - self.rows } else { self.first_row };
        Self { first_row, ..self }
    }
}

/// Puts the northernmost row first where the southernmost is stored first.
pub(super) fn turn_round<T>(posts: &mut [T], cols: usize, south_up: bool) {
    if south_up {
        posts.reverse();
        posts.chunks_mut(cols).for_each(<[T]>::reverse);
    }
}

/// A DEM that is open: its place is known, its posts are read when asked for.
pub trait DemFile {
    /// Where all posts lie.
    fn lattice(&self) -> &PostLattice;

    /// The elevations of a window inside the raster, row after row from the north, NaN for gaps.
    ///
    /// # Errors
    /// [`TerrainError`] where the file cannot be read or is damaged there, or holds what is no elevation.
    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError>;
}

impl DemFile for Dem {
    fn lattice(&self) -> &PostLattice {
        self.lattice()
    }

    fn window(&self, Window { first_row, first_col, rows, cols }: Window) -> Result<Vec<f64>, TerrainError> {
        let posts = (first_row..first_row + rows).flat_map(|row| (first_col..first_col + cols).map(move |col| (row, col)));
        Ok(posts.map(|(row, col)| self.elevation(row, col).unwrap_or(f64::NAN)).collect())
    }
}

/// What a slice asks of a terrain.
pub(super) trait Posts {
    fn lattice(&self) -> &PostLattice;
    fn elevation(&self, row: usize, col: usize) -> Option<f64>;
}

impl Posts for Dem {
    fn lattice(&self) -> &PostLattice {
        self.lattice()
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
    fn lattice(&self) -> &PostLattice {
        self.file.lattice()
    }

    fn elevation(&self, row: usize, col: usize) -> Option<f64> {
        let index = self.window.index(row, col)?;
        self.elevations_m.get(index).copied().filter(|z_m| !z_m.is_nan())
    }
}
