//! `chta plan` for a scenario with `[mission]`.

use chta::{
    report::{DocumentKind, targets_text},
    study::targets_plan,
};

use crate::cli::{
    Answer, Failure,
    args::PlanArgs,
    hints::further_means,
    load::Loaded,
    not_for_targets, output,
    output::TableFormat,
    progress::Progress,
    trajectory::TrajectoryFile,
    views::{Files, GeoJsonFile, Table, Views},
};

/// Plans a mission over targets.
pub(super) fn run(args: &PlanArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    not_for_targets::refuse(&[
        ("--front", args.front.is_some(), "finds a front of paths to one goal"),
        ("--plot-front", args.plot_front.is_some(), "draws a front of paths to one goal"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
        ("--dry-run", args.size.dry_run, "states the size of a search for one goal"),
    ])?;
    let plot = args.view.begin_picture(args.plot.as_deref())?;
    let geojson = GeoJsonFile::begin(args.geojson.as_deref(), loaded.case.prepared.projection.as_ref())?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let in_time = TrajectoryFile::begin(&args.trajectory)?;
    let planned = targets_plan(&loaded.case, &Progress::new(args.common.quiet))?;
    output::warn_all(args.common.quiet, &planned.warnings);
    let views = Views {
        text: &|| targets_text(&planned.answer, further_means()),
        json: &|| loaded.document(DocumentKind::PlanTargets, &planned.warnings, &planned.answer),
        csv: &|out| planned.write_csv(out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(planned.picture()))?;
    files.geojson(geojson, planned.geojson());
    files.table(&mut table, &views)?;
    files.trajectory(in_time, planned.path(), planned.flown_case())?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(planned.is_traversable()))
}
