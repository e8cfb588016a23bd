//! `[uncertainty]`: the errors of command, ground and position, and how many trials are flown.

use std::path::PathBuf;

use super::{Budget, Entries, ProblemKind, Scenario, TerrainSource};
use crate::{
    ballistics::TakeoffChoice,
    chain::csv::MeasuredFile,
    graph::{ReliabilityOptions, ReliabilityUse, RiskModel, TakeoffScatter},
    ground::DemGround,
    quantity::Angle,
    uncertainty::{Distribution, DriftCommand, MeasuredErrors, Policy, TrialOptions, Uncertainty, UncertaintyProblem},
};

/// The keys of `[uncertainty]`, with defaults for absent ones.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyKeys {
    /// The errors. Measured ones are unread until [`Scenario::with_measured_errors`] has their file.
    pub errors: Uncertainty,
    /// Path of the file of measured errors, relative to the scenario's folder.
    pub errors_file: Option<PathBuf>,
    /// Horizontal distance from the goal that counts as reached, m.
    pub goal_tolerance_m: f64,
    /// The greatest number of hops in a trial; `None`: derived from the planned ones.
    pub hop_limit: Option<u32>,
    /// The policy: open loop or replanned.
    pub policy: Policy,
    /// The number of trials.
    pub trials: u64,
    /// The seed of all draws.
    pub seed: u64,
    /// The command of every hop of a robot whose heading is not controlled; `None` where it is.
    pub drift: Option<DriftCommand>,
}

impl Default for UncertaintyKeys {
    /// No errors, no tolerance, 10 000 open-loop trials of seed 0.
    fn default() -> Self {
        Self {
            errors: Uncertainty::NONE,
            errors_file: None,
            goal_tolerance_m: 0.0,
            hop_limit: None,
            policy: Policy::OpenLoop,
            trials: 10_000,
            seed: 0,
            drift: None,
        }
    }
}

impl UncertaintyKeys {
    /// The trials that they define.
    pub fn options(&self) -> TrialOptions {
        TrialOptions {
            trials: self.trials,
            seed: self.seed,
            policy: self.policy,
            hop_limit: self.hop_limit,
            goal_tolerance_m: self.goal_tolerance_m,
            ..TrialOptions::default()
        }
    }

    /// A warning about them: without errors the trials carry no information, and a goal tolerance of 0 is met by no trial with an
    /// error.
    pub fn warning(&self) -> Option<&'static str> {
        if self.errors.is_none() {
            Some(
                "no errors are given, so that every trial flies the plan exactly and the rate has no meaning: give [uncertainty] a standard \
                 deviation above 0, such as takeoff_speed_sigma_fraction = 0.01 and takeoff_angle_sigma_deg = 0.3, with goal_tolerance_m",
            )
        } else if self.goal_tolerance_m == 0.0 {
            Some(
                "uncertainty.goal_tolerance_m is 0 or absent, so that only a trial without any error reaches the goal: say how near is \
                 near enough",
            )
        } else {
            None
        }
    }
}

