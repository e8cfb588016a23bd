//! The command line as typed: the commands, the options that several of them share, and the parsers of positions and counts.

mod journeys;
mod terrains;

use std::path::PathBuf;

use chta::{
    graph::proof::DEFAULT_BUDGET_CELLS,
    quantity::MapPoint,
    terrain::{LonLat, NoDataRule},
};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

use super::inputs::{DEFAULT_MAX_GIB, max_gib};

pub(crate) use journeys::{
    CheckArgs, CompareArgs, HopArgs, PlanArgs, RequireArgs, RunArgs, SimulateArgs, TradeArgs, TrajectoryArgs,
};
pub(crate) use terrains::{DepthLawArg, FanArgs, MapArgs, SliceArgs, SynthArgs};

/// Constrained hopping traversability analysis: can a hopping robot get from here to there, in how few hops, with which commands?
///
/// Exit status: 0 done, and the answer is yes; 1 done, and the answer is no; 2 bad input or failure.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 110)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Run(RunArgs),
    Slice(SliceArgs),
    Fan(FanArgs),
    Map(Box<MapArgs>),
    Hop(HopArgs),
    Check(CheckArgs),
    Plan(PlanArgs),
    Simulate(Box<SimulateArgs>),
    Require(RequireArgs),
    Trade(TradeArgs),
    Compare(CompareArgs),
    Synth(Box<SynthArgs>),
    /// List the known bodies with gravity, radius and their source
    #[command(after_help = "Example:\n  chta bodies")]
    Bodies,
    Schema(SchemaArgs),
}

/// Print the JSON schema of a scenario or of an answer, or list their kinds
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta schema plan")]
pub(crate) struct SchemaArgs {
    /// scenario, or the kind of an answer; absent: list them
    #[arg(value_name = "KIND")]
    pub(crate) kind: Option<String>,
}

/// How a result is written to standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For reading.
    Text,
    /// One document, for scripts.
    Json,
}

/// Options of all analyses.
#[derive(Clone, Debug, ClapArgs)]
pub(crate) struct CommonArgs {
    /// Scenario (TOML) with body, hopper, surface and search
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<PathBuf>,
    /// Set any scenario key; overrides the scenario [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Known body, which gives gravity and radius (`chta bodies` lists them)
    #[arg(long, value_name = "NAME")]
    pub(crate) body: Option<String>,
    /// Gravity, m/s^2
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    pub(crate) gravity_m_s2: Option<f64>,
    /// Height to keep over the ground flown over, less near take-off and landing, m [default: 0]
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    pub(crate) clearance_m: Option<f64>,
    /// Accept a map whose scale along the transect is off by over 1 %, with its distances unchanged
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// Stored number that marks missing elevations, or none: all numbers are elevations [default: as the file states]
    #[arg(long, value_name = "VALUE|none", allow_negative_numbers = true)]
    pub(crate) no_data: Option<String>,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Options of commands that search.
#[derive(Debug, ClapArgs)]
pub(crate) struct SearchArgs {
    /// Points inside each segment, or auto: the first of 0, 1, 2, 3, 7, 15, 31 that finds a path [default: auto]
    #[arg(long, value_name = "K|auto", allow_negative_numbers = true)]
    pub(crate) points_per_segment: Option<String>,
    /// Instead: greatest spacing of neighbouring points along the ground, m [default: by points per segment]
    #[arg(long, value_name = "D", conflicts_with = "points_per_segment", allow_negative_numbers = true)]
    pub(crate) node_spacing_max_m: Option<f64>,
    /// Second criterion after hops: takeoff-speed, energy, time, peak-speed [default: takeoff-speed]
    #[arg(long, value_name = "EFFORT")]
    pub(crate) effort: Option<String>,
}

/// Options of a proof.
#[derive(Clone, Copy, Debug, ClapArgs)]
pub(crate) struct ProveArgs {
    /// Bound the fewest hops from below and above, for every choice of points; "untraversable" where no path is proved to exist
    #[arg(long)]
    pub(crate) prove: bool,
    /// Greatest number of cells that the chain is divided into for the proof
    #[arg(long, value_name = "CELLS", default_value_t = DEFAULT_BUDGET_CELLS, value_parser = cell_count, requires = "prove", allow_negative_numbers = true)]
    pub(crate) budget: usize,
}

/// A chain, and where the journey over it begins and ends.
#[derive(Debug, ClapArgs)]
pub(crate) struct JourneyArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON); -: standard input
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) start: Option<f64>,
    /// Goal along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) goal: Option<f64>,
}

/// How an answer is computed and written.
#[derive(Clone, Copy, Debug, ClapArgs)]
pub(crate) struct AnswerArgs {
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = thread_count)]
    pub(crate) threads: usize,
    /// How the answer is written to standard output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Reads a number of threads; 0: one for each core.
fn thread_count(text: &str) -> Result<usize, String> {
    /// More than any machine this runs on has cores; thousands of threads take longer to start than most answers.
    const MOST_THREADS: usize = 512;
    match text.parse() {
        Ok(threads) if threads <= MOST_THREADS => Ok(threads),
        _ => Err(format!("expected a whole number from 0 (one for each core) to {MOST_THREADS}")),
    }
}

/// Reads a number of cells.
fn cell_count(text: &str) -> Result<usize, String> {
    const MOST: usize = 10_000_000;
    let count = text.trim().parse().ok().filter(|count| (1..=MOST).contains(count));
    count
        .ok_or_else(|| format!("found `{text}`, expected a whole number of cells from 1 to {MOST}, such as {DEFAULT_BUDGET_CELLS}"))
}

/// Reads `X,Y`.
fn map_point(text: &str) -> Result<MapPoint, String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|n| n.is_finite());
    let wanted = || format!("found `{text}`, expected two finite numbers in metres, X,Y, such as 12.5,-30");
    let (x, y) = text.split_once(',').ok_or_else(wanted)?;
    Ok(MapPoint::new(number(x).ok_or_else(wanted)?, number(y).ok_or_else(wanted)?))
}

/// Reads `VALUE` or `none`.
fn no_data_rule(text: &str) -> Result<NoDataRule, String> {
    if text.eq_ignore_ascii_case("none") {
        return Ok(NoDataRule::Nothing);
    }
    text.parse().map(NoDataRule::Value).map_err(|_| format!("found `{text}`, expected a number, or none"))
}

/// Reads `LON,LAT`.
fn lon_lat(text: &str) -> Result<LonLat, String> {
    let number = |part: &str, range: std::ops::RangeInclusive<f64>| part.trim().parse::<f64>().ok().filter(|n| range.contains(n));
    let wanted = || {
        format!(
            "found `{text}`, expected longitude (-180 to 360, east positive) and latitude (-90 to 90) in degrees, such as 62.8,-87.18"
        )
    };
    let (lon, lat) = text.split_once(',').ok_or_else(wanted)?;
    let (lon_deg, lat_deg) = (number(lon, -180.0..=360.0).ok_or_else(wanted)?, number(lat, -90.0..=90.0).ok_or_else(wanted)?);
    Ok(LonLat { lon_deg, lat_deg })
}
