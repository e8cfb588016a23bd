//! A path through an arena.

use super::Tariff;
use crate::quantity::MapPoint;

/// How a point of a path is reached from the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// At one height.
    Drive,
    /// Up over a face.
    Jump,
    /// Down over a face.
    Drop,
}

impl Move {
    /// Its name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Jump => "jump",
            Self::Drop => "drop",
        }
    }
}

/// A point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where it is.
    pub point: MapPoint,
    /// The height under it, m.
    pub z_m: f64,
    /// How it is reached; `None` for the start.
    pub reached_by: Option<Move>,
}

/// A path with what it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct ArenaPath {
    /// Its points, from the start to the goal.
    pub points: Vec<PathPoint>,
    /// Its time, s.
    pub time_s: f64,
    /// The prices that the time is made of.
    pub tariff: Tariff,
}

impl ArenaPath {
    /// The jumps of the path.
    pub fn jumps(&self) -> usize {
        self.points.iter().filter(|point| point.reached_by == Some(Move::Jump)).count()
    }

    /// Joins drives that go on straight ahead, and removes points that do not move.
    pub(super) fn simplify(points: Vec<PathPoint>) -> Vec<PathPoint> {
        let mut kept: Vec<PathPoint> = Vec::with_capacity(points.len());
        for point in points {
            if let [.., before, last] = kept.as_slice()
                && last.reached_by == Some(Move::Drive)
                && point.reached_by == Some(Move::Drive)
                && goes_on_straight(before.point, last.point, point.point)
            {
                kept.pop();
            }
            let stays = kept.last().is_some_and(|last| last.point == point.point && point.reached_by == Some(Move::Drive));
            if !stays {
                kept.push(point);
            }
        }
        kept
    }
}

fn goes_on_straight(a: MapPoint, b: MapPoint, c: MapPoint) -> bool {
    let (ab, bc) = (b - a, c - b);
    let (lengths, along) = (ab.norm() * bc.norm(), ab.dot(&bc));
    ab.perp(&bc).abs() <= 1e-12 * lengths && along > 0.0
}

/// A way up over a face, as it is flown: driven to the take-off, flown, and driven on.
pub(super) fn flown(from: &PathPoint, to: PathPoint, [takeoff, landing]: [f64; 2]) -> [PathPoint; 3] {
    let at = |share: f64| from.point + share * (to.point - from.point);
    [
        PathPoint { point: at(takeoff), reached_by: Some(Move::Drive), ..*from },
        PathPoint { point: at(landing), ..to },
        PathPoint { reached_by: Some(Move::Drive), ..to },
    ]
}

/// The unsigned angle between two directions, rad; 0 where one has no length.
pub(super) fn turn_rad(before: [f64; 2], after: [f64; 2]) -> f64 {
    let cross = before[0] * after[1] - before[1] * after[0];
    let dot = before[0] * after[0] + before[1] * after[1];
    libm::atan2(cross.abs(), dot)
}
