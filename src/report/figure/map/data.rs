//! What the maps show, as plain data.

use super::super::Caption;
use crate::{quantity::MapPoint, terrain::Dem};

/// A post that no path reaches, in [`HopMapFigure::hops`] and in the GeoTIFF.
pub const HOPS_UNREACHABLE: i16 = -1;
/// A post without an elevation, in [`HopMapFigure::hops`] and in the GeoTIFF.
pub const HOPS_NO_DATA: i16 = i16::MIN;

/// The posts of a DEM that a map speaks of: every `stride`-th of every `stride`-th row, from the north-west post on.
///
/// ```text
///   o . o . o     stride 2 of 3 rows and 5 columns: 2 rows and 3 columns of posts,
///   . . . . .     row-major from the north-west
///   o . o . o
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MapPosts<'a> {
    /// The terrain, drawn as a hillshade whatever the stride.
    pub dem: &'a Dem,
    /// 1 for every post; 0 counts as 1.
    pub stride: usize,
}

impl MapPosts<'_> {
    /// Rows and columns of the posts that the map speaks of.
    ///
    /// A DEM of 256 x 256 posts with stride 3 has 86 x 86 of them, the last at row and column 255.
    pub fn size(&self) -> (usize, usize) {
        let stride = self.stride.max(1);
        (self.dem.rows().div_ceil(stride), self.dem.cols().div_ceil(stride))
    }

    /// The place, in a raster of these posts, of the one nearest to a post of the DEM; beyond the last one the last.
    pub(super) fn index(&self, row: usize, col: usize) -> usize {
        let (rows, cols) = self.size();
        let nearest = |post: usize, count: usize| ((post + self.stride / 2) / self.stride.max(1)).min(count.saturating_sub(1));
        nearest(row, rows) * cols + nearest(col, cols)
    }

    /// Whether the post at a place of such a raster has no elevation.
    pub(super) fn is_gap(&self, index: usize) -> bool {
        let (stride, cols) = (self.stride.max(1), self.size().1.max(1));
        self.dem.elevation(index / cols * stride, index % cols * stride).is_none()
    }

    /// How many of the posts have no elevation.
    pub(super) fn gaps(&self) -> usize {
        let (rows, cols) = self.size();
        (0..rows * cols).filter(|&index| self.is_gap(index)).count()
    }
}

/// A goal on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoalMark {
    /// Where.
    pub at: MapPoint,
    /// Fewest hops to it; `None` where it is not reached.
    pub hops: Option<u64>,
}

/// A hop map.
#[derive(Clone, Debug)]
pub struct HopMapFigure<'a> {
    /// The words above.
    pub caption: Caption,
    /// Terrain and posts.
    pub posts: MapPosts<'a>,
    /// Fewest hops to each post, row-major from the north-west; [`HOPS_UNREACHABLE`] and [`HOPS_NO_DATA`] where there are none.
    pub hops: &'a [i16],
    /// From which posts the start can be reached again, in the same order; `None`: not asked.
    pub can_return: Option<&'a [bool]>,
    /// Which posts lie in keep-out zones, in the same order; `None`: there are no zones.
    pub kept_out: Option<&'a [bool]>,
    /// Where the journeys begin.
    pub start: MapPoint,
    /// Where they should end.
    pub goals: Vec<GoalMark>,
    /// Paths to goals: the start and every landing, in order.
    pub paths: Vec<Vec<MapPoint>>,
}

/// A map of one number for each post.
#[derive(Clone, Debug)]
pub struct ValueMapFigure<'a> {
    /// The words above.
    pub caption: Caption,
    /// Terrain and posts.
    pub posts: MapPosts<'a>,
    /// The numbers, row-major from the north-west; NaN where there is none.
    pub values: &'a [f64],
    /// What the numbers are, with their unit, such as `least total effort (m/s)`.
    pub value_name: String,
    /// What NaN on a post with an elevation means, such as `unreachable`.
    pub none_name: String,
    /// Where the journeys begin, where there is one start.
    pub start: Option<MapPoint>,
    /// Where they should end.
    pub goals: Vec<GoalMark>,
    /// Paths to goals: the start and every landing, in order.
    pub paths: Vec<Vec<MapPoint>>,
}

/// Where trials of one hop landed, on a DEM.
#[derive(Clone, Debug, PartialEq)]
pub struct LandingCloud {
    /// The hop's number in the planned path, from 1.
    pub hop: usize,
    /// Where it should land.
    pub planned: MapPoint,
    /// Some or all of the landings; more than fit are thinned, which the legend says.
    pub landings: Vec<MapPoint>,
    /// How many landings there were in all.
    pub count: u64,
    /// The 95 % ellipse, where there were landings enough.
    pub ellipse: Option<LandingEllipse>,
}

/// An ellipse on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandingEllipse {
    /// Its middle.
    pub centre: MapPoint,
    /// Half of its longer axis, m.
    pub semi_major_m: f64,
    /// Half of its shorter axis, m.
    pub semi_minor_m: f64,
    /// Direction of the longer axis, clockwise from grid north.
    pub heading_deg: f64,
}

/// Landings of a whole path on a DEM.
#[derive(Clone, Debug)]
pub struct LandingMapFigure<'a> {
    /// The words above.
    pub caption: Caption,
    /// The terrain.
    pub dem: &'a Dem,
    /// The planned path: the start and every landing, in order.
    pub path: Vec<MapPoint>,
    /// One for each planned hop.
    pub clouds: Vec<LandingCloud>,
}
