//! Single hops between the nodes of a DEM.

use std::collections::HashSet;

use nalgebra::Vector2;

use super::{SurfaceNode, SurfaceNodes, nearest_steps::NearestSteps};
use crate::{
    ballistics::LineOfSight,
    ground::{DemGround, HopReach, MapPosition},
    hop::HopTest,
    quantity::{SlopeInterval, VertexId},
    world::Limit,
};

/// A reach with what may be lost to rounding.
const ROUNDED: f64 = 1.0 + 1e-9;

/// From which end nodes are searched, and which way the hops between them then lead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// From the start, along the hops.
    Start,
    /// From the goal, against the hops.
    Goal,
}

impl Side {
    /// The nodes and places of a hop between one of this side and another one, in the order of flight.
    pub(super) const fn in_order<'p>(
        self,
        (node, at): (SurfaceNode, &'p MapPosition),
        (other, there): (SurfaceNode, &'p MapPosition),
    ) -> ([SurfaceNode; 2], [&'p MapPosition; 2]) {
        match self {
            Self::Start => ([node, other], [at, there]),
            Self::Goal => ([other, node], [there, at]),
        }
    }

    /// The other end.
    pub(super) const fn other(self) -> Self {
        match self {
            Self::Start => Self::Goal,
            Self::Goal => Self::Start,
        }
    }
}

/// The feasible arcs of a hop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Feasible {
    pub(super) sight: LineOfSight,
    pub(super) heading: Vector2<f64>,
    pub(super) lofts: SlopeInterval,
}

/// The hops between nodes, for any thread.
#[derive(Clone, Debug)]
pub(super) struct SurfaceHops<'s> {
    pub(super) ground: &'s DemGround,
    pub(super) nodes: &'s SurfaceNodes,
    reach: HopReach,
    steps: NearestSteps,
    /// Hops that the walk over the triangles has and their slice has not.
    refused: HashSet<[SurfaceNode; 2]>,
}

impl<'s> SurfaceHops<'s> {
    pub(super) fn new(ground: &'s DemGround, nodes: &'s SurfaceNodes) -> Self {
        let reach = HopReach::of(ground);
        let steps = NearestSteps::within(nodes.lattice(), reach.longest_m() * ROUNDED);
        Self { ground, nodes, reach, steps, refused: HashSet::new() }
    }

    /// The bytes that they take at most.
    pub(super) fn bytes(ground: &DemGround, nodes: &SurfaceNodes) -> u64 {
        NearestSteps::bytes(nodes.lattice(), HopReach::of(ground).longest_m() * ROUNDED)
    }

    pub(super) fn position(&self, node: SurfaceNode) -> Option<MapPosition> {
        self.nodes.position(self.ground, node)
    }

    /// The nodes among which all are that one hop leads to, or from which it leads here.
    pub(super) fn about(&self, at: &MapPosition, side: Side) -> impl Iterator<Item = SurfaceNode> + '_ {
        self.nodes.about(at.at, self.reach_m(at, side))
    }

    /// A horizontal distance that no hop exceeds which begins at a position, or which ends there, m.
    pub(super) fn reach_m(&self, at: &MapPosition, side: Side) -> f64 {
        let reach_m = match side {
            Side::Start => self.reach.run_m(at),
            Side::Goal => self.reach.run_into_m(at),
        };
        reach_m * ROUNDED
    }

    /// The same nodes, those of the lattice in ascending order of their distance.
    pub(super) fn nearest_first(&self, node: SurfaceNode, at: &MapPosition, side: Side) -> impl Iterator<Item = SurfaceNode> + '_ {
        let (lattice, reach_m) = (self.nodes.lattice(), self.reach_m(at, side));
        let near = self.nodes.of_lattice(node).map(|cell| self.steps.about(cell, reach_m));
        // About a place beside the lattice, of which there are few, in any order.
        let far = if near.is_none() { Some(lattice.about(at.at, reach_m).map(|(i, j)| lattice.index(i, j))) } else { None };
        let of_lattice = near.into_iter().flatten().chain(far.into_iter().flatten());
        of_lattice.map(SurfaceNode::of_index).chain(self.nodes.places_about(at.at, reach_m))
    }

    /// The length of the longest hop over level ground, m.
    pub(super) fn level_m(&self) -> f64 {
        self.reach.level_m()
    }

    /// The line of sight of a hop and its heading; `None` if the greatest speeds exclude it.
    pub(super) fn sight(&self, from: &MapPosition, to: &MapPosition) -> Option<(LineOfSight, Vector2<f64>)> {
        self.reach.sight(self.ground, from, to)
    }

    /// The hop from one node to another; `None` if no arc is feasible.
    ///
    /// A walk over the triangles, which equals the slice up to rounding; where the line may run along an edge between two facets, the slice.
    pub(super) fn between(
        &self,
        nodes: [SurfaceNode; 2],
        [from, to]: [&MapPosition; 2],
        (sight, heading): (LineOfSight, Vector2<f64>),
    ) -> Option<Feasible> {
        if self.is_refused(nodes) {
            return None;
        }
        let lofts = if self.nodes.may_run_along_edges(self.ground, nodes, [from.at, to.at]) {
            self.by_slice([from, to])?.ok()
        } else {
            self.ground.lofts_by_walk(from, to, sight, heading)
        }?;
        Some(Feasible { sight, heading, lofts })
    }

    /// Whether a hop is one that its slice does not have.
    pub(super) fn is_refused(&self, nodes: [SurfaceNode; 2]) -> bool {
        !self.refused.is_empty() && self.refused.contains(&nodes)
    }

    /// The feasible lofts by the slice and the hop test along it, or the limit that leaves none: what the route is flown by. `None` without
    /// ground all along.
    pub(super) fn by_slice(&self, [from, to]: [&MapPosition; 2]) -> Option<Result<SlopeInterval, Limit>> {
        let test = HopTest::new(self.ground.chain(from.at, to.at).ok()?);
        let geometry = test.chain().geometry();
        let ends = [VertexId(0), VertexId(geometry.segment_count())].map(|vertex| geometry.vertex_station(vertex));
        Some(test.lofts(&ends[0], &ends[1]))
    }

    /// Refuses from now on the hops of a path that their slices do not have: on the very edge of a limit the walk may differ from them.
    ///
    /// # Returns
    /// Whether there are any.
    pub(super) fn refuse_wrong(&mut self, hops: impl IntoIterator<Item = [SurfaceNode; 2]>) -> bool {
        let before = self.refused.len();
        for hop in hops {
            let [from, to] = hop.map(|node| self.position(node));
            let is_right = from.zip(to).is_some_and(|(from, to)| matches!(self.by_slice([&from, &to]), Some(Ok(_))));
            if !is_right {
                self.refused.insert(hop);
            }
        }
        self.refused.len() > before
    }
}
