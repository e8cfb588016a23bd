//! Which of the feasible arcs is flown.

use super::LineOfSight;
use crate::quantity::{Angle, SlopeInterval};

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
    /// The angle at which the most draws of the errors survive. What that is depends on the ground and the errors, which the search and
    /// the policies of trials know; where there are no errors to fly, the middle of the interval.
    MostReliable,
}

impl TakeoffChoice {
    /// All choices.
    pub const ALL: [Self; 4] = [Self::LeastSpeed, Self::MidRange, Self::LeastTime, Self::MostReliable];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LeastSpeed => "least-speed",
            Self::MidRange => "mid-range",
            Self::LeastTime => "least-time",
            Self::MostReliable => "most-reliable",
        }
    }

    /// The loft to fly, chosen from a feasible set that is not empty.
    ///
    /// ```text
    ///     least speed: n = sqrt(1 + b^2) clamped into the set           (P eq. 20, 22)
    ///     mid range, most reliable:   theta = the mean of the set's end angles
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
            Self::MidRange | Self::MostReliable => bisecting_loft(sight, lower, upper),
        }
    }

    /// The window to fly of several feasible ones, ascending and disjoint, by its number, and the loft in it; `None` of none.
    ///
    /// ```text
    ///     least speed: the arc of least speed over all windows;   least time: the flattest;   mid range: in the widest window, by angle
    /// ```
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::{LineOfSight, TakeoffChoice}, quantity::SlopeInterval};
    /// // 45 degrees lies between the windows, nearer to the second by speed: (1 + m^2) / m is 2.5 at 0.5 and 2.05 at 1.25.
    /// let windows = [[0.2, 0.5], [1.25, 1.5]].map(|[lower, upper]| SlopeInterval { lower, upper });
    /// let of = |choice: TakeoffChoice| choice.among(LineOfSight::new(10.0, 0.0), windows);
    /// assert_eq!(of(TakeoffChoice::LeastSpeed), Some((1, 1.25)));
    /// assert_eq!(of(TakeoffChoice::LeastTime), Some((0, 0.2)));
    /// assert_eq!(of(TakeoffChoice::MidRange).map(|(window, _)| window), Some(0));
    /// ```
    pub fn among(self, sight: LineOfSight, windows: impl IntoIterator<Item = SlopeInterval>) -> Option<(usize, f64)> {
        let mut windows = windows.into_iter().enumerate();
        let (mut at, mut best) = windows.next()?;
        if self != Self::LeastTime {
            let slope = |loft: f64| sight.slope() + loft;
            // What is to be least. The square of the speed is (1 + m^2) / n times a constant.
            let worth = |set: SlopeInterval| match self {
                Self::LeastSpeed | Self::LeastTime => {
                    let loft = self.loft(sight, set);
                    (1.0 + slope(loft) * slope(loft)) / loft
                }
                Self::MidRange | Self::MostReliable => {
                    Angle::from_slope(slope(set.lower)).radians() - Angle::from_slope(slope(set.upper)).radians()
                }
            };
            // One window, the usual case, is compared with nothing.
            let mut least = None;
            for (number, set) in windows {
                let known = *least.get_or_insert_with(|| worth(best));
                let this = worth(set);
                if this < known {
                    (at, best, least) = (number, set, Some(this));
                }
            }
        }
        Some((at, self.loft(sight, best)))
    }
}

crate::quantity::by_name!(TakeoffChoice, TakeoffChoice::ALL);

/// The loft whose angle lies at a share of the way between the angles of a set's ends: 0 at the lower, 1/2 in the middle, 1 at the upper.
///
/// # Returns
/// A member of the set, positive, for shares from 0 to 1.
///
/// # Examples
/// ```
/// use chta::{ballistics::{LineOfSight, loft_at_share}, quantity::{Angle, SlopeInterval}};
/// let slope = |degrees| Angle::from_degrees(degrees).slope();
/// let set = SlopeInterval { lower: slope(30.0), upper: slope(60.0) };
/// assert!((loft_at_share(LineOfSight::new(10.0, 0.0), set, 0.1) - slope(33.0)).abs() < 1e-12);
/// ```
pub fn loft_at_share(sight: LineOfSight, set: SlopeInterval, share: f64) -> f64 {
    let lower = set.lower.max(f64::MIN_POSITIVE);
    let upper = set.upper.max(lower);
    let [low, high] = [lower, upper].map(|loft| Angle::from_slope(sight.slope() + loft).radians());
    (Angle::from_radians(low + share * (high - low)).slope() - sight.slope()).clamp(lower, upper)
}

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
