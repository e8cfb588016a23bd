//! The search for the path of fewest hops, then least effort.

use super::{
    Cost, Edge, Effort, EndpointRefusal, Frontier, NodeSet, PointSpacing, RefusalCounts, TooManyNodes,
    local_reach::LocalReach,
    questions::{Questions, Round},
};
use crate::{
    ballistics::TakeoffChoice,
    chain::Station,
    hop::{HopTest, Split},
    progress::{Cancelled, Detail, Meter, Progress, Stage},
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

/// Why a search has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SearchError {
    /// More nodes than fit.
    #[error(transparent)]
    TooManyNodes(#[from] TooManyNodes),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
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
    /// How many pairs were tested, over all spacings tried. Questions with one start share the search and its counts.
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
/// Of several such paths it gives the one whose nodes, compared from the goal backwards, come first along the chain. The answer does
/// not depend on the number of threads (those of the rayon pool it is called in).
///
/// Reports each spacing before it is tried.
///
/// # Errors
/// [`SearchError`].
///
/// # Complexity
/// With V nodes, W of them in reach of each ahead of the nodes of as many hops, and S vertices flown past: about O(V W), as
/// [`Sweep`](crate::hop::Sweep) evaluates one take-off, in time; some 150 bytes a node in memory, no stored edges.
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
    answers.pop().ok_or(SearchError::TooManyNodes(TooManyNodes { nodes: 0 }))
}

/// Answers many questions, each a start and a goal, with one search for each start.
///
/// Every answer is that of [`search`] for its pair, but for the counts of pairs tested and refused, which are those of the shared
/// search: goals are sinks, so they do not block each other.
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
