//! All offsets between nodes within reach, each with everything that is the same for all pairs of posts with that offset.
//!
//! The line between two posts `(columns, rows)` apart crosses the lattice's rows, columns and diagonals at the same relative
//! positions for every such pair: between which two posts, and how far from one to the other. All of it follows from integers, so
//! testing a hop against the terrain is a walk down a table.
//!
//! ```text
//!   o---o---o---o       offset (3, 1): crosses columns at 1/3 and 2/3 of the way,
//!   | \ |#\ | \ |       diagonals at 1/2 (u - v = 1) and 1 (the landing itself)
//!   A---o---o-##o
//!    ###| \ | \ B
//! ```

use std::{collections::HashMap, ops::Range};

use nalgebra::Vector2;

use super::facets::{Facets, facets_towards};
use crate::ballistics::limits::ClearanceProfile;

/// A vertex of the slice between two posts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// The two posts it lies between, as steps from the take-off in the array of elevations.
    pub(super) first: i32,
    pub(super) second: i32,
    /// Fraction of the distance from the first to the second.
    pub(super) share: f64,
    /// Fraction of the distance from take-off to landing.
    pub(super) along: f64,
    /// Loft needed per metre of height above the line of sight: `1 / d + 1 / e`, 1/m, for the distances `d`, `e` to both ends.
    pub(super) stiffness: f64,
    /// The clearance to keep over it, m.
    pub(super) raised_m: f64,
}

/// A kink of a tapered clearance, between two vertices of the slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kink {
    /// The number of the crossing at or beyond it; as many as there are: the landing. The one before 0 is the take-off.
    pub(super) next: u32,
    /// Fraction of the distance from the vertex before to that one.
    pub(super) share: f64,
    /// As of a [`Crossing`].
    pub(super) along: f64,
    pub(super) stiffness: f64,
    pub(super) raised_m: f64,
}

/// The offset from a node to another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Offset {
    /// Nodes to the east and to the south.
    pub(crate) cols: i32,
    pub(crate) rows: i32,
    /// The step in the array of elevations.
    pub(super) post_step: isize,
    pub(crate) run_m: f64,
    /// East and north, of length 1.
    pub(crate) heading: Vector2<f64>,
    /// Its range in the table of crossings. The opposite offset shares it: its crossings are the same, mirrored about the take-off.
    crossings: Range<usize>,
    /// Its kinks in their table, which the opposite offset shares as well.
    kinks: Range<usize>,
    /// 1 if the steps of the table apply as they are, -1 if they are negated.
    pub(super) turn: isize,
    /// The facets of the take-off and of the landing.
    pub(super) departure: Facets,
    pub(super) arrival: Facets,
    /// The rises that the parabolas of safety of both speeds allow, m.
    pub(super) rises_m: (f64, f64),
}

/// Spacing of a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spacing {
    /// Post spacing, m.
    pub(crate) dx_m: f64,
    pub(crate) dy_m: f64,
    /// Posts from one node to the next.
    pub(crate) stride: usize,
    /// Columns of nodes and of posts.
    pub(crate) node_cols: usize,
    pub(crate) post_cols: usize,
}

/// The vertices of the slice over `(columns, rows)` posts, in the order of travel, without its ends.
pub(super) fn crossings(cols: i32, rows: i32, run_m: f64, post_cols: usize, clearance: ClearanceProfile) -> Vec<Crossing> {
    // A crossing at the fraction n / d, d > 0, of the line; fractions are compared exactly.
    let mut places: Vec<(i64, i64)> = Vec::new();
    for lines in [cols, rows, cols - rows] {
        let count = i64::from(lines.abs());
        places.extend((1..count).map(|number| (number, count)));
    }
    places.sort_by(|a, b| (a.0 * b.1).cmp(&(b.0 * a.1)));
    places.dedup_by(|a, b| a.0 * b.1 == b.0 * a.1);
    places
        .into_iter()
        .map(|(number, count)| crossing(i64::from(cols), i64::from(rows), (number, count), run_m, post_cols))
        .map(|crossing| {
            let d_m = crossing.along * run_m;
            Crossing { raised_m: clearance.at_m(d_m, run_m - d_m), ..crossing }
        })
        .collect()
}

