//! A cell of a trade whose route is free.

use std::collections::BTreeMap;

use super::{
    Case, CellError,
    free_trials::route_with_success,
    physics::escape_warnings,
    targets::targets_plan,
    travel::{TravelOptions, travel_plan},
};
use crate::{
    path::{Hop, HopPath},
    progress::Progress,
    report::{MarginsRecord, TotalsRecord, TradeRow},
    scenario::Scenario,
};

/// The row of a cell.
///
/// # Errors
/// [`CellError::Journey`].
pub(super) fn free_row(case: &Case, values: BTreeMap<String, f64>, progress: &dyn Progress) -> Result<TradeRow, CellError> {
    if case.scenario.drives().is_some() {
        return travel_row(case, values, progress);
    }
    if case.scenario.mission.is_some() {
        return targets_row(case, values, progress);
    }
    let (route, _) = route_with_success(case, progress)?;
    let (scenario, check) = (&case.scenario, route.check);
    let path = route.path.filter(|_| check.is_traversable());
    Ok(TradeRow {
        values,
        verdict: Some(check.verdict),
        hops: check.hops.filter(|_| path.is_some()),
        lower_bound: None,
        above_escape: !escape_warnings(scenario, Some(case.prepared.chain.geometry())).is_empty(),
        far_on_body: is_far_on_body(scenario, path.as_ref()),
        totals: path.as_ref().map(|path| TotalsRecord::from(&path.totals)),
        margins: path.as_ref().and_then(MarginsRecord::of),
        effort: check.effort.filter(|_| path.is_some()),
        success_budget: check.success_budget,
        by_objective: check.objective,
        error: None,
    })
}

/// Whether a hop is so long that the body under it is no plain.
fn is_far_on_body(scenario: &Scenario, path: Option<&HopPath>) -> bool {
    let longest_m = path.into_iter().flat_map(|path| &path.hops).map(Hop::run_m).reduce(f64::max);
    longest_m.zip(scenario.body.radius_m()).is_some_and(|(longest_m, radius_m)| longest_m > 0.01 * radius_m)
}

/// The row of a mission over targets: its hops where it visits all of them.
fn targets_row(case: &Case, values: BTreeMap<String, f64>, progress: &dyn Progress) -> Result<TradeRow, CellError> {
    let planned = targets_plan(case, progress)?;
    let (answer, scenario) = (&planned.answer, &case.scenario);
    let path = planned.path().filter(|_| answer.is_traversable());
    Ok(TradeRow {
        values,
        verdict: Some(answer.verdict),
        hops: path.map(|path| path.hops.len() as u64),
        lower_bound: None,
        above_escape: !escape_warnings(scenario, Some(case.prepared.chain.geometry())).is_empty(),
        far_on_body: is_far_on_body(scenario, path),
        totals: path.map(|path| TotalsRecord::from(&path.totals)),
        margins: path.and_then(MarginsRecord::of),
        effort: None,
        success_budget: None,
        by_objective: scenario.plans_by_objective().then(|| answer.objective.clone()),
        error: None,
    })
}

/// The row of a mission that drives.
fn travel_row(case: &Case, values: BTreeMap<String, f64>, progress: &dyn Progress) -> Result<TradeRow, CellError> {
    let planned = travel_plan(case, TravelOptions::default(), progress)?;
    let answer = &planned.answer;
    let is_traversable = answer.is_traversable();
    Ok(TradeRow {
        values,
        verdict: Some(answer.verdict),
        hops: answer.hops.filter(|_| is_traversable),
        lower_bound: None,
        above_escape: !escape_warnings(&case.scenario, Some(case.prepared.chain.geometry())).is_empty(),
        far_on_body: false,
        totals: planned.totals_record().filter(|_| is_traversable),
        margins: None,
        effort: None,
        success_budget: None,
        by_objective: Some(answer.objective.clone()),
        error: None,
    })
}
