//! `[budget]`: what a path may take at most, and what it has to give at least.

use super::{Entries, ProblemKind, UncertaintyKeys};
use crate::graph::ReliabilityUse;

/// The keys of `[budget]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// The least success that the fixed trials of a path estimate, 0 to 1; `None`: any.
    pub estimated_success_min: Option<f64>,
}

/// The keys as given.
pub(super) fn budget(entries: &Entries) -> Budget {
    Budget { estimated_success_min: entries.number("budget", "estimated_success_min") }
}

/// Refuses a budget of success that nothing estimates.
pub(super) fn check(entries: &mut Entries, budget: Budget, risk: ReliabilityUse, uncertainty: Option<&UncertaintyKeys>) {
    let Some(least) = budget.estimated_success_min else { return };
    let key = ("budget", "estimated_success_min");
    if uncertainty.is_none() {
        let message = format!("budget.estimated_success_min is {least}, but without [uncertainty] no success is estimated");
        let help = "add [uncertainty] with deviations above 0, such as takeoff_speed_sigma_fraction = 0.02, and goal_tolerance_m; or remove \
                    estimated_success_min";
        entries.problem(key, ProblemKind::Missing, message, help);
    } else if risk == ReliabilityUse::Ignored {
        let message =
            format!("budget.estimated_success_min is {least}, but search.risk = \"ignored\" plans without regard to success");
        let help = "set risk = \"traded\" or \"fewest-hops\", or remove risk or estimated_success_min";
        entries.problem(key, ProblemKind::Conflict, message, help);
    }
}
