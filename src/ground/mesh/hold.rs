//! What holds a contact on a facet: prepared once for each contact, so that a pair of contacts costs no trigonometry.

use nalgebra::{Vector2, Vector3};

use super::{MeshContact, MeshGround};
use crate::{
    ballistics::ContactLimits,
    chain::{GroundRefusal, SegmentConstraints, facet_constraints},
    quantity::{Angle, AngleInterval, FacetId, SlopeInterval},
    world::{Contact, Direction, PreparedCone},
};

/// What a facet allows a take-off or a landing, for every direction of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hold {
    /// Nothing: it is too steep to rest on, kept out, or its speed limit is 0.
    Refused,
    /// What its friction cone holds, up to this speed.
    Cone(PreparedCone, f64),
    /// Every direction, up to this speed: a touchdown with brakes.
    Every(f64),
    /// Angles from the slope, which depend on the direction of travel in more than the cut of a cone.
    Stated,
}

impl Hold {
    /// The directions that a facet of this normal allows; empty if none, `None` where they are stated.
    #[inline]
    pub(super) fn limits(&self, normal: Vector3<f64>, heading: Vector2<f64>, kind: Contact) -> Option<ContactLimits> {
        let (slopes, speed_max_m_s) = match self {
            Self::Refused => (SlopeInterval::EMPTY, 0.0),
            Self::Cone(cone, speed_m_s) => {
                let inwards = match kind {
                    Contact::Takeoff => normal,
                    Contact::Landing => -normal,
                };
                (cone.slopes(inwards, heading), *speed_m_s)
            }
            Self::Every(speed_m_s) => (SlopeInterval::ALL, *speed_m_s),
            Self::Stated => return None,
        };
        Some(ContactLimits { slopes, speed_max_m_s })
    }
}

impl MeshGround {
    /// What holds a take-off and a landing on a facet of this normal.
    pub(super) fn holds(&self, id: FacetId, normal: Vector3<f64>) -> [Hold; 2] {
        let Some(constraints) = self.constraints(id, normal, steepest(normal)) else { return [Hold::Refused; 2] };
        let face = self.face_surface(id);
        let Some(friction) = face.ground.friction.or(face.surface.constant_friction()) else { return [Hold::Stated; 2] };
        let brakes = self.envelope.hopper().limits().landing.brakes();
        [Contact::Takeoff, Contact::Landing].map(|kind| {
            let stated = constraints.stated(Direction::Forward).map(|line| line.contact(kind).speed_max_m_s());
            if kind == Contact::Landing && brakes {
                return match constraints.check_contact(kind, Direction::Forward) {
                    Ok(rule) => Hold::Every(rule.speed_max_m_s()),
                    Err(_) => Hold::Refused,
                };
            }
            match stated {
                Some(speed_m_s) if constraints.refusal().is_none() && speed_m_s > 0.0 => {
                    Hold::Cone(PreparedCone::new(friction), speed_m_s)
                }
                _ => Hold::Refused,
            }
        })
    }

    /// The constraints of a facet for one direction of travel; `None` where it states no grip.
    pub(super) fn constraints(&self, id: FacetId, normal: Vector3<f64>, heading: Vector2<f64>) -> Option<SegmentConstraints> {
        let (hopper, gravity, face) = (self.envelope.hopper(), self.envelope.gravity(), self.face_surface(id));
        facet_constraints(normal, heading, face.ground, hopper, gravity, &face.surface).ok()
    }

    /// What the facets at a contact allow for a direction of travel, the strictest of each limit; `None` if they refuse every hop. This
    /// is the version for inner loops.
    #[inline]
    pub(super) fn limits(&self, contact: &MeshContact, heading: Vector2<f64>, kind: Contact) -> Option<ContactLimits> {
        let mut least = ContactLimits { slopes: SlopeInterval::ALL, speed_max_m_s: f64::INFINITY };
        for facet in contact.facets() {
            let hold = &facet.holds[kind as usize];
            let limits = match hold.limits(facet.normal, heading, kind) {
                Some(limits) => limits,
                None => self.constraints(facet.id, facet.normal, heading)?.allowed(kind, Direction::Forward)?.contact_limits(),
            };
            least.slopes = least.slopes.intersect(limits.slopes);
            least.speed_max_m_s = least.speed_max_m_s.min(limits.speed_max_m_s);
        }
        (!least.slopes.is_empty()).then_some(least)
    }

