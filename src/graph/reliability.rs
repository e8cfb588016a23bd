//! The most reliable path problem, and the Pareto front of hops against success probability.

use std::collections::BTreeMap;

use super::{Cost, Edge, HopGraph, Leg, NodeSet, Outcome, SearchError, SearchOptions, search};
use crate::{
    ballistics::{Arc, TakeoffChoice},
    chain::Station,
    hop::{HopTest, PlannedHop, RiskModel, SegmentHops, Split},
    progress::{Cancelled, Detail, Meter, PairCounter, Progress, Stage},
    quantity::NodeId,
    world::Direction,
};

/// How reliability is weighed in the choice of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ReliabilityUse {
    /// Reliability is not considered.
    #[default]
    Ignored,
    /// The most reliable of the paths with the fewest hops.
    FewestHops,
    /// The most reliable path with a limited number of hops more than the fewest.
    Traded,
}

impl ReliabilityUse {
    /// All variants.
    pub const ALL: [Self; 3] = [Self::Ignored, Self::FewestHops, Self::Traded];

    /// The name in scenarios.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ignored => "ignored",
            Self::FewestHops => "fewest-hops",
            Self::Traded => "traded",
        }
    }
}

crate::quantity::by_name!(ReliabilityUse, ReliabilityUse::ALL);

/// How reliability is estimated and weighed in the choice of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliabilityOptions {
    /// The source of a hop's estimated probability to fail.
    pub model: RiskModel,
    /// How many hops more than the fewest a more reliable path may take; 0: the most reliable of the paths with the fewest
    /// hops.
    pub extra_hops_max: u32,
    /// Allowed distance of the last landing from the goal, m.
    pub goal_tolerance_m: Option<f64>,
}

/// The most reliable path with its number of hops, more reliable than every path with fewer hops.
#[derive(Clone, Debug, PartialEq)]
pub struct ReliablePath {
    /// The edges from start to goal.
    pub legs: Vec<Leg>,
    /// The number of hops, and the effort.
    pub cost: Cost,
    /// The estimated probability that all hops succeed: the product over them.
    pub success: f64,
}

/// For the fewest hops, and for each extra hop allowed, the most reliable path, kept only if it beats all shorter ones (the
/// Pareto front of hops against success probability). Empty if there is no path over the nodes.
///
/// A hop has the weight `-ln(1 - p)`, so the sum of weights is `-ln` of the success probability of the path. Paths of least
/// weight for each number of hops are found layer by layer (Bellman 1958, restricted to nodes from which the goal is still
/// within the hop budget). Ties go to the path whose nodes come first.
///
/// # Errors
/// [`SearchError`]: invalid deviations, or cancelled.
///
/// # Complexity
/// With E edges within reach of the budget: E hop tests and E risk estimates, `E (1 + extra)` additions; 12 bytes for each edge.
pub fn most_reliable_paths(
    test: &HopTest,
    nodes: &NodeSet,
    options: &SearchOptions,
    reliability: &ReliabilityOptions,
    progress: &dyn Progress,
) -> Result<Vec<ReliablePath>, SearchError> {
    reliability.model.check()?;
    let meter = Meter::new(progress, Stage::Reliability);
    meter.report(Detail::None)?;
    let mut counter = meter.counter();
    let graph = HopGraph::new(test, nodes, options.effort, options.takeoff, options.split);
    let extra = u64::from(reliability.extra_hops_max);
    let Some(lattice) = Lattice::within(&graph, extra, &mut counter)? else { return Ok(Vec::new()) };
    let labels = lattice.labelled(&graph, options, reliability, &mut counter)?;
    let mut least = f64::INFINITY;
    let mut paths = Vec::new();
    for (&hops, layer) in &labels {
        let Some(label) = layer.get(&nodes.goal().index()).filter(|label| label.weight < least) else { continue };
        least = label.weight;
        paths.extend(path_to_goal(&graph, &labels, hops, label.weight));
    }
    Ok(paths)
}

/// Finds a path as [`search`] does, then replaces it by the most reliable path over the same nodes within the hop budget.
///
/// # Errors
/// [`SearchError`].
pub fn search_most_reliable(
    test: &HopTest,
    start: Station,
    goal: Station,
    options: &SearchOptions,
    reliability: &ReliabilityOptions,
    progress: &dyn Progress,
) -> Result<(super::Answer, Vec<ReliablePath>), SearchError> {
    reliability.model.check()?;
    let mut answer = search(test, start, goal, options, progress)?;
    let mut paths = Vec::new();
    if let Outcome::Path { legs, cost } = &mut answer.outcome
        && !legs.is_empty()
    {
        let nodes = NodeSet::new(test.chain(), start, goal, answer.spacing)?;
        paths = most_reliable_paths(test, &nodes, options, reliability, progress)?;
        if let Some(best) = paths.last() {
            legs.clone_from(&best.legs);
            *cost = best.cost;
        }
    }
    Ok((answer, paths))
}

