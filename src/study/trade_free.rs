//! A cell of a trade whose route is free.

use std::collections::BTreeMap;

use super::{Case, CellError, free_trials::route_with_success, physics::escape_warnings};
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
