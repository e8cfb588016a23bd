//! The measured errors of a scenario, read from their file.

use std::path::Path;

use super::PipelineError;
use crate::{chain::csv::read_measured_csv_file, scenario::Scenario};

/// A scenario with its measured errors, if it names a file of them, and the warnings about that file.
///
/// `base` is the folder that the scenario's paths start from.
///
/// # Errors
/// [`PipelineError::Csv`], and [`PipelineError::Measured`] if a deviation is given of an error that was measured.
pub fn with_measured_errors(scenario: Scenario, base: &Path) -> Result<(Scenario, Vec<String>), PipelineError> {
    let Some(name) = scenario.uncertainty.as_ref().and_then(|keys| keys.errors_file.as_ref()) else {
        return Ok((scenario, Vec::new()));
    };
    let path = base.join(name);
    let file = read_measured_csv_file(&path)?;
    scenario.with_measured_errors(&file).map_err(|problems| PipelineError::Measured { path, problems })
}
