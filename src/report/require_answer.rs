//! The least capability with which a goal can be reached, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DeratingRecord, GapRecord, HopRecord, ObjectiveRecord, QuestionRouteRecord, SuccessBudgetRecord, TotalsRecord};
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
    /// Of free routes: the most capable value tried at which the goal was not reached over these nodes, which proves nothing; absent along a
    /// transect, and where every value tried reaches it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_reached_at: Option<f64>,
    /// Of free routes: the nodes of all values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub route: Option<QuestionRouteRecord>,
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
    /// Of a scenario with a budget of success: how sure the value is. Nothing is proved then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success: Option<RequireSuccessRecord>,
    /// Of a scenario with an objective or budgets of totals: what was tried. Nothing is proved then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_budgets: Option<RequireBudgetsRecord>,
    /// The shares of the limits that this answer is for; absent if it is for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
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

/// The least capable value with enough estimated success, and how sure it is. Success need not grow with a capability: between the values
/// tried it may be otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RequireSuccessRecord {
    /// The success wanted.
    pub success_min: f64,
    /// The least capable value tried whose estimate is enough; null if no value tried has it.
    pub at: Option<SuccessTry>,
    /// The value before the least capable one whose 95 % interval reaches the success wanted, or that one at the end of the range; null if
    /// none does.
    pub uncertain_from: Option<f64>,
    /// The least capable value whose whole 95 % interval is enough; null if none is.
    pub uncertain_to: Option<f64>,
    /// Whether no estimate falls from one value tried to the next more capable one.
    pub monotone: bool,
    /// Whether every value tried that is more capable than the one found is enough as well.
    pub enough_from_there_on: bool,
    /// Every value tried, from the least capable to the most capable.
    pub tries: Vec<SuccessTry>,
}

/// The least capable value whose best path by the objective keeps the budgets. That need not grow with a capability: between the values tried
/// it may be otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RequireBudgetsRecord {
    /// What the path of that value was planned for, and takes of its budgets; null if no value tried has one within them.
    pub at: Option<ObjectiveRecord>,
    /// Whether every value tried that is more capable than the one found has a path within the budgets as well.
    pub within_from_there_on: bool,
    /// Every value tried, from the least capable to the most capable.
    pub tries: Vec<BudgetsTry>,
}

/// A path by objective at one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BudgetsTry {
    /// The value, in the key's unit.
    pub value: f64,
    /// The hops of the path: the best within the budgets, or else the best without them; null without a path.
    pub hops: Option<u64>,
    /// Whether a path keeps the budgets.
    pub within: bool,
    /// The keys of the budgets that it exceeds.
    pub exceeds: Vec<String>,
}

/// The success at one value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SuccessTry {
    /// The value, in the key's unit.
    pub value: f64,
    /// The hops of the path: the fewest with enough estimated success, or else those of the best; null without a path.
    pub hops: Option<u64>,
    /// The share of 512 fixed trials of that path that reach the goal, with the same draws at every value; 0 without a path.
    pub success_estimated: f64,
    /// Its 95 % interval by Wilson's score.
    pub success_estimated_ci95: [f64; 2],
}

impl BudgetsTry {
    /// What a plan by objective says at a value.
    pub fn new(value: f64, hops: Option<u64>, objective: Option<&ObjectiveRecord>) -> Self {
        let unmet = objective.into_iter().flat_map(|objective| &objective.budgets).filter(|budget| !budget.met);
        let exceeds: Vec<String> = unmet.map(|budget| budget.key.clone()).collect();
        Self { value, hops, within: hops.is_some() && exceeds.is_empty(), exceeds }
    }
}

impl SuccessTry {
    /// What a budget of success says at a value; `None` without a path.
    pub fn new(value: f64, found: Option<&SuccessBudgetRecord>) -> Self {
        Self {
            value,
            hops: found.and_then(|found| found.hops),
            success_estimated: found.and_then(|found| found.success_estimated).unwrap_or(0.0),
            success_estimated_ci95: found.and_then(|found| found.success_estimated_ci95).unwrap_or([0.0; 2]),
        }
    }
}
