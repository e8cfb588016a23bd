//! How large an answer is, before it is computed, as plain data and text.

use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Upper bounds on what an answer takes, without the answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SizeAnswer {
    /// Always true: nothing was computed.
    pub dry_run: bool,
    /// Posts of the DEM.
    pub posts: u64,
    /// Nodes: the points that hops join.
    pub nodes: u64,
    /// Pairs of nodes that may be tested, at most.
    pub pairs_max: u64,
    /// Searches over all nodes, at most, where an answer takes several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub searches_max: Option<u64>,
    /// Trials flown, at most, of landing sites; absent where none are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trials_max: Option<u64>,
    /// Bytes needed, at most; the sum of `memory`.
    pub bytes_max: u64,
    /// The same by what they are for.
    pub memory: Vec<SizeRecord>,
}

/// The bytes of one part.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SizeRecord {
    /// What they are for.
    pub part: String,
    /// At most.
    pub bytes_max: u64,
}

impl SizeAnswer {
    /// From counts and parts.
    pub fn new([posts, nodes, pairs_max]: [u64; 3], memory: Vec<SizeRecord>) -> Self {
        let bytes_max = memory.iter().fold(0, |sum: u64, part| sum.saturating_add(part.bytes_max));
        Self { dry_run: true, posts, nodes, pairs_max, searches_max: None, trials_max: None, bytes_max, memory }
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let Self { posts, nodes, pairs_max, .. } = self;
        let counts = [("searches over all nodes", self.searches_max), ("trials", self.trials_max)];
        let counts: String =
            counts.iter().filter_map(|(what, most)| most.map(|most| format!("{what}: at most {most}\n"))).collect();
        let mut text = format!(
            "dry run: nothing was computed\nposts of the DEM: {posts}\nnodes: {nodes}\npairs of nodes: at most {pairs_max}\n{counts}memory: \
             at most {}\n",
            mebibytes(self.bytes_max)
        );
        for part in &self.memory {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {}: {}", part.part, mebibytes(part.bytes_max));
        }
        text
    }
}

/// Bytes in MiB for the reader, rounded up.
fn mebibytes(bytes: u64) -> String {
    let tenths = (u128::from(bytes) * 10).div_ceil(1 << 20);
    format!("{}.{} MiB", tenths / 10, tenths % 10)
}
