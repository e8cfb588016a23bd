//! The search for a journey, and the proof where one is requested: what check, plan, compare and require share.

use super::{CaseError, Prepared};
use crate::{
    chain::Station,
    graph::{
        self, Outcome, ReliabilityUse, ReliablePath, SearchError,
        proof::{Bounds, BoundsOptions, bounds},
        search_most_reliable,
    },
    hop::HopTest,
    path::{HopPath, PathError, TooManyHops},
    progress::Progress,
    report::CheckAnswer,
    scenario::Scenario,
};

/// Bounds on the fewest hops are proved, for every choice of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Proof {
    /// The greatest number of cells that the chain is divided into.
    pub budget_cells: usize,
}

/// Why a journey is not searched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JourneyError {
    /// The case.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The search or the proof.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A proof for a scenario that selects the most reliable path.
    #[error(
        "a proof bounds the fewest hops, but search.risk is \"{}\", which selects the most reliable path: leave the proof out, or set \
         search.risk to \"ignored\"",
        risk.name()
    )]
    ProofWithRisk {
        /// How path choice weighs reliability.
        risk: ReliabilityUse,
    },
}

/// The result of a search, with bounds if a proof was requested.
#[derive(Clone, Debug)]
pub(super) struct Searched {
    pub(super) found: graph::Answer,
    /// The Pareto front of hops against success probability, where the scenario weighs risk.
    pub(super) reliable_paths: Vec<ReliablePath>,
    /// The bounds, and the budget of cells.
    pub(super) proof: Option<(Bounds, usize)>,
}

impl Searched {
    /// Searches, and proves if requested.
    pub(super) fn new(
        test: &HopTest,
        ends: (Station, Station),
        scenario: &Scenario,
        proof: Option<Proof>,
        progress: &dyn Progress,
    ) -> Result<Self, JourneyError> {
        let Some(Proof { budget_cells }) = proof else {
            let (found, reliable_paths) = search(test, ends, scenario, progress)?;
            return Ok(Self { found, reliable_paths, proof: None });
        };
        if scenario.reliability().is_some() {
            return Err(JourneyError::ProofWithRisk { risk: scenario.risk });
        }
        let search = scenario.search.clone();
        let options = BoundsOptions { budget_cells, search, explain: true, ..BoundsOptions::default() };
        let bounds = bounds(test, ends.0, ends.1, &options, progress)?;
        Ok(Self { found: bounds.answer.clone(), reliable_paths: Vec::new(), proof: Some((bounds, budget_cells)) })
    }

    /// The same for many pairs: one search from each start; pair by pair for proofs and where the most reliable paths are wanted.
    pub(super) fn all(
        test: &HopTest,
        pairs: &[(Station, Station)],
        scenario: &Scenario,
        proof: Option<Proof>,
        progress: &dyn Progress,
    ) -> Result<Vec<Self>, JourneyError> {
        if proof.is_some() {
            return pairs.iter().map(|&ends| Self::new(test, ends, scenario, proof, progress)).collect();
        }
        let found: Vec<graph::Answer> = if scenario.reliability().is_some() {
            pairs.iter().map(|&ends| Ok(search(test, ends, scenario, progress)?.0)).collect::<Result<_, SearchError>>()?
        } else {
            graph::search_pairs(test, pairs, &scenario.search, progress)?
        };
        Ok(found.into_iter().map(|found| Self { found, reliable_paths: Vec::new(), proof: None }).collect())
    }

    /// The answer as plain data together with the path that it found, whose hops may be too many to list. An answer whose path no
    /// commands of the machine fly has no path.
    pub(super) fn answer_with_path(
        &self,
        test: &HopTest,
        (start, goal): (Station, Station),
        (prepared, options): (&Prepared, &graph::SearchOptions),
    ) -> (CheckAnswer, Result<Option<HopPath>, TooManyHops>) {
        let answer = CheckAnswer::new(test, start.point.x_m, goal.point.x_m, &self.found, options.effort);
        let answer = match &self.proof {
            None => answer,
            Some((bounds, budget)) => answer.with_bounds(bounds, *budget),
        };
        let Outcome::Path { legs, .. } = &self.found.outcome else { return (answer, Ok(None)) };
        match prepared.path(test, legs, options) {
            Ok(path) => (answer.with_path(Some(&path)), Ok(Some(path))),
            Err(PathError::TooManyHops(problem)) => (answer, Err(problem)),
            Err(PathError::NoCommand(problem)) => (answer.without_commands(&problem), Ok(None)),
        }
    }
}

/// Searches for one pair, for the most reliable path if the scenario requests it.
pub(super) fn search(
    test: &HopTest,
    (start, goal): (Station, Station),
    scenario: &Scenario,
    progress: &dyn Progress,
) -> Result<(graph::Answer, Vec<ReliablePath>), SearchError> {
    let options = &scenario.search;
    match scenario.reliability() {
        None => graph::search(test, start, goal, options, progress).map(|answer| (answer, Vec::new())),
        Some(reliability) => search_most_reliable(test, start, goal, options, &reliability, progress),
    }
}
