//! The Pareto front of two amounts.

use super::{Amount, Budgets, FoundPath, LabelCap, LegGraph, labels::Tracked, search::Run};
use crate::progress::Cancelled;

/// Sums in another order differ by less, as a share of the greatest: no more hops for a total that is the same.
const ROUNDING: f64 = 1e-12;

/// All paths of which none takes less of one amount without taking more of the other, ascending in the first: for every number of hops the
/// path with the least of the second amount, if it takes less than all paths with fewer hops. Within budgets; of equal paths one.
///
/// # Returns
/// The paths, and whether labels were left out because there were too many.
///
/// # Errors
/// [`Cancelled`], from the graph.
pub fn front(
    graph: &impl LegGraph,
    ends: (usize, usize),
    (first, second): (Amount, Amount),
    budgets: &Budgets,
    cap: LabelCap,
) -> Result<(Vec<FoundPath>, bool), Cancelled> {
    let mut run = Run::new(graph, ends, Tracked::front(first, second, budgets), cap);
    run.until(false)?;
    let mut paths = run.at_goal().into_iter().map(|label| run.path(label)).collect::<Result<Vec<_>, _>>()?;
    paths.sort_by(|a, b| {
        a.totals.of(first).total_cmp(&b.totals.of(first)).then(a.totals.of(second).total_cmp(&b.totals.of(second)))
    });
    let greatest = paths.iter().map(|path| path.totals.of(second)).fold(0.0, f64::max);
    // With a budget on a third amount the labels of the goal are a front of three.
    let mut least = f64::INFINITY;
    paths.retain(|path| {
        let improves = path.totals.of(second) < least - ROUNDING * greatest;
        least = least.min(path.totals.of(second));
        improves
    });
    Ok((paths, run.labels.capped))
}
