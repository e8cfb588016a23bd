//! `chta check`: does a path exist.

use std::path::Path;

use chta::{
    chain::{
        Station,
        csv::{StartGoal, read_pairs_csv_file},
    },
    figure::{Caption, ProofFigure, draw_proof},
    graph::proof::Bounds,
    path::{Hop, HopPath},
    report::{CheckAnswer, Document, PairsAnswer, check_text},
};

use super::{
    captions::{SpeedLimit, title},
    search::{Searched, use_threads},
};
use crate::cli::{
    Answer, Failure,
    args::{CheckArgs, Format},
    effects::Purpose,
    hints::further_means,
    inputs,
    load::{EndOptions, Loaded, load},
    output,
    wrong_thing::Role,
};

/// Checks one pair or many.
pub(crate) fn run(args: &CheckArgs) -> Result<Answer, Failure> {
    let files = [
        (Some(args.journey.chain.as_path()), Role::Chain),
        (args.common.scenario.as_deref(), Role::ScenarioOption),
        (args.pairs.as_deref(), Role::Pairs),
    ];
    inputs::look_at(args.common.input_max_gib, &files)?;
    // Set before the terrain is read, since reading starts the threads.
    use_threads(args.answer.threads)?;
    let loaded = load(
        &args.journey.chain,
        &args.common,
        Some(&args.search),
        EndOptions::of_path(args.journey.start, args.journey.goal),
        Purpose::Check,
    )?;
    let mut warnings = Vec::new();
    let pairs = match &args.pairs {
        None => vec![loaded.ends()?],
        Some(path) => {
            let path = &inputs::open(path, Role::Pairs)?.file;
            let file = read_pairs_csv_file(path)?;
            warnings.extend(file.warnings.iter().map(|warning| format!("{}: {warning}", path.display())));
            stations(&loaded, path, &file.pairs)?
        }
    };
    // Outputs are opened before the computation, which may take long.
    let plot = args.plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    let (answers, pictures) = answers(&loaded, &pairs, args, &mut warnings)?;
    output::finish(plot.into_iter().zip(pictures).collect())?;
    for warning in &warnings {
        output::warn(args.common.quiet, warning);
    }
    let verdict = if answers.iter().all(CheckAnswer::is_traversable) { Answer::Yes } else { Answer::No };
    output::to_stdout(written(args, loaded, answers, warnings)?.as_bytes())?;
    Ok(verdict)
}

/// The stations of all pairs, or an error for the first that lies off the chain.
fn stations(loaded: &Loaded, file: &Path, pairs: &[StartGoal]) -> Result<Vec<(Station, Station)>, Failure> {
    let geometry = loaded.prepared.chain.geometry();
    let mut stations = Vec::with_capacity(pairs.len());
    for (i, pair) in pairs.iter().enumerate() {
        let station = |name: &str, x_m: f64| {
            geometry
                .station(x_m)
                .map_err(|problem| Failure::message(format!("{}: pair {} ({name}): {problem}", file.display(), i + 1)))
        };
        stations.push((station("start_x_m", pair.start_x_m)?, station("goal_x_m", pair.goal_x_m)?));
    }
    Ok(stations)
}

/// The answers for all pairs, the warnings about their paths, and the picture of the proof if requested.
fn answers(
    loaded: &Loaded,
    pairs: &[(Station, Station)],
    args: &CheckArgs,
    warnings: &mut Vec<String>,
) -> Result<(Vec<CheckAnswer>, Option<Vec<u8>>), Failure> {
    let test = loaded.hop_test();
    let options = &loaded.scenario.search;
    let searched = Searched::all(&test, pairs, &loaded.scenario, args.prove, args.common.quiet)?;
    let mut answers = Vec::with_capacity(pairs.len());
    let mut drawn = None;
    for (&ends, searched) in pairs.iter().zip(&searched) {
        let (answer, path) = searched.answer_with_path(&test, ends, (&loaded.prepared, options));
        // A path of too many hops to list is one all the same.
        let path = path.unwrap_or(None);
        if let Some(path) = &path {
            let of_path = loaded.scenario.path_warnings(path);
            warnings.extend(of_path.into_iter().filter(|warning| !warnings.contains(warning)).collect::<Vec<_>>());
        }
        if let (Some(file), Some(bounds)) = (args.plot.as_deref(), searched.bounds()) {
            drawn = Some(picture(loaded, ends, (bounds, path.as_ref()), file)?);
        }
        answers.push(answer);
    }
    Ok((answers, drawn))
}

/// The picture of what is proved along the chain, in the format of the file's extension.
fn picture(
    loaded: &Loaded,
    ends: (Station, Station),
    (bounds, path): (&Bounds, Option<&HopPath>),
    file: &Path,
) -> Result<Vec<u8>, Failure> {
    let scenario = &loaded.scenario;
    let mut line = vec![format!("from x = {:.3} m to x = {:.3} m", ends.0.point.x_m, ends.1.point.x_m)];
    line.extend(scenario.body.name.clone());
    line.extend(SpeedLimit::stated(&scenario.hopper).map(|limit| limit.to_string()));
    let beside = path.is_some_and(|path| path.hops.iter().any(Hop::is_beside_line));
    line.extend(beside.then(|| "path beside the line, drawn projected on it".to_owned()));
    let caption = Caption::new(title("What is proved", scenario), line.join(", "));
    let figure = ProofFigure::of(caption, loaded.prepared.chain.geometry(), ends, bounds, path);
    output::encoded(draw_proof(&figure), file)
}

/// The answers as text or as one document.
fn written(args: &CheckArgs, loaded: Loaded, mut answers: Vec<CheckAnswer>, warnings: Vec<String>) -> Result<String, Failure> {
    if args.answer.format == Format::Text {
        return Ok(answers.iter().map(|answer| check_text(answer, further_means())).collect::<Vec<_>>().join("\n"));
    }
    let warnings = loaded.warnings_with(warnings);
    let Loaded { document, inputs, prepared, .. } = loaded;
    let projection = prepared.projection.as_ref();
    Ok(match (&args.pairs, answers.pop()) {
        (None, Some(answer)) => Document::new("check", document, inputs, warnings, answer).on_map(projection).to_json()?,
        (_, last) => {
            answers.extend(last);
            Document::new("check-pairs", document, inputs, warnings, PairsAnswer { pairs: answers }).on_map(projection).to_json()?
        }
    })
}
