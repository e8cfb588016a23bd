//! The legs from every node of a lattice to its neighbours: which of them a rover drives, and what they take.

use std::ops::Range;

use rayon::prelude::*;

use super::{
    DriveAmount, DriveGround, DriveLeg, DriveLimit, DriveRefusal, DriveRefusalCounts,
    extras::Extras,
    price::PostPrices,
    slopes::{CHUNK, KEPT, NO_LEG, OffsetSlopes, Window},
    template::Template,
};
use crate::{
    ground::{MapPosition, NodeLattice, Post},
    progress::{Cancelled, Meter, Progress, Stage},
};

/// Rows of nodes that are judged together.
const ROWS: usize = 32;

/// Why there is no drive map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    /// More states than the search counts.
    #[error(
        "driving over {nodes} nodes with {states_per_node} headings each has too many states, found {bytes} bytes, expected at most 2^32 states: \
         take a coarser raster or fewer nodes, or no price for turns"
    )]
    TooLarge {
        /// Nodes of the lattice.
        nodes: usize,
        /// States of each.
        states_per_node: usize,
        /// What they would take.
        bytes: u64,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The legs from every node of a lattice to its neighbours.
///
/// A leg exists between two nodes that both have an elevation. Directions are numbered as the rover's
/// [`offsets`](crate::world::Neighbours::offsets).
///
/// # Memory
/// [`DriveEdges::bytes`]: 4 bytes a node for the allowed directions. Where the nodes are the posts, legs are priced when they are asked for;
/// otherwise 8 bytes more for every leg.
#[derive(Debug)]
pub struct DriveEdges<'a> {
    drive: &'a DriveGround<'a>,
    lattice: NodeLattice,
    offsets: Vec<(i32, i32)>,
    /// The offsets as differences of node numbers.
    steps: Vec<isize>,
    masks: Vec<u32>,
    prices: Prices<'a>,
    amount: DriveAmount,
    least: Vec<f64>,
    refusals: DriveRefusalCounts,
}

#[derive(Debug)]
enum Prices<'a> {
    Posts(PostPrices<'a>),
    /// Of every leg of every node; infinite where it is refused.
    Stored(Vec<f64>),
}

impl<'a> DriveEdges<'a> {
    /// Judges the legs between the nodes of a lattice over the DEM, by rows in parallel.
    ///
    /// Between posts, all legs of one offset cross the same edges and facets, and their limits are judged for many posts at once; between other
    /// nodes, every leg is one [`DriveGround::leg`]. The results are the same.
    ///
    /// # Errors
    /// [`DriveError::Cancelled`].
    pub fn new(
        drive: &'a DriveGround<'a>,
        lattice: NodeLattice,
        amount: DriveAmount,
        progress: &dyn Progress,
    ) -> Result<Self, DriveError> {
        let offsets = drive.rover().limits().neighbours.offsets();
        let width = lattice.cols.cast_signed();
        let steps: Vec<isize> = offsets.iter().map(|(east, north)| *east as isize - *north as isize * width).collect();
        let map = lattice.map(drive.ground().terrain().dem().georeference());
        let run_m = |(east, north): &(i32, i32)| libm::hypot(f64::from(*east) * map.dx_m(), f64::from(*north) * map.dy_m());
        let least = offsets.iter().map(|offset| amount.least_per_m(drive.rover()) * run_m(offset)).collect();
        let meter = Meter::with_total(progress, Stage::DriveLegs, lattice.rows as u64);
        let of_posts = lattice.stride == 1 && lattice.per_post == 1;
        let prices = if of_posts { Prices::Posts(PostPrices::new(drive, amount, &offsets)) } else { Prices::Stored(Vec::new()) };
        let mut edges = Self {
            drive,
            lattice,
            offsets,
            steps,
            masks: Vec::new(),
            prices,
            amount,
            least,
            refusals: DriveRefusalCounts::default(),
        };
        if of_posts {
            edges.judge_posts(&meter)?;
        } else {
            edges.judge_nodes(&meter)?;
        }
        Ok(edges)
    }

    /// The bytes that the legs of so many nodes take, at most, those that are freed before it is done included.
    pub fn bytes(lattice: &NodeLattice, neighbours: usize, roughness: bool) -> u64 {
        let of_posts = lattice.stride == 1 && lattice.per_post == 1;
        let of_node = if of_posts { 2 * size_of::<u32>() + usize::from(roughness) } else { size_of::<u32>() + 8 * neighbours };
        (lattice.count() as u64).saturating_mul(of_node as u64)
    }

    /// The ground and the rover.
    pub const fn drive(&self) -> &'a DriveGround<'a> {
        self.drive
    }

