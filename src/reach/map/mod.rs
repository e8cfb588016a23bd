//! Hop maps: from one post of a DEM to all others, in how few hops.
//!
//! Nodes are posts, an edge is a single hop whose limits hold on the exact slice between its two posts ([`PostHops`]). [`search`] finds
//! the fewest hops from a start to every post, layer by layer.

mod facets;
mod ground;
mod lattice;
mod layer_bits;
mod mobility;
mod offsets;
mod overlays;
mod paths;
mod post_hops;
mod request;
mod samples;
mod search;

pub use lattice::{NodeLattice, Post};
pub use mobility::{Mobility, SECTORS, mobility};
pub use paths::{MapHop, joined, path_hops};
pub use post_hops::{GroundOf, Lofts, PostHops, PostRefusal};
pub use request::{MapError, MapRequest};
pub use search::{HopMap, Journey, LayerProgress, NO_GROUND, Search, UNREACHED, search};
