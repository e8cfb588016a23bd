//! The chain as a CSV file, read with every problem named at once, and written so that it reads back as it was.
//!
//! ```text
//! x_m,z_m,friction_coefficient      a vertex per row; the other columns say what
//! 0,0,0.6                           the segment that begins here allows
//! 4.5,1.25,0.7
//! 9,1,                              no segment begins at the last vertex
//! ```
//!
//! [`CHAIN_COLUMNS`] lists every column. Two ways of stating a segment exist, one per file: its surface (`friction_coefficient`,
//! `cross_slope_deg`), which fixes both directions, or explicit limits, six columns for each direction. `keep_out` goes with either.
//! A set of columns counts as given where some row fills it; six columns of a direction are given together or not at all, and fill
//! every row but the last. With one direction given, no hop goes the other way, and a warning says so.
//!
//! Angles are degrees in the file and radians inside. Text of up to 17 significant digits is read as a double and converted, as
//! [`Angle::from_degrees`](crate::quantity::Angle::from_degrees) does. One radian double in eleven is no double of degrees at all: such an
//! angle is written with more digits, and text of more than 17 digits is honoured digit by digit.

mod columns;
mod degrees;
mod pairs;
mod problem;
mod read;
mod records;
mod table;
mod write;

pub use columns::{CHAIN_COLUMNS, CsvColumn, PAIRS_COLUMNS};
pub use pairs::{PairsFile, StartGoal, read_pairs_csv, read_pairs_csv_file};
pub use problem::{CsvFileError, CsvProblem, CsvProblems};
pub use read::{ChainFile, read_chain_csv, read_chain_csv_file};
pub use write::{ChainWriteError, write_chain_csv};
