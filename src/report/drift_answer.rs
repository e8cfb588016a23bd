//! The answer of trials of a robot whose heading is not controlled, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DensityRecord, SimulationRecord, SuccessRequirement, simulate_answer::requirement_text, text::Sheet};

/// The answer of `chta simulate` where `uncertainty.heading` is "uncontrolled": there is no plan and no goal.
///
/// A trial counts as `reached` where it flies all its hops and rests after each of them, wherever that is; `success_rate` is their share. The
/// distances of `landings` are horizontal ones from the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriftAnswer {
    /// Where every trial starts, [x, y, z], m.
    pub start_m: [f64; 3],
    /// The commanded take-off speed of every hop, m/s.
    pub takeoff_speed_m_s: f64,
    /// The commanded take-off angle of every hop over the horizontal, degrees.
    pub takeoff_angle_deg: f64,
    /// How many hops every trial has.
    pub hops: u32,
    /// The trials.
    #[serde(flatten)]
    pub trials: SimulationRecord,
    /// Whether the required share that flies all hops is shown, if one is required.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub requirement: Option<SuccessRequirement>,
    /// Where the trials end on the map, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<DensityRecord>,
}

impl DriftAnswer {
    /// Whether the required share, if there is one, is shown.
    pub fn shows_success(&self) -> bool {
        self.requirement.is_none_or(|requirement| requirement.success_min_shown)
    }
}

/// The text of such an answer.
pub fn drift_text(answer: &DriftAnswer) -> String {
    let DriftAnswer { start_m: [x_m, y_m, _], takeoff_speed_m_s, takeoff_angle_deg, hops, trials, .. } = answer;
    let mut sheet = Sheet::default();
    sheet.line(format_args!(
        "hops in any direction, each as likely as any other, from ({x_m}, {y_m}) m: there is no plan and no goal"
    ));
    sheet.line(format_args!("command of each of {hops} hops: {takeoff_speed_m_s} m/s at {takeoff_angle_deg} deg"));
    let [low, high] = trials.success_rate_ci95;
    sheet.line(format_args!(
        "{} of {} trials fly all hops and rest after each, {:.4} (95 % interval {low:.4} to {high:.4}); seed {}",
        trials.outcomes.reached, trials.trials, trials.success_rate, trials.seed
    ));
    for failure in &trials.failures {
        sheet.line(format_args!("  {} at hop {}: {}", failure.outcome, failure.hop, failure.count));
    }
    sheet.line(format_args!("distance from the start at rest, m:"));
    sheet.line(format_args!("  hop   landings     mean      5 %     50 %     95 %      max"));
    for landing in &trials.landings {
        let error = &landing.error;
        let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
        let [mean, low, half, high, most] = [error.mean_m, error.q05_m, error.q50_m, error.q95_m, error.max_m].map(number);
        sheet.line(format_args!("  {:<4} {:>9} {mean:>8} {low:>8} {half:>8} {high:>8} {most:>8}", landing.hop, landing.count));
    }
    let mut text = sheet.into_text();
    text.push_str(&answer.density.as_ref().map(DensityRecord::text).unwrap_or_default());
    text.push_str(&requirement_text(answer.requirement, Some(&answer.trials)));
    text
}
