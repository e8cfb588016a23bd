//! The terrain limit of a hop over a chain.

use crate::{
    ballistics::limits::clearing_loft,
    chain::{PolygonalChain, Site, Station},
    quantity::{SlopeInterval, VertexId},
};

/// The lofts that clear every chain vertex flown over, and the vertex that sets the bound.
///
/// ```text
///     n >= max over vertices p of  s_p - t_p                                   (P eq. 14; see clearing_loft)
/// ```
///
/// Testing vertices is sufficient: between them the arc is concave and the ground straight. The result depends slightly on
/// how finely flat ground is divided, since a clearance over a vertex just after take-off requires a steep start (model
/// section 2).
///
/// # Returns
/// An interval without upper bound, and the vertex that sets its lower bound; no lower bound and no vertex if none is flown
/// over.
///
/// # Complexity
/// Two divisions per vertex flown over.
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

/// The indices of the vertices strictly between two stations, in either order.
#[inline]
pub(crate) fn flown_past(a: &Station, b: &Station) -> std::ops::Range<usize> {
    let (left, right) = if a.point.x_m <= b.point.x_m { (a.site, b.site) } else { (b.site, a.site) };
    Site::vertices_between(left, right)
}
