//! A commanded hop with the errors of its execution.

use nalgebra::Vector2;

use super::{
    Uncertainty,
    bounce::{Bounces, arc, bounces},
    draws::{HopDraws, TrialDraws, Wanted},
};
use crate::ballistics::Arc;
use crate::ground::{ContactFailure, FirstContact, HeightField, LiftoffVelocity, Realization, TouchdownState};
use crate::quantity::Angle;

/// A command, its planned landing, and where the hop is meant to end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Command<C> {
    pub(crate) liftoff: LiftoffVelocity,
    pub(crate) speed_m_s: f64,
    /// The planned first contact.
    pub(crate) aim: C,
    /// The planned place of rest, from which the error of a landing is measured: `aim`, unless the command accounts for bounces.
    pub(crate) rest: C,
}

impl<C: Copy> Command<C> {
    /// The command that flies an arc along a heading.
    pub(crate) fn of_arc(arc: &Arc, heading: Vector2<f64>, aim: C) -> Self {
        let across = arc.horizontal_speed_m_s();
        Self::new(LiftoffVelocity { heading, horizontal_m_s: across, vertical_m_s: across * arc.takeoff_slope() }, aim)
    }

    pub(crate) fn new(liftoff: LiftoffVelocity, aim: C) -> Self {
        Self { liftoff, speed_m_s: libm::hypot(liftoff.horizontal_m_s, liftoff.vertical_m_s), aim, rest: aim }
    }
}

/// The errors of a run, and which draws they use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Errors {
    uncertainty: Uncertainty,
    wanted: Wanted,
}

/// The errors of one hop as drawn, in their units.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct DrawnErrors {
    /// Actual minus commanded take-off speed, m/s; a speed below zero is set to zero.
    pub takeoff_speed_m_s: f64,
    /// Actual minus commanded elevation of the take-off velocity.
    pub takeoff_angle: Angle,
    /// Actual minus commanded heading, clockwise; zero along a chain.
    pub heading: Angle,
    /// Bounce-and-roll displacement after the landing, along the heading and to its left, m.
    pub drift_m: [f64; 2],
    /// Believed minus actual position before the hop, m: on a chain along it and to its left, on a map east and north; zero unless the
    /// policy asks for the position.
    pub position_m: [f64; 2],
    /// Added to the friction coefficient of the whole ground, one draw a trial.
    pub friction_coefficient: f64,
}

/// The result of one hop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlownHop<C> {
    /// The first contact, or the last position over known ground.
    pub(crate) end: C,
    /// Where the hopper comes to rest after bounces and drift; the last contact if it does not come to rest safely (see `failure`).
    pub(crate) rest: C,
    /// The bounces after the first contact.
    pub(crate) bounces: Bounces<C>,
    pub(crate) time_s: f64,
    pub(crate) touchdown: TouchdownState,
    /// Whether it ended on the ground: it touched down, or it never lifted off.
    pub(crate) landed: bool,
    /// Why the hopper does not rest safely; `None` if it does.
    pub(crate) failure: Option<ContactFailure>,
}

impl Errors {
    /// The errors of a run. `asks_position`: whether its policy uses the position estimate.
    pub(crate) fn new(uncertainty: Uncertainty, asks_position: bool) -> Self {
        let u = &uncertainty;
        let wanted = Wanted {
            speed: u.takeoff_speed_sigma_m_s > 0.0 || u.takeoff_speed_sigma_fraction > 0.0,
            direction: u.takeoff_angle_sigma.radians() > 0.0 || u.heading_sigma.radians() > 0.0,
            drift: u.drift_along_sigma_m > 0.0 || u.drift_across_sigma_m > 0.0,
            position: u.position_sigma_m > 0.0 && asks_position,
        };
        Self { uncertainty, wanted }
    }

    /// The draws of the next hop.
    pub(crate) fn draw(&self, draws: &mut TrialDraws) -> HopDraws {
        draws.hop(self.wanted)
    }

    /// The errors of the position estimate, m: along and across, or east and north.
    pub(crate) fn position_m(&self, draws: &HopDraws) -> [f64; 2] {
        draws.position.map(|normal| self.uncertainty.position_sigma_m * normal)
    }

    /// The bounce-and-roll displacement after the landing, m: along the heading and to its left.
    pub(crate) fn drift_m(&self, draws: &HopDraws) -> [f64; 2] {
        let u = &self.uncertainty;
        [u.drift_along_sigma_m * draws.drift[0], u.drift_across_sigma_m * draws.drift[1]]
    }

