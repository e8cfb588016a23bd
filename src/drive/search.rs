//! Least costs over drive legs, by label setting.

use super::{DriveEdges, queue::Buckets};
use crate::progress::{Cancelled, Detail, Meter};

/// No direction: nothing leads to the state, or it is a start.
pub(super) const NO_MARK: u8 = 63;
/// Set while a state is done under its label.
const DONE: u8 = 64;
/// States between two reports of the search.
const STATES_PER_REPORT: u64 = 1 << 16;

/// The labels of all states, and the queue of those that are not done.
#[derive(Debug)]
pub(super) struct Labels {
    /// The least cost found; infinite where none is.
    pub(super) values: Vec<f64>,
    marks: Vec<u8>,
    queue: Buckets,
    /// Of every node with several states, the least of their labels and its heading.
    best: Vec<(f64, u8)>,
}

impl Labels {
    /// Of nodes with one state each, with buckets of this width.
    pub(super) fn of_nodes(nodes: usize, width: f64) -> Self {
        Self { values: vec![f64::INFINITY; nodes], marks: vec![NO_MARK; nodes], queue: Buckets::new(width), best: Vec::new() }
    }

    /// Of nodes with a state for each of so many headings.
    pub(super) fn of_headings(nodes: usize, headings: usize, width: f64) -> Self {
        Self { best: vec![(f64::INFINITY, 0); nodes], ..Self::of_nodes(nodes * headings, width) }
    }

    /// A node from which the search begins, in any of its states.
    pub(super) fn start(&mut self, node: usize, key: f64) {
        let states = if self.best.is_empty() { 1 } else { self.values.len() / self.best.len() };
        for state in node * states..(node + 1) * states {
            self.values[state] = 0.0;
            self.marks[state] = NO_MARK;
            self.queue.push(narrow(state), key);
        }
        if let Some(best) = self.best.get_mut(node) {
            *best = (0.0, 0);
        }
    }

    /// The least label of every node, the mark of every state (how it was reached), and where nodes have several, the heading of the best.
    pub(super) fn into_parts(self) -> (Vec<f64>, Vec<u8>, Vec<u8>) {
        let Self { values, mut marks, best, .. } = self;
        marks.iter_mut().for_each(|mark| *mark &= !DONE);
        if best.is_empty() {
            return (values, marks, Vec::new());
        }
        let (costs, headings) = best.into_iter().unzip();
        (costs, marks, headings)
    }

    /// The least label with which a node is known to be reached at a heading: its own, or that of its best heading and the turn.
    #[inline]
    fn turned(&self, node: usize, heading: usize, turns: &[f64], headings: usize) -> f64 {
        let (label, best) = self.best[node];
        label + turns[usize::from(best) * headings + heading]
    }

    /// Offers a state a label from another one of label `from`.
    ///
    /// Of equal labels the one that `prefers` names stays, where the predecessor's label is less: so predecessors never form a circle. A
    /// strictly better label does not need that: along a chain of predecessors labels never increase.
    #[inline]
    fn offer(&mut self, state: usize, value: f64, from: f64, mark: u8, arcs: &impl Arcs) {
        if value < self.values[state] {
            self.values[state] = value;
            self.marks[state] = mark;
            self.queue.push(narrow(state), value + arcs.bound(state));
        } else if value == self.values[state] && from < value && arcs.prefers(mark, self.marks[state] & !DONE) {
            self.marks[state] = mark | (self.marks[state] & DONE);
        }
    }

    /// Sets the labels of all states that can be reached, or at least that of `goal`.
    pub(super) fn run(&mut self, arcs: &impl Arcs, goal: Option<usize>, meter: &Meter<'_>) -> Result<(), Cancelled> {
        let (mut taken, mut visited) = (Vec::new(), 0);
        loop {
            let (values, marks) = (&self.values, &self.marks);
            let key = |state: u32| {
                let state = state as usize;
                (marks[state] & DONE == 0).then(|| values[state] + arcs.bound(state))
            };
            let Some(least) = self.queue.take(&mut taken, key) else { return Ok(()) };
            // Bounds round, so that a state a little beyond the goal is looked at too.
            if goal.is_some_and(|goal| least > self.values[goal] * (1.0 + 1e-12)) {
                return Ok(());
            }
            for state in taken.iter().map(|state| *state as usize) {
                if self.marks[state] & DONE != 0 {
                    continue;
                }
                self.marks[state] |= DONE;
                visited += 1;
                if visited % STATES_PER_REPORT == 0 {
                    meter.set_done(visited / arcs.states_per_node(), arcs.nodes());
                    meter.report(Detail::None)?;
                }
                arcs.relax(state, self);
            }
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "there are fewer than 2^32 states")]
const fn narrow(state: usize) -> u32 {
    state as u32
}

/// The arcs between states.
pub(super) trait Arcs {
    /// Offers labels to all states that an arc leads to.
    fn relax(&self, state: usize, labels: &mut Labels);

