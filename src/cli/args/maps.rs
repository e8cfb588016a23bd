//! The options of the commands that answer for a whole DEM, or for all directions from a point of it.

use std::path::{Path, PathBuf};

use chta::{figure::SeenFrom, planner::Amount, quantity::MapPoint, terrain::LonLat};
use clap::Args as ClapArgs;

use super::{AnswerArgs, CommonArgs, SearchArgs, lon_lat, map_point};
use crate::cli::{
    Failure,
    output::{self, Pending},
};

/// Options of commands whose answers may be large.
#[derive(Clone, Copy, Debug, ClapArgs)]
pub(crate) struct SizeArgs {
    /// Check the input and print how many posts, nodes, pairs and bytes the answer takes at most, without computing it
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Refuse what needs more memory than N MiB, before it is computed [default: no limit]
    #[arg(long, value_name = "N", value_parser = mebibytes, allow_negative_numbers = true)]
    pub(crate) memory_max_mib: Option<u64>,
}

impl SizeArgs {
    /// The most memory, bytes.
    pub(crate) fn memory_max_bytes(&self) -> Option<u64> {
        self.memory_max_mib.map(|mib| mib << 20)
    }
}

/// From where the picture of a mesh is seen.
#[derive(Clone, Copy, Debug, ClapArgs)]
pub(crate) struct ViewArgs {
    /// From where the oblique view of a mesh is: azimuth of the viewer, clockwise from north (+y), and elevation, degrees [default: 215,35]
    #[arg(long, value_name = "AZIMUTH,ELEVATION", value_parser = seen_from, allow_hyphen_values = true, requires = "plot")]
    pub(crate) seen_from: Option<SeenFrom>,
}

impl ViewArgs {
    /// The direction.
    pub(crate) fn direction(self) -> SeenFrom {
        self.seen_from.unwrap_or_default()
    }

    /// Opens the picture of other terrain than a mesh.
    pub(crate) fn begin_picture(self, plot: Option<&Path>) -> Result<Option<Pending<'_>>, Failure> {
        self.without_mesh()?;
        output::begin_picture("--plot", plot)
    }

    /// Refuses the option for a picture of other terrain.
    pub(crate) fn without_mesh(self) -> Result<(), Failure> {
        match self.seen_from {
            None => Ok(()),
            Some(_) => Err(Failure::message(
                "--seen-from: found this option, which turns the picture of a mesh with route = \"free\", and this terrain is another one: leave the \
                 option out",
            )),
        }
    }
}

/// Reads an azimuth and an elevation.
fn seen_from(text: &str) -> Result<SeenFrom, String> {
    let wanted = || {
        format!(
            "found `{text}`, expected azimuth (-360 to 360, clockwise from north) and elevation (-90 to 90) in degrees, such as 215,35"
        )
    };
    let number = |part: &str, most: f64| part.trim().parse::<f64>().ok().filter(|number| (-most..=most).contains(number));
    let (azimuth, elevation) = text.split_once(',').ok_or_else(wanted)?;
    let azimuth_deg = number(azimuth, 360.0).ok_or_else(wanted)?;
    Ok(SeenFrom { azimuth_deg, elevation_deg: number(elevation, 90.0).ok_or_else(wanted)? })
}

/// Reads a number of MiB.
fn mebibytes(text: &str) -> Result<u64, String> {
    const MOST: u64 = 1 << 32;
    let count = text.trim().parse().ok().filter(|count| (1..=MOST).contains(count));
    count.ok_or_else(|| format!("found `{text}`, expected a whole number of MiB from 1 to {MOST}, such as 4096"))
}

/// Reads a number of hops.
fn hop_count(text: &str) -> Result<i16, String> {
    let count = text.trim().parse().ok().filter(|count| *count >= 1);
    count.ok_or_else(|| format!("found `{text}`, expected a whole number of hops from 1 to {}, such as 10", i16::MAX))
}

