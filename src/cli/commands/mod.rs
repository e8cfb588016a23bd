//! One file per command.

pub(super) mod bodies;
pub(super) mod check;
pub(super) mod compare;
pub(super) mod completions;
pub(super) mod fan;
pub(super) mod hop;
pub(super) mod man;
pub(super) mod map;
pub(super) mod plan;
pub(super) mod require;
pub(super) mod run;
pub(super) mod schema;
pub(super) mod simulate;
pub(super) mod slice;
pub(super) mod synth;
pub(super) mod trade;
