//! The problems of a scenario, with their positions.

use std::{fmt, ops::Range};

use super::Place;

/// The key that a problem is about, as it was given, known or not.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct KeyPath {
    /// The table; empty if the key is outside any table, or if the problem concerns the whole text.
    pub table: String,
    /// The name in that table; empty if the problem concerns the whole table.
    pub name: String,
}

impl KeyPath {
    /// The key of this name in this table.
    pub fn new(table: &str, name: &str) -> Self {
        Self { table: table.to_owned(), name: name.to_owned() }
    }

    /// Whether it is one of these keys of a table.
    pub fn is_one_of(&self, table: &str, names: &[&str]) -> bool {
        self.table == table && names.contains(&self.name.as_str())
    }
}

/// What kind of problem a key has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProblemKind {
    /// The text is not a scenario, or an assignment is not of the form `table.key=value`.
    Syntax,
    /// There is no such key or table.
    Unknown,
    /// The value is not one that the key takes.
    Value,
    /// The key is absent and needed.
    Missing,
    /// The key excludes another key that was given.
    Conflict,
    /// The key has no meaning with the other keys that were given.
    Misplaced,
}

/// One problem of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioProblem {
    /// The key concerned. Decisions use it and [`kind`](Self::kind), never the message.
    pub key: KeyPath,
    /// The kind of problem.
    pub kind: ProblemKind,
    /// Its position: in the file, in a setting outside the file, or none (for a missing key).
    pub place: Place,
    /// The found and the expected value, in one sentence without a full stop.
    pub message: String,
    /// How to mend it.
    pub help: String,
}

/// All problems of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioProblems {
    /// The file's name, as the user gave it; empty without a file.
    pub name: String,
    /// The file's text, into which problems point; empty without a file.
    pub source: String,
    /// The problems, in the order of the file.
    pub problems: Vec<ScenarioProblem>,
}

impl ScenarioProblems {
    /// The bytes of the source that a problem points at.
    pub fn span(&self, problem: &ScenarioProblem) -> Option<Range<usize>> {
        match &problem.place {
            Place::File(span) if span.end <= self.source.len() => Some(span.clone()),
            _ => None,
        }
    }
}

impl ScenarioProblems {
    /// One problem as a sentence that begins with its position.
    pub fn sentence(&self, problem: &ScenarioProblem) -> String {
        let place = match &problem.place {
            Place::File(span) => {
                let (line, column) = line_and_column(&self.source, span.start);
                format!("{}:{line}:{column}: ", self.name)
            }
            Place::Option(option) => format!("{option}: "),
            Place::Nowhere if self.name.is_empty() => String::new(),
            Place::Nowhere => format!("{}: ", self.name),
        };
        format!("{place}{}; {}", problem.message, problem.help)
    }
}

impl fmt::Display for ScenarioProblems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            f.write_str(&self.sentence(problem))?;
        }
        Ok(())
    }
}

impl std::error::Error for ScenarioProblems {}

/// Line and column, both from 1, the column in characters.
fn line_and_column(source: &str, byte: usize) -> (usize, usize) {
    let before = source.get(..byte).unwrap_or(source);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
