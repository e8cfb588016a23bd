//! From the command line to a scenario and its chain.

use std::{
    fs,
    io::Read,
    path::{Component, Path, PathBuf},
    sync::Arc,
};

use chta::{
    chain::{Station, csv::read_chain_csv_file},
    hop::HopTest,
    report::InputFile,
    scenario::{
        Entries, FileKind, LackingKey, Place, Scenario, ScenarioProblem, ScenarioProblems, TerrainSource, scenario_document,
    },
    study::{JourneyEnd as End, Overlays, PipelineError, Prepared, Survey, SweptKey, Trade, prepare, sha256_of},
    terrain::{MapPlace, sidecar_files},
};

use super::{
    Failure,
    args::{CommonArgs, SearchArgs},
    claims,
    effects::Purpose,
    hints,
    inputs::{self, Input, KeyProblem},
    output,
    wrong_thing::Role,
};

/// A scenario with its chain, and the records of both for a result.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// The scenario as used.
    pub(crate) scenario: Scenario,
    /// The chain, with start and goal where they are known.
    pub(crate) prepared: Prepared,
    /// The scenario for a result.
    pub(crate) document: serde_json::Value,
    /// The files that were read.
    pub(crate) inputs: Vec<InputFile>,
    /// The folder that the scenario's paths start from.
    pub(crate) base: PathBuf,
    /// How the command line gives start and goal.
    ends: EndOptions,
}

/// The options for start and goal. Commands name them differently; some have none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EndOptions {
    names: Option<[&'static str; 2]>,
    x_m: [Option<f64>; 2],
}

impl EndOptions {
    /// A command without such options.
    pub(crate) const NONE: Self = Self { names: None, x_m: [None, None] };

    /// The ends of one hop.
    pub(crate) const fn of_hop(from: Option<f64>, to: Option<f64>) -> Self {
        Self { names: Some(["--from", "--to"]), x_m: [from, to] }
    }

    /// The ends of a path.
    pub(crate) const fn of_path(start: Option<f64>, goal: Option<f64>) -> Self {
        Self { names: Some(["--start", "--goal"]), x_m: [start, goal] }
    }

    /// The source of an end's value.
    fn place(&self, end: End) -> String {
        match (self.names, self.x_m[end as usize]) {
            (Some(names), Some(_)) => names[end as usize].to_owned(),
            _ => format!("terrain.{}_x_m", end.name()),
        }
    }

    /// The failure for an end that is given nowhere.
    fn missing(&self, end: End) -> Failure {
        let name = end.name();
        Failure::message(match self.names {
            Some(names) => format!(
                "found no {name}: give {} X along the chain, or [terrain] {name}_x_m (for a dem or mesh {name}_m) in the scenario",
                names[end as usize]
            ),
            None => {
                format!("found no {name}: add {name}_x_m = X (for a dem or mesh {name}_m = [x, y]) to the scenario's [terrain]")
            }
        })
    }
}

impl Loaded {
    /// The hop test over the chain.
    pub(crate) fn hop_test(&self) -> HopTest {
        HopTest::new(Arc::clone(&self.prepared.chain))
    }

    /// Start and goal, or a failure that names the missing one.
    pub(crate) fn ends(&self) -> Result<(Station, Station), Failure> {
        let start = self.prepared.start.ok_or_else(|| self.ends.missing(End::Start))?;
        let goal = self.prepared.goal.ok_or_else(|| self.ends.missing(End::Goal))?;
        Ok((start, goal))
    }

