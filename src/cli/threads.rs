//! The number of threads: from `--threads`, else from the environment variable `CHTA_THREADS`, else one for each core.

use std::{env, sync::OnceLock};

use clap::{ArgMatches, parser::ValueSource};

use super::{Failure, verbose};

/// The variable that gives the default of `--threads`.
pub(crate) const VARIABLE: &str = "CHTA_THREADS";

/// More than any machine this runs on has cores; thousands of threads take longer to start than most answers.
const MOST_THREADS: usize = 512;

/// The number of the environment variable, where it applies.
static OF_ENVIRONMENT: OnceLock<usize> = OnceLock::new();

/// Reads a number of threads; 0: one for each core.
pub(crate) fn thread_count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads) if threads <= MOST_THREADS => Ok(threads),
        _ => Err(format!("expected a whole number from 0 (one for each core) to {MOST_THREADS}")),
    }
}

/// Takes the default from the environment, if the command has the option and the command line does not give it. An empty variable
/// counts as unset.
///
/// # Errors
/// A value that is no number of threads, with the variable's name.
pub(crate) fn take_default(command: &ArgMatches) -> Result<(), Failure> {
    let is_default =
        command.try_contains_id("threads").is_ok() && command.value_source("threads") == Some(ValueSource::DefaultValue);
    let Some(value) = env::var_os(VARIABLE).filter(|value| is_default && !value.is_empty()) else { return Ok(()) };
    let text = value.to_string_lossy();
    let count = thread_count(&text).map_err(|expected| {
        Failure::message(format!(
            "{VARIABLE}: found `{text}`, {expected}: set the variable to such a number, unset it, or give --threads"
        ))
    })?;
    // Called once.
    let _ = OF_ENVIRONMENT.set(count);
    Ok(())
}

/// Sets the number of threads that `--threads` gives; 0: that of the environment variable, else one for each core.
///
/// # Errors
/// Threads that cannot be started.
pub(crate) fn start(option: usize) -> Result<(), Failure> {
    let threads = if option == 0 { OF_ENVIRONMENT.get().copied().unwrap_or(0) } else { option };
    // Zero is the default, and small searches never start the threads.
    if threads > 0 {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global()
            .map_err(|error| Failure::message(format!("the threads cannot be started ({error}): ask for fewer with --threads")))?;
    }
    verbose::say(|| match (option, threads) {
        (_, 0) => format!("threads: {}, one for each core", rayon::current_num_threads()),
        (0, _) => format!("threads: {threads}, of {VARIABLE}"),
        _ => format!("threads: {threads}, of --threads"),
    });
    Ok(())
}
