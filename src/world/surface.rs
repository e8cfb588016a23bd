//! The grip of the ground, and the steepest slope to rest on.

use std::f64::consts::FRAC_PI_2;

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
pub struct SurfaceProperties {
    /// What keeps the foot from sliding; `None` if every segment of the chain states it.
    pub grip: Option<Grip>,
    /// The steepest slope to rest on.
    pub rest: RestSlope,
}

/// A property of a surface that has no meaning.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidSurface {
    /// Angles above the slope that are not two finite angles in order.
    #[error("surface.{key} is [{min_deg}, {max_deg}], expected two finite angles in degrees, [min, max], min not above max")]
    FromSlope {
        /// The key in a scenario.
        key: &'static str,
        /// The lower end, degrees.
        min_deg: f64,
        /// The upper end, degrees.
        max_deg: f64,
    },
    /// A rest slope that is not an angle between the horizontal and the vertical.
    #[error("surface.rest_slope_max_deg is {found_deg}, expected an angle from 0 to 90 degrees")]
    RestSlope {
        /// What was found, degrees.
        found_deg: f64,
    },
}

impl SurfaceProperties {
    /// The friction of the whole ground; `None` if the grip is not a friction cone.
    pub const fn constant_friction(&self) -> Option<FrictionCone> {
        match self.grip {
            Some(Grip::Friction(cone)) => Some(cone),
            Some(Grip::FromSlope { .. }) | None => None,
        }
    }

    /// Whether all that is stated has a meaning.
    ///
    /// # Errors
    /// The first [`InvalidSurface`].
    pub fn check(&self) -> Result<(), InvalidSurface> {
        if let Some(Grip::FromSlope { takeoff, landing }) = self.grip {
            for (key, angles) in [("takeoff_from_slope_deg", takeoff), ("landing_from_slope_deg", landing)] {
                let finite = angles.min.radians().is_finite() && angles.max.radians().is_finite();
                if !finite || angles.min > angles.max {
                    let (min_deg, max_deg) = (angles.min.degrees(), angles.max.degrees());
                    return Err(InvalidSurface::FromSlope { key, min_deg, max_deg });
                }
            }
        }
        match self.rest {
            RestSlope::AtMost(angle) if !(0.0..=FRAC_PI_2).contains(&angle.radians()) => {
                Err(InvalidSurface::RestSlope { found_deg: angle.degrees() })
            }
            RestSlope::AtMost(_) | RestSlope::AsFrictionHolds | RestSlope::Unlimited => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_that_have_no_meaning_are_refused() {
        let good = AngleInterval::from_degrees(-10.0, 80.0);
        let surface =
            |takeoff, landing| SurfaceProperties { grip: Some(Grip::FromSlope { takeoff, landing }), rest: RestSlope::Unlimited };
        assert_eq!(surface(good, good).check(), Ok(()));
        for (min, max) in [(80.0, -10.0), (f64::NAN, 80.0), (10.0, f64::NAN), (f64::NEG_INFINITY, 0.0), (0.0, f64::INFINITY)] {
            let bad = AngleInterval::from_degrees(min, max);
            let key = |surface: SurfaceProperties| match surface.check() {
                Err(InvalidSurface::FromSlope { key, .. }) => key,
                other => panic!("{min} to {max}: {other:?}"),
            };
            assert_eq!(key(surface(bad, good)), "takeoff_from_slope_deg");
            assert_eq!(key(surface(good, bad)), "landing_from_slope_deg");
        }
    }

    #[test]
    fn a_rest_slope_lies_between_the_horizontal_and_the_vertical() {
        let rest = |degrees| SurfaceProperties { grip: None, rest: RestSlope::AtMost(Angle::from_degrees(degrees)) }.check();
        for good in [0.0, 30.0, 90.0] {
            assert_eq!(rest(good), Ok(()), "{good}");
        }
        for bad in [-1.0, 90.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(matches!(rest(bad), Err(InvalidSurface::RestSlope { .. })), "{bad}");
        }
    }
}
