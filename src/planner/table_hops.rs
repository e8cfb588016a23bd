//! Hops between nodes of the lattice by tables: what all hops over the same columns and rows have in common is computed once.

use nalgebra::Vector2;

use super::{
    SurfaceNode, SurfaceNodes,
    surface_hops::{Feasible, Side},
};
use crate::{
    ground::{DemGround, NodeLattice, Post, PostHops},
    quantity::MapPoint,
};

/// The tables of all hops between the nodes of a lattice.
///
/// Which hops there are is the same as by the walk over the triangles or by the slice; lofts differ by rounding, next to the end of a cone by
/// some 1e-8 of themselves.
#[derive(Debug)]
pub(super) struct TableHops {
    hops: PostHops,
}

impl TableHops {
    /// The tables, where they take at most so many bytes; `None` also where one hop reaches more nodes than tables are made for.
    pub(super) fn within(ground: &DemGround, nodes: &SurfaceNodes, bytes: u64) -> Option<Self> {
        (Self::bytes(ground, nodes)? <= bytes).then_some(())?;
        Some(Self { hops: PostHops::over(ground.clone(), Self::lattice(ground, nodes)).ok()? })
    }

    /// The bytes that they take, those of their preparation included; `None` where one hop reaches too many nodes.
    pub(super) fn bytes(ground: &DemGround, nodes: &SurfaceNodes) -> Option<u64> {
        let size = PostHops::size(ground, Self::lattice(ground, nodes)).ok()?;
        Some(size.bytes.saturating_add(size.preparation_bytes))
    }

    fn lattice(ground: &DemGround, nodes: &SurfaceNodes) -> NodeLattice {
        NodeLattice::finer(ground.terrain().dem(), nodes.lattice().nodes_per_post())
    }

    /// The length of the hops of every offset, the shortest first, m.
    pub(super) fn runs_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.hops.offsets().iter().map(|offset| offset.run_m)
    }

    /// The number of the node of the lattice at exactly this place, if one is there.
    pub(super) fn node_at(&self, at: MapPoint) -> Option<SurfaceNode> {
        let (lattice, map) = (self.hops.lattice(), self.hops.ground().terrain().dem().georeference());
        let node = lattice.nearest(map, at);
        (lattice.at(map, node) == at).then(|| SurfaceNode::of_index(lattice.index(node)))
    }

    /// Visits the nodes of the lattice to which one hop may lead from one of them, or from which one may lead there, the nearest first, each with
    /// the number of its offset. Nodes where no hop begins or ends have none.
    pub(super) fn about(&self, (i, j): (usize, usize), side: Side) -> impl Iterator<Item = (usize, Post)> + '_ {
        let (lattice, node) = (self.hops.lattice(), Post { row: j, col: i });
        let within = if self.hops.usable(node) { self.hops.within_reach(lattice.block_of(node)) } else { 0 };
        (0..within).filter_map(move |offset| {
            let other = match side {
                Side::Start => self.hops.landing(node, offset),
                Side::Goal => self.hops.takeoff(node, offset),
            };
            other.map(|other| (offset, other))
        })
    }

    /// The number of a node of the lattice.
    pub(super) fn number(&self, node: Post) -> SurfaceNode {
        SurfaceNode::of_index(self.hops.lattice().index(node))
    }

    /// The hop by an offset from a node, which ends on the lattice; `None` if no arc is feasible.
    pub(super) fn hop(&self, from: Post, offset: usize) -> Option<Feasible> {
        // Without a slice there is no hop, as everywhere.
        let (sight, lofts) = self.hops.lofts(from, offset).ok()??;
        let heading: Vector2<f64> = self.hops.offsets()[offset].heading;
        Some(Feasible { sight, heading, lofts })
    }
}
