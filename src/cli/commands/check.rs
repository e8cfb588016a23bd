//! `chta check`: does a path exist.

use chta::{
    report::{DocumentKind, check_text},
    study::{check, check_pairs},
};

use super::{check_over_mesh, check_targets};
use crate::cli::{
    Answer, Failure,
    args::CheckArgs,
    effects::Purpose,
    hints::further_means,
    inputs,
    load::{load_journey, read_pairs},
    output,
    progress::Progress,
    threads, unanswered,
    views::{Files, show},
};

/// Checks one pair or many.
pub(crate) fn run(args: &CheckArgs) -> Result<Answer, Failure> {
    inputs::look_at_pairs(&args.journey.chain, &args.common, args.pairs.as_deref())?;
    // Set before the terrain is read, since reading starts the threads.
    threads::start(args.answer.threads)?;
    if let Some(input) = check_over_mesh::loaded(args)? {
        return check_over_mesh::run(args, &input);
    }
    let loaded = load_journey(&args.journey, &args.common, &args.search, Purpose::Check, &[])?;
    if loaded.case.scenario.mission.is_some() {
        return check_targets::run(args, &loaded);
    }
    let pairs = args.pairs.as_deref().map(read_pairs).transpose()?;
    pairs.is_none().then(|| loaded.ends()).transpose()?;
    // Outputs are opened before the computation, which may take long.
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let (proof, progress) = (args.prove.proof(), Progress::new(args.common.quiet));
    let checked = match (&pairs, &args.pairs) {
        (Some(pairs), Some(file)) => check_pairs(&loaded.case, &pairs.pairs, proof, &progress).map_err(unanswered::about(file))?,
        _ => check(&loaded.case, proof, &progress)?,
    };
    drop(progress);
    let mut files = Files::default();
    files.picture(plot, || checked.picture())?;
    files.finish()?;
    let warnings: Vec<_> = pairs.iter().flat_map(|pairs| &pairs.warnings).chain(&checked.warnings).cloned().collect();
    output::warn_all(args.common.quiet, &warnings);
    let text = || checked.answers().map(|answer| check_text(answer, further_means())).collect::<Vec<_>>().join("\n");
    show(args.answer.format, text, || match (&pairs, checked.answers().next()) {
        (None, Some(answer)) => loaded.document(DocumentKind::Check, &warnings, answer),
        _ => loaded.document(DocumentKind::CheckPairs, &warnings, checked.pairs_answer()),
    })?;
    Ok(Answer::of(checked.is_traversable()))
}