    /// At most what is left to the goal of a search for one.
    fn bound(&self, _: usize) -> f64 {
        0.0
    }

    /// Whether the first of two marks of equal labels stays: the one from the predecessor of the lower number.
    fn prefers(&self, mark: u8, other: u8) -> bool;

    fn states_per_node(&self) -> u64;

    fn nodes(&self) -> u64;
}

/// Nodes as states: turns take nothing. A mark is the direction of the leg.
pub(super) struct NodeArcs<'e, B> {
    edges: &'e DriveEdges<'e>,
    masks: &'e [u32],
    /// 1 along the legs, -1 against them.
    sign: isize,
    bound: B,
}

impl<'e, B: Fn(usize) -> f64> NodeArcs<'e, B> {
    /// Along the legs of these nodes, or against them where `masks` are the directions into each node.
    pub(super) const fn new(edges: &'e DriveEdges<'e>, masks: &'e [u32], sign: isize, bound: B) -> Self {
        Self { edges, masks, sign, bound }
    }
}

impl<B: Fn(usize) -> f64> Arcs for NodeArcs<'_, B> {
    #[inline]
    fn relax(&self, state: usize, labels: &mut Labels) {
        let from = labels.values[state];
        let steps = self.edges.steps();
        for direction in ones(self.masks[state]) {
            let to = state.wrapping_add_signed(self.sign * steps[direction]);
            if labels.values[to] < from + self.edges.least(direction) {
                continue;
            }
            let begin = if self.sign > 0 { state } else { to };
            labels.offer(to, from + self.edges.cost(begin, direction), from, mark_of(direction), self);
        }
    }

    #[inline]
    fn bound(&self, state: usize) -> f64 {
        (self.bound)(state)
    }

    fn prefers(&self, mark: u8, other: u8) -> bool {
        let steps = self.edges.steps();
        // The predecessor lies against the step: the lower its number, the greater the step.
        other != NO_MARK && self.sign * steps[usize::from(mark)] > self.sign * steps[usize::from(other)]
    }

    fn states_per_node(&self) -> u64 {
        1
    }

    fn nodes(&self) -> u64 {
        self.masks.len() as u64
    }
}

/// Nodes with a heading as states: of the leg before on the way from a start, of the leg after on the way to a goal. A mark is the heading of
/// the state before or after.
///
/// A state is of no use where the best heading of its node and a turn on the spot cost no more: what follows costs no more from there either,
/// since turning by way of a third heading is never shorter. Most states are left out so.
pub(super) struct TurnArcs<'e> {
    edges: &'e DriveEdges<'e>,
    masks: &'e [u32],
    sign: isize,
    /// What turning between two directions takes, row after row; the same both ways.
    turns: &'e [f64],
}

impl<'e> TurnArcs<'e> {
    /// As [`NodeArcs::new`], with the price of turns.
    pub(super) const fn new(edges: &'e DriveEdges<'e>, masks: &'e [u32], sign: isize, turns: &'e [f64]) -> Self {
        Self { edges, masks, sign, turns }
    }
}

impl Arcs for TurnArcs<'_> {
    #[inline]
    fn relax(&self, state: usize, labels: &mut Labels) {
        let headings = self.edges.offsets().len();
        let (node, heading) = (state / headings, state % headings);
        let from = labels.values[state];
        let is_best = usize::from(labels.best[node].1) == heading;
        if !is_best && labels.turned(node, heading, self.turns, headings) <= from {
            return;
        }
        let steps = self.edges.steps();
        for direction in ones(self.masks[node]) {
            let beyond = node.wrapping_add_signed(self.sign * steps[direction]);
            let to = beyond * headings + direction;
            let turned = from + self.turns[heading * headings + direction];
            let known = labels.values[to].min(labels.turned(beyond, direction, self.turns, headings));
            if known < turned + self.edges.least(direction) {
                continue;
            }
            let begin = if self.sign > 0 { node } else { beyond };
            let value = turned + self.edges.cost(begin, direction);
            if value > known {
                continue;
            }
            labels.offer(to, value, from, mark_of(heading), self);
            if value < labels.best[beyond].0 {
                labels.best[beyond] = (value, mark_of(direction));
            }
        }
    }

    fn prefers(&self, mark: u8, other: u8) -> bool {
        mark < other && other != NO_MARK
    }

    fn states_per_node(&self) -> u64 {
        self.edges.offsets().len() as u64
    }

    fn nodes(&self) -> u64 {
        self.masks.len() as u64
    }
}

#[expect(clippy::cast_possible_truncation, reason = "at most 32 directions")]
const fn mark_of(direction: usize) -> u8 {
    direction as u8
}

/// The numbers of the bits that are set.
fn ones(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let first = mask.trailing_zeros();
        mask &= mask.wrapping_sub(1);
        (first < u32::BITS).then_some(first as usize)
    })
}
