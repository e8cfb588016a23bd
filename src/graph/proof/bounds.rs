//! Both bounds on the fewest hops, refined until they meet.

use super::{
    Faults, Gap, Prover, Sound, Stretch,
    depths::CUT_OFF,
    points::{Scope, try_points},
    refine::Refinement,
};
use crate::{
    chain::Station,
    graph::{AUTO_POINTS_PER_SEGMENT, Answer, Outcome, PointSpacing, SearchError, SearchOptions, search_one},
    hop::HopTest,
    progress::{Cancelled, Detail, Meter, Progress, Stage},
};

/// The cells that a proof may use where nothing else is asked for: some 200 bytes each.
pub const DEFAULT_BUDGET_CELLS: usize = 50_000;

/// How to bound.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundsOptions {
    /// The greatest number of cells; memory grows with it alone.
    pub budget_cells: usize,
    /// How to search for the first path, and how its effort is counted. Without a spacing the few first choices of "auto" are tried; the
    /// points inside may-cells take over from there.
    pub search: SearchOptions,
    /// When to stop.
    pub until: Until,
    /// Whether to say of every cell what is proved of it, and why there is no path.
    pub explain: bool,
}

impl Default for BoundsOptions {
    fn default() -> Self {
        Self { budget_cells: DEFAULT_BUDGET_CELLS, search: SearchOptions::default(), until: Until::BoundsMeet, explain: false }
    }
}

/// When bounds are close enough.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Until {
    /// When they meet, or the goal is cut off.
    #[default]
    BoundsMeet,
    /// When it is known whether there is a path, in however many hops.
    Decided,
}

/// What bounds come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProofVerdict {
    /// A path was found.
    Traversable,
    /// Proved: no path, at any resolution.
    Untraversable,
    /// No path found, and none excluded: the budget ended.
    Open,
}

impl ProofVerdict {
    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Traversable => "traversable",
            Self::Untraversable => "untraversable",
            Self::Open => "no-path-found",
        }
    }
}

/// What a proof took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProofSummary {
    /// Cells at the end.
    pub cells: usize,
    /// How many cells were split in two.
    pub splits: u64,
    /// How often the depths of all cells were settled.
    pub rounds: u32,
    /// How many pairs of cells were tested.
    pub pairs_tested: u64,
    /// Whether the best path goes over points of the cells, not over those of the search.
    pub path_over_cells: bool,
}

/// A path and a bound that no path undercuts.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// No path has fewer hops, at any resolution; `None`: proved, there is no path at all.
    pub lower: Option<u64>,
    /// The best path known with the counts of the search, or why none was found. The path may be one over points of the cells.
    pub answer: Answer,
    /// What it took.
    pub summary: ProofSummary,
    /// What is proved of each stretch, from left to right; empty where it was not asked for.
    pub stretches: Vec<Stretch>,
    /// Where there is proved to be no path: why. `None` also where it was not asked for.
    pub gap: Option<Gap>,
}

impl Bounds {
    /// The hops of the best path known; `None` where there is none.
    pub fn upper(&self) -> Option<u64> {
        self.answer.hops()
    }

    /// What the bounds come to.
    pub fn verdict(&self) -> ProofVerdict {
        match (self.upper(), self.lower) {
            (Some(_), _) => ProofVerdict::Traversable,
            (None, None) => ProofVerdict::Untraversable,
            (None, Some(_)) => ProofVerdict::Open,
        }
    }

    /// Whether nothing is left open: the bounds meet, or there is no path.
    pub fn is_proved(&self) -> bool {
        self.lower == self.upper()
    }
}

/// Bounds the fewest hops from start to goal from both sides, for every choice of points.
///
/// Reports the cells of each round.
///
/// # Errors
/// [`SearchError`]: cancelled, or too many nodes for the search for a first path.
///
/// # Complexity
/// Memory grows with the budget of cells alone. A round tests each cell against the cells one may-hop nearer to start or goal until one
/// may be joined to it: with C cells, W of them in reach of each and S vertices flown past, O(C W S) at worst; later rounds only look at
/// what was split and what lost its may-path.
///
/// # Examples
/// ```
/// use chta::{chain::*, graph::proof::*, hop::HopTest, quantity::*, world::*};
/// let hopper = Hopper::with_speeds(5.0, 5.0).unwrap();
/// let grip = Some(Grip::Friction(FrictionCone::new(1.0).unwrap()));
/// let points = [(0.0, 0.0), (60.0, 0.0), (60.5, 50.0), (80.0, 50.0)].map(|(x, z)| ChainPoint::new(x, z));
/// let chain = PolygonalChain::bare(points.to_vec()).unwrap();
/// let chain = ConstrainedChain::new(chain, &hopper, Gravity::new(1.0).unwrap(), &SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds }).unwrap();
/// let test = HopTest::new(chain.clone());
/// let at = |x| chain.geometry().station(x).unwrap();
/// // A hop at 45 degrees carries v^2 / g = 25 m: 60 m take three, and no path takes two.
/// let there = bounds(&test, at(0.0), at(60.0), &BoundsOptions::default(), &()).unwrap();
/// assert_eq!((there.lower, there.upper()), (Some(3), Some(3)));
/// // 5 m/s lift no one over a 50 m wall: v^2 / (2 g) = 12.5 m.
/// let up = bounds(&test, at(0.0), at(70.0), &BoundsOptions::default(), &()).unwrap();
/// assert_eq!(up.verdict(), ProofVerdict::Untraversable);
/// ```
pub fn bounds(
    test: &HopTest,
    start: Station,
    goal: Station,
    options: &BoundsOptions,
    progress: &dyn Progress,
) -> Result<Bounds, SearchError> {
    bounds_of(test, (start, goal), options, &Meter::new(progress, Stage::Proof))
}

