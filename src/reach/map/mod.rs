//! Hop maps: the fewest hops from one or several posts of a DEM to all others.
//!
//! Nodes are posts; an edge is a single hop whose limits hold on the exact slice between its two posts ([`PostHops`]). [`search`]
//! finds the fewest hops from its sources to every post, layer by layer.

mod costs_to_go;
mod layer_bits;
mod mobility;
mod paths;
mod risks_to_go;
mod search;

pub use crate::ground::{MapError, NodeLattice, Post, PostHops, PostHopsSize, PostRefusal};
pub use costs_to_go::costs_to_go;
pub use mobility::{Mobility, SECTORS, mobility};
pub use paths::{MapHop, joined, path_hops, verify};
pub use risks_to_go::{risks_flown_over, risks_to_go};
pub use search::{HopMap, Journey, NO_GROUND, NOT_SEARCHED, Search, Source, UNREACHED, search};
