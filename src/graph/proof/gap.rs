//! Why there is no path: the parts of the chain proved reachable and unreachable, and the limits that refuse the hops between
//! them.

use super::{Faults, Prover, cell::Cell, depths::CUT_OFF, points::try_points, refine::Refinement};
use crate::{
    graph::RefusalCounts,
    progress::{Cancelled, Meter},
};

/// What is proved for a stretch of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StretchClass {
    /// A path from the start to one of its points was found.
    Reachable,
    /// No path leads from the start to any point of it, at any resolution.
    Unreachable,
    /// Neither is proved.
    Open,
}

impl StretchClass {
    /// All classes.
    pub const ALL: [Self; 3] = [Self::Reachable, Self::Unreachable, Self::Open];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reachable => "reachable",
            Self::Unreachable => "unreachable",
            Self::Open => "open",
        }
    }
}

crate::quantity::by_name!(StretchClass, StretchClass::ALL);

/// A stretch of the chain with one class; a vertex, the start or the goal has zero length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// x of its left end, m.
    pub from_x_m: f64,
    /// x of its right end, m.
    pub to_x_m: f64,
    /// What is proved for it.
    pub class: StretchClass,
    /// Whether a may-path leads from it to the goal; if not, the goal is provably unreachable from it.
    pub may_lead_to_goal: bool,
}

/// The gap that makes a journey impossible.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// No path from the start comes nearer to the goal than this x, m.
    pub reached_x_m: f64,
    /// No position nearer to the start than this x leads to the goal, m.
    pub leads_to_goal_x_m: f64,
    /// Number of cells that may be reached from the start.
    pub reached_cells: usize,
    /// Number of cells from which the goal may be reached.
    pub leading_cells: usize,
    /// The refusals of the hops from the cells that may be reached to the other cells within reach: pairs of cells, each
    /// counted under the first limit that leaves no arc.
    pub refusals: RefusalCounts,
}

impl<F: Faults> Refinement<'_, F> {
    /// Every cell with what is proved for it; settles all depths.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn stretches(&mut self, meter: &Meter<'_>) -> Result<Vec<Stretch>, Cancelled> {
        self.settle_from_start(CUT_OFF, meter)?;
        self.settle_to_goal(CUT_OFF, meter)?;
        let reached = try_points(self, super::points::Scope::FromStart, meter)?.reached_x_m();
        let class = |i: usize, cell: &Cell<F::Rounding>| {
            if self.from_start.of(i) == CUT_OFF {
                StretchClass::Unreachable
            } else if reached[reached.partition_point(|x_m| *x_m < cell.from_m)..].first().is_some_and(|x_m| *x_m <= cell.to_m) {
                StretchClass::Reachable
            } else {
                StretchClass::Open
            }
        };
        let stretch = |(i, cell): (usize, &Cell<F::Rounding>)| Stretch {
            from_x_m: cell.from_m,
            to_x_m: cell.to_m,
            class: class(i, cell),
            may_lead_to_goal: self.to_goal.of(i) != CUT_OFF,
        };
        Ok(self.cells.iter().enumerate().map(stretch).collect())
    }

    /// The gap, once the goal is proved unreachable; settles all depths.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn gap(&mut self, meter: &Meter<'_>) -> Result<Gap, Cancelled> {
        self.settle_from_start(CUT_OFF, meter)?;
        self.settle_to_goal(CUT_OFF, meter)?;
        let of =
            |depths: &super::depths::Depths| -> Vec<usize> { (0..self.cells.len()).filter(|&i| depths.of(i) != CUT_OFF).collect() };
        let (reached, leading) = (of(&self.from_start), of(&self.to_goal));
        let unreached: Vec<usize> = (0..self.cells.len()).filter(|i| reached.binary_search(i).is_err()).collect();
        let (start_m, goal_m) = (self.cells[self.start].from_m, self.cells[self.goal].from_m);
        let nearest = |cells: &[usize], to_m: f64| {
            let nearest_points = cells.iter().map(|&i| to_m.clamp(self.cells[i].from_m, self.cells[i].to_m));
            nearest_points.min_by(|a, b| (a - to_m).abs().total_cmp(&(b - to_m).abs()))
        };
        Ok(Gap {
            reached_x_m: nearest(&reached, goal_m).unwrap_or(start_m),
            leads_to_goal_x_m: nearest(&leading, start_m).unwrap_or(goal_m),
            reached_cells: reached.len(),
            leading_cells: leading.len(),
            refusals: refusals_between(&self.prover, &self.cells, &reached, &unreached, meter)?,
        })
    }
}

/// The most pairs of cells analysed, which takes about a second at most.
const MOST_PAIRS: usize = 1_000_000;

/// The refusals of the hops from one set of cells to another.
///
/// If there are too many pairs, a regular sample of the take-off cells is used.
fn refusals_between<F: Faults>(
    prover: &Prover<'_, F>,
    cells: &[Cell<F::Rounding>],
    reached: &[usize],
    others: &[usize],
    meter: &Meter<'_>,
) -> Result<RefusalCounts, Cancelled> {
    let mut counter = meter.counter();
    let within = |from: usize, to: usize| {
        let (from, to) = (&cells[from], &cells[to]);
        (to.from_m - from.to_m).max(from.from_m - to.to_m) <= prover.reach_from_m(from)
    };
    let step = (reached.len().saturating_mul(others.len()) / MOST_PAIRS).max(1);
    let mut counts = RefusalCounts::default();
    for &from in reached.iter().step_by(step) {
        for &to in others.iter().filter(|&&to| within(from, to)) {
            counter.pair()?;
            if let Err(limit) = prover.may(&cells[from], &cells[to]) {
                counts.count(limit);
            }
        }
    }
    Ok(counts)
}
