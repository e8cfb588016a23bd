//! The parts of a batch: each a table of consecutive rows, written whole or not at all.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use chta::study::{ANSWERS, BatchRow, CaseTable};
use sha2::{Digest, Sha256};

use super::{
    Failure,
    output::{self, Pending},
};

/// A part is closed after so many rows,
const ROWS: usize = 50;

/// or after this time.
const TIME: Duration = Duration::from_secs(10);

/// The folder of a batch.
pub(crate) struct BatchFolder {
    folder: PathBuf,
    columns: Vec<String>,
    open: Vec<Vec<String>>,
    began: Instant,
    /// Parts written by this run.
    pub(crate) written: usize,
}

/// Rows by the numbers of their cases.
pub(crate) type Rows = BTreeMap<usize, Vec<String>>;

/// Why a table cannot be written or read; with its name.
fn failed(file: &Path, error: &dyn std::error::Error) -> Failure {
    Failure::message(format!("{}: {error}; give a folder whose parts this version wrote, or another one", file.display()))
}

impl BatchFolder {
    /// The folder, with the rows that an earlier run left if this one goes on.
    pub(crate) fn open(folder: &Path, cases: &CaseTable, resumes: bool) -> Result<(Self, Rows), Failure> {
        fs::create_dir_all(folder).map_err(|error| {
            Failure::message(format!("{}: cannot be made ({error}): choose a folder that may be written to", folder.display()))
        })?;
        output::check_folder(folder)?;
        let columns = cases.row_columns();
        let this = Self { folder: folder.to_path_buf(), columns, open: Vec::new(), began: Instant::now(), written: 0 };
        let (parts, mut rows) = (this.parts()?, Rows::new());
        if !resumes && let Some(part) = parts.first() {
            return Err(Failure::message(format!(
                "{}: found a part of an earlier batch: go on with it by --resume, or choose another folder",
                part.display()
            )));
        }
        for part in &parts {
            rows.extend(this.read(part)?);
        }
        Ok((this, rows))
    }

    /// The parts that are there, in the order of their names.
    fn parts(&self) -> Result<Vec<PathBuf>, Failure> {
        let listed = fs::read_dir(&self.folder).map_err(|error| failed(&self.folder, &error))?;
        let is_part = |path: &PathBuf| {
            let named = path.file_stem().is_some_and(|name| name.to_string_lossy().starts_with("part-"));
            named && path.extension().is_some_and(|ending| ending == "csv")
        };
        let mut parts: Vec<_> = listed.filter_map(|entry| Some(entry.ok()?.path())).filter(is_part).collect();
        parts.sort();
        Ok(parts)
    }

    /// The rows of a part by the numbers of their cases.
    fn read(&self, part: &Path) -> Result<Rows, Failure> {
        let about = |error: csv::Error| failed(part, &error);
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(part).map_err(about)?;
        if reader.headers().map_err(about)?.iter().ne(self.columns.iter().map(String::as_str)) {
            return Err(Failure::message(format!(
                "{}: found other columns than those of these cases: choose another folder",
                part.display()
            )));
        }
        let mut rows = Rows::new();
        for record in reader.records() {
            let cells: Vec<String> = record.map_err(about)?.iter().map(str::to_owned).collect();
            if let Some(Ok(case)) = cells.first().map(|case| case.parse()) {
                rows.insert(case, cells);
            }
        }
        Ok(rows)
    }

    /// Adds rows, and closes the part when it is full or old.
    pub(crate) fn add(&mut self, rows: &[BatchRow]) -> Result<(), Failure> {
        self.open.extend(rows.iter().map(|row| row.cells.clone()));
        if self.open.len() >= ROWS || self.began.elapsed() >= TIME { self.close() } else { Ok(()) }
    }

    /// Closes the open part, if it has rows.
    pub(crate) fn close(&mut self) -> Result<(), Failure> {
        if let Some(first) = self.open.first() {
            let (table, number) = (self.table(&self.open)?, first[0].parse::<usize>().unwrap_or_default());
            // Another run may have answered the same case with others, or under another scenario: the content tells the parts apart.
            let tag = Sha256::digest(&table).iter().take(6).fold(0_u64, |tag, byte| tag << 8 | u64::from(*byte));
            output::to_file(&self.folder.join(format!("part-{number:08}-{tag:012x}.csv")), &table)?;
            self.open.clear();
            self.written += 1;
        }
        self.began = Instant::now();
        Ok(())
    }

    /// Rows as a table, with the version and the meaning and units of the answers before it.
    fn table(&self, rows: &[Vec<String>]) -> Result<Vec<u8>, Failure> {
        let mut text = format!("# chta {} batch\n", env!("CARGO_PKG_VERSION")).into_bytes();
        for (name, meaning) in ANSWERS {
            text.extend(format!("# {name}: {meaning}\n").into_bytes());
        }
        let mut writer = csv::Writer::from_writer(text);
        let about = |error: csv::Error| failed(&self.folder, &error);
        writer.write_record(&self.columns).map_err(about)?;
        rows.iter().try_for_each(|row| writer.write_record(row)).map_err(about)?;
        writer.into_inner().map_err(|error| failed(&self.folder, &error))
    }

    /// All rows as one table.
    pub(crate) fn collect(&self, rows: &Rows, file: Pending<'_>) -> Result<(), Failure> {
        let rows: Vec<_> = rows.values().cloned().collect();
        output::finish(vec![(file, self.table(&rows)?)])
    }
}
