//! The best of the paths of fewest hops over a DEM, layer by layer.
//!
//! Where an objective begins with the hops, its best path visits one node of each layer: after k hops one that k hops reach and from which
//! the goal is as many hops away as are left. The best path to a node comes from the layer before, and one label is enough for each node.
//! Of the hops to a node the one that takes least by its lower bound is computed first, and others only while their bounds are below what
//! is known.

use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::{
    Amounts, LabelCap, Objective, PathStep, SearchResult, SurfaceLegs, SurfaceNode,
    fewest_hops::{FewestHops, nodes_beside},
    labels::{NONE, by_objective},
    search::{Waiting, path_along},
    surface_hops::Side,
    surface_legs::LegOffers,
};
use crate::{
    ground::MapPosition,
    progress::{Cancelled, Meter, PairCounter},
};

/// What the best path to a node takes by the objective, filled up with zeros.
type Key = [f64; Objective::MOST];

/// The best path to a node.
#[derive(Clone, Copy, Debug)]
struct Label {
    node: SurfaceNode,
    at: MapPosition,
    key: Key,
    /// The label before it; [`NONE`] at the start.
    before: u32,
    /// The command of the last hop.
    command: u32,
}

/// The labels of all layers so far.
struct Layers<'a> {
    offers: &'a LegOffers<'a>,
    objective: &'a Objective,
    labels: Vec<Label>,
    /// Where the labels of the last layer begin.
    last: usize,
    /// The label of each node; [`NONE`] without one.
    of_node: Vec<u32>,
}

/// The best path by an objective that begins with the hops, over nodes with known fewest hops to the goal.
///
/// Of equal paths the one whose labels are older; layers are in the order of the rows of nodes.
///
/// # Errors
/// [`Cancelled`].
///
/// # Complexity
/// 4 bytes for each node and some 72 for each label. Every node of a layer looks at the labels of the layer before within reach.
pub(super) fn best_of_fewest(
    legs: &SurfaceLegs<'_>,
    hops_left: &FewestHops,
    (objective, cap): (&Objective, LabelCap),
    meter: &Meter<'_>,
) -> Result<SearchResult, Cancelled> {
    let (offers, (start, goal)) = (&legs.offers, legs.ends());
    let start = SurfaceNode::of_index(start);
    let surface = offers.surface;
    let mut layers = Layers { offers, objective, labels: Vec::new(), last: 0, of_node: vec![NONE; surface.nodes.count()] };
    let mut capped = false;
    if let Some(at) = surface.position(start) {
        layers.add(Label { node: start, at, key: Key::default(), before: NONE, command: 0 });
    }
    for left in (0..hops_left.of(start).unwrap_or(0)).rev() {
        meter.check()?;
        let layer: Vec<SurfaceNode> = layers.labels[layers.last..].iter().map(|label| label.node).collect();
        let next = nodes_beside(surface, Side::Start, &layer, |node| hops_left.of(node) == Some(left));
        let begin = || (meter.counter(), Vec::new());
        let best = |(counter, waiting): &mut (_, _), node: &SurfaceNode| layers.best_to(*node, counter, waiting);
        let found: Vec<(Option<Label>, u64)> = next.par_iter().with_min_len(8).map_init(begin, best).collect::<Result<_, _>>()?;
        legs.count(found.iter().map(|(_, pairs)| pairs).sum());
        layers.last = layers.labels.len();
        for label in found.into_iter().filter_map(|(label, _)| label) {
            capped |= layers.labels.len() >= cap.in_all;
            if layers.labels.len() < cap.in_all {
                layers.add(label);
            }
        }
    }
    let path = layers.steps_to(goal).map(|steps| path_along(legs, steps)).transpose()?;
    let reached = layers.labels.len();
    Ok(SearchResult { path, capped, labels: reached, settled: layers.last, reached })
}

impl Layers<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "no more labels than nodes, which are numbered in 32 bits")]
    fn add(&mut self, label: Label) {
        self.of_node[label.node.index()] = self.labels.len() as u32;
        self.labels.push(label);
    }

    /// A key with what one more hop takes.
    fn extended(&self, key: &Key, hop: &Amounts) -> Key {
        let mut sum = Key::default();
        for ((sum, total), amount) in sum.iter_mut().zip(key).zip(self.objective.amounts()) {
            *sum = amount.join(*total, hop.of(*amount));
        }
        sum
    }

    /// The best label of a node over the hops from the last layer, and how many hops were computed.
    fn best_to(
        &self,
        node: SurfaceNode,
        counter: &mut PairCounter<'_>,
        waiting: &mut Vec<Waiting>,
    ) -> Result<(Option<Label>, u64), Cancelled> {
        let surface = self.offers.surface;
        let Some(at) = surface.position(node) else { return Ok((None, 0)) };
        let mut heap = std::mem::take(waiting);
        for known in surface.about(&at, Side::Goal) {
            let before = self.of_node[known.index()];
            let Some(label) = self.labels.get(before as usize).filter(|_| before as usize >= self.last) else { continue };
            if let Some((sight, _)) = surface.sight(&label.at, &at) {
                let key = self.extended(&label.key, &self.offers.least.of_hop(sight));
                heap.push(Waiting { key, node: label.node.0, label: before });
            }
        }
        let mut heap = BinaryHeap::from(heap);
        let (mut best, mut pairs): (Option<Label>, u64) = (None, 0);
        // A hop that is not computed yet waits under what it takes at least.
        while let Some(Waiting { key: least, label: before, .. }) = heap.pop() {
            if best.is_some_and(|best| by_objective(&least, &best.key).is_ge()) {
                break;
            }
            let label = self.labels[before as usize];
            let Some(sight) = surface.sight(&label.at, &at) else { continue };
            pairs += 1;
            counter.pair()?;
            if let Some(hop) = surface.between([label.node, node], [&label.at, &at], sight) {
                self.offers.each(label.node, &at, &hop, |command, amounts| {
                    let key = self.extended(&label.key, &amounts);
                    if best.is_none_or(|best| by_objective(&key, &best.key).is_lt()) {
                        best = Some(Label { node, at, key, before, command });
                    }
                });
            }
        }
        *waiting = heap.into_vec();
        waiting.clear();
        Ok((best, pairs))
    }

    /// The hops of the best path to a node; `None` if it has no label.
    fn steps_to(&self, node: usize) -> Option<Vec<PathStep>> {
        let mut label = self.labels.get(self.of_node[node] as usize)?;
        let mut steps = Vec::new();
        while let Some(before) = self.labels.get(label.before as usize) {
            steps.push(PathStep { from: before.node.index(), to: label.node.index(), command: label.command });
            label = before;
        }
        steps.reverse();
        Some(steps)
    }
}
