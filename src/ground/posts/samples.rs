//! The DEM's elevations as a flat array.

use super::{facets::CORNERS, offsets::Crossing};
use crate::terrain::{Dem, Samples};

/// Elevations row after row, NaN for gaps, with the spacing of their posts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heights<'a> {
    samples: Samples<'a>,
    pub(super) cols: usize,
    scale: &'a HeightScale,
}

/// What the heights of a DEM share: the spacing of its posts, and where the neighbours of a post stand among them.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeightScale {
    /// One over the posts' spacing, 1/m: a quotient's last bit is worth less than a division.
    per_dx: f64,
    per_dy: f64,
    /// [`CORNERS`] as steps among the elevations.
    corners: [[isize; 4]; 6],
}

/// The take-off of a walk and the height of its line of sight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    /// The take-off's place among the elevations.
    pub(super) from: usize,
    /// The take-off's height less the clearance, m.
    pub(super) base_m: f64,
    /// 1 or -1: how the crossings' steps are turned.
    pub(super) turn: isize,
    /// To the landing, m.
    pub(super) rise_m: f64,
    /// A loft that no vertex may ask more than.
    pub(super) most: f64,
}

impl HeightScale {
    pub(super) fn of(dem: &Dem) -> Self {
        let map = dem.georeference();
        let width = dem.cols().cast_signed();
        let corners = CORNERS.map(|facet| facet.map(|(east, south)| south as isize * width + east as isize));
        Self { per_dx: 1.0 / map.dx_m(), per_dy: 1.0 / map.dy_m(), corners }
    }
}

impl<'a> Heights<'a> {
    #[inline]
    pub(super) fn of(dem: &'a Dem, scale: &'a HeightScale) -> Self {
        Self { samples: dem.samples(), cols: dem.cols(), scale }
    }

    pub(super) fn rows(&self) -> usize {
        let posts = match self.samples {
            Samples::Single(values) => values.len(),
            Samples::Double(values) => values.len(),
        };
        posts / self.cols
    }

    /// A post's elevation, m; NaN where it has none.
    #[inline]
    pub(super) fn at(&self, index: usize) -> f64 {
        match self.samples {
            Samples::Single(values) => f64::from(values[index]),
            Samples::Double(values) => values[index],
        }
    }

    /// The gradient (east, north) of one of a post's facets, which must exist; NaN where a post of it has no elevation.
    #[inline]
    pub(super) fn gradient(&self, post: usize, facet: usize) -> (f64, f64) {
        match self.samples {
            Samples::Single(values) => self.gradient_of(values, post, facet),
            Samples::Double(values) => self.gradient_of(values, post, facet),
        }
    }

    #[inline]
    fn gradient_of<T: Copy + Into<f64>>(&self, heights: &[T], post: usize, facet: usize) -> (f64, f64) {
        let [east, west, north, south] =
            self.scale.corners[facet].map(|step| -> f64 { heights[post.wrapping_add_signed(step)].into() });
        ((east - west) * self.scale.per_dx, (north - south) * self.scale.per_dy)
    }

    /// The least loft that clears all vertices on the way; `None` where that is more than the most allowed, or an elevation is missing.
    #[inline]
    pub(super) fn clearing_loft(&self, walk: Walk, crossings: &[Crossing]) -> Option<f64> {
        match self.samples {
            Samples::Single(values) => clearing_loft(values, walk, crossings),
            Samples::Double(values) => clearing_loft(values, walk, crossings),
        }
    }
}

/// With `n >= s - t` of [`clearing_loft`](crate::ballistics::limits::clearing_loft) written as the height over the line of sight times
/// `1 / d + 1 / e`: no division.
#[inline]
fn clearing_loft<T: Copy + Into<f64>>(heights: &[T], walk: Walk, crossings: &[Crossing]) -> Option<f64> {
    let mut least = f64::NEG_INFINITY;
    for crossing in crossings {
        let at = |step: i32| -> f64 { heights[walk.from.wrapping_add_signed(walk.turn * step as isize)].into() };
        let first = at(crossing.first);
        let z_m = first + crossing.share * (at(crossing.second) - first);
        let loft = (z_m - (walk.base_m + walk.rise_m * crossing.along)) * crossing.stiffness;
        // So that a missing elevation, which is no number, ends the walk too.
        let clears = loft <= walk.most;
        if !clears {
            return None;
        }
        least = least.max(loft);
    }
    Some(least)
}
