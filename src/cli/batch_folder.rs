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
    args::TableFile,
    claims, inputs,
    output::{self, Pending},
    wrong_thing::Role,
};

/// A part is closed after so many rows,
const ROWS: usize = 50;

/// or after this time.
const TIME: Duration = Duration::from_secs(10);

/// The folder of a batch.
pub(crate) struct BatchFolder<'c> {
    folder: PathBuf,
    cases: &'c CaseTable,
    columns: Vec<String>,
    format: TableFile,
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

/// Reads the cases. Parquet is no text that could be another kind of file: its reader knows it.
pub(crate) fn read_cases(file: &Path) -> Result<CaseTable, Failure> {
    let read = |file: &Path| CaseTable::read(file).map_err(|error| Failure::of(&error));
    if CaseTable::is_parquet(file) {
        claims::reads(file);
        return read(file);
    }
    read(&inputs::open(file, Role::Cases)?.file)
}

/// Refuses Parquet in a build without it. `what`: the option or the file that asks for it.
pub(crate) fn check_format(what: &str, format: TableFile) -> Result<(), Failure> {
    if format == TableFile::Csv || cfg!(feature = "parquet") {
        return Ok(());
    }
    Err(Failure::message(format!(
        "{what}: this is Parquet, but this chta was built without Parquet: build it with `cargo install --path . --features parquet`, or take CSV"
    )))
}

impl<'c> BatchFolder<'c> {
    /// The folder, with the rows that an earlier run left if this one goes on.
    pub(crate) fn open(folder: &Path, cases: &'c CaseTable, format: TableFile, resumes: bool) -> Result<(Self, Rows), Failure> {
        check_format("--parts parquet", format)?;
        fs::create_dir_all(folder).map_err(|error| {
            Failure::message(format!("{}: cannot be made ({error}): choose a folder that may be written to", folder.display()))
        })?;
        output::check_folder(folder)?;
        let (folder, columns) = (folder.to_path_buf(), cases.row_columns());
        let this = Self { folder, cases, columns, format, open: Vec::new(), began: Instant::now(), written: 0 };
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

    /// The parts that are there, of either format, in the order of their names.
    fn parts(&self) -> Result<Vec<PathBuf>, Failure> {
        let listed = fs::read_dir(&self.folder).map_err(|error| failed(&self.folder, &error))?;
        let is_part = |path: &PathBuf| {
            let named = path.file_stem().is_some_and(|name| name.to_string_lossy().starts_with("part-"));
            named && path.extension().is_some_and(|ending| ending == "csv" || ending == "parquet")
        };
        let mut parts: Vec<_> = listed.filter_map(|entry| Some(entry.ok()?.path())).filter(is_part).collect();
        parts.sort();
        Ok(parts)
    }

    /// The rows of a part by the numbers of their cases.
    fn read(&self, part: &Path) -> Result<Rows, Failure> {
        let (columns, rows) = match TableFile::of(part) {
            TableFile::Csv => read_csv(part)?,
            TableFile::Parquet => read_parquet(part)?,
        };
        if columns != self.columns {
            return Err(Failure::message(format!(
                "{}: found other columns than those of these cases: choose another folder",
                part.display()
            )));
        }
        Ok(rows.into_iter().filter_map(|cells| Some((cells.first()?.parse().ok()?, cells))).collect())
    }

    /// The rows that are those of the cases now, with the cells as the cases give them.
    pub(crate) fn kept(&self, rows: Rows, key: impl Fn(usize) -> String) -> Rows {
        let is_kept = |(case, row): &(usize, Vec<String>)| *case < self.cases.count() && !row[1].is_empty() && row[1] == key(*case);
        let stated = |(case, mut row): (usize, Vec<String>)| {
            let given = self.cases.given(case);
            row[2..2 + given.len()].clone_from_slice(given);
            (case, row)
        };
        rows.into_iter().filter(is_kept).map(stated).collect()
    }

    /// Adds rows, and closes the part when it is full or old.
    pub(crate) fn add(&mut self, rows: &[BatchRow]) -> Result<(), Failure> {
        self.open.extend(rows.iter().map(|row| row.cells.clone()));
        if self.open.len() >= ROWS || self.began.elapsed() >= TIME { self.close() } else { Ok(()) }
    }

    /// Closes the open part, if it has rows.
    pub(crate) fn close(&mut self) -> Result<(), Failure> {
        if let Some(first) = self.open.first() {
            let (table, number) = (self.table(&self.open, self.format)?, first[0].parse::<usize>().unwrap_or_default());
            // Another run may have answered the same case with others, or under another scenario: the content tells the parts apart.
            let tag = Sha256::digest(&table).iter().take(6).fold(0_u64, |tag, byte| tag << 8 | u64::from(*byte));
            let name = format!("part-{number:08}-{tag:012x}.{}", self.format.ending());
            output::to_file(&self.folder.join(name), &table)?;
            self.open.clear();
            self.written += 1;
        }
        self.began = Instant::now();
        Ok(())
    }

    /// Rows as a table, with the version and the meaning and units of the columns beside it.
    fn table(&self, rows: &[Vec<String>], format: TableFile) -> Result<Vec<u8>, Failure> {
        match format {
            TableFile::Csv => self.csv(rows),
            TableFile::Parquet => parquet(self.cases, rows).map_err(|error| failed(&self.folder, &error)),
        }
    }

    fn csv(&self, rows: &[Vec<String>]) -> Result<Vec<u8>, Failure> {
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

    /// All rows as one table, in the format of the ending of its file.
    pub(crate) fn collect(&self, rows: &Rows, file: Pending<'_>) -> Result<(), Failure> {
        let rows: Vec<_> = rows.values().cloned().collect();
        let table = self.table(&rows, TableFile::of(file.path()))?;
        output::finish(vec![(file, table)])
    }
}

/// The names of the columns of a table, and its rows.
type Table = (Vec<String>, Vec<Vec<String>>);

fn read_csv(part: &Path) -> Result<Table, Failure> {
    let about = |error: csv::Error| failed(part, &error);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(part).map_err(about)?;
    let columns = reader.headers().map_err(about)?.iter().map(str::to_owned).collect();
    let rows = reader.records().map(|record| Ok(record?.iter().map(str::to_owned).collect()));
    Ok((columns, rows.collect::<Result<_, _>>().map_err(about)?))
}

#[cfg(feature = "parquet")]
fn read_parquet(part: &Path) -> Result<Table, Failure> {
    let read = fs::File::open(part).and_then(chta::report::read_parquet);
    read.map_err(|error| failed(part, &error))
}

#[cfg(not(feature = "parquet"))]
fn read_parquet(part: &Path) -> Result<Table, Failure> {
    check_format(&part.display().to_string(), TableFile::Parquet).map(|()| Default::default())
}

#[cfg(feature = "parquet")]
fn parquet(cases: &CaseTable, rows: &[Vec<String>]) -> std::io::Result<Vec<u8>> {
    let mut table = Vec::new();
    chta::report::write_parquet(&mut table, &cases.parquet_columns(), &cases.words(), rows)?;
    Ok(table)
}

#[cfg(not(feature = "parquet"))]
fn parquet(_cases: &CaseTable, _rows: &[Vec<String>]) -> std::io::Result<Vec<u8>> {
    // Refused before.
    Err(std::io::Error::other("built without Parquet"))
}
