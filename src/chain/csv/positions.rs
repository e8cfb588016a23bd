//! Positions on a map in one CSV.

use std::path::Path;

use super::{CsvFileError, CsvProblems, POSITION_COLUMNS, problem::read_file, table::Table};
use crate::quantity::MapPoint;

/// The content of a CSV of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionsFile {
    /// The positions with their lines in the file, in its order.
    pub positions: Vec<(u64, MapPoint)>,
    /// Warnings of ignored content.
    pub warnings: Vec<String>,
}

/// Reads positions on a map from a CSV with the columns `x_m,y_m`.
///
/// Does not check that they lie on a map.
///
/// # Errors
/// [`CsvProblems`] with every problem of the file, including a file without positions.
///
/// # Examples
/// ```
/// use chta::{chain::csv::read_positions_csv, quantity::MapPoint};
/// let file = read_positions_csv(b"x_m,y_m\n10,20\n-3,4.5\n").unwrap();
/// assert_eq!(file.positions, [(2, MapPoint::new(10.0, 20.0)), (3, MapPoint::new(-3.0, 4.5))]);
/// let problems = read_positions_csv(b"x_m,y_m\n0,far\n").unwrap_err();
/// assert_eq!(problems.to_string(), "line 2, column 3 (y_m): found `far`, expected a finite number; write a plain number such as 12.5 or 1e-3");
/// ```
pub fn read_positions_csv(source: &[u8]) -> Result<PositionsFile, CsvProblems> {
    let mut problems = CsvProblems::default();
    let Some(table) = Table::read(source, &POSITION_COLUMNS, &mut problems) else { return Err(problems.sorted()) };
    if table.row_count() == 0 && table.complete {
        problems.push(|| {
            table.row_place(0).problem("no row below the header".to_owned(), "at least 1 position", "add a row such as 10,20")
        });
    }
    if !problems.is_empty() {
        return Err(problems.sorted());
    }
    let position = |row| Some((table.line(row), MapPoint::new(table.value(row, 0)?, table.value(row, 1)?)));
    let positions = (0..table.row_count()).filter_map(position).collect();
    Ok(PositionsFile { positions, warnings: table.warnings })
}

/// Reads a file of positions; see [`read_positions_csv`].
///
/// # Errors
/// [`CsvFileError`] if the file cannot be read or has problems.
pub fn read_positions_csv_file(path: impl AsRef<Path>) -> Result<PositionsFile, CsvFileError> {
    read_file(path.as_ref().to_owned(), read_positions_csv)
}
