//! Hop maps: the fewest hops from one or several posts of a DEM to all others.
//!
//! Nodes are posts, or points between them; an edge is a single hop whose limits hold on the exact slice between its two posts ([`PostHops`]). [`search`]
//! finds the fewest hops from its sources to every post, layer by layer; [`least_totals`] the least total of any amount. Nodes may be finer
//! than the posts ([`NodeLattice::finer`]).

mod costs_to_go;
mod layer_bits;
mod least_amounts;
mod mobility;
mod objective;
mod paths;
mod risks_to_go;
mod search;

pub use crate::ground::{MapError, NodeLattice, Post, PostHops, PostHopsSize, PostRefusal};
pub use costs_to_go::costs_to_go;
pub use least_amounts::{LeastTotals, least_totals, totals_along};
pub use mobility::{Mobility, SECTORS, mobility};
pub use objective::MapObjective;
pub use paths::{MapHop, joined, path_hops, path_hops_by, verify};
pub use risks_to_go::{risks_flown_over, risks_to_go};
pub use search::{HopMap, Journey, NO_GROUND, NOT_SEARCHED, Search, Source, UNREACHED, search};
