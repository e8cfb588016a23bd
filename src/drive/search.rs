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
}

impl Labels {
    /// Of so many states, with buckets of this width.
    pub(super) fn new(states: usize, width: f64) -> Self {
        Self { values: vec![f64::INFINITY; states], marks: vec![NO_MARK; states], queue: Buckets::new(width) }
    }

    /// A state from which the search begins.
    pub(super) fn start(&mut self, state: usize, key: f64) {
        self.values[state] = 0.0;
        self.marks[state] = NO_MARK;
        self.queue.push(narrow(state), key);
    }

    /// How a state was reached: its mark, less what the search keeps in it.
    pub(super) fn into_parts(self) -> (Vec<f64>, Vec<u8>) {
        let Self { values, mut marks, .. } = self;
        marks.iter_mut().for_each(|mark| *mark &= !DONE);
        (values, marks)
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
pub(super) struct TurnArcs<'e> {
    edges: &'e DriveEdges<'e>,
    masks: &'e [u32],
    sign: isize,
    /// What turning from one direction to another takes, row after row.
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
        let directions = self.edges.offsets().len();
        let (node, heading) = (state / directions, state % directions);
        let from = labels.values[state];
        let steps = self.edges.steps();
        for direction in ones(self.masks[node]) {
            let beyond = node.wrapping_add_signed(self.sign * steps[direction]);
            let to = beyond * directions + direction;
            let turned = from + self.turns[heading * directions + direction];
            if labels.values[to] < turned + self.edges.least(direction) {
                continue;
            }
            let begin = if self.sign > 0 { node } else { beyond };
            labels.offer(to, turned + self.edges.cost(begin, direction), from, mark_of(heading), self);
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
