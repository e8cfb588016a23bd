//! Many cases of one scenario, each of which sets some of its keys: one row a case.

use std::{
    collections::BTreeSet,
    fmt::Write as _,
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
    columns: Vec<String>,
    /// The line of each case, and its cells.
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
    /// A header alone.
    #[error("{}: found no case, expected a row for each below the header", file.display())]
    Empty {
        /// The file.
        file: PathBuf,
    },
}

impl CaseTable {
    /// Reads a table (CSV).
    ///
    /// # Errors
    /// [`CaseTableError`].
    pub fn read(file: &Path) -> Result<Self, CaseTableError> {
        let failed = |problem| CaseTableError::Csv { file: file.to_path_buf(), problem };
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_path(file).map_err(failed)?;
        let columns: Vec<String> = reader.headers().map_err(failed)?.iter().map(str::to_owned).collect();
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
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(failed)?;
            let line = record.position().map_or(0, csv::Position::line);
            rows.push((line, record.iter().map(str::to_owned).collect()));
        }
        if rows.is_empty() {
            return Err(CaseTableError::Empty { file: file.to_path_buf() });
        }
        Ok(Self { name: file.display().to_string(), columns, rows })
    }

    /// How many cases there are.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// The keys of a case, set in the scenario.
    fn drafted(&self, draft: &Draft, case: usize) -> Draft {
        let mut draft = draft.clone();
        let (line, cells) = &self.rows[case];
        let place = format!("{}, line {line}", self.name);
        for (column, cell) in self.columns.iter().zip(cells).filter(|(_, cell)| !cell.is_empty()) {
            draft.entries.set(&place, &format!("{column}={cell}"));
        }
        draft
    }

    /// The names of the columns of rows: those of the cases between their number and key, and the answers.
    pub fn row_columns(&self) -> Vec<String> {
        let answers = ANSWERS.iter().map(|(name, _)| (*name).to_owned());
        ["case", "key"].into_iter().map(str::to_owned).chain(self.columns.iter().cloned()).chain(answers).collect()
    }
}

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
    /// The name of a case among answers: the SHA-256 of the scenario as used and of the version; empty where the scenario is refused.
    /// Files count by their names.
    pub fn key(&self, draft: &Draft, case: usize) -> String {
        let draft = self.drafted(draft, case);
        draft.validated(true).map_or_else(
            |_| String::new(),
            |scenario| {
                let document = scenario_document(&scenario, &|path| relative_name(&draft.base.join(path)));
                let digest = Sha256::digest(format!("{} {document}", env!("CARGO_PKG_VERSION")));
                digest.iter().fold(String::with_capacity(64), |mut text, byte| {
                    // Writing to a String cannot fail.
                    let _ = write!(text, "{byte:02x}");
                    text
                })
            },
        )
    }

    /// Plans some cases, all threads together. The rows do not depend on which cases are asked for at once, nor on the threads.
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
