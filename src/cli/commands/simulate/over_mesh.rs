//! `chta simulate` over a mesh.

use std::fs;

use chta::{
    report::{DocumentKind, HopRecord, mesh_simulate_text},
    study::{MeshRouteQuestion, mesh_route, same_path_over_mesh, simulate_over_mesh},
};

use crate::cli::{
    Answer, Failure,
    args::SimulateArgs,
    inputs,
    load::{MeshPlanInput, refused_result},
    output::{self, Pending},
    progress::Progress,
    views::{Files, show},
    wrong_thing::Role,
};

/// Simulates a free route over a mesh.
pub(super) fn run(args: &SimulateArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    args.check_half_width()?;
    let refused = [
        ("--experiment", args.experiment.is_some(), "is flown along a profile"),
        ("--output", args.output.is_some(), "writes landings along a profile"),
        ("--plot-map", args.plot_map.is_some(), "draws landings on a map"),
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
    ];
    if let Some((option, _, what)) = refused.into_iter().find(|(_, given, _)| *given) {
        let message = format!("{option}: found this option, which {what}, and this terrain is a mesh: leave the option out");
        return Err(Failure::message(message));
    }
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let tally = args.tally.as_deref().map(Pending::begin).transpose()?;
    let about = |error: &dyn std::error::Error| Failure::message(format!("{}: {error}", input.mesh.display()));
    let progress = Progress::new(args.common.quiet);
    let question = MeshRouteQuestion { scenario: &input.scenario, base: &input.base, front: None, roadmap: None };
    let routed = mesh_route(&question, &progress).map_err(|error| Failure::about(&input.mesh, &error))?;
    plan_of_result(args, &routed.answer.path, input)?;
    let simulated =
        simulate_over_mesh(routed, &input.scenario, &args.options(), &mut (), &progress).map_err(|error| about(&error))?;
    output::warn_all(args.common.quiet, &simulated.warnings);
    let mut files = Files::default();
    files.picture(plot, || simulated.picture(&input.scenario))?;
    files.json(tally, simulated.tallies.first())?;
    files.finish()?;
    let answer = &simulated.answer;
    show(
        args.answer.format,
        || mesh_simulate_text(answer),
        || input.document(DocumentKind::SimulateMesh, &simulated.warnings, answer),
    )?;
    Ok(Answer::of(answer.plan.is_traversable() && answer.shows_success()))
}

/// Refuses a result whose path is not the one that was planned, unless the options say that it is to be planned anew.
fn plan_of_result(args: &SimulateArgs, planned: &[HopRecord], input: &MeshPlanInput) -> Result<(), Failure> {
    let file = inputs::open(&args.journey.chain, Role::Chain)?;
    args.check_plan_anew(&file)?;
    if args.plan_anew || !file.is_result() {
        return Ok(());
    }
    let refused = |error: &dyn std::error::Error| refused_result(&file, error);
    let text = fs::read(&file.file).map_err(|error| refused(&error))?;
    let document = serde_json::from_slice(&text).map_err(|error| refused(&error))?;
    same_path_over_mesh(&document, input.inputs(), planned).map_err(|error| refused(&error))
}
