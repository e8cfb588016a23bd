//! What would help after a low success rate, from how the trials ended.

use crate::{
    ballistics::TakeoffChoice,
    graph::ReliabilityUse,
    path::Hop,
    planner::Amount,
    quantity::format_number,
    report::AdviceRecord,
    scenario::Route,
    study::Planned,
    uncertainty::{ErrorKey, Policy, Summary, TrialOptions, TrialOutcome},
};

/// A success rate below this gets advice.
const LOW: f64 = 0.9;

/// At most so many keys: the first helps most.
const MOST: usize = 3;

/// The keys that would help most against what failed most often; none after a success rate of at least 0.9.
///
/// Keys of planning come first, since they cost nothing but hops; then what the machine or the goal would have to be.
pub(super) fn advice(planned: &Planned, summary: &Summary) -> Vec<AdviceRecord> {
    let failures = summary.outcomes.each().filter(|(outcome, _)| *outcome != TrialOutcome::Reached);
    let most = failures.max_by_key(|(outcome, count)| (*count, std::cmp::Reverse(*outcome)));
    let Some((outcome, _)) = most.filter(|(_, count)| summary.success.rate < LOW && *count > 0) else { return Vec::new() };
    let advisor = Advisor { planned, summary };
    let all = match outcome {
        TrialOutcome::Reached => Vec::new(),
        TrialOutcome::Missed => {
            [advisor.policy(), advisor.risk(), advisor.takeoff_angle(), advisor.error(), advisor.tolerance()].into()
        }
        TrialOutcome::SlidAtTakeoff | TrialOutcome::SlidAtLanding => {
            [advisor.takeoff_angle(), advisor.risk(), advisor.policy(), advisor.friction()].into()
        }
        TrialOutcome::Damaged => [advisor.takeoff_angle(), advisor.risk(), advisor.policy(), Some(advisor.landing_speed())].into(),
        TrialOutcome::Lost => [advisor.takeoff_angle(), advisor.risk(), advisor.policy(), advisor.error()].into(),
        TrialOutcome::Stuck => [advisor.takeoff_angle(), advisor.risk(), advisor.error()].into(),
        TrialOutcome::HopLimit => vec![advisor.hop_limit()],
        TrialOutcome::OutOfPropellant => vec![advisor.propellant()],
    };
    all.into_iter().flatten().take(MOST).collect()
}

struct Advisor<'a> {
    planned: &'a Planned,
    summary: &'a Summary,
}

fn record(key: &str, found: impl Into<String>, value: Option<&str>, reason: impl Into<String>) -> AdviceRecord {
    AdviceRecord { key: key.to_owned(), found: found.into(), value: value.map(str::to_owned), reason: reason.into() }
}

