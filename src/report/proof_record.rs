//! The result of a proof, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limit_counts::LimitCounts;
use crate::graph::proof::{Bounds, Gap, ProofVerdict, Stretch, StretchClass};

/// The bounds on the fewest hops, and the work done for them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProofRecord {
    /// No path has fewer hops, at any resolution; null if it is proved that there is no path at all.
    pub lower_bound: Option<u64>,
    /// The hops of the best known path; null if no path is known.
    pub upper_bound: Option<u64>,
    /// Whether the two bounds meet, or no path can exist.
    pub proved: bool,
    /// The work done.
    pub proof: ProofSummaryRecord,
    /// Consecutive stretches of the chain by what is proved of them, from left to right.
    pub stretches: Vec<StretchRecord>,
    /// If no path can exist: how far one gets, and which limits refuse.
    pub gap: Option<GapRecord>,
}

/// The work done for a proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ProofSummaryRecord {
    /// Cells that the chain was divided into.
    pub cells: usize,
    /// The greatest number of cells allowed.
    pub budget_cells: usize,
    /// The number of cells that were halved.
    pub splits: u64,
    /// The number of updates of the search over the cells.
    pub rounds: u32,
    /// The number of tested pairs of cells.
    pub pairs_tested: u64,
    /// Whether the best path uses points of the cells instead of the nodes of the search.
    pub path_over_cells: bool,
    /// Whether the hopper has a footprint, which the proof uses at vertices alone; absent if it has none.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub footprint_at_vertices_alone: bool,
}

/// A stretch of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StretchRecord {
    /// Its left end, m.
    pub from_x_m: f64,
    /// Its right end, m.
    pub to_x_m: f64,
    /// `reachable` (a path to points of it was found), `unreachable` (proved) or `open`.
    pub class: StretchClass,
    /// Whether the goal may be reachable from it; `false` is proved.
    pub may_lead_to_goal: bool,
}

/// The gap that makes a journey impossible.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GapRecord {
    /// No path from the start comes nearer to the goal, m.
    pub reached_x_m: f64,
    /// The goal cannot be reached from any point nearer to the start, m.
    pub leads_to_goal_from_x_m: f64,
    /// Pairs of cells within reach, from a possibly reachable cell to an unreachable one, by the limit that refuses all hops.
    pub refusals: LimitCounts,
}

impl ProofRecord {
    /// The record of bounds that were allowed the given number of cells.
    pub fn new(bounds: &Bounds, budget_cells: usize) -> Self {
        let summary = bounds.summary;
        Self {
            lower_bound: bounds.lower,
            upper_bound: bounds.upper(),
            proved: bounds.is_proved(),
            proof: ProofSummaryRecord {
                cells: summary.cells,
                budget_cells,
                splits: summary.splits,
                rounds: summary.rounds,
                pairs_tested: summary.pairs_tested,
                path_over_cells: summary.path_over_cells,
                footprint_at_vertices_alone: summary.footprint_at_vertices_alone,
            },
            stretches: merged(&bounds.stretches),
            gap: bounds.gap.as_ref().map(GapRecord::of),
        }
    }

    /// The verdict from the bounds: `untraversable` only if it is proved.
    pub const fn verdict(&self) -> ProofVerdict {
        match (self.upper_bound, self.lower_bound) {
            (Some(_), _) => ProofVerdict::Traversable,
            (None, None) => ProofVerdict::Untraversable,
            (None, Some(_)) => ProofVerdict::Open,
        }
    }
}

impl GapRecord {
    /// The record of a gap.
    pub fn of(gap: &Gap) -> Self {
        Self { reached_x_m: gap.reached_x_m, leads_to_goal_from_x_m: gap.leads_to_goal_x_m, refusals: (&gap.refusals).into() }
    }
}

/// Merges neighbouring stretches of the same class.
fn merged(stretches: &[Stretch]) -> Vec<StretchRecord> {
    let mut merged: Vec<StretchRecord> = Vec::new();
    for stretch in stretches {
        let Stretch { from_x_m, to_x_m, class, may_lead_to_goal } = *stretch;
        match merged.last_mut() {
            Some(last) if (last.class, last.may_lead_to_goal) == (class, may_lead_to_goal) => last.to_x_m = to_x_m,
            _ => merged.push(StretchRecord { from_x_m, to_x_m, class, may_lead_to_goal }),
        }
    }
    merged
}
