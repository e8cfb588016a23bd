//! `chta map` over a mesh.

use chta::{
    report::{DocumentKind, mesh_map_text},
    study::{MeshReachQuestion, mesh_reach},
};

use crate::cli::{
    Answer, Failure,
    args::MapArgs,
    load::MeshPlanInput,
    not_on_mesh,
    output::{self, TableFormat},
    progress::Progress,
    views::{Files, Table, Views},
};

/// Finds what is reached over a mesh.
pub(super) fn run(args: &MapArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse_of_map(args)?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let hops_max = args.hops_max.map(|most| u32::from(most.unsigned_abs()));
    let question = MeshReachQuestion { scenario: &input.scenario, base: &input.base, hops_max, returns: args.back };
    let reached = mesh_reach(&question, &Progress::new(args.common.quiet)).map_err(|error| Failure::about(&input.mesh, &error))?;
    output::warn_all(args.common.quiet, &reached.warnings);
    let views = Views {
        text: &|| mesh_map_text(&reached.answer),
        json: &|| Ok(input.document(DocumentKind::MapMesh, &reached.warnings, &reached.answer)?),
        csv: &|out| reached.write_csv(out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(reached.picture(&input.scenario, args.view.direction())))?;
    files.table(&mut table, &views)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(reached.answer.reaches_the_goal()))
}
