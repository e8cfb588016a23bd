//! Options that have no meaning over a mesh as it stands.

use super::{Failure, args::MapArgs};

/// An option, whether it was given, and what it does.
pub(crate) type Given = (&'static str, bool, &'static str);

/// What is to be done about an option that was given.
const LEAVE_OUT: &str = "leave the option out";

/// Refuses the first option that was given.
pub(crate) fn refuse(options: &[Given]) -> Result<(), Failure> {
    refuse_with(options, |_| LEAVE_OUT)
}

/// Refuses the first option that was given beside a robot with legs.
pub(crate) fn refuse_for_legs(options: &[Given]) -> Result<(), Failure> {
    let Some((option, _, what)) = options.iter().find(|(_, given, _)| *given) else { return Ok(()) };
    Err(Failure::message(format!("{option}: found this option, which {what}, and robot.file names a robot with legs: {LEAVE_OUT}")))
}

/// Refuses the options of a map that only a point answers.
pub(crate) fn refuse_of_legs_map(args: &MapArgs) -> Result<(), Failure> {
    const OF_POINTS: &str = "is about hops of a point";
    const OF_GOALS: &str = "follows the hops of a point to a goal (chta plan answers for stances on the way to one)";
    refuse_for_legs(&[
        ("--node-spacing-max-m", args.node_spacing_max_m.is_some(), "sets nodes finer than posts (--stride thins them)"),
        ("--effort", args.effort.is_some(), OF_POINTS),
        ("--objective", !args.objective.is_empty(), "weighs hops of a point (over stances hops alone are counted)"),
        ("--return", args.back, OF_POINTS),
        ("--effort-output", args.effort_output.is_some(), OF_POINTS),
        ("--amount-output", !args.amount_output.is_empty(), OF_POINTS),
        ("--return-output", args.return_output.is_some(), OF_POINTS),
        ("--nearest-output", args.nearest_output.is_some(), OF_POINTS),
        ("--predecessor-output", args.predecessor_output.is_some(), OF_POINTS),
        ("--simulate", args.simulate, OF_GOALS),
        ("--paths", args.paths.is_some(), OF_GOALS),
        ("--geojson", args.geojson.is_some(), OF_GOALS),
        ("--profiles", args.profiles.is_some(), OF_GOALS),
    ])
}

fn refuse_with(options: &[Given], mend: impl Fn(&str) -> &'static str) -> Result<(), Failure> {
    let Some((option, _, what)) = options.iter().find(|(_, given, _)| *given) else { return Ok(()) };
    let mend = mend(what);
    Err(Failure::message(format!("{option}: found this option, which {what}, and this terrain is a mesh: {mend}")))
}

/// Refuses the options of a map that only a DEM answers.
pub(crate) fn refuse_of_map(args: &MapArgs) -> Result<(), Failure> {
    const IN_SPACE: &str = "gives a place of a map by two numbers";
    const RASTER: &str = "writes a raster of a DEM's posts";
    const NODES: &str = "sets the nodes over a DEM (search.contacts_max is the number of contacts)";
    const AMOUNTS: &str = "weighs hops over a DEM (over a mesh hops alone are counted)";
    const OF_GOALS: &str = "follows paths over a DEM (chta plan answers for the path to the goal)";
    let options = [
        ("--start", !args.start.is_empty(), IN_SPACE),
        ("--start-lonlat", !args.start_lonlat.is_empty(), IN_SPACE),
        ("--starts", args.starts.is_some(), IN_SPACE),
        ("--goal", !args.goal.is_empty(), IN_SPACE),
        ("--goal-lonlat", !args.goal_lonlat.is_empty(), IN_SPACE),
        ("--stride", args.stride != 1, NODES),
        ("--node-spacing-max-m", args.node_spacing_max_m.is_some(), NODES),
        ("--effort", args.effort.is_some(), AMOUNTS),
        ("--objective", !args.objective.is_empty(), AMOUNTS),
        ("--effort-output", args.effort_output.is_some(), RASTER),
        ("--amount-output", !args.amount_output.is_empty(), RASTER),
        ("--return-output", args.return_output.is_some(), RASTER),
        ("--nearest-output", args.nearest_output.is_some(), RASTER),
        ("--predecessor-output", args.predecessor_output.is_some(), RASTER),
        ("--mobility", args.mobility.is_some(), RASTER),
        ("--qml", args.qml, "writes the style of a raster"),
        ("--simulate", args.simulate, "flies paths over a DEM (chta simulate flies the path to the goal)"),
        ("--paths", args.paths.is_some(), OF_GOALS),
        ("--geojson", args.geojson.is_some(), OF_GOALS),
        ("--profiles", args.profiles.is_some(), OF_GOALS),
        ("--dry-run", args.size.dry_run, "states the size of a search over a DEM"),
        ("--memory-max-mib", args.size.memory_max_mib.is_some(), "limits the memory of a search over a DEM"),
    ];
    refuse_with(&options, |what| match what {
        IN_SPACE => "set terrain.start_m and terrain.goal_m = [x, y, z] by the scenario or --set",
        _ => LEAVE_OUT,
    })
}
