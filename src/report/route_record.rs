//! How a free route was searched, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FurtherMeans, limit_counts::LimitCounts};
use crate::quantity::format_number;

/// How a route over a DEM was searched, in any direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RouteRecord {
    /// `free`.
    pub kind: RouteKind,
    /// Nodes of the lattice for each post spacing.
    pub nodes_per_post: usize,
    /// The distance of neighbouring nodes of the lattice in a row or a column, m; the greater of both.
    pub node_spacing_m: f64,
    /// What the search keeps of every node, bytes; its labels and what waits come on top.
    pub search_bytes: u64,
    /// Nodes that the search for the best path reached, the start included; without a path all that the start reaches.
    pub reached_nodes: usize,
    /// The reached place nearest to the goal, [easting, northing, height], m.
    pub nearest_m: [f64; 3],
    /// Without a path: what lies between the places reached and those that lead to the goal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<RouteGapRecord>,
}

/// What lies between the places that the start reaches and those from which the goal can be reached, over the nodes of the search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RouteGapRecord {
    /// The place nearest to the start from which the goal can be reached, [easting, northing, height], m.
    pub leads_to_goal_from_m: [f64; 3],
    /// The number of nodes from which the goal can be reached, itself included.
    pub leads_to_goal_nodes: usize,
    /// The least horizontal distance from a reached node to one that leads to the goal, m; null if none are as near as one hop by its
    /// speeds.
    pub width_m: Option<f64>,
    /// Pairs of a reached node and one that leads to the goal, as near as one hop by its speeds.
    pub pairs: u64,
    /// How many of these pairs were judged, evenly of all.
    pub judged_pairs: u64,
    /// The number of judged pairs whose hop is refused by each limit.
    pub refusals: LimitCounts,
    /// The number of judged pairs with missing elevations between them.
    pub without_ground: u64,
    /// The scenario's keys that set these limits, those of the most refusals first: another value of one of them may close the gap.
    pub keys: Vec<String>,
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

    /// How near the search came, and what refuses to go on, a sentence a line.
    pub(super) fn nearest(&self, means: FurtherMeans<'_>) -> Vec<String> {
        let place = |[x_m, y_m, _]: [f64; 3]| format!("({x_m:.3}, {y_m:.3}) m");
        let mut said = vec![format!(
            "the reached place nearest to the goal is {}; more nodes may find a path: this does not prove that no path exists",
            place(self.nearest_m)
        )];
        let Some(gap) = &self.gap else { return said };
        said.extend(gap.of_ends(self.reached_nodes));
        said.extend(gap.sentences(means));
        said
    }
}

impl RouteGapRecord {
    /// How many nodes lead to the goal, and what is said if none does but the goal, or if the start reaches nothing.
    fn of_ends(&self, reached_nodes: usize) -> Vec<String> {
        let [x_m, y_m, _] = self.leads_to_goal_from_m;
        let mut said = vec![format!(
            "the goal can be reached from {} of these nodes, of which ({x_m:.3}, {y_m:.3}) m is nearest to the start",
            self.leads_to_goal_nodes
        )];
        said.extend(isolated_ends([reached_nodes, self.leads_to_goal_nodes], "nodes"));
        said
    }

    /// How wide it is, what refuses the hops across it, and which keys may close it, a sentence a line.
    pub(super) fn sentences(&self, means: FurtherMeans<'_>) -> Vec<String> {
        let mut said = vec![match self.width_m {
            None => "none of these is as near to a reached place as one hop by its speeds: the gap is wider than a hop".to_owned(),
            Some(width_m) => {
                let missing = (self.without_ground > 0).then(|| format!("missing elevations {}", self.without_ground));
                let by_limit = self.refusals.ranked().into_iter().map(|(limit, count)| format!("{limit} {count}"));
                let refused: Vec<String> = by_limit.chain(missing).collect();
                format!(
                    "the gap is {width_m:.3} m wide; of {} hops across it {} were judged, refused by {}",
                    self.pairs,
                    self.judged_pairs,
                    refused.join(", ")
                )
            }
        }];
        if let Some((first, others)) = self.keys.split_first() {
            let others = if others.is_empty() { String::new() } else { format!(" (or of {})", others.join(", ")) };
            said.push(format!("whether another value of {first} closes the gap is found by {} {first}{others}", means.requirement));
        }
        said
    }
}

/// Which ends no hop joins to any other place, where so many places are reached from the start and lead to the goal, themselves included.
pub(super) fn isolated_ends(reached_and_leading: [usize; 2], places: &str) -> Option<String> {
    let said = match reached_and_leading {
        [0 | 1, 0 | 1] => "no hop leads away from the start, and none to the goal",
        [0 | 1, _] => "no hop leads away from the start",
        [_, 0 | 1] => "no hop leads to the goal",
        _ => return None,
    };
    Some(format!("{said} over these {places}: see first what the ground and the limits allow there"))
}

#[expect(clippy::cast_precision_loss, reason = "a size for reading")]
fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / 1_048_576.0
}
