//! The problems of a CSV file as plain data, each with its position in the file.

use std::{fmt, io, ops::Range, path::PathBuf};

/// How many problems of one file are listed; the others are only counted. A longer list would scroll the first problem off
/// the screen.
const LISTED_AT_MOST: usize = 50;

/// One problem of a CSV file.
///
/// Its `Display` is one sentence; [`text`](Self::text) and [`span`](Self::span) are for underlining the field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsvProblem {
    /// Line of the file, from 1.
    pub line: u64,
    /// Column of the field's first character in that line, from 1, counted in characters; `None` if the problem concerns the
    /// whole line.
    pub column: Option<u64>,
    /// Name of the CSV column, if the problem belongs to one.
    pub name: Option<String>,
    /// The line, or an excerpt around the field of a long line (with `...` where it is cut).
    pub text: String,
    /// The field's bytes within [`text`](Self::text); empty for an empty field.
    pub span: Range<usize>,
    /// The text or value found.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// How to correct it.
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

/// All problems of a CSV file, in the order of its lines.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CsvProblems {
    /// The listed problems, at most 50.
    pub problems: Vec<CsvProblem>,
    /// How many more problems there are.
    pub more: usize,
}

impl CsvProblems {
    /// Adds a problem; its message is only composed if it is listed.
    pub(super) fn push(&mut self, problem: impl FnOnce() -> CsvProblem) {
        if self.problems.len() < LISTED_AT_MOST {
            self.problems.push(problem());
        } else {
            self.more += 1;
        }
    }

    /// Whether there is no problem.
    pub fn is_empty(&self) -> bool {
        self.problems.is_empty()
    }

    /// The same problems, sorted by their position in the file.
    #[must_use]
    pub(super) fn sorted(mut self) -> Self {
        self.problems.sort_by_key(|problem| (problem.line, problem.column));
        self
    }

    /// Writes one line per problem, each with `prefix` in front.
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

/// Why no data could be read from a CSV file.
#[derive(Debug)]
#[non_exhaustive]
pub enum CsvFileError {
    /// The file cannot be read.
    Read {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// The text of the file has problems.
    Problems {
        /// The file.
        path: PathBuf,
        /// All problems found.
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

/// Reads a whole file and passes its bytes to `reader`.
pub(super) fn read_file<T>(path: PathBuf, reader: impl FnOnce(&[u8]) -> Result<T, CsvProblems>) -> Result<T, CsvFileError> {
    match std::fs::read(&path) {
        Ok(bytes) => reader(&bytes).map_err(|problems| CsvFileError::Problems { path, problems }),
        Err(source) => Err(CsvFileError::Read { path, source }),
    }
}
