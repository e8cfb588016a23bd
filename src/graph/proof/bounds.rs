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

/// The default limit on the number of cells; a cell takes some 200 bytes.
pub const DEFAULT_BUDGET_CELLS: usize = 50_000;

/// Options of the bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundsOptions {
    /// The greatest number of cells; memory grows only with this number.
    pub budget_cells: usize,
    /// Options of the search for the first path, including its effort. Without a spacing only the first few spacings of "auto" are
    /// tried; after that, points inside may-cells are used.
    pub search: SearchOptions,
    /// When to stop.
    pub until: Until,
    /// Whether to report what is proved for every cell, and why there is no path.
    pub explain: bool,
}

impl Default for BoundsOptions {
    fn default() -> Self {
        Self { budget_cells: DEFAULT_BUDGET_CELLS, search: SearchOptions::default(), until: Until::BoundsMeet, explain: false }
    }
}

/// The stopping criterion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Until {
    /// Stop when the bounds meet, or when the goal is proved unreachable.
    #[default]
    BoundsMeet,
    /// Stop when it is decided whether there is a path, with any number of hops.
    Decided,
}

/// The conclusion from the bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProofVerdict {
    /// A path was found.
    Traversable,
    /// Proved: there is no path, at any resolution.
    Untraversable,
    /// Undecided within the budget: no path was found, and none is excluded.
    Open,
}

impl ProofVerdict {
    /// All verdicts.
    pub const ALL: [Self; 3] = [Self::Traversable, Self::Untraversable, Self::Open];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Traversable => "traversable",
            Self::Untraversable => "untraversable",
            Self::Open => "no-path-found",
        }
    }
}

crate::quantity::by_name!(ProofVerdict, ProofVerdict::ALL);

/// The work done for a proof.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProofSummary {
    /// Cells at the end.
    pub cells: usize,
    /// Number of cells split in two.
    pub splits: u64,
    /// Number of passes that settled the depths of all cells.
    pub rounds: u32,
    /// Number of pairs of cells tested.
    pub pairs_tested: u64,
    /// Whether the best path uses points of the cells rather than nodes of the search.
    pub path_over_cells: bool,
    /// Whether the hopper has a footprint: the proof uses it at vertices alone, so that it holds and may be weaker than it could be.
    pub footprint_at_vertices_alone: bool,
}

/// The best path found, and a lower bound on the hops of every path.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Every path has at least this many hops, at any resolution; `None`: there is provably no path.
    pub lower: Option<u64>,
    /// The best known path with the counts of the search, or why none was found. The path may use points of the cells.
    pub answer: Answer,
    /// The work done.
    pub summary: ProofSummary,
    /// What is proved for each stretch, from left to right; empty if not requested.
    pub stretches: Vec<Stretch>,
    /// Why there is no path, if that is proved; `None` also if not requested.
    pub gap: Option<Gap>,
}

impl Bounds {
    /// The hops of the best known path; `None` if no path is known.
    pub fn upper(&self) -> Option<u64> {
        self.answer.hops()
    }

    /// The conclusion from the bounds.
    pub fn verdict(&self) -> ProofVerdict {
        match (self.upper(), self.lower) {
            (Some(_), _) => ProofVerdict::Traversable,
            (None, None) => ProofVerdict::Untraversable,
            (None, Some(_)) => ProofVerdict::Open,
        }
    }

    /// Whether the question is decided: the bounds meet, or there is provably no path.
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
/// Memory grows only with the budget of cells. A round tests each cell against the cells one may-hop nearer to start or goal
/// until it finds one that may be joined to it: with C cells, W of them in reach of each and S vertices flown over, O(C W S)
/// at worst. Later rounds only test cells that were split or that lost their may-path.
///
/// # Examples
/// ```
/// use chta::{chain::*, graph::proof::*, hop::HopTest, quantity::*, world::*};
/// let hopper = Hopper::with_speeds(5.0, 5.0).unwrap();
/// let grip = Some(Grip::Friction(FrictionCone::new(1.0).unwrap()));
/// let points = [(0.0, 0.0), (60.0, 0.0), (60.5, 50.0), (80.0, 50.0)].map(|(x, z)| ChainPoint::new(x, z));
/// let chain = PolygonalChain::bare(points.to_vec()).unwrap();
/// let (gravity, surface) = (Gravity::new(1.0).unwrap(), SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds });
/// let chain = ConstrainedChain::new(chain, &hopper, gravity, &surface).unwrap();
/// let test = HopTest::new(chain);
/// let chain = test.chain();
/// let at = |x| chain.geometry().station(x).unwrap();
/// // A hop at 45 degrees covers v^2 / g = 25 m: 60 m take three, and no path takes two.
/// let there = bounds(&test, at(0.0), at(60.0), &BoundsOptions::default(), &()).unwrap();
/// assert_eq!((there.lower, there.upper()), (Some(3), Some(3)));
/// // At 5 m/s no arc rises over a 50 m wall: v^2 / (2 g) = 12.5 m.
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

/// The same with faults that a test selects.
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

/// The first path, over the points requested, or over the first spacings of "auto" while they are few.
fn first_path(test: &HopTest, ends: (Station, Station), options: &SearchOptions, meter: &Meter<'_>) -> Result<Answer, SearchError> {
    let spacing = options.spacing.unwrap_or(PointSpacing::PerSegment(AUTO_POINTS_PER_SEGMENT[0]));
    search_one(test, ends, &SearchOptions { spacing: Some(spacing), ..options.clone() }, meter)
}

/// The state of the refinement of both bounds.
struct Closing<'a, 'o, F: Faults> {
    refinement: Refinement<'a, F>,
    options: &'o BoundsOptions,
    answer: Answer,
    rounds: u32,
    path_over_cells: bool,
    /// The number of cells when points were last tried.
    tried_cells: usize,
}

impl<F: Faults> Closing<'_, '_, F> {
    /// Refines until the bounds meet, the goal is proved unreachable, or the budget ends; returns the lower bound.
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
            // Only may-paths shorter than the best path can change the result.
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

    /// Without a path, may-paths up to this factor longer than the shortest are split together with it: all of them must be
    /// cut.
    const BREADTH: u32 = 2;

    /// Searches for a path of at most this many hops over points of the cells; returns whether there is one.
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

    /// The work done so far.
    fn summary(&self) -> ProofSummary {
        ProofSummary {
            cells: self.refinement.cells.len(),
            splits: self.refinement.splits,
            rounds: self.rounds,
            pairs_tested: self.refinement.from_start.pairs_tested + self.refinement.to_goal.pairs_tested,
            path_over_cells: self.path_over_cells,
            footprint_at_vertices_alone: self.refinement.prover.test().chain().footprint().is_some(),
        }
    }
}
