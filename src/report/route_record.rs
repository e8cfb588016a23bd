//! How a free route was searched, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::format_number;

/// How a route over a DEM was searched, in any direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RouteRecord {
    /// `free`.
    pub kind: RouteKind,
    /// Nodes of the lattice for each post spacing.
    pub nodes_per_post: usize,
    /// The distance of neighbouring nodes of the lattice in a row or a column, m; the greater of both.
    pub node_spacing_m: f64,
    /// The labels of the nodes, bytes.
    pub search_bytes: u64,
    /// Nodes reached before the search ended, the start included.
    pub reached_nodes: usize,
    /// The reached place nearest to the goal, [easting, northing, height], m.
    pub nearest_m: [f64; 3],
}

/// The nodes of free routes over which all values of a varied key are answered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuestionRouteRecord {
    /// `free`.
    pub kind: RouteKind,
    /// Nodes of the lattice for each post spacing.
    pub nodes_per_post: usize,
    /// The distance of neighbouring nodes of the lattice in a row or a column, m; the greater of both.
    pub node_spacing_m: f64,
    /// How far a hop goes over level ground at most, by the speeds, at the value with the shortest hops, for which the nodes were chosen, m;
    /// null where the scenario gives their spacing.
    pub shortest_level_hop_m: Option<f64>,
}

impl QuestionRouteRecord {
    /// The nodes in words.
    pub(super) fn sentence(&self) -> String {
        let Self { kind: _, nodes_per_post, node_spacing_m, shortest_level_hop_m } = self;
        let chosen = shortest_level_hop_m
            .map(|hop_m| format!(", chosen for the value with the shortest hops, {} m over level ground", format_number(hop_m)))
            .unwrap_or_default();
        format!(
            "free routes over the same nodes for all values: {nodes_per_post} for each post spacing, at most {} m apart{chosen}",
            format_number(*node_spacing_m)
        )
    }
}

/// The kind of a route.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RouteKind {
    /// Any way over the DEM.
    Free,
}

impl RouteKind {
    /// All kinds that are recorded.
    pub const ALL: [Self; 1] = [Self::Free];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
        }
    }
}

crate::quantity::by_name!(RouteKind, RouteKind::ALL);

impl RouteRecord {
    /// The nodes in words.
    pub(super) fn nodes(&self, nodes: usize, pairs_tested: u64) -> String {
        let Self { nodes_per_post, node_spacing_m, search_bytes, reached_nodes, .. } = self;
        format!(
            "free route: {nodes} nodes, {nodes_per_post} for each post spacing (at most {node_spacing_m} m apart) and those of the straight slice, \
             {:.1} MiB; {reached_nodes} reached, pairs of them tested: {pairs_tested}",
            mebibytes(*search_bytes)
        )
    }

    /// How near the search came, in words.
    pub(super) fn nearest(&self) -> String {
        let [x_m, y_m, _] = self.nearest_m;
        format!(
            "the reached place nearest to the goal is ({x_m:.3}, {y_m:.3}) m; more nodes may find a path: this is no proof that there is none"
        )
    }
}

#[expect(clippy::cast_precision_loss, reason = "a size for reading")]
fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / 1_048_576.0
}
