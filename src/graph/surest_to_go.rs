//! Where to go on from every node, the surest way first.

use rayon::prelude::*;

use super::{
    Cost, HopGraph, SearchOptions, SuretyOptions,
    surest::{edge_weight, steps_from},
};
use crate::quantity::NodeId;

/// How many ways on are kept for each node. A robot beside the node takes the first that is feasible from where it really is; if none
/// of so many is, none of the rest is likely to be surer than any hop that leads on.
const KEPT: usize = 32;

/// Of every node the nodes to hop to, those first that make the rest of the journey surest within the hops allowed.
#[derive(Clone, Debug)]
pub(super) struct SurestToGo {
    /// Of every node, at most [`KEPT`].
    ways_on: Vec<Vec<NodeId>>,
    /// Of every node the weight of the surest way to the goal, `-ln` of its estimated success; infinite where there is none.
    #[cfg(test)]
    weights: Vec<f64>,
}

/// An edge that is of use: its target, its hops, its weight.
#[derive(Clone, Copy)]
struct WayOn {
    target: usize,
    hops: u64,
    weight: f64,
}

impl SurestToGo {
    /// From the least costs of all nodes: with `W_k(u)` the least weight from `u` with at most `k` hops,
    ///
    /// ```text
    ///     W_k(u) = min over edges (u, v) of n hops of  w(u, v) + W_(k - n)(v),   W_k(goal) = 0
    /// ```
    ///
    /// from `k = 0` on (Bellman 1958), for the `k` from the fewest hops of a node to as many more as surety allows.
    ///
    /// # Complexity
    /// With E edges that the hops allowed leave of use: E hop tests and risk estimates, `E (1 + extra)` additions.
    pub(super) fn of(graph: &HopGraph<'_>, costs: &[Option<Cost>], options: &SearchOptions, surety: &SuretyOptions) -> Self {
        let extra = u64::from(surety.extra_hops_max);
        let fewest = |node: usize| costs[node].map(Cost::hops);
        let goal = graph.nodes().goal().index();
        let ways = |node: usize| -> Vec<WayOn> {
            let Some(own) = fewest(node).filter(|_| node != goal) else { return Vec::new() };
            let of_use = |step: &super::surest::Step| fewest(step.target).is_some_and(|rest| step.hops + rest <= own + extra);
            let weighed = |step: super::surest::Step| {
                let weight = edge_weight(graph, (node, step.target), options, surety);
                WayOn { target: step.target, hops: step.hops, weight }
            };
            steps_from(graph, node).into_iter().filter(of_use).map(weighed).collect()
        };
        let ways: Vec<Vec<WayOn>> = (0..costs.len()).into_par_iter().map(ways).collect();
        let mut table = Table::new(costs, extra);
        for allowed in 0..=table.most_hops {
            for node in (0..costs.len()).filter(|&node| node != goal) {
                let Some(place) = table.place(node, allowed) else { continue };
                let least = ways[node].iter().map(|way| table.onward(way, allowed)).fold(f64::INFINITY, f64::min);
                table.weights[place] = least;
            }
        }
        let ranked = |node: usize| -> Vec<NodeId> {
            let Some(own) = fewest(node) else { return Vec::new() };
            let allowed = own + extra;
            let mut onward: Vec<(f64, u64, usize)> = ways[node]
                .iter()
                .map(|way| (table.onward(way, allowed), way, allowed.saturating_sub(way.hops)))
                .filter(|&(weight, ..)| weight < f64::INFINITY)
                .map(|(weight, way, rest)| (weight, way.hops + table.hops_of_use(way.target, rest), way.target))
                .collect();
            // Of equally sure ways that of fewest hops: where no hop risks anything, each brings the goal nearer for all that.
            onward.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            onward.into_iter().take(KEPT).map(|way| NodeId(way.2)).collect()
        };
        Self {
            ways_on: (0..costs.len()).map(ranked).collect(),
            #[cfg(test)]
            weights: (0..costs.len()).map(|node| fewest(node).map_or(f64::INFINITY, |own| table.at(node, own + extra))).collect(),
        }
    }

