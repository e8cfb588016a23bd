//! What a path was planned for, and what it takes of its budgets.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    planner::{Amount, Amounts, Budgets, LayerTotals, Objective, TotalBudget, UnmetBudget},
    quantity::format_number,
};

/// The objective of a plan, and its budgets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObjectiveRecord {
    /// What was to be least, and what broke ties.
    pub objective: Vec<Amount>,
    /// The totals of the path in all amounts of the objective, in their order; empty without a path.
    pub objective_totals: Vec<AmountRecord>,
    /// The greatest totals, and what the path takes of them; if it takes more of one, the verdict is `no-path-found`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub budgets: Vec<BudgetRecord>,
    /// Whether the search left out labels because there were too many: the path may then not be the best, and another one may keep the
    /// budgets.
    pub labels_capped: bool,
}

/// A total of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AmountRecord {
    /// Of which amount.
    pub amount: Amount,
    /// The total, in `unit`.
    pub total: f64,
}

impl AmountRecord {
    /// What the layers of the map cost a path.
    pub fn of_layers(layers: &LayerTotals) -> Vec<Self> {
        layers.iter().map(|(layer, total)| Self { amount: Amount::Layer(layer), total }).collect()
    }

    /// What text says of the costs of layers, where there are some.
    pub fn layers_sentence(layers: &[Self]) -> Option<String> {
        let costs: Vec<_> = layers.iter().map(|row| format!("{} {:.4}", row.amount, row.total)).collect();
        (!costs.is_empty()).then(|| format!("costs of layers: {}", costs.join(", ")))
    }
}

/// A greatest total.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BudgetRecord {
    /// Of which amount.
    pub amount: Amount,
    /// The key that sets it.
    pub key: String,
    /// The greatest total, in the unit of the amount.
    pub max: f64,
    /// What the path takes: the best by the objective within all budgets, or the best without budgets, if no path keeps them; null without a path.
    pub total: Option<f64>,
    /// Whether the path keeps it.
    pub met: bool,
    /// Where the path takes too much: the least total of any path over these nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least: Option<f64>,
}

impl ObjectiveRecord {
    /// From the result of a search: what its path takes, the budgets that none keeps, and whether labels were left out.
    pub fn new(
        objective: &Objective,
        budgets: &[TotalBudget],
        (found, unmet, capped): (Option<Amounts>, &[UnmetBudget], bool),
    ) -> Self {
        let total_of = |amount| found.map(|totals| totals.of(amount));
        let budget = |budget: &TotalBudget| {
            let total = total_of(budget.amount);
            let unmet = unmet.iter().find(|unmet| unmet.over.amount == budget.amount);
            let met = total.is_none_or(|total| keeps(budget.amount, total, budget.most));
            BudgetRecord {
                amount: budget.amount,
                key: budget.full_key(),
                max: budget.most,
                total,
                met,
                least: unmet.filter(|_| !met).map(|unmet| unmet.least),
            }
        };
        let totals =
            objective.amounts().iter().filter_map(|amount| Some(AmountRecord { amount: *amount, total: total_of(*amount)? }));
        Self {
            objective: objective.amounts().to_vec(),
            objective_totals: totals.collect(),
            budgets: budgets.iter().map(budget).collect(),
            labels_capped: capped,
        }
    }

    /// The same with the totals of the path as it is flown: commands in steps take other amounts than those that were planned.
    #[must_use]
    pub fn flown(mut self, flown: &Amounts) -> Self {
        // Risk is of the plan.
        for row in self.objective_totals.iter_mut().filter(|row| row.amount != Amount::Risk) {
            row.total = flown.of(row.amount);
        }
        for row in &mut self.budgets {
            let total = flown.of(row.amount);
            row.total = Some(total);
            row.met = keeps(row.amount, total, row.max);
        }
        self
    }

    /// Whether the path keeps all budgets.
    pub fn is_met(&self) -> bool {
        self.budgets.iter().all(|budget| budget.met)
    }

