//! From the command line to a scenario and its chain.

use std::{
    fs,
    io::Read,
    path::{Component, Path, PathBuf},
    sync::Arc,
};

use chta::{
    chain::Station,
    hop::HopTest,
    report::InputFile,
    scenario::{
        Entries, JourneyEnd as End, LackingKey, Overlays, PipelineError, Place, Prepared, Scenario, ScenarioProblem,
        ScenarioProblems, Survey, SweptKey, TerrainSource, Trade, prepare, scenario_document, sha256_of,
    },
};

use super::{
    Failure,
    args::{CommonArgs, SearchArgs},
    claims,
    effects::Purpose,
    hints, output,
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
    let mut source = typed(target, common, search, ends)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let given = source.entries.clone();
    validate_and_prepare(target, source, common.quiet, (ends, purpose, &given), &mut prepare)
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
    let mut source = typed(target, common, Some(search), ends)?;
    let (entries, base) = (source.entries.clone(), source.base.clone());
    source.entries = Trade::first_cell(&entries, swept, "--vary").map_err(|error| Failure::message(format!("--vary: {error}")))?;
    let mut kept = None;
    let first =
        validate_and_prepare(target, source, common.quiet, (ends, Purpose::Trade, &entries), &mut |scenario, terrain, base| {
            kept.insert(Survey::of(scenario, terrain, base)?).prepare(scenario)
        })?;
    let survey = kept.ok_or_else(|| Failure::message(format!("{}: found no terrain", target.display())))?;
    Ok(ToVary { first, survey, entries, base })
}

/// The keys of a chain, scenario or result with the options beside it.
fn typed(target: &Path, common: &CommonArgs, search: Option<&SearchArgs>, ends: EndOptions) -> Result<Source, Failure> {
    let is_scenario = is_scenario(target);
    let mut source = match (is_scenario, &common.scenario) {
        (true, None) => read_source(target)?,
        (true, Some(other)) => {
            return Err(Failure::message(format!(
                "found two scenarios, {} and --scenario {}, expected one: give a chain CSV as CHAIN, or leave --scenario away",
                target.display(),
                other.display()
            )));
        }
        (false, Some(scenario)) => read_source(scenario)?,
        (false, None) => Source { entries: Entries::default(), name: String::new(), text: String::new(), base: PathBuf::new() },
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
        source.entries.set_by_option("CHAIN", "terrain", "chain", target.to_string_lossy().into_owned().into());
        // A path on the command line is relative to the working folder.
        source.base = PathBuf::new();
    }
    apply_options(&mut source.entries, common, search, ends);
    Ok(source)
}

/// Prepares a chain from a scenario and its terrain, whose paths start from the given folder.
type Prepare<'a> = &'a mut dyn FnMut(&Scenario, &TerrainSource, &Path) -> Result<Prepared, PipelineError>;

