//! `chta trade`: one or two keys of the scenario varied.

use chta::{
    report::DocumentKind,
    study::{SweptKey, Trade, trade},
};

use crate::cli::{
    Answer, Failure,
    args::TradeArgs,
    effects::Purpose,
    inputs,
    load::{load_mesh_plan, load_to_vary},
    output,
    progress::Progress,
    threads,
    views::{Files, Table, Views},
};

/// Answers every cell.
pub(crate) fn run(args: &TradeArgs) -> Result<Answer, Failure> {
    inputs::look_at_chain(&args.journey.chain, &args.common)?;
    threads::start(args.answer.threads)?;
    if let Some(input) = load_mesh_plan(&args.journey, &args.common, &args.search, Purpose::Trade, &[])? {
        return super::trade_legs::run(args, &input);
    }
    let swept: Vec<_> = args.vary.iter().map(|text| SweptKey::parse(text)).collect::<Result<_, _>>()?;
    // Outputs are opened before the computation, which may take long.
    let mut table = Table::by_extension(args.output.as_deref())?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let to_vary = load_to_vary(&args.journey, &args.common, &args.search, (Purpose::Trade, &[]), &|entries| {
        Ok(Trade::some_cells(entries, &swept, "--vary")?)
    })?;
    to_vary.first.ends()?;
    let mut traded = trade(&to_vary.variation, &swept, args.prove.proof(), &Progress::new(args.common.quiet))?;
    traded.word_errors(|error| to_vary.sentence(error));
    output::warn_all(args.common.quiet, &traded.warnings);
    let views = Views {
        text: &|| traded.answer.text(),
        // Its scenario is that of the first row that is not refused.
        json: &|| to_vary.first.document(DocumentKind::Trade, &traded.warnings, &traded.answer),
        csv: &|out| traded.answer.write_csv(out),
    };
    let mut files = Files::default();
    files.table(&mut table, &views)?;
    files.picture(plot, || Some(traded.picture()))?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(!args.require_all || traded.answer.is_traversable()))
}
