//! The front of hops against an amount for routes in any direction.

use super::{
    Case, JourneyError,
    free_route::{FreeSearch, without_outages},
    front::{amount_row, are_alike, front_commands, front_hops_max},
};
use crate::{
    path::HopPath,
    planner::{Amount, Objective, RouteGoal, RouteQuestion, front_of_routes},
    progress::Progress,
    report::{FrontRecord, FrontSearchRecord},
};

/// The front of hops against an amount over the nodes of a free route; each of its paths is flown again over its unrolled chain and over the
/// DEM. `planned`: the path of the plan.
pub(super) fn free_front(
    case: &Case,
    planned: Option<&HopPath>,
    amount: Amount,
    progress: &dyn Progress,
) -> Result<(Vec<FrontRecord>, FrontSearchRecord), JourneyError> {
    without_outages(&case.scenario, "a front is made of paths by two amounts")?;
    let search = FreeSearch::of(case)?;
    let scenario = &search.case.scenario;
    let (commands, takeoff) = front_commands(scenario);
    let objective = Objective::of(amount);
    let question = RouteQuestion { objective: &objective, budgets: &search.budgets, commands, errors: None, cap: search.cap };
    let goal = RouteGoal { takeoff, ..search.goal };
    let hops_max = |fewest| front_hops_max(scenario, fewest);
    let front = front_of_routes(&search.ground, &search.nodes, &goal, (amount, &question, &hops_max), progress)?;
    let mut rows = Vec::new();
    for path in &front.paths {
        let Some(hops) = search.flown(search.laid(path, commands)?)?.path else { continue };
        let is_planned = planned.is_some_and(|planned| are_the_same(planned, &hops));
        rows.push(amount_row(amount, (path.cost.hops(), &hops), is_planned));
    }
    let of = FrontSearchRecord { front_amount: amount, front_hops_max: front.hops_max, front_labels_capped: front.capped };
    Ok((rows, of))
}

/// Whether two paths land at the same places and take the same.
pub(super) fn are_the_same(first: &HopPath, second: &HopPath) -> bool {
    first.hops.len() == second.hops.len()
        && first.hops.iter().zip(&second.hops).all(|(a, b)| a.landing.point_m == b.landing.point_m)
        && are_alike(&first.amounts(), &second.amounts())
}
