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
    for (name, list) in lists {
        command = command.mut_subcommand(name, |sub| {
            let example = sub.get_after_help().map(ToString::to_string).unwrap_or_default();
            sub.after_long_help(format!("{list}\n{example}"))
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
