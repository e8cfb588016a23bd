//! The heights over the floor, as cells between the lines through the faces of the boxes.
//!
//! ```text
//!      y2 +---+---+---+        each cell has one height: that of its highest box;
//!         | 0 |0.6|1.2|        a point on a line belongs to the lowest cell that it touches,
//!      y1 +---+---+---+        so driving along a face is allowed, and no gap is left between two boxes
//!         | 0 | 0 |1.2|        that touch; outside of the floor the height is infinite
//!      y0 +---+---+---+
//!         x0  x1  x2  x3
//! ```

use super::floor::{ArenaBox, RISE_TOLERANCE_M, SAME_M};
use crate::quantity::MapPoint;
use nalgebra::Vector2;

/// Heights by cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Levels {
    xs: Vec<f64>,
    ys: Vec<f64>,
    /// Row by row, (columns) x (rows), where columns = lines along x less one.
    cells: Vec<f64>,
}

/// The four cells that meet at a point, counter-clockwise from that towards +x and +y: the same cell several times if the point is on no line.
pub(super) type Quadrants = [f64; 4];

/// A line that a segment crosses, at a share of its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// The share.
    pub(super) at: f64,
    /// The height before it, m.
    pub(super) from_m: f64,
    /// The height after it, m.
    pub(super) to_m: f64,
    /// The cells about the point, if lines in both directions are crossed there.
    pub(super) corner: Option<Quadrants>,
    /// Whether a line across x is crossed, and one across y.
    across: [bool; 2],
}

impl Step {
    /// The sine of the angle between a direction and the face, the smaller one at a corner.
    pub(super) fn sine(&self, direction: Vector2<f64>) -> f64 {
        let of_x = if self.across[0] { direction.x.abs() } else { 1.0 };
        let of_y = if self.across[1] { direction.y.abs() } else { 1.0 };
        of_x.min(of_y)
    }
}

/// What a segment crosses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossed {
    /// The jumps on the way.
    pub(super) jumps: u32,
    /// The height where it begins, m.
    pub(super) start_m: f64,
    /// The height where it ends, m.
    pub(super) end_m: f64,
}

/// A piece of a face: a line between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    /// Its end with the least coordinates.
    pub(super) min: MapPoint,
    /// Its other end.
    pub(super) max: MapPoint,
    /// The heights on its two sides, that towards less x or y first, m.
    pub(super) sides_m: [f64; 2],
}

/// Which cells a coordinate is in: one, or the two beside a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Band {
    low: isize,
    high: isize,
}

impl Levels {
    /// The heights of boxes on a floor.
    pub(super) fn new(size_m: [f64; 2], boxes: &[ArenaBox]) -> Self {
        let lines = |size_m: f64, faces: &dyn Fn(&ArenaBox) -> [f64; 2]| {
            let on_floor = boxes.iter().flat_map(faces).filter(|at| *at > SAME_M && *at < size_m - SAME_M);
            let mut lines: Vec<f64> = on_floor.chain([0.0, size_m]).collect();
            lines.sort_unstable_by(f64::total_cmp);
            lines.dedup_by(|next, kept| *next - *kept <= SAME_M);
            lines
        };
        let xs = lines(size_m[0], &|one| [one.min.x, one.max.x]);
        let ys = lines(size_m[1], &|one| [one.min.y, one.max.y]);
        let columns = xs.len() - 1;
        let mut cells = vec![0.0; columns * (ys.len() - 1)];
        let range = |lines: &[f64], low: f64, high: f64| {
            let first = lines.partition_point(|line| *line < low - SAME_M);
            let end = lines.partition_point(|line| *line < high - SAME_M).min(lines.len() - 1);
            first..end
        };
        for one in boxes {
            for row in range(&ys, one.min.y, one.max.y) {
                for cell in &mut cells[row * columns..][range(&xs, one.min.x, one.max.x)] {
                    *cell = one.height_m.max(*cell);
                }
            }
        }
        Self { xs, ys, cells }
    }

    /// The lines across x and across y.
    pub(super) fn lines(&self) -> (&[f64], &[f64]) {
        (&self.xs, &self.ys)
    }

