//! The file of landings, written while the trials run.

use std::{
    io::{self, BufWriter},
    path::Path,
};

use chta::{
    report::{
        MapKnowledge,
        landings::{CsvLandings, LandingColumns, LandingRow, LandingWriter},
    },
    study::{Drift, Drifted, SimulateOptions, Simulated, Trials},
    terrain::MapProjection,
    uncertainty::{HopRecord, Observer, Policy, RestDensity, TrialRecord},
};

use super::{Failure, load::Loaded, output::Pending, progress::Progress};

/// The file of landings, written while the trials run.
pub(crate) struct RowFile<'a> {
    writer: Box<dyn LandingWriter>,
    /// `None` for standard output.
    pending: Option<Pending<'a>>,
    known: MapKnowledge,
    projection: Option<MapProjection>,
}

impl<'a> RowFile<'a> {
    /// Opens it in the format of its extension; `drawn`: with the errors drawn for each hop.
    pub(crate) fn begin(path: &'a Path, drawn: bool, loaded: &Loaded) -> Result<Self, Failure> {
        let on_dem = loaded.case.is_on_dem();
        let projection = loaded.case.prepared.projection.clone().filter(|_| on_dem);
        let known = match (on_dem, &projection) {
            (false, _) => MapKnowledge::Nothing,
            (true, None) => MapKnowledge::Metres,
            (true, Some(_)) => MapKnowledge::Projection,
        };
        let columns = LandingColumns { known, drawn };
        let unwritten = |error: io::Error| Failure::message(format!("{}: cannot be written ({error})", path.display()));
        if path == Path::new("-") {
            let writer = CsvLandings::begin(BufWriter::new(io::stdout()), columns).map_err(unwritten)?;
            return Ok(Self { writer: Box::new(writer), pending: None, known, projection });
        }
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let writer: Box<dyn LandingWriter>;
        let pending;
        match ending.as_deref() {
            Some("csv") => {
                pending = Pending::begin(path)?;
                let out = BufWriter::with_capacity(1 << 16, pending.handle()?);
                writer = Box::new(CsvLandings::begin(out, columns).map_err(unwritten)?);
            }
            Some("parquet") => (pending, writer) = parquet(path, loaded, columns)?,
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
fn parquet<'a>(path: &'a Path, loaded: &Loaded, columns: LandingColumns) -> Result<(Pending<'a>, Box<dyn LandingWriter>), Failure> {
    use chta::report::landings::ParquetLandings;

    let seed = loaded.case.scenario.uncertainty.clone().unwrap_or_default().seed;
    let words = [
        ("chta_version", env!("CARGO_PKG_VERSION").to_owned()),
        ("scenario", loaded.record.scenario.to_string()),
        ("seed", seed.to_string()),
        ("inputs", serde_json::to_string(&loaded.record.inputs)?),
    ];
    let pending = Pending::begin(path)?;
    let out = BufWriter::with_capacity(1 << 16, pending.handle()?);
    let writer = ParquetLandings::begin(out, columns, &words)
        .map_err(|error| Failure::message(format!("{}: cannot be written ({error})", path.display())))?;
    Ok((pending, Box::new(writer)))
}

/// Parquet without the feature `parquet`: always an error.
#[cfg(not(feature = "parquet"))]
fn parquet<'a>(
    path: &'a Path,
    _loaded: &Loaded,
    _columns: LandingColumns,
) -> Result<(Pending<'a>, Box<dyn LandingWriter>), Failure> {
    Err(Failure::message(format!(
        "--output: '{}' is a Parquet file, but this chta was built without Parquet: build it with `cargo install --path . --features parquet`, or \
         give a name that ends in .csv",
        path.display()
    )))
}

/// Writes landings as they are flown, and tells the progress which policy is flown.
pub(crate) struct Listener<'a> {
    rows: Option<RowFile<'a>>,
    density: Option<&'a mut RestDensity>,
    policy: Policy,
    failed: Option<io::Error>,
    progress: &'a Progress,
}

impl<'a> Listener<'a> {
    /// Flies trials, writes their landings and counts where they rest.
    pub(crate) fn fly(
        trials: Trials,
        rows: Option<RowFile<'a>>,
        density: Option<&'a mut RestDensity>,
        progress: &'a Progress,
    ) -> Result<Simulated, Failure> {
        let mut listener = Self { rows, density, policy: Policy::OpenLoop, failed: None, progress };
        let flown = trials.fly(&mut listener, progress);
        // A write error replaces the error of the trials that it stopped.
        if let Some(error) = listener.failed {
            return Err(Failure::message(format!("the landings cannot be written ({error}): free some space")));
        }
        let flown = flown?;
        listener.rows.map_or(Ok(()), RowFile::keep)?;
        Ok(flown)
    }
}

impl<'a> Listener<'a> {
    /// Flies trials without a plan, and counts where they rest.
    pub(crate) fn fly_drift(
        trials: Drift,
        options: &SimulateOptions,
        density: Option<&'a mut RestDensity>,
        progress: &'a Progress,
    ) -> Result<Drifted, Failure> {
        let mut listener = Self { rows: None, density, policy: Policy::OpenLoop, failed: None, progress };
        Ok(trials.fly(options, &mut listener, progress)?)
    }
}

impl Observer for Listener<'_> {
    fn wants_records(&self) -> bool {
        self.rows.is_some() || self.density.is_some()
    }

    fn begin(&mut self, policy: Policy) {
        self.policy = policy;
        self.progress.begin_trials(policy);
    }

    fn trial(&mut self, trial: &TrialRecord) {
        if let Some(density) = &mut self.density {
            density.trial(trial);
        }
    }

    fn hop(&mut self, hop: &HopRecord) {
        if let Some(density) = &mut self.density {
            density.hop(hop);
        }
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