/// The kinks of a tapered clearance over a line with these vertices.
fn kinks(run_m: f64, crossings: &[Crossing], clearance: ClearanceProfile) -> impl Iterator<Item = Kink> {
    let kink_m = clearance.kink_m(run_m);
    let ends_m = if clearance.has_kinks() { [Some(kink_m), Some(run_m - kink_m)] } else { [None; 2] };
    ends_m.into_iter().flatten().map(move |d_m| {
        let along = d_m / run_m;
        let next = crossings.partition_point(|crossing| crossing.along < along);
        let (before, after) =
            (next.checked_sub(1).map_or(0.0, |i| crossings[i].along), crossings.get(next).map_or(1.0, |crossing| crossing.along));
        let e_m = run_m - d_m;
        Kink {
            next: u32::try_from(next).unwrap_or(u32::MAX),
            share: (along - before) / (after - before),
            along,
            stiffness: 1.0 / d_m + 1.0 / e_m,
            raised_m: clearance.taper() * kink_m,
        }
    })
}

/// The vertex at the fraction `number / count` of the line.
#[expect(clippy::cast_precision_loss, reason = "products of two reaches stay far below 2^53")]
#[expect(clippy::cast_possible_truncation, reason = "steps within a raster that fits memory, checked where the table is made")]
fn crossing(cols: i64, rows: i64, (number, count): (i64, i64), run_m: f64, post_cols: usize) -> Crossing {
    let (east, south) = (cols * number, rows * number);
    let (col, row) = (east.div_euclid(count), south.div_euclid(count));
    let (rest_east, rest_south) = (east.rem_euclid(count), south.rem_euclid(count));
    // On a row, a column or a diagonal: interpolated along it to the next post; at a post both remainders are 0.
    let rest = rest_east.max(rest_south);
    let next = (col + i64::from(rest_east > 0), row + i64::from(rest_south > 0));
    #[expect(clippy::cast_possible_wrap, reason = "a raster's columns")]
    let post_cols = post_cols as i64;
    let step = |(col, row): (i64, i64)| (row * post_cols + col) as i32;
    let along = number as f64 / count as f64;
    Crossing {
        first: step((col, row)),
        second: step(next),
        share: rest as f64 / count as f64,
        along,
        // X / (d e), with the distances d and e as fractions of X.
        stiffness: (count * count) as f64 / ((number * (count - number)) as f64 * run_m),
        raised_m: 0.0,
    }
}

/// Every offset within a range, nearest first, and the table of their crossings.
#[derive(Clone, Debug, Default)]
pub(crate) struct OffsetTable {
    pub(crate) offsets: Vec<Offset>,
    /// The steps of all offsets in the array of nodes, kept separately: a search scans them far more often than it tests a pair.
    pub(super) node_steps: Vec<isize>,
    pub(super) crossings: Vec<Crossing>,
    kinks: Vec<Kink>,
}

/// The number of offsets and crossings within a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TableSize {
    pub(super) offsets: usize,
    pub(super) crossings: usize,
}

impl OffsetTable {
    /// All node offsets `(columns, rows)` within a range except (0, 0).
    fn within(spacing: Spacing, range_m: f64, bounds: (usize, usize)) -> impl Iterator<Item = (i32, i32)> {
        #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "clamped to the lattice")]
        let reach = |step_m: f64, count: usize| {
            let most = (count.saturating_sub(1)).min(i32::MAX as usize);
            (range_m / (step_m * spacing.stride as f64)).floor().min(most as f64) as i32
        };
        let (across, down) = (reach(spacing.dx_m, bounds.1), reach(spacing.dy_m, bounds.0));
        (-down..=down)
            .flat_map(move |rows| (-across..=across).map(move |cols| (cols, rows)))
            .filter(move |&(cols, rows)| (cols, rows) != (0, 0) && spacing.metres(cols, rows).norm() <= range_m)
    }

