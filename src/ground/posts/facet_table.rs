//! Which facets around every post allow contacts, for all hops: computed once, looked up many times.

use rayon::prelude::*;

use super::{
    facets::{CORNERS, Facets},
    samples::Heights,
};

/// A squared slope within this fraction of its limit is left to the exact code.
const NEAR: f64 = 1.0e-6;

/// The facets around every post, one bit each.
#[derive(Clone, Debug)]
pub(super) struct FacetTable {
    exists: Vec<u8>,
    steep: Vec<u8>,
    doubtful: Vec<u8>,
    /// Whether some post has no elevation.
    pub(super) gaps: bool,
}

/// What the facets of a heading allow a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Footing {
    /// No ground, or too steep to rest on.
    Refused,
    /// Within rounding of the steepest slope to rest on.
    Doubtful,
    /// The contact is allowed.
    Sound,
}

impl FacetTable {
    /// The table of a raster; `rest` gives the tangent of the steepest slope to rest on at a post.
    pub(super) fn new(heights: Heights<'_>, rest: &(dyn Fn(usize) -> Option<f64> + Sync)) -> Self {
        let (rows, cols) = (heights.rows(), heights.cols);
        let mut bits = vec![[0u8; 3]; rows * cols];
        bits.par_chunks_mut(cols).enumerate().for_each(|(row, line)| {
            for (col, post) in line.iter_mut().enumerate() {
                *post = around(heights, row, col, rest(row * cols + col));
            }
        });
        let of = |which: usize| bits.par_iter().map(|post| post[which]).collect();
        let gaps = (0..rows * cols).into_par_iter().any(|index| heights.at(index).is_nan());
        Self { exists: of(0), steep: of(1), doubtful: of(2), gaps }
    }

    /// Whether a hop in some direction may begin or end at a post.
    #[inline]
    pub(super) fn usable(&self, post: usize) -> bool {
        self.exists[post] & !self.steep[post] != 0
    }

    /// Whether a post has at least one of the facets.
    #[inline]
    pub(super) fn has_any(&self, post: usize, facets: Facets) -> bool {
        self.exists[post] & facets.bits() != 0
    }

    /// Whether a post has a facet.
    #[inline]
    pub(super) fn has(&self, post: usize, facet: usize) -> bool {
        self.exists[post] & (1 << facet) != 0
    }

    /// What the facet of a heading allows; along an edge, the steeper of the two facets.
    #[inline]
    pub(super) fn footing(&self, post: usize, facets: Facets) -> Footing {
        let bits = facets.bits();
        if self.exists[post] & bits == 0 || self.steep[post] & bits != 0 {
            Footing::Refused
        } else if self.doubtful[post] & bits != 0 {
            Footing::Doubtful
        } else {
            Footing::Sound
        }
    }
}

/// Existing, steep and doubtful facets of a post.
fn around(heights: Heights<'_>, row: usize, col: usize, rest: Option<f64>) -> [u8; 3] {
    let (rows, cols) = (heights.rows(), heights.cols);
    let mut bits = [0u8; 3];
    for (facet, corners) in CORNERS.iter().enumerate() {
        let inside = corners.iter().all(|&(east, south)| {
            col.checked_add_signed(east as isize).is_some_and(|col| col < cols)
                && row.checked_add_signed(south as isize).is_some_and(|row| row < rows)
        });
        if !inside {
            continue;
        }
        let (east, north) = heights.gradient(row * cols + col, facet);
        let steepness = east * east + north * north;
        if steepness.is_nan() {
            continue;
        }
        bits[0] |= 1 << facet;
        let Some(most) = rest.map(|rest| rest * rest) else { continue };
        if steepness > most * (1.0 + NEAR) {
            bits[1] |= 1 << facet;
        } else if steepness >= most * (1.0 - NEAR) {
            bits[2] |= 1 << facet;
        }
    }
    bits
}
