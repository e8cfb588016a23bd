//! The take-off and landing speed limits.

use crate::{
    ballistics::LineOfSight,
    quantity::{MonicQuadratic, SlopeInterval},
    world::tolerant_speed_m_s,
};

/// The lofts at which the take-off speed stays within its limit.
///
/// ```text
///     g X (1 + (b + n)^2) <= 2 n v^2   <=>   n^2 - 2 (q - b) n + (1 + b^2) <= 0,   q = v^2 / (g X)      (P eq. 15)
/// ```
///
/// The limit is applied as `v (1 + 1e-9)`, the program's only tolerance.
///
/// # Units
/// `v` in m/s, `g` in m/s^2.
///
/// # Returns
/// A closed interval of positive lofts; empty if the landing is out of reach, and for `v = 0` or NaN.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, limits};
/// // Flat, q = 1.25: n^2 - 2.5 n + 1 = (n - 0.5)(n - 2)
/// let lofts = limits::takeoff_speed(LineOfSight::new(8.0, 0.0), 10.0, 10.0);
/// assert!((lofts.lower - 0.5).abs() < 1e-8 && (lofts.upper - 2.0).abs() < 1e-8);
/// ```
#[inline]
pub fn takeoff_speed(sight: LineOfSight, speed_max_m_s: f64, gravity_m_s2: f64) -> SlopeInterval {
    between_roots(sight, reach_ratio(sight, speed_max_m_s, gravity_m_s2) - sight.min_speed_ratio())
}

/// The lofts at which the landing speed stays within its limit.
///
/// ```text
///     g X (1 + (b - n)^2) <= 2 n v^2   <=>   n^2 - 2 (q + b) n + (1 + b^2) <= 0,   q = v^2 / (g X)      (P eq. 17, with v_l)
/// ```
///
/// Equal to the take-off limit at `v^2 + 2 g Z`, without the cancellation of that sum. Units, tolerance and return value are
/// those of [`takeoff_speed`].
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, limits};
/// // The same speed reaches the same flat distance at either end.
/// let sight = LineOfSight::new(8.0, 0.0);
/// assert_eq!(limits::landing_speed(sight, 10.0, 10.0), limits::takeoff_speed(sight, 10.0, 10.0));
/// ```
#[inline]
pub fn landing_speed(sight: LineOfSight, speed_max_m_s: f64, gravity_m_s2: f64) -> SlopeInterval {
    between_roots(sight, reach_ratio(sight, speed_max_m_s, gravity_m_s2) - sight.min_speed_ratio_reversed())
}

/// The intersection of both speed limits, with one square root: the two quadratics have the same product of roots, so the
/// interval with the smaller sum of roots lies inside the other.
///
/// ```
/// use chta::ballistics::{LineOfSight, limits};
/// let sight = LineOfSight::new(5.0, -2.0);
/// let both = limits::speeds(sight, 9.0, 10.0, 5.0);
/// assert_eq!(both, limits::takeoff_speed(sight, 9.0, 5.0).intersect(limits::landing_speed(sight, 10.0, 5.0)));
/// ```
#[inline]
pub fn speeds(sight: LineOfSight, takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64, gravity_m_s2: f64) -> SlopeInterval {
    let takeoff = reach_ratio(sight, takeoff_speed_max_m_s, gravity_m_s2) - sight.min_speed_ratio();
    let landing = reach_ratio(sight, landing_speed_max_m_s, gravity_m_s2) - sight.min_speed_ratio_reversed();
    between_roots(sight, takeoff.min(landing))
}

/// `q = v^2 / (g X)`, the speed limit with its tolerance.
#[inline]
fn reach_ratio(sight: LineOfSight, speed_max_m_s: f64, gravity_m_s2: f64) -> f64 {
    let v = tolerant_speed_m_s(speed_max_m_s);
    v * v / (gravity_m_s2 * sight.run_m())
}

/// The interval between the roots of `n^2 - 2 (w + e) n + w^2`, with `w = sqrt(1 + b^2)` and the excess `e` of `q` over its
/// least value.
#[inline]
fn between_roots(sight: LineOfSight, excess: f64) -> SlopeInterval {
    match (MonicQuadratic { excess, geometric_mean: sight.secant() }).roots() {
        Some(roots) => SlopeInterval { lower: roots.smaller, upper: roots.larger },
        None => SlopeInterval::EMPTY,
    }
}
