//! The apex height limit.

use crate::{
    ballistics::LineOfSight,
    quantity::{MonicQuadratic, SlopeInterval},
};

/// The lofts at which the flight rises at most a given height above its take-off.
///
/// ```text
///     X (b + n)^2 <= 4 H n   <=>   n^2 - 2 (2 H / X - b) n + b^2 <= 0
/// ```
///
/// Only the larger root is a bound: below the smaller root the parabola has its apex before the take-off (falling ground) or
/// beyond the landing (rising ground), so the flight's highest point is the take-off or the landing itself.
///
/// Source: model section 2 (apex height), with that correction.
///
/// # Units
/// `H` in m.
///
/// # Returns
/// An interval without lower bound; empty if the landing itself is higher than `H`.
///
/// # Degenerate
/// `H = 0` over falling ground leaves the arcs that never rise, `n <= -b`. `H < 0` and NaN give the empty interval.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, limits};
/// // Flat: X n / 4 <= H
/// assert_eq!(limits::apex_height(LineOfSight::new(10.0, 0.0), 2.5).upper, 1.0);
/// assert!(limits::apex_height(LineOfSight::new(10.0, 3.0), 2.5).is_empty());
/// ```
#[inline]
pub fn apex_height(sight: LineOfSight, height_max_m: f64) -> SlopeInterval {
    let (b, h) = (sight.slope(), height_max_m / sight.run_m());
    // Half the sum of the roots, 2 h - b, minus their geometric mean |b|.
    match (MonicQuadratic { excess: 2.0 * (h - b.max(0.0)), geometric_mean: b.abs() }).roots() {
        Some(roots) => SlopeInterval { lower: f64::NEG_INFINITY, upper: roots.larger },
        None => SlopeInterval::EMPTY,
    }
}
