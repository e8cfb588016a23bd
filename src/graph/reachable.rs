//! The positions that a start reaches in either direction along the chain.

use std::sync::Arc;

use super::{
    Effort, HopGraph, NodeSet, PointSpacing, SearchError,
    batched_search::{Aim, BatchedSearch},
    goals::Goals,
    local_reach::LocalReach,
};
use crate::{
    ballistics::TakeoffChoice,
    chain::Station,
    ground::LandingTable,
    hop::{HopTest, Split},
    progress::{Detail, Meter, Progress, Stage},
    quantity::NodeId,
    world::Limit,
};

/// The nodes of a chain, from left to right, with the fewest hops from a start to each.
#[derive(Clone, Debug, PartialEq)]
pub struct Reachable {
    /// Each node and its hops; `None` if it is unreachable over these nodes.
    pub nodes: Vec<(Station, Option<u64>)>,
    /// The limit that refuses the hop from the reached node with the greatest x to the next node. `None` if it is the last
    /// node.
    pub refusing_ahead: Option<Limit>,
}

/// The fewest hops from a start to every node: the search without a goal.
///
/// # Errors
/// [`SearchError`].
///
/// # Complexity
/// That of [`search`](super::search()), for the nodes that are reached.
pub fn reachable(test: &HopTest, start: Station, spacing: PointSpacing, progress: &dyn Progress) -> Result<Reachable, SearchError> {
    let meter = Meter::new(progress, Stage::Reachability);
    meter.report(Detail::None)?;
    reachable_nodes(test, start, spacing, &meter)
}

/// The same as a part of another stage.
pub(crate) fn reachable_nodes(
    test: &HopTest,
    start: Station,
    spacing: PointSpacing,
    meter: &Meter<'_>,
) -> Result<Reachable, SearchError> {
    let set = NodeSet::new(test.chain(), start, start, spacing)?;
    let graph = HopGraph::new(test, &set, Effort::default(), TakeoffChoice::default(), Split::default());
    let table = Arc::new(LandingTable::new(test, set.shared_stations()));
    let reach = LocalReach::of(test);
    let mut batched = BatchedSearch::new(&graph, &table, &reach, Aim::Hops);
    batched.run(&start, &mut Goals::new(&[]), meter)?;
    let stations = set.stations();
    let nodes: Vec<_> = stations.iter().enumerate().map(|(i, station)| (*station, batched.hops(NodeId(i)))).collect();
    let farthest = nodes.iter().rposition(|(_, hops)| hops.is_some()).unwrap_or(0);
    let refusing_ahead = stations.get(farthest).zip(stations.get(farthest + 1)).and_then(|(a, b)| graph.edge(a, b).err());
    Ok(Reachable { nodes, refusing_ahead })
}
