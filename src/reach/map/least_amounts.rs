//! The least total of an amount from the sources to every node: Dijkstra's algorithm in buckets.
//!
//! A bucket is all nodes whose least total of the first amount lies within one width of it. The nodes of a bucket offer their hops to all
//! others in rounds, until no label of the bucket changes any more (delta-stepping, Meyer and Sanders 2003): labels are the least sums in
//! whatever order the nodes of a bucket are looked at. A pair of nodes is tested only where a bound from its line of sight alone leaves
//! something to gain.

use std::{
    cmp::Ordering,
    collections::BTreeMap,
    sync::atomic::{AtomicBool, AtomicU64, Ordering as Memory},
};

use rayon::prelude::*;

use super::{
    HopMap, MapError, NO_GROUND, NOT_SEARCHED, Post, PostHops, UNREACHED,
    layer_bits::Disc,
    objective::MapObjective,
    search::{NONE, PathLabels},
};
use crate::{
    ballistics::LineOfSight,
    ground::Surface,
    planner::{Amount, Objective},
    progress::{Detail, Meter, PairCounter, Progress, Stage},
    quantity::SlopeInterval,
};

/// Totals in the order of an objective; those beyond its amounts are 0.
type Totals = [f64; Objective::MOST];

/// The least totals of an objective from the nearest source to every node.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastTotals {
    /// The paths found: their hops, and where each leads. Without an effort.
    pub paths: HopMap,
    /// For each node, row after row, the total of each amount of the objective; NaN without a path.
    totals: Vec<f64>,
    amounts: usize,
}

/// A path to a node that may be better than the one known.
#[derive(Clone, Copy, Debug)]
struct Offer {
    node: u32,
    offset: u32,
    source: u32,
    totals: Totals,
}

/// The best paths known.
struct Labels {
    amounts: usize,
    totals: Vec<f64>,
    /// The least first total offered so far, which a round lowers while it runs: only what it offers is lost by it.
    least: Vec<AtomicU64>,
    previous: Vec<u32>,
    nearest: Vec<u32>,
}

/// The least totals of an objective from the sources to every node, of the paths whose first total is within a budget. The result does not
/// depend on the number of threads.
///
/// Of equal totals, the path from the source of the lower number counts, then the one whose last hop is shorter. Nodes beyond the budget are
/// [`NOT_SEARCHED`].
///
/// # Arguments
/// `most`: the greatest total of the first amount; infinite: any.
///
/// # Errors
/// [`MapError`]; [`MapError::Request`] for an objective of an amount that is no sum over the hops of a map.
///
/// # Complexity
/// One test for every pair within reach that the bound leaves; `8 k + 53` bytes for every node with `k` amounts, and some megabytes of offers.
pub fn least_totals(
    hops: &PostHops,
    sources: &[Post],
    objective: &MapObjective,
    most: f64,
    progress: &dyn Progress,
) -> Result<LeastTotals, MapError> {
    MapObjective::accepts(objective.objective())?;
    let meter = Meter::new(progress, Stage::MapLayers);
    meter.report(Detail::None)?;
    let search = Search::new(hops, objective, most);
    let mut labels = Labels::new(hops, sources, objective.amounts().len());
    let mut buckets: BTreeMap<u64, Vec<u32>> = BTreeMap::new();
    for (number, &source) in (0..).zip(sources) {
        let node = hops.lattice().index(source);
        let begins = Offer { node: number_of(node), offset: NONE, source: number, totals: [0.0; Objective::MOST] };
        labels.take(&begins);
        buckets.entry(0).or_default().push(number_of(node));
    }
    let usable = (0..hops.lattice().count()).into_par_iter().filter(|&index| hops.usable(hops.lattice().node(index))).count();
    let mut settled = 0;
    while let Some((bucket, nodes)) = buckets.pop_first() {
        meter.set_done(settled, usable as u64);
        meter.report(Detail::None)?;
        settled += search.settle(bucket, nodes, (&mut labels, &mut buckets), &meter)?;
        meter.check()?;
    }
    let beyond = search.beyond.into_inner();
    labels.into_map(hops, beyond)
}

