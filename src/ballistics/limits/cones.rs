//! Direction limits: the cones of the ground, and the take-off angles of the mechanism.

use crate::{ballistics::LineOfSight, quantity::SlopeInterval};

/// The lofts whose take-off slope lies in a cone.
///
/// ```text
///     m1 <= b + n <= m2                                                        (CHTA paper, Definition 2)
/// ```
///
/// Used both for the take-off cone of the ground and for the take-off angles of the mechanism.
///
/// # Returns
/// The cone's interval of slopes moved by `-b`; empty if the cone is. An infinite end stays infinite.
///
/// # Examples
/// ```
/// use chta::{ballistics::{LineOfSight, limits}, quantity::SlopeInterval};
/// let cone = SlopeInterval { lower: 1.0, upper: f64::INFINITY };
/// assert_eq!(limits::takeoff_cone(LineOfSight::new(2.0, 1.0), cone).lower, 0.5);
/// ```
#[inline]
pub fn takeoff_cone(sight: LineOfSight, slopes: SlopeInterval) -> SlopeInterval {
    SlopeInterval { lower: slopes.lower - sight.slope(), upper: slopes.upper - sight.slope() }
}

/// The lofts whose landing slope lies in a cone.
///
/// ```text
///     l1 <= b - n <= l2                                                        (P eq. 12, 13)
/// ```
///
/// # Returns
/// The interval `[b - l2, b - l1]`; empty if the cone is. An infinite end stays infinite.
///
/// # Examples
/// ```
/// use chta::{ballistics::{LineOfSight, limits}, quantity::SlopeInterval};
/// let cone = SlopeInterval { lower: -3.0, upper: -1.0 };
/// let lofts = limits::landing_cone(LineOfSight::new(2.0, 1.0), cone);
/// assert_eq!((lofts.lower, lofts.upper), (1.5, 3.5));
/// ```
#[inline]
pub fn landing_cone(sight: LineOfSight, slopes: SlopeInterval) -> SlopeInterval {
    SlopeInterval { lower: sight.slope() - slopes.upper, upper: sight.slope() - slopes.lower }
}
