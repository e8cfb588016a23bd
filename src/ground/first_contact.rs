//! Where an arc first meets the ground, and whether the ground holds the hopper there.

use nalgebra::{Point3, Vector2, Vector3};

use super::{HeightField, Surface};
use crate::{
    chain::{ContactRule, FootprintRefusal, GroundRefusal},
    world::tolerant_speed_m_s,
};

/// The actual velocity at which a hop leaves the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiftoffVelocity {
    /// Horizontal direction, of length 1: (east, north) on a map, (1, 0) or (-1, 0) on a chain.
    pub heading: Vector2<f64>,
    /// Horizontal speed, not negative, m/s.
    pub horizontal_m_s: f64,
    /// Vertical speed, m/s.
    pub vertical_m_s: f64,
}

impl LiftoffVelocity {
    /// Whether the speed is zero: the hopper stays where it is.
    pub fn stays(&self) -> bool {
        self.horizontal_m_s == 0.0 && self.vertical_m_s == 0.0
    }
}

/// How one flight ends.
#[derive(Clone, Copy, Debug)]
pub struct Flight<C, F> {
    /// The first contact, or the last position over known ground.
    pub end: C,
    /// The facet at the contact; `None` if the flight leaves the known ground.
    pub support_facet: Option<F>,
    /// Time of flight, s.
    pub time_s: f64,
}

/// The realization of the uncertain ground in one trial: how it differs from the map.
#[derive(Clone, Debug, Default)]
pub struct Realization {
    /// Added to every friction coefficient.
    pub friction: f64,
    /// Added to every height.
    pub heights: Option<Box<HeightField>>,
}

/// Why a contact does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactFailure {
    /// The direction lies outside the cone, or the surface is too steep to rest on, or under the footprint too rough.
    Slides,
    /// The landing is faster than its limit.
    TooFast,
    /// The contact lies in a keep-out zone, where a layer refuses it or where no ground is known, or a layer refuses the flight.
    OffLimits,
}

/// Ground over which an arc can be followed to its first contact: the nominal ground, or a realization of it.
pub trait FirstContact: Surface + Clone + Send + Sync {
    /// The facet that supports a landing.
    type SupportFacet: Copy;

    /// Changes this ground to the realization of another trial.
    fn realize(&mut self, realization: Realization);

    /// A position of the plan on the realized ground: the same horizontal position at the realized height.
    fn realized(&self, planned: Self::Contact) -> Self::Contact;

    /// Coordinates of a position: on a chain x along it, y to its left, z up; on a map easting, northing and z.
    fn point(&self, position: &Self::Contact) -> Point3<f64>;

    /// How far two of its points are apart, as errors of landings and the distance from a goal are measured, m: horizontally.
    fn apart_m(&self, one: &Point3<f64>, other: &Point3<f64>) -> f64 {
        (one - other).xy().norm()
    }

    /// Whether the ground holds a take-off with this velocity.
    fn holds_takeoff(&self, from: &Self::Contact, liftoff: &LiftoffVelocity) -> bool;

    /// The first contact of an arc. An arc that passes its aim within rounding lands on it.
    fn first_contact(
        &self,
        from: &Self::Contact,
        liftoff: &LiftoffVelocity,
        aim: &Self::Contact,
    ) -> Flight<Self::Contact, Self::SupportFacet>;

    /// Whether the ground holds a landing.
    ///
    /// # Errors
    /// The [`ContactFailure`] of a landing that does not hold.
    fn check_landing(
        &self,
        end: &Self::Contact,
        support_facet: &Self::SupportFacet,
        touchdown: &TouchdownState,
    ) -> Result<(), ContactFailure>;

    /// Whether the layers of the map hold under a flight from one contact to another.
    ///
    /// # Errors
    /// [`ContactFailure::OffLimits`] where one does not.
    fn check_track(&self, _from: &Self::Contact, _end: &Self::Contact) -> Result<(), ContactFailure> {
        Ok(())
    }

    /// The outward normal of a facet, of any length, in the coordinates of [`point`](Self::point). A chain does not slope to the side.
    fn normal(&self, facet: &Self::SupportFacet) -> Vector3<f64>;

    /// Whether the ground allows a contact after the first one, from which the hopper bounces on or at which it comes to rest: outside
    /// keep-out zones, and not faster than the landing speed limit.
    ///
    /// # Errors
    /// [`ContactFailure::OffLimits`] or [`ContactFailure::TooFast`].
    fn check_bounce(
        &self,
        end: &Self::Contact,
        facet: &Self::SupportFacet,
        touchdown: &TouchdownState,
    ) -> Result<(), ContactFailure>;

    /// Whether the hopper rests on a facet that it reached along a heading.
    ///
    /// # Errors
    /// [`ContactFailure::OffLimits`] or [`ContactFailure::Slides`] where it cannot rest.
    fn check_rest(&self, position: &Self::Contact, facet: &Self::SupportFacet, heading: Vector2<f64>)
    -> Result<(), ContactFailure>;

    /// Where the hopper comes to rest after a bounce-and-roll displacement along and to the left of its heading.
    ///
    /// # Errors
    /// [`ContactFailure::OffLimits`] or [`ContactFailure::Slides`] where the hopper cannot rest.
    fn displaced(
        &self,
        from: &Self::Contact,
        heading: Vector2<f64>,
        along_m: f64,
        left_m: f64,
    ) -> Result<Self::Contact, ContactFailure>;