    /// The faces inside the floor, each piece between the same two heights joined.
    pub(super) fn faces(&self) -> Vec<Face> {
        let mut faces: Vec<Face> = Vec::new();
        let mut add = |min: MapPoint, max: MapPoint, sides_m: [f64; 2]| {
            if sides_m[0] == sides_m[1] {
                return;
            }
            match faces.last_mut() {
                Some(last) if last.max == min && last.sides_m == sides_m => last.max = max,
                _ => faces.push(Face { min, max, sides_m }),
            }
        };
        let cell = |column: usize, row: usize| self.cell(column.cast_signed(), row.cast_signed());
        for i in 1..self.xs.len() - 1 {
            for (j, ends) in self.ys.windows(2).enumerate() {
                let at = |y: f64| MapPoint::new(self.xs[i], y);
                add(at(ends[0]), at(ends[1]), [cell(i - 1, j), cell(i, j)]);
            }
        }
        for j in 1..self.ys.len() - 1 {
            for (i, ends) in self.xs.windows(2).enumerate() {
                let at = |x: f64| MapPoint::new(x, self.ys[j]);
                add(at(ends[0]), at(ends[1]), [cell(i, j - 1), cell(i, j)]);
            }
        }
        faces
    }

    /// The height of a cell, m.
    fn cell(&self, column: isize, row: isize) -> f64 {
        let columns = self.xs.len() - 1;
        match (usize::try_from(column), usize::try_from(row)) {
            (Ok(column), Ok(row)) if column < columns && row < self.ys.len() - 1 => self.cells[row * columns + column],
            _ => f64::INFINITY,
        }
    }

    /// The cells that meet at a point.
    pub(super) fn quadrants(&self, point: MapPoint) -> Quadrants {
        self.about(Band::of(&self.xs, point.x), Band::of(&self.ys, point.y))
    }

    fn about(&self, x: Band, y: Band) -> Quadrants {
        [self.cell(x.high, y.high), self.cell(x.low, y.high), self.cell(x.low, y.low), self.cell(x.high, y.low)]
    }

    /// The height at a point, m: the least of the cells that touch it.
    pub(super) fn at(&self, point: MapPoint) -> f64 {
        self.quadrants(point).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The heights of the nodes of a grid, row by row.
    pub(super) fn at_nodes(&self, xs: &[f64], ys: &[f64]) -> Vec<f64> {
        let bands = |lines: &[f64], at: &[f64]| -> Vec<Band> { at.iter().map(|at| Band::of(lines, *at)).collect() };
        let columns = bands(&self.xs, xs);
        let rows = bands(&self.ys, ys);
        let mut heights = Vec::with_capacity(xs.len() * ys.len());
        for y in rows {
            heights.extend(columns.iter().map(|x| self.about(*x, y).into_iter().fold(f64::INFINITY, f64::min)));
        }
        heights
    }

    /// Whether a line inside the floor runs along each of these coordinates.
    pub(super) fn on_faces(&self, xs: &[f64], ys: &[f64]) -> [Vec<bool>; 2] {
        let on = |lines: &[f64], at: &[f64]| {
            let is_on = |at: &f64| {
                let Band { low, high } = Band::of(lines, *at);
                low != high && low >= 0 && high + 1 < lines.len().cast_signed()
            };
            at.iter().map(is_on).collect()
        };
        [on(&self.xs, xs), on(&self.ys, ys)]
    }

    /// The least and the greatest height within `ring_m` of a point along x and y, the border of that square left out.
    pub(super) fn within(&self, point: MapPoint, ring_m: f64) -> (f64, f64) {
        let range = |lines: &[f64], at: f64| {
            let first = lines.partition_point(|line| *line <= at - ring_m + SAME_M).saturating_sub(1);
            let end = lines.partition_point(|line| *line < at + ring_m - SAME_M).clamp(first + 1, lines.len() - 1);
            first..end
        };
        let (columns, rows) = (range(&self.xs, point.x), range(&self.ys, point.y));
        let width = self.xs.len() - 1;
        let heights = rows.flat_map(|row| &self.cells[row * width..][columns.clone()]);
        heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (height.min(low), height.max(high)))
    }

