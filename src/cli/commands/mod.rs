//! One file per command, and one for a question over a mesh.

pub(super) mod arena;
pub(super) mod bodies;
pub(super) mod check;
mod check_over_mesh;
pub(super) mod compare;
pub(super) mod completions;
pub(super) mod fan;
pub(super) mod hop;
pub(super) mod man;
pub(super) mod map;
mod map_over_mesh;
mod map_travel;
pub(super) mod plan;
mod plan_over_mesh;
mod plan_targets;
mod plan_travel;
pub(super) mod require;
pub(super) mod run;
mod run_over_mesh;
mod run_targets;
mod run_travel;
pub(super) mod schema;
pub(super) mod simulate;
pub(super) mod sites;
pub(super) mod slice;
pub(super) mod synth;
pub(super) mod trade;
