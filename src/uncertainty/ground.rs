//! What a trial asks of the ground, whether a chain or a map.

use nalgebra::{Point3, Vector2};

use super::{TrialOutcome, field::HeightField};
use crate::{
    chain::{ContactRule, GroundRefusal},
    world::tolerant_speed_m_s,
};

/// The velocity at which a hop really leaves the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiftoffVelocity {
    /// Direction on the map (east, north), of length 1; on a chain (1, 0) or (-1, 0).
    pub heading: Vector2<f64>,
    /// Horizontal speed, not negative, m/s.
    pub horizontal_m_s: f64,
    /// Vertical speed, m/s.
    pub vertical_m_s: f64,
}

impl LiftoffVelocity {
    /// Whether there is no speed at all: the robot stays where it is.
    pub(super) fn stays(&self) -> bool {
        self.horizontal_m_s == 0.0 && self.vertical_m_s == 0.0
    }
}

/// A command, and the landing that it aims at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Command<S> {
    pub(super) liftoff: LiftoffVelocity,
    pub(super) speed_m_s: f64,
    pub(super) aim: S,
}

impl<S> Command<S> {
    pub(super) fn new(liftoff: LiftoffVelocity, aim: S) -> Self {
        Self { liftoff, speed_m_s: libm::hypot(liftoff.horizontal_m_s, liftoff.vertical_m_s), aim }
    }
}

/// How one flight went.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight<S, F> {
    /// The first contact, or the last place over known ground.
    pub(super) end: S,
    /// The facet met there; `None` where it leaves the known ground in flight.
    pub(super) support_facet: Option<F>,
    pub(super) time_s: f64,
}

/// The realization of the uncertain ground in one trial: how it differs from the map.
#[derive(Clone, Debug, Default)]
pub(super) struct Realization {
    /// Added to every friction coefficient.
    pub(super) friction: f64,
    pub(super) heights: Option<Box<HeightField>>,
}

/// Ground to fly over: nominal, or as one trial finds it.
pub(super) trait Ground: Clone + Send + Sync {
    /// A position at which the robot can stand.
    type Position: Copy + PartialEq + Send + Sync + std::fmt::Debug;
    /// The facet of the ground that supports a landing.
    type SupportFacet: Copy;

    /// Makes it the ground of another trial, as drawn.
    fn realize(&mut self, realization: Realization);

    /// A position of the plan on the real ground.
    fn real(&self, planned: Self::Position) -> Self::Position;

    /// The coordinates of a position: x, y, z.
    fn point(&self, position: &Self::Position) -> Point3<f64>;

    /// Whether the ground holds a take-off in this direction.
    fn holds_takeoff(&self, from: &Self::Position, liftoff: &LiftoffVelocity) -> bool;

    /// Flies to the first contact. A flight that passes its aim as closely as rounding allows lands on it.
    fn fly(
        &self,
        from: &Self::Position,
        liftoff: &LiftoffVelocity,
        aim: &Self::Position,
    ) -> Flight<Self::Position, Self::SupportFacet>;

    /// What the landing does to the robot; `None` where it holds.
    fn landing_failure(
        &self,
        end: &Self::Position,
        support_facet: &Self::SupportFacet,
        touchdown: &TouchdownState,
    ) -> Option<TrialOutcome>;

    /// Where it comes to rest after a bounce-and-roll displacement along and to the left of its heading, or how the trial ends there.
    fn displaced(
        &self,
        from: &Self::Position,
        heading: Vector2<f64>,
        along_m: f64,
        left_m: f64,
    ) -> Result<Self::Position, TrialOutcome>;

    /// Where the robot believes to be, so far off: a place of the nominal ground; `None` where that has no ground.
    fn believed(&self, position: &Self::Position, along_m: f64, across_m: f64) -> Option<Self::Position>;

