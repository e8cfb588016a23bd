//! The slopes of all legs of one offset from the posts of a row.

use super::{refusal::DriveLimit, template::Template};
use crate::terrain::{Dem, Samples};

/// Posts of a row that are judged together: their slopes fit the nearest cache.
pub(super) const CHUNK: usize = 256;

/// Posts beyond the border that a leg's facets may have: three along, and one beside an edge.
pub(super) const MARGIN: usize = 4;

/// How a leg is judged.
pub(super) const NO_LEG: u8 = u8::MAX;
/// A leg that keeps every limit looked at so far.
pub(super) const KEPT: u8 = DriveLimit::Roughness as u8 + 1;

/// Some rows of a DEM with a margin on all sides: NaN where there is no elevation.
#[derive(Debug)]
pub(super) struct Window {
    heights_m: Vec<f64>,
    width: usize,
    first_row: usize,
}

impl Window {
    /// The rows from `first` to before `end`, and their margin.
    pub(super) fn of(dem: &Dem, first: usize, end: usize) -> Self {
        let (rows, cols) = (dem.rows(), dem.cols());
        let width = cols + 2 * MARGIN;
        let mut heights_m = vec![f64::NAN; (end - first + 2 * MARGIN) * width];
        for (line, to) in heights_m.chunks_exact_mut(width).enumerate() {
            let Some(row) = (first + line).checked_sub(MARGIN).filter(|row| *row < rows) else { continue };
            let to = &mut to[MARGIN..MARGIN + cols];
            match dem.samples() {
                Samples::Single(values) => {
                    to.iter_mut().zip(&values[row * cols..]).for_each(|(to, z_m)| *to = f64::from(*z_m));
                }
                Samples::Double(values) => to.copy_from_slice(&values[row * cols..(row + 1) * cols]),
            }
        }
        Self { heights_m, width, first_row: first }
    }

    /// The heights of so many posts of a row from a column on, moved by columns and rows.
    #[inline]
    fn line(&self, (row, col): (usize, usize), (east, south): (i32, i32), count: usize) -> &[f64] {
        let post = (row - self.first_row + MARGIN) * self.width + col + MARGIN;
        let moved = post.wrapping_add_signed(south as isize * self.width.cast_signed() + east as isize);
        &self.heights_m[moved..moved + count]
    }
}

/// The weights of a facet's differences of height for the slopes along and across a leg.
#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [(i32, i32); 4],
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    facet: Facet,
    other: Option<Facet>,
}

/// The slopes of the legs of one offset, there and back.
#[derive(Clone, Debug)]
pub(super) struct OffsetSlopes {
    offset: (i32, i32),
    /// Slope along the leg per difference of height to the east and to the north.
    along: [f64; 2],
    /// The same across it.
    across: [f64; 2],
    pieces: Vec<Piece>,
}

/// The slopes of some legs.
#[derive(Debug)]
struct Found {
    /// The steepest slope up along the leg, and the least: the steepest down, negative.
    highest: [f64; CHUNK],
    lowest: [f64; CHUNK],
    across: [f64; CHUNK],
    /// NaN where a facet has no elevation.
    known: [f64; CHUNK],
}

impl OffsetSlopes {
    /// Of an offset in columns to the east and rows to the north, and the template of its legs.
    pub(super) fn new(offset: (i32, i32), template: &Template, (dx_m, dy_m): (f64, f64)) -> Self {
        let heading = template.heading;
        let facet = |facet: super::template::Facet| Facet { corners: facet.corners() };
        let pieces = template.pieces.iter().map(|piece| Piece { facet: facet(piece.facet), other: piece.other.map(facet) });
        Self {
            offset,
            along: [heading.x / dx_m, heading.y / dy_m],
            across: [heading.y / dx_m, -heading.x / dy_m],
            pieces: pieces.collect(),
        }
    }

