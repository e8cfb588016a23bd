//! One flight: the parabola through take-off and landing.

use super::LineOfSight;
use crate::quantity::Angle;

/// The parabola from take-off to landing with a given loft `n = m - b > 0`.
///
/// ```text
///     z - z_t = m d - (n / X) d^2,   d = distance from the take-off            (Campana and Laumond eq. 5)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    sight: LineOfSight,
    loft: f64,
    gravity_m_s2: f64,
}

impl Arc {
    /// The arc over a line of sight with a loft above 0, under gravity in m/s^2.
    pub const fn new(sight: LineOfSight, loft: f64, gravity_m_s2: f64) -> Self {
        Self { sight, loft, gravity_m_s2 }
    }

    /// The line of sight it spans.
    pub const fn line_of_sight(&self) -> LineOfSight {
        self.sight
    }

    /// The loft n: the take-off slope minus the slope of the line of sight.
    pub const fn loft(&self) -> f64 {
        self.loft
    }

    /// Take-off slope m = b + n.
    pub fn takeoff_slope(&self) -> f64 {
        self.sight.slope() + self.loft
    }

    /// Landing slope `l = b - n = 2 b - m` (P eq. 10).
    ///
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// let arc = Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 1.62);
    /// assert_eq!(arc.landing_slope(), -1.0);
    /// ```
    pub fn landing_slope(&self) -> f64 {
        self.sight.slope() - self.loft
    }

    /// Take-off angle.
    pub fn takeoff_angle(&self) -> Angle {
        Angle::from_slope(self.takeoff_slope())
    }

    /// Landing angle, negative on the way down.
    pub fn landing_angle(&self) -> Angle {
        Angle::from_slope(self.landing_slope())
    }

    /// Take-off speed, m/s.
    ///
    /// ```text
    ///     v_t^2 = g X (1 + m^2) / (2 n)                                         (P eq. 9)
    /// ```
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// // 45 degrees over flat ground: X = v^2 / g, so 10 m at 10 m/s^2 takes 10 m/s.
    /// let arc = Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 10.0);
    /// assert!((arc.takeoff_speed_m_s() - 10.0).abs() < 1e-12);
    /// ```
    pub fn takeoff_speed_m_s(&self) -> f64 {
        self.speed_at_slope(self.takeoff_slope())
    }

    /// Landing speed, m/s.
    ///
    /// ```text
    ///     v_l^2 = g X (1 + (b - n)^2) / (2 n)  =  v_t^2 - 2 g Z                 (P eq. 11)
    /// ```
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// // Fired level (m = 0) off a 5 m step at g = 10: 1 s of fall, 10 m/s down; 20 m far, so 20 m/s across.
    /// let arc = Arc::new(LineOfSight::new(20.0, -5.0), 0.25, 10.0);
    /// assert!((arc.landing_speed_m_s() - 500f64.sqrt()).abs() < 1e-12);
    /// ```
    pub fn landing_speed_m_s(&self) -> f64 {
        self.speed_at_slope(self.landing_slope())
    }

    /// The speed at the point where the arc has this slope: the horizontal component `sqrt(g X / (2 n))` is constant.
    fn speed_at_slope(&self, slope: f64) -> f64 {
        self.horizontal_speed_m_s() * libm::hypot(1.0, slope)
    }

    /// The horizontal speed `sqrt(g X / (2 n))`, constant over the flight, m/s.
    pub fn horizontal_speed_m_s(&self) -> f64 {
        (self.gravity_m_s2 * self.sight.run_m() / (2.0 * self.loft)).sqrt()
    }

    /// Flight time `sqrt(2 X n / g)`, s (P eq. 37).
    ///
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// let arc = Arc::new(LineOfSight::new(20.0, -5.0), 0.25, 10.0);
    /// assert_eq!(arc.flight_time_s(), 1.0);
    /// ```
    pub fn flight_time_s(&self) -> f64 {
        (2.0 * self.sight.run_m() * self.loft / self.gravity_m_s2).sqrt()
    }

    /// The height of the flight's highest point above the take-off, m.
    ///
    /// ```text
    ///     X m^2 / (4 n) where the arc rises and then falls, 0 where it never rises (m <= 0),
    ///     Z where it still rises at the landing (b - n >= 0)
    /// ```
    ///
    /// Source: model section 2, which leaves out the third case.
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// // 45 degrees over flat ground: a quarter of the distance.
    /// assert_eq!(Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 10.0).apex_height_m(), 2.5);
    /// // Straight up a wall: the landing is the highest point.
    /// assert_eq!(Arc::new(LineOfSight::new(1.0, 9.0), 2.0, 10.0).apex_height_m(), 9.0);
    /// ```
    pub fn apex_height_m(&self) -> f64 {
        let m = self.takeoff_slope();
        if m <= 0.0 {
            0.0
        } else if self.landing_slope() >= 0.0 {
            self.sight.rise_m()
        } else {
            self.sight.run_m() * m * (m / (4.0 * self.loft))
        }
    }

