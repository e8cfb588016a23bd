//! Paths through points inside the may-cells: they improve the upper bound where equidistant points miss a path.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::{
    Faults,
    depths::{CUT_OFF, nearest_first},
    refine::Refinement,
};
use crate::{
    ballistics::Arc,
    chain::Station,
    graph::{Cost, Edge, Leg, SearchOptions},
    hop::HopTest,
    progress::{Cancelled, Meter, PairCounter},
    quantity::SlopeInterval,
};

/// A point of a cell that lies on a may-path.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    station: Station,
    /// The least hops from the start to its cell, and from its cell to the goal.
    from_start: u32,
    to_goal: u32,
}

/// The points tried, from left to right, and how each was first reached.
#[derive(Debug)]
pub(super) struct Tried {
    candidates: Vec<Candidate>,
    reached: Vec<Option<Reached>>,
    start: usize,
    goal: usize,
}

/// How a point was reached.
#[derive(Clone, Copy, Debug)]
struct Reached {
    /// The previous point and the lofts of the hop; `None` for the start itself.
    by: Option<(usize, SlopeInterval)>,
}

/// With more cells than this, only their middles are tried.
const MANY_CELLS: usize = 4000;

/// Which cells supply the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scope {
    /// Cells on may-paths from start to goal of at most this many hops; stops when the goal is reached.
    Paths(u32),
    /// All cells that may be reached from the start.
    FromStart,
}

/// Tries the middles and ends of cells, level by level from the start.
///
/// As cells are split, their points become denser exactly where a path may lead.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn try_points<F: Faults>(refinement: &Refinement<'_, F>, scope: Scope, meter: &Meter<'_>) -> Result<Tried, Cancelled> {
    let test = refinement.prover.test();
    let mut tried = Tried::over(refinement, scope);
    let at_most = if let Scope::Paths(at_most) = scope { at_most } else { CUT_OFF };
    tried.reached[tried.start] = Some(Reached { by: None });
    let mut frontier = vec![tried.start];
    let mut hops = 0;
    let reach_m = test.greatest_reach_m();
    let (mut by_depth, mut open) = (tried.by_depth(), BTreeSet::new());
    while !frontier.is_empty() && hops < at_most && (scope == Scope::FromStart || tried.reached[tried.goal].is_none()) {
        hops += 1;
        while let Some(entry) = by_depth.first_entry().filter(|entry| *entry.key() <= hops) {
            open.extend(entry.remove());
        }
        let within: Vec<usize> = open.range(tried.within_reach(&frontier, reach_m)).copied().collect();
        let (within, late): (Vec<_>, Vec<_>) =
            within.into_iter().partition(|&i| tried.candidates[i].to_goal.saturating_add(hops) <= at_most);
        for i in late {
            open.remove(&i);
        }
        let first_hop = |counter: &mut PairCounter<'_>, &i: &usize| tried.first_hop(test, reach_m, &frontier, i, counter);
        let found = within.par_iter().map_init(|| meter.counter(), first_hop).collect::<Result<Vec<_>, _>>();
        meter.check()?;
        let found = found?;
        frontier.clear();
        for (&i, by) in within.iter().zip(&found) {
            if by.is_some() {
                tried.reached[i] = Some(Reached { by: *by });
                open.remove(&i);
                frontier.push(i);
            }
        }
    }
    Ok(tried)
}

