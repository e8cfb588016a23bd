//! The lattice of a raster's posts.

use super::{GeoReference, MapBounds, TerrainError};

/// Posts in rows and columns, and their position on the map: at least 2 x 2, with different coordinates for neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct PostLattice {
    rows: usize,
    cols: usize,
    georeference: GeoReference,
}

impl PostLattice {
    /// A lattice with a number of rows and columns and a position.
    ///
    /// # Errors
    /// [`TerrainError::InvalidDem`] if there are fewer than 2 rows or columns, or if neighbouring posts have equal
    /// coordinates in floating point, as for 1 mm posts 10^14 m from the origin.
    pub fn new(rows: usize, cols: usize, georeference: GeoReference) -> Result<Self, TerrainError> {
        check_sides(rows, cols)?;
        let bounds = georeference.bounds(rows, cols);
        let MapBounds { min, max } = bounds;
        let near = |edge: f64, step: f64| (edge + step) - edge > 0.5 * step && (edge - step) - edge < -0.5 * step;
        let (dx_m, dy_m) = (georeference.dx_m(), georeference.dy_m());
        let distinct = near(min.x, dx_m) && near(max.x, dx_m) && near(min.y, dy_m) && near(max.y, dy_m);
        if distinct && [min.x, min.y, max.x, max.y].iter().all(|value| value.is_finite()) {
            return Ok(Self { rows, cols, georeference });
        }
        Err(TerrainError::InvalidDem(format!(
            "the map has {bounds} with posts every {dx_m} m and {dy_m} m, expected coordinates that tell neighbouring posts apart"
        )))
    }

    /// Number of rows, north to south.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns, west to east.
    pub fn cols(&self) -> usize {
        self.cols
    }

    /// The position of the posts on the map.
    pub fn georeference(&self) -> &GeoReference {
        &self.georeference
    }

    /// The rectangle of the outermost posts.
    pub fn bounds(&self) -> MapBounds {
        self.georeference.bounds(self.rows, self.cols)
    }

    /// The index of a post in row-major order from the north; `None` outside.
    pub(super) fn index(&self, row: usize, col: usize) -> Option<usize> {
        (row < self.rows && col < self.cols).then(|| row * self.cols + col)
    }
}

/// The smallest raster is a square of four posts.
pub(super) fn check_sides(rows: usize, cols: usize) -> Result<(), TerrainError> {
    if rows >= 2 && cols >= 2 {
        return Ok(());
    }
    Err(TerrainError::InvalidDem(format!("the raster has {rows} rows and {cols} columns, expected at least 2 of each")))
}
