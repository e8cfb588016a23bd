//! Rasters of which parts are read on demand.

use super::{Dem, PostLattice, TerrainError};

/// A rectangle of posts, with rows and columns counted from the north-west.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Northernmost row.
    pub first_row: usize,
    /// Westernmost column.
    pub first_col: usize,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub cols: usize,
}

impl Window {
    /// The index of a post in the window, in row-major order; `None` outside.
    fn index(&self, row: usize, col: usize) -> Option<usize> {
        let (row, col) = (row.checked_sub(self.first_row)?, col.checked_sub(self.first_col)?);
        (row < self.rows && col < self.cols).then_some(row * self.cols + col)
    }

    /// This window in a file with a number of rows, which may store the southernmost row first.
    pub(super) const fn stored(self, of_rows: usize, south_up: bool) -> Self {
        let first_row = if south_up { of_rows - self.first_row - self.rows } else { self.first_row };
        Self { first_row, ..self }
    }
}

/// Reverses the order of rows if the southernmost row is stored first.
pub(super) fn turn_round<T>(posts: &mut [T], cols: usize, south_up: bool) {
    if south_up {
        posts.reverse();
        posts.chunks_mut(cols).for_each(<[T]>::reverse);
    }
}

/// An open DEM: its lattice is known, and posts are read on demand.
pub trait DemFile {
    /// The lattice of all posts.
    fn lattice(&self) -> &PostLattice;

    /// The elevations of a window inside the raster, row after row from the north, NaN for gaps.
    ///
    /// # Errors
    /// [`TerrainError`] if the file cannot be read or is damaged there, or holds an invalid elevation.
    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError>;

    /// What an analyst should know of the file, where elevations in this range were read.
    fn warnings(&self, range_m: (f64, f64)) -> Vec<String>;
}

impl DemFile for Dem {
    fn warnings(&self, range_m: (f64, f64)) -> Vec<String> {
        self.step().warning(range_m, self.georeference().step_m()).into_iter().collect()
    }

    fn lattice(&self) -> &PostLattice {
        self.lattice()
    }

    fn window(&self, Window { first_row, first_col, rows, cols }: Window) -> Result<Vec<f64>, TerrainError> {
        let posts = (first_row..first_row + rows).flat_map(|row| (first_col..first_col + cols).map(move |col| (row, col)));
        Ok(posts.map(|(row, col)| self.elevation(row, col).unwrap_or(f64::NAN)).collect())
    }
}

/// The terrain that a slice needs.
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

/// The posts of one window, with indices of the whole raster; no post outside the window can be read.
pub(super) struct Part<'a> {
    file: &'a dyn DemFile,
    window: Window,
    elevations_m: Vec<f64>,
}

impl<'a> Part<'a> {
    /// An empty part: only the position of the lattice is known.
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
