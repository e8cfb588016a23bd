//! The answer of a plan, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    CheckAnswer, FrontRecord, FrontSearchRecord, FurtherMeans, HopRecord, ReliablePathRecord, TotalsRecord, amount_front_text,
    check_text, front_text, path_text, reliable_paths_text, sigma_margins::edge_text,
};

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
    /// The front of hops against reliability or an amount, in ascending order of hops; empty without a path, absent if not requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front: Option<Vec<FrontRecord>>,
    /// Of a front against another amount than risk: what it was searched for.
    #[serde(flatten)]
    pub front_search: Option<FrontSearchRecord>,
}

/// The text of `chta plan`.
pub fn plan_text(answer: &PlanAnswer, means: FurtherMeans<'_>) -> String {
    let mut text = check_text(&answer.check, means);
    if let Some(totals) = &answer.totals {
        text.push('\n');
        text.push_str(&path_text(&answer.path, totals));
    }
    match (&answer.front, &answer.front_search) {
        (Some(front), Some(of)) => text.push_str(&amount_front_text(front, of)),
        (Some(front), None) => text.push_str(&front_text(front)),
        (None, _) => text.push_str(&reliable_paths_text(&answer.reliable_paths, answer.check.hops)),
    }
    if let Some(estimate) = answer.totals.as_ref().and_then(|totals| totals.estimate) {
        text.push_str(&estimate.text(&answer.reliable_paths, answer.check.hops));
        text.push_str(&edge_text(answer.path.iter().map(|hop| (hop.hop, hop.margins_sigma.as_ref()))));
    }
    if answer.verified == Some(true) {
        let of = if answer.check.propellant_shortage.is_some() { " of a hop" } else { "" };
        text.push_str("verified: every hop was flown again by direct simulation and breaks no limit");
        text.push_str(of);
        text.push('\n');
    }
    text
}