    /// What the facets at a contact allow for a direction of travel: the strictest of each limit.
    ///
    /// # Errors
    /// Why they refuse every hop, and the facet that does.
    pub fn allowed(
        &self,
        contact: &MeshContact,
        heading: Vector2<f64>,
        kind: Contact,
    ) -> Result<ContactLimits, (GroundRefusal, FacetId)> {
        self.limits(contact, heading, kind).ok_or_else(|| self.refusal(contact, heading, kind))
    }

    /// Why the facets at a contact refuse a direction of travel.
    fn refusal(&self, contact: &MeshContact, heading: Vector2<f64>, kind: Contact) -> (GroundRefusal, FacetId) {
        let mut least = SlopeInterval::ALL;
        let mut last = FacetId(0);
        for facet in contact.facets() {
            last = facet.id;
            let hold = &facet.holds[kind as usize];
            // What does not depend on the heading was decided along the steepest direction.
            let along = if *hold == Hold::Refused { steepest(facet.normal) } else { heading };
            let Some(constraints) = self.constraints(facet.id, facet.normal, along) else {
                return (GroundRefusal::NoGround, facet.id);
            };
            let rule = match constraints.check_contact(kind, Direction::Forward) {
                Ok(rule) => rule,
                Err(refusal) => return (refusal, facet.id),
            };
            let slopes = hold.limits(facet.normal, heading, kind).map_or(rule.slopes(), |limits| limits.slopes);
            if slopes.is_empty() {
                // By the last digits of a cone that the plane of travel touches.
                return (GroundRefusal::NothingAhead { angles: rule.angles() }, facet.id);
            }
            least = least.intersect(slopes);
        }
        let [min, max] = [least.lower, least.upper].map(Angle::from_slope);
        (GroundRefusal::FacetsDisagree { angles: AngleInterval { min, max } }, last)
    }
}

/// The horizontal direction in which the plane through the normal and the vertical cuts the cone of a facet through its axis.
fn steepest(normal: Vector3<f64>) -> Vector2<f64> {
    normal.xy().try_normalize(0.0).unwrap_or_else(Vector2::x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::FacetGround,
        draw::Draw,
        world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    /// A million facets of every inclination: the prepared cones against the constraints by angles.
    #[test]
    fn prepared_cones_are_those_of_the_angles() {
        let draw = &mut Draw::seeded(1806);
        let hopper = Hopper::with_speeds(3.0, 2.0).unwrap();
        let gravity = Gravity::new(1.0).unwrap();
        let (mut open, mut closed, mut near) = (0, 0, 0);
        for round in 0..1_000_000 {
            let friction = FrictionCone::new(draw.log_uniform(1e-3, 1e2)).unwrap();
            let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest: RestSlope::Unlimited };
            let normal = match round % 8 {
                0 => Vector3::new(draw.uniform(-1e-6, 1e-6), draw.uniform(-1e-6, 1e-6), draw.uniform(-1.0, 1.0)),
                1 => Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), 0.0),
                _ => Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)),
            };
            let Some(normal) = normal.try_normalize(1e-9) else { continue };
            let (sine, cosine) = libm::sincos(draw.uniform(-3.2, 3.2));
            let heading = Vector2::new(cosine, sine);
            let across = normal.xy().perp(&heading).abs();
            if (across - libm::sin(libm::atan(friction.coefficient()))).abs() < 1e-9 {
                near += 1;
                continue;
            }
            let constraints = facet_constraints(normal, heading, FacetGround::default(), &hopper, gravity, &surface).unwrap();
            let cone = Hold::Cone(PreparedCone::new(friction), 3.0);
            for kind in [Contact::Takeoff, Contact::Landing] {
                let quick = cone.limits(normal, heading, kind).unwrap().slopes.angles();
                let slow = constraints.check_contact(kind, Direction::Forward).ok().and_then(|rule| rule.slopes().angles());
                let ends = |angles: Option<AngleInterval>| angles.map(|angles| [angles.min.radians(), angles.max.radians()]);
                match (ends(quick), ends(slow)) {
                    (Some(quick), Some(slow)) => {
                        open += 1;
                        let apart = (quick[0] - slow[0]).abs().max((quick[1] - slow[1]).abs());
                        assert!(apart < 1e-10, "{quick:?} {slow:?} {normal:?} {heading:?} {friction:?} {kind:?}");
                    }
                    (None, None) => closed += 1,
                    (one, other) => {
                        let [min, max] = one.or(other).unwrap();
                        assert!(max - min < 1e-10, "{one:?} {other:?} {normal:?} {heading:?} {friction:?} {kind:?}");
                    }
                }
            }
        }
        assert!(open > 300_000 && closed > 300_000 && near < 1_000, "{open} open, {closed} closed, {near} near");
    }
}
