//! The robot.

use super::{
    Flight,
    keys::{FlightKeys, JumperKeys},
};

/// A wheeled robot that jumps, with every default filled in. [`Arena::new`](super::Arena::new) checks it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jumper {
    /// Driving speed, m/s.
    pub speed_m_s: f64,
    /// Time to turn on the spot, s/rad.
    pub turn_s_per_rad: f64,
    /// The time of a jump, s.
    pub jump_time_s: f64,
    /// The greatest rise of a jump, m.
    pub rise_max_m: f64,
    /// What landings keep from edges, and RRT* from faces, m.
    pub ring_m: f64,
    /// The longest jump or drop of RRT*, m.
    pub jump_edge_max_m: f64,
    /// What each jump leaves of the driving speed.
    pub speed_factor_per_jump: f64,
    /// Energy of driving, J/m.
    pub drive_j_per_m: f64,
    /// Energy of a jump, J.
    pub jump_j: f64,
    /// Power drawn at all times, W.
    pub power_w: f64,
    /// The energy that there is, J; infinite without a bound.
    pub battery_j: f64,
    /// The flight of a jump; `None`: jumps are rules. The greatest rise is then also that of the flight.
    pub flight: Option<Flight>,
}

impl Jumper {
    /// With the defaults of the keys.
    ///
    /// Turning at the driving speed `v` with wheels `b` apart: each wheel runs `b / 2` a radian, which takes `b / (2 v)`.
    pub(super) fn of(keys: &JumperKeys, flight: Option<&FlightKeys>) -> Self {
        let flight = flight.map(Flight::of);
        let highest_m = flight.map_or(f64::INFINITY, |flight| flight.highest_box_m(keys.ring_m).max(0.0));
        let by_wheels = keys.wheelbase_m.map_or(0.0, |wheelbase_m| wheelbase_m / (2.0 * keys.speed_m_s));
        Self {
            speed_m_s: keys.speed_m_s,
            turn_s_per_rad: keys.turn_s_per_rad.unwrap_or(by_wheels),
            jump_time_s: keys.jump_time_s,
            rise_max_m: keys.rise_max_m.min(highest_m),
            ring_m: keys.ring_m,
            jump_edge_max_m: keys.jump_edge_max_m,
            speed_factor_per_jump: keys.speed_factor_per_jump,
            drive_j_per_m: keys.drive_j_per_m,
            jump_j: keys.jump_j,
            power_w: keys.power_w,
            battery_j: keys.battery_j.unwrap_or(f64::INFINITY),
            flight,
        }
    }

    /// Whether any key gives energy a price.
    pub fn has_energy(&self) -> bool {
        self.drive_j_per_m > 0.0 || self.jump_j > 0.0 || self.power_w > 0.0
    }

    /// Whether the time alone decides: no bound on energy, and no jump slows the robot.
    pub(super) fn is_plain(&self) -> bool {
        self.battery_j == f64::INFINITY && self.speed_factor_per_jump == 1.0
    }

    /// The energy of a part of a path, J.
    pub(super) fn energy_j(&self, driven_m: f64, jumps: u32, time_s: f64) -> f64 {
        self.drive_j_per_m * driven_m + self.jump_j * f64::from(jumps) + self.power_w * time_s
    }
}