    /// The warnings about the input and an answer, without repetition.
    pub(crate) fn warnings_with(&self, more: impl IntoIterator<Item = String>) -> Vec<String> {
        let mut warnings = self.prepared.warnings.clone();
        for warning in more {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        warnings
    }
}

/// Keys of a scenario with the file they came from.
struct Source {
    entries: Entries,
    name: String,
    text: String,
    /// The folder that its paths start from.
    base: PathBuf,
}

/// A file to analyse, and whether it is a scenario or a chain.
struct Target {
    input: Input,
    is_scenario: bool,
}

impl Target {
    /// A chain, scenario or result.
    fn chain(path: &Path) -> Result<Self, Failure> {
        let input = inputs::open(path, Role::Chain)?;
        let is_scenario = input.is_scenario();
        // What is not even a table is reported before the keys that its analysis would lack.
        if !is_scenario && input.kind != FileKind::ChainCsv {
            read_chain_csv_file(&input.file)?;
        }
        Ok(Self { input, is_scenario })
    }
}

/// Loads a scenario or result as it stands.
pub(crate) fn load_scenario(target: &Path, common: &CommonArgs, purpose: Purpose) -> Result<Loaded, Failure> {
    let target = Target { input: inputs::open(target, Role::Scenario)?, is_scenario: true };
    let source = typed(&target, common, None, EndOptions::NONE)?;
    let given = source.entries.clone();
    validate_and_prepare(&target, source, common.quiet, (EndOptions::NONE, purpose, &given), &mut prepare)
}

/// Loads a chain, scenario or result with the options beside it.
pub(crate) fn load(
    target: &Path,
    common: &CommonArgs,
    search: Option<&SearchArgs>,
    ends: EndOptions,
    purpose: Purpose,
) -> Result<Loaded, Failure> {
    load_with(target, common, search, ends, purpose, &[])
}

/// Loads the same with keys that a command's own options set: option, table, key and value.
pub(crate) fn load_with(
    target: &Path,
    common: &CommonArgs,
    search: Option<&SearchArgs>,
    ends: EndOptions,
    purpose: Purpose,
    own: &[(&str, &str, &str, toml::Value)],
) -> Result<Loaded, Failure> {
    let target = Target::chain(target)?;
    let mut source = typed(&target, common, search, ends)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let given = source.entries.clone();
    validate_and_prepare(&target, source, common.quiet, (ends, purpose, &given), &mut prepare)
}

/// A scenario of which keys are varied: the first cell, loaded, and the source of all other cells.
#[derive(Debug)]
pub(crate) struct ToVary {
    /// With the first value of every key.
    pub(crate) first: Loaded,
    /// The terrain.
    pub(crate) survey: Survey,
    /// The keys as typed, with the options.
    pub(crate) entries: Entries,
    /// The folder that the scenario's paths start from.
    pub(crate) base: PathBuf,
}

/// Loads the same for keys that are varied, the terrain read once.
pub(crate) fn load_to_vary(
    target: &Path,
    common: &CommonArgs,
    search: &SearchArgs,
    ends: EndOptions,
    swept: &[SweptKey],
) -> Result<ToVary, Failure> {
    let target = Target::chain(target)?;
    let mut source = typed(&target, common, Some(search), ends)?;
    let (entries, base) = (source.entries.clone(), source.base.clone());
    source.entries = Trade::first_cell(&entries, swept, "--vary").map_err(|error| Failure::message(format!("--vary: {error}")))?;
    let mut kept = None;
    let first =
        validate_and_prepare(&target, source, common.quiet, (ends, Purpose::Trade, &entries), &mut |scenario, terrain, base| {
            kept.insert(Survey::of(scenario, terrain, base)?).prepare(scenario)
        })?;
    let survey = kept.ok_or_else(|| Failure::message(format!("{}: found no terrain", target.input.given.display())))?;
    Ok(ToVary { first, survey, entries, base })
}

/// The keys of a chain, scenario or result with the options beside it.
fn typed(target: &Target, common: &CommonArgs, search: Option<&SearchArgs>, ends: EndOptions) -> Result<Source, Failure> {
    let Target { input, is_scenario } = target;
    let mut source = match (*is_scenario, &common.scenario) {
        (true, None) => read_source(input)?,
        (true, Some(other)) => return Err(two_scenarios(input, other, "a chain CSV as CHAIN")),
        (false, scenario) => option_source(scenario.as_deref())?,
    };
    if !is_scenario {
        for key in SLICED_TERRAIN {
            source.entries.forget("terrain", key);
        }
        for key in ["friction_raster", "keep_out"] {
            if source.entries.forget("surface", key) {
                let warning = format!("surface.{key} is laid over terrain when it is sliced: for a chain its own columns count");
                output::warn(common.quiet, &warning);
            }
        }
        source.entries.set_by_option("CHAIN", "terrain", "chain", input.file.to_string_lossy().into_owned().into());
        // A path on the command line is relative to the working folder.
        source.base = PathBuf::new();
    }
    apply_options(&mut source.entries, common, search, ends);
    look_at_keys(&mut source, *is_scenario)?;
    Ok(source)
}

/// Looks at the files that a scenario's keys name, before anything else is checked, and puts what stands in for a pipe in its place.
fn look_at_keys(source: &mut Source, chain_is_a_key: bool) -> Result<(), Failure> {
    let files = source.entries.files();
    let terrains = files.iter().filter(|(key, _)| key.table == "terrain").count();
    let has_chain = files.iter().any(|(key, _)| key.path() == "terrain.chain");
    let (mut problems, mut is_wrong) = (Vec::new(), false);
    for (key, path) in files {
        let Some(role) = Role::of_key(key.table, key.name) else { continue };
        // Which of two terrains is meant comes before what they are, and a chain takes no overlays.
        let is_undecided = key.table == "terrain" && (terrains > 1 || (role == Role::ChainKey && !chain_is_a_key));
        if is_undecided || (key.table == "surface" && has_chain) {
            continue;
        }
        let path = if path == "-" { PathBuf::from(path) } else { source.base.join(path) };
        match inputs::of_key(&path, role)? {
            Ok(input) if input.is_stream() => source.entries.redirect(key, &input.file.to_string_lossy()),
            Ok(_) => {}
            Err(KeyProblem { found, help, is_unreadable }) => {
                is_wrong |= !is_unreadable;
                problems.push(source.entries.file_problem(key, found, help));
            }
        }
    }
    if problems.is_empty() || source.entries.is_unreadable() {
        return Ok(());
    }
    // Of a file that is something else, further problems may be consequences.
    if !is_wrong && let Err(others) = Scenario::new(source.entries.clone()) {
        problems.extend(others);
    }
    Err(refused(problems, &source.name, &source.text))
}

/// Prepares a chain from a scenario and its terrain, whose paths start from the given folder.
type Prepare<'a> = &'a mut dyn FnMut(&Scenario, &TerrainSource, &Path) -> Result<Prepared, PipelineError>;

/// Validates keys and prepares their chain. `given`: the keys of file and options, without those that a command varies.
fn validate_and_prepare(
    target: &Target,
    source: Source,
    quiet: bool,
    (ends, purpose, given): (EndOptions, Purpose, &Entries),
    prepare: Prepare<'_>,
) -> Result<Loaded, Failure> {
    let base = source.base;
    let Target { input, is_scenario } = target;
    let replaced = Purpose::replaced(&source.entries);
    let mut scenario = validated(source.entries, &source.name, &source.text)?;
    let mut terrain = scenario.terrain.clone().ok_or_else(|| {
        let name = input.given.display();
        // Results of chains name their terrain; those of maps and fans cover all headings and have no chain.
        Failure::message(if input.is_result() {
            format!("{name}: found no terrain, as in results of `chta map` and `chta fan`: repeat those with their DEM and --scenario {name}")
        } else {
            format!("{name}: found no terrain; add [terrain] with dem, mesh or chain, or give a chain CSV")
        })
    })?;
    let chain_name = input.file.to_string_lossy().into_owned();
    if !is_scenario && terrain == (TerrainSource::Chain { path: chain_name.into() }) {
        // The name as given, in case it is not UTF-8.
        terrain = TerrainSource::Chain { path: input.file.clone() };
        scenario.terrain = Some(terrain.clone());
    }
    let file = base.join(terrain.path());
    let exact = || Scenario { hopper: scenario.hopper.with_any_command(), ..scenario.clone() };
    let assumed = (!purpose.flies_commands()).then(exact);
    let mut prepared =
        prepare(assumed.as_ref().unwrap_or(&scenario), &terrain, &base).map_err(|error| unprepared(error, &file, ends))?;
    prepared.warnings.extend(purpose.unused(given, &scenario).into_iter().chain(replaced));
    for warning in &prepared.warnings {
        output::warn(quiet, warning);
    }
    let mut inputs = match terrain {
        TerrainSource::Dem { .. } => raster_files(&file)?,
        TerrainSource::Mesh { .. } | TerrainSource::Chain { .. } => vec![input_file(&file)?],
    };
    for overlay in Overlays::files(&scenario) {
        inputs.extend(raster_files(&base.join(overlay))?);
    }
    let document = scenario_document(&scenario, &|path| relative_name(&base.join(path)));
    Ok(Loaded { scenario, prepared, document, inputs, base, ends })
}

/// The failure for a terrain without a usable chain, with the file or option at fault.
fn unprepared(error: PipelineError, file: &Path, ends: EndOptions) -> Failure {
    match error {
        PipelineError::Csv(error) => Failure::Csv(error),
        PipelineError::OffChain { which, problem } => Failure::message(format!("{}: {problem}", ends.place(which))),
        other => Failure::about(file, &other),
    }
}

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
    search: &SearchArgs,
    purpose: impl Fn(ScenarioEnds) -> Purpose,
    has_start: bool,
) -> Result<Bare, Failure> {
    let input = inputs::open(target, Role::MapTarget)?;
    let ends = match (input.is_scenario(), has_start) {
        (_, false) => ScenarioEnds::Needed,
        (true, true) => ScenarioEnds::Offered,
        (false, true) => ScenarioEnds::Ignored,
    };
    let source = match (input.is_scenario(), &common.scenario) {
        (true, Some(other)) => return Err(two_scenarios(&input, other, "a DEM as DEM")),
        (true, None) => read_source(&input)?,
        (false, scenario) => option_source(scenario.as_deref())?,
    };
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

/// The failure for two scenarios.
fn two_scenarios(input: &Input, other: &Path, instead: &str) -> Failure {
    Failure::message(format!(
        "found two scenarios, {} and --scenario {}, expected one: give {instead}, or leave --scenario away",
        input.given.display(),
        other.display()
    ))
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
        (own_ends(&source, purpose.scenario_ends())?, dem)
    } else {
        look_at_keys(&mut source, false)?;
        let ends = own_ends(&source, purpose.scenario_ends())?;
        let own = source.entries.files().into_iter().find(|(key, _)| key.path() == "terrain.dem").map(|(_, file)| file);
        let own = own.ok_or_else(|| {
            let name = &source.name;
            Failure::message(format!(
                "{name}: found no terrain.dem, expected one for a map: add it, or give the DEM, and the scenario with --scenario {name}"
            ))
        })?;
        (ends, source.base.join(own))
    };
    let title = given.given().any(|(key, place)| key.path() == "report.title" && *place != Place::Nowhere);
    let title = given.title().filter(|_| title).map(str::to_owned);
    forget_terrain(&mut source.entries);
    look_at_keys(&mut source, false)?;
    let scenario = validated(source.entries, &source.name, &source.text)?;
    let warnings = purpose.unused(&given, &scenario).into_iter().chain(Purpose::replaced(&given)).collect();
    let lacking = scenario.lacks_on_a_dem();
    if !lacking.is_empty() {
        let name = common.scenario.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default();
        return Err(Failure::message(name + &lacking_on_a_dem(&lacking)));
    }
    let document = scenario_document(&scenario, &|path| relative_name(&source.base.join(path)));
    // Hops over a map have exact commands, which the warnings say.
    let scenario = Scenario { hopper: scenario.hopper.with_any_command(), ..scenario };
    Ok(Bare { dem, scenario, base: source.base, document, warnings, title, ends })
}

