//! How far along a line of sight a greatest speed carries.

use super::LineOfSight;

/// The greatest distance along the direction of a line of sight that a take-off speed reaches, m.
///
/// ```text
///     R_t = v^2 / (g (1 + sin(beta))),   at theta = pi/4 + beta/2, the slope b + sqrt(1 + b^2)                    (P eq. 19, 20)
/// ```
///
/// # Units
/// `v` in m/s, `g` in m/s^2; the distance is straight, not horizontal.
///
/// # Returns
/// Infinity straight down a wall (`beta` = -90 degrees) and for `g = 0`.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, greatest_takeoff_reach_m};
/// // 30 degrees up: 100 / (10 (1 + 1/2)).
/// let up = LineOfSight::new(3f64.sqrt(), 1.0);
/// assert!((greatest_takeoff_reach_m(up, 10.0, 10.0) - 20.0 / 3.0).abs() < 1e-12);
/// ```
pub fn greatest_takeoff_reach_m(sight: LineOfSight, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    speed_m_s / gravity_m_s2 * (speed_m_s * (sight.secant() / sight.min_speed_ratio()))
}

/// The same for a landing speed: that of the line travelled backwards, at the same take-off angle.
///
/// ```text
///     R_l = v^2 / (g (1 - sin(beta)))
/// ```
///
/// ```
/// use chta::ballistics::{LineOfSight, greatest_landing_reach_m};
/// // 30 degrees up: 100 / (10 (1 - 1/2)).
/// let up = LineOfSight::new(3f64.sqrt(), 1.0);
/// assert!((greatest_landing_reach_m(up, 10.0, 10.0) - 20.0).abs() < 1e-12);
/// ```
pub fn greatest_landing_reach_m(sight: LineOfSight, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    speed_m_s / gravity_m_s2 * (speed_m_s * (sight.secant() / sight.min_speed_ratio_reversed()))
}
