//! The results of trials, as plain data and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AdviceRecord, CheckAnswer, DensityRecord, FurtherMeans, HopRecord, check_text, text::Sheet};
use crate::uncertainty::{
    ErrorSummary, LandingEllipse, LandingSummary, OutcomeCounts, Policy, RatePoint, Summary, TrialOutcome, Wilson,
};

/// The answer of a simulation: the check and, with a path, the results of its trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulateAnswer {
    /// Whether a path exists.
    #[serde(flatten)]
    pub check: CheckAnswer,
    /// The hops of the path that the trials begin with, as planned; empty without a path.
    #[serde(default)]
    pub path: Vec<HopRecord>,
    /// The trials of the policy of the scenario.
    #[serde(flatten)]
    pub simulation: Option<SimulationRecord>,
    /// Both policies on the same draws, if requested.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub compare: Vec<SimulationRecord>,
    /// Whether the required success is shown.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub requirement: Option<SuccessRequirement>,
    /// After a success rate below 0.9: which keys of the scenario would help most, the first before the others.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub advice: Vec<AdviceRecord>,
    /// Where the trials end on the map, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<DensityRecord>,
}

/// A success rate that trials have to show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SuccessRequirement {
    /// The required success.
    pub success_min: f64,
    /// Whether the lower end of the 95 % interval, under the policy of the scenario, is at least that.
    pub success_min_shown: bool,
}

impl SuccessRequirement {
    /// Whether trials show a success; without trials nothing is shown.
    pub fn of(success_min: f64, trials: Option<&SimulationRecord>) -> Self {
        Self::of_low(success_min, trials.map(|trials| trials.success_rate_ci95[0]))
    }

    /// The same by the lower end of the 95 % interval; `None` without trials.
    pub fn of_low(success_min: f64, low: Option<f64>) -> Self {
        Self { success_min, success_min_shown: low.is_some_and(|low| low >= success_min) }
    }

    /// The same as a sentence.
    pub(super) fn sentence(&self, success_rate: f64, [low, _]: [f64; 2]) -> String {
        let Self { success_min, success_min_shown } = *self;
        if success_min_shown {
            format!("a success of {success_min} is shown: the lower end of the 95 % interval is {low:.4}\n")
        } else if success_rate > success_min {
            format!(
                "a success of {success_min} is not shown: the lower end of the 95 % interval is {low:.4}, below it; more trials narrow the \
                 interval\n"
            )
        } else {
            format!("a success of {success_min} is not shown: the lower end of the 95 % interval is {low:.4}, below it\n")
        }
    }
}

impl SimulateAnswer {
    /// The answer to whether this success is shown; `None` asks for nothing. Without trials nothing is shown.
    #[must_use]
    pub fn requiring(mut self, success_min: Option<f64>) -> Self {
        self.requirement = success_min.map(|success_min| SuccessRequirement::of(success_min, self.simulation.as_ref()));
        self
    }

    /// Whether the required success, if there is one, is shown.
    pub fn shows_success(&self) -> bool {
        self.requirement.is_none_or(|requirement| requirement.success_min_shown)
    }

    /// What failed most often, and what would help, as lines.
    fn advice_text(&self) -> String {
        let Some(simulation) = self.simulation.as_ref().filter(|_| !self.advice.is_empty()) else { return String::new() };
        let mut sheet = Sheet::default();
        let failed = simulation.trials - simulation.outcomes.reached;
        if let Some(most) = simulation.failures.first() {
            let FailureRecord { outcome, hop, count } = most;
            sheet.line(format_args!("\nmost frequent failure: {outcome} at hop {hop}, {count} of {failed} trials that fail"));
        }
        for advice in &self.advice {
            sheet.line(format_args!("advice: {}", advice.sentence()));
        }
        sheet.into_text()
    }
}

/// The text of `chta simulate`.
pub fn simulate_text(answer: &SimulateAnswer, means: FurtherMeans<'_>) -> String {
    let mut text = check_text(&answer.check, means);
    text.push_str(&records_text(answer.simulation.as_ref(), &answer.compare));
    text.push_str(&answer.advice_text());
    text.push_str(&answer.density.as_ref().map(DensityRecord::text).unwrap_or_default());
    text.push_str(&requirement_text(answer.requirement, answer.simulation.as_ref()));
    text
}

/// The trials of the scenario's policy, or those of several that are compared.
pub(super) fn records_text(own: Option<&SimulationRecord>, compared: &[SimulationRecord]) -> String {
    if own.is_none() && compared.is_empty() {
        return "nothing to simulate: there is no nominal path\n".to_owned();
    }
    let own = own.filter(|_| compared.is_empty());
    own.into_iter().chain(compared).flat_map(|record| ["\n".to_owned(), record.text()]).collect()
}

