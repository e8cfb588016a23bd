//! Which nodes a choice of reliable paths looks at.

use super::{NodeSet, ReliabilityOptions, RiskModel, SearchOptions, reliability::ten_nodes_a_hop_m};
use crate::hop::HopTest;

/// Start, goal, and of the other nodes those that are no nearer than this to the one before.
///
/// A chain that was sliced from a DEM has a vertex at every edge of a triangle that it crosses, and every vertex is a node: some forty of them
/// where ten decide how reliably a hop over level ground can be flown. Edges grow with the square of that. Where the spacing of nodes is
/// given, or only paths with the fewest hops are wanted, all nodes are kept.
pub(super) fn kept_nodes(test: &HopTest, nodes: &NodeSet, options: &SearchOptions, reliability: &ReliabilityOptions) -> Vec<bool> {
    let is_flown = matches!(reliability.model, RiskModel::Flown { .. });
    let is_free = options.spacing.is_none() && reliability.extra_hops_max != Some(0);
    let stations = nodes.stations();
    let Some(spacing_m) = ten_nodes_a_hop_m(test).filter(|_| is_flown && is_free) else { return vec![true; stations.len()] };
    // Half the spacing: of vertices that are not evenly spaced, a hop over level ground still meets ten to twenty.
    let apart_m = 0.5 * spacing_m;
    let mut last_m = f64::NEG_INFINITY;
    let mut kept: Vec<bool> = stations
        .iter()
        .map(|station| {
            let is_kept = station.point.x_m - last_m >= apart_m;
            if is_kept {
                last_m = station.point.x_m;
            }
            is_kept
        })
        .collect();
    for end in [nodes.start(), nodes.goal()] {
        kept[end.index()] = true;
    }
    kept
}
