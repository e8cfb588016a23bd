//! The errors of single hops, as a test stand measured them, in one CSV.

use std::path::Path;

use super::{
    CsvFileError, CsvProblems, MEASURED_COLUMNS,
    columns::{SPEED_ERROR, SPEED_ERROR_FRACTION},
    problem::read_file,
    table::{Cell, Table},
};

/// The content of a CSV of measured errors.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFile {
    /// Which of [`MEASURED_COLUMNS`] the file has.
    pub has: [bool; MEASURED_COLUMNS.len()],
    /// One hop a row, in the order of the file: a value for each of [`MEASURED_COLUMNS`], angles in radians; 0 where the file has no such
    /// column.
    pub rows: Vec<[f64; MEASURED_COLUMNS.len()]>,
    /// Warnings of ignored content.
    pub warnings: Vec<String>,
}

/// Reads measured errors of hops from a CSV with at least one of [`MEASURED_COLUMNS`], and every value of the columns that it has.
///
/// # Errors
/// [`CsvProblems`] with every problem of the file: no column that is known, both columns of the speed, a value left out, no row.
///
/// # Examples
/// ```
/// use chta::chain::csv::read_measured_csv;
/// let file = read_measured_csv(b"takeoff_speed_error_m_s,drift_along_m\n0.05,0.1\n-0.02,0\n").unwrap();
/// assert_eq!(file.rows[1], [0.0, -0.02, 0.0, 0.0, 0.0, 0.0]);
/// let problems = read_measured_csv(b"takeoff_speed_error_m_s,drift_along_m\n0.05,\n").unwrap_err();
/// assert_eq!(problems.to_string(), "line 2, column 6 (drift_along_m): found nothing, expected a finite number; write 0 if there was no error, or remove the row");
/// ```
pub fn read_measured_csv(source: &[u8]) -> Result<MeasuredFile, CsvProblems> {
    let mut problems = CsvProblems::default();
    let Some(table) = Table::read(source, &MEASURED_COLUMNS, &mut problems) else { return Err(problems.sorted()) };
    let has = std::array::from_fn(|column| table.has(column));
    if !has.contains(&true) && problems.is_empty() {
        let names: Vec<&str> = MEASURED_COLUMNS.iter().map(|column| column.name).collect();
        problems.push(|| {
            table.row_place(usize::MAX).problem(
                "a header without an error".to_owned(),
                format!("at least one of {}", names.join(", ")),
                "name the columns so, in these units",
            )
        });
    }
    if has[SPEED_ERROR] && has[SPEED_ERROR_FRACTION] {
        problems.push(|| {
            table.header_place(SPEED_ERROR).problem(
                "the error of the take-off speed twice, in m/s and as a fraction".to_owned(),
                "it once",
                "remove one of the two columns: both would be added",
            )
        });
    }
    if table.row_count() == 0 && table.complete {
        problems.push(|| {
            table.row_place(0).problem(
                "no row below the header".to_owned(),
                "at least 1 hop",
                "add a row for each hop that was measured",
            )
        });
    }
    for row in 0..table.row_count() {
        for column in (0..MEASURED_COLUMNS.len()).filter(|&column| has[column]) {
            if table.cell(row, column) == Cell::Blank {
                problems.push(|| {
                    table.place(row, column).problem(
                        "nothing".to_owned(),
                        MEASURED_COLUMNS[column].expected(),
                        "write 0 if there was no error, or remove the row",
                    )
                });
            }
        }
    }
    if !problems.is_empty() {
        return Err(problems.sorted());
    }
    let rows = (0..table.row_count()).map(|row| std::array::from_fn(|column| table.value(row, column).unwrap_or(0.0))).collect();
    Ok(MeasuredFile { has, rows, warnings: table.warnings })
}

/// Reads a file of measured errors; see [`read_measured_csv`].
///
/// # Errors
/// [`CsvFileError`] if the file cannot be read or has problems.
pub fn read_measured_csv_file(path: impl AsRef<Path>) -> Result<MeasuredFile, CsvFileError> {
    read_file(path.as_ref().to_owned(), read_measured_csv)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_files_are_refused_with_every_problem_and_its_line() {
        for (text, expected) in [
            ("", &["line 1: found an empty file"][..]),
            ("a,b\n1,2\n", &["line 1: found a header without an error, expected at least one of takeoff_speed_error_fraction"]),
            ("drift_along_m\n", &["line 1: found no row below the header, expected at least 1 hop"]),
            (
                "takeoff_speed_error_m_s,takeoff_speed_error_fraction\n0.1,0.1\n",
                &["line 1, column 1: found the error of the take-off speed twice", "remove one of the two columns"],
            ),
            (
                "takeoff_angle_error_deg,drift_across_m\n190,0.1\n,nan\n1,0,2\n",
                &[
                    "line 2, column 1 (takeoff_angle_error_deg): found `190`, expected a finite angle from -180 to 180 degrees",
                    "line 3, column 1 (takeoff_angle_error_deg): found nothing",
                    "line 3, column 2 (drift_across_m): found `nan`",
                    "line 4, column 5: found 3 fields",
                ],
            ),
            ("heading_error_rad\n0.1\n", &["found `heading_error_rad`, in radians", "multiply its numbers by 57.2957795"]),
            (
                "takeoff_speed_error_percent\n1\n",
                &["expected a column takeoff_speed_error_fraction", "multiply its numbers by 0.01"],
            ),
            (
                "takeoff_speed_error_km_h\n1\n",
                &["expected a column takeoff_speed_error_m_s", "multiply its numbers by 0.2777777778"],
            ),
            ("drift_along_cm\n1\n", &["expected a column drift_along_m", "multiply its numbers by 0.01"]),
            ("drift_along_m;drift_across_m\n1;2\n", &["semicolons"]),
        ] {
            let problems = read_measured_csv(text.as_bytes()).expect_err(text).to_string();
            for part in expected {
                assert!(problems.contains(part), "{text:?}: {problems}");
            }
        }
    }

    #[test]
    fn unknown_columns_are_ignored_with_a_warning() {
        let file = read_measured_csv(b"run,takeoff_angle_error_deg\n7,90\n").expect("a valid file");
        assert_eq!(file.has, [false, false, true, false, false, false]);
        assert!((file.rows[0][2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!(file.warnings.iter().any(|warning| warning.contains("unknown column `run` is ignored")), "{:?}", file.warnings);
    }
}
