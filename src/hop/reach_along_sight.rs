//! How far one hop could go in the direction of its landing.

use super::HopTest;
use crate::{
    ballistics::{LineOfSight, greatest_landing_reach_m, greatest_takeoff_reach_m},
    chain::Station,
    quantity::Angle,
    world::{Contact, Direction, Limit},
};

/// The greatest reach of one hop along the line of sight of a pair of stations, by its two greatest speeds alone (P eq. 19, 20).
///
/// A hop to the pair's own landing is within it if no other limit refuses it. The speeds are those of the two stations' ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachAlongSight {
    sight: LineOfSight,
    takeoff_m: f64,
    landing_m: f64,
}

impl ReachAlongSight {
    /// By the greatest take-off speed, m along the line of sight.
    pub const fn by_takeoff_speed_m(&self) -> f64 {
        self.takeoff_m
    }

    /// By the greatest landing speed, m along the line of sight.
    pub const fn by_landing_speed_m(&self) -> f64 {
        self.landing_m
    }

    /// The smaller of both, m along the line of sight.
    pub const fn reach_m(&self) -> f64 {
        self.takeoff_m.min(self.landing_m)
    }

    /// The same, horizontally, m.
    pub fn reach_horizontal_m(&self) -> f64 {
        self.reach_m() / self.sight.secant()
    }

    /// Which speed sets it; the take-off speed if both do.
    pub const fn limit(&self) -> Limit {
        if self.takeoff_m <= self.landing_m { Limit::TakeoffSpeed } else { Limit::LandingSpeed }
    }

    /// The take-off angle that attains it: 45 degrees and half the angle of the line of sight.
    pub fn takeoff_angle(&self) -> Angle {
        Angle::from_slope(self.sight.min_speed_ratio())
    }
}

impl HopTest {
    /// The greatest reach in the direction from one station to another; `None` if both have the same x or the ground at one of them
    /// refuses the contact, so that no speed is allowed there.
    pub fn reach_along_sight(&self, takeoff: &Station, landing: &Station) -> Option<ReachAlongSight> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        let sight = self.line_of_sight(takeoff, landing)?;
        let speed_m_s =
            |station, contact| self.chain().check_contact(station, contact, direction).ok().map(|rule| rule.speed_max_m_s());
        let takeoff_m = greatest_takeoff_reach_m(sight, speed_m_s(takeoff, Contact::Takeoff)?, self.gravity_m_s2());
        let landing_m = greatest_landing_reach_m(sight, speed_m_s(landing, Contact::Landing)?, self.gravity_m_s2());
        Some(ReachAlongSight { sight, takeoff_m, landing_m })
    }
}
