//! The answer of trials of a robot with legs, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{LegsPlanAnswer, SuccessRequirement, legs_plan_text, text::Sheet};
use crate::uncertainty::{LegsOutcome, LegsSummary, Policy};

/// The answer of `chta simulate` for a robot with legs: the plan, and its trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsSimulateAnswer {
    /// The plan.
    #[serde(flatten)]
    pub plan: LegsPlanAnswer,
    /// The trials under the policy of the scenario; null without a path.
    pub simulation: Option<LegsTrialsRecord>,
    /// The trials under both policies, where that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub compare: Vec<LegsTrialsRecord>,
    /// The success that was to be shown.
    #[serde(flatten)]
    pub requirement: Option<SuccessRequirement>,
}

/// Trials of a robot with legs under one policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsTrialsRecord {
    /// The policy.
    pub policy: Policy,
    /// The seed.
    pub seed: u64,
    /// How many trials.
    pub trials: u64,
    /// The share that stood at the goal.
    pub success_rate: f64,
    /// Its 95 % interval.
    pub success_ci95: [f64; 2],
    /// How many ended in each way that occurs.
    pub outcomes: Vec<LegsOutcomeRecord>,
    /// During which hop, or move of a robot that also walks, trials ended that did not reach the goal; 0: after the last one, off the goal.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ended_in_hops: Vec<EndedInHopRecord>,
    /// Half of all trials ended nearer to the goal than this, horizontally.
    pub goal_distance_median_m: Option<f64>,
    /// 95 of 100 trials did.
    pub goal_distance_p95_m: Option<f64>,
}

/// How many trials ended in a way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsOutcomeRecord {
    /// Which way: `reached`, `missed`, `slid_at_takeoff`, `slid_at_landing`, `damaged`, `crashed` (the trunk met the ground in flight), `fell` (it
    /// cannot stand where it came down, or where a walk led), `lost`, `walk_stopped` (a limit refused a walk), `walk_failed`, `stuck` or
    /// `hop_limit`.
    pub outcome: LegsOutcome,
    /// How many.
    pub trials: u64,
}

/// How many trials ended during a hop, or a move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EndedInHopRecord {
    /// Its number.
    pub hop: usize,
    /// How many.
    pub trials: u64,
}

impl LegsSimulateAnswer {
    /// Whether it shows the success that was asked for; true if none was.
    pub fn shows_success(&self) -> bool {
        self.requirement.as_ref().is_none_or(|requirement| requirement.success_min_shown)
    }
}

impl From<&LegsSummary> for LegsTrialsRecord {
    fn from(summary: &LegsSummary) -> Self {
        let [goal_distance_median_m, goal_distance_p95_m] =
            summary.goal_distance_m.map_or([None; 2], |distances| distances.map(Some));
        Self {
            policy: summary.policy,
            seed: summary.seed,
            trials: summary.trials,
            success_rate: summary.success.rate,
            success_ci95: [summary.success.low, summary.success.high],
            outcomes: summary
                .outcomes
                .iter()
                .map(|(outcome, trials)| LegsOutcomeRecord { outcome: *outcome, trials: *trials })
                .collect(),
            ended_in_hops: summary.ended_in.iter().map(|(hop, trials)| EndedInHopRecord { hop: *hop, trials: *trials }).collect(),
            goal_distance_median_m,
            goal_distance_p95_m,
        }
    }
}

/// The text of `chta simulate` for a robot with legs.
pub fn legs_simulate_text(answer: &LegsSimulateAnswer) -> String {
    let mut sheet = Sheet::default();
    let each = if answer.plan.walk.is_some() { "move" } else { "hop" };
    let records = if answer.compare.is_empty() { answer.simulation.as_slice() } else { &answer.compare };
    for record in records {
        let [low, high] = record.success_ci95;
        let LegsTrialsRecord { policy, trials, seed, success_rate, .. } = record;
        sheet.line(format_args!(
            "{policy}: {success_rate:.4} of {trials} trials stand at the goal (95 %: {low:.4} to {high:.4}), seed {seed}"
        ));
        for LegsOutcomeRecord { outcome, trials } in &record.outcomes {
            sheet.line(format_args!("  {:<16} {trials}", outcome.to_string()));
        }
        for EndedInHopRecord { hop, trials } in &record.ended_in_hops {
            match hop {
                0 => sheet.line(format_args!("  off the goal after the last {each}: {trials}")),
                hop => sheet.line(format_args!("  ended in {each} {hop}: {trials}")),
            }
        }
        if let (Some(median_m), Some(most_m)) = (record.goal_distance_median_m, record.goal_distance_p95_m) {
            sheet.line(format_args!("  distance from the goal: median {median_m:.3} m, 95 % {most_m:.3} m"));
        }
    }
    let shown = answer.requirement.zip(answer.simulation.as_ref());
    let shown = shown.map_or(String::new(), |(requirement, record)| requirement.sentence(record.success_rate, record.success_ci95));
    legs_plan_text(&answer.plan) + &sheet.into_text() + &shown
}