    /// Judges the legs from the posts of a row, from a column on, against the greatest tangents up, down and across: there, and back from
    /// their ends to the posts.
    pub(super) fn judge(&self, window: &Window, at: (usize, usize), ceilings: [f64; 3], there: &mut [u8], back: &mut [u8]) {
        let count = there.len();
        let mut found = Found {
            highest: [f64::NEG_INFINITY; CHUNK],
            lowest: [f64::INFINITY; CHUNK],
            across: [0.0; CHUNK],
            known: [0.0; CHUNK],
        };
        for piece in &self.pieces {
            match piece.other {
                None => self.add(window, at, piece.facet, &mut found, count),
                Some(other) => self.add_edge(window, at, [piece.facet, other], &mut found, count),
            }
        }
        let begins = window.line(at, (0, 0), count);
        let ends = window.line(at, (self.offset.0, -self.offset.1), count);
        let [up, down, across] = ceilings;
        for i in 0..count {
            let is_leg = !(begins[i] + ends[i]).is_nan();
            let (highest, lowest) = (found.highest[i], -found.lowest[i]);
            let verdict = |climb: f64, descent: f64| {
                let by_slopes = if climb > up {
                    DriveLimit::SlopeUp as u8
                } else if descent > down {
                    DriveLimit::SlopeDown as u8
                } else if found.across[i] > across {
                    DriveLimit::CrossSlope as u8
                } else {
                    KEPT
                };
                let known = if found.known[i].is_nan() { DriveLimit::Ground as u8 } else { by_slopes };
                if is_leg { known } else { NO_LEG }
            };
            there[i] = verdict(highest, lowest);
            back[i] = verdict(lowest, highest);
        }
    }

    /// The slopes of one facet at so many posts.
    #[inline]
    fn add(&self, window: &Window, at: (usize, usize), facet: Facet, found: &mut Found, count: usize) {
        let [east, west, north, south] = facet.corners.map(|corner| window.line(at, corner, count));
        let Found { highest, lowest, across, known } = found;
        let found = highest[..count].iter_mut().zip(&mut lowest[..count]).zip(across[..count].iter_mut().zip(&mut known[..count]));
        let heights = east.iter().zip(west).zip(north.iter().zip(south));
        for (((highest, lowest), (across, known)), ((east, west), (north, south))) in found.zip(heights) {
            let (to_east, to_north) = (east - west, north - south);
            let slope = to_east * self.along[0] + to_north * self.along[1];
            let aside = (to_east * self.across[0] + to_north * self.across[1]).abs();
            *highest = greater(slope, *highest);
            *lowest = less(slope, *lowest);
            *across = greater(aside, *across);
            *known += slope;
        }
    }

    /// The same along the common edge of two facets, one of which suffices.
    #[inline]
    fn add_edge(&self, window: &Window, at: (usize, usize), facets: [Facet; 2], found: &mut Found, count: usize) {
        let [left, right] = facets.map(|facet| facet.corners.map(|corner| window.line(at, corner, count)));
        let slopes = |[east, west, north, south]: [&[f64]; 4], i: usize| {
            let (to_east, to_north) = (east[i] - west[i], north[i] - south[i]);
            let slope = to_east * self.along[0] + to_north * self.along[1];
            (slope, (to_east * self.across[0] + to_north * self.across[1]).abs())
        };
        for i in 0..count {
            let ((one, aside), (two, beside)) = (slopes(left, i), slopes(right, i));
            let slope = if one.is_nan() { two } else { one };
            found.highest[i] = greater(slope, found.highest[i]);
            found.lowest[i] = less(slope, found.lowest[i]);
            found.across[i] = greater(beside, greater(aside, found.across[i]));
            found.known[i] += slope;
        }
    }
}

/// The greater number; the second where the first is NaN. One instruction, unlike [`f64::max`].
#[inline]
fn greater(first: f64, second: f64) -> f64 {
    if first > second { first } else { second }
}

#[inline]
fn less(first: f64, second: f64) -> f64 {
    if first < second { first } else { second }
}