    /// The hopper's position estimate on the nominal ground, for these errors; `None` where there is no ground.
    fn believed(&self, position: &Self::Contact, along_m: f64, across_m: f64) -> Option<Self::Contact>;
}

/// How far rounding may displace a flight, as a fraction of its size: the tolerance of `path::execute`, for the same reasons.
pub(super) const PLACE_TOLERANCE: f64 = 1e-12;

/// Tolerance of directions, rad, as in `path::execute`: a tangent and an arc tangent between limit and command leave an error of
/// some 1e-15.
pub(super) const ANGLE_TOLERANCE_RAD: f64 = 1e-9;

/// Rounding error of a speed, as a fraction.
const SPEED_ROUNDING: f64 = 1e-12;

/// The state of the robot at touchdown.
#[derive(Clone, Copy, Debug)]
pub struct TouchdownState {
    /// Horizontal direction, of length 1: (east, north) on a map, (1, 0) or (-1, 0) on a chain.
    pub heading: Vector2<f64>,
    /// Horizontal speed, m/s.
    pub horizontal_m_s: f64,
    /// Vertical speed, negative on the way down, m/s.
    pub vertical_m_s: f64,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Uncertainty of the direction from rounding, rad.
    pub angle_tolerance_rad: f64,
    speed_tolerance_m_s: f64,
}

impl TouchdownState {
    /// The state after a time of flight under gravity.
    pub fn after(liftoff: &LiftoffVelocity, time_s: f64, gravity_m_s2: f64) -> Self {
        let vertical_m_s = liftoff.vertical_m_s - gravity_m_s2 * time_s;
        let (across, up) = (liftoff.horizontal_m_s, vertical_m_s);
        let speed_m_s = (across * across + up * up).sqrt();
        // An error e of the position turns the direction by e g v_x / v^3 and changes the speed by e g v_z / v^2.
        let size_m = across * time_s + liftoff.vertical_m_s.abs() * time_s;
        let along_s = PLACE_TOLERANCE * size_m * gravity_m_s2 / (speed_m_s * speed_m_s);
        let uncertain = if along_s.is_finite() { along_s } else { 0.0 };
        Self {
            heading: liftoff.heading,
            horizontal_m_s: across,
            vertical_m_s,
            speed_m_s,
            angle_tolerance_rad: ANGLE_TOLERANCE_RAD + if speed_m_s > 0.0 { uncertain * across / speed_m_s } else { 0.0 },
            speed_tolerance_m_s: SPEED_ROUNDING * speed_m_s + uncertain * up.abs(),
        }
    }

    /// Whether the speed exceeds a limit.
    pub fn is_over(&self, speed_max_m_s: f64) -> bool {
        self.speed_m_s > tolerant_speed_m_s(speed_max_m_s) + self.speed_tolerance_m_s
    }
}

/// Whether a direction lies within the slopes of a rule; the slope of straight up or down is infinite.
pub(super) fn within(rule: &ContactRule, horizontal_m_s: f64, vertical_m_s: f64, tolerance_rad: f64) -> bool {
    let slope = vertical_m_s / horizontal_m_s;
    if !slope.is_finite() {
        return rule.slopes().contains(if vertical_m_s > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY });
    }
    let tolerance = tolerance_rad * (1.0 + slope * slope);
    rule.slopes().lower - tolerance <= slope && slope <= rule.slopes().upper + tolerance
}

/// The failure of a contact whose footprint the ground refuses.
pub(super) const fn failure_of(refusal: &FootprintRefusal) -> ContactFailure {
    match refusal {
        FootprintRefusal::TooSteep { .. } | FootprintRefusal::TooRough { .. } => ContactFailure::Slides,
        FootprintRefusal::Unknown { .. } => ContactFailure::OffLimits,
    }
}

/// Whether a rule holds a take-off; a refusal does not.
pub(super) fn holds(rule: Result<ContactRule, GroundRefusal>, liftoff: &LiftoffVelocity) -> bool {
    rule.is_ok_and(|rule| within(&rule, liftoff.horizontal_m_s, liftoff.vertical_m_s, ANGLE_TOLERANCE_RAD))
}

/// Whether a rule holds a landing; of a refusal, which failure it causes.
pub(super) fn check_landing(
    rule: Result<ContactRule, GroundRefusal>,
    landing_speed_max_m_s: f64,
    touchdown: &TouchdownState,
) -> Result<(), ContactFailure> {
    match rule {
        Err(GroundRefusal::KeepOut | GroundRefusal::Layer(_)) => Err(ContactFailure::OffLimits),
        Err(GroundRefusal::Footprint(refusal)) if !touchdown.is_over(landing_speed_max_m_s) => Err(failure_of(&refusal)),
        Err(refusal) => {
            let stated = matches!(refusal, GroundRefusal::SpeedZero | GroundRefusal::TouchdownSpeed { .. });
            let too_fast = stated || touchdown.is_over(landing_speed_max_m_s);
            Err(if too_fast { ContactFailure::TooFast } else { ContactFailure::Slides })
        }
        Ok(rule) if touchdown.is_over(rule.speed_max_m_s()) => Err(ContactFailure::TooFast),
        Ok(rule) if within(&rule, touchdown.horizontal_m_s, touchdown.vertical_m_s, touchdown.angle_tolerance_rad) => Ok(()),
        Ok(_) => Err(ContactFailure::Slides),
    }
}
