//! The cells with their depths from both ends, and the splitting of cells.

use super::{
    Faults, Prover,
    cell::{Cell, partition, stretch},
    depths::{CUT_OFF, Depths, Root},
};
use crate::{
    chain::{Site, Station},
    progress::{Cancelled, Meter},
};

/// The may-graph between two stations at its current refinement.
#[derive(Debug)]
pub(super) struct Refinement<'a, F: Faults> {
    pub(super) prover: Prover<'a, F>,
    /// From left to right.
    pub(super) cells: Vec<Cell<F::Rounding>>,
    pub(super) start: usize,
    pub(super) goal: usize,
    pub(super) from_start: Depths,
    pub(super) to_goal: Depths,
    pub(super) splits: u64,
}

impl<'a, F: Faults> Refinement<'a, F> {
    /// The coarsest cells: one stretch between neighbours among the vertices, start and goal; no depth is settled yet.
    pub(super) fn new(prover: Prover<'a, F>, start: &Station, goal: &Station) -> Self {
        let cells = partition::<F>(prover.test().chain().geometry(), prover.slopes(), [start, goal]);
        let at = |station: &Station| place_of(&cells, station.point.x_m);
        let (start, goal) = (at(start), at(goal));
        let from_start = Depths::new(Root::Start, cells.len(), start);
        let to_goal = Depths::new(Root::Goal, cells.len(), goal);
        Self { prover, cells, start, goal, from_start, to_goal, splits: 0 }
    }

    /// Settles the depths from the start up to a limit and returns the depth of the goal: every path has at least this many
    /// hops (if it does not exceed the limit). [`CUT_OFF`] means that there is no path.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn settle_from_start(&mut self, limit: u32, meter: &Meter<'_>) -> Result<u32, Cancelled> {
        self.from_start.settle(&self.prover, &self.cells, limit, meter)?;
        Ok(self.from_start.of(self.goal))
    }

    /// Settles the depths to the goal up to a limit.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn settle_to_goal(&mut self, limit: u32, meter: &Meter<'_>) -> Result<(), Cancelled> {
        self.to_goal.settle(&self.prover, &self.cells, limit, meter)
    }

    /// The least number of may-hops from start to goal through a cell, as far as settled; `None` if it is on no may-path.
    pub(super) fn over(&self, cell: usize) -> Option<u32> {
        let (before, after) = (self.from_start.of(cell), self.to_goal.of(cell));
        (before != CUT_OFF && after != CUT_OFF).then(|| before.saturating_add(after))
    }

    /// Splits the wider stretches on may-paths of at most this many hops, within the budget of cells; returns whether there
    /// was anything to split.
    pub(super) fn split(&mut self, at_most: u32, budget_cells: usize) -> bool {
        let on_path = |i: usize| self.over(i).is_some_and(|hops| hops <= at_most);
        let mut chosen: Vec<usize> = (0..self.cells.len()).filter(|&i| on_path(i) && self.cells[i].middle_m().is_some()).collect();
        let widest_m = chosen.iter().map(|&i| self.cells[i].width_m()).fold(0.0, f64::max);
        chosen.retain(|&i| self.cells[i].width_m() >= Self::WIDE * widest_m);
        // A stretch is replaced by its two halves, which share the point between them: one cell more.
        let room = budget_cells.saturating_sub(self.cells.len());
        if chosen.len() > room {
            chosen.sort_by(|&a, &b| self.cells[b].width_m().total_cmp(&self.cells[a].width_m()).then(a.cmp(&b)));
            chosen.truncate(room);
            chosen.sort_unstable();
        }
        self.halve(&chosen);
        !chosen.is_empty()
    }

    /// Stretches of at least this fraction of the widest one are split with it.
    const WIDE: f64 = 0.25;

    /// Halves stretches, given by ascending indices.
    fn halve(&mut self, chosen: &[usize]) {
        let mut cells = Vec::with_capacity(self.cells.len() + chosen.len());
        let mut halves = Vec::with_capacity(self.cells.len());
        let mut next = chosen.iter().copied().peekable();
        let geometry = self.prover.test().chain().geometry();
        for (i, cell) in self.cells.iter().enumerate() {
            let first = u32::try_from(cells.len()).unwrap_or(u32::MAX);
            let is_chosen = next.next_if_eq(&i).is_some();
            if let (Site::Inside(segment), Some(middle_m)) = (cell.site, cell.middle_m().filter(|_| is_chosen)) {
                cells.push(stretch::<F>(geometry, self.prover.slopes(), segment, cell.from_m, middle_m));
                cells.push(stretch::<F>(geometry, self.prover.slopes(), segment, middle_m, cell.to_m));
                halves.push((first, 2));
                self.splits += 1;
            } else {
                cells.push(*cell);
                halves.push((first, 1));
            }
        }
        self.from_start.after_split(&halves, cells.len());
        self.to_goal.after_split(&halves, cells.len());
        self.start = halves[self.start].0 as usize;
        self.goal = halves[self.goal].0 as usize;
        self.cells = cells;
    }
}

/// The cell that is exactly this point; start and goal have cells of their own.
fn place_of<R>(cells: &[Cell<R>], x_m: f64) -> usize {
    let first = cells.partition_point(|cell| cell.to_m < x_m);
    let is_point = |cell: &Cell<R>| cell.from_m == x_m && cell.to_m == x_m;
    first + cells[first..].iter().position(is_point).unwrap_or(0)
}
