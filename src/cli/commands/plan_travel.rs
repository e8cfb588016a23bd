//! `chta plan` for a scenario with `[drive]`.

use chta::{
    report::{DocumentKind, travel_text, write_travel_csv},
    study::{Front, TravelOptions, travel_plan, travel_size},
};

use crate::cli::{
    Answer, Failure,
    args::PlanArgs,
    load::Loaded,
    not_for_travel, output,
    output::TableFormat,
    progress::Progress,
    views::{Files, GeoJsonFile, Table, Views},
};

/// Plans a mission that drives.
pub(super) fn run(args: &PlanArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    not_for_travel::refuse(&[
        ("--trajectory", args.trajectory.trajectory.is_some(), "writes hops along a profile"),
        ("--plot-front", args.plot_front.is_some(), "draws a front of hops"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
    ])?;
    if args.size.dry_run {
        let size = travel_size(&loaded.case)?;
        return output::sized(&loaded.record.document(DocumentKind::Size, &[], size), args.answer.format);
    }
    let options = TravelOptions { alternatives: args.alternatives, front: args.front()?.map(Front::amount) };
    let plot = args.view.begin_picture(args.plot.as_deref())?;
    let geojson = GeoJsonFile::begin(args.geojson.as_deref(), loaded.case.prepared.projection.as_ref())?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let planned = travel_plan(&loaded.case, options, &Progress::new(args.common.quiet))?;
    output::warn_all(args.common.quiet, &planned.warnings);
    let views = Views {
        text: &|| travel_text(&planned.answer),
        json: &|| loaded.document(DocumentKind::PlanTravel, &planned.warnings, &planned.answer),
        csv: &|out| write_travel_csv(&planned.answer.path, out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(planned.picture()))?;
    files.geojson(geojson, planned.geojson());
    files.table(&mut table, &views)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(planned.is_traversable()))
}