/// An edge to a node, with its number of hops.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub(super) target: usize,
    pub(super) hops: u64,
}

/// All edges on paths within the hop budget.
struct Lattice {
    steps: Vec<Vec<Step>>,
    /// The least number of hops from each node to the goal.
    to_goal: Vec<u64>,
    /// The most hops allowed.
    budget: u64,
}

/// The most reliable path to a node with some number of hops.
#[derive(Clone, Copy)]
struct Label {
    weight: f64,
    from: Option<(u64, usize)>,
}

/// Labels by number of hops, then by node: sparse, since for a given number of hops only few nodes have a label.
type Labels = BTreeMap<u64, BTreeMap<usize, Label>>;

impl Lattice {
    /// The edges out of every node within the budget, breadth first by hops; `None` if the goal is not reached.
    fn within(graph: &HopGraph, extra: u64, counter: &mut PairCounter<'_>) -> Result<Option<Self>, Cancelled> {
        let nodes = graph.nodes();
        let count = nodes.stations().len();
        let (start, goal) = (nodes.start().index(), nodes.goal().index());
        let mut steps: Vec<Vec<Step>> = vec![Vec::new(); count];
        let mut from_start = vec![u64::MAX; count];
        let mut budget = u64::MAX;
        let mut waiting = BTreeMap::from([(0, vec![start])]);
        from_start[start] = 0;
        while let Some((hops, mut layer)) = waiting.pop_first() {
            if hops >= budget {
                break;
            }
            layer.sort_unstable();
            layer.dedup();
            for node in layer.into_iter().filter(|&node| node != goal) {
                if from_start[node] < hops {
                    continue;
                }
                steps[node] = steps_from(graph, node, counter)?;
                for step in &steps[node] {
                    let reached = hops + step.hops;
                    if reached < from_start[step.target] {
                        from_start[step.target] = reached;
                        waiting.entry(reached).or_insert_with(Vec::new).push(step.target);
                    }
                }
                if from_start[goal] != u64::MAX {
                    budget = from_start[goal].saturating_add(extra);
                }
            }
        }
        Ok((from_start[goal] != u64::MAX).then(|| Self { to_goal: hops_to(goal, &steps), steps, budget }))
    }

    /// All labels from which the goal is still within the budget.
    fn labelled(
        &self,
        graph: &HopGraph,
        options: &SearchOptions,
        reliability: &ReliabilityOptions,
        counter: &mut PairCounter<'_>,
    ) -> Result<Labels, Cancelled> {
        let nodes = graph.nodes();
        let start = nodes.start().index();
        let mut weights: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        let mut least = vec![f64::INFINITY; self.steps.len()];
        let mut labels: Labels = BTreeMap::from([(0, BTreeMap::from([(start, Label { weight: 0.0, from: None })]))]);
        let mut hops = 0;
        loop {
            let layer: Vec<(usize, Label)> = labels[&hops].iter().map(|(&node, &label)| (node, label)).collect();
            for (node, label) in layer {
                // The node was reached with fewer hops and at least the same reliability.
                if label.weight >= least[node] {
                    continue;
                }
                least[node] = label.weight;
                for step in &self.steps[node] {
                    let reached = hops + step.hops;
                    if reached.saturating_add(self.to_goal[step.target]) > self.budget {
                        continue;
                    }
                    counter.pair()?;
                    let weight = label.weight
                        + *weights
                            .entry((node, step.target))
                            .or_insert_with(|| edge_weight(graph, (node, step.target), options, reliability));
                    let layer = labels.entry(reached).or_default();
                    if layer.get(&step.target).is_none_or(|known| weight < known.weight) {
                        layer.insert(step.target, Label { weight, from: Some((hops, node)) });
                    }
                }
            }
            match labels.range(hops + 1..).next() {
                Some((&next, _)) => hops = next,
                None => return Ok(labels),
            }
        }
    }
}

/// The edges out of one node.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn steps_from(graph: &HopGraph, node: usize, counter: &mut PairCounter<'_>) -> Result<Vec<Step>, Cancelled> {
    let nodes = graph.nodes();
    let takeoff = nodes.station(NodeId(node));
    let mut steps = Vec::new();
    for target in graph.landings(takeoff).filter(|&target| target != node) {
        counter.pair()?;
        if let Ok(edge) = graph.edge(takeoff, nodes.station(NodeId(target))) {
            steps.push(Step { target, hops: edge.hops() });
        }
    }
    Ok(steps)
}

