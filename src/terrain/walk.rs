//! A straight walk over the triangles of a DEM, from one to the next, without allocation.

use nalgebra::Vector2;

use super::Dem;
use crate::quantity::MapPoint;

/// A position within this many post spacings of a line of the lattice is on it, as in [`slice`](super::slice()).
const ON_THE_LINE: f64 = 1.0e-9;

/// The triangulated ground of a DEM (every square of posts divided from north-west to south-east), for straight walks.
///
/// A function of row and column gives the heights of posts: the DEM's own ([`Triangles::nominal`]) or heights with errors;
/// NaN means no ground.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    dem: &'a Dem,
    /// Column of the last square's north-west post.
    last_col: isize,
    last_row: isize,
    origin: MapPoint,
    spacing_m: Vector2<f64>,
    tolerance: f64,
}

/// The part of a walk over one triangle: straight ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetSpan {
    /// Where it begins, m from the beginning of the walk.
    pub from_m: f64,
    /// Where it ends, m from the beginning of the walk.
    pub to_m: f64,
    /// Height of the ground at its beginning, m.
    pub from_z_m: f64,
    /// Height of the ground at its end, m.
    pub to_z_m: f64,
    /// Gradient of the triangle, to the east and north.
    pub gradient: Vector2<f64>,
}

/// The half of a square: north-east or south-west of its diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    NorthEast,
    SouthWest,
}

/// The side through which a walk leaves a triangle.
#[derive(Clone, Copy, Debug)]
enum Side {
    East,
    North,
    West,
    South,
    Diagonal,
}

/// A triangle with the heights of its posts; the third post is the north-east or the south-west one.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    col: isize,
    row: isize,
    half: Half,
    north_west_m: f64,
    south_east_m: f64,
    third_m: f64,
}

impl<'a> Triangles<'a> {
    /// The triangles of a DEM.
    #[expect(clippy::cast_possible_wrap, reason = "rows and columns stay far below 2^63")]
    pub fn of(dem: &'a Dem) -> Self {
        let (map, bounds) = (dem.georeference(), dem.bounds());
        let resolution = |low: f64, high: f64, step: f64| f64::EPSILON * low.abs().max(high.abs()) / step;
        let tolerance = ON_THE_LINE.max(resolution(bounds.min.x, bounds.max.x, map.dx_m())).max(resolution(
            bounds.min.y,
            bounds.max.y,
            map.dy_m(),
        ));
        Self {
            dem,
            last_col: dem.cols() as isize - 2,
            last_row: dem.rows() as isize - 2,
            origin: map.north_west(),
            spacing_m: Vector2::new(map.dx_m(), map.dy_m()),
            tolerance,
        }
    }

