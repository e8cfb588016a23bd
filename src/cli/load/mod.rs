//! From the command line to a scenario and its chain.

mod arena;
mod bare;
mod drift;
mod ends;
mod mesh_hop;
mod mesh_plan;
mod names;
mod pairs;
mod result;
mod stance;
mod vary;

use std::path::{Path, PathBuf};

use chta::{
    chain::{Station, csv::read_chain_csv_file},
    report::{DocumentKind, InputFile},
    scenario::{Entries, FileKind, LackingKey, Scenario, ScenarioProblems, TerrainSource},
    study::{
        Case, CaseError, CaseRecord, PipelineError, checksums,
        open::{Draft, OpenCase, OpenError, SLICED_TERRAIN},
        scenario_files,
    },
};
use serde::Serialize;

pub(crate) use arena::load_arena;
pub(crate) use bare::{Bare, load_bare, load_map};
pub(crate) use drift::load_drift;
pub(crate) use ends::EndOptions;
pub(crate) use mesh_hop::{MeshHopInput, load_mesh_hop};
pub(crate) use mesh_plan::{MeshPlanInput, is_over_mesh, load_mesh_plan, load_mesh_scenario};
pub(crate) use names::relative_name;
pub(crate) use pairs::read_pairs;
pub(crate) use result::{MeshResult, plan_to_fly};
pub(crate) use stance::{contacts_document, load_stance};
pub(crate) use vary::load_to_vary;

use super::{
    Failure,
    args::{CommonArgs, JourneyArgs, SearchArgs},
    claims,
    effects::{Purpose, WORDING},
    hints,
    inputs::{self, Input, KeyProblem},
    output, verbose,
    wrong_thing::Role,
};

/// A case, and what a result says of it.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// The scenario over its terrain, with all warnings about the input.
    pub(crate) case: Case,
    /// The head of its documents.
    pub(crate) record: CaseRecord,
    /// How the command line gives start and goal.
    ends: EndOptions,
}

impl Loaded {
    /// Start and goal, or a failure that names the missing one.
    pub(crate) fn ends(&self) -> Result<(Station, Station), Failure> {
        self.case.ends().map_err(|error| match error {
            CaseError::MissingEnd { which } => self.ends.missing(which),
            other => other.into(),
        })
    }

    /// The same case, whose search may take no more memory than this.
    pub(crate) fn within_memory(self, memory_max_bytes: Option<u64>) -> Result<Self, Failure> {
        Ok(Self { case: self.case.within_memory(memory_max_bytes)?, ..self })
    }

    /// An answer as one document, with its warnings.
    pub(crate) fn document<T: Serialize>(&self, kind: DocumentKind, warnings: &[String], answer: T) -> Result<String, Failure> {
        Ok(self.record.document(kind, warnings, answer).to_json()?)
    }

    /// Refuses an option that needs a chain on a map.
    pub(crate) fn check_on_map(&self, option: &str) -> Result<(), Failure> {
        match self.case.prepared.chain.geometry().map_points() {
            Some(_) => Ok(()),
            None => Err(Failure::message(format!(
                "{option}: the chain lies on no map; give it map_x_m and map_y_m, or slice it from a DEM"
            ))),
        }
    }
}

/// What a file to analyse is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TargetKind {
    Scenario,
    Chain,
    Raster,
}

/// A file to analyse, and what it is.
struct Target {
    input: Input,
    kind: TargetKind,
}

impl Target {
    /// A chain, scenario or result.
    fn chain(path: &Path) -> Result<Self, Failure> {
        Self::of(path, Role::Chain)
    }

    /// The same, or an elevation raster where the role takes one.
    fn of(path: &Path, role: Role) -> Result<Self, Failure> {
        let input = inputs::open(path, role)?;
        let kind = match input.is_scenario() {
            true => TargetKind::Scenario,
            false if role.takes_rasters() && input.is_raster() => TargetKind::Raster,
            false => TargetKind::Chain,
        };
        // What is not even a table is reported before the keys that its analysis would lack.
        if kind == TargetKind::Chain && input.kind != FileKind::ChainCsv {
            read_chain_csv_file(&input.file)?;
        }
        Ok(Self { input, kind })
    }

    fn is_scenario(&self) -> bool {
        self.kind == TargetKind::Scenario
    }
}

/// Whether a file is a scenario that drives, by its keys alone; one that cannot be read is reported when it is loaded.
pub(crate) fn drives(target: &Path, common: &CommonArgs) -> bool {
    scenario_of(target, common).is_some_and(|scenario| scenario.drives().is_some())
}

