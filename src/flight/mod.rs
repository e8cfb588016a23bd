//! One hop flown with drawn errors: the draws, the first contact, and whether the ground holds.
//!
//! [`crate::uncertainty`] combines hops to trials: policies, outcomes, statistics.

mod bounce;
mod command_spread;
mod deviations;
mod distribution;
mod draws;
mod error_key;
mod hop;
mod hop_errors;
mod hop_trials;
mod measured;
mod quasi;
mod rest_aim;

pub(crate) use command_spread::CommandSpread;
pub use deviations::{Uncertainty, UncertaintyProblem};
pub use distribution::Distribution;
pub(crate) use draws::TrialDraws;
pub use error_key::ErrorKey;
pub(crate) use hop::{Command, FlownHop};
pub use hop_errors::DrawnErrors;
pub(crate) use hop_errors::{Biases, Errors, HopErrors};
pub(crate) use hop_trials::{HopTrials, JudgedHop, REPORTED_DRAWS, SEARCHED_DRAWS, Survival};
pub use measured::MeasuredErrors;
pub(crate) use measured::MeasuredRow;
pub(crate) use rest_aim::resting_at;
