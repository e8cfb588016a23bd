//! A scenario whose heading is not controlled.

use super::{Draft, OpenError, Purpose};
use crate::{
    scenario::{Key, Place, scenario_document},
    study::{CaseRecord, Drift, checksums, open::AskError, scenario_files},
};

/// A scenario whose heading is not controlled, opened for its trials.
#[derive(Clone, Debug)]
pub struct OpenDrift {
    /// The trials, before they are flown.
    pub trials: Drift,
    /// The head of the document.
    pub record: CaseRecord,
    /// The files that are read.
    pub files: Vec<std::path::PathBuf>,
}

impl Draft {
    /// Opens the trials of a scenario whose heading is not controlled; `None` for any other scenario.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn drift(&self) -> Result<Option<OpenDrift>, AskError> {
        if !self.entries.ask_for_drift() {
            return Ok(None);
        }
        let (scenario, wording) = (self.validated(false)?, &self.wording);
        let keys = scenario.lacks_on_a_dem();
        if !keys.is_empty() {
            return Err(OpenError::Lacking { name: self.name.clone(), keys, terrain: "a DEM" }.into());
        }
        let Some(trials) = Drift::of(&scenario, &self.base)? else { return Ok(None) };
        let unused = Purpose::Simulate.unused(&self.entries, &scenario, wording);
        let of_plans = self.entries.given().filter(|(key, place)| is_of_plans(key, place)).map(|(key, _)| {
            let path = key.path();
            format!("{path} has no effect where uncertainty.heading is \"uncontrolled\": it chooses or limits planned hops, and none are planned")
        });
        let warnings = unused.into_iter().chain(Purpose::replaced(&self.entries)).chain(of_plans).collect();
        let document = scenario_document(&scenario, &|path| (wording.file_name)(&self.base.join(path)));
        let files = scenario_files(&scenario, &self.base);
        let inputs = checksums(&files, &wording.file_name)?;
        let record = CaseRecord { scenario: document, inputs, warnings, crs: trials.crs().cloned() };
        Ok(Some(OpenDrift { trials, record, files }))
    }
}

/// Whether a key is about plans alone: what chooses among paths, if it was set beside the file, and what limits commands or totals, wherever it
/// was, for silence about a limit that is not kept would be a promise.
fn is_of_plans(key: &Key, place: &Place) -> bool {
    match (key.table, key.name) {
        ("budget", _)
        | (
            "hopper",
            "takeoff_angle_min_deg"
            | "takeoff_angle_max_deg"
            | "apex_height_max_m"
            | "flight_time_max_s"
            | "takeoff_speed_min_m_s"
            | "takeoff_speed_levels_m_s"
            | "takeoff_speed_step_m_s"
            | "takeoff_angle_step_deg"
            | "heading_step_deg",
        ) => true,
        ("search" | "derating", _) => matches!(place, Place::Option(_)),
        _ => false,
    }
}
