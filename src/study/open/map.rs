//! The scenario of a question that has hops over a whole DEM, without the scenario's own terrain.

use std::path::PathBuf;

use super::{Draft, OpenError, Purpose, ScenarioEnds, facets::lacking_without_robot};
use crate::{
    report::InputFile,
    scenario::{Entries, Place, Scenario, scenario_document},
    study::{Overlays, PipelineError, checksums, raster_files},
    terrain::MapPlace,
};

/// A scenario without terrain, and the DEM of a question.
#[derive(Clone, Debug)]
pub struct OpenMap {
    /// The DEM's file.
    pub dem: PathBuf,
    /// The scenario as used.
    pub scenario: Scenario,
    /// The folder that its paths start from.
    pub base: PathBuf,
    /// The scenario for a result.
    pub document: serde_json::Value,
    /// Warnings about keys without effect.
    pub warnings: Vec<String>,
    /// The title that the scenario gives its report, other than the file's name.
    pub title: Option<String>,
    /// The scenario's own start and goal on its DEM, where they are used.
    pub ends: Option<[MapPlace; 2]>,
}

impl OpenMap {
    /// The name of the map in titles: that of the scenario's report, else of the DEM.
    pub fn title_of_map(&self) -> String {
        let of_dem = || self.dem.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        self.title.clone().unwrap_or_else(of_dem)
    }

    /// The DEM and the overlays over it, each with the files beside it that are read.
    pub fn files(&self) -> Vec<PathBuf> {
        let overlays = Overlays::files(&self.scenario).map(|overlay| self.base.join(overlay));
        std::iter::once(self.dem.clone()).chain(overlays).flat_map(|file| raster_files(&file)).collect()
    }

    /// The same and the robot file, if there is one.
    pub fn files_with_robot(&self) -> Vec<PathBuf> {
        self.files().into_iter().chain(self.scenario.legs.file.as_ref().map(|file| self.base.join(file))).collect()
    }
}

impl Draft {
    /// The scenario's own start and goal on its DEM, where they count for a question.
    ///
    /// # Errors
    /// Problems of the keys, where there is no other start.
    pub fn ends_on_dem(&self, purpose: Purpose) -> Result<Option<[MapPlace; 2]>, OpenError> {
        let wanted = purpose.scenario_ends();
        if wanted == ScenarioEnds::Ignored || self.file_of("terrain.dem").is_none() {
            return Ok(None);
        }
        let scenario = match self.validated(purpose.stands_on_legs()) {
            // A start or goal that the scenario lacks is not missed where the caller has a start.
            Err(_) if wanted == ScenarioEnds::Offered => return Ok(None),
            scenario => scenario?,
        };
        Ok(scenario.terrain.and_then(|terrain| terrain.map_ends()))
    }

    /// Opens the scenario for hops over this DEM. Its own terrain is [removed](Self::forget_terrain) before; `ends` are those of
    /// [`ends_on_dem`](Self::ends_on_dem), and `given` the keys with it.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn over_dem(
        self,
        dem: PathBuf,
        ends: Option<[MapPlace; 2]>,
        given: &Entries,
        purpose: Purpose,
    ) -> Result<OpenMap, OpenError> {
        let title = given.given().any(|(key, place)| key.path() == "report.title" && *place != Place::Nowhere);
        let title = given.title().filter(|_| title).map(str::to_owned);
        let scenario = self.validated(purpose.stands_on_legs())?;
        let (base, wording) = (self.base, &self.wording);
        let warnings = purpose.unused(given, &scenario, wording).into_iter().chain(Purpose::replaced(given)).collect();
        let keys = lacking_without_robot(&scenario);
        if !keys.is_empty() {
            return Err(OpenError::Lacking { name: self.name, keys, terrain: "a DEM" });
        }
        let document = scenario_document(&scenario, &|path| (wording.file_name)(&base.join(path)));
        // Hops over a map have exact commands, which the warnings say.
        let scenario = Scenario { hopper: scenario.hopper.with_any_command(), ..scenario };
        Ok(OpenMap { dem, scenario, base, document, warnings, title, ends })
    }

    /// The same for the scenario's own DEM, or another one.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn map(mut self, dem: Option<PathBuf>, purpose: Purpose) -> Result<OpenMap, OpenError> {
        let given = self.entries.clone();
        let ends = self.ends_on_dem(purpose)?;
        let name = || OpenError::NoDem { name: self.name.clone() };
        let dem = dem.or_else(|| self.file_of("terrain.dem")).ok_or_else(name)?;
        self.forget_terrain();
        self.over_dem(dem, ends, &given, purpose)
    }
}

/// Files with their checksums.
pub(super) fn inputs(files: &[PathBuf], draft: &Draft) -> Result<Vec<InputFile>, PipelineError> {
    checksums(files, &draft.wording.file_name)
}
