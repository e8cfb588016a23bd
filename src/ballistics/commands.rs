//! The take-off speeds that a machine can be commanded, and the windows that they leave of the arcs that all other limits allow.

use super::{LineOfSight, TakeoffChoice, limits};
use crate::{
    quantity::{Angle, SlopeInterval},
    world::{HopperLimits, Limit, SpeedLevels},
};

/// The take-off speeds that a machine can be commanded.
///
/// All other limits of a hop leave one interval of the loft. Of this the machine's own speeds leave windows:
///
/// ```text
///     any speed       [-----------------------------]
///     a least speed   [--------)            (-------]      slower arcs lie around the slowest one, n = sqrt(1 + b^2)
///     levels             |  |                 |   |        at most a flat and a steep arc of each level
/// ```
///
/// They limit commands, not flights: an arc that errors make slower than the least speed does no harm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TakeoffSpeeds {
    /// Any.
    Any,
    /// At least this, m/s.
    AtLeast(f64),
    /// Only these.
    Levels(SpeedLevels),
}

/// One interval of lofts, and the ends of it that the machine's take-off speeds set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TakeoffWindow {
    /// The lofts; a single one for a level.
    pub lofts: SlopeInterval,
    /// The limit that sets the lower end, if it is one of the machine's take-off speeds.
    pub lower: Option<Limit>,
    /// The same of the upper end.
    pub upper: Option<Limit>,
}

impl TakeoffWindow {
    /// A window without ends of the machine's take-off speeds.
    const fn whole(lofts: SlopeInterval) -> Self {
        Self { lofts, lower: None, upper: None }
    }
}

impl TakeoffSpeeds {
    /// Those of a hopper. Beside levels a least speed has no effect: no level is below it.
    pub fn of(limits: &HopperLimits) -> Self {
        match (limits.takeoff_speed_levels, limits.takeoff_speed_min_m_s) {
            (Some(levels), _) => Self::Levels(levels),
            (None, Some(least_m_s)) => Self::AtLeast(least_m_s),
            (None, None) => Self::Any,
        }
    }

    /// The limit that these speeds are, if they are one.
    pub const fn limit(&self) -> Option<Limit> {
        match self {
            Self::Any => None,
            Self::AtLeast(_) => Some(Limit::TakeoffSpeedMin),
            Self::Levels(_) => Some(Limit::TakeoffSpeedLevels),
        }
    }

    /// Whether every speed can be commanded.
    #[inline]
    pub const fn are_any(&self) -> bool {
        matches!(self, Self::Any)
    }

