//! The estimated success of paths: the front of hops against reliability, and a budget of success.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TotalsRecord, text::Sheet};
use crate::{
    quantity::format_number,
    uncertainty::{ESTIMATE_TRIALS, Policy, Wilson},
};

/// A path of the front of hops against reliability: no path of the front with fewer hops has as great an estimated success.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrontRecord {
    /// The number of hops.
    pub hops: u64,
    /// The share of the fixed trials that reach the goal.
    pub success_estimated: f64,
    /// Its 95 % interval by Wilson's score.
    pub success_estimated_ci95: [f64; 2],
    /// The number of these trials.
    pub trials: u64,
    /// The policy they are flown under.
    pub policy: Policy,
    /// Whether it is the path of the plan.
    pub planned: bool,
    /// Its totals.
    #[serde(flatten)]
    pub totals: TotalsRecord,
}

impl FrontRecord {
    /// The rows that improve on all rows with fewer hops, from those of all paths in ascending order of hops.
    pub fn improving(rows: impl IntoIterator<Item = Self>) -> Vec<Self> {
        let mut best = f64::NEG_INFINITY;
        let improves = |row: &Self| {
            let better = row.success_estimated > best;
            best = best.max(row.success_estimated);
            better
        };
        rows.into_iter().filter(improves).collect()
    }
}

/// The 95 % interval of an estimate by the fixed trials.
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 512 trials")]
pub fn estimate_ci95(success_estimated: f64) -> [f64; 2] {
    let Wilson { low, high, .. } = Wilson::of((success_estimated * ESTIMATE_TRIALS as f64).round() as u64, ESTIMATE_TRIALS);
    [low, high]
}

/// The front as text.
pub fn front_text(rows: &[FrontRecord]) -> String {
    let mut sheet = Sheet::default();
    let Some(first) = rows.first() else {
        sheet.line(format_args!("\nhops against reliability: no path"));
        return sheet.into_text();
    };
    sheet.line(format_args!(
        "\nhops against reliability: for every number of hops the most reliable path, if it improves on all with fewer\n\
         {:>6}{:>20}{:>22}{:>14}{:>16}{:>16}",
        "hops", "estimated success", "95 % interval", "flight (s)", "energy (J/kg)", "fastest (m/s)"
    ));
    for row in rows {
        let [low, high] = row.success_estimated_ci95;
        let planned = if row.planned { "  <- the path above" } else { "" };
        sheet.line(format_args!(
            "{:>6}{:>20.4}{:>22}{:>14.3}{:>16.4}{:>16.4}{planned}",
            row.hops,
            row.success_estimated,
            format!("{low:.4} to {high:.4}"),
            row.totals.flight_time_s,
            row.totals.energy_j_kg,
            row.totals.peak_takeoff_speed_m_s
        ));
    }
    sheet.line(format_args!(
        "estimated by {} fixed trials of each path, the same errors for all, policy {}",
        first.trials, first.policy
    ));
    sheet.into_text()
}

/// What a budget of success says of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SuccessBudgetRecord {
    /// The least success wanted.
    pub estimated_success_min: f64,
    /// Whether the path has it; if not, the verdict is `no-path-found`.
    pub met: bool,
    /// The share of the fixed trials of the path that reach the goal: the fewest hops with enough of it, or else the greatest over these
    /// paths. Null if no path could be flown.
    pub success_estimated: Option<f64>,
    /// Its 95 % interval by Wilson's score.
    pub success_estimated_ci95: Option<[f64; 2]>,
    /// The hops of that path.
    pub hops: Option<u64>,
}

impl SuccessBudgetRecord {
    /// A budget, whether it is met, and the hops and the estimated success of the path.
    pub fn new(estimated_success_min: f64, met: bool, found: Option<(u64, f64)>) -> Self {
        Self {
            estimated_success_min,
            met,
            success_estimated: found.map(|(_, success)| success),
            success_estimated_ci95: found.map(|(_, success)| estimate_ci95(success)),
            hops: found.map(|(hops, _)| hops),
        }
    }

    /// The fact as a sentence.
    pub fn sentence(&self) -> String {
        let least = format_number(self.estimated_success_min);
        let Some(((success, [low, high]), hops)) = self.success_estimated.zip(self.success_estimated_ci95).zip(self.hops) else {
            return format!(
                "not as reliably as the budget wants: no path could be flown in trials, expected an estimated success of at least {least} \
                 (budget.estimated_success_min)"
            );
        };
        let plural = if hops == 1 { "" } else { "s" };
        let interval = format!("95 % interval {low:.4} to {high:.4} of {ESTIMATE_TRIALS} fixed trials");
        if self.met {
            return format!("estimated success {success:.4} ({interval}), at least the {least} of budget.estimated_success_min");
        }
        format!(
            "not as reliably as the budget wants: the best estimated success over these paths is {success:.4} with {hops} hop{plural} \
             ({interval}), expected at least {least} (budget.estimated_success_min)"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_that_of_the_fixed_trials() {
        for (count, share) in [(0, 0.0), (1, 1.0 / 512.0), (256, 0.5), (511, 511.0 / 512.0), (512, 1.0)] {
            let Wilson { low, high, .. } = Wilson::of(count, 512);
            assert_eq!(estimate_ci95(share), [low, high], "{count}");
        }
    }

    #[test]
    fn a_budget_says_what_was_found_and_expected() {
        let cases = [
            (
                (0.95, true, Some((12, 0.96875))),
                "estimated success 0.9688 (95 % interval 0.9498 to 0.9807 of 512 fixed trials), at least the 0.95",
            ),
            ((0.95, false, Some((12, 0.5))), "the best estimated success over these paths is 0.5000 with 12 hops"),
            ((0.95, false, Some((1, 0.5))), "with 1 hop ("),
            ((0.5, false, None), "no path could be flown in trials, expected an estimated success of at least 0.5"),
        ];
        for ((least, met, found), part) in cases {
            let sentence = SuccessBudgetRecord::new(least, met, found).sentence();
            assert!(sentence.contains(part) && sentence.contains("budget.estimated_success_min"), "{sentence}");
        }
    }
}
