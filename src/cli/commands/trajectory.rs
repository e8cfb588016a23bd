//! The option `--trajectory`: a path in time as a CSV file.

use chta::{
    path::{HopPath, Timetable},
    report::{MapKnowledge, write_trajectory_csv},
};

use crate::cli::{Failure, args::TrajectoryArgs, load::Loaded, output::Pending};

/// Opens the file before the computation begins, after checking its name and the step.
pub(super) fn begin(args: &TrajectoryArgs) -> Result<Option<Pending<'_>>, Failure> {
    let Some(file) = args.trajectory.as_deref() else { return Ok(None) };
    let is_special = file.exists() && !file.is_file();
    if !is_special && !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        return Err(Failure::message(format!("--trajectory {}: expected a file that ends in .csv", file.display())));
    }
    if let Some(step_s) = args.step_s.filter(|step_s| !(*step_s > 0.0 && step_s.is_finite())) {
        return Err(Failure::message(format!("--step-s: found {step_s}, expected a number of seconds above 0, such as 0.1")));
    }
    Pending::begin(file).map(Some)
}

/// The opened file with its content: the path in time; only the header without a path.
pub(super) fn filled<'a>(
    file: Option<Pending<'a>>,
    args: &TrajectoryArgs,
    path: Option<&HopPath>,
    loaded: &Loaded,
) -> Result<Option<(Pending<'a>, Vec<u8>)>, Failure> {
    let Some(file) = file else { return Ok(None) };
    let none = HopPath { hops: Vec::new(), totals: chta::path::Totals::default() };
    let hopper = loaded.prepared.chain.hopper().limits();
    let table = Timetable::new(path.unwrap_or(&none), hopper, loaded.scenario.body.gravity.m_s2(), args.step_s)
        .map_err(|error| Failure::message(format!("--step-s: {error}")))?;
    let mut csv = Vec::new();
    let written = write_trajectory_csv(&table, map_knowledge(loaded), loaded.prepared.projection.as_ref(), &mut csv);
    written.map_err(|error| Failure::about(file.path(), &error))?;
    Ok(Some((file, csv)))
}

/// How the chain is located on a map, which determines the columns of its path.
pub(super) fn map_knowledge(loaded: &Loaded) -> MapKnowledge {
    match (loaded.prepared.chain.geometry().map_points(), &loaded.prepared.projection) {
        (None, _) => MapKnowledge::Nothing,
        (Some(_), None) => MapKnowledge::Metres,
        (Some(_), Some(_)) => MapKnowledge::Projection,
    }
}
