//! One hop flown under drawn errors: the draws, the first contact, and whether the ground holds.
//!
//! What a trial makes of it (policies, outcomes, statistics) is [`crate::uncertainty`]'s.

mod deviations;
mod draws;
mod hop;

pub use deviations::{Uncertainty, UncertaintyProblem};
pub(crate) use draws::{HopDraws, TrialDraws};
pub(crate) use hop::{Command, Errors, FlownHop};