impl Labels {
    fn new(hops: &PostHops, sources: &[Post], amounts: usize) -> Self {
        let nodes = hops.lattice().count();
        Self {
            amounts,
            totals: vec![f64::INFINITY; nodes * amounts],
            least: (0..nodes).into_par_iter().map(|_| AtomicU64::new(f64::INFINITY.to_bits())).collect(),
            previous: vec![NONE; nodes],
            nearest: if sources.len() > 1 { vec![NONE; nodes] } else { Vec::new() },
        }
    }

    fn of(&self, node: usize) -> &[f64] {
        &self.totals[node * self.amounts..][..self.amounts]
    }

    fn first(&self, node: usize) -> f64 {
        self.totals[node * self.amounts]
    }

    fn source(&self, node: usize) -> u32 {
        self.nearest.get(node).copied().unwrap_or(0)
    }

    /// Whether the node is one that a path begins at.
    fn is_begin(&self, node: usize) -> bool {
        self.previous[node] == NONE
    }

    /// The order of totals and of what decides between equals, against what is known of a node.
    fn compared(&self, totals: &Totals, (node, source, offset): (usize, u32, u32)) -> Ordering {
        let by_totals = totals.iter().zip(self.of(node)).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
        by_totals.unwrap_or_else(|| (source, rank(offset)).cmp(&(self.source(node), rank(self.previous[node]))))
    }

    /// Takes an offer if it is better.
    fn take(&mut self, offer: &Offer) -> bool {
        let node = offer.node as usize;
        if self.compared(&offer.totals, (node, offer.source, offer.offset)) != Ordering::Less {
            return false;
        }
        let amounts = self.amounts;
        self.totals[node * amounts..][..amounts].copy_from_slice(&offer.totals[..amounts]);
        self.least[node].fetch_min(offer.totals[0].to_bits(), Memory::Relaxed);
        self.previous[node] = offer.offset;
        if let Some(nearest) = self.nearest.get_mut(node) {
            *nearest = offer.source;
        }
        true
    }

    /// The map of the paths. `beyond` says that paths beyond the budget were left out.
    fn into_map(mut self, hops: &PostHops, beyond: bool) -> Result<LeastTotals, MapError> {
        let lattice = hops.lattice();
        let mark = |index: usize| match lattice.node(index) {
            node if !hops.has_ground(node) => NO_GROUND,
            node if beyond && hops.usable(node) => NOT_SEARCHED,
            _ => UNREACHED,
        };
        let marks = (0..lattice.count()).into_par_iter().map(mark).collect();
        let reached: Vec<bool> = (0..lattice.count()).map(|node| self.first(node) < f64::INFINITY).collect();
        self.totals.iter_mut().filter(|total| total.is_infinite()).for_each(|total| *total = f64::NAN);
        let labels = PathLabels { marks, reached, previous: self.previous, nearest: self.nearest };
        Ok(LeastTotals { paths: HopMap::of_paths(hops, labels)?, totals: self.totals, amounts: self.amounts })
    }
}

impl LeastTotals {
    /// The paths, and for each amount of the objective its totals.
    pub fn into_parts(self) -> (HopMap, Vec<Vec<f64>>) {
        let totals = (0..self.amounts).map(|place| self.of(place)).collect();
        (self.paths, totals)
    }

    /// The total of the amount of this place in the objective at every node, row after row; NaN without a path.
    ///
    /// # Panics
    /// Panics if the objective has no such place.
    pub fn of(&self, place: usize) -> Vec<f64> {
        assert!(place < self.amounts, "the objective has {} amounts", self.amounts);
        self.totals.iter().skip(place).step_by(self.amounts).copied().collect()
    }

    /// The bytes of the search and its labels for each node.
    pub(crate) const fn bytes_per_node(amounts: usize, several: bool) -> usize {
        // Totals, the least offered, the previous hop, hops, the mark of a reached node, the buckets, which grow to twice their length; the
        // hops while they are counted.
        let source = if several { size_of::<u32>() } else { 0 };
        (amounts + 3) * size_of::<f64>() + size_of::<u32>() + 2 * size_of::<i16>() + 1 + 4 * size_of::<u32>() + source
    }

    /// The bytes of the offers of one round, at most, where a node has so many others within reach.
    pub(crate) const fn round_bytes(offsets: usize) -> usize {
        3 * Search::ROUND * offsets * size_of::<Offer>()
    }
}

