//! The check of what a hop takes from the machine: its delta-v from the flown states, its propellant from the mass that is left.

use super::{Flight, Measure, StatedValue, ViolatedLimit, Violation, checker::angle_rounding};
use crate::{
    path::Hop,
    world::{HopperLimits, LandingMode},
};

/// Standard gravity, m/s^2, by which a specific impulse in seconds is an exhaust velocity (CGPM 1901).
const EXHAUST_PER_SECOND_M_S2: f64 = 9.806_65;

/// Relative tolerance of a delta-v and of a mass: that of speeds.
const TOLERANCE: f64 = 1e-9;

/// The mass of the machine, hop after hop.
pub(super) struct Stores<'a> {
    limits: &'a HopperLimits,
    gravity_m_s2: f64,
    mass_kg: Option<f64>,
}

impl<'a> Stores<'a> {
    /// Before the first hop.
    pub(super) fn full(limits: &'a HopperLimits, gravity_m_s2: f64) -> Self {
        Self { limits, gravity_m_s2, mass_kg: limits.isp_s.and(limits.mass_kg) }
    }

    /// Checks the delta-v and the propellant that a hop states.
    ///
    /// The delta-v is that of the velocities which Newton's equations gave: the take-off as commanded, and with brakes the change from
    /// the velocity above the landing to one straight down. The mass left is the one before, divided by the mass ratio.
    pub(super) fn check(&mut self, number: usize, hop: &Hop, flight: Option<&Flight>, violations: &mut Vec<Violation>) {
        let delta_v_m_s = flight.map_or(hop.delta_v_m_s, |flight| self.flown_m_s(hop, flight));
        let mut stated = |value, stated: Option<f64>, flown: Option<f64>, tolerance: f64, unit| {
            let agrees = match (stated, flown) {
                // Written so that NaN fails.
                (Some(stated), Some(flown)) => (stated - flown).abs() <= tolerance,
                (None, None) => true,
                _ => false,
            };
            if !agrees {
                let measure = stated.zip(flown).map(|(found, allowed)| Measure { found, allowed, unit });
                let limit = ViolatedLimit::StatedValue(value);
                violations.push(Violation { measure, ..Violation::at(number, limit, hop.takeoff.along_m) });
            }
        };
        // An error of the position along the flight is one of the time, in which gravity changes the velocity.
        let of_landing_m_s = flight.map_or(0.0, |flight| {
            let of_place_s = flight.rounding_m / flight.landing_speed_m_s;
            self.gravity_m_s2 * (of_place_s + flight.flight_time_s * angle_rounding(hop))
        });
        let rounding_m_s = TOLERANCE * delta_v_m_s.abs() + of_landing_m_s;
        stated(StatedValue::DeltaV, Some(hop.delta_v_m_s), Some(delta_v_m_s), rounding_m_s, "m/s");
        let before_kg = self.mass_kg;
        if let (Some(mass_kg), Some(isp_s)) = (before_kg, self.limits.isp_s) {
            self.mass_kg = Some(mass_kg / libm::exp(delta_v_m_s / (isp_s * EXHAUST_PER_SECOND_M_S2)));
        }
        let tolerance_kg = before_kg.map_or(0.0, |mass_kg| TOLERANCE * mass_kg);
        let used_kg = before_kg.zip(self.mass_kg).map(|(before, after)| before - after);
        stated(StatedValue::Propellant, hop.propellant.map(|p| p.used_kg), used_kg, tolerance_kg, "kg");
        stated(StatedValue::MassEnd, hop.propellant.map(|p| p.mass_end_kg), self.mass_kg, tolerance_kg, "kg");
    }

    /// The delta-v of a flown hop, m/s.
    fn flown_m_s(&self, hop: &Hop, flight: &Flight) -> f64 {
        let braking_m_s = match self.limits.landing {
            LandingMode::Ballistic => 0.0,
            LandingMode::Braked { touchdown_speed_m_s } => {
                let change = nalgebra::Vector2::new(flight.across_m_s, flight.landing_climb_m_s + touchdown_speed_m_s);
                change.norm()
            }
        };
        hop.takeoff_speed_m_s + braking_m_s + self.limits.hop_delta_v_overhead_m_s.unwrap_or(0.0)
    }
}
