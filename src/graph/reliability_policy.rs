//! A reliability policy: the successors of every node, the most reliable first.

use std::sync::Arc;

use rayon::prelude::*;

use super::{Cost, HopGraph, ReliabilityOptions, SearchOptions, judge::Judge, reliability::steps_from, thinned::kept_nodes};
use crate::{
    progress::{Cancelled, Detail, Meter, PairCounter, Progress, Stage},
    quantity::NodeId,
};

/// The number of successors kept for each node. A robot near the node takes the first that is feasible from its actual
/// position; if none of these is feasible, the remaining ones are unlikely to be more reliable than any feasible hop.
const KEPT: usize = 32;

/// For every node, its successors in order of the reliability of the rest of the path within the hop budget, the most reliable
/// first.
#[derive(Clone, Debug)]
pub(super) struct ReliabilityPolicy {
    judge: Judge,
    /// The nodes that it leads over; the others have no successors.
    kept: Arc<Vec<bool>>,
    /// The edges out of every node within the hop budget that they were judged for.
    edges: Arc<Vec<Vec<Successor>>>,
    /// For every node, at most [`KEPT`] successors.
    successors: Vec<Vec<NodeId>>,
    /// For every node, the weight of the most reliable path to the goal, `-ln` of its estimated success probability; infinite
    /// without such a path.
    #[cfg(test)]
    weights: Vec<f64>,
}

/// An edge on some path within the hop budget: its target, its hops, its weight.
#[derive(Clone, Copy, Debug)]
struct Successor {
    target: usize,
    hops: u64,
    weight: f64,
}

impl ReliabilityPolicy {
    /// Computes the policy from the least costs of all nodes. Let `W_k(u)` be the least weight from `u` with at most `k`
    /// hops:
    ///
    /// ```text
    ///     W_k(u) = min over edges (u, v) of n hops of  w(u, v) + W_(k - n)(v),   W_k(goal) = 0
    /// ```
    ///
    /// for ascending `k` (Bellman 1958), from a node's fewest hops to the number that the options allow.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// With E edges on some path within the hop budget: E hop tests and risk estimates, `E (1 + extra)` additions.
    pub(super) fn of(
        graph: &HopGraph,
        costs: &[Option<Cost>],
        options: &SearchOptions,
        reliability: &ReliabilityOptions,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let meter = Meter::new(progress, Stage::Reliability);
        meter.report(Detail::None)?;
        let fewest = |node: usize| costs[node].map(Cost::hops);
        let extra = reliability.extra_hops(fewest(graph.nodes().start().index()).unwrap_or(0));
        let goal = graph.nodes().goal().index();
        let judge = Judge::new(graph.test(), options, &reliability.model, reliability.goal_tolerance_m);
        // A robot that replans takes off where it believes to be, whatever came before.
        let takeoff_m2 = judge.takeoff_m2([0.0; 2]);
        let edges = |kept: &[bool], counter: &mut PairCounter<'_>, node: usize| -> Result<Vec<Successor>, Cancelled> {
            counter.check()?;
            let Some(own) = fewest(node).filter(|_| node != goal && kept[node]) else { return Ok(Vec::new()) };
            let of_use = |step: &super::reliability::Step| fewest(step.target).is_some_and(|rest| step.hops + rest <= own + extra);
            let steps = steps_from(graph, kept, node, counter)?;
            let weighed = |step: super::reliability::Step| {
                counter.pair()?;
                let weight = judge.edge(graph, (node, step.target), takeoff_m2, f64::INFINITY).weight;
                Ok(Successor { target: step.target, hops: step.hops, weight })
            };
            steps.into_iter().filter(of_use).map(weighed).collect()
        };
        let all_edges = |kept: &[bool]| -> Result<Vec<_>, Cancelled> {
            let of_node = |counter: &mut PairCounter<'_>, node: usize| edges(kept, counter, node);
            let edges = (0..costs.len()).into_par_iter().map_init(|| meter.counter(), of_node).collect::<Result<Vec<_>, _>>();
            meter.check()?;
            edges
        };
        let start = graph.nodes().start();
        let kept = kept_nodes(graph.test(), graph.nodes(), options, reliability);
        let policy = Self::ranked(judge.clone(), (Arc::new(all_edges(&kept)?), Arc::new(kept)), (costs, goal), extra);
        let leads_nowhere = fewest(start.index()).is_some_and(|hops| hops > 0) && policy.successors(start).is_empty();
        if !leads_nowhere || !policy.kept.contains(&false) {
            return Ok(policy);
        }
        let kept = vec![true; costs.len()];
        Ok(Self::ranked(judge.clone(), (Arc::new(all_edges(&kept)?), Arc::new(kept)), (costs, goal), extra))
    }

    /// The same with fewer hops allowed beyond the fewest.
    pub(super) fn with_fewer_extra_hops(&self, costs: &[Option<Cost>], goal: usize, extra: u64) -> Self {
        Self::ranked(self.judge.clone(), (Arc::clone(&self.edges), Arc::clone(&self.kept)), (costs, goal), extra)
    }

    fn ranked(
        judge: Judge,
        (edges, kept): (Arc<Vec<Vec<Successor>>>, Arc<Vec<bool>>),
        (costs, goal): (&[Option<Cost>], usize),
        extra: u64,
    ) -> Self {
        let fewest = |node: usize| costs[node].map(Cost::hops);
        let mut table = Table::new(costs, extra);
        for allowed in 0..=table.most_hops {
            for node in (0..costs.len()).filter(|&node| node != goal) {
                let Some(place) = table.place(node, allowed) else { continue };
                let least = edges[node].iter().map(|edge| table.onward(edge, allowed)).fold(f64::INFINITY, f64::min);
                table.weights[place] = least;
            }
        }
        let ranked = |node: usize| -> Vec<NodeId> {
            let Some(own) = fewest(node) else { return Vec::new() };
            let allowed = own + extra;
            let mut onward: Vec<(f64, u64, usize)> = edges[node]
                .iter()
                .map(|edge| (table.onward(edge, allowed), edge, allowed.saturating_sub(edge.hops)))
                .filter(|&(weight, ..)| weight < f64::INFINITY)
                .map(|(weight, edge, rest)| (weight, edge.hops + table.hops_of_use(edge.target, rest), edge.target))
                .collect();
            // Of equally reliable paths the one with the fewest hops comes first, so that hops without risk lead to the goal
            // as well.
            onward.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            onward.into_iter().take(KEPT).map(|(.., target)| NodeId(target)).collect()
        };
        Self {
            successors: (0..costs.len()).map(ranked).collect(),
            #[cfg(test)]
            weights: (0..costs.len()).map(|node| fewest(node).map_or(f64::INFINITY, |own| table.at(node, own + extra))).collect(),
            judge,
            kept,
            edges,
        }
    }

    /// Whether it leads over a node.
    pub(super) fn leads_over(&self, node: NodeId) -> bool {
        self.kept[node.index()]
    }

    /// The judge of its edges.
    pub(super) const fn judge(&self) -> &Judge {
        &self.judge
    }

    /// The successors of a node, the most reliable first; empty at the goal and if the goal cannot be reached from the node.
    pub(super) fn successors(&self, node: NodeId) -> &[NodeId] {
        &self.successors[node.index()]
    }
}

