//! Reads a chain from CSV.

use std::path::Path;

use super::{
    CHAIN_COLUMNS, CsvFileError, CsvProblem, CsvProblems,
    columns::{BEND, CROSS_SLOPE, FORWARD, FRICTION, KEEP_OUT, MAP_X, MAP_Y, REVERSE, SIX, X, Z},
    problem::read_file,
    table::{Cell, Table},
    voids,
};
use crate::{
    chain::{ChainProblem, ContactRule, GroundForm, LineConstraints, PolygonalChain, SegmentGround},
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint, VertexId},
    terrain::{MapProjection, NoDataRule},
    world::{Direction, FrictionCone},
};

/// A chain as read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainFile {
    /// The chain.
    pub chain: PolygonalChain,
    /// The projection of its map, if comments at the head of the file state one (`# crs_proj: +proj=...`, as written by
    /// `chta slice`).
    pub projection: Option<MapProjection>,
    /// Warnings: ignored content, and directions without any possible hop.
    pub warnings: Vec<String>,
}

/// Reads a chain from the text of a CSV.
///
/// # Errors
/// [`CsvProblems`] with every problem of the file, each with its line and field.
///
/// # Examples
/// ```
/// use chta::chain::csv::read_chain_csv;
/// let file = read_chain_csv(b"x_m,z_m,friction_coefficient\n0,0,0.6\n4,1,0.7\n9,1,\n").unwrap();
/// assert_eq!(file.chain.slopes(), [0.25, 0.0]);
///
/// let problems = read_chain_csv(b"x_m,z_m\n0,0\n2,inf\n1,3\n").unwrap_err();
/// let messages: Vec<String> = problems.problems.iter().map(ToString::to_string).collect();
/// assert!(messages[0].starts_with("line 3, column 3 (z_m): found `inf`, expected a finite number"));
/// assert!(messages[1].starts_with("line 4, column 1 (x_m): found `1`, expected more than 2, the x_m of line 3"));
/// ```
pub fn read_chain_csv(source: &[u8]) -> Result<ChainFile, CsvProblems> {
    read_chain_csv_with(source, NoDataRule::AsStated)
}

/// Reads a chain from the text of a CSV, as [`read_chain_csv`], with a rule for heights that mark missing data.
///
/// A chain has no gaps, so a height that marks missing data is a problem. With [`NoDataRule::Nothing`], none does.
///
/// # Errors
/// [`CsvProblems`] with every problem of the file, each with its line and field.
pub fn read_chain_csv_with(source: &[u8], no_data: NoDataRule) -> Result<ChainFile, CsvProblems> {
    let mut problems = CsvProblems::default();
    let Some(table) = Table::read(source, &CHAIN_COLUMNS, &mut problems) else { return Err(problems.sorted()) };
    let mut reading = Reading::of(table);
    reading.check_sets(&mut problems);
    reading.check_forms(&mut problems);
    reading.check_blanks(&mut problems);
    reading.check_last_row(&mut problems);
    reading.check_cones(&mut problems);
    reading.check_geometry(&mut problems);
    voids::check(&reading.table, no_data, &mut problems);
    if !problems.is_empty() {
        return Err(problems.sorted());
    }
    reading.warn();
    match reading.chain() {
        Ok(chain) => {
            let mut warnings = reading.table.warnings;
            let projection = stated_projection(source, &mut warnings).filter(|_| chain.map_points().is_some());
            Ok(ChainFile { chain, projection, warnings })
        }
        Err(invalid) => {
            for problem in invalid.0 {
                problems.push(|| reading.geometry_problem(&problem, &|row| row));
            }
            Err(problems.sorted())
        }
    }
}

/// The projection given by comments before the header; one that cannot be used causes a warning.
fn stated_projection(source: &[u8], warnings: &mut Vec<String>) -> Option<MapProjection> {
    let head: Vec<&str> = source
        .split(|byte| matches!(byte, b'\n' | b'\r'))
        .take_while(|line| line.is_empty() || line.starts_with(b"#"))
        .filter_map(|line| std::str::from_utf8(line).ok())
        .collect();
    let comment =
        |key: &str| head.iter().find_map(|line| Some(line.strip_prefix("# ")?.strip_prefix(key)?.strip_prefix(": ")?.to_owned()));
    match MapProjection::from_proj_string(&comment("crs_proj")?, comment("crs_name"), comment("crs_code")) {
        Ok(projection) => Some(projection),
        Err(reason) => {
            warnings.push(format!("the comment crs_proj is ignored, so results have no longitude and latitude: {reason}"));
            None
        }
    }
}

