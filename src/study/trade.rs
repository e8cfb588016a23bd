//! Varies one or two keys of a scenario over a grid, with the answer in every cell.

use std::{collections::BTreeMap, ops::ControlFlow, path::Path};

use rayon::prelude::*;

use super::{
    Case, CaseError, Commands, JourneyError, PipelineError, Survey, ask_the_same, free_nodes::QuestionNodes, journey,
    physics::escape_warnings, swept_key::SweptKey, trade_free::free_row,
};
use crate::{
    chain::Station,
    graph::{
        Answer, Outcome, ReliabilityUse, SearchError, SearchOptions,
        proof::{BoundsOptions, ProofVerdict, bounds_of},
        search_one,
    },
    hop::HopTest,
    path::HopPath,
    progress::{Cancelled, Detail, Meter, Progress, Stage, Step},
    report::{EffortRecord, MarginsRecord, ObjectiveRecord, SweptKeyRecord, TotalsRecord, TradeAnswer, TradeRow},
    scenario::{Entries, Route, Scenario, ScenarioProblem},
};

/// The reasons why a trade cannot be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TradeError {
    /// A text that is not of the form `TABLE.KEY=FROM:TO:STEPS`.
    #[error("{path}: found `{found}`, expected FROM:TO:STEPS, three numbers, such as hopper.takeoff_speed_max_m_s=4:10:7")]
    Malformed {
        /// The key, as typed.
        path: String,
        /// The text after it.
        found: String,
    },
    /// An unknown key.
    #[error("{path}: unknown key; {nearest}")]
    UnknownKey {
        /// The key, as typed.
        path: String,
        /// The hint that names the nearest key.
        nearest: String,
    },
    /// A key that does not take a single number.
    #[error("{path}: takes {expected}, which cannot be varied: expected a key that takes a number")]
    NotANumber {
        /// The key.
        path: String,
        /// The kind of value that it takes.
        expected: String,
    },
    /// An empty range.
    #[error("{path}: found FROM {from} and TO {to}, expected FROM below TO, both finite")]
    Range {
        /// The key.
        path: String,
        /// Where it begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// Too few values, too many, or not a whole number.
    #[error("{path}: STEPS is {found}, expected how many values to try, a whole number from 2 to {}", SweptKey::MOST)]
    Steps {
        /// The key.
        path: String,
        /// The given text.
        found: String,
    },
    /// A value outside the key's range.
    #[error("{path}: a value is {value}, expected {expected}")]
    Value {
        /// The key.
        path: String,
        /// The value.
        value: f64,
        /// The expected value.
        expected: String,
    },
    /// The same key twice.
    #[error("{path} is varied twice, expected two different keys")]
    Twice {
        /// The key.
        path: String,
    },
    /// No key, or more than two.
    #[error("found {found} keys to vary, expected one, or two for a grid")]
    Count {
        /// How many.
        found: usize,
    },
    /// Too many cells.
    #[error("the grid has {cells} cells, expected at most {}: choose fewer STEPS", Trade::MOST_CELLS)]
    Cells {
        /// How many.
        cells: usize,
    },
    /// A key without effect on the answer.
    #[error(
        "{path}: no value from {from} to {to} changes anything here: no verdict depends on this key, or the chain's own limits, its friction \
         or the escape speed decide"
    )]
    NoEffect {
        /// The key.
        path: String,
        /// The least value.
        from: f64,
        /// The greatest value.
        to: f64,
    },
    /// A proof over free routes.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The reasons why one cell has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CellError {
    /// Values that no scenario takes together.
    #[error("{}", sentences(problems))]
    Scenario {
        /// All problems.
        problems: Vec<ScenarioProblem>,
    },
    /// A terrain without a usable chain.
    #[error(transparent)]
    Prepare(#[from] PipelineError),
    /// No start or no goal.
    #[error("found no start or no goal, expected terrain.start_x_m and terrain.goal_x_m")]
    NoEnds,
    /// The search.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// The estimate of a success.
    #[error(transparent)]
    Journey(#[from] JourneyError),
}

impl From<CaseError> for CellError {
    fn from(error: CaseError) -> Self {
        match error {
            CaseError::Prepare(error) => error.into(),
            other => Self::Journey(other.into()),
        }
    }
}

/// The answers of all cells.
#[derive(Debug)]
pub struct TradedCells {
    /// They as plain data.
    pub answer: TradeAnswer,
    /// The cells without an answer: which row, and the reason.
    pub failed: Vec<(usize, CellError)>,
    /// The warnings about free routes.
    pub route_warnings: Vec<String>,
}

/// The answer for one pair of ends: the verdict, the hops and, with a proof, the lower bound of the hops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Varied {
    /// The verdict: `Open` if no path was found and none excluded.
    pub verdict: ProofVerdict,
    /// The fewest hops found.
    pub hops: Option<u64>,
    /// With a proof: no path has fewer hops; `None` if there is no path at all.
    pub lower_bound: Option<Option<u64>>,
}

