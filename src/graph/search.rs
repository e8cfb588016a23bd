//! The search for the path of fewest hops, then least effort.

use super::{
    Cost, Edge, Effort, EndpointRefusal, Frontier, NodeSet, NodesError, PointSpacing, RefusalCounts, ReliablePath,
    local_reach::LocalReach,
    questions::{Questions, Round},
};
use crate::{
    ballistics::TakeoffChoice,
    chain::Station,
    flight::UncertaintyProblem,
    hop::{HopTest, Split},
    progress::{Cancelled, Detail, Meter, Progress, Stage},
};

/// The numbers of points per segment that "auto" tries; the first with a path gives the answer.
///
/// Apart from the 2, each halves the gaps of the one before. The node sets for k and k + 1 are not nested, and a larger k
/// may cost a hop: the only guarantee is that a path was found.
pub const AUTO_POINTS_PER_SEGMENT: [u32; 7] = [0, 1, 2, 3, 7, 15, 31];

/// Options of the search.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct SearchOptions {
    /// How densely to fill segments with points; `None`: the first of [`AUTO_POINTS_PER_SEGMENT`] with a path.
    pub spacing: Option<PointSpacing>,
    /// The second criterion after hops.
    pub effort: Effort,
    /// Which feasible take-off angle to use.
    pub takeoff: TakeoffChoice,
    /// How to divide several hops along one segment.
    pub split: Split,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SearchError {
    /// More nodes than fit, or a spacing that is no distance.
    #[error(transparent)]
    Nodes(#[from] NodesError),
    /// Errors by which no risk can be estimated.
    #[error(transparent)]
    Errors(#[from] UncertaintyProblem),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// One edge of the path found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The take-off station of its first hop.
    pub takeoff: Station,
    /// The landing station of its last hop.
    pub landing: Station,
    /// One hop or several along a segment.
    pub edge: Edge,
    /// The loft of its single hop, where the search chose it; `None`: the choice of take-off angle decides.
    pub loft: Option<f64>,
}

/// The result of the search.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A path.
    Path {
        /// The edges from start to goal; empty if start and goal are the same position.
        legs: Vec<Leg>,
        /// Hops and effort.
        cost: Cost,
    },
    /// Start, goal or both refuse every hop.
    EndpointsRefuse(Vec<EndpointRefusal>),
    /// There is no path over these nodes; another choice of points may have one.
    NoPath(Box<Frontier>),
}

/// The result of the search and its work.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The result.
    pub outcome: Outcome,
    /// The spacing that gave the result.
    pub spacing: PointSpacing,
    /// The greatest number of points inside one segment.
    pub points_per_segment: u32,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of pairs tested, over all spacings tried. Questions with the same start share one search and its counts.
    pub pairs_tested: u64,
    /// The refused pairs by limit.
    pub refusals: RefusalCounts,
}

impl Answer {
    /// Takes another path over the same nodes, where this answer is a path.
    pub fn follow(&mut self, path: &ReliablePath) {
        if let Outcome::Path { legs, cost } = &mut self.outcome {
            legs.clone_from(&path.legs);
            *cost = path.cost;
        }
    }

    /// The number of hops; `None` without a path.
    pub fn hops(&self) -> Option<u64> {
        match &self.outcome {
            Outcome::Path { cost, .. } => Some(cost.hops()),
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
        }
    }
}

/// Finds the path of fewest hops, and of least effort among those, over the chosen nodes (P Algorithm 3).
///
/// Of several such paths it returns the one whose nodes, compared from the goal backwards, come first along the chain. The
/// result does not depend on the number of threads (those of the rayon pool in which it is called).
///
/// `progress` is called with each spacing before it is tried.
///
/// # Errors
/// [`SearchError`].
///
/// # Complexity
/// With V nodes, W of them in reach of each ahead of the nodes with equal hops, and S vertices flown over: about O(V W) time,
/// as [`Sweep`](crate::ground::Sweep) evaluates one take-off; some 150 bytes of memory per node, and no stored edges.
pub fn search(
    test: &HopTest,
    start: Station,
    goal: Station,
    options: &SearchOptions,
    progress: &dyn Progress,
) -> Result<Answer, SearchError> {
    search_one(test, (start, goal), options, &Meter::new(progress, Stage::Search))
}

/// The same as a part of another stage.
pub(crate) fn search_one(
    test: &HopTest,
    ends: (Station, Station),
    options: &SearchOptions,
    meter: &Meter<'_>,
) -> Result<Answer, SearchError> {
    let mut answers = search_all(test, &[ends], options, meter)?;
    // One question, one answer.
    answers.pop().ok_or(SearchError::Nodes(NodesError::TooMany { nodes: 0 }))
}

/// Answers several questions, each a start and a goal, with one search per start.
///
/// Every answer equals that of [`search`] for its pair, except for the counts of pairs tested and refused, which are those of
/// the shared search: goals are sinks, so they do not block each other.
///
/// # Errors
/// [`SearchError`].
pub fn search_pairs(
    test: &HopTest,
    pairs: &[(Station, Station)],
    options: &SearchOptions,
    progress: &dyn Progress,
) -> Result<Vec<Answer>, SearchError> {
    search_all(test, pairs, options, &Meter::new(progress, Stage::Search))
}

fn search_all(
    test: &HopTest,
    pairs: &[(Station, Station)],
    options: &SearchOptions,
    meter: &Meter<'_>,
) -> Result<Vec<Answer>, SearchError> {
    let automatic = AUTO_POINTS_PER_SEGMENT.map(PointSpacing::PerSegment);
    let spacings: &[PointSpacing] = match &options.spacing {
        Some(spacing) => std::slice::from_ref(spacing),
        None => &automatic,
    };
    let reach = LocalReach::of(test);
    let mut questions = Questions::new(pairs);
    for (i, &spacing) in spacings.iter().enumerate() {
        let nodes = NodeSet::of_chain(test.chain(), spacing)?;
        let round = Round { test, reach: &reach, nodes: &nodes, spacing, options, is_last: i + 1 == spacings.len() };
        if i == 0 {
            questions.refuse_ends(&round);
        }
        if questions.are_answered() {
            break;
        }
        meter.report(match spacing {
            PointSpacing::PerSegment(points) => Detail::PointsPerSegment(points),
            PointSpacing::AtMostM(spacing_m) => Detail::NodeSpacingM(spacing_m),
        })?;
        questions.ask(&round, meter)?;
    }
    Ok(questions.into_answers())
}
