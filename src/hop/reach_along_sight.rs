//! How far one hop could go in the direction of its landing.

use super::HopTest;
use crate::{
    ballistics::{LineOfSight, TakeoffChoice, landing_reach_m, limits, takeoff_reach_m},
    chain::Station,
    quantity::{Angle, SlopeInterval},
    world::{Contact, Direction, Limit},
};

/// The greatest reach of one hop along the line of sight of a pair of stations, by the greatest speeds of their ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachAlongSight {
    sight: LineOfSight,
    loft: f64,
    by_takeoff_m: f64,
    by_landing_m: f64,
}

impl ReachAlongSight {
    /// By the greatest take-off speed, m along the line of sight.
    pub const fn by_takeoff_speed_m(&self) -> f64 {
        self.by_takeoff_m
    }

    /// By the greatest landing speed, m along the line of sight.
    pub const fn by_landing_speed_m(&self) -> f64 {
        self.by_landing_m
    }

    /// The smaller of both, m along the line of sight.
    pub const fn reach_m(&self) -> f64 {
        self.by_takeoff_m.min(self.by_landing_m)
    }

    /// The same, horizontally, m.
    pub fn reach_horizontal_m(&self) -> f64 {
        self.reach_m() / self.sight.secant()
    }

    /// Which speed sets it; the take-off speed if both do.
    pub const fn limit(&self) -> Limit {
        if self.by_takeoff_m <= self.by_landing_m { Limit::TakeoffSpeed } else { Limit::LandingSpeed }
    }

    /// The take-off angle of that hop.
    pub fn takeoff_angle(&self) -> Angle {
        Angle::from_slope(self.sight.slope() + self.loft)
    }
}

impl HopTest {
    /// The greatest reach in the direction from one station to another: first by the speeds alone, at the take-off angle of 45 degrees
    /// and half the angle of the line of sight (P eq. 19, 20); then at the nearest angle that both cones and the take-off mechanism
    /// allow (P eq. 29, 30), `None` if they allow none.
    ///
    /// Limits that depend on the length of the hop (terrain, apex height, flight time) are not looked at. `None` if both stations have
    /// the same x, or the ground at one of them refuses the contact for every hop, so that no speed is allowed there.
    pub fn reach_along_sight(&self, takeoff: &Station, landing: &Station) -> Option<(ReachAlongSight, Option<ReachAlongSight>)> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        let sight = self.line_of_sight(takeoff, landing)?;
        let rule = |station, contact| self.chain().check_contact(station, contact, direction).ok();
        let (from, to) = (rule(takeoff, Contact::Takeoff)?, rule(landing, Contact::Landing)?);
        let gravity = self.gravity_m_s2();
        let highest_m_s = self.hopper().limits().takeoff_speed_levels.map_or(f64::INFINITY, |levels| levels.highest_m_s());
        let takeoff_m_s = from.speed_max_m_s().min(highest_m_s);
        let at = |lofts: SlopeInterval| {
            let loft = TakeoffChoice::LeastSpeed.loft(sight, lofts);
            ReachAlongSight {
                sight,
                loft,
                by_takeoff_m: takeoff_reach_m(sight, loft, takeoff_m_s, gravity),
                by_landing_m: landing_reach_m(sight, loft, to.speed_max_m_s(), gravity),
            }
        };
        let angles = limits::takeoff_cone(sight, from.slopes().intersect(self.mechanism_slopes()))
            .intersect(limits::landing_cone(sight, to.slopes()));
        let within = Some(angles).filter(|lofts| !lofts.is_empty() && lofts.upper > 0.0).map(at);
        Some((at(SlopeInterval::ALL), within))
    }
}
