//! The least capability with which a goal can be reached, as plain data.

use serde::Serialize;

use super::{GapRecord, HopRecord, TotalsRecord};

/// What `chta require` answers.
#[derive(Clone, Debug, Serialize)]
pub struct RequireAnswer {
    /// Start, m.
    pub start_x_m: f64,
    /// Goal, m.
    pub goal_x_m: f64,
    /// The scenario key that was varied.
    pub vary: String,
    /// The most capable value at which it is proved that no path exists; null where that is proved at no value of the range.
    pub unreachable_at: Option<f64>,
    /// The least capable value at which a path was found; null where none was found at any value of the range.
    pub reachable_at: Option<f64>,
    /// The least value of the range.
    pub from: f64,
    /// The greatest value of the range.
    pub to: f64,
    /// Every value tried, in the order of trying.
    pub tries: Vec<RequireTry>,
    /// How many hops the path at `reachable_at` has.
    pub hops: Option<u64>,
    /// That path; empty also where it has too many hops to list.
    pub path: Vec<HopRecord>,
    /// What it adds up to.
    pub totals: Option<TotalsRecord>,
    /// What stops the journey at `unreachable_at`.
    pub gap: Option<GapRecord>,
}

/// One value tried.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RequireTry {
    /// The value, in the key's unit.
    pub value: f64,
    /// `traversable`, `untraversable` (proved) or `no-path-found`.
    pub verdict: &'static str,
    /// No path has fewer hops; null where there is none.
    pub lower_bound: Option<u64>,
    /// The hops of the best path known.
    pub upper_bound: Option<u64>,
}
