//! Tallies of trials that were flown apart.

use std::{fs, path::PathBuf};

use chta::{
    study::{Simulated, Trials},
    uncertainty::{RestDensity, Tally},
};

use super::{
    Failure, claims,
    landings::{Listener, RowFile},
    progress::Progress,
};

/// Flies trials with what is written meanwhile, or merges the tallies of those that were flown apart.
pub(crate) fn fly_or_merge<'a>(
    trials: Trials,
    merge: &[PathBuf],
    (rows, rests): (Option<RowFile<'a>>, Option<&'a mut RestDensity>),
    progress: &'a Progress,
) -> Result<Simulated, Failure> {
    if merge.is_empty() { Listener::fly(trials, rows, rests, progress) } else { Ok(trials.merged(&read(merge)?, progress)?) }
}

/// Reads them.
pub(crate) fn read(files: &[PathBuf]) -> Result<Vec<Tally>, Failure> {
    let one = |file: &PathBuf| {
        claims::reads(file);
        let refused = |error: &dyn std::fmt::Display| {
            Failure::message(format!(
                "{}: this is no tally ({error}), expected a file that `chta simulate --tally` of this version wrote",
                file.display()
            ))
        };
        let bytes = fs::read(file).map_err(|error| {
            Failure::message(format!(
                "{}: cannot be read ({error}), expected a tally: check the path and its permissions",
                file.display()
            ))
        })?;
        serde_json::from_slice(&bytes).map_err(|error| refused(&error))
    };
    files.iter().map(one).collect()
}
