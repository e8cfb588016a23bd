//! How fine the nodes over a DEM are, against what one hop spans.

use crate::{
    graph::PointSpacing,
    ground::{DemGround, Surface},
    planner::NodesPerPost,
    scenario::Scenario,
    terrain::Dem,
    world::Hopper,
};

/// The greater distance of neighbouring posts in a row or a column, m.
pub(super) fn post_spacing_m(dem: &Dem) -> f64 {
    let map = dem.georeference();
    map.dx_m().max(map.dy_m())
}

/// How far one hop over this ground goes over a level at most, by the speeds, m.
pub(super) fn level_hop_m(ground: &DemGround) -> f64 {
    level_hop_of_m(ground.hopper(), ground.gravity_m_s2())
}

/// How far one hop of a machine goes over level ground at most, by the speeds, m.
pub(super) fn level_hop_of_m(hopper: &Hopper, gravity_m_s2: f64) -> f64 {
    let limits = hopper.limits();
    let speed_m_s = limits.takeoff_speed_max_m_s.min(limits.arc_landing_speed_max_m_s());
    speed_m_s / gravity_m_s2 * speed_m_s
}

/// As many nodes a post spacing as the scenario says; by itself, as a hop of this length over level ground needs.
pub(super) fn nodes_per_post(spacing: Option<PointSpacing>, dem: &Dem, level_hop_m: f64) -> NodesPerPost {
    match spacing {
        Some(PointSpacing::AtMostM(spacing_m)) => NodesPerPost::at_most_m(spacing_m, post_spacing_m(dem)),
        Some(PointSpacing::PerSegment(_)) | None => NodesPerPost::auto(level_hop_m, post_spacing_m(dem)),
    }
}

/// How far a hop goes over level ground at most, by the speeds that planning may use, m.
pub(super) fn planned_level_hop_m(scenario: &Scenario) -> f64 {
    let derated = scenario.derated();
    let Scenario { hopper, body, .. } = derated.as_ref().unwrap_or(scenario);
    level_hop_of_m(&hopper.with_any_command(), body.gravity.m_s2())
}

/// A warning where one hop, so long over level ground, spans few nodes.
///
/// # Arguments
/// `of`: what the nodes belong to, such as `the map`.
pub(super) fn coarse_nodes(level_hop_m: f64, of: &str, node_spacing_m: f64) -> Option<String> {
    coarse_nodes_of(level_hop_m, (of, "search.node_spacing_max_m"), node_spacing_m)
}

/// The same of a map, where `finer` names what a smaller one of makes the nodes finer.
pub(super) fn coarse_map_nodes(level_hop_m: f64, finer: &str, node_spacing_m: f64) -> Option<String> {
    coarse_nodes_of(level_hop_m, ("the map", finer), node_spacing_m)
}

fn coarse_nodes_of(level_hop_m: f64, (of, finer): (&str, &str), node_spacing_m: f64) -> Option<String> {
    const FEW: f64 = 8.0;
    let spans = level_hop_m / node_spacing_m;
    (spans < FEW).then(|| {
        format!(
            "one hop over level ground spans {spans:.1} nodes of {of}, {node_spacing_m} m apart, fewer than 8: a smaller {finer} \
             may save hops"
        )
    })
}
