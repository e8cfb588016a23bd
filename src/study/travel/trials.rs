//! How reliably a mission that drives and hops is travelled.

use super::{
    super::{JourneyError, SimulateOptions, dem_ground::dem_ground},
    plan::TravelPlanned,
    search::TravelSearch,
    walk::Stretch,
};
use crate::{
    planner::TotalBudget,
    progress::Progress,
    report::{SuccessRequirement, TravelSimulateAnswer, TravelTrialsRecord},
    scenario::Scenario,
    uncertainty::{Policy, TravelMission, TravelMove, TrialOptions},
};

/// The trials of a mission, with everything that their views need.
#[derive(Clone, Debug)]
pub struct TravelSimulated {
    /// The plan.
    pub planned: TravelPlanned,
    /// The answer as plain data.
    pub answer: TravelSimulateAnswer,
    /// Warnings about the plan and the trials.
    pub warnings: Vec<String>,
}

/// Makes the trials of a planned mission under the errors of its scenario. Without a path nothing is tried, and the answer says so.
///
/// # Errors
/// [`JourneyError`].
pub fn travel_simulate(
    planned: TravelPlanned,
    options: &SimulateOptions,
    progress: &dyn Progress,
) -> Result<TravelSimulated, JourneyError> {
    let scenario = planned.case.scenario.clone();
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let policies = if options.compare { Policy::ALL.to_vec() } else { vec![keys.policy] };
    let mut warnings = planned.warnings.clone();
    let mut records = Vec::new();
    if let Some((mut mission, legs)) = mission(&planned)? {
        if policies.contains(&Policy::Replan) {
            mission.to_go = Some(TravelSearch::of(&planned.case)?.into_to_go(progress)?);
        }
        warnings.extend(left_out(&scenario));
        let SimulateOptions { until_half_width, first_trial, .. } = *options;
        let trials = TrialOptions { first_trial, until_half_width, ..keys.options() };
        for policy in &policies {
            let trials = TrialOptions { policy: *policy, ..trials };
            let summary = mission.run(&keys.errors, &trials, progress).map_err(|error| Box::new(error.into()))?;
            // The moves of a robot that replans are not those of the plan.
            let of_plan = |number: usize| number.checked_sub(1).and_then(|number| legs.get(number)).copied().unwrap_or(0);
            let leg_of: Option<&dyn Fn(usize) -> usize> = (*policy == Policy::OpenLoop).then_some(&of_plan);
            records.push(TravelTrialsRecord::new(&summary, leg_of));
        }
    }
    let simulation = records.iter().find(|record| record.policy == keys.policy).cloned();
    let compare = if records.len() > 1 { records } else { Vec::new() };
    let shown = simulation.as_ref().map(|record| record.success_ci95[0]);
    let requirement = options.success_min.map(|success_min| SuccessRequirement::of_low(success_min, shown));
    let answer = TravelSimulateAnswer { plan: planned.answer.clone(), simulation, compare, requirement };
    Ok(TravelSimulated { planned, answer, warnings })
}

/// The moves of a plan, and the number of the leg that each belongs to; `None` without a path.
fn mission(planned: &TravelPlanned) -> Result<Option<(TravelMission, Vec<usize>)>, JourneyError> {
    let Some(path) = &planned.mission.path else { return Ok(None) };
    let Some(keys) = &planned.case.scenario.drive else { return Ok(None) };
    let whole = dem_ground(&planned.case).map_err(Box::new)?.unwrap_or_else(|| planned.ground.clone());
    let mut places = path.places.windows(2);
    let (mut moves, mut legs, mut leg) = (Vec::new(), Vec::new(), 0);
    for stretch in &planned.stretches {
        match stretch {
            Stretch::Drive(driven) => {
                leg += 1;
                for pair in places.by_ref().take(driven.legs.len()) {
                    moves.push(TravelMove::Drive { from: pair[0], to: pair[1] });
                    legs.push(leg);
                }
            }
            Stretch::Hops(hops) => {
                for (hop, pair) in hops.hops.iter().zip(places.by_ref()) {
                    leg += 1;
                    moves.push(TravelMove::Hop { hop: Box::new(*hop), from: pair[0], to: pair[1] });
                    legs.push(leg);
                }
            }
        }
    }
    let goal = path.places[path.places.len() - 1];
    let takeoff = planned.case.scenario.search.takeoff;
    let mission =
        TravelMission { whole, planning: planned.ground.clone(), rover: keys.rover.clone(), moves, goal, takeoff, to_go: None };
    Ok(Some((mission, legs)))
}

/// What the trials leave out of a scenario.
fn left_out(scenario: &Scenario) -> Vec<String> {
    let mut warnings = Vec::new();
    let is_exact = scenario.drive.as_ref().is_none_or(|keys| keys.rover.limits().is_exact());
    if scenario.uncertainty.as_ref().is_none_or(|keys| keys.errors.is_none()) && is_exact {
        warnings.push(
            "neither [uncertainty] nor [drive] states an error: every trial is the plan itself, and its success says nothing about reliability"
                .to_owned(),
        );
    }
    if scenario.uncertainty.as_ref().is_some_and(|keys| keys.errors.height_sigma_m > 0.0) {
        warnings.push(
            "uncertainty.height_sigma_m changes the ground of hops alone: wheels are judged over the map as it is known".to_owned(),
        );
    }
    if scenario.hopper.limits().propellant_max_kg.is_some() {
        warnings.push("trials of missions do not count propellant: hopper.propellant_max_kg is kept by the plan alone".to_owned());
    }
    let unlimited: Vec<&str> = scenario.budget.totals(&scenario.hopper).iter().map(|TotalBudget { key, .. }| *key).collect();
    if !unlimited.is_empty() {
        warnings.push(format!("trials of missions count no budgets: {} limit the plan alone", unlimited.join(", ")));
    }
    warnings
}
