//! The triangulated DEM at points between its posts: the lattice of n points a post spacing. On which facet, edge or post a point lies is
//! decided in integers.

use rayon::prelude::*;

use super::{Dem, GeoReference, TerrainError};
use crate::quantity::MapPoint;

impl GeoReference {
    /// The point `(i / n, j / n)` of the lattice of posts, `i` east and `j` south of the north-west post: exactly on the post where it is
    /// one. `n` at least 1.
    ///
    /// ```
    /// use chta::{quantity::MapPoint, terrain::GeoReference};
    /// let map = GeoReference::local(MapPoint::new(100.0, 50.0), 2.0, 5.0)?;
    /// assert_eq!(map.between_posts(4, (3, 8)), MapPoint::new(101.5, 40.0));
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    #[expect(clippy::cast_precision_loss, reason = "counts of points stay far below 2^53")]
    pub fn between_posts(&self, n: usize, (i, j): (usize, usize)) -> MapPoint {
        let north_west = self.north_west();
        let along =
            |k: usize, step_m: f64| if k.is_multiple_of(n) { (k / n) as f64 * step_m } else { k as f64 / n as f64 * step_m };
        MapPoint::new(north_west.x + along(i, self.dx_m()), north_west.y - along(j, self.dy_m()))
    }
}

impl Dem {
    /// The height of the triangulated DEM at the point `(i / n, j / n)` of the lattice of posts; `None` where its facet, or every facet
    /// that meets there, has no elevation.
    ///
    /// ```text
    ///   (0, 0) +-----+ (n, 0)      a = i mod n, b = j mod n within the square of four posts
    ///          | \   |             a > b: the north-eastern facet;  a < b: the south-western one;  a = b: the diagonal edge
    ///          |   \ |             a = 0 or b = 0: an edge of the grid;  both: a post
    ///   (0, n) +-----+ (n, n)
    /// ```
    #[expect(clippy::cast_precision_loss, reason = "counts of points stay far below 2^53")]
    pub fn height_between_posts(&self, n: usize, (i, j): (usize, usize)) -> Option<f64> {
        let (col, row, a, b) = (i / n, j / n, i % n, j % n);
        let post = |down: usize, across: usize| self.elevation(row + down, col + across);
        let share = |k: usize| k as f64 / n as f64;
        Some(match (a, b) {
            (0, 0) => post(0, 0)?,
            (_, 0) => between(post(0, 0)?, post(0, 1)?, share(a)),
            (0, _) => between(post(0, 0)?, post(1, 0)?, share(b)),
            _ if a == b => between(post(0, 0)?, post(1, 1)?, share(a)),
            _ if a > b => {
                let (corner, east, south_east) = (post(0, 0)?, post(0, 1)?, post(1, 1)?);
                corner + (east - corner) * share(a) + (south_east - east) * share(b)
            }
            _ => {
                let (corner, south, south_east) = (post(0, 0)?, post(1, 0)?, post(1, 1)?);
                corner + (south - corner) * share(b) + (south_east - south) * share(a)
            }
        })
    }

    /// The same surface with n posts in place of one: every facet is divided into `n^2` of the same slope, so that the heights between the
    /// posts stay as they are, up to rounding. Facets without elevation have none.
    ///
    /// # Errors
    /// [`TerrainError::InvalidDem`] if neighbouring points have equal map coordinates in floating point.
    ///
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Dem, GeoReference}};
    /// let map = GeoReference::local(MapPoint::new(0.0, 10.0), 10.0, 10.0)?;
    /// let dem = Dem::new(2, 2, vec![0.0, 4.0, 8.0, 0.0], map)?.finer(2)?;
    /// assert_eq!((dem.rows(), dem.cols(), dem.georeference().dx_m()), (3, 3, 5.0));
    /// assert_eq!([dem.elevation(0, 1), dem.elevation(1, 1), dem.elevation(1, 2)], [Some(2.0), Some(0.0), Some(2.0)]);
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn finer(&self, n: usize) -> Result<Self, TerrainError> {
        let n = n.max(1);
        let [rows, cols] = [self.rows(), self.cols()].map(|posts| points(posts, n));
        let height = |index: usize| self.height_between_posts(n, (index % cols, index / cols)).unwrap_or(f64::NAN);
        let heights_m = (0..rows.saturating_mul(cols)).into_par_iter().map(height).collect();
        Self::new(rows, cols, heights_m, self.georeference().finer(n))
    }
}

/// How many points of the lattice a row or a column of posts has.
pub(crate) const fn points(posts: usize, n: usize) -> usize {
    posts.saturating_sub(1).saturating_mul(n).saturating_add(1)
}

/// On the straight line from one height to another; exact at both ends.
fn between(from_z_m: f64, to_z_m: f64, share: f64) -> f64 {
    from_z_m + (to_z_m - from_z_m) * share
}
