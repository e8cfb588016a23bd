//! `chta run`: everything a scenario asks for.

use std::sync::Arc;

use chta::{
    report::{DocumentKind, plan_text},
    study::{PlanOptions, SimulateOptions, Trials, plan},
};

use super::{run_over_mesh, run_targets, run_travel};
use crate::cli::{
    Answer, Failure,
    args::{CommonArgs, RunArgs},
    effects::Purpose,
    hints::further_means,
    inputs,
    landings::Listener,
    load::{EndOptions, load_mesh_scenario, load_scenario},
    output,
    page::PageInput,
    progress::Progress,
    run_folder::RunFolder,
    threads,
    trajectory::TrajectoryFile,
    views::show,
    wrong_thing::Role,
};

/// Runs a scenario and writes its results into a folder.
pub(crate) fn run(args: &RunArgs) -> Result<Answer, Failure> {
    inputs::look_at(args.input_max_gib, &[(Some(&args.scenario), Role::Scenario)])?;
    threads::start(args.answer.threads)?;
    let common = CommonArgs::of_scenarios(&args.set, args.accept_map_scale, args.input_max_gib, args.quiet);
    let target = (args.scenario.as_path(), Role::Scenario);
    if let Some(input) = load_mesh_scenario(target, &common, (None, EndOptions::NONE), Purpose::Run, &[])? {
        return run_over_mesh::run(args, &input);
    }
    let loaded = load_scenario(&args.scenario, &common, Purpose::Run)?;
    loaded.ends()?;
    if loaded.case.scenario.drives().is_some() {
        return run_travel::run(args, &loaded);
    }
    if loaded.case.scenario.mission.is_some() {
        return run_targets::run(args, &loaded);
    }
    let mut folder = RunFolder::begin(args)?;
    let in_time = TrajectoryFile::begin(&args.trajectory)?;
    let options = PlanOptions { verify: true, estimate: true, ..PlanOptions::default() };
    let planned = Arc::new(plan(&loaded.case, options, &Progress::new(args.quiet))?);
    output::warn_all(args.quiet, &planned.warnings);
    folder.trajectory(in_time, &planned)?;
    folder.plan(&planned, &loaded)?;
    let mut trials_text = String::new();
    if loaded.case.scenario.uncertainty.is_some() && planned.path.is_some() {
        let trials = Trials::new(&planned, &SimulateOptions::default());
        output::warn_all(args.quiet, trials.warnings());
        let simulated = Listener::fly(trials, None, None, &Progress::new(args.quiet))?;
        folder.trials(&simulated, &loaded)?;
        trials_text = simulated.answer.simulation.as_ref().map(|record| format!("\n{}", record.text())).unwrap_or_default();
    }
    let written = folder.write(PageInput::Case(&loaded))?;
    let text = || format!("{}{trials_text}\n{written}\n", plan_text(&planned.answer, further_means()));
    show(args.answer.format, text, || loaded.document(DocumentKind::Run, &planned.warnings, &planned.answer))?;
    Ok(Answer::of(planned.is_traversable()))
}