/// The same as a part of another stage.
pub(crate) fn bounds_of(
    test: &HopTest,
    ends: (Station, Station),
    options: &BoundsOptions,
    meter: &Meter<'_>,
) -> Result<Bounds, SearchError> {
    bounds_with::<Sound>(test, ends, options, meter)
}

/// The same with the faults that a test asks for.
pub(super) fn bounds_with<F: Faults>(
    test: &HopTest,
    (start, goal): (Station, Station),
    options: &BoundsOptions,
    meter: &Meter<'_>,
) -> Result<Bounds, SearchError> {
    meter.report(Detail::None)?;
    let answer = first_path(test, (start, goal), &options.search, meter)?;
    if answer.hops() == Some(0) {
        let nothing = ProofSummary::default();
        return Ok(Bounds { lower: Some(0), answer, summary: nothing, stretches: Vec::new(), gap: None });
    }
    let mut closing = Closing {
        refinement: Refinement::<F>::new(Prover::new(test), &start, &goal),
        options,
        answer,
        rounds: 0,
        path_over_cells: false,
        tried_cells: 0,
    };
    let lower = closing.close(meter)?;
    let (mut stretches, mut gap) = (Vec::new(), None);
    if options.explain {
        stretches = closing.refinement.stretches(meter)?;
        gap = lower.is_none().then(|| closing.refinement.gap(meter)).transpose()?;
    }
    Ok(Bounds { lower, summary: closing.summary(), answer: closing.answer, stretches, gap })
}

/// The first path, over the points asked for, or the first of "auto" while they are few.
fn first_path(test: &HopTest, ends: (Station, Station), options: &SearchOptions, meter: &Meter<'_>) -> Result<Answer, SearchError> {
    let spacing = options.spacing.unwrap_or(PointSpacing::PerSegment(AUTO_POINTS_PER_SEGMENT[0]));
    search_one(test, ends, &SearchOptions { spacing: Some(spacing), ..options.clone() }, meter)
}

/// Two bounds that close in on each other.
struct Closing<'a, 'o, F: Faults> {
    refinement: Refinement<'a, F>,
    options: &'o BoundsOptions,
    answer: Answer,
    rounds: u32,
    path_over_cells: bool,
    /// How many cells there were when points were last tried.
    tried_cells: usize,
}

impl<F: Faults> Closing<'_, '_, F> {
    /// Refines until the bounds meet, the goal is cut off, or the budget ends; gives the lower bound.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn close(&mut self, meter: &Meter<'_>) -> Result<Option<u64>, Cancelled> {
        loop {
            let upper = self.answer.hops().map(|hops| u32::try_from(hops).unwrap_or(CUT_OFF));
            let lower = self.refinement.settle_from_start(upper.unwrap_or(CUT_OFF), meter)?;
            self.rounds += 1;
            meter.report(Detail::ProofRound { cells: self.refinement.cells.len(), round: self.rounds })?;
            if lower == CUT_OFF {
                return Ok(None);
            }
            let decided = upper.is_some() && self.options.until == Until::Decided;
            if decided || upper.is_some_and(|upper| lower >= upper) {
                return Ok(Some(u64::from(lower)));
            }
            // Only may-paths shorter than the best path can change the answer.
            let shorter = upper.map_or(CUT_OFF - 1, |upper| upper - 1);
            self.refinement.settle_to_goal(shorter, meter)?;
            if self.try_points(shorter, meter)? {
                continue;
            }
            let breadth = if upper.is_none() { lower.saturating_add(lower / Self::BREADTH) } else { lower };
            if !self.refinement.split(breadth, self.options.budget_cells) {
                return Ok(Some(u64::from(lower)));
            }
        }
    }

    /// Without a path, may-paths longer than the shortest by this share are split with it: all of them have to be cut.
    const BREADTH: u32 = 2;

    /// Looks for a path of at most so many hops over points of the cells; whether there is one.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn try_points(&mut self, at_most: u32, meter: &Meter<'_>) -> Result<bool, Cancelled> {
        self.tried_cells = self.refinement.cells.len();
        let tried = try_points(&self.refinement, Scope::Paths(at_most), meter)?;
        let test = self.refinement.prover.test();
        let Some((cost, legs)) = tried.path(test, &self.options.search) else { return Ok(false) };
        self.answer.outcome = Outcome::Path { legs, cost };
        self.path_over_cells = true;
        Ok(true)
    }

    /// What it took so far.
    fn summary(&self) -> ProofSummary {
        ProofSummary {
            cells: self.refinement.cells.len(),
            splits: self.refinement.splits,
            rounds: self.rounds,
            pairs_tested: self.refinement.from_start.pairs_tested + self.refinement.to_goal.pairs_tested,
            path_over_cells: self.path_over_cells,
        }
    }
}