    /// The lines that the segment between two points of the floor crosses, in order, until `visit` returns false; returns the heights where the
    /// segment begins and ends.
    ///
    /// A segment along a line has the height of the lower of the two cells beside it.
    pub(super) fn walk(&self, from: MapPoint, to: MapPoint, mut visit: impl FnMut(Step) -> bool) -> (f64, f64) {
        let mut x = Axis::new(&self.xs, from.x, to.x);
        let mut y = Axis::new(&self.ys, from.y, to.y);
        let length_m = (to - from).norm();
        let same = SAME_M / length_m.max(SAME_M);
        let height = |x: &Axis<'_>, y: &Axis<'_>| self.about(x.band, y.band).into_iter().fold(f64::INFINITY, f64::min);
        let start_m = height(&x, &y);
        let mut now_m = start_m;
        loop {
            let at = x.next.min(y.next);
            if at >= 1.0 - same {
                return (start_m, now_m);
            }
            let both = x.next - at <= same && y.next - at <= same;
            let corner = both.then(|| self.about(x.about_line(), y.about_line()));
            let across = [x.next - at <= same, y.next - at <= same];
            if across[0] {
                x.advance();
            }
            if across[1] {
                y.advance();
            }
            let to_m = height(&x, &y);
            if to_m != now_m && !visit(Step { at, from_m: now_m, to_m, corner, across }) {
                return (start_m, to_m);
            }
            now_m = to_m;
        }
    }

    /// The jumps of a segment, each over one face and with at most this rise; `None` if a face is too high.
    pub(super) fn crossed(&self, from: MapPoint, to: MapPoint, rise_max_m: f64) -> Option<Crossed> {
        let mut jumps = Some(0);
        let (start_m, end_m) = self.walk(from, to, |step| {
            let more = jumps_between(step.from_m, step.to_m, step.corner.as_ref().map_or(&[], |cells| cells), rise_max_m);
            jumps = jumps.zip(more).map(|(jumps, more)| jumps + more);
            jumps.is_some()
        });
        jumps.map(|jumps| Crossed { jumps, start_m, end_m })
    }
}

/// The fewest jumps from one height to another at a point, by the heights of the other cells that meet there; `None` if there are too few
/// steps.
pub(super) fn jumps_between(from_m: f64, to_m: f64, others: &[f64], rise_max_m: f64) -> Option<u32> {
    let reach_m = rise_max_m + if rise_max_m > 0.0 { RISE_TOLERANCE_M } else { 0.0 };
    let (mut now_m, mut jumps) = (from_m, 0);
    while now_m < to_m {
        let highest = |top: f64, other: &f64| if *other <= now_m + reach_m { other.max(top) } else { top };
        let next_m = if to_m <= now_m + reach_m { to_m } else { others.iter().fold(now_m, highest) };
        if next_m <= now_m {
            return None;
        }
        now_m = next_m;
        jumps += 1;
    }
    Some(jumps)
}

impl Band {
    /// The cells of a coordinate.
    fn of(lines: &[f64], at: f64) -> Self {
        // The first line that is not before the coordinate.
        let next = lines.partition_point(|line| *line < at - SAME_M).cast_signed();
        let is_on_line = lines.get(next.unsigned_abs()).is_some_and(|line| (line - at).abs() <= SAME_M);
        Self { low: next - 1, high: if is_on_line { next } else { next - 1 } }
    }
}

/// The way of a segment along one coordinate.
struct Axis<'a> {
    lines: &'a [f64],
    from: f64,
    /// The change over the whole segment.
    change: f64,
    /// The cells where it is.
    band: Band,
    /// The line that is crossed next, and at which share of the segment; infinite if none is.
    line: isize,
    next: f64,
}

impl<'a> Axis<'a> {
    fn new(lines: &'a [f64], from: f64, to: f64) -> Self {
        let mut band = Band::of(lines, from);
        // The same line, whatever rounding made of the two ends.
        let change = if (to - from).abs() <= SAME_M { 0.0 } else { to - from };
        if change > 0.0 {
            band.low = band.high;
        } else if change < 0.0 {
            band.high = band.low;
        }
        let mut axis = Self { lines, from, change, band, line: 0, next: f64::INFINITY };
        if change != 0.0 {
            axis.line = if change > 0.0 { band.low + 1 } else { band.low };
            axis.look();
        }
        axis
    }

    /// The share of the line ahead.
    fn look(&mut self) {
        let line = usize::try_from(self.line).ok().and_then(|line| self.lines.get(line));
        self.next = line.map_or(f64::INFINITY, |line| (line - self.from) / self.change);
    }

    /// The two cells beside the line ahead.
    fn about_line(&self) -> Band {
        if self.change == 0.0 { self.band } else { Band { low: self.line - 1, high: self.line } }
    }

    fn advance(&mut self) {
        let step = if self.change > 0.0 { 1 } else { -1 };
        self.line += step;
        self.band = Band { low: self.band.low + step, high: self.band.high + step };
        self.look();
    }
}
