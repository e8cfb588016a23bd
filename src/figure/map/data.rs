//! The data of the maps.

use super::{super::Caption, unreached::RefusedBy};
use crate::{quantity::MapPoint, terrain::Dem};

/// The value of an unreachable post, in [`HopMapFigure::hops`] and in the GeoTIFF.
pub const HOPS_UNREACHABLE: i16 = -1;
/// The value of a post beyond the hops that were searched, in [`HopMapFigure::hops`] and in the GeoTIFF.
pub const HOPS_NOT_SEARCHED: i16 = -2;
/// The value of a post without an elevation, in [`HopMapFigure::hops`] and in the GeoTIFF.
pub const HOPS_NO_DATA: i16 = i16::MIN;

/// The posts of a DEM that are nodes of a map: every `stride`-th post of every `stride`-th row, from the north-west post on.
///
/// ```text
///   o . o . o     stride 2 of 3 rows and 5 columns: 2 rows and 3 columns of posts,
///   . . . . .     row-major from the north-west
///   o . o . o
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MapPosts<'a> {
    /// The terrain, drawn as a hillshade at full resolution.
    pub dem: &'a Dem,
    /// 1 for every post; 0 counts as 1.
    pub stride: usize,
    /// How many posts `dem` has in place of each of the original raster, which is the same surface; 1 for the raster itself. With more, answers
    /// are for nodes.
    pub per_post: usize,
}

impl MapPosts<'_> {
    /// What there are answers for, in words.
    pub(super) const fn node(&self) -> &'static str {
        if self.per_post > 1 { "node" } else { "post" }
    }

    /// Rows and columns of the map's posts.
    ///
    /// A DEM of 256 x 256 posts with stride 3 has 86 x 86 of them, the last at row and column 255.
    pub fn size(&self) -> (usize, usize) {
        let stride = self.stride.max(1);
        (self.dem.rows().div_ceil(stride), self.dem.cols().div_ceil(stride))
    }

    /// The index, in a raster of these posts, of the one nearest to a post of the DEM; the last one beyond the end.
    pub(super) fn index(&self, row: usize, col: usize) -> usize {
        let (rows, cols) = self.size();
        let nearest = |post: usize, count: usize| ((post + self.stride / 2) / self.stride.max(1)).min(count.saturating_sub(1));
        nearest(row, rows) * cols + nearest(col, cols)
    }

    /// Whether the post at an index of such a raster has no elevation.
    pub(super) fn is_gap(&self, index: usize) -> bool {
        let (stride, cols) = (self.stride.max(1), self.size().1.max(1));
        self.dem.elevation(index / cols * stride, index % cols * stride).is_none()
    }

    /// The number of posts without elevation.
    pub(super) fn gaps(&self) -> usize {
        let (rows, cols) = self.size();
        (0..rows * cols).filter(|&index| self.is_gap(index)).count()
    }
}

/// A goal on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoalMark {
    /// Its position.
    pub at: MapPoint,
    /// Fewest hops to it; `None` if unreachable.
    pub hops: Option<u64>,
}

/// The posts of a map that refuse every contact for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RefusedPosts {
    /// The kind of the reason, which has a pattern of its own.
    pub by: RefusedBy,
    /// The reason in the legend, such as "keep-out".
    pub reason: String,
    /// Whether it is that of each post, row-major from the north-west.
    pub posts: Vec<bool>,
}

/// A hop map.
#[derive(Clone, Debug)]
pub struct HopMapFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// Terrain and posts.
    pub posts: MapPosts<'a>,
    /// Fewest hops to each post, row-major from the north-west; [`HOPS_UNREACHABLE`], [`HOPS_NOT_SEARCHED`] or [`HOPS_NO_DATA`] for
    /// other posts.
    pub hops: &'a [i16],
    /// Whether a start can be reached again from each post, in the same order; `None` if not requested.
    pub can_return: Option<&'a [bool]>,
    /// Posts that refuse every contact, by reason: of several reasons for one post the first counts. Without any, nothing is said of why
    /// posts are not reached.
    pub refused: Vec<RefusedPosts>,
    /// The starts.
    pub starts: Vec<MapPoint>,
    /// The goals.
    pub goals: Vec<GoalMark>,
    /// Paths to goals: the start and every landing, in order.
    pub paths: Vec<Vec<MapPoint>>,
}

/// A map of one number for each post.
#[derive(Clone, Debug)]
pub struct ValueMapFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// Terrain and posts.
    pub posts: MapPosts<'a>,
    /// The values, row-major from the north-west; NaN for absent values.
    pub values: &'a [f64],
    /// Posts that refuse every contact, by reason: those without a value are drawn with it.
    pub refused: Vec<RefusedPosts>,
    /// The name of the values with their unit, such as `least total effort (m/s)`.
    pub value_name: String,
    /// The meaning of NaN at a post with an elevation, such as `unreachable`.
    pub none_name: String,
    /// The starts.
    pub starts: Vec<MapPoint>,
    /// The goals.
    pub goals: Vec<GoalMark>,
    /// Paths to goals: the start and every landing, in order.
    pub paths: Vec<Vec<MapPoint>>,
}

/// The landings of one hop's trials on a DEM.
#[derive(Clone, Debug, PartialEq)]
pub struct LandingCloud {
    /// The hop's number in the planned path, from 1.
    pub hop: usize,
    /// The planned landing.
    pub planned: MapPoint,
    /// Some or all of the landings; if there are too many they are thinned, which the legend says.
    pub landings: Vec<MapPoint>,
    /// The number of all landings.
    pub count: u64,
    /// The 95 % ellipse, if there are enough landings.
    pub ellipse: Option<LandingEllipse>,
}

/// An ellipse on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandingEllipse {
    /// Its centre.
    pub centre: MapPoint,
    /// Its semi-major axis, m.
    pub semi_major_m: f64,
    /// Its semi-minor axis, m.
    pub semi_minor_m: f64,
    /// Heading of the major axis, clockwise from grid north.
    pub heading_deg: f64,
}

/// Landings of a whole path on a DEM.
#[derive(Clone, Debug)]
pub struct LandingMapFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// The terrain.
    pub dem: &'a Dem,
    /// The planned path: the start and every landing, in order.
    pub path: Vec<MapPoint>,
    /// One for each planned hop.
    pub clouds: Vec<LandingCloud>,
}
