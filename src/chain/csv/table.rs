//! A CSV file as a table of values with known columns.

use super::{
    CsvColumn, CsvProblems,
    columns::{excerpt, in_other_unit, nearest},
    records::{Place, Record, Records, plain, text_of},
};
use crate::quantity::unit_of;

/// How many unknown columns are listed in warnings; the others are only counted.
const WARNED_AT_MOST: usize = 20;

/// The content of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    /// Empty, or the column does not exist.
    Blank,
    /// Invalid, and already reported.
    Bad,
    /// Undetermined: the row has too few or too many fields, which is already reported.
    Unknown,
    /// A value, angles in radians.
    Value(f64),
}

/// The position of a row, from which it can be read again for a message.
#[derive(Clone, Copy, Debug)]
struct Row {
    offset: usize,
    line: u64,
}

/// The rows of a file, read with a set of known columns.
#[derive(Debug)]
pub(super) struct Table<'a> {
    source: &'a str,
    columns: &'static [CsvColumn],
    header: Record,
    /// For each known column, the index of its field in a row.
    fields: Vec<Option<usize>>,
    /// For each known column, the index of its cell in a row of cells.
    slots: Vec<Option<usize>>,
    width: usize,
    rows: Vec<Row>,
    cells: Vec<Cell>,
    /// Whether all rows up to the end of the file were read.
    pub(super) complete: bool,
    /// Warnings of ignored content.
    pub(super) warnings: Vec<String>,
}

impl<'a> Table<'a> {
    /// Reads a table; `None` if the file cannot be checked beyond the problems already reported.
    pub(super) fn read(bytes: &'a [u8], columns: &'static [CsvColumn], problems: &mut CsvProblems) -> Option<Self> {
        let source = match text_of(bytes) {
            Ok(source) => source,
            Err(problem) => {
                problems.push(|| *problem);
                return None;
            }
        };
        let mut records = Records::of(source);
        let mut header = Record::default();
        match records.read(&mut header) {
            Ok(true) => {}
            Ok(false) => {
                let nothing = Record { offset: 0, line: 1, fields: Vec::new() };
                let found = if source.trim().is_empty() { "an empty file" } else { "a file of comments only" };
                problems.push(|| {
                    Place::of_line(source, &nothing).problem(
                        found.to_owned(),
                        "a header",
                        format!("begin with the line {}", required_names(columns)),
                    )
                });
                return None;
            }
            Err(problem) => {
                problems.push(|| *problem);
                return None;
            }
        }
        let mut table = Self {
            source,
            columns,
            header,
            fields: vec![None; columns.len()],
            slots: vec![None; columns.len()],
            width: 0,
            rows: Vec::new(),
            cells: Vec::new(),
            complete: true,
            warnings: Vec::new(),
        };
        if !table.is_a_header(problems) {
            return None;
        }
        table.read_header(problems);
        table.read_rows(&mut records, problems);
        table.warn_of_open_end();
        Some(table)
    }

    /// Warns if the file ends within a line, as one does that was cut short: the last number may have had more digits.
    fn warn_of_open_end(&mut self) {
        let open = !self.source.ends_with(['\n', '\r']);
        if let Some(last) = self.rows.last().filter(|_| open && self.complete) {
            self.warnings.push(format!(
                "line {}: the file ends within this line, after {} rows: make sure that it is whole",
                last.line,
                self.rows.len()
            ));
        }
    }

