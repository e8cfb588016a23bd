//! `chta run` for a scenario with `[mission]`.

use chta::{
    report::{DocumentKind, targets_simulate_text, targets_text},
    study::{SimulateOptions, targets_plan, targets_simulate},
};

use crate::cli::{
    Answer, Failure, args::RunArgs, hints::further_means, load::Loaded, output, page::PageInput, progress::Progress,
    run_folder::RunFolder, trajectory::TrajectoryFile, views::show,
};

/// Plans a mission over targets, makes its trials, and writes the results into a folder.
pub(super) fn run(args: &RunArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    let mut folder = RunFolder::begin(args)?;
    let in_time = TrajectoryFile::begin(&args.trajectory)?;
    let progress = Progress::new(args.quiet);
    let planned = targets_plan(&loaded.case, &progress)?;
    let (answer, mut warnings) = (planned.answer.clone(), planned.warnings.clone());
    folder.trajectory_of(in_time, planned.path(), planned.flown_case())?;
    folder.plan_of_targets(&planned, loaded)?;
    let mut text = targets_text(&answer, further_means());
    if loaded.case.scenario.uncertainty.is_some() && planned.path().is_some() {
        let simulated = targets_simulate(planned, &SimulateOptions::default(), &mut (), &progress)?;
        folder.trials_of_targets(&simulated, loaded)?;
        text = targets_simulate_text(&simulated.answer, further_means());
        warnings.clone_from(&simulated.warnings);
    }
    drop(progress);
    output::warn_all(args.quiet, &warnings);
    let written = folder.write(PageInput::Case(loaded))?;
    show(args.answer.format, || format!("{text}\n{written}\n"), || loaded.document(DocumentKind::PlanTargets, &warnings, &answer))?;
    Ok(Answer::of(answer.is_traversable()))
}
