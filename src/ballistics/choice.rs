//! Which of the feasible arcs is flown.

use super::LineOfSight;
use crate::quantity::SlopeInterval;

/// How to choose the take-off angle from its feasible set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TakeoffChoice {
    /// Least take-off speed, which is also the least landing speed (P Prop. 2).
    #[default]
    LeastSpeed,
    /// The middle of the interval of angles: the largest angular margin on both sides (Campana and Laumond 2016).
    MidRange,
    /// The flattest arc, which has the least flight time.
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

    /// The loft to fly, chosen from a feasible set that is not empty.
    ///
    /// ```text
    ///     least speed: n = sqrt(1 + b^2) clamped into the set           (P eq. 20, 22)
    ///     mid range:   theta = the mean of the set's end angles
    ///     least time:  the set's lower end
    /// ```
    ///
    /// # Returns
    /// A member of the set, positive and finite. The open end `n = 0` (the line of sight itself) is never returned.
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
            Self::LeastSpeed => sight.secant().clamp(lower, upper),
            Self::LeastTime => lower,
            Self::MidRange => bisecting_loft(sight, lower, upper),
        }
    }
}

crate::quantity::by_name!(TakeoffChoice, TakeoffChoice::ALL);

/// The loft whose take-off direction bisects the angle between those of two lofts.
///
/// The sum of the unit vectors along both directions points along the bisector. Its loft is therefore the mean of both lofts,
/// each weighted by the other's `sqrt(1 + m^2)`: no tangent is needed, and no digits are lost near the vertical.
fn bisecting_loft(sight: LineOfSight, lower: f64, upper: f64) -> f64 {
    let length = |loft: f64| libm::hypot(1.0, sight.slope() + loft);
    let first = length(lower);
    let middle = if upper.is_infinite() { lower + first } else { lower + (upper - lower) * (first / (first + length(upper))) };
    middle.clamp(lower, upper.min(f64::MAX))
}
