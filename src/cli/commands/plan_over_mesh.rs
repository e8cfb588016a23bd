//! `chta plan` over a mesh.

use chta::{
    report::{DocumentKind, MapKnowledge, mesh_plan_text, write_path_csv},
    study::{MeshRouteError, MeshRouteQuestion, mesh_route},
};

use crate::cli::{
    Answer, Failure,
    args::PlanArgs,
    load::MeshPlanInput,
    not_on_mesh,
    output::{self, Pending, TableFormat},
    progress::Progress,
    views::{Files, Table, Views},
};

/// Plans a free route over a mesh.
pub(super) fn run(args: &PlanArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    if input.scenario.legs.file.is_some() {
        return super::plan_legs::run(args, input);
    }
    args.refuse_postures()?;
    not_on_mesh::refuse(&[
        ("--geojson", args.geojson.is_some(), "writes a path on a map"),
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
        ("--plot-front", args.plot_front.is_some(), "draws a front over a DEM or a profile"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
        ("--dry-run", args.size.dry_run, "states the size of a search over a DEM"),
        ("--memory-max-mib", args.size.memory_max_mib.is_some(), "limits the memory of a search over a DEM"),
    ])?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let roadmap_output = args.roadmap.roadmap_output.as_deref().map(Pending::begin).transpose()?;
    let read = args.roadmap.roadmap.as_deref();
    let question = MeshRouteQuestion { scenario: &input.scenario, base: &input.base, front: args.front()?, roadmap: read };
    let about = |error: MeshRouteError| {
        let roadmap = read.filter(|_| matches!(error, MeshRouteError::NoRoadmap(_) | MeshRouteError::Roadmap(_)));
        Failure::about(roadmap.unwrap_or(&input.mesh), &error)
    };
    let routed = mesh_route(&question, &Progress::new(args.common.quiet)).map_err(about)?;
    output::warn_all(args.common.quiet, &routed.warnings);
    let views = Views {
        text: &|| mesh_plan_text(&routed.answer),
        json: &|| Ok(input.document(DocumentKind::PlanMesh, &routed.warnings, &routed.answer)?),
        csv: &|out| write_path_csv(&routed.answer.path, MapKnowledge::Metres, out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(routed.picture(&input.scenario, args.view.direction())))?;
    files.table(&mut table, &views)?;
    files.roadmap(roadmap_output, &routed)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(routed.answer.is_traversable()))
}