    /// The length of the arc, m.
    ///
    /// ```text
    ///     L = X / (2 n) (F(m) - F(l)),   F(s) = (s sqrt(1 + s^2) + asinh s) / 2,   from the take-off slope m to the landing slope l
    /// ```
    ///
    /// Source: the integral of `sqrt(1 + s^2)` over the run, along which the slope falls evenly. A flat arc, whose two terms nearly cancel,
    /// is integrated by Simpson's rule.
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// // 45 degrees over 10 m: 5 (sqrt 2 + asinh 1); and a nearly straight line of 3 along and 4 up.
    /// let thrown = Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 9.0);
    /// assert!((thrown.length_m() - 5.0 * (2f64.sqrt() + 1f64.asinh())).abs() < 1e-12);
    /// assert!((Arc::new(LineOfSight::new(3.0, 4.0), 1e-9, 9.0).length_m() - 5.0).abs() < 1e-12);
    /// ```
    pub fn length_m(&self) -> f64 {
        /// The error of Simpson's rule falls with the fourth power of this: below 1e-14 of the length.
        const FLAT: f64 = 1e-3;
        let (from, to) = (self.takeoff_slope(), self.landing_slope());
        let secant = |slope: f64| libm::hypot(1.0, slope);
        if self.loft < FLAT {
            return self.sight.run_m() * (secant(from) + 4.0 * secant(self.sight.slope()) + secant(to)) / 6.0;
        }
        let integral = |slope: f64| 0.5 * (slope * secant(slope) + libm::asinh(slope));
        self.sight.run_m() * (integral(from) - integral(to)) / (2.0 * self.loft)
    }

    /// Height above the take-off at a horizontal distance `d` from it, m.
    ///
    /// Written as `d (b + n (X - d) / X)`, which is exact at the take-off and keeps its digits next to the landing.
    ///
    /// ```
    /// use chta::ballistics::{Arc, LineOfSight};
    /// let arc = Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 10.0);
    /// assert_eq!((arc.height_at_m(0.0), arc.height_at_m(5.0), arc.height_at_m(10.0)), (0.0, 2.5, 0.0));
    /// ```
    pub fn height_at_m(&self, distance_m: f64) -> f64 {
        let remaining = (self.sight.run_m() - distance_m) / self.sight.run_m();
        distance_m * (self.sight.slope() + self.loft * remaining)
    }
}

/// The least take-off speed with which any arc reaches over a line of sight, m/s.
///
/// ```text
///     v^2 = g X (b + sqrt(1 + b^2)) = g (Z + hypot(X, Z)),   at the loft sqrt(1 + b^2), theta = pi/4 + beta/2       (P eq. 16, 20)
/// ```
///
/// For a falling line of sight written as `g X / (sqrt(1 + b^2) - b)`, which keeps its digits.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, least_takeoff_speed_m_s};
/// assert_eq!(least_takeoff_speed_m_s(LineOfSight::new(10.0, 0.0), 10.0), 10.0);
/// // 4 along, 3 up: v^2 = 10 (3 + 5)
/// assert!((least_takeoff_speed_m_s(LineOfSight::new(4.0, 3.0), 10.0) - 80f64.sqrt()).abs() < 1e-12);
/// ```
pub fn least_takeoff_speed_m_s(sight: LineOfSight, gravity_m_s2: f64) -> f64 {
    (gravity_m_s2 * sight.run_m() * sight.min_speed_ratio()).sqrt()
}

/// The least landing speed of any arc over a line of sight, m/s: that of the same line travelled backwards (P eq. 18).
///
/// ```
/// use chta::ballistics::{LineOfSight, least_landing_speed_m_s};
/// // 4 along, 3 down: v^2 = 10 (3 + 5)
/// assert!((least_landing_speed_m_s(LineOfSight::new(4.0, -3.0), 10.0) - 80f64.sqrt()).abs() < 1e-12);
/// ```
pub fn least_landing_speed_m_s(sight: LineOfSight, gravity_m_s2: f64) -> f64 {
    (gravity_m_s2 * sight.run_m() * sight.min_speed_ratio_reversed()).sqrt()
}
