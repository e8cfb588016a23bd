//! What is wrong with a scenario, with its place.

use std::{fmt, ops::Range};

use super::Place;

/// One thing that is wrong with a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioProblem {
    /// Where: in the file, on the command line, or nowhere in particular (something missing).
    pub place: Place,
    /// What was found and what was expected, in one sentence without a full stop.
    pub message: String,
    /// How to mend it.
    pub help: String,
}

/// All that is wrong with a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioProblems {
    /// The file's name, as the user gave it; empty where there is none.
    pub name: String,
    /// The file's text, to point into; empty where there is none.
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
    /// One problem as a sentence that begins with its place.
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
