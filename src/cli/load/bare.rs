//! The scenario of a command that has hops over a whole DEM, without the scenario's own terrain.

use std::path::{Path, PathBuf};

use chta::{
    scenario::{Place, Scenario, scenario_document},
    terrain::MapPlace,
};

use super::{
    EndOptions, Source, apply_options, forget_terrain, lacking_on, look_at_keys, option_source, read_source, relative_name,
    two_scenarios, validated, validated_with_legs,
};
use crate::cli::{
    Failure,
    args::{CommonArgs, SearchArgs},
    effects::Purpose,
    inputs, verbose,
    wrong_thing::Role,
};

/// A scenario without terrain, for a command that has its own.
#[derive(Debug)]
pub(crate) struct Bare {
    /// The DEM's file.
    pub(crate) dem: PathBuf,
    /// The scenario as used.
    pub(crate) scenario: Scenario,
    /// The folder that its paths start from.
    pub(crate) base: PathBuf,
    /// The scenario for a result.
    pub(crate) document: serde_json::Value,
    /// Warnings about keys without effect.
    pub(crate) warnings: Vec<String>,
    /// The title that the scenario gives its report, other than the file's name.
    pub(crate) title: Option<String>,
    /// The scenario's own start and goal on its DEM, where they are used.
    pub(crate) ends: Option<[MapPlace; 2]>,
}

impl Bare {
    /// The name of the map in titles: that of the scenario's report, else of the DEM.
    pub(crate) fn title_of_map(&self) -> String {
        let of_dem = || self.dem.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        self.title.clone().unwrap_or_else(of_dem)
    }
}

/// Loads the scenario of the options for hops over this DEM, without its own terrain.
pub(crate) fn load_bare(dem: &Path, common: &CommonArgs, search: &SearchArgs, purpose: Purpose) -> Result<Bare, Failure> {
    let dem = inputs::open(dem, Role::Dem)?.file;
    of_source(option_source(common.scenario.as_deref())?, Some(dem), common, search, purpose)
}

/// Loads the same for a DEM, or for a scenario that names one, with the scenario's start and goal where the command line has no start.
pub(crate) fn load_map(
    target: &Path,
    common: &CommonArgs,
    (search, objective): (&SearchArgs, &[String]),
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
    let dem = (!input.is_scenario()).then_some(input.file);
    of_source(source, dem, common, search, purpose(ends))
}

/// Whether a scenario's own start and goal count for a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ScenarioEnds {
    /// They are ignored, with the rest of its terrain.
    Ignored,
    /// Its goal counts where it has one.
    Offered,
    /// There is no other start.
    Needed,
}

/// The scenario of a source for hops over a DEM, its own one if no other is given.
fn of_source(
    mut source: Source,
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
        let own = source.entries.files().into_iter().find(|(key, _)| key.path() == "terrain.dem").map(|(_, file)| file);
        let own = own.ok_or_else(|| {
            let name = &source.name;
            Failure::message(format!(
                "{name}: found no terrain.dem, expected one for a map: add it, or give the DEM, and the scenario with --scenario {name}, or over a \
                 mesh give terrain.mesh with route = \"free\""
            ))
        })?;
        (ends, source.base.join(own))
    };
    let title = given.given().any(|(key, place)| key.path() == "report.title" && *place != Place::Nowhere);
    let title = given.title().filter(|_| title).map(str::to_owned);
    forget_terrain(&mut source.entries);
    look_at_keys(&mut source, false)?;
    let judged = if purpose.stands_on_legs() { validated_with_legs } else { validated };
    let scenario = judged(source.entries, &source.name, &source.text)?;
    let warnings = purpose.unused(&given, &scenario).into_iter().chain(Purpose::replaced(&given)).collect();
    // A robot file may state the speeds.
    let mut lacking = scenario.lacks_on_a_dem();
    lacking.retain(|key| scenario.legs.file.is_none() || key.key.starts_with("surface."));
    if !lacking.is_empty() {
        let name = common.scenario.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default();
        return Err(Failure::message(name + &lacking_on(&lacking, "a DEM")));
    }
    let document = scenario_document(&scenario, &|path| relative_name(&source.base.join(path)));
    verbose::settings(&document, &scenario.search);
    // Hops over a map have exact commands, which the warnings say.
    let scenario = Scenario { hopper: scenario.hopper.with_any_command(), ..scenario };
    Ok(Bare { dem, scenario, base: source.base, document, warnings, title, ends })
}

/// The start and goal of a scenario on its DEM, where they count.
fn own_ends(source: &Source, purpose: Purpose) -> Result<Option<[MapPlace; 2]>, Failure> {
    let wanted = purpose.scenario_ends();
    let judged = if purpose.stands_on_legs() { validated_with_legs } else { validated };
    let has_dem = source.entries.files().iter().any(|(key, _)| key.path() == "terrain.dem");
    if wanted == ScenarioEnds::Ignored || !has_dem {
        return Ok(None);
    }
    let scenario = match judged(source.entries.clone(), &source.name, &source.text) {
        // A start or goal that the scenario lacks is not missed where the command line has a start.
        Err(_) if wanted == ScenarioEnds::Offered => return Ok(None),
        scenario => scenario?,
    };
    Ok(scenario.terrain.and_then(|terrain| terrain.map_ends()))
}
