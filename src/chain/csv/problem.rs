//! What is wrong with a CSV file, as plain data that names the place.

use std::{fmt, io, ops::Range, path::PathBuf};

/// How many problems of one file are told in full; the rest is counted. More would scroll the first off the screen.
const TOLD_AT_MOST: usize = 50;

/// One thing that is wrong with a CSV file.
///
/// Its `Display` is one sentence; [`text`](Self::text) and [`span`](Self::span) are for underlining the field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsvProblem {
    /// Line of the file, from 1.
    pub line: u64,
    /// Column of the field's first character in that line, from 1, counted in characters; `None` where the whole line is meant.
    pub column: Option<u64>,
    /// Name of the CSV column, where the problem belongs to one.
    pub name: Option<String>,
    /// The line, or a window of it around the field where it is long (then with `...` at the ends that are cut).
    pub text: String,
    /// The field's bytes within [`text`](Self::text); empty for an empty field.
    pub span: Range<usize>,
    /// What stands there.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// How to mend it.
    pub help: String,
}

impl fmt::Display for CsvProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}", self.line)?;
        if let Some(column) = self.column {
            write!(f, ", column {column}")?;
        }
        if let Some(name) = &self.name {
            write!(f, " ({name})")?;
        }
        write!(f, ": found {}, expected {}; {}", self.found, self.expected, self.help)
    }
}

/// All that is wrong with a CSV file, in the order of its lines.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CsvProblems {
    /// The problems told in full, at most 50.
    pub problems: Vec<CsvProblem>,
    /// How many more there are.
    pub more: usize,
}

impl CsvProblems {
    /// Takes note of a problem, which is only put into words while there is room for it.
    pub(super) fn push(&mut self, tell: impl FnOnce() -> CsvProblem) {
        if self.problems.len() < TOLD_AT_MOST {
            self.problems.push(tell());
        } else {
            self.more += 1;
        }
    }

    /// Whether nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.problems.is_empty()
    }

    /// The same problems in the order of the file.
    #[must_use]
    pub(super) fn sorted(mut self) -> Self {
        self.problems.sort_by_key(|problem| (problem.line, problem.column));
        self
    }

    /// One line per problem, each begun with `prefix`.
    fn write_lines(&self, f: &mut fmt::Formatter<'_>, prefix: &str) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            let end = if i == 0 { "" } else { "\n" };
            write!(f, "{end}{prefix}{problem}")?;
        }
        match self.more {
            0 => Ok(()),
            1 => write!(f, "\n{prefix}and 1 more problem"),
            more => write!(f, "\n{prefix}and {more} more problems"),
        }
    }
}

impl fmt::Display for CsvProblems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_lines(f, "")
    }
}

impl std::error::Error for CsvProblems {}

/// Why a CSV file gives no data.
#[derive(Debug)]
#[non_exhaustive]
pub enum CsvFileError {
    /// The file cannot be read.
    Read {
        /// Which file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// Its text has problems.
    Problems {
        /// Which file.
        path: PathBuf,
        /// All of them.
        problems: CsvProblems,
    },
}

impl fmt::Display for CsvFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, source } => {
                write!(f, "{}: cannot be read ({source}), expected a CSV file: check the path and its permissions", path.display())
            }
            Self::Problems { path, problems } => problems.write_lines(f, &format!("{}: ", path.display())),
        }
    }
}

impl std::error::Error for CsvFileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read { source, .. } => Some(source),
            Self::Problems { problems, .. } => Some(problems),
        }
    }
}

/// Reads a file whole and hands its bytes to a reader.
pub(super) fn read_file<T>(path: PathBuf, reader: impl FnOnce(&[u8]) -> Result<T, CsvProblems>) -> Result<T, CsvFileError> {
    match std::fs::read(&path) {
        Ok(bytes) => reader(&bytes).map_err(|problems| CsvFileError::Problems { path, problems }),
        Err(source) => Err(CsvFileError::Read { path, source }),
    }
}
