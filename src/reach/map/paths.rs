//! The hops of a path over the map, each on its own slice.

use super::{MapError, MapObjective, Post, PostHops};
use crate::{
    ballistics::{LineOfSight, TakeoffChoice},
    graph::{Edge, Leg},
    ground::{ContactPoint, Surface},
    hop::{HopTest, Split},
    path::{Execution, Hop, HopPath, execute, generate},
    quantity::{SlopeInterval, VertexId},
};

/// One hop of a path, on the slice between its two posts.
#[derive(Clone, Debug)]
pub struct MapHop {
    /// The hop test on the slice from take-off to landing, the same as from [`slice`](crate::terrain::slice()).
    pub test: HopTest,
    /// The hop.
    pub path: HopPath,
}

/// The hops of a path of nodes, with their chosen take-offs.
///
/// # Errors
/// [`MapError`], as [`PostHops::lofts`].
pub fn path_hops(hops: &PostHops, nodes: &[Post], choice: TakeoffChoice) -> Result<Vec<MapHop>, MapError> {
    hops_along(hops, nodes, choice, |_, _, _| None)
}

/// The same with the take-off of each hop that is best for an objective.
///
/// # Errors
/// [`MapError`], as [`PostHops::lofts`].
pub fn path_hops_by(
    hops: &PostHops,
    nodes: &[Post],
    objective: &MapObjective,
    choice: TakeoffChoice,
) -> Result<Vec<MapHop>, MapError> {
    hops_along(hops, nodes, choice, |sight, lofts, is_first| Some(objective.arc(sight, lofts, is_first).loft()))
}

/// The hops of a path of nodes, each with the loft that is wanted of its lofts; `None`: by the choice.
fn hops_along(
    hops: &PostHops,
    nodes: &[Post],
    choice: TakeoffChoice,
    wanted: impl Fn(LineOfSight, SlopeInterval, bool) -> Option<f64>,
) -> Result<Vec<MapHop>, MapError> {
    let mut found = Vec::with_capacity(nodes.len().saturating_sub(1));
    for (from, to) in nodes.iter().zip(nodes.iter().skip(1)) {
        let Some(chain) = hops.chain(*from, *to)? else { continue };
        let test = HopTest::new(chain);
        let is_first = found.is_empty();
        let Some(path) = hop_along(&test, choice, |sight, lofts| wanted(sight, lofts, is_first)) else { continue };
        found.push(MapHop { test, path });
    }
    Ok(found)
}

/// The single hop over a slice; `None` if no hop joins the two nodes.
fn hop_along(test: &HopTest, choice: TakeoffChoice, wanted: impl Fn(LineOfSight, SlopeInterval) -> Option<f64>) -> Option<HopPath> {
    let geometry = test.chain().geometry();
    let (takeoff, landing) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
    let lofts = test.lofts(&takeoff, &landing).ok()?;
    let loft = wanted(test.line_of_sight(&takeoff, &landing)?, lofts);
    generate(test, &[Leg { takeoff, landing, edge: Edge::Hop(lofts), loft }], choice, Split::default()).ok()
}

/// Joins the hops of a path to one [`HopPath`] over the map, with distances along it from its start. Its contacts are the nodes themselves:
/// between posts the heights of the slices on both sides of a node may differ from each other by rounding.
pub fn joined(hops: &PostHops, path: &[MapHop]) -> HopPath {
    let mut begin_m = 0.0;
    let mut flown: Vec<Hop> = Vec::with_capacity(path.len());
    for hop in path.iter().flat_map(|hop| &hop.path.hops) {
        let run_m = hop.landing.along_m;
        let along = |point: &ContactPoint, along_m| ContactPoint { along_m, station: None, ..at_node(hops, point) };
        let end_m = begin_m + run_m;
        flown.push(Hop { takeoff: along(&hop.takeoff, begin_m), landing: along(&hop.landing, end_m), ..*hop });
        begin_m = end_m;
    }
    HopPath::of_hops(flown, hops.ground().hopper())
}

/// A contact at the node that lies there.
fn at_node(hops: &PostHops, point: &ContactPoint) -> ContactPoint {
    let lattice = hops.lattice();
    let nearest = lattice.nearest(hops.ground().terrain().dem().georeference(), point.point_m.xy());
    let there = hops.position(nearest).filter(|node| node.at == point.point_m.xy());
    there.map_or(*point, |node| ContactPoint { point_m: point.point_m.xy().coords.push(node.z_m).into(), ..*point })
}

/// Flies a joined path again over the ground, from one node to another, by the independent checker.
///
/// The checker walks over the triangles of the DEM; the hops were found with slices and a table of offsets.
pub fn verify(hops: &PostHops, path: &HopPath, start: Post, goal: Post) -> Execution {
    let [start, goal] = [start, goal].map(|node| hops.position(node));
    execute(hops.ground(), path, start.zip(goal))
}
