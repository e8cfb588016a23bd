//! `chta arena`: a wheeled robot that jumps, on a flat floor with boxes.

use std::time::Instant;

use chta::{
    report::arena_text,
    study::{compare_planners, plan_in_arena},
};

use crate::cli::{
    Answer, Failure,
    args::ArenaArgs,
    load::load_arena,
    output::{self, Pending},
    views::show,
};

/// Plans a path, and says how far it is from what no path beats.
pub(crate) fn run(args: &ArenaArgs) -> Result<Answer, Failure> {
    let planner = args.planner()?;
    let input = load_arena(args)?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let file = args.output.as_deref().map(Pending::begin).transpose()?;
    let began = Instant::now();
    let about = |error| Failure::about(&args.arena, &error);
    let mut planned = plan_in_arena(&input.arena, planner, !args.no_jump).map_err(about)?;
    if args.compare {
        planned.answer.compared = Some(compare_planners(&input.arena, args.rrt_star(), !args.no_jump).map_err(about)?);
    }
    output::say_run_time(args.quiet, began.elapsed());
    output::warn_all(args.quiet, &planned.warnings);
    let mut files = Vec::new();
    if let Some(file) = file {
        files.push((file, input.toml()?.into_bytes()));
    }
    if let Some(plot) = plot {
        let picture = output::encoded(planned.picture(&input.arena, &input.name), plot.path())?;
        files.push((plot, picture));
    }
    output::finish(files)?;
    show(args.format, || arena_text(&planned.answer), || input.document(&planned.answer, &planned.warnings))?;
    Ok(Answer::of(planned.answer.found))
}
