//! The search: label-setting A* in batches. A batch is all open nodes with the same lower bound on the total number of hops and
//! the same number of hops from the start. The edges of a batch are evaluated when its nodes are settled, and never stored.
//!
//! Since every edge takes at least one hop and the bound is consistent, the label of a node is final when its batch is taken from
//! the queue. Any number of threads may evaluate a batch in any order. Offers to a node are
//! compared by cost, then by the index of the predecessor (the smaller one wins, the start before all). This is a total
//! order, so the result does not depend on the order of evaluation.

use std::{
    collections::BTreeMap,
    ops::{ControlFlow, Range},
    sync::Arc,
};

use rayon::prelude::*;

use super::{
    Cost, HopGraph, RefusalCounts,
    goals::Goals,
    local_reach::{HopsLeft, LocalReach},
    nodes::around,
};
use crate::{
    chain::Station,
    ground::{LandingTable, Sweep},
    progress::{Cancelled, Meter, PairCounter},
    quantity::{NodeId, SlopeInterval},
    world::{Direction, Limit},
};

/// The predecessor of a label: the start (0), or a node as its index plus one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Origin(u32);

impl Origin {
    /// The start itself.
    pub(super) const START: Self = Self(0);

    /// A node.
    #[expect(clippy::cast_possible_truncation, reason = "a node set has at most 20 million nodes")]
    const fn node(index: usize) -> Self {
        Self(index as u32 + 1)
    }

    /// The node's index; `None` for the start.
    pub(super) const fn index(self) -> Option<usize> {
        (self.0 as usize).checked_sub(1)
    }
}

/// The best known path to a node or a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Label {
    pub(super) cost: Cost,
    pub(super) from: Origin,
    /// Whether the label is final.
    settled: bool,
}

impl Label {
    /// No path known.
    pub(super) const UNKNOWN: Self = Self { cost: Cost::UNREACHED, from: Origin(u32::MAX), settled: false };

    /// The label of the start.
    pub(super) const fn at_start() -> Self {
        Self { cost: Cost::of_hops(0), from: Origin::START, settled: true }
    }

    /// Accepts an offer if it is better, by cost, then by origin.
    pub(super) fn offer(&mut self, cost: Cost, from: Origin) {
        if self.takes(cost, from) {
            (self.cost, self.from) = (cost, from);
        }
    }

    /// Whether an offer is better than the known path.
    fn takes(&self, cost: Cost, from: Origin) -> bool {
        (cost, from) < (self.cost, self.from)
    }

    /// Whether a path is known.
    pub(super) const fn is_known(&self) -> bool {
        self.cost.hops() < Cost::UNREACHED.hops()
    }

    /// Whether a path with this many hops could be better.
    const fn waits_for(&self, hops: u64, aim: Aim) -> bool {
        let known = self.cost.hops();
        !self.settled
            && match aim {
                Aim::HopsThenEffort => known >= hops,
                Aim::Hops => known > hops,
            }
    }
}

/// The amount of work done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    /// Pairs passed to the hop test.
    pub(super) pairs: u64,
    /// The refused pairs by limit.
    pub(super) refusals: RefusalCounts,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.refusals += other.refusals;
    }
}

/// A station from which hops leave, with the cost of the path to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Takeoff {
    pub(super) station: Station,
    pub(super) cost: Cost,
    pub(super) origin: Origin,
    /// A bound on the distance of one hop from here, m.
    pub(super) reach_m: f64,
}

/// What a search minimises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aim {
    /// Fewest hops, then least effort.
    HopsThenEffort,
    /// Only the number of hops: the first path with the fewest hops is enough.
    Hops,
}

/// A label-setting A* search in batches over one graph, run for one start after another. A batch is all open nodes with the same
/// lower bound on the total number of hops and the same number of hops from the start.
#[derive(Debug)]
pub(super) struct BatchedSearch<'g> {
    graph: &'g HopGraph,
    table: &'g Arc<LandingTable>,
    reach: &'g LocalReach,
    aim: Aim,
    labels: Vec<Label>,
    /// The nodes whose labels have to be reset before the next start.
    known: Vec<u32>,
    /// Open nodes, by the least number of hops of any path through them to a goal, then by their own hops.
    due: BTreeMap<(u64, u64), Vec<u32>>,
    sweep: Sweep,
    tally: Tally,
    /// Batches of at least this many pairs are split among threads; for smaller ones, waking the threads costs more than it saves.
    shared_from_pairs: usize,
    /// In tests, the order in which a batch is evaluated.
    #[cfg(test)]
    arrange: fn(&mut [Takeoff]),
}

