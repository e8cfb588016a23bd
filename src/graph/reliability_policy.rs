//! The reliability policy of the nodes of a chain: the successors of every node, the most reliable first.

use std::sync::Arc;

use rayon::prelude::*;

use super::{
    Cost, HopGraph, ReliabilityOptions, SearchOptions,
    judge::Judge,
    reliability::{Step, steps_from},
    successors::{Successor, Successors},
    thinned::kept_nodes,
};
use crate::{
    progress::{Cancelled, Detail, Meter, PairCounter, Progress, Stage},
    quantity::NodeId,
};

/// For every node of a chain, its successors in order of the reliability of the rest of the path within the hop budget, and the judge of
/// the hops to them.
#[derive(Clone, Debug)]
pub(super) struct ReliabilityPolicy {
    judge: Judge,
    /// The nodes that it leads over; the others have no successors.
    kept: Arc<Vec<bool>>,
    successors: Successors,
}

impl ReliabilityPolicy {
    /// Computes the policy from the least costs of all nodes.
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
        let fewest: Vec<Option<u64>> = costs.iter().map(|cost| cost.map(Cost::hops)).collect();
        let start = graph.nodes().start();
        let extra = reliability.extra_hops(fewest[start.index()].unwrap_or(0));
        let goal = graph.nodes().goal().index();
        let judge = Judge::new(graph.test(), options, &reliability.model, reliability.goal_tolerance_m);
        // A robot that replans takes off where it believes to be, whatever came before.
        let takeoff_m2 = judge.takeoff_m2([0.0; 2]);
        let edges = |kept: &[bool], counter: &mut PairCounter<'_>, node: usize| -> Result<Vec<Successor>, Cancelled> {
            counter.check()?;
            let Some(own) = fewest[node].filter(|_| node != goal && kept[node]) else { return Ok(Vec::new()) };
            let of_use = |step: &Step| fewest[step.target].is_some_and(|rest| step.hops + rest <= own + extra);
            let steps = steps_from(graph, kept, node, counter)?;
            let weighed = |step: Step| {
                counter.pair()?;
                let weight = judge.edge(graph, (node, step.target), takeoff_m2, f64::INFINITY).weight;
                Ok(Successor { target: step.target, hops: step.hops, weight })
            };
            steps.into_iter().filter(of_use).map(weighed).collect()
        };
        let successors = |kept: &[bool]| -> Result<Successors, Cancelled> {
            let of_node = |counter: &mut PairCounter<'_>, node: usize| edges(kept, counter, node);
            let edges = (0..costs.len()).into_par_iter().map_init(|| meter.counter(), of_node).collect::<Result<Vec<_>, _>>();
            meter.check()?;
            Ok(Successors::new(edges?, fewest.clone(), extra))
        };
        let kept = kept_nodes(graph.test(), graph.nodes(), options, reliability);
        let policy = Self { judge: judge.clone(), successors: successors(&kept)?, kept: Arc::new(kept) };
        let leads_nowhere = fewest[start.index()].is_some_and(|hops| hops > 0) && policy.successors(start).is_empty();
        if !leads_nowhere || !policy.kept.contains(&false) {
            return Ok(policy);
        }
        let kept = vec![true; costs.len()];
        Ok(Self { successors: successors(&kept)?, kept: Arc::new(kept), ..policy })
    }

    /// The same with fewer hops allowed beyond the fewest.
    pub(super) fn with_fewer_extra_hops(&self, extra: u64) -> Self {
        Self { successors: self.successors.with_fewer_extra_hops(extra), ..self.clone() }
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
        self.successors.of(node)
    }

    /// The weight of the most reliable path from a node to the goal within the hop budget, `-ln` of its estimated success probability;
    /// infinite without such a path.
    #[cfg(test)]
    fn weight(&self, node: NodeId) -> f64 {
        self.successors.weight(node)
    }
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
                    let weight = policy.weight(nodes.start());
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