/// What a search does not change.
struct Search<'a> {
    hops: &'a PostHops,
    objective: &'a MapObjective,
    /// The greatest first total.
    most: f64,
    /// The width of a bucket.
    width: f64,
    /// The nodes within reach of a node.
    disc: Disc,
    /// Whether something lies beyond the budget.
    beyond: AtomicBool,
}

impl<'a> Search<'a> {
    /// Nodes whose hops are offered at once: so many keep the threads busy, and so few that their offers take some megabytes.
    const ROUND: usize = 256;
    /// Nodes of a round that one thread looks at in one go.
    const PIECE: usize = 16;

    fn new(hops: &'a PostHops, objective: &'a MapObjective, most: f64) -> Self {
        // No shorter hop over level ground exists; most of the steeper ones still lead out of a bucket of half of it.
        let shortest_m = hops.offsets().first().map_or(1.0, |offset| offset.run_m);
        let least = objective.bound(0, LineOfSight::new(shortest_m, 0.0));
        let width = if least > 0.0 { 0.5 * least } else { 1.0 };
        Self { hops, objective, most, width, disc: Disc::of(hops.offsets()), beyond: AtomicBool::new(false) }
    }

    /// The bucket of a total.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
    fn bucket(&self, total: f64) -> u64 {
        (total / self.width) as u64
    }

    /// Offers the hops of the nodes of a bucket until none of its labels changes; returns how many nodes it had.
    fn settle(
        &self,
        bucket: u64,
        mut nodes: Vec<u32>,
        (labels, buckets): (&mut Labels, &mut BTreeMap<u64, Vec<u32>>),
        meter: &Meter<'_>,
    ) -> Result<u64, MapError> {
        let mut settled = 0;
        while !nodes.is_empty() {
            nodes.sort_unstable();
            nodes.dedup();
            // Others have moved to a bucket before this one.
            nodes.retain(|&node| self.bucket(labels.first(node as usize)) == bucket);
            settled += nodes.len() as u64;
            let mut again = Vec::new();
            for round in nodes.chunks(Self::ROUND) {
                for offer in self.offers(round, labels, meter)? {
                    let known = labels.first(offer.node as usize);
                    if !labels.take(&offer) {
                        continue;
                    }
                    let to = self.bucket(offer.totals[0]);
                    if to <= bucket {
                        again.push(offer.node);
                    } else if known.is_infinite() || self.bucket(known) != to {
                        buckets.entry(to).or_default().push(offer.node);
                    }
                }
            }
            nodes = again;
        }
        Ok(settled)
    }