/// Reads a chain file; see [`read_chain_csv`].
///
/// # Errors
/// [`CsvFileError`] if the file cannot be read or has problems.
pub fn read_chain_csv_file(path: impl AsRef<Path>) -> Result<ChainFile, CsvFileError> {
    read_chain_csv_file_with(path, NoDataRule::AsStated)
}

/// Reads a chain file; see [`read_chain_csv_with`].
///
/// # Errors
/// [`CsvFileError`] if the file cannot be read or has problems.
pub fn read_chain_csv_file_with(path: impl AsRef<Path>, no_data: NoDataRule) -> Result<ChainFile, CsvFileError> {
    read_file(path.as_ref().to_owned(), |source| read_chain_csv_with(source, no_data))
}

/// The columns of the two forms of stating segments; a file fills the columns of one form only.
const SURFACE_FORM: std::ops::Range<usize> = FRICTION..KEEP_OUT;
const EXPLICIT_FORM: std::ops::Range<usize> = FORWARD..MAP_X;

/// A table, and which of its columns are filled, while it is converted to a chain.
struct Reading<'a> {
    table: Table<'a>,
    /// For each column, the first row that fills it. (The last row does not fill columns of segments.)
    filled: Vec<Option<usize>>,
}

impl<'a> Reading<'a> {
    fn of(table: Table<'a>) -> Self {
        let count = table.row_count();
        let first_filled =
            |column: usize| (0..rows_of(column, count)).find(|&row| matches!(table.cell(row, column), Cell::Value(_) | Cell::Bad));
        let filled = (0..CHAIN_COLUMNS.len()).map(|column| if table.has(column) { first_filled(column) } else { None }).collect();
        Self { table, filled }
    }

    fn fills(&self, column: usize) -> bool {
        self.filled.get(column).copied().flatten().is_some()
    }

    fn fills_any(&self, mut columns: std::ops::Range<usize>) -> bool {
        columns.any(|column| self.fills(column))
    }

    /// Checks that both or neither of the map's columns are given, and all six or none of a direction.
    fn check_sets(&self, problems: &mut CsvProblems) {
        for (set, called) in [
            (FORWARD..REVERSE, "all six columns for travel towards +x, or none"),
            (REVERSE..MAP_X, "all six columns for travel towards -x, or none"),
            (MAP_X..MAP_Y + 1, "both map columns, or none"),
        ] {
            let (given, missing): (Vec<usize>, Vec<usize>) = set.partition(|&column| self.fills(column));
            let Some(&first) = given.first() else { continue };
            if !missing.is_empty() {
                let (absent, blank): (Vec<usize>, Vec<usize>) = missing.iter().partition(|&&column| !self.table.has(column));
                let steps = [("add", absent), ("fill", blank)].into_iter().filter(|(_, columns)| !columns.is_empty());
                let help = steps.map(|(verb, columns)| format!("{verb} {}", names(&columns))).collect::<Vec<_>>().join(" and ");
                let found = format!("{} without {}", names(&given), names(&missing));
                problems.push(|| self.table.header_place(first).problem(found, called, help));
            }
        }
    }

    /// Checks that the file uses the surface form or the explicit form, not both.
    fn check_forms(&self, problems: &mut CsvProblems) {
        let (Some(surface), Some(explicit)) = (self.first_of(SURFACE_FORM), self.first_of(EXPLICIT_FORM)) else { return };
        let expected = "the surface form (friction_coefficient, cross_slope_deg) or the explicit form (takeoff_*, landing_*, reverse_*), one per file";
        let help = "empty the columns of one of the two";
        let in_row =
            |row: usize, form: std::ops::Range<usize>| form.into_iter().find(|&column| self.table.cell(row, column) != Cell::Blank);
        let mut both = false;
        for row in 0..self.table.row_count().saturating_sub(1) {
            if self.table.is_ragged(row) {
                continue;
            }
            if let (Some(of_surface), Some(of_explicit)) = (in_row(row, SURFACE_FORM), in_row(row, EXPLICIT_FORM)) {
                both = true;
                let found =
                    || format!("both {} and {} in one row", CHAIN_COLUMNS[of_surface].name, CHAIN_COLUMNS[of_explicit].name);
                problems.push(|| self.table.place(row, of_explicit).problem(found(), expected, help));
            }
        }
        if !both {
            let (later, earlier) = if surface.0 < explicit.0 { (explicit, surface) } else { (surface, explicit) };
            problems.push(|| {
                let found = format!(
                    "{}, where line {} has {}",
                    CHAIN_COLUMNS[later.1].name,
                    self.table.line(earlier.0),
                    CHAIN_COLUMNS[earlier.1].name
                );
                self.table.place(later.0, later.1).problem(found, expected, help)
            });
        }
    }

