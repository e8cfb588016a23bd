//! The scenario of a command that has hops over a whole DEM, without the scenario's own terrain.

use std::path::{Path, PathBuf};

pub(crate) use chta::study::open::OpenMap as Bare;
use chta::{
    study::open::{Draft, ScenarioEnds},
    terrain::MapPlace,
};

use super::{EndOptions, OwnKey, apply_options, look_at_keys, option_source, read_source, two_scenarios, unopened};
use crate::cli::{
    Failure,
    args::{CommonArgs, SearchArgs},
    effects::Purpose,
    inputs, verbose,
    wrong_thing::Role,
};

/// Loads the scenario of the options for hops over this DEM, without its own terrain.
pub(crate) fn load_bare(dem: &Path, common: &CommonArgs, search: &SearchArgs, purpose: Purpose) -> Result<Bare, Failure> {
    let dem = inputs::open(dem, Role::Dem)?.file;
    of_source(option_source(common.scenario.as_deref())?, Some(dem), common, search, purpose)
}

/// Loads the same for a DEM, or for a scenario that names one, with the scenario's start and goal where the command line has no start.
pub(crate) fn load_map(
    target: &Path,
    common: &CommonArgs,
    (search, objective, own): (&SearchArgs, &[String], &[OwnKey<'_>]),
    purpose: impl Fn(ScenarioEnds) -> Purpose,
    has_start: bool,
) -> Result<Bare, Failure> {
    let input = inputs::open(target, Role::MapTarget)?;
    let ends = match (input.is_scenario(), has_start) {
        (_, false) => ScenarioEnds::Needed,
        (true, true) => ScenarioEnds::Offered,
        (false, true) => ScenarioEnds::Ignored,
    };
    let mut source = match (input.is_scenario(), &common.scenario) {
        (true, Some(other)) => return Err(two_scenarios(&input, other, "a DEM as DEM")),
        (true, None) => read_source(&input)?,
        (false, scenario) => option_source(scenario.as_deref())?,
    };
    if !objective.is_empty() {
        let amounts: Vec<toml::Value> = objective.iter().map(|amount| amount.trim().into()).collect();
        source.entries.forget("search", "effort");
        source.entries.set_by_option("--objective", "search", "objective", amounts.into());
    }
    for (option, table, name, value) in own {
        source.entries.set_by_option(option, table, name, value.clone());
    }
    let dem = (!input.is_scenario()).then_some(input.file);
    of_source(source, dem, common, search, purpose(ends))
}

/// The scenario of a source for hops over a DEM, its own one if no other is given.
fn of_source(
    mut source: Draft,
    dem: Option<PathBuf>,
    common: &CommonArgs,
    search: &SearchArgs,
    purpose: Purpose,
) -> Result<Bare, Failure> {
    apply_options(&mut source.entries, common, Some(search), EndOptions::NONE);
    let given = source.entries.clone();
    let (ends, dem) = if let Some(dem) = dem {
        (own_ends(&source, purpose)?, dem)
    } else {
        look_at_keys(&mut source, false)?;
        let ends = own_ends(&source, purpose)?;
        let own = source.file_of("terrain.dem").ok_or_else(|| {
            let name = &source.name;
            Failure::message(format!(
                "{name}: found no terrain.dem, expected one for a map: add it, or give the DEM, and the scenario with --scenario {name}, or over a \
                 mesh give terrain.mesh with route = \"free\""
            ))
        })?;
        (ends, own)
    };
    source.forget_terrain();
    look_at_keys(&mut source, false)?;
    let name = common.scenario.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default();
    let bare = source.over_dem(dem, ends, &given, purpose).map_err(|error| unopened(error, &name))?;
    verbose::settings(&bare.document, &bare.scenario.search);
    Ok(bare)
}

/// The start and goal of a scenario on its DEM, where they count.
fn own_ends(source: &Draft, purpose: Purpose) -> Result<Option<[MapPlace; 2]>, Failure> {
    source.ends_on_dem(purpose).map_err(|error| unopened(error, ""))
}