    /// The size of a table for a lattice with this many rows and columns of nodes.
    pub(super) fn size(spacing: Spacing, range_m: f64, bounds: (usize, usize)) -> TableSize {
        let mut size = TableSize { offsets: 0, crossings: 0 };
        for (cols, rows) in Self::within(spacing, range_m, bounds) {
            size.offsets += 1;
            let lines = cols.unsigned_abs() as usize + rows.unsigned_abs() as usize + cols.abs_diff(rows) as usize;
            size.crossings += lines * spacing.stride;
        }
        // Every offset shares its crossings with the opposite one.
        size.crossings /= 2;
        size
    }

    /// The bytes that a table of this size holds, at most: a vector that grew holds up to twice what is in it.
    pub(super) fn bytes(offsets: usize, crossings: usize) -> usize {
        let of_offset = size_of::<Offset>() + size_of::<isize>() + size_of::<Kink>();
        2 * (offsets * of_offset + crossings * size_of::<Crossing>())
    }

    /// The bytes that making it holds beside it, at most: half of a vector while it grows, the list of all offsets and the buffer of its
    /// sorting, and the shared ranges.
    pub(super) fn preparation_bytes(offsets: usize, crossings: usize) -> usize {
        let of_offset = 4 * size_of::<(f64, i32, i32)>() + 2 * size_of::<((i32, i32), [Range<usize>; 2])>();
        Self::bytes(offsets, crossings) / 2 + offsets * of_offset + crossings.min(1 << 12) * size_of::<Crossing>()
    }

    /// The table; `rises_m` gives the rises that a distance allows (the offset is left out where the lower one is above the upper).
    pub(crate) fn new(
        spacing: Spacing,
        range_m: f64,
        bounds: (usize, usize),
        clearance: ClearanceProfile,
        rises_m: impl Fn(f64) -> (f64, f64),
    ) -> Self {
        let mut found: Vec<(f64, i32, i32)> =
            Self::within(spacing, range_m, bounds).map(|(cols, rows)| (spacing.metres(cols, rows).norm(), rows, cols)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut table = Self::default();
        let mut shared = HashMap::new();
        for (run_m, rows, cols) in found {
            let allowed = rises_m(run_m);
            if allowed.0 > allowed.1 {
                continue;
            }
            table.push(spacing, (cols, rows), (run_m, clearance), allowed, &mut shared);
        }
        table
    }

    fn push(
        &mut self,
        spacing: Spacing,
        (cols, rows): (i32, i32),
        (run_m, clearance): (f64, ClearanceProfile),
        rises_m: (f64, f64),
        shared: &mut HashMap<(i32, i32), [Range<usize>; 2]>,
    ) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "strides are below the raster's sides")]
        let stride = spacing.stride as i32;
        let (post_cols, post_rows) = (cols * stride, rows * stride);
        let turn = if (rows, cols) < (0, 0) { -1 } else { 1 };
        let (table, kink_table) = (&mut self.crossings, &mut self.kinks);
        let own = shared.entry((cols * turn, rows * turn)).or_insert_with(|| {
            let (first, first_kink) = (table.len(), kink_table.len());
            table.extend(crossings(post_cols * turn, post_rows * turn, run_m, spacing.post_cols, clearance));
            kink_table.extend(kinks(run_m, &table[first..], clearance));
            [first..table.len(), first_kink..kink_table.len()]
        });
        let step = |cols: i32, rows: i32, width: usize| rows as isize * width.cast_signed() + cols as isize;
        self.node_steps.push(step(cols, rows, spacing.node_cols));
        self.offsets.push(Offset {
            cols,
            rows,
            post_step: step(post_cols, post_rows, spacing.post_cols),
            run_m,
            heading: spacing.metres(cols, rows) / run_m,
            crossings: own[0].clone(),
            kinks: own[1].clone(),
            turn: turn as isize,
            departure: facets_towards(cols, rows),
            arrival: facets_towards(-cols, -rows),
            rises_m,
        });
    }

    /// The offset's vertices in the order of travel; their steps must be multiplied by its `turn`.
    pub(super) fn crossings_of(&self, offset: &Offset) -> &[Crossing] {
        &self.crossings[offset.crossings.clone()]
    }

    /// The kinks of a tapered clearance over the offset's line.
    pub(super) fn kinks_of(&self, offset: &Offset) -> &[Kink] {
        &self.kinks[offset.kinks.clone()]
    }
}