    /// The first row that fills some column of a form, and that column.
    fn first_of(&self, form: std::ops::Range<usize>) -> Option<(usize, usize)> {
        form.filter_map(|column| Some((self.filled.get(column).copied().flatten()?, column))).min()
    }

    /// Checks that a column filled in some row is filled in all rows.
    fn check_blanks(&self, problems: &mut CsvProblems) {
        let both_forms = self.fills_any(SURFACE_FORM) && self.fills_any(EXPLICIT_FORM);
        for (column, known) in CHAIN_COLUMNS.iter().enumerate() {
            // A mixture of both forms is reported first: the intended form decides which blanks are errors.
            let undecided = both_forms && (SURFACE_FORM.contains(&column) || EXPLICIT_FORM.contains(&column));
            let Some(first) = self.filled.get(column).copied().flatten().filter(|_| !undecided && !known.required) else {
                continue;
            };
            for row in 0..rows_of(column, self.table.row_count()) {
                if self.table.cell(row, column) == Cell::Blank {
                    problems.push(|| {
                        let expected = format!("{} as in line {}", known.expected(), self.table.line(first));
                        let help = "a column is filled in every row, or in none";
                        self.table.place(row, column).problem("nothing".to_owned(), expected, help)
                    });
                }
            }
        }
    }

    /// Checks that the last row leaves the segment columns empty: no segment begins at the last vertex.
    fn check_last_row(&self, problems: &mut CsvProblems) {
        let known = |&last: &usize| last > 0 && self.table.complete && !self.table.is_ragged(last);
        let Some(last) = self.table.row_count().checked_sub(1).filter(known) else { return };
        let filled: Vec<usize> = (FRICTION..MAP_X).filter(|&column| self.table.cell(last, column) != Cell::Blank).collect();
        let Some(&first) = filled.first() else { return };
        problems.push(|| {
            let found = format!("`{}` in the last row", self.table.excerpt(last, first));
            let help = format!("empty {}, or add the vertex where the segment ends: is the file cut short?", names(&filled));
            self.table.place(last, first).problem(found, "nothing, since no segment begins at the last vertex", help)
        });
    }

    /// Checks that no least angle is above its greatest.
    fn check_cones(&self, problems: &mut CsvProblems) {
        for row in 0..self.table.row_count().saturating_sub(1) {
            for least in [FORWARD, FORWARD + 3, REVERSE, REVERSE + 3] {
                let (Some(min), Some(max)) = (self.table.value(row, least), self.table.value(row, least + 1)) else { continue };
                if min > max {
                    problems.push(|| {
                        let (low, high) = (self.table.excerpt(row, least), self.table.excerpt(row, least + 1));
                        let expected = format!("at most {high}, the {} of this row", CHAIN_COLUMNS[least + 1].name);
                        let help = "swap the two; where nothing is allowed, write the speed 0";
                        self.table.place(row, least).problem(format!("`{low}`"), expected, help)
                    });
                }
            }
        }
    }

    /// Reports the problems of the chain's geometry, for the rows whose x is known.
    fn check_geometry(&self, problems: &mut CsvProblems) {
        let rows: Vec<usize> = (0..self.table.row_count()).filter(|&row| self.table.value(row, X).is_some()).collect();
        let row_of = |vertex: usize| rows.get(vertex).copied().unwrap_or_default();
        let known = |row: usize, column: usize| self.table.value(row, column);
        let vertices =
            rows.iter().map(|&row| ChainPoint::new(known(row, X).unwrap_or_default(), known(row, Z).unwrap_or_default())).collect();
        let Err(invalid) = PolygonalChain::bare(vertices) else { return };
        for problem in invalid.0 {
            let certain = match problem {
                ChainProblem::TooFewVertices { .. } => self.table.row_count() < 2 && self.table.complete,
                // Only if all four coordinates of the two vertices are known.
                ChainProblem::Vertical { segment } => {
                    let (a, b) = (row_of(segment.index()), row_of(segment.index() + 1));
                    b == a + 1 && known(a, Z).is_some() && known(b, Z).is_some()
                }
                _ => true,
            };
            if certain {
                problems.push(|| self.geometry_problem(&problem, &row_of));
            }
        }
    }