    /// The DEM's own heights.
    pub fn nominal(&self) -> impl Fn(usize, usize) -> f64 + Copy + 'a {
        let dem = self.dem;
        move |row, col| dem.elevation(row, col).unwrap_or(f64::NAN)
    }

    /// Map coordinates of a post.
    pub fn post(&self, row: usize, col: usize) -> MapPoint {
        self.dem.georeference().post(row, col)
    }

    /// Whether a position lies on the map, including its border.
    pub fn covers(&self, place: MapPoint) -> bool {
        self.lattice(place).is_some()
    }

    /// Height and gradient of the ground at a position; `None` off the map and if a post of the triangle is missing.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Dem, GeoReference, Triangles}};
    /// // Elevation 1 at the north-east post, 0 at the others: only the north-east half rises.
    /// let dem = Dem::new(2, 2, vec![0.0, 1.0, 0.0, 0.0], GeoReference::local(MapPoint::new(0.0, 1.0), 1.0, 1.0)?)?;
    /// let ground = Triangles::of(&dem);
    /// let (z_m, gradient) = ground.at(MapPoint::new(0.75, 0.75), ground.nominal()).unwrap();
    /// assert_eq!((z_m, gradient.x, gradient.y), (0.5, 1.0, 1.0));
    /// assert!(ground.at(MapPoint::new(1.5, 0.5), ground.nominal()).is_none());
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn at(&self, place: MapPoint, heights: impl Fn(usize, usize) -> f64) -> Option<(f64, Vector2<f64>)> {
        let (u, v) = self.lattice(place)?;
        let (col, row) = (floor(u).clamp(0, self.last_col), floor(v).clamp(0, self.last_row));
        let half = if u - coordinate(col) >= v - coordinate(row) { Half::NorthEast } else { Half::SouthWest };
        let triangle = Triangle::of(col, row, half, &heights);
        let height_m = triangle.height_m(u, v);
        (!height_m.is_nan()).then(|| (height_m, triangle.gradient(self.spacing_m)))
    }

    /// The triangles along a straight line from a position, up to the end of the ground.
    ///
    /// From a position on a line of the lattice (within 1e-9 post spacings, or the rounding error of the map coordinates
    /// if that is larger) the walk begins with the triangle ahead; along a line, with one of the two beside it. Consecutive spans
    /// share their ends, and the ground is continuous over them.
    ///
    /// # Arguments
    /// `heading`: unit vector, east and north.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Dem, GeoReference, Triangles}};
    /// use nalgebra::Vector2;
    /// let dem = Dem::new(2, 2, vec![0.0, 1.0, 0.0, 0.0], GeoReference::local(MapPoint::new(0.0, 1.0), 1.0, 1.0)?)?;
    /// let ground = Triangles::of(&dem);
    /// let spans: Vec<_> = ground.walk(MapPoint::new(0.0, 0.5), Vector2::new(1.0, 0.0), ground.nominal()).collect();
    /// assert_eq!(spans.len(), 2);
    /// assert_eq!((spans[0].to_m, spans[1].to_m, spans[1].to_z_m), (0.5, 1.0, 0.5));
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    #[inline]
    pub fn walk<H: Fn(usize, usize) -> f64>(&self, from: MapPoint, heading: Vector2<f64>, heights: H) -> FacetWalk<'a, H> {
        let step = Vector2::new(heading.x / self.spacing_m.x, -heading.y / self.spacing_m.y);
        let triangle = self.lattice(from).and_then(|(u, v)| self.ahead(u, v, step, &heights));
        let (u, v) = self.lattice(from).unwrap_or((0.0, 0.0));
        let diagonal_offset = self.nearly_whole(u - v);
        let diagonal_rate = step.x - step.y;
        FacetWalk {
            ground: *self,
            heights,
            start: Vector2::new(u, v),
            diagonal_offset,
            step,
            diagonal_rate,
            inverse_step: Vector2::new(1.0 / step.x, 1.0 / step.y),
            inverse_diagonal_rate: 1.0 / diagonal_rate,
            from_m: 0.0,
            next: triangle,
        }
    }

    /// The posts ahead on a straight line that runs along edges of triangles, which is along a row, a column or a diagonal of
    /// posts: row, column and distance of each, up to the map's border. `None` for any other line, and off the map.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Dem, GeoReference, Triangles}};
    /// use nalgebra::Vector2;
    /// let dem = Dem::new(3, 3, vec![0.0; 9], GeoReference::local(MapPoint::new(0.0, 2.0), 1.0, 1.0)?)?;
    /// let ground = Triangles::of(&dem);
    /// let row = ground.posts_ahead(MapPoint::new(0.5, 1.0), Vector2::new(1.0, 0.0)).unwrap();
    /// assert_eq!(row.collect::<Vec<_>>(), [(1, 1, 0.5), (1, 2, 1.5)]);
    /// assert!(ground.posts_ahead(MapPoint::new(0.5, 1.0), Vector2::new(0.6, 0.8)).is_none());
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn posts_ahead(&self, from: MapPoint, heading: Vector2<f64>) -> Option<impl Iterator<Item = (usize, usize, f64)> + use<>> {
        let (u, v) = self.lattice(from)?;
        let step = Vector2::new(heading.x / self.spacing_m.x, -heading.y / self.spacing_m.y);
        let level = |rate: f64| rate.abs() <= ON_THE_LINE * step.amax();
        let whole = |value: f64| value == value.round();
        let (along_row, along_col) = (level(step.y) && whole(v), level(step.x) && whole(u));
        let diagonal = level(step.x - step.y) && whole(self.nearly_whole(u - v));
        if !(along_row || along_col || diagonal) {
            return None;
        }
        // Position and rate along the line, counted in columns (in rows if it runs along a column); from one post to the next it
        // changes by `sign`.
        let (at, rate) = if along_col { (v, step.y) } else { (u, step.x) };
        let sign = if rate < 0.0 { -1.0 } else { 1.0 };
        let first = if rate < 0.0 { at.ceil() - 1.0 } else { at.floor() + 1.0 };
        let each_m = match (along_row, along_col) {
            (true, _) => self.spacing_m.x,
            (_, true) => self.spacing_m.y,
            _ => libm::hypot(self.spacing_m.x, self.spacing_m.y),
        };
        let (last_col, last_row) = (self.last_col + 1, self.last_row + 1);
        let posts = (0u32..).map(move |number| {
            let post = first + sign * f64::from(number);
            let moved = post - at;
            let (col, row) = match (along_row, along_col) {
                (true, _) => (post, v),
                (_, true) => (u, post),
                _ => (post, (v + moved).round()),
            };
            (floor(col), floor(row), moved.abs() * each_m)
        });
        let inside = move |at: isize, last: isize| usize::try_from(at).ok().filter(|_| at <= last);
        Some(posts.map_while(move |(col, row, distance_m)| Some((inside(row, last_row)?, inside(col, last_col)?, distance_m))))
    }

    /// Columns east and rows south of the north-west post, rounded if nearly integers; `None` off the map.
    #[inline]
    fn lattice(&self, place: MapPoint) -> Option<(f64, f64)> {
        let u = self.nearly_whole((place.x - self.origin.x) / self.spacing_m.x);
        let v = self.nearly_whole((self.origin.y - place.y) / self.spacing_m.y);
        let inside = |value: f64, last: isize| 0.0 <= value && value <= coordinate(last + 1);
        (inside(u, self.last_col) && inside(v, self.last_row)).then_some((u, v))
    }

    #[inline]
    fn nearly_whole(&self, value: f64) -> f64 {
        let whole = value.round();
        if (value - whole).abs() <= self.tolerance { whole } else { value }
    }

    /// The triangle ahead of a position on the lattice; `None` if the map ends there.
    #[inline]
    fn ahead<H: Fn(usize, usize) -> f64>(&self, u: f64, v: f64, step: Vector2<f64>, heights: &H) -> Option<Triangle> {
        let square = |at: f64, step: f64, last: isize| {
            let square = floor(at);
            if step == 0.0 {
                square.min(last)
            } else if step < 0.0 && coordinate(square) == at {
                square - 1
            } else {
                square
            }
        };
        let (col, row) = (square(u, step.x, self.last_col), square(v, step.y, self.last_row));
        if step == Vector2::zeros() || !self.has(col, row) {
            return None;
        }
        let side = self.nearly_whole(u - v) - coordinate(col - row);
        let half = if side > 0.0 || (side == 0.0 && step.x >= step.y) { Half::NorthEast } else { Half::SouthWest };
        Some(Triangle::of(col, row, half, heights))
    }

    #[inline]
    fn has(&self, col: isize, row: isize) -> bool {
        (0..=self.last_col).contains(&col) && (0..=self.last_row).contains(&row)
    }
}

