//! What every node has still to go to the goal.

use std::{cmp::Reverse, collections::BinaryHeap};

use super::{Cost, Edge, Effort, HopGraph, Leg, NodeSet, SearchOptions};
use crate::{
    ballistics::{Arc, HopTest, LineOfSight},
    chain::Station,
    quantity::NodeId,
};

/// The cost of the cheapest way from every node to the goal, computed once: what a robot needs that finds itself elsewhere than planned.
///
/// A hop from anywhere to any node, and that node's cost-to-go, is a whole journey; the best of them is the best plan from there whose
/// landings after the first are nodes.
#[derive(Clone, Debug)]
pub struct CostToGo {
    nodes: NodeSet,
    options: SearchOptions,
    costs: Vec<Option<Cost>>,
    /// The nodes from which the goal is reached, the cheapest first.
    in_order: Vec<NodeId>,
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
        let mut in_order: Vec<NodeId> = (0..costs.len()).map(NodeId).filter(|node| costs[node.index()].is_some()).collect();
        in_order.sort_by_key(|node| (costs[node.index()], *node));
        Self { nodes, options: options.clone(), costs, in_order }
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

    /// The nodes from which the goal is reached, those with the least to go first.
    pub fn in_order(&self) -> &[NodeId] {
        &self.in_order
    }

    /// No hop over this line of sight costs less.
    #[inline]
    pub fn least_cost(&self, sight: LineOfSight, gravity_m_s2: f64) -> Cost {
        let fastest = Arc::new(sight, sight.stretch(), gravity_m_s2);
        match self.options.effort {
            Effort::TakeoffSpeed | Effort::Energy | Effort::PeakSpeed => self.options.effort.cost(&fastest, 1),
            // A flat and fast arc takes less time than any bound worth computing.
            Effort::Time => Cost::of_hops(1),
        }
    }

    /// The best way on from any station of the chain, which need not be a node: the first leg, and what the whole journey then costs.
    /// `None` where no node that leads to the goal is in reach.
    ///
    /// Of two that cost the same the one to the node with the smaller x.
    ///
    /// # Complexity
    /// A hop test for each node in reach that could still be better than the best known.
    pub fn best_leg(&self, test: &HopTest<'_>, from: &Station) -> Option<(Leg, Cost)> {
        let counted = (self.options.effort, self.options.takeoff, self.options.split);
        let stations = self.nodes.stations();
        let mut best: Option<(Leg, Cost)> = None;
        for node in self.nodes.around(from, test.reach_bound_m(from)) {
            let landing = &stations[node];
            let (Some(to_go), Some(sight)) = (self.costs[node], test.line_of_sight(from, landing)) else { continue };
            let too_dear = |cost: Cost| best.as_ref().is_some_and(|(_, known)| cost >= *known);
            if too_dear(Cost::of_hops(1) + to_go) || too_dear(self.least_cost(sight, test.gravity_m_s2()) + to_go) {
                continue;
            }
            let Ok(edge) = Edge::between(test, from, landing) else { continue };
            let cost = edge.cost(test, from, landing, counted) + to_go;
            if !too_dear(cost) {
                best = Some((Leg { takeoff: *from, landing: *landing, edge }, cost));
            }
        }
        best
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