/// The verdict over one chain, with a proof within a budget of cells if one is given.
///
/// # Errors
/// [`SearchError`].
pub fn verdict(
    test: &HopTest,
    ends: (Station, Station),
    options: &SearchOptions,
    proof_budget_cells: Option<usize>,
    progress: &dyn Progress,
) -> Result<Varied, SearchError> {
    let stage = if proof_budget_cells.is_some() { Stage::Proof } else { Stage::Search };
    Ok(verdict_of(test, ends, options, proof_budget_cells, &Meter::new(progress, stage))?.0)
}

/// The same as a part of another stage, with the answer of the search.
fn verdict_of(
    test: &HopTest,
    ends: (Station, Station),
    options: &SearchOptions,
    proof_budget_cells: Option<usize>,
    meter: &Meter<'_>,
) -> Result<(Varied, Answer), SearchError> {
    let Some(budget_cells) = proof_budget_cells else {
        let found = search_one(test, ends, options, meter)?;
        let hops = found.hops();
        let verdict = if hops.is_some() { ProofVerdict::Traversable } else { ProofVerdict::Open };
        return Ok((Varied { verdict, hops, lower_bound: None }, found));
    };
    let options = BoundsOptions { budget_cells, search: options.clone(), ..BoundsOptions::default() };
    let bounds = bounds_of(test, ends, &options, meter)?;
    Ok((Varied { verdict: bounds.verdict(), hops: bounds.upper(), lower_bound: Some(bounds.lower) }, bounds.answer))
}

/// Parts of the work of a cell, which are not reported, and end with it.
struct Unreported<'m, 'p>(&'m Meter<'p>);

impl Progress for Unreported<'_, '_> {
    fn report(&self, _: &Step) -> ControlFlow<()> {
        if self.0.check().is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A scenario, its terrain and its swept keys.
#[derive(Clone, Debug)]
pub struct Trade<'a> {
    entries: &'a Entries,
    base: &'a Path,
    survey: &'a Survey,
    swept: &'a [SweptKey],
}

impl<'a> Trade<'a> {
    /// The greatest number of cells in a grid.
    pub const MOST_CELLS: usize = 100_000;

    /// A trade of the keys as typed, over terrain that was read once; `base` is the folder that the scenario's paths start from.
    ///
    /// # Errors
    /// [`TradeError`], if the swept keys do not define a row or a grid.
    pub fn new(entries: &'a Entries, base: &'a Path, survey: &'a Survey, swept: &'a [SweptKey]) -> Result<Self, TradeError> {
        checked(swept)?;
        Ok(Self { entries, base, survey, swept })
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        cells(self.swept)
    }

