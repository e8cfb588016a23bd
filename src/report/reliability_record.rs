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
    /// The estimated probability that all of them succeed.
    pub estimated_success: f64,
    /// The effort of the path, in the unit of the search's effort.
    pub effort: f64,
}

impl ReliablePathRecord {
    /// A row for each path.
    pub fn rows(paths: &[ReliablePath]) -> Vec<Self> {
        paths
            .iter()
            .map(|path| Self { hops: path.cost.hops(), estimated_success: path.success, effort: path.cost.effort() })
            .collect()
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
        sheet.line(format_args!("{:>6}{:>20.4}{:>12.4}", row.hops, row.estimated_success, row.effort));
    }
    sheet.into_text()
}
