//! Which of the feasible arcs to fly.

use super::LineOfSight;
use crate::quantity::{Angle, SlopeInterval};

/// How to choose the take-off angle from its feasible set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TakeoffChoice {
    /// Least take-off speed, and with it least landing speed (P Prop. 2).
    #[default]
    LeastSpeed,
    /// The middle of the angle interval: furthest from all limits (Campana and Laumond 2016).
    MidRange,
    /// The flattest arc: least flight time.
    LeastTime,
}

impl TakeoffChoice {
    /// All choices.
    pub const ALL: [Self; 3] = [Self::LeastSpeed, Self::MidRange, Self::LeastTime];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LeastSpeed => "least-speed",
            Self::MidRange => "mid-range",
            Self::LeastTime => "least-time",
        }
    }

    /// The loft to fly, from a feasible set that is not empty.
    ///
    /// ```text
    ///     least speed: n = sqrt(1 + b^2) clamped into the set           (P eq. 20, 22)
    ///     mid range:   theta = the mean of the set's end angles
    ///     least time:  the set's lower end
    /// ```
    ///
    /// # Returns
    /// A loft of the set, positive and finite. The line of sight's own open end is never chosen.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::{LineOfSight, TakeoffChoice}, quantity::SlopeInterval};
    /// let flat = LineOfSight::new(10.0, 0.0);
    /// let set = SlopeInterval { lower: 0.5, upper: 2.0 };
    /// assert_eq!(TakeoffChoice::LeastSpeed.loft(flat, set), 1.0);
    /// assert_eq!(TakeoffChoice::LeastTime.loft(flat, set), 0.5);
    /// // The two ends are complementary angles, so their middle is 45 degrees.
    /// assert!((TakeoffChoice::MidRange.loft(flat, set) - 1.0).abs() < 1e-12);
    /// ```
    pub fn loft(self, sight: LineOfSight, set: SlopeInterval) -> f64 {
        let lower = set.lower.max(f64::MIN_POSITIVE);
        let upper = set.upper.max(lower);
        match self {
            Self::LeastSpeed => sight.stretch().clamp(lower, upper),
            Self::LeastTime => lower,
            Self::MidRange => {
                let end = |loft: f64| Angle::from_slope(sight.slope() + loft).radians();
                let middle = Angle::from_radians(0.5 * (end(lower) + end(upper)));
                (middle.slope() - sight.slope()).clamp(lower, upper.min(f64::MAX))
            }
        }
    }
}
