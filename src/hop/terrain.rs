//! The ground in between, as a limit of a hop over a chain.

use crate::{
    ballistics::limits::clearing_loft,
    chain::{PolygonalChain, Site, Station},
    quantity::{SlopeInterval, VertexId},
};

/// The lofts that clear every chain vertex flown past, and the vertex that decides.
///
/// Vertices are enough: between them the arc is concave and the ground straight. The answer depends a little on how finely flat
/// ground is divided, since a clearance over a vertex just after take-off asks for a steep start (model section 2).
///
/// # Returns
/// An interval without upper end, and the vertex that sets its lower end; no lower end and no vertex where none is flown past.
///
/// # Complexity
/// One division pair per vertex flown past.
pub fn terrain_limit(
    chain: &PolygonalChain,
    takeoff: &Station,
    landing: &Station,
    clearance_m: f64,
) -> (SlopeInterval, Option<VertexId>) {
    let mut highest = (f64::NEG_INFINITY, None);
    for i in flown_past(takeoff, landing) {
        let loft = clearing_loft(takeoff.point, landing.point, chain.vertices()[i], clearance_m);
        if loft > highest.0 {
            highest = (loft, Some(VertexId(i)));
        }
    }
    (SlopeInterval { lower: highest.0, upper: f64::INFINITY }, highest.1)
}

/// The indices of the vertices strictly between two stations, whichever is left.
#[inline]
pub(crate) fn flown_past(a: &Station, b: &Station) -> std::ops::Range<usize> {
    let (left, right) = if a.point.x_m <= b.point.x_m { (a.site, b.site) } else { (b.site, a.site) };
    Site::vertices_between(left, right)
}
