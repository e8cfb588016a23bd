//! How reliably a robot with legs makes its planned hops.

use super::{LegsRouted, SimulateOptions, stance::with_robot};
use crate::{
    ground::{NoFriction, StanceGround, StanceMap},
    progress::Progress,
    report::{LegsSimulateAnswer, LegsTrialsRecord, SuccessRequirement},
    scenario::Scenario,
    uncertainty::{LegsMission, Policy, SimulationError, TrialOptions},
};

/// Why there are no trials.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LegsTrialsError {
    /// A robot that is a point.
    #[error(
        "the robot is a point without a trunk, expected legs for trials of its stances: remove robot.file, whose trials are those of a hopper"
    )]
    Point,
    /// The surface states no grip, or the hopper no speeds.
    #[error(transparent)]
    Constraints(#[from] crate::chain::ConstraintProblem),
    /// The surface states no friction.
    #[error(transparent)]
    NoFriction(#[from] NoFriction),
    /// The trials.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// The trials of a robot with legs, with everything that their views need.
#[derive(Clone, Debug)]
pub struct LegsSimulated {
    /// The plan.
    pub routed: LegsRouted,
    /// The answer as plain data.
    pub answer: LegsSimulateAnswer,
    /// Warnings about the plan and the trials.
    pub warnings: Vec<String>,
}

/// Makes the trials of a plan under the errors of its scenario. Without a path nothing is tried, and the answer says so.
///
/// # Errors
/// [`LegsTrialsError`].
pub fn simulate_legs(
    routed: LegsRouted,
    scenario: &Scenario,
    options: &SimulateOptions,
    progress: &dyn Progress,
) -> Result<LegsSimulated, LegsTrialsError> {
    if routed.ground.is_point() {
        return Err(LegsTrialsError::Point);
    }
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let policies = if options.compare { Policy::ALL.to_vec() } else { vec![keys.policy] };
    let mut warnings = routed.warnings.clone();
    let mut records: Vec<LegsTrialsRecord> = Vec::new();
    if let Some(mission) = mission(&routed, scenario)? {
        warnings.extend(left_out(scenario));
        let SimulateOptions { until_half_width, first_trial, .. } = *options;
        let trials = TrialOptions { first_trial, until_half_width, ..keys.options() };
        for policy in &policies {
            let summary = mission.run(&keys.errors, &TrialOptions { policy: *policy, ..trials }, progress)?;
            records.push((&summary).into());
        }
    }
    let simulation = records.iter().find(|record| record.policy == keys.policy).cloned();
    let compare = if records.len() > 1 { records } else { Vec::new() };
    let shown = simulation.as_ref().map(|record| record.success_ci95[0]);
    let requirement = options.success_min.map(|success_min| SuccessRequirement::of_low(success_min, shown));
    let answer = LegsSimulateAnswer { plan: routed.answer.clone(), simulation, compare, requirement };
    Ok(LegsSimulated { routed, answer, warnings })
}

/// The path as a mission, with the whole limits of a scenario; `None` without one.
fn mission(routed: &LegsRouted, scenario: &Scenario) -> Result<Option<LegsMission>, LegsTrialsError> {
    let Some(found) = &routed.grown.route.path else { return Ok(None) };
    let planning = &routed.ground;
    let hopper = with_robot(&scenario.hopper, planning.robot()).with_any_command();
    let mesh = planning.mesh().under(&hopper, scenario.body.gravity, &scenario.surface)?;
    let whole =
        StanceGround::new(mesh, planning.robot().clone(), crate::ballistics::stance::ConeKind::Exact, planning.stands_up())?;
    let whole = match &routed.map {
        Some(map) => whole.with_map(StanceMap::new(map.clone())),
        None => whole,
    };
    let roadmap = &routed.grown.roadmap;
    let hops = roadmap.hops_to(routed.grown.ends.1).into_iter().enumerate();
    let mut aims: Vec<_> = hops.filter_map(|(node, hops)| Some((roadmap.contact(node).clone(), hops?))).collect();
    aims.sort_by_key(|(_, hops)| *hops);
    let walking = routed.walking.as_ref().map(|walking| walking.in_trials(routed, scenario)).transpose();
    let walking = walking.map_err(SimulationError::from)?;
    Ok(Some(LegsMission {
        whole,
        planning: planning.clone(),
        stances: found.contacts.iter().map(|node| roadmap.contact(*node).clone()).collect(),
        moves: found.moves.clone(),
        aims,
        walking,
        takeoff: scenario.search.takeoff,
    }))
}

/// What the trials leave out of a scenario.
fn left_out(scenario: &Scenario) -> Vec<String> {
    let mut warnings = Vec::new();
    let errors = scenario.uncertainty.as_ref().map(|keys| &keys.errors);
    if errors.is_none_or(crate::uncertainty::Uncertainty::is_none) {
        let stated = match scenario.drives() {
            None => Some("[uncertainty] states no error"),
            Some(keys) => keys.rover.limits().is_exact().then_some("neither [uncertainty] nor [drive] states an error"),
        };
        warnings.extend(
            stated
                .map(|stated| format!("{stated}: every trial is the plan itself, and its success says nothing about reliability")),
        );
    }
    if errors.is_some_and(|errors| errors.height_sigma_m > 0.0 || errors.friction_sigma > 0.0) {
        warnings.push(
            "trials of a robot with legs have the ground and the friction as they are known: height_sigma_m and friction_sigma of [uncertainty] \
             change nothing"
                .to_owned(),
        );
    }
    if scenario.drives().is_some() {
        warnings.push(
            "a robot with legs that walks stands at the end of a walk in the planned orientation, as high over the ground as planned: of its walks \
             heading and length have errors, as [drive] states them"
                .to_owned(),
        );
    }
    if scenario.hopper.limits().restitution.is_some() {
        warnings.push("a robot with legs does not bounce in trials: [contact] changes nothing".to_owned());
    }
    warnings
}
