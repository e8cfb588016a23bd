//! Polygons on the map, and their intersection with a straight line.

use nalgebra::Vector2;

use super::line::Line;
use crate::{quantity::MapPoint, terrain::MapBounds};

/// A polygon: its outer and inner rings, without the repeated last point.
///
/// Points inside are those separated from infinity by an odd number of ring edges (even-odd rule), so holes and
/// self-intersecting rings need no special case. Border points belong to the polygon, including those of holes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polygon {
    rings: Vec<Vec<MapPoint>>,
    bounds: MapBounds,
}

/// The greatest number of pieces of an edge; an edge longer than the largest raster is divided into longer pieces.
const MOST_PIECES: f64 = 1.0e5;

impl Polygon {
    /// A polygon from rings with finite points; `None` without points.
    pub(super) fn new(rings: Vec<Vec<MapPoint>>) -> Option<Self> {
        let first = *rings.first()?.first()?;
        let bounds = rings.iter().flatten().fold(MapBounds { min: first, max: first }, |bounds, point| MapBounds {
            min: bounds.min.inf(point),
            max: bounds.max.sup(point),
        });
        Some(Self { rings, bounds })
    }

    /// Its rings, each closed by its first point at its end as well.
    pub(super) fn outlines(&self) -> impl Iterator<Item = Vec<MapPoint>> + '_ {
        self.rings.iter().map(|ring| {
            let closes = ring.first().filter(|first| ring.last() != Some(first));
            ring.iter().chain(closes).copied().collect()
        })
    }

    /// The smallest rectangle around it.
    pub(super) fn bounds(&self) -> MapBounds {
        self.bounds
    }

    /// Calls `visit` with the rectangle around every piece of its edges, each at most `longest_m` long.
    pub(super) fn borders(&self, longest_m: f64, visit: &mut dyn FnMut(MapBounds)) {
        for ring in &self.rings {
            for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                let pieces = ((b - a).norm() / longest_m).ceil().clamp(1.0, MOST_PIECES);
                let at = |piece: f64| a + (b - a) * (piece / pieces);
                let mut piece = 0.0;
                while piece < pieces {
                    let (from, to) = (at(piece), at(piece + 1.0));
                    visit(MapBounds { min: from.inf(&to), max: from.sup(&to) });
                    piece += 1.0;
                }
            }
        }
    }

    /// The parts of a line that lie in the polygon, m along it, in any order.
    ///
    /// In the line's own frame each end of an edge is to the left (above), to the right (below) or on the line. An edge with
    /// one end above the line and one not above it crosses a line shifted slightly upwards exactly once, so these crossings,
    /// sorted, are the ends of the parts just above the line; the same holds below. A point of the line on no edge has the
    /// same result above and below. Edges on the line are parts themselves, since the border belongs to the zone.
    pub(super) fn parts_on(&self, line: &Line) -> Vec<(f64, f64)> {
        if !self.may_meet(line) {
            return Vec::new();
        }
        let mut parts = Vec::new();
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for ring in &self.rings {
            let points: Vec<Vector2<f64>> = ring.iter().map(|point| self.snapped(line, *point)).collect();
            for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
                if a.y == 0.0 && b.y == 0.0 {
                    parts.push((a.x.min(b.x), a.x.max(b.x)));
                    continue;
                }
                let along_m = a.x + (b.x - a.x) * (a.y / (a.y - b.y));
                if (a.y > 0.0) != (b.y > 0.0) {
                    above.push(along_m);
                }
                if (a.y < 0.0) != (b.y < 0.0) {
                    below.push(along_m);
                }
            }
        }
        for mut places in [above, below] {
            places.sort_by(f64::total_cmp);
            parts.extend(places.chunks_exact(2).map(|pair| (pair[0], pair[1])));
        }
        parts
    }

    /// Whether a position lies in the polygon; its border, within the rounding of its coordinates, belongs to it.
    ///
    /// Counts the edges that a ray to the east crosses; each edge includes its southern end and excludes its northern one.
    pub(super) fn contains(&self, at: MapPoint) -> bool {
        if !self.bounds.contains(at) {
            return false;
        }
        let near_m = 8.0 * f64::EPSILON * self.largest_m();
        let mut inside = false;
        for ring in &self.rings {
            for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                let (edge, away) = (b - a, at - a);
                let share = (away.dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0);
                // An edge of zero length is a point.
                let foot = if share.is_nan() { away } else { away - edge * share };
                if foot.norm() <= near_m {
                    return true;
                }
                if (a.y > at.y) != (b.y > at.y) && at.x < a.x + edge.x * (away.y / edge.y) {
                    inside = !inside;
                }
            }
        }
        inside
    }

    /// Its largest absolute coordinate.
    fn largest_m(&self) -> f64 {
        let MapBounds { min, max } = self.bounds;
        [min.x, min.y, max.x, max.y].into_iter().map(f64::abs).fold(0.0, f64::max)
    }

    /// A ring's point in the line's frame, moved onto the line if it is within the tolerance.
    fn snapped(&self, line: &Line, point: MapPoint) -> Vector2<f64> {
        let frame = line.frame(point);
        let rounding_m = 8.0 * f64::EPSILON * self.largest_m();
        if frame.y.abs() <= line.tolerance_m.max(rounding_m) { Vector2::new(frame.x, 0.0) } else { frame }
    }

    /// Whether the rectangle around the polygon touches the one around the line.
    fn may_meet(&self, line: &Line) -> bool {
        let (low, high) = (line.origin.inf(&line.end), line.origin.sup(&line.end));
        let near = line.tolerance_m;
        self.bounds.min.x <= high.x + near
            && low.x - near <= self.bounds.max.x
            && self.bounds.min.y <= high.y + near
            && low.y - near <= self.bounds.max.y
    }
}
