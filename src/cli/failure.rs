//! Bad input and failures, reported on standard error with the position underlined.

use std::{
    error::Error,
    fmt,
    io::{self, IsTerminal, Write},
    ops::Range,
    path::Path,
};

use chta::{
    chain::csv::{CsvFileError, CsvProblem},
    progress::Cancelled,
    scenario::{Place, ScenarioProblem, ScenarioProblems},
    study::PipelineError,
};
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents, NamedSource, SourceCode,
    SourceSpan, SpanContents,
};

use super::{hints, inputs};

/// Why a command ends with status 2.
#[derive(Debug)]
pub(crate) enum Failure {
    /// One sentence.
    Message(String),
    /// Problems of a scenario.
    Scenario(ScenarioProblems),
    /// Problems of a CSV file.
    Csv(CsvFileError),
}

impl Failure {
    /// One sentence.
    pub(crate) fn message(sentence: impl Into<String>) -> Self {
        Self::Message(sentence.into())
    }

    /// The message of a library error, with the options that mend it.
    pub(crate) fn of(error: &(dyn Error + 'static)) -> Self {
        Self::Message(hints::sentence(error))
    }

    /// The same for an error about a file: the message begins with the file's name unless the error already names it.
    pub(crate) fn about(file: &Path, error: &(dyn Error + 'static)) -> Self {
        let sentence = hints::sentence(error);
        Self::Message(if hints::names(error, file) { sentence } else { format!("{}: {sentence}", file.display()) })
    }

    /// Reports it on standard error: one sentence for each problem, with the line and the field underlined where there is one.
    pub(crate) fn tell(&self) {
        let mut text = String::new();
        for pointed in self.pointed() {
            let mut report = String::new();
            // Writing to a String cannot fail.
            let _ = handler().render_report(&mut report, &pointed);
            text.push_str(report.trim_start());
        }
        // An error on writing to standard error cannot be reported.
        let _ = io::stderr().write_all(inputs::shown(&text).as_bytes());
    }

    /// All in one sentence, for an answer.
    pub(crate) fn sentence(&self) -> String {
        inputs::shown(&self.pointed().into_iter().map(|pointed| pointed.sentence).collect::<Vec<_>>().join("; "))
    }

    /// Whether an option of the command line is at fault.
    pub(crate) fn is_of_option(&self) -> bool {
        matches!(self, Self::Scenario(problems) if problems.problems.iter().any(|problem| matches!(problem.place, Place::Option(_))))
    }

    /// Every problem with its position.
    fn pointed(&self) -> Vec<Pointed> {
        match self {
            Self::Message(sentence) => vec![Pointed::bare(sentence.clone())],
            Self::Scenario(problems) => problems.problems.iter().map(|problem| Pointed::in_scenario(problems, problem)).collect(),
            Self::Csv(error @ CsvFileError::Problems { path, problems }) => {
                let name = path.display().to_string();
                let mut pointed: Vec<_> = problems.problems.iter().map(|problem| Pointed::in_csv(&name, problem)).collect();
                if problems.more > 0 {
                    pointed.push(Pointed::bare(format!("{name}: and {} more problems", problems.more)));
                }
                if pointed.is_empty() { vec![Pointed::bare(error.to_string())] } else { pointed }
            }
            Self::Csv(error) => vec![Pointed::bare(error.to_string())],
        }
    }
}

impl From<PipelineError> for Failure {
    fn from(error: PipelineError) -> Self {
        match error {
            PipelineError::Csv(error) => Self::Csv(error),
            other => Self::of(&other),
        }
    }
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Self::Message(format!("the result cannot be written as JSON ({error})"))
    }
}

impl From<Cancelled> for Failure {
    fn from(cancelled: Cancelled) -> Self {
        Self::of(&cancelled)
    }
}

impl From<CsvFileError> for Failure {
    fn from(error: CsvFileError) -> Self {
        Self::Csv(error)
    }
}

/// How problems are drawn: in colour on a terminal, plain elsewhere, without line wrapping.
fn handler() -> GraphicalReportHandler {
    let mut theme = match (io::stderr().is_terminal(), std::env::var_os("NO_COLOR")) {
        (true, None) => GraphicalTheme::unicode(),
        (true, Some(_)) => GraphicalTheme::unicode_nocolor(),
        (false, _) => GraphicalTheme::none(),
    };
    // The same prefix style as `warning:` and the errors of clap.
    "error:".clone_into(&mut theme.characters.error);
    GraphicalReportHandler::new_themed(theme).with_wrap_lines(false).with_break_words(false)
}

/// Longer lines are not shown: the sentence gives their position, and a terminal has no room for them.
const LONGEST_LINE: usize = 200;

/// A span with the lines that contain it and one line on either side, as they are shown.
fn around<'a>(source: &'a str, span: &Range<usize>) -> &'a str {
    let line_start = |end: usize| source.get(..end).and_then(|before| before.rfind('\n'));
    let line_end = |start: usize| source.get(start..).and_then(|after| after.find('\n')).map(|length| start + length);
    let first = line_start(span.start).and_then(line_start).map_or(0, |newline| newline + 1);
    let last = line_end(span.end).and_then(|newline| line_end(newline + 1)).unwrap_or(source.len());
    source.get(first..last).unwrap_or(source)
}

/// One problem and the text that it points into.
struct Pointed {
    sentence: String,
    source: Option<Box<dyn SourceCode>>,
    span: Option<SourceSpan>,
}

impl Pointed {
    fn bare(sentence: String) -> Self {
        Self { sentence, source: None, span: None }
    }

    fn in_scenario(problems: &ScenarioProblems, problem: &ScenarioProblem) -> Self {
        let sentence = problems.sentence(problem);
        let shown =
            problems.span(problem).filter(|span| around(&problems.source, span).lines().all(|line| line.len() <= LONGEST_LINE));
        let Some(span) = shown else { return Self::bare(sentence) };
        let source = NamedSource::new(&problems.name, problems.source.clone());
        Self { sentence, source: Some(Box::new(source)), span: Some(span.into()) }
    }

    fn in_csv(name: &str, problem: &CsvProblem) -> Self {
        if problem.text.is_empty() {
            return Self::bare(format!("{name}: {problem}"));
        }
        let line = LineOfFile { name: name.to_owned(), number: problem.line, text: problem.text.clone() };
        let span = SourceSpan::from(problem.span.clone());
        Self { sentence: format!("{name}: {problem}"), source: Some(Box::new(line)), span: Some(span) }
    }
}

impl fmt::Debug for Pointed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl fmt::Display for Pointed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl Error for Pointed {}

impl Diagnostic for Pointed {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.span.and(self.source.as_deref())
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.span?;
        Some(Box::new(std::iter::once(LabeledSpan::new_with_span(None, span))))
    }
}

/// One line of a file that is too large, or not valid text, to be held in memory whole.
#[derive(Debug)]
struct LineOfFile {
    name: String,
    number: u64,
    text: String,
}

impl SourceCode for LineOfFile {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        _before: usize,
        _after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        if span.offset() + span.len() > self.text.len() {
            return Err(MietteError::OutOfBounds);
        }
        let whole = SourceSpan::from(0..self.text.len());
        let line = usize::try_from(self.number).unwrap_or(usize::MAX).saturating_sub(1);
        let name = self.name.clone();
        Ok(Box::new(MietteSpanContents::new_named(name, self.text.as_bytes(), whole, line, 0, 1)))
    }
}
