//! What a proof says, as plain data.

use std::collections::BTreeMap;

use serde::Serialize;

use super::check_answer::counts;
use crate::graph::proof::{Bounds, Gap, ProofVerdict, Stretch};

/// The bounds on the fewest hops, and what they took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProofRecord {
    /// No path has fewer hops, at any resolution; null where it is proved that there is none at all.
    pub lower_bound: Option<u64>,
    /// The hops of the best path known; null where none is known.
    pub upper_bound: Option<u64>,
    /// Whether the two meet, or no path can exist.
    pub proved: bool,
    /// What it took.
    pub proof: ProofSummaryRecord,
    /// Neighbouring stretches of the chain by what is proved of them, from left to right.
    pub stretches: Vec<StretchRecord>,
    /// Where no path can exist: how far one gets, and which limits refuse.
    pub gap: Option<GapRecord>,
}

/// What a proof took.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ProofSummaryRecord {
    /// Cells that the chain was cut into.
    pub cells: usize,
    /// How many of them it was allowed.
    pub budget_cells: usize,
    /// How many cells were split in two.
    pub splits: u64,
    /// How often the search over the cells was brought up to date.
    pub rounds: u32,
    /// How many pairs of cells were tested.
    pub pairs_tested: u64,
    /// Whether the best path goes over points of the cells, not over those of the search.
    pub path_over_cells: bool,
}

/// A stretch of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StretchRecord {
    /// Where it begins, m.
    pub from_x_m: f64,
    /// Where it ends, m.
    pub to_x_m: f64,
    /// `reachable` (a path to points of it was found), `unreachable` (proved) or `open`.
    pub class: &'static str,
    /// Whether the goal may be reached from it; where not, that is proved.
    pub may_lead_to_goal: bool,
}

/// What keeps a journey from being possible.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GapRecord {
    /// No path from the start comes nearer to the goal, m.
    pub reached_x_m: f64,
    /// No place nearer to the start leads to the goal, m.
    pub leads_to_goal_from_x_m: f64,
    /// Pairs of cells within reach, the first of which may be reached and the second not, by the limit that refuses all hops.
    pub refusals: BTreeMap<&'static str, u64>,
}

impl ProofRecord {
    /// Of bounds that were allowed so many cells.
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
            },
            stretches: merged(&bounds.stretches),
            gap: bounds.gap.as_ref().map(GapRecord::of),
        }
    }

    /// The verdict that the bounds allow: `untraversable` only where it is proved.
    pub const fn verdict(&self) -> &'static str {
        match (self.upper_bound, self.lower_bound) {
            (Some(_), _) => ProofVerdict::Traversable.name(),
            (None, None) => ProofVerdict::Untraversable.name(),
            (None, Some(_)) => ProofVerdict::Open.name(),
        }
    }
}

impl GapRecord {
    /// Of a gap.
    pub fn of(gap: &Gap) -> Self {
        Self { reached_x_m: gap.reached_x_m, leads_to_goal_from_x_m: gap.leads_to_goal_x_m, refusals: counts(&gap.refusals) }
    }
}

/// Neighbours of which the same is proved, as one.
fn merged(stretches: &[Stretch]) -> Vec<StretchRecord> {
    let mut merged: Vec<StretchRecord> = Vec::new();
    for stretch in stretches {
        let Stretch { from_x_m, to_x_m, class, may_lead_to_goal } = *stretch;
        match merged.last_mut() {
            Some(last) if (last.class, last.may_lead_to_goal) == (class.name(), may_lead_to_goal) => last.to_x_m = to_x_m,
            _ => merged.push(StretchRecord { from_x_m, to_x_m, class: class.name(), may_lead_to_goal }),
        }
    }
    merged
}
