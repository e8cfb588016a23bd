//! The options of the commands that read or generate terrain.

use std::path::PathBuf;

use chta::{
    quantity::MapPoint,
    terrain::{LonLat, NoDataRule},
};
use clap::{Args as ClapArgs, ValueEnum};

use super::{AnswerArgs, CommonArgs, DEFAULT_MAX_GIB, SearchArgs, lon_lat, map_point, max_gib, no_data_rule};

/// Cut terrain along a vertical plane into a polygonal chain (CSV)
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta slice data/terrain/mars_crater_field.tif --from 12,12 --to 180,150 -o chain.csv")]
pub(crate) struct SliceArgs {
    /// Elevation raster (GeoTIFF or ESRI ASCII grid, map in metres) or mesh (OBJ, STL or PLY, z up); -: standard input
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
    /// Intermediate point, map coordinates in m, where the slice bends; may be repeated, in the order of travel [default: none]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true)]
    pub(crate) via: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "via")]
    pub(crate) via_lonlat: Vec<LonLat>,
    /// Scenario whose friction and keep-out zones go into the chain
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<PathBuf>,
    /// Accept a map whose scale along the transect is off by over 1 %, with its distances unchanged
    #[arg(long)]
    pub(crate) accept_map_scale: bool,
    /// Stored number that marks missing elevations, or none: all numbers are elevations [default: as the file states]
    #[arg(long, value_name = "VALUE|none", value_parser = no_data_rule, allow_negative_numbers = true)]
    pub(crate) no_data: Option<NoDataRule>,
    /// Chain CSV to write; - or absent: standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// The slice as a line in three dimensions (GeoJSON) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) geojson: Option<PathBuf>,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Slices in all directions from one point: how far and in how few hops one gets in each
#[derive(Debug, ClapArgs)]
#[command(
    after_help = "Example:\n  chta fan data/terrain/mars_crater_field.tif --from 100,80 --headings 36 --length 80 \\\n    --scenario data/scenarios/mars_crater_field.toml --plot rose.svg"
)]
pub(crate) struct FanArgs {
    /// Elevation raster: GeoTIFF or ESRI ASCII grid, map in metres; -: standard input
    #[arg(value_name = "DEM")]
    pub(crate) dem: PathBuf,
    /// Where all slices begin, map coordinates in m
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, required_unless_present = "from_lonlat")]
    pub(crate) from: Option<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "from")]
    pub(crate) from_lonlat: Option<LonLat>,
    /// Number of slices, equally spaced clockwise from grid north
    #[arg(long, value_name = "N", default_value_t = 36)]
    pub(crate) headings: u32,
    /// Length of each slice, m; the map's border and no-data shorten it
    #[arg(long, value_name = "L", allow_negative_numbers = true)]
    pub(crate) length: f64,
    /// Table (CSV) to write; -: to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Rose picture (SVG or PNG) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Fewest hops from one post of a DEM to every other, in any direction
