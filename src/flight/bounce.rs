//! What follows a first contact: bounces, contact after contact, until the hopper rests.

use nalgebra::{Vector2, Vector3};

use crate::{
    ballistics::bounced,
    ground::{ContactFailure, FirstContact, Flight, LiftoffVelocity, TouchdownState},
    world::{LandingMode, Restitution},
};

/// The most bounces of one hop. Every bounce leaves at most the share `e^2` of the energy of its impact, `e` being the greater
/// coefficient, and at least the energy of the settling speed; so a hop whose energy is `E` above the lowest ground has at most
///
/// ```text
///     2 E / (v_s^2 (1 / e^2 - 1))        bounces, on level ground only  ln(v / v_s) / ln(1 / e)
/// ```
///
/// Without a long fall that is some 2 300 for `e` = 0.99 and speeds of ten thousand million settling speeds. A hopper that still moves
/// after this many does not rest: it is taken to slide.
const BOUNCES_MAX: u32 = 10_000;

/// How the bounces after a first contact end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounces<C> {
    /// The last contact; after a bounce that leaves the known ground, the last position over it.
    pub(crate) end: C,
    /// How many arcs were flown after the first contact.
    pub(crate) count: u32,
    /// Time from the first contact to the last one, s.
    pub(crate) time_s: f64,
    /// Why the hopper does not rest there; `None` if it does.
    pub(crate) failure: Option<ContactFailure>,
}

impl<C> Bounces<C> {
    /// A hopper that stays where it landed.
    pub(crate) const fn none(end: C) -> Self {
        Self { end, count: 0, time_s: 0.0, failure: None }
    }
}

/// Follows an arc to its first contact. A take-off faster than escape does not come back: it has no contact.
pub(super) fn arc<G: FirstContact>(
    ground: &G,
    from: &G::Contact,
    liftoff: &LiftoffVelocity,
    aim: &G::Contact,
) -> Flight<G::Contact, G::SupportFacet> {
    let speed_m_s = libm::hypot(liftoff.horizontal_m_s, liftoff.vertical_m_s);
    if ground.gravity().escape_speed_m_s().is_some_and(|escape_m_s| speed_m_s >= escape_m_s) {
        return Flight { end: *from, support_facet: None, time_s: 0.0 };
    }
    ground.first_contact(from, liftoff, aim)
}

/// Follows the bounces after a first contact that held.
///
/// ```text
///       first contact      bounces          rest
///     . - .        . - .
///    /     \     /       \   .-.
///   /       \  /           \/   \_.
///  o         x              x    x ->
/// ```
///
/// Each contact reflects the velocity about the normal of the facet there, with the two coefficients of restitution; the hopper rests
/// where it would leave with less than the settling speed. A later contact fails in a zone where no contact is allowed, where the ground
/// ends, and above the landing speed limit (after a fall over an edge it can be faster than the first one). Its direction is not judged
/// against friction: what friction takes is in the coefficient along the facet. The place of rest is judged against the rest slope.
///
/// A bounce that begins on a vertex or an edge may lead into the next facet at once: an arc of no length, and the next impact is on that
/// facet. A contact whose velocity does not point into its facet is no impact: the hopper rests. By rounding that also ends the bounces of
/// a hopper whose speed away from the facet is some 1e-13 of its speed along it, and which no further bounce would move.
///
/// A braked hopper meets the ground straight down, at its touchdown speed.
#[cold]
#[inline(never)]
pub(super) fn bounces<G: FirstContact>(
    ground: &G,
    first: &Flight<G::Contact, G::SupportFacet>,
    touchdown: &TouchdownState,
    restitution: &Restitution,
) -> Bounces<G::Contact> {
    let mut ended = Bounces::none(first.end);
    let Some(mut facet) = first.support_facet else { return ended };
    let gravity_m_s2 = ground.gravity_m_s2();
    let settled_m_s = restitution.settling_speed_m_s(gravity_m_s2);
    let across = touchdown.heading * touchdown.horizontal_m_s;
    let mut velocity = match ground.hopper().limits().landing {
        LandingMode::Ballistic => Vector3::new(across.x, across.y, touchdown.vertical_m_s),
        LandingMode::Braked { touchdown_speed_m_s } => Vector3::new(0.0, 0.0, -touchdown_speed_m_s),
    };
    let mut heading = touchdown.heading;
    loop {
        let away = bounced(velocity, ground.normal(&facet), restitution);
        let Some(away) = away.filter(|away| away.norm() >= settled_m_s) else { break };
        if ended.count == BOUNCES_MAX {
            ended.failure = Some(ContactFailure::Slides);
            return ended;
        }
        let liftoff = leaving(away, heading);
        heading = liftoff.heading;
        let flight = arc(ground, &ended.end, &liftoff, &ended.end);
        let touchdown = TouchdownState::after(&liftoff, flight.time_s, gravity_m_s2);
        let track = ground.check_track(&ended.end, &flight.end);
        ended.end = flight.end;
        ended.count += 1;
        ended.time_s += flight.time_s;
        let held = flight.support_facet.ok_or(ContactFailure::OffLimits).and_then(|met| {
            track?;
            ground.check_bounce(&flight.end, &met, &touchdown)?;
            Ok(met)
        });
        facet = match held {
            Ok(met) => met,
            Err(failure) => {
                ended.failure = Some(failure);
                return ended;
            }
        };
        let across = heading * touchdown.horizontal_m_s;
        velocity = Vector3::new(across.x, across.y, touchdown.vertical_m_s);
    }
    if ended.count > 0 {
        ended.failure = ground.check_rest(&ended.end, &facet, heading).err();
    }
    ended
}

/// A velocity with its heading; straight up or down, that of before.
fn leaving(velocity: Vector3<f64>, before: Vector2<f64>) -> LiftoffVelocity {
    let horizontal_m_s = libm::hypot(velocity.x, velocity.y);
    let heading = if horizontal_m_s > 0.0 { velocity.xy() / horizontal_m_s } else { before };
    LiftoffVelocity { heading, horizontal_m_s, vertical_m_s: velocity.z }
}

#[cfg(test)]
mod tests;
