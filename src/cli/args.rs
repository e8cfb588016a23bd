//! The command line as typed.

use std::path::PathBuf;

use chta::{graph::proof::DEFAULT_BUDGET_CELLS, quantity::MapPoint, terrain::LonLat};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

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
}

/// How a result is written to standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For reading.
    Text,
    /// One document, for scripts.
    Json,
}

/// What all analyses take.
#[derive(Clone, Debug, ClapArgs)]
pub(crate) struct CommonArgs {
    /// Scenario (TOML) with body, hopper, surface and search
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<PathBuf>,
    /// Set any scenario key; wins over the scenario [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Known body, which gives gravity and radius (`chta bodies` lists them)
    #[arg(long, value_name = "NAME")]
    pub(crate) body: Option<String>,
    /// Gravity, m/s^2
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    pub(crate) gravity_m_s2: Option<f64>,
    /// Height to keep over every vertex flown past, m [default: 0]
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    pub(crate) clearance_m: Option<f64>,
    /// Take distances of a map whose scale along the transect is off by over 1 % as they are
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What searches take.
#[derive(Debug, ClapArgs)]
pub(crate) struct SearchArgs {
    /// Points inside each segment, or auto: the first of 0, 1, 2, 3, 7, 15, 31 that finds a path [default: auto]
    #[arg(long, value_name = "K|auto", allow_negative_numbers = true)]
    pub(crate) points_per_segment: Option<String>,
    /// Instead: as many points as keep neighbours this close along the ground, m [default: by points per segment]
    #[arg(long, value_name = "D", conflicts_with = "points_per_segment", allow_negative_numbers = true)]
    pub(crate) node_spacing_max_m: Option<f64>,
    /// Second criterion after hops: takeoff-speed, energy, time, peak-speed [default: takeoff-speed]
    #[arg(long, value_name = "EFFORT")]
    pub(crate) effort: Option<String>,
}

/// What a proof takes.
#[derive(Clone, Copy, Debug, ClapArgs)]
pub(crate) struct ProveArgs {
    /// Bound the fewest hops from both sides, for every choice of points: "untraversable" is said where it is proved
    #[arg(long)]
    pub(crate) prove: bool,
    /// The most cells that the chain is cut into for the proof
    #[arg(long, value_name = "CELLS", default_value_t = DEFAULT_BUDGET_CELLS, value_parser = cell_count, requires = "prove", allow_negative_numbers = true)]
    pub(crate) budget: usize,
}

/// Do everything a scenario asks for: chain.csv, path.csv, path.geojson (on a map), result.json and path.svg
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta run data/scenarios/mars_crater_field.toml -o out")]
pub(crate) struct RunArgs {
    /// Scenario (TOML), or a result.json to repeat
    #[arg(value_name = "SCENARIO")]
    pub(crate) scenario: PathBuf,
    /// Folder for the results, made where it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written to standard output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    /// Set any scenario key; wins over the scenario [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Take distances of a map whose scale along the transect is off by over 1 % as they are
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Cut terrain along a vertical plane into a polygonal chain (CSV)
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta slice data/terrain/mars_crater_field.tif --from 12,12 --to 180,150 -o chain.csv")]
pub(crate) struct SliceArgs {
    /// Elevation raster (GeoTIFF or ESRI ASCII grid, map in metres) or mesh (OBJ, STL or PLY, z up)
    #[arg(value_name = "DEM|MESH")]
    pub(crate) terrain: PathBuf,
    /// Where the slice begins, map coordinates in m
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, required_unless_present = "from_lonlat")]
    pub(crate) from: Option<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "from")]
    pub(crate) from_lonlat: Option<LonLat>,
    /// Where it ends, map coordinates in m
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, required_unless_present = "to_lonlat")]
    pub(crate) to: Option<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "to")]
    pub(crate) to_lonlat: Option<LonLat>,
    /// Metres per unit of the mesh: 1000 for one in kilometres [default: 1]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) mesh_scale: Option<f64>,
    /// A point between, map coordinates in m, where the slice bends; may be repeated, in the order of travel [default: none]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true)]
    pub(crate) via: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "via")]
    pub(crate) via_lonlat: Vec<LonLat>,
    /// Scenario whose friction and keep-out zones go into the chain
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<PathBuf>,
    /// Take distances of a map whose scale along the transect is off by over 1 % as they are
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// Chain CSV to write; - or absent: standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// The slice as a line in three dimensions (GeoJSON) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) geojson: Option<PathBuf>,
    /// No warnings on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Slices in all directions from one point: how far and in how few hops one gets in each