    /// The nodes.
    pub const fn lattice(&self) -> &NodeLattice {
        &self.lattice
    }

    /// What a leg's cost is.
    pub const fn amount(&self) -> DriveAmount {
        self.amount
    }

    /// Where the neighbours lie, in nodes to the east and to the north, by direction.
    pub fn offsets(&self) -> &[(i32, i32)] {
        &self.offsets
    }

    /// How many legs each limit refused, of all between two nodes with an elevation.
    pub const fn refusals(&self) -> DriveRefusalCounts {
        self.refusals
    }

    /// The directions in which the rover drives from a node, a bit each.
    #[inline]
    pub fn directions(&self, node: usize) -> u32 {
        self.masks[node]
    }

    /// The neighbour of a node in a direction in which a leg is allowed.
    #[inline]
    pub fn neighbour(&self, node: usize, direction: usize) -> usize {
        node.wrapping_add_signed(self.steps[direction])
    }

    /// The node from which an allowed leg in a direction leads to a node.
    #[inline]
    pub fn behind(&self, node: usize, direction: usize) -> usize {
        node.wrapping_add_signed(-self.steps[direction])
    }

    /// What an allowed leg takes.
    #[inline]
    pub fn cost(&self, node: usize, direction: usize) -> f64 {
        match &self.prices {
            Prices::Posts(prices) => prices.cost(node, direction),
            Prices::Stored(costs) => costs[node * self.offsets.len() + direction],
        }
    }

    /// All that an allowed leg between posts takes, its extremes left out; `None` where the nodes are not the posts.
    pub fn sums(&self, node: usize, direction: usize) -> Option<DriveLeg> {
        match &self.prices {
            Prices::Posts(prices) => Some(prices.leg(node, direction)),
            Prices::Stored(_) => None,
        }
    }

    /// The leg from a node in a direction, with all that it takes, or why it is refused; `None` where there is no leg.
    pub fn leg(&self, node: usize, direction: usize) -> Option<Result<DriveLeg, DriveRefusal>> {
        let from = self.lattice.node(node);
        let to = self.moved(from, self.offsets[direction])?;
        Some(self.drive.leg(&self.position(from)?, &self.position(to)?))
    }

    /// Less than every leg of a direction takes, or as much.
    #[inline]
    pub(super) fn least(&self, direction: usize) -> f64 {
        self.least[direction]
    }

    pub(super) fn steps(&self) -> &[isize] {
        &self.steps
    }

    pub(super) fn masks(&self) -> &[u32] {
        &self.masks
    }

    /// The directions in which the rover drives to each node, a bit each.
    pub(crate) fn masks_into(&self) -> Vec<u32> {
        self.gathered(&self.masks, 0..self.offsets.len(), -1)
    }

    pub(super) fn position(&self, node: Post) -> Option<MapPosition> {
        self.lattice.position(self.drive.ground().terrain().dem(), node)
    }

    /// The node at an offset from another; `None` off the lattice.
    fn moved(&self, from: Post, (east, north): (i32, i32)) -> Option<Post> {
        let row = from.row.checked_add_signed(-(north as isize)).filter(|row| *row < self.lattice.rows)?;
        let col = from.col.checked_add_signed(east as isize).filter(|col| *col < self.lattice.cols)?;
        Some(Post { row, col })
    }

    /// The bits of some directions, each from the node that lies in that direction (`sign` 1) or behind it (-1).
    fn gathered(&self, masks: &[u32], directions: Range<usize>, sign: isize) -> Vec<u32> {
        let (rows, cols) = (self.lattice.rows, self.lattice.cols);
        let mut gathered = vec![0; masks.len()];
        gathered.par_chunks_mut(cols).enumerate().for_each(|(row, line)| {
            for direction in directions.clone() {
                let (east, north) = self.offsets[direction];
                let Some(other) = row.checked_add_signed(-sign * north as isize).filter(|other| *other < rows) else { continue };
                let east = sign * east as isize;
                let (first, end) = (usize::try_from(-east).unwrap_or(0), cols.saturating_sub(usize::try_from(east).unwrap_or(0)));
                if first >= end {
                    continue;
                }
                let from = other * cols + first.wrapping_add_signed(east);
                for (to, bits) in line[first..end].iter_mut().zip(&masks[from..]) {
                    *to |= bits & (1 << direction);
                }
            }
        });
        gathered
    }

