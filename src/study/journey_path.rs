//! The path of a case, along its transect or in any direction: what questions that vary a key ask of each value.

use super::{
    Case, JourneyError,
    free_trials::route_with_success,
    journey::{self, Searched},
    targets::{TargetsPlanned, targets_plan},
    travel::{TravelOptions, TravelPlanned, travel_plan},
};
use crate::{
    graph::{Outcome, proof::ProofVerdict},
    path::{HopPath, generate},
    progress::Progress,
    report::{CheckAnswer, ObjectiveRecord, SuccessBudgetRecord, TotalsRecord},
    scenario::Route,
};

/// The path of a case, and what its budgets say of it.
#[derive(Clone, Debug)]
pub(super) enum JourneyPath {
    /// Along a transect.
    Transect(Box<Searched>),
    /// A free route: with its answer and its path.
    Free(Box<Searched>, Box<CheckAnswer>, Option<Box<HopPath>>),
    /// A mission that drives.
    Travel(Box<TravelPlanned>),
    /// A mission over targets.
    Targets(Box<TargetsPlanned>),
}

impl JourneyPath {
    /// Searches.
    ///
    /// # Errors
    /// [`JourneyError`].
    pub(super) fn of(case: &Case, progress: &dyn Progress) -> Result<Self, JourneyError> {
        if case.scenario.drives().is_some() {
            return Ok(Self::Travel(Box::new(travel_plan(case, TravelOptions::default(), progress)?)));
        }
        if case.scenario.mission.is_some() {
            return Ok(Self::Targets(Box::new(targets_plan(case, progress)?)));
        }
        if case.scenario.route == Route::Free {
            let (route, searched) = route_with_success(case, progress)?;
            let searched = Searched { objective: route.check.objective.clone(), ..searched };
            return Ok(Self::Free(Box::new(searched), Box::new(route.check), route.path.map(Box::new)));
        }
        let searched = journey::search(&case.hop_test(), case.ends()?, case, progress)?;
        Ok(Self::Transect(Box::new(searched)))
    }

    const fn searched(&self) -> Option<&Searched> {
        match self {
            Self::Transect(searched) | Self::Free(searched, ..) => Some(searched),
            Self::Travel(_) | Self::Targets(_) => None,
        }
    }

    /// The hops; `None` without a path, and of a mission that does not visit all targets.
    pub(super) fn hops(&self) -> Option<u64> {
        match self {
            Self::Travel(planned) => planned.answer.hops,
            Self::Targets(planned) => planned
                .answer
                .hops
                .filter(|_| planned.tour.left_out.is_empty() && planned.answer.outages.iter().all(|outage| outage.met)),
            Self::Free(searched, check, _) => searched.found.hops().filter(|_| check.keeps_outages()),
            Self::Transect(searched) => searched.found.hops(),
        }
    }

    /// What the budget of success says of it.
    pub(super) fn success(&self) -> Option<SuccessBudgetRecord> {
        self.searched()?.success
    }

    /// What its objective and its budgets of totals say of it.
    pub(super) fn objective(&self) -> Option<&ObjectiveRecord> {
        match self {
            Self::Travel(planned) => Some(&planned.answer.objective),
            Self::Targets(planned) => Some(&planned.answer.objective),
            Self::Transect(searched) | Self::Free(searched, ..) => searched.objective.as_ref(),
        }
    }

    /// The verdict, and what no path takes fewer hops than, where it is no transect.
    pub(super) fn verdict(&self) -> (ProofVerdict, Option<u64>) {
        match self {
            Self::Free(_, check, _) => (check.verdict, check.hops_lower_bound),
            Self::Travel(planned) => (planned.answer.verdict, Some(planned.answer.hops_lower_bound)),
            Self::Targets(planned) => (planned.answer.verdict, planned.answer.hops_lower_bound),
            Self::Transect(_) => (ProofVerdict::Open, None),
        }
    }

    /// What the path takes in all; `None` without one, or if it has too many hops to list.
    pub(super) fn totals(&self, case: &Case) -> Option<TotalsRecord> {
        match self {
            Self::Travel(planned) => planned.totals_record(),
            Self::Targets(planned) => planned.totals_record(),
            Self::Transect(_) | Self::Free(..) => self.path(case).map(|path| TotalsRecord::from(&path.totals)),
        }
    }

    /// The path itself; `None` without one, of a mission that drives, or if it has too many hops to list.
    pub(super) fn path(&self, case: &Case) -> Option<HopPath> {
        let searched = match self {
            Self::Travel(_) => return None,
            Self::Targets(planned) => return planned.path().cloned(),
            Self::Free(_, _, path) => return path.as_deref().cloned(),
            Self::Transect(searched) => searched,
        };
        let Outcome::Path { legs, .. } = &searched.found.outcome else { return None };
        let options = &case.scenario.search;
        generate(&case.hop_test(), legs, options.takeoff, options.split).ok()
    }
}
