//! How far along a line of sight a speed carries.

use super::LineOfSight;

/// The distance along the direction of a line of sight that a take-off speed covers at a loft, m.
///
/// ```text
///     R_t = X w,   X = 2 n v^2 / (g (1 + (b + n)^2)),   w = sqrt(1 + b^2)                                     (P eq. 29)
///     greatest at n = w, theta = pi/4 + beta/2:   R_t = v^2 / (g (1 + sin(beta)))                         (P eq. 16, 20)
/// ```
///
/// # Units
/// `v` in m/s, `g` in m/s^2; the distance is straight, not horizontal.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, takeoff_reach_m};
/// // 30 degrees up: 100 / (10 (1 + 1/2)).
/// let up = LineOfSight::new(3f64.sqrt(), 1.0);
/// assert!((takeoff_reach_m(up, up.secant(), 10.0, 10.0) - 20.0 / 3.0).abs() < 1e-12);
/// ```
pub fn takeoff_reach_m(sight: LineOfSight, loft: f64, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    reach_m(sight, loft, sight.slope() + loft, speed_m_s, gravity_m_s2)
}

/// The same for a landing speed.
///
/// ```text
///     R_l = X w,   X = 2 n v^2 / (g (1 + (b - n)^2))                                                          (P eq. 30)
///     greatest at n = w as well:   R_l = v^2 / (g (1 - sin(beta)))                                            (P eq. 18)
/// ```
///
/// ```
/// use chta::ballistics::{LineOfSight, landing_reach_m};
/// // 30 degrees up: 100 / (10 (1 - 1/2)).
/// let up = LineOfSight::new(3f64.sqrt(), 1.0);
/// assert!((landing_reach_m(up, up.secant(), 10.0, 10.0) - 20.0).abs() < 1e-12);
/// ```
pub fn landing_reach_m(sight: LineOfSight, loft: f64, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    reach_m(sight, loft, sight.slope() - loft, speed_m_s, gravity_m_s2)
}

/// For the slope of the flight at the end that has the speed.
fn reach_m(sight: LineOfSight, loft: f64, slope: f64, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    // Two quotients: a steep arc has a slope whose square overflows.
    let secant = libm::hypot(1.0, slope);
    2.0 * speed_m_s / gravity_m_s2 * speed_m_s * (loft / secant) * (sight.secant() / secant)
}
