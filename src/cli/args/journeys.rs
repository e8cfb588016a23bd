//! The options of the commands that analyse a chain.

use std::path::{Path, PathBuf};

use chta::{
    figure::PictureFormat,
    graph::proof::DEFAULT_BUDGET_CELLS,
    study::{Case, Front, SimulateOptions},
    uncertainty::experiments::{DriftReading, Experiment},
};
use clap::{Args as ClapArgs, ValueEnum};

use super::{
    super::{Failure, density, load::OwnKey},
    AnswerArgs, CommonArgs, DEFAULT_MAX_GIB, Format, JourneyArgs, Position, ProveArgs, SearchArgs, cell_count,
    maps::{SizeArgs, ViewArgs},
    max_gib, position, success_share, trial_number,
};

/// Options of commands that fly a path.
#[derive(Debug, ClapArgs)]
pub(crate) struct TrajectoryArgs {
    /// Path in time (CSV) to write: position, velocity, hop and phase at every step and at all take-offs and landings
    #[arg(long, value_name = "FILE")]
    pub(crate) trajectory: Option<PathBuf>,
    /// Step of the trajectory, s [default: a fiftieth of the longest flight, but at least a hundred-thousandth of the mission time]
    #[arg(long, value_name = "S", requires = "trajectory", allow_negative_numbers = true)]
    pub(crate) step_s: Option<f64>,
}

/// The format of the pictures of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PicturesArg {
    /// Vector graphics.
    Svg,
    /// Raster graphics, 300 dots an inch.
    Png,
}

impl From<PicturesArg> for PictureFormat {
    fn from(format: PicturesArg) -> Self {
        match format {
            PicturesArg::Svg => Self::Svg,
            PicturesArg::Png => Self::Png,
        }
    }
}

