//! The triangulated ground in lattice coordinates: elevations and facets.

use nalgebra::Vector2;

use crate::quantity::MapPoint;
use crate::terrain::window::Posts;
use crate::terrain::{GeoReference, MapBounds, ProfileFacet};

/// A point within this many post spacings of a line of the lattice is on it. Rounding of a division reaches 1e-12 on the
/// largest rasters; a micrometre of ground is a thousand times larger than this on a 1 m raster.
const ON_THE_LINE: f64 = 1.0e-9;

/// The triangles of a raster, in lattice coordinates: u counts columns to the east, v rows to the south.
pub(super) struct Ground<'a> {
    posts: &'a dyn Posts,
    map: &'a GeoReference,
    tolerance: f64,
    last: Vector2<f64>,
}

/// A square of four posts, identified by its north-west post.
#[derive(Clone, Copy)]
struct Square {
    row: usize,
    col: usize,
}

impl<'a> Ground<'a> {
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    pub(super) fn of(posts: &'a dyn Posts) -> Self {
        let lattice = posts.lattice();
        let (map, bounds) = (lattice.georeference(), lattice.bounds());
        // The resolution of map coordinates: even a post's own coordinates can be off by one unit in the last place.
        let resolution_x = f64::EPSILON * bounds.min.x.abs().max(bounds.max.x.abs()) / map.dx_m();
        let resolution_y = f64::EPSILON * bounds.min.y.abs().max(bounds.max.y.abs()) / map.dy_m();
        Self {
            posts,
            map,
            tolerance: ON_THE_LINE.max(resolution_x).max(resolution_y),
            last: Vector2::new((lattice.cols() - 1) as f64, (lattice.rows() - 1) as f64),
        }
    }

