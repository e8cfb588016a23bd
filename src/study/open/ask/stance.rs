//! Where a robot with legs stands.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::{AskError, Draft, OpenError, Purpose, Reply, Wording, map::inputs};
use crate::{
    ground::StandsUp,
    quantity::MapPoint,
    report::{Document, DocumentKind, StanceAnswer},
    scenario::{FileKind, read_robot, scenario_document},
    study::{CaseRecord, StanceQuestion, StanceTerrain, checksums, contacts_of, stand},
    terrain::DemOptions,
};

/// What is asked of a stance.
#[derive(Clone, Debug)]
pub struct StanceAsked {
    /// Another terrain than the scenario's.
    pub terrain: Option<PathBuf>,
    /// The place, m: `[x, y]` on a map, `[x, y, z]` over a mesh.
    pub at_m: Vec<f64>,
    /// Another robot file than the scenario's.
    pub robot: Option<PathBuf>,
    /// Which way it faces, degrees clockwise from +y; absent: all around is tried.
    pub heading_deg: Option<f64>,
    /// How far its root is over the place, m; absent: several are tried.
    pub height_m: Option<f64>,
    /// Which way is up for its trunk.
    pub up: StandsUp,
    /// How many headings the rose has.
    pub headings: u32,
}

impl Draft {
    /// Looks for a stance of a robot with legs.
    ///
    /// # Errors
    /// [`AskError`]. That it cannot stand is an answer.
    pub fn stance(&self, asked: &StanceAsked) -> Result<Reply, AskError> {
        let mut draft = self.clone();
        let (given, scale) = (draft.entries.clone(), draft.entries.mesh_scale());
        let none = |what, expected| AskError::Value { what, found: "absent".to_owned(), expected };
        let own = || draft.file_of("terrain.mesh").or_else(|| draft.file_of("terrain.dem"));
        let terrain = asked.terrain.clone().or_else(own);
        let terrain = terrain.ok_or_else(|| none("the terrain", "a mesh or an elevation raster to stand on"))?;
        let name = terrain.display().to_string();
        let help = "check the path and its permissions";
        let kind = FileKind::of(&terrain).map_err(|error| OpenError::unreadable(&name, error.to_string(), help))?;
        let is_mesh = matches!(kind, FileKind::Mesh(..));
        draft.forget_terrain();
        let scenario = draft.validated(true)?;
        let keys: Vec<_> = scenario.lacks_on_a_dem().into_iter().filter(|key| key.key.starts_with("surface.")).collect();
        if !keys.is_empty() {
            let terrain = if is_mesh { "a mesh" } else { "a DEM" };
            return Err(OpenError::Lacking { name: draft.name, keys, terrain }.into());
        }
        let own = scenario.legs.file.as_ref().map(|file| draft.base.join(file));
        let file = asked.robot.clone().or(own);
        let file = file.ok_or_else(|| none("the robot", "a robot file (TOML), or robot.file in the scenario"))?;
        let robot = read_robot(&file)?;
        let at_m = match asked.at_m[..] {
            [x, y] => (MapPoint::new(x, y), None),
            [x, y, z] => (MapPoint::new(x, y), Some(z)),
            ref other => {
                let found = format!("{} numbers", other.len());
                return Err(AskError::Value { what: "at_m", found, expected: "X and Y on a map, X, Y and Z on a mesh" });
            }
        };
        let ground = if is_mesh {
            StanceTerrain::Mesh(terrain.clone(), scale)
        } else {
            let read = DemOptions::default().no_data(scenario.no_data).read(&terrain);
            StanceTerrain::Dem(Arc::new(read.map_err(crate::study::PipelineError::from)?))
        };
        let unused = Purpose::Hop.unused(&given, &scenario, &draft.wording);
        let mut files = vec![terrain, file];
        files.extend(robot.files.iter().cloned());
        let name = draft.wording.file_name;
        let record = CaseRecord {
            scenario: scenario_document(&scenario, &|path| name(&draft.base.join(path))),
            inputs: inputs(&files, &draft)?,
            warnings: unused.into_iter().chain(Purpose::replaced(&given)).collect(),
            crs: None,
        };
        let question = StanceQuestion {
            scenario: &scenario,
            base: &draft.base,
            terrain: &ground,
            robot: robot.robot,
            chains: &robot.chains,
            at_m,
            heading_deg: asked.heading_deg,
            height_m: asked.height_m,
            up: asked.up,
            headings: asked.headings,
        };
        let stood = stand(&question)?;
        let warnings = [&robot.warnings[..], &stood.warnings].concat();
        let json = record.document(DocumentKind::Stance, &warnings, &stood.answer).to_json()?;
        let reply = Reply::new(DocumentKind::Stance, json, stood.answer.stands);
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || Some(stood.picture(&scenario)));
        Ok(reply)
    }
}

/// The cone of take-off directions that contacts without a robot allow: a table `normal_x,normal_y,normal_z,friction_coefficient`, one row a
/// contact.
///
/// # Errors
/// [`AskError::Contacts`], with the line.
pub fn stance_of_contacts(file: &Path, headings: u32, wording: &Wording) -> Result<Reply, AskError> {
    let answer = StanceAnswer::of_contacts(&contacts_of(file)?, headings);
    let inputs = checksums(&[file.to_path_buf()], &wording.file_name)?;
    let json = Document::new(DocumentKind::Stance, serde_json::json!({}), inputs, Vec::new(), &answer).to_json()?;
    let reply = Reply::new(DocumentKind::Stance, json, answer.stands);
    #[cfg(feature = "plot")]
    let reply = reply.drawn(move || Some(crate::study::contacts_picture(&answer)));
    Ok(reply)
}
