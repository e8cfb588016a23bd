//! The grip of the ground, and the steepest slope to rest on.

use super::FrictionCone;
use crate::quantity::{Angle, AngleInterval};

/// What keeps the hopper's foot from sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// Coulomb friction: a cone about the surface normal (Campana and Laumond 2016, section IV-A).
    Friction(FrictionCone),
    /// Angles relative to the segment's own slope, as in the CHTA paper (section V-B); the cross-slope has no effect.
    FromSlope {
        /// Take-off angles relative to the slope.
        takeoff: AngleInterval,
        /// Landing angles relative to the slope.
        landing: AngleInterval,
    },
}

/// The steepest surface on which a hopper may rest between hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestSlope {
    /// The friction angle `atan mu` if a friction coefficient is given, else no limit.
    AsFrictionHolds,
    /// A given slope.
    AtMost(Angle),
    /// No limit, as in the CHTA paper: a contact lasts an instant and the hopper does not rest.
    Unlimited,
}

/// The ground properties where the chain itself states none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// What keeps the foot from sliding; `None` if every segment of the chain states it.
    pub grip: Option<Grip>,
    /// The steepest slope to rest on.
    pub rest: RestSlope,
}
