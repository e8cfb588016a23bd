//! The options of the command that ranks landing sites.

use std::path::PathBuf;

use chta::{quantity::MapPoint, terrain::LonLat};
use clap::Args as ClapArgs;

use super::super::load::OwnKey;
use super::{
    AnswerArgs, CommonArgs, lon_lat, map_point,
    maps::{NodeSpacing, SizeArgs, node_spacing},
};

/// Landing sites ranked: what is reached from each candidate, in how few hops, and from where it is reached again
///
/// One map of hops from every candidate, as chta map finds it, and one back to every set of candidates that reach each other. Candidates
/// are every N-th node where hops begin, or the places of a file. With targets, sites that reach more of them come first, then those that
/// reach them in fewer hops; without, those from which the greatest share of the nodes is reached.
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta sites data/scenarios/mars_crater_field.toml --every 16 --plot sites.svg")]
pub(crate) struct SitesArgs {
    /// Elevation raster: GeoTIFF or ESRI ASCII grid, map in metres; or a scenario (TOML) with terrain.dem; -: standard input
    #[arg(value_name = "DEM|SCENARIO")]
    pub(crate) dem: PathBuf,
    /// Candidates: every N-th node in rows and columns where hops begin [default: none]
    #[arg(long, value_name = "N", value_parser = at_least_one, allow_negative_numbers = true, required_unless_present = "candidates")]
    pub(crate) every: Option<u32>,
    /// Instead: candidates, CSV with `x_m,y_m`; the nearest nodes are used [default: none]
    #[arg(long, value_name = "FILE", conflicts_with = "every")]
    pub(crate) candidates: Option<PathBuf>,
    /// Target, map coordinates in m; the nearest node is used; may be repeated [default: the targets or the goal of SCENARIO]
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true)]
    pub(crate) target: Vec<MapPoint>,
    /// Instead: longitude and planetocentric latitude, degrees, east positive; may be repeated [default: none]
    #[arg(long, value_name = "LON,LAT", value_parser = lon_lat, allow_hyphen_values = true, conflicts_with = "target")]
    pub(crate) target_lonlat: Vec<LonLat>,
    /// Land only on every N-th post; hops are always tested against the full DEM
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = at_least_one, allow_negative_numbers = true)]
    pub(crate) stride: u32,
    /// Instead, nodes finer than posts: neighbouring nodes at most D m apart, or auto: one hop over level ground spans 8 nodes or more
    /// [default: the scenario's, or posts]
    #[arg(long, value_name = "D|auto", value_parser = node_spacing, conflicts_with = "stride", allow_negative_numbers = true)]
    pub(crate) node_spacing_max_m: Option<NodeSpacing>,
    /// Least total of an amount to every node in place of fewest hops: its mean and its greatest are stated beside the hops [default: the
    /// scenario's, or hops]
    #[arg(long, value_name = "AMOUNT[,AMOUNT]", value_delimiter = ',')]
    pub(crate) objective: Vec<String>,
    /// Trials of the path from every candidate to each target, flown under the errors of [uncertainty]: the share that arrives [default: none
    /// are flown]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) trials: Option<i64>,
    /// Exit with status 1 unless some candidate reaches all targets, or without targets any other node
    #[arg(long)]
    pub(crate) require_all: bool,
    /// Sites to write: a table (CSV, or JSON), or a raster (GeoTIFF, float32: share reached, share of returns and mean hops at the
    /// candidates, NaN elsewhere); -: the table to standard output, in place of the answer
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Map picture (SVG or PNG) to write
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) size: SizeArgs,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

impl SitesArgs {
    /// The scenario key set by the number of trials; it is checked and written as a key of the scenario.
    pub(crate) fn own_keys(&self) -> Vec<OwnKey<'static>> {
        self.trials.map(|trials| ("--trials", "uncertainty", "trials", trials.into())).into_iter().collect()
    }
}

/// Reads a count of at least one.
fn at_least_one(text: &str) -> Result<u32, String> {
    let count = text.trim().parse().ok().filter(|count| *count >= 1);
    count.ok_or_else(|| format!("found `{text}`, expected a whole number of at least 1, such as 16"))
}
