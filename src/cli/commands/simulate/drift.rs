//! `chta simulate` for a robot whose heading is not controlled.

use chta::{
    report::{DocumentKind, drift_text},
    study::open::OpenDrift,
};

use crate::cli::{
    Answer, Failure,
    args::SimulateArgs,
    density::DensityFiles,
    landings::Listener,
    not_for_drift, output,
    progress::Progress,
    views::{Files, show},
};

/// Simulates hops in any direction.
pub(super) fn run(args: &SimulateArgs, open: OpenDrift) -> Result<Answer, Failure> {
    args.check_half_width()?;
    args.check_density()?;
    not_for_drift::refuse(&[
        ("--compare", args.compare, "compares two policies of following a path"),
        ("--experiment", args.experiment.is_some(), "is about a planned path"),
        ("--output", args.output.is_some(), "writes landings beside planned ones"),
        ("--plot", args.plot.is_some(), "draws landings about a planned path (--plot-density draws where trials end)"),
        ("--plot-map", args.plot_map.is_some(), "draws landings about a planned path (--plot-density draws where trials end)"),
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes the planned hops"),
        ("--tally", args.tally.is_some(), "writes a tally of a planned path"),
        ("--merge", !args.merge.is_empty(), "merges tallies of a planned path"),
    ])?;
    let mut density = DensityFiles::begin(args)?;
    let quiet = args.common.quiet;
    output::warn_all(quiet, open.trials.warnings());
    let progress = Progress::new(quiet);
    let counted = density.of_drift(&open.trials, args.within.as_deref())?;
    let mut flown = Listener::fly_drift(open.trials, &args.options(), counted, &progress)?;
    let mut files = Files::default();
    flown = density.add_drift(&mut files, flown)?;
    files.finish()?;
    let answer = &flown.answer;
    show(
        args.answer.format,
        || drift_text(answer),
        || Ok(open.record.document(DocumentKind::SimulateDrift, &flown.warnings, answer).to_json()?),
    )?;
    Ok(Answer::of(answer.shows_success()))
}
