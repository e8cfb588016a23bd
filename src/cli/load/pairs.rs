//! The file of pairs of start and goal.

use std::path::Path;

use chta::chain::csv::{PairsFile, read_pairs_csv_file};

use crate::cli::{Failure, inputs, wrong_thing::Role};

/// The pairs of a file; its warnings begin with its name.
pub(crate) fn read_pairs(path: &Path) -> Result<PairsFile, Failure> {
    let path = &inputs::open(path, Role::Pairs)?.file;
    let PairsFile { pairs, warnings } = read_pairs_csv_file(path)?;
    Ok(PairsFile { pairs, warnings: warnings.iter().map(|warning| format!("{}: {warning}", path.display())).collect() })
}
