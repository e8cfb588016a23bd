//! The scenario: TOML as typed, then validated, and the pipeline from terrain to a chain ready for analysis.

mod alike;
mod backslashes;
mod catalogue;
mod document;
mod entries;
mod file_kind;
mod footprint;
mod on_body;
mod physics;
mod pipeline;
mod problem;
mod propulsion;
mod read;
mod sense;
mod trade;
mod trials;

pub use alike::ask_the_same;
pub use catalogue::{CATALOGUE, Key, Kind};
pub use document::scenario_document;
pub use entries::{Entries, Place};
pub use file_kind::FileKind;
pub use footprint::coarse_dem_warning;
pub use on_body::{OfBody, dem_on_body, on_body};
pub use physics::{Extent, Extremes, TooLarge, constant_gravity_warnings};
pub use pipeline::{DemReading, JourneyEnd, Overlays, PipelineError, Prepared, Survey, Transect, friction, prepare, sha256_of};
pub use problem::{KeyPath, ProblemKind, ScenarioProblem, ScenarioProblems};
pub use read::{BodyChoice, LackingKey, Scenario, TerrainSource};
pub use sense::TrialGround;
pub use trade::{SweptKey, Trade, TradeError, Varied, verdict};
pub use trials::UncertaintyKeys;