/// Do everything a scenario asks for: chain.csv, path.csv, path.geojson (on a map), result.json and path.svg
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta run data/scenarios/mars_crater_field.toml -o out")]
pub(crate) struct RunArgs {
    /// Scenario (TOML), or a result.json to repeat; -: standard input
    #[arg(value_name = "SCENARIO")]
    pub(crate) scenario: PathBuf,
    /// Folder for the results, created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Page (HTML) to write of the answer, as `chta report` makes it: one file with figures, tables and the documents
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    /// Format of the pictures in the folder, whose names end in it
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = PicturesArg::Svg)]
    pub(crate) pictures: PicturesArg,
    #[command(flatten)]
    pub(crate) trajectory: TrajectoryArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    /// Set any scenario key; overrides the scenario [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Accept a map whose scale along the transect is off by over 1 %, with its distances unchanged
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Make a page of an answer: one HTML file with profile, map, 3-D ground, tables and provenance, which loads nothing else
///
/// The page holds the documents unchanged and the ground of their inputs, whose checksums have to be those of the documents.
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta report out/result.json -o out/report.html")]
pub(crate) struct ReportArgs {
    /// Results (JSON) of one scenario: one with a path (run, plan, simulate), and beside it trials, a trade, or the sensitivity to errors
    #[arg(value_name = "RESULT", required = true)]
    pub(crate) results: Vec<PathBuf>,
    /// Page (HTML) to write; -: standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Test one hop: each limit separately, the limits that bound the feasible take-off angles, or the two that conflict
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta hop data/scenarios/paper_76m.toml --from 0 --to 20 --format json")]
pub(crate) struct HopArgs {
    /// Chain (CSV), elevation raster, mesh (OBJ, STL, PLY), scenario (TOML) or result (JSON); -: standard input
    #[arg(value_name = "TERRAIN")]
    pub(crate) terrain: PathBuf,
    /// Where the hop takes off, m: X along a chain, X,Y on a map, X,Y,Z on a mesh [default: the scenario's start]
    #[arg(long, value_name = "X[,Y[,Z]]", value_parser = position, allow_hyphen_values = true)]
    pub(crate) from: Option<Position>,
    /// Where it lands, m: X along a chain, X,Y on a map, X,Y,Z on a mesh [default: the scenario's goal]
    #[arg(long, value_name = "X[,Y[,Z]]", value_parser = position, allow_hyphen_values = true)]
    pub(crate) to: Option<Position>,
    /// Picture (SVG or PNG) to write of a hop over a mesh: the cut of its plane, the feasible arcs and those that facets block
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) trajectory: TrajectoryArgs,
    /// How the answer is written to standard output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Does a path exist, and in how few hops
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta check data/scenarios/simple_reduced.toml --points-per-segment 2")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) journey: JourneyArgs,
    /// Many pairs of start and goal: CSV with `start_x_m,goal_x_m`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["start", "goal"])]
    pub(crate) pairs: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    /// Picture (SVG or PNG) to write: which stretches of the chain are proved reachable or unreachable
    #[arg(long, value_name = "FILE", requires = "prove", conflicts_with = "pairs")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) prove: ProveArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Plan the path of fewest hops, then least effort
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta plan data/scenarios/paper_76m.toml --verify -o path.csv --plot path.svg")]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(crate) journey: JourneyArgs,
    /// Path CSV to write; -: to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Path in three dimensions (GeoJSON) to write, for a chain on a map
    #[arg(long, value_name = "FILE")]
    pub(crate) geojson: Option<PathBuf>,
    /// Picture (SVG or PNG) to write, with or without a path
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    /// Fly the path again by direct simulation and check every limit
    #[arg(long)]
    pub(crate) verify: bool,
    /// Front of hops against an amount over the same nodes: hops,energy and the like, the least of it for every number of hops; hops,risk
    /// the most reliable path, with its success estimated by 512 fixed trials under the scenario's policy, which needs [uncertainty]
    /// [default: none]
    #[arg(long, value_name = "AMOUNTS")]
    pub(crate) front: Option<String>,
    /// Picture of the front (SVG or PNG) to write
    #[arg(long, value_name = "FILE", requires = "front")]
    pub(crate) plot_front: Option<PathBuf>,
    /// Picture (SVG or PNG) to write of a robot with legs: its key postures hop by hop, five hops from that of --postures-from on
    #[arg(long, value_name = "FILE")]
    pub(crate) plot_postures: Option<PathBuf>,
    /// First hop of the picture of postures
    #[arg(long, value_name = "HOP", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..), requires = "plot_postures")]
    pub(crate) postures_from: u32,
    /// Of a scenario with [drive]: the same journey by driving alone, by hops alone and by both, and the fewest hops that make it possible
    #[arg(long)]
    pub(crate) alternatives: bool,
    #[command(flatten)]
    pub(crate) trajectory: TrajectoryArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) prove: ProveArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) size: SizeArgs,
    #[command(flatten)]
    pub(crate) roadmap: RoadmapArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

impl PlanArgs {
    /// The first hop of the picture of postures, on a path of so many hops.
    pub(crate) fn first_posture(&self, hops: usize) -> Result<usize, Failure> {
        let first = self.postures_from as usize;
        if hops > 0 && first > hops {
            return Err(Failure::message(format!("--postures-from: found {first}, expected a hop of the path, 1 to {hops}")));
        }
        Ok(first)
    }

    /// Refuses what is about facets alone: a roadmap, and the postures of a robot with legs.
    pub(crate) fn refuse_of_facets(&self) -> Result<(), Failure> {
        self.roadmap.refuse()?;
        self.refuse_postures()
    }

    /// Refuses the postures of a hopper without legs.
    pub(crate) fn refuse_postures(&self) -> Result<(), Failure> {
        if self.plot_postures.is_some() {
            let text = "--plot-postures: found this option, which draws the trunk and the limbs of a robot, and the scenario names none, expected \
                        robot.file on a free route: leave the option out, or set robot.file";
            return Err(Failure::message(text.to_owned()));
        }
        Ok(())
    }