///
/// Without --points-per-segment, and with auto, each segment has 1 point.
#[derive(Debug, ClapArgs)]
#[command(
    after_help = "Example:\n  chta fan data/terrain/mars_crater_field.tif --from 100,80 --headings 36 --length 80 \\\n    --scenario data/scenarios/mars_crater_field.toml --plot rose.svg"
)]
pub(crate) struct FanArgs {
    /// Elevation raster: GeoTIFF or ESRI ASCII grid, map in metres
    #[arg(value_name = "DEM")]
    pub(crate) dem: PathBuf,
    /// Where all slices begin, map coordinates in m
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, required_unless_present = "from_lonlat")]
    pub(crate) from: Option<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "from")]
    pub(crate) from_lonlat: Option<LonLat>,
    /// How many, equally spaced clockwise from grid north
    #[arg(long, value_name = "N", default_value_t = 36)]
    pub(crate) headings: u32,
    /// How long each is, m; the map's border and no-data cut it
    #[arg(long, value_name = "L", allow_negative_numbers = true)]
    pub(crate) length: f64,
    /// Table (CSV) to write; -: to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Rose picture (SVG) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Fewest hops from one post of a DEM to every other, in any direction
///
/// Every edge is one hop on the exact slice between two posts, as `chta slice` and `chta hop` find it.
#[derive(Debug, ClapArgs)]
#[command(
    after_help = "Example:\n  chta map data/terrain/lunar_rille.tif --start 60,60 --scenario data/scenarios/lunar_rille.toml"
)]
pub(crate) struct MapArgs {
    /// Elevation raster: GeoTIFF or ESRI ASCII grid, map in metres
    #[arg(value_name = "DEM")]
    pub(crate) dem: PathBuf,
    /// Where all hops start, map coordinates in m; the nearest post counts
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, required_unless_present = "start_lonlat")]
    pub(crate) start: Option<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "start")]
    pub(crate) start_lonlat: Option<LonLat>,
    /// A place to get to, map coordinates in m; may be repeated [default: none]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, group = "goals")]
    pub(crate) goal: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "goal", group = "goals")]
    pub(crate) goal_lonlat: Vec<LonLat>,
    /// Land only on every N-th post; the terrain in the way is always the full DEM
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    pub(crate) stride: u32,
    /// Also the least effort among fewest hops: takeoff-speed, energy, time, peak-speed [default: not asked; alone: the scenario's]
    #[arg(long, value_name = "EFFORT", num_args = 0..=1)]
    #[expect(clippy::option_option, reason = "absent, given alone, or with a value")]
    pub(crate) effort: Option<Option<String>>,
    /// Also from which posts the start can be reached again
    #[arg(long = "return")]
    pub(crate) back: bool,
    /// Hops (GeoTIFF) to write: int16, -1 unreachable, -32768 no-data
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Least effort (GeoTIFF) to write: float32, NaN where there is no way
    #[arg(long, value_name = "FILE", requires = "effort")]
    pub(crate) effort_output: Option<PathBuf>,
    /// Hops back to the start (GeoTIFF) to write
    #[arg(long, value_name = "FILE", requires = "back")]
    pub(crate) return_output: Option<PathBuf>,
    /// Mobility (GeoTIFF) to work out and write: share of its reach disc that one hop from each post reaches, and in how many of 16 directions
    #[arg(long, value_name = "FILE")]
    pub(crate) mobility: Option<PathBuf>,
    /// Hops to every goal (CSV) to write
    #[arg(long, value_name = "FILE", requires = "goals")]
    pub(crate) paths: Option<PathBuf>,
    /// The same in three dimensions (GeoJSON)
    #[arg(long, value_name = "FILE", requires = "goals")]
    pub(crate) geojson: Option<PathBuf>,
    /// Profile of every hop to every goal, one picture below the other (SVG), to write
    #[arg(long, value_name = "FILE", requires = "goals")]
    pub(crate) profiles: Option<PathBuf>,
    /// Map picture (SVG or PNG) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Test one hop: every limit by itself, what sets either end of the feasible take-off angles, or which two conflict
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta hop data/scenarios/paper_76m.toml --from 0 --to 20 --format json")]
pub(crate) struct HopArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON)
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Where the hop takes off, along the chain, m [default: the scenario's start]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) from: Option<f64>,
    /// Where it lands, along the chain, m [default: the scenario's goal]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) to: Option<f64>,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Does a path exist, and in how few hops
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta check data/scenarios/simple_reduced.toml --points-per-segment 2")]
pub(crate) struct CheckArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON)
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) start: Option<f64>,
    /// Goal along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) goal: Option<f64>,
    /// Many questions at once: CSV with `start_x_m,goal_x_m`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["start", "goal"])]
    pub(crate) pairs: Option<PathBuf>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    /// Picture (SVG or PNG) to write of what is proved of each stretch of the chain
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
    /// Chain (CSV), scenario (TOML) or result (JSON)
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) start: Option<f64>,
    /// Goal along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) goal: Option<f64>,
    /// Path CSV to write; -: to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Path in three dimensions (GeoJSON) to write, for a chain on a map
    #[arg(long, value_name = "FILE")]
    pub(crate) geojson: Option<PathBuf>,
    /// Picture (SVG) to write, also where there is no path
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Fly the path again by direct simulation and judge every limit
    #[arg(long)]
    pub(crate) verify: bool,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) prove: ProveArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Fly the planned path many times under the errors of [uncertainty]: how surely, where the landings scatter, how trials end
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta simulate data/scenarios/rolling_surely.toml --trials 500 --compare")]
pub(crate) struct SimulateArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON)
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) start: Option<f64>,
    /// Goal along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) goal: Option<f64>,
    /// How many trials at most [default: the scenario's, or 10000]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) trials: Option<i64>,
    /// Seed of all draws; a trial's depend on it and on the trial's number alone [default: the scenario's, or 0]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: Option<i64>,
    /// open-loop: planned commands from wherever it is; replan: the best next hop after every landing [default: the scenario's]
    #[arg(long, value_name = "POLICY")]
    pub(crate) policy: Option<String>,
    /// Both policies on the same draws
    #[arg(long)]
    pub(crate) compare: bool,
    /// Stop once half the 95 % interval of the success rate is no wider; asked after every 1000 trials [default: fly all trials]
    #[arg(long, value_name = "W", allow_negative_numbers = true)]
    pub(crate) until_half_width: Option<f64>,
    /// Instead: worst-drift (the paper's), cone-width (its claim), risk-trade (what hops buy in surety) [default: none]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["compare", "until_half_width"])]
    pub(crate) experiment: Option<String>,
    /// How worst-drift reads the paper: noise-at-landing, noise-in-flight, farthest-from-goal [default: noise-at-landing]
    #[arg(long, value_name = "NAME", requires = "experiment")]
    pub(crate) reading: Option<String>,
    /// One row per landing, .csv or .parquet; -: CSV to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Picture of the trials (SVG): trajectories, landing errors, outcomes, convergence
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Picture of the landings on the map (SVG), with 95 % ellipses, for a DEM
    #[arg(long, value_name = "FILE", conflicts_with = "experiment")]
    pub(crate) plot_map: Option<PathBuf>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// The least capability with which the goal can be reached, between a value proved too little and one with a path
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta require data/scenarios/simple_reduced.toml --vary hopper.takeoff_speed_max_m_s")]
pub(crate) struct RequireArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON)
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) start: Option<f64>,
    /// Goal along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) goal: Option<f64>,
    /// Scenario key to vary, such as `hopper.takeoff_speed_max_m_s`
    #[arg(long, value_name = "TABLE.KEY")]
    pub(crate) vary: String,
    /// Least value to try, in the key's unit [default: by key]
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    pub(crate) from: Option<f64>,
    /// Greatest value to try, in the key's unit [default: by key]
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    pub(crate) to: Option<f64>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How close to bring the two values, as a share of them
    #[arg(long, value_name = "SHARE", default_value_t = 0.001, allow_negative_numbers = true)]
    pub(crate) resolution: f64,
    /// The most cells that the chain is cut into at each value
    #[arg(long, value_name = "CELLS", default_value_t = DEFAULT_BUDGET_CELLS / 5, value_parser = cell_count, allow_negative_numbers = true)]
    pub(crate) budget: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// One or two keys of the scenario varied: the fewest hops, or that there is no path, for every value or pair of values
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta trade data/scenarios/simple_reduced.toml --vary hopper.takeoff_speed_max_m_s=2:6:9")]
pub(crate) struct TradeArgs {
    /// Chain (CSV), scenario (TOML) or result (JSON)
    #[arg(value_name = "CHAIN")]
    pub(crate) chain: PathBuf,
    /// Start along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) start: Option<f64>,
    /// Goal along the chain, m [default: the scenario's]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) goal: Option<f64>,
    /// Scenario key that takes STEPS values from FROM to TO, both included; given twice: a grid [example: `--vary
    /// hopper.takeoff_speed_max_m_s=4:10:7`]
    #[arg(long, value_name = "TABLE.KEY=FROM:TO:STEPS", required = true)]
    pub(crate) vary: Vec<String>,
    /// Rows to write, .csv or .json by its name; -: CSV to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Picture to write (.svg or .png): a heat map with every field's number
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
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
    /// Table to write, .csv or .json by its name; -: CSV to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Picture to write (.svg or .png): all paths overlaid
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Threads to work with; the answer does not depend on it [default: one for each core]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) threads: usize,
    /// How the answer is written
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) prove: ProveArgs,
    /// Set any scenario key in all of them; wins over the scenarios [example: `--set hopper.takeoff_speed_max_m_s=8`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Take distances of a map whose scale along the transect is off by over 1 % as they are
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// No warnings and no progress on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Make terrain up from a seed: fractal ground, craters, a rille, boulders
///
/// The same options give the same bytes on every machine.
#[derive(Debug, ClapArgs)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
#[command(after_help = "Example:\n  chta synth --rows 200 --cols 200 --craters --crater-density-per-km2 2000 --seed 7 -o moon.tif")]
pub(crate) struct SynthArgs {
    /// Elevation raster to write: .tif (GeoTIFF) or .asc (ESRI ASCII grid)
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Rows of posts
    #[arg(long, default_value_t = 257, allow_negative_numbers = true)]
    pub(crate) rows: usize,
    /// Columns of posts
    #[arg(long, default_value_t = 257, allow_negative_numbers = true)]
    pub(crate) cols: usize,
    /// Spacing of posts, m
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) spacing_m: f64,
    /// Map coordinates of the south-west post, m
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, default_value = "0,0")]
    pub(crate) south_west_m: MapPoint,
    /// Elevation at the middle of the map, m
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) mean_elevation_m: f64,
    /// Slope of the plane under everything, degrees
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) tilt_deg: f64,
    /// Towards where it rises, degrees clockwise from grid north
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) tilt_towards_deg: f64,
    /// Without fractal ground
    #[arg(long, conflicts_with_all = ["ground_hurst", "ground_rms_m", "ground_baseline_m"])]
    pub(crate) no_ground: bool,
    /// Hurst exponent of the ground: near 0 rough at all scales, near 1 smooth close by
    #[arg(long, default_value_t = 0.8, allow_negative_numbers = true)]
    pub(crate) ground_hurst: f64,
    /// Root mean square height difference at the baseline, m
    #[arg(long, default_value_t = 0.1, allow_negative_numbers = true)]
    pub(crate) ground_rms_m: f64,
    /// The baseline, m
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) ground_baseline_m: f64,
    /// With craters
    #[arg(long)]
    pub(crate) craters: bool,
    /// Smallest crater, m
    #[arg(long, default_value_t = 4.0, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_diameter_min_m: f64,
    /// Largest crater, m
    #[arg(long, default_value_t = 60.0, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_diameter_max_m: f64,
    /// Craters per square kilometre
    #[arg(long, default_value_t = 1500.0, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_density_per_km2: f64,
    /// Exponent of the cumulative counts: 3 young, 2 in equilibrium
    #[arg(long, default_value_t = 2.5, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_power_law_exponent: f64,
    /// Depth of fresh craters by diameter: moon (Pike 1977) or mars (Robbins and Hynek 2012)
    #[arg(long, value_enum, default_value = "moon", requires = "craters")]
    pub(crate) crater_depth_law: DepthLawArg,
    /// 0: all fresh; 1: some worn to nothing
    #[arg(long, default_value_t = 0.8, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_degradation_max: f64,
    /// With a sinuous rille from west to east
    #[arg(long)]
    pub(crate) rille: bool,
    /// Width of the rille between its upper edges, m
    #[arg(long, default_value_t = 80.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_width_m: f64,
    /// Depth of the rille, m
    #[arg(long, default_value_t = 15.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_depth_m: f64,
    /// Slope of its walls, degrees
    #[arg(long, default_value_t = 28.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_wall_slope_deg: f64,
    /// Swing of its centre line, m
    #[arg(long, default_value_t = 30.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_meander_amplitude_m: f64,
    /// Length of its meanders, m
    #[arg(long, default_value_t = 300.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_meander_length_m: f64,
    /// With boulders
    #[arg(long)]
    pub(crate) boulders: bool,
    /// Share of ground covered by rocks of any size: 0.05 sparse, 0.2 rough
    #[arg(long, default_value_t = 0.1, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) rock_abundance: f64,
    /// Smallest boulder, m
    #[arg(long, default_value_t = 1.0, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_diameter_min_m: f64,
    /// Largest boulder, m
    #[arg(long, default_value_t = 4.0, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_diameter_max_m: f64,
    /// Share of a boulder's radius below ground
    #[arg(long, default_value_t = 0.2, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_burial: f64,
}

/// Whose fresh craters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DepthLawArg {
    /// Pike 1977.
    Moon,
    /// Robbins and Hynek 2012.
    Mars,
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