/// The keys as given; `None` if the scenario has none of them.
pub(super) fn trials(entries: &mut Entries, terrain: Option<&TerrainSource>) -> Option<UncertaintyKeys> {
    if !entries.has_table("uncertainty") {
        return None;
    }
    let number = |name| entries.number("uncertainty", name).unwrap_or(0.0);
    let errors_file = entries.text("uncertainty", "errors").map(PathBuf::from);
    let absent = UncertaintyKeys::default();
    let keys = UncertaintyKeys {
        errors: Uncertainty {
            takeoff_speed_sigma_m_s: number("takeoff_speed_sigma_m_s"),
            takeoff_speed_sigma_fraction: number("takeoff_speed_sigma_fraction"),
            takeoff_angle_sigma: Angle::from_degrees(number("takeoff_angle_sigma_deg")),
            heading_sigma: Angle::from_degrees(number("heading_sigma_deg")),
            position_sigma_m: number("position_sigma_m"),
            drift_along_sigma_m: number("drift_along_sigma_m"),
            drift_across_sigma_m: number("drift_across_sigma_m"),
            friction_sigma: number("friction_sigma"),
            height_sigma_m: number("height_sigma_m"),
            height_correlation_m: number("height_correlation_m"),
            takeoff_speed_bias_sigma_fraction: number("takeoff_speed_bias_sigma_fraction"),
            takeoff_angle_bias_sigma: Angle::from_degrees(number("takeoff_angle_bias_sigma_deg")),
            heading_bias_sigma: Angle::from_degrees(number("heading_bias_sigma_deg")),
            distribution: super::read::find(&Distribution::ALL, Distribution::name, entries.text("uncertainty", "distribution"))
                .unwrap_or_default(),
            measured: errors_file.as_ref().map(|_| MeasuredErrors::unread()),
        },
        errors_file,
        goal_tolerance_m: number("goal_tolerance_m"),
        hop_limit: entries.count("uncertainty", "hop_limit").and_then(|limit| u32::try_from(limit).ok()),
        policy: super::read::find(&Policy::ALL, Policy::name, entries.text("uncertainty", "policy")).unwrap_or(Policy::Replan),
        trials: entries.count("uncertainty", "trials").unwrap_or(absent.trials),
        seed: entries.count("uncertainty", "seed").unwrap_or(absent.seed),
        drift: super::drift::drift(entries, terrain),
    };
    let on_a_map = is_on_a_map(terrain);
    for problem in keys.errors.problems_of_deviations(on_a_map) {
        let message = format!("uncertainty.{}", problem.found());
        entries.problem(("uncertainty", problem.key()), ProblemKind::Misplaced, message, problem.help());
    }
    Some(keys)
}

/// Whether hops have a heading over this terrain.
const fn is_on_a_map(terrain: Option<&TerrainSource>) -> bool {
    matches!(terrain, None | Some(TerrainSource::Dem { .. } | TerrainSource::MeshInSpace { .. }))
}

/// How risk weighs, and how many extra hops it may cost. Where errors are given, hops are traded for reliability unless the scenario says
/// otherwise: a path planned without regard to them stands on the edge of its limits. A budget of success weighs errors of 0 as well.
pub(super) fn risk(
    entries: &mut Entries,
    uncertainty: Option<&UncertaintyKeys>,
    (budget, limits_totals): (Budget, bool),
) -> (ReliabilityUse, Option<u32>) {
    let is_estimated = uncertainty.is_some() && budget.estimated_success_min.is_some();
    let absent = if is_estimated || has_errors(uncertainty) { ReliabilityUse::Traded } else { ReliabilityUse::Ignored };
    let given = super::read::find(&ReliabilityUse::ALL, ReliabilityUse::name, entries.text("search", "risk"));
    let by_objective = limits_totals || entries.objective("search", "objective").is_some();
    let absent = if by_objective && budget.estimated_success_min.is_none() { ReliabilityUse::Ignored } else { absent };
    let risk = given.unwrap_or(absent);
    if by_objective && budget.estimated_success_min.is_none() && risk != ReliabilityUse::Ignored {
        let message = format!(
            "search.risk = \"{}\" beside search.objective or a budget of a total, expected one of the two: a plan by objective weighs \
             reliability only where the objective has risk",
            risk.name()
        );
        entries.problem(
            ("search", "risk"),
            ProblemKind::Conflict,
            message,
            "remove risk, or the objective and the budgets; objective = [\"hops\", \"risk\"] is the most reliable path of the fewest hops",
        );
    }
    let extra = entries.count("search", "risk_extra_hops_max").and_then(|hops| u32::try_from(hops).ok());
    if extra.is_some() && risk != ReliabilityUse::Traded {
        let message = format!("search.risk_extra_hops_max with search.risk = \"{}\", which allows no extra hops", risk.name());
        entries.problem(
            ("search", "risk_extra_hops_max"),
            ProblemKind::Misplaced,
            message,
            "set risk = \"traded\", or remove risk_extra_hops_max",
        );
    }
    (risk, extra)
}

/// The choice of take-off angle where the scenario names none.
pub(super) fn takeoff_choice(risk: ReliabilityUse, uncertainty: Option<&UncertaintyKeys>) -> TakeoffChoice {
    let is_weighed = risk != ReliabilityUse::Ignored && has_errors(uncertainty);
    if is_weighed { TakeoffChoice::MostReliable } else { TakeoffChoice::default() }
}

