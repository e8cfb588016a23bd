//! The slopes on which a robot comes to rest.

use nalgebra::Vector2;

use crate::world::RestSlope;

/// The tangent of the steepest slope to rest on, under friction of this coefficient; `None` if every slope holds.
pub(super) fn rest_slope(rest: RestSlope, friction: Option<f64>) -> Option<f64> {
    match rest {
        RestSlope::AsFrictionHolds => friction,
        RestSlope::AtMost(angle) => Some(angle.slope()),
        RestSlope::Unlimited => None,
    }
}

/// Whether the facet is flat enough to rest on; an absent limit always holds. `friction` is its coefficient, if it has one;
/// `tolerance_rad`, an angle, is converted to a slope: d tan = (1 + tan^2) d angle.
pub(super) fn rests(rest: RestSlope, gradient: Vector2<f64>, friction: Option<f64>, tolerance_rad: f64) -> bool {
    rest_slope(rest, friction).is_none_or(|max| gradient.norm() <= max + tolerance_rad * (1.0 + max * max))
}
