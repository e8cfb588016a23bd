//! Intervals of slopes: the form of every limit of a hop.

use super::{Angle, AngleInterval};

/// A closed interval of slopes `tan(theta)`, ends possibly infinite; empty where `lower > upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeInterval {
    /// The lower end.
    pub lower: f64,
    /// The upper end.
    pub upper: f64,
}

impl SlopeInterval {
    /// All directions.
    pub const ALL: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    /// No direction.
    pub const EMPTY: Self = Self { lower: f64::INFINITY, upper: f64::NEG_INFINITY };

    /// The slopes of the directions forwards between two sides, each (ahead, up): from `lower` anticlockwise to `upper`, less than half
    /// a turn. Where straight up lies between them the upper end is infinite, where straight down does the lower one.
    ///
    /// ```
    /// use chta::quantity::SlopeInterval;
    /// assert_eq!(SlopeInterval::between_sides([2.0, 1.0], [2.0, 3.0]), SlopeInterval { lower: 0.5, upper: 1.5 });
    /// assert_eq!(SlopeInterval::between_sides([2.0, 1.0], [-1.0, 3.0]), SlopeInterval { lower: 0.5, upper: f64::INFINITY });
    /// assert!(SlopeInterval::between_sides([-1.0, 3.0], [-2.0, 1.0]).is_empty());
    /// ```
    #[inline]
    pub fn between_sides(lower: [f64; 2], upper: [f64; 2]) -> Self {
        match (lower[0] > 0.0, upper[0] > 0.0) {
            (true, true) => Self { lower: lower[1] / lower[0], upper: upper[1] / upper[0] },
            (true, false) => Self { lower: lower[1] / lower[0], upper: f64::INFINITY },
            (false, true) => Self { lower: f64::NEG_INFINITY, upper: upper[1] / upper[0] },
            (false, false) => Self::EMPTY,
        }
    }

    /// Whether the interval is empty. An interval with a NaN end counts as empty.
    pub fn is_empty(self) -> bool {
        let nonempty = self.lower <= self.upper;
        !nonempty
    }

    /// Whether `slope` is inside, ends included.
    pub fn contains(self, slope: f64) -> bool {
        self.lower <= slope && slope <= self.upper
    }

    /// The intersection of both.
    ///
    /// ```
    /// use chta::quantity::SlopeInterval;
    /// let a = SlopeInterval { lower: 0.0, upper: 2.0 };
    /// let b = SlopeInterval { lower: 1.0, upper: f64::INFINITY };
    /// assert_eq!(a.intersect(b), SlopeInterval { lower: 1.0, upper: 2.0 });
    /// ```
    #[must_use]
    pub fn intersect(self, other: Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.min(other.upper) }
    }

    /// The interval moved by `offset`.
    #[must_use]
    pub fn shifted(self, offset: f64) -> Self {
        Self { lower: self.lower + offset, upper: self.upper + offset }
    }

    /// The same directions as angles; `None` if empty.
    pub fn angles(self) -> Option<AngleInterval> {
        (!self.is_empty()).then(|| AngleInterval { min: Angle::from_slope(self.lower), max: Angle::from_slope(self.upper) })
    }
}
