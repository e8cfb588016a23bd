//! When a flight passes a plane.

/// The times at which a body under constant gravity passes a plane, s; NaN or infinite for those that there are not.
///
/// ```text
///     s + c t + p t^2 = 0        s: height over the plane at t = 0, c: speed away from it, p: half the part of gravity away from it
/// ```
///
/// The root of smaller size is the quotient of the product of both by the other one, so neither loses digits.
///
/// # Examples
/// ```
/// use chta::ballistics::plane_times_s;
/// // Thrown up at 4 m/s under 2 m/s^2, 3 m below a ceiling: it passes it after 1 s, and again after 3 s.
/// let mut times = plane_times_s(-3.0, 4.0, -1.0);
/// times.sort_by(f64::total_cmp);
/// assert_eq!(times, [1.0, 3.0]);
/// // Towards a wall, gravity runs along it.
/// assert!(plane_times_s(-3.0, 1.5, 0.0).contains(&2.0));
/// ```
pub fn plane_times_s(over_m: f64, away_m_s: f64, half_pull_m_s2: f64) -> [f64; 2] {
    let discriminant = away_m_s * away_m_s - 4.0 * half_pull_m_s2 * over_m;
    let sum = -0.5 * (away_m_s + discriminant.sqrt().copysign(away_m_s));
    [sum / half_pull_m_s2, over_m / sum]
}
