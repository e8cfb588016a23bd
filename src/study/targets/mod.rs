//! Missions over several targets: plans, and their trials.

mod compare;
#[cfg(feature = "plot")]
mod picture;
mod plan;
mod search;
mod trials;

pub use plan::{TargetsPlanned, targets_plan};
pub use trials::{TargetsSimulated, targets_simulate};
