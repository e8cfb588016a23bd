//! One file per command.

pub(super) mod bodies;
mod captions;
pub(super) mod check;
pub(super) mod compare;
pub(super) mod fan;
pub(super) mod hop;
pub(super) mod map;
mod map_profiles;
pub(super) mod plan;
pub(super) mod require;
pub(super) mod run;
pub(super) mod schema;
mod search;
pub(super) mod simulate;
pub(super) mod slice;
pub(super) mod synth;
pub(super) mod trade;
mod trajectory;
