//! Which nodes have ground under the hopper's footprint that allows contacts: fitted once per node, looked up many times.

use rayon::prelude::*;

use super::{NodeLattice, overlays::OverlayTable, refusal::rest_tangent};
use crate::ground::DemGround;

/// What the ground under the footprint at a node allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ground) enum Standing {
    /// Contacts.
    Sound,
    /// None: too steep, by the friction at the node if that rules the rest slope.
    TooSteep,
    /// None: too rough, or not known.
    Refused,
    /// So close to a limit that the exact code decides.
    Close,
}

/// The standing of every node, one byte each.
#[derive(Clone, Debug)]
pub(super) struct FootingTable(Vec<Standing>);

impl FootingTable {
    /// The table of a ground; `None` if its hopper has no footprint.
    ///
    /// # Complexity
    /// `4 (footprint / spacing)^2` facets per node, in parallel.
    pub(super) fn new(ground: &DemGround, lattice: NodeLattice, overlays: Option<&OverlayTable>) -> Option<Self> {
        ground.footprint.as_ref()?;
        let dem = ground.terrain().dem();
        let of_node = |index: usize| {
            let node = lattice.node(index);
            let Some(position) = lattice.position(dem, node) else { return Standing::Refused };
            ground.standing(&position, rest_tangent(ground, overlays, lattice.raster_index(node)))
        };
        Some(Self((0..lattice.count()).into_par_iter().map(of_node).collect()))
    }

    /// The standing of a node.
    #[inline]
    pub(super) fn of(&self, node: usize) -> Standing {
        self.0[node]
    }
}
