//! The flight time limit.

use crate::{ballistics::LineOfSight, quantity::SlopeInterval};

/// The lofts at which the flight takes at most a given time.
///
/// ```text
///     sqrt(2 X n / g) <= T   <=>   n <= g T^2 / (2 X)                          (model section 2)
/// ```
///
/// # Units
/// `T` in s, `g` in m/s^2.
///
/// # Returns
/// An interval without lower bound; without positive lofts for `T = 0`.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, limits};
/// assert_eq!(limits::flight_time(LineOfSight::new(5.0, 0.0), 2.0, 10.0).upper, 4.0);
/// ```
#[inline]
pub fn flight_time(sight: LineOfSight, time_max_s: f64, gravity_m_s2: f64) -> SlopeInterval {
    let upper = gravity_m_s2 * time_max_s * (time_max_s / (2.0 * sight.run_m()));
    SlopeInterval { lower: f64::NEG_INFINITY, upper }
}
