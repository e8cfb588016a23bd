//! `chta plan`: the path of fewest hops, then least effort.

use chta::{
    report::{DocumentKind, plan_text},
    study::{PlanOptions, plan, route_size},
};

use super::{plan_over_mesh, plan_targets, plan_travel};
use crate::cli::{
    Answer, Failure,
    args::PlanArgs,
    effects::Purpose,
    hints::further_means,
    inputs,
    load::{load_journey, load_mesh_plan},
    output::{self, TableFormat},
    progress::Progress,
    threads,
    trajectory::TrajectoryFile,
    views::{Files, GeoJsonFile, Table, Views},
};

/// Plans a path.
pub(crate) fn run(args: &PlanArgs) -> Result<Answer, Failure> {
    inputs::look_at_chain(&args.journey.chain, &args.common)?;
    let front = args.front()?;
    threads::start(args.answer.threads)?;
    if let Some(input) = load_mesh_plan(&args.journey, &args.common, &args.search, Purpose::Plan, &[])? {
        return plan_over_mesh::run(args, &input);
    }
    args.refuse_of_facets()?;
    let loaded =
        load_journey(&args.journey, &args.common, &args.search, Purpose::Plan, &[])?.within_memory(args.size.memory_max_bytes())?;
    loaded.ends()?;
    if loaded.case.scenario.drives().is_some() {
        return plan_travel::run(args, &loaded);
    }
    args.refuse_alternatives()?;
    if loaded.case.scenario.mission.is_some() {
        return plan_targets::run(args, &loaded);
    }
    if args.size.dry_run {
        let size = route_size(&loaded.case)?;
        return output::sized(&loaded.record.document(DocumentKind::Size, &[], size), args.answer.format);
    }
    args.geojson.is_some().then(|| loaded.check_on_map("--geojson")).transpose()?;
    // Outputs are opened before the search, which may take long.
    let plot = args.view.begin_picture(args.plot.as_deref())?;
    let plot_front = output::begin_picture("--plot-front", args.plot_front.as_deref())?;
    let geojson = GeoJsonFile::begin(args.geojson.as_deref(), loaded.case.prepared.projection.as_ref())?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let in_time = TrajectoryFile::begin(&args.trajectory)?;
    let options = PlanOptions { proof: args.prove.proof(), verify: args.verify, estimate: true, front };
    let planned = plan(&loaded.case, options, &Progress::new(args.common.quiet))?;
    output::warn_all(args.common.quiet, &planned.warnings);
    let views = Views {
        text: &|| plan_text(&planned.answer, further_means()),
        json: &|| loaded.document(DocumentKind::Plan, &planned.warnings, &planned.answer),
        csv: &|out| planned.write_csv(out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(planned.picture()))?;
    files.picture(plot_front, || planned.front_picture())?;
    files.geojson(geojson, planned.geojson());
    files.table(&mut table, &views)?;
    files.trajectory(in_time, planned.path.as_ref(), &planned.case)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(planned.is_traversable()))
}
