//! The most reliable path problem, and the Pareto front of hops against success probability.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::{
    Cost, HopGraph, Leg, NodeSet, Outcome, PointSpacing, RiskModel, SearchError, SearchOptions,
    judge::{Judge, Judged},
    search,
    thinned::kept_nodes,
};
use crate::{
    chain::Station,
    hop::HopTest,
    progress::{Cancelled, Detail, Meter, PairCounter, Progress, Stage},
    quantity::NodeId,
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
#[derive(Clone, Debug)]
pub struct ReliabilityOptions {
    /// The source of a hop's estimated probability to fail.
    pub model: RiskModel,
    /// How many hops more than the fewest a more reliable path may take; 0: the most reliable of the paths with the fewest
    /// hops; `None`: ten, or half the fewest if that is more.
    pub extra_hops_max: Option<u32>,
    /// Allowed distance of the last landing from the goal, m.
    pub goal_tolerance_m: Option<f64>,
}

impl ReliabilityOptions {
    /// The same, with hops flown under the limits of this chain where no DEM is flown over; `None`: under those that they are planned with.
    #[must_use]
    pub fn flown_under(mut self, limits_of: Option<&HopTest>) -> Self {
        if let RiskModel::Flown { whole, .. } = &mut self.model {
            *whole = limits_of.cloned().map(Box::new);
        }
        self
    }

    /// How many hops more than the fewest a path may take.
    pub fn extra_hops(&self, fewest: u64) -> u64 {
        self.extra_hops_max.map_or_else(|| (fewest / 2).max(10), u64::from)
    }
}

/// The most reliable path with its number of hops, more reliable than every path with fewer hops.
#[derive(Clone, Debug, PartialEq)]
pub struct ReliablePath {
    /// The edges from start to goal.
    pub legs: Vec<Leg>,
    /// The number of hops, and the effort.
    pub cost: Cost,
    /// The sum of the weights of its hops: the smaller, the more reliable. It ranks paths and is no probability: errors that last a
    /// whole trial tie its hops together.
    pub weight: f64,
    /// The share of trials of the whole path that reach the goal; `None` until they are flown.
    pub success: Option<f64>,
}

/// For the fewest hops, and for each extra hop allowed, the most reliable path, kept only if it beats all shorter ones (the
/// Pareto front of hops against success probability). Empty if there is no path over the nodes.
///
/// With k of K flown draws that survive, a hop has the weight
///
/// ```text
///     -ln((k + 1/2) / (K + 1)) + 0.05 (share of the draws that fail when all errors are doubled)
/// ```
///
/// Paths of least weight for each number of hops are found layer by layer (Bellman 1958, restricted to nodes from which the goal is
/// still within the hop budget); where the errors of landings add up, every layer's hops begin with the scatter of the path before them.
/// Draws are flown only for edges that may still improve on what is known. Ties go to the path whose nodes come first.
///
/// # Errors
/// [`SearchError`]: invalid deviations, or cancelled.
///
/// # Complexity
/// With E edges within reach of the budget: E hop tests, at most `E (1 + extra)` risk estimates of 128 flights each; 64 bytes for each
/// edge.
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
    let extra = |fewest: u64| reliability.extra_hops(fewest);
    let kept = kept_nodes(test, nodes, options, reliability);
    let lattice = match Lattice::within(&graph, &kept, &extra, &mut counter)? {
        // Where no path leads over the nodes kept, all of them count.
        None if kept.contains(&false) => Lattice::within(&graph, &vec![true; kept.len()], &extra, &mut counter)?,
        found => found,
    };
    let Some(lattice) = lattice else { return Ok(Vec::new()) };
    let judge = Judge::new(test, options, &reliability.model, reliability.goal_tolerance_m);
    let labels = lattice.labelled(&graph, &judge, &mut counter)?;
    let mut least = f64::INFINITY;
    let mut paths = Vec::new();
    for (&hops, layer) in &labels {
        let Some(label) = layer.get(&nodes.goal().index()).filter(|label| label.weight < least) else { continue };
        least = label.weight;
        paths.extend(path_to_goal(&graph, &labels, hops, label.weight));
    }
    Ok(paths)
}

