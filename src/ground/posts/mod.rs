//! All single hops between the posts of a DEM, computed fast, with the results of [`Windows`](super::Windows) on the same two
//! posts.

mod error;
mod exact;
mod facet_table;
mod facets;
mod footings;
mod lattice;
mod offsets;
mod overlays;
mod post_hops;
mod reach;
mod refusal;
mod samples;

pub use error::MapError;
pub(in crate::ground) use footings::Standing;
pub use lattice::{NodeLattice, Post};
pub(crate) use offsets::Offset;
#[cfg(test)]
pub(crate) use offsets::{OffsetTable, Spacing};
pub(crate) use overlays::OverlayTable;
pub use post_hops::{Lofts, PostHops};
pub use reach::PostHopsSize;
pub use refusal::PostRefusal;