/// Whether any error of command, ground or position is given.
fn has_errors(uncertainty: Option<&UncertaintyKeys>) -> bool {
    uncertainty.is_some_and(|keys| !keys.errors.is_none())
}

impl Scenario {
    /// The same scenario with its measured errors read, and warnings about them: without their heading along a chain, and of few rows.
    ///
    /// # Errors
    /// Every deviation of an error that the file has as well.
    pub fn with_measured_errors(&self, file: &MeasuredFile) -> Result<(Self, Vec<String>), Vec<UncertaintyProblem>> {
        /// Of events with a chance of 3 %, one of a hundred rows shows at least one with a probability of 95 %.
        const ENOUGH_ROWS: usize = 100;
        let mut warnings = file.warnings.clone();
        let Some(mut keys) = self.uncertainty.clone() else { return Ok((self.clone(), warnings)) };
        let on_a_map = is_on_a_map(self.terrain.as_ref());
        let mut measured = MeasuredErrors::of(file);
        if measured.has_heading() && !on_a_map {
            warnings.push(
                "uncertainty.errors has measured errors of the heading, which have no effect along a chain: it has one plane of travel"
                    .to_owned(),
            );
            measured = measured.without_heading();
        }
        let rows = measured.row_count();
        if rows < ENOUGH_ROWS {
            #[expect(clippy::cast_precision_loss, reason = "below 100")]
            let unseen = (3.0 / rows as f64).min(1.0);
            warnings.push(format!(
                "uncertainty.errors has {rows} rows, which trials and estimates fly over and over: an error that occurs in fewer than \
                 {:.0} % of hops may be in none of them, and no success rate here accounts for it; measure {ENOUGH_ROWS} hops or more",
                100.0 * unseen
            ));
        }
        keys.errors.measured = Some(measured);
        let problems = keys.errors.problems(on_a_map);
        if problems.is_empty() { Ok((Self { uncertainty: Some(keys), ..self.clone() }, warnings)) } else { Err(problems) }
    }

    /// How path choice weighs reliability; `None` if it ignores it.
    ///
    /// The risk of a hop is the share of fixed draws of `[uncertainty]` that fail, flown over the DEM if there is one, else along the
    /// chain; without `[uncertainty]` it is the slack of its angle.
    pub fn reliability(&self, over: Option<&DemGround>) -> Option<ReliabilityOptions> {
        let extra_hops_max = match self.risk {
            ReliabilityUse::Ignored => return None,
            ReliabilityUse::FewestHops => Some(0),
            ReliabilityUse::Traded => self.risk_extra_hops_max,
        };
        Some(self.reliability_with(extra_hops_max, over))
    }

    /// The same with a given number of extra hops, in place of the scenario's.
    pub fn reliability_with(&self, extra_hops_max: Option<u32>, over: Option<&DemGround>) -> ReliabilityOptions {
        let model = self.uncertainty.as_ref().map_or(RiskModel::Slack, |keys| RiskModel::Flown {
            errors: keys.errors.clone(),
            takeoffs: match keys.policy {
                Policy::Replan => TakeoffScatter::OfPosition,
                Policy::OpenLoop => TakeoffScatter::OfLandings,
            },
            over: over.cloned().map(Box::new),
            whole: None,
        });
        let goal_tolerance_m = self.uncertainty.as_ref().map(|keys| keys.goal_tolerance_m);
        ReliabilityOptions { model, extra_hops_max, goal_tolerance_m }
    }
}

#[cfg(test)]
mod tests {
    use crate::{scenario::CATALOGUE, uncertainty::ErrorKey};

    #[test]
    fn every_error_is_a_key_and_every_other_key_says_how_trials_are_flown() {
        let no_error = [
            "height_correlation_m",
            "distribution",
            "goal_tolerance_m",
            "hop_limit",
            "policy",
            "trials",
            "seed",
            "heading",
            "takeoff_speed_m_s",
            "takeoff_angle_deg",
        ];
        let keys = CATALOGUE.iter().filter(|key| key.table == "uncertainty" && !no_error.contains(&key.name));
        let mut names: Vec<&str> = keys.map(|key| key.name).collect();
        names.sort_unstable();
        let mut errors = ErrorKey::ALL.map(ErrorKey::name);
        errors.sort_unstable();
        assert_eq!(names, errors);
    }
}
