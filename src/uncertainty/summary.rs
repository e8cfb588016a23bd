//! What many trials come to.

use nalgebra::{Matrix2, Point2};

use super::{OutcomeCounts, Policy, Trajectory, Wilson};
use crate::quantity::Angle;

/// What many trials came to. The same for any number of threads, to the last bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The policy flown.
    pub policy: Policy,
    /// The seed of all draws.
    pub seed: u64,
    /// How many trials were flown; fewer than asked for where the rate was known well enough before.
    pub trials: u64,
    /// How they ended; adds up to `trials`.
    pub outcomes: OutcomeCounts,
    /// The share that reached the goal, with its 95 % interval.
    pub success: Wilson,
    /// All hops flown, landed or not.
    pub hops_flown: u64,
    /// The landings by number of hop, from 1; as many as any trial had.
    pub landings: Vec<LandingSummary>,
    /// How the rate converged: after 10, 20, 50, 100, 200 and 500 trials, after each 1 000, and at the end.
    pub convergence: Vec<RatePoint>,
    /// The first trials with all their hops, as many as asked for.
    pub trajectories: Vec<Trajectory>,
}

/// The rate after so many trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatePoint {
    /// After how many.
    pub trials: u64,
    /// The rate then.
    pub success: Wilson,
}

/// The landings of one number of hop over all trials that landed it, those that ended with it included (their place is that of the
/// contact).
#[derive(Clone, Debug, PartialEq)]
pub struct LandingSummary {
    /// Which hop, from 1.
    pub hop: u32,
    /// How many trials landed it.
    pub count: u64,
    /// Of the horizontal distance between planned landing and place of rest.
    pub error: ErrorSummary,
    /// Where the robot came to rest, on a map.
    pub ellipse: Option<LandingEllipse>,
}

/// A distribution of distances, m. The quantiles are within 0.2 % of the true ones (see
/// [`QuantileSketch`](super::QuantileSketch)), the others are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSummary {
    /// Mean.
    pub mean_m: f64,
    /// 5 % lie below.
    pub q05_m: f64,
    /// A quarter lies below.
    pub q25_m: f64,
    /// Half lie below.
    pub q50_m: f64,
    /// Three quarters lie below.
    pub q75_m: f64,
    /// 95 % lie below.
    pub q95_m: f64,
    /// The largest.
    pub max_m: f64,
}

/// The ellipse that holds 95 % of a Gaussian with the mean and covariance of the places where a hop came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandingEllipse {
    /// Its centre, the mean place on the map, m.
    pub centre: Point2<f64>,
    /// Covariance east and north, m^2.
    pub covariance_m2: Matrix2<f64>,
    /// Half the long axis, m.
    pub semi_major_m: f64,
    /// Half the short axis, m.
    pub semi_minor_m: f64,
    /// Direction of the long axis, clockwise from grid north, 0 to 180 degrees.
    pub orientation: Angle,
}
