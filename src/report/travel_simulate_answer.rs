//! The answer of trials of a mission that may drive, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{SuccessRequirement, TravelAnswer, text::Sheet, travel_text};
use crate::uncertainty::{Policy, TravelOutcome, TravelSummary};

/// The answer of `chta simulate` for a scenario with `[drive]`: the plan, and its trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelSimulateAnswer {
    /// The plan.
    #[serde(flatten)]
    pub plan: TravelAnswer,
    /// The trials under the policy of the scenario; null without a path.
    pub simulation: Option<TravelTrialsRecord>,
    /// The trials under both policies, where that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub compare: Vec<TravelTrialsRecord>,
    /// The success that was to be shown.
    #[serde(flatten)]
    pub requirement: Option<SuccessRequirement>,
}

/// Trials of a mission under one policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelTrialsRecord {
    /// The policy.
    pub policy: Policy,
    /// The seed.
    pub seed: u64,
    /// How many trials.
    pub trials: u64,
    /// The share that reached the goal.
    pub success_rate: f64,
    /// Its 95 % interval.
    pub success_ci95: [f64; 2],
    /// How many ended in each way that occurs.
    pub outcomes: Vec<TravelOutcomeRecord>,
    /// During which leg trials ended that did not reach the goal; 0: after the last one, off the goal.
    pub ended_in_legs: Vec<EndedInLegRecord>,
    /// The mean mission time of those that reached the goal; null if none did.
    pub mission_time_mean_s: Option<f64>,
    /// The mean length driven by them, in three dimensions.
    pub driven_mean_m: Option<f64>,
    /// Half of all trials ended nearer to the goal than this, horizontally.
    pub goal_distance_median_m: Option<f64>,
    /// 95 of 100 trials did.
    pub goal_distance_p95_m: Option<f64>,
}

/// How many trials ended in a way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelOutcomeRecord {
    /// Which way.
    pub outcome: TravelOutcome,
    /// How many.
    pub trials: u64,
}

/// How many trials ended during a leg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EndedInLegRecord {
    /// The number of the leg.
    pub leg: usize,
    /// How many.
    pub trials: u64,
}

impl TravelTrialsRecord {
    /// Of a summary. `leg_of`: the number of the leg that a move belongs to, by its number from 1.
    pub fn new(summary: &TravelSummary, leg_of: &dyn Fn(usize) -> usize) -> Self {
        let mut ended: Vec<EndedInLegRecord> = Vec::new();
        for (number, trials) in &summary.ended_in {
            let leg = leg_of(*number);
            match ended.iter_mut().find(|record| record.leg == leg) {
                Some(record) => record.trials += trials,
                None => ended.push(EndedInLegRecord { leg, trials: *trials }),
            }
        }
        Self {
            policy: summary.policy,
            seed: summary.seed,
            trials: summary.trials,
            success_rate: summary.success.rate,
            success_ci95: [summary.success.low, summary.success.high],
            outcomes: summary
                .outcomes
                .iter()
                .map(|(outcome, trials)| TravelOutcomeRecord { outcome: *outcome, trials: *trials })
                .collect(),
            ended_in_legs: ended,
            mission_time_mean_s: summary.mission_time_mean_s,
            driven_mean_m: summary.driven_mean_m,
            goal_distance_median_m: summary.goal_distance_m.map(|[median, _]| median),
            goal_distance_p95_m: summary.goal_distance_m.map(|[_, p95]| p95),
        }
    }
}

impl TravelSimulateAnswer {
    /// Whether the trials show the success that was to be shown.
    pub fn shows_success(&self) -> bool {
        self.requirement.is_none_or(|requirement| requirement.success_min_shown)
    }
}

/// The text of `chta simulate` for a scenario with `[drive]`.
pub fn travel_simulate_text(answer: &TravelSimulateAnswer) -> String {
    let mut text = travel_text(&answer.plan);
    let mut sheet = Sheet::default();
    let records: Vec<&TravelTrialsRecord> =
        if answer.compare.is_empty() { answer.simulation.iter().collect() } else { answer.compare.iter().collect() };
    for record in records {
        trials_lines(&mut sheet, record);
    }
    text.push_str(&sheet.into_text());
    if let Some((requirement, record)) = answer.requirement.zip(answer.simulation.as_ref()) {
        text.push('\n');
        text.push_str(&requirement.sentence(record.success_rate, record.success_ci95));
    }
    text
}

fn trials_lines(sheet: &mut Sheet, record: &TravelTrialsRecord) {
    let [low, high] = record.success_ci95;
    sheet.line(format_args!(
        "\n{} trials, {}, seed {}: the goal was reached by {:.2} % (95 % interval {:.2} to {:.2} %)",
        record.trials,
        record.policy,
        record.seed,
        100.0 * record.success_rate,
        100.0 * low,
        100.0 * high
    ));
    let outcomes: Vec<String> = record.outcomes.iter().map(|row| format!("{} {}", row.outcome, row.trials)).collect();
    sheet.line(format_args!("outcomes: {}", outcomes.join(", ")));
    if !record.ended_in_legs.is_empty() {
        let legs = record.ended_in_legs.iter().map(|row| match row.leg {
            0 => format!("after the last leg {}", row.trials),
            leg => format!("leg {leg} {}", row.trials),
        });
        sheet.line(format_args!("not reached, by where they ended: {}", legs.collect::<Vec<_>>().join(", ")));
    }
    if let Some((time_s, driven_m)) = record.mission_time_mean_s.zip(record.driven_mean_m) {
        sheet.line(format_args!("those that reached it took {time_s:.1} s and drove {driven_m:.2} m on average"));
    }
    if let Some((median_m, p95_m)) = record.goal_distance_median_m.zip(record.goal_distance_p95_m) {
        sheet.line(format_args!("distance from the goal at the end: median {median_m:.3} m, 95 % within {p95_m:.3} m"));
    }
}
