//! Intersections of a line on the map with the lines of the lattice.

use nalgebra::Vector2;

use super::facet::Ground;
use crate::quantity::MapPoint;

/// A vertex of the slice: its position on the lattice, on the map, and along the transect.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) x_m: f64,
    pub(super) lattice: Vector2<f64>,
    pub(super) map: MapPoint,
    rank: Rank,
}

/// Which of two vertices at the same position is kept: the one of higher rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Diagonal,
    Line,
    Post,
    End,
}

/// Distances that differ by less than the rounding of the transect's length, as a fraction of it.
const SAME_PLACE: f64 = 4.0 * f64::EPSILON;

/// All vertices from `from` to `to`, at strictly increasing distances.
///
/// They are computed with the two ends in one order for both directions of travel, so that both give the same vertices. Each
/// is computed from the number of its own line, so that errors do not accumulate.
pub(super) fn crossings(ground: &Ground<'_>, from: MapPoint, to: MapPoint, length_m: f64) -> Vec<Crossing> {
    let backwards = (to.x, to.y) < (from.x, from.y);
    let (first, last) = if backwards { (to, from) } else { (from, to) };
    let transect = Transect::new(ground, first, last, length_m);
    let mut found = Vec::new();
    transect.push_crossings(&mut found, Vector2::new(1.0, 0.0));
    transect.push_crossings(&mut found, Vector2::new(0.0, 1.0));
    transect.push_crossings(&mut found, Vector2::new(1.0, -1.0));
    found.sort_by(|a, b| a.x_m.total_cmp(&b.x_m).then(a.rank.cmp(&b.rank)));
    let mut vertices = vec![Crossing { x_m: 0.0, lattice: transect.start, map: first, rank: Rank::End }];
    let end = Crossing { x_m: length_m, lattice: transect.end, map: last, rank: Rank::End };
    for crossing in found.into_iter().chain([end]) {
        push_apart(&mut vertices, crossing, SAME_PLACE * length_m);
    }
    if backwards {
        vertices.reverse();
        for vertex in &mut vertices {
            vertex.x_m = length_m - vertex.x_m;
        }
    }
    vertices
}

/// Adds a vertex, or decides which of two at the same position is kept.
fn push_apart(vertices: &mut Vec<Crossing>, crossing: Crossing, closest_m: f64) {
    // The first vertex, the start, is always kept.
    while let Some(previous) = vertices.last() {
        if crossing.x_m - previous.x_m > closest_m {
            break;
        }
        let only_the_start = vertices.len() == 1;
        if crossing.rank == Rank::End && only_the_start {
            break;
        }
        if only_the_start || previous.rank >= crossing.rank {
            return;
        }
        vertices.pop();
    }
    vertices.push(crossing);
}

/// The line in lattice coordinates.
struct Transect<'a> {
    ground: &'a Ground<'a>,
    start: Vector2<f64>,
    end: Vector2<f64>,
    step: Vector2<f64>,
    origin: MapPoint,
    along: Vector2<f64>,
    heading: Vector2<f64>,
}

impl<'a> Transect<'a> {
    fn new(ground: &'a Ground<'a>, first: MapPoint, last: MapPoint, length_m: f64) -> Self {
        // Ends within the tolerance of a line are moved onto it: otherwise a line crossed at a flat angle would have a second
        // crossing next to them.
        let (start, end) = (ground.snapped(ground.lattice(first)), ground.snapped(ground.lattice(last)));
        let along = last - first;
        let heading = Vector2::new(along.x / length_m, along.y / length_m);
        Self { ground, start, end, step: end - start, origin: first, along, heading }
    }

    /// Adds the intersections with the lines `normal . (u, v) = integer`.
    fn push_crossings(&self, found: &mut Vec<Crossing>, normal: Vector2<f64>) {
        let [begin, end] = [self.start, self.end].map(|place| self.ground.nearly_whole(normal.dot(&place)));
        let change = end - begin;
        let (low, high) = if begin <= end { (begin, end) } else { (end, begin) };
        let mut line = low.ceil();
        while line <= high && change != 0.0 {
            let share = ((line - begin) / change).clamp(0.0, 1.0);
            let crossing = self.crossing(normal, line, share);
            if !self.at_an_end(crossing.lattice) {
                found.push(crossing);
            }
            line += 1.0;
        }
    }

    /// The vertex on a line, moved onto a post if it is at one.
    fn crossing(&self, normal: Vector2<f64>, line: f64, share: f64) -> Crossing {
        let mut lattice = self.start + self.step * share;
        let mut map = self.origin + self.along * share;
        let mut rank = Rank::Diagonal;
        if normal.y == 0.0 {
            lattice.x = line;
            rank = Rank::Line;
        } else if normal.x == 0.0 {
            lattice.y = line;
            rank = Rank::Line;
        }
        let near = self.ground.snapped(lattice);
        if near.x.fract() == 0.0 && near.y.fract() == 0.0 {
            lattice = near;
            rank = Rank::Post;
        } else if rank == Rank::Diagonal {
            // u - v = k: the smaller coordinate has more digits; the other is computed from it exactly.
            lattice.x = lattice.y + line;
        }
        let exact = self.ground.map_point(lattice);
        if lattice.x.fract() == 0.0 {
            map.x = exact.x;
        }
        if lattice.y.fract() == 0.0 {
            map.y = exact.y;
        }
        Crossing { x_m: self.distance_m(lattice), lattice, map, rank }
    }

    /// Distance along the transect of the projection of a lattice point on it: exact along rows and columns from a post.
    fn distance_m(&self, lattice: Vector2<f64>) -> f64 {
        let away = self.ground.metres(lattice - self.start);
        away.dot(&self.heading)
    }

    fn at_an_end(&self, lattice: Vector2<f64>) -> bool {
        let near = |end: Vector2<f64>| (lattice - end).amax() <= self.ground.tolerance();
        near(self.start) || near(self.end)
    }
}