    /// What the hops of some nodes offer.
    fn offers(&self, nodes: &[u32], labels: &Labels, meter: &Meter<'_>) -> Result<Vec<Offer>, MapError> {
        let of_piece = |counter: &mut PairCounter<'_>, piece: &[u32]| {
            let mut found = Vec::new();
            for &node in piece {
                counter.check()?;
                self.from(node as usize, labels, &mut found, counter)?;
            }
            Ok(found)
        };
        if nodes.len() <= Self::PIECE {
            return of_piece(&mut meter.counter(), nodes);
        }
        let pieces: Vec<Result<Vec<Offer>, MapError>> =
            nodes.par_chunks(Self::PIECE).map_init(|| meter.counter(), |counter, piece| of_piece(counter, piece)).collect();
        meter.check()?;
        Ok(pieces.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// What the hops of a node offer.
    fn from(&self, index: usize, labels: &Labels, found: &mut Vec<Offer>, counter: &mut PairCounter<'_>) -> Result<(), MapError> {
        let (hops, lattice) = (self.hops, self.hops.lattice());
        let from = lattice.node(index);
        if !hops.usable(from) {
            return Ok(());
        }
        let within = hops.within_reach(lattice.block_of(from));
        let (offsets, steps) = (&hops.offsets()[..within], &hops.node_steps()[..within]);
        let inside = self.disc.is_inside(lattice, from);
        let (own, source, is_first) = (labels.of(index), labels.source(index), labels.is_begin(index));
        let from_m = hops.height_m(from);
        for (number, (offset, &step)) in (0u32..).zip(offsets.iter().zip(steps)) {
            let to = if inside {
                index.wrapping_add_signed(step)
            } else {
                let Some(to) = hops.moved(from, offset.rows, offset.cols) else { continue };
                lattice.index(to)
            };
            let least = || f64::from_bits(labels.least[to].load(Memory::Relaxed));
            if own[0] > least() {
                continue;
            }
            let sight = LineOfSight::new(offset.run_m, hops.height_of_index_m(to) - from_m);
            let bound = own[0] + self.objective.bound(0, sight);
            // Written so that a missing elevation ends here too.
            let is_worth = bound <= least();
            if !is_worth || !self.may_improve(own, sight, labels, (to, source, number)) {
                continue;
            }
            if bound > self.most {
                self.beyond.store(true, Memory::Relaxed);
                continue;
            }
            if !hops.usable(lattice.node(to)) {
                continue;
            }
            counter.pair()?;
            let worth = |sight: LineOfSight, lofts: SlopeInterval| {
                self.objective.bound_of_lofts(sight, lofts, is_first).is_none_or(|bound| own[0] + bound <= least())
            };
            let Some((sight, lofts)) = hops.lofts_where(from, offset, worth)? else { continue };
            let totals = self.objective.best(own, sight, lofts, is_first).1;
            if totals[0] > self.most {
                self.beyond.store(true, Memory::Relaxed);
                continue;
            }
            if totals[0] > least() || labels.compared(&totals, (to, source, number)) != Ordering::Less {
                continue;
            }
            labels.least[to].fetch_min(totals[0].to_bits(), Memory::Relaxed);
            found.push(Offer { node: number_of(to), offset: number, source, totals });
        }
        Ok(())
    }

    /// Whether a hop along a line of sight may give a node a better label than it has.
    fn may_improve(&self, own: &[f64], sight: LineOfSight, labels: &Labels, (to, source, offset): (usize, u32, u32)) -> bool {
        let known = labels.of(to);
        for (place, (own, known)) in own.iter().zip(known).enumerate() {
            let bound = self.objective.amounts()[place].join(*own, self.objective.bound(place, sight));
            match bound.total_cmp(known) {
                Ordering::Less => return true,
                Ordering::Greater => return false,
                Ordering::Equal => {}
            }
        }
        (source, rank(offset)) < (labels.source(to), rank(labels.previous[to]))
    }
}

/// The place of a last hop among equals: a source begins before any hop leads to it.
const fn rank(offset: u32) -> u32 {
    offset.wrapping_add(1)
}

/// The number of a node in a label.
#[expect(clippy::cast_possible_truncation, reason = "a map has at most as many nodes as 32 bits number")]
const fn number_of(node: usize) -> u32 {
    node as u32
}

/// The totals of an amount along the paths of a map: the sums over their hops from the source on.
///
/// # Returns
/// For each node, row after row; NaN without a path.
///
/// # Errors
/// [`MapError`].
pub fn totals_along(hops: &PostHops, paths: &HopMap, amount: Amount, objective: &MapObjective) -> Result<Vec<f64>, MapError> {
    let lattice = hops.lattice();
    let limits = hops.ground().hopper().limits();
    let of_last_hop = |index: usize| -> Result<f64, MapError> {
        let node = lattice.node(index);
        let Some((from, offset)) = paths.last_hop(hops, node) else { return Ok(0.0) };
        let is_first = paths.last_hop(hops, from).is_none();
        let Some((sight, lofts)) = hops.lofts_where(from, &hops.offsets()[offset], |_, _| true)? else { return Ok(f64::NAN) };
        let arc = objective.arc(sight, lofts, is_first);
        Ok(amount.of_arc(&arc, limits, is_first))
    };
    let each: Vec<f64> = (0..lattice.count()).into_par_iter().map(of_last_hop).collect::<Result<_, _>>()?;
    Ok(paths.summed(hops, &each, |total, hop| amount.join(total, hop)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_comes_before_every_hop_in_the_order_of_equals() {
        let labels =
            Labels { amounts: 1, totals: vec![0.0], least: vec![AtomicU64::new(0)], previous: vec![NONE], nearest: vec![] };
        assert_eq!(labels.compared(&[0.0; 4], (0, 0, 0)), Ordering::Greater);
        assert_eq!(labels.compared(&[0.0; 4], (0, 0, NONE)), Ordering::Equal);
    }
}
