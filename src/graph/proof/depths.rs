//! How many may-hops a cell lies from one end of the journey: breadth first, kept up while cells are split.

use rayon::prelude::*;

use super::{Faults, Prover, cell::Cell};

/// No may-path joins the cell to this end.
pub(super) const CUT_OFF: u32 = u32::MAX;

/// No cell.
const NONE: u32 = u32::MAX;

/// Which way the hops go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// From the start: depth is the least number of may-hops from it.
    FromStart,
    /// Towards the goal: depth is the least number of may-hops to it.
    ToGoal,
}

/// The depth of every cell, from below.
///
/// Splitting cells only takes may-hops away, so depths only grow: a cell keeps the cell that gave it its depth until that one is split
/// or gets deeper itself, and then looks for another one of the same depth, else goes one level down (Even and Shiloach 1981, with edges
/// tested when asked for and none stored). Memory is a few numbers a cell.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    way: Way,
    /// At least so many may-hops; [`CUT_OFF`] for proved never.
    depth: Vec<u32>,
    /// The cell one level up that gave the depth, or might.
    parent: Vec<u32>,
    /// Whether the test of that parent has been made with the cells as they are.
    tested: Vec<bool>,
    /// How many pairs of cells were tested.
    pub(super) pairs_tested: u64,
}

/// What one cell's look for a parent came to.
struct Found {
    parent: Option<u32>,
    pairs_tested: u64,
}

impl Depths {
    /// Before any test: one hop from the end at least.
    ///
    /// The distance over the greatest reach would bound more, but not the may-graph: a cell is crossed for nothing there. A depth has to
    /// be one that every may-path keeps to, or the level above holds no parent where one exists.
    pub(super) fn new(way: Way, cells: usize, end: usize) -> Self {
        let depth = (0..cells).map(|i| u32::from(i != end)).collect();
        Self { way, depth, parent: vec![NONE; cells], tested: vec![false; cells], pairs_tested: 0 }
    }

    /// The least number of may-hops, as far as it was settled.
    pub(super) fn of(&self, cell: usize) -> u32 {
        self.depth[cell]
    }

    /// Settles all depths up to a limit; deeper ones are only known to be deeper.
    pub(super) fn settle<F: Faults>(&mut self, prover: &Prover<'_, F>, cells: &[Cell<F::Rounding>], limit: u32) {
        let mut levels: std::collections::BTreeMap<u32, Vec<u32>> = std::collections::BTreeMap::new();
        for (i, &depth) in (0u32..).zip(&self.depth) {
            if depth <= limit && depth < CUT_OFF {
                levels.entry(depth).or_default().push(i);
            }
        }
        let mut above = levels.remove(&0).unwrap_or_default();
        let mut level = 1;
        while let Some((&next, _)) = levels.first_key_value() {
            if above.is_empty() {
                for cell in levels.into_values().flatten() {
                    self.depth[cell as usize] = CUT_OFF;
                }
                return self.cut_off_beyond(limit);
            }
            let mut pending = if next == level { levels.remove(&level).unwrap_or_default() } else { Vec::new() };
            pending.sort_unstable();
            let found: Vec<Found> = pending.par_iter().map(|&cell| self.look(prover, cells, cell, level, &above)).collect();
            let (mut settled, mut deeper) = (Vec::new(), Vec::new());
            for (&cell, found) in pending.iter().zip(&found) {
                self.pairs_tested += found.pairs_tested;
                let i = cell as usize;
                self.tested[i] = found.parent.is_some();
                if let Some(parent) = found.parent {
                    self.parent[i] = parent;
                    settled.push(cell);
                } else {
                    self.depth[i] = level + 1;
                    deeper.push(cell);
                }
            }
            if level < limit && !deeper.is_empty() {
                levels.entry(level + 1).or_default().append(&mut deeper);
            }
            above = settled;
            level += 1;
        }
        if above.is_empty() {
            self.cut_off_beyond(limit);
        }
    }

