//! The scenario: TOML as typed, then validated, and written again.

mod arena;
mod backslashes;
mod budget;
mod catalogue;
mod contact;
mod derating;
mod document;
mod entries;
mod face_groups;
mod file_kind;
mod mesh_planner;
mod mesh_search;
mod problem;
mod propulsion;
mod read;
mod route;
mod schema;
mod terrain_source;
mod trials;

pub use arena::{arena_toml, read_arena};
pub use budget::Budget;
pub use catalogue::{CATALOGUE, Key, Kind};
pub use document::scenario_document;
pub use entries::{Entries, Place};
pub(crate) use entries::{fits, nearest_key};
pub use file_kind::FileKind;
pub use mesh_search::MeshSearch;
pub use problem::{KeyPath, ProblemKind, ScenarioProblem, ScenarioProblems};
pub use read::{BodyChoice, LackingKey, Scenario};
pub use route::Route;
pub use schema::scenario_schema;
pub use terrain_source::TerrainSource;
pub use trials::UncertaintyKeys;