/// Whether trials show the success that is required of them, if some is.
pub(super) fn requirement_text(requirement: Option<SuccessRequirement>, trials: Option<&SimulationRecord>) -> String {
    requirement
        .zip(trials)
        .map(|(requirement, trials)| format!("\n{}", requirement.sentence(trials.success_rate, trials.success_rate_ci95)))
        .unwrap_or_default()
}

/// The results of the trials of one policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulationRecord {
    /// The number of the first trial, of trials flown in ranges; absent if it is 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub first_trial: u64,
    /// The number of trials flown.
    pub trials: u64,
    /// The seed of all draws.
    pub seed: u64,
    /// The policy.
    pub policy: Policy,
    /// The share that reached the goal.
    pub success_rate: f64,
    /// Its 95 % interval (Wilson).
    pub success_rate_ci95: [f64; 2],
    /// The outcomes of the trials; they add up to `trials`.
    pub outcomes: OutcomeRecord,
    /// The outcomes other than `reached` by the hop that ended the trial, the most frequent first.
    pub failures: Vec<FailureRecord>,
    /// The number of hops flown, with or without a landing.
    pub hops_flown: u64,
    /// The landings by hop number: all planned hops, and any further hops flown.
    pub landings: Vec<LandingRecord>,
    /// The rate after each 1 000 trials, at most some hundred points, and at the end.
    pub convergence: Vec<RateRecord>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
const fn is_zero(number: &u64) -> bool {
    *number == 0
}

/// Trials by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct OutcomeRecord {
    /// It stopped within the goal tolerance.
    pub reached: u64,
    /// It stopped elsewhere.
    pub missed: u64,
    /// A take-off left its cone.
    pub slid_at_takeoff: u64,
    /// A landing left its cone, or was on ground too steep to rest on.
    pub slid_at_landing: u64,
    /// A landing was too fast.
    pub damaged: u64,
    /// It left the known ground, or landed in a keep-out zone or where a layer does not hold, or flew where one does not.
    pub lost: u64,
    /// No further hop was feasible.
    pub stuck: u64,
    /// It flew the greatest number of hops allowed.
    pub hop_limit: u64,
    /// Its next hop took more propellant than it had left.
    pub out_of_propellant: u64,
}

/// Trials that failed in the same way at the same hop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FailureRecord {
    /// How they ended.
    pub outcome: TrialOutcome,
    /// The hop that ended them, from 1; 0 if they ended before any.
    pub hop: u32,
    /// How many.
    pub count: u64,
}

impl FailureRecord {
    /// All failures of some trials, the most frequent first.
    fn rows(summary: &Summary) -> Vec<Self> {
        let of_hop = |(hop, counts): (usize, &OutcomeCounts)| {
            let hop = u32::try_from(hop).unwrap_or(u32::MAX);
            let failed = counts.each().filter(|(outcome, count)| *outcome != TrialOutcome::Reached && *count > 0);
            failed.map(|(outcome, count)| Self { outcome, hop, count }).collect::<Vec<_>>()
        };
        let mut rows: Vec<Self> = summary.ends.iter().enumerate().flat_map(of_hop).collect();
        rows.sort_by(|a, b| b.count.cmp(&a.count).then(a.hop.cmp(&b.hop)).then(a.outcome.cmp(&b.outcome)));
        rows
    }
}

/// The landings of one hop number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LandingRecord {
    /// The hop's number, from 1.
    pub hop: u32,
    /// The number of trials that landed this hop.
    pub count: u64,
    /// Quantiles of the distance from the planned landing to the rest position; null if no trial landed.
    #[serde(flatten)]
    pub error: ErrorRecord,
    /// On a DEM: the 95 % ellipse of the rest positions, under a Gaussian fit. Replanned trials plan different landings for the
    /// same hop number; there it is the spread of different plans about their common mean.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ellipse95: Option<EllipseRecord>,
}

/// A distribution of distances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ErrorRecord {
    /// Mean.
    pub mean_m: Option<f64>,
    /// The 5 % quantile.
    pub q05_m: Option<f64>,
    /// The 25 % quantile.
    pub q25_m: Option<f64>,
    /// The median.
    pub q50_m: Option<f64>,
    /// The 75 % quantile.
    pub q75_m: Option<f64>,
    /// The 95 % quantile.
    pub q95_m: Option<f64>,
    /// The largest.
    pub max_m: Option<f64>,
}

