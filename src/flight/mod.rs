//! One hop flown with drawn errors: the draws, the first contact, and whether the ground holds.
//!
//! [`crate::uncertainty`] combines hops to trials: policies, outcomes, statistics.

mod deviations;
mod draws;
mod error_key;
mod hop;
mod hop_trials;
mod quasi;

pub use deviations::{Uncertainty, UncertaintyProblem};
pub(crate) use draws::{HopDraws, TrialDraws};
pub use error_key::ErrorKey;
pub(crate) use hop::{Command, Errors, FlownHop};
pub(crate) use hop_trials::{HopTrials, JudgedHop, Survival};
