//! `chta hop`: one pair, limit by limit.

use chta::{
    report::{DocumentKind, hop_text, mesh_hop_text},
    study::{Hopped, MeshHopQuestion, hop, mesh_hop},
};

use crate::cli::{
    Answer, Failure,
    args::HopArgs,
    inputs,
    load::{EndOptions, MeshHopInput, load_hop, load_mesh_hop},
    output,
    trajectory::TrajectoryFile,
    views::{Files, show},
};

/// Tests one hop.
pub(crate) fn run(args: &HopArgs) -> Result<Answer, Failure> {
    inputs::look_at_hop(&args.terrain, &args.common)?;
    let ends = EndOptions::of_hop(args.from, args.to);
    if let Some(input) = load_mesh_hop(&args.terrain, &args.common, ends)? {
        return over_mesh(args, &input);
    }
    refuse("--plot", args.plot.is_some(), "draws a hop over a mesh, and this terrain is not a mesh: leave the option out")?;
    let loaded = load_hop(&args.terrain, &args.common, ends)?;
    loaded.ends()?;
    let hopped = hop(&loaded.case)?;
    if let Some(file) = TrajectoryFile::begin(&args.trajectory)? {
        let path = hopped.path().map_err(|error| Failure::of(&error))?;
        let mut files = Files::default();
        files.trajectory(Some(file), path.as_ref(), &hopped.case)?;
        files.finish()?;
    }
    let Hopped { answer, warnings, .. } = &hopped;
    output::warn_all(args.common.quiet, warnings);
    show(args.format, || hop_text(answer), || loaded.document(DocumentKind::Hop, warnings, answer))?;
    Ok(Answer::of(answer.feasible))
}

/// Tests one hop over a mesh.
fn over_mesh(args: &HopArgs, input: &MeshHopInput) -> Result<Answer, Failure> {
    let trajectory = args.trajectory.trajectory.is_some();
    refuse("--trajectory", trajectory, "writes hops along a profile, and this terrain is a mesh: leave the option out")?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let MeshHopInput { mesh, scale, ends_m, scenario, .. } = input;
    let question = MeshHopQuestion { scenario, mesh, scale: *scale, ends_m: *ends_m };
    let hopped = mesh_hop(&question).map_err(|error| Failure::about(mesh, &error))?;
    let mut files = Files::default();
    files.picture(plot, || Some(hopped.picture(scenario)))?;
    files.finish()?;
    output::warn_all(args.common.quiet, &hopped.warnings);
    show(args.format, || mesh_hop_text(&hopped.answer), || input.document(&hopped.warnings, &hopped.answer))?;
    Ok(Answer::of(hopped.answer.feasible))
}

/// Refuses an option that the terrain has no use for.
fn refuse(option: &str, given: bool, why: &str) -> Result<(), Failure> {
    if given { Err(Failure::message(format!("{option}: found this option, which {why}"))) } else { Ok(()) }
}