/// The least weights by node and number of hops allowed.
struct Table<'a> {
    costs: &'a [Option<Cost>],
    extra: u64,
    /// The largest number of hops that any node needs.
    most_hops: u64,
    /// For every node, the weight with its fewest hops, with one more, and so on.
    weights: Vec<f64>,
}

impl<'a> Table<'a> {
    /// The initial table: only the goal itself reaches the goal.
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

    /// The index of the weight of a node for a number of hops allowed; `None` if no path is that short, or if more hops are
    /// allowed than needed.
    fn place(&self, node: usize, allowed: u64) -> Option<usize> {
        let more = allowed.checked_sub(self.costs[node]?.hops()).filter(|&more| more <= self.extra)?;
        #[expect(clippy::cast_possible_truncation, reason = "a few hops more")]
        Some(node * weights_each(self.extra) + more as usize)
    }

    /// The least weight of a node for a number of hops allowed.
    fn at(&self, node: usize, allowed: u64) -> f64 {
        self.place(node, allowed).map_or(f64::INFINITY, |place| self.weights[place])
    }

    /// The fewest hops of the most reliable path from a node for a number of hops allowed.
    fn hops_of_use(&self, node: usize, allowed: u64) -> u64 {
        let weight = self.at(node, allowed);
        let fewer = (0..=allowed).rev().take_while(|&hops| self.place(node, hops).is_some() && self.at(node, hops) == weight);
        fewer.last().unwrap_or(allowed)
    }

    /// The least weight of a path that continues with an edge, for a total number of hops allowed.
    fn onward(&self, edge: &Successor, allowed: u64) -> f64 {
        allowed.checked_sub(edge.hops).map_or(f64::INFINITY, |rest| edge.weight + self.at(edge.target, rest))
    }
}