    /// The answer in every cell, in parallel; the same for any number of threads.
    ///
    /// The last key changes fastest. Reports every cell. A cell that fails has a row with its error.
    ///
    /// # Errors
    /// [`TradeError`]: a key without effect, or it was cancelled.
    pub fn run(&self, proof_budget_cells: Option<usize>, progress: &dyn Progress) -> Result<TradedCells, TradeError> {
        let meter = Meter::with_total(progress, Stage::Trade, self.cells() as u64);
        meter.report(Detail::None)?;
        for axis in 0..self.swept.len() {
            self.check_effect(axis, &meter)?;
        }
        self.read_ahead();
        let nodes = self.question_nodes();
        let row = |cell| -> Result<Result<TradeRow, CellError>, Cancelled> {
            meter.check()?;
            let row = match self.row(&self.at(cell), (proof_budget_cells, nodes.as_ref()), &meter) {
                Err(CellError::Search(SearchError::Cancelled(cancelled))) => return Err(cancelled),
                row => row,
            };
            meter.complete_one()?;
            Ok(row)
        };
        let answered: Vec<_> = (0..self.cells()).into_par_iter().map(row).collect();
        meter.check()?;
        let (mut rows, mut failed) = (Vec::with_capacity(answered.len()), Vec::new());
        for (cell, answer) in answered.into_iter().enumerate() {
            rows.push(answer?.unwrap_or_else(|error| {
                let row = TradeRow::failed(self.named(&self.at(cell)), error.to_string());
                failed.push((cell, error));
                row
            }));
        }
        let vary = self.swept.iter().map(|v| SweptKeyRecord { key: v.path(), values: v.values().to_vec() }).collect();
        let first = (0..self.cells()).find_map(|cell| self.scenario(&self.at(cell)).ok());
        let route_warnings = nodes.zip(first).map(|(nodes, first)| nodes.warnings_of_all(&first)).unwrap_or_default();
        let answer = TradeAnswer { vary, route: nodes.map(|nodes| nodes.record), rows };
        Ok(TradedCells { answer, failed, route_warnings })
    }

    /// Reads the whole raster where trials over it estimate a success, so that the cells, which are answered side by side, find it read. What is
    /// wrong with it, they say.
    fn read_ahead(&self) {
        let flies = |scenario: &Scenario| {
            let estimates = scenario.budget.estimated_success_min.is_some() && scenario.uncertainty.is_some();
            estimates && scenario.risk != ReliabilityUse::Ignored
        };
        // The cells differ in numbers, not in whether they fly.
        let first = (0..self.cells()).find_map(|cell| self.scenario(&self.at(cell)).ok());
        if let Some((sliced, _)) = first.filter(flies).and_then(|_| self.survey.sliced()) {
            let _ = sliced.whole();
        }
    }

    /// The nodes of free routes, the same for all cells; `None` along a transect, and where their spacing is varied.
    fn question_nodes(&self) -> Option<QuestionNodes> {
        if self.swept.iter().any(|v| matches!(v.key(), ("search", "node_spacing_max_m" | "points_per_segment"))) {
            return None;
        }
        // Without a case that can be prepared, every cell says why.
        let first = (0..self.cells()).find_map(|cell| self.case(&self.at(cell)).ok())?;
        let scenarios = (0..self.cells()).filter_map(|cell| self.scenario(&self.at(cell)).ok());
        QuestionNodes::resolved(&first, scenarios).ok().flatten()
    }

    /// The values of a cell by their keys.
    fn named(&self, values: &[f64]) -> BTreeMap<String, f64> {
        self.swept.iter().map(SweptKey::path).zip(values.iter().copied()).collect()
    }

    /// The values of a cell, from its number.
    fn at(&self, cell: usize) -> Vec<f64> {
        at(self.swept, cell)
    }

    /// The scenario of a cell.
    fn scenario(&self, values: &[f64]) -> Result<Scenario, CellError> {
        Scenario::new(varied(self.entries, self.swept, values, "varied")).map_err(|problems| CellError::Scenario { problems })
    }

