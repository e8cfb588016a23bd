//! The offsets within reach of one hop, and how many of them are within reach of each block.

use super::{
    MapError, NodeLattice, PostHops,
    lattice::BLOCK,
    offsets::{OffsetTable, Spacing, TableSize},
    overlays::OverlayTable,
    samples::{HeightScale, Heights},
};
use crate::{
    ballistics::{limits::ClearanceProfile, safety_ceiling_m, safety_range_m},
    ground::{DemGround, Surface},
    terrain::points,
    world::tolerant_speed_m_s,
};

/// Bounds on reach are widened by this factor against rounding.
const WIDER: f64 = 1.0 + 1.0e-6;

/// The largest table of crossings, 320 MiB: a reach of some 150 posts.
const MOST_CROSSINGS: usize = 1 << 23;

/// How far hops reach from the nodes of a DEM.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    spacing: Spacing,
    /// The longest hop, m.
    longest_m: f64,
    /// For each block, the longest hop from or to its nodes, m.
    ranges_m: Vec<f64>,
}

/// The number of pairs and bytes of the hops over a DEM: upper bounds, known before anything is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PostHopsSize {
    /// The nodes.
    pub nodes: usize,
    /// Nodes within reach of a node, at most.
    pub offsets: usize,
    /// Bytes that [`PostHops`] holds beside the elevations, at most.
    pub bytes: u64,
    /// Bytes that its preparation holds at the same time, at most.
    pub preparation_bytes: u64,
}

impl Reach {
    /// The reach of a ground's hopper.
    pub(super) fn of(ground: &DemGround, lattice: NodeLattice, heights: Heights<'_>) -> Result<Self, MapError> {
        let spacing = spacing(ground, lattice);
        let speeds = speeds_m_s(ground);
        let gravity = ground.gravity_m_s2();
        // The longest hop that rises or falls by at most a height.
        let range_m =
            |height_m: f64| safety_range_m(height_m, speeds[0], gravity).min(safety_range_m(height_m, speeds[1], gravity)) * WIDER;
        let blocks = block_heights(lattice, heights);
        let all = blocks.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |all, one| (all.0.min(one.0), all.1.max(one.1)));
        let mut longest_m = if speeds.iter().all(|&v| v > 0.0) && all.0 <= all.1 { range_m(all.1 - all.0) } else { 0.0 };
        if !longest_m.is_finite() {
            let found = format!("{longest_m} m");
            return Err(MapError::Request {
                what: "the reach of one hop",
                found,
                expected: "a finite one: give speed limits and gravity",
            });
        }
        // A shorter range contains less relief, which shortens the range further.
        let mut ranges_m = Vec::new();
        for _ in 0..8 {
            let reliefs = block_reliefs(lattice, blocks_within(spacing, longest_m), &blocks);
            ranges_m = reliefs.into_iter().map(|relief_m| range_m(relief_m).min(longest_m)).collect();
            let next_m = ranges_m.iter().copied().fold(0.0, f64::max);
            let converged = next_m > 0.95 * longest_m;
            longest_m = next_m;
            if converged {
                break;
            }
        }
        let size = OffsetTable::size(spacing, longest_m, (lattice.rows, lattice.cols));
        if size.crossings > MOST_CROSSINGS {
            let posts = longest_m / spacing.dx_m.min(spacing.dy_m);
            if lattice.per_post > 1 {
                return Err(MapError::TooFine {
                    range_m: longest_m,
                    nodes: posts,
                    offsets: size.offsets,
                    per_post: lattice.per_post,
                });
            }
            let dem = ground.terrain().dem();
            let fits = |stride: &usize| {
                let bounds = ((dem.rows() - 1) / stride + 1, (dem.cols() - 1) / stride + 1);
                OffsetTable::size(Spacing { stride: *stride, ..spacing }, longest_m, bounds).crossings <= MOST_CROSSINGS
            };
            let widest = dem.rows().max(dem.cols());
            let stride = (spacing.stride + 1..widest).find(fits).unwrap_or(widest);
            return Err(MapError::TooFar { range_m: longest_m, posts, offsets: size.offsets, stride });
        }
        Ok(Self { spacing, longest_m, ranges_m })
    }
}

/// The greatest speeds of take-off and landing, m/s, a little raised.
fn speeds_m_s(ground: &DemGround) -> [f64; 2] {
    let hopper = ground.hopper().limits();
    [hopper.takeoff_speed_max_m_s, hopper.arc_landing_speed_max_m_s()].map(|v| tolerant_speed_m_s(v) * WIDER)
}

/// The spacing of the posts and nodes of a ground.
fn spacing(ground: &DemGround, lattice: NodeLattice) -> Spacing {
    let dem = ground.terrain().dem();
    let map = dem.georeference().finer(lattice.per_post);
    let raster_cols = points(dem.cols(), lattice.per_post);
    Spacing { dx_m: map.dx_m(), dy_m: map.dy_m(), stride: lattice.stride, node_cols: lattice.cols, post_cols: raster_cols }
}