    /// Where a whole level is empty, nothing lies beyond it.
    fn cut_off_beyond(&mut self, limit: u32) {
        for depth in self.depth.iter_mut().filter(|depth| **depth > limit) {
            *depth = CUT_OFF;
        }
    }

    /// Looks for a cell of the level above from which (or to which) a hop may lead: the one known, then the nearest first.
    fn look<F: Faults>(&self, prover: &Prover<'_, F>, cells: &[Cell<F::Rounding>], cell: u32, level: u32, above: &[u32]) -> Found {
        let i = cell as usize;
        let known = self.parent[i];
        let is_above = |other: u32| self.depth.get(other as usize) == Some(&(level - 1));
        if known != NONE && self.tested[i] && is_above(known) {
            return Found { parent: Some(known), pairs_tested: 0 };
        }
        let mut pairs_tested = 0;
        let mut may = |other: u32| {
            pairs_tested += 1;
            let (own, other) = (&cells[i], &cells[other as usize]);
            match self.way {
                Way::FromStart => prover.may(other, own).is_ok(),
                Way::ToGoal => prover.may(own, other).is_ok(),
            }
        };
        if known != NONE {
            // Where it was split, its halves stand in its place.
            for candidate in [known, known + 1] {
                if candidate != cell && is_above(candidate) && may(candidate) {
                    return Found { parent: Some(candidate), pairs_tested };
                }
            }
        }
        let reach_m = match self.way {
            Way::FromStart => prover.reach_to_m(&cells[i]),
            Way::ToGoal => prover.reach_from_m(&cells[i]),
        };
        let parent = nearest_first(cells, cell, reach_m, above).find(|&other| may(other));
        Found { parent, pairs_tested }
    }

    /// The same for cells of which some were split: `halves` has, for each old cell, the index of its first new one and how many there
    /// are.
    pub(super) fn after_split(&mut self, halves: &[(u32, u32)], count: usize) {
        let (mut depth, mut parent, mut tested) = (Vec::with_capacity(count), Vec::with_capacity(count), Vec::with_capacity(count));
        for (i, &(_, pieces)) in halves.iter().enumerate() {
            let old = self.parent[i];
            let (new, whole) = match halves.get(old as usize) {
                Some(&(first, pieces)) => (first, pieces == 1),
                None => (NONE, false),
            };
            for _ in 0..pieces {
                depth.push(self.depth[i]);
                parent.push(new);
                tested.push(self.tested[i] && whole && pieces == 1);
            }
        }
        (self.depth, self.parent, self.tested) = (depth, parent, tested);
    }
}

/// The cells of a rising list within a distance of a cell, the nearest first.
fn nearest_first<'c, R: crate::quantity::Rounding>(
    cells: &'c [Cell<R>],
    cell: u32,
    reach_m: f64,
    among: &'c [u32],
) -> impl Iterator<Item = u32> + 'c {
    let own = &cells[cell as usize];
    let mut right = among.partition_point(|&other| other <= cell);
    let mut left = among.partition_point(|&other| other < cell);
    let gap_m = move |other: u32| {
        let other = &cells[other as usize];
        (other.from_m - own.to_m).max(own.from_m - other.to_m).next_down()
    };
    std::iter::from_fn(move || {
        let before = left.checked_sub(1).map(|i| (gap_m(among[i]), among[i])).filter(|(gap_m, _)| *gap_m <= reach_m);
        let after = among.get(right).map(|&other| (gap_m(other), other)).filter(|(gap_m, _)| *gap_m <= reach_m);
        let take_left = match (before, after) {
            (Some((a, _)), Some((b, _))) => a <= b,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => return None,
        };
        if take_left {
            left -= 1;
            before.map(|(_, other)| other)
        } else {
            right += 1;
            after.map(|(_, other)| other)
        }
    })
}
