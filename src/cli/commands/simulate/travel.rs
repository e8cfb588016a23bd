//! `chta simulate` for a scenario with `[drive]`.

use chta::{
    report::{DocumentKind, travel_simulate_text},
    study::{TravelOptions, travel_plan, travel_simulate},
};

use crate::cli::{
    Answer, Failure, args::SimulateArgs, load::Loaded, not_for_travel, output, progress::Progress, views::Files, views::show,
};

/// Simulates a mission that drives.
pub(super) fn run(args: &SimulateArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    args.check_half_width()?;
    not_for_travel::refuse(&[
        ("--output", args.output.is_some(), "writes the landings of hops"),
        ("--density", args.density.is_some(), "counts the landings of hops"),
        ("--plot-density", args.plot_density.is_some(), "draws the landings of hops"),
        ("--plot-map", args.plot_map.is_some(), "draws the landings of hops"),
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
        ("--tally", args.tally.is_some(), "writes a tally of hops"),
        ("--merge", !args.merge.is_empty(), "merges tallies of hops"),
    ])?;
    loaded.ends()?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let progress = Progress::new(args.common.quiet);
    let planned = travel_plan(&loaded.case, TravelOptions::default(), &progress)?;
    let simulated = travel_simulate(planned, &args.options(), &progress)?;
    output::warn_all(args.common.quiet, &simulated.warnings);
    let mut files = Files::default();
    files.picture(plot, || Some(simulated.picture()))?;
    files.finish()?;
    let answer = &simulated.answer;
    show(
        args.answer.format,
        || travel_simulate_text(answer),
        || loaded.document(DocumentKind::SimulateTravel, &simulated.warnings, answer),
    )?;
    Ok(Answer::of(answer.plan.is_traversable() && answer.shows_success()))
}
