//! The terrain and the robot of a stance, and the scenario for both.

use std::path::PathBuf;

use chta::{
    quantity::MapPoint,
    report::{Document, DocumentKind},
    robot_model::LimbChain,
    scenario::{FileKind, RobotFileError, Scenario, read_robot, scenario_document},
    study::{CaseRecord, StanceTerrain, checksums},
    terrain::DemOptions,
    world::Robot,
};
use serde::Serialize;

use super::{EndOptions, apply_options, lacking_on, look_at_keys, option_source, refused, relative_name};
use crate::cli::{
    Failure,
    args::{Position, StanceArgs},
    claims,
    effects::{Purpose, WORDING},
    inputs, output, verbose,
    wrong_thing::Role,
};

/// A terrain, a robot and a place.
#[derive(Debug)]
pub(crate) struct StanceInput {
    /// The terrain.
    pub(crate) terrain: StanceTerrain,
    /// Its file.
    pub(crate) file: PathBuf,
    /// The robot.
    pub(crate) robot: Robot,
    /// The joints of its limbs.
    pub(crate) chains: Vec<Option<LimbChain>>,
    /// Where it stands, m.
    pub(crate) at_m: (MapPoint, Option<f64>),
    /// The scenario as used, without terrain.
    pub(crate) scenario: Scenario,
    /// The folder that the paths of the scenario start from.
    pub(crate) base: PathBuf,
    /// What the reader of the robot says.
    pub(crate) warnings: Vec<String>,
    record: CaseRecord,
}

impl StanceInput {
    /// An answer as one document, with its warnings.
    pub(crate) fn document<T: Serialize>(&self, warnings: &[String], answer: T) -> Result<String, Failure> {
        Ok(self.record.document(DocumentKind::Stance, warnings, answer).to_json()?)
    }
}

/// Loads the terrain, the robot and the scenario of a stance.
pub(crate) fn load_stance(args: &StanceArgs) -> Result<StanceInput, Failure> {
    let common = &args.common();
    let (Some(terrain), Some(at)) = (&args.terrain, args.at) else {
        return Err(Failure::message("found neither a terrain nor --contacts, expected one of them"));
    };
    inputs::look_at(
        common.input_max_gib,
        &[(Some(terrain), Role::HopTerrain), (common.scenario.as_deref(), Role::ScenarioOption)],
    )?;
    let input = inputs::open(terrain, Role::HopTerrain)?;
    let is_mesh = matches!(input.kind, FileKind::Mesh(..));
    if !is_mesh && !input.is_raster() {
        return Err(Failure::message(format!(
            "{}: found {}, expected a mesh or an elevation raster to stand on; give the scenario with --scenario",
            terrain.display(),
            input.kind.name()
        )));
    }
    let mut source = option_source(common.scenario.as_deref())?;
    apply_options(&mut source.entries, common, None, EndOptions::NONE);
    let given = source.entries.clone();
    let scale = source.entries.mesh_scale();
    source.forget_terrain();
    look_at_keys(&mut source, false)?;
    let scenario = source.validated(true).map_err(refused)?;
    let lacking: Vec<_> = scenario.lacks_on_a_dem().into_iter().filter(|key| key.key.starts_with("surface.")).collect();
    if !lacking.is_empty() {
        let name = common.scenario.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default();
        return Err(Failure::message(name + &lacking_on(&lacking, if is_mesh { "a mesh" } else { "a DEM" })));
    }
    let named = args.robot.clone().or_else(|| scenario.legs.file.as_ref().map(|file| source.base.join(file)));
    let named = named.ok_or_else(|| {
        Failure::message(
            "found no robot, expected --robot FILE, or robot.file in the scenario: a robot file states trunk and limbs",
        )
    })?;
    let robot = read_robot(&named).map_err(|error| match error {
        RobotFileError::Problems(problems) => Failure::Scenario(problems),
        other => Failure::of(&other),
    })?;
    let at_m = match at {
        Position::OnMap(at) => (at, None),
        Position::InSpace([x, y, z]) => (MapPoint::new(x, y), Some(z)),
        Position::Along(_) if is_mesh => return Err(Failure::message(format!("--at: {}", at.misfit_in_space()))),
        Position::Along(_) => return Err(Failure::message(format!("--at: {}", at.misfit_on_map()))),
    };
    let ground = if is_mesh {
        StanceTerrain::Mesh(input.file.clone(), scale)
    } else {
        let read = DemOptions::default().no_data(scenario.no_data).read(&input.file);
        StanceTerrain::Dem(std::sync::Arc::new(read.map_err(|error| Failure::about(terrain, &error))?))
    };
    let warnings: Vec<String> =
        Purpose::Hop.unused(&given, &scenario, &WORDING).into_iter().chain(Purpose::replaced(&given)).collect();
    output::warn_all(common.quiet, &warnings);
    let mut files = vec![input.file.clone(), named];
    files.extend(robot.files.iter().cloned());
    for file in &files {
        claims::reads(file);
    }
    let document = scenario_document(&scenario, &|path| relative_name(&source.base.join(path)));
    verbose::settings(&document, &scenario.search);
    let inputs = checksums(&files, &relative_name)?;
    let record = CaseRecord { scenario: document, inputs, warnings, crs: None };
    let base = source.base;
    Ok(StanceInput {
        terrain: ground,
        file: input.file,
        robot: robot.robot,
        chains: robot.chains,
        at_m,
        scenario,
        base,
        warnings: robot.warnings,
        record,
    })
}

/// The document of contacts without a robot.
pub(crate) fn contacts_document<T: Serialize>(file: &PathBuf, answer: T) -> Result<String, Failure> {
    let inputs = checksums(std::slice::from_ref(file), &relative_name)?;
    Ok(Document::new(DocumentKind::Stance, serde_json::json!({}), inputs, Vec::new(), answer).to_json()?)
}
