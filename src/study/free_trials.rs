//! What the errors of a scenario say of a free route: which of several is flown, the command of each of its hops, and how reliably it arrives.

use super::{
    Case, FreeRouteError, JourneyError,
    dem_ground::dem_ground,
    free_route::{FoundRoute, FreeSearch, Laid, hops_alone, one_goal},
    front::{Flown, FlownJourney, RELIABLE},
    journey::Searched,
    objective::reliability,
    to_go::{Replanning, ToGo},
};
use crate::{
    ballistics::Arc,
    graph::{Cost, Edge, Leg, ReliabilityUse, with_reliable_commands},
    ground::MapPosition,
    planner::FreeRoute,
    progress::Progress,
    report::SuccessBudgetRecord,
};

/// A free route with the most reliable command of each hop, where the scenario leaves the commands to that, and its cost. Commands that the
/// search chose stay.
///
/// # Errors
/// [`JourneyError`].
pub(super) fn commanded(laid: Laid) -> Result<(Laid, Cost), JourneyError> {
    let search = &laid.case.scenario.search;
    let is_chosen = laid.legs.iter().any(|leg| leg.loft.is_some());
    let legs = match reliability(&laid.case, false)?.filter(|_| !is_chosen) {
        Some(reliability) => with_reliable_commands(&laid.test, &laid.legs, search, &reliability)?,
        None => laid.legs.clone(),
    };
    let of_leg = |leg: &Leg| {
        let (sight, Edge::Hop(lofts)) = (laid.test.line_of_sight(&leg.takeoff, &leg.landing)?, leg.edge) else { return None };
        let loft = leg.loft.unwrap_or_else(|| laid.test.loft(search.takeoff, sight, lofts));
        Some(search.effort.cost(&Arc::new(sight, loft, laid.test.gravity_m_s2()), 1))
    };
    let cost = legs.iter().filter_map(of_leg).fold(Cost::default(), |total, hop| total + hop);
    Ok((Laid { legs, ..laid }, cost))
}

/// A route and what its fixed trials say.
struct Estimated {
    route: FoundRoute,
    success: f64,
    to_go: Option<ToGo>,
    replanning: Option<Replanning>,
}

/// The free route of a case, by hops and effort or by its objective; where the scenario weighs reliability or has a budget of success, with what
/// trials of the route say of it, and what they replan by.
///
/// Where too few trials of the route of fewest hops arrive, the most reliable routes over places within some hops of it are flown too, and the one
/// counts that most trials arrive by.
///
/// # Errors
/// [`JourneyError`].
pub(super) fn route_with_success(case: &Case, progress: &dyn Progress) -> Result<(FoundRoute, Searched), JourneyError> {
    hops_alone(&case.scenario, "this question is answered")?;
    one_goal(&case.scenario, "this question is answered")?;
    let search = FreeSearch::of(case)?;
    let route = search.route(progress)?;
    with_success(&search, &route, progress)
}

/// The same for a route that was found.
///
/// # Errors
/// [`JourneyError`].
pub(super) fn with_success(
    search: &FreeSearch,
    route: &FreeRoute,
    progress: &dyn Progress,
) -> Result<(FoundRoute, Searched), JourneyError> {
    let laid = route.path.as_ref().map(|path| search.laid(path, search.case.scenario.commands)).transpose()?;
    let found = search.found(route, laid)?;
    let scenario = &search.case.scenario;
    let least = scenario.budget.estimated_success_min;
    let weighs = scenario.risk != ReliabilityUse::Ignored && !scenario.plans_by_objective();
    let has_hops = found.path.as_ref().is_some_and(|path| !path.hops.is_empty());
    let is_flown = scenario.uncertainty.is_some() && (least.is_some() || (weighs && has_hops));
    if !is_flown || found.path.is_none() {
        let searched = Searched::of(found.found.clone());
        return Ok((found, searched));
    }
    let mut best = estimated(found, progress)?;
    let hops = best.route.found.hops();
    let enough = least.map_or(RELIABLE, |least| least.min(RELIABLE));
    let looks_on = weighs && has_hops && best.success < enough;
    let mut is_other = false;
    let others = if looks_on { reliable_places(&best, progress)? } else { Vec::new() };
    for places in &others {
        let Some(other) = other_route(search, route, places)? else { continue };
        let is_unwanted = scenario.risk == ReliabilityUse::FewestHops && other.found.hops() != hops;
        if is_unwanted || !other.check.keeps_outages() {
            continue;
        }
        let other = estimated(other, progress)?;
        if other.success > best.success {
            (best, is_other) = (other, true);
        }
    }
    let Estimated { mut route, success, to_go, .. } = best;
    if route.found.hops() != hops {
        route.warnings.push(format!(
            "this path is the most reliable one over places beside the route of fewest hops, which has {} hops over these nodes and arrives less \
             often; with search.risk = \"ignored\" that one is planned",
            hops.unwrap_or(0)
        ));
    } else if looks_on && !is_other {
        let why = if others.is_empty() {
            "no other one was looked at: the posts of the DEM are too far apart for its hops, or there are too many places beside it"
        } else {
            "none over places beside it arrives more often; detours farther away were not looked at"
        };
        route.warnings.push(format!("{:.0} % of the fixed trials arrive by this route, and {why}", 100.0 * success));
    }
    let mut searched = Searched::of(route.found.clone());
    (searched.flown, searched.to_go) = (Some(success), to_go);
    if let Some((least, path)) = least.zip(route.path.as_ref()) {
        let record = SuccessBudgetRecord::new(least, success >= least, Some((path.hops.len() as u64, success)));
        searched.success = Some(record);
        route.check = route.check.with_success_budget(searched.success);
    }
    Ok((route, searched))
}

/// The journey of a route, with the DEM that it is flown over.
fn with_journey<T>(
    route: &FoundRoute,
    ask: impl FnOnce(&FlownJourney<'_>) -> Result<T, super::SimulateError>,
) -> Result<T, JourneyError> {
    let ground = dem_ground(&route.case).map_err(Box::new)?;
    let scenario = &route.case.scenario;
    let journey =
        FlownJourney { scenario, test: &route.test, whole: route.case.whole_test(), ends: route.ends, ground: ground.as_ref() };
    Ok(ask(&journey).map_err(Box::new)?)
}

fn estimated(route: FoundRoute, progress: &dyn Progress) -> Result<Estimated, JourneyError> {
    let (Some(path), Some(keys)) = (&route.path, &route.case.scenario.uncertainty) else {
        return Ok(Estimated { route, success: 0.0, to_go: None, replanning: None });
    };
    let Flown { success, to_go, replanning } =
        with_journey(&route, |journey| journey.success_of(&route.found, path, &keys.options(), progress))?;
    Ok(Estimated { route, success, to_go, replanning })
}

/// The places of the most reliable routes about a route.
fn reliable_places(of: &Estimated, progress: &dyn Progress) -> Result<Vec<Vec<MapPosition>>, JourneyError> {
    with_journey(&of.route, |journey| journey.reliable_places(&of.route.found, of.replanning.as_ref(), progress))
}

/// The route over these places; `None` where one of its hops is not feasible by its slice, or it has no commands.
fn other_route(search: &FreeSearch, of: &FreeRoute, places: &[MapPosition]) -> Result<Option<FoundRoute>, JourneyError> {
    let laid = match search.laid_over(places, None) {
        Ok(laid) => laid,
        Err(JourneyError::Free(FreeRouteError::Lost { .. })) => return Ok(None),
        Err(error) => return Err(error),
    };
    Ok(Some(search.found(of, Some(laid))?).filter(|route| route.path.is_some()))
}