/// Finds a path as [`search`] does, then the most reliable paths over the same nodes within the hop budget, of which the answer has the
/// most reliable one.
///
/// Where the spacing is left to the search and errors are flown, one hop over level ground spans ten nodes: where a hop may end decides
/// how surely it is flown, and vertices alone leave little choice. If no path leads over these nodes, the nodes are those of [`search`].
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
    let spread = options.spacing.is_none() && matches!(reliability.model, RiskModel::Flown { .. });
    let over_level_ground = spread
        .then(|| ten_nodes_a_hop(test))
        .flatten()
        .map(|spacing| search(test, start, goal, &SearchOptions { spacing: Some(spacing), ..options.clone() }, progress));
    let mut answer = match over_level_ground {
        Some(Ok(answer)) if answer.hops().is_some() => answer,
        Some(Err(SearchError::Cancelled(cancelled))) => return Err(cancelled.into()),
        // Too many nodes, or no path over them.
        _ => search(test, start, goal, options, progress)?,
    };
    let mut paths = Vec::new();
    if let Outcome::Path { legs, .. } = &answer.outcome
        && !legs.is_empty()
    {
        let nodes = NodeSet::new(test.chain(), start, goal, answer.spacing)?;
        paths = most_reliable_paths(test, &nodes, options, reliability, progress)?;
        if let Some(best) = paths.last() {
            answer.follow(best);
        }
    }
    Ok((answer, paths))
}

/// The spacing with which the longest hop over level ground spans ten nodes.
fn ten_nodes_a_hop(test: &HopTest) -> Option<PointSpacing> {
    ten_nodes_a_hop_m(test).map(PointSpacing::AtMostM)
}

/// That spacing, m; `None` if no hop is limited.
pub(super) fn ten_nodes_a_hop_m(test: &HopTest) -> Option<f64> {
    let (takeoff_m_s, landing_m_s) = test.chain().speed_bounds_m_s();
    let speed_m_s = takeoff_m_s.min(landing_m_s);
    let spacing_m = speed_m_s * speed_m_s / test.gravity_m_s2() / 10.0;
    (spacing_m.is_finite() && spacing_m > 0.0).then_some(spacing_m)
}

/// Of a front, the path to fly: the fewest hops whose success is at least 0.98 of the best; where trials are not flown, the most
/// reliable one.
///
/// # Returns
/// An index; `None` of an empty front.
///
/// # Examples
/// ```
/// use chta::graph::{ReliablePath, preferred_path};
/// let path = |success| ReliablePath { legs: Vec::new(), cost: Default::default(), weight: 1.0, success };
/// assert_eq!(preferred_path(&[path(Some(0.4)), path(Some(0.95)), path(Some(0.96))]), Some(1));
/// assert_eq!(preferred_path(&[path(None), path(None)]), Some(1));
/// ```
pub fn preferred_path(front: &[ReliablePath]) -> Option<usize> {
    const ENOUGH: f64 = 0.98;
    let last = front.len().checked_sub(1)?;
    let best = front.iter().filter_map(|path| path.success).reduce(f64::max);
    let enough = |best: f64| front.iter().position(|path| path.success.is_some_and(|success| success >= ENOUGH * best));
    Some(best.and_then(enough).unwrap_or(last))
}

