//! Label-setting search: the best path by an objective, within budgets.
//!
//! Without a budget on another amount it is Dijkstra's algorithm in lexicographic order; with a lower bound on what is left to the goal it
//! is A*. With one, a node keeps every label that another one does not dominate (Martins 1984): no better by the objective, and no less of
//! any amount with a budget. The first label of the goal that is taken from the queue is the best.

use std::{cmp::Ordering, collections::BinaryHeap};

use super::{
    Amount, Amounts, Budgets, Objective, OutagePart, OverBudget,
    labels::{Labels, NONE, Origin, Tracked, by_objective},
};
use crate::progress::Cancelled;

/// Nodes, and the legs out of each with what they take. Edges are visited and never stored, so that a graph of a million nodes may have
/// them implicitly.
pub trait LegGraph {
    /// The number of nodes; they are numbered from 0.
    fn nodes(&self) -> usize;

    /// Visits every leg out of a node, once for each of its distinct commands; those that the visitor does not want may be left out. The
    /// order of visits decides between equals.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled>;

    /// What no path from a node to the goal takes less of: for every amount no more than a leg and what is left after it. Zeros are such
    /// bounds.
    fn least_to_goal(&self, node: usize) -> Amounts;

    /// How a leg out of a node is outside the condition of one of the layers that may be left for a while, for a search under them.
    fn outage(&self, _from: usize, _leg: &Successor, _layer: usize) -> OutagePart {
        OutagePart::HELD
    }
}

/// What is done with the legs out of a node.
pub trait LegVisitor {
    /// Whether a leg to a node that takes at least so much may be of use: a graph need not compute another one.
    fn wants(&mut self, _node: usize, _least: &Amounts) -> bool {
        true
    }

    /// Whether such a leg could improve on what is known at its node, whatever follows: a cheaper question, which needs no ground.
    fn may_improve(&mut self, _node: usize, _least: &Amounts) -> bool {
        true
    }

    /// A leg with one of its commands.
    fn visit(&mut self, leg: &Successor);
}

/// A leg with one of its commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Successor {
    /// The node it leads to.
    pub node: usize,
    /// The command: a number that the graph knows.
    pub command: u32,
    /// What it takes, each at least 0.
    pub amounts: Amounts,
}

/// How many labels a search keeps at most; one that leaves out others says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LabelCap {
    /// Of one node.
    pub of_node: usize,
    /// In all, those no longer needed included: some 40 bytes each.
    pub in_all: usize,
}

impl LabelCap {
    /// Every label is kept.
    pub(super) const NONE: Self = Self { of_node: usize::MAX, in_all: usize::MAX };

    /// The bytes that each label of a search takes at most, with its place in the queue.
    pub fn bytes_per_label(objective: &Objective, budgets: &Budgets) -> u64 {
        (Labels::bytes_per_label(Tracked::new(objective, budgets).len()) + 3 * size_of::<Waiting>()) as u64
    }
}

impl Default for LabelCap {
    /// A node of a plan has hundreds at most; ten million labels are some 400 MB.
    fn default() -> Self {
        Self { of_node: 2_000, in_all: 10_000_000 }
    }
}

/// One leg of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathStep {
    /// Where it begins.
    pub from: usize,
    /// Where it ends.
    pub to: usize,
    /// Its command.
    pub command: u32,
}

/// A path.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPath {
    /// Its legs from the start to the goal; none if they are the same node.
    pub steps: Vec<PathStep>,
    /// What it takes: the sums over its legs from the start.
    pub totals: Amounts,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchResult {
    /// The best path; `None` if no path keeps the budgets.
    pub path: Option<FoundPath>,
    /// Whether labels were left out because there were too many: the path may then not be the best, and `None` proves nothing.
    pub capped: bool,
    /// How many labels were made.
    pub labels: usize,
    /// How many of them were settled: the legs out of their nodes visited.
    pub settled: usize,
    /// How many nodes have labels.
    pub reached: usize,
}

/// A label that waits, the best first; of equals the one of the lower node, then the older one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Waiting {
    pub(super) key: [f64; Objective::MOST],
    pub(super) node: u32,
    pub(super) label: u32,
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        let best_first = by_objective(&self.key, &other.key).then(self.node.cmp(&other.node)).then(self.label.cmp(&other.label));
        best_first.reverse()
    }
}

/// The best path from a start to a goal by an objective, within budgets.
///
/// # Errors
/// [`Cancelled`], from the graph.
///
/// # Complexity
/// Without a budget on another amount one visit of the legs of every node that may lie on a better path; with one, a visit for every label.
pub fn search(
    graph: &impl LegGraph,
    (start, goal): (usize, usize),
    objective: &Objective,
    budgets: &Budgets,
    cap: LabelCap,
) -> Result<SearchResult, Cancelled> {
    search_tracked(graph, (start, goal), Tracked::new(objective, budgets), cap)
}

