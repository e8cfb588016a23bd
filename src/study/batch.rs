//! Many cases of one scenario, each of which sets some of its keys: one row a case.

use std::{
    collections::BTreeSet,
    fmt::Write as _,
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};

use rayon::prelude::*;
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::open::{Draft, PlanAsked, relative_name};
use crate::{
    progress::Progress,
    scenario::{Key, nearest_key, scenario_document},
};

/// Cases as a table: its columns are scenario keys, its rows cases. An empty cell leaves the key as the scenario has it.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseTable {
    /// The name of its file, with which problems of a case begin.
    name: String,
    /// What its rows are counted by: lines or rows.
    place: &'static str,
    columns: Vec<String>,
    /// The line or row of each case, and its cells.
    rows: Vec<(u64, Vec<String>)>,
}

/// Why a table of cases cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaseTableError {
    /// No CSV, or a row with more or fewer cells than the header.
    #[error("{}: {problem}, expected CSV whose header names scenario keys, such as hopper.takeoff_speed_max_m_s", file.display())]
    Csv {
        /// The file.
        file: PathBuf,
        /// The problem.
        problem: csv::Error,
    },
    /// A column that is no key.
    #[error("{}: found the column {column}, expected a scenario key; {nearest}", file.display())]
    Column {
        /// The file.
        file: PathBuf,
        /// The column.
        column: String,
        /// The nearest key, in words.
        nearest: String,
    },
    /// A column that stands twice.
    #[error("{}: found the column {column} twice, expected every key once", file.display())]
    Twice {
        /// The file.
        file: PathBuf,
        /// The column.
        column: String,
    },
    /// Parquet that cannot be read.
    #[error("{}: {problem}, expected Parquet whose columns are scenario keys, such as hopper.takeoff_speed_max_m_s", file.display())]
    Parquet {
        /// The file.
        file: PathBuf,
        /// The problem.
        problem: std::io::Error,
    },
    /// Parquet in a build without it.
    #[error("{}: this is Parquet, which this build of chta does not read: give the cases as CSV, or build it with the feature parquet", file.display())]
    NoParquet {
        /// The file.
        file: PathBuf,
    },
    /// A header alone.
    #[error("{}: found no case, expected a row for each below the header", file.display())]
    Empty {
        /// The file.
        file: PathBuf,
    },
}

/// The names of the columns, and of each case its line or row and its cells.
type Cases = (Vec<String>, Vec<(u64, Vec<String>)>);

fn csv_cases(file: &Path) -> Result<Cases, CaseTableError> {
    let failed = |problem| CaseTableError::Csv { file: file.to_path_buf(), problem };
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_path(file).map_err(failed)?;
    let columns = reader.headers().map_err(failed)?.iter().map(str::to_owned).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(failed)?;
        let line = record.position().map_or(0, csv::Position::line);
        rows.push((line, record.iter().map(str::to_owned).collect()));
    }
    Ok((columns, rows))
}

#[cfg(feature = "parquet")]
fn parquet_cases(file: &Path) -> Result<Cases, CaseTableError> {
    let failed = |problem| CaseTableError::Parquet { file: file.to_path_buf(), problem };
    let (columns, rows) = crate::report::read_parquet(File::open(file).map_err(failed)?).map_err(failed)?;
    Ok((columns, (1..).zip(rows).collect()))
}

#[cfg(not(feature = "parquet"))]
fn parquet_cases(file: &Path) -> Result<Cases, CaseTableError> {
    Err(CaseTableError::NoParquet { file: file.to_path_buf() })
}

impl CaseTable {
    /// Whether a file is Parquet, by its first bytes; a pipe is not.
    pub fn is_parquet(file: &Path) -> bool {
        if !file.is_file() {
            return false;
        }
        let mut beginning = [0; 4];
        File::open(file).and_then(|mut opened| opened.read_exact(&mut beginning)).is_ok() && beginning == *b"PAR1"
    }

    /// Reads a table: CSV, or Parquet by its first bytes.
    ///
    /// # Errors
    /// [`CaseTableError`].
    pub fn read(file: &Path) -> Result<Self, CaseTableError> {
        let (columns, rows) = if Self::is_parquet(file) { parquet_cases(file)? } else { csv_cases(file)? };
        let mut known = BTreeSet::new();
        for column in &columns {
            let (table, name) = column.split_once('.').unwrap_or(("", column));
            if Key::find(table, name).is_none() {
                let (file, nearest) = (file.to_path_buf(), nearest_key(table, name));
                return Err(CaseTableError::Column { file, column: column.clone(), nearest });
            }
            if !known.insert(column) {
                return Err(CaseTableError::Twice { file: file.to_path_buf(), column: column.clone() });
            }
        }
        if rows.is_empty() {
            return Err(CaseTableError::Empty { file: file.to_path_buf() });
        }
        let place = if Self::is_parquet(file) { "row" } else { "line" };
        Ok(Self { name: file.display().to_string(), place, columns, rows })
    }

