//! `chta simulate` for a scenario with `[mission]`.

use chta::{
    report::{DocumentKind, targets_simulate_text},
    study::{targets_plan, targets_simulate},
};

use crate::cli::{
    Answer, Failure, args::SimulateArgs, hints::further_means, load::Loaded, not_for_targets, output, progress::Progress,
    trajectory::TrajectoryFile, views::Files, views::show,
};

/// Simulates a mission over targets as a whole.
pub(super) fn run(args: &SimulateArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    args.check_half_width()?;
    not_for_targets::refuse(&[
        ("--output", args.output.is_some(), "writes the landings of a path to one goal"),
        ("--density", args.density.is_some(), "counts the landings of a path to one goal"),
        ("--plot-density", args.plot_density.is_some(), "draws the landings of a path to one goal"),
        ("--plot-map", args.plot_map.is_some(), "draws the landings of a path to one goal"),
        ("--tally", args.tally.is_some(), "writes a tally of a path to one goal"),
        ("--merge", !args.merge.is_empty(), "merges tallies of a path to one goal"),
    ])?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let in_time = TrajectoryFile::begin(&args.trajectory)?;
    let progress = Progress::new(args.common.quiet);
    let planned = targets_plan(&loaded.case, &progress)?;
    let mut files = Files::default();
    files.trajectory(in_time, planned.path(), planned.flown_case())?;
    let simulated = targets_simulate(planned, &args.options(), &mut (), &progress)?;
    drop(progress);
    output::warn_all(args.common.quiet, &simulated.warnings);
    files.picture(plot, || Some(simulated.picture()))?;
    files.finish()?;
    let answer = &simulated.answer;
    show(
        args.answer.format,
        || targets_simulate_text(answer, further_means()),
        || loaded.document(DocumentKind::SimulateTargets, &simulated.warnings, answer),
    )?;
    Ok(Answer::of(answer.plan.is_traversable() && answer.shows_success()))
}
