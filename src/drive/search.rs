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
    cells: Vec<Cell>,
    queue: Buckets,
    /// Of every node with several states, the least of their labels and its heading.
    best: Vec<(f64, u8)>,
}

/// All that the search looks up of a state, in one place: it waits for memory more than for anything else.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// The least cost found; infinite where none is.
    value: f64,
    /// The directions of its node's arcs.
    directions: u32,
    /// How it was reached, and whether it is done.
    mark: u8,
}

impl Labels {
    /// Of nodes with one state each and arcs in these directions, with buckets of this width.
    pub(super) fn of_nodes(masks: &[u32], width: f64) -> Self {
        let cells = masks.iter().map(|directions| Cell { value: f64::INFINITY, directions: *directions, mark: NO_MARK }).collect();
        Self { cells, queue: Buckets::new(width), best: Vec::new() }
    }

    /// Of nodes with a state for each of so many headings.
    pub(super) fn of_headings(masks: &[u32], headings: usize, width: f64) -> Self {
        let states = masks.iter().flat_map(|directions| std::iter::repeat_n(*directions, headings));
        let mut cells = Vec::with_capacity(masks.len() * headings);
        cells.extend(states.map(|directions| Cell { value: f64::INFINITY, directions, mark: NO_MARK }));
        Self { cells, queue: Buckets::new(width), best: vec![(f64::INFINITY, 0); masks.len()] }
    }

    /// A node from which the search begins, in any of its states.
    pub(super) fn start(&mut self, node: usize, key: f64) {
        let states = if self.best.is_empty() { 1 } else { self.cells.len() / self.best.len() };
        for state in node * states..(node + 1) * states {
            (self.cells[state].value, self.cells[state].mark) = (0.0, NO_MARK);
            self.queue.push(narrow(state), key);
        }
        if let Some(best) = self.best.get_mut(node) {
            *best = (0.0, 0);
        }
    }

    /// The least label of every node, the mark of every state (how it was reached), and where nodes have several, the heading of the best.
    pub(super) fn into_parts(self) -> (Vec<f64>, Vec<u8>, Vec<u8>) {
        let Self { cells, best, .. } = self;
        let marks = cells.iter().map(|cell| cell.mark & !DONE).collect();
        if best.is_empty() {
            return (cells.iter().map(|cell| cell.value).collect(), marks, Vec::new());
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
        let cell = &mut self.cells[state];
        if value < cell.value {
            (cell.value, cell.mark) = (value, mark);
            self.queue.push(narrow(state), value + arcs.bound(state));
        } else if value == cell.value && from < value && arcs.prefers(mark, cell.mark & !DONE) {
            cell.mark = mark | (cell.mark & DONE);
        }
    }

    /// Sets the labels of all states that can be reached, or at least that of `goal`.
    pub(super) fn run(&mut self, arcs: &impl Arcs, goal: Option<usize>, meter: &Meter<'_>) -> Result<(), Cancelled> {
        let (mut taken, mut visited) = (Vec::new(), 0);
        loop {
            let cells = &self.cells;
            let key = |state: u32| {
                let cell = &cells[state as usize];
                (cell.mark & DONE == 0).then(|| cell.value + arcs.bound(state as usize))
            };
            let Some(least) = self.queue.take(&mut taken, key) else { return Ok(()) };
            // Bounds round, so that a state a little beyond the goal is looked at too.
            if goal.is_some_and(|goal| least > self.cells[goal].value * (1.0 + 1e-12)) {
                return Ok(());
            }
            for state in taken.iter().map(|state| *state as usize) {
                let cell = &mut self.cells[state];
                if cell.mark & DONE != 0 {
                    continue;
                }
                cell.mark |= DONE;
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
    /// 1 along the legs, -1 against them.
    sign: isize,
    bound: B,
}

impl<'e, B: Fn(usize) -> f64> NodeArcs<'e, B> {
    /// Along the legs between nodes (`sign` 1), or against them (-1) where the directions of labels are those into each node.
    pub(super) const fn new(edges: &'e DriveEdges<'e>, sign: isize, bound: B) -> Self {
        Self { edges, sign, bound }
    }
}

impl<B: Fn(usize) -> f64> Arcs for NodeArcs<'_, B> {
    #[inline]
    fn relax(&self, state: usize, labels: &mut Labels) {
        let Cell { value: from, directions, .. } = labels.cells[state];
        let steps = self.edges.steps();
        for direction in ones(directions) {
            let to = state.wrapping_add_signed(self.sign * steps[direction]);
            if labels.cells[to].value < from + self.edges.least(direction) {
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
        self.edges.lattice().count() as u64
    }
}

/// Nodes with a heading as states: of the leg before on the way from a start, of the leg after on the way to a goal. A mark is the heading of
/// the state before or after.
///
/// A state is of no use where the best heading of its node and a turn on the spot cost no more: what follows costs no more from there either,
/// since turning by way of a third heading is never shorter. Most states are left out so.
pub(super) struct TurnArcs<'e> {
    edges: &'e DriveEdges<'e>,
    sign: isize,
    /// What turning between two directions takes, row after row; the same both ways.
    turns: &'e [f64],
}

impl<'e> TurnArcs<'e> {
    /// As [`NodeArcs::new`], with the price of turns.
    pub(super) const fn new(edges: &'e DriveEdges<'e>, sign: isize, turns: &'e [f64]) -> Self {
        Self { edges, sign, turns }
    }
}

impl Arcs for TurnArcs<'_> {
    #[inline]
    fn relax(&self, state: usize, labels: &mut Labels) {
        let headings = self.edges.offsets().len();
        let (node, heading) = (state / headings, state % headings);
        let Cell { value: from, directions, .. } = labels.cells[state];
        let is_best = usize::from(labels.best[node].1) == heading;
        if !is_best && labels.turned(node, heading, self.turns, headings) <= from {
            return;
        }
        let steps = self.edges.steps();
        for direction in ones(directions) {
            let beyond = node.wrapping_add_signed(self.sign * steps[direction]);
            let to = beyond * headings + direction;
            let turned = from + self.turns[heading * headings + direction];
            let known = labels.cells[to].value.min(labels.turned(beyond, direction, self.turns, headings));
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
        self.edges.lattice().count() as u64
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
