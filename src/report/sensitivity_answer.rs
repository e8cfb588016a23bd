//! What each error costs, as plain data and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::Sheet;
use crate::{
    quantity::format_number,
    uncertainty::{ErrorKey, PairedDifference, Policy, Wilson, experiments::Experiment},
};

/// The answer of `sensitivity`: each error in turn without effect, on the same draws, along the same path and under the same policy, which
/// counts on all errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SensitivityAnswer {
    /// The experiment's name.
    pub experiment: Experiment,
    /// Trials flown with all errors, and as many without each.
    pub trials: u64,
    /// The seed of all draws.
    pub seed: u64,
    /// The policy flown.
    pub policy: Policy,
    /// The share that reached the goal with all errors.
    pub success_rate: f64,
    /// Its 95 % interval (Wilson).
    pub success_rate_ci95: [f64; 2],
    /// The errors, from the one that costs most.
    pub errors: Vec<SensitivityRow>,
}

/// What one error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SensitivityRow {
    /// The error, by its key in `[uncertainty]`.
    pub error: ErrorKey,
    /// Its standard deviation, in the unit of the key; null where it is no single number.
    pub sigma: Option<f64>,
    /// The share that reached the goal without it.
    pub success_rate_without: f64,
    /// Its 95 % interval (Wilson).
    pub success_rate_without_ci95: [f64; 2],
    /// What the error costs: the success rate without it minus that with it.
    pub cost: f64,
    /// Its 95 % interval, of pairs of trials with the same draws.
    pub cost_ci95: [f64; 2],
    /// Trials that reach the goal only without the error.
    pub reached_only_without: u64,
    /// Trials that reach the goal only with the error.
    pub reached_only_with: u64,
}

impl SensitivityRow {
    /// The row of an error: which trials reached the goal with all errors, and which without it.
    pub fn new(error: ErrorKey, sigma: Option<f64>, with: &[bool], without: &[bool]) -> Self {
        let count = |wanted: (bool, bool)| with.iter().zip(without).filter(|pair| (*pair.0, *pair.1) == wanted).count() as u64;
        let (only_without, only_with) = (count((false, true)), count((true, false)));
        let reached = without.iter().filter(|reached| **reached).count() as u64;
        let trials = without.len() as u64;
        let rate = Wilson::of(reached, trials);
        let difference = PairedDifference::of(only_without, only_with, trials);
        Self {
            error,
            sigma,
            success_rate_without: rate.rate,
            success_rate_without_ci95: [rate.low, rate.high],
            cost: difference.difference,
            cost_ci95: [difference.low, difference.high],
            reached_only_without: only_without,
            reached_only_with: only_with,
        }
    }

    /// The error with its size, as in a scenario.
    pub fn setting(&self) -> String {
        self.sigma.map_or_else(|| self.error.to_string(), |sigma| format!("{} = {}", self.error, format_number(sigma)))
    }
}

impl SensitivityAnswer {
    /// The answer as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let [low, high] = self.success_rate_ci95;
        sheet.line(format_args!(
            "what each error costs: {} trials each on the same draws, {}, seed {}\nwith all errors {:.4} reach the goal (95 % interval {low:.4} \
             to {high:.4})",
            self.trials, self.policy, self.seed, self.success_rate
        ));
        let wide = self.errors.iter().map(|row| row.setting().len() + 2).fold(10, usize::max);
        sheet.line(format_args!("\n{:<wide$}{:>14}{:>10}{:>22}", "without", "reach the goal", "cost", "95 % interval"));
        for row in &self.errors {
            let [low, high] = row.cost_ci95;
            let interval = format!("{low:.4} to {high:.4}");
            sheet.line(format_args!("{:<wide$}{:>14.4}{:>10.4}{interval:>22}", row.setting(), row.success_rate_without, row.cost));
        }
        sheet.into_text()
    }
}