    /// How many cases there are.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// The keys of a case, set in the scenario.
    fn drafted(&self, draft: &Draft, case: usize) -> Draft {
        let mut draft = draft.clone();
        let (line, cells) = &self.rows[case];
        let place = format!("{}, {} {line}", self.name, self.place);
        for (column, cell) in self.columns.iter().zip(cells).filter(|(_, cell)| !cell.is_empty()) {
            draft.entries.set(&place, &format!("{column}={cell}"));
        }
        draft
    }

    /// The columns of rows as Parquet has them: numbers where a key takes a number and every case gives one, else text.
    #[cfg(feature = "parquet")]
    pub fn parquet_columns(&self) -> Vec<crate::report::TableColumn> {
        use crate::{report::CellKind, scenario::Kind};
        let given = |name: &str| {
            let place = self.columns.iter().position(|column| column == name)?;
            let key = name.split_once('.').and_then(|(table, name)| Key::find(table, name))?;
            let mut cells = self.rows.iter().map(|(_, cells)| &cells[place]).filter(|cell| !cell.is_empty());
            Some(match key.kind {
                Kind::Number { .. } if cells.all(|cell| cell.parse::<f64>().is_ok()) => CellKind::Number,
                Kind::Count { .. } if cells.all(|cell| cell.parse::<i64>().is_ok()) => CellKind::Count,
                _ => CellKind::Text,
            })
        };
        let kind = |name: &str| match name {
            "case" | "hops" | "hops_lower_bound" => CellKind::Count,
            "key" | "verdict" | "error" => CellKind::Text,
            name => given(name).unwrap_or(CellKind::Number),
        };
        self.row_columns().into_iter().map(|name| crate::report::TableColumn { kind: kind(&name), name }).collect()
    }

    /// What a table of rows says of itself: the version, and the meaning of every column with its unit.
    pub fn words(&self) -> Vec<(String, String)> {
        let version = ("chta_version".to_owned(), env!("CARGO_PKG_VERSION").to_owned());
        let of_row = [("case", "number of the case in its table, from 0"), ("key", KEY)];
        let of_row = of_row.into_iter().chain(ANSWERS).map(|(name, meaning)| (name.to_owned(), meaning.to_owned()));
        let keys = self.columns.iter().filter_map(|column| {
            let (table, name) = column.split_once('.')?;
            Some((column.clone(), Key::find(table, name)?.help.to_owned()))
        });
        std::iter::once(version).chain(of_row).chain(keys).collect()
    }

    /// The names of the columns of rows: those of the cases between their number and key, and the answers.
    pub fn row_columns(&self) -> Vec<String> {
        let answers = ANSWERS.iter().map(|(name, _)| (*name).to_owned());
        ["case", "key"].into_iter().map(str::to_owned).chain(self.columns.iter().cloned()).chain(answers).collect()
    }
}

/// What the key of a row is.
const KEY: &str = "SHA-256 of the scenario as used, of its files and of the version; empty where the scenario is refused";

/// The columns of answers, with what they mean and their units.
pub const ANSWERS: [(&str, &str); 10] = [
    ("verdict", "whether a path was found over the nodes that were searched; empty with an error"),
    ("hops", "hops of the path, at most so many over these nodes; empty without a path"),
    ("hops_lower_bound", "fewer hops cannot suffice"),
    ("flight_time_s", "time in flight of the path, s"),
    ("mission_time_s", "time from the first preparation to the last landing, s"),
    ("energy_j_kg", "energy of the path per unit mass, J/kg"),
    ("delta_v_m_s", "sum of the speeds of take-off, m/s"),
    ("peak_takeoff_speed_m_s", "greatest take-off speed of the path, m/s"),
    ("ground_distance_m", "distance along the path, m"),
    ("error", "why there is no answer; empty with one"),
];

/// The answer to one case.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchRow {
    /// The cells of its row, as [`CaseTable::row_columns`] names them.
    pub cells: Vec<String>,
    /// Whether there is a path; `None` with an error.
    pub holds: Option<bool>,
}

