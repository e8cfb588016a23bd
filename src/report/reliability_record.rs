//! The Pareto front of hops against success probability, as rows.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::Sheet;
use crate::{
    graph::ReliablePath,
    uncertainty::{ESTIMATE_TRIALS, Policy},
};

/// How reliably a path is flown, by fixed trials: the same for every question, whatever the seed of the scenario.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SuccessEstimate {
    /// The share of 512 fixed trials that reach the goal under `success_policy`. No product of the hops: friction and heights are one draw
    /// of a whole trial, and a replanned hop is another hop.
    pub success_estimated: f64,
    /// The policy of these trials.
    pub success_policy: Policy,
}

impl SuccessEstimate {
    /// The estimate as a line.
    pub(super) fn line(&self) -> String {
        let Self { success_estimated, success_policy } = self;
        format!("estimated success: {success_estimated:.4} under {success_policy}, by {ESTIMATE_TRIALS} fixed trials")
    }

    /// The estimate as text, with what fewer hops would cost: `rows` are the front that the path of `hops` hops was chosen from.
    pub(super) fn text(&self, rows: &[ReliablePathRecord], hops: Option<u64>) -> String {
        let Self { success_estimated, .. } = self;
        let mut sheet = Sheet::default();
        sheet.line(format_args!("\n{}", self.line()));
        let fewer = rows.iter().filter(|row| hops.is_some_and(|hops| row.hops < hops));
        let least = fewer.filter_map(|row| Some((row.hops, row.estimated_success?))).find(|(_, share)| share < success_estimated);
        if let Some((hops, share)) = least {
            let hops = if hops == 1 { "1 hop".to_owned() } else { format!("{hops} hops") };
            sheet.line(format_args!(
                "fewer hops would cost reliability: the most reliable path of {hops} has an estimated success of {share:.4}"
            ));
        }
        sheet.into_text()
    }
}

/// The most reliable path of one hop count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReliablePathRecord {
    /// The number of hops.
    pub hops: u64,
    /// The share of 512 fixed trials that reach the goal; null without errors to fly, and for
    /// paths that are not flown: nine of a front are where no budget of success is to be met.
    pub estimated_success: Option<f64>,
    /// The effort of the path, in the unit of the search's effort.
    pub effort: f64,
}

impl ReliablePathRecord {
    /// A row for each path.
    pub fn rows(paths: &[ReliablePath]) -> Vec<Self> {
        let row =
            |path: &ReliablePath| Self { hops: path.cost.hops(), estimated_success: path.success, effort: path.cost.effort() };
        paths.iter().map(row).collect()
    }
}

/// The rows as text; empty without rows. `hops`: those of the path that was chosen.
pub fn reliable_paths_text(rows: &[ReliablePathRecord], hops: Option<u64>) -> String {
    let mut sheet = Sheet::default();
    if !rows.is_empty() {
        sheet.line(format_args!("\nmost reliable path by hops\n{:>6}{:>20}{:>12}", "hops", "estimated success", "effort"));
    }
    for row in rows {
        let estimate = row.estimated_success.map_or("-".to_owned(), |share| format!("{share:.4}"));
        let chosen = if hops == Some(row.hops) { "  <- chosen" } else { "" };
        sheet.line(format_args!("{:>6}{estimate:>20}{:>12.4}{chosen}", row.hops, row.effort));
    }
    let flown = rows.iter().filter(|row| row.estimated_success.is_some()).count();
    if flown > 0 && flown < rows.len() {
        sheet.line(format_args!(
            "{flown} of {} paths were flown in trials: one with fewer hops may be as reliable as the one chosen",
            rows.len()
        ));
    }
    sheet.into_text()
}
