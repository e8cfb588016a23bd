//! `chta simulate --experiment NAME`.

use chta::{
    report::{DocumentKind, simulate_text},
    study::{SimulateOptions, experiment, simulate},
};

use crate::cli::{
    Answer, Failure,
    args::SimulateArgs,
    hints::further_means,
    load::{Loaded, plan_to_fly},
    output,
    progress::Progress,
    views::{Files, show},
};

/// Runs an experiment by its name.
pub(super) fn run(args: &SimulateArgs, loaded: &Loaded, name: &str) -> Result<Answer, Failure> {
    let (which, reading) = args.experiment(name)?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    loaded.ends()?;
    let progress = Progress::new(args.common.quiet);
    let planned = plan_to_fly(args, loaded, &progress)?;
    output::warn_all(args.common.quiet, &planned.warnings);
    let answer = experiment(&planned, which, reading, &progress)?;
    drop(progress);
    let Some(answer) = &answer else {
        // Without a path nothing is flown, and the answer says so.
        let simulated = simulate(&planned, &SimulateOptions::default(), &mut (), &())?;
        let text = || simulate_text(&simulated.answer, further_means());
        show(args.answer.format, text, || loaded.document(DocumentKind::Simulate, &[], &simulated.answer))?;
        return Ok(Answer::No);
    };
    let title = loaded.case.scenario.title.clone().unwrap_or_default();
    let mut files = Files::default();
    files.picture(plot, || answer.picture(&title))?;
    files.finish()?;
    let json = || loaded.document(DocumentKind::SimulateExperiment, &[], answer);
    show(args.answer.format, || answer.text(), json)?;
    Ok(Answer::Yes)
}
