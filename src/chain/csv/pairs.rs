//! Several pairs of start and goal in one CSV.

use std::path::Path;

use super::{CsvFileError, CsvProblems, PAIRS_COLUMNS, problem::read_file, table::Table};

/// A start and a goal on the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartGoal {
    /// Start of the path, m.
    pub start_x_m: f64,
    /// End of the path, m.
    pub goal_x_m: f64,
}

/// The content of a CSV of pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct PairsFile {
    /// The pairs, in the order of the file.
    pub pairs: Vec<StartGoal>,
    /// Warnings of ignored content.
    pub warnings: Vec<String>,
}

/// Reads pairs of start and goal from a CSV with the columns `start_x_m,goal_x_m`.
///
/// Does not check that they lie on a chain; [`PolygonalChain::station`](crate::chain::PolygonalChain::station) does.
///
/// # Errors
/// [`CsvProblems`] with every problem of the file, including a file without pairs.
///
/// # Examples
/// ```
/// use chta::chain::csv::read_pairs_csv;
/// let file = read_pairs_csv(b"start_x_m,goal_x_m\n0,100\n100,0\n").unwrap();
/// assert_eq!(file.pairs[1].start_x_m, 100.0);
/// let problems = read_pairs_csv(b"start_x_m,goal_x_m\n0,far\n").unwrap_err();
/// assert_eq!(problems.to_string(), "line 2, column 3 (goal_x_m): found `far`, expected a finite number; write a plain number such as 12.5 or 1e-3");
/// ```
pub fn read_pairs_csv(source: &[u8]) -> Result<PairsFile, CsvProblems> {
    let mut problems = CsvProblems::default();
    let Some(table) = Table::read(source, &PAIRS_COLUMNS, &mut problems) else { return Err(problems.sorted()) };
    if table.row_count() == 0 && table.complete {
        problems.push(|| {
            table.row_place(0).problem("no row below the header".to_owned(), "at least 1 pair", "add a row such as 0,100")
        });
    }
    if !problems.is_empty() {
        return Err(problems.sorted());
    }
    let pair = |row| Some(StartGoal { start_x_m: table.value(row, 0)?, goal_x_m: table.value(row, 1)? });
    let pairs = (0..table.row_count()).filter_map(pair).collect();
    Ok(PairsFile { pairs, warnings: table.warnings })
}

/// Reads a file of pairs; see [`read_pairs_csv`].
///
/// # Errors
/// [`CsvFileError`] if the file cannot be read or has problems.
pub fn read_pairs_csv_file(path: impl AsRef<Path>) -> Result<PairsFile, CsvFileError> {
    read_file(path.as_ref().to_owned(), read_pairs_csv)
}
