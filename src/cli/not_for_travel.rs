//! Options that have no meaning for a mission that drives.

use super::{Failure, args::MapArgs, not_on_mesh::Given};

/// Refuses the first option that was given.
pub(crate) fn refuse(options: &[Given]) -> Result<(), Failure> {
    let Some((option, _, what)) = options.iter().find(|(_, given, _)| *given) else { return Ok(()) };
    Err(Failure::message(format!(
        "{option}: found this option, which {what}, and this scenario drives: leave the option out, or set drive.travel = \"hop\""
    )))
}

/// Refuses the options of a map that only hops answer.
pub(crate) fn refuse_of_map(args: &MapArgs) -> Result<(), Failure> {
    const OF_HOPS: &str = "is about hops alone";
    const OF_GOALS: &str = "follows the hops to a goal (chta plan answers for a mission to the goal)";
    refuse(&[
        ("--stride", args.stride != 1, "thins the nodes of hops (a coarser dem thins those of drive legs)"),
        ("--effort", args.effort.is_some(), "ranks hops (--objective ranks missions)"),
        ("--effort-output", args.effort_output.is_some(), OF_HOPS),
        ("--hops-max", args.hops_max.is_some(), "ends a search by hops (budget.hops_max limits the hops of missions)"),
        ("--nearest-output", args.nearest_output.is_some(), OF_HOPS),
        ("--predecessor-output", args.predecessor_output.is_some(), OF_HOPS),
        ("--mobility", args.mobility.is_some(), OF_HOPS),
        ("--simulate", args.simulate, OF_GOALS),
        ("--paths", args.paths.is_some(), OF_GOALS),
        ("--geojson", args.geojson.is_some(), OF_GOALS),
        ("--profiles", args.profiles.is_some(), OF_GOALS),
    ])
}
