//! The path of a case, along its transect or in any direction: what questions that vary a key ask of each value.

use super::{
    Case, JourneyError,
    free_trials::route_with_success,
    journey::{self, Searched},
};
use crate::{
    graph::Outcome,
    path::{HopPath, generate},
    progress::Progress,
    report::{CheckAnswer, ObjectiveRecord, SuccessBudgetRecord},
    scenario::Route,
};

/// The path of a case, and what its budgets say of it.
#[derive(Clone, Debug)]
pub(super) struct JourneyPath {
    searched: Searched,
    /// Of a free route: its answer and its path.
    free: Option<(Box<CheckAnswer>, Option<HopPath>)>,
}

impl JourneyPath {
    /// Searches.
    ///
    /// # Errors
    /// [`JourneyError`].
    pub(super) fn of(case: &Case, progress: &dyn Progress) -> Result<Self, JourneyError> {
        if case.scenario.route == Route::Free {
            let (route, searched) = route_with_success(case, progress)?;
            let searched = Searched { objective: route.check.objective.clone(), ..searched };
            return Ok(Self { searched, free: Some((Box::new(route.check), route.path)) });
        }
        let searched = journey::search(&case.hop_test(), case.ends()?, case, progress)?;
        Ok(Self { searched, free: None })
    }

    /// The hops; `None` without a path.
    pub(super) fn hops(&self) -> Option<u64> {
        self.searched.found.hops()
    }

    /// What the budget of success says of it.
    pub(super) const fn success(&self) -> Option<SuccessBudgetRecord> {
        self.searched.success
    }

    /// What its objective and its budgets of totals say of it.
    pub(super) const fn objective(&self) -> Option<&ObjectiveRecord> {
        self.searched.objective.as_ref()
    }

    /// Of a free route: its answer.
    pub(super) fn free_check(&self) -> Option<&CheckAnswer> {
        self.free.as_ref().map(|(check, _)| check.as_ref())
    }

    /// The path itself; `None` without one, or if it has too many hops to list.
    pub(super) fn path(&self, case: &Case) -> Option<HopPath> {
        if let Some((_, path)) = &self.free {
            return path.clone();
        }
        let Outcome::Path { legs, .. } = &self.searched.found.outcome else { return None };
        let options = &case.scenario.search;
        generate(&case.hop_test(), legs, options.takeoff, options.split).ok()
    }
}
