//! The places where a taut path may bend.
//!
//! ```text
//!            before ^      Cutting the corner on the inner side of the bend makes the path shorter. So a taut
//!                   |      path bends only where that would take more jumps than going through the corner, or
//!      after <------o      where a face in between is too high.
//!            inner  :
//! ```

use super::levels::{Quadrants, jumps_between};
use crate::quantity::MapPoint;

/// Directions this close are the same, as a sine.
const SAME: f64 = 1e-12;

/// A place where lines through faces meet, with the heights of the four cells about it.
pub(super) struct Corner {
    pub(super) point: MapPoint,
    pub(super) quadrants: Quadrants,
}

/// The quadrant just clockwise and the one just counter-clockwise of a direction: the same one unless it is along an axis.
fn beside([x, y]: [f64; 2]) -> (usize, usize) {
    match (x.abs() <= SAME, y.abs() <= SAME) {
        (false, true) => {
            if x > 0.0 {
                (3, 0)
            } else {
                (1, 2)
            }
        }
        (true, _) => {
            if y > 0.0 {
                (0, 1)
            } else {
                (2, 3)
            }
        }
        (false, false) => {
            let own = match (x > 0.0, y > 0.0) {
                (true, true) => 0,
                (false, true) => 1,
                (false, false) => 2,
                (true, false) => 3,
            };
            (own, own)
        }
    }
}

impl Corner {
    /// Whether a path may bend here: not on level ground, and not at a straight face, where cutting the bend crosses what the bend crosses.
    pub(super) fn has_bend(&self) -> bool {
        let [first, second, third, fourth] = self.quadrants;
        let is_straight_across = first == second && third == fourth;
        let is_straight_up = first == fourth && second == third;
        !is_straight_across && !is_straight_up
    }

    /// The height just beyond the corner in a direction, m.
    pub(super) fn level_towards(&self, direction: [f64; 2]) -> f64 {
        let (clockwise, counter) = beside(direction);
        self.quadrants[clockwise].min(self.quadrants[counter])
    }

    /// Whether a path that arrives in a direction at a height may bend here.
    pub(super) fn may_bend(&self, before: [f64; 2], level_m: f64, rise_max_m: f64) -> bool {
        let back = [-before[0], -before[1]];
        let is_costly = |way: &[usize], end_m: f64| {
            let through = jumps_between(level_m, end_m, &self.quadrants, rise_max_m);
            through.is_some_and(|jumps| self.inner_jumps(level_m, way, end_m, rise_max_m).is_none_or(|inner| inner > jumps))
        };
        // To the left the inner cells follow each other clockwise from the way back, to the right counter-clockwise.
        [(beside(back).0, beside(before).1, 3), (beside(back).1, beside(before).0, 1)].into_iter().any(|(first, last, step)| {
            let mut way = vec![first];
            loop {
                let own = way[way.len() - 1];
                let next = (own + step) % 4;
                let along_axis_m = self.quadrants[own].min(self.quadrants[next]);
                if is_costly(&way, self.quadrants[own]) || is_costly(&way, along_axis_m) {
                    return true;
                }
                if own == last || way.len() == 4 {
                    return false;
                }
                way.push(next);
            }
        })
    }

    /// Whether cutting the corner between two directions would take more jumps than going through it, or is not possible.
    pub(super) fn bends_around(
        &self,
        (before, after): ([f64; 2], [f64; 2]),
        (from_m, to_m): (f64, f64),
        through: u32,
        rise_max_m: f64,
    ) -> bool {
        let cross = before[0] * after[1] - before[1] * after[0];
        let dot = before[0] * after[0] + before[1] * after[1];
        if cross.abs() <= SAME {
            // Straight on is a line of its own; straight back goes around the end of a face.
            return dot < 0.0;
        }
        let back = [-before[0], -before[1]];
        let (first, last, step) =
            if cross > 0.0 { (beside(back).0, beside(after).1, 3) } else { (beside(back).1, beside(after).0, 1) };
        let mut way = [first; 4];
        let mut count = 1;
        while way[count - 1] != last && count < 4 {
            way[count] = (way[count - 1] + step) % 4;
            count += 1;
        }
        self.inner_jumps(from_m, &way[..count], to_m, rise_max_m).is_none_or(|inner| inner > through)
    }

    /// The jumps of the way over these cells, one after the other; `None` if a face is too high.
    fn inner_jumps(&self, from_m: f64, way: &[usize], to_m: f64, rise_max_m: f64) -> Option<u32> {
        let mut now_m = from_m;
        let mut jumps = 0;
        for level_m in way.iter().map(|cell| self.quadrants[*cell]).chain([to_m]) {
            jumps += jumps_between(now_m, level_m, &[], rise_max_m)?;
            now_m = level_m;
        }
        Some(jumps)
    }
}