impl Triangle {
    #[inline]
    fn of(col: isize, row: isize, half: Half, heights: &impl Fn(usize, usize) -> f64) -> Self {
        let third_m = match half {
            Half::NorthEast => post(heights, col + 1, row),
            Half::SouthWest => post(heights, col, row + 1),
        };
        Self { col, row, half, north_west_m: post(heights, col, row), south_east_m: post(heights, col + 1, row + 1), third_m }
    }

    #[inline]
    fn height_m(&self, u: f64, v: f64) -> f64 {
        let (u, v) = (u - coordinate(self.col), v - coordinate(self.row));
        let (first, second) = match self.half {
            Half::NorthEast => (u, v),
            Half::SouthWest => (v, u),
        };
        self.north_west_m + first * (self.third_m - self.north_west_m) + second * (self.south_east_m - self.third_m)
    }

    #[inline]
    fn gradient(&self, spacing_m: Vector2<f64>) -> Vector2<f64> {
        let (first, second) = (self.third_m - self.north_west_m, self.south_east_m - self.third_m);
        match self.half {
            Half::NorthEast => Vector2::new(first / spacing_m.x, -second / spacing_m.y),
            Half::SouthWest => Vector2::new(second / spacing_m.x, -first / spacing_m.y),
        }
    }

    /// The triangle beyond a side: reads the height of its third post and keeps the two posts of the side.
    #[inline]
    fn beyond(self, side: Side, ground: &Triangles<'_>, heights: &impl Fn(usize, usize) -> f64) -> Option<Self> {
        let Self { col, row, half, north_west_m, south_east_m, third_m } = self;
        let (next_col, next_row) = match side {
            Side::East => (col + 1, row),
            Side::West => (col - 1, row),
            Side::North => (col, row - 1),
            Side::South => (col, row + 1),
            Side::Diagonal => (col, row),
        };
        if !ground.has(next_col, next_row) {
            return None;
        }
        let (half, north_west_m, south_east_m, third_m) = match side {
            Side::East => (Half::SouthWest, third_m, post(heights, col + 2, row + 1), south_east_m),
            Side::North => (Half::SouthWest, post(heights, col, row - 1), third_m, north_west_m),
            Side::West => (Half::NorthEast, post(heights, col - 1, row), third_m, north_west_m),
            Side::South => (Half::NorthEast, third_m, post(heights, col + 1, row + 2), south_east_m),
            Side::Diagonal if half == Half::NorthEast => (Half::SouthWest, north_west_m, south_east_m, post(heights, col, row + 1)),
            Side::Diagonal => (Half::NorthEast, north_west_m, south_east_m, post(heights, col + 1, row)),
        };
        Some(Self { col: next_col, row: next_row, half, north_west_m, south_east_m, third_m })
    }
}

