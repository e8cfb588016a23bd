//! How reliably a planned path is flown.

mod advice;
mod drift;
mod flyer;
mod parts;
#[cfg(feature = "plot")]
mod pictures;

use std::{
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use advice::advice;
pub use drift::{Drift, Drifted};
pub(super) use flyer::Flyer;
pub use parts::PartsProblem;
pub(super) use parts::merged;
#[cfg(feature = "plot")]
pub(super) use pictures::trials_picture;

use super::{CaseError, Planned, TrialGround, dem_ground::dem_ground};
use crate::{
    graph::{NodesError, SearchError},
    ground::DemGround,
    progress::{Cancelled, Progress},
    report::{HopRecord, SimulateAnswer, SimulationRecord},
    terrain::{Dem, TerrainError, read_keep_out},
    uncertainty::{Observer, Policy, RestDensity, Simulation, SimulationError, Summary, Tally, TrialOptions},
};

/// How many trials are kept with all their hops, for the pictures.
const KEPT_TRIALS: u64 = 300;

/// What is wanted beyond the keys of `[uncertainty]`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SimulateOptions {
    /// Both policies on the same draws, instead of the scenario's alone.
    pub compare: bool,
    /// Stop once half the width of the success rate's 95 % interval is at most this.
    pub until_half_width: Option<f64>,
    /// The number of the first trial: trials flown in ranges give the answer of the whole, once their tallies are merged.
    pub first_trial: u64,
    /// The success, above 0 and at most 1, that the trials have to show: the lower end of the 95 % interval is to be at least this.
    pub success_min: Option<f64>,
    /// Whether the tallies of the trials are kept.
    pub tally: bool,
}

/// Why there is no simulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// The raster that is flown over.
    #[error("{}: {problem}", file.display())]
    Dem {
        /// Its file.
        file: PathBuf,
        /// The problem.
        problem: Box<TerrainError>,
    },
    /// The nodes of the replanning policy.
    #[error(transparent)]
    Nodes(#[from] NodesError),
    /// The replanning policy.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A question that trials do not answer.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The area whose share is asked for.
    #[error(transparent)]
    Area(TerrainError),
    /// The trials.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Tallies that are not those of the run.
    #[error(transparent)]
    Parts(#[from] PartsProblem),
}

impl From<Cancelled> for SimulateError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Search(cancelled.into())
    }
}

/// The trials of a plan, before they are flown.
#[derive(Clone, Debug)]
pub struct Trials {
    planned: Arc<Planned>,
    policies: Vec<Policy>,
    options: TrialOptions,
    success_min: Option<f64>,
    tally: bool,
    warnings: Vec<String>,
}

/// The trials of a plan, with everything that their views need.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// The plan.
    pub planned: Arc<Planned>,
    /// The results, policy by policy; empty without a path.
    pub summaries: Vec<Summary>,
    /// The tallies, policy by policy; empty unless they were wanted.
    pub tallies: Vec<Tally>,
    /// The answer as plain data.
    pub answer: SimulateAnswer,
    /// The warnings about the trials: settings without effect, deviations beyond sense.
    pub warnings: Vec<String>,
    /// The raster flown over with its overlays, if the terrain is one.
    ground: Option<DemGround>,
}

/// The planned hops as the answer lists them: the same, whether or not the plan was estimated.
fn planned_rows(planned: &Planned) -> Vec<HopRecord> {
    planned.answer.path.iter().map(|hop| HopRecord { margins_sigma: None, success_estimated: None, ..hop.clone() }).collect()
}