///
/// Every edge is one hop on the exact slice between two posts, as `chta slice` and `chta hop` find it. The terrain keys of
/// --scenario (dem, mesh or chain, start, goal, intermediate points) are ignored: DEM, --start and --goal replace them.
#[derive(Debug, ClapArgs)]
#[command(
    after_help = "Example:\n  chta map data/terrain/lunar_rille.tif --start 60,60 --scenario data/scenarios/lunar_rille.toml"
)]
pub(crate) struct MapArgs {
    /// Elevation raster: GeoTIFF or ESRI ASCII grid, map in metres; -: standard input
    #[arg(value_name = "DEM")]
    pub(crate) dem: PathBuf,
    /// Start of all paths, map coordinates in m; the nearest post is used
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, required_unless_present = "start_lonlat")]
    pub(crate) start: Option<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "start")]
    pub(crate) start_lonlat: Option<LonLat>,
    /// Goal, map coordinates in m; the nearest post is used; may be repeated [default: none]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, group = "goals")]
    pub(crate) goal: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "goal", group = "goals")]
    pub(crate) goal_lonlat: Vec<LonLat>,
    /// Land only on every N-th post; hops are always tested against the full DEM
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    pub(crate) stride: u32,
    /// Also least effort among paths of fewest hops: takeoff-speed, energy, time, peak-speed [default: none; alone: the scenario's]
    #[arg(long, value_name = "EFFORT", num_args = 0..=1)]
    #[expect(clippy::option_option, reason = "absent, given alone, or with a value")]
    pub(crate) effort: Option<Option<String>>,
    /// Also find the posts from which the start can be reached again
    #[arg(long = "return")]
    pub(crate) back: bool,
    /// Hops (GeoTIFF) to write: int16, -1 unreachable, -32768 no-data
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Least effort (GeoTIFF) to write: float32, NaN where there is no path
    #[arg(long, value_name = "FILE", requires = "effort")]
    pub(crate) effort_output: Option<PathBuf>,
    /// Hops back to the start (GeoTIFF) to write
    #[arg(long, value_name = "FILE", requires = "back")]
    pub(crate) return_output: Option<PathBuf>,
    /// Mobility (GeoTIFF) to write: the share of the posts within v^2/g of a post, v the smaller speed limit, that one hop from it
    /// reaches, and in how many of 16 directions
    #[arg(long, value_name = "FILE")]
    pub(crate) mobility: Option<PathBuf>,
    /// Also fly the path to every goal many times under the errors of `[uncertainty]`, in three dimensions, open loop
    #[arg(long, requires = "goals")]
    pub(crate) simulate: bool,
    /// Hops to every goal (CSV) to write
    #[arg(long, value_name = "FILE", requires = "goals")]
    pub(crate) paths: Option<PathBuf>,
    /// The same in three dimensions (GeoJSON)
    #[arg(long, value_name = "FILE", requires = "goals")]
    pub(crate) geojson: Option<PathBuf>,
    /// Profile of every hop to every goal, all on one sheet (SVG or PNG), to write
    #[arg(long, value_name = "FILE", requires = "goals")]
    pub(crate) profiles: Option<PathBuf>,
    /// Map picture (SVG or PNG) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Generate terrain from a seed: fractal ground, craters, a rille, boulders
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
    /// Direction in which the plane rises, degrees clockwise from grid north
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
    /// Smallest crater, m [default: 4, or the post spacing if that is greater]
    #[arg(long, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_diameter_min_m: Option<f64>,
    /// Largest crater, m [default: 60, or as the map and the smallest crater allow]
    #[arg(long, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_diameter_max_m: Option<f64>,
    /// Craters per square kilometre [default: 1500; fewer where the post spacing leaves out small ones]
    #[arg(long, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_density_per_km2: Option<f64>,
    /// Exponent of the cumulative counts: 3 young, 2 in equilibrium
    #[arg(long, default_value_t = 2.5, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_power_law_exponent: f64,
    /// Depth of fresh craters by diameter: moon (Pike 1977) or mars (Robbins and Hynek 2012)
    #[arg(long, value_enum, default_value = "moon", requires = "craters")]
    pub(crate) crater_depth_law: DepthLawArg,
    /// Degradation of craters, 0: all fresh; 1: some completely eroded
    #[arg(long, default_value_t = 0.8, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_degradation_max: f64,
    /// With a sinuous rille from west to east
    #[arg(long)]
    pub(crate) rille: bool,
    /// Width of the rille between its upper edges, m [default: 80, or the post spacing if that is greater]
    #[arg(long, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_width_m: Option<f64>,
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
    /// Smallest boulder, m [default: 1, or the post spacing if that is greater]
    #[arg(long, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_diameter_min_m: Option<f64>,
    /// Largest boulder, m [default: 4, or the smallest boulder if that is greater]
    #[arg(long, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_diameter_max_m: Option<f64>,
    /// Share of a boulder's radius below ground
    #[arg(long, default_value_t = 0.2, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_burial: f64,
}

/// Depth law of fresh craters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DepthLawArg {
    /// Pike 1977.
    Moon,
    /// Robbins and Hynek 2012.
    Mars,
}
