//! `chta trade`: one or two keys of the scenario varied.

use std::path::Path;

use chta::{
    figure::{Picture, TradeFigure, draw_trade},
    report::{Document, DocumentKind, TradeAnswer},
    study::{SweptKey, Trade, TradeError},
};

use super::{
    captions::{SpeedLimit, title},
    search::use_threads,
};
use crate::cli::{
    Answer, Failure,
    args::{Format, TradeArgs},
    hints, inputs,
    load::{EndOptions, Loaded, ToVary, load_to_vary},
    output::{self, Pending, TableFormat},
    progress::Progress,
    wrong_thing::Role,
};

/// The failure for an invalid swept key.
#[expect(clippy::needless_pass_by_value, reason = "as map_err gives it")]
fn refused(error: TradeError) -> Failure {
    Failure::message(format!("--vary: {}", hints::sentence(&error)))
}

/// Answers every cell.
pub(crate) fn run(args: &TradeArgs) -> Result<Answer, Failure> {
    inputs::look_at(
        args.common.input_max_gib,
        &[(Some(&args.journey.chain), Role::Chain), (args.common.scenario.as_deref(), Role::ScenarioOption)],
    )?;
    use_threads(args.answer.threads)?;
    let swept: Vec<_> = args.vary.iter().map(|text| SweptKey::parse(text)).collect::<Result<_, _>>().map_err(refused)?;
    let table = args.output.as_deref().map(TableFormat::of).transpose()?;
    let csv_to_stdout = args.output.as_deref() == Some(Path::new("-"));
    // Outputs are opened before the computation, which may take long.
    let rows = args.output.as_deref().filter(|_| !csv_to_stdout).map(Pending::begin).transpose()?;
    let plot = args.plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    let ends = EndOptions::of_path(args.journey.start, args.journey.goal);
    let ToVary { first, survey, entries, base } = load_to_vary(&args.journey.chain, &args.common, &args.search, ends, &swept)?;
    first.ends()?;
    let trade = Trade::new(&entries, &base, &survey, &swept).map_err(refused)?;
    let budget = args.prove.prove.then_some(args.prove.budget);
    let answer = trade.run(budget, &Progress::new(args.common.quiet)).map_err(refused)?;
    for warning in answer.warnings() {
        output::warn(args.common.quiet, &warning);
    }
    let mut files = Vec::new();
    if let Some(file) = rows {
        let bytes = if table == Some(TableFormat::Json) { document(&first, &answer)?.into_bytes() } else { csv(&answer)? };
        files.push((file, bytes));
    }
    if let Some(file) = plot {
        let encoded = output::encoded(picture(&answer, &first), file.path())?;
        files.push((file, encoded));
    }
    output::finish(files)?;
    let text = match args.answer.format {
        _ if csv_to_stdout => csv(&answer)?,
        Format::Text => answer.text().into_bytes(),
        Format::Json => document(&first, &answer)?.into_bytes(),
    };
    output::to_stdout(&text)?;
    Ok(Answer::Yes)
}

/// The rows as CSV.
fn csv(answer: &TradeAnswer) -> Result<Vec<u8>, Failure> {
    let mut csv = Vec::new();
    answer.write_csv(&mut csv).map_err(|error| Failure::message(format!("trade.csv: {error}")))?;
    Ok(csv)
}

/// The answer as one JSON document; its scenario is that of the first row.
fn document(first: &Loaded, answer: &TradeAnswer) -> Result<String, Failure> {
    let warnings = first.warnings_with(answer.warnings());
    let document = Document::new(DocumentKind::Trade, first.document.clone(), first.inputs.clone(), warnings, answer.clone());
    Ok(document.on_map(first.prepared.projection.as_ref()).to_json()?)
}

/// The heat map.
fn picture(answer: &TradeAnswer, first: &Loaded) -> Result<Picture, chta::figure::FigureError> {
    let (scenario, prepared) = (&first.scenario, &first.prepared);
    let varied = |key: &str| answer.vary.iter().any(|v| v.key == key);
    let mut line = Vec::new();
    for (end, key, station) in [("from", "terrain.start_x_m", prepared.start), ("to", "terrain.goal_x_m", prepared.goal)] {
        line.extend(station.filter(|_| !varied(key)).map(|station| format!("{end} x = {:.3} m", station.point.x_m)));
    }
    line.extend(scenario.body.name.clone().filter(|_| !varied("body.gravity_m_s2")));
    line.extend(SpeedLimit::stated(&scenario.hopper).filter(|limit| !varied(limit.key)).map(|limit| limit.to_string()));
    draw_trade(&TradeFigure::of(answer, title("Fewest hops", scenario), line.join(", ")))
}
