//! The chain as a CSV file: reading reports every problem at once, and a written file reads back as the same chain.
//!
//! ```text
//! x_m,z_m,friction_coefficient      a vertex per row; the other columns say what
//! 0,0,0.6                           the segment that begins here allows
//! 4.5,1.25,0.7
//! 9,1,                              no segment begins at the last vertex
//! ```
//!
//! [`CHAIN_COLUMNS`] lists every column. A file states its segments in one of two forms: by their surface
//! (`friction_coefficient`, `cross_slope_deg`), which applies to both directions, or by explicit limits, six columns for each
//! direction. `keep_out` may be added to either. A group of columns counts as present if some row fills it. The six columns
//! of a direction are given together or not at all, and are filled in every row but the last. If only one direction is given,
//! no hop goes the other way, and a warning says so.
//!
//! Angles are degrees in the file and radians inside the program. Text of up to 17 significant digits is read as a double and
//! converted, as [`Angle::from_degrees`](crate::quantity::Angle::from_degrees) does. One radian double in eleven has no
//! double of degrees: such an angle is written with more digits, and all digits of longer text are used.

mod columns;
mod degrees;
mod measured;
mod pairs;
mod positions;
mod problem;
mod read;
mod records;
mod table;
mod voids;
mod write;

pub use columns::{CHAIN_COLUMNS, CsvColumn, MEASURED_COLUMNS, PAIRS_COLUMNS, POSITION_COLUMNS};
pub use measured::{MeasuredFile, read_measured_csv, read_measured_csv_file};
pub use pairs::{PairsFile, StartGoal, read_pairs_csv, read_pairs_csv_file};
pub use positions::{PositionsFile, read_positions_csv, read_positions_csv_file};
pub use problem::{CsvFileError, CsvProblem, CsvProblems};
pub use read::{ChainFile, read_chain_csv, read_chain_csv_file, read_chain_csv_file_with, read_chain_csv_with};
pub use write::{ChainWriteError, write_chain_csv};
