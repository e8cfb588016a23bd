//! The set of all arcs between two cells as four intervals, each narrowed by the others.

use crate::{
    quantity::{Interval, Rounding},
    world::Limit,
};

/// The arcs between two cells that are still possible: slopes of take-off `m`, of landing `l`, of the line of sight `b`, and
/// lofts `n`, with `m = b + n` and `l = b - n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arcs<R> {
    pub(super) takeoff: Interval<R>,
    pub(super) landing: Interval<R>,
    pub(super) sight: Interval<R>,
    pub(super) loft: Interval<R>,
}

impl<R: Rounding> Arcs<R> {
    /// All arcs over lines of sight with these slopes.
    pub(super) const fn along(sight: Interval<R>) -> Self {
        Self { takeoff: Interval::ALL, landing: Interval::ALL, sight, loft: Interval::new(0.0, f64::INFINITY) }
    }

    /// Applies one limit and narrows the other intervals.
    ///
    /// # Errors
    /// The limit, if it leaves no arc.
    pub(super) fn limit(&mut self, apply: impl FnOnce(&mut Self), limit: Limit) -> Result<(), Limit> {
        apply(self);
        self.narrow();
        let left = !(self.takeoff.is_empty() || self.landing.is_empty() || self.sight.is_empty() || self.loft.is_empty());
        // An arc needs a positive loft.
        if left && self.loft.upper > 0.0 { Ok(()) } else { Err(limit) }
    }

    /// Narrows each interval by the others: `b = (m + l) / 2`, `n = (m - l) / 2 = m - b = b - l`.
    fn narrow(&mut self) {
        self.sight = self.sight.intersect((self.takeoff + self.landing).halved());
        let by_both = (self.takeoff - self.landing).halved();
        self.loft = self.loft.intersect(by_both).intersect(self.takeoff - self.sight).intersect(self.sight - self.landing);
        self.sight = self.sight.intersect(self.takeoff - self.loft).intersect(self.landing + self.loft);
        self.takeoff = self.takeoff.intersect(self.sight + self.loft);
        self.landing = self.landing.intersect(self.sight - self.loft);
    }
}

/// The take-off slopes between which every arc is slower than a speed, over all lines of sight of a slope of at most `b` and for at least
/// this ratio `q = v^2 / (g X)`: the open interval between the roots of [`least_speed_slopes`], rounded inwards. `None` if there may be
/// none.
///
/// The interval grows with `q` and shrinks with `b`.
pub(super) fn slower_slopes<R: Rounding>(ratio: f64, sight_slope: f64) -> Option<[f64; 2]> {
    let (one, q, b) = (Interval::point(1.0), Interval::<R>::point(ratio), Interval::<R>::point(sight_slope));
    let secant = (one + b.squared()).sqrt();
    let speed_ratio = if sight_slope >= 0.0 { b + secant } else { one / (secant - b) };
    let excess = q - speed_ratio;
    // NaN fails as well.
    let real = ratio.is_finite() && sight_slope.is_finite() && excess.lower > 0.0;
    if !real {
        return None;
    }
    let root = (excess * (excess + secant + secant)).sqrt();
    let larger = q + root;
    let smaller = (one + (q + q) * b) / larger;
    (smaller.upper < larger.lower).then_some([smaller.upper, larger.lower])
}

/// The take-off slopes that a speed allows over a line of sight of slope `b`, with `q = v^2 / (g X)`:
///
/// ```text
///     m^2 - 2 q m + 1 + 2 q b <= 0   <=>   q - r <= m <= q + r,   r^2 = (q - b - w)(q - b + w),   w^2 = 1 + b^2
/// ```
///
/// The interval grows with `q` and shrinks with `b`. The smaller root follows from the product of the roots. Empty if the
/// speed is too low for any arc. For landing slopes, apply it to `-b` and negate the result.
pub(super) fn least_speed_slopes<R: Rounding>(ratio: f64, sight_slope: f64) -> Interval<R> {
    if !(ratio.is_finite() && sight_slope.is_finite()) {
        return Interval::ALL;
    }
    let (one, q, b) = (Interval::point(1.0), Interval::<R>::point(ratio), Interval::<R>::point(sight_slope));
    let secant = (one + b.squared()).sqrt();
    let speed_ratio = if sight_slope >= 0.0 { b + secant } else { one / (secant - b) };
    let excess = q - speed_ratio;
    if excess.upper < 0.0 {
        return Interval::EMPTY;
    }
    let excess = Interval::new(excess.lower.max(0.0), excess.upper);
    // q - b + w = (q - b - w) + 2 w, without the cancellation.
    let root = (excess * (excess + secant + secant)).sqrt();
    let larger = q + root;
    let smaller = (one + (q + q) * b) / larger;
    Interval::new(smaller.lower, larger.upper)
}
