//! The take-off speeds that a machine can be commanded: a least speed, or fixed levels.

use crate::{
    ballistics::LineOfSight,
    quantity::{MonicQuadratic, Roots, SlopeInterval},
    world::SPEED_TOLERANCE,
};

/// The lofts of the arcs that are slower than a least take-off speed: an open interval around that of the slowest arc.
///
/// ```text
///     g X (1 + (b + n)^2) < 2 n v^2   <=>   n^2 - 2 (q - b) n + (1 + b^2) < 0,   q = v^2 / (g X)
/// ```
///
/// The quadratic of the greatest take-off speed (P eq. 15). The limit holds as `v (1 - 1e-9)`.
///
/// # Units
/// `v` in m/s, `g` in m/s^2.
///
/// # Returns
/// The two lofts at which the speed is the least one, both of which are allowed; `None` if every arc is fast enough.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, limits};
/// // Flat, q = 1.25: n^2 - 2.5 n + 1 = (n - 0.5)(n - 2)
/// let gap = limits::takeoff_speed_min(LineOfSight::new(8.0, 0.0), 10.0, 10.0).unwrap();
/// assert!((gap.lower - 0.5).abs() < 1e-8 && (gap.upper - 2.0).abs() < 1e-8);
/// assert_eq!(limits::takeoff_speed_min(LineOfSight::new(8.0, 0.0), 8.9, 10.0), None);
/// ```
#[inline]
pub fn takeoff_speed_min(sight: LineOfSight, speed_min_m_s: f64, gravity_m_s2: f64) -> Option<SlopeInterval> {
    let roots = lofts_at(sight, speed_min_m_s * (1.0 - SPEED_TOLERANCE), gravity_m_s2)?;
    (roots.smaller < roots.larger).then_some(SlopeInterval { lower: roots.smaller, upper: roots.larger })
}

/// The flatter and the steeper arc of one take-off speed, each of those that an interval of lofts contains.
///
/// A level holds within a relative 1e-9, as every speed: where the exact arc lies outside of the interval by less than that, the
/// nearest arc inside is returned. Where the level is the least speed itself, both arcs are one.
///
/// # Examples
/// ```
/// use chta::{ballistics::{LineOfSight, limits}, quantity::SlopeInterval};
/// let found = limits::takeoff_speed_level(LineOfSight::new(8.0, 0.0), 10.0, 10.0, SlopeInterval::ALL);
/// assert_eq!(found, [Some(0.5), Some(2.0)]);
/// // 10 m are the reach of 10 m/s: one arc, at 45 degrees.
/// let found = limits::takeoff_speed_level(LineOfSight::new(10.0, 0.0), 10.0, 10.0, SlopeInterval::ALL);
/// assert_eq!(found, [Some(1.0), None]);
/// ```
#[inline]
pub fn takeoff_speed_level(sight: LineOfSight, speed_m_s: f64, gravity_m_s2: f64, lofts: SlopeInterval) -> [Option<f64>; 2] {
    let at = |share: f64| lofts_at(sight, speed_m_s * share, gravity_m_s2);
    let Some(outer) = at(1.0 + SPEED_TOLERANCE) else { return [None; 2] };
    let slowest = Roots { smaller: sight.secant(), larger: sight.secant() };
    let (exact, inner) = (at(1.0).unwrap_or(slowest), at(1.0 - SPEED_TOLERANCE).unwrap_or(slowest));
    let nearest = |loft: f64, from: f64, to: f64| {
        let band = SlopeInterval { lower: from, upper: to }.intersect(lofts);
        (!band.is_empty()).then(|| loft.max(band.lower).min(band.upper)).filter(|loft| loft.is_finite())
    };
    let flat = nearest(exact.smaller, outer.smaller, inner.smaller);
    let steep = nearest(exact.larger, inner.larger, outer.larger);
    [flat, steep.filter(|steep| flat != Some(*steep))]
}

/// The lofts at which the take-off speed has a value; `None` if every arc is faster.
#[inline]
fn lofts_at(sight: LineOfSight, speed_m_s: f64, gravity_m_s2: f64) -> Option<Roots> {
    let excess = speed_m_s * speed_m_s / (gravity_m_s2 * sight.run_m()) - sight.min_speed_ratio();
    MonicQuadratic { excess, geometric_mean: sight.secant() }.roots()
}
