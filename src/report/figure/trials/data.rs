//! What the pictures of trials show, as plain data.

use super::super::{Caption, Flight};
use crate::quantity::ChainPoint;

/// Trials over a chain's profile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownFigure {
    /// The ground, from left to right.
    pub ground: Vec<ChainPoint>,
    /// The planned hops.
    pub planned: Vec<Flight>,
    /// Some or all of the trials; of more than a few hundred flights every n-th trial is drawn, and the legend says so.
    pub trials: Vec<FlownTrial>,
    /// How many trials were flown in all.
    pub trials_in_all: u64,
}

/// One trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownTrial {
    /// Its flights, each from where it really took off to where it first met the ground.
    pub flights: Vec<Flight>,
    /// Whether it reached the goal; the others are drawn apart.
    pub reached: bool,
}

/// Quantiles of a distance error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorQuantiles {
    /// How many landings there were.
    pub count: u64,
    /// Mean.
    pub mean_m: f64,
    /// 5 % are below.
    pub q05_m: f64,
    /// 25 % are below.
    pub q25_m: f64,
    /// Median.
    pub q50_m: f64,
    /// 75 % are below.
    pub q75_m: f64,
    /// 95 % are below.
    pub q95_m: f64,
    /// The largest.
    pub max_m: f64,
}

/// The distance errors of one policy or reading, landing by landing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LandingBoxes {
    /// The policy or reading, such as `open-loop`; with one series alone it may be empty.
    pub name: String,
    /// Of hop 1, 2, and so on; a count of 0 leaves the place empty.
    pub landings: Vec<ErrorQuantiles>,
}

/// Box plots, group by group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LandingErrorFigure {
    /// The words above.
    pub caption: Caption,
    /// One or several series, told apart by colour and hatching.
    pub series: Vec<LandingBoxes>,
}

/// How the trials of one policy ended.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutcomeBars {
    /// The policy, such as `open-loop`.
    pub policy: String,
    /// Outcome names with their counts, in the order of the bars; they add up to the number of trials.
    pub counts: Vec<(String, u64)>,
    /// The share that reached the goal, 0 to 1, with its 95 % interval.
    pub success: Success,
    /// The success rate after the first so many trials, rising; may be empty.
    pub convergence: Vec<ConvergencePoint>,
}

/// A share with its 95 % interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Success {
    /// 0 to 1.
    pub rate: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// The success rate after some trials.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConvergencePoint {
    /// After how many trials.
    pub trials: u64,
    /// The rate and its interval.
    pub success: Success,
}

/// All of a simulation; what is absent or empty is left out of the sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimulationFigure {
    /// The words above.
    pub caption: Caption,
    /// Trajectories over the profile (2-D chains).
    pub flown: Option<FlownFigure>,
    /// Distance errors by landing, one series for each policy.
    pub errors: Vec<LandingBoxes>,
    /// Outcomes and convergence, one for each policy.
    pub outcomes: Vec<OutcomeBars>,
}

/// The landing error against the width of the cones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConeWidthFigure {
    /// The words above.
    pub caption: Caption,
    /// One for each width.
    pub points: Vec<ConeWidthPoint>,
}

/// One width of the cones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConeWidthPoint {
    /// The width of the cones.
    pub width_deg: f64,
    /// Hops of the planned path; `None` where there is none, and then no errors are drawn.
    pub hops: Option<u64>,
    /// The distance errors over all landings.
    pub errors: ErrorQuantiles,
}
