//! What a vertical plane cuts out of a cone of directions.

use crate::quantity::{Angle, SlopeInterval};

/// The directions of a convex cone that lie in the vertical plane of a heading; each direction is (ahead, up), of any length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaneCut {
    /// The plane misses the cone.
    Nothing,
    /// From `lower` anticlockwise to `upper`, at most half a turn, ends included. Both are the same where the plane touches the cone.
    Between {
        /// The side that is clockwise of the others.
        lower: [f64; 2],
        /// The side that is anticlockwise of the others.
        upper: [f64; 2],
    },
    /// Every direction.
    Everything,
}

impl PlaneCut {
    /// The slopes of the directions that point ahead, as take-off slopes.
    ///
    /// # Returns
    /// Up to infinity where straight up lies inside, from minus infinity where straight down does; empty where no direction points ahead.
    /// Its [`angles`](SlopeInterval::angles) are the elevations for a report: 90 degrees where straight up lies inside or between the
    /// sides, -90 where straight down does.
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::stance::PlaneCut;
    /// // From 45 to 135 degrees: ahead, slopes of 1 or more. A landing comes down with 45 degrees or steeper.
    /// let cut = PlaneCut::Between { lower: [1.0, 1.0], upper: [-1.0, 1.0] };
    /// assert_eq!((cut.takeoff_slopes().lower, cut.takeoff_slopes().upper), (1.0, f64::INFINITY));
    /// assert_eq!((cut.landing_slopes().lower, cut.landing_slopes().upper), (f64::NEG_INFINITY, -1.0));
    /// ```
    #[inline]
    pub fn takeoff_slopes(&self) -> SlopeInterval {
        match *self {
            Self::Nothing => SlopeInterval::EMPTY,
            Self::Between { lower, upper } => slopes_between(lower, upper),
            Self::Everything => SlopeInterval::ALL,
        }
    }

    /// The slopes of the velocities ahead whose reverse lies inside, as landing slopes (model section 2).
    #[inline]
    pub fn landing_slopes(&self) -> SlopeInterval {
        match *self {
            Self::Nothing => SlopeInterval::EMPTY,
            Self::Between { lower, upper } => slopes_between(lower.map(|part| -part), upper.map(|part| -part)),
            Self::Everything => SlopeInterval::ALL,
        }
    }

    /// Whether a direction, (ahead, up), lies inside, sides included.
    ///
    /// ```
    /// use chta::ballistics::stance::PlaneCut;
    /// let cut = PlaneCut::Between { lower: [1.0, 1.0], upper: [0.0, 1.0] };
    /// assert!(cut.contains([0.0, 3.0]) && cut.contains([1.0, 2.0]) && !cut.contains([-1.0, 9.0]) && !cut.contains([-1.0, -2.0]));
    /// ```
    pub fn contains(&self, direction: [f64; 2]) -> bool {
        match *self {
            Self::Nothing => false,
            // Of a single ray the reverse is on the same line, so an angle of at most a right one to a side is asked as well.
            Self::Between { lower, upper } => {
                cross(lower, direction) >= 0.0
                    && cross(direction, upper) >= 0.0
                    && (dot(lower, direction) >= 0.0 || dot(upper, direction) >= 0.0)
            }
            Self::Everything => true,
        }
    }

    /// The angle between the sides: 0 for a single ray, 180 degrees for a half-plane, 360 for every direction; `None` if the plane misses the cone.
    pub fn opening(&self) -> Option<Angle> {
        match *self {
            Self::Nothing => None,
            Self::Between { lower, upper } => Some(Angle::from_radians(libm::atan2(cross(lower, upper), dot(lower, upper)).abs())),
            Self::Everything => Some(Angle::from_radians(std::f64::consts::TAU)),
        }
    }
}

/// The slopes ahead between two sides. A half-plane that faces ahead has both sides vertical, and every slope.
fn slopes_between(lower: [f64; 2], upper: [f64; 2]) -> SlopeInterval {
    // At most half a turn lies between the sides, so where neither points ahead and the lower one points down and the upper one up, ahead
    // is between them. Of sides that nearly coincide this would be rounding: they point the same way.
    if lower[0] <= 0.0 && upper[0] <= 0.0 && lower[1] < 0.0 && upper[1] > 0.0 && dot(lower, upper) < 0.0 {
        return SlopeInterval::ALL;
    }
    SlopeInterval::between_sides(lower, upper)
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
