//! The offsets within reach of one hop, and how many of them are within reach of each block.

use super::{
    MapError, PostHops,
    lattice::BLOCK,
    offsets::{OffsetTable, Spacing},
};
use crate::{
    ballistics::{safety_ceiling_m, safety_range_m},
    ground::Surface,
    world::tolerant_speed_m_s,
};

/// Bounds on reach are widened by this factor against rounding.
const WIDER: f64 = 1.0 + 1.0e-6;

/// The largest table of crossings, 320 MiB: a reach of some 150 posts.
const MOST_CROSSINGS: usize = 1 << 23;

impl PostHops {
    /// Makes the table of offsets, and finds how far hops reach from each block.
    pub(super) fn set_reach(&mut self) -> Result<(), MapError> {
        let hopper = self.ground.hopper().limits();
        let speeds = [hopper.takeoff_speed_max_m_s, hopper.arc_landing_speed_max_m_s()].map(|v| tolerant_speed_m_s(v) * WIDER);
        let gravity = self.ground.gravity_m_s2();
        // The longest hop that rises or falls by at most a height.
        let range_m =
            |height_m: f64| safety_range_m(height_m, speeds[0], gravity).min(safety_range_m(height_m, speeds[1], gravity)) * WIDER;
        let blocks = self.block_heights();
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
            ranges_m =
                self.block_reliefs(&blocks, longest_m).into_iter().map(|relief_m| range_m(relief_m).min(longest_m)).collect();
            let next_m = ranges_m.iter().copied().fold(0.0, f64::max);
            let converged = next_m > 0.95 * longest_m;
            longest_m = next_m;
            if converged {
                break;
            }
        }
        let spacing = self.spacing();
        let bounds = (self.lattice.rows, self.lattice.cols);
        let size = OffsetTable::size(spacing, longest_m, bounds);
        if size.crossings > MOST_CROSSINGS {
            let posts = longest_m / spacing.dx_m.min(spacing.dy_m);
            let dem = self.ground.terrain().dem();
            let fits = |stride: &usize| {
                let bounds = ((dem.rows() - 1) / stride + 1, (dem.cols() - 1) / stride + 1);
                OffsetTable::size(Spacing { stride: *stride, ..spacing }, longest_m, bounds).crossings <= MOST_CROSSINGS
            };
            let widest = dem.rows().max(dem.cols());
            let stride = (spacing.stride + 1..widest).find(fits).unwrap_or(widest);
            return Err(MapError::TooFar { range_m: longest_m, posts, offsets: size.offsets, stride });
        }
        let rises_m = |run_m: f64| {
            let [takeoff_m, landing_m] = speeds.map(|v| safety_ceiling_m(run_m, v, gravity));
            // With brakes the speed of an arc's landing, and so the drop, has no limit.
            let drop_m = if landing_m.is_finite() { landing_m.abs() } else { 0.0 };
            let slack_m = 1.0e-9 * (run_m + takeoff_m.abs() + drop_m);
            (-landing_m - slack_m, takeoff_m + slack_m)
        };
        self.table = OffsetTable::new(spacing, longest_m, bounds, self.envelope().clearance(), rises_m);
        let count = |range_m: &f64| self.table.offsets.partition_point(|offset| offset.run_m <= *range_m);
        self.within_reach = ranges_m.iter().map(count).collect();
        Ok(())
    }

    fn spacing(&self) -> Spacing {
        let map = self.ground.terrain().dem().georeference();
        Spacing {
            dx_m: map.dx_m(),
            dy_m: map.dy_m(),
            stride: self.lattice.stride,
            node_cols: self.lattice.cols,
            post_cols: self.ground.terrain().dem().cols(),
        }
    }

    /// Lowest and highest node of each block; (inf, -inf) if it has none.
    fn block_heights(&self) -> Vec<(f64, f64)> {
        let (down, across) = self.lattice.blocks();
        let posts = self.heights();
        (0..down * across)
            .map(|block| {
                let heights = self.lattice.nodes_of(block).map(|node| posts.at(self.lattice.post_index(node)));
                // `min` and `max` of a number and NaN give the number.
                heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)))
            })
            .collect()
    }

    /// The number of blocks that a range may extend over, down and across.
    pub(crate) fn blocks_within(&self, range_m: f64) -> (usize, usize) {
        let spacing = self.spacing();
        #[expect(clippy::cast_precision_loss, reason = "strides and blocks are small")]
        let side = (BLOCK * spacing.stride) as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
        let count = |step_m: f64| (range_m / (side * step_m)).ceil() as usize;
        (count(spacing.dy_m), count(spacing.dx_m))
    }

    /// For each block, the relief of all blocks within a range of it, m.
    fn block_reliefs(&self, blocks: &[(f64, f64)], range_m: f64) -> Vec<f64> {
        let (down, across) = self.lattice.blocks();
        let (rows, cols) = self.blocks_within(range_m);
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
}
