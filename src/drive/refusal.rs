//! Why a rover does not drive a straight leg.

use std::{fmt, ops::AddAssign};

use crate::{quantity::Angle, world::LayerName};

/// What refuses a leg, in the order of testing: a leg counts under the first that it does not keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DriveLimit {
    /// Ground under the whole leg, and where step and roughness are judged under the wheels beyond its ends too.
    Ground,
    /// Keep-out zones.
    KeepOut,
    /// Layers of the map that restrict contacts.
    Layer,
    /// The steepest slope climbed.
    SlopeUp,
    /// The steepest slope descended.
    SlopeDown,
    /// The steepest slope crossed.
    CrossSlope,
    /// The greatest difference of height between the axles.
    Step,
    /// The greatest deviation of the ground from the plane fitted over the wheelbase.
    Roughness,
}

impl DriveLimit {
    /// All of them, in the order of testing.
    pub const ALL: [Self; 8] =
        [Self::Ground, Self::KeepOut, Self::Layer, Self::SlopeUp, Self::SlopeDown, Self::CrossSlope, Self::Step, Self::Roughness];

    /// The name in messages and results.
    ///
    /// ```
    /// use chta::drive::DriveLimit;
    /// assert_eq!(DriveLimit::CrossSlope.name(), "cross-slope");
    /// ```
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::KeepOut => "keep-out",
            Self::Layer => "layer",
            Self::SlopeUp => "slope-up",
            Self::SlopeDown => "slope-down",
            Self::CrossSlope => "cross-slope",
            Self::Step => "step",
            Self::Roughness => "roughness",
        }
    }

    const fn index(self) -> usize {
        self as usize
    }
}

crate::quantity::by_name!(DriveLimit, DriveLimit::ALL);

/// Why a leg is refused. Places are distances along the leg from its beginning, m; of slopes, the middle of the steepest piece.
///
/// A leg is tested in the order of [`DriveLimit`], and the first limit that it exceeds refuses it, with the greatest value on the whole
/// leg. Ground that step or roughness need beyond the ends of the leg is asked for where these are tested, after the slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DriveRefusal {
    /// A part of the leg, or of the ground under wheels that stand at its ends, has no elevation or lies off the map.
    NoGround {
        /// Where; below 0 or beyond the length for wheels before or beyond the leg.
        at_m: f64,
    },
    /// A part of the leg lies in a keep-out zone, or where a mask of zones says nothing.
    KeepOut {
        /// Where the first such part begins.
        at_m: f64,
    },
    /// A layer of the map does not hold all along the leg.
    Layer {
        /// The layer.
        layer: LayerName,
    },
    /// It climbs too steeply.
    SlopeUp {
        /// The tangent of the steepest climb.
        slope: f64,
        /// The tangent of the steepest allowed.
        max: f64,
        /// Where.
        at_m: f64,
    },
    /// It descends too steeply.
    SlopeDown {
        /// The tangent of the steepest descent, positive.
        slope: f64,
        /// The tangent of the steepest allowed.
        max: f64,
        /// Where.
        at_m: f64,
    },
    /// The ground is too steep across the way.
    CrossSlope {
        /// The tangent of the steepest slope across.
        slope: f64,
        /// The tangent of the steepest allowed.
        max: f64,
        /// Where.
        at_m: f64,
    },
    /// The heights under the two axles differ too much.
    Step {
        /// The greatest difference, m.
        step_m: f64,
        /// The greatest allowed, m.
        max_m: f64,
        /// The middle between the axles.
        at_m: f64,
    },
    /// The ground at an end of the leg deviates too much from a plane.
    Roughness {
        /// The greatest distance from the plane fitted over a disc of the wheelbase, m.
        residual_m: f64,
        /// The greatest allowed, m.
        max_m: f64,
        /// Which end.
        at_m: f64,
    },
}

