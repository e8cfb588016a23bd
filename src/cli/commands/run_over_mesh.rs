//! `chta run` over a mesh.

use chta::{
    report::{DocumentKind, mesh_plan_text},
    study::{MeshRouteQuestion, SimulateOptions, mesh_route, simulate_over_mesh},
};

use crate::cli::{
    Answer, Failure, args::RunArgs, load::MeshPlanInput, not_on_mesh, output, page::PageInput, progress::Progress,
    run_folder::RunFolder, views::show,
};

/// Plans a free route over a mesh, flies its trials, and writes the results into a folder.
pub(super) fn run(args: &RunArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    if input.scenario.legs.file.is_some() {
        return super::run_legs::run(args, input);
    }
    not_on_mesh::refuse(&[("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile")])?;
    let mut folder = RunFolder::begin(args)?;
    let about = |error: &dyn std::error::Error| Failure::message(format!("{}: {error}", input.mesh.display()));
    let progress = Progress::new(args.quiet);
    let question = MeshRouteQuestion { scenario: &input.scenario, base: &input.base, front: None, roadmap: None };
    let routed = mesh_route(&question, &progress).map_err(|error| Failure::about(&input.mesh, &error))?;
    let (answer, mut warnings) = (routed.answer.clone(), routed.warnings.clone());
    folder.plan_over_mesh(&routed, input)?;
    let mut trials_text = String::new();
    if input.scenario.uncertainty.is_some() && routed.path.is_some() {
        let simulated = simulate_over_mesh(routed, &input.scenario, &SimulateOptions::default(), &mut (), &progress)
            .map_err(|error| about(&error))?;
        folder.trials_over_mesh(&simulated, input)?;
        trials_text = simulated.answer.simulation.as_ref().map(|record| format!("\n{}", record.text())).unwrap_or_default();
        warnings = simulated.warnings;
    }
    drop(progress);
    output::warn_all(args.quiet, &warnings);
    let written = folder.write(PageInput::Facets(input))?;
    let text = || format!("{}{trials_text}\n{written}\n", mesh_plan_text(&answer));
    show(args.answer.format, text, || Ok(input.document(DocumentKind::RunMesh, &warnings, &answer)?))?;
    Ok(Answer::of(answer.is_traversable()))
}
