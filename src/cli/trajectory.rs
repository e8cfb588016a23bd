//! The option `--trajectory`: a path in time as a CSV file.

use chta::{
    path::HopPath,
    study::{Case, TrajectoryError},
};

use super::{Failure, args::TrajectoryArgs, output::Pending};

/// The file of a path in time.
#[derive(Debug)]
pub(crate) struct TrajectoryFile<'a> {
    file: Pending<'a>,
    step_s: Option<f64>,
}

impl<'a> TrajectoryFile<'a> {
    /// Opens the file before the computation begins, after checking its name and the step.
    pub(crate) fn begin(args: &'a TrajectoryArgs) -> Result<Option<Self>, Failure> {
        let Some(file) = args.trajectory.as_deref() else { return Ok(None) };
        let is_special = file.exists() && !file.is_file();
        if !is_special && !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
            return Err(Failure::message(format!("--trajectory {}: expected a file that ends in .csv", file.display())));
        }
        if let Some(step_s) = args.step_s.filter(|step_s| !(*step_s > 0.0 && step_s.is_finite())) {
            return Err(Failure::message(format!("--step-s: found {step_s}, expected a number of seconds above 0, such as 0.1")));
        }
        Ok(Some(Self { file: Pending::begin(file)?, step_s: args.step_s }))
    }

    /// The opened file with its content: the path in time; only the header without a path.
    pub(crate) fn filled(self, path: Option<&HopPath>, case: &Case) -> Result<(Pending<'a>, Vec<u8>), Failure> {
        let mut csv = Vec::new();
        case.write_trajectory(path, self.step_s, &mut csv).map_err(|error| match error {
            TrajectoryError::Timetable(error) => Failure::message(format!("--step-s: {error}")),
            other => Failure::about(self.file.path(), &other),
        })?;
        Ok((self.file, csv))
    }
}