/// An ellipse on the map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EllipseRecord {
    /// Its centre, easting.
    pub centre_map_x_m: f64,
    /// Its centre, northing.
    pub centre_map_y_m: f64,
    /// Half its long axis.
    pub semi_major_m: f64,
    /// Half its short axis.
    pub semi_minor_m: f64,
    /// Direction of the long axis, clockwise from grid north, 0 to 180.
    pub orientation_deg: f64,
}

/// The success rate after some number of trials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RateRecord {
    /// The number of trials.
    pub trials: u64,
    /// The share that reached the goal.
    pub success_rate: f64,
    /// Its 95 % interval.
    pub success_rate_ci95: [f64; 2],
}

/// The number of convergence points in a result: enough for a curve, few enough to read.
const MOST_RATES: usize = 100;

impl SimulationRecord {
    /// From a summary, with an entry for every planned hop.
    pub fn new(summary: &Summary, planned_hops: usize) -> Self {
        let landings = summary.landings.iter().map(LandingRecord::new);
        let flown = u32::try_from(summary.landings.len()).unwrap_or(u32::MAX);
        let planned = u32::try_from(planned_hops).unwrap_or(u32::MAX);
        let none = |hop| LandingRecord { hop, count: 0, error: ErrorRecord::default(), ellipse95: None };
        let every = summary.convergence.len().div_ceil(MOST_RATES).max(1);
        let last = summary.convergence.len().saturating_sub(1);
        let kept = |i: usize| (i + 1).is_multiple_of(every) || i == last;
        Self {
            first_trial: summary.first_trial,
            trials: summary.trials,
            seed: summary.seed,
            policy: summary.policy,
            success_rate: summary.success.rate,
            success_rate_ci95: [summary.success.low, summary.success.high],
            outcomes: OutcomeRecord::new(&summary.outcomes),
            failures: FailureRecord::rows(summary),
            hops_flown: summary.hops_flown,
            landings: landings.chain((flown + 1..=planned).map(none)).collect(),
            convergence: summary.convergence.iter().enumerate().filter(|(i, _)| kept(*i)).map(|(_, point)| point.into()).collect(),
        }
    }

    /// Whether every hop was replanned from the end of the previous one.
    fn is_replanned(&self) -> bool {
        self.policy == Policy::Replan
    }

    /// The meaning of the landing distances.
    fn distances(&self) -> &'static str {
        if self.is_replanned() {
            "distance from the landing planned for the hop at its take-off, planned anew before every hop"
        } else {
            "distance from the planned landing"
        }
    }

    /// The answer as text: the rate, the outcomes, the landings.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let [low, high] = self.success_rate_ci95;
        sheet.line(format_args!(
            "{}: {} of {} trials reach the goal, {:.4} (95 % interval {low:.4} to {high:.4}), seed {}",
            self.policy, self.outcomes.reached, self.trials, self.success_rate, self.seed
        ));
        let ended: Vec<_> =
            self.outcomes.each().filter(|(_, count)| *count > 0).map(|(name, count)| format!("{name} {count}")).collect();
        if self.first_trial > 0 {
            sheet.line(format_args!("the first of these trials has the number {}", self.first_trial));
        }
        sheet.line(format_args!("outcomes: {}", ended.join(", ")));
        sheet.line(format_args!(
            "\n{} (m)\n{:>5}{:>11}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}",
            self.distances(),
            "hop",
            "landings",
            "mean",
            "5 %",
            "25 %",
            "50 %",
            "75 %",
            "95 %",
            "max"
        ));
        for landing in self.landings.iter().filter(|landing| landing.count > 0) {
            let numbers: String =
                landing.error.each().map(|number| number.map_or(format!("{:>10}", "-"), |n| format!("{n:>10.3}"))).concat();
            // Only for a fixed plan: under replanning, landings of the same hop number belong to different plans, and their spread
            // is not an error.
            let ellipse = landing.ellipse95.filter(|_| !self.is_replanned()).map_or(String::new(), |ellipse| {
                format!(
                    "  95 % ellipse {:.2} x {:.2} m at {:.0} deg",
                    ellipse.semi_major_m, ellipse.semi_minor_m, ellipse.orientation_deg
                )
            });
            sheet.line(format_args!("{:>5}{:>11}{numbers}{ellipse}", landing.hop, landing.count));
        }
        let unlanded = self.landings.iter().filter(|landing| landing.count == 0).count();
        if unlanded > 0 {
            sheet.line(format_args!("no trial landed any of the {unlanded} planned hops after that"));
        }
        sheet.into_text()
    }
}

