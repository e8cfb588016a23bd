//! The search for the path of fewest hops, then least effort, with petgraph.

use petgraph::algo::astar;

use super::{
    Cost, Edge, Effort, EndpointRefusal, Frontier, HopGraph, NodeSet, PointSpacing, RefusalCounts, TooManyNodes, endpoint_refusal,
};
use crate::{
    ballistics::{HopTest, Split, TakeoffChoice},
    chain::{Contact, Direction, Station},
};

/// The points per segment that "auto" tries, the first that finds a path answering.
///
/// From 1 on all but 2 halve the gaps of the one before. Sets for k and k + 1 are not nested, and a larger k may cost a hop: all that
/// is claimed is that a path appears.
pub const AUTO_POINTS_PER_SEGMENT: [u32; 7] = [0, 1, 2, 3, 7, 15, 31];

/// How to search.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct SearchOptions {
    /// How densely to fill segments with points; `None`: automatically, by [`AUTO_POINTS_PER_SEGMENT`].
    pub spacing: Option<PointSpacing>,
    /// The second criterion after hops.
    pub effort: Effort,
    /// Which feasible take-off angle to fly.
    pub takeoff: TakeoffChoice,
    /// How to divide many hops along one segment.
    pub split: Split,
}

/// One edge of the path found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Where it begins.
    pub takeoff: Station,
    /// Where it ends.
    pub landing: Station,
    /// One hop or several.
    pub edge: Edge,
}

/// What the search came to.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A path.
    Path {
        /// Its edges from start to goal; none where start and goal are the same place.
        legs: Vec<Leg>,
        /// Hops and effort.
        cost: Cost,
    },
    /// Start, goal or both refuse whatever the hop.
    EndpointsRefuse(Vec<EndpointRefusal>),
    /// No path over these nodes; another choice of points may have one.
    NoPath(Box<Frontier>),
}

/// The outcome and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// What came of it.
    pub outcome: Outcome,
    /// The spacing that answered.
    pub spacing: PointSpacing,
    /// The greatest number of points inside one segment.
    pub points_per_segment: u32,
    /// How many nodes there were.
    pub nodes: usize,
    /// How many pairs were tested, over all spacings tried.
    pub pairs_tested: u64,
    /// How the refused pairs fell.
    pub refusals: RefusalCounts,
}

impl Answer {
    /// The number of hops; `None` without a path.
    pub fn hops(&self) -> Option<u64> {
        match &self.outcome {
            Outcome::Path { cost, .. } => Some(cost.hops()),
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
        }
    }
}

/// Finds the path of fewest hops, and of least effort among those, over the nodes asked for (P Algorithm 3).
///
/// `progress` is told each spacing before it is tried.
///
/// # Errors
/// [`TooManyNodes`].
///
/// # Complexity
/// With V nodes, W of them in reach of each and S vertices flown past: at most O(V W S + V W log(V W)) time, O(V W) heap entries in
/// petgraph's queue at worst, no stored edges.
pub fn search(
    test: &HopTest<'_>,
    start: Station,
    goal: Station,
    options: &SearchOptions,
    progress: &mut dyn FnMut(PointSpacing),
) -> Result<Answer, TooManyNodes> {
    let automatic = AUTO_POINTS_PER_SEGMENT.map(PointSpacing::PerSegment);
    let spacings: &[PointSpacing] = match &options.spacing {
        Some(spacing) => std::slice::from_ref(spacing),
        None => &automatic,
    };
    let refusing = refusing_endpoints(test, &start, &goal);
    let mut pairs_tested = 0;
    let mut refusals = RefusalCounts::default();
    let mut last = None;
    for (i, &spacing) in spacings.iter().enumerate() {
        let nodes = NodeSet::new(test.chain(), start, goal, spacing)?;
        let answer = |outcome, pairs_tested, refusals| Answer {
            outcome,
            spacing,
            points_per_segment: nodes.most_per_segment(),
            nodes: nodes.stations().len(),
            pairs_tested,
            refusals,
        };
        if !refusing.is_empty() {
            return Ok(answer(Outcome::EndpointsRefuse(refusing), 0, refusals));
        }
        progress(spacing);
        let graph = HopGraph::new(test, &nodes, options.effort, options.takeoff, options.split);
        let found = shortest(&graph);
        let (pairs, refused) = graph.tally();
        pairs_tested += pairs;
        refusals += refused;
        if let Some((cost, legs)) = found {
            return Ok(answer(Outcome::Path { legs, cost }, pairs_tested, refusals));
        }
        if i + 1 == spacings.len() {
            let frontier = Box::new(Frontier::of(&graph));
            last = Some(answer(Outcome::NoPath(frontier), pairs_tested, refusals));
        }
    }
    // There is always a last spacing.
    last.ok_or(TooManyNodes { nodes: 0 })
}

/// Which of start and goal refuse whatever the hop. A journey of no hop asks nothing of either.
fn refusing_endpoints(test: &HopTest<'_>, start: &Station, goal: &Station) -> Vec<EndpointRefusal> {
    let Some(towards) = Direction::between(start.point.x_m, goal.point.x_m) else { return Vec::new() };
    [(start, Contact::Takeoff), (goal, Contact::Landing)]
        .into_iter()
        .filter_map(|(station, contact)| endpoint_refusal(test.chain(), station, contact, towards))
        .collect()
}

/// The cheapest path, by petgraph's A* without an estimate, that is Dijkstra's algorithm with predecessors.
fn shortest(graph: &HopGraph<'_>) -> Option<(Cost, Vec<Leg>)> {
    use petgraph::visit::EdgeRef;

    let nodes = graph.nodes();
    let goal = nodes.goal();
    let (cost, path) = astar(graph, nodes.start(), |node| node == goal, |edge| *edge.weight(), |_| Cost::default())?;
    let legs = path
        .windows(2)
        .filter_map(|pair| {
            let (takeoff, landing) = (*nodes.station(pair[0]), *nodes.station(pair[1]));
            graph.edge(&takeoff, &landing).ok().map(|edge| Leg { takeoff, landing, edge })
        })
        .collect();
    Some((cost, legs))
}