impl<'g> BatchedSearch<'g> {
    /// About 100 to 200 microseconds of work.
    const SHARED_FROM_PAIRS: usize = 4096;
    /// Parts per thread of a shared batch, which balances parts of unequal work.
    const PIECES_PER_THREAD: usize = 4;

    /// A search that has not run yet.
    pub(super) fn new(graph: &'g HopGraph, table: &'g Arc<LandingTable>, reach: &'g LocalReach, aim: Aim) -> Self {
        Self {
            graph,
            table,
            reach,
            aim,
            labels: vec![Label::UNKNOWN; graph.nodes().stations().len()],
            known: Vec::new(),
            due: BTreeMap::new(),
            sweep: Sweep::new(Arc::clone(table)),
            tally: Tally::default(),
            shared_from_pairs: Self::SHARED_FROM_PAIRS,
            #[cfg(test)]
            arrange: |_| {},
        }
    }

    /// The work of the last run.
    pub(super) fn tally(&self) -> Tally {
        self.tally.clone()
    }

    /// The fewest hops to a node; `None` if it is unreachable.
    ///
    /// Valid only after a run that settled every reachable node, that is, one with no goals or with an unreached goal; other runs
    /// stop early.
    pub(super) fn hops(&self, node: NodeId) -> Option<u64> {
        let label = self.labels[node.index()];
        label.is_known().then(|| label.cost.hops())
    }

    /// The stations of the best path to a goal, from the start on and without the goal, after a run that found one.
    pub(super) fn stations_before(&self, start: &Station, goal: &Label) -> Vec<Station> {
        let mut from = goal.from;
        let mut stations = Vec::new();
        while let Some(node) = from.index() {
            stations.push(self.graph.nodes().stations()[node]);
            from = self.labels[node].from;
        }
        stations.push(*start);
        stations.reverse();
        stations
    }

    /// Searches from a start until every goal has its best path, or until all reachable nodes are settled.
    ///
    /// Nodes are settled in the order of the least number of hops that a path through them can have: their own hops plus the
    /// bound on the remaining ones (A*). Nodes with the same two numbers form one batch. The bound is consistent (along an
    /// edge it falls by at most the edge's hops), so a batch is complete when its turn comes, and every node on a best path
    /// has been settled before.
    ///
    /// # Errors
    /// [`Cancelled`]; the next run begins anew.
    pub(super) fn run(&mut self, start: &Station, goals: &mut Goals, meter: &Meter<'_>) -> Result<(), Cancelled> {
        let left = HopsLeft::to(self.reach, goals.stations());
        self.forget();
        if let Some(node) = self.graph.nodes().find(start) {
            self.labels[node.index()] = Label::at_start();
            self.known.extend(u32::try_from(node.index()));
        }
        goals.arrive_at(start);
        let first = Takeoff { station: *start, cost: Cost::of_hops(0), origin: Origin::START, reach_m: self.reach.at_m(start) };
        self.expand(&mut [first], goals, left, meter)?;
        while let Some(((least, hops), nodes)) = self.due.pop_first() {
            if least > goals.most_hops() {
                break;
            }
            let mut batch = self.settle(nodes, hops);
            self.expand(&mut batch, goals, left, meter)?;
        }
        Ok(())
    }

    /// Resets the labels of the previous start.
    fn forget(&mut self) {
        for node in self.known.drain(..) {
            self.labels[node as usize] = Label::UNKNOWN;
        }
        self.due.clear();
        self.tally = Tally::default();
    }

