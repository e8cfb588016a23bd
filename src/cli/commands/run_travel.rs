//! `chta run` for a scenario with `[drive]`.

use chta::{
    report::{DocumentKind, travel_simulate_text, travel_text},
    study::{SimulateOptions, TravelOptions, travel_plan, travel_simulate},
};

use crate::cli::{
    Answer, Failure, args::RunArgs, load::Loaded, not_for_travel, output, page::PageInput, progress::Progress,
    run_folder::RunFolder, views::show,
};

/// Plans a mission that drives, makes its trials, and writes the results into a folder.
pub(super) fn run(args: &RunArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    not_for_travel::refuse(&[("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile")])?;
    let mut folder = RunFolder::begin(args)?;
    let progress = Progress::new(args.quiet);
    let planned = travel_plan(&loaded.case, TravelOptions { alternatives: true, front: None }, &progress)?;
    let (answer, mut warnings) = (planned.answer.clone(), planned.warnings.clone());
    folder.plan_of_travel(&planned, loaded)?;
    let mut text = travel_text(&answer);
    if loaded.case.scenario.uncertainty.is_some() && planned.is_traversable() {
        let simulated = travel_simulate(planned, &SimulateOptions::default(), &progress)?;
        folder.trials_of_travel(&simulated, loaded)?;
        text = travel_simulate_text(&simulated.answer);
        warnings.clone_from(&simulated.warnings);
    }
    drop(progress);
    output::warn_all(args.quiet, &warnings);
    let written = folder.write(PageInput::Case(loaded))?;
    show(args.answer.format, || format!("{text}\n{written}\n"), || loaded.document(DocumentKind::PlanTravel, &warnings, &answer))?;
    Ok(Answer::of(answer.is_traversable()))
}
