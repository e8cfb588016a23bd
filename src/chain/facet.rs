//! What a facet of any inclination allows for one direction of travel: walls and overhangs as well as ground.

use nalgebra::{Vector2, Vector3};

use super::{
    ConstraintProblem, GroundForm, GroundRefusal, LineConstraints, SegmentConstraints, SegmentGround,
    constrained::{commanded, resolve_constraints},
    rest_slope,
};
use crate::{
    quantity::{Angle, SegmentId},
    terrain::ProfileFacet,
    world::{FrictionCone, Gravity, Grip, Hopper, SurfaceProperties},
};

/// What the surface of a facet is, other than its geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FacetGround {
    /// Its own friction; `None` where that of the scenario holds.
    pub(crate) friction: Option<FrictionCone>,
    /// Whether it lies in a keep-out zone.
    pub(crate) keep_out: bool,
}

/// The constraints of a facet for one direction of travel.
///
/// A facet that faces up is ground, with its slope along the direction of travel and its cross-slope. The cone of one that does not is
/// that about its normal; it is steeper than every rest slope, and holds no touchdown straight down.
///
/// # Arguments
/// `normal`: of length 1, away from the body; `heading`: the horizontal direction of travel, of length 1.
///
/// # Errors
/// [`ConstraintProblem`], where neither the facet nor the surface states a grip, or the hopper no speeds.
pub(crate) fn facet_constraints(
    normal: Vector3<f64>,
    heading: Vector2<f64>,
    facet: FacetGround,
    hopper: &Hopper,
    gravity: Gravity,
    surface: &SurfaceProperties,
) -> Result<SegmentConstraints, ConstraintProblem> {
    let id = SegmentId(0);
    let friction = facet.friction.or(surface.constant_friction());
    if normal.z > 0.0 {
        let gradient = -normal.xy() / normal.z;
        let cross_slope = ProfileFacet::from_gradient(gradient, heading).cross_slope;
        let ground = SegmentGround { form: GroundForm::Surface { friction, cross_slope }, keep_out: facet.keep_out };
        return resolve_constraints(id, gradient.dot(&heading), &ground, hopper, gravity, surface);
    }
    let tilt = Angle::from_radians(libm::atan2(libm::hypot(normal.x, normal.y), normal.z));
    let ahead = normal.xy().dot(&heading);
    let (side, in_plane) = (normal.xy().perp(&heading), libm::hypot(ahead, normal.z));
    let cross_slope = Angle::from_radians(libm::atan2(side.abs(), in_plane));
    let grip = friction.map(Grip::Friction).or(surface.grip).ok_or(ConstraintProblem::NoGrip(id))?;
    let limits = hopper.limits();
    let line = match grip {
        Grip::FromSlope { .. } => Err(GroundRefusal::FacesDown { tilt }),
        Grip::Friction(cone) => cone
            .cut(cross_slope)
            .map(|delta| {
                let elevation = Angle::from_radians(libm::atan2(normal.z, ahead));
                LineConstraints::about_normal(elevation, delta, limits.takeoff_speed_max_m_s, limits.landing_speed_max_m_s)
            })
            .ok_or(GroundRefusal::CrossSlope { cross_slope, friction: cone }),
    };
    let ground = SegmentGround { form: GroundForm::Surface { friction, cross_slope }, keep_out: facet.keep_out };
    let too_steep = rest_slope(&ground, surface).map(|max| GroundRefusal::TooSteep { tilt, max: Angle::from_slope(max) });
    let refusal = if facet.keep_out { Some(GroundRefusal::KeepOut) } else { too_steep };
    let touchdown = limits.landing.brakes().then(|| {
        let refused = match grip {
            Grip::Friction(friction) => GroundRefusal::TouchdownSlope { tilt, friction },
            Grip::FromSlope { .. } => GroundRefusal::FacesDown { tilt },
        };
        [Err(refused); 2]
    });
    commanded(id, [line, Err(GroundRefusal::NoGround)], (refusal, touchdown), hopper, gravity)
}
