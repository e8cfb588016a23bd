//! The parabola of safety: the envelope of all arcs with a given take-off speed.

/// The greatest height above the take-off that any arc of a given take-off speed reaches at a horizontal distance, m.
///
/// ```text
///     Z <= v^2 / (2 g) - g X^2 / (2 v^2)        <=>   g (Z + hypot(X, Z)) <= v^2                      (model section 2)
/// ```
///
/// # Units
/// `X` in m, `v` in m/s, `g` in m/s^2.
///
/// # Returns
/// Negative where every arc is below the take-off height. Negative infinity for `v = 0`.
///
/// # Examples
/// ```
/// use chta::ballistics::safety_ceiling_m;
/// // 4 along, 3 up needs v^2 = g (3 + 5).
/// assert!((safety_ceiling_m(4.0, 80f64.sqrt(), 10.0) - 3.0).abs() < 1e-12);
/// assert_eq!(safety_ceiling_m(0.0, 10.0, 10.0), 5.0);
/// ```
pub fn safety_ceiling_m(run_m: f64, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    let height_m = speed_m_s * speed_m_s / (2.0 * gravity_m_s2);
    if height_m > 0.0 { height_m - run_m * (run_m / (4.0 * height_m)) } else { f64::NEG_INFINITY }
}

/// The greatest horizontal distance that any arc of a given take-off speed covers while falling at most a given height, m.
///
/// ```text
///     X <= (v / g) sqrt(v^2 + 2 g h)
/// ```
///
/// Source: the parabola of safety at `Z = -h`, see [`safety_ceiling_m`].
///
/// # Units
/// `v` in m/s, `g` in m/s^2, `h` in m, not negative.
///
/// # Returns
/// 0 for `v = 0`; infinity for `g = 0`.
///
/// # Examples
/// ```
/// use chta::ballistics::safety_range_m;
/// assert_eq!(safety_range_m(0.0, 10.0, 10.0), 10.0);
/// // From a 15 m step: v^2 + 2 g h = 400.
/// assert_eq!(safety_range_m(15.0, 10.0, 10.0), 20.0);
/// ```
pub fn safety_range_m(drop_m: f64, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    speed_m_s / gravity_m_s2 * (speed_m_s * speed_m_s + 2.0 * gravity_m_s2 * drop_m).sqrt()
}