/// The start and goal of a scenario on its DEM, where they count.
fn own_ends(source: &Source, wanted: ScenarioEnds) -> Result<Option<[MapPlace; 2]>, Failure> {
    let has_dem = source.entries.files().iter().any(|(key, _)| key.path() == "terrain.dem");
    if wanted == ScenarioEnds::Ignored || !has_dem {
        return Ok(None);
    }
    let scenario = match validated(source.entries.clone(), &source.name, &source.text) {
        // A start or goal that the scenario lacks is not missed where the command line has a start.
        Err(_) if wanted == ScenarioEnds::Offered => return Ok(None),
        scenario => scenario?,
    };
    Ok(scenario.terrain.and_then(|terrain| terrain.map_ends()))
}

/// The failure for keys that hops over a DEM need, with how to give them.
fn lacking_on_a_dem(keys: &[LackingKey]) -> String {
    let name = |LackingKey { key, instead, .. }: &LackingKey| match instead {
        [] => (*key).to_owned(),
        instead => format!("{key} (or {})", instead.join(" and ")),
    };
    let names: Vec<_> = keys.iter().map(name).collect();
    let sets: Vec<_> = keys.iter().map(|LackingKey { key, example, .. }| format!("--set {key}={example}")).collect();
    format!(
        "found no {}, expected in the scenario, since a DEM has no columns for it: add it to the file of --scenario, or give, for \
         example, {}",
        names.join(", no "),
        sets.join(" ")
    )
}

