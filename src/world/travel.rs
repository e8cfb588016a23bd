//! The direction of travel in the vertical plane, and the two ends of a hop.

/// A direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// Towards +x.
    Forward,
    /// Towards -x.
    Reverse,
}

impl Direction {
    /// Both directions.
    pub const BOTH: [Self; 2] = [Self::Forward, Self::Reverse];

    /// The direction of travel between two stations; `None` if both have the same x.
    pub fn between(takeoff_x_m: f64, landing_x_m: f64) -> Option<Self> {
        if landing_x_m > takeoff_x_m {
            Some(Self::Forward)
        } else if landing_x_m < takeoff_x_m {
            Some(Self::Reverse)
        } else {
            None
        }
    }

    /// +1 forward, -1 in reverse: the factor that converts x and slopes to the direction of travel.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Reverse => -1.0,
        }
    }

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Reverse => "reverse",
        }
    }
}

crate::quantity::by_name!(Direction, Direction::BOTH);

/// One of the two ends of a hop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Contact {
    /// The hop begins here.
    Takeoff,
    /// The hop ends here.
    Landing,
}
