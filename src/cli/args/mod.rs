//! The command line as typed: the commands, the options that several of them share, and the parsers of positions and counts.

mod arena;
mod batch;
mod journeys;
mod maps;
mod position;
mod setup;
mod sites;
mod stance;
mod synth;
mod terrains;

use std::path::PathBuf;

use chta::{graph::proof::DEFAULT_BUDGET_CELLS, study::Proof, terrain::NoDataRule};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

use super::{
    inputs::{DEFAULT_MAX_GIB, max_gib},
    threads::thread_count,
};

pub(crate) use arena::ArenaArgs;
pub(crate) use batch::{BatchArgs, TableFile};
pub(crate) use journeys::{
    CheckArgs, CompareArgs, HopArgs, PlanArgs, ReportArgs, RequireArgs, RunArgs, SimulateArgs, TradeArgs, TrajectoryArgs,
};
pub(crate) use maps::{FanArgs, MapArgs, NodeSpacing};
pub(crate) use position::{Position, place};
use position::{lon_lat, map_point, position};
pub(crate) use setup::{CompletionsArgs, ManArgs, SchemaArgs};
pub(crate) use sites::SitesArgs;
pub(crate) use stance::StanceArgs;
pub(crate) use synth::{MeshArg, SynthArgs};
pub(crate) use terrains::SliceArgs;

/// Constrained hopping traversability analysis: can a hopping robot get from here to there, in how few hops, with which commands?
///
/// Exit status: 0 done, and the answer is yes; 1 done, and the answer is no; 2 bad input or failure; 130 interrupted.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 110)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Say on standard error what is read, with which settings, and how long each stage takes; the answer stays as it is
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Run(RunArgs),
    Slice(SliceArgs),
    Fan(FanArgs),
    Map(Box<MapArgs>),
    Sites(Box<SitesArgs>),
    Hop(HopArgs),
    Check(CheckArgs),
    Plan(PlanArgs),
    Simulate(Box<SimulateArgs>),
    Require(RequireArgs),
    Trade(TradeArgs),
    Compare(CompareArgs),
    Batch(BatchArgs),
    Report(ReportArgs),
    Stance(Box<StanceArgs>),
    Arena(Box<ArenaArgs>),
    Synth(Box<SynthArgs>),
    /// List the known bodies with gravity, radius and their source
    #[command(after_help = "Example:\n  chta bodies")]
    Bodies,
    Completions(CompletionsArgs),
    Man(ManArgs),
    Schema(SchemaArgs),
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

impl CommonArgs {
    /// The same for a command that takes whole scenarios and few of these options.
    pub(crate) fn of_scenarios(set: &[String], accept_map_scale: bool, input_max_gib: f64, quiet: bool) -> Self {
        let set = set.to_vec();
        let (body, gravity_m_s2, clearance_m, no_data) = (None, None, None, None);
        Self { scenario: None, set, body, gravity_m_s2, clearance_m, accept_map_scale, no_data, input_max_gib, quiet }
    }
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
    #[arg(long, value_name = "CELLS", alias = "budget", default_value_t = DEFAULT_BUDGET_CELLS, value_parser = cell_count, requires = "prove", allow_negative_numbers = true)]
    pub(crate) prove_cells_max: usize,
}

impl ProveArgs {
    /// The proof, if it is wanted.
    pub(crate) fn proof(self) -> Option<Proof> {
        self.prove.then_some(Proof { budget_cells: self.prove_cells_max })
    }
}

/// A chain, and where the journey over it begins and ends.
#[derive(Debug, ClapArgs)]
pub(crate) struct JourneyArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON); -: standard input
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start, m: X along the chain, X,Y on the map, X,Y,Z of a free route over a mesh [default: the scenario's]
    #[arg(long, value_name = "X[,Y]", value_parser = position, allow_hyphen_values = true)]
    pub(crate) start: Option<Position>,
    /// Goal, m: X along the chain, X,Y on the map, X,Y,Z of a free route over a mesh [default: the scenario's]
    #[arg(long, value_name = "X[,Y]", value_parser = position, allow_hyphen_values = true)]
    pub(crate) goal: Option<Position>,
}

/// How an answer is computed and written.
#[derive(Clone, Copy, Debug, ClapArgs)]
pub(crate) struct AnswerArgs {
    /// Threads to work with; the answer does not depend on it [default: the environment variable `CHTA_THREADS`, else one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = thread_count)]
    pub(crate) threads: usize,
    /// How the answer is written to standard output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Reads a number of cells.
fn cell_count(text: &str) -> Result<usize, String> {
    const MOST: usize = 10_000_000;
    let count = text.trim().parse().ok().filter(|count| (1..=MOST).contains(count));
    count
        .ok_or_else(|| format!("found `{text}`, expected a whole number of cells from 1 to {MOST}, such as {DEFAULT_BUDGET_CELLS}"))
}

/// Reads the number of a trial.
fn trial_number(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("found `{text}`, expected the number of a trial: a whole number from 0"))
}

/// Reads a share of successful trials.
fn success_share(text: &str) -> Result<f64, String> {
    let share = text.trim().parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| format!("found `{text}`, expected a share above 0 and at most 1, such as 0.95"))
}

/// Reads `VALUE` or `none`.
fn no_data_rule(text: &str) -> Result<NoDataRule, String> {
    if text.eq_ignore_ascii_case("none") {
        return Ok(NoDataRule::Nothing);
    }
    text.parse().map(NoDataRule::Value).map_err(|_| format!("found `{text}`, expected a number, or none"))
}