    /// Judges legs between posts: those of half of the directions from every post there and back, then those back gathered by the post
    /// from which they begin.
    fn judge_posts(&mut self, meter: &Meter<'_>) -> Result<(), Cancelled> {
        let half = self.offsets.len() / 2;
        let dem = self.drive.ground().terrain().dem();
        let map = dem.georeference();
        let slopes: Vec<OffsetSlopes> = self.offsets[..half]
            .iter()
            .map(|offset| OffsetSlopes::new(*offset, &Template::new(map, *offset, 0.0), (map.dx_m(), map.dy_m())))
            .collect();
        let extras = Extras::new(self.drive, self.lattice, &self.offsets[..half]);
        let (rows, cols) = (self.lattice.rows, self.lattice.cols);
        let mut there_and_back = vec![0u32; rows * cols];
        let counts = there_and_back.par_chunks_mut(ROWS * cols).enumerate().map(|(block, masks)| {
            let first = block * ROWS;
            let window = Window::of(dem, first, first + masks.len() / cols);
            let mut counts = [0u64; KEPT as usize + 1];
            let mut heights = Vec::new();
            for (line, masks) in masks.chunks_exact_mut(cols).enumerate() {
                meter.check_piece(first + line)?;
                for (chunk, masks) in masks.chunks_mut(CHUNK).enumerate() {
                    let at = (first + line, chunk * CHUNK);
                    for (direction, slopes) in slopes.iter().enumerate() {
                        let (mut there, mut back) = ([NO_LEG; CHUNK], [NO_LEG; CHUNK]);
                        let (there, back) = (&mut there[..masks.len()], &mut back[..masks.len()]);
                        slopes.judge(&window, at, self.drive.ceilings(), there, back);
                        if let Some(extras) = &extras {
                            for (i, (there, back)) in there.iter_mut().zip(back.iter_mut()).enumerate() {
                                let from = Post { row: at.0, col: at.1 + i };
                                [*there, *back] =
                                    extras.judge(from, (direction, self.offsets[direction]), [*there, *back], &mut heights);
                            }
                        }
                        for ((mask, there), back) in masks.iter_mut().zip(there).zip(back) {
                            *mask |= u32::from(*there == KEPT) << direction | u32::from(*back == KEPT) << (direction + half);
                            for verdict in [*there, *back] {
                                if let Some(count) = counts.get_mut(usize::from(verdict)) {
                                    *count += 1;
                                }
                            }
                        }
                    }
                }
            }
            Ok(counts)
        });
        let counts: Vec<[u64; KEPT as usize + 1]> = counts.collect::<Result<_, Cancelled>>()?;
        for (limit, index) in DriveLimit::ALL.into_iter().zip(0..) {
            self.refusals.add(limit, counts.iter().map(|counts: &[u64; KEPT as usize + 1]| counts[index]).sum());
        }
        // A leg back in a direction of the second half begins at the neighbour: from its own post on, that neighbour lies in that direction.
        self.masks = self.gathered(&there_and_back, half..2 * half, 1);
        let low = (1u32 << half) - 1;
        self.masks.par_iter_mut().zip(&there_and_back).for_each(|(mask, own)| *mask |= own & low);
        Ok(())
    }

    /// Judges and prices every leg by itself.
    fn judge_nodes(&mut self, meter: &Meter<'_>) -> Result<(), Cancelled> {
        let (cols, directions) = (self.lattice.cols, self.offsets.len());
        let mut masks = vec![0u32; self.lattice.count()];
        let mut costs = vec![f64::INFINITY; self.lattice.count() * directions];
        let lines = masks.par_chunks_mut(cols).zip(costs.par_chunks_mut(cols * directions)).enumerate();
        let counts = lines.map(|(row, (masks, costs))| {
            meter.complete_one()?;
            let mut counts = DriveRefusalCounts::default();
            for (col, (mask, costs)) in masks.iter_mut().zip(costs.chunks_exact_mut(directions)).enumerate() {
                for (direction, cost) in costs.iter_mut().enumerate() {
                    match self.leg(row * cols + col, direction) {
                        None => {}
                        Some(Err(refusal)) => counts.count(refusal.limit()),
                        Some(Ok(leg)) => {
                            *mask |= 1 << direction;
                            *cost = match self.amount {
                                DriveAmount::Time => leg.time_s,
                                DriveAmount::Energy => leg.energy_j_kg,
                                DriveAmount::Length => leg.length_m,
                            };
                        }
                    }
                }
            }
            Ok(counts)
        });
        let counts: Vec<DriveRefusalCounts> = counts.collect::<Result<_, Cancelled>>()?;
        for counts in counts {
            self.refusals += counts;
        }
        (self.masks, self.prices) = (masks, Prices::Stored(costs));
        Ok(())
    }
}
