//! The mesh of one hop, and the scenario for it.

use std::path::{Path, PathBuf};

use chta::{
    report::DocumentKind,
    scenario::{FileKind, Scenario, scenario_document},
    study::{CaseRecord, checksums},
};
use nalgebra::Point3;
use serde::Serialize;

use super::{
    EndOptions, apply_options, lacking_on, look_at_keys, option_source, read_source, relative_name, two_scenarios, validated,
};
use crate::cli::{
    Failure,
    args::CommonArgs,
    claims,
    effects::{Purpose, WORDING},
    inputs, output, verbose,
    wrong_thing::Role,
};

/// The mesh of one hop, with the scenario and the ends.
#[derive(Debug)]
pub(crate) struct MeshHopInput {
    /// The file.
    pub(crate) mesh: PathBuf,
    /// Metres per unit of the file.
    pub(crate) scale: f64,
    /// Where the hop begins and ends, before it is moved to the surface, m.
    pub(crate) ends_m: [Point3<f64>; 2],
    /// The scenario as used, without terrain.
    pub(crate) scenario: Scenario,
    /// The head of the document.
    record: CaseRecord,
}

impl MeshHopInput {
    /// An answer as one document, with its warnings.
    pub(crate) fn document<T: Serialize>(&self, warnings: &[String], answer: T) -> Result<String, Failure> {
        Ok(self.record.document(DocumentKind::HopMesh, warnings, answer).to_json()?)
    }
}

/// Loads the mesh of a hop: a mesh, or a scenario or result that names one where the ends are positions in space; `None` for any other
/// terrain.
pub(crate) fn load_mesh_hop(terrain: &Path, common: &CommonArgs, ends: EndOptions) -> Result<Option<MeshHopInput>, Failure> {
    let input = inputs::open(terrain, Role::HopTerrain)?;
    let mut source = match (&input.kind, &common.scenario) {
        (FileKind::Mesh(..), scenario) => option_source(scenario.as_deref())?,
        _ if !input.is_scenario() || !ends.are_in_space() => return Ok(None),
        (_, Some(other)) => return Err(two_scenarios(&input, other, "a mesh as TERRAIN")),
        (_, None) => read_source(&input)?,
    };
    let mesh = if matches!(input.kind, FileKind::Mesh(..)) {
        input.file.clone()
    } else {
        look_at_keys(&mut source, false)?;
        // Of another terrain the sentence about the count of numbers says what it takes.
        let Some(named) = source.file_of("terrain.mesh") else { return Ok(None) };
        named
    };
    let ends_m = ends.in_space(&mesh)?.map(Point3::from);
    apply_options(&mut source.entries, common, None, EndOptions::NONE);
    let given = source.entries.clone();
    let scale = source.entries.mesh_scale();
    source.forget_terrain();
    look_at_keys(&mut source, false)?;
    let scenario = validated(&source)?;
    let lacking = scenario.lacks_on_a_dem();
    if !lacking.is_empty() {
        let name = common.scenario.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default();
        return Err(Failure::message(name + &lacking_on(&lacking, "a mesh")));
    }
    let warnings: Vec<String> =
        Purpose::Hop.unused(&given, &scenario, &WORDING).into_iter().chain(Purpose::replaced(&given)).collect();
    output::warn_all(common.quiet, &warnings);
    claims::reads(&mesh);
    // As of maps, without terrain: the inputs name the mesh.
    let document = scenario_document(&scenario, &|path| relative_name(&source.base.join(path)));
    verbose::settings(&document, &scenario.search);
    let inputs = checksums(std::slice::from_ref(&mesh), &relative_name)?;
    let record = CaseRecord { scenario: document, inputs, warnings, crs: None };
    Ok(Some(MeshHopInput { mesh, scale, ends_m, scenario, record }))
}
