//! The search for a mission over the targets of a case.

use super::super::{
    Case, CaseError, FreeRouteError, JourneyError,
    dem_ground::dem_ground,
    free_route::{FreeSearch, lattice},
};
use crate::{
    planner::{Amount, RouteError, RouteQuestion, SurfaceNodes, Tour, TourQuestion, tour},
    progress::Progress,
    quantity::MapPoint,
    scenario::{MissionKeys, Scenario},
    terrain::NoProjection,
};

/// The nodes and the stops of a case.
pub(super) struct TargetsSearch {
    pub(super) free: FreeSearch,
    pub(super) keys: MissionKeys,
    /// The start, then the targets as listed.
    pub(super) stops: Vec<MapPoint>,
}

impl TargetsSearch {
    /// # Errors
    /// [`JourneyError`], also for a scenario without targets, and for two stops at one place.
    pub(super) fn of(case: &Case) -> Result<Self, JourneyError> {
        let keys = case.scenario.mission.clone().ok_or(CaseError::NoTargets)?;
        let targets = targets_on_map(case, &keys)?;
        // No slice between any two of them: in which order targets are listed changes no node.
        let mut free = FreeSearch::over(case, &|case, ground, [start, _]| {
            let places = std::iter::once(start).chain(targets.iter().copied());
            Ok(SurfaceNodes::new(ground, lattice(case, ground)?, places).map_err(RouteError::from)?)
        })?;
        free.exempt.clone_from(&targets);
        let stops: Vec<MapPoint> = std::iter::once(free.goal.start).chain(targets.iter().copied()).collect();
        let name = |stop: usize| if stop == 0 { "the start".to_owned() } else { format!("target {stop}") };
        let same = (1..stops.len()).find_map(|second| Some((stops[..second].iter().position(|at| *at == stops[second])?, second)));
        if let Some((first, second)) = same {
            return Err(FreeRouteError::SameStop { first: name(first), second: name(second) }.into());
        }
        Ok(Self { free, keys, stops })
    }

    pub(super) const fn scenario(&self) -> &Scenario {
        &self.free.case.scenario
    }

    /// The best mission by the objective, within the budgets.
    pub(super) fn best(&self, progress: &dyn Progress) -> Result<Tour, JourneyError> {
        let (free, scenario) = (&self.free, self.scenario());
        let by_risk = free.objective.amounts().contains(&Amount::Risk);
        let whole = dem_ground(&free.case).map_err(Box::new)?;
        let errors = scenario.uncertainty.as_ref().filter(|_| by_risk).map(|keys| &keys.errors);
        let route = RouteQuestion {
            objective: &free.objective,
            budgets: &free.budgets,
            commands: scenario.commands,
            errors: errors.zip(whole.as_ref()),
            cap: free.cap,
        };
        let question = TourQuestion {
            route,
            effort: free.goal.effort,
            takeoff: free.goal.takeoff,
            order: self.keys.order,
            returns: self.keys.return_to_start,
        };
        Ok(tour(&free.ground, &free.nodes, &self.stops, &question, progress)?)
    }
}

/// The targets on the map.
fn targets_on_map(case: &Case, keys: &MissionKeys) -> Result<Vec<MapPoint>, JourneyError> {
    let ground = dem_ground(case).map_err(Box::new)?.ok_or(FreeRouteError::NoDem)?;
    let projection = case.prepared.projection.as_ref().ok_or(&NoProjection::Local);
    let on_map = |place: &crate::terrain::MapPlace| {
        let at = place.on_map("a target", projection, ground.terrain().dem().bounds());
        at.map_err(|error| FreeRouteError::Target(Box::new(error)))
    };
    Ok(keys.targets.iter().map(on_map).collect::<Result<_, _>>()?)
}
