//! The posts around a journey over a DEM, for the footprints of its contacts.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::RangeInclusive,
    sync::Arc,
};

use nalgebra::Vector2;

use super::{
    Dem, DemFile, FootprintFit, FootprintGap, GeoReference, PostLattice, Profile, TerrainError, Window,
    dem::{Posts, check_elevation},
    footprint::fit_plane,
};
use crate::quantity::MapPoint;

/// Side of a tile, posts. Larger tiles read more posts beside a journey, smaller ones seek more often in the file.
const TILE: usize = 64;

/// The posts of a DEM around a journey: the whole DEM, or the tiles along a slice of a file that is not read whole.
///
/// # Memory
/// Of tiles: 8 bytes per post within a tile's side of the slice, so some kilobytes per post of its length.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    lattice: PostLattice,
    held: Held,
}

/// The posts that are known.
#[derive(Clone, Debug, PartialEq)]
enum Held {
    Whole(Arc<Dem>),
    Tiles(BTreeMap<(usize, usize), Vec<f64>>),
}

impl Surroundings {
    /// All posts of a DEM.
    pub fn whole(dem: Arc<Dem>) -> Self {
        Self { lattice: dem.lattice().clone(), held: Held::Whole(dem) }
    }

    /// The posts of a file within a distance of slices of it, m.
    ///
    /// # Errors
    /// [`TerrainError`] if the file cannot be read there.
    pub fn along(file: &dyn DemFile, legs: &[Profile], distance_m: f64) -> Result<Self, TerrainError> {
        let lattice = file.lattice().clone();
        let mut wanted = BTreeSet::new();
        for pair in legs.iter().flat_map(|leg| leg.points.windows(2)) {
            let Some((rows, cols)) = around(&lattice, [pair[0].map, pair[1].map], distance_m) else { continue };
            for row in rows.start() / TILE..=rows.end() / TILE {
                wanted.extend((cols.start() / TILE..=cols.end() / TILE).map(|col| (row, col)));
            }
        }
        let read = |(row, col): (usize, usize)| {
            let (first_row, first_col) = (row * TILE, col * TILE);
            let (rows, cols) = (TILE.min(lattice.rows() - first_row), TILE.min(lattice.cols() - first_col));
            let posts = file.window(Window { first_row, first_col, rows, cols })?;
            for (index, z_m) in posts.iter().enumerate() {
                check_elevation(*z_m, first_row + index / cols, first_col + index % cols)?;
            }
            Ok(((row, col), posts))
        };
        let tiles = wanted.into_iter().map(read).collect::<Result<_, TerrainError>>()?;
        Ok(Self { held: Held::Tiles(tiles), lattice })
    }

    /// The lattice of all posts.
    pub const fn lattice(&self) -> &PostLattice {
        &self.lattice
    }

    /// The elevation of a post, m; NaN if it has none or is not known.
    pub fn height_m(&self, row: usize, col: usize) -> f64 {
        match &self.held {
            Held::Whole(dem) => dem.elevation(row, col).unwrap_or(f64::NAN),
            Held::Tiles(tiles) => {
                let width = TILE.min(self.lattice.cols().saturating_sub(col / TILE * TILE));
                let tile = tiles.get(&(row / TILE, col / TILE));
                tile.and_then(|posts| posts.get(row % TILE * width + col % TILE)).copied().unwrap_or(f64::NAN)
            }
        }
    }

    /// The plane fitted over the footprint of this diameter around a map point, m.
    ///
    /// `base_m` is any height near the ground there.
    ///
    /// # Errors
    /// [`FootprintGap`] where the ground under the footprint is not known.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Dem, FootprintGap, GeoReference, Surroundings}};
    /// // A plane that rises by 1 in 5 to the east: no residual, a tangent of 0.2.
    /// let posts = (0..36).map(|post| 0.2 * f64::from(post % 6)).collect();
    /// let dem = Dem::new(6, 6, posts, GeoReference::local(MapPoint::new(0.0, 5.0), 1.0, 1.0)?)?;
    /// let ground = Surroundings::whole(dem.into());
    /// let fit = ground.fit(MapPoint::new(2.3, 2.4), 0.5, 3.0).unwrap();
    /// assert!((fit.tilt_slope - 0.2).abs() < 1e-12 && fit.residual_m < 1e-12);
    /// assert_eq!(ground.fit(MapPoint::new(1.4, 2.4), 0.3, 3.0), Err(FootprintGap::Border));
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn fit(&self, at: MapPoint, base_m: f64, footprint_m: f64) -> Result<FootprintFit, FootprintGap> {
        self.fit_raised(at, base_m, footprint_m, None)
    }

    /// The same on ground that is higher by this function of the map point.
    ///
    /// # Errors
    /// [`FootprintGap`].
    pub fn fit_raised(
        &self,
        at: MapPoint,
        base_m: f64,
        footprint_m: f64,
        raised_m: Option<&dyn Fn(MapPoint) -> f64>,
    ) -> Result<FootprintFit, FootprintGap> {
        let heights = |row, col| {
            let nominal_m = self.height_m(row, col);
            raised_m.map_or(nominal_m, |raised_m| nominal_m + raised_m(self.lattice.georeference().post(row, col)))
        };
        let (gradient, residual_m): (Vector2<f64>, f64) = fit_plane(&self.lattice, &heights, at, base_m, footprint_m)?;
        Ok(FootprintFit { tilt_slope: libm::hypot(gradient.x, gradient.y), residual_m })
    }

    /// The DEM of the posts within a distance of a map point, and of those next to them; `None` if it has no elevation.
    pub(crate) fn cut_out(&self, at: MapPoint, distance_m: f64) -> Option<Dem> {
        let (rows, cols) = around(&self.lattice, [at, at], distance_m)?;
        let map = self.lattice.georeference();
        let north_west = map.post(*rows.start(), *cols.start());
        let cut = GeoReference::local(north_west, map.dx_m(), map.dy_m()).ok()?;
        let lattice = PostLattice::new(rows.clone().count(), cols.clone().count(), cut).ok()?;
        let posts =
            rows.flat_map(|row| cols.clone().map(move |col| (row, col))).map(|(row, col)| self.height_m(row, col)).collect();
        Dem::from_lattice(lattice, Posts::Double(posts)).ok()
    }
}

/// The rows and columns of the posts within a distance of the rectangle between two map points, and one more on each side.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the raster first")]
#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
fn around(lattice: &PostLattice, [a, b]: [MapPoint; 2], distance_m: f64) -> Option<(RangeInclusive<usize>, RangeInclusive<usize>)> {
    let map = lattice.georeference();
    let (origin, dx_m, dy_m) = (map.north_west(), map.dx_m(), map.dy_m());
    let range = |low: f64, high: f64, posts: usize| {
        let last = (posts - 1) as f64;
        // At least two posts, also at the border.
        let first = (low.floor() - 1.0).clamp(0.0, last - 1.0) as usize;
        let end = (high.ceil() + 1.0).clamp(1.0, last) as usize;
        (low.is_finite() && high.is_finite()).then_some(first..=end.max(first + 1))
    };
    let cols = range((a.x.min(b.x) - distance_m - origin.x) / dx_m, (a.x.max(b.x) + distance_m - origin.x) / dx_m, lattice.cols())?;
    let rows = range((origin.y - a.y.max(b.y) - distance_m) / dy_m, (origin.y - a.y.min(b.y) + distance_m) / dy_m, lattice.rows())?;
    Some((rows, cols))
}
