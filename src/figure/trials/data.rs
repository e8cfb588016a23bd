//! The data of the pictures of trials.

use super::super::{Caption, Flight};
use crate::quantity::ChainPoint;

/// Trials over a chain's profile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownFigure {
    /// The ground, from left to right.
    pub ground: Vec<ChainPoint>,
    /// The planned hops.
    pub planned: Vec<Flight>,
    /// Some or all of the trials; more than a few hundred flights are thinned to every n-th trial, and the legend says so.
    pub trials: Vec<FlownTrial>,
    /// The number of all trials flown.
    pub trials_in_all: u64,
}

/// One trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownTrial {
    /// Its flights, each from the actual take-off to first contact with the ground.
    pub flights: Vec<Flight>,
    /// Whether it reached the goal; failed trials are drawn differently.
    pub reached: bool,
}

/// Quantiles of a distance error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorQuantiles {
    /// The number of landings.
    pub count: u64,
    /// Mean.
    pub mean_m: f64,
    /// The 5 % quantile.
    pub q05_m: f64,
    /// The 25 % quantile.
    pub q25_m: f64,
    /// Median.
    pub q50_m: f64,
    /// The 75 % quantile.
    pub q75_m: f64,
    /// The 95 % quantile.
    pub q95_m: f64,
    /// The largest.
    pub max_m: f64,
}

/// The distance errors of one policy or reading, landing by landing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LandingBoxes {
    /// The policy or reading, such as `open-loop`; it may be empty for a single series.
    pub name: String,
    /// The errors of hop 1, 2, and so on; a count of 0 draws no box.
    pub landings: Vec<ErrorQuantiles>,
}

/// Box plots, group by group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LandingErrorFigure {
    /// The caption.
    pub caption: Caption,
    /// One or several series, distinguished by colour and hatching.
    pub series: Vec<LandingBoxes>,
}

/// The outcomes of the trials of one policy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutcomeBars {
    /// The policy, such as `open-loop`.
    pub policy: String,
    /// Outcome names with their counts, in the order of the bars; they add up to the number of trials.
    pub counts: Vec<(String, u64)>,
    /// The share that reached the goal, 0 to 1, with its 95 % interval.
    pub success: Success,
    /// The success rate after increasing numbers of trials; may be empty.
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
    /// The number of trials.
    pub trials: u64,
    /// The rate and its interval.
    pub success: Success,
}

/// All data of a simulation; absent or empty parts are omitted from the sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimulationFigure {
    /// The caption.
    pub caption: Caption,
    /// Trajectories over the profile, under the first of the policies.
    pub flown: Option<FlownFigure>,
    /// Distance errors by landing, one series for each policy.
    pub errors: Vec<LandingBoxes>,
    /// Outcomes and convergence, one for each policy.
    pub outcomes: Vec<OutcomeBars>,
}

/// What each error costs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensitivityFigure {
    /// The caption.
    pub caption: Caption,
    /// One for each error, from the top.
    pub bars: Vec<SensitivityBar>,
}

/// What one error costs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensitivityBar {
    /// The error, such as `takeoff_angle_sigma_deg = 0.5`.
    pub name: String,
    /// The success rate without it minus that with it, -1 to 1, with its 95 % interval.
    pub cost: Success,
}

/// The landing error against the width of the cones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConeWidthFigure {
    /// The caption.
    pub caption: Caption,
    /// One for each width.
    pub points: Vec<ConeWidthPoint>,
}

/// One width of the cones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConeWidthPoint {
    /// The width of the cones.
    pub width_deg: f64,
    /// Hops of the planned path; `None` without a path, and then no errors are drawn.
    pub hops: Option<u64>,
    /// The distance errors over all landings.
    pub errors: ErrorQuantiles,
}

/// Paths of increasing hops and increasing success, or a decreasing amount.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrontFigure {
    /// The caption.
    pub caption: Caption,
    /// One for each path, in ascending order of hops.
    pub points: Vec<FrontPoint>,
    /// What hops are traded against.
    pub against: FrontAgainst,
}

/// What hops are traded against on a front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrontAgainst {
    /// The estimated success, with the least wanted, 0 to 1; `None`: any.
    Success {
        /// The least wanted.
        least: Option<f64>,
    },
    /// The total of an amount.
    Total {
        /// What it is.
        words: &'static str,
        /// Its unit.
        unit: &'static str,
        /// The greatest total allowed; `None`: any.
        most: Option<f64>,
    },
}

impl Default for FrontAgainst {
    fn default() -> Self {
        Self::Success { least: None }
    }
}

/// Where a path of a front lies beside its hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrontValue {
    /// Its estimated success.
    Success(Success),
    /// A total, in the unit of the front.
    Total(f64),
}

/// A path of a front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontPoint {
    /// Its hops.
    pub hops: u64,
    /// Its success or its total.
    pub value: FrontValue,
    /// Whether it is the path of the plan.
    pub planned: bool,
}
