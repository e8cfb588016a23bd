//! `chta hop`: one pair, limit by limit.

use chta::{
    report::{DocumentKind, hop_text},
    study::{Hopped, hop},
};

use crate::cli::{
    Answer, Failure,
    args::HopArgs,
    inputs,
    load::{EndOptions, load_hop},
    output,
    trajectory::TrajectoryFile,
    views::{Files, show},
};

/// Tests one hop.
pub(crate) fn run(args: &HopArgs) -> Result<Answer, Failure> {
    inputs::look_at_hop(&args.terrain, &args.common)?;
    let ends = EndOptions::of_hop(args.from, args.to);
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