    pub(super) fn bounds(&self) -> MapBounds {
        self.posts.lattice().bounds()
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Lattice coordinates of a map point.
    pub(super) fn lattice(&self, point: MapPoint) -> Vector2<f64> {
        let away = point - self.map.north_west();
        Vector2::new(away.x / self.map.dx_m(), -away.y / self.map.dy_m())
    }

    /// Map coordinates of a lattice point.
    pub(super) fn map_point(&self, lattice: Vector2<f64>) -> MapPoint {
        let away = self.metres(lattice);
        self.map.north_west() + away
    }

    /// A step on the lattice in metres east and north.
    pub(super) fn metres(&self, step: Vector2<f64>) -> Vector2<f64> {
        Vector2::new(step.x * self.map.dx_m(), -step.y * self.map.dy_m())
    }

    /// Whether a point lies on the map, including the outermost posts.
    pub(super) fn covers(&self, lattice: Vector2<f64>) -> bool {
        let inside = |value: f64, last: f64| value >= -self.tolerance && value <= last + self.tolerance;
        inside(lattice.x, self.last.x) && inside(lattice.y, self.last.y)
    }

    /// Coordinates rounded to integers if they nearly are, and clamped to the map.
    pub(super) fn snapped(&self, lattice: Vector2<f64>) -> Vector2<f64> {
        let snap = |value: f64, last: f64| self.nearly_whole(value).clamp(0.0, last);
        Vector2::new(snap(lattice.x, self.last.x), snap(lattice.y, self.last.y))
    }

    /// The nearest integer if the coordinate is within the tolerance, else the coordinate.
    pub(super) fn nearly_whole(&self, value: f64) -> f64 {
        let whole = value.round();
        if (value - whole).abs() <= self.tolerance { whole } else { value }
    }

    /// Elevation of the ground: at a post its own, on a line between two posts interpolated, and inside a facet on the plane
    /// through three posts. `None` if one of these is missing.
    pub(super) fn elevation(&self, lattice: Vector2<f64>) -> Option<f64> {
        let at = self.snapped(lattice);
        let square = self.square(at);
        let (u, v) = (at.x - as_coordinate(square.col), at.y - as_coordinate(square.row));
        let [north_west, north_east, south_west, south_east] = self.corners(square);
        if (u - v).abs() <= self.tolerance && u.fract() != 0.0 && v.fract() != 0.0 {
            return between(north_west, south_east, u);
        }
        match (u, v) {
            (0.0, _) => between(north_west, south_west, v),
            (1.0, _) => between(north_east, south_east, v),
            (_, 0.0) => between(north_west, north_east, u),
            (_, 1.0) => between(south_west, south_east, u),
            _ if u > v => {
                let (north_west, north_east, south_east) = (north_west?, north_east?, south_east?);
                Some(north_west + u * (north_east - north_west) + v * (south_east - north_east))
            }
            _ => {
                let (north_west, south_west, south_east) = (north_west?, south_west?, south_east?);
                Some(north_west + v * (south_west - north_west) + u * (south_east - south_west))
            }
        }
    }

    /// The facet at the middle of a segment; of several that touch it, the one with the largest cross-slope. `None` if one of
    /// its posts is missing.
    pub(super) fn facet(&self, middle: Vector2<f64>, heading: Vector2<f64>) -> Option<ProfileFacet> {
        let reach = Vector2::repeat(self.tolerance);
        let (low, high) = (self.square(middle - reach), self.square(middle + reach));
        let mut steepest: Option<ProfileFacet> = None;
        for row in low.row..=high.row {
            for col in low.col..=high.col {
                for gradient in self.gradients_at(Square { row, col }, middle).into_iter().flatten() {
                    let facet = ProfileFacet::from_gradient(gradient, heading);
                    if steepest.is_none_or(|other| facet.cross_slope > other.cross_slope) {
                        steepest = Some(facet);
                    }
                }
            }
        }
        steepest
    }

    /// Gradients (east, north) of the triangles of a square that touch a point and have all their posts.
    fn gradients_at(&self, square: Square, point: Vector2<f64>) -> [Option<Vector2<f64>>; 2] {
        let side = (point.x - as_coordinate(square.col)) - (point.y - as_coordinate(square.row));
        let [north_west, north_east, south_west, south_east] = self.corners(square);
        let gradient = |west: Option<f64>, east: Option<f64>, north: Option<f64>, south: Option<f64>| {
            Some(Vector2::new((east? - west?) / self.map.dx_m(), (north? - south?) / self.map.dy_m()))
        };
        let north_east_half = if side >= -self.tolerance { gradient(north_west, north_east, north_east, south_east) } else { None };
        let south_west_half = if side <= self.tolerance { gradient(south_west, south_east, north_west, south_west) } else { None };
        [north_east_half, south_west_half]
    }

    /// The posts that elevations and facets between two positions may need: first and last row, first and last column.
    pub(super) fn reach(&self, a: Vector2<f64>, b: Vector2<f64>) -> [usize; 4] {
        let margin = Vector2::repeat(self.tolerance);
        let (low, high) = (self.square(a.inf(&b) - margin), self.square(a.sup(&b) + margin));
        [low.row, high.row + 1, low.col, high.col + 1]
    }

    /// The square that contains a point; on the last row and column, the last square.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the raster first")]
    fn square(&self, lattice: Vector2<f64>) -> Square {
        let floor = |value: f64, last: f64| value.clamp(0.0, last - 1.0).floor() as usize;
        Square { row: floor(lattice.y, self.last.y), col: floor(lattice.x, self.last.x) }
    }

    /// North-west, north-east, south-west, south-east.
    fn corners(&self, Square { row, col }: Square) -> [Option<f64>; 4] {
        [(row, col), (row, col + 1), (row + 1, col), (row + 1, col + 1)].map(|(row, col)| self.posts.elevation(row, col))
    }
}

#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
fn as_coordinate(index: usize) -> f64 {
    index as f64
}

/// Interpolates between two posts; exact at each of them even if the other is missing.
fn between(first: Option<f64>, second: Option<f64>, share: f64) -> Option<f64> {
    if share == 0.0 {
        first
    } else if share == 1.0 {
        second
    } else {
        let (first, second) = (first?, second?);
        Some(first + share * (second - first))
    }
}