    /// The case of a cell.
    fn case(&self, values: &[f64]) -> Result<Case, CellError> {
        let scenario = self.scenario(values)?;
        // The one number that changes how the terrain is read.
        let rereads = self.swept.iter().any(|v| v.key() == ("terrain", "mesh_scale"));
        let reread = scenario.terrain.as_ref().filter(|_| rereads).map(|source| Survey::of(&scenario, source, self.base));
        let reread = reread.transpose()?;
        Ok(Case::over(reread.as_ref().unwrap_or(self.survey), scenario, self.base, Commands::OfTheMachine)?)
    }

    /// One cell.
    fn row(
        &self,
        values: &[f64],
        (proof_budget_cells, nodes): (Option<usize>, Option<&QuestionNodes>),
        meter: &Meter<'_>,
    ) -> Result<TradeRow, CellError> {
        let mut case = self.case(values)?;
        if case.scenario.route == Route::Free {
            if let Some(nodes) = nodes {
                case.scenario = nodes.of(case.scenario);
            }
            return free_row(&case, self.named(values), &Unreported(meter));
        }
        let Case { scenario, prepared, .. } = &case;
        let ends = prepared.start.zip(prepared.goal).ok_or(CellError::NoEnds)?;
        let above_escape = !escape_warnings(scenario, Some(prepared.chain.geometry())).is_empty();
        let distance_m = (ends.1.point.x_m - ends.0.point.x_m).abs();
        let test = case.hop_test();
        let (mut answer, mut found) = verdict_of(&test, ends, &scenario.search, proof_budget_cells, meter)?;
        let (mut success_budget, mut objective) = (None, None);
        let chooses = scenario.budget.estimated_success_min.is_some() || scenario.plans_by_objective();
        if chooses && answer.hops.is_some() {
            let searched = journey::search(&test, ends, &case, &Unreported(meter))?;
            (found, success_budget, objective) = (searched.found, searched.success, searched.objective);
            let met = success_budget.is_none_or(|budget| budget.met) && objective.as_ref().is_none_or(ObjectiveRecord::is_met);
            answer.hops = found.hops().filter(|_| met);
            if answer.hops.is_none() {
                answer.verdict = ProofVerdict::Open;
            }
        }
        let has_path = answer.hops.is_some();
        let effort = scenario.search.effort;
        let path = if has_path { self.exact_path(&case, &found) } else { None };
        Ok(TradeRow {
            values: self.named(values),
            verdict: Some(answer.verdict),
            hops: answer.hops,
            lower_bound: answer.lower_bound,
            above_escape,
            // Some hop is at least as long as the mean of them.
            far_on_body: answer.hops.zip(scenario.body.radius_m()).is_some_and(|(hops, radius_m)| {
                #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
                let hops = hops.max(1) as f64;
                distance_m / hops > 0.01 * radius_m
            }),
            totals: path.as_ref().map(|path| TotalsRecord::from(&path.totals)),
            margins: path.as_ref().and_then(MarginsRecord::of),
            effort: match &found.outcome {
                Outcome::Path { cost, .. } if has_path => Some(EffortRecord::new(effort, cost.effort())),
                Outcome::Path { .. } | Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
            },
            success_budget,
            by_objective: objective,
            error: None,
        })
    }

    /// The path found, with exact commands; `None` without one, or if it has too many hops to list.
    fn exact_path(&self, case: &Case, found: &Answer) -> Option<HopPath> {
        let Outcome::Path { legs, .. } = &found.outcome else { return None };
        let is_exact = case.scenario.hopper.with_any_command().limits() == case.scenario.hopper.limits();
        let exact = || Case::over(self.survey, case.scenario.clone(), self.base, Commands::Exact).ok();
        let exact = if is_exact { None } else { Some(exact()?) };
        let case = exact.as_ref().unwrap_or(case);
        case.planning().path(&case.hop_test(), legs, &case.scenario.search).ok()
    }