/// An iterator over the triangles along a straight line; see [`Triangles::walk`].
#[derive(Clone, Debug)]
pub struct FacetWalk<'a, H> {
    ground: Triangles<'a>,
    heights: H,
    /// Column and row of the beginning of the line, counted from the north-west post.
    start: Vector2<f64>,
    /// Column minus row at the beginning of the line.
    diagonal_offset: f64,
    /// Change of column and row per metre along the line.
    step: Vector2<f64>,
    /// Change of column minus row per metre along the line.
    diagonal_rate: f64,
    /// One over each component of `step`.
    inverse_step: Vector2<f64>,
    /// One over `diagonal_rate`.
    inverse_diagonal_rate: f64,
    /// Where the next triangle begins, m along the line.
    from_m: f64,
    /// The next triangle; `None` at the end of the walk.
    next: Option<Triangle>,
}

impl<H> FacetWalk<'_, H> {
    /// The distance at which the walk leaves a triangle, and through which side.
    ///
    /// For a given heading each side can only be crossed in one direction (e.g. only eastwards), so the walk cannot return to a
    /// triangle it has left.
    #[inline]
    fn exit(&self, triangle: &Triangle) -> (f64, Side) {
        let (col, row) = (coordinate(triangle.col), coordinate(triangle.row));
        let east_or_west = |line: f64| (line - self.start.x) * self.inverse_step.x;
        let north_or_south = |line: f64| (line - self.start.y) * self.inverse_step.y;
        let mut exit = (f64::INFINITY, Side::Diagonal);
        let mut candidate = |crosses: bool, at_m: f64, side: Side| {
            if crosses && at_m < exit.0 {
                exit = (at_m, side);
            }
        };
        match triangle.half {
            Half::NorthEast => {
                candidate(self.step.x > 0.0, east_or_west(col + 1.0), Side::East);
                candidate(self.step.y < 0.0, north_or_south(row), Side::North);
                candidate(
                    self.diagonal_rate < 0.0,
                    ((col - row) - self.diagonal_offset) * self.inverse_diagonal_rate,
                    Side::Diagonal,
                );
            }
            Half::SouthWest => {
                candidate(self.step.x < 0.0, east_or_west(col), Side::West);
                candidate(self.step.y > 0.0, north_or_south(row + 1.0), Side::South);
                candidate(
                    self.diagonal_rate > 0.0,
                    ((col - row) - self.diagonal_offset) * self.inverse_diagonal_rate,
                    Side::Diagonal,
                );
            }
        }
        exit
    }
}

impl<H: Fn(usize, usize) -> f64> Iterator for FacetWalk<'_, H> {
    type Item = FacetSpan;

    #[inline]
    fn next(&mut self) -> Option<FacetSpan> {
        loop {
            let triangle = self.next?;
            let from_m = self.from_m;
            let (exit_m, side) = self.exit(&triangle);
            let to_m = exit_m.max(from_m);
            let height_m = |at_m: f64| triangle.height_m(self.start.x + at_m * self.step.x, self.start.y + at_m * self.step.y);
            let (from_z_m, to_z_m) = (height_m(from_m), height_m(to_m));
            self.next = triangle.beyond(side, &self.ground, &self.heights);
            self.from_m = to_m;
            // A line through a post may clip the corner of a triangle without data over a length within rounding: skip that
            // triangle. A longer span without data ends the walk.
            if from_z_m.is_nan() || to_z_m.is_nan() {
                if to_m > from_m + self.ground.tolerance * self.ground.spacing_m.amin() {
                    self.next = None;
                    return None;
                }
                continue;
            }
            return Some(FacetSpan { from_m, to_m, from_z_m, to_z_m, gradient: triangle.gradient(self.ground.spacing_m) });
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "places on the map only; the cast saturates")]
fn floor(value: f64) -> isize {
    value.floor() as isize
}

#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
fn coordinate(index: isize) -> f64 {
    index as f64
}

