//! Help generated from the program's own lists, so that it cannot become outdated.

use std::{fmt::Write, sync::OnceLock};

use chta::{
    chain::csv::{CHAIN_COLUMNS, CsvColumn, MEASURED_COLUMNS, PAIRS_COLUMNS},
    scenario::CATALOGUE,
    terrain::{FORMATS, MESH_FORMATS},
};
use clap::{Command, CommandFactory, FromArgMatches};

use super::{Failure, args::Args, pictures, threads};

/// The name of the command that was called.
static CALLED: OnceLock<String> = OnceLock::new();

/// Where the spacing of nodes and the choice of take-off angles change the answer of a command, in lines of at most 100 characters.
const CHANGES: [(&str, &str); 16] = [
    ("run", JOURNEY),
    (
        "slice",
        "  Nowhere: every crossing of the ground's facets is a vertex. Commands that take the chain place\n  nodes between its vertices.",
    ),
    (
        "fan",
        "  Spacing: hops and distances of a heading hold over its nodes; finer ones may reach farther or\n  need fewer hops. Angles: nowhere, whole windows count.",
    ),
    (
        "map",
        "  Spacing: hops end at posts (every N-th with --stride N) or at nodes in between\n  (--node-spacing-max-m); others may reach more, in fewer hops. Angles: the choice\n  (search.takeoff_angle) changes effort, amounts and trials, never the fewest hops.",
    ),
    (
        "hop",
        "  Spacing: nowhere, there are two places and no nodes. Angles: windows are the same for every\n  choice (search.takeoff_angle), which only picks the best hop inside them.",
    ),
    (
        "check",
        "  Spacing: a path, and its hops, hold over the nodes; finer nodes may find one, or a shorter one.\n  The bound below holds for any nodes, and --prove raises it. Angles: nowhere, whole windows count.",
    ),
    ("plan", JOURNEY),
    (
        "require",
        "  Spacing: the value that suffices holds over the nodes; finer ones may lower it. Angles: with\n  --success-min and under limits of totals the choice (search.takeoff_angle) counts, otherwise not.",
    ),
    (
        "trade",
        "  Spacing: every cell is a plan over its nodes; finer ones may find paths in more cells, or shorter\n  ones. Angles: the choice (search.takeoff_angle) changes totals and success of cells.",
    ),
    (
        "compare",
        "  Spacing and angles: each scenario is planned with its own nodes and choice of angle, so that\n  rows differ by them as well; give all the same where machines are compared.",
    ),
    (
        "simulate",
        "  Spacing: trials fly the plan over its nodes, and replan over the same; finer ones change the\n  path and its success. Angles: the choice (search.takeoff_angle) moves hops from the ends of their\n  windows; most-reliable is the choice where errors are given.",
    ),
    (
        "sites",
        "  Spacing: shares and hops of a candidate hold over the nodes of its map, and candidates stand on\n  the lattice asked for; finer ones may rank otherwise. Angles: nowhere, whole windows count.",
    ),
    ("batch", JOURNEY),
    (
        "stance",
        "  Spacing: the rose has angles at its headings alone (--headings). Angles: each heading has its\n  exact window, from which nothing is chosen; spacing of nodes is of no account.",
    ),
    (
        "arena",
        "  Spacing: --planner grid goes over nodes of the arena's grid.spacing_m, so that its time is one\n  over them; rrt-star samples; any-angle has no nodes. Angles: nowhere, the machine has one\n  take-off angle.",
    ),
    ("report", "  Nowhere: a page shows answers; its slider of angles moves one arc inside its window and plans\n  nothing."),
];

/// The same of commands that plan a path.
const JOURNEY: &str = "  Spacing (search.node_spacing_max_m, search.points_per_segment): a path, and its hops, hold over\n  the nodes; finer nodes may find one, or a better one. The bound below holds for any nodes.\n  Angles (search.takeoff_angle): the choice changes speeds, totals, margins and success, and with\n  them which of the paths of fewest hops is taken; whether a hop is feasible it does not change.";

