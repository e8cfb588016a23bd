//! The DEM's elevations as a flat array.

use super::{
    facets::CORNERS,
    offsets::{Crossing, Kink},
};
use crate::terrain::{Dem, Samples};

/// Elevations row after row, NaN for gaps, and the post spacing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heights<'a> {
    samples: Samples<'a>,
    pub(super) cols: usize,
    scale: &'a HeightScale,
}

/// What the heights of a DEM share: the post spacing, and the steps to the neighbours of a post in the array.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeightScale {
    /// Inverse post spacing, 1/m: a multiplication is faster than a division, and the last bit does not matter.
    per_dx: f64,
    per_dy: f64,
    /// [`CORNERS`] as steps in the array of elevations.
    corners: [[isize; 4]; 6],
}

/// The take-off of a walk and the height of its line of sight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    /// The index of the take-off in the array of elevations.
    pub(super) from: usize,
    /// The take-off's height, m.
    pub(super) base_m: f64,
    /// 1 or -1: the sign of the crossings' steps.
    pub(super) turn: isize,
    /// Height of the landing above the take-off, m.
    pub(super) rise_m: f64,
    /// The walk ends at a vertex that needs more loft than this.
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

    /// The gradient (east, north) of one of a post's facets, which must exist; NaN if an elevation is missing.
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

    /// The least loft that keeps the clearance over all vertices and kinks on the line; `None` if that exceeds the most allowed, or
    /// an elevation is missing.
    #[inline]
    pub(super) fn clearing_loft(&self, walk: Walk, crossings: &[Crossing], kinks: &[Kink]) -> Option<f64> {
        match self.samples {
            Samples::Single(values) => clearing_loft(values, walk, crossings, kinks),
            Samples::Double(values) => clearing_loft(values, walk, crossings, kinks),
        }
    }
}

/// The bounds of [`clearing_loft`](crate::ballistics::limits::clearing_loft), `n >= s - t`, computed without a division as the
/// height over the line of sight, with the clearance, times `1 / d + 1 / e`; and the same at the kinks of the clearance.
#[inline]
fn clearing_loft<T: Copy + Into<f64>>(heights: &[T], walk: Walk, crossings: &[Crossing], kinks: &[Kink]) -> Option<f64> {
    let at = |step: i32| -> f64 { heights[walk.from.wrapping_add_signed(walk.turn * step as isize)].into() };
    let ground = |crossing: &Crossing| {
        let first = at(crossing.first);
        first + crossing.share * (at(crossing.second) - first)
    };
    let mut least = f64::NEG_INFINITY;
    for crossing in crossings {
        let over_m = ground(crossing) - (walk.base_m + walk.rise_m * crossing.along);
        let loft = (over_m + crossing.raised_m) * crossing.stiffness;
        // Written so that NaN, a missing elevation, also ends the walk.
        let clears = loft <= walk.most;
        if !clears {
            return None;
        }
        least = least.max(loft);
    }
    for kink in kinks {
        let next = kink.next as usize;
        let before_m = next.checked_sub(1).map_or(walk.base_m, |before| ground(&crossings[before]));
        let after_m = crossings.get(next).map_or(walk.base_m + walk.rise_m, ground);
        let over_m = before_m + kink.share * (after_m - before_m) - (walk.base_m + walk.rise_m * kink.along);
        let loft = (over_m + kink.raised_m) * kink.stiffness;
        if loft > walk.most {
            return None;
        }
        least = least.max(loft);
    }
    Some(least)
}
