//! Why the hops of a map cannot be computed.

use crate::{ground::SliceProblem, progress::Cancelled, quantity::MapPoint, terrain::TerrainError};

/// Why there is no hop map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// An invalid value in the request.
    #[error("{what} is {found}, expected {expected}")]
    Request {
        /// The name of the value.
        what: &'static str,
        /// The value given.
        found: String,
        /// What is expected.
        expected: &'static str,
    },
    /// An error of the terrain or its overlays.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// The slice between two nodes is not a valid chain.
    #[error("the slice from ({:.3} m, {:.3} m): {reason}", at.x, at.y)]
    Ground {
        /// Where it begins.
        at: MapPoint,
        /// Why.
        reason: Box<SliceProblem>,
    },
    /// One hop spans too many posts.
    #[error(
        "one hop reaches {range_m:.1} m, {posts:.0} posts, which makes {offsets} landings from every post, more than fit a table of 256 MiB \
         (some 150 posts): take a stride of {stride}, a coarser raster (gdalwarp -tr), or lower speed limits"
    )]
    TooFar {
        /// The reach of one hop, m.
        range_m: f64,
        /// The same in posts.
        posts: f64,
        /// How many offsets are in reach.
        offsets: usize,
        /// The least stride with which the table fits.
        stride: usize,
    },
    /// One hop spans too many nodes of a lattice that is finer than the posts.
    #[error(
        "one hop reaches {range_m:.1} m, {nodes:.0} nodes, which makes {offsets} landings from every node, more than fit a table of 256 MiB: \
         found {per_post} nodes for each post spacing, expected fewer: make the spacing of nodes larger, or lower the speed limits"
    )]
    TooFine {
        /// The reach of one hop, m.
        range_m: f64,
        /// The same in nodes.
        nodes: f64,
        /// How many offsets are in reach.
        offsets: usize,
        /// Nodes a post spacing.
        per_post: usize,
    },
    /// A hop count exceeds the range of the map's integers.
    #[error("a post is more than {most} hops away, expected fewer: take a greater stride or higher speed limits")]
    TooManyHops {
        /// The largest hop count.
        most: i16,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