    /// Refuses alternatives of a scenario that does not drive.
    pub(crate) fn refuse_alternatives(&self) -> Result<(), Failure> {
        if self.alternatives {
            let text = "--alternatives: found this option for a scenario that does not drive, expected [drive] with travel = \"both\" or \"drive\": \
                        leave the option out, or set drive.travel";
            return Err(Failure::message(text.to_owned()));
        }
        Ok(())
    }
}

/// The roadmap of a free route over a mesh
#[derive(Debug, ClapArgs)]
pub(crate) struct RoadmapArgs {
    /// Roadmap (JSON) of an earlier plan over the same mesh: its contacts are searched, with start and goal, and no others are drawn
    /// [default: contacts are drawn]
    #[arg(long, value_name = "FILE")]
    pub(crate) roadmap: Option<PathBuf>,
    /// Roadmap of a plan over a mesh (JSON) to write, for later plans with --roadmap [default: none]
    #[arg(long, value_name = "FILE")]
    pub(crate) roadmap_output: Option<PathBuf>,
}

impl RoadmapArgs {
    /// Refuses both where the terrain is no mesh.
    pub(crate) fn refuse(&self) -> Result<(), Failure> {
        let given = [("--roadmap", &self.roadmap), ("--roadmap-output", &self.roadmap_output)];
        match given.into_iter().find(|(_, file)| file.is_some()) {
            Some((option, _)) => Err(Failure::message(format!(
                "{option}: found this option, which is for free routes over a mesh, and this terrain is not a mesh: leave the option out"
            ))),
            None => Ok(()),
        }
    }
}