    /// Whether any answer depends on a key: neighbouring cells along it are compared until two differ.
    fn check_effect(&self, axis: usize, meter: &Meter<'_>) -> Result<(), TradeError> {
        let own = &self.swept[axis];
        let across: &[f64] = self.swept.iter().enumerate().find(|(i, _)| *i != axis).map_or(&[0.0], |(_, v)| v.values());
        for &other in across {
            let mut before = None;
            for &value in own.values() {
                let values = match (self.swept.len(), axis) {
                    (1, _) => vec![value],
                    (_, 0) => vec![value, other],
                    _ => vec![other, value],
                };
                meter.report(Detail::None)?;
                // What is refused for some values depends on them, or no cell has an answer.
                let Ok(Case { scenario, prepared, .. }) = self.case(&values) else { return Ok(()) };
                if before.as_ref().is_some_and(|(s, p)| !ask_the_same((s, p), (&scenario, &prepared))) {
                    return Ok(());
                }
                before = Some((scenario, prepared));
            }
        }
        let (from, to) = (own.values()[0], own.values()[own.values().len() - 1]);
        Err(TradeError::NoEffect { path: own.path(), from, to })
    }
}

impl Trade<'_> {
    /// The keys as typed with the values of the first cell, for reading the terrain. Problems with them begin with `given_by`, the
    /// caller's name for the source of the swept keys, and the key.
    ///
    /// # Errors
    /// As [`Trade::new`].
    pub fn first_cell(entries: &Entries, swept: &[SweptKey], given_by: &str) -> Result<Entries, TradeError> {
        checked(swept)?;
        let first: Vec<f64> = swept.iter().filter_map(|v| v.values().first().copied()).collect();
        Ok(varied(entries, swept, &first, given_by))
    }

    /// The same for the first cell and, in case it is refused, for some others, up to the last.
    ///
    /// # Errors
    /// As [`Trade::new`].
    pub fn some_cells(entries: &Entries, swept: &[SweptKey], given_by: &str) -> Result<Vec<Entries>, TradeError> {
        /// How many.
        const SOME: usize = 16;
        checked(swept)?;
        let last = cells(swept).saturating_sub(1);
        let mut picks: Vec<usize> = (0..SOME).map(|i| i * last / (SOME - 1)).collect();
        picks.dedup();
        Ok(picks.into_iter().map(|cell| varied(entries, swept, &at(swept, cell), given_by)).collect())
    }
}

/// The values of a cell, from its number.
fn at(swept: &[SweptKey], cell: usize) -> Vec<f64> {
    match swept {
        [one] => vec![one.values()[cell]],
        [first, second] => {
            let across = second.values().len();
            vec![first.values()[cell / across], second.values()[cell % across]]
        }
        _ => Vec::new(),
    }
}

/// Checks for one key or two different ones, and not too many cells.
fn checked(swept: &[SweptKey]) -> Result<(), TradeError> {
    match swept {
        [first, second] if first.key() == second.key() => return Err(TradeError::Twice { path: first.path() }),
        [_] | [_, _] => {}
        _ => return Err(TradeError::Count { found: swept.len() }),
    }
    match cells(swept) {
        cells if cells > Trade::MOST_CELLS => Err(TradeError::Cells { cells }),
        _ => Ok(()),
    }
}

fn cells(swept: &[SweptKey]) -> usize {
    swept.iter().map(|v| v.values().len()).product()
}

/// The keys with these values set.
fn varied(entries: &Entries, swept: &[SweptKey], values: &[f64], given_by: &str) -> Entries {
    let mut entries = entries.clone();
    for (v, &value) in swept.iter().zip(values) {
        let (table, name) = v.key();
        entries.set_by_option(&format!("{given_by} {}", v.path()), table, name, v.typed(value));
    }
    entries
}

/// Problems in one sentence.
fn sentences(problems: &[ScenarioProblem]) -> String {
    problems.iter().map(|problem| format!("{}; {}", problem.message, problem.help)).collect::<Vec<_>>().join("; ")
}
