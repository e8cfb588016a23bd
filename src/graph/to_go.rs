//! What every node has still to go to the goal.

use std::{cmp::Reverse, collections::BinaryHeap};

use super::{Cost, HopGraph, NodeSet, SearchOptions};
use crate::{ballistics::HopTest, quantity::NodeId};

/// The cost of the cheapest way from every node to the goal, computed once: what a robot needs that finds itself elsewhere than planned.
///
/// A hop from anywhere to any node, and that node's cost-to-go, is a whole journey; the best of them is the best plan from there whose
/// landings after the first are nodes.
#[derive(Clone, Debug)]
pub struct CostToGo {
    nodes: NodeSet,
    options: SearchOptions,
    costs: Vec<Option<Cost>>,
}

impl CostToGo {
    /// Dijkstra's algorithm from the goal against the direction of the hops.
    ///
    /// `options` says how costs are counted (its spacing is that of the nodes given, and not looked at).
    ///
    /// # Complexity
    /// With V nodes, W of them in reach of each and S vertices flown past: O(V W S + V W log V) time, O(V W) heap entries at worst.
    pub fn of(test: &HopTest<'_>, nodes: NodeSet, options: &SearchOptions) -> Self {
        let graph = HopGraph::new(test, &nodes, options.effort, options.takeoff, options.split);
        let costs = settled(&graph);
        Self { nodes, options: options.clone(), costs }
    }

    /// The nodes.
    pub const fn nodes(&self) -> &NodeSet {
        &self.nodes
    }

    /// How the costs are counted.
    pub const fn options(&self) -> &SearchOptions {
        &self.options
    }

    /// What a node has still to go; nothing at the goal, `None` where no way leads there.
    ///
    /// # Panics
    /// Where there is no such node.
    #[inline]
    pub fn of_node(&self, node: NodeId) -> Option<Cost> {
        self.costs[node.index()]
    }
}

/// The least costs of all nodes.
fn settled(graph: &HopGraph<'_>) -> Vec<Option<Cost>> {
    let nodes = graph.nodes();
    let mut costs: Vec<Option<Cost>> = vec![None; nodes.stations().len()];
    let mut done = vec![false; nodes.stations().len()];
    let goal = nodes.goal();
    costs[goal.index()] = Some(Cost::default());
    let mut queue = BinaryHeap::from([Reverse((Cost::default(), goal))]);
    while let Some(Reverse((cost, node))) = queue.pop() {
        if std::mem::replace(&mut done[node.index()], true) {
            continue;
        }
        let landing = nodes.station(node);
        for from in graph.takeoffs(node) {
            if done[from] {
                continue;
            }
            let takeoff = nodes.station(NodeId(from));
            let Ok(edge) = graph.edge(takeoff, landing) else { continue };
            let total = graph.cost(takeoff, landing, edge) + cost;
            if costs[from].is_none_or(|known| total < known) {
                costs[from] = Some(total);
                queue.push(Reverse((total, NodeId(from))));
            }
        }
    }
    costs
}
