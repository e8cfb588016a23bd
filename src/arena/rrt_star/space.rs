//! Where RRT* stands and drives.

use super::super::{
    Arena, Flight, Move,
    floor::{RISE_TOLERANCE_M, SAME_M},
    levels::{Face, Levels},
};
use crate::quantity::MapPoint;

/// A smaller ring counts as absent, m.
const NO_RING_M: f64 = 1e-6;

/// The heights, the rings about their faces, and the limits of jumps.
pub(super) struct Space<'a> {
    levels: &'a Levels,
    /// The rings as open rectangles: least and greatest coordinates.
    rings: Vec<[f64; 4]>,
    /// The faces that can be jumped.
    pub(super) jumpable: Vec<Face>,
    pub(super) ring_m: f64,
    pub(super) edge_max_m: f64,
    rise_max_m: f64,
    flight: Option<Flight>,
}

impl<'a> Space<'a> {
    pub(super) fn new(arena: &'a Arena, may_jump: bool) -> Self {
        let jumper = arena.jumper();
        let faces = arena.levels().faces();
        let grow_m = jumper.ring_m - SAME_M;
        let rings =
            faces.iter().map(|face| [face.min.x - grow_m, face.min.y - grow_m, face.max.x + grow_m, face.max.y + grow_m]).collect();
        let rise_max_m = if may_jump { jumper.rise_max_m } else { 0.0 };
        let is_jumpable = |face: &Face| may_jump && (face.sides_m[0] - face.sides_m[1]).abs() <= rise_max_m + RISE_TOLERANCE_M;
        let jumpable = faces.into_iter().filter(is_jumpable).collect();
        Self {
            levels: arena.levels(),
            rings,
            jumpable,
            ring_m: jumper.ring_m,
            edge_max_m: jumper.jump_edge_max_m,
            rise_max_m,
            flight: jumper.flight,
        }
    }

    /// The height at a point, m; `None` within a ring.
    pub(super) fn height_m(&self, point: MapPoint) -> Option<f64> {
        let (low_m, high_m) = self.levels.within(point, self.ring_m);
        (low_m == high_m).then_some(low_m)
    }

    /// Where a jump that is a flight takes off and lands, as shares of the way.
    pub(super) fn split(&self, (from, from_m): (MapPoint, f64), (to, to_m): (MapPoint, f64)) -> Option<[f64; 2]> {
        let rise_m = to_m - from_m;
        let flight =
            self.flight.filter(|_| rise_m > 0.0 && self.rise_max_m > 0.0 && rise_m <= self.rise_max_m + RISE_TOLERANCE_M)?;
        flight.split(self.levels, (from, to), (from_m, to_m), self.ring_m)
    }

    /// How one gets straight from one place to another; `None`: not at all.
    pub(super) fn joined(&self, (from, from_m): (MapPoint, f64), (to, to_m): (MapPoint, f64)) -> Option<Move> {
        if from_m == to_m {
            let is_clear = if self.ring_m > NO_RING_M {
                !self.rings.iter().any(|ring| passes_through(ring, from, to))
            } else {
                // Without a ring the faces themselves are in the way.
                let mut is_level = true;
                let (start_m, _) = self.levels.walk(from, to, |_| {
                    is_level = false;
                    false
                });
                is_level && start_m == from_m
            };
            return is_clear.then_some(Move::Drive);
        }
        let is_up = to_m > from_m;
        if is_up && self.flight.is_some() {
            return self.split((from, from_m), (to, to_m)).map(|_| Move::Jump);
        }
        if (to - from).norm() > self.edge_max_m {
            return None;
        }
        if is_up && to_m - from_m > self.rise_max_m + RISE_TOLERANCE_M {
            return None;
        }
        let mut holds = true;
        self.levels.walk(from, to, |step| {
            holds &= if is_up { step.from_m == from_m && step.to_m == to_m } else { step.to_m < step.from_m };
            holds
        });
        // Without a ring a place may be on a face, and the line along it.
        let kind = if is_up && self.rise_max_m > 0.0 { Move::Jump } else { Move::Drop };
        (holds && (!is_up || self.rise_max_m > 0.0)).then_some(kind)
    }
}

/// Whether a segment passes through an open rectangle.
fn passes_through([x0, y0, x1, y1]: &[f64; 4], from: MapPoint, to: MapPoint) -> bool {
    if from.x.max(to.x) <= *x0 || from.x.min(to.x) >= *x1 || from.y.max(to.y) <= *y0 || from.y.min(to.y) >= *y1 {
        return false;
    }
    // All corners on one side of the line: no.
    let way = to - from;
    let side = |x: f64, y: f64| way.x * (y - from.y) - way.y * (x - from.x);
    let sides = [side(*x0, *y0), side(*x1, *y0), side(*x1, *y1), side(*x0, *y1)];
    !(sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0))
}
