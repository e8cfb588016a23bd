//! `chta run` of a robot with legs.

use chta::{
    report::{DocumentKind, legs_plan_text, legs_simulate_text},
    study::{LegsRouteQuestion, SimulateOptions, legs_route, simulate_legs},
};

use crate::cli::{
    Answer, Failure, args::RunArgs, load::MeshPlanInput, not_on_mesh, output, page::PageInput, progress::Progress,
    run_folder::RunFolder, views::show,
};

/// Plans a route of a robot with legs, makes its trials, and writes the results into a folder.
pub(super) fn run(args: &RunArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse_for_legs(&[("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile")])?;
    let mut folder = RunFolder::begin(args)?;
    let progress = Progress::new(args.quiet);
    let question = LegsRouteQuestion { scenario: &input.scenario, base: &input.base };
    let routed = legs_route(question, &progress).map_err(|error| Failure::about(&input.mesh, &error))?;
    let (answer, crs, mut warnings) = (routed.answer.clone(), routed.crs(), routed.warnings.clone());
    folder.plan_of_legs(&routed, input)?;
    let mut text = legs_plan_text(&answer);
    if input.scenario.uncertainty.is_some() && routed.path.is_some() {
        let simulated = simulate_legs(routed, &input.scenario, &SimulateOptions::default(), &progress)
            .map_err(|error| Failure::about(&input.mesh, &error))?;
        folder.trials_of_legs(&simulated, input)?;
        text = legs_simulate_text(&simulated.answer);
        warnings = simulated.warnings;
    }
    drop(progress);
    output::warn_all(args.quiet, &warnings);
    let written = folder.write(PageInput::Facets(input))?;
    let document = || Ok(input.document_on_map(DocumentKind::PlanLegs, crs.as_ref(), &warnings, &answer)?);
    show(args.answer.format, || format!("{text}\n{written}\n"), document)?;
    Ok(Answer::of(answer.plan.is_traversable()))
}