impl Advisor<'_> {
    fn hops(&self) -> &[Hop] {
        self.planned.path.as_ref().map_or(&[], |path| &path.hops)
    }

    fn policy(&self) -> Option<AdviceRecord> {
        let of_many = self.summary.policy == Policy::OpenLoop && self.hops().len() > 1;
        of_many.then(|| {
            let reason = "open loop the errors of all landings add up; a replanned hop begins where the hopper believes to be";
            record("uncertainty.policy", "\"open-loop\"", Some("\"replan\""), reason)
        })
    }

    fn takeoff_angle(&self) -> Option<AdviceRecord> {
        let scenario = &self.planned.case.scenario;
        // The choice is that of the search, which weighs reliability.
        let weighs = scenario.risk != ReliabilityUse::Ignored;
        (weighs && scenario.search.takeoff != TakeoffChoice::MostReliable).then(|| {
            let found = format!("\"{}\"", scenario.search.takeoff.name());
            record(
                "search.takeoff_angle",
                found,
                Some("\"most-reliable\""),
                "of all angles the one that the most draws of the errors survive",
            )
        })
    }

    fn risk(&self) -> Option<AdviceRecord> {
        let scenario = &self.planned.case.scenario;
        if scenario.plans_by_objective() {
            let objective = scenario.full_objective();
            let reason = "a path of least amounts stands on the edge of its limits: without an objective and budgets of totals the plan \
                          weighs reliability";
            return (!objective.amounts().contains(&Amount::Risk))
                .then(|| record("search.objective", objective.to_string(), None, reason));
        }
        let risk = scenario.risk;
        (risk != ReliabilityUse::Traded).then(|| {
            let reason = match scenario.route {
                Route::Transect => {
                    "more hops, each farther from its limits; without search.takeoff_angle the angles are then the most reliable"
                }
                // Its search does not weigh reliability.
                Route::Free => {
                    "a robot that replans then weighs reliability; without search.takeoff_angle the angles are the most reliable"
                }
            };
            record("search.risk", format!("\"{}\"", risk.name()), Some("\"traded\""), reason)
        })
    }

    /// The error of the take-off that scatters landings most, on flat ground: the range is `v^2 sin(2 theta) / g`.
    fn error(&self) -> Option<AdviceRecord> {
        let errors = self.planned.case.scenario.uncertainty.as_ref()?.errors.clone();
        let last = self.hops().last()?;
        let (range_m, speed_m_s, twice_rad) = (last.run_m(), last.takeoff_speed_m_s, 2.0 * last.takeoff_angle.radians());
        let of_angle = (2.0 * range_m * libm::cos(twice_rad) / libm::sin(twice_rad)).abs() * errors.takeoff_angle_sigma.radians();
        let scatters = [
            (ErrorKey::TakeoffSpeedFraction, 2.0 * range_m * errors.takeoff_speed_sigma_fraction),
            (ErrorKey::TakeoffSpeed, 2.0 * range_m / speed_m_s * errors.takeoff_speed_sigma_m_s),
            (ErrorKey::TakeoffAngle, of_angle),
            (ErrorKey::Heading, range_m * errors.heading_sigma.radians()),
            (ErrorKey::DriftAlong, errors.drift_along_sigma_m),
            (ErrorKey::DriftAcross, errors.drift_across_sigma_m),
            (ErrorKey::Position, errors.position_sigma_m),
        ];
        let (key, scatter_m) = scatters.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, scatter_m)| *scatter_m > 0.0)?;
        let (_, sigma, _) = errors.by_key().into_iter().find(|(name, ..)| *name == key.name())?;
        let reason = format!("a smaller error helps: it alone scatters the last landing by some {scatter_m:.2} m");
        Some(record(&format!("uncertainty.{key}"), format_number(sigma), None, reason))
    }

    fn tolerance(&self) -> Option<AdviceRecord> {
        let missed_m = self.summary.missed_m.quantile(0.5)?;
        let tolerance_m = self.planned.case.scenario.uncertainty.as_ref()?.goal_tolerance_m;
        let reason = format!("half of the trials that stop off the goal are within {missed_m:.2} m of it");
        Some(record("uncertainty.goal_tolerance_m", format_number(tolerance_m), None, reason))
    }

    fn friction(&self) -> Option<AdviceRecord> {
        let friction = self.planned.case.scenario.surface.constant_friction()?;
        let reason = "a greater one widens the cones of take-off and landing: feet with a better hold, or other ground";
        Some(record("surface.friction_coefficient", format_number(friction.coefficient()), None, reason))
    }

    fn landing_speed(&self) -> AdviceRecord {
        let max_m_s = self.planned.case.scenario.hopper.limits().landing_speed_max_m_s;
        let reason = "a machine that withstands faster landings; the path may then take faster ones";
        record("hopper.landing_speed_max_m_s", format_number(max_m_s), None, reason)
    }

    fn hop_limit(&self) -> Option<AdviceRecord> {
        let hops = self.hops().len();
        let limit =
            self.planned.case.scenario.uncertainty.as_ref()?.hop_limit.unwrap_or_else(|| TrialOptions::default_hop_limit(hops));
        let reason = format!("a greater one lets trials go on: the path has {hops} hops, and replanning takes more");
        Some(record("uncertainty.hop_limit", limit.to_string(), None, reason))
    }

    fn propellant(&self) -> Option<AdviceRecord> {
        let max_kg = self.planned.case.scenario.hopper.limits().propellant_max_kg?;
        let reason = "with more of it, hops that replanning and errors add can be flown";
        Some(record("hopper.propellant_max_kg", format_number(max_kg), None, reason))
    }
}
