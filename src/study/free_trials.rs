//! What the errors of a scenario say of a free route: the command of each of its hops, and how reliably it is flown.

use super::{
    Case, JourneyError,
    dem_ground::dem_ground,
    free_route::{FoundRoute, found_route},
    front::FlownJourney,
    journey::Searched,
    objective::reliability,
};
use crate::{
    ballistics::Arc,
    graph::{Cost, Edge, Leg, with_reliable_commands},
    hop::HopTest,
    progress::Progress,
    report::SuccessBudgetRecord,
};

/// The legs of a free route with the most reliable command of each hop, where the scenario leaves the commands to that, and the cost of the
/// route with them. Commands that the search chose stay.
///
/// # Errors
/// [`JourneyError`].
pub(super) fn commanded(case: &Case, test: &HopTest, (legs, cost): (Vec<Leg>, Cost)) -> Result<(Vec<Leg>, Cost), JourneyError> {
    let Some(reliability) = reliability(case, false)?.filter(|_| legs.iter().all(|leg| leg.loft.is_none())) else {
        return Ok((legs, cost));
    };
    let search = &case.scenario.search;
    let legs = with_reliable_commands(test, &legs, search, &reliability)?;
    let of_leg = |leg: &Leg| {
        let (sight, Edge::Hop(lofts)) = (test.line_of_sight(&leg.takeoff, &leg.landing)?, leg.edge) else { return None };
        let loft = leg.loft.unwrap_or_else(|| test.loft(search.takeoff, sight, lofts));
        Some(search.effort.cost(&Arc::new(sight, loft, test.gravity_m_s2()), 1))
    };
    let cost = legs.iter().filter_map(of_leg).fold(Cost::default(), |total, hop| total + hop);
    Ok((legs, cost))
}

/// The free route of a case; where the scenario has a budget of success, with what trials of the route say of it, and what they replan by.
///
/// The route is searched by hops and effort, and then estimated: where it has too little success, routes over other nodes may have enough.
///
/// # Errors
/// [`JourneyError`].
pub(super) fn route_with_success(case: &Case, progress: &dyn Progress) -> Result<(FoundRoute, Searched), JourneyError> {
    let mut route = found_route(case, progress)?;
    let mut searched = Searched::of(route.found.clone());
    let scenario = &route.case.scenario;
    let keys = scenario.uncertainty.as_ref();
    if let (Some(least), Some(path), Some(keys)) = (scenario.budget.estimated_success_min, &route.path, keys) {
        let ground = dem_ground(&route.case).map_err(Box::new)?;
        let journey =
            FlownJourney { scenario, test: &route.test, whole: route.case.whole_test(), ends: route.ends, ground: ground.as_ref() };
        let flown = journey.success_of(&route.found, path, &keys.options(), progress).map_err(Box::new)?;
        let (success, hops) = (flown.0, path.hops.len() as u64);
        searched.success = Some(SuccessBudgetRecord::new(least, success >= least, Some((hops, success))));
        searched.to_go = flown.1;
        route.check = route.check.with_success_budget(searched.success);
    }
    Ok((route, searched))
}
