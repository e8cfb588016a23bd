//! The clearance over the terrain between take-off and landing.
//!
//! ```text
//!                 eps(d) = min(eps, k d, k e)                     the height kept over the ground, by default
//!               ______________________________ eps
//!             /                                \                  d, e  distances from take-off and landing
//!           /  k                            k    \                w = eps / k, the ramp; X / 2 if the hop is shorter than 2 w
//!      ___/________________________________________\___  ground
//!        t    |                                |    l
//!        |-w->|                                |<-w-|
//! ```
//!
//! Over the line of sight the arc is `n d e / X` high, which is concave; the ground plus `eps(d)` is piecewise linear. So an arc
//! keeps its clearance everywhere if it does at every vertex between and at the two kinks of the taper. Under the paper's rule
//! the clearance is `eps` at every vertex, and there are no kinks.

use crate::{
    quantity::ChainPoint,
    world::{ClearanceRule, HopperLimits},
};

/// The height to keep over the ground, by the distances from take-off and landing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearanceProfile {
    height_m: f64,
    /// Infinite under the rule of vertices, for which it limits nothing.
    taper: f64,
    /// `w = eps / k`; 0 if there is no clearance or no taper.
    ramp_m: f64,
}

impl ClearanceProfile {
    /// No clearance: the flight must only not run below the ground.
    pub const NONE: Self = Self { height_m: 0.0, taper: f64::INFINITY, ramp_m: 0.0 };

    /// A height, m, kept by a rule.
    pub fn new(height_m: f64, rule: ClearanceRule) -> Self {
        let taper = rule.taper().unwrap_or(f64::INFINITY);
        Self { height_m, taper, ramp_m: height_m / taper }
    }

    /// The clearance of a hopper.
    pub fn of(limits: &HopperLimits) -> Self {
        Self::new(limits.clearance_m, limits.clearance_rule)
    }

    /// The full height, m.
    #[inline]
    pub const fn height_m(&self) -> f64 {
        self.height_m
    }

    /// The slope at which the height grows from either contact; infinite under the rule of vertices.
    #[inline]
    pub const fn taper(&self) -> f64 {
        self.taper
    }

    /// The distance from either contact over which the height grows, m; 0 without clearance or taper.
    #[inline]
    pub const fn ramp_m(&self) -> f64 {
        self.ramp_m
    }

    /// Whether the height grows from the contacts, so that the two kinks of the taper limit a hop beside the vertices.
    #[inline]
    pub fn has_kinks(&self) -> bool {
        self.ramp_m > 0.0
    }

    /// The height to keep at distances `d` and `e` above 0 from take-off and landing, m: `min(eps, k d, k e)`.
    ///
    /// ```
    /// use chta::{ballistics::limits::ClearanceProfile, world::ClearanceRule};
    /// let half = ClearanceProfile::new(2.0, ClearanceRule::Tapered(0.5));
    /// assert_eq!([half.at_m(1.0, 9.0), half.at_m(5.0, 5.0), half.at_m(8.0, 2.0)], [0.5, 2.0, 1.0]);
    /// let paper = ClearanceProfile::new(2.0, ClearanceRule::Vertex);
    /// assert_eq!([paper.at_m(1.0, 9.0), paper.at_m(5.0, 5.0)], [2.0, 2.0]);
    /// ```
    #[inline]
    pub fn at_m(&self, d_m: f64, e_m: f64) -> f64 {
        let (near_m, other_m) = (self.near_m(d_m), self.taper * e_m);
        if other_m < near_m { other_m } else { near_m }
    }

    /// The height to keep at a distance above 0 from one contact and far from the other, m: `min(eps, k d)`.
    #[inline]
    pub fn near_m(&self, d_m: f64) -> f64 {
        // A comparison: one instruction, where `min` also looks for NaN.
        let grown_m = self.taper * d_m;
        if grown_m < self.height_m { grown_m } else { self.height_m }
    }

    /// How far from its two contacts the kinks of a hop of this length are, m: `min(w, X / 2)`.
    #[inline]
    pub fn kink_m(&self, run_m: f64) -> f64 {
        if 0.5 * run_m < self.ramp_m { 0.5 * run_m } else { self.ramp_m }
    }

    /// The least loft that keeps the clearance at one kink.
    ///
    /// ```text
    ///     n >= (h + eps(w)) X / (w (X - w)) = (h / w + k) X / (X - w)
    /// ```
    ///
    /// for ground at a height `h` over the line of sight at the kink. `over` is `h / w`: the slope of the ground seen from the
    /// contact, away from it, minus that of the line of sight seen in the same way.
    ///
    /// ```
    /// use chta::{ballistics::limits::ClearanceProfile, world::ClearanceRule};
    /// // 1 m of clearance on flat ground: 2 k = 1 up to 2 eps / k = 4 m, and k = 0.5 for endless hops.
    /// let clearance = ClearanceProfile::new(1.0, ClearanceRule::TAPERED);
    /// assert_eq!([1.0, 4.0, 8.0].map(|run_m| clearance.kink_loft(0.0, run_m)), [1.0, 1.0, 0.5 / 0.75]);
    /// ```
    #[inline]
    pub fn kink_loft(&self, over: f64, run_m: f64) -> f64 {
        (over + self.taper) * (run_m / (run_m - self.kink_m(run_m)))
    }
}

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
/// All in m; `eps` is the [`ClearanceProfile`] at the point.
///
/// # Degenerate
/// The point has to lie strictly between take-off and landing: at the x of either the result is infinite or NaN. A loft of at
/// most 0 means that every arc clears the point.
///
/// # Examples
/// ```
/// use chta::{ballistics::limits::{ClearanceProfile, clearing_loft}, quantity::ChainPoint, world::ClearanceRule};
/// let (t, l) = (ChainPoint::new(0.0, 0.0), ChainPoint::new(4.0, 0.0));
/// // A 1 m needle in the middle: z = n d (1 - d/4), so n = 1 passes just over (2, 1).
/// assert_eq!(clearing_loft(t, l, ChainPoint::new(2.0, 1.0), ClearanceProfile::NONE), 1.0);
/// assert_eq!(clearing_loft(t, l, ChainPoint::new(2.0, 1.0), ClearanceProfile::new(1.0, ClearanceRule::Vertex)), 2.0);
/// ```
#[inline]
pub fn clearing_loft(takeoff: ChainPoint, landing: ChainPoint, point: ChainPoint, clearance: ClearanceProfile) -> f64 {
    let (d_m, e_m) = ((point.x_m - takeoff.x_m).abs(), (landing.x_m - point.x_m).abs());
    let clearance_m = clearance.at_m(d_m, e_m);
    // Subtract the heights before adding the clearance: the difference of close doubles is exact.
    let seen = ((point.z_m - takeoff.z_m) + clearance_m) / d_m;
    let ahead = ((landing.z_m - point.z_m) - clearance_m) / e_m;
    seen - ahead
}