impl CaseTable {
    /// The name of a case among answers: the SHA-256 of the scenario as used, of the content of its files and of the version; empty where the
    /// scenario is refused or a file cannot be read.
    pub fn key(&self, draft: &Draft, case: usize) -> String {
        let draft = self.drafted(draft, case);
        let named = |path: &Path| relative_name(&draft.base.join(path));
        let Ok(scenario) = draft.validated(true) else { return String::new() };
        let shared = draft.shared.clone().unwrap_or_default();
        let Ok(files) = shared.checksums(&scenario, &draft.base, &relative_name) else { return String::new() };
        let mut text = format!("{} {}", env!("CARGO_PKG_VERSION"), scenario_document(&scenario, &named));
        for file in files {
            // Writing to a String cannot fail.
            let _ = write!(text, " {}", file.sha256);
        }
        Sha256::digest(text).iter().fold(String::with_capacity(64), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        })
    }

    /// The cells of a case as they were given, in the order of the columns.
    pub fn given(&self, case: usize) -> &[String] {
        &self.rows[case].1
    }

    /// The keys that are columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Plans some cases, all threads together. The rows do not depend on which cases are asked for at once, nor on the threads. Cases of a draft
    /// that [shares](super::open::SharedInputs) its inputs read a terrain once for all.
    ///
    /// Of cases that `progress` cancels the rows say so as an error: a caller that cancels drops them.
    pub fn answers(&self, draft: &Draft, cases: &[usize], progress: &dyn Progress) -> Vec<BatchRow> {
        cases.par_iter().map(|case| self.answer(draft, *case, progress)).collect()
    }

    fn answer(&self, draft: &Draft, case: usize, progress: &dyn Progress) -> BatchRow {
        let reply = self.drafted(draft, case).plan(&PlanAsked::default(), progress);
        let (holds, document, error) = match reply {
            Ok(reply) => (Some(reply.holds), serde_json::from_str(&reply.json).unwrap_or(Value::Null), String::new()),
            Err(error) => (None, Value::Null, error.to_string().replace('\n', "; ")),
        };
        let (_, given) = &self.rows[case];
        let mut cells = vec![case.to_string(), self.key(draft, case)];
        cells.extend(given.iter().cloned());
        cells.extend(ANSWERS.iter().map(|(name, _)| match *name {
            "error" => error.clone(),
            name => cell(document.get(name).or_else(|| document.get("totals")?.get(name))),
        }));
        BatchRow { cells, holds }
    }
}

/// A value of a document in a table.
fn cell(value: Option<&Value>) -> String {
    match value {
        Some(Value::String(text)) => text.clone(),
        Some(Value::Number(number)) => number.to_string(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn table(text: &str) -> (tempfile::TempDir, Result<CaseTable, CaseTableError>) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("cases.csv");
        fs::write(&file, text).unwrap();
        let read = CaseTable::read(&file);
        (folder, read)
    }

    #[test]
    fn what_is_no_table_of_cases_is_refused_by_name() {
        for (text, said) in [
            ("hopper.takeof_speed_max_m_s\n3\n", "the nearest known key is hopper.takeoff_speed_max_m_s"),
            ("body.name,body.name\nmars,moon\n", "body.name twice"),
            ("body.name\n", "found no case"),
            ("body.name,hopper.mass_kg\nmars\n", "expected CSV whose header names scenario keys"),
        ] {
            let (_folder, read) = table(text);
            let refused = read.unwrap_err().to_string();
            assert!(refused.contains(said) && refused.contains("cases.csv"), "{refused}");
        }
    }

    #[test]
    fn a_row_is_the_plan_of_its_scenario_and_errors_stay_in_their_row() {
        let draft = Draft::read("data/scenarios/simple_reduced.toml".as_ref()).unwrap();
        let (_folder, read) = table("hopper.takeoff_speed_max_m_s,search.effort\n3,\n6,time\n-1,\n6,\n");
        let cases = read.unwrap();
        let rows = cases.answers(&draft, &[0, 1, 2, 3], &());
        assert_eq!(rows.iter().map(|row| row.holds).collect::<Vec<_>>(), [Some(false), Some(true), None, Some(true)]);
        let columns = cases.row_columns();
        let value = |row: usize, name: &str| rows[row].cells[columns.iter().position(|column| column == name).unwrap()].clone();
        assert!(value(2, "error").contains("line 4") && value(2, "key").is_empty() && value(2, "verdict").is_empty());
        assert_eq!((value(0, "hops").as_str(), value(0, "error").as_str()), ("", ""));
        let mut alone = draft.clone();
        alone.set("hopper.takeoff_speed_max_m_s=6");
        let plan: Value = serde_json::from_str(&alone.plan(&PlanAsked::default(), &()).unwrap().json).unwrap();
        assert_eq!(value(3, "hops"), plan["hops"].to_string());
        assert_eq!(value(3, "energy_j_kg"), plan["totals"]["energy_j_kg"].to_string());
        // Another scenario, another key; asked alone, the same row.
        assert_ne!(value(1, "key"), value(3, "key"));
        assert_eq!(cases.answers(&draft, &[3], &())[0], rows[3]);
    }
}
