//! What is common to the pictures of all commands: their width, and the files of their pages.

use std::{
    path::{Path, PathBuf},
    sync::{Mutex, OnceLock, PoisonError},
};

use chta::figure::{FigureError, Picture, WIDTH_MAX_MM, WIDTH_MIN_MM};
use clap::{Arg, ArgMatches, Command};

use super::{Failure, output};

/// The options that name a picture.
const OPTIONS: [&str; 6] = ["plot", "plot_density", "plot_front", "plot_map", "plot_postures", "profiles"];

/// The command whose pictures have names of their own.
const RUN: &str = "run";

const WIDTH: &str = "width_mm";

/// The width of all pictures, if it is given.
static WIDTH_MM: OnceLock<f64> = OnceLock::new();

/// The files of pictures with several pages.
static PAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// The command line with `--width-mm` for every command that draws.
pub(super) fn with_width(command: Command) -> Command {
    let draws = |command: &Command| {
        let named = command.get_arguments().any(|argument| OPTIONS.contains(&argument.get_id().as_str()));
        named || command.get_name() == RUN
    };
    let names: Vec<String> =
        command.get_subcommands().filter(|command| draws(command)).map(|command| command.get_name().to_owned()).collect();
    let width = Arg::new(WIDTH)
        .long("width-mm")
        .value_name("W")
        .value_parser(width_mm)
        .allow_negative_numbers(true)
        .help("Width of every picture, mm; lines and letters become larger or smaller with it [default: 170]");
    names.into_iter().fold(command, |command, name| command.mut_subcommand(name, |command| command.arg(width.clone())))
}

/// Reads a width.
fn width_mm(text: &str) -> Result<f64, String> {
    let width_mm = text.trim().parse().ok().filter(|width_mm| (WIDTH_MIN_MM..=WIDTH_MAX_MM).contains(width_mm));
    width_mm.ok_or_else(|| format!("found `{text}`, expected a width from {WIDTH_MIN_MM} to {WIDTH_MAX_MM} mm, such as 84"))
}

/// Takes the width from the command line.
///
/// # Errors
/// A width without a picture.
pub(super) fn take_width(name: &str, command: &ArgMatches) -> Result<(), Failure> {
    let Some(width_mm) = command.try_get_one::<f64>(WIDTH).ok().flatten() else { return Ok(()) };
    let is_given = |option: &&str| command.try_contains_id(option).unwrap_or(false);
    if name != RUN && !OPTIONS.iter().any(is_given) {
        return Err(Failure::message(
            "--width-mm: found no picture to have this width, expected an option that names one: give --plot FILE.svg, or leave the width out",
        ));
    }
    // Called once.
    let _ = WIDTH_MM.set(*width_mm);
    Ok(())
}

/// A picture in the width of the command line.
pub(super) fn in_width(picture: Picture) -> Result<Picture, FigureError> {
    match WIDTH_MM.get() {
        None => Ok(picture),
        Some(width_mm) => picture.with_width_mm(*width_mm),
    }
}

/// The files of a picture, which the answer names if they are several.
pub(crate) fn encoded(drawn: Result<Picture, FigureError>, file: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let files = pages(drawn, file)?;
    if files.len() > 1 {
        let names = files.iter().map(|(file, _)| file.display().to_string());
        PAGES.lock().unwrap_or_else(PoisonError::into_inner).extend(names);
    }
    Ok(files)
}

/// A picture as files, one for each page: the first has the name given, page 2 of `FILE.svg` is `FILE-2.svg`. A device or pipe gets all pages
/// in one picture.
pub(crate) fn pages(drawn: Result<Picture, FigureError>, file: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let about = |error: FigureError| Failure::message(error.to_string());
    let picture = drawn.and_then(in_width).map_err(about)?;
    let format = output::picture_format(file).map_err(about)?;
    let is_special = file.exists() && !file.is_file();
    let pages = if is_special { vec![picture] } else { picture.pages() };
    let file_of = |(number, page): (usize, &Picture)| -> Result<(PathBuf, Vec<u8>), Failure> {
        Ok((page_file(file, number), page.encoded(format).map_err(about)?))
    };
    (1..).zip(&pages).map(file_of).collect()
}

/// The file of a page, counted from 1.
pub(crate) fn page_file(file: &Path, number: usize) -> PathBuf {
    if number < 2 {
        return file.to_path_buf();
    }
    let (stem, ending) = (file.file_stem().unwrap_or_default(), file.extension().unwrap_or_default());
    file.with_file_name(format!("{}-{number}.{}", stem.to_string_lossy(), ending.to_string_lossy()))
}

/// The files of pictures with several pages, as a line at the end of an answer; empty without any.
pub(crate) fn pages_text() -> String {
    let names = PAGES.lock().unwrap_or_else(PoisonError::into_inner);
    match &names[..] {
        [] => String::new(),
        [first, .., last] if names.len() > 6 => {
            format!("pages of the picture: {first}, {}, ... {last} ({})\n", names[1], names.len())
        }
        _ => format!("pages of the picture: {}\n", names.join(", ")),
    }
}