    /// The nodes to hop to from a node, the surest way first; none from the goal and where no way leads there.
    pub(super) fn ways_on(&self, node: NodeId) -> &[NodeId] {
        &self.ways_on[node.index()]
    }
}

/// The least weights by node and hops allowed.
struct Table<'a> {
    costs: &'a [Option<Cost>],
    extra: u64,
    /// Hops that no node needs more than.
    most_hops: u64,
    /// Of every node, with its fewest hops allowed, one more, and so on.
    weights: Vec<f64>,
}

impl<'a> Table<'a> {
    /// Nothing but the goal reaches the goal.
    fn new(costs: &'a [Option<Cost>], extra: u64) -> Self {
        let most_hops = costs.iter().flatten().map(|cost| cost.hops()).max().unwrap_or(0) + extra;
        let mut weights = vec![f64::INFINITY; costs.len() * weights_each(extra)];
        for (node, own) in weights.chunks_exact_mut(weights_each(extra)).enumerate() {
            if costs[node].is_some_and(|cost| cost.hops() == 0) {
                own.fill(0.0);
            }
        }
        Self { costs, extra, most_hops, weights }
    }

    /// Where the weight of a node with so many hops allowed stands; `None` where it has no way of so few, or more than enough.
    fn place(&self, node: usize, allowed: u64) -> Option<usize> {
        let more = allowed.checked_sub(self.costs[node]?.hops()).filter(|&more| more <= self.extra)?;
        #[expect(clippy::cast_possible_truncation, reason = "a few hops more")]
        Some(node * weights_each(self.extra) + more as usize)
    }

    /// The least weight of a node with so many hops allowed.
    fn at(&self, node: usize, allowed: u64) -> f64 {
        self.place(node, allowed).map_or(f64::INFINITY, |place| self.weights[place])
    }

    /// The fewest hops of the surest way from a node with so many allowed.
    fn hops_of_use(&self, node: usize, allowed: u64) -> u64 {
        let weight = self.at(node, allowed);
        let fewer = (0..=allowed).rev().take_while(|&hops| self.place(node, hops).is_some() && self.at(node, hops) == weight);
        fewer.last().unwrap_or(allowed)
    }

    /// The least weight of a journey that goes on by an edge, with so many hops allowed in all.
    fn onward(&self, way: &WayOn, allowed: u64) -> f64 {
        allowed.checked_sub(way.hops).map_or(f64::INFINITY, |rest| way.weight + self.at(way.target, rest))
    }
}