impl OutcomeRecord {
    fn new(counts: &OutcomeCounts) -> Self {
        Self {
            reached: counts.of(TrialOutcome::Reached),
            missed: counts.of(TrialOutcome::Missed),
            slid_at_takeoff: counts.of(TrialOutcome::SlidAtTakeoff),
            slid_at_landing: counts.of(TrialOutcome::SlidAtLanding),
            damaged: counts.of(TrialOutcome::Damaged),
            lost: counts.of(TrialOutcome::Lost),
            stuck: counts.of(TrialOutcome::Stuck),
            hop_limit: counts.of(TrialOutcome::HopLimit),
            out_of_propellant: counts.of(TrialOutcome::OutOfPropellant),
        }
    }

    /// Every outcome by its name, in order; those out of propellant only where some are.
    pub fn each(&self) -> impl Iterator<Item = (&'static str, u64)> {
        let counts = [
            self.reached,
            self.missed,
            self.slid_at_takeoff,
            self.slid_at_landing,
            self.damaged,
            self.lost,
            self.stuck,
            self.hop_limit,
            self.out_of_propellant,
        ];
        let all = TrialOutcome::ALL.into_iter().zip(counts);
        all.filter(|(outcome, count)| *outcome != TrialOutcome::OutOfPropellant || *count > 0)
            .map(|(outcome, count)| (outcome.name(), count))
    }
}

impl LandingRecord {
    fn new(landing: &LandingSummary) -> Self {
        Self {
            hop: landing.hop,
            count: landing.count,
            error: if landing.count > 0 { (&landing.error).into() } else { ErrorRecord::default() },
            ellipse95: landing.ellipse.as_ref().map(EllipseRecord::from),
        }
    }
}

impl From<&ErrorSummary> for ErrorRecord {
    fn from(error: &ErrorSummary) -> Self {
        Self {
            mean_m: Some(error.mean_m),
            q05_m: Some(error.q05_m),
            q25_m: Some(error.q25_m),
            q50_m: Some(error.q50_m),
            q75_m: Some(error.q75_m),
            q95_m: Some(error.q95_m),
            max_m: Some(error.max_m),
        }
    }
}

impl ErrorRecord {
    /// The quantiles of a complete list of distances: each is the value of rank `share (count - 1)`, interpolated linearly.
    pub fn of(distances_m: &[f64]) -> Self {
        let mut sorted = distances_m.to_vec();
        sorted.sort_by(f64::total_cmp);
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^53")]
        let (count, last) = (sorted.len() as f64, sorted.len().saturating_sub(1) as f64);
        let quantile = |share: f64| {
            let rank = share * last;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
            let (below, part) = (rank.floor() as usize, rank - rank.floor());
            let low = sorted.get(below)?;
            Some(low + part * (sorted.get(below + 1).unwrap_or(low) - low))
        };
        Self {
            mean_m: (count > 0.0).then(|| sorted.iter().sum::<f64>() / count),
            q05_m: quantile(0.05),
            q25_m: quantile(0.25),
            q50_m: quantile(0.5),
            q75_m: quantile(0.75),
            q95_m: quantile(0.95),
            max_m: sorted.last().copied(),
        }
    }

    /// Mean, the quantiles from the least, the largest.
    pub fn each(&self) -> [Option<f64>; 7] {
        [self.mean_m, self.q05_m, self.q25_m, self.q50_m, self.q75_m, self.q95_m, self.max_m]
    }
}

impl From<&LandingEllipse> for EllipseRecord {
    fn from(ellipse: &LandingEllipse) -> Self {
        Self {
            centre_map_x_m: ellipse.centre.x,
            centre_map_y_m: ellipse.centre.y,
            semi_major_m: ellipse.semi_major_m,
            semi_minor_m: ellipse.semi_minor_m,
            orientation_deg: ellipse.orientation.degrees(),
        }
    }
}

impl From<&RatePoint> for RateRecord {
    fn from(point: &RatePoint) -> Self {
        let Wilson { rate, low, high } = point.success;
        Self { trials: point.trials, success_rate: rate, success_rate_ci95: [low, high] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_kept_distances_are_those_of_their_ranks() {
        let record = ErrorRecord::of(&[3.0, 1.0, 2.0, 5.0, 4.0]);
        assert_eq!((record.mean_m, record.q25_m, record.q50_m, record.max_m), (Some(3.0), Some(2.0), Some(3.0), Some(5.0)));
        assert_eq!(record.q05_m, Some(1.2));
        assert_eq!(ErrorRecord::of(&[]), ErrorRecord::default());
    }
}
