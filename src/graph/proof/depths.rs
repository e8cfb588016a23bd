//! The number of may-hops of each cell from one end of the journey: a breadth-first search, updated as cells are split.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::{Faults, Prover, cell::Cell};
use crate::progress::{Cancelled, Meter, PairCounter};

/// No may-path joins the cell to this end.
pub(super) const CUT_OFF: u32 = u32::MAX;

/// No cell.
const NONE: u32 = u32::MAX;

/// The end of the journey from which depths are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Root {
    /// The start: depth is the least number of may-hops from it.
    Start,
    /// The goal: depth is the least number of may-hops to it.
    Goal,
}

/// A lower bound on the depth of every cell.
///
/// Splitting cells only removes may-hops, so depths only increase. A cell keeps the parent that gave its depth until that
/// parent is split or becomes deeper. It then looks for another parent of the same depth, and otherwise moves one level down
/// (Even and Shiloach 1981, with edges tested on demand and not stored). Memory is a few numbers per cell.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    root: Root,
    /// The least number of may-hops; [`CUT_OFF`] if provably unreachable.
    depth: Vec<u32>,
    /// The cell one level up that gave the depth, or a candidate for it.
    parent: Vec<u32>,
    /// Whether the edge from that parent was tested with the current cells.
    tested: Vec<bool>,
    /// Number of pairs of cells tested.
    pub(super) pairs_tested: u64,
}

/// The result of one cell's search for a parent.
struct Found {
    parent: Option<u32>,
    pairs_tested: u64,
}

impl Depths {
    /// The initial state before any test: every cell is at least one hop from the end.
    ///
    /// The distance divided by the greatest reach would be a larger bound on hops, but not in the may-graph, where crossing a
    /// cell is free. A depth must be a lower bound for every may-path; otherwise the level above would lack a parent that
    /// exists.
    pub(super) fn new(root: Root, cells: usize, end: usize) -> Self {
        let depth = (0..cells).map(|i| u32::from(i != end)).collect();
        Self { root, depth, parent: vec![NONE; cells], tested: vec![false; cells], pairs_tested: 0 }
    }

    /// The least number of may-hops, as far as settled.
    pub(super) fn of(&self, cell: usize) -> u32 {
        self.depth[cell]
    }

    /// Settles all depths up to a limit; deeper cells are only known to be deeper.
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
        // Cells not nearer than the current level that have no parent yet.
        let mut waiting: BTreeSet<u32> = BTreeSet::new();
        let mut level = 0;
        while level < limit && !above.is_empty() && !(waiting.is_empty() && by_depth.is_empty()) {
            level += 1;
            let mut settled = Vec::new();
            for cell in by_depth.remove(&level).unwrap_or_default() {
                if self.has_parent(cell, level) {
                    settled.push(cell);
                } else {
                    // A cell has no depth until it has a parent, so that it cannot be a parent itself.
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
        // After an empty level all remaining cells are unreachable; otherwise they are deeper than the limit.
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

    /// Whether the known parent still gives a cell this depth.
    fn has_parent(&self, cell: u32, level: u32) -> bool {
        self.tested[cell as usize] && self.is_above(self.parent[cell as usize], level)
    }

    /// Whether a cell is one level nearer to the end.
    fn is_above(&self, cell: u32, level: u32) -> bool {
        self.depth.get(cell as usize) == Some(&(level - 1))
    }

    /// Looks for a cell of the level above from which (or to which) a hop may lead: first the known parent, then the nearest
    /// cells.
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
            // A parent that was split is replaced by its halves.
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

    /// Updates the depths after a split: `halves` holds, for each old cell, the index of its first new cell and their number.
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

/// The range of cells within a distance of any cell of an ascending list.
fn within_reach<R: crate::quantity::Rounding>(cells: &[Cell<R>], list: &[u32], reach_m: f64) -> std::ops::Range<u32> {
    let (Some(&first), Some(&last)) = (list.first(), list.last()) else { return 0..0 };
    let (low_m, high_m) = (cells[first as usize].from_m - reach_m, cells[last as usize].to_m + reach_m);
    let begin = cells.partition_point(|cell| cell.to_m < low_m.next_down());
    let end = cells.partition_point(|cell| cell.from_m <= high_m.next_up());
    let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
    index(begin)..index(end.max(begin))
}

/// The cells of an ascending list within a distance of a cell, the nearest first.
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

/// The items of a list within a distance, the nearest first. The distances must increase in both directions from `around`.
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
