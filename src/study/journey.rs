//! The search for a journey, and the proof where one is requested: what check, plan, compare and require share.

use super::{
    Case, CaseError, FreeRouteError, SimulateError,
    dem_ground::dem_ground,
    front::{Estimated, FlownJourney},
    objective::{ByObjective, by_objective},
    to_go::ToGo,
};
use crate::{
    chain::Station,
    graph::{
        self, Outcome, ReliabilityUse, ReliablePath, SearchError,
        proof::{Bounds, BoundsOptions, bounds},
        search_most_reliable,
    },
    hop::HopTest,
    path::{Hop, HopPath, PathError, TooManyHops},
    progress::Progress,
    report::{CheckAnswer, DeratingRecord, HopRecord, ObjectiveRecord, SigmaMarginsRecord, SuccessBudgetRecord, SuccessEstimate},
    scenario::Scenario,
    uncertainty::HopScatter,
    world::FrictionCone,
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
    /// A route over a DEM in any direction.
    #[error(transparent)]
    Free(#[from] FreeRouteError),
    /// The trials that estimate the success of paths.
    #[error(transparent)]
    Trials(#[from] Box<SimulateError>),
}

/// How reliably a path is flown.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    pub(super) success: SuccessEstimate,
    /// Of each hop.
    pub(super) margins: Vec<SigmaMarginsRecord>,
    /// The success of each hop by itself.
    pub(super) of_hops: Vec<f64>,
    /// What trials of the path replan by, where it was flown for this estimate.
    pub(super) to_go: Option<ToGo>,
}

impl Estimate {
    /// Adds what is of single hops to their rows.
    pub(super) fn add_to(&self, rows: &mut [HopRecord]) {
        for (row, (margins, success)) in rows.iter_mut().zip(self.margins.iter().zip(&self.of_hops)) {
            (row.margins_sigma, row.success_estimated) = (Some(*margins), Some(*success));
        }
    }
}

/// The result of a search, with bounds if a proof was requested.
#[derive(Clone, Debug)]
pub(super) struct Searched {
    pub(super) found: graph::Answer,
    /// The Pareto front of hops against success probability, where the scenario weighs risk.
    pub(super) reliable_paths: Vec<ReliablePath>,
    /// What the budget of success says of the path, where the scenario has one.
    pub(super) success: Option<SuccessBudgetRecord>,
    /// What the path was planned for and whether it keeps its budgets, where the scenario plans by objective.
    pub(super) objective: Option<ObjectiveRecord>,
    /// What is to be known about a plan by objective.
    pub(super) warnings: Vec<String>,
    /// The share of the fixed trials of the path that arrive, where the choice of the path found it and no front has it.
    pub(super) flown: Option<f64>,
    /// What trials of the path replan by, where the choice of the path found it.
    pub(super) to_go: Option<ToGo>,
    /// The bounds, and the budget of cells.
    pub(super) proof: Option<(Bounds, usize)>,
}

impl Searched {
    /// Searches, and proves if requested.
    pub(super) fn new(
        test: &HopTest,
        ends: (Station, Station),
        case: &Case,
        proof: Option<Proof>,
        progress: &dyn Progress,
    ) -> Result<Self, JourneyError> {
        let Some(Proof { budget_cells }) = proof else {
            return search(test, ends, case, progress);
        };
        let options = case.scenario.search.clone();
        let options = BoundsOptions { budget_cells, search: options, explain: true, ..BoundsOptions::default() };
        let bounds = bounds(test, ends.0, ends.1, &options, progress)?;
        // The bounds are on the fewest hops; the most reliable path, and the best by an objective, may take more.
        let weighs_more = weighs_reliability(&case.scenario) || case.scenario.plans_by_objective();
        let searched = if weighs_more && bounds.answer.hops().is_some() {
            search(test, ends, case, progress)?
        } else {
            Self::of(bounds.answer.clone())
        };
        Ok(Self { proof: Some((bounds, budget_cells)), ..searched })
    }

    /// The same for many pairs: one search from each start; pair by pair for proofs and where the most reliable paths are wanted.
    pub(super) fn all(
        test: &HopTest,
        pairs: &[(Station, Station)],
        case: &Case,
        proof: Option<Proof>,
        progress: &dyn Progress,
    ) -> Result<Vec<Self>, JourneyError> {
        if proof.is_some() {
            return pairs.iter().map(|&ends| Self::new(test, ends, case, proof, progress)).collect();
        }
        if weighs_reliability(&case.scenario) || case.scenario.plans_by_objective() {
            return pairs.iter().map(|&ends| search(test, ends, case, progress)).collect();
        }
        let found = graph::search_pairs(test, pairs, &case.scenario.search, progress)?;
        Ok(found.into_iter().map(Self::of).collect())
    }

    /// The answer of a search that does not weigh reliability.
    pub(super) const fn of(found: graph::Answer) -> Self {
        Self {
            found,
            reliable_paths: Vec::new(),
            success: None,
            objective: None,
            warnings: Vec::new(),
            flown: None,
            to_go: None,
            proof: None,
        }
    }

    /// How reliably the path of the answer is flown, under the policy of the scenario, and how its hops scatter; `None` without errors.
    ///
    /// A path of a front was estimated when it was chosen; another one is flown here.
    pub(super) fn success_estimate(
        &self,
        test: &HopTest,
        ends: (Station, Station),
        case: &Case,
        path: &HopPath,
        progress: &dyn Progress,
    ) -> Result<Option<Estimate>, JourneyError> {
        let scenario = &case.scenario;
        let Some(keys) = scenario.uncertainty.as_ref().filter(|keys| !keys.errors.is_none()) else { return Ok(None) };
        let hops = self.found.hops();
        let of_front = self.reliable_paths.iter().find(|path| Some(path.cost.hops()) == hops).and_then(|path| path.success);
        let known = of_front.or(self.flown).or_else(|| self.success.filter(|success| success.hops == hops)?.success_estimated);
        let ground = dem_ground(case).map_err(Box::new)?;
        let journey = FlownJourney { scenario, test, whole: case.whole_test(), ends, ground: ground.as_ref() };
        let (success_estimated, to_go) = if let Some(share) = known {
            (share, None)
        } else {
            let flown = journey.success_of(&self.found, path, &keys.options(), progress).map_err(Box::new)?;
            (flown.success, flown.to_go)
        };
        let success = SuccessEstimate { success_estimated, success_policy: keys.policy };
        let simulation = journey.simulation(path, None).map_err(Box::new)?;
        let scatters = simulation.hop_scatters();
        let friction = scenario.surface.constant_friction().map(FrictionCone::coefficient);
        // The half-angle of the cone is atan(mu).
        let friction_rad = friction.map_or(0.0, |mu| keys.errors.friction_sigma / (1.0 + mu * mu));
        let of_hop =
            |(hop, scatter): (&Hop, &HopScatter)| SigmaMarginsRecord::new(&hop.margins, scatter, friction_rad.to_degrees());
        Ok(Some(Estimate {
            success,
            margins: path.hops.iter().zip(&scatters).map(of_hop).collect(),
            of_hops: simulation.hop_successes(keys.policy),
            to_go,
        }))
    }

    /// The answer as plain data together with the path that it found, whose hops may be too many to list. An answer whose path no
    /// commands of the machine fly has no path.
    pub(super) fn answer_with_path(
        &self,
        test: &HopTest,
        (start, goal): (Station, Station),
        case: &Case,
    ) -> (CheckAnswer, Result<Option<HopPath>, TooManyHops>) {
        let (prepared, options) = (case.planning(), &case.scenario.search);
        let answer = CheckAnswer::new(test, start.point.x_m, goal.point.x_m, &self.found, options.effort);
        let answer = match &self.proof {
            None => answer,
            Some((bounds, budget)) => answer.with_bounds(bounds, *budget),
        };
        let answer = answer
            .with_success_budget(self.success)
            .with_objective(self.objective.clone())
            .with_derating(DeratingRecord::of(&case.scenario.derating));
        let Outcome::Path { legs, .. } = &self.found.outcome else { return (answer, Ok(None)) };
        match prepared.path(test, legs, options) {
            Ok(path) => (answer.with_path(Some(&path)), Ok(Some(path))),
            Err(PathError::TooManyHops(problem)) => (answer, Err(problem)),
            Err(PathError::NoCommand(problem)) => (answer.without_commands(&problem), Ok(None)),
        }
    }
}

/// Whether path choice weighs reliability.
fn weighs_reliability(scenario: &Scenario) -> bool {
    scenario.risk != ReliabilityUse::Ignored
}

/// Searches for one pair: by the objective of the scenario, for the most reliable path if it requests that, else for the fewest hops.
pub(super) fn search(
    test: &HopTest,
    ends: (Station, Station),
    case: &Case,
    progress: &dyn Progress,
) -> Result<Searched, JourneyError> {
    let scenario = &case.scenario;
    let options = &scenario.search;
    if let Some(ByObjective { found, record, warnings }) = by_objective(test, ends, case, progress)? {
        return Ok(Searched { objective: Some(record), warnings, ..Searched::of(found) });
    }
    let flown = weighs_reliability(scenario) && scenario.uncertainty.is_some();
    let ground = if flown { dem_ground(case).map_err(Box::new)? } else { None };
    let journey = FlownJourney { scenario, test, whole: case.whole_test(), ends, ground: ground.as_ref() };
    let reliability = scenario.reliability(ground.as_ref());
    let Some(reliability) = reliability.map(|reliability| reliability.flown_under(journey.whole.as_ref())) else {
        return Ok(Searched::of(graph::search(test, ends.0, ends.1, options, progress)?));
    };
    let (mut found, mut front) = search_most_reliable(test, ends.0, ends.1, options, &reliability, progress)?;
    let Estimated { budget, to_go } = journey.estimate(&mut found, &mut front, progress).map_err(Box::new)?;
    Ok(Searched { success: budget, to_go, reliable_paths: front, ..Searched::of(found) })
}