    /// The errors of a hop of this commanded speed, on ground with this error of its friction.
    pub(crate) fn drawn(&self, speed_m_s: f64, draws: &HopDraws, friction_coefficient: f64) -> DrawnErrors {
        let u = &self.uncertainty;
        let [elevation, heading] = draws.direction;
        DrawnErrors {
            takeoff_speed_m_s: speed_m_s * u.takeoff_speed_sigma_fraction * draws.speed[1]
                + u.takeoff_speed_sigma_m_s * draws.speed[0],
            takeoff_angle: Angle::from_radians(u.takeoff_angle_sigma.radians() * elevation),
            heading: Angle::from_radians(u.heading_sigma.radians() * heading),
            drift_m: self.drift_m(draws),
            position_m: self.position_m(draws),
            friction_coefficient,
        }
    }

    /// The realization of a trial's ground; `None` if all trials have the nominal ground.
    pub(crate) fn realization(&self, draws: &mut TrialDraws, trial: u64) -> Option<Realization> {
        let u = &self.uncertainty;
        let friction = if u.friction_sigma > 0.0 { u.friction_sigma * draws.friction(trial) } else { 0.0 };
        let heights = (u.height_sigma_m > 0.0)
            .then(|| Box::new(HeightField::drawn(draws.height_field(trial), u.height_sigma_m, u.height_correlation_m)));
        (u.friction_sigma > 0.0 || heights.is_some()).then_some(Realization { friction, heights })
    }

    /// A commanded velocity with its errors: first of speed, then of elevation angle, then of heading.
    pub(crate) fn liftoff(&self, liftoff: &LiftoffVelocity, speed_m_s: f64, draws: &HopDraws) -> LiftoffVelocity {
        let u = &self.uncertainty;
        let real_m_s =
            speed_m_s * (1.0 + u.takeoff_speed_sigma_fraction * draws.speed[1]) + u.takeoff_speed_sigma_m_s * draws.speed[0];
        let scale = if self.wanted.speed { real_m_s.max(0.0) / speed_m_s } else { 1.0 };
        let (horizontal, up) = (liftoff.horizontal_m_s * scale, liftoff.vertical_m_s * scale);
        if !self.wanted.direction {
            return LiftoffVelocity { heading: liftoff.heading, horizontal_m_s: horizontal, vertical_m_s: up };
        }
        let (sine, cosine) = libm::sincos(u.takeoff_angle_sigma.radians() * draws.direction[0]);
        let (horizontal, up) = (horizontal * cosine - up * sine, horizontal * sine + up * cosine);
        let mut heading = liftoff.heading;
        if u.heading_sigma.radians() > 0.0 {
            let (sine, cosine) = libm::sincos(u.heading_sigma.radians() * draws.direction[1]);
            heading = Vector2::new(heading.x * cosine + heading.y * sine, heading.y * cosine - heading.x * sine);
        }
        // A take-off angle beyond 90 degrees reverses the heading.
        if horizontal < 0.0 {
            return LiftoffVelocity { heading: -heading, horizontal_m_s: -horizontal, vertical_m_s: up };
        }
        LiftoffVelocity { heading, horizontal_m_s: horizontal, vertical_m_s: up }
    }

    /// Follows an arc to its first contact, checks the landing, follows its bounces if the hopper has a restitution, and adds the random
    /// displacement (`drift_*`) that stands for what rolls on.
    pub(crate) fn fly<G: FirstContact>(
        &self,
        ground: &G,
        from: &G::Contact,
        liftoff: &LiftoffVelocity,
        aim: &G::Contact,
        draws: &HopDraws,
    ) -> FlownHop<G::Contact> {
        let flight = arc(ground, from, liftoff, aim);
        let touchdown = TouchdownState::after(liftoff, flight.time_s, ground.gravity_m_s2());
        let displacement_m = self.drift_m(draws);
        let held = match &flight.support_facet {
            // A hopper that does not move has no contact to check.
            _ if liftoff.stays() => Ok(()),
            None => Err(ContactFailure::OffLimits),
            Some(support_facet) => ground.check_landing(&flight.end, support_facet, &touchdown),
        };
        let bounces = match &ground.hopper().limits().restitution {
            Some(restitution) if held.is_ok() && restitution.bounces() && !liftoff.stays() => {
                bounces(ground, &flight, &touchdown, restitution)
            }
            _ => Bounces::none(flight.end),
        };
        let rest = held
            .and(bounces.failure.map_or(Ok(()), Err))
            .and_then(|()| ground.displaced(&bounces.end, liftoff.heading, displacement_m[0], displacement_m[1]));
        FlownHop {
            end: flight.end,
            rest: rest.unwrap_or(bounces.end),
            bounces,
            time_s: flight.time_s,
            touchdown,
            landed: flight.support_facet.is_some() || liftoff.stays(),
            failure: rest.err(),
        }
    }
}
