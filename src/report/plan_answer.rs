//! The answer of a plan, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{CheckAnswer, HopRecord, ReliablePathRecord, TotalsRecord};

/// The answer of a plan: the check, the path, its totals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanAnswer {
    /// Whether a path exists.
    #[serde(flatten)]
    pub check: CheckAnswer,
    /// Whether the path was flown again and passed; absent if not requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verified: Option<bool>,
    /// The hops; empty without a path.
    pub path: Vec<HopRecord>,
    /// The sums over the path; null without one.
    pub totals: Option<TotalsRecord>,
    /// The Pareto front of hops against success probability, where the scenario weighs risk.
    #[serde(rename = "surest", default, skip_serializing_if = "Vec::is_empty")]
    pub reliable_paths: Vec<ReliablePathRecord>,
}
