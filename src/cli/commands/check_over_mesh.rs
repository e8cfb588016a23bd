//! `chta check` for a result over a mesh.

use std::fs;

use chta::{
    report::{DocumentKind, mesh_check_text},
    study::check_over_mesh,
};

use crate::cli::{
    Answer, Failure,
    args::CheckArgs,
    effects::Purpose,
    inputs,
    load::{MeshPlanInput, load_mesh_plan},
    not_on_mesh, output,
    views::show,
    wrong_thing::Role,
};

/// Loads a result over a mesh; `None` for any other input.
pub(super) fn loaded(args: &CheckArgs) -> Result<Option<MeshPlanInput>, Failure> {
    if !inputs::open(&args.journey.chain, Role::Chain)?.is_result() {
        return Ok(None);
    }
    load_mesh_plan(&args.journey, &args.common, &args.search, Purpose::Check, &[])
}

/// Flies the path of a result again.
pub(super) fn run(args: &CheckArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse(&[
        ("--pairs", args.pairs.is_some(), "gives pairs of places along a chain"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
        ("--plot", args.plot.is_some(), "draws stretches of a profile (chta plan draws the path over a mesh)"),
    ])?;
    let file = inputs::open(&args.journey.chain, Role::Chain)?;
    let about = |error: &dyn std::error::Error| Failure::message(format!("{}: {error}", file.given.display()));
    let text = fs::read(&file.file).map_err(|error| about(&error))?;
    let document = serde_json::from_slice(&text).map_err(|error| about(&error))?;
    let checked = check_over_mesh((&input.scenario, &input.base), &document, input.inputs()).map_err(|error| about(&error))?;
    output::warn_all(args.common.quiet, &checked.warnings);
    let json = || Ok(input.document(DocumentKind::CheckMesh, &checked.warnings, &checked.answer)?);
    show(args.answer.format, || mesh_check_text(&checked.answer), json)?;
    Ok(Answer::of(checked.answer.holds))
}