/// Weights kept for each node.
#[expect(clippy::cast_possible_truncation, reason = "a few hops more")]
const fn weights_each(extra: u64) -> usize {
    extra as usize + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::{ConstrainedChain, PolygonalChain},
        graph::{CostToGo, NodeSet, PointSpacing, surest_paths},
        hop::{HopDeviations, HopTest, RiskModel},
        quantity::{Angle, ChainPoint},
        world::{FrictionCone, Grip, Hopper, RestSlope, Surface},
    };

    const SPACING: PointSpacing = PointSpacing::PerSegment(1);

    fn rough_chain() -> (ConstrainedChain, Hopper) {
        let points = (0..40).map(|i| ChainPoint::new(f64::from(i), 0.3 * f64::from(i * i % 7) - 0.02 * f64::from(i))).collect();
        let hopper = Hopper { clearance_m: 0.05, ..Hopper::with_speeds(5.0, 5.0) };
        let grip = Some(Grip::Friction(FrictionCone::new(1.1).unwrap()));
        let surface = Surface { grip, rest: RestSlope::Unlimited };
        (ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper, &surface).unwrap(), hopper)
    }

    fn models() -> [RiskModel; 2] {
        let angle = Angle::from_degrees(0.5);
        let deviations =
            HopDeviations { takeoff_speed_fraction: 0.01, takeoff_angle: angle, place_m: 0.05, ..HopDeviations::default() };
        [RiskModel::Deviations(deviations), RiskModel::Slack]
    }

    /// The other road: the surest path from each start, forwards.
    #[test]
    fn every_node_has_to_go_what_the_surest_path_from_it_risks() {
        let (chain, hopper) = rough_chain();
        let test = HopTest::new(&chain, &hopper, 1.6);
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        let (mut compared, mut bought) = (0, 0);
        for model in models() {
            for start_m in [2.5, 9.0, 21.5, 38.0] {
                let options = SearchOptions { spacing: Some(SPACING), ..SearchOptions::default() };
                let nodes = NodeSet::new(&chain, station(start_m), station(34.0), SPACING).unwrap();
                let mut with_fewer = f64::INFINITY;
                for extra_hops_max in 0..=3 {
                    let surety = SuretyOptions { model, extra_hops_max, goal_tolerance_m: Some(0.5) };
                    let to_go = CostToGo::of(&test, nodes.clone(), &options);
                    let costs: Vec<_> = (0..nodes.stations().len()).map(|node| to_go.of_node(NodeId(node))).collect();
                    let graph = HopGraph::new(&test, &nodes, options.effort, options.takeoff, options.split);
                    let surest = SurestToGo::of(&graph, &costs, &options, &surety);
                    let path = surest_paths(&test, &nodes, &options, &surety).pop().expect("a path");
                    let weight = surest.weights[nodes.start().index()];
                    assert!(
                        (libm::exp(-weight) - path.success).abs() <= 1e-12 * path.success,
                        "{start_m} m, {extra_hops_max}: {weight}"
                    );
                    bought += u32::from(weight < with_fewer && extra_hops_max > 0);
                    with_fewer = weight;
                    compared += 1;
                }
            }
        }
        assert_eq!(compared, 32);
        assert!(bought > 4, "hops bought surety {bought} times");
    }

    #[test]
    fn the_first_ways_on_lead_from_every_node_to_the_goal() {
        let (chain, hopper) = rough_chain();
        let test = HopTest::new(&chain, &hopper, 1.6);
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        for model in models() {
            for extra_hops_max in [0, 2] {
                let surety = SuretyOptions { model, extra_hops_max, goal_tolerance_m: None };
                let nodes = NodeSet::new(&chain, station(2.0), station(34.0), SPACING).unwrap();
                let (count, goal) = (nodes.stations().len(), nodes.goal());
                let options = SearchOptions { spacing: Some(SPACING), ..SearchOptions::default() };
                let to_go = CostToGo::surely(&test, nodes, &options, &surety);
                let mut arrived = 0;
                for start in (0..count).map(NodeId) {
                    assert_eq!(
                        to_go.surest_ways_on(start).is_empty(),
                        start == goal || to_go.of_node(start).is_none(),
                        "{start:?}"
                    );
                    let ways = std::iter::successors(Some(start), |node| to_go.surest_ways_on(*node).first().copied());
                    let last = ways.take(count + 1).last();
                    if to_go.of_node(start).is_some() {
                        assert_eq!(last, Some(goal), "from {start:?} in circles");
                        arrived += 1;
                    }
                }
                assert!(arrived > 30, "{arrived} nodes lead to the goal");
            }
        }
    }

    #[test]
    fn the_nearest_node_is_the_nearest_of_all() {
        let (chain, hopper) = rough_chain();
        let test = HopTest::new(&chain, &hopper, 1.6);
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        let nodes = NodeSet::new(&chain, station(2.3), station(34.0), SPACING).unwrap();
        let to_go = CostToGo::of(&test, nodes, &SearchOptions::default());
        for i in -10..420 {
            let x_m = 0.1 * f64::from(i);
            let away_m = |node: NodeId| (to_go.nodes().station(node).point.x_m - x_m).abs();
            let least = (0..to_go.nodes().stations().len()).map(|node| away_m(NodeId(node))).fold(f64::INFINITY, f64::min);
            assert_eq!(away_m(to_go.nearest_node(x_m)), least, "at {x_m} m");
        }
    }
}