/// The same for what labels keep.
pub(super) fn search_tracked(
    graph: &impl LegGraph,
    (start, goal): (usize, usize),
    tracked: Tracked,
    cap: LabelCap,
) -> Result<SearchResult, Cancelled> {
    let mut run = Run::new(graph, (start, goal), tracked, cap);
    let best = run.until(true)?;
    let path = best.map(|label| run.path(label)).transpose()?;
    Ok(SearchResult {
        path,
        capped: run.labels.capped,
        labels: run.labels.len(),
        settled: run.settled,
        reached: run.labels.labelled_nodes(),
    })
}

/// One search on its way.
pub(super) struct Run<'g, G> {
    graph: &'g G,
    goal: usize,
    pub(super) labels: Labels,
    /// How many labels were settled: their legs visited.
    pub(super) settled: usize,
    queue: BinaryHeap<Waiting>,
}

/// Space for the amounts of one leg after another.
#[derive(Debug, Default)]
struct Scratch {
    totals: Vec<f64>,
    whole: Vec<f64>,
}

/// A label whose legs are visited.
struct Settled<'r, G> {
    graph: &'r G,
    goal: usize,
    labels: &'r mut Labels,
    queue: &'r mut BinaryHeap<Waiting>,
    label: u32,
    scratch: &'r mut Scratch,
}

impl<G: LegGraph> Settled<'_, G> {
    /// Whether the amounts in the scratch may belong to a path that is better than those to the goal that are known; leaves what such a
    /// path takes at least.
    fn leads_on(&mut self, node: usize) -> bool {
        let Scratch { totals, whole } = &mut *self.scratch;
        let labels = &*self.labels;
        // A path that takes at least as much of everything as one that is known is not better.
        labels.tracked.with_rest(totals, &self.graph.least_to_goal(node), whole) && !labels.node_dominates(self.goal, whole)
    }

    /// Whether no stretch outside the condition of a layer gets too long with a leg; leaves in the scratch what is kept of them.
    fn keeps_outages(&mut self, leg: &Successor) -> bool {
        let labels = &*self.labels;
        if !labels.tracked.has_outages() {
            return true;
        }
        let from = labels.origin(self.label).node as usize;
        let part = |layer: usize| self.graph.outage(from, leg, layer);
        labels.tracked.go_outside(labels.totals(self.label), &mut self.scratch.totals, &part)
    }
}

impl<G: LegGraph> LegVisitor for Settled<'_, G> {
    fn wants(&mut self, node: usize, least: &Amounts) -> bool {
        self.may_improve(node, least) && self.leads_on(node)
    }

    fn may_improve(&mut self, node: usize, least: &Amounts) -> bool {
        if self.labels.node_is_ahead(node, self.label, least) {
            return false;
        }
        self.labels.extended(self.label, least, &mut self.scratch.totals);
        !self.labels.node_dominates(node, &self.scratch.totals)
    }

    fn visit(&mut self, leg: &Successor) {
        if self.labels.node_is_ahead(leg.node, self.label, &leg.amounts) {
            return;
        }
        self.labels.extended(self.label, &leg.amounts, &mut self.scratch.totals);
        if !self.leads_on(leg.node) || !self.keeps_outages(leg) {
            return;
        }
        let origin = Origin { node: number(leg.node), before: self.label, command: leg.command };
        if let Some(label) = self.labels.offer(&self.scratch.totals, origin) {
            let key = self.labels.tracked.key(&self.scratch.whole);
            self.queue.push(Waiting { key, node: origin.node, label });
        }
    }
}

/// Looks for the amounts of one leg.
struct OnlyLeg {
    step: PathStep,
    amounts: Amounts,
}

impl LegVisitor for OnlyLeg {
    fn wants(&mut self, node: usize, _: &Amounts) -> bool {
        node == self.step.to
    }

    fn may_improve(&mut self, node: usize, _: &Amounts) -> bool {
        node == self.step.to
    }

    fn visit(&mut self, leg: &Successor) {
        if leg.node == self.step.to && leg.command == self.step.command {
            self.amounts = leg.amounts;
        }
    }
}

impl<'g, G: LegGraph> Run<'g, G> {
    pub(super) fn new(graph: &'g G, (start, goal): (usize, usize), tracked: Tracked, cap: LabelCap) -> Self {
        let zeros = tracked.zeros();
        let mut labels = Labels::new(tracked, graph.nodes(), cap.in_all.max(1), cap.of_node.max(1));
        let mut queue = BinaryHeap::new();
        let node = number(start);
        let mut whole = Vec::new();
        if labels.tracked.with_rest(&zeros, &graph.least_to_goal(start), &mut whole)
            && let Some(label) = labels.offer(&zeros, Origin { node, before: NONE, command: 0 })
        {
            queue.push(Waiting { key: labels.tracked.key(&whole), node, label });
        }
        Self { graph, goal, labels, settled: 0, queue }
    }

    /// Another node where a path may begin.
    pub(super) fn also_from(&mut self, start: usize) {
        let (zeros, node) = (self.labels.tracked.zeros(), number(start));
        if let Some(label) = self.labels.offer(&zeros, Origin { node, before: NONE, command: 0 }) {
            self.queue.push(Waiting { key: self.labels.tracked.key(&zeros), node, label });
        }
    }

