//! Input that several cases have in common, read once.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    time::SystemTime,
};

use crate::{
    report::InputFile,
    scenario::{Scenario, TerrainSource},
    study::{Case, CaseError, Commands, PipelineError, Survey, scenario_files, sha256_of},
};

/// How many terrains are kept at once: cases that vary more of them read some anew.
const TERRAINS: usize = 4;

/// Terrain and checksums that the cases of a batch share. A terrain is known by the content of its files and by the keys that decide what
/// is read of them, so that every answer is the one that the case has by itself.
///
/// A file that is changed while a batch runs is read anew if its length or its time of change differs.
#[derive(Clone, Debug, Default)]
pub struct SharedInputs(Arc<Inner>);

#[derive(Debug, Default)]
struct Inner {
    files: Mutex<HashMap<PathBuf, Known>>,
    /// The latest is the last.
    terrains: Mutex<Vec<(String, Arc<Survey>)>>,
}

/// A file whose content is known.
#[derive(Clone, Debug)]
struct Known {
    length: u64,
    changed: Option<SystemTime>,
    sha256: String,
}

impl SharedInputs {
    /// The checksum of a file.
    ///
    /// # Errors
    /// [`PipelineError::Read`].
    pub fn sha256(&self, file: &Path) -> Result<String, PipelineError> {
        let state = fs::metadata(file).ok().map(|metadata| (metadata.len(), metadata.modified().ok()));
        let locked = || self.0.files.lock().unwrap_or_else(PoisonError::into_inner);
        let known = locked().get(file).cloned();
        if let Some(known) = known.filter(|known| Some((known.length, known.changed)) == state) {
            return Ok(known.sha256);
        }
        let sha256 = sha256_of(file)?;
        if let Some((length, changed)) = state {
            locked().insert(file.to_path_buf(), Known { length, changed, sha256: sha256.clone() });
        }
        Ok(sha256)
    }

    /// The files that are read for a scenario, each with its checksum.
    ///
    /// # Errors
    /// [`PipelineError::Read`].
    pub fn checksums(
        &self,
        scenario: &Scenario,
        base: &Path,
        name: &dyn Fn(&Path) -> String,
    ) -> Result<Vec<InputFile>, PipelineError> {
        let files = scenario_files(scenario, base);
        files.iter().map(|file| Ok(InputFile { name: name(file), sha256: self.sha256(file)? })).collect()
    }

    /// [`Case::new`] over a terrain that may have been read for another case.
    pub(super) fn case(&self, scenario: Scenario, base: &Path, commands: Commands) -> Result<Case, CaseError> {
        let terrain = scenario.terrain.as_ref().ok_or(CaseError::NoTerrain)?;
        // What cannot be read is refused by the reader.
        let Ok(key) = self.key(&scenario, terrain, base) else { return Case::new(scenario, base, commands) };
        let survey = match self.known(&key) {
            Some(survey) => survey,
            None => self.kept(key, Arc::new(Case::survey(&scenario, terrain, base, commands)?)),
        };
        Case::surveyed(&survey, scenario, base, commands)
    }

    /// Everything that decides what is read of a terrain.
    fn key(&self, scenario: &Scenario, terrain: &TerrainSource, base: &Path) -> Result<String, PipelineError> {
        let files = self.checksums(scenario, base, &|path| path.display().to_string())?;
        let Scenario { body, groups, friction_raster, keep_out, keep_in, layers, accept_map_scale, no_data, via, route, .. } =
            scenario;
        let limits = scenario.hopper.limits();
        let overlays = (friction_raster, keep_out, keep_in, layers);
        let reading = (accept_map_scale, no_data, via, route, limits.footprint_m, limits.radius_m, groups);
        Ok(format!("{terrain:?} {body:?} {overlays:?} {reading:?} {files:?}"))
    }

    fn known(&self, key: &str) -> Option<Arc<Survey>> {
        let terrains = self.0.terrains.lock().unwrap_or_else(PoisonError::into_inner);
        terrains.iter().find(|(other, _)| other == key).map(|(_, survey)| Arc::clone(survey))
    }

