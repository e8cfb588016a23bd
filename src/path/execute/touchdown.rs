//! The check of a braked touchdown: straight down on the facet, at the touchdown speed.

use std::f64::consts::FRAC_PI_2;

use super::checker::{ANGLE_TOLERANCE_RAD, Checker, SPEED_ROUNDING};
use crate::{
    ground::{Hold, Surface},
    world::{Limit, tolerant_speed_m_s},
};

impl<S: Surface> Checker<'_, S> {
    /// What keeps the hopper from sliding at its touchdown, and how fast it may be.
    pub(super) fn touchdown(&mut self, hold: &Hold, touchdown_m_s: f64, x_m: f64) {
        let tolerance_rad = ANGLE_TOLERANCE_RAD + self.surface.slope_rounding();
        let mut max_m_s = self.surface.hopper().limits().landing_speed_max_m_s;
        match hold {
            Hold::Friction { normal, cone } => {
                // The ground pushes straight up.
                let off_rad = libm::acos(normal.normalize().z.clamp(-1.0, 1.0));
                let held = off_rad <= cone.half_angle().radians() + tolerance_rad;
                if !held {
                    self.note_limit(Limit::Touchdown, off_rad.to_degrees(), cone.half_angle().degrees(), "deg", x_m);
                }
            }
            Hold::Stated { line: Some(line), .. } => {
                let angles = line.landing.angles();
                for (end_rad, holds) in [
                    (angles.min.radians(), angles.min.radians() <= -FRAC_PI_2 + tolerance_rad),
                    (angles.max.radians(), angles.max.radians() >= -FRAC_PI_2 - tolerance_rad),
                ] {
                    if !holds {
                        self.note_limit(Limit::Touchdown, -90.0, end_rad.to_degrees(), "deg", x_m);
                    }
                }
                max_m_s = max_m_s.min(line.landing.speed_max_m_s());
            }
            // The refusal of the direction is reported by itself.
            Hold::Stated { line: None, .. } => {}
        }
        // Written so that NaN fails.
        let within = touchdown_m_s <= tolerant_speed_m_s(max_m_s) * (1.0 + SPEED_ROUNDING);
        if max_m_s <= 0.0 {
            self.note_limit(Limit::LandingSpeed, touchdown_m_s, max_m_s, "m/s", x_m);
        } else if !within {
            self.note_limit(Limit::Touchdown, touchdown_m_s, max_m_s, "m/s", x_m);
        }
    }
}
