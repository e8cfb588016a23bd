//! `[uncertainty]`: the errors of command, ground and position, and how many trials are flown.

use super::{Budget, Entries, ProblemKind, Scenario, TerrainSource};
use crate::{
    ballistics::TakeoffChoice,
    graph::{ReliabilityOptions, ReliabilityUse, RiskModel, TakeoffScatter},
    ground::DemGround,
    quantity::Angle,
    uncertainty::{Policy, TrialOptions, Uncertainty},
};

/// The keys of `[uncertainty]`, with defaults for absent ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncertaintyKeys {
    /// The standard deviations.
    pub errors: Uncertainty,
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
}

impl Default for UncertaintyKeys {
    /// No errors, no tolerance, 10 000 open-loop trials of seed 0.
    fn default() -> Self {
        Self {
            errors: Uncertainty::NONE,
            goal_tolerance_m: 0.0,
            hop_limit: None,
            policy: Policy::OpenLoop,
            trials: 10_000,
            seed: 0,
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
        if self.errors == Uncertainty::NONE {
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
        },
        goal_tolerance_m: number("goal_tolerance_m"),
        hop_limit: entries.count("uncertainty", "hop_limit").and_then(|limit| u32::try_from(limit).ok()),
        policy: super::read::find(&Policy::ALL, Policy::name, entries.text("uncertainty", "policy")).unwrap_or(Policy::Replan),
        trials: entries.count("uncertainty", "trials").unwrap_or(absent.trials),
        seed: entries.count("uncertainty", "seed").unwrap_or(absent.seed),
    };
    let on_a_map = matches!(terrain, None | Some(TerrainSource::Dem { .. }));
    if let Err(problem) = keys.errors.check(on_a_map) {
        let message = format!("uncertainty.{}", problem.found());
        entries.problem(("uncertainty", problem.key()), ProblemKind::Misplaced, message, problem.help());
    }
    Some(keys)
}

/// How risk weighs, and how many extra hops it may cost. Where errors are given, hops are traded for reliability unless the scenario says
/// otherwise: a path planned without regard to them stands on the edge of its limits. A budget of success weighs errors of 0 as well.
pub(super) fn risk(entries: &mut Entries, uncertainty: Option<&UncertaintyKeys>, budget: Budget) -> (ReliabilityUse, Option<u32>) {
    let is_estimated = uncertainty.is_some() && budget.estimated_success_min.is_some();
    let absent = if is_estimated || has_errors(uncertainty) { ReliabilityUse::Traded } else { ReliabilityUse::Ignored };
    let given = super::read::find(&ReliabilityUse::ALL, ReliabilityUse::name, entries.text("search", "risk"));
    let risk = given.unwrap_or(absent);
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
    uncertainty.is_some_and(|keys| keys.errors != Uncertainty::NONE)
}

impl Scenario {
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
            errors: keys.errors,
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