impl Spacing {
    /// Distances east and north of an offset in nodes, m.
    #[expect(clippy::cast_precision_loss, reason = "strides stay far below 2^53")]
    pub(super) fn metres(&self, cols: i32, rows: i32) -> Vector2<f64> {
        let stride = self.stride as f64;
        Vector2::new(f64::from(cols) * stride * self.dx_m, -f64::from(rows) * stride * self.dy_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        quantity::MapPoint,
        terrain::{Dem, GeoReference, slice},
    };

    /// The table's vertices have the positions and heights of those of the slice, for every offset of a square.
    #[test]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap, reason = "small numbers")]
    fn crossings_are_those_of_the_slice() {
        const SIDE: usize = 21;
        let heights: Vec<f64> = (0..SIDE * SIDE).map(|i| f64::from((i as u32 * 7919) % 1009) / 64.0).collect();
        let map = GeoReference::local(MapPoint::new(500.0, 900.0), 2.0, 3.0).unwrap();
        let dem = Dem::new(SIDE, SIDE, heights.clone(), map).unwrap();
        let spacing = Spacing { dx_m: 2.0, dy_m: 3.0, stride: 1, node_cols: SIDE, post_cols: SIDE };
        let table = OffsetTable::new(spacing, 30.0, (SIDE, SIDE), ClearanceProfile::NONE, |_| (-1e9, 1e9));
        let (mut compared, middle) = (0, SIDE / 2);
        for offset in &table.offsets {
            let (row, col) = (middle as i32 + offset.rows, middle as i32 + offset.cols);
            if !(0..SIDE as i32).contains(&row) || !(0..SIDE as i32).contains(&col) {
                continue;
            }
            let (from, to) = (dem.georeference().post(middle, middle), dem.georeference().post(row as usize, col as usize));
            let profile = slice(&dem, from, to).unwrap();
            let inner = &profile.points[1..profile.points.len() - 1];
            let found = table.crossings_of(offset);
            assert_eq!(inner.len(), found.len(), "offset ({}, {})", offset.cols, offset.rows);
            for (point, crossing) in inner.iter().zip(found) {
                let start = middle * SIDE + middle;
                let height = |step: i32| heights[start.wrapping_add_signed(offset.turn * step as isize)];
                let z_m = height(crossing.first) + crossing.share * (height(crossing.second) - height(crossing.first));
                assert!((z_m - point.z_m).abs() < 1e-9, "offset ({}, {})", offset.cols, offset.rows);
                assert!((crossing.along * offset.run_m - point.x_m).abs() < 1e-9);
                let (d, e) = (point.x_m, offset.run_m - point.x_m);
                assert!((crossing.stiffness - (1.0 / d + 1.0 / e)).abs() < 1e-9 * crossing.stiffness);
                compared += 1;
            }
            let (first, last) = (profile.facets[0], profile.facets[profile.facets.len() - 1]);
            let grid = |row, col| dem.elevation(row, col).unwrap_or(f64::NAN);
            for (facet, facets, row, col) in
                [(first, offset.departure, middle, middle), (last, offset.arrival, row as usize, col as usize)]
            {
                let steepest = facets
                    .numbers()
                    .filter_map(|number| {
                        let at = |(east, south): (i32, i32)| {
                            let (row, col) = (row as i32 + south, col as i32 + east);
                            ((0..SIDE as i32).contains(&row) && (0..SIDE as i32).contains(&col))
                                .then(|| grid(row as usize, col as usize))
                        };
                        let [east, west, north, south] = super::super::facets::CORNERS[number];
                        Some(((at(east)? - at(west)?) / 2.0).hypot((at(north)? - at(south)?) / 3.0))
                    })
                    .fold(f64::NEG_INFINITY, f64::max);
                assert!((steepest - facet.tilt().slope()).abs() < 1e-9 * (1.0 + steepest), "({}, {})", offset.cols, offset.rows);
            }
        }
        assert!(compared > 4_000, "{compared} vertices compared");
    }
}