    /// Marks the nodes of a batch as settled and returns them as take-offs from left to right. Skips nodes already settled with
    /// fewer hops.
    fn settle(&mut self, mut nodes: Vec<u32>, hops: u64) -> Vec<Takeoff> {
        nodes.sort_unstable();
        let stations = self.graph.nodes().stations();
        let mut takeoffs = Vec::with_capacity(nodes.len());
        for node in nodes.into_iter().map(|node| node as usize) {
            let label = &mut self.labels[node];
            if label.settled || label.cost.hops() != hops {
                continue;
            }
            label.settled = true;
            let station = stations[node];
            let reach_m = self.reach.at_m(&station);
            takeoffs.push(Takeoff { station, cost: label.cost, origin: Origin::node(node), reach_m });
        }
        takeoffs
    }

    /// Evaluates the edges out of a batch, given from left to right: to the goals, and to the nodes unless the goals' labels
    /// show that no path through them can be better.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn expand(&mut self, batch: &mut [Takeoff], goals: &mut Goals, left: HopsLeft<'_>, meter: &Meter<'_>) -> Result<(), Cancelled> {
        self.tally += goals.land_from(self.graph, batch, meter)?;
        // Any other path to a goal needs at least two more hops: one to a node, one from it to the goal.
        let Some(takeoff) = batch.first() else { return Ok(()) };
        if takeoff.cost.hops() + 2 > goals.most_hops() {
            return Ok(());
        }
        let mut begin = 0;
        while begin < batch.len() {
            // Take-offs with overlapping ranges of landings, which together form one contiguous range of nodes.
            let mut window = self.landings(&batch[begin]);
            let mut end = begin + 1;
            while let Some(range) = batch.get(end).map(|takeoff| self.landings(takeoff)).filter(|r| r.start < window.end) {
                window = window.start.min(range.start)..window.end.max(range.end);
                end += 1;
            }
            self.sweep_stretch(&mut batch[begin..end], window, left, meter)?;
            begin = end;
        }
        Ok(())
    }

    /// The nodes within reach of a take-off.
    fn landings(&self, takeoff: &Takeoff) -> Range<usize> {
        around(self.graph.nodes().stations(), &takeoff.station, takeoff.reach_m)
    }

    /// Evaluates the edges from take-offs with equal hops to all nodes of a range that could get better labels from them.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn sweep_stretch(
        &mut self,
        batch: &mut [Takeoff],
        window: Range<usize>,
        left: HopsLeft<'_>,
        meter: &Meter<'_>,
    ) -> Result<(), Cancelled> {
        let Some(hops) = batch.first().map(|takeoff| takeoff.cost.hops() + 1) else { return Ok(()) };
        let waits = |node: &usize| self.labels[*node].waits_for(hops, self.aim);
        let waiting: Vec<usize> = window.filter(waits).collect();
        let (Some(&first), Some(&last)) = (waiting.first(), waiting.last()) else { return Ok(()) };
        #[cfg(test)]
        (self.arrange)(batch);
        let Self { graph, aim, .. } = *self;
        let stretch = Stretch { graph, aim, hops, first, waiting: &waiting, labels: &self.labels[first..=last] };
        let pairs = batch.len().saturating_mul(waiting.len());
        let threads = rayon::current_num_threads();
        let found: Result<Vec<(Vec<Label>, Tally)>, Cancelled> = if pairs < self.shared_from_pairs || threads == 1 {
            stretch.offers(&mut self.sweep, &mut meter.counter(), batch).map(|offers| vec![offers])
        } else {
            let pieces = batch.par_chunks(batch.len().div_ceil(threads * Self::PIECES_PER_THREAD));
            let begin = || (Sweep::new(Arc::clone(self.table)), meter.counter());
            pieces.map_init(begin, |(sweep, counter), piece| stretch.offers(sweep, counter, piece)).collect()
        };
        meter.check()?;
        for (offers, tally) in found? {
            self.tally += tally;
            for (node, offer) in (first..).zip(offers) {
                self.take(node, &offer, left);
            }
        }
        Ok(())
    }

    /// Accepts an offer to a node if it is better than the known path, and opens the node if it has fewer hops.
    fn take(&mut self, node: usize, offer: &Label, left: HopsLeft<'_>) {
        let label = &mut self.labels[node];
        let before = *label;
        label.offer(offer.cost, offer.from);
        if label.cost.hops() == before.cost.hops() {
            return;
        }
        let hops = label.cost.hops();
        #[expect(clippy::cast_possible_truncation, reason = "a node set has at most 20 million nodes")]
        let id = node as u32;
        if !before.is_known() {
            self.known.push(id);
        }
        let least = hops.saturating_add(left.from(&self.graph.nodes().stations()[node]));
        self.due.entry((least, hops)).or_default().push(id);
    }
}

