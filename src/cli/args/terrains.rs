//! The options of the commands that read or generate terrain.

use std::path::PathBuf;

use chta::{
    quantity::MapPoint,
    terrain::{LonLat, NoDataRule},
};
use clap::{Args as ClapArgs, ValueEnum};

use super::{DEFAULT_MAX_GIB, lon_lat, map_point, max_gib, no_data_rule};

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
