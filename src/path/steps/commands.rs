//! The commands of a machine around an exact one.

use super::{
    Machine, Pair,
    grounds::{SteppedGround, Target},
};
use crate::{
    ballistics::limits,
    quantity::Angle,
    world::{Limit, multiples},
};

/// A command: take-off angle and speed, m/s.
pub(super) type Command = (Angle, f64);

impl<G: SteppedGround> Machine<'_, G> {
    /// The commands near that of an exact hop to a target, the nearest first.
    ///
    /// With a step of the speed alone, the angle makes up for it: each speed has two angles that land exactly.
    ///
    /// # Errors
    /// The limit that leaves no exact hop.
    pub(super) fn commands(&self, takeoff: &G::Contact, target: &Target<G::Contact>) -> Result<Vec<Command>, Limit> {
        let Pair { test, takeoff, landing } = self.ground.pair(takeoff, &target.at)?;
        let sight = test.line_of_sight(&takeoff, &landing).ok_or(Limit::Direction)?;
        let lofts = test.lofts(&takeoff, &landing)?;
        let exact = self.arc(sight, test.loft(self.choice, sight, lofts));
        let (angle, speed_m_s) = (exact.takeoff_angle(), exact.takeoff_speed_m_s());
        let is_too_slow = |speed_m_s: f64| self.is_too_slow(speed_m_s);
        Ok(match (self.steps.takeoff_angle, self.steps.takeoff_speed_m_s) {
            (None, None) => vec![(angle, speed_m_s)],
            (Some(step), speed_step) => {
                let angles = multiples(angle.degrees(), step.degrees()).map(Angle::from_degrees);
                let inside = |angle: &Angle| angle.radians().abs() < std::f64::consts::FRAC_PI_2;
                let arcs =
                    angles.filter(inside).map(|angle| (angle, angle.slope() - sight.slope())).filter(|(_, loft)| *loft > 0.0);
                arcs.flat_map(|(angle, loft)| {
                    let exact_m_s = self.arc(sight, loft).takeoff_speed_m_s();
                    let mut speeds = match (speed_step, test.hopper().limits().takeoff_speed_levels) {
                        (_, Some(levels)) => levels.as_slice().to_vec(),
                        (Some(step), None) => multiples(exact_m_s, step).filter(|&speed_m_s| !is_too_slow(speed_m_s)).collect(),
                        (None, None) => vec![exact_m_s],
                    };
                    speeds.sort_by(|a, b| (a - exact_m_s).abs().total_cmp(&(b - exact_m_s).abs()));
                    speeds.into_iter().take(3).map(move |speed_m_s| (angle, speed_m_s))
                })
                .filter(|(_, speed_m_s)| *speed_m_s > 0.0)
                .collect()
            }
            (None, Some(step)) => {
                let speeds = multiples(speed_m_s, step).filter(|speed_m_s| *speed_m_s > 0.0);
                let gravity = test.gravity_m_s2();
                let lofts = |speed_m_s: f64| limits::takeoff_speed_level(sight, speed_m_s, gravity, lofts).into_iter().flatten();
                speeds
                    .flat_map(|speed_m_s| {
                        let mut both: Vec<f64> = lofts(speed_m_s).collect();
                        both.sort_by(|a, b| (a - exact.loft()).abs().total_cmp(&(b - exact.loft()).abs()));
                        both.into_iter().map(move |loft| (Angle::from_slope(sight.slope() + loft), speed_m_s))
                    })
                    .collect()
            }
        })
    }
}
