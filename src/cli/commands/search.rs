//! The search and the proof with their progress, shared by check, plan, run and require.

use chta::{
    chain::Station,
    graph::{
        self, Outcome, ReliablePath,
        proof::{Bounds, BoundsOptions, bounds},
        search_most_reliable,
    },
    hop::HopTest,
    path::{HopPath, PathError, TooManyHops},
    report::CheckAnswer,
    scenario::Scenario,
    study::Prepared,
};

use crate::cli::{Failure, args::ProveArgs, progress::Progress};

/// The result of a search, with bounds if a proof was requested.
#[derive(Debug)]
pub(super) struct Searched {
    pub(super) found: graph::Answer,
    /// The Pareto front of hops against success probability, where the scenario weighs risk.
    pub(super) reliable_paths: Vec<ReliablePath>,
    proof: Option<(Bounds, usize)>,
}

impl Searched {
    /// Searches, and proves if requested.
    pub(super) fn new(
        test: &HopTest,
        ends: (Station, Station),
        scenario: &Scenario,
        prove: Option<ProveArgs>,
        quiet: bool,
    ) -> Result<Self, Failure> {
        match prove.filter(|prove| prove.prove) {
            None => {
                let (found, reliable_paths) = search(test, ends, scenario, quiet)?;
                Ok(Self { found, reliable_paths, proof: None })
            }
            Some(_) if scenario.reliability().is_some() => Err(Failure::message(format!(
                "--prove bounds the fewest hops, but search.risk is \"{}\", which selects the most reliable path: omit --prove, or add \
                 --set search.risk=ignored",
                scenario.risk.name()
            ))),
            Some(ProveArgs { budget, .. }) => {
                let search = scenario.search.clone();
                let options = BoundsOptions { budget_cells: budget, search, explain: true, ..BoundsOptions::default() };
                let bounds = proved(test, ends, &options, quiet)?;
                Ok(Self { found: bounds.answer.clone(), reliable_paths: Vec::new(), proof: Some((bounds, budget)) })
            }
        }
    }

    /// The same for many pairs: one search from each start, or a proof for each pair.
    pub(super) fn all(
        test: &HopTest,
        pairs: &[(Station, Station)],
        scenario: &Scenario,
        prove: ProveArgs,
        quiet: bool,
    ) -> Result<Vec<Self>, Failure> {
        if prove.prove {
            return pairs.iter().map(|&ends| Self::new(test, ends, scenario, Some(prove), quiet)).collect();
        }
        let found = search_pairs(test, pairs, scenario, quiet)?;
        Ok(found.into_iter().map(|found| Self { found, reliable_paths: Vec::new(), proof: None }).collect())
    }

    /// The bounds, if a proof was requested.
    pub(super) fn bounds(&self) -> Option<&Bounds> {
        self.proof.as_ref().map(|(bounds, _)| bounds)
    }

    /// The answer as plain data.
    pub(super) fn answer(&self, test: &HopTest, (start, goal): (Station, Station), effort: graph::Effort) -> CheckAnswer {
        let answer = CheckAnswer::new(test, start.point.x_m, goal.point.x_m, &self.found, effort);
        match &self.proof {
            None => answer,
            Some((bounds, budget)) => answer.with_bounds(bounds, *budget),
        }
    }

    /// The answer as plain data together with the path that it found, whose hops may be too many to list. An answer whose path no
    /// commands of the machine fly has no path.
    pub(super) fn answer_with_path(
        &self,
        test: &HopTest,
        ends: (Station, Station),
        (prepared, options): (&Prepared, &graph::SearchOptions),
    ) -> (CheckAnswer, Result<Option<HopPath>, TooManyHops>) {
        let answer = self.answer(test, ends, options.effort);
        let Outcome::Path { legs, .. } = &self.found.outcome else { return (answer, Ok(None)) };
        match prepared.path(test, legs, options) {
            Ok(path) => (answer.with_path(Some(&path)), Ok(Some(path))),
            Err(PathError::TooManyHops(problem)) => (answer, Err(problem)),
            Err(PathError::NoCommand(problem)) => (answer.without_commands(&problem), Ok(None)),
        }
    }
}

/// Sets the number of threads; 0: one for each core.
pub(super) fn use_threads(threads: usize) -> Result<(), Failure> {
    if threads == 0 {
        // This is the default, and small searches never start the threads.
        return Ok(());
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::message(format!("the threads cannot be started ({error}): ask for fewer with --threads")))
}

/// Searches for one pair, for the most reliable path if the scenario requests it, and shows progress on the terminal.
pub(super) fn search(
    test: &HopTest,
    (start, goal): (Station, Station),
    scenario: &Scenario,
    quiet: bool,
) -> Result<(graph::Answer, Vec<ReliablePath>), Failure> {
    let options = &scenario.search;
    let progress = Progress::new(quiet);
    let found = match scenario.reliability() {
        None => graph::search(test, start, goal, options, &progress).map(|answer| (answer, Vec::new())),
        Some(reliability) => search_most_reliable(test, start, goal, options, &reliability, &progress),
    };
    found.map_err(|error| Failure::of(&error))
}

/// Searches for many pairs, once from each start; pair by pair where the most reliable paths are requested.
fn search_pairs(
    test: &HopTest,
    pairs: &[(Station, Station)],
    scenario: &Scenario,
    quiet: bool,
) -> Result<Vec<graph::Answer>, Failure> {
    if scenario.reliability().is_some() {
        return pairs.iter().map(|&ends| Ok(search(test, ends, scenario, quiet)?.0)).collect();
    }
    graph::search_pairs(test, pairs, &scenario.search, &Progress::new(quiet)).map_err(|error| Failure::of(&error))
}

/// Bounds the fewest hops, and shows the progress of the proof on the terminal.
pub(super) fn proved(
    test: &HopTest,
    (start, goal): (Station, Station),
    options: &BoundsOptions,
    quiet: bool,
) -> Result<Bounds, Failure> {
    bounds(test, start, goal, options, &Progress::new(quiet)).map_err(|error| Failure::of(&error))
}