    /// Keeps a terrain, unless another thread was faster.
    fn kept(&self, key: String, survey: Arc<Survey>) -> Arc<Survey> {
        if let Some(known) = self.known(&key) {
            return known;
        }
        let mut terrains = self.0.terrains.lock().unwrap_or_else(PoisonError::into_inner);
        if terrains.len() == TERRAINS {
            terrains.remove(0);
        }
        terrains.push((key, Arc::clone(&survey)));
        survey
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::open::{Draft, PlanAsked};

    /// A DEM of ten posts a side whose posts rise by this much each, m.
    fn write_dem(file: &Path, rise_m: f64) {
        let header = "ncols 10\nnrows 10\nxllcorner 0\nyllcorner 0\ncellsize 2\n";
        let row = |row: usize| {
            let cells = (0..10).map(|col| format!("{}", rise_m * f64::from(u32::try_from((row * 7 + col * 3) % 5).unwrap())));
            cells.collect::<Vec<_>>().join(" ")
        };
        fs::write(file, header.to_owned() + &(0..10).map(row).collect::<Vec<_>>().join("\n") + "\n").unwrap();
    }

    #[test]
    fn shared_terrain_gives_every_case_its_own_answer() {
        let folder = tempfile::tempdir().unwrap();
        write_dem(&folder.path().join("a.asc"), 0.1);
        write_dem(&folder.path().join("b.asc"), 0.3);
        let text = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 3.0\nlanding_speed_max_m_s = 3.0\n\
                    [surface]\nfriction_coefficient = 0.6\n[terrain]\ndem = \"a.asc\"\nstart_m = [3.0, 3.0]\ngoal_m = [15.0, 14.0]\n";
        let alone = Draft::of_toml(text, "mine.toml", folder.path());
        let shared = Draft { shared: Some(SharedInputs::default()), ..alone.clone() };
        let settings = [
            "hopper.clearance_m=0",
            "hopper.takeoff_speed_max_m_s=2.5",
            "surface.friction_coefficient=0.8",
            "terrain.dem=b.asc",
            "terrain.goal_m=[13.0, 12.0]",
            "terrain.via_m=[[5.0, 9.0]]",
            "hopper.footprint_m=3.0",
            "terrain.route=free",
            "derating.friction=0.8",
            "hopper.heading_step_deg=7",
            "body.name=ceres",
            "terrain.dem=absent.asc",
            "terrain.no_data=0.1",
        ];
        let mut answers = 0;
        for _ in 0..2 {
            for setting in settings {
                let [first, second] = [&alone, &shared].map(|draft| {
                    let mut draft = draft.clone();
                    draft.set(setting);
                    draft.plan(&PlanAsked::default(), &()).map(|reply| reply.json).map_err(|error| error.to_string())
                });
                answers += usize::from(first.is_ok());
                assert_eq!(first, second, "{setting}");
            }
        }
        assert!(answers > settings.len(), "{answers}");
        let kept = shared.shared.as_ref().unwrap();
        assert_eq!(kept.0.terrains.lock().unwrap().len(), TERRAINS);
        // A file that changes is read anew.
        let before = shared.plan(&PlanAsked::default(), &()).unwrap().json;
        write_dem(&folder.path().join("a.asc"), 0.25);
        let after = shared.plan(&PlanAsked::default(), &()).unwrap().json;
        assert!(before != after && after == alone.plan(&PlanAsked::default(), &()).unwrap().json);
    }

    #[test]
    fn one_terrain_is_read_once_whatever_the_machine() {
        let draft = Draft::read("data/scenarios/lunar_rille.toml".as_ref()).unwrap();
        let shared = SharedInputs::default();
        let draft = Draft { shared: Some(shared.clone()), ..draft };
        for speed in ["7", "8", "9"] {
            let mut draft = draft.clone();
            draft.set(&format!("hopper.takeoff_speed_max_m_s={speed}"));
            draft.plan(&PlanAsked::default(), &()).unwrap();
        }
        assert_eq!(shared.0.terrains.lock().unwrap().len(), 1);
    }
}