/// Of a front, the path to fly under a budget of success: the fewest hops whose success is at least `success_min`; without any, the one of
/// the greatest success.
///
/// # Returns
/// An index, and whether the success is enough; `None` where no path has a success.
///
/// # Examples
/// ```
/// use chta::graph::{ReliablePath, path_within_budget};
/// let path = |success| ReliablePath { legs: Vec::new(), cost: Default::default(), weight: 1.0, success };
/// let front = [path(Some(0.4)), path(Some(0.95)), path(Some(0.96))];
/// assert_eq!(path_within_budget(&front, 0.3), Some((0, true)));
/// assert_eq!(path_within_budget(&front, 0.96), Some((2, true)));
/// assert_eq!(path_within_budget(&front, 0.97), Some((2, false)));
/// assert_eq!(path_within_budget(&[path(None)], 0.0), None);
/// ```
pub fn path_within_budget(front: &[ReliablePath], success_min: f64) -> Option<(usize, bool)> {
    if let Some(enough) = front.iter().position(|path| path.success.is_some_and(|success| success >= success_min)) {
        return Some((enough, true));
    }
    let estimated = front.iter().enumerate().filter_map(|(i, path)| Some((i, path.success?)));
    let best = estimated.reduce(|best, next| if next.1 > best.1 { next } else { best })?;
    Some((best.0, false))
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
    /// The loft of its last hop, where the judge chose it.
    loft: Option<f64>,
    /// Mean square distance of the next take-off from the node, m^2.
    takeoff_m2: [f64; 2],
}

/// Labels by number of hops, then by node: sparse, since for a given number of hops only few nodes have a label.
type Labels = BTreeMap<u64, BTreeMap<usize, Label>>;

impl Lattice {
    /// The edges out of every node kept within the budget, breadth first by hops; `None` if the goal is not reached.
    fn within(
        graph: &HopGraph,
        kept: &[bool],
        extra: &dyn Fn(u64) -> u64,
        counter: &mut PairCounter<'_>,
    ) -> Result<Option<Self>, Cancelled> {
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
                steps[node] = steps_from(graph, kept, node, counter)?;
                for step in &steps[node] {
                    let reached = hops + step.hops;
                    if reached < from_start[step.target] {
                        from_start[step.target] = reached;
                        waiting.entry(reached).or_insert_with(Vec::new).push(step.target);
                    }
                }
                if from_start[goal] != u64::MAX {
                    budget = from_start[goal].saturating_add(extra(from_start[goal]));
                }
            }
        }
        Ok((from_start[goal] != u64::MAX).then(|| Self { to_goal: hops_to(goal, &steps), steps, budget }))
    }

    /// All labels from which the goal is still within the budget.
    fn labelled(&self, graph: &HopGraph, judge: &Judge, counter: &mut PairCounter<'_>) -> Result<Labels, Cancelled> {
        let nodes = graph.nodes();
        let (start, goal) = (nodes.start().index(), nodes.goal().index());
        let mut known: BTreeMap<(usize, usize), Known> = BTreeMap::new();
        let mut least = vec![f64::INFINITY; self.steps.len()];
        let first = Label { weight: 0.0, from: None, loft: None, takeoff_m2: [0.0; 2] };
        let mut labels: Labels = BTreeMap::from([(0, BTreeMap::from([(start, first)]))]);
        let mut hops = 0;
        loop {
            // A label is of no use where the node, or the goal, was reached with fewer hops and at least the same reliability.
            let layer: Vec<(usize, Label)> = labels[&hops]
                .iter()
                .filter(|&(&node, label)| label.weight < least[node] && label.weight < least[goal])
                .map(|(&node, &label)| (node, label))
                .collect();
            for (node, label) in &layer {
                least[*node] = label.weight;
            }
            let mut into: BTreeMap<(u64, usize), Vec<(usize, Label)>> = BTreeMap::new();
            for (node, label) in layer {
                for step in &self.steps[node] {
                    let reached = hops + step.hops;
                    if reached.saturating_add(self.to_goal[step.target]) <= self.budget {
                        into.entry((reached, step.target)).or_default().push((node, label));
                    }
                }
            }
            // Where the take-off does not depend on the hops before, an edge is judged once; the first hop takes off without scatter.
            let is_kept = hops > 0 && !judge.depends_on_hops_before();
            let into: Vec<_> = into.into_iter().collect();
            let best_of = |((reached, target), sources): &((u64, usize), Vec<(usize, Label)>)| {
                let known_label = labels.get(reached).and_then(|layer| layer.get(target));
                let most = least[*target].min(least[goal]).min(known_label.map_or(f64::INFINITY, |label| label.weight));
                best_into((judge, graph), *target, (hops, sources), most, is_kept.then_some(&known))
            };
            let all: Vec<Best> = into.par_iter().map(best_of).collect();
            for (((reached, target), _), best) in into.iter().zip(all) {
                for (source, edge) in best.judged {
                    counter.pair()?;
                    if is_kept {
                        known.insert((source, *target), edge);
                    }
                }
                if let Some(label) = best.label {
                    labels.entry(*reached).or_default().insert(*target, label);
                }
            }
            match labels.range(hops + 1..).next() {
                Some((&next, _)) => hops = next,
                None => return Ok(labels),
            }
        }
    }
}

