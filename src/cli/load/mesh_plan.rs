//! The terrain of a free route over facets, of a mesh or for legs of a DEM, and the scenario for it.

use std::path::Path;

pub(crate) use chta::study::open::OpenFacets as MeshPlanInput;
use chta::study::{open::Draft, scenario_files};

use super::{EndOptions, OwnKey, apply_options, look_at_keys, read_source, unopened};
use crate::cli::{
    Failure,
    args::{CommonArgs, JourneyArgs, SearchArgs},
    claims,
    effects::Purpose,
    inputs, output, verbose,
    wrong_thing::Role,
};

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
) -> Result<Option<Draft>, Failure> {
    let input = inputs::open(target, role)?;
    if !input.is_scenario() || common.scenario.is_some() {
        return Ok(None);
    }
    let mut source = read_source(&input)?;
    apply_options(&mut source.entries, common, search, ends);
    Ok(source.is_over_facets().then_some(source))
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
    if !source.asks_over_facets(purpose) {
        return Ok(None);
    }
    look_at_keys(&mut source, true)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let Some(open) = source.facets(purpose).map_err(|error| unopened(error, &format!("{}: ", source.name)))? else {
        return Ok(None);
    };
    output::warn_all(common.quiet, &open.record.warnings);
    for file in scenario_files(&open.scenario, &open.base) {
        claims::reads(&file);
        verbose::read(&file);
    }
    verbose::settings(&open.record.scenario, &open.scenario.search);
    Ok(Some(open))
}
