//! `chta check`: does a path exist.

use chta::{
    chain::{Station, csv::read_pairs_csv_file},
    graph::Outcome,
    path::generate,
    report::{CheckAnswer, Document, check_text},
    scenario::{Extremes, constant_gravity_doubts},
};
use serde::Serialize;

use super::search::search;
use crate::cli::{
    Answer, Failure,
    args::{CheckArgs, Format},
    load::{Loaded, load},
    output,
};

/// The answers for many pairs.
#[derive(Serialize)]
struct PairsAnswer {
    pairs: Vec<CheckAnswer>,
}

/// Checks one pair or many.
pub(crate) fn run(args: &CheckArgs) -> Result<Answer, Failure> {
    let loaded = load(&args.chain, &args.common, Some(&args.search), [args.start, args.goal])?;
    let answers = match &args.pairs {
        None => vec![answer(&loaded, loaded.ends()?, args)?],
        Some(path) => {
            let file = read_pairs_csv_file(path)?;
            for warning in &file.warnings {
                output::warn(args.common.quiet, warning);
            }
            let station = |x_m: f64| {
                let geometry = loaded.prepared.chain.geometry();
                geometry.station(x_m).map_err(|problem| Failure::message(format!("{}: {problem}", path.display())))
            };
            let pairs = file.pairs.iter().map(|pair| Ok((station(pair.start_x_m)?, station(pair.goal_x_m)?)));
            let pairs: Vec<_> = pairs.collect::<Result<_, Failure>>()?;
            pairs.into_iter().map(|ends| answer(&loaded, ends, args)).collect::<Result<_, _>>()?
        }
    };
    let verdict = if answers.iter().all(CheckAnswer::is_traversable) { Answer::Yes } else { Answer::No };
    output::to_stdout(written(args, loaded, answers)?.as_bytes())?;
    Ok(verdict)
}

/// One pair.
fn answer(loaded: &Loaded, (start, goal): (Station, Station), args: &CheckArgs) -> Result<CheckAnswer, Failure> {
    let test = loaded.hop_test();
    let options = &loaded.scenario.search;
    let found = search(&test, start, goal, options, args.common.quiet)?;
    if let Outcome::Path { legs, .. } = &found.outcome
        && let Ok(path) = generate(&test, legs, options.takeoff, options.split)
    {
        for doubt in constant_gravity_doubts(&loaded.scenario.body, Extremes::of(&path.hops)) {
            output::warn(args.common.quiet, &doubt);
        }
    }
    Ok(CheckAnswer::new(&test, start.point.x_m, goal.point.x_m, &found, options.effort))
}

/// The answers as text or as one document.
fn written(args: &CheckArgs, loaded: Loaded, mut answers: Vec<CheckAnswer>) -> Result<String, Failure> {
    if args.format == Format::Text {
        return Ok(answers.iter().map(check_text).collect::<Vec<_>>().join("\n"));
    }
    let Loaded { document, inputs, prepared, .. } = loaded;
    let (warnings, projection) = (prepared.warnings, prepared.projection.as_ref());
    Ok(match (&args.pairs, answers.pop()) {
        (None, Some(answer)) => Document::new("check", document, inputs, warnings, answer).on_map(projection).to_json()?,
        (_, last) => {
            answers.extend(last);
            Document::new("check-pairs", document, inputs, warnings, PairsAnswer { pairs: answers }).on_map(projection).to_json()?
        }
    })
}