    fn text(&self, record: &Record, field: usize) -> &'a str {
        record.fields.get(field).and_then(|bytes| self.source.get(bytes.clone())).map_or("", plain)
    }

    /// Whether the first record is a header with commas; if not, this is the only problem reported.
    fn is_a_header(&self, problems: &mut CsvProblems) -> bool {
        let names: Vec<&str> = (0..self.header.fields.len()).map(|field| self.text(&self.header, field)).collect();
        let known = |name: &str| self.columns.iter().any(|column| column.name == name.trim_matches(['"', ' ']));
        for (separator, called) in [(';', "semicolons"), ('\t', "tabs")] {
            let between = |name: &&str| name.contains(separator) && name.split(separator).any(known);
            if names.iter().any(between) {
                problems.push(|| {
                    Place::of_line(self.source, &self.header).problem(
                        format!("{called} between the columns"),
                        "commas",
                        "write commas between columns and points in numbers (1.5, not 1,5), or export as CSV with an English locale",
                    )
                });
                return false;
            }
        }
        if names.iter().all(|name| name.parse::<f64>().is_ok()) {
            problems.push(|| {
                Place::of_line(self.source, &self.header).problem(
                    "numbers in the first row".to_owned(),
                    "a header",
                    format!("put the names of the columns above them: {}", required_names(self.columns)),
                )
            });
            return false;
        }
        true
    }

    /// Finds the known columns and warns of the others.
    fn read_header(&mut self, problems: &mut CsvProblems) {
        let mut unknown = 0;
        for field in 0..self.header.fields.len() {
            let name = self.text(&self.header, field);
            let Some(index) = self.columns.iter().position(|column| column.name == name) else {
                unknown += 1;
                if unknown <= WARNED_AT_MOST {
                    self.warnings.push(self.warning_of_unknown(field, name));
                }
                continue;
            };
            if let Some(first) = self.fields[index] {
                problems.push(|| {
                    Place::of_field(self.source, &self.header, field).named(name).problem(
                        format!("`{name}` twice, here and as field {}", first + 1),
                        "each column once",
                        "remove one of the two",
                    )
                });
            } else {
                self.fields[index] = Some(field);
                self.slots[index] = Some(self.width);
                self.width += 1;
            }
        }
        self.check_units(problems);
        if unknown > WARNED_AT_MOST {
            self.warnings.push(format!("{} more unknown columns are ignored", unknown - WARNED_AT_MOST));
        }
        self.check_required(problems);
    }

    fn names(&self) -> impl Iterator<Item = &'a str> {
        (0..self.header.fields.len()).map(|field| self.text(&self.header, field))
    }

    /// Refuses a column that states a known quantity in another unit, unless the known column is there as well: leaving it out
    /// would leave out what it says of the ground.
    fn check_units(&self, problems: &mut CsvProblems) {
        for (field, name) in self.names().enumerate() {
            let Some(other) = in_other_unit(self.columns, name) else { continue };
            let known = self.columns.iter().position(|column| column.name == other.column);
            if known.is_some_and(|known| !self.has(known)) {
                problems.push(|| {
                    Place::of_field(self.source, &self.header, field).problem(
                        format!("`{}`, in {}", excerpt(name), other.unit),
                        format!("a column {}", other.column),
                        other.help,
                    )
                });
            }
        }
    }

    fn warning_of_unknown(&self, field: usize, name: &str) -> String {
        let which = if name.is_empty() {
            format!("column {} without a name", field + 1)
        } else {
            format!("unknown column `{}`", excerpt(name))
        };
        match nearest(self.columns, name) {
            Some(near) => format!("line {}: {which} is ignored (the nearest known column is {near})", self.header.line),
            None => format!("line {}: {which} is ignored", self.header.line),
        }
    }

    fn check_required(&self, problems: &mut CsvProblems) {
        for (column, field) in self.columns.iter().zip(&self.fields) {
            if !column.required || field.is_some() {
                continue;
            }
            // A column of the same quantity in another unit is reported instead.
            if self.names().any(|name| in_other_unit(self.columns, name).is_some_and(|other| other.column == column.name)) {
                continue;
            }
            problems.push(|| {
                let near = (0..self.header.fields.len()).map(|field| self.text(&self.header, field)).find(|name| {
                    !self.columns.iter().any(|known| known.name == *name) && nearest(self.columns, name) == Some(column.name)
                });
                let help = match near {
                    Some(near) => match unit_of(column.name) {
                        "" => format!("is `{}` meant? rename it to {}", excerpt(near), column.name),
                        unit => format!("is `{}` meant? rename it to {} if its numbers are in {unit}", excerpt(near), column.name),
                    },
                    None => format!("name the column {} in the header", column.name),
                };
                let found = format!("a header without {}", column.name);
                Place::of_line(self.source, &self.header).problem(found, format!("a column {}", column.name), help)
            });
        }
    }

    fn read_rows(&mut self, records: &mut Records<'a>, problems: &mut CsvProblems) {
        let mut record = Record::default();
        loop {
            match records.read(&mut record) {
                Ok(true) => {}
                Ok(false) => break,
                Err(problem) => {
                    problems.push(|| *problem);
                    self.complete = false;
                    break;
                }
            }
            self.rows.push(Row { offset: record.offset, line: record.line });
            let start = self.cells.len();
            if record.fields.len() == self.header.fields.len() {
                self.cells.resize(start + self.width, Cell::Blank);
                self.read_cells(&record, start, problems);
            } else {
                self.cells.resize(start + self.width, Cell::Unknown);
                problems.push(|| self.ragged(&record));
            }
        }
    }

    /// Parses the fields of a row into its cells.
    fn read_cells(&mut self, record: &Record, start: usize, problems: &mut CsvProblems) {
        for (index, column) in self.columns.iter().enumerate() {
            let (Some(field), Some(slot)) = (self.fields[index], self.slots[index]) else { continue };
            let text = self.text(record, field);
            self.cells[start + slot] = if text.is_empty() && !column.required {
                Cell::Blank
            } else {
                match column.parse(text) {
                    Ok(value) => Cell::Value(value),
                    Err(fault) => {
                        problems.push(|| {
                            let found = if text.is_empty() { "nothing".to_owned() } else { format!("`{}`", excerpt(text)) };
                            Place::of_field(self.source, record, field).named(column.name).problem(
                                found,
                                fault.expected,
                                fault.help,
                            )
                        });
                        Cell::Bad
                    }
                }
            };
        }
    }

    /// The problem of a row with too few or too many fields.
    fn ragged(&self, record: &Record) -> super::CsvProblem {
        let (found, expected) = (record.fields.len(), self.header.fields.len());
        let help = if found > expected {
            "is there a decimal comma (write 1.5, not 1,5), a comma between thousands (write 1500, not 1,500), or a comma too many?"
        } else {
            "write every comma, also in the last row, whose segment columns stay empty"
        };
        let place =
            if found > expected { Place::of_field(self.source, record, expected) } else { Place::of_line(self.source, record) };
        let fields = if found == 1 { "1 field".to_owned() } else { format!("{found} fields") };
        place.problem(fields, format!("{expected} as in the header"), help)
    }

    /// The number of rows.
    pub(super) fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// Whether a row has too few or too many fields.
    pub(super) fn is_ragged(&self, row: usize) -> bool {
        (0..self.columns.len()).any(|column| self.cell(row, column) == Cell::Unknown)
    }

    /// The line of a row.
    pub(super) fn line(&self, row: usize) -> u64 {
        self.rows.get(row).map_or(self.header.line, |row| row.line)
    }

    /// The content of a known column in a row.
    pub(super) fn cell(&self, row: usize, column: usize) -> Cell {
        let slot = self.slots.get(column).copied().flatten();
        slot.and_then(|slot| self.cells.get(row * self.width + slot)).copied().unwrap_or(Cell::Blank)
    }

    /// The value of a known column in a row, if it has one.
    pub(super) fn value(&self, row: usize, column: usize) -> Option<f64> {
        if let Cell::Value(value) = self.cell(row, column) { Some(value) } else { None }
    }

    /// Whether the header has this column.
    pub(super) fn has(&self, column: usize) -> bool {
        self.slots.get(column).is_some_and(Option::is_some)
    }

    /// The position of a known column's field in a row.
    pub(super) fn place(&self, row: usize, column: usize) -> Place {
        let record = self.record(row);
        let (Some(field), Some(known)) = (self.fields.get(column).copied().flatten(), self.columns.get(column)) else {
            return Place::of_line(self.source, &record);
        };
        Place::of_field(self.source, &record, field).named(known.name)
    }

    /// The position of a whole row, or of the header if there is no such row.
    pub(super) fn row_place(&self, row: usize) -> Place {
        Place::of_line(self.source, &self.record(row))
    }

    /// The position of a known column's name in the header.
    pub(super) fn header_place(&self, column: usize) -> Place {
        match self.fields.get(column).copied().flatten() {
            Some(field) => Place::of_field(self.source, &self.header, field),
            None => Place::of_line(self.source, &self.header),
        }
    }

    /// The text of a known column's field in a row, for a message.
    pub(super) fn excerpt(&self, row: usize, column: usize) -> String {
        let field = self.fields.get(column).copied().flatten();
        field.map_or_else(String::new, |field| excerpt(self.text(&self.record(row), field)))
    }

    /// Reads the record of a row again.
    fn record(&self, row: usize) -> Record {
        let mut record = Record::default();
        let found = self.rows.get(row).map(|row| Records::again(self.source, row.offset, row.line).read(&mut record));
        if matches!(found, Some(Ok(true))) { record } else { self.header.clone() }
    }
}

/// The names of the required columns.
fn required_names(columns: &[CsvColumn]) -> String {
    columns.iter().filter(|column| column.required).map(|column| column.name).collect::<Vec<_>>().join(",")
}