    /// Settles labels until the best one of the goal, or until none waits.
    pub(super) fn until(&mut self, first_is_enough: bool) -> Result<Option<u32>, Cancelled> {
        let mut scratch = Scratch::default();
        while let Some(Waiting { node, label, .. }) = self.queue.pop() {
            if !self.labels.is_alive(label) {
                continue;
            }
            let node = node as usize;
            if node == self.goal {
                if first_is_enough {
                    return Ok(Some(label));
                }
                continue;
            }
            if !first_is_enough && self.is_beaten(node, label, &mut scratch.whole) {
                continue;
            }
            self.settled += 1;
            let Self { graph, goal, labels, queue, .. } = self;
            graph.successors(node, &mut Settled { graph: *graph, goal: *goal, labels, queue, label, scratch: &mut scratch })?;
        }
        Ok(None)
    }

    /// Whether a path to the goal found since a label was made takes no more of anything than every path that goes on from it.
    fn is_beaten(&self, node: usize, label: u32, whole: &mut Vec<f64>) -> bool {
        let tracked = &self.labels.tracked;
        !tracked.with_rest(self.labels.totals(label), &self.graph.least_to_goal(node), whole)
            || self.labels.node_dominates(self.goal, whole)
    }

    /// The labels of the goal.
    pub(super) fn at_goal(&self) -> Vec<u32> {
        self.labels.of_node(self.goal).collect()
    }

    /// The path that ends with a label.
    pub(super) fn path(&self, label: u32) -> Result<FoundPath, Cancelled> {
        let mut steps = Vec::new();
        let mut at = self.labels.origin(label);
        while at.before != NONE {
            let before = self.labels.origin(at.before);
            steps.push(PathStep { from: before.node as usize, to: at.node as usize, command: at.command });
            at = before;
        }

        steps.reverse();
        path_along(self.graph, steps)
    }
}

/// The path of some legs, with what they take from the start.
pub(super) fn path_along(graph: &impl LegGraph, steps: Vec<PathStep>) -> Result<FoundPath, Cancelled> {
    let mut totals = Amounts::NONE;
    for step in &steps {
        let mut only = OnlyLeg { step: *step, amounts: Amounts::NONE };
        graph.successors(step.from, &mut only)?;
        totals = totals.then(&only.amounts);
    }
    Ok(FoundPath { steps, totals })
}

/// The number of a node in a label.
#[expect(clippy::cast_possible_truncation, reason = "a graph has at most as many nodes as 32 bits number")]
const fn number(node: usize) -> u32 {
    node as u32
}

/// The least total of an amount over all paths, and whether labels were left out; `None` if there is no path.
fn least_total(graph: &impl LegGraph, ends: (usize, usize), amount: Amount, cap: LabelCap) -> Result<Option<f64>, Cancelled> {
    let found = search(graph, ends, &Objective::of(amount), &Budgets::NONE, cap)?;
    Ok(found.path.map(|path| path.totals.of(amount)))
}

/// A budget that the best path without budgets does not keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnmetBudget {
    /// By how much that path exceeds it.
    pub over: OverBudget,
    /// The least total of this amount over all paths.
    pub least: f64,
}

/// The path that stands where a search within budgets found none.
pub(super) struct WithoutBudgets {
    pub(super) path: FoundPath,
    /// Whether it keeps the budgets after all: labels of such paths were left out.
    pub(super) within: bool,
    /// The budgets that it exceeds, each with the least of any path.
    pub(super) unmet: Vec<UnmetBudget>,
    /// Whether labels were left out: it may then not be the best.
    pub(super) capped: bool,
    /// How many nodes the search for it reached, and how many labels it settled.
    pub(super) work: (usize, usize),
}

/// Where no path keeps the budgets: the best without them, and for each budget that it exceeds the least of any path. Where labels of every
/// path were left out, that of the fewest hops is a path all the same. `None` if there is no path.
pub(super) fn without_budgets(
    graph: &impl LegGraph,
    ends: (usize, usize),
    objective: &Objective,
    budgets: &Budgets,
    cap: LabelCap,
) -> Result<Option<WithoutBudgets>, Cancelled> {
    let SearchResult { mut path, capped, reached, settled, .. } = search(graph, ends, objective, &Budgets::NONE, cap)?;
    if path.is_none() && capped {
        path = search(graph, ends, &Objective::of(Amount::Hops), &Budgets::NONE, LabelCap::NONE)?.path;
    }
    let Some(path) = path else { return Ok(None) };
    let mut unmet = Vec::new();
    for over in budgets.exceeded_by(&path.totals) {
        let least = least_total(graph, ends, over.amount, cap)?.unwrap_or(over.total);
        unmet.push(UnmetBudget { over, least });
    }
    Ok(Some(WithoutBudgets { path, within: unmet.is_empty(), unmet, capped, work: (reached, settled) }))
}
