//! The events of a trial, hop by hop.

use nalgebra::{Point3, Vector2};

use super::{DrawnErrors, TrialOutcome};
use crate::quantity::Angle;

/// One flown hop of one trial.
///
/// Positions are (x, y, z) in m. On a map x is east and y north. On a chain x runs along it and y is the offset to the left of its
/// plane, which only bounce-and-roll displacement to the side changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopRecord {
    /// Which trial, from 0.
    pub trial: u64,
    /// The number of the hop in it, from 1.
    pub hop: u32,
    /// The actual take-off.
    pub takeoff_m: Point3<f64>,
    /// The actual horizontal direction, of length 1: (east, north) on a map, (1, 0) or (-1, 0) on a chain.
    pub heading: Vector2<f64>,
    /// The actual horizontal speed, constant over the flight, m/s.
    pub horizontal_m_s: f64,
    /// The actual vertical speed at the take-off, m/s.
    pub takeoff_vertical_m_s: f64,
    /// Its vertical speed where the flight ends, negative on the way down, m/s.
    pub landing_vertical_m_s: f64,
    /// Time from take-off to the end of the flight, s.
    pub flight_time_s: f64,
    /// The planned landing.
    pub planned_m: Point3<f64>,
    /// The first contact with the ground; for a hop that did not land, where it left the known ground in flight.
    pub contact_m: Point3<f64>,
    /// Where it came to rest after its bounces and the bounce-and-roll displacement; the last contact if the trial ended with it.
    pub rest_m: Point3<f64>,
    /// How many bounces it flew after its first contact.
    pub bounces: u32,
    /// Time from the first contact to the last, s.
    pub bounce_time_s: f64,
    /// Horizontal distance from the planned landing to the position of rest, m.
    pub error_m: f64,
    /// The errors that were drawn for it.
    pub drawn: DrawnErrors,
    /// Whether it met the ground.
    pub landed: bool,
    /// The outcome of the trial, if this is its last hop.
    pub outcome: Option<TrialOutcome>,
}

impl HopRecord {
    /// Actual take-off speed, m/s.
    pub fn takeoff_speed_m_s(&self) -> f64 {
        libm::hypot(self.horizontal_m_s, self.takeoff_vertical_m_s)
    }

    /// Actual take-off angle above the horizontal, in the actual direction of travel.
    pub fn takeoff_angle(&self) -> Angle {
        Angle::from_radians(libm::atan2(self.takeoff_vertical_m_s, self.horizontal_m_s))
    }

    /// Landing speed, m/s.
    pub fn landing_speed_m_s(&self) -> f64 {
        libm::hypot(self.horizontal_m_s, self.landing_vertical_m_s)
    }

    /// Landing angle, negative on the way down.
    pub fn landing_angle(&self) -> Angle {
        Angle::from_radians(libm::atan2(self.landing_vertical_m_s, self.horizontal_m_s))
    }

    /// At least two points of the flight at equal times, including both ends.
    pub fn flight_points(&self, gravity_m_s2: f64, count: u32) -> Vec<Point3<f64>> {
        let last = count.max(2) - 1;
        (0..=last)
            .map(|i| {
                if i == last {
                    return self.contact_m;
                }
                let time_s = self.flight_time_s * (f64::from(i) / f64::from(last));
                let away = self.heading * (self.horizontal_m_s * time_s);
                let up_m = time_s * (self.takeoff_vertical_m_s - 0.5 * gravity_m_s2 * time_s);
                Point3::new(self.takeoff_m.x + away.x, self.takeoff_m.y + away.y, self.takeoff_m.z + up_m)
            })
            .collect()
    }
}

/// One trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialRecord {
    /// Which one, from 0.
    pub trial: u64,
    /// How it ended.
    pub outcome: TrialOutcome,
    /// The number of hops flown, including the last one, even if it did not land.
    pub hops: u32,
    /// How many stops of the mission it reached, one after the other, each within the goal tolerance: the goal alone, or every target.
    pub stops: u32,
    /// Where it ended.
    pub end_m: Point3<f64>,
    /// Horizontal distance from the end to the goal, m.
    pub goal_distance_m: f64,
}

impl TrialRecord {
    /// The hop that ended the trial, from 1: the last one flown, or the one that was not flown because its take-off slid or its propellant
    /// was not there; 0 if the trial ended before any.
    pub const fn last_hop(&self) -> u32 {
        match self.outcome {
            TrialOutcome::SlidAtTakeoff | TrialOutcome::OutOfPropellant => self.hops.saturating_add(1),
            _ => self.hops,
        }
    }
}

/// A trial with all its hops.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// The trial.
    pub trial: TrialRecord,
    /// Its hops in the order of flight.
    pub hops: Vec<HopRecord>,
}