/// A file that was read, for a result.
pub(crate) fn input_file(path: &Path) -> Result<InputFile, Failure> {
    claims::reads(path);
    Ok(InputFile { name: relative_name(path), sha256: sha256_of(path)? })
}

/// A raster and the files beside it that were read, for a result.
pub(crate) fn raster_files(path: &Path) -> Result<Vec<InputFile>, Failure> {
    [path.to_path_buf()].into_iter().chain(sidecar_files(path)).map(|file| input_file(&file)).collect()
}

/// The DEM and the overlays of a scenario over it, for a result.
pub(crate) fn raster_files_of(bare: &Bare) -> Result<Vec<InputFile>, Failure> {
    let mut files = raster_files(&bare.dem)?;
    for overlay in Overlays::files(&bare.scenario) {
        files.extend(raster_files(&bare.base.join(overlay))?);
    }
    Ok(files)
}

/// Reads a scenario with the folder of its paths but without its terrain, for commands that have their own.
pub(crate) fn scenario_alone(path: &Path) -> Result<(Scenario, PathBuf), Failure> {
    let mut source = option_source(Some(path))?;
    forget_terrain(&mut source.entries);
    look_at_keys(&mut source, false)?;
    Ok((validated(source.entries, &source.name, &source.text)?, source.base))
}