impl MapArgs {
    /// Whether nothing is asked for but single hops from every node, which need no start.
    pub(crate) fn asks_for_single_hops(&self) -> bool {
        let of_starts = [
            self.output.is_some(),
            self.effort.is_some(),
            !self.amount_output.is_empty(),
            self.back,
            self.nearest_output.is_some(),
            self.predecessor_output.is_some(),
            self.hops_max.is_some(),
            !self.goal.is_empty(),
            !self.goal_lonlat.is_empty(),
            self.simulate,
        ];
        self.mobility.is_some() && !of_starts.contains(&true)
    }
}

/// An amount, and the file for its totals.
#[derive(Clone, Debug)]
pub(crate) struct AmountFile {
    /// The amount.
    pub(crate) amount: Amount,
    /// The file.
    pub(crate) file: PathBuf,
}

/// Reads an amount and a file.
fn amount_file(text: &str) -> Result<AmountFile, String> {
    let names = Amount::ALL.map(Amount::name).join(", ");
    let wrong = || format!("found `{text}`, expected AMOUNT=FILE, such as energy=energy.tif, with one of {names}");
    let (name, file) = text.split_once('=').filter(|(_, file)| !file.is_empty()).ok_or_else(wrong)?;
    let amount = Amount::ALL.into_iter().find(|amount| amount.name() == name.trim()).ok_or_else(wrong)?;
    Ok(AmountFile { amount, file: file.into() })
}

/// How fine the nodes of a map are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NodeSpacing {
    /// So fine that one hop over level ground spans 8 nodes or more.
    Auto,
    /// At most this far apart, m.
    AtMostM(f64),
}

impl NodeSpacing {
    /// The greatest distance of neighbours, m.
    pub(crate) const fn metres(self) -> Option<f64> {
        match self {
            Self::Auto => None,
            Self::AtMostM(spacing_m) => Some(spacing_m),
        }
    }
}

