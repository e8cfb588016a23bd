//! The hop graph over points of the chain, and the search for the path of fewest hops.
//!
//! Nodes are the vertices, points between them, start and goal; an edge is one hop, or several along one segment, in either
//! direction of travel. Edges are evaluated when their source node is settled and never stored, so memory grows only with the
//! nodes. Nodes are settled in batches of one hop count, each shared among as many threads as its size justifies.
//!
//! [`HopGraph`] implements petgraph's traits, so petgraph's algorithms run on it: `examples/petgraph_on_hops.rs`.
//!
//! A discretisation can only miss paths: a path found exists, but a failure at some density of points proves nothing.
//! [`proof`] bounds the fewest hops from both sides, for every density.

mod batched_search;
mod corridor;
mod cost;
mod cost_to_go;
mod edges;
mod frontier;
mod goals;
mod judge;
mod local_reach;
mod nodes;
mod path_commands;
mod post_costs;
mod post_risks;
pub mod proof;
mod questions;
mod reachable;
mod refusals;
mod reliability;
mod reliability_policy;
mod search;
mod successors;
mod thinned;
mod usable;

pub use corridor::{Beside, Corridor};
pub use cost::{Cost, Effort, EffortUnit};
pub use cost_to_go::CostToGo;
pub use edges::{Edge, EdgeReference, HopGraph};
pub use frontier::{Frontier, NearestMiss};
pub use judge::{RiskModel, TakeoffScatter};
pub use nodes::{NodeSet, NodesError, PointSpacing};
pub use post_costs::PostCosts;
pub use post_risks::PostRisks;
pub use reachable::{Reachable, reachable};
pub use refusals::RefusalCounts;
pub use reliability::{
    ReliabilityOptions, ReliabilityUse, ReliablePath, most_reliable_paths, path_within_budget, preferred_path, search_most_reliable,
};
pub use search::{AUTO_POINTS_PER_SEGMENT, Answer, Leg, Outcome, SearchError, SearchOptions, search, search_pairs};
pub use usable::{EndpointRefusal, endpoint_refusal, is_usable};
pub(crate) use {
    judge::{Judge, Judged, MapJudge},
    path_commands::with_reliable_commands,
    reachable::reachable_nodes,
    search::search_one,
};