    /// A problem of the geometry, described with lines and fields of the file.
    fn geometry_problem(&self, problem: &ChainProblem, row_of: &dyn Fn(usize) -> usize) -> CsvProblem {
        match *problem {
            ChainProblem::TooFewVertices { count } => {
                let found = if count == 0 { "no row below the header".to_owned() } else { "1 row below the header".to_owned() };
                self.table.row_place(0).problem(found, "at least 2 vertices, one per row", "add the vertices of the terrain")
            }
            ChainProblem::NotIncreasing { vertex, .. } => {
                let (row, before) = (row_of(vertex.index()), row_of(vertex.index().saturating_sub(1)));
                let (line, x) = (self.table.line(before), self.table.excerpt(before, X));
                self.table.place(row, X).problem(
                    format!("`{}`", self.table.excerpt(row, X)),
                    format!("more than {x}, the x_m of line {line}"),
                    "put the rows in the order of x, each x once; a wall needs some millimetres of width",
                )
            }
            ChainProblem::Vertical { segment } => {
                let row = row_of(segment.index() + 1);
                let line = self.table.line(row_of(segment.index()));
                self.table.place(row, X).problem(
                    format!("`{}`, too near the x_m of line {line} for a slope", self.table.excerpt(row, X)),
                    "a slope that is a finite number",
                    "move the vertices apart",
                )
            }
            // Non-finite fields never reach the chain, and its lists are built with equal lengths.
            ref other => self.table.row_place(0).problem(other.to_string(), "a valid chain", "check the rows"),
        }
    }

    /// Warns of empty columns, and of a direction without limits.
    fn warn(&mut self) {
        let blank = (0..CHAIN_COLUMNS.len()).filter(|&column| self.table.has(column) && !self.fills(column));
        let mut warnings: Vec<String> =
            blank.map(|column| format!("column {} is empty in every row and is ignored", CHAIN_COLUMNS[column].name)).collect();
        match (self.fills(FORWARD), self.fills(REVERSE)) {
            (true, false) => warnings.push("no hop goes towards -x: the chain has no reverse_ columns".to_owned()),
            (false, true) => warnings.push("no hop goes towards +x: the chain has the reverse_ columns alone".to_owned()),
            _ => {}
        }
        self.table.warnings.append(&mut warnings);
    }

    /// The chain, once the table has no problems.
    fn chain(&self) -> Result<PolygonalChain, crate::chain::InvalidChain> {
        let rows = 0..self.table.row_count();
        let value = |row: usize, column: usize| self.table.value(row, column);
        let vertices = rows.clone().filter_map(|row| Some(ChainPoint::new(value(row, X)?, value(row, Z)?))).collect();
        let grounds = rows.clone().skip(1).map(|row| self.ground(row - 1)).collect();
        let map =
            self.fills(MAP_X).then(|| rows.filter_map(|row| Some(MapPoint::new(value(row, MAP_X)?, value(row, MAP_Y)?))).collect());
        let bends = (0..self.table.row_count()).filter(|&row| value(row, BEND) == Some(1.0)).map(VertexId).collect();
        PolygonalChain::new(vertices, grounds, map)?.with_bends(bends)
    }

    /// The ground that a row states for the segment that begins there.
    fn ground(&self, row: usize) -> SegmentGround {
        let explicit = self.fills(FORWARD) || self.fills(REVERSE);
        let form = if explicit {
            GroundForm::Explicit { forward: self.limits(row, Direction::Forward), reverse: self.limits(row, Direction::Reverse) }
        } else {
            GroundForm::Surface {
                friction: self.table.value(row, FRICTION).and_then(|mu| FrictionCone::new(mu).ok()),
                cross_slope: self.table.value(row, CROSS_SLOPE).map(Angle::from_radians).unwrap_or_default(),
            }
        };
        SegmentGround { form, keep_out: self.table.value(row, KEEP_OUT) == Some(1.0) }
    }

    /// The limits that a row states for a direction.
    fn limits(&self, row: usize, direction: Direction) -> Option<LineConstraints> {
        let first = match direction {
            Direction::Forward => FORWARD,
            Direction::Reverse => REVERSE,
        };
        let angle = |column: usize| self.table.value(row, column).map(Angle::from_radians);
        let contact = |first: usize| {
            let angles = AngleInterval { min: angle(first)?, max: angle(first + 1)? };
            Some(ContactRule::new(angles, self.table.value(row, first + 2)?))
        };
        Some(LineConstraints { takeoff: contact(first)?, landing: contact(first + SIX / 2)? })
    }
}

/// How many rows must fill a column: all, or all but the last for a column of segments.
fn rows_of(column: usize, row_count: usize) -> usize {
    if (FRICTION..MAP_X).contains(&column) { row_count.saturating_sub(1) } else { row_count }
}

/// The names of some columns.
fn names(columns: &[usize]) -> String {
    columns.iter().filter_map(|&column| CHAIN_COLUMNS.get(column)).map(|column| column.name).collect::<Vec<_>>().join(", ")
}
