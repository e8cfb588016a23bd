//! How many may-hops a cell lies from one end of the journey: breadth first, kept up while cells are split.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::{Faults, Prover, cell::Cell};
use crate::progress::{Cancelled, Meter, PairCounter};

/// No may-path joins the cell to this end.
pub(super) const CUT_OFF: u32 = u32::MAX;

/// No cell.
const NONE: u32 = u32::MAX;

/// The end of the journey that depths are counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Root {
    /// From the start: depth is the least number of may-hops from it.
    Start,
    /// Towards the goal: depth is the least number of may-hops to it.
    Goal,
}

/// The depth of every cell, from below.
///
/// Splitting cells only takes may-hops away, so depths only grow: a cell keeps the cell that gave it its depth until that one is split
/// or gets deeper itself, and then looks for another one of the same depth, else goes one level down (Even and Shiloach 1981, with edges
/// tested when asked for and none stored). Memory is a few numbers a cell.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    root: Root,
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
    pub(super) fn new(root: Root, cells: usize, end: usize) -> Self {
        let depth = (0..cells).map(|i| u32::from(i != end)).collect();
        Self { root, depth, parent: vec![NONE; cells], tested: vec![false; cells], pairs_tested: 0 }
    }

    /// The least number of may-hops, as far as it was settled.
    pub(super) fn of(&self, cell: usize) -> u32 {
        self.depth[cell]
    }

    /// Settles all depths up to a limit; deeper ones are only known to be deeper.
    ///
    /// # Errors
    /// [`Cancelled`]; then the depths are of no further use.
    pub(super) fn settle<F: Faults>(
        &mut self,
        prover: &Prover<'_, F>,
        cells: &[Cell<F::Rounding>],
        limit: u32,
        meter: &Meter<'_>,
    ) -> Result<(), Cancelled> {
        let reach_m = prover.greatest_reach_m();
        let mut by_depth: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (i, &depth) in (0u32..).zip(&self.depth) {
            if depth <= limit && depth < CUT_OFF {
                by_depth.entry(depth).or_default().push(i);
            }
        }
        let mut above = by_depth.remove(&0).unwrap_or_default();
        // Cells that are no nearer than the level at hand and still without a parent.
        let mut waiting: BTreeSet<u32> = BTreeSet::new();
        let mut level = 0;
        while level < limit && !above.is_empty() && !(waiting.is_empty() && by_depth.is_empty()) {
            level += 1;
            let mut settled = Vec::new();
            for cell in by_depth.remove(&level).unwrap_or_default() {
                if self.has_parent(cell, level) {
                    settled.push(cell);
                } else {
                    // Without a depth until it has a parent, so that it is none itself.
                    self.depth[cell as usize] = CUT_OFF;
                    waiting.insert(cell);
                }
            }
            // Only cells within reach of the level above can have a parent there.
            let looking: Vec<u32> = waiting.range(within_reach(cells, &above, reach_m)).copied().collect();
            let look = |counter: &mut PairCounter<'_>, &cell: &u32| self.look(prover, cells, cell, (level, &above), counter);
            let found = looking.par_iter().map_init(|| meter.counter(), look).collect::<Result<Vec<Found>, _>>();
            meter.check()?;
            let found = found?;
            for (&cell, found) in looking.iter().zip(&found) {
                self.pairs_tested += found.pairs_tested;
                let i = cell as usize;
                self.tested[i] = found.parent.is_some();
                if let Some(parent) = found.parent {
                    (self.parent[i], self.depth[i]) = (parent, level);
                    waiting.remove(&cell);
                    settled.push(cell);
                }
            }
            settled.sort_unstable();
            above = settled;
        }
        // Beyond an empty level there is nothing; else the rest is deeper than the limit.
        let rest = if above.is_empty() { CUT_OFF } else { limit.saturating_add(1) };
        for cell in waiting.into_iter().chain(by_depth.into_values().flatten()) {
            self.depth[cell as usize] = rest;
        }
        if above.is_empty() {
            for depth in self.depth.iter_mut().filter(|depth| **depth > limit) {
                *depth = CUT_OFF;
            }
        }
        Ok(())
    }

    /// Whether the parent known still gives a cell this depth.
    fn has_parent(&self, cell: u32, level: u32) -> bool {
        self.tested[cell as usize] && self.is_above(self.parent[cell as usize], level)
    }

    /// Whether a cell is one level nearer.
    fn is_above(&self, cell: u32, level: u32) -> bool {
        self.depth.get(cell as usize) == Some(&(level - 1))
    }

    /// Looks for a cell of the level above from which (or to which) a hop may lead: the one known, then the nearest first.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn look<F: Faults>(
        &self,
        prover: &Prover<'_, F>,
        cells: &[Cell<F::Rounding>],
        cell: u32,
        (level, above): (u32, &[u32]),
        counter: &mut PairCounter<'_>,
    ) -> Result<Found, Cancelled> {
        counter.check()?;
        let i = cell as usize;
        let known = self.parent[i];
        let mut pairs_tested = 0;
        let mut may = |other: u32| {
            counter.pair()?;
            pairs_tested += 1;
            let (own, other) = (&cells[i], &cells[other as usize]);
            Ok(match self.root {
                Root::Start => prover.may(other, own).is_ok(),
                Root::Goal => prover.may(own, other).is_ok(),
            })
        };
        if known != NONE {
            // Where it was split, its halves stand in its place.
            for candidate in [known, known + 1] {
                if candidate != cell && self.is_above(candidate, level) && may(candidate)? {
                    return Ok(Found { parent: Some(candidate), pairs_tested });
                }
            }
        }
        let reach_m = match self.root {
            Root::Start => prover.reach_to_m(&cells[i]),
            Root::Goal => prover.reach_from_m(&cells[i]),
        };
        let mut parent = None;
        for other in nearest_cells(cells, cell, reach_m, above) {
            if may(other)? {
                parent = Some(other);
                break;
            }
        }
        Ok(Found { parent, pairs_tested })
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

/// The range of cells within a distance of any of a rising list.
fn within_reach<R: crate::quantity::Rounding>(cells: &[Cell<R>], list: &[u32], reach_m: f64) -> std::ops::Range<u32> {
    let (Some(&first), Some(&last)) = (list.first(), list.last()) else { return 0..0 };
    let (low_m, high_m) = (cells[first as usize].from_m - reach_m, cells[last as usize].to_m + reach_m);
    let begin = cells.partition_point(|cell| cell.to_m < low_m.next_down());
    let end = cells.partition_point(|cell| cell.from_m <= high_m.next_up());
    let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
    index(begin)..index(end.max(begin))
}

/// The cells of a rising list within a distance of a cell, the nearest first.
fn nearest_cells<'c, R: crate::quantity::Rounding>(
    cells: &'c [Cell<R>],
    cell: u32,
    reach_m: f64,
    among: &'c [u32],
) -> impl Iterator<Item = u32> + 'c {
    let own = &cells[cell as usize];
    let gap_m = move |other: u32| {
        let other = &cells[other as usize];
        (other.from_m - own.to_m).max(own.from_m - other.to_m).next_down()
    };
    let around = among.partition_point(|&other| other < cell)..among.partition_point(|&other| other <= cell);
    nearest_first(among, around, gap_m, reach_m)
}

/// The items of a list within a distance, the nearest first, given how far each is; from `around` on the distances grow to either side.
pub(super) fn nearest_first<I: Copy>(
    list: &[I],
    around: std::ops::Range<usize>,
    gap_m: impl Fn(I) -> f64,
    reach_m: f64,
) -> impl Iterator<Item = I> {
    let std::ops::Range { start: mut left, end: mut right } = around;
    std::iter::from_fn(move || {
        let near = |item: &I| Some((gap_m(*item), *item)).filter(|(gap_m, _)| *gap_m <= reach_m);
        let before = left.checked_sub(1).and_then(|i| near(&list[i]));
        let after = list.get(right).and_then(near);
        let take_left = match (before, after) {
            (Some((a, _)), Some((b, _))) => a <= b,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => return None,
        };
        if take_left {
            left -= 1;
            before.map(|(_, item)| item)
        } else {
            right += 1;
            after.map(|(_, item)| item)
        }
    })
}
