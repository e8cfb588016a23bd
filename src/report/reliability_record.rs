//! The Pareto front of hops against success probability, as rows.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::Sheet;
use crate::graph::ReliablePath;

/// The most reliable path of one hop count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReliablePathRecord {
    /// The number of hops.
    pub hops: u64,
    /// The share of 512 fixed trials that reach the goal; null without errors to fly.
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

/// The rows as text; empty without rows.
pub fn reliable_paths_text(rows: &[ReliablePathRecord]) -> String {
    let mut sheet = Sheet::default();
    if !rows.is_empty() {
        sheet.line(format_args!(
            "\nmost reliable path by hops (the last is the one above)\n{:>6}{:>20}{:>12}",
            "hops", "estimated success", "effort"
        ));
    }
    for row in rows {
        let estimate = row.estimated_success.map_or("-".to_owned(), |share| format!("{share:.4}"));
        sheet.line(format_args!("{:>6}{estimate:>20}{:>12.4}", row.hops, row.effort));
    }
    sheet.into_text()
}
