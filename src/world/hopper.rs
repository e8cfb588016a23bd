//! The robot: the limits of its actuator and its body.

use crate::quantity::Angle;

/// A ballistic hopper, a point mass with limits.
///
/// The two speeds are infinite if only the chain's explicit constraints limit them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hopper {
    /// Greatest take-off speed, m/s.
    pub takeoff_speed_max_m_s: f64,
    /// Greatest landing speed, m/s.
    pub landing_speed_max_m_s: f64,
    /// Height to keep above every vertex flown over, m (epsilon in the CHTA paper).
    pub clearance_m: f64,
    /// Least take-off angle from the horizontal that the mechanism allows.
    pub takeoff_angle_min: Option<Angle>,
    /// Greatest take-off angle from the horizontal that the mechanism allows.
    pub takeoff_angle_max: Option<Angle>,
    /// Greatest apex above the take-off point, m.
    pub apex_height_max_m: Option<f64>,
    /// Longest flight, s.
    pub flight_time_max_s: Option<f64>,
    /// Mass, kg, used for energies only.
    pub mass_kg: Option<f64>,
    /// Rest between hops, s, used for the mission time only.
    pub rest_time_s: Option<f64>,
}

impl Hopper {
    /// A hopper without limits of its own: all limits come from the chain.
    pub const UNLIMITED: Self = Self {
        takeoff_speed_max_m_s: f64::INFINITY,
        landing_speed_max_m_s: f64::INFINITY,
        clearance_m: 0.0,
        takeoff_angle_min: None,
        takeoff_angle_max: None,
        apex_height_max_m: None,
        flight_time_max_s: None,
        mass_kg: None,
        rest_time_s: None,
    };

    /// A hopper with the two speed limits that every analysis needs, and no other limit.
    pub const fn with_speeds(takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64) -> Self {
        Self { takeoff_speed_max_m_s, landing_speed_max_m_s, ..Self::UNLIMITED }
    }
}