    /// The best next hop from a place of the nominal ground; `None` where none leads on.
    fn replanned(&self, believed: &Self::Position) -> Option<Command<Self::Position>>;
}

/// How far rounding may carry a flight from its place, as a share of its size: the tolerance of `path::execute`, for the same reasons.
pub(super) const PLACE_TOLERANCE: f64 = 1e-12;

/// How far a direction may lie over its limit, rad, as in `path::execute`: a tangent and its arc tangent on the way from a limit to a
/// command leave some 1e-15.
pub(super) const ANGLE_TOLERANCE_RAD: f64 = 1e-9;

/// What may be lost of a speed by the formulas that gave it, as a share.
const SPEED_ROUNDING: f64 = 1e-12;

/// The state of the robot at touchdown.
#[derive(Clone, Copy, Debug)]
pub(super) struct TouchdownState {
    pub(super) heading: Vector2<f64>,
    pub(super) horizontal_m_s: f64,
    pub(super) vertical_m_s: f64,
    pub(super) speed_m_s: f64,
    /// How uncertain rounding leaves direction and speed.
    pub(super) angle_tolerance_rad: f64,
    speed_tolerance_m_s: f64,
}

impl TouchdownState {
    /// After so much time of flight under gravity.
    pub(super) fn after(liftoff: &LiftoffVelocity, time_s: f64, gravity_m_s2: f64) -> Self {
        let vertical_m_s = liftoff.vertical_m_s - gravity_m_s2 * time_s;
        let (across, up) = (liftoff.horizontal_m_s, vertical_m_s);
        let speed_m_s = (across * across + up * up).sqrt();
        // A place uncertain by e turns the direction by e g v_x / v^3 and changes the speed by e g v_z / v^2.
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

    /// Whether it is faster than a limit allows.
    pub(super) fn is_over(&self, speed_max_m_s: f64) -> bool {
        self.speed_m_s > tolerant_speed_m_s(speed_max_m_s) + self.speed_tolerance_m_s
    }
}

/// Whether a direction lies within the slopes of a rule; straight up or down is infinite.
pub(super) fn within(rule: &ContactRule, horizontal_m_s: f64, vertical_m_s: f64, tolerance_rad: f64) -> bool {
    let slope = vertical_m_s / horizontal_m_s;
    if !slope.is_finite() {
        return rule.slopes().contains(if vertical_m_s > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY });
    }
    let tolerance = tolerance_rad * (1.0 + slope * slope);
    rule.slopes().lower - tolerance <= slope && slope <= rule.slopes().upper + tolerance
}

/// Whether a rule, or what the ground says instead, holds a take-off.
pub(super) fn holds(rule: Result<ContactRule, GroundRefusal>, liftoff: &LiftoffVelocity) -> bool {
    rule.is_ok_and(|rule| within(&rule, liftoff.horizontal_m_s, liftoff.vertical_m_s, ANGLE_TOLERANCE_RAD))
}

/// What a landing under a rule, or what the ground says instead, does to the robot.
pub(super) fn failure(
    rule: Result<ContactRule, GroundRefusal>,
    landing_speed_max_m_s: f64,
    touchdown: &TouchdownState,
) -> Option<TrialOutcome> {
    match rule {
        Err(GroundRefusal::KeepOut) => Some(TrialOutcome::Lost),
        Err(GroundRefusal::SpeedZero) => Some(TrialOutcome::Damaged),
        Err(_) if touchdown.is_over(landing_speed_max_m_s) => Some(TrialOutcome::Damaged),
        Err(_) => Some(TrialOutcome::SlidAtLanding),
        Ok(rule) if touchdown.is_over(rule.speed_max_m_s()) => Some(TrialOutcome::Damaged),
        Ok(rule) => {
            let stays = within(&rule, touchdown.horizontal_m_s, touchdown.vertical_m_s, touchdown.angle_tolerance_rad);
            (!stays).then_some(TrialOutcome::SlidAtLanding)
        }
    }
}
