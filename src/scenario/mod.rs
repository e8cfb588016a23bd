//! The scenario: TOML as typed, then validated, and written again.

mod backslashes;
mod budget;
mod catalogue;
mod contact;
mod derating;
mod document;
mod drive;
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
mod values;

pub use budget::Budget;
pub use catalogue::{CATALOGUE, Key, Kind};
pub use document::scenario_document;
pub use drive::DriveKeys;
pub(crate) use entries::nearest_key;
pub use entries::{Entries, Place};
pub use file_kind::FileKind;
pub use mesh_search::MeshSearch;
pub use problem::{KeyPath, ProblemKind, ScenarioProblem, ScenarioProblems};
pub use read::{BodyChoice, LackingKey, Scenario};
pub use route::Route;
pub use schema::scenario_schema;
pub use terrain_source::TerrainSource;
pub use trials::UncertaintyKeys;
pub(crate) use values::fits;
