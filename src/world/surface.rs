//! The ground's grip, and how steep a place may be to rest on.

use super::FrictionCone;
use crate::quantity::{Angle, AngleInterval};

/// What keeps a hopper from sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// Coulomb friction: a cone about the surface normal (Campana and Laumond 2016, section IV-A).
    Friction(FrictionCone),
    /// Angles above the segment's own slope, as the CHTA paper states them (section V-B); the cross-slope does not matter.
    FromSlope {
        /// Take-off angles above the slope.
        takeoff: AngleInterval,
        /// Landing angles above the slope.
        landing: AngleInterval,
    },
}

/// The steepest surface a hopper rests on between hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestSlope {
    /// As steep as friction holds: `atan mu` where a friction coefficient is given, else no limit.
    AsFrictionHolds,
    /// No steeper than this.
    AtMost(Angle),
    /// The paper's model: contact is an instant, nothing rests.
    Unlimited,
}

/// The ground where the chain itself says nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceProperties {
    /// What keeps the hopper from sliding; `None` where every segment of the chain says it.
    pub grip: Option<Grip>,
    /// What it may rest on.
    pub rest: RestSlope,
}