/// Trials policy by policy on the same draws; with their tallies, if they are wanted.
pub(super) fn by_policy(
    simulation: &Simulation,
    policies: &[Policy],
    (options, tally): (TrialOptions, bool),
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<(Vec<Summary>, Vec<Tally>), SimulationError> {
    let (mut summaries, mut tallies) = (Vec::new(), Vec::new());
    for policy in policies {
        let options = TrialOptions { policy: *policy, ..options };
        if tally {
            let (summary, tally) = simulation.run_and_tally(&options, observer, progress)?;
            summaries.push(summary);
            tallies.push(tally);
        } else {
            summaries.push(simulation.run(&options, observer, progress)?);
        }
    }
    Ok((summaries, tallies))
}

/// Counts of where trials over a DEM rest, of which none is flown yet. `area`: a file of zones whose share is asked for.
fn density_over(ground: &DemGround, hops: usize, area: Option<&Path>) -> Result<RestDensity, SimulateError> {
    let dem = ground.terrain().dem();
    let read = |path: &Path| {
        read_keep_out(path, Some(&dem.georeference().coordinate_system), dem.bounds()).map_err(|error| match error {
            TerrainError::Overlay { path, problem, .. } => TerrainError::Overlay { what: "area", path, problem },
            other => other,
        })
    };
    let area = area.map(read).transpose().map_err(SimulateError::Area)?;
    Ok(RestDensity::over(ground, hops, area))
}

/// Flies the trials of a plan under the errors of its scenario. Without a path nothing is flown, and the answer says so.
///
/// # Errors
/// [`SimulateError`].
pub fn simulate(
    planned: &Arc<Planned>,
    options: &SimulateOptions,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<Simulated, SimulateError> {
    Trials::new(planned, options).fly(observer, progress)
}

impl Trials {
    /// The trials of a plan, with the warnings about them. Nothing is read or flown yet.
    pub fn new(planned: &Arc<Planned>, options: &SimulateOptions) -> Self {
        let scenario = &planned.case.scenario;
        let keys = scenario.uncertainty.clone().unwrap_or_default();
        let policies = if options.compare { Policy::ALL.to_vec() } else { vec![keys.policy] };
        let warnings = planned.path.as_ref().map(|path| {
            let ground = TrialGround::of_chain(scenario, &planned.case.prepared, path.hops.len());
            scenario.trial_warnings(&policies, &ground)
        });
        let SimulateOptions { compare: _, until_half_width, first_trial, success_min, tally } = *options;
        let options = TrialOptions { first_trial, until_half_width, trajectories: KEPT_TRIALS, ..keys.options() };
        Self { planned: Arc::clone(planned), policies, options, success_min, tally, warnings: warnings.unwrap_or_default() }
    }

    /// The warnings about them.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Counts of where they rest, for an observer: none yet. `area`: a file of zones whose share is asked for.
    ///
    /// # Returns
    /// `None` if they are not flown over a DEM.
    ///
    /// # Errors
    /// [`SimulateError::Dem`] and [`SimulateError::Area`].
    pub fn density(&self, area: Option<&Path>) -> Result<Option<RestDensity>, SimulateError> {
        let Some(ground) = dem_ground(&self.planned.case)? else { return Ok(None) };
        let hops = self.planned.path.as_ref().map_or(0, |path| path.hops.len());
        density_over(&ground, hops, area).map(Some)
    }

    /// Flies those of a range of numbers under the scenario's policy, as a tally that merges with those of other ranges: the trials of a
    /// campaign can be flown in parts, by several processes, and together give the answer of the whole to the byte.
    ///
    /// # Returns
    /// `None` without a path to fly.
    ///
    /// # Errors
    /// [`SimulateError`].
    pub fn tally(&self, numbers: Range<u64>, progress: &dyn Progress) -> Result<Option<Tally>, SimulateError> {
        let Some(path) = &self.planned.path else { return Ok(None) };
        let policy = self.planned.case.scenario.uncertainty.clone().unwrap_or_default().policy;
        let simulation = Flyer::new(&self.planned, &[policy], progress)?.simulation(path)?;
        let options = TrialOptions {
            policy,
            first_trial: numbers.start,
            trials: numbers.end.saturating_sub(numbers.start),
            until_half_width: None,
            trajectories: 0,
            ..self.options
        };
        Ok(Some(simulation.tally(&options, &mut (), progress)?))
    }

    /// The answer of trials that were flown in parts, by their tallies: the bytes of the answer of the whole. One trial is flown, to know
    /// the tallies for those of this plan; there are no trajectories.
    ///
    /// # Errors
    /// [`SimulateError::Parts`] for tallies of another run, and for trials that are missing or counted twice.
    pub fn merged(self, tallies: &[Tally], progress: &dyn Progress) -> Result<Simulated, SimulateError> {
        let Some(own) = self.tally(self.options.first_trial..self.options.first_trial + 1, progress)? else {
            return Err(PartsProblem::NoPath.into());
        };
        let tally = merged(tallies, &own, (self.options.first_trial, self.options.trials))?;
        let answer = self.answer_of(&tally);
        let Self { planned, warnings, .. } = self;
        Ok(Simulated { planned, summaries: vec![tally.summary()], tallies: vec![tally], answer, warnings, ground: None })
    }

    /// The answer of trials that were flown in parts and merged.
    pub fn answer_of(&self, tally: &Tally) -> SimulateAnswer {
        let hops = self.planned.path.as_ref().map_or(0, |path| path.hops.len());
        let simulation = Some(SimulationRecord::new(&tally.summary(), hops));
        let advice = advice(&self.planned, &tally.summary());
        SimulateAnswer {
            check: self.planned.answer.check.clone(),
            path: planned_rows(&self.planned),
            simulation,
            compare: Vec::new(),
            requirement: None,
            advice,
            density: None,
        }
        .requiring(self.success_min)
    }

    /// Flies them, policy by policy on the same draws.
    ///
    /// # Errors
    /// [`SimulateError`].
    pub fn fly(self, observer: &mut dyn Observer, progress: &dyn Progress) -> Result<Simulated, SimulateError> {
        let Self { planned, policies, options, success_min, tally, warnings } = self;
        let (check, rows) = (planned.answer.check.clone(), planned_rows(&planned));
        let Some(path) = &planned.path else {
            let answer = SimulateAnswer {
                check,
                path: rows,
                simulation: None,
                compare: Vec::new(),
                requirement: None,
                advice: Vec::new(),
                density: None,
            };
            let answer = answer.requiring(success_min);
            return Ok(Simulated { planned, summaries: Vec::new(), tallies: Vec::new(), answer, warnings, ground: None });
        };
        let flyer = Flyer::new(&planned, &policies, progress)?;
        let simulation = flyer.simulation(path)?;
        let (summaries, tallies) = by_policy(&simulation, &policies, (options, tally), observer, progress)?;
        let hops = path.hops.len();
        let records: Vec<_> = summaries.iter().map(|summary| SimulationRecord::new(summary, hops)).collect();
        let own = planned.case.scenario.uncertainty.clone().unwrap_or_default().policy;
        let simulation = summaries.iter().position(|summary| summary.policy == own).map(|i| records[i].clone());
        let advice =
            summaries.iter().find(|summary| summary.policy == own).map(|summary| advice(&planned, summary)).unwrap_or_default();
        let compare = if records.len() > 1 { records } else { Vec::new() };
        Ok(Simulated {
            planned: Arc::clone(&planned),
            summaries,
            tallies,
            answer: SimulateAnswer { check, path: rows, simulation, compare, requirement: None, advice, density: None }
                .requiring(success_min),
            warnings,
            ground: flyer.into_ground(),
        })
    }
}

impl Simulated {
    /// The raster flown over, if the terrain is one.
    pub fn dem(&self) -> Option<&Dem> {
        self.ground.as_ref().map(|ground| ground.terrain().dem())
    }
}
