//! Jumps as flights: a parabola with one take-off speed and angle, as a spring gives it, over the edge of a box.
//!
//! ```text
//!                 . - ~ - .                    H  apex, R  range on level ground
//!              .             `
//!            /     +----------o------          it comes down on the box at x(h), where it is still falling
//!     -------o     |   past                    past   what the landing keeps from the edge
//!            <----- x(h) ----->
//! ```

use super::{floor::RISE_TOLERANCE_M, keys::FlightKeys, levels::Levels};
use crate::{
    ballistics::{Arc, LineOfSight},
    quantity::MapPoint,
};

/// The flight of every jump: its speeds along the floor and up at take-off, and gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    along_m_s: f64,
    up_m_s: f64,
    gravity_m_s2: f64,
}

impl Flight {
    pub(super) fn of(keys: &FlightKeys) -> Self {
        let angle = keys.takeoff_angle_deg.to_radians();
        let (along_m_s, up_m_s) = (keys.takeoff_speed_m_s * libm::cos(angle), keys.takeoff_speed_m_s * libm::sin(angle));
        Self { along_m_s, up_m_s, gravity_m_s2: keys.gravity_m_s2 }
    }

    /// The speed along the floor, m/s.
    pub const fn along_m_s(&self) -> f64 {
        self.along_m_s
    }

    /// The height of the apex over the take-off, m.
    pub fn apex_m(&self) -> f64 {
        self.up_m_s * self.up_m_s / (2.0 * self.gravity_m_s2)
    }

    /// How far it flies over level ground, m.
    pub fn range_m(&self) -> f64 {
        2.0 * self.along_m_s * self.up_m_s / self.gravity_m_s2
    }

    /// The highest box on which it lands so far past the edge, m; below 0 if it lands on no box.
    ///
    /// The flight is over the height `h` for a length of `2 v sqrt(2 (H - h) / g)`, with `v` the speed along the floor, and that must be the distance
    /// `d` past the edge at least:
    ///
    /// ```text
    ///     h <= H - g d^2 / (8 v^2)
    /// ```
    pub fn highest_box_m(&self, past_m: f64) -> f64 {
        self.apex_m() - self.gravity_m_s2 * past_m * past_m / (8.0 * self.along_m_s * self.along_m_s)
    }

    /// The arc to a rise, on its way down; `None`: the rise is above the apex.
    pub fn arc(&self, rise_m: f64) -> Option<Arc> {
        let left = self.up_m_s * self.up_m_s - 2.0 * self.gravity_m_s2 * rise_m;
        let time_s = (self.up_m_s + left.max(0.0).sqrt()) / self.gravity_m_s2;
        let run_m = self.along_m_s * time_s;
        let loft = self.up_m_s / self.along_m_s - rise_m / run_m;
        (left >= 0.0).then(|| Arc::new(LineOfSight::new(run_m, rise_m), loft, self.gravity_m_s2))
    }

    /// How long the flight is over a height that it reaches, m: from where it passes it on its way up to where it comes down on it.
    fn over_m(&self, rise_m: f64) -> f64 {
        let left = self.up_m_s * self.up_m_s - 2.0 * self.gravity_m_s2 * rise_m;
        2.0 * self.along_m_s * left.max(0.0).sqrt() / self.gravity_m_s2
    }

    /// Where a straight way up over one face takes off and lands, as shares of its length: the middle of what there is room for. `None`: there is no
    /// room, or more than one face.
    pub(super) fn split(
        &self,
        levels: &Levels,
        (from, to): (MapPoint, MapPoint),
        (from_m, to_m): (f64, f64),
        ring_m: f64,
    ) -> Option<[f64; 2]> {
        let (way, mut face, mut faces) = (to - from, 0.0, 0);
        let length_m = way.norm();
        let mut sine = 1.0;
        let (start_m, end_m) = levels.walk(from, to, |step| {
            faces += 1;
            (face, sine) = (step.at * length_m, step.sine(way / length_m));
            faces == 1
        });
        if faces != 1 || start_m != from_m || end_m != to_m {
            return None;
        }
        let rise_m = to_m - from_m;
        let run_m = self.arc(rise_m)?.line_of_sight().run_m();
        // The take-off, from the start of the way: in time to be over the edge, and so late that the landing is past it.
        let past_m = ring_m / sine;
        let first_m = (face - run_m + past_m).max(0.0);
        let last_m = (length_m - run_m).min(face - run_m + self.over_m(rise_m)).min(face);
        (first_m <= last_m + RISE_TOLERANCE_M).then(|| {
            let takeoff_m = f64::midpoint(first_m, last_m.max(first_m));
            [takeoff_m / length_m, ((takeoff_m + run_m) / length_m).min(1.0)]
        })
    }
}
