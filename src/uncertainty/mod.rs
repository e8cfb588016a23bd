//! How surely a planned path is flown: worst cases and frequencies under errors of command, ground and position.
//!
//! A path is a promise made without slip and scatter. Here it is flown many times over ground that is not quite as mapped, with commands
//! that are not quite as given: each [`HopRecord`] is one arc of a parabola to its first contact with the ground, found exactly, and
//! judged where it really takes off and lands.
//!
//! ```text
//!   trial n ──> draws (seed, n) ──> hop: command + errors ──> first contact ──> judged ──> drift ──> next hop
//! ```

mod deviations;
mod draws;
pub mod experiments;
mod field;
mod ground;
mod on_chain;
mod on_map;
mod options;
mod outcome;
mod quantiles;
mod record;
mod simulation;
mod summary;
mod tally;
mod trial;
mod wilson;

pub use deviations::{Uncertainty, UncertaintyProblem};
pub use ground::Launch;
pub use options::{MapGround, Mission, Observer, Progress, SimulationError, TrialOptions};
pub use outcome::{OutcomeCounts, Policy, TrialOutcome};
pub use quantiles::QuantileSketch;
pub use record::{HopRecord, Trajectory, TrialRecord};
pub use simulation::{FlightEnd, Simulation};
pub use summary::{ErrorSummary, LandingEllipse, LandingSummary, RatePoint, Summary};
pub use wilson::Wilson;