impl DriveRefusal {
    /// The limit that refuses.
    pub const fn limit(&self) -> DriveLimit {
        match self {
            Self::NoGround { .. } => DriveLimit::Ground,
            Self::KeepOut { .. } => DriveLimit::KeepOut,
            Self::Layer { .. } => DriveLimit::Layer,
            Self::SlopeUp { .. } => DriveLimit::SlopeUp,
            Self::SlopeDown { .. } => DriveLimit::SlopeDown,
            Self::CrossSlope { .. } => DriveLimit::CrossSlope,
            Self::Step { .. } => DriveLimit::Step,
            Self::Roughness { .. } => DriveLimit::Roughness,
        }
    }

    /// The name of the limit that refuses.
    pub const fn name(&self) -> &'static str {
        self.limit().name()
    }
}

impl fmt::Display for DriveRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let degrees = |slope: f64| Angle::from_slope(slope).degrees();
        match *self {
            Self::NoGround { at_m } => write!(f, "the ground {at_m:.3} m along the leg has no elevation"),
            Self::KeepOut { at_m } => write!(f, "the leg enters a keep-out zone {at_m:.3} m along"),
            Self::Layer { layer } => write!(f, "the layer {layer} does not hold all along the leg"),
            Self::SlopeUp { slope, max, at_m } => {
                write!(f, "the leg climbs {:.3} deg {at_m:.3} m along, more than {:.3} deg", degrees(slope), degrees(max))
            }
            Self::SlopeDown { slope, max, at_m } => {
                write!(f, "the leg descends {:.3} deg {at_m:.3} m along, more than {:.3} deg", degrees(slope), degrees(max))
            }
            Self::CrossSlope { slope, max, at_m } => {
                let (found, most) = (degrees(slope), degrees(max));
                write!(f, "the ground slopes {found:.3} deg across the leg {at_m:.3} m along, more than {most:.3} deg")
            }
            Self::Step { step_m, max_m, at_m } => {
                write!(f, "the heights under the axles differ by {step_m:.3} m {at_m:.3} m along the leg, more than {max_m} m")
            }
            Self::Roughness { residual_m, max_m, at_m } => write!(
                f,
                "the ground {at_m:.3} m along the leg lies up to {residual_m:.3} m off the plane fitted over the wheelbase, more than {max_m} m"
            ),
        }
    }
}

impl std::error::Error for DriveRefusal {}

/// How many legs each limit refused; a leg counts once, under the first limit that it exceeds in the order of [`DriveLimit`].
///
/// ```
/// use chta::drive::{DriveLimit, DriveRefusalCounts};
/// let mut counts = DriveRefusalCounts::default();
/// counts.count(DriveLimit::Step);
/// counts += counts;
/// assert_eq!((counts.of(DriveLimit::Step), counts.ranked()), (2, vec![(DriveLimit::Step, 2)]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct DriveRefusalCounts {
    counts: [u64; DriveLimit::ALL.len()],
}

impl DriveRefusalCounts {
    /// Counts one refusal.
    pub const fn count(&mut self, limit: DriveLimit) {
        self.add(limit, 1);
    }

    /// Counts refusals of one limit.
    pub(super) const fn add(&mut self, limit: DriveLimit, legs: u64) {
        self.counts[limit.index()] += legs;
    }

    /// How many legs a limit refused.
    pub const fn of(&self, limit: DriveLimit) -> u64 {
        self.counts[limit.index()]
    }

    /// The limits that refused any, with their counts, in descending order; equal counts in the order of testing.
    pub fn ranked(&self) -> Vec<(DriveLimit, u64)> {
        let mut ranked: Vec<_> = DriveLimit::ALL.into_iter().map(|limit| (limit, self.of(limit))).filter(|(_, n)| *n > 0).collect();
        ranked.sort_by_key(|(limit, n)| (std::cmp::Reverse(*n), *limit));
        ranked
    }

    /// The sum of all counts.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }
}

impl AddAssign for DriveRefusalCounts {
    fn add_assign(&mut self, other: Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(other.counts) {
            *mine += theirs;
        }
    }
}
