//! The statistics of many trials.

use nalgebra::{Matrix2, Point2};

use super::{OutcomeCounts, Policy, QuantileSketch, Trajectory, Wilson};
use crate::quantity::Angle;

/// The statistics of many trials, bit-identical for any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The policy flown.
    pub policy: Policy,
    /// The seed of all draws.
    pub seed: u64,
    /// The number of the first trial; 0 unless they are a later part of a run.
    pub first_trial: u64,
    /// The number of trials flown; fewer than requested if the success rate was precise enough before.
    pub trials: u64,
    /// The outcomes; their sum is `trials`.
    pub outcomes: OutcomeCounts,
    /// The outcomes by the hop that ended the trial ([`TrialRecord::last_hop`](super::TrialRecord::last_hop)); 0: before any.
    pub ends: Vec<OutcomeCounts>,
    /// Of the trials that stopped off the goal: horizontal distances from it, m.
    pub missed_m: QuantileSketch,
    /// The success rate with its 95 % interval.
    pub success: Wilson,
    /// The number of hops flown, landed or not.
    pub hops_flown: u64,
    /// The landings by the number of their hop, from 1 to the most hops of any trial.
    pub landings: Vec<LandingSummary>,
    /// The convergence of the rate: after 10, 20, 50, 100, 200 and 500 trials, after each 1 000, and at the end.
    pub convergence: Vec<RatePoint>,
    /// The first trials with all their hops, as many as requested.
    pub trajectories: Vec<Trajectory>,
}

/// The success rate after some trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatePoint {
    /// The number of trials.
    pub trials: u64,
    /// The rate after them.
    pub success: Wilson,
}

/// The landings of all trials' hops with one number. A landing that ended its trial is included; its position of rest is the
/// contact.
#[derive(Clone, Debug, PartialEq)]
pub struct LandingSummary {
    /// The number of the hop, from 1.
    pub hop: u32,
    /// The number of trials with this landing.
    pub count: u64,
    /// The horizontal distances between planned landing and position of rest.
    pub error: ErrorSummary,
    /// The positions of rest, on a map.
    pub ellipse: Option<LandingEllipse>,
}

/// A distribution of distances, m. Quantiles are within 0.2 % of the true ones (see [`QuantileSketch`](super::QuantileSketch));
/// mean and maximum are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSummary {
    /// Mean.
    pub mean_m: f64,
    /// The 5 % quantile.
    pub q05_m: f64,
    /// The 25 % quantile.
    pub q25_m: f64,
    /// The median.
    pub q50_m: f64,
    /// The 75 % quantile.
    pub q75_m: f64,
    /// The 95 % quantile.
    pub q95_m: f64,
    /// The largest.
    pub max_m: f64,
}

/// The ellipse that holds 95 % of a Gaussian with the mean and covariance of the positions of rest after one hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandingEllipse {
    /// Its centre, the mean position on the map, m.
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
