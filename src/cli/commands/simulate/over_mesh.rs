//! `chta simulate` over a mesh.

use chta::{
    report::{DocumentKind, mesh_simulate_text},
    study::{MeshRouteQuestion, merged_over_mesh, mesh_route, simulate_over_mesh},
};

use crate::cli::{
    Answer, Failure,
    args::SimulateArgs,
    load::{MeshPlanInput, MeshResult},
    not_on_mesh,
    output::{self, Pending},
    progress::Progress,
    tallies,
    views::{Files, show},
};

/// Simulates a free route over a mesh.
pub(super) fn run(args: &SimulateArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    args.check_half_width()?;
    if input.scenario.legs.file.is_some() {
        return super::legs::run(args, input);
    }
    not_on_mesh::refuse(&[
        ("--experiment", args.experiment.is_some(), "is flown along a profile"),
        ("--output", args.output.is_some(), "writes landings along a profile"),
        ("--density", args.density.is_some(), "counts landings on a map"),
        ("--plot-density", args.plot_density.is_some(), "draws landings on a map"),
        ("--plot-map", args.plot_map.is_some(), "draws landings on a map"),
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
    ])?;
    let of_result = MeshResult::of(args, input)?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let tally = args.tally.as_deref().map(Pending::begin).transpose()?;
    let about = |error: &dyn std::error::Error| Failure::message(format!("{}: {error}", input.mesh.display()));
    let progress = Progress::new(args.common.quiet);
    let question = MeshRouteQuestion { scenario: &input.scenario, base: &input.base, front: None, roadmap: None };
    let routed = mesh_route(&question, &progress).map_err(|error| Failure::about(&input.mesh, &error))?;
    of_result.check_planned(&routed.answer.path)?;
    let (scenario, options) = (&input.scenario, args.options());
    let simulated = if args.merge.is_empty() {
        simulate_over_mesh(routed, scenario, &options, &mut (), &progress)
    } else {
        merged_over_mesh(routed, scenario, &options, &tallies::read(&args.merge)?, &())
    };
    let simulated = simulated.map_err(|error| about(&error))?;
    output::warn_all(args.common.quiet, &simulated.warnings);
    let mut files = Files::default();
    files.picture(plot, || simulated.picture(&input.scenario))?;
    files.json(tally, simulated.tallies.first())?;
    files.finish()?;
    let answer = &simulated.answer;
    show(
        args.answer.format,
        || mesh_simulate_text(answer),
        || Ok(input.document(DocumentKind::SimulateMesh, &simulated.warnings, answer)?),
    )?;
    Ok(Answer::of(answer.plan.is_traversable() && answer.shows_success()))
}
