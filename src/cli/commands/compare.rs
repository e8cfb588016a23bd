//! `chta compare`: several scenarios side by side.

use std::path::Path;

use chta::study::{Compared, Comparison, PlanOptions, plan};

use crate::cli::{
    Answer, Failure,
    args::{CommonArgs, CompareArgs},
    effects::Purpose,
    inputs,
    load::{Loaded, comparison_document, load_scenario, relative_name},
    output,
    progress::Progress,
    threads,
    views::{Files, Table, Views},
};

/// Answers each scenario separately and shows the answers side by side.
pub(crate) fn run(args: &CompareArgs) -> Result<Answer, Failure> {
    inputs::look_at_scenarios(args.input_max_gib, &args.scenarios)?;
    // Outputs are opened before the computation, which may take long.
    let mut table = Table::by_extension(args.output.as_deref())?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    threads::start(args.answer.threads)?;
    let compared: Vec<_> = args.scenarios.iter().map(|file| compared(file, args)).collect::<Result<_, _>>()?;
    let (loaded, compared): (Vec<_>, Vec<_>) = compared.into_iter().unzip();
    let comparison = Comparison::of(compared);
    let views = Views {
        text: &|| comparison.answer.text(),
        json: &|| comparison_document(&loaded, &comparison),
        csv: &|out| comparison.answer.write_csv(out),
    };
    let mut files = Files::default();
    files.table(&mut table, &views)?;
    files.picture(plot, || Some(comparison.picture()))?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::Yes)
}

/// Loads and plans one scenario.
fn compared(file: &Path, args: &CompareArgs) -> Result<(Loaded, Compared), Failure> {
    let common = CommonArgs::of_scenarios(&args.set, args.accept_map_scale, args.input_max_gib, args.quiet);
    let loaded = load_scenario(file, &common, Purpose::Compare)?;
    loaded.ends()?;
    let options = PlanOptions { proof: args.prove.proof(), verify: false };
    let planned = plan(&loaded.case, options, &Progress::new(args.quiet))?;
    output::warn_all(args.quiet, &planned.warnings);
    Ok((loaded, Compared::of(planned, relative_name(file), &file.display().to_string())))
}
