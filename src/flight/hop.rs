//! A commanded hop with the errors of its execution.

use nalgebra::Vector2;

use super::{
    Errors, HopErrors,
    bounce::{Bounces, arc, bounces},
};
use crate::ballistics::Arc;
use crate::ground::{ContactFailure, FirstContact, LiftoffVelocity, TouchdownState};

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
    /// A commanded velocity with its errors: first of speed, then of elevation angle, then of heading.
    pub(crate) fn liftoff(&self, liftoff: &LiftoffVelocity, speed_m_s: f64, errors: &HopErrors) -> LiftoffVelocity {
        let real_m_s = speed_m_s * (1.0 + errors.speed_fraction) + errors.speed_m_s;
        let scale = if self.changes_speed() { real_m_s.max(0.0) / speed_m_s } else { 1.0 };
        let (horizontal, up) = (liftoff.horizontal_m_s * scale, liftoff.vertical_m_s * scale);
        if !self.changes_direction() {
            return LiftoffVelocity { heading: liftoff.heading, horizontal_m_s: horizontal, vertical_m_s: up };
        }
        let (sine, cosine) = libm::sincos(errors.angle_rad);
        let (horizontal, up) = (horizontal * cosine - up * sine, horizontal * sine + up * cosine);
        let mut heading = liftoff.heading;
        if self.changes_heading() {
            let (sine, cosine) = libm::sincos(errors.heading_rad);
            heading = Vector2::new(heading.x * cosine + heading.y * sine, heading.y * cosine - heading.x * sine);
        }
        // A take-off angle beyond 90 degrees reverses the heading.
        if horizontal < 0.0 {
            return LiftoffVelocity { heading: -heading, horizontal_m_s: -horizontal, vertical_m_s: up };
        }
        LiftoffVelocity { heading, horizontal_m_s: horizontal, vertical_m_s: up }
    }
}

impl HopErrors {
    /// Follows an arc to its first contact, checks the landing, follows its bounces if the hopper has a restitution, and adds the random
    /// displacement (`drift_*`) that stands for what rolls on.
    pub(crate) fn fly<G: FirstContact>(
        &self,
        ground: &G,
        from: &G::Contact,
        liftoff: &LiftoffVelocity,
        aim: &G::Contact,
    ) -> FlownHop<G::Contact> {
        let flight = arc(ground, from, liftoff, aim);
        let touchdown = TouchdownState::after(liftoff, flight.time_s, ground.gravity_m_s2());
        let held = match &flight.support_facet {
            // A hopper that does not move has no contact to check.
            _ if liftoff.stays() => Ok(()),
            None => Err(ContactFailure::OffLimits),
            Some(support_facet) => {
                ground.check_track(from, &flight.end).and_then(|()| ground.check_landing(&flight.end, support_facet, &touchdown))
            }
        };
        let bounces = match &ground.hopper().limits().restitution {
            Some(restitution) if held.is_ok() && restitution.bounces() && !liftoff.stays() => {
                bounces(ground, &flight, &touchdown, restitution)
            }
            _ => Bounces::none(flight.end),
        };
        let rest = held
            .and(bounces.failure.map_or(Ok(()), Err))
            .and_then(|()| ground.displaced(&bounces.end, liftoff.heading, self.drift_m[0], self.drift_m[1]));
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
