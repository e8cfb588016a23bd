//! `chta compare`: several scenarios side by side.

use crate::cli::{
    Answer, Failure,
    args::CompareArgs,
    compared::compare_all,
    inputs, output, threads,
    views::{Files, Table, Views},
};

/// Answers each scenario separately and shows the answers side by side.
pub(crate) fn run(args: &CompareArgs) -> Result<Answer, Failure> {
    inputs::look_at_scenarios(args.input_max_gib, &args.scenarios)?;
    // Outputs are opened before the computation, which may take long.
    let mut table = Table::by_extension(args.output.as_deref())?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    threads::start(args.answer.threads)?;
    let comparison = compare_all(args)?;
    let views = Views {
        text: &|| comparison.answer().text(),
        json: &|| comparison.document(),
        csv: &|out| comparison.answer().write_csv(out),
    };
    let mut files = Files::default();
    files.table(&mut table, &views)?;
    files.picture(plot, || Some(comparison.picture(args.view.direction())))?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(!args.require_all || comparison.answer().is_traversable()))
}
