//! The clearance over the terrain between take-off and landing.

use crate::quantity::ChainPoint;

/// The least loft that clears one point between take-off and landing.
///
/// ```text
///     n >= s - t,   s = (z_p + eps - z_t) / |x_p - x_t|,   t = (z_l - z_p - eps) / |x_l - x_p|
/// ```
///
/// `s` is the slope from the take-off to the point, `t` the slope from the point to the landing; the loft must be at least
/// the difference. This is P eq. 14 (`m >= s + (d/X)(s - t)`) minus the slope of the line of sight, which is the mean of `s`
/// and `t` weighted by their horizontal distances.
///
/// # Units
/// All in m; `eps` is the clearance.
///
/// # Degenerate
/// The point has to lie strictly between take-off and landing: at the x of either the result is infinite or NaN. A loft of at
/// most 0 means that every arc clears the point.
///
/// # Examples
/// ```
/// use chta::{ballistics::limits::clearing_loft, quantity::ChainPoint};
/// let (t, l) = (ChainPoint::new(0.0, 0.0), ChainPoint::new(4.0, 0.0));
/// // A 1 m needle in the middle: z = n d (1 - d/4), so n = 1 passes just over (2, 1).
/// assert_eq!(clearing_loft(t, l, ChainPoint::new(2.0, 1.0), 0.0), 1.0);
/// assert_eq!(clearing_loft(t, l, ChainPoint::new(2.0, 1.0), 1.0), 2.0);
/// ```
#[inline]
pub fn clearing_loft(takeoff: ChainPoint, landing: ChainPoint, point: ChainPoint, clearance_m: f64) -> f64 {
    // Subtract the heights before adding the clearance: the difference of close doubles is exact.
    let seen = ((point.z_m - takeoff.z_m) + clearance_m) / (point.x_m - takeoff.x_m).abs();
    let ahead = ((landing.z_m - point.z_m) - clearance_m) / (landing.x_m - point.x_m).abs();
    seen - ahead
}
