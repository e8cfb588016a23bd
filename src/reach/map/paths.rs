//! The hops of a path over the map, each on its own slice.

use std::sync::Arc;

use super::{MapError, PostHops, lattice::Post};
use crate::{
    ballistics::TakeoffChoice,
    chain::ConstrainedChain,
    graph::{Edge, Leg},
    hop::{HopTest, Split},
    path::{Hop, HopPath, generate},
    quantity::VertexId,
};

/// One hop of a path, on the slice between its two posts.
#[derive(Clone, Debug)]
pub struct MapHop {
    /// The slice from take-off to landing, which [`slice`](crate::terrain::slice()) gives too.
    pub chain: Arc<ConstrainedChain>,
    /// The hop along it.
    pub path: HopPath,
}

/// The hops of a path from node to node, as chosen.
///
/// # Errors
/// [`MapError`], as [`PostHops::lofts`].
pub fn path_hops(hops: &PostHops<'_>, posts: &[Post], choice: TakeoffChoice) -> Result<Vec<MapHop>, MapError> {
    let mut found = Vec::with_capacity(posts.len().saturating_sub(1));
    for (from, to) in posts.iter().zip(posts.iter().skip(1)) {
        let Some(chain) = hops.chain(*from, *to)? else { continue };
        let chain = Arc::new(chain);
        let Some(path) = hop_along(Arc::clone(&chain), choice) else { continue };
        found.push(MapHop { chain, path });
    }
    Ok(found)
}

/// The single hop over a slice.
fn hop_along(chain: Arc<ConstrainedChain>, choice: TakeoffChoice) -> Option<HopPath> {
    let test = HopTest::new(chain);
    let geometry = test.chain().geometry();
    let (takeoff, landing) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
    // Whoever gives a way that this map did not find gets the hops that there are.
    let lofts = test.lofts(&takeoff, &landing).ok()?;
    generate(&test, &[Leg { takeoff, landing, edge: Edge::Hop(lofts) }], choice, Split::default()).ok()
}

/// The hops of a path joined to one [`HopPath`], x counted along it from its beginning.
pub fn joined(hops: &PostHops<'_>, path: &[MapHop]) -> HopPath {
    let mut begin_m = 0.0;
    let mut flown: Vec<Hop> = Vec::with_capacity(path.len());
    for hop in path.iter().flat_map(|hop| &hop.path.hops) {
        let mut hop = *hop;
        let run_m = hop.landing.point.x_m;
        hop.takeoff.point.x_m = begin_m;
        begin_m += run_m;
        hop.landing.point.x_m = begin_m;
        flown.push(hop);
    }
    HopPath::of_hops(flown, hops.request().hopper)
}
