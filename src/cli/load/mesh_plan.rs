//! The mesh of a free route, and the scenario for it.

use std::path::{Path, PathBuf};

use chta::{
    report::{DocumentKind, InputFile},
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
    /// The scenario, whose terrain is a mesh as it stands.
    pub(crate) scenario: Scenario,
    /// The folder that its paths start from.
    pub(crate) base: PathBuf,
    /// The file of the mesh.
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
    let is_over_mesh = !source.entries.is_unreadable() && source.entries.ask_for_free_mesh();
    Ok(is_over_mesh.then_some(source))
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
    look_at_keys(&mut source, true)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let given = source.entries.clone();
    let (base, name) = (source.base, source.name);
    let validated = if purpose.stands_on_legs() { validated_with_legs } else { validated };
    let scenario = validated(source.entries, &name, &source.text)?;
    // Two terrains would have been refused.
    let Some(TerrainSource::MeshInSpace { path, .. }) = &scenario.terrain else { return Ok(None) };
    let mesh = base.join(path);
    // A robot file may state the speeds.
    let mut lacking = scenario.lacks_on_a_dem();
    lacking.retain(|key| scenario.legs.file.is_none() || key.key.starts_with("surface."));
    if !lacking.is_empty() {
        return Err(Failure::message(format!("{name}: {}", lacking_on(&lacking, "a mesh"))));
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
