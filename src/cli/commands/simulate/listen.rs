//! The listener of the trials: it writes the file of landings and shows progress on the terminal.

use std::{
    io::{self, BufWriter},
    path::Path,
    time::Instant,
};

use chta::{
    progress::{Detail, Step},
    report::MapKnowledge,
    report::landings::{CsvLandings, LandingRow, LandingWriter},
    terrain::MapProjection,
    uncertainty::{HopRecord, Observer, Policy},
};

use super::trials::on_dem;
use crate::cli::{Failure, load::Loaded, output::Pending, progress::Progress};

/// The file of landings, written while the trials run.
pub(super) struct RowFile<'a> {
    writer: Box<dyn LandingWriter>,
    /// `None` for standard output.
    pending: Option<Pending<'a>>,
    known: MapKnowledge,
    projection: Option<MapProjection>,
}

impl<'a> RowFile<'a> {
    /// Opens it in the format of its extension.
    pub(super) fn begin(path: &'a Path, loaded: &Loaded) -> Result<Self, Failure> {
        let projection = loaded.prepared.projection.clone().filter(|_| on_dem(loaded));
        let known = match (on_dem(loaded), &projection) {
            (false, _) => MapKnowledge::Nothing,
            (true, None) => MapKnowledge::Metres,
            (true, Some(_)) => MapKnowledge::Projection,
        };
        let unwritten = |error: io::Error| Failure::message(format!("{}: cannot be written ({error})", path.display()));
        if path == Path::new("-") {
            let writer = CsvLandings::begin(BufWriter::new(io::stdout()), known).map_err(unwritten)?;
            return Ok(Self { writer: Box::new(writer), pending: None, known, projection });
        }
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let writer: Box<dyn LandingWriter>;
        let pending;
        match ending.as_deref() {
            Some("csv") => {
                pending = Pending::begin(path)?;
                let out = BufWriter::with_capacity(1 << 16, pending.handle()?);
                writer = Box::new(CsvLandings::begin(out, known).map_err(unwritten)?);
            }
            Some("parquet") => (pending, writer) = parquet(path, loaded, known)?,
            _ => {
                return Err(Failure::message(format!(
                    "--output: '{}' ends neither in .csv nor in .parquet: give the landings one of the two names",
                    path.display()
                )));
            }
        }
        Ok(Self { writer, pending: Some(pending), known, projection })
    }

    /// Finishes the file and renames it to its final name.
    fn keep(mut self) -> Result<(), Failure> {
        match self.writer.finish() {
            Err(error) if self.pending.is_none() && error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
            Err(error) => return Err(Failure::message(format!("the landings cannot be written ({error}): free some space"))),
            Ok(()) => {}
        }
        drop(self.writer);
        self.pending.map_or(Ok(()), Pending::keep)
    }
}

/// A Parquet file, with scenario and seed in its metadata.
#[cfg(feature = "parquet")]
fn parquet<'a>(path: &'a Path, loaded: &Loaded, known: MapKnowledge) -> Result<(Pending<'a>, Box<dyn LandingWriter>), Failure> {
    use chta::report::landings::ParquetLandings;

    let seed = loaded.scenario.uncertainty.unwrap_or_default().seed;
    let words = [
        ("chta_version", env!("CARGO_PKG_VERSION").to_owned()),
        ("scenario", loaded.document.to_string()),
        ("seed", seed.to_string()),
        ("inputs", serde_json::to_string(&loaded.inputs)?),
    ];
    let pending = Pending::begin(path)?;
    let out = BufWriter::with_capacity(1 << 16, pending.handle()?);
    let writer = ParquetLandings::begin(out, known, &words)
        .map_err(|error| Failure::message(format!("{}: cannot be written ({error})", path.display())))?;
    Ok((pending, Box::new(writer)))
}

/// Parquet without the feature `parquet`: always an error.
#[cfg(not(feature = "parquet"))]
fn parquet<'a>(path: &'a Path, _loaded: &Loaded, _known: MapKnowledge) -> Result<(Pending<'a>, Box<dyn LandingWriter>), Failure> {
    Err(Failure::message(format!(
        "--output: '{}' is a Parquet file, but this chta was built without Parquet: build it with `cargo install --path . --features parquet`, or \
         give a name that ends in .csv",
        path.display()
    )))
}

/// Writes landings as they are flown.
pub(super) struct Listener<'a> {
    rows: Option<RowFile<'a>>,
    policy: Policy,
    failed: Option<io::Error>,
    progress: &'a Progress,
}

impl<'a> Listener<'a> {
    pub(super) fn new(rows: Option<RowFile<'a>>, policy: Policy, progress: &'a Progress) -> Self {
        Self { rows, policy, failed: None, progress }
    }

    /// The trials of another policy follow.
    pub(super) const fn begin(&mut self, policy: Policy) {
        self.policy = policy;
    }

    /// The write error, which replaces the simulation's error that it was stopped.
    pub(super) fn failure(&mut self) -> Option<Failure> {
        let error = self.failed.take()?;
        Some(Failure::message(format!("the landings cannot be written ({error}): free some space")))
    }

    /// Finishes the file.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        if let Some(failure) = self.failure() {
            return Err(failure);
        }
        self.rows.map_or(Ok(()), RowFile::keep)
    }
}

impl Observer for Listener<'_> {
    fn wants_records(&self) -> bool {
        self.rows.is_some()
    }

    fn hop(&mut self, hop: &HopRecord) {
        let Some(rows) = self.rows.as_mut().filter(|_| self.failed.is_none()) else { return };
        if let Some(row) = LandingRow::new(hop, self.policy, rows.known != MapKnowledge::Nothing, rows.projection.as_ref())
            && let Err(error) = rows.writer.write(&row)
        {
            // A closed pipe is success: the reader needs no more.
            if rows.pending.is_none() && error.kind() == io::ErrorKind::BrokenPipe {
                self.rows = None;
            } else {
                self.failed = Some(error);
                self.progress.stop();
            }
        }
    }
}

/// The lines of the trials of a policy, which begin now.
pub(super) fn trials_line(policy: Policy) -> impl Fn(&Step) -> Option<String> + Sync {
    let begun = Instant::now();
    move |step| match (step.detail, step.of) {
        (Detail::Trials { reached_goal }, Some(of)) => {
            Some(progress_text(policy, (step.done, of), reached_goal, begun.elapsed().as_secs_f64()))
        }
        _ => None,
    }
}

/// The progress line: trials done, trials per second and time left.
#[expect(clippy::cast_precision_loss, reason = "for reading")]
fn progress_text(policy: Policy, (done, of): (u64, u64), reached_goal: u64, elapsed_s: f64) -> String {
    let rate = done as f64 / elapsed_s.max(1e-9);
    let left_s = (of - done.min(of)) as f64 / rate.max(1e-9);
    format!(
        "{}: {done} of {of} trials, {rate:.0} a second, {left_s:.0} s left at most, {:.4} reach the goal",
        policy.name(),
        reached_goal as f64 / done.max(1) as f64
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_has_rate_and_time_left() {
        assert_eq!(
            progress_text(Policy::Replan, (3000, 9000), 1500, 2.0),
            "replan: 3000 of 9000 trials, 1500 a second, 4 s left at most, 0.5000 reach the goal"
        );
    }
}