/// Whether a file is a scenario of a mission over targets, in the same way.
pub(crate) fn visits(target: &Path, common: &CommonArgs) -> bool {
    scenario_of(target, common).is_some_and(|scenario| scenario.mission.is_some())
}

/// The scenario of a file by its keys alone.
fn scenario_of(target: &Path, common: &CommonArgs) -> Option<Scenario> {
    let mut source = read_source(&inputs::open(target, Role::Scenario).ok()?).ok()?;
    apply_options(&mut source.entries, common, None, EndOptions::NONE);
    Scenario::new(source.entries).ok()
}

/// Loads a scenario or result as it stands.
pub(crate) fn load_scenario(target: &Path, common: &CommonArgs, purpose: Purpose) -> Result<Loaded, Failure> {
    let target = Target { input: inputs::open(target, Role::Scenario)?, kind: TargetKind::Scenario };
    let source = typed(&target, common, None, EndOptions::NONE)?;
    let given = source.entries.clone();
    validate_and_prepare(&target, source, common.quiet, (EndOptions::NONE, purpose, &given), &mut of(purpose))
}

/// Loads the chain, scenario or result of a journey with the options beside it, and with keys that a command's own options set.
pub(crate) fn load_journey(
    JourneyArgs { chain, start, goal }: &JourneyArgs,
    common: &CommonArgs,
    search: &SearchArgs,
    purpose: Purpose,
    own: &[OwnKey<'_>],
) -> Result<Loaded, Failure> {
    load(chain, common, Some(search), EndOptions::of_path(*start, *goal), purpose, own)
}

/// A key that a command's own option sets: option, table, key and value.
pub(crate) type OwnKey<'a> = (&'a str, &'a str, &'a str, toml::Value);

