//! Landings as CSV.

use std::io::{self, Write};

use super::{FIRST_COLUMNS, LandingRow, LandingWriter, number_columns};

/// Landings as CSV, with a header even without landings.
#[derive(Debug)]
pub struct CsvLandings<W: Write> {
    writer: csv::Writer<W>,
}

impl<W: Write> CsvLandings<W> {
    /// Begins a file with the header.
    ///
    /// # Errors
    /// An error of the file system.
    pub fn begin(out: W, on_a_map: bool) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(FIRST_COLUMNS.iter().chain(number_columns(on_a_map)))?;
        Ok(Self { writer })
    }
}

impl<W: Write> LandingWriter for CsvLandings<W> {
    fn write(&mut self, row: &LandingRow) -> io::Result<()> {
        self.writer.write_field(row.trial.to_string())?;
        self.writer.write_field(row.hop.to_string())?;
        self.writer.write_field(row.policy)?;
        self.writer.write_field(row.outcome)?;
        for number in row.numbers {
            self.writer.write_field(number.to_string())?;
        }
        self.writer.write_record(None::<&[u8]>)?;
        Ok(())
    }

    fn finish(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}
