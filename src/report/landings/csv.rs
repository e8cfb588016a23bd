//! Landings as CSV.

use std::io::{self, Write};

use super::{DRAWN_COLUMNS, FIRST_COLUMNS, LandingColumns, LandingRow, LandingWriter, TRUE_HEADING, number_columns};
use crate::report::MapKnowledge;

/// Landings as CSV, with a header even without landings.
#[derive(Debug)]
pub struct CsvLandings<W: Write> {
    writer: csv::Writer<W>,
    columns: LandingColumns,
}

impl<W: Write> CsvLandings<W> {
    /// Begins a file with the header.
    ///
    /// # Errors
    /// An error of the file system.
    pub fn begin(out: W, columns: LandingColumns) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        let heading = (columns.known == MapKnowledge::Projection).then_some(&TRUE_HEADING);
        let drawn = DRAWN_COLUMNS.iter().filter(|_| columns.drawn);
        let header = FIRST_COLUMNS.iter().chain(number_columns(columns.known)).chain(heading).chain(drawn);
        writer.write_record(header).map_err(of_the_writer)?;
        Ok(Self { writer, columns })
    }
}

impl<W: Write> CsvLandings<W> {
    fn record(&mut self, row: &LandingRow) -> csv::Result<()> {
        self.writer.write_field(row.trial.to_string())?;
        self.writer.write_field(row.hop.to_string())?;
        self.writer.write_field(row.policy)?;
        self.writer.write_field(row.outcome)?;
        for number in row.numbers {
            self.writer.write_field(number.to_string())?;
        }
        if self.columns.known == MapKnowledge::Projection {
            self.writer.write_field(row.heading_true_deg.map(|heading| heading.to_string()).unwrap_or_default())?;
        }
        for number in row.drawn.iter().filter(|_| self.columns.drawn) {
            self.writer.write_field(number.to_string())?;
        }
        self.writer.write_record(None::<&[u8]>)
    }
}

impl<W: Write> LandingWriter for CsvLandings<W> {
    fn write(&mut self, row: &LandingRow) -> io::Result<()> {
        self.record(row).map_err(of_the_writer)
    }

    fn finish(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// The error of the file or pipe with its kind, which the conversion of the crate `csv` loses: it distinguishes a closed pipe from a full disk.
fn of_the_writer(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}