impl Tried {
    /// The points of the selected cells, none of them reached yet.
    fn over<F: Faults>(refinement: &Refinement<'_, F>, scope: Scope) -> Self {
        let geometry = refinement.prover.test().chain().geometry();
        let mut candidates: Vec<Candidate> = Vec::new();
        for (i, cell) in refinement.cells.iter().enumerate() {
            let from_start = refinement.from_start.of(i);
            let (asked, to_goal) = match scope {
                Scope::Paths(at_most) => (refinement.over(i).is_some_and(|hops| hops <= at_most), refinement.to_goal.of(i)),
                Scope::FromStart => (from_start != CUT_OFF, 0),
            };
            if !asked && i != refinement.start && i != refinement.goal {
                continue;
            }
            let width = cell.from_m < cell.to_m;
            let middle = if width { cell.middle_m() } else { Some(cell.from_m) };
            // With many cells their middles are dense enough.
            let ends = if width && refinement.cells.len() < MANY_CELLS { [Some(cell.from_m), Some(cell.to_m)] } else { [None; 2] };
            let places = [ends[0], middle, ends[1]];
            for station in places.into_iter().flatten().filter_map(|x_m| geometry.station(x_m).ok()) {
                // An end of a stretch that is a vertex has a cell of its own.
                if station.site == cell.site {
                    candidates.push(Candidate { station, from_start, to_goal });
                }
            }
        }
        candidates.sort_by(|a, b| a.station.point.x_m.total_cmp(&b.station.point.x_m));
        candidates.dedup_by(|a, b| {
            let same = a.station.point.x_m == b.station.point.x_m;
            if same {
                // An end shared by two stretches gets the smaller depth of the two.
                (b.from_start, b.to_goal) = (b.from_start.min(a.from_start), b.to_goal.min(a.to_goal));
            }
            same
        });
        let at = |cell: usize| {
            let x_m = refinement.cells[cell].from_m;
            candidates.partition_point(|c| c.station.point.x_m < x_m)
        };
        let (start, goal) = (at(refinement.start), at(refinement.goal));
        Self { reached: vec![None; candidates.len()], candidates, start, goal }
    }

    /// All points except the start, by the least hops to their cells.
    fn by_depth(&self) -> BTreeMap<u32, Vec<usize>> {
        let mut by_depth: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, candidate) in self.candidates.iter().enumerate().filter(|(i, _)| *i != self.start) {
            by_depth.entry(candidate.from_start).or_default().push(i);
        }
        by_depth
    }

    /// The range of points within a distance of any point of an ascending frontier.
    fn within_reach(&self, frontier: &[usize], reach_m: f64) -> std::ops::Range<usize> {
        let x_m = |i: usize| self.candidates[i].station.point.x_m;
        let (Some(&first), Some(&last)) = (frontier.first(), frontier.last()) else { return 0..0 };
        let begin = self.candidates.partition_point(|c| c.station.point.x_m < x_m(first) - reach_m);
        let end = self.candidates.partition_point(|c| c.station.point.x_m <= x_m(last) + reach_m);
        begin..end.max(begin)
    }

    /// The nearest point of an ascending frontier from which one hop leads to a point.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn first_hop(
        &self,
        test: &HopTest,
        reach_m: f64,
        frontier: &[usize],
        to: usize,
        counter: &mut PairCounter<'_>,
    ) -> Result<Option<(usize, SlopeInterval)>, Cancelled> {
        counter.check()?;
        let x_m = |i: usize| self.candidates[i].station.point.x_m;
        let around = frontier.partition_point(|&i| i < to);
        let nearest = nearest_first(frontier, around..around, |i| (x_m(i) - x_m(to)).abs(), reach_m);
        for from in nearest {
            counter.pair()?;
            if let Ok(lofts) = test.lofts(&self.candidates[from].station, &self.candidates[to].station) {
                return Ok(Some((from, lofts)));
            }
        }
        Ok(None)
    }

    /// The path to the goal with its cost, if the goal was reached.
    pub(super) fn path(&self, test: &HopTest, options: &SearchOptions) -> Option<(Cost, Vec<Leg>)> {
        let (mut cost, mut legs) = (Cost::default(), Vec::new());
        let mut here = self.goal;
        while let Some((from, lofts)) = self.reached[here]?.by {
            let (takeoff, landing) = (self.candidates[from].station, self.candidates[here].station);
            let sight = test.line_of_sight(&takeoff, &landing)?;
            let arc = Arc::new(sight, test.loft(options.takeoff, sight, lofts), test.gravity_m_s2());
            cost = cost + options.effort.cost(&arc, 1);
            legs.push(Leg { takeoff, landing, edge: Edge::Hop(lofts), loft: None });
            here = from;
        }
        legs.reverse();
        Some((cost, legs))
    }

    /// The x of all points reached, in ascending order.
    pub(super) fn reached_x_m(&self) -> Vec<f64> {
        let points = self.candidates.iter().zip(&self.reached);
        points.filter(|(_, reached)| reached.is_some()).map(|(candidate, _)| candidate.station.point.x_m).collect()
    }
}
