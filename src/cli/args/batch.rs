//! The options of the command that answers many cases.

use std::path::{Path, PathBuf};

use clap::{Args as ClapArgs, ValueEnum};

use super::{DEFAULT_MAX_GIB, max_gib, thread_count};

/// Plan many cases of one scenario: one row a case, in parts that survive a crash
///
/// Rows are written in parts, each closed every 50 cases or 10 s and there as a whole or not at all. A case that is refused has its reason in
/// the column error, and the others go on. Rows do not depend on the threads.
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta batch data/cases/speeds.csv --scenario data/scenarios/simple_reduced.toml -o parts")]
pub(crate) struct BatchArgs {
    /// Cases (CSV or Parquet): one row a case, columns are scenario keys; an empty cell leaves the key as the scenario has it
    #[arg(value_name = "CASES")]
    pub(crate) cases: PathBuf,
    /// Scenario (TOML) whose keys the cases set
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: PathBuf,
    /// Folder for the parts, created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// The format of the parts; Parquet needs a chta built with it
    #[arg(long, value_enum, default_value = "csv")]
    pub(crate) parts: TableFile,
    /// Go on where an earlier batch in this folder ended: a row whose scenario and files are the same is kept
    #[arg(long)]
    pub(crate) resume: bool,
    /// All rows in the order of the cases as one table (CSV, or Parquet by its ending .parquet) to write [default: none]
    #[arg(long, value_name = "FILE")]
    pub(crate) collect: Option<PathBuf>,
    /// Set any scenario key; overrides the scenario [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Threads to work with; the answer does not depend on it [default: the environment variable `CHTA_THREADS`, else one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = thread_count)]
    pub(crate) threads: usize,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
}

/// The format of a table of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFile {
    Csv,
    Parquet,
}

impl TableFile {
    /// That of a file, by its ending.
    pub(crate) fn of(file: &Path) -> Self {
        let is_parquet = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"));
        if is_parquet { Self::Parquet } else { Self::Csv }
    }

    /// The ending of its files.
    pub(crate) const fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }
}
