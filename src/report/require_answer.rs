//! The least capability with which a goal can be reached, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GapRecord, HopRecord, TotalsRecord};
use crate::graph::proof::ProofVerdict;

/// The answer of `chta require`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RequireAnswer {
    /// Start, m.
    pub start_x_m: f64,
    /// Goal, m.
    pub goal_x_m: f64,
    /// The scenario key that was varied.
    pub vary: String,
    /// The most capable value at which it is proved that no path exists; null if there is no such value in the range.
    pub unreachable_at: Option<f64>,
    /// The least capable value at which a path was found; null if no path was found in the range.
    pub reachable_at: Option<f64>,
    /// The least value of the range.
    pub from: f64,
    /// The greatest value of the range.
    pub to: f64,
    /// How close the two values were to come, as a fraction of them.
    pub resolution: f64,
    /// Whether they did, or the whole range is decided; false where the values between stayed open within the budget.
    pub resolution_met: bool,
    /// Whether the path found holds at every value of the key, however demanding: a clearance whose taper ends below `reachable_at` on every
    /// hop of it. Absent if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub never_binds: bool,
    /// Every value tried, in the order of the trials.
    pub tries: Vec<RequireTry>,
    /// The number of hops of the path at `reachable_at`.
    pub hops: Option<u64>,
    /// That path; empty if no path was found or it has too many hops to list.
    pub path: Vec<HopRecord>,
    /// Its totals.
    pub totals: Option<TotalsRecord>,
    /// The gap that stops the journey at `unreachable_at`.
    pub gap: Option<GapRecord>,
}

/// One value tried.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RequireTry {
    /// The value, in the key's unit.
    pub value: f64,
    /// `traversable`, `untraversable` (proved) or `no-path-found`.
    pub verdict: ProofVerdict,
    /// No path has fewer hops; null if no path exists.
    pub lower_bound: Option<u64>,
    /// The hops of the best known path.
    pub upper_bound: Option<u64>,
}