/// Reads a spacing of nodes; its range is that of the key.
pub(super) fn node_spacing(text: &str) -> Result<NodeSpacing, String> {
    match text.trim() {
        "auto" => Ok(NodeSpacing::Auto),
        other => other
            .parse()
            .map(NodeSpacing::AtMostM)
            .map_err(|_| format!("found `{text}`, expected a number of metres above 0, such as 1.25, or auto")),
    }
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
    pub(crate) size: SizeArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Fewest hops from one post of a DEM to every other, in any direction
///
/// Every edge is one hop on the exact slice between two posts, as `chta slice` and `chta hop` find it. Of several starts, each post is
/// reached from the nearest. Where no start is given, start and goal are those of the scenario; with DEM and a start, the terrain keys of
/// --scenario (dem, mesh or chain, start, goal, intermediate points) are ignored. For a scenario of a free route over a mesh: the fewest hops
/// to contacts all over it.
#[derive(Debug, ClapArgs)]
#[command(
    after_help = "Example:\n  chta map data/terrain/lunar_rille.tif --start 60,60 --scenario data/scenarios/lunar_rille.toml"
)]
pub(crate) struct MapArgs {
    /// Elevation raster: GeoTIFF or ESRI ASCII grid, map in metres; or a scenario (TOML) with terrain.dem, or with terrain.mesh and route = "free"; -: standard input
    #[arg(value_name = "DEM|SCENARIO")]
    pub(crate) dem: PathBuf,
    /// Start of all paths, map coordinates in m; the nearest post is used; may be repeated: each post is reached from the nearest
    /// start [default: the scenario's]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true)]
    pub(crate) start: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "start")]
    pub(crate) start_lonlat: Vec<LonLat>,
    /// Instead: many starts, CSV with `x_m,y_m`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["start", "start_lonlat"])]
    pub(crate) starts: Option<PathBuf>,
    /// Goal, map coordinates in m; the nearest post is used; may be repeated [default: none]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true)]
    pub(crate) goal: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "goal")]
    pub(crate) goal_lonlat: Vec<LonLat>,
    /// Land only on every N-th post; hops are always tested against the full DEM
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    pub(crate) stride: u32,
    /// Instead, nodes finer than posts: neighbouring nodes at most D m apart, or auto: one hop over level ground spans 8 nodes or more
    /// [default: the scenario's, or posts]
    #[arg(long, value_name = "D|auto", value_parser = node_spacing, conflicts_with = "stride", allow_negative_numbers = true)]
    pub(crate) node_spacing_max_m: Option<NodeSpacing>,
    /// Also least effort among paths of fewest hops: takeoff-speed, energy, time, peak-speed [default: none; alone: the scenario's]
    #[arg(long, value_name = "EFFORT", num_args = 0..=1)]
    #[expect(clippy::option_option, reason = "absent, given alone, or with a value")]
    pub(crate) effort: Option<Option<String>>,
    /// Least total of an amount to every post, then of others among equals, in place of fewest hops: hops, takeoff-speed, delta-v, energy,
    /// flight-time, mission-time, distance, arc-length, last peak-speed [default: the scenario's, or hops]
    #[arg(long, value_name = "AMOUNT[,AMOUNT]", value_delimiter = ',', conflicts_with = "effort")]
    pub(crate) objective: Vec<String>,
    /// Search no farther than N hops; farther posts are reported as not searched [default: search all]
    #[arg(long, value_name = "N", value_parser = hop_count, allow_negative_numbers = true)]
    pub(crate) hops_max: Option<i16>,
    /// Also find the posts from which a start can be reached again
    #[arg(long = "return")]
    pub(crate) back: bool,
    /// Hops (GeoTIFF) to write: int16, -1 unreachable, -2 beyond --hops-max, -32768 no-data; over a mesh the contacts with their hops (CSV; -: to
    /// standard output, in place of the answer)
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Least effort (GeoTIFF) to write: float32, NaN where there is no path
    #[arg(long, value_name = "FILE", requires = "effort")]
    pub(crate) effort_output: Option<PathBuf>,
    /// Total of an amount along the path to every post (GeoTIFF) to write: float32, NaN where there is no path; may be repeated
    #[arg(long, value_name = "AMOUNT=FILE", value_parser = amount_file)]
    pub(crate) amount_output: Vec<AmountFile>,
    /// Hops back to the nearest start (GeoTIFF) to write
    #[arg(long, value_name = "FILE", requires = "back")]
    pub(crate) return_output: Option<PathBuf>,
    /// Number of the nearest start, from 1 (GeoTIFF), to write: the one that the fewest hops come from, then, with --effort, the least
    /// effort, then the first of them; int32, -1 unreachable, -2 beyond --hops-max
    #[arg(long, value_name = "FILE")]
    pub(crate) nearest_output: Option<PathBuf>,
    /// Post that the last hop to each post comes from (GeoTIFF) to write: row * columns + column of it in this raster, counted from the
    /// north-west from 0; int32, -1 at starts, -2147483648 (no-data) where no hop leads
    #[arg(long, value_name = "FILE")]
    pub(crate) predecessor_output: Option<PathBuf>,
    /// Also write a QGIS style (.qml) beside each raster, in the colours of the picture
    #[arg(long)]
    pub(crate) qml: bool,
    /// Mobility (GeoTIFF) to write, for which no start is needed: the share of the posts within v^2/g of a post, v the smaller speed limit, that one hop from it
    /// reaches, and in how many of 16 directions
    #[arg(long, value_name = "FILE")]
    pub(crate) mobility: Option<PathBuf>,
    /// Also fly the path to every goal many times under the errors of `[uncertainty]`, in three dimensions, open loop
    /// or replanned over the posts of the map
    #[arg(long)]
    pub(crate) simulate: bool,
    /// Hops to every goal (CSV) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) paths: Option<PathBuf>,
    /// The same in three dimensions (GeoJSON)
    #[arg(long, value_name = "FILE")]
    pub(crate) geojson: Option<PathBuf>,
    /// Profile of every hop to every goal (SVG or PNG) to write, eight to a page of A4; page 2 of FILE.svg is FILE-2.svg
    #[arg(long, value_name = "FILE")]
    pub(crate) profiles: Option<PathBuf>,
    /// Of every path only eight hops in the picture of profiles, from this one on [default: all hops]
    #[arg(long, value_name = "HOP", value_parser = clap::value_parser!(u32).range(1..), requires = "profiles")]
    pub(crate) profiles_from: Option<u32>,
    /// Map picture (SVG or PNG) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) size: SizeArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}