    /// What is said of it, a sentence a line.
    pub fn sentences(&self) -> Vec<String> {
        let names: Vec<_> = self.objective.iter().map(|amount| amount.name()).collect();
        let totals = self.objective_totals.iter().map(|row| format!("{} {}", row.amount.words(), with_unit(row.amount, row.total)));
        let totals = totals.collect::<Vec<_>>().join(", ");
        let of_path = if totals.is_empty() { String::new() } else { format!(": {totals}") };
        let mut said = vec![format!("planned for the least {}{of_path}", names.join(", then "))];
        for budget in &self.budgets {
            let Some(total) = budget.total else { continue };
            let (key, words) = (&budget.key, budget.amount.words());
            let [total, max] = [total, budget.max].map(|value| with_unit(budget.amount, value));
            said.push(match budget.least {
                _ if budget.met => format!("within its budget: {words} {total}, at most {max} ({key})"),
                Some(least) => format!(
                    "not within its budget: {words} {total} for the best path by this objective, expected at most {max} ({key}); the least of \
                     any path over these nodes is {}",
                    with_unit(budget.amount, least)
                ),
                None => format!("not within its budget: {words} {total} for this path as it is flown, expected at most {max} ({key})"),
            });
        }
        let unmet = || self.budgets.iter().filter(|budget| !budget.met);
        let each_alone = |budget: &BudgetRecord| budget.least.is_some_and(|least| keeps(budget.amount, least, budget.max));
        if unmet().next().is_some() && unmet().all(each_alone) {
            said.push(
                "each of these budgets is kept by some path over these nodes, but no path keeps all budgets at once".to_owned(),
            );
        }
        if self.labels_capped {
            let of = if self.is_met() { "the path may not be the best" } else { "another path may keep the budgets" };
            said.push(format!(
                "the search left out labels because there were too many: {of}; fewer nodes or fewer budgets need fewer"
            ));
        }
        said
    }
}

/// Whether a total keeps a greatest one, as a search judges it.
fn keeps(amount: Amount, total: f64, most: f64) -> bool {
    let budgets = Budgets::NONE.with(amount, most);
    budgets.is_ok_and(|budgets| budgets.exceeded_by(&Amounts::NONE.with(amount, total)).next().is_none())
}

/// A total with its unit.
pub(super) fn with_unit(amount: Amount, total: f64) -> String {
    let number = if amount == Amount::Hops { format_number(total) } else { format!("{total:.4}") };
    if amount.unit().is_empty() { number } else { format!("{number} {}", amount.unit()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A budget: the total of the path, the least one, and a part of what is said.
    #[test]
    fn an_unmet_budget_says_what_was_found_and_what_is_least() {
        let budget = |total: f64, max: f64, least| BudgetRecord {
            amount: Amount::Energy,
            key: "budget.energy_max_j_kg".to_owned(),
            max,
            total: Some(total),
            met: keeps(Amount::Energy, total, max),
            least,
        };
        let rows = [
            (budget(90.0, 100.0, None), true, "energy per unit mass 90.0000 J/kg, at most 100.0000 J/kg (budget.energy_max_j_kg)"),
            (budget(100.0 + 1e-8, 100.0, None), true, "within its budget"),
            (budget(120.0, 100.0, Some(110.0)), false, "is 110.0000 J/kg"),
            (budget(120.0, 100.0, Some(95.0)), false, "no path keeps all budgets at once"),
            (budget(120.0, 100.0, None), false, "as it is flown"),
        ];
        for (budget, met, part) in rows {
            let record = ObjectiveRecord {
                objective: vec![Amount::Hops],
                objective_totals: vec![AmountRecord { amount: Amount::Hops, total: 3.0 }],
                budgets: vec![budget],
                labels_capped: false,
            };
            let said = record.sentences().join("\n");
            assert!(record.is_met() == met && said.contains(part) && said.contains("number of hops 3"), "{said}");
        }
    }
}
