//! What the paths of a map have least, and what bounds them.

use super::{MapQuestion, MapStudyError};
use crate::{
    planner::{Amount, Budgets, Objective, TotalBudget},
    reach::map::MapObjective,
};

/// What the paths of a map have least.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::study) enum Aim {
    /// Hops, then if wanted the effort; not more than so many hops.
    Hops(Option<i16>),
    /// The amounts of an objective, within a budget of the first of them.
    Least(Objective, Option<TotalBudget>),
}

impl MapQuestion<'_> {
    /// What its paths have least: hops, or the objective of the scenario.
    ///
    /// A map keeps one label for each node, so that it keeps a budget of the first amount alone: which of two paths to a node is the better
    /// one within a budget of another amount is known only where both go on.
    ///
    /// # Errors
    /// [`MapStudyError::OtherBudget`], [`MapStudyError::EffortBesideObjective`], [`MapStudyError::Map`].
    pub(in crate::study) fn aim(&self) -> Result<Aim, MapStudyError> {
        let scenario = self.scenario;
        if let Some(risk) = self.amounts.iter().find(|amount| **amount == Amount::Risk) {
            return Err(MapStudyError::NoRisk { amount: *risk });
        }
        let Some(objective) = &scenario.objective else {
            let of_hops = self.budget_of(Amount::Hops)?.map(|budget| budget.most.clamp(0.0, f64::from(i16::MAX)));
            #[expect(clippy::cast_possible_truncation, reason = "clamped to the range")]
            let most = of_hops.map(|most| most as i16);
            return Ok(Aim::Hops(most));
        };
        if self.effort {
            return Err(MapStudyError::EffortBesideObjective { objective: objective.clone() });
        }
        MapObjective::accepts(objective)?;
        Ok(Aim::Least(objective.clone(), self.budget_of(objective.first())?))
    }

    /// The least budget of the first amount.
    fn budget_of(&self, first: Amount) -> Result<Option<TotalBudget>, MapStudyError> {
        let (budget, hopper) = (&self.scenario.budget, &self.scenario.hopper);
        let is_kept = |budget: &TotalBudget| budget.key.starts_with("budget.") || budget.amount == first;
        let of_hops =
            self.hops_max.map(|most| TotalBudget { amount: Amount::Hops, key: "the greatest number of hops", most: most.into() });
        let budgets: Vec<TotalBudget> = budget.totals(hopper).into_iter().filter(is_kept).chain(of_hops).collect();
        if let Some(other) = budgets.iter().find(|budget| budget.amount != first) {
            return Err(MapStudyError::OtherBudget { budget: *other, first });
        }
        Ok(budgets.into_iter().min_by(|a, b| a.most.total_cmp(&b.most)))
    }

    /// A warning where the propellant bounds only the paths to goals.
    pub(super) fn propellant_warning(&self, aim: &Aim) -> Option<String> {
        let has_propellant =
            self.scenario.budget.totals(&self.scenario.hopper).iter().any(|budget| !budget.key.starts_with("budget."));
        let Aim::Least(objective, _) = aim else { return None };
        (has_propellant && objective.first() != Amount::DeltaV).then(|| {
            format!(
                "hopper.propellant_max_kg bounds only the paths to goals: what a map of {} reaches may take more; put delta-v first in \
                 search.objective",
                objective.first()
            )
        })
    }
}

/// The total from which on an amount is too much.
pub(in crate::study) fn allowed(budget: Option<&TotalBudget>) -> f64 {
    budget.map_or(f64::INFINITY, |budget| {
        Budgets::NONE.with(budget.amount, budget.most).map_or(f64::INFINITY, |budgets| budgets.allowed(budget.amount))
    })
}
