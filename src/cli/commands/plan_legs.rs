//! `chta plan` of a robot with legs over a mesh or a DEM.

use chta::{
    report::{DocumentKind, MapKnowledge, legs_plan_text, write_path_csv},
    scenario::TerrainSource,
    study::{LegsRouteQuestion, legs_route},
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

/// Plans a route of a robot with legs.
pub(super) fn run(args: &PlanArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse_for_legs(&[
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
        ("--plot-front", args.plot_front.is_some(), "draws a front over a DEM or a profile"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
        ("--dry-run", args.size.dry_run, "states the size of a search for a point"),
        ("--memory-max-mib", args.size.memory_max_mib.is_some(), "limits the memory of a search for a point"),
        ("--front", args.front()?.is_some(), "searches hops against an amount for a point"),
        ("--roadmap", args.roadmap.roadmap.is_some(), "reads contacts of a point"),
        ("--roadmap-output", args.roadmap.roadmap_output.is_some(), "writes contacts of a point"),
    ])?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let plot_postures = output::begin_picture("--plot-postures", args.plot_postures.as_deref())?;
    let is_over_mesh = matches!(input.scenario.terrain, Some(TerrainSource::MeshInSpace { .. }));
    if args.geojson.is_some() && is_over_mesh {
        not_on_mesh::refuse(&[("--geojson", true, "writes a path on a map")])?;
    }
    let geojson = args.geojson.as_deref().map(Pending::begin).transpose()?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let question = LegsRouteQuestion { scenario: &input.scenario, base: &input.base };
    let routed = legs_route(question, &Progress::new(args.common.quiet)).map_err(|error| Failure::about(&input.mesh, &error))?;
    output::warn_all(args.common.quiet, &routed.warnings);
    let first = args.first_posture(routed.answer.plan.path.len())?;
    let views = Views {
        text: &|| legs_plan_text(&routed.answer),
        json: &|| Ok(input.document_on_map(DocumentKind::PlanLegs, routed.crs().as_ref(), &routed.warnings, &routed.answer)?),
        csv: &|out| write_path_csv(&routed.answer.plan.path, MapKnowledge::Metres, out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(routed.picture(&input.scenario, args.view.direction())))?;
    files.picture(plot_postures, || routed.postures_picture(&input.scenario, first))?;
    files.geojson_on(geojson, routed.geojson(), routed.projection.as_ref())?;
    files.table(&mut table, &views)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(routed.answer.plan.is_traversable()))
}