/// Whether a command has an option of this long name, written without its dashes.
pub(super) fn offers(command: &str, option: &str) -> bool {
    let command = Args::command().find_subcommand(command).cloned();
    command.is_some_and(|command| command.get_arguments().any(|argument| argument.get_long() == Some(option)))
}

/// Whether the command that was called has an option of this long name.
pub(super) fn takes(option: &str) -> bool {
    CALLED.get().is_none_or(|command| offers(command, option))
}

/// The command line, parsed.
///
/// # Errors
/// A bad value in the environment, or options that contradict each other. What clap refuses ends the program.
pub(super) fn parsed() -> Result<Args, Failure> {
    let matches = command().get_matches();
    if let Some((name, of_command)) = matches.subcommand() {
        // Parsed once, so it is not set before.
        let _ = CALLED.set(name.to_owned());
        threads::take_default(of_command)?;
        pictures::take_width(name, of_command)?;
        // clap would miss one that stands before the command.
        if matches.get_flag("verbose") && of_command.try_get_one::<bool>("quiet").is_ok_and(|quiet| quiet == Some(&true)) {
            return Err(Failure::message("found both --verbose and --quiet, expected at most one of them: omit the other"));
        }
    }
    Ok(Args::from_arg_matches(&matches).unwrap_or_else(|error| error.exit()))
}

/// The command line's definition, with these lists in its long help.
pub(super) fn command() -> Command {
    let mut command = pictures::with_width(Args::command());
    let lists = [
        ("run", scenario_keys()),
        ("slice", formats()),
        ("hop", columns("Columns of a chain CSV", &CHAIN_COLUMNS)),
        ("check", columns("Columns of a pairs CSV", &PAIRS_COLUMNS)),
        ("plan", columns("Columns of a chain CSV", &CHAIN_COLUMNS)),
        ("simulate", columns("Columns of a CSV of measured errors (uncertainty.errors)", &MEASURED_COLUMNS)),
    ];
    for (name, changes) in CHANGES {
        command = command.mut_subcommand(name, |sub| {
            let example = sub.get_after_help().map(ToString::to_string).unwrap_or_default();
            let list = lists.iter().find(|(of, _)| *of == name).map_or_else(String::new, |(_, list)| format!("{list}\n"));
            sub.after_long_help(format!("{list}Where spacing and the choice of angles change the answer:\n{changes}\n\n{example}"))
        });
    }
    // A fan has no path to refine for and no second criterion.
    command.mut_subcommand("fan", |fan| {
        fan.mut_arg("points_per_segment", |points| {
            points
                .help("Points inside each segment; auto is the same as 1, since there is no single path to refine for [default: 1]")
        })
        .mut_arg("effort", |effort| effort.hide(true))
    })
}

/// Every key of a scenario.
fn scenario_keys() -> String {
    let mut text = "Keys of a scenario:\n".to_owned();
    let mut table = "";
    for key in &CATALOGUE {
        if key.table != table {
            table = key.table;
            line(&mut text, format_args!("[{table}]"));
        }
        line(&mut text, format_args!("  {:<26} {}", key.name, key.help));
    }
    text
}

/// The formats of elevation rasters and meshes.
fn formats() -> String {
    let mut text = "Formats of elevation rasters and meshes:\n".to_owned();
    for (name, what) in FORMATS.into_iter().chain(MESH_FORMATS) {
        line(&mut text, format_args!("  {name:<16} {what}"));
    }
    text
}

/// The columns of a CSV file.
fn columns(title: &str, columns: &[CsvColumn]) -> String {
    let mut text = format!("{title}:\n");
    for column in columns {
        line(&mut text, format_args!("  {:<36} {}", column.name, column.help));
    }
    text
}

/// Adds a line; writing to a String cannot fail.
fn line(text: &mut String, line: std::fmt::Arguments<'_>) {
    let _ = text.write_fmt(line);
    text.push('\n');
}
