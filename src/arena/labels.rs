//! The labels of a search, by state: times, and where a battery or weakening asks for it energy and jumps as well.

use std::{cmp::Ordering, collections::BinaryHeap};

/// How a state is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Label {
    /// The state.
    pub(super) state: u32,
    /// The label before; itself for the first.
    pub(super) parent: u32,
    /// The time so far, s.
    pub(super) time_s: f64,
    /// The energy so far, J.
    pub(super) energy_j: f64,
    /// The jumps so far.
    pub(super) jumps: u32,
}

/// A label that waits, with the least time of any path through it. The earliest comes first, equal ones by their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Waiting {
    pub(super) bound_s: f64,
    pub(super) label: u32,
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound_s.total_cmp(&self.bound_s).then(other.label.cmp(&self.label))
    }
}

/// The labels, and those that wait.
#[derive(Debug)]
pub(super) struct Labels {
    all: Vec<Label>,
    waiting: BinaryHeap<Waiting>,
    /// The least time by state, where time alone decides.
    best_s: Vec<f64>,
    /// The settled labels by state otherwise.
    settled: Vec<Vec<u32>>,
    is_plain: bool,
}

impl Labels {
    /// For so many states; `is_plain`: the time alone decides.
    pub(super) fn new(states: usize, is_plain: bool) -> Self {
        let (best_s, settled) =
            if is_plain { (vec![f64::INFINITY; states], Vec::new()) } else { (Vec::new(), vec![Vec::new(); states]) };
        Self { all: Vec::new(), waiting: BinaryHeap::new(), best_s, settled, is_plain }
    }

    /// Adds a label, with the least time from its state to the goal; its parent is ignored for the first one.
    pub(super) fn offer(&mut self, label: Label, rest_s: f64) {
        if self.is_plain {
            let best_s = &mut self.best_s[label.state as usize];
            if label.time_s >= *best_s {
                return;
            }
            *best_s = label.time_s;
        } else if self.is_dominated(&label) {
            return;
        }
        // More labels than 2^32 do not fit into memory.
        let number = u32::try_from(self.all.len()).unwrap_or(u32::MAX);
        self.all.push(label);
        self.waiting.push(Waiting { bound_s: label.time_s + rest_s, label: number });
    }

    /// Whether another state of a node is reached so early that a turn from it makes this label no sooner: what follows a label follows that turn
    /// too. `turns_s` has the time of the turn from each state of the node. Only where time alone decides.
    pub(super) fn is_later_than_a_turn<const N: usize>(&self, label: &Label, own: usize, turns_s: &[f64; N]) -> bool {
        let first = label.state as usize - own;
        self.is_plain
            && self.best_s[first..first + N]
                .iter()
                .zip(turns_s)
                .enumerate()
                .any(|(state, (best_s, turn_s))| state != own && best_s + turn_s <= label.time_s)
    }

    /// Settles the next label; `None` when all are settled.
    pub(super) fn settle(&mut self) -> Option<(u32, Label)> {
        while let Some(Waiting { label: number, .. }) = self.waiting.pop() {
            let label = self.all[number as usize];
            if self.is_plain {
                if label.time_s > self.best_s[label.state as usize] {
                    continue;
                }
            } else {
                if self.is_dominated(&label) {
                    continue;
                }
                self.settled[label.state as usize].push(number);
            }
            return Some((number, label));
        }
        None
    }

    /// Whether a settled label, which took no more time since it came earlier, took no more of the rest either.
    fn is_dominated(&self, label: &Label) -> bool {
        self.settled[label.state as usize]
            .iter()
            .map(|number| &self.all[*number as usize])
            .any(|settled| settled.time_s <= label.time_s && settled.energy_j <= label.energy_j && settled.jumps <= label.jumps)
    }

    /// The states from the first label to this one.
    pub(super) fn states_to(&self, mut number: u32) -> Vec<u32> {
        let mut states = vec![self.all[number as usize].state];
        while self.all[number as usize].parent != number {
            number = self.all[number as usize].parent;
            states.push(self.all[number as usize].state);
        }
        states.reverse();
        states
    }
}
