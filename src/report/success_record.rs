//! The estimated success of paths: the front of hops against reliability, and a budget of success.

use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TotalsRecord, text::Sheet};
use crate::{
    planner::Amount,
    quantity::format_number,
    uncertainty::{ESTIMATE_TRIALS, Policy, Wilson},
};

/// A path of a front: no path of the front with fewer hops has as great an estimated success, or takes as little of the front's amount.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrontRecord {
    /// The number of hops.
    pub hops: u64,
    /// Of a front of hops against risk: how reliably it is flown.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub success: Option<FrontSuccess>,
    /// Whether it is the path of the plan.
    pub planned: bool,
    /// Of a front against it: the sum of take-off speeds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub takeoff_speed_sum_m_s: Option<f64>,
    /// Of a front against it: the length of the arcs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc_length_m: Option<f64>,
    /// Of a front against the cost of a layer: that cost, in the unit of the layer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer_total: Option<f64>,
    /// Its totals.
    #[serde(flatten)]
    pub totals: TotalsRecord,
}

/// The estimated success of a path of a front.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrontSuccess {
    /// The share of the fixed trials that reach the goal.
    pub success_estimated: f64,
    /// Its 95 % interval by Wilson's score.
    pub success_estimated_ci95: [f64; 2],
    /// The number of these trials.
    pub trials: u64,
    /// The policy they are flown under.
    pub policy: Policy,
}

impl FrontRecord {
    /// The rows that improve on all rows with fewer hops, from those of all paths in ascending order of hops.
    pub fn improving(rows: impl IntoIterator<Item = Self>) -> Vec<Self> {
        let mut best = f64::NEG_INFINITY;
        let improves = |row: &Self| {
            let success = row.success.map_or(f64::NEG_INFINITY, |success| success.success_estimated);
            let better = success > best;
            best = best.max(success);
            better
        };
        rows.into_iter().filter(improves).collect()
    }

    /// What the path takes of an amount; NaN of risk, of which it has an estimated success.
    #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
    pub fn of(&self, amount: Amount) -> f64 {
        match amount {
            Amount::Hops => self.hops as f64,
            Amount::TakeoffSpeed => self.takeoff_speed_sum_m_s.unwrap_or(f64::NAN),
            Amount::DeltaV => self.totals.delta_v_m_s,
            Amount::Energy => self.totals.energy_j_kg,
            Amount::FlightTime => self.totals.flight_time_s,
            Amount::MissionTime => self.totals.mission_time_s.unwrap_or(self.totals.flight_time_s),
            Amount::Distance => self.totals.ground_distance_m,
            Amount::ArcLength => self.arc_length_m.unwrap_or(f64::NAN),
            Amount::Risk => f64::NAN,
            Amount::PeakSpeed => self.totals.peak_takeoff_speed_m_s,
            Amount::Layer(_) => self.layer_total.unwrap_or(f64::NAN),
        }
    }
}

/// What a front of hops against an amount other than risk was searched for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrontSearchRecord {
    /// The amount against which hops are traded.
    pub front_amount: Amount,
    /// The most hops of a path of the front.
    pub front_hops_max: u64,
    /// Whether the search left out labels because there were too many: the front may then miss paths.
    pub front_labels_capped: bool,
}

/// A front of hops against an amount as text.
pub fn amount_front_text(rows: &[FrontRecord], of: &FrontSearchRecord) -> String {
    let (amount, most) = (of.front_amount, of.front_hops_max);
    let mut sheet = Sheet::default();
    if rows.is_empty() {
        sheet.line(format_args!("\nhops against {amount}: no path"));
        return sheet.into_text();
    }
    let shown = [Amount::FlightTime, Amount::Energy, Amount::PeakSpeed].map(|other| (other, other != amount));
    let heading = |amount: Amount| match amount.unit() {
        "" => amount.to_string(),
        unit => format!("{amount} ({unit})"),
    };
    let mut heads = format!("{:>6}{:>22}", "hops", heading(amount));
    for (other, _) in shown.iter().filter(|(_, is_shown)| *is_shown) {
        let _ = write!(heads, "{:>20}", heading(*other));
    }
    sheet.line(format_args!(
        "\nhops against {amount}: for every number of hops up to {most} the path of the least {}, if it improves on all with fewer, over\n\
         the distinct commands of every hop\n{heads}",
        amount.words()
    ));
    for row in rows {
        let mut line = format!("{:>6}{:>22.4}", row.hops, row.of(amount));
        for (other, _) in shown.iter().filter(|(_, is_shown)| *is_shown) {
            let _ = write!(line, "{:>20.4}", row.of(*other));
        }
        let planned = if row.planned { "  <- the path above" } else { "" };
        sheet.line(format_args!("{line}{planned}"));
    }
    if of.front_labels_capped {
        sheet.line(format_args!(
            "the search left out labels because there were too many: the front may miss paths; fewer nodes need fewer"
        ));
    }
    sheet.into_text()
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
    let Some(first) = rows.first().and_then(|row| row.success) else {
        sheet.line(format_args!("\nhops against reliability: no path"));
        return sheet.into_text();
    };
    sheet.line(format_args!(
        "\nhops against reliability: for every number of hops the most reliable path, if it improves on all with fewer\n\
         {:>6}{:>20}{:>22}{:>14}{:>16}{:>16}",
        "hops", "estimated success", "95 % interval", "flight (s)", "energy (J/kg)", "fastest (m/s)"
    ));
    for row in rows {
        let Some(FrontSuccess { success_estimated, success_estimated_ci95: [low, high], .. }) = row.success else { continue };
        let planned = if row.planned { "  <- the path above" } else { "" };
        sheet.line(format_args!(
            "{:>6}{:>20.4}{:>22}{:>14.3}{:>16.4}{:>16.4}{planned}",
            row.hops,
            success_estimated,
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
