//! `chta check`: does a path exist.

use chta::{
    chain::csv::read_pairs_csv_file,
    report::{CheckAnswer, DocumentKind, PairsAnswer, check_text},
    study::{Checked, check, check_pairs, stations},
};

use crate::cli::{
    Answer, Failure,
    args::CheckArgs,
    effects::Purpose,
    hints::further_means,
    inputs,
    load::{Loaded, load_journey},
    output,
    progress::Progress,
    threads,
    views::{Files, show},
    wrong_thing::Role,
};

/// Checks one pair or many.
pub(crate) fn run(args: &CheckArgs) -> Result<Answer, Failure> {
    inputs::look_at_pairs(&args.journey.chain, &args.common, args.pairs.as_deref())?;
    // Set before the terrain is read, since reading starts the threads.
    threads::start(args.answer.threads)?;
    let loaded = load_journey(&args.journey, &args.common, &args.search, Purpose::Check)?;
    let (proof, progress) = (args.prove.proof(), Progress::new(args.common.quiet));
    let (mut warnings, mut pairs) = (Vec::new(), Vec::new());
    match &args.pairs {
        None => drop(loaded.ends()?),
        Some(path) => {
            let path = &inputs::open(path, Role::Pairs)?.file;
            let file = read_pairs_csv_file(path)?;
            warnings.extend(file.warnings.iter().map(|warning| format!("{}: {warning}", path.display())));
            stations(&loaded.case, &file.pairs).map_err(|error| Failure::about(path, &error))?;
            pairs = file.pairs;
        }
    }
    // Outputs are opened before the computation, which may take long.
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let checked = match &args.pairs {
        None => check(&loaded.case, proof, &progress)?,
        Some(_) => check_pairs(&loaded.case, &pairs, proof, &progress)?,
    };
    drop(progress);
    let mut files = Files::default();
    files.picture(plot, || checked.picture())?;
    files.finish()?;
    warnings.extend(checked.warnings.iter().cloned());
    output::warn_all(args.common.quiet, &warnings);
    let text = || checked.answers().map(|answer| check_text(answer, further_means())).collect::<Vec<_>>().join("\n");
    show(args.answer.format, text, || document(args, &loaded, &checked, &warnings))?;
    Ok(Answer::of(checked.is_traversable()))
}

/// The answers as one document.
fn document(args: &CheckArgs, loaded: &Loaded, checked: &Checked, warnings: &[String]) -> Result<String, Failure> {
    let pairs: Vec<CheckAnswer> = checked.answers().cloned().collect();
    match (&args.pairs, pairs.first()) {
        (None, Some(answer)) => loaded.document(DocumentKind::Check, warnings, answer),
        _ => loaded.document(DocumentKind::CheckPairs, warnings, PairsAnswer { pairs }),
    }
}