/// Loads a chain, scenario or result with the options beside it, and with keys that a command's own options set.
pub(crate) fn load(
    target: &Path,
    common: &CommonArgs,
    search: Option<&SearchArgs>,
    ends: EndOptions,
    purpose: Purpose,
    own: &[OwnKey<'_>],
) -> Result<Loaded, Failure> {
    loaded_from(&Target::chain(target)?, common, (search, ends), purpose, own)
}

/// Loads the terrain of one hop, or a scenario or result that has it, with the options beside it.
pub(crate) fn load_hop(terrain: &Path, common: &CommonArgs, ends: EndOptions) -> Result<Loaded, Failure> {
    loaded_from(&Target::of(terrain, Role::HopTerrain)?, common, (None, ends), Purpose::Hop, &[])
}

fn loaded_from(
    target: &Target,
    common: &CommonArgs,
    (search, ends): (Option<&SearchArgs>, EndOptions),
    purpose: Purpose,
    own: &[OwnKey<'_>],
) -> Result<Loaded, Failure> {
    let mut source = typed(target, common, search, ends)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let given = source.entries.clone();
    validate_and_prepare(target, source, common.quiet, (ends, purpose, &given), &mut of(purpose))
}

/// The keys of a chain, scenario or result with the options beside it.
fn typed(target: &Target, common: &CommonArgs, search: Option<&SearchArgs>, ends: EndOptions) -> Result<Draft, Failure> {
    let Target { input, kind } = target;
    let mut source = match (target.is_scenario(), &common.scenario) {
        (true, None) => read_source(input)?,
        (true, Some(other)) => return Err(two_scenarios(input, other, "a chain CSV as CHAIN")),
        (false, scenario) => option_source(scenario.as_deref())?,
    };
    let has_chain = source.entries.files().iter().any(|(key, _)| key.path() == "terrain.chain");
    let on_chain = *kind == TargetKind::Chain || (*kind == TargetKind::Scenario && has_chain);
    ends.check_counts(&input.given, *kind == TargetKind::Raster, on_chain)?;
    if *kind == TargetKind::Raster {
        source.forget_terrain();
        // The files of a scenario beside the raster lie where that scenario does.
        for (key, path) in source.entries.files().into_iter().filter(|(_, path)| path != "-") {
            source.entries.redirect(key, &source.base.join(path).to_string_lossy());
        }
        let base = source.base.clone();
        source.entries.redirect_layers(|path| base.join(path).to_string_lossy().into_owned());
        source.entries.set_by_option("TERRAIN", "terrain", "dem", input.file.to_string_lossy().into_owned().into());
        source.base = PathBuf::new();
    }
    if *kind == TargetKind::Chain {
        for key in SLICED_TERRAIN {
            source.entries.forget("terrain", key);
        }
        for key in ["friction_raster", "keep_out", "keep_in"] {
            if source.entries.forget("surface", key) {
                let warning = format!("surface.{key} is laid over terrain when it is sliced: for a chain its own columns count");
                output::warn(common.quiet, &warning);
            }
        }
        for name in source.entries.names_in("layer") {
            source.entries.forget("layer", &name);
            let warning = format!("layer.{name} is laid over a map: it has no effect on a chain that is given by itself");
            output::warn(common.quiet, &warning);
        }
        // The measured errors of a scenario beside the chain lie where that scenario does.
        for (key, path) in
            source.entries.files().into_iter().filter(|(key, path)| matches!(key.table, "robot" | "uncertainty") && path != "-")
        {
            source.entries.redirect(key, &source.base.join(path).to_string_lossy());
        }
        source.entries.set_by_option("CHAIN", "terrain", "chain", input.file.to_string_lossy().into_owned().into());
        // A path on the command line is relative to the working folder.
        source.base = PathBuf::new();
    }
    apply_options(&mut source.entries, common, search, ends);
    if *kind == TargetKind::Raster && ends.is_of_hop() {
        for layer in source.entries.forget_costs_of_layers() {
            let warning = format!("layer.{layer} has a cost, which counts along whole paths: it is not stated of a hop by itself");
            output::warn(common.quiet, &warning);
        }
        for layer in source.entries.forget_layers_with_outages() {
            let warning =
                format!("layer.{layer} may be left for a while, which counts along whole paths: it refuses no hop by itself");
            output::warn(common.quiet, &warning);
        }
    }
    look_at_keys(&mut source, target.is_scenario())?;
    Ok(source)
}

/// Looks at the files that a scenario's keys name, before anything else is checked, and puts what stands in for a pipe in its place.
fn look_at_keys(source: &mut Draft, chain_is_a_key: bool) -> Result<(), Failure> {
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
    Err(refused(source.refused(problems)))
}

/// How the cases of a question are prepared.
fn of(purpose: Purpose) -> impl FnMut(Scenario, &Path) -> Result<Case, CaseError> {
    move |scenario, base| Case::new(scenario, base, purpose.commands())
}

/// Prepares the case of a scenario, whose paths start from the given folder.
type Prepare<'a> = &'a mut dyn FnMut(Scenario, &Path) -> Result<Case, CaseError>;

/// A case and what a result says of it, once the files that it read are noted.
fn stated(OpenCase { case, record }: OpenCase, ends: EndOptions) -> Loaded {
    for file in scenario_files(&case.scenario, &case.base) {
        claims::reads(&file);
        verbose::read(&file);
    }
    let geometry = case.prepared.chain.geometry();
    let (from_m, to_m) = geometry.extent_m();
    verbose::say(|| format!("the chain has {} segments, x from {from_m} to {to_m} m", geometry.segment_count()));
    verbose::settings(&record.scenario, &case.scenario.search);
    Loaded { case, record, ends }
}

/// Validates keys and prepares their case. `given`: the keys of file and options, without those that a command varies.
fn validate_and_prepare(
    target: &Target,
    source: Draft,
    quiet: bool,
    (ends, purpose, given): (EndOptions, Purpose, &Entries),
    prepare: Prepare<'_>,
) -> Result<Loaded, Failure> {
    let Target { input, kind } = target;
    let mut scenario = validated(&source)?;
    let Draft { base, entries, .. } = source;
    let lacking = scenario.lacks_on_a_dem();
    if *kind == TargetKind::Raster && !lacking.is_empty() {
        return Err(Failure::message(lacking_on(&lacking, "a DEM")));
    }
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
    if *kind == TargetKind::Chain && terrain == (TerrainSource::Chain { path: chain_name.into() }) {
        // The name as given, in case it is not UTF-8.
        terrain = TerrainSource::Chain { path: input.file.clone() };
        scenario.terrain = Some(terrain.clone());
    }
    let file = base.join(terrain.path());
    let case = prepare(scenario, &base).map_err(|error| match error {
        CaseError::Prepare(error) => unprepared(error, &file, ends),
        other => other.into(),
    })?;
    let opened = OpenCase::new(case, purpose, [given, &entries], &WORDING)?;
    output::warn_all(quiet, &opened.case.prepared.warnings);
    Ok(stated(opened, ends))
}

/// The failure for a terrain without a usable chain, with the file or option at fault.
fn unprepared(error: PipelineError, file: &Path, ends: EndOptions) -> Failure {
    match error {
        PipelineError::Csv(error) => Failure::Csv(error),
        PipelineError::OffChain { which, problem } => Failure::message(format!("{}: {problem}", ends.place(which))),
        other => Failure::about(file, &other),
    }
}

/// The failure for two scenarios.
fn two_scenarios(input: &Input, other: &Path, instead: &str) -> Failure {
    Failure::message(format!(
        "found two scenarios, {} and --scenario {}, expected one: give {instead}, or leave --scenario away",
        input.given.display(),
        other.display()
    ))
}

/// The failure for keys that hops over a terrain without columns need, with how to give them.
fn lacking_on(keys: &[LackingKey], terrain: &str) -> String {
    let name = |LackingKey { key, instead, .. }: &LackingKey| match instead {
        [] => (*key).to_owned(),
        instead => format!("{key} (or {})", instead.join(" and ")),
    };
    let names: Vec<_> = keys.iter().map(name).collect();
    let sets: Vec<_> = keys.iter().map(|LackingKey { key, example, .. }| format!("--set {key}={example}")).collect();
    format!(
        "found no {}, expected in the scenario, since {terrain} has no columns for it: add it to the file of --scenario, or give, for \
         example, {}",
        names.join(", no "),
        sets.join(" ")
    )
}

/// Files for a result, noted as read.
pub(crate) fn read_files(files: &[PathBuf]) -> Result<Vec<InputFile>, Failure> {
    for file in files {
        claims::reads(file);
        verbose::read(file);
    }
    Ok(checksums(files, &relative_name)?)
}

/// The DEM and the overlays of a scenario over it, for a result.
pub(crate) fn raster_files_of(bare: &Bare) -> Result<Vec<InputFile>, Failure> {
    read_files(&bare.files())
}

/// Reads a scenario with the folder of its paths but without its terrain, for commands that have their own.
pub(crate) fn scenario_alone(path: &Path) -> Result<(Scenario, PathBuf), Failure> {
    let mut source = option_source(Some(path))?;
    source.forget_terrain();
    look_at_keys(&mut source, false)?;
    Ok((validated(&source)?, source.base))
}

/// The same and its robot file.
pub(crate) fn files_with_robot_of(bare: &Bare) -> Result<Vec<InputFile>, Failure> {
    read_files(&bare.files_with_robot())
}

/// The keys of a scenario with those that are set, before they are validated.
pub(crate) fn load_draft(path: &Path, set: &[String]) -> Result<Draft, Failure> {
    let mut source = option_source(Some(path))?;
    for assignment in set {
        source.entries.set(&format!("--set {assignment}"), assignment);
    }
    look_at_keys(&mut source, true)?;
    Ok(source)
}

/// The keys of the scenario of an option; none without it.
fn option_source(scenario: Option<&Path>) -> Result<Draft, Failure> {
    match scenario {
        Some(path) => read_source(&inputs::open(path, Role::ScenarioOption)?),
        None => Ok(Draft { wording: WORDING, ..Draft::default() }),
    }
}

/// Reads the keys of a scenario (TOML) or of a result (JSON).
fn read_source(input: &Input) -> Result<Draft, Failure> {
    let path = input.file.as_path();
    claims::reads(path);
    let name = input.given.display().to_string();
    // A pipe has no folder: its paths start from the working folder.
    let folder = if input.is_stream() { None } else { path.parent() }.unwrap_or(Path::new(""));
    let read = if input.is_result() { Draft::read_result(path, name) } else { Draft::read_scenario(path, &name, folder) };
    let draft = read.map_err(|error| Failure::of(&error))?;
    Ok(Draft { wording: WORDING, ..draft })
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
    ends.set(entries);
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

/// Validates keys for a point; every problem names the file that they came from.
fn validated(source: &Draft) -> Result<Scenario, Failure> {
    source.validated(false).map_err(refused)
}

/// The failure for problems of keys.
fn refused(mut problems: ScenarioProblems) -> Failure {
    for problem in &mut problems.problems {
        problem.help.push_str(hints::of_problem(problem));
    }
    Failure::Scenario(problems)
}

/// The failure for a scenario that cannot be opened. `name`: what a lack of keys is said of.
fn unopened(error: OpenError, name: &str) -> Failure {
    match error {
        OpenError::Problems(problems) => refused(problems),
        OpenError::Lacking { keys, terrain, .. } => Failure::message(format!("{name}{}", lacking_on(&keys, terrain))),
        OpenError::File(error) => error.into(),
        other => Failure::of(&other),
    }
}
