//! A cell of a trade whose route is free.

use std::collections::BTreeMap;

use super::{
    Case, CellError,
    free_trials::route_with_success,
    physics::escape_warnings,
    travel::{TravelOptions, travel_plan},
};
use crate::{
    path::Hop,
    progress::Progress,
    report::{MarginsRecord, TotalsRecord, TradeRow},
};

/// The row of a cell.
///
/// # Errors
/// [`CellError::Journey`].
pub(super) fn free_row(case: &Case, values: BTreeMap<String, f64>, progress: &dyn Progress) -> Result<TradeRow, CellError> {
    if case.scenario.drives().is_some() {
        return travel_row(case, values, progress);
    }
    let (route, _) = route_with_success(case, progress)?;
    let (scenario, check) = (&case.scenario, route.check);
    let path = route.path.filter(|_| check.is_traversable());
    let longest_m = path.iter().flat_map(|path| &path.hops).map(Hop::run_m).reduce(f64::max);
    Ok(TradeRow {
        values,
        verdict: Some(check.verdict),
        hops: check.hops.filter(|_| path.is_some()),
        lower_bound: None,
        above_escape: !escape_warnings(scenario, Some(case.prepared.chain.geometry())).is_empty(),
        far_on_body: longest_m.zip(scenario.body.radius_m()).is_some_and(|(longest_m, radius_m)| longest_m > 0.01 * radius_m),
        totals: path.as_ref().map(|path| TotalsRecord::from(&path.totals)),
        margins: path.as_ref().and_then(MarginsRecord::of),
        effort: check.effort.filter(|_| path.is_some()),
        success_budget: check.success_budget,
        by_objective: check.objective,
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