/// The keys of a terrain that is sliced.
const SLICED_TERRAIN: [&str; 9] =
    ["dem", "mesh", "mesh_scale", "start_m", "goal_m", "start_lonlat_deg", "goal_lonlat_deg", "via_m", "via_lonlat_deg"];

/// The keys of a terrain that is given as a chain.
const CHAIN_TERRAIN: [&str; 3] = ["chain", "start_x_m", "goal_x_m"];

/// Whether a key of `[terrain]` gives way to the DEM of a command line.
pub(crate) fn gives_way_to_a_dem(name: &str) -> bool {
    SLICED_TERRAIN.contains(&name) || CHAIN_TERRAIN.contains(&name)
}

/// Removes the scenario's terrain, where the command line gives another.
fn forget_terrain(entries: &mut Entries) {
    for key in SLICED_TERRAIN.into_iter().chain(CHAIN_TERRAIN) {
        entries.forget("terrain", key);
    }
}

/// The keys of the scenario of an option; none without it.
fn option_source(scenario: Option<&Path>) -> Result<Source, Failure> {
    match scenario {
        Some(path) => read_source(&inputs::open(path, Role::ScenarioOption)?),
        None => Ok(Source { entries: Entries::default(), name: String::new(), text: String::new(), base: PathBuf::new() }),
    }
}

/// Reads the keys of a scenario (TOML) or of a result (JSON).
fn read_source(input: &Input) -> Result<Source, Failure> {
    const LARGEST: u64 = 1 << 24;
    let path = input.file.as_path();
    claims::reads(path);
    let name = input.given.display().to_string();
    let unread =
        |reason: String, help: &str| Failure::message(format!("{name}: cannot be read ({reason}), expected a scenario: {help}"));
    let size = fs::metadata(path).map_err(|e| unread(e.to_string(), "check the path and its permissions"))?.len();
    if size > LARGEST {
        return Err(unread(format!("{size} bytes"), "a scenario has some kilobytes; give a chain or DEM inside it"));
    }
    let mut bytes = Vec::new();
    // Reading is bounded as well: the size of a pipe or device is not known in advance.
    let read = fs::File::open(path).and_then(|file| file.take(LARGEST).read_to_end(&mut bytes));
    read.map_err(|e| unread(e.to_string(), "check the path and its permissions"))?;
    let text = String::from_utf8(bytes).map_err(|e| unread(e.to_string(), "write it as TOML in UTF-8"))?;
    // A pipe has no folder: its paths start from the working folder.
    let folder = if input.is_stream() { None } else { path.parent() }.map(Path::to_path_buf).unwrap_or_default();
    if input.is_result() {
        let result: serde_json::Value =
            serde_json::from_str(&text).map_err(|e| unread(e.to_string(), "give a result.json that chta wrote"))?;
        let scenario = result
            .get("scenario")
            .ok_or_else(|| unread("it has no `scenario`".to_owned(), "give a result.json that chta wrote"))?;
        // The paths in a result are relative to the folder in which chta ran.
        return Ok(Source { entries: Entries::from_json(scenario), name, text: String::new(), base: PathBuf::new() });
    }
    let mut entries = Entries::from_toml(&text);
    if !input.is_stream() {
        entries.set_default_title(&path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default());
    }
    Ok(Source { entries, name, text, base: folder })
}