/// The labels of a contiguous range of nodes, and the indices within it (`waiting`) whose labels could still improve by a hop from
/// take-offs with the same hop count.
#[derive(Clone, Copy)]
struct Stretch<'s> {
    graph: &'s HopGraph,
    aim: Aim,
    /// The number of hops at a landing.
    hops: u64,
    first: usize,
    /// The nodes whose labels a landing could improve.
    waiting: &'s [usize],
    labels: &'s [Label],
}

impl Stretch<'_> {
    /// The best labels that a set of take-offs can offer.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn offers(
        &self,
        sweep: &mut Sweep,
        counter: &mut PairCounter<'_>,
        takeoffs: &[Takeoff],
    ) -> Result<(Vec<Label>, Tally), Cancelled> {
        let mut labels = self.labels.to_vec();
        let mut tally = Tally::default();
        for takeoff in takeoffs {
            counter.check()?;
            let range = around(self.graph.nodes().stations(), &takeoff.station, takeoff.reach_m);
            let place = |node: usize| self.waiting.partition_point(|&waiting| waiting < node);
            let in_reach = &self.waiting[place(range.start)..place(range.end)];
            let x_m = takeoff.station.point.x_m;
            let (behind, ahead) =
                in_reach.split_at(in_reach.partition_point(|&node| self.graph.nodes().stations()[node].point.x_m <= x_m));
            for (landings, direction) in [(behind, Direction::Reverse), (ahead, Direction::Forward)] {
                let waits = |node: &&usize| labels[**node - self.first].waits_for(self.hops, self.aim);
                let (Some(&first), Some(&last)) = (landings.iter().find(waits), landings.iter().rfind(waits)) else { continue };
                let swept = sweep.landings_while(&takeoff.station, first..last + 1, direction, |node, single| {
                    let label = &mut labels[node - self.first];
                    if !label.waits_for(self.hops, self.aim) {
                        return ControlFlow::Continue(());
                    }
                    if let Err(cancelled) = counter.pair() {
                        return ControlFlow::Break(cancelled);
                    }
                    self.evaluate(takeoff, node, single, label, &mut tally);
                    ControlFlow::Continue(())
                });
                if let ControlFlow::Break(cancelled) = swept {
                    return Err(cancelled);
                }
            }
        }
        Ok((labels, tally))
    }

    /// Offers a node the result of the hop test for one pair, if that could improve its label.
    #[inline]
    fn evaluate(&self, takeoff: &Takeoff, node: usize, single: Result<SlopeInterval, Limit>, label: &mut Label, tally: &mut Tally) {
        tally.pairs += 1;
        let landing = &self.graph.nodes().stations()[node];
        match self.graph.edge_of(&takeoff.station, landing, single) {
            Ok(edge) => {
                let least = takeoff.cost + Cost::of_hops(edge.hops());
                match self.aim {
                    Aim::Hops => label.offer(least, takeoff.origin),
                    // The edge's effort need not be computed if the cost would be too high without it.
                    Aim::HopsThenEffort if label.takes(least, takeoff.origin) => {
                        label.offer(takeoff.cost + self.graph.cost(&takeoff.station, landing, edge), takeoff.origin);
                    }
                    Aim::HopsThenEffort => {}
                }
            }
            Err(limit) => tally.refusals.count(limit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ballistics::TakeoffChoice,
        chain::{ConstrainedChain, PolygonalChain},
        graph::{Effort, NodeSet, PointSpacing},
        hop::{HopTest, Split},
        progress::Stage,
        quantity::{ChainPoint, VertexId},
        world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    /// Level ground with a few needles, where many hops cost the same to the last bit.
    fn chain() -> ConstrainedChain {
        let height = |i: u8| if i % 7 == 3 { 0.5 } else { 0.0 };
        let points = (0..60).map(|i| ChainPoint::new(f64::from(i), height(i))).collect();
        let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.8).unwrap())), rest: RestSlope::Unlimited };
        ConstrainedChain::new(
            PolygonalChain::bare(points).unwrap(),
            &Hopper::with_speeds(5.0, 5.0).unwrap(),
            Gravity::new(3.711).unwrap(),
            &surface,
        )
        .unwrap()
    }

    /// Unchanged, reversed, and shuffled like cards.
    const ORDERS: [fn(&mut [Takeoff]); 3] = [
        |_| {},
        <[Takeoff]>::reverse,
        |batch| {
            let half = batch.len() / 2;
            batch.rotate_left(half);
            for i in (0..half).step_by(2) {
                batch.swap(i, half + i);
            }
        },
    ];

    #[test]
    fn neither_the_order_nor_the_threads_change_a_label() {
        let chain = chain();
        let test = HopTest::new(chain.clone());
        let nodes = NodeSet::of_chain(&chain, PointSpacing::PerSegment(2)).unwrap();
        let (table, reach) = (Arc::new(LandingTable::new(&test, nodes.shared_stations())), LocalReach::of(&test));
        let at = |i| chain.geometry().vertex_station(VertexId(i));
        for effort in Effort::ALL {
            let graph = HopGraph::new(&test, &nodes, effort, TakeoffChoice::LeastSpeed, Split::FullReach);
            let mut expected = None;
            for (arrange, threads) in ORDERS.into_iter().flat_map(|order| [1, 2, 7].map(|threads| (order, threads))) {
                let mut goals = Goals::new(&[at(59), at(40)]);
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let found = pool.install(|| {
                    let mut search = BatchedSearch::new(&graph, &table, &reach, Aim::HopsThenEffort);
                    (search.arrange, search.shared_from_pairs) = (arrange, 0);
                    search.run(&at(1), &mut goals, &Meter::new(&(), Stage::Search)).unwrap();
                    (search.labels.clone(), search.tally, goals.labels())
                });
                assert!(found.2.iter().all(Option::is_some));
                assert!(expected.get_or_insert_with(|| found.clone()) == &found, "{effort:?}, {threads} threads");
            }
        }
    }

    #[test]
    fn among_equal_offers_the_leftmost_origin_wins() {
        let mut label = Label::UNKNOWN;
        for (hops, from) in [(3, 8), (2, 9), (2, 4), (2, 6), (3, 0)] {
            label.offer(Cost::of_hops(hops), Origin::node(from));
        }
        assert_eq!((label.cost.hops(), label.from), (2, Origin::node(4)));
        label.offer(Cost::of_hops(2), Origin::START);
        assert_eq!(label.from, Origin::START);
    }

    #[test]
    fn a_run_does_not_affect_the_next_one() {
        let chain = chain();
        let test = HopTest::new(chain.clone());
        let nodes = NodeSet::of_chain(&chain, PointSpacing::PerSegment(1)).unwrap();
        let graph = HopGraph::new(&test, &nodes, Effort::Time, TakeoffChoice::MidRange, Split::Equal);
        let (table, reach) = (Arc::new(LandingTable::new(&test, nodes.shared_stations())), LocalReach::of(&test));
        let at = |i| chain.geometry().vertex_station(VertexId(i));
        let meter = Meter::new(&(), Stage::Search);
        let mut one = BatchedSearch::new(&graph, &table, &reach, Aim::HopsThenEffort);
        for start in [0, 30, 59, 12] {
            let mut fresh = BatchedSearch::new(&graph, &table, &reach, Aim::HopsThenEffort);
            let (mut goals, mut same) = (Goals::new(&[at(20), at(45)]), Goals::new(&[at(20), at(45)]));
            one.run(&at(start), &mut goals, &meter).unwrap();
            fresh.run(&at(start), &mut same, &meter).unwrap();
            assert_eq!((one.labels.clone(), one.tally.clone(), goals.labels()), (fresh.labels, fresh.tally, same.labels()));
        }
    }
}