/// Fly the planned path many times under the errors of [uncertainty]: success rate, scatter of the landings, outcomes
#[derive(Debug, ClapArgs)]
#[command(group = clap::ArgGroup::new("rests").args(["density", "plot_density"]).multiple(true))]
#[command(after_help = "Example:\n  chta simulate data/scenarios/rolling_surely.toml --trials 500 --compare")]
pub(crate) struct SimulateArgs {
    #[command(flatten)]
    pub(crate) journey: JourneyArgs,
    /// Plan the scenario of a result (JSON) anew [default: its path is flown as it stands]
    #[arg(long)]
    pub(crate) plan_anew: bool,
    /// How many trials at most [default: the scenario's, or 10000]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) trials: Option<i64>,
    /// Seed of all random draws; those of a trial depend only on the seed and the trial's number [default: the scenario's, or 0]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: Option<i64>,
    /// open-loop: the planned commands, wherever the robot is; replan: the best next hop after every landing, by
    /// search.risk and search.effort [default: the scenario's]
    #[arg(long, value_name = "POLICY")]
    pub(crate) policy: Option<String>,
    /// Both policies on the same draws
    #[arg(long)]
    pub(crate) compare: bool,
    /// Stop once the success rate's 95 % interval is at most 2 W wide; checked every 1000 trials [default: fly all trials]
    #[arg(long, value_name = "W", allow_negative_numbers = true)]
    pub(crate) until_half_width: Option<f64>,
    /// Number of the first trial: ranges of trials can be flown apart, and their tallies merge to that of all
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = trial_number, conflicts_with = "experiment", allow_negative_numbers = true)]
    pub(crate) first_trial: u64,
    /// Success to be shown: exit status 1 where the lower end of the 95 % interval is below it [default: none]
    #[arg(long, value_name = "P", value_parser = success_share, conflicts_with = "experiment", allow_negative_numbers = true)]
    pub(crate) success_min: Option<f64>,
    /// Tally of the trials (JSON) to write, which the library merges with those of other ranges [default: none]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["experiment", "compare"])]
    pub(crate) tally: Option<PathBuf>,
    /// Tallies (JSON) of ranges that were flown apart with --first-trial, --trials and --tally, in place of flying: together all trials
    /// of the run, whose answer is written as if they had been flown at once [default: none]
    #[arg(
        long, value_name = "FILE", num_args = 1..,
        conflicts_with_all = [
            "experiment", "compare", "until_half_width", "output", "plot", "plot_map", "density", "plot_density", "trajectory", "plan_anew"
        ]
    )]
    pub(crate) merge: Vec<PathBuf>,
    /// Experiment to run instead: worst-drift (the paper's), cone-width (the paper's claim), sensitivity (what each error
    /// costs) [default: none]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["compare", "until_half_width"])]
    pub(crate) experiment: Option<String>,
    /// How worst-drift interprets the paper: noise-at-landing, noise-in-flight, farthest-from-goal [default: noise-at-landing]
    #[arg(long, value_name = "NAME", requires = "experiment")]
    pub(crate) reading: Option<String>,
    /// One row per landing, .csv or .parquet; -: CSV to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// The errors that were drawn for each hop, beside its landing
    #[arg(long, requires = "output")]
    pub(crate) draws: bool,
    /// Pictures of the trials (SVG or PNG), each on a page of A4: trajectories, landing errors, outcomes with the success rate; page 2 of FILE.svg is FILE-2.svg
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Picture of the landings on the map (SVG or PNG), with 95 % ellipses, for a DEM
    #[arg(long, value_name = "FILE", conflicts_with = "experiment")]
    pub(crate) plot_map: Option<PathBuf>,
    /// Raster (GeoTIFF) of the share of trials that end in the cell of each post of a DEM, and in further bands of those that rest there
    /// after each planned hop
    #[arg(long, value_name = "FILE", conflicts_with_all = ["experiment", "compare"])]
    pub(crate) density: Option<PathBuf>,
    /// Picture (SVG or PNG) of the share of trials that end in the cell of each post of a DEM, in bands, with the area of --within
    #[arg(long, value_name = "FILE", conflicts_with_all = ["experiment", "compare"])]
    pub(crate) plot_density: Option<PathBuf>,
    /// Area (GeoJSON polygons or mask on the map) whose share of the trials' ends is stated, beside --density or --plot-density [default:
    /// none]
    #[arg(long, value_name = "FILE", requires = "rests")]
    pub(crate) within: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) trajectory: TrajectoryArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// The least capability with which the goal can be reached, between a value proved insufficient and a value with a path
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta require data/scenarios/simple_reduced.toml --vary hopper.takeoff_speed_max_m_s")]
pub(crate) struct RequireArgs {
    #[command(flatten)]
    pub(crate) journey: JourneyArgs,
    /// Scenario key to vary, such as `hopper.takeoff_speed_max_m_s`
    #[arg(long, value_name = "TABLE.KEY")]
    pub(crate) vary: String,
    /// Least value to try, in the key's unit [default: by key]
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    pub(crate) from: Option<f64>,
    /// Greatest value to try, in the key's unit [default: by key]
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    pub(crate) to: Option<f64>,
    /// Success wanted, 0 to 1: the least value whose success, estimated by 512 fixed trials, is at least P; also keys of
    /// `[uncertainty]` and `[derating]` can then be varied [default: the scenario's `budget.estimated_success_min`, else any]
    #[arg(long, value_name = "P", allow_negative_numbers = true)]
    pub(crate) success_min: Option<f64>,
    /// Most hops: the least value with a path within these budgets [default: the scenario's `budget.hops_max`, else any]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) hops_max: Option<i64>,
    /// Longest mission, from the first preparation to the last landing [default: the scenario's `budget.mission_time_max_s`, else any]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) mission_time_max_s: Option<f64>,
    /// Most energy per unit mass, from the store [default: the scenario's `budget.energy_max_j_kg`, else any]
    #[arg(long, value_name = "J", allow_negative_numbers = true)]
    pub(crate) energy_max_j_kg: Option<f64>,
    /// Most delta-v [default: the scenario's `budget.delta_v_max_m_s`, else any]
    #[arg(long, value_name = "DV", allow_negative_numbers = true)]
    pub(crate) delta_v_max_m_s: Option<f64>,
    /// How close to bring the two values, as a fraction of them
    #[arg(long, value_name = "SHARE", default_value_t = 0.001, allow_negative_numbers = true)]
    pub(crate) resolution: f64,
    /// Greatest number of cells that the chain is divided into at each value
    #[arg(long, value_name = "CELLS", alias = "budget", default_value_t = DEFAULT_BUDGET_CELLS / 5, value_parser = cell_count, allow_negative_numbers = true)]
    pub(crate) prove_cells_max: usize,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Vary one or two scenario keys: the fewest hops, or no path, for every value or pair of values
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta trade data/scenarios/simple_reduced.toml --vary hopper.takeoff_speed_max_m_s=2:6:9")]
pub(crate) struct TradeArgs {
    #[command(flatten)]
    pub(crate) journey: JourneyArgs,
    /// Scenario key that takes STEPS values from FROM to TO, both included; given twice: a grid; of a robot with legs, robot.cone or robot.file with a
    /// list [example: `--vary hopper.takeoff_speed_max_m_s=4:10:7`]
    #[arg(long, value_name = "TABLE.KEY=FROM:TO:STEPS", required = true)]
    pub(crate) vary: Vec<String>,
    /// Rows to write, as .csv or .json by the file's extension; -: CSV to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// End with exit status 1 where a cell has no path or fails
    #[arg(long)]
    pub(crate) require_all: bool,
    /// Picture (SVG or PNG) to write: a heat map with the number of every cell
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) prove: ProveArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Several scenarios side by side: verdict, hops, totals, least margins, and their paths in one picture
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta compare data/scenarios/simple.toml data/scenarios/simple_reduced.toml")]
pub(crate) struct CompareArgs {
    /// Scenarios (TOML) or results (JSON), two or more
    #[arg(value_name = "SCENARIO", required = true, num_args = 2..)]
    pub(crate) scenarios: Vec<PathBuf>,
    /// Table to write, as .csv or .json by the file's extension; -: CSV to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// End with exit status 1 where a scenario has no path or fails
    #[arg(long)]
    pub(crate) require_all: bool,
    /// Picture (SVG or PNG) to write: all paths overlaid
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) prove: ProveArgs,
    /// Set any scenario key in all of them; overrides the scenarios [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Accept a map whose scale along the transect is off by over 1 %, with its distances unchanged
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

impl RequireArgs {
    /// The scenario keys set by options of their own.
    pub(crate) fn own_keys(&self) -> Vec<OwnKey<'static>> {
        let number = |option, name, value: Option<f64>| value.map(|value| (option, "budget", name, value.into()));
        [
            number("--success-min", "estimated_success_min", self.success_min),
            self.hops_max.map(|most| ("--hops-max", "budget", "hops_max", most.into())),
            number("--mission-time-max-s", "mission_time_max_s", self.mission_time_max_s),
            number("--energy-max-j-kg", "energy_max_j_kg", self.energy_max_j_kg),
            number("--delta-v-max-m-s", "delta_v_max_m_s", self.delta_v_max_m_s),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl PlanArgs {
    /// The front by its amounts.
    pub(crate) fn front(&self) -> Result<Option<Front>, Failure> {
        let Some(given) = self.front.as_deref() else { return Ok(None) };
        let found = Front::named(given);
        let possible = || Front::all().map(Front::name).collect::<Vec<_>>().join(" or ");
        let none = || {
            Failure::message(format!(
                "--front: found '{given}', expected {} or hops,layer:NAME: hops first, then one amount",
                possible()
            ))
        };
        found.ok_or_else(none).map(Some)
    }
}

impl SimulateArgs {
    /// The scenario keys set by the options of trials; they are checked and written as keys of the scenario.
    pub(crate) fn own_keys(&self) -> Vec<OwnKey<'static>> {
        let trials = self.trials.map(|trials| ("--trials", "uncertainty", "trials", trials.into()));
        let seed = self.seed.map(|seed| ("--seed", "uncertainty", "seed", seed.into()));
        let policy = self.policy.clone().map(|policy| ("--policy", "uncertainty", "policy", policy.into()));
        [trials, seed, policy].into_iter().flatten().collect()
    }

    /// What is wanted beyond the keys of the scenario.
    pub(crate) const fn options(&self) -> SimulateOptions {
        SimulateOptions {
            compare: self.compare,
            until_half_width: self.until_half_width,
            first_trial: self.first_trial,
            success_min: self.success_min,
            tally: self.tally.is_some(),
        }
    }

    /// Whether the landings go to standard output, in place of the answer.
    pub(crate) fn lands_on_stdout(&self) -> bool {
        self.output.as_deref() == Some(Path::new("-"))
    }

    /// Checks the width at which trials end.
    pub(crate) fn check_half_width(&self) -> Result<(), Failure> {
        if let Some(half_width) = self.until_half_width.filter(|half_width| !(*half_width > 0.0 && *half_width < 0.5)) {
            return Err(Failure::message(format!(
                "--until-half-width is {half_width}, expected a number above 0 and below 0.5: 0.01 stops at a rate known to one in a hundred"
            )));
        }
        Ok(())
    }

    /// Checks the raster of where trials rest.
    pub(crate) fn check_density(&self) -> Result<(), Failure> {
        density::check_raster(self)
    }

    /// Checks the options of trials.
    pub(crate) fn check(&self, case: &Case) -> Result<(), Failure> {
        self.check_half_width()?;
        if self.plot_map.is_some() && !case.is_on_dem() {
            return Err(Failure::message("--plot-map: the landings lie on no DEM; give the scenario [terrain] dem, or use --plot"));
        }
        density::check(self, case)?;
        Ok(())
    }

    /// The experiment by its name and how it interprets the paper, once no option without effect on it is given.
    pub(crate) fn experiment(&self, name: &str) -> Result<(Experiment, DriftReading), Failure> {
        if self.trajectory.trajectory.is_some() {
            let message =
                format!("--trajectory: the experiment {name} flies no nominal path: omit one of --trajectory and --experiment");
            return Err(Failure::message(message));
        }
        if name == "risk-trade" {
            // Its name of old.
            return Err(Failure::message(
                "--experiment risk-trade is now chta plan --front hops,risk: give that command, expected here worst-drift or cone-width",
            ));
        }
        let experiment = named(&Experiment::ALL, Experiment::name, name, "--experiment")?;
        let reading = self.reading.as_deref().map(|reading| named(&DriftReading::ALL, DriftReading::name, reading, "--reading"));
        let reading = reading.transpose()?.unwrap_or_default();
        let flies = experiment.flies_trials();
        let without_effect = [
            ("--output", self.output.is_some()),
            ("--reading", self.reading.is_some() && experiment != Experiment::WorstDrift),
            ("--trials", self.trials.is_some() && !flies),
            ("--policy", self.policy.is_some() && !flies),
            ("--threads", self.answer.threads != 0 && !flies),
        ];
        match without_effect.into_iter().find(|(_, given)| *given) {
            Some((option, _)) => {
                Err(Failure::message(format!("{option} has no effect on the experiment {}: omit it", experiment.name())))
            }
            None => Ok((experiment, reading)),
        }
    }
}

/// The variant with this name, or an error that suggests the nearest.
fn named<T: Copy>(all: &[T], name: fn(T) -> &'static str, given: &str, option: &str) -> Result<T, Failure> {
    all.iter().copied().find(|variant| name(*variant) == given).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|variant| name(*variant)).collect();
        let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(given, known)).copied().unwrap_or_default();
        Failure::message(format!("{option}: '{given}' is unknown, expected one of {}; the nearest is {near}", names.join(", ")))
    })
}
