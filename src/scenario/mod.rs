//! The scenario: TOML as typed, then validated, and the pipeline it wires from terrain to answer.

mod alike;
mod catalogue;
mod document;
mod entries;
mod pipeline;
mod problem;
mod read;
mod trade;
mod trials;

pub use alike::ask_the_same;
pub use catalogue::{CATALOGUE, Key, Kind};
pub use document::scenario_document;
pub use entries::{Entries, Place};
pub use pipeline::{
    Covers, Cut, Extremes, JourneyEnd, PipelineError, Prepared, Survey, constant_gravity_doubts, friction, prepare, sha256_of,
};
pub use problem::{KeyPath, ProblemKind, ScenarioProblem, ScenarioProblems};
pub use read::{BodyChoice, LackingKey, Scenario, TerrainSource};
pub use trade::{Trade, TradeError, Variation, Varied, judged};
pub use trials::UncertaintyKeys;