/// Lowest and highest node of each block; (inf, -inf) if it has none.
fn block_heights(lattice: NodeLattice, posts: Heights<'_>) -> Vec<(f64, f64)> {
    let (down, across) = lattice.blocks();
    (0..down * across)
        .map(|block| {
            let heights = lattice.nodes_of(block).map(|node| posts.at(lattice.raster_index(node)));
            // `min` and `max` of a number and NaN give the number.
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)))
        })
        .collect()
}

/// The number of blocks that a range may extend over, down and across.
fn blocks_within(spacing: Spacing, range_m: f64) -> (usize, usize) {
    #[expect(clippy::cast_precision_loss, reason = "strides and blocks are small")]
    let side = (BLOCK * spacing.stride) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
    let count = |step_m: f64| (range_m / (side * step_m)).ceil() as usize;
    (count(spacing.dy_m), count(spacing.dx_m))
}

/// For each block, the relief of all blocks within some rows and columns of it, m.
fn block_reliefs(lattice: NodeLattice, (rows, cols): (usize, usize), blocks: &[(f64, f64)]) -> Vec<f64> {
    let (down, across) = lattice.blocks();
    let joined = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let window = |at: usize, reach: usize, count: usize| at.saturating_sub(reach)..=(at.saturating_add(reach)).min(count - 1);
    let mut along_rows = vec![none; blocks.len()];
    for (index, found) in along_rows.iter_mut().enumerate() {
        let (row, col) = (index / across, index % across);
        *found = window(col, cols, across).map(|col| blocks[row * across + col]).fold(none, joined);
    }
    let of_block = |index: usize| {
        let (row, col) = (index / across, index % across);
        let (low, high) = window(row, rows, down).map(|row| along_rows[row * across + col]).fold(none, joined);
        (high - low).max(0.0)
    };
    (0..blocks.len()).map(of_block).collect()
}

impl PostHops {
    /// Fills the table of offsets.
    pub(super) fn set_reach(&mut self) -> Result<(), MapError> {
        let Reach { spacing, longest_m, ranges_m, .. } = Reach::of(&self.ground, self.lattice, self.heights())?;
        let (speeds, gravity) = (speeds_m_s(&self.ground), self.ground.gravity_m_s2());
        let rises_m = |run_m: f64| {
            let [takeoff_m, landing_m] = speeds.map(|v| safety_ceiling_m(run_m, v, gravity));
            // With brakes the speed of an arc's landing, and so the drop, has no limit.
            let drop_m = if landing_m.is_finite() { landing_m.abs() } else { 0.0 };
            let slack_m = 1.0e-9 * (run_m + takeoff_m.abs() + drop_m);
            (-landing_m - slack_m, takeoff_m + slack_m)
        };
        let bounds = (self.lattice.rows, self.lattice.cols);
        let clearance = if self.by_vertices { ClearanceProfile::NONE } else { self.envelope().clearance() };
        self.table = OffsetTable::new(spacing, longest_m, bounds, clearance, rises_m);
        let count = |range_m: &f64| self.table.offsets.partition_point(|offset| offset.run_m <= *range_m);
        self.within_reach = ranges_m.iter().map(count).collect();
        Ok(())
    }

    /// The number of blocks that a range may extend over, down and across.
    pub(crate) fn blocks_within(&self, range_m: f64) -> (usize, usize) {
        blocks_within(spacing(&self.ground, self.lattice), range_m)
    }

    /// The size of the hops over a ground, without the tables themselves.
    ///
    /// # Errors
    /// As [`PostHops::new`], for a reach of too many posts.
    pub fn size(ground: &DemGround, lattice: NodeLattice) -> Result<PostHopsSize, MapError> {
        let dem = ground.terrain().dem();
        let scale = HeightScale::of(dem);
        let of_posts = if lattice.per_post > 1 { NodeLattice::new(dem, 1) } else { lattice };
        // Blocks of finer nodes are smaller, and so is their relief: they reach no farther than those of posts.
        let reach = Reach::of(ground, of_posts, Heights::of(dem, &scale))?;
        let TableSize { offsets, crossings } =
            OffsetTable::size(spacing(ground, lattice), reach.longest_m, (lattice.rows, lattice.cols));
        let nodes = lattice.count();
        // The tables are about the posts of the raster of heights, of which a finer lattice has its own.
        let posts = if lattice.per_post > 1 { nodes } else { dem.rows() * dem.cols() };
        let finer = if lattice.per_post > 1 { size_of::<f64>() * nodes } else { 0 };
        let (down, across) = lattice.blocks();
        let overlays = ground.terrain().overlays();
        let has_overlays = overlays.friction().is_some() || overlays.zones().next().is_some();
        let facets = 3 * posts;
        let footings = if ground.footprint.is_some() { nodes } else { 0 };
        let (overlay, overlay_preparation) = if has_overlays { OverlayTable::bytes(posts) } else { (0, 0) };
        let refused = if overlays.layers().is_empty() { 0 } else { nodes };
        let held = finer + facets + footings + refused + overlay + OffsetTable::bytes(offsets, crossings) + 64 * down * across;
        let preparation = facets.max(overlay_preparation).max(OffsetTable::preparation_bytes(offsets, crossings));
        Ok(PostHopsSize { nodes, offsets, bytes: held as u64, preparation_bytes: preparation as u64 })
    }
}