/// Options override the scenario: `--set` first, then named options.
fn apply_options(entries: &mut Entries, common: &CommonArgs, search: Option<&SearchArgs>, ends: EndOptions) {
    let CommonArgs { scenario: _, set, body, gravity_m_s2, clearance_m, accept_map_scale, no_data, input_max_gib: _, quiet: _ } =
        common;
    // The keys that an option replaces are removed from the file's keys only, not from those set by the same command line.
    if body.is_some() {
        entries.forget("body", "gravity_m_s2");
        entries.forget("body", "radius_m");
    }
    if search.is_some_and(|search| search.points_per_segment.is_some()) {
        entries.forget("search", "node_spacing_max_m");
    }
    if search.is_some_and(|search| search.node_spacing_max_m.is_some()) {
        entries.forget("search", "points_per_segment");
    }
    for assignment in set {
        entries.set(&format!("--set {assignment}"), assignment);
    }
    if let Some(name) = body {
        entries.set_by_option("--body", "body", "name", name.clone().into());
    }
    if let Some(gravity) = gravity_m_s2 {
        entries.set_by_option("--gravity-m-s2", "body", "gravity_m_s2", (*gravity).into());
    }
    if let Some(clearance) = clearance_m {
        entries.set_by_option("--clearance-m", "hopper", "clearance_m", (*clearance).into());
    }
    if let Some(no_data) = no_data {
        let value = no_data.parse().map_or_else(|_| toml::Value::from(no_data.clone()), toml::Value::Float);
        entries.set_by_option("--no-data", "terrain", "no_data", value);
    }
    if *accept_map_scale {
        entries.set_by_option("--accept-map-scale", "terrain", "accept_map_scale", true.into());
    }
    for (end, key) in [(End::Start, "start_x_m"), (End::Goal, "goal_x_m")] {
        if let Some(x_m) = ends.x_m[end as usize] {
            entries.set_by_option(&ends.place(end), "terrain", key, x_m.into());
        }
    }
    let Some(SearchArgs { points_per_segment, node_spacing_max_m, effort }) = search else { return };
    if let Some(points) = points_per_segment {
        let value = points.parse::<i64>().map_or_else(|_| toml::Value::from(points.clone()), toml::Value::from);
        entries.set_by_option("--points-per-segment", "search", "points_per_segment", value);
    }
    if let Some(spacing) = node_spacing_max_m {
        entries.set_by_option("--node-spacing-max-m", "search", "node_spacing_max_m", (*spacing).into());
    }
    if let Some(effort) = effort {
        entries.set_by_option("--effort", "search", "effort", effort.clone().into());
    }
}

/// Validates keys; every problem names the file that they came from.
fn validated(entries: Entries, name: &str, text: &str) -> Result<Scenario, Failure> {
    Scenario::new(entries).map_err(|problems| refused(problems, name, text))
}

/// The failure for problems of keys; it names the file that they came from.
fn refused(mut problems: Vec<ScenarioProblem>, name: &str, text: &str) -> Failure {
    for problem in &mut problems {
        problem.help.push_str(hints::of_problem(problem));
    }
    let in_file = problems.iter().any(|problem| !matches!(problem.place, Place::Option(_)));
    let (name, source) = if in_file { (name.to_owned(), text.to_owned()) } else { (String::new(), String::new()) };
    Failure::Scenario(ScenarioProblems { name, source, problems })
}

/// A file's path relative to the working folder, normalised and with `/`, so that results are the same on every platform.
///
/// What came through a pipe keeps the name it was given under, such as `-`.
pub(crate) fn relative_name(path: &Path) -> String {
    if let Some(given) = inputs::given_name(path) {
        return given.to_string_lossy().into_owned();
    }
    let here = std::env::current_dir().unwrap_or_default();
    let absolute = normal(&here.join(path));
    let here = normal(&here);
    let shared = absolute.iter().zip(&here).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), here.len() - shared);
    up.chain(absolute[shared..].iter().cloned()).collect::<Vec<_>>().join("/")
}

/// The parts of a path, with `.` and `..` resolved as text.
fn normal(path: &Path) -> Vec<String> {
    let mut parts = Vec::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                parts.pop();
            }
            Component::Prefix(_) | Component::RootDir | Component::Normal(_) => {
                parts.push(component.as_os_str().to_string_lossy().into_owned());
            }
        }
    }
    parts
}
