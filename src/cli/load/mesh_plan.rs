//! The terrain of a free route over facets, of a mesh or for legs of a DEM, and the scenario for it.

use std::path::{Path, PathBuf};

use chta::{
    report::{CrsRecord, DocumentKind, InputFile},
    scenario::{Scenario, TerrainSource, scenario_document},
    study::{CaseRecord, checksums, scenario_files},
};
use serde::Serialize;

use super::{
    EndOptions, OwnKey, Source, apply_options, lacking_on, look_at_keys, read_source, relative_name, validated, validated_with_legs,
};
use crate::cli::{
    Failure,
    args::{CommonArgs, JourneyArgs, SearchArgs},
    claims,
    effects::Purpose,
    inputs, output, verbose,
    wrong_thing::Role,
};

/// The scenario of a free route over a mesh.
#[derive(Debug)]
pub(crate) struct MeshPlanInput {
    /// The scenario, whose terrain is a mesh as it stands, or for a robot with legs a DEM.
    pub(crate) scenario: Scenario,
    /// The folder that its paths start from.
    pub(crate) base: PathBuf,
    /// The file of the terrain.
    pub(crate) mesh: PathBuf,
    /// The head of the document.
    record: CaseRecord,
}

impl MeshPlanInput {
    /// The files that are read, with their checksums.
    pub(crate) fn inputs(&self) -> &[InputFile] {
        &self.record.inputs
    }

    /// The head of its documents.
    pub(crate) const fn record(&self) -> &CaseRecord {
        &self.record
    }

    /// An answer as one document, with its warnings.
    pub(crate) fn document<T: Serialize>(&self, kind: DocumentKind, warnings: &[String], answer: T) -> Result<String, Failure> {
        Ok(self.record.document(kind, warnings, answer).to_json()?)
    }

    /// The same on a map, whose reference system is known or not.
    pub(crate) fn document_on_map<T: Serialize>(
        &self,
        kind: DocumentKind,
        crs: Option<&CrsRecord>,
        warnings: &[String],
        answer: T,
    ) -> Result<String, Failure> {
        let record = CaseRecord { crs: crs.cloned(), ..self.record.clone() };
        Ok(record.document(kind, warnings, answer).to_json()?)
    }
}

/// Loads the scenario of a free route over a mesh; `None` for any other input.
pub(crate) fn load_mesh_plan(
    JourneyArgs { chain, start, goal }: &JourneyArgs,
    common: &CommonArgs,
    search: &SearchArgs,
    purpose: Purpose,
    own: &[OwnKey<'_>],
) -> Result<Option<MeshPlanInput>, Failure> {
    load_mesh_scenario((chain, Role::Chain), common, (Some(search), EndOptions::of_path(*start, *goal)), purpose, own)
}

/// The keys of a scenario of hops over a mesh as it stands, with the options beside it; `None` for any other input.
fn mesh_source(
    (target, role): (&Path, Role),
    common: &CommonArgs,
    (search, ends): (Option<&SearchArgs>, EndOptions),
) -> Result<Option<Source>, Failure> {
    let input = inputs::open(target, role)?;
    if !input.is_scenario() || common.scenario.is_some() {
        return Ok(None);
    }
    let mut source = read_source(&input)?;
    apply_options(&mut source.entries, common, search, ends);
    let entries = &source.entries;
    let is_over_facets = !entries.is_unreadable() && (entries.ask_for_free_mesh() || entries.ask_for_legs_on_dem());
    Ok(is_over_facets.then_some(source))
}

/// Whether a file is a scenario of hops over a mesh as it stands.
pub(crate) fn is_over_mesh(target: &Path, common: &CommonArgs) -> Result<bool, Failure> {
    Ok(mesh_source((target, Role::Scenario), common, (None, EndOptions::NONE))?.is_some())
}

/// Loads the scenario of hops over a mesh as it stands, with the options beside it; `None` for any other input.
pub(crate) fn load_mesh_scenario(
    target: (&Path, Role),
    common: &CommonArgs,
    options: (Option<&SearchArgs>, EndOptions),
    purpose: Purpose,
    own: &[OwnKey<'_>],
) -> Result<Option<MeshPlanInput>, Failure> {
    let Some(mut source) = mesh_source(target, common, options)? else { return Ok(None) };
    // Its nodes are those of a map over any DEM.
    // A point has no limbs and cones to compare.
    let is_of_legs = source.entries.files().iter().any(|(key, _)| key.path() == "robot.file");
    if (purpose == Purpose::MapMesh && !source.entries.ask_for_free_mesh()) || (purpose == Purpose::Trade && !is_of_legs) {
        return Ok(None);
    }
    look_at_keys(&mut source, true)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let given = source.entries.clone();
    let (base, name) = (source.base, source.name);
    let validated = if purpose.stands_on_legs() { validated_with_legs } else { validated };
    let scenario = validated(source.entries, &name, &source.text)?;
    // Two terrains would have been refused.
    let Some(TerrainSource::MeshInSpace { path, .. } | TerrainSource::Dem { path, .. }) = &scenario.terrain else {
        return Ok(None);
    };
    let terrain = if matches!(scenario.terrain, Some(TerrainSource::Dem { .. })) { "a DEM" } else { "a mesh" };
    let mesh = base.join(path);
    // A robot file may state the speeds.
    let mut lacking = scenario.lacks_on_a_dem();
    lacking.retain(|key| scenario.legs.file.is_none() || key.key.starts_with("surface."));
    if !lacking.is_empty() {
        return Err(Failure::message(format!("{name}: {}", lacking_on(&lacking, terrain))));
    }
    let warnings: Vec<String> = purpose.unused(&given, &scenario).into_iter().chain(Purpose::replaced(&given)).collect();
    output::warn_all(common.quiet, &warnings);
    let files = scenario_files(&scenario, &base);
    for file in &files {
        claims::reads(file);
        verbose::read(file);
    }
    let document = scenario_document(&scenario, &|path| relative_name(&base.join(path)));
    verbose::settings(&document, &scenario.search);
    let inputs = checksums(&files, &relative_name)?;
    let record = CaseRecord { scenario: document, inputs, warnings, crs: None };
    Ok(Some(MeshPlanInput { scenario, base, mesh, record }))
}
