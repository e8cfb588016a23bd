//! Whether a path exists, for one pair of start and goal or for many.

use super::{
    Case, CaseError, Commands, JourneyEnd, JourneyError, Proof,
    free_route::{FoundRoute, along_transect},
    free_trials::route_with_success,
    journey::Searched,
};
#[cfg(feature = "plot")]
use crate::figure::{Caption, FigureError, Picture, ProofFigure, draw_proof};
use crate::{
    chain::{OffChain, Station, csv::StartGoal},
    graph::{SearchError, proof::Bounds},
    path::HopPath,
    progress::Progress,
    report::{CheckAnswer, PairsAnswer},
    scenario::Route,
};

/// Why there is no answer. That there is no path is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// The case, the search or the proof.
    #[error(transparent)]
    Journey(#[from] JourneyError),
    /// A pair with an end off the chain.
    #[error("pair {pair} ({}_x_m): {problem}", which.name())]
    OffChain {
        /// Which pair, from 1.
        pair: usize,
        /// Start or goal.
        which: JourneyEnd,
        /// The position, and the extent of the chain.
        problem: OffChain,
    },
}

impl From<CaseError> for CheckError {
    fn from(error: CaseError) -> Self {
        Self::Journey(error.into())
    }
}

impl From<SearchError> for CheckError {
    fn from(error: SearchError) -> Self {
        Self::Journey(error.into())
    }
}

/// The answers for all pairs, with everything that their views need.
#[derive(Clone, Debug)]
pub struct Checked {
    /// What was asked.
    pub case: Case,
    /// One for each pair.
    pub pairs: Vec<CheckedPair>,
    /// The warnings about the paths.
    pub warnings: Vec<String>,
}

/// The answer for one pair.
#[derive(Clone, Debug)]
pub struct CheckedPair {
    /// Start and goal.
    pub ends: (Station, Station),
    /// The answer as plain data.
    pub answer: CheckAnswer,
    /// The path; `None` if no path was found, or if it has too many hops to list.
    pub path: Option<HopPath>,
    /// The bounds on the fewest hops, if they were wanted.
    pub bounds: Option<Bounds>,
}

/// Checks whether a path leads from the case's start to its goal.
///
/// # Errors
/// [`CheckError::Journey`].
pub fn check(case: &Case, proof: Option<Proof>, progress: &dyn Progress) -> Result<Checked, CheckError> {
    if case.scenario.route == Route::Free {
        return check_free(case, proof, progress);
    }
    checked(case, &[case.ends()?], proof, progress)
}

/// The same in any direction over a DEM.
fn check_free(case: &Case, proof: Option<Proof>, progress: &dyn Progress) -> Result<Checked, CheckError> {
    if proof.is_some() {
        along_transect(&case.scenario, "bounds that hold at any resolution are proved")?;
    }
    let (FoundRoute { case, ends, check, path, warnings, .. }, _) = route_with_success(case, progress)?;
    Ok(Checked { case, pairs: vec![CheckedPair { ends, answer: check, path, bounds: None }], warnings })
}

/// Checks many pairs of start and goal: positions along the chain, over a free route along the straight slice.
///
/// # Errors
/// [`CheckError`].
pub fn check_pairs(case: &Case, pairs: &[StartGoal], proof: Option<Proof>, progress: &dyn Progress) -> Result<Checked, CheckError> {
    let ends = stations(case, pairs)?;
    if case.scenario.route == Route::Transect {
        return checked(case, &ends, proof, progress);
    }
    let mut all = Checked { case: case.clone(), pairs: Vec::with_capacity(pairs.len()), warnings: Vec::new() };
    for ends in ends {
        let Checked { pairs, warnings, .. } = check_free(&case.between(ends), proof, progress)?;
        all.pairs.extend(pairs);
        for warning in warnings {
            if !all.warnings.contains(&warning) {
                all.warnings.push(warning);
            }
        }
    }
    Ok(all)
}

/// The stations of all pairs.
///
/// # Errors
/// [`CheckError::OffChain`] for the first that lies off the chain.
fn stations(case: &Case, pairs: &[StartGoal]) -> Result<Vec<(Station, Station)>, CheckError> {
    let station = |pair, which, x_m| {
        case.prepared.chain.geometry().station(x_m).map_err(|problem| CheckError::OffChain { pair, which, problem })
    };
    let ends = |(i, pair): (usize, &StartGoal)| {
        Ok((station(i + 1, JourneyEnd::Start, pair.start_x_m)?, station(i + 1, JourneyEnd::Goal, pair.goal_x_m)?))
    };
    pairs.iter().enumerate().map(ends).collect()
}

fn checked(
    case: &Case,
    pairs: &[(Station, Station)],
    proof: Option<Proof>,
    progress: &dyn Progress,
) -> Result<Checked, CheckError> {
    let case = case.with_commands(Commands::OfTheMachine)?;
    let test = case.hop_test();
    let searched = Searched::all(&test, pairs, &case, proof, progress)?;
    let mut checked = Checked { case, pairs: Vec::with_capacity(pairs.len()), warnings: Vec::new() };
    for (&ends, searched) in pairs.iter().zip(searched) {
        let (answer, path) = searched.answer_with_path(&test, ends, &checked.case);
        // A path of too many hops to list is one all the same.
        let path = path.unwrap_or(None);
        let of_path = path.iter().flat_map(|path| checked.case.scenario.path_warnings(path));
        for warning in of_path.chain(searched.warnings) {
            if !checked.warnings.contains(&warning) {
                checked.warnings.push(warning);
            }
        }
        checked.pairs.push(CheckedPair { ends, answer, path, bounds: searched.proof.map(|(bounds, _)| bounds) });
    }
    Ok(checked)
}

impl Checked {
    /// Whether every pair has a path that the machine can fly.
    pub fn is_traversable(&self) -> bool {
        self.pairs.iter().all(|pair| pair.answer.is_traversable())
    }

    /// The answers as plain data.
    pub fn answers(&self) -> impl Iterator<Item = &CheckAnswer> {
        self.pairs.iter().map(|pair| &pair.answer)
    }

    /// The answers for many pairs as plain data.
    pub fn pairs_answer(&self) -> PairsAnswer {
        PairsAnswer { pairs: self.answers().cloned().collect() }
    }

    /// The picture of what is proved along the chain, for the first pair; `None` without a proof.
    ///
    /// # Errors
    /// [`FigureError`].
    #[cfg(feature = "plot")]
    pub fn picture(&self) -> Option<Result<Picture, FigureError>> {
        use super::captions::{SpeedLimit, title};

        let CheckedPair { ends, path, bounds, .. } = self.pairs.first()?;
        let (scenario, bounds) = (&self.case.scenario, bounds.as_ref()?);
        let mut line = vec![format!("from x = {:.3} m to x = {:.3} m", ends.0.point.x_m, ends.1.point.x_m)];
        line.extend(scenario.body.name.clone());
        line.extend(SpeedLimit::stated(&scenario.hopper).map(|limit| limit.to_string()));
        let beside = path.as_ref().is_some_and(|path| path.hops.iter().any(crate::path::Hop::is_beside_line));
        line.extend(beside.then(|| "path beside the line, drawn projected on it".to_owned()));
        let caption = Caption::new(title("What is proved", scenario), line.join(", "));
        Some(draw_proof(&ProofFigure::of(caption, self.case.prepared.chain.geometry(), *ends, bounds, path.as_ref())))
    }
}