/// Validates keys and prepares their chain. `given`: the keys of file and options, without those that a command varies.
fn validate_and_prepare(
    target: &Path,
    source: Source,
    quiet: bool,
    (ends, purpose, given): (EndOptions, Purpose, &Entries),
    prepare: Prepare<'_>,
) -> Result<Loaded, Failure> {
    let base = source.base;
    let replaced = Purpose::replaced(&source.entries);
    let mut scenario = validated(source.entries, &source.name, &source.text)?;
    let mut terrain = scenario.terrain.clone().ok_or_else(|| {
        let name = target.display();
        // Results of chains name their terrain; those of maps and fans cover all headings and have no chain.
        let is_result = target.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
        Failure::message(if is_result {
            format!("{name}: found no terrain, as in results of `chta map` and `chta fan`: repeat those with their DEM and --scenario {name}")
        } else {
            format!("{name}: found no terrain; add [terrain] with dem, mesh or chain, or give a chain CSV")
        })
    })?;
    let chain_name = target.to_string_lossy().into_owned();
    if !is_scenario(target) && terrain == (TerrainSource::Chain { path: chain_name.into() }) {
        // The name as given, in case it is not UTF-8.
        terrain = TerrainSource::Chain { path: target.to_path_buf() };
        scenario.terrain = Some(terrain.clone());
    }
    let file = base.join(terrain.path());
    let mut prepared = prepare(&scenario, &terrain, &base).map_err(|error| unprepared(error, &file, ends))?;
    prepared.warnings.extend(purpose.unused(given, &scenario).into_iter().chain(replaced));
    for warning in &prepared.warnings {
        output::warn(quiet, warning);
    }
    let mut inputs = vec![input_file(&file)?];
    for overlay in Overlays::files(&scenario) {
        inputs.push(input_file(&base.join(overlay))?);
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
    /// The scenario as used.
    pub(crate) scenario: Scenario,
    /// The folder that its paths start from.
    pub(crate) base: PathBuf,
    /// The scenario for a result.
    pub(crate) document: serde_json::Value,
    /// Warnings about keys without effect.
    pub(crate) warnings: Vec<String>,
}

/// Loads the scenario of the options for hops over this DEM, without its own terrain.
pub(crate) fn load_bare(dem: &Path, common: &CommonArgs, search: &SearchArgs, purpose: Purpose) -> Result<Bare, Failure> {
    if is_scenario(dem) {
        let name = dem.display();
        return Err(Failure::message(format!(
            "{name}: found a scenario in place of the DEM, expected a GeoTIFF or ESRI ASCII grid: give the DEM first, and the scenario \
             with --scenario {name}"
        )));
    }
    let mut source = match &common.scenario {
        Some(path) => read_source(path)?,
        None => Source { entries: Entries::default(), name: String::new(), text: String::new(), base: PathBuf::new() },
    };
    apply_options(&mut source.entries, common, Some(search), EndOptions::NONE);
    let given = source.entries.clone();
    forget_terrain(&mut source.entries);
    let scenario = validated(source.entries, &source.name, &source.text)?;
    let warnings = purpose.unused(&given, &scenario).into_iter().chain(Purpose::replaced(&given)).collect();
    let lacking = scenario.lacks_on_a_dem();
    if !lacking.is_empty() {
        let name = common.scenario.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default();
        return Err(Failure::message(name + &lacking_on_a_dem(&lacking)));
    }
    let document = scenario_document(&scenario, &|path| relative_name(&source.base.join(path)));
    Ok(Bare { scenario, base: source.base, document, warnings })
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

/// Reads a scenario with the folder of its paths but without its terrain, for commands that have their own.
pub(crate) fn scenario_alone(path: &Path) -> Result<(Scenario, PathBuf), Failure> {
    let mut source = read_source(path)?;
    forget_terrain(&mut source.entries);
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

/// Whether a file is a scenario or a result by its extension; any other file is a chain CSV.
pub(crate) fn is_scenario(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml") || extension.eq_ignore_ascii_case("json"))
}

/// Reads the keys of a scenario (TOML) or of a result (JSON).
fn read_source(path: &Path) -> Result<Source, Failure> {
    const LARGEST: u64 = 1 << 24;
    claims::reads(path);
    let name = path.display().to_string();
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
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
        let result: serde_json::Value =
            serde_json::from_str(&text).map_err(|e| unread(e.to_string(), "give a result.json that chta wrote"))?;
        let scenario = result
            .get("scenario")
            .ok_or_else(|| unread("it has no `scenario`".to_owned(), "give a result.json that chta wrote"))?;
        // The paths in a result are relative to the folder in which chta ran.
        return Ok(Source { entries: Entries::from_json(scenario), name, text: String::new(), base: PathBuf::new() });
    }
    let mut entries = Entries::from_toml(&text);
    entries.set_default_title(&path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default());
    Ok(Source { entries, name, text, base: folder })
}

/// Options override the scenario: `--set` first, then named options.
fn apply_options(entries: &mut Entries, common: &CommonArgs, search: Option<&SearchArgs>, ends: EndOptions) {
    let CommonArgs { scenario: _, set, body, gravity_m_s2, clearance_m, accept_map_scale, quiet: _ } = common;
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
    Scenario::new(entries).map_err(|mut problems: Vec<ScenarioProblem>| {
        for problem in &mut problems {
            problem.help.push_str(hints::of_problem(problem));
        }
        let in_file = problems.iter().any(|problem| !matches!(problem.place, Place::Option(_)));
        let (name, source) = if in_file { (name.to_owned(), text.to_owned()) } else { (String::new(), String::new()) };
        Failure::Scenario(ScenarioProblems { name, source, problems })
    })
}

/// A file's path relative to the working folder, normalised and with `/`, so that results are the same on every platform.
pub(crate) fn relative_name(path: &Path) -> String {
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
