//! `chta simulate`: how reliably the planned path is flown.

mod experiment;
mod listen;
mod pictures;
mod trials;

use std::path::Path;

use chta::{
    hop::HopTest,
    report::{Document, DocumentKind, SimulateAnswer, SimulationRecord, check_text},
    scenario::UncertaintyKeys,
    study::TrialGround,
    uncertainty::{Policy, TrialOptions},
};
use serde::Serialize;

use super::{plan::Planned, search::use_threads, trajectory};
use crate::cli::{
    Answer, Failure,
    args::{Format, SimulateArgs},
    effects::Purpose,
    hints::further_means,
    inputs,
    load::{EndOptions, Loaded, load_with},
    output,
    wrong_thing::Role,
};
use listen::RowFile;
use pictures::{landing_map, sheet};
use trials::Flyer;

/// Simulates.
pub(crate) fn run(args: &SimulateArgs) -> Result<Answer, Failure> {
    inputs::look_at(
        args.common.input_max_gib,
        &[(Some(&args.journey.chain), Role::Chain), (args.common.scenario.as_deref(), Role::ScenarioOption)],
    )?;
    // Set before the terrain is read, since reading starts the threads.
    use_threads(args.answer.threads)?;
    let loaded = load_with(
        &args.journey.chain,
        &args.common,
        Some(&args.search),
        EndOptions::of_path(args.journey.start, args.journey.goal),
        Purpose::Simulate,
        &trial_options(args),
    )?;
    if let Some(name) = &args.experiment {
        if args.trajectory.trajectory.is_some() {
            let message =
                format!("--trajectory: the experiment {name} flies no nominal path: omit one of --trajectory and --experiment");
            return Err(Failure::message(message));
        }
        return experiment::run(args, &loaded, name);
    }
    // All options are checked before the search, which may take long.
    let keys = loaded.scenario.uncertainty.unwrap_or_default();
    if let Some(half_width) = args.until_half_width.filter(|half_width| !(*half_width > 0.0 && *half_width < 0.5)) {
        return Err(Failure::message(format!(
            "--until-half-width is {half_width}, expected a number above 0 and below 0.5: 0.01 stops at a rate known to one in a hundred"
        )));
    }
    if args.plot_map.is_some() && !trials::on_dem(&loaded) {
        return Err(Failure::message("--plot-map: the landings lie on no DEM; give the scenario [terrain] dem, or use --plot"));
    }
    loaded.ends()?;
    let rows = args.output.as_deref().map(|path| RowFile::begin(path, &loaded)).transpose()?;
    let plot = args.plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    let plot_map = args.plot_map.as_deref().map(|path| output::begin_picture("--plot-map", path)).transpose()?;
    let in_time = trajectory::begin(&args.trajectory)?;
    let to_stdout = args.output.as_deref() == Some(Path::new("-"));
    let test = loaded.hop_test();
    let planned = Planned::new(&loaded, &test, None, false, args.common.quiet)?;
    let trajectory_csv = trajectory::filled(in_time, &args.trajectory, planned.path.as_ref(), &loaded)?;
    let Some(path) = &planned.path else {
        output::finish(trajectory_csv.into_iter().collect())?;
        return no_path(args, &loaded, &planned);
    };
    let policies: &[Policy] = if args.compare { &Policy::ALL } else { std::slice::from_ref(&keys.policy) };
    let warnings = trial_warnings(&loaded, policies, path.hops.len());
    for warning in &warnings {
        output::warn(args.common.quiet, warning);
    }
    let flyer = Flyer::new(&loaded, &test, path, &planned.found, policies, args.common.quiet)?;
    let flown = flyer.fly(policies, &trials_asked(args, &keys), rows, args.common.quiet)?;
    let mut files = Vec::new();
    if let Some(file) = plot {
        let picture = sheet(&flyer, &flown, file.path())?;
        files.push((file, picture));
    }
    if let Some(file) = plot_map
        && let Some(picture) = landing_map(&flyer, &flown, file.path())?
    {
        files.push((file, picture));
    }
    files.extend(trajectory_csv);
    output::finish(files)?;
    if to_stdout {
        return Ok(planned.verdict());
    }
    let records: Vec<_> = flown.iter().map(|flown| SimulationRecord::new(&flown.summary, path.hops.len())).collect();
    let asked = records.iter().find(|record| record.policy == keys.policy).cloned();
    let text = match args.answer.format {
        Format::Text => {
            let mut text = check_text(planned.check(), further_means());
            for record in &records {
                text.push('\n');
                text.push_str(&record.text());
            }
            text
        }
        Format::Json => {
            let compare = if args.compare { records } else { Vec::new() };
            let answer = SimulateAnswer { check: planned.check().clone(), simulation: asked, compare };
            document(&loaded, warnings, answer)?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(planned.verdict())
}

/// The trials of a whole run.
pub(super) struct RunTrials {
    /// The text answer; empty if the scenario has no [uncertainty], or no path was found.
    pub(super) text: String,
    /// Names and contents of its files.
    pub(super) files: Vec<(&'static str, Vec<u8>)>,
}

/// All files that a run may write for its trials.
pub(super) const RUN_FILES: [&str; 3] = ["simulation.json", "trials.svg", "landings.svg"];

/// Flies and draws the trials of the scenario's `[uncertainty]` for the plan of a run.
pub(super) fn of_run(loaded: &Loaded, test: &HopTest, planned: &Planned, quiet: bool) -> Result<RunTrials, Failure> {
    let mut trials = RunTrials { text: String::new(), files: Vec::new() };
    let (Some(keys), Some(path)) = (loaded.scenario.uncertainty, &planned.path) else { return Ok(trials) };
    let policies = std::slice::from_ref(&keys.policy);
    let warnings = trial_warnings(loaded, policies, path.hops.len());
    for warning in &warnings {
        output::warn(quiet, warning);
    }
    let flyer = Flyer::new(loaded, test, path, &planned.found, policies, quiet)?;
    let flown = flyer.fly(policies, &keys.options(), None, quiet)?;
    let [answer, sheet_name, map_name] = RUN_FILES;
    let Some(record) = flown.first().map(|flown| SimulationRecord::new(&flown.summary, path.hops.len())) else { return Ok(trials) };
    trials.text = format!("\n{}", record.text());
    let simulation = SimulateAnswer { check: planned.check().clone(), simulation: Some(record), compare: Vec::new() };
    trials.files.push((answer, document(loaded, warnings, simulation)?.into_bytes()));
    trials.files.push((sheet_name, sheet(&flyer, &flown, Path::new(sheet_name))?));
    trials.files.extend(landing_map(&flyer, &flown, Path::new(map_name))?.map(|picture| (map_name, picture)));
    Ok(trials)
}

/// Warnings about the trials of a path of this many hops: settings without effect and deviations beyond sense.
fn trial_warnings(loaded: &Loaded, policies: &[Policy], hops: usize) -> Vec<String> {
    let ground = TrialGround::of_chain(&loaded.scenario, &loaded.prepared, hops);
    loaded.scenario.trial_warnings(policies, &ground)
}

/// The answer without a path to fly.
fn no_path(args: &SimulateArgs, loaded: &Loaded, planned: &Planned) -> Result<Answer, Failure> {
    let text = match args.answer.format {
        Format::Text => check_text(planned.check(), further_means()) + "nothing to simulate: there is no nominal path\n",
        Format::Json => {
            document(loaded, Vec::new(), SimulateAnswer { check: planned.check().clone(), simulation: None, compare: Vec::new() })?
        }
    };
    if args.output.as_deref() != Some(Path::new("-")) {
        output::to_stdout(text.as_bytes())?;
    }
    Ok(Answer::No)
}

fn document<T: Serialize>(loaded: &Loaded, warnings: Vec<String>, answer: T) -> Result<String, Failure> {
    let document = loaded.document.clone();
    let document = Document::new(DocumentKind::Simulate, document, loaded.inputs.clone(), loaded.warnings_with(warnings), answer);
    Ok(document.on_map(loaded.prepared.projection.as_ref()).to_json()?)
}

/// The scenario keys set by the options of trials; they are checked and written as keys of the scenario.
fn trial_options(args: &SimulateArgs) -> Vec<(&'static str, &'static str, &'static str, toml::Value)> {
    let trials = args.trials.map(|trials| ("--trials", "uncertainty", "trials", trials.into()));
    let seed = args.seed.map(|seed| ("--seed", "uncertainty", "seed", seed.into()));
    let policy = args.policy.clone().map(|policy| ("--policy", "uncertainty", "policy", policy.into()));
    [trials, seed, policy].into_iter().flatten().collect()
}

/// The trials that scenario and options define.
fn trials_asked(args: &SimulateArgs, keys: &UncertaintyKeys) -> TrialOptions {
    TrialOptions { until_half_width: args.until_half_width, ..keys.options() }
}
