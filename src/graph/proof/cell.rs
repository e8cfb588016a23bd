//! Division of the chain's continuum into cells: every vertex is a cell, and every segment is divided into stretches.

use super::Faults;
use crate::{
    chain::{PolygonalChain, Site, Station},
    quantity::{Interval, SegmentId, VertexId},
};

/// A vertex, or a stretch inside one segment, which may be a single point.
///
/// A stretch includes its ends, with the constraints of its own segment. At an end that is a vertex this includes more than
/// the ground has, never less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell<R> {
    /// The vertex or segment.
    pub(super) site: Site,
    /// x of its left end, m.
    pub(super) from_m: f64,
    /// x of its right end, m.
    pub(super) to_m: f64,
    /// The ground's height at both ends, m.
    pub(super) heights_m: [Interval<R>; 2],
}

impl<R: crate::quantity::Rounding> Cell<R> {
    /// The ends; only one if the cell is a point.
    pub(super) fn ends(&self) -> impl Iterator<Item = (f64, Interval<R>)> {
        let [first, last] = self.heights_m;
        let other = (self.from_m < self.to_m).then_some((self.to_m, last));
        std::iter::once((self.from_m, first)).chain(other)
    }

    /// The lowest and the highest ground of the cell, m.
    pub(super) fn height_range_m(&self) -> (f64, f64) {
        let [first, last] = self.heights_m;
        (first.lower.min(last.lower), first.upper.max(last.upper))
    }

    /// The length along x, m.
    pub(super) fn width_m(&self) -> f64 {
        self.to_m - self.from_m
    }

    /// The x that divides a stretch in two; `None` for a point, or if there is no double between the ends.
    pub(super) fn middle_m(&self) -> Option<f64> {
        let middle_m = self.from_m + 0.5 * (self.to_m - self.from_m);
        (self.from_m < middle_m && middle_m < self.to_m).then_some(middle_m)
    }
}

/// The segment shared by two neighbouring sites, the left one first.
pub(super) fn shared_segment(left: Site, right: Site) -> Option<SegmentId> {
    let ahead = match left {
        Site::Vertex(v) => v.index(),
        Site::Inside(s) => s.index(),
    };
    let behind = match right {
        Site::Vertex(v) => v.index().checked_sub(1)?,
        Site::Inside(s) => s.index(),
    };
    (ahead == behind).then_some(SegmentId(ahead))
}

/// An enclosure of the exact slope dz/dx of every segment.
pub(super) fn slopes<F: Faults>(geometry: &PolygonalChain) -> Vec<Interval<F::Rounding>> {
    let point = Interval::point;
    geometry.vertices().windows(2).map(|v| (point(v[1].z_m) - point(v[0].z_m)) / (point(v[1].x_m) - point(v[0].x_m))).collect()
}

/// The cells of a chain from left to right: each vertex, the start and the goal as a cell of its own, and one stretch between
/// neighbours.
pub(super) fn partition<F: Faults>(
    geometry: &PolygonalChain,
    slopes: &[Interval<F::Rounding>],
    [start, goal]: [&Station; 2],
) -> Vec<Cell<F::Rounding>> {
    let mut cells = Vec::with_capacity(2 * slopes.len() + 5);
    let is_end = |x_m: f64| x_m == start.point.x_m || x_m == goal.point.x_m;
    for (i, pair) in geometry.vertices().windows(2).enumerate() {
        let mut own = [start, goal].map(|end| (end.site == Site::Inside(SegmentId(i))).then_some(end.point.x_m));
        own.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        if !F::DROPS_VERTICES || is_end(pair[0].x_m) {
            cells.push(vertex(geometry, i));
        }
        let mut from_m = pair[0].x_m;
        for x_m in own.into_iter().flatten() {
            if x_m > from_m {
                cells.push(stretch::<F>(geometry, slopes, SegmentId(i), from_m, x_m));
                cells.push(stretch::<F>(geometry, slopes, SegmentId(i), x_m, x_m));
            }
            from_m = x_m;
        }
        cells.push(stretch::<F>(geometry, slopes, SegmentId(i), from_m, pair[1].x_m));
    }
    let last = geometry.segment_count();
    if !F::DROPS_VERTICES || is_end(geometry.vertices()[last].x_m) {
        cells.push(vertex(geometry, last));
    }
    cells
}

/// The cell of a vertex.
fn vertex<R: crate::quantity::Rounding>(geometry: &PolygonalChain, index: usize) -> Cell<R> {
    let point = geometry.vertices()[index];
    let height = Interval::point(point.z_m);
    Cell { site: Site::Vertex(VertexId(index)), from_m: point.x_m, to_m: point.x_m, heights_m: [height; 2] }
}

/// A stretch of a segment.
pub(super) fn stretch<F: Faults>(
    geometry: &PolygonalChain,
    slopes: &[Interval<F::Rounding>],
    segment: SegmentId,
    from_m: f64,
    to_m: f64,
) -> Cell<F::Rounding> {
    let [a, b] = [0, 1].map(|end| geometry.vertices()[segment.index() + end]);
    let slope = slopes[segment.index()];
    let point = Interval::point;
    // Computed from the nearer vertex, which keeps more digits.
    let height = |x_m: f64| {
        if x_m == a.x_m {
            point(a.z_m)
        } else if x_m == b.x_m {
            point(b.z_m)
        } else if x_m - a.x_m <= b.x_m - x_m {
            point(a.z_m) + slope * (point(x_m) - point(a.x_m))
        } else {
            point(b.z_m) - slope * (point(b.x_m) - point(x_m))
        }
    };
    Cell { site: Site::Inside(segment), from_m, to_m, heights_m: [height(from_m), height(to_m)] }
}