/// The least number of hops from every node to the goal, against the direction of the edges.
fn hops_to(goal: usize, steps: &[Vec<Step>]) -> Vec<u64> {
    let mut against: Vec<Vec<Step>> = vec![Vec::new(); steps.len()];
    for (node, steps) in steps.iter().enumerate() {
        for step in steps {
            against[step.target].push(Step { target: node, hops: step.hops });
        }
    }
    let mut least = vec![u64::MAX; steps.len()];
    least[goal] = 0;
    let mut waiting = BTreeMap::from([(0, vec![goal])]);
    while let Some((hops, layer)) = waiting.pop_first() {
        for node in layer {
            if least[node] < hops {
                continue;
            }
            for step in &against[node] {
                let reached = hops + step.hops;
                if reached < least[step.target] {
                    least[step.target] = reached;
                    waiting.entry(reached).or_insert_with(Vec::new).push(step.target);
                }
            }
        }
    }
    least
}

/// The weight of an edge: the sum over its hops.
pub(super) fn edge_weight(
    graph: &HopGraph,
    (from, to): (usize, usize),
    options: &SearchOptions,
    reliability: &ReliabilityOptions,
) -> f64 {
    let (test, nodes) = (graph.test(), graph.nodes());
    let (takeoff, landing) = (*nodes.station(NodeId(from)), *nodes.station(NodeId(to)));
    let tolerance_m = reliability.goal_tolerance_m.filter(|_| nodes.goal() == NodeId(to));
    match graph.edge(&takeoff, &landing) {
        Ok(Edge::Hop(lofts)) => test.line_of_sight(&takeoff, &landing).map_or(0.0, |sight| {
            let arc = Arc::new(sight, test.loft(options.takeoff, sight, lofts), test.gravity_m_s2());
            reliability.model.weight(test, &PlannedHop { takeoff, landing, arc, lofts, tolerance_m })
        }),
        Ok(Edge::Along(along)) => {
            along_weight(test, (takeoff, landing), &along, (options.takeoff, options.split), reliability, tolerance_m)
        }
        // The pair was an edge when the lattice was built.
        Err(_) => f64::INFINITY,
    }
}

/// The weight of many hops along one segment. The hops near its ends are evaluated one by one, since their scatter includes
/// other ground; the hops between have the weight of the last of these.
#[expect(clippy::cast_precision_loss, reason = "at most 2^53 hops")]
fn along_weight(
    test: &HopTest,
    (takeoff, landing): (Station, Station),
    along: &SegmentHops,
    (choice, split): (TakeoffChoice, Split),
    reliability: &ReliabilityOptions,
    tolerance_m: Option<f64>,
) -> f64 {
    const BESIDE_AN_END: u64 = 16;
    let Some(direction) = Direction::between(takeoff.point.x_m, landing.point.x_m) else { return 0.0 };
    let (each_m, last_m) = along.lengths_m(split);
    let geometry = test.chain().geometry();
    let place = |i: u64| match i {
        0 => Some(takeoff),
        i if i == along.hops() => Some(landing),
        i => geometry.station(takeoff.point.x_m + direction.sign() * each_m * i as f64).ok(),
    };
    let weight = |i: u64| {
        let (Some(from), Some(to)) = (place(i), place(i + 1)) else { return 0.0 };
        let length_m = if i + 1 == along.hops() { last_m } else { each_m };
        let arc = along.arc(test, length_m, choice);
        let tolerance_m = tolerance_m.filter(|_| i + 1 == along.hops());
        let hop = PlannedHop { takeoff: from, landing: to, arc, lofts: along.lofts(test, length_m), tolerance_m };
        reliability.model.weight(test, &hop)
    };
    if along.hops() <= 2 * BESIDE_AN_END {
        return (0..along.hops()).map(weight).sum();
    }
    let between = along.hops() - 2 * BESIDE_AN_END;
    let (first, last) = (0..BESIDE_AN_END, along.hops() - BESIDE_AN_END..along.hops());
    first.chain(last).map(weight).sum::<f64>() + weight(BESIDE_AN_END) * between as f64
}

/// The path to the goal that ends with a label.
fn path_to_goal(graph: &HopGraph, labels: &Labels, hops: u64, weight: f64) -> Option<ReliablePath> {
    let nodes = graph.nodes();
    let mut at = (hops, nodes.goal().index());
    let (mut legs, mut cost) = (Vec::new(), Cost::default());
    while let Some(from) = labels.get(&at.0)?.get(&at.1)?.from {
        let (takeoff, landing) = (*nodes.station(NodeId(from.1)), *nodes.station(NodeId(at.1)));
        let edge = graph.edge(&takeoff, &landing).ok()?;
        cost = cost + graph.cost(&takeoff, &landing, edge);
        legs.push(Leg { takeoff, landing, edge });
        at = from;
    }
    legs.reverse();
    Some(ReliablePath { legs, cost, success: libm::exp(-weight) })
}
