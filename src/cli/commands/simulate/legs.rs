//! `chta simulate` of a robot with legs.

use chta::{
    report::{DocumentKind, legs_simulate_text},
    study::{LegsRouteQuestion, legs_route, simulate_legs},
};

use crate::cli::{
    Answer, Failure,
    args::SimulateArgs,
    load::MeshPlanInput,
    not_on_mesh, output,
    progress::Progress,
    views::{Files, show},
};

/// Simulates a route of a robot with legs.
pub(super) fn run(args: &SimulateArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse_for_legs(&[
        ("--experiment", args.experiment.is_some(), "is flown along a profile"),
        ("--output", args.output.is_some(), "writes landings along a profile"),
        ("--density", args.density.is_some(), "counts landings of a point on a map"),
        ("--plot-density", args.plot_density.is_some(), "draws landings of a point on a map"),
        ("--plot-map", args.plot_map.is_some(), "draws landings of a point on a map"),
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
        ("--tally", args.tally.is_some(), "writes the landings of a point"),
        ("--merge", !args.merge.is_empty(), "merges the landings of a point"),
    ])?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let progress = Progress::new(args.common.quiet);
    let question = LegsRouteQuestion { scenario: &input.scenario, base: &input.base };
    let about = |error| Failure::about(&input.mesh, &error);
    let routed = legs_route(question, &progress).map_err(about)?;
    let simulated =
        simulate_legs(routed, &input.scenario, &args.options(), &progress).map_err(|error| Failure::about(&input.mesh, &error))?;
    output::warn_all(args.common.quiet, &simulated.warnings);
    let mut files = Files::default();
    files.picture(plot, || Some(simulated.routed.picture(&input.scenario, chta::figure::SeenFrom::default())))?;
    files.finish()?;
    let answer = &simulated.answer;
    show(
        args.answer.format,
        || legs_simulate_text(answer),
        || Ok(input.document_on_map(DocumentKind::SimulateLegs, simulated.routed.crs().as_ref(), &simulated.warnings, answer)?),
    )?;
    Ok(Answer::of(answer.plan.plan.is_traversable() && answer.shows_success()))
}
