//! The overlays of the terrain, friction raster and keep-out zones, at every post: which squares of posts a border runs through,
//! and the values elsewhere.
//!
//! If no border touches the bounding box of two posts, the overlays are constant between them and add no vertices to the slice.

use nalgebra::{Vector2, Vector3};
use rayon::prelude::*;

use super::lattice::Post;
use crate::{
    terrain::{Dem, MapBounds, OverlaidDem, Profile, ProfileFacet, ProfilePoint, TerrainError},
    world::FrictionCone,
};

/// A border within this fraction of the post spacing from a square counts as running through it.
const TOUCHING: f64 = 1.0e-6;

/// Zones and friction at every post.
#[derive(Clone, Debug)]
pub(crate) struct OverlayTable {
    cols: usize,
    kept: Vec<bool>,
    /// Friction coefficients, NaN where the raster has none; empty without a raster.
    friction: Vec<f64>,
    /// How many squares with a border lie to the north and west of each post.
    borders_before: Vec<u32>,
}

impl OverlayTable {
    /// The bytes that the tables of so many posts hold, and those that making them holds beside it: at most, as long as no post has
    /// more than two borders of the overlays on its row on average.
    pub(super) const fn bytes(posts: usize) -> (usize, usize) {
        let line = size_of::<ProfilePoint>() + size_of::<ProfileFacet>();
        (posts * (size_of::<bool>() + size_of::<f64>() + size_of::<u32>()), posts * 6 * line)
    }

    /// The overlays of a DEM; `None` if it has neither friction raster nor zones.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`] if a mask does not cover the terrain, or friction is missing in the raster and as a constant.
    pub(crate) fn new(terrain: &OverlaidDem, constant: Option<FrictionCone>) -> Result<Option<Self>, TerrainError> {
        let (dem, overlays) = (terrain.dem(), terrain.overlays());
        let friction = overlays.friction();
        if friction.is_none() && overlays.zones().next().is_none() {
            return Ok(None);
        }
        let (rows, cols) = (dem.rows(), dem.cols());
        let lines: Vec<Result<Profile, TerrainError>> = (0..rows)
            .into_par_iter()
            .map(|row| {
                let mut line = level_row(dem, row);
                overlays.lay(&mut line, constant)?;
                Ok(line)
            })
            .collect();
        let mut kept = Vec::with_capacity(rows * cols);
        let mut coefficients = Vec::with_capacity(if friction.is_some() { rows * cols } else { 0 });
        let posts_m: Vec<f64> = level_row(dem, 0).points.iter().map(|point| point.x_m).collect();
        for line in lines {
            for facet in at_posts(&posts_m, &line?) {
                kept.push(facet.keep_out);
                if friction.is_some() {
                    coefficients.push(facet.friction.map_or(f64::NAN, FrictionCone::coefficient));
                }
            }
        }
        let mut squares = Squares::of(dem);
        if let Some(raster) = friction {
            raster.borders(&mut |border| squares.mark(border));
        }
        for zones in overlays.zones() {
            // Short pieces of borders have small bounding boxes, so they mark few squares without a border.
            zones.borders(dem.georeference().step_m(), &mut |border| squares.mark(border));
        }
        Ok(Some(Self { cols, kept, friction: coefficients, borders_before: squares.counted() }))
    }

    /// Whether a post, with everything around it up to the next border, lies in a keep-out zone.
    #[inline]
    pub(crate) fn kept(&self, post: usize) -> bool {
        self.kept[post]
    }

    /// Whether there is a friction raster.
    #[inline]
    pub(super) fn has_friction(&self) -> bool {
        !self.friction.is_empty()
    }

    /// The friction coefficient at a post; `None` without a raster.
    #[inline]
    pub(super) fn friction(&self, post: usize) -> Option<f64> {
        self.friction.get(post).copied()
    }

    /// Whether a border touches the bounding box of two posts.
    #[inline]
    pub(crate) fn has_border(&self, a: Post, b: Post) -> bool {
        // Squares that touch the box: from the one before its first post to the one at its last.
        let (north, south) = (a.row.min(b.row), a.row.max(b.row));
        let (west, east) = (a.col.min(b.col), a.col.max(b.col));
        let before = |row: usize, col: usize| self.borders_before[row * (self.cols + 1) + col];
        let (top, left, bottom, right) = (north.saturating_sub(1), west.saturating_sub(1), south + 1, east + 1);
        before(bottom, right) + before(top, left) != before(top, right) + before(bottom, left)
    }
}

/// A row of posts as a level profile.
fn level_row(dem: &Dem, row: usize) -> Profile {
    let map = dem.georeference();
    let level =
        ProfileFacet { normal: Vector3::z(), cross_slope: crate::quantity::Angle::default(), keep_out: false, friction: None };
    let west = map.post(row, 0);
    let points = (0..dem.cols())
        .map(|col| {
            let at = map.post(row, col);
            ProfilePoint { x_m: at.x - west.x, z_m: 0.0, map: at }
        })
        .collect();
    Profile { points, facets: vec![level; dem.cols() - 1], heading: Vector2::new(1.0, 0.0) }
}

/// The facet under each post of a row's line: that of the segment after it, for the last post of the segment before it.
fn at_posts(posts_m: &[f64], line: &Profile) -> Vec<ProfileFacet> {
    let mut found = Vec::with_capacity(posts_m.len());
    let mut posts = posts_m.iter().peekable();
    for (index, point) in line.points.iter().enumerate() {
        if posts.next_if(|&&x_m| x_m == point.x_m).is_some() {
            found.push(line.facets[index.min(line.facets.len() - 1)]);
        }
    }
    found
}

/// The squares of four posts with borders through them.
struct Squares<'a> {
    dem: &'a Dem,
    touched: Vec<bool>,
}

impl<'a> Squares<'a> {
    fn of(dem: &'a Dem) -> Self {
        Self { dem, touched: vec![false; dem.rows() * dem.cols()] }
    }

    /// Marks the squares that a rectangle touches.
    fn mark(&mut self, border: MapBounds) {
        let map = self.dem.georeference();
        let (west, north) = (map.north_west().x, map.north_west().y);
        let cols = [(border.min.x - west) / map.dx_m() - TOUCHING, (border.max.x - west) / map.dx_m() + TOUCHING];
        let rows = [(north - border.max.y) / map.dy_m() - TOUCHING, (north - border.min.y) / map.dy_m() + TOUCHING];
        let (Some(rows), Some(cols)) = (within(rows, self.dem.rows()), within(cols, self.dem.cols())) else { return };
        for row in rows {
            for col in cols.clone() {
                self.touched[row * self.dem.cols() + col] = true;
            }
        }
    }

    /// The number of marked squares to the north and west of each post, preceded by a row and a column of zeros.
    fn counted(self) -> Vec<u32> {
        let (rows, cols) = (self.dem.rows(), self.dem.cols());
        let mut before = vec![0u32; (rows + 1) * (cols + 1)];
        for row in 0..rows {
            let mut in_row = 0;
            for col in 0..cols {
                in_row += u32::from(self.touched[row * cols + col]);
                before[(row + 1) * (cols + 1) + col + 1] = before[row * (cols + 1) + col + 1] + in_row;
            }
        }
        before
    }
}

/// The range of squares between two coordinates, clamped to the raster; empty if they lie off the map.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the raster first")]
#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
fn within([low, high]: [f64; 2], posts: usize) -> Option<std::ops::RangeInclusive<usize>> {
    let last = (posts - 1) as f64;
    (high >= 0.0 && low <= last).then(|| low.floor().clamp(0.0, last) as usize..=high.floor().clamp(0.0, last) as usize)
}