    /// The windows that these speeds leave of an interval of lofts, ascending and disjoint; none without positive lofts. It
    /// allocates nothing.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::{LineOfSight, TakeoffSpeeds}, quantity::SlopeInterval, world::Limit};
    /// // Flat, 8 m at 10 m/s^2: 10 m/s at the lofts 0.5 and 2.
    /// let (sight, lofts) = (LineOfSight::new(8.0, 0.0), SlopeInterval { lower: 0.25, upper: 4.0 });
    /// let found: Vec<_> = TakeoffSpeeds::AtLeast(10.0).windows(sight, lofts, 10.0).collect();
    /// assert_eq!((found.len(), found[0].lofts.lower, found[1].lofts.upper), (2, 0.25, 4.0));
    /// assert!((found[0].lofts.upper - 0.5).abs() < 1e-8 && (found[1].lofts.lower - 2.0).abs() < 1e-8);
    /// assert_eq!((found[0].lower, found[0].upper), (None, Some(Limit::TakeoffSpeedMin)));
    /// ```
    pub fn windows(&self, sight: LineOfSight, lofts: SlopeInterval, gravity_m_s2: f64) -> impl Iterator<Item = TakeoffWindow> + '_ {
        let parts = match self {
            Self::Any => 1,
            Self::AtLeast(_) => 2,
            Self::Levels(levels) => 2 * levels.as_slice().len(),
        };
        let usable = |window: &TakeoffWindow| !window.lofts.is_empty() && window.lofts.upper > 0.0;
        (0..parts).filter_map(move |part| self.window(part, sight, lofts, gravity_m_s2)).filter(usable)
    }

    /// One of the possible windows, in ascending order.
    fn window(&self, part: usize, sight: LineOfSight, lofts: SlopeInterval, gravity_m_s2: f64) -> Option<TakeoffWindow> {
        match self {
            Self::Any => Some(TakeoffWindow::whole(lofts)),
            Self::AtLeast(least_m_s) => {
                let Some(gap) = limits::takeoff_speed_min(sight, *least_m_s, gravity_m_s2) else {
                    return (part == 0).then_some(TakeoffWindow::whole(lofts));
                };
                let mut window = TakeoffWindow::whole(lofts);
                if part == 0 && gap.lower < lofts.upper {
                    (window.lofts.upper, window.upper) = (gap.lower, self.limit());
                } else if part == 1 && gap.upper > lofts.lower {
                    (window.lofts.lower, window.lower) = (gap.upper, self.limit());
                }
                Some(window)
            }
            // The flat arc is flatter for a higher level, the steep one steeper.
            Self::Levels(levels) => {
                let (levels, count) = (levels.as_slice(), levels.as_slice().len());
                let (level, steep) = if part < count { (count - 1 - part, 0) } else { (part - count, 1) };
                let loft = limits::takeoff_speed_level(sight, levels[level], gravity_m_s2, lofts)[steep]?;
                let limit = self.limit();
                Some(TakeoffWindow { lofts: SlopeInterval { lower: loft, upper: loft }, lower: limit, upper: limit })
            }
        }
    }

    /// Whether an interval of lofts contains one that these speeds allow.
    #[inline]
    pub fn allow(&self, sight: LineOfSight, lofts: SlopeInterval, gravity_m_s2: f64) -> bool {
        self.are_any() || self.windows(sight, lofts, gravity_m_s2).next().is_some()
    }

    /// The loft to fly of an interval that all other limits allow; `None` if these speeds leave none of it.
    ///
    /// ```text
    ///     least speed: the slowest allowed arc; of two equally slow ones the flatter, which flies shorter
    ///     mid range:   the middle of the widest window; of single arcs the one nearest to the middle of the whole interval
    ///     least time:  the flattest allowed arc
    /// ```
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::{LineOfSight, TakeoffChoice, TakeoffSpeeds}, quantity::SlopeInterval, world::SpeedLevels};
    /// let (sight, lofts) = (LineOfSight::new(8.0, 0.0), SlopeInterval { lower: 0.25, upper: 4.0 });
    /// let levels = TakeoffSpeeds::Levels(SpeedLevels::new(&[10.0, 11.0]).unwrap());
    /// assert_eq!(levels.loft(TakeoffChoice::LeastSpeed, sight, lofts, 10.0), Some(0.5));
    /// ```
    #[inline]
    pub fn loft(&self, choice: TakeoffChoice, sight: LineOfSight, lofts: SlopeInterval, gravity_m_s2: f64) -> Option<f64> {
        if self.are_any() {
            return Some(choice.loft(sight, lofts));
        }
        let windows = self.windows(sight, lofts, gravity_m_s2).map(|window| window.lofts);
        let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).radians();
        match choice {
            TakeoffChoice::LeastTime => windows.map(|window| choice.loft(sight, window)).next(),
            TakeoffChoice::LeastSpeed => {
                // v^2 is (1 + m^2) / n times a constant. Equal speeds differ by rounding only.
                let speed_squared = |loft: f64| (1.0 + (sight.slope() + loft) * (sight.slope() + loft)) / loft;
                let slowest = windows.map(|window| choice.loft(sight, window));
                first_least(slowest, |loft| speed_squared(*loft))
            }
            TakeoffChoice::MidRange | TakeoffChoice::MostReliable => match self {
                Self::Any | Self::AtLeast(_) => {
                    let narrowness = |window: &SlopeInterval| angle(window.lower) - angle(window.upper) + std::f64::consts::PI;
                    first_least(windows, narrowness).map(|window| choice.loft(sight, window))
                }
                Self::Levels(_) => {
                    let middle = angle(choice.loft(sight, lofts));
                    first_least(windows.map(|window| window.lower), |loft| (angle(*loft) - middle).abs())
                }
            },
        }
    }
}

/// The first item with the least value; values of later ones count as equal within a relative 1e-9.
fn first_least<T>(items: impl Iterator<Item = T>, value: impl Fn(&T) -> f64) -> Option<T> {
    let mut best: Option<(T, f64)> = None;
    for item in items {
        let this = value(&item);
        if best.as_ref().is_none_or(|(_, least)| this < least * (1.0 - 1e-9)) {
            best = Some((item, this));
        }
    }
    best.map(|(item, _)| item)
}
