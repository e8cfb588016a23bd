//! What each error costs: trials without it, on the draws of trials with it.

use super::{ExperimentError, Planned, simulate::Flyer};
use crate::{
    path::HopPath,
    progress::Progress,
    report::{SensitivityAnswer, SensitivityRow},
    uncertainty::{ErrorKey, Observer, TrialOptions, TrialOutcome, TrialRecord, Uncertainty, Wilson, experiments::Experiment},
};

/// Which trials reached the goal, in their order.
#[derive(Debug, Default)]
struct Reached(Vec<bool>);

impl Observer for Reached {
    fn wants_records(&self) -> bool {
        true
    }

    fn trial(&mut self, trial: &TrialRecord) {
        self.0.push(trial.outcome == TrialOutcome::Reached);
    }
}

/// Flies the trials of a path with all errors, and then without each in turn. Path and policy stay as they are: what changes is how exactly
/// commands are executed over which ground.
pub(super) fn sensitivity(
    planned: &Planned,
    path: &HopPath,
    progress: &dyn Progress,
) -> Result<SensitivityAnswer, ExperimentError> {
    let missing = ExperimentError::NoUncertainty { experiment: Experiment::Sensitivity };
    let keys = planned.case.scenario.uncertainty.as_ref().ok_or(missing)?;
    let errors: Vec<ErrorKey> = ErrorKey::ALL.into_iter().filter(|key| keys.errors.has(*key)).collect();
    if errors.is_empty() {
        return Err(ExperimentError::NoErrors);
    }
    let flyer = Flyer::new(planned, &[keys.policy], progress)?;
    let options = TrialOptions { trajectories: 0, ..keys.options() };
    let flown = |errors: Uncertainty| -> Result<Vec<bool>, ExperimentError> {
        let mut reached = Reached::default();
        flyer.simulation_under(path, errors)?.run(&options, &mut reached, progress).map_err(super::SimulateError::from)?;
        Ok(reached.0)
    };
    let with = flown(keys.errors.clone())?;
    let sigma = |key: ErrorKey| keys.errors.by_key().into_iter().find(|(name, ..)| *name == key.name()).map(|(_, sigma, _)| sigma);
    let row = |key: ErrorKey| Ok(SensitivityRow::new(key, sigma(key), &with, &flown(keys.errors.without(key))?));
    let mut errors: Vec<SensitivityRow> = errors.into_iter().map(row).collect::<Result<_, ExperimentError>>()?;
    errors.sort_by(|a, b| b.cost.total_cmp(&a.cost));
    let rate = Wilson::of(with.iter().filter(|reached| **reached).count() as u64, with.len() as u64);
    Ok(SensitivityAnswer {
        experiment: Experiment::Sensitivity,
        trials: keys.trials,
        seed: keys.seed,
        policy: keys.policy,
        success_rate: rate.rate,
        success_rate_ci95: [rate.low, rate.high],
        errors,
    })
}
