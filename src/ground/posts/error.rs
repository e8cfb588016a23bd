//! Why the hops of a map cannot be computed.

use crate::{ground::SliceProblem, progress::Cancelled, quantity::MapPoint, terrain::TerrainError};

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// A request that makes no sense.
    #[error("{what} is {found}, expected {expected}")]
    Request {
        /// Of what.
        what: &'static str,
        /// What was given.
        found: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// The terrain, or what lies over it.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// A slice that makes no chain.
    #[error("the slice from ({:.3} m, {:.3} m): {reason}", at.x, at.y)]
    Ground {
        /// Where it begins.
        at: MapPoint,
        /// Why not.
        reason: Box<SliceProblem>,
    },
    /// A hop that spans too many posts.
    #[error(
        "one hop reaches {range_m:.1} m, {posts:.0} posts, which makes {offsets} landings from every post, more than fit a table of 256 MiB \
         (some 150 posts): take a stride of {stride}, a coarser raster (gdalwarp -tr), or lower speed limits"
    )]
    TooFar {
        /// How far, m.
        range_m: f64,
        /// How many posts that is.
        posts: f64,
        /// How many landings there are.
        offsets: usize,
        /// The least stride at which they fit.
        stride: usize,
    },
    /// More hops than the map's numbers hold.
    #[error("a post is more than {most} hops away, expected fewer: take a greater stride or higher speed limits")]
    TooManyHops {
        /// The most there are.
        most: i16,
    },
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
