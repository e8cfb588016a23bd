//! The options of the command that cuts terrain.

use std::path::PathBuf;

use chta::{
    quantity::MapPoint,
    terrain::{LonLat, NoDataRule},
};
use clap::Args as ClapArgs;

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
