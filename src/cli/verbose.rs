//! What `--verbose` says on standard error: the files read, the settings used, and how long each stage took. No answer depends on it.

use std::{
    collections::BTreeSet,
    io::{self, Write as _},
    path::{Path, PathBuf},
    sync::{Mutex, OnceLock, PoisonError},
    time::{Duration, Instant},
};

use chta::{
    graph::{AUTO_POINTS_PER_SEGMENT, PointSpacing, SearchOptions},
    progress::{Stage, Step},
    study::sha256_of,
};

use super::inputs;

/// The record of this run; unset without the option.
static RECORD: OnceLock<Record> = OnceLock::new();

/// When the program began, and what was said so far.
#[derive(Debug)]
struct Record {
    began: Instant,
    said: Mutex<Said>,
}

#[derive(Debug, Default)]
struct Said {
    files: BTreeSet<PathBuf>,
    /// The stage under way and when its time was last counted.
    under_way: Option<(Stage, Instant)>,
    /// The last line about a step.
    line: String,
    /// The time of each stage so far, in the order in which they began.
    spent: Vec<(Stage, Duration)>,
}

impl Said {
    /// Counts the time since the last report for the stage under way, and goes on with another.
    fn count(&mut self, next: Option<Stage>) {
        let now = Instant::now();
        if let Some((stage, since)) = self.under_way {
            let time = now - since;
            match self.spent.iter_mut().find(|(known, _)| *known == stage) {
                Some((_, sum)) => *sum += time,
                None => self.spent.push((stage, time)),
            }
        }
        self.under_way = next.map(|stage| (stage, now));
    }
}

impl Record {
    fn with<T>(&self, change: impl FnOnce(&mut Said) -> T) -> T {
        // A panic in another thread cannot leave the record inconsistent.
        change(&mut self.said.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Begins to say what is done.
pub(crate) fn begin() {
    // Called once.
    let _ = RECORD.set(Record { began: Instant::now(), said: Mutex::default() });
}

/// Says a line, which is made only if the option was given.
pub(crate) fn say(line: impl FnOnce() -> String) {
    if let Some(record) = RECORD.get() {
        let after_s = record.began.elapsed().as_secs_f64();
        // An error on writing to standard error cannot be reported.
        let _ = writeln!(io::stderr(), "info: {after_s:.3} s: {}", inputs::shown(&line()));
    }
}

/// Says that a file is read, with its checksum; once for each file. An error is left to the reader.
pub(crate) fn read(path: &Path) {
    if RECORD.get().is_some_and(|record| record.with(|said| said.files.insert(path.to_path_buf())))
        && let Ok(sha256) = sha256_of(path)
    {
        say(|| format!("read {}, sha256 {sha256}", path.display()));
    }
}

/// Says the settings of an analysis: the scenario as used, and how the nodes are spaced.
pub(crate) fn settings(scenario: &serde_json::Value, search: &SearchOptions) {
    say(|| format!("scenario {scenario}"));
    say(|| match search.spacing {
        Some(PointSpacing::PerSegment(points)) => format!("nodes: {points} points inside each segment"),
        Some(PointSpacing::AtMostM(spacing_m)) => format!("nodes: at most {spacing_m} m apart"),
        None => format!("nodes: the first of {AUTO_POINTS_PER_SEGMENT:?} points inside each segment that finds a path"),
    });
}

/// Counts the time of a step's stage, and says its line if that is new.
pub(crate) fn step(step: &Step, line: impl FnOnce() -> Option<String>) {
    let Some(record) = RECORD.get() else { return };
    let is_new = record.with(|said| {
        said.count(Some(step.stage));
        line().filter(|line| said.line != *line).inspect(|line| said.line.clone_from(line))
    });
    if let Some(line) = is_new {
        say(|| line);
    }
}

/// The stage under way is over.
pub(crate) fn stage_is_over() {
    if let Some(record) = RECORD.get() {
        record.with(|said| said.count(None));
    }
}

/// Says how long the stages took.
pub(crate) fn end() {
    let Some(record) = RECORD.get() else { return };
    let spent = record.with(|said| {
        said.count(None);
        std::mem::take(&mut said.spent)
    });
    for (stage, time) in spent {
        say(|| format!("{} took {:.3} s", stage.name(), time.as_secs_f64()));
    }
    say(|| "all done".to_owned());
}
