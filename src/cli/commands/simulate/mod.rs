//! `chta simulate`: how reliably the planned path is flown.

mod drift;
mod experiment;
mod legs;
mod over_mesh;
mod targets;
mod travel;

use chta::{
    report::{DocumentKind, simulate_text},
    study::Trials,
};

use crate::cli::{
    Answer, Failure,
    args::SimulateArgs,
    density::DensityFiles,
    effects::Purpose,
    hints::further_means,
    inputs,
    landings::RowFile,
    load::{load_drift, load_journey, load_mesh_plan, plan_to_fly},
    output::{self, Pending},
    progress::Progress,
    tallies, threads,
    trajectory::TrajectoryFile,
    views::{Files, show},
};

/// Simulates.
pub(crate) fn run(args: &SimulateArgs) -> Result<Answer, Failure> {
    inputs::look_at_chain(&args.journey.chain, &args.common)?;
    // Set before the terrain is read, since reading starts the threads.
    threads::start(args.answer.threads)?;
    if let Some(open) = load_drift(&args.journey, &args.common, &args.search, &args.own_keys())? {
        return drift::run(args, open);
    }
    if let Some(input) = load_mesh_plan(&args.journey, &args.common, &args.search, Purpose::Simulate, &args.own_keys())? {
        return over_mesh::run(args, &input);
    }
    let loaded = load_journey(&args.journey, &args.common, &args.search, Purpose::Simulate, &args.own_keys())?;
    if let Some(name) = &args.experiment {
        return experiment::run(args, &loaded, name);
    }
    if loaded.case.scenario.drives().is_some() {
        return travel::run(args, &loaded);
    }
    if loaded.case.scenario.mission.is_some() {
        return targets::run(args, &loaded);
    }
    // All options are checked before the search, which may take long.
    args.check(&loaded.case)?;
    loaded.ends()?;
    let rows = args.output.as_deref().map(|path| RowFile::begin(path, args.draws, &loaded)).transpose()?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let plot_map = output::begin_picture("--plot-map", args.plot_map.as_deref())?;
    let tally = args.tally.as_deref().map(Pending::begin).transpose()?;
    let mut density = DensityFiles::begin(args)?;
    let in_time = TrajectoryFile::begin(&args.trajectory)?;
    let quiet = args.common.quiet;
    let planned = plan_to_fly(args, &loaded, &Progress::new(quiet))?;
    output::warn_all(quiet, &planned.warnings);
    let mut files = Files::default();
    files.trajectory(in_time, planned.path.as_ref(), &planned.case)?;
    let trials = Trials::new(&planned, &args.options());
    output::warn_all(quiet, trials.warnings());
    // Without a path the file of landings is not written.
    let (rows, rests) = (rows.filter(|_| planned.path.is_some()), density.of(&trials, args.within.as_deref())?);
    let mut simulated = tallies::fly_or_merge(trials, &args.merge, (rows, rests), &Progress::new(quiet))?;
    density.add(&mut files, &mut simulated)?;
    files.picture(plot, || simulated.picture())?;
    files.picture(plot_map, || simulated.landing_map())?;
    files.json(tally, simulated.tallies.first())?;
    files.finish()?;
    if !args.lands_on_stdout() {
        let text = || simulate_text(&simulated.answer, further_means());
        show(args.answer.format, text, || loaded.document(DocumentKind::Simulate, &simulated.warnings, &simulated.answer))?;
    }
    Ok(Answer::of(planned.is_traversable() && simulated.answer.shows_success()))
}
