//! The straight line from take-off to landing.

use crate::quantity::Angle;

/// The line of sight from take-off to landing, in the direction of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOfSight {
    run_m: f64,
    slope: f64,
    /// `sqrt(1 + b^2) = sec(beta)`: length over horizontal distance, and the loft of least speed.
    secant: f64,
}

impl LineOfSight {
    /// From run `X > 0` and rise `Z`, both in m. The caller excludes `X = 0`, for which the slope is infinite or NaN.
    ///
    /// ```
    /// use chta::ballistics::LineOfSight;
    /// let sight = LineOfSight::new(4.0, 3.0);
    /// assert_eq!((sight.slope(), sight.length_m()), (0.75, 5.0));
    /// ```
    #[inline]
    pub fn new(run_m: f64, rise_m: f64) -> Self {
        Self::along(run_m, rise_m / run_m)
    }

    /// From run and slope: for two points on one segment, whose stored slope has more correct digits than the difference of
    /// the two heights.
    #[inline]
    pub fn along(run_m: f64, slope: f64) -> Self {
        Self { run_m, slope, secant: (1.0 + slope * slope).sqrt() }
    }

    /// Horizontal distance X, m.
    #[inline]
    pub const fn run_m(&self) -> f64 {
        self.run_m
    }

    /// Height difference Z, m.
    #[inline]
    pub fn rise_m(&self) -> f64 {
        self.slope * self.run_m
    }

    /// The slope b = Z / X.
    #[inline]
    pub const fn slope(&self) -> f64 {
        self.slope
    }

    /// `sqrt(1 + b^2)`, the secant of the angle beta above the horizontal.
    #[inline]
    pub const fn secant(&self) -> f64 {
        self.secant
    }

    /// `b + sqrt(1 + b^2)`: the least `v^2 / (g X)` at take-off, and the take-off slope that attains it (P eq. 16, 20).
    ///
    /// For a falling line of sight computed as `1 / (sqrt(1 + b^2) - b)`, which keeps its digits.
    ///
    /// ```
    /// use chta::ballistics::LineOfSight;
    /// assert_eq!(LineOfSight::new(4.0, 3.0).min_speed_ratio(), 2.0);
    /// assert_eq!(LineOfSight::new(4.0, -3.0).min_speed_ratio(), 0.5);
    /// ```
    #[inline]
    pub fn min_speed_ratio(&self) -> f64 {
        min_speed_ratio(self.slope, self.secant)
    }

    /// `sqrt(1 + b^2) - b`: the least `v^2 / (g X)` at landing, equal to that of a take-off along the reversed line (P eq.
    /// 18).
    #[inline]
    pub fn min_speed_ratio_reversed(&self) -> f64 {
        min_speed_ratio(-self.slope, self.secant)
    }

    /// The distance R = X sqrt(1 + b^2), m (P eq. 6).
    pub fn length_m(&self) -> f64 {
        self.run_m * self.secant
    }

    /// The angle beta above the horizontal (P eq. 7).
    pub fn angle(&self) -> Angle {
        Angle::from_slope(self.slope)
    }
}

/// `b + w` for `w = sqrt(1 + b^2)`, without cancellation.
#[inline]
fn min_speed_ratio(slope: f64, secant: f64) -> f64 {
    if slope >= 0.0 { slope + secant } else { 1.0 / (secant - slope) }
}