/// Number of weights kept for each node.
#[expect(clippy::cast_possible_truncation, reason = "a few hops more")]
const fn weights_each(extra: u64) -> usize {
    extra as usize + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::{ConstrainedChain, PolygonalChain},
        flight::Uncertainty,
        graph::{CostToGo, NodeSet, PointSpacing, RiskModel, TakeoffScatter, most_reliable_paths},
        hop::HopTest,
        quantity::{Angle, ChainPoint},
        world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
    };

    const SPACING: PointSpacing = PointSpacing::PerSegment(1);

    fn rough_chain() -> ConstrainedChain {
        let points = (0..40).map(|i| ChainPoint::new(f64::from(i), 0.3 * f64::from(i * i % 7) - 0.02 * f64::from(i))).collect();
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(5.0, 5.0) }).unwrap();
        let grip = Some(Grip::Friction(FrictionCone::new(1.1).unwrap()));
        let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
        ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper, Gravity::new(1.6).unwrap(), &surface).unwrap()
    }

    fn models() -> [RiskModel; 2] {
        let errors =
            Uncertainty { takeoff_speed_sigma_fraction: 0.01, takeoff_angle_sigma: Angle::from_degrees(0.5), ..Uncertainty::NONE };
        // Without an error of position the first hop scatters as every other.
        [RiskModel::Flown { errors, takeoffs: TakeoffScatter::OfPosition, over: None, whole: None }, RiskModel::Slack]
    }

    /// Compares with the most reliable path from each start, found by forward search.
    #[test]
    fn the_policy_weighs_every_node_as_the_most_reliable_path_from_it() {
        let chain = rough_chain();
        let test = HopTest::new(chain.clone());
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        let (mut compared, mut bought) = (0, 0);
        for model in models() {
            for start_m in [2.5, 9.0, 21.5, 38.0] {
                let options = SearchOptions { spacing: Some(SPACING), ..SearchOptions::default() };
                let nodes = NodeSet::new(&chain, station(start_m), station(34.0), SPACING).unwrap();
                let mut with_fewer = f64::INFINITY;
                for extra_hops_max in (0..=3).map(Some) {
                    let reliability = ReliabilityOptions { model: model.clone(), extra_hops_max, goal_tolerance_m: Some(0.5) };
                    let to_go = CostToGo::of(&test, nodes.clone(), &options, &()).unwrap();
                    let costs: Vec<_> = (0..nodes.stations().len()).map(|node| to_go.of_node(NodeId(node))).collect();
                    let graph = HopGraph::new(&test, &nodes, options.effort, options.takeoff, options.split);
                    let policy = ReliabilityPolicy::of(&graph, &costs, &options, &reliability, &()).unwrap();
                    let path = most_reliable_paths(&test, &nodes, &options, &reliability, &()).unwrap().pop().expect("a path");
                    let weight = policy.weights[nodes.start().index()];
                    assert!((weight - path.weight).abs() <= 1e-12 * path.weight, "{start_m} m, {extra_hops_max:?}: {weight}");
                    bought += u32::from(weight < with_fewer && extra_hops_max > Some(0));
                    with_fewer = weight;
                    compared += 1;
                }
            }
        }
        assert_eq!(compared, 32);
        assert!(bought > 4, "extra hops raised the reliability only {bought} times");
    }

    #[test]
    fn the_first_successors_lead_from_every_node_to_the_goal() {
        let chain = rough_chain();
        let test = HopTest::new(chain.clone());
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        for model in models() {
            for extra_hops_max in [Some(0), Some(2)] {
                let reliability = ReliabilityOptions { model: model.clone(), extra_hops_max, goal_tolerance_m: None };
                let nodes = NodeSet::new(&chain, station(2.0), station(34.0), SPACING).unwrap();
                let (count, goal) = (nodes.stations().len(), nodes.goal());
                let options = SearchOptions { spacing: Some(SPACING), ..SearchOptions::default() };
                let to_go = CostToGo::with_reliability(&test, nodes, &options, &reliability, &()).unwrap();
                let mut arrived = 0;
                for start in (0..count).map(NodeId) {
                    assert_eq!(
                        to_go.reliable_successors(start).is_empty(),
                        start == goal || to_go.of_node(start).is_none(),
                        "{start:?}"
                    );
                    let path = std::iter::successors(Some(start), |node| to_go.reliable_successors(*node).first().copied());
                    let last = path.take(count + 1).last();
                    if to_go.of_node(start).is_some() {
                        assert_eq!(last, Some(goal), "the successors from {start:?} form a cycle");
                        arrived += 1;
                    }
                }
                assert!(arrived > 30, "only {arrived} nodes lead to the goal");
            }
        }
    }

    #[test]
    fn the_nearest_node_is_the_nearest_of_all() {
        let chain = rough_chain();
        let test = HopTest::new(chain.clone());
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        let nodes = NodeSet::new(&chain, station(2.3), station(34.0), SPACING).unwrap();
        let to_go = CostToGo::of(&test, nodes, &SearchOptions::default(), &()).unwrap();
        for i in -10..420 {
            let x_m = 0.1 * f64::from(i);
            let away_m = |node: NodeId| (to_go.nodes().station(node).point.x_m - x_m).abs();
            let least = (0..to_go.nodes().stations().len()).map(|node| away_m(NodeId(node))).fold(f64::INFINITY, f64::min);
            assert_eq!(away_m(to_go.nearest_node(x_m)), least, "at {x_m} m");
        }
    }
}