/// What is known of an edge that is judged once.
#[derive(Clone, Copy)]
enum Known {
    /// Its risk.
    Exact(Judged),
    /// That it weighs no less.
    AtLeast(f64),
}

/// The best label of a node in a layer, and the edges that were judged for it, by their sources.
struct Best {
    label: Option<Label>,
    judged: Vec<(usize, Known)>,
}

/// The best label of a node over edges from labels with this number of hops, if it weighs less than `most`. The lightest sources come first,
/// and draws end where an edge cannot win any more.
fn best_into(
    (judge, graph): (&Judge, &HopGraph),
    target: usize,
    (hops, sources): (u64, &[(usize, Label)]),
    mut most: f64,
    known: Option<&BTreeMap<(usize, usize), Known>>,
) -> Best {
    let mut sources: Vec<&(usize, Label)> = sources.iter().collect();
    sources.sort_by(|a, b| a.1.weight.total_cmp(&b.1.weight).then(a.0.cmp(&b.0)));
    let mut best = Best { label: None, judged: Vec::new() };
    let least_of_edge = judge.least_weight();
    for (source, label) in sources {
        let below = most - label.weight;
        if below <= least_of_edge {
            break;
        }
        let edge = match known.and_then(|known| known.get(&(*source, target))) {
            Some(Known::Exact(edge)) => *edge,
            Some(Known::AtLeast(weight)) if *weight >= below => continue,
            _ => {
                let edge = judge.edge(graph, (*source, target), label.takeoff_m2, below);
                let learnt = if edge.weight < below { Known::Exact(edge) } else { Known::AtLeast(below) };
                best.judged.push((*source, learnt));
                edge
            }
        };
        if edge.weight < below {
            most = label.weight + edge.weight;
            let takeoff_m2 = judge.takeoff_m2(edge.spread_m2);
            best.label = Some(Label { weight: most, from: Some((hops, *source)), loft: edge.loft, takeoff_m2 });
        }
    }
    best
}

/// The edges out of one node to nodes that are kept.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn steps_from(
    graph: &HopGraph,
    kept: &[bool],
    node: usize,
    counter: &mut PairCounter<'_>,
) -> Result<Vec<Step>, Cancelled> {
    let nodes = graph.nodes();
    let takeoff = nodes.station(NodeId(node));
    let mut steps = Vec::new();
    for target in graph.landings(takeoff).filter(|&target| target != node && kept[target]) {
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

/// The path to the goal that ends with a label.
fn path_to_goal(graph: &HopGraph, labels: &Labels, hops: u64, weight: f64) -> Option<ReliablePath> {
    let nodes = graph.nodes();
    let mut at = (hops, nodes.goal().index());
    let (mut legs, mut cost) = (Vec::new(), Cost::default());
    loop {
        let label = labels.get(&at.0)?.get(&at.1)?;
        let Some(from) = label.from else { break };
        let (takeoff, landing) = (*nodes.station(NodeId(from.1)), *nodes.station(NodeId(at.1)));
        let edge = graph.edge(&takeoff, &landing).ok()?;
        cost = cost + graph.cost(&takeoff, &landing, edge);
        legs.push(Leg { takeoff, landing, edge, loft: label.loft });
        at = from;
    }
    legs.reverse();
    Some(ReliablePath { legs, cost, weight, success: None })
}
