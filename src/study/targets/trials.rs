//! How reliably a mission over targets is flown as a whole.

use super::super::{
    Case, JourneyError, SimulateError, SimulateOptions, TrialGround, dem_ground::dem_ground, free_route::FoundRoute,
    front::FlownJourney, simulate::by_policy,
};
use super::plan::{FlownLeg, TargetsPlanned};
use crate::{
    ground::DemGround,
    progress::Progress,
    report::{SimulationRecord, SuccessRequirement, TargetsSimulateAnswer, VisitedRecord},
    uncertainty::{HopRecord, Observer, Policy, Simulation, TrialOptions, TrialRecord, Wilson},
};

/// The trials of a mission over targets, with everything that their views need.
#[derive(Clone, Debug)]
pub struct TargetsSimulated {
    /// The plan.
    pub planned: TargetsPlanned,
    /// The answer as plain data.
    pub answer: TargetsSimulateAnswer,
    /// Warnings about the plan and the trials.
    pub warnings: Vec<String>,
}

/// Counts, by policy, the trials that reach each stop, and passes all on.
struct Stops<'o> {
    policies: Vec<(Policy, Vec<u64>)>,
    count: usize,
    then: &'o mut dyn Observer,
}

impl Observer for Stops<'_> {
    fn wants_records(&self) -> bool {
        true
    }

    fn begin(&mut self, policy: Policy) {
        self.policies.push((policy, vec![0; self.count]));
        self.then.begin(policy);
    }

    fn hop(&mut self, hop: &HopRecord) {
        self.then.hop(hop);
    }

    fn trial(&mut self, trial: &TrialRecord) {
        let reached = self.policies.last_mut().into_iter().flat_map(|(_, counts)| counts);
        reached.take(trial.stops as usize).for_each(|count| *count += 1);
        self.then.trial(trial);
    }
}

/// Flies the trials of a planned mission under the errors of its scenario: each flies all legs, one after the other, from wherever the one
/// before has brought it. Without a path nothing is flown, and the answer says so.
///
/// # Errors
/// [`JourneyError`].
pub fn targets_simulate(
    planned: TargetsPlanned,
    options: &SimulateOptions,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<TargetsSimulated, JourneyError> {
    let scenario = planned.case.scenario.clone();
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let policies = if options.compare { Policy::ALL.to_vec() } else { vec![keys.policy] };
    let mut warnings = planned.warnings.clone();
    let mut records = Vec::new();
    let mut stops = Stops { policies: Vec::new(), count: planned.legs.len(), then: observer };
    if let Some(path) = planned.path() {
        let ground = TrialGround::of_chain(&scenario, &planned.case.prepared, path.hops.len());
        warnings.extend(scenario.trial_warnings(&policies, &ground));
        let simulation = simulation(&planned, &policies, progress)?;
        let SimulateOptions { until_half_width, first_trial, .. } = *options;
        let trials = TrialOptions { first_trial, until_half_width, ..keys.options() };
        let (summaries, _) = by_policy(&simulation, &policies, (trials, false), &mut stops, progress)
            .map_err(|error| Box::new(SimulateError::from(error)))?;
        records = summaries.iter().map(|summary| SimulationRecord::new(summary, path.hops.len())).collect();
    }
    let simulation = records.iter().find(|record| record.policy == keys.policy).cloned();
    let visited = visited(&planned, &stops.policies, simulation.as_ref());
    let compare = if records.len() > 1 { records } else { Vec::new() };
    let requirement = options.success_min.map(|success_min| SuccessRequirement::of(success_min, simulation.as_ref()));
    let answer = TargetsSimulateAnswer { plan: planned.answer.clone(), simulation, visited, compare, requirement };
    Ok(TargetsSimulated { planned, answer, warnings })
}

/// The share of trials that reach each stop, under the policy of the scenario.
fn visited(planned: &TargetsPlanned, policies: &[(Policy, Vec<u64>)], simulation: Option<&SimulationRecord>) -> Vec<VisitedRecord> {
    let Some(record) = simulation else { return Vec::new() };
    let counts = policies.iter().find(|(policy, _)| *policy == record.policy).map_or(&[][..], |(_, counts)| counts);
    let row = |(leg, count): (&crate::planner::TourLeg, &u64)| {
        let share = Wilson::of(*count, record.trials);
        VisitedRecord {
            target: (leg.to > 0).then_some(leg.to),
            trials: *count,
            reached_share: share.rate,
            reached_share_ci95: [share.low, share.high],
        }
    };
    planned.tour.legs.iter().zip(counts).map(row).collect()
}

/// The trials of all legs, one after the other.
fn simulation(planned: &TargetsPlanned, policies: &[Policy], progress: &dyn Progress) -> Result<Simulation, JourneyError> {
    let ground = dem_ground(&planned.case).map_err(Box::new)?;
    let mut whole: Option<Simulation> = None;
    for leg in &planned.legs {
        let next = of_leg(leg, ground.as_ref(), policies, progress).map_err(Box::new)?;
        whole = Some(match whole {
            Some(before) => before.followed_by(next).map_err(|error| Box::new(SimulateError::from(error)))?,
            None => next,
        });
    }
    // A path has legs.
    whole.ok_or_else(|| super::super::CaseError::NoTargets.into())
}

fn of_leg(
    FlownLeg { route, to_go }: &FlownLeg,
    ground: Option<&DemGround>,
    policies: &[Policy],
    progress: &dyn Progress,
) -> Result<Simulation, SimulateError> {
    let FoundRoute { case, test, ends, found, path, .. } = route.as_ref();
    let Case { scenario, .. } = case;
    let journey = FlownJourney { scenario, test, whole: case.whole_test(), ends: *ends, ground };
    let path = path.as_ref().ok_or(super::super::CaseError::NoTargets)?;
    let to_go = match to_go {
        Some(known) => Some(known.clone()),
        None if policies.contains(&Policy::Replan) => {
            let options = scenario.uncertainty.clone().unwrap_or_default().options();
            journey.to_go_of(found, path, &options, progress)?
        }
        None => None,
    };
    journey.simulation(path, to_go.as_ref())
}
