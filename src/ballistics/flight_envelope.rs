//! The flight envelope: all limits of a hop except the terrain, combined.

use super::{LineOfSight, TakeoffChoice, TakeoffSpeeds, limits};
use crate::{
    quantity::{Angle, SlopeInterval},
    world::{Gravity, Hopper},
};

/// The flight envelope of a hopper under a given gravity: the hops that its limits and the contacts allow over ground without
/// obstacles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightEnvelope {
    hopper: Hopper,
    gravity: Gravity,
    /// The take-off slopes that the mechanism allows.
    mechanical: SlopeInterval,
    clearance: limits::ClearanceProfile,
    speeds: TakeoffSpeeds,
}

/// The limits of one contact (take-off or landing): directions of travel as slopes, and a greatest speed.
/// [`ContactRule`](crate::chain::ContactRule) is the form with angles that the chain's constraints use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLimits {
    /// Allowed directions of travel.
    pub slopes: SlopeInterval,
    /// Greatest speed, m/s.
    pub speed_max_m_s: f64,
}

impl FlightEnvelope {
    /// For a hopper and a gravity. The hopper's speed limits are capped below the escape speed, where the gravity's body has a known
    /// radius.
    pub fn new(hopper: &Hopper, gravity: Gravity) -> Self {
        let mechanical = SlopeInterval {
            lower: hopper.limits().takeoff_angle_min.map_or(f64::NEG_INFINITY, Angle::slope),
            upper: hopper.limits().takeoff_angle_max.map_or(f64::INFINITY, Angle::slope),
        };
        let clearance = limits::ClearanceProfile::of(hopper.limits());
        let speeds = TakeoffSpeeds::of(hopper.limits());
        Self { hopper: hopper.below_escape(gravity), gravity, mechanical, clearance, speeds }
    }

    /// The hopper.
    pub const fn hopper(&self) -> &Hopper {
        &self.hopper
    }

    /// The gravity.
    pub const fn gravity(&self) -> Gravity {
        self.gravity
    }

    /// Gravity, m/s^2.
    pub const fn gravity_m_s2(&self) -> f64 {
        self.gravity.m_s2()
    }

    /// The height to keep over the ground.
    #[inline]
    pub const fn clearance(&self) -> limits::ClearanceProfile {
        self.clearance
    }

    /// The take-off slopes that the take-off mechanism can produce: from the hopper's least to its greatest take-off angle.
    pub const fn mechanism_slopes(&self) -> SlopeInterval {
        self.mechanical
    }

    /// The take-off speeds that the machine can be commanded.
    #[inline]
    pub const fn takeoff_speeds(&self) -> &TakeoffSpeeds {
        &self.speeds
    }

    /// Whether the machine can be commanded an arc of an interval that all other limits allow.
    #[inline]
    pub fn commands(&self, sight: LineOfSight, lofts: SlopeInterval) -> bool {
        self.speeds.allow(sight, lofts, self.gravity.m_s2())
    }

    /// The loft to fly of an interval that all other limits allow, of those that the machine can be commanded; for an interval
    /// without any, that of a machine of any speed.
    #[inline]
    pub fn loft(&self, choice: TakeoffChoice, sight: LineOfSight, lofts: SlopeInterval) -> f64 {
        self.speeds.loft(choice, sight, lofts, self.gravity.m_s2()).unwrap_or_else(|| choice.loft(sight, lofts))
    }

    /// The lofts that all limits except the terrain and the machine's commands allow: the intersection of the intervals in [`limits`].
    ///
    /// Source: CHTA paper, eq. 21 without eq. 14.
    ///
    /// # Returns
    /// A hop exists if the interval is not empty and contains a positive loft.
    ///
    /// # Degenerate
    /// A speed limit of 0 or NaN gives the empty interval.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::{ContactLimits, LineOfSight, FlightEnvelope}, quantity::SlopeInterval, world::{Gravity, Hopper}};
    /// let envelope = FlightEnvelope::new(&Hopper::with_speeds(10.0, 10.0).unwrap(), Gravity::new(10.0).unwrap());
    /// let free = ContactLimits { slopes: SlopeInterval::ALL, speed_max_m_s: 10.0 };
    /// // Flat, q = 1.25: n^2 - 2.5 n + 1 = (n - 0.5)(n - 2); a take-off of 45 degrees or more leaves 1 to 2.
    /// let steep = ContactLimits { slopes: SlopeInterval { lower: 1.0, upper: f64::INFINITY }, ..free };
    /// let lofts = envelope.lofts(LineOfSight::new(8.0, 0.0), steep, free);
    /// assert!((lofts.lower - 1.0).abs() < 1e-8 && (lofts.upper - 2.0).abs() < 1e-8);
    /// ```
    #[inline]
    pub fn lofts(&self, sight: LineOfSight, takeoff: ContactLimits, landing: ContactLimits) -> SlopeInterval {
        limits::speeds(sight, takeoff.speed_max_m_s, landing.speed_max_m_s, self.gravity.m_s2())
            .intersect(limits::takeoff_cone(sight, takeoff.slopes.intersect(self.mechanical)))
            .intersect(limits::landing_cone(sight, landing.slopes))
            .intersect(self.flight_limits(sight))
    }

    /// The lofts that the hopper's limits on the flight (greatest apex height, longest flight time) allow; all lofts if it has
    /// neither.
    #[inline]
    pub fn flight_limits(&self, sight: LineOfSight) -> SlopeInterval {
        let apex =
            self.hopper.limits().apex_height_max_m.map_or(SlopeInterval::ALL, |height_m| limits::apex_height(sight, height_m));
        match self.hopper.limits().flight_time_max_s {
            Some(time_s) => apex.intersect(limits::flight_time(sight, time_s, self.gravity.m_s2())),
            None => apex,
        }
    }
}
