//! How reliably a free route over a mesh is flown.

use std::ops::Range;

#[cfg(feature = "plot")]
use super::simulate::trials_picture;
use super::{
    MeshRouted, PartsProblem, SimulateOptions, TrialGround,
    simulate::{by_policy, merged},
};
#[cfg(feature = "plot")]
use crate::figure::{FigureError, Picture};
use crate::{
    chain::ConstraintProblem,
    progress::Progress,
    quantity::format_number,
    report::{MeshSimulateAnswer, SimulationRecord, SuccessRequirement},
    scenario::Scenario,
    uncertainty::{Observer, Policy, Simulation, SimulationError, Summary, Tally, TrialOptions},
    world::FrictionCone,
};

/// Why there are no trials over a mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshTrialsError {
    /// A ball, whose first contact is not that of its centre.
    #[error(
        "found hopper.radius_m of {} m, expected a point for trials over a mesh, which follow its first contact: set hopper.radius_m = 0; the \
         path of the ball is planned and flown again without errors", format_number(*.radius_m)
    )]
    Ball {
        /// The radius, m.
        radius_m: f64,
    },
    /// The surface states no grip, or the hopper no speeds.
    #[error(transparent)]
    Constraints(#[from] ConstraintProblem),
    /// The trials.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Tallies that are not those of the run.
    #[error(transparent)]
    Parts(#[from] PartsProblem),
}

/// The trials of a plan over a mesh, with everything that their views need.
#[derive(Clone, Debug)]
pub struct MeshSimulated {
    /// The plan.
    pub routed: MeshRouted,
    /// The results, policy by policy; empty without a path.
    pub summaries: Vec<Summary>,
    /// The tallies, policy by policy; empty unless they were wanted.
    pub tallies: Vec<Tally>,
    /// The answer as plain data.
    pub answer: MeshSimulateAnswer,
    /// The warnings about the plan and the trials.
    pub warnings: Vec<String>,
}

#[cfg(feature = "plot")]
impl MeshSimulated {
    /// The sheet with the landing errors and the outcomes of the trials; `None` if nothing was flown.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self, scenario: &Scenario) -> Option<Result<Picture, FigureError>> {
        (!self.summaries.is_empty()).then(|| trials_picture(scenario, &self.summaries, None))
    }
}

/// Flies a plan over a mesh under the errors of its scenario, to the first contact of every flight with any facet. A hop that is planned anew
/// leads to the contact of the roadmap with the fewest hops to the goal that one hop reaches. Without a path nothing is flown, and the
/// answer says so.
///
/// # Errors
/// [`MeshTrialsError`].
pub fn simulate_over_mesh(
    routed: MeshRouted,
    scenario: &Scenario,
    options: &SimulateOptions,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<MeshSimulated, MeshTrialsError> {
    refuse_ball(&routed)?;
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let policies = if options.compare { Policy::ALL.to_vec() } else { vec![keys.policy] };
    let mut warnings = routed.warnings.clone();
    let (mut summaries, mut tallies) = (Vec::new(), Vec::new());
    if let Some(mission) = routed.mission(scenario)? {
        warnings.extend(scenario.trial_warnings(&policies, &trial_ground(&routed, scenario)));
        let simulation = Simulation::new(&mission, keys.errors.clone())?;
        let SimulateOptions { until_half_width, first_trial, tally, .. } = *options;
        let trials = TrialOptions { first_trial, until_half_width, ..keys.options() };
        (summaries, tallies) = by_policy(&simulation, &policies, (trials, tally), observer, progress)?;
    }
    Ok(answered(routed, keys.policy, options, (summaries, tallies), warnings))
}

/// Flies the trials of a range of numbers over a mesh, as a tally that merges with those of other ranges.
///
/// # Returns
/// `None` without a path to fly.
///
/// # Errors
/// [`MeshTrialsError`].
pub fn tally_over_mesh(
    routed: &MeshRouted,
    scenario: &Scenario,
    numbers: Range<u64>,
    progress: &dyn Progress,
) -> Result<Option<Tally>, MeshTrialsError> {
    refuse_ball(routed)?;
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let Some(mission) = routed.mission(scenario)? else { return Ok(None) };
    let trials = numbers.end.saturating_sub(numbers.start);
    let options = TrialOptions { first_trial: numbers.start, trials, policy: keys.policy, ..keys.options() };
    let simulation = Simulation::new(&mission, keys.errors.clone())?;
    Ok(Some(simulation.tally(&options, &mut (), progress)?))
}

/// The answer of trials over a mesh that were flown in parts, by their tallies, as [`Trials::merged`](super::Trials::merged) gives it.
///
/// # Errors
/// [`MeshTrialsError::Parts`] for tallies of another run, and for trials that are missing or counted twice.
pub fn merged_over_mesh(
    routed: MeshRouted,
    scenario: &Scenario,
    options: &SimulateOptions,
    tallies: &[Tally],
    progress: &dyn Progress,
) -> Result<MeshSimulated, MeshTrialsError> {
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let first = options.first_trial;
    let Some(own) = tally_over_mesh(&routed, scenario, first..first + 1, progress)? else {
        return Err(PartsProblem::NoPath.into());
    };
    let tally = merged(tallies, &own, (first, keys.options().trials))?;
    let mut warnings = routed.warnings.clone();
    warnings.extend(scenario.trial_warnings(&[keys.policy], &trial_ground(&routed, scenario)));
    Ok(answered(routed, keys.policy, options, (vec![tally.summary()], vec![tally]), warnings))
}

fn refuse_ball(routed: &MeshRouted) -> Result<(), MeshTrialsError> {
    let radius_m = routed.ground.radius_m();
    if radius_m > 0.0 { Err(MeshTrialsError::Ball { radius_m }) } else { Ok(()) }
}

/// The answer of trials under some policies, of which that of the scenario counts.
fn answered(
    routed: MeshRouted,
    own: Policy,
    options: &SimulateOptions,
    (summaries, tallies): (Vec<Summary>, Vec<Tally>),
    warnings: Vec<String>,
) -> MeshSimulated {
    let hops = routed.path.as_ref().map_or(0, |path| path.hops.len());
    let records: Vec<_> = summaries.iter().map(|summary| SimulationRecord::new(summary, hops)).collect();
    let simulation = records.iter().find(|record| record.policy == own).cloned();
    let compare = if records.len() > 1 { records } else { Vec::new() };
    let requirement = options.success_min.map(|success_min| SuccessRequirement::of(success_min, simulation.as_ref()));
    let answer = MeshSimulateAnswer { plan: routed.answer.clone(), simulation, compare, requirement };
    MeshSimulated { routed, summaries, tallies, answer, warnings }
}

/// What the warnings about trials need to know of the mesh.
fn trial_ground(routed: &MeshRouted, scenario: &Scenario) -> TrialGround {
    let mesh = routed.ground.tree().mesh();
    let bounds = mesh.bounds();
    let ends = [routed.grown.ends.0, routed.grown.ends.1].map(|node| routed.grown.roadmap.contact(node).point_m());
    let is_one = scenario.groups.is_empty() && mesh.faces().are_bare();
    // The frictions of groups of faces are not looked through.
    let friction = if is_one { scenario.surface.constant_friction().map(FrictionCone::coefficient) } else { Some(f64::INFINITY) };
    TrialGround {
        friction_max: friction,
        extent_m: (bounds.map.max - bounds.map.min).norm(),
        journey_m: Some((ends[1] - ends[0]).norm()),
        hops: routed.path.as_ref().map_or(0, |path| path.hops.len()),
    }
}
