//! `chta map` over a mesh.

use chta::{
    report::{DocumentKind, mesh_map_text},
    study::{MeshReachQuestion, mesh_reach},
};

use crate::cli::{
    Answer, Failure,
    args::MapArgs,
    load::MeshPlanInput,
    output::{self, TableFormat},
    progress::Progress,
    views::{Files, Table, Views},
};

/// Finds what is reached over a mesh.
pub(super) fn run(args: &MapArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    check(args)?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let mut table = Table::begin(args.output.as_deref(), TableFormat::Csv)?;
    let hops_max = args.hops_max.map(|most| u32::from(most.unsigned_abs()));
    let question = MeshReachQuestion { scenario: &input.scenario, base: &input.base, hops_max, returns: args.back };
    let reached = mesh_reach(&question, &Progress::new(args.common.quiet)).map_err(|error| Failure::about(&input.mesh, &error))?;
    output::warn_all(args.common.quiet, &reached.warnings);
    let views = Views {
        text: &|| mesh_map_text(&reached.answer),
        json: &|| input.document(DocumentKind::MapMesh, &reached.warnings, &reached.answer),
        csv: &|out| reached.write_csv(out),
    };
    let mut files = Files::default();
    files.picture(plot, || Some(reached.picture(&input.scenario, args.view.direction())))?;
    files.table(&mut table, &views)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(reached.answer.reaches_the_goal()))
}

/// Refuses the options that only a DEM answers.
fn check(args: &MapArgs) -> Result<(), Failure> {
    const IN_SPACE: &str = "gives a place of a map by two numbers";
    const RASTER: &str = "writes a raster of a DEM's posts";
    const OF_GOALS: &str = "follows paths over a DEM (chta plan answers for the path to the goal)";
    let refused = [
        ("--start", !args.start.is_empty(), IN_SPACE),
        ("--start-lonlat", !args.start_lonlat.is_empty(), IN_SPACE),
        ("--starts", args.starts.is_some(), IN_SPACE),
        ("--goal", !args.goal.is_empty(), IN_SPACE),
        ("--goal-lonlat", !args.goal_lonlat.is_empty(), IN_SPACE),
        ("--stride", args.stride != 1, "thins the posts of a DEM (search.contacts_max is the number of contacts)"),
        (
            "--node-spacing-max-m",
            args.node_spacing_max_m.is_some(),
            "refines the posts of a DEM (search.contacts_max is the number of contacts)",
        ),
        ("--effort", args.effort.is_some(), "weighs hops over a DEM (over a mesh hops alone are counted)"),
        ("--objective", !args.objective.is_empty(), "weighs hops over a DEM (over a mesh hops alone are counted)"),
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
    let Some((option, _, what)) = refused.into_iter().find(|(_, given, _)| *given) else { return Ok(()) };
    let mend = if what == IN_SPACE {
        "set terrain.start_m and terrain.goal_m = [x, y, z] by the scenario or --set"
    } else {
        "leave the option out"
    };
    Err(Failure::message(format!("{option}: found this option, which {what}, and this terrain is a mesh: {mend}")))
}
