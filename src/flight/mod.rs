//! One hop flown with drawn errors: the draws, the first contact, and whether the ground holds.
//!
//! [`crate::uncertainty`] combines hops to trials: policies, outcomes, statistics.

mod deviations;
mod distribution;
mod draws;
mod error_key;
mod hop;
mod hop_errors;
mod hop_trials;
mod measured;
mod quasi;

pub use deviations::{Uncertainty, UncertaintyProblem};
pub use distribution::Distribution;
pub(crate) use draws::TrialDraws;
pub use error_key::ErrorKey;
pub(crate) use hop::{Command, FlownHop};
pub(crate) use hop_errors::{Errors, HopErrors};
pub(crate) use hop_trials::{HopTrials, JudgedHop, Survival};
pub use measured::MeasuredErrors;
