//! How fine the nodes over a DEM are, against what one hop spans.

use crate::ground::{DemGround, Surface};

/// The greater distance of neighbouring posts in a row or a column, m.
pub(super) fn post_spacing_m(ground: &DemGround) -> f64 {
    let map = ground.terrain().dem().georeference();
    map.dx_m().max(map.dy_m())
}

/// How far one hop goes over level ground at most, by the speeds, m.
pub(super) fn level_hop_m(ground: &DemGround) -> f64 {
    let limits = ground.hopper().limits();
    let speed_m_s = limits.takeoff_speed_max_m_s.min(limits.arc_landing_speed_max_m_s());
    speed_m_s / ground.gravity_m_s2() * speed_m_s
}

/// A warning where one hop spans few nodes.
///
/// # Arguments
/// `of`: what the nodes belong to, such as `the map`.
pub(super) fn coarse_nodes(ground: &DemGround, of: &str, node_spacing_m: f64) -> Option<String> {
    const FEW: f64 = 8.0;
    let spans = level_hop_m(ground) / node_spacing_m;
    (spans < FEW).then(|| {
        format!(
            "one hop over level ground spans {spans:.1} nodes of {of}, {node_spacing_m} m apart, fewer than 8: a smaller \
             search.node_spacing_max_m may save hops"
        )
    })
}