/// The height of a post, NaN outside the raster.
#[inline]
fn post(heights: &impl Fn(usize, usize) -> f64, col: isize, row: isize) -> f64 {
    match (usize::try_from(row), usize::try_from(col)) {
        (Ok(row), Ok(col)) => heights(row, col),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        terrain::{FractalGround, GeoReference, SyntheticTerrain, slice, synthesise},
    };

    fn rough() -> Dem {
        let ground = Some(FractalGround { hurst_exponent: 0.6, rms_deviation_m: 0.4, baseline_m: 1.0 });
        let terrain = SyntheticTerrain { rows: 30, cols: 40, seed: 9, ground, craters: None, ..SyntheticTerrain::default() };
        synthesise(&terrain).unwrap()
    }

    /// Compares with the slice, which sorts the crossings of all lines.
    fn agrees_with_slice(dem: &Dem, from: MapPoint, to: MapPoint) {
        let profile = slice(dem, from, to).unwrap();
        let ground = Triangles::of(dem);
        let length_m = profile.length_m();
        let heading = (to - from) / length_m;
        let spans: Vec<FacetSpan> = ground
            .walk(from, heading, ground.nominal())
            .take_while(|s| s.from_m < length_m - 1e-6)
            .filter(|s| s.to_m > s.from_m + 1e-6)
            .collect();
        let segments: Vec<_> = profile.points.windows(2).zip(&profile.facets).filter(|(p, _)| p[1].x_m > p[0].x_m + 1e-6).collect();
        assert_eq!(spans.len(), segments.len(), "from {from} to {to}");
        for (i, (span, (points, facet))) in spans.iter().zip(&segments).enumerate() {
            assert!((span.from_m - points[0].x_m).abs() < 1e-6 && (span.from_z_m - points[0].z_m).abs() < 1e-5, "{span:?}");
            if i + 1 < spans.len() {
                assert!((span.to_m - points[1].x_m).abs() < 1e-6 && (span.to_z_m - points[1].z_m).abs() < 1e-5, "{span:?}");
            }
            let normal = nalgebra::Vector3::new(-span.gradient.x, -span.gradient.y, 1.0).normalize();
            // Along an edge of the lattice, the walk may use either triangle.
            let along = facet.normal.xy().dot(&heading) / facet.normal.z;
            assert!((normal.xy().dot(&heading) / normal.z - along).abs() < 1e-6, "{span:?} against {facet:?}");
        }
    }

    #[test]
    fn walks_agree_with_slices() {
        let dem = rough();
        let mut draw = Draw::seeded(1);
        for _ in 0..400 {
            let mut place = |coarse: bool| {
                let (x, y) = (39.0 * draw.unit(), 29.0 * draw.unit());
                if coarse { MapPoint::new(x.round(), y.round()) } else { MapPoint::new(x, y) }
            };
            for coarse in [false, true] {
                let (from, to) = (place(coarse), place(coarse));
                if (to - from).norm() > 0.1 {
                    agrees_with_slice(&dem, from, to);
                }
            }
        }
        // Along rows, columns, diagonals and the border.
        for (from, to) in [
            ((0.0, 0.0), (39.0, 0.0)),
            ((39.0, 29.0), (0.0, 29.0)),
            ((3.0, 29.0), (3.0, 0.0)),
            ((39.0, 2.0), (39.0, 20.0)),
            ((2.0, 20.0), (20.0, 2.0)),
            ((20.0, 2.0), (2.0, 20.0)),
            ((2.5, 4.0), (30.5, 4.0)),
        ] {
            agrees_with_slice(&dem, MapPoint::new(from.0, from.1), MapPoint::new(to.0, to.1));
        }
    }

    #[test]
    fn walks_end_where_the_ground_ends() {
        let map = GeoReference::local(MapPoint::new(0.0, 2.0), 1.0, 1.0).unwrap();
        let dem = Dem::new(3, 4, vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0], map).unwrap();
        let ground = Triangles::of(&dem);
        let end_m = |from: (f64, f64), heading: (f64, f64)| {
            let spans = ground.walk(MapPoint::new(from.0, from.1), Vector2::new(heading.0, heading.1), ground.nominal());
            spans.last().map(|span| span.to_m)
        };
        assert_eq!(end_m((0.5, 0.25), (-1.0, 0.0)), Some(0.5), "ends at the border");
        assert_eq!(end_m((0.25, 0.5), (1.0, 0.0)), Some(1.25), "ends at the south-west half of the square with the gap");
        assert_eq!(end_m((3.0, 0.0), (1.0, 0.0)), None, "at the border, outwards");
        assert_eq!(end_m((-0.1, 0.0), (1.0, 0.0)), None, "starts off the map");
        assert_eq!(end_m((0.5, 0.5), (0.0, 0.0)), None, "has no direction");
    }
}
