//! What a search for missions holds beside its states and labels to be faster.

use super::super::{SurfaceNodes, table_hops::TableHops};
use super::{MissionQuestion, Travel};
use crate::{
    drive::{DriveAmount, DriveEdges, DriveError, DriveGround},
    ground::{DemGround, NodeLattice},
    progress::{Cancelled, Progress},
    world::Rover,
};

/// What is kept of pairs of nodes takes no more bytes than these.
const PAIRS_BYTES: u64 = 1 << 26;

/// A search towards a goal prepares nothing where there are more nodes than a square has with a side of so many times the way.
const SIDES: f64 = 8.0;

/// Fewer nodes than these are always prepared for: it takes some tens of milliseconds.
const FEW: f64 = 1e5;

/// What a search has prepared, or may keep.
pub(super) struct Kept {
    /// The tables of hops between nodes of the lattice.
    pub(super) tables: Option<TableHops>,
    /// Whether all drive legs between posts are judged beforehand.
    judges: bool,
    /// How many bytes may be kept of pairs of nodes, each for hops and for drive legs.
    pub(super) pairs_bytes: u64,
}

impl Kept {
    /// What fits into the bytes that a question allows.
    ///
    /// # Arguments
    /// `way_m`: the straight way to the goal; `None` for a search of all nodes. `again`: whether the search may come to a node more than once.
    pub(super) fn of(
        (ground, nodes): (&DemGround, &SurfaceNodes),
        question: &MissionQuestion<'_>,
        (way_m, again): (Option<f64>, bool),
    ) -> Self {
        let mut room = question.kept_bytes_max;
        let mut take = |bytes: u64| {
            let fits = bytes <= room;
            room -= if fits { bytes } else { 0 };
            fits
        };
        let is_worth = way_m.is_none_or(|way_m| {
            let side = SIDES * way_m / nodes.lattice().spacing_m();
            #[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
            let count = nodes.count() as f64;
            count <= FEW.max(side * side)
        });
        let limits = question.rover.limits();
        // Planes under the wheels take long: towards a goal those of a few posts are needed.
        let is_light = way_m.is_none() || (limits.roughness_max_m.is_none() && limits.step_max_m.is_none());
        let judges = is_worth
            && is_light
            && question.travel.drives()
            && nodes.lattice().nodes_per_post() == 1
            && take(Self::legs_bytes((ground, nodes), question.rover));
        let hops = question.travel.hops() && is_worth;
        let tables = hops.then(|| TableHops::bytes(ground, nodes)).flatten().filter(|bytes| take(*bytes));
        let tables = tables.and_then(|bytes| TableHops::within(ground, nodes, bytes));
        let pairs_bytes = if again { (room / 2).min(PAIRS_BYTES) } else { 0 };
        Self { tables, judges, pairs_bytes }
    }

    /// The bytes of all that a search may hold to be faster, if it is allowed to.
    pub(super) fn most_bytes((ground, nodes): (&DemGround, &SurfaceNodes), rover: &Rover, travel: Travel) -> u64 {
        let tables = travel.hops().then(|| TableHops::bytes(ground, nodes)).flatten().unwrap_or(0);
        let legs = if travel.drives() { Self::legs_bytes((ground, nodes), rover) } else { 0 };
        tables.saturating_add(legs).saturating_add(2 * PAIRS_BYTES)
    }

    fn legs_bytes((ground, nodes): (&DemGround, &SurfaceNodes), rover: &Rover) -> u64 {
        let lattice = NodeLattice::finer(ground.terrain().dem(), nodes.lattice().nodes_per_post());
        let limits = rover.limits();
        DriveEdges::bytes(&lattice, limits.neighbours.count(), limits.roughness_max_m.is_some())
    }

    /// The drive legs between all posts, where they are judged beforehand.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn edges<'d>(
        &self,
        drive: Option<&'d DriveGround<'d>>,
        progress: &dyn Progress,
    ) -> Result<Option<DriveEdges<'d>>, Cancelled> {
        let Some(drive) = drive.filter(|_| self.judges) else { return Ok(None) };
        let lattice = NodeLattice::new(drive.ground().terrain().dem(), 1);
        match DriveEdges::new(drive, lattice, DriveAmount::Time, progress) {
            Ok(edges) => Ok(Some(edges)),
            Err(DriveError::Cancelled(cancelled)) => Err(cancelled),
            // Too large to be judged beforehand: each leg is judged by itself.
            Err(DriveError::TooLarge { .. }) => Ok(None),
        }
    }
}
