//! The judge of void values: whether a number that programs write where nothing was measured is ground.
//!
//! A file that marks its gaps by a number and does not state it would turn them into pits or peaks. The judge looks at every block
//! of equal values that are usual marks. A block is refused if it lies off the range of the valid values that border it by more than
//! that range: -9999 m between slopes of a trench is ground, a plateau of -9999 m in a plain at 100 m is not.
//!
//! ```text
//!   valid values      100 .. 105          range R = 5
//!   block             -9999               off by 10099 > R: refused
//! ```

use std::collections::HashSet;
use std::fmt;

use super::{TerrainError, stored::Scaling};
use crate::quantity::{MapPoint, format_number};

/// A usual mark of missing data that nothing states and that is not ground either.
#[derive(Clone, Debug, PartialEq)]
pub struct VoidTaken {
    /// Its elevation, m.
    pub z_m: f64,
    /// The number that the file stores.
    pub stored: f64,
    /// Number of values in its block.
    pub count: usize,
    /// The first of them.
    pub place: VoidPlace,
    /// Lowest and highest elevation around the block, m; `None` if there are none.
    pub border_m: Option<(f64, f64)>,
}

/// A place of terrain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VoidPlace {
    /// A post of a raster.
    Post {
        /// From 0, from the north.
        row: usize,
        /// From 0, from the west.
        col: usize,
        /// On the map.
        at: MapPoint,
    },
    /// A vertex of a mesh.
    Vertex {
        /// From 1, in the order of the file.
        number: usize,
    },
}

impl VoidTaken {
    /// What was found, without the ways out.
    pub fn found(&self) -> String {
        let Self { z_m, stored, count, place, border_m } = self;
        let scaled = if stored == z_m { String::new() } else { format!(" (stored as {})", format_number(*stored)) };
        let (one, many) = match place {
            VoidPlace::Post { .. } => ("post", "posts"),
            VoidPlace::Vertex { .. } => ("vertex", "vertices"),
        };
        let (block, first) = if *count == 1 { (one, "") } else { (many, "first ") };
        let place = match place {
            VoidPlace::Post { row, col, at } => {
                let (x_m, y_m) = (format_number(at.x), format_number(at.y));
                format!("at row {row}, column {col} (from 0, from the north-west), map point ({x_m} m, {y_m} m)")
            }
            VoidPlace::Vertex { number } => format!("number {number} of the file"),
        };
        let compared = match border_m {
            Some((low, high)) => {
                let off = if z_m < low { low - z_m } else { z_m - high };
                let [off, low, high] = [off, *low, *high].map(format_number);
                format!("lies {off} off the {many} around ({low} to {high})")
            }
            None => format!("has no {many} around that it could be compared with"),
        };
        format!(
            "{}{scaled} of {count} {block}, {first}{place}, {compared} and is a usual mark of missing data",
            format_number(*z_m)
        )
    }
}

impl fmt::Display for VoidTaken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = format_number(self.stored);
        write!(
            f,
            "the elevation {}, expected elevations, or missing data that is stated; state what it is: terrain.no_data = {value} where it \
             marks missing data, or terrain.no_data = \"none\" where it is an elevation",
            self.found()
        )
    }
}

/// The numbers that programs write for missing elevations, in the order of how often they are met.
///
/// Numbers of 1e9 and above are no elevations in any case ([`ELEVATION_LIMIT_M`](super::ELEVATION_LIMIT_M)).
const USUAL_MARKS: [f64; 45] = [
    -9999.0,
    -32768.0,
    -32767.0,
    -99999.0,
    -10000.0,
    -999.0,
    -9999.9,
    -9999.99,
    -9999.999,
    -99999.9,
    -99999.99,
    -999.9,
    -999.99,
    -999.25,
    -999_999.0,
    -9_999_999.0,
    -99_999_999.0,
    -999_999_999.0,
    -100_000.0,
    -1_000_000.0,
    -32766.0,
    -32765.0,
    -32764.0,
    -32752.0,
    -32000.0,
    -30000.0,
    -20000.0,
    -50000.0,
    -88888.0,
    -77777.0,
    -8888.0,
    -7777.0,
    -5555.0,
    32767.0,
    32766.0,
    32768.0,
    65535.0,
    65534.0,
    55537.0,
    9999.0,
    99999.0,
    999_999.0,
    100_000.0,
    1_000_000.0,
    16_777_216.0,
];

/// The marks that are met after a conversion of units, and the conversions: kilometres, feet, US survey feet to metres.
const CONVERTED_MARKS: [f64; 5] = [-9999.0, -32768.0, -32767.0, -99999.0, -10000.0];
const CONVERSIONS: [f64; 3] = [1000.0, 0.3048, 1200.0 / 3937.0];

/// Zero is what programs fill with that know no mark. It is a height of its own right, so it is a mark only this far off, m.
const ZERO_OFF_M: f64 = 1000.0;

/// A value within this fraction of a mark equals it: what casts to 32 bits and scalings leave of it.
const ROUNDING: f64 = 1.0e-6;

/// A block is ground if it is within this of its border, m: the step of elevations in whole metres.
const WHOLE_METRE_M: f64 = 1.0;

/// Ground within this fraction of a mark's own size reaches the mark by its slopes: a trench at -9999 m in ground at -9950 m.
const NEAR_THE_MARK: f64 = 0.01;

/// A border that is reached by this slope or less, as a ratio, can be natural relief: there the values behind it count as well.
const GENTLE: f64 = 1.0;

/// Resampling smears a void over the posts around it, so that its border is no ground. At this many posts from the block the ground is
/// itself again; if all of it is off the block by more than its range and by a slope of over [`WALLED`], the block is a void.
const RIM_POSTS: usize = 4;
const WALLED: f64 = 2.0;

/// A block of values that are a usual mark and are not ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Void {
    /// The index of its first value.
    pub(crate) first: usize,
    /// Number of its values.
    pub(crate) count: usize,
    /// Its elevation, m.
    pub(crate) z_m: f64,
    /// The number that is stored.
    pub(crate) stored: f64,
    /// Lowest and highest valid value on its border; `None` if nothing borders it.
    pub(crate) border_m: Option<(f64, f64)>,
}

impl Void {
    /// The refusal of the block, whose first value lies at a place.
    pub(super) fn taken(self, place: VoidPlace) -> TerrainError {
        let Self { count, z_m, stored, border_m, .. } = self;
        TerrainError::Void(Box::new(VoidTaken { z_m, stored, count, place, border_m }))
    }
}

/// The marks that some values could be.
pub(super) struct Marks {
    /// In the order of their elevations.
    marks: Vec<Mark>,
}

/// A mark: its elevation, the number that is stored, and the size of that number in metres.
#[derive(Clone, Copy, Debug)]
struct Mark {
    z_m: f64,
    stored: f64,
    size_m: f64,
}

impl Mark {
    fn is(&self, z_m: f64) -> bool {
        (z_m - self.z_m).abs() <= ROUNDING * self.z_m.abs()
    }
}

impl Marks {
    /// The usual marks of a raster within a range of elevations, zero among them: as elevations, and as numbers that were stored
    /// before scaling.
    pub(super) fn of_raster(range_m: (f64, f64), scaling: Scaling) -> Self {
        Self::chosen(range_m, scaling, Some(0.0))
    }

    /// The same of a chain or a mesh, which no program fills with zeros.
    pub(super) fn within(range_m: (f64, f64), scaling: Scaling) -> Self {
        Self::chosen(range_m, scaling, None)
    }

    fn chosen((low_m, high_m): (f64, f64), scaling: Scaling, zero: Option<f64>) -> Self {
        let converted = CONVERTED_MARKS.into_iter().flat_map(|mark| CONVERSIONS.map(|factor| mark * factor));
        let all = USUAL_MARKS.into_iter().chain(converted).chain(zero);
        let both = all.flat_map(|mark| {
            let as_stored = Mark { z_m: scaling.apply(mark), stored: mark, size_m: (mark * scaling.scale).abs() };
            [as_stored, Mark { z_m: mark, stored: scaling.stored(mark), size_m: mark.abs() }]
        });
        let room = |z_m: f64| z_m.abs() * ROUNDING;
        let within = |mark: &Mark| mark.z_m >= low_m - room(mark.z_m) && mark.z_m <= high_m + room(mark.z_m);
        let mut marks: Vec<Mark> = both.filter(within).collect();
        marks.sort_by(|a, b| a.z_m.total_cmp(&b.z_m));
        marks.dedup_by(|later, first| first.is(later.z_m));
        Self { marks }
    }

    /// The number of the mark that a value equals.
    pub(super) fn find(&self, z_m: f64) -> Option<usize> {
        let above = self.marks.partition_point(|mark| mark.z_m < z_m);
        [above.checked_sub(1), Some(above)].into_iter().flatten().find(|&at| self.marks.get(at).is_some_and(|mark| mark.is(z_m)))
    }

    /// Whether some values have a mark among them, in one pass that takes little time beside reading them.
    pub(super) fn are_in<T: Copy + Into<f64>>(&self, values: &[T]) -> bool {
        // A piece of the values stays in the cache while each mark is looked for.
        values.chunks(4096).any(|piece| {
            self.marks.iter().any(|mark| {
                let (z_m, room) = (mark.z_m, ROUNDING * mark.z_m.abs());
                piece.iter().fold(false, |found, &value| found | ((value.into() - z_m).abs() <= room))
            })
        })
    }
}

/// The first block of values that is a mark and not ground, of `count` values with neighbours.
///
/// `value` is NaN for a gap; `neighbours` calls its second argument with the index of each neighbour. Blocks of one value are judged
/// by the valid values around them, and blocks of several different marks side by side as a whole.
pub(super) fn find_void(
    count: usize,
    marks: &Marks,
    spacing_m: f64,
    value: impl Fn(usize) -> f64,
    neighbours: impl Fn(usize, &mut dyn FnMut(usize)),
) -> Option<Void> {
    let around = Around { count, marks, spacing_m, value: &value, neighbours: &neighbours };
    let marked: Vec<usize> = (0..count).filter(|&index| marks.find(value(index)).is_some()).collect();
    if marked.is_empty() {
        return None;
    }
    let mut seen = vec![false; count];
    for alone in [true, false] {
        seen.fill(false);
        for &first in &marked {
            let Some(mark) = marks.find(value(first)).filter(|_| !seen[first]) else { continue };
            let belongs = |z_m: f64| if alone { marks.find(z_m) == Some(mark) } else { marks.find(z_m).is_some() };
            let block = Block::from(first, &mut seen, &value, &neighbours, belongs);
            if !alone && block.extent_m.0 == block.extent_m.1 {
                continue;
            }
            if let Err(OffBorder(border_m)) = block.check(&around) {
                return Some(Void {
                    first,
                    count: block.values.len(),
                    z_m: value(first),
                    stored: marks.marks[mark].stored,
                    border_m,
                });
            }
        }
    }
    None
}

/// The border, lowest and highest, m, that a block lies off; `None` if there is no valid value at all.
struct OffBorder(Option<(f64, f64)>);

/// Connected values, and the valid ones around them.
struct Block {
    /// Lowest and highest of its values, m.
    extent_m: (f64, f64),
    /// Lowest and highest value around it, m; `None` if all around are gaps.
    border_m: Option<(f64, f64)>,
    /// The indices of the block's values.
    values: Vec<usize>,
}

impl Block {
    fn from(
        first: usize,
        seen: &mut [bool],
        value: &impl Fn(usize) -> f64,
        neighbours: &impl Fn(usize, &mut dyn FnMut(usize)),
        belongs: impl Fn(f64) -> bool,
    ) -> Self {
        let mut block = Self { extent_m: (value(first), value(first)), border_m: None, values: Vec::new() };
        let mut waiting = vec![first];
        seen[first] = true;
        while let Some(index) = waiting.pop() {
            block.values.push(index);
            block.extent_m = wider(Some(block.extent_m), value(index));
            neighbours(index, &mut |near| {
                let z_m = value(near);
                if z_m.is_nan() {
                } else if !belongs(z_m) {
                    block.border_m = Some(wider(block.border_m, z_m));
                } else if !seen[near] {
                    seen[near] = true;
                    waiting.push(near);
                }
            });
        }
        block
    }

    /// Checks that the block is ground. Without a border, all values that are no marks are the border.
    fn check<V: Fn(usize) -> f64, N: Fn(usize, &mut dyn FnMut(usize))>(&self, around: &Around<'_, V, N>) -> Result<(), OffBorder> {
        let Around { count, marks, spacing_m, value, .. } = *around;
        let elsewhere = || {
            let valid = (0..count).map(value).filter(|z_m| !z_m.is_nan() && marks.find(*z_m).is_none());
            valid.fold(None, |range, z_m| Some(wider(range, z_m)))
        };
        let is_zero = self.extent_m == (0.0, 0.0);
        let Some(border_m) = self.border_m.or_else(elsewhere) else {
            // Zeros everywhere are a plain, or a mask without a zone.
            return if is_zero { Ok(()) } else { Err(OffBorder(None)) };
        };
        let off_m = |(low_m, high_m): (f64, f64)| (low_m - self.extent_m.1).max(self.extent_m.0 - high_m);
        let range = |(low_m, high_m): (f64, f64)| high_m - low_m;
        let least_m = if is_zero { ZERO_OFF_M } else { WHOLE_METRE_M };
        let off = off_m(border_m);
        let size_m = marks.find(self.extent_m.0).map_or(0.0, |mark| marks.marks[mark].size_m);
        let is_near = off <= NEAR_THE_MARK * size_m;
        if off > range(border_m).max(least_m) && !is_near {
            let behind = if off <= GENTLE * spacing_m { around.ring(&self.values, 2) } else { None };
            if behind.is_none_or(|wide| off_m(wide) > 2.0 * range(wide)) {
                return Err(OffBorder(Some(border_m)));
            }
        } else if !is_near && range(border_m) > WALLED * spacing_m {
            // A border that is steep itself can be the smeared rim of a void.
            let Some(outside) = around.ring(&self.values, RIM_POSTS) else { return Ok(()) };
            #[expect(clippy::cast_precision_loss, reason = "a small constant")]
            let walled_m = WALLED * spacing_m * RIM_POSTS as f64;
            if off_m(outside) > range(outside).max(least_m).max(walled_m) {
                return Err(OffBorder(Some(outside)));
            }
        }
        Ok(())
    }
}

/// The values that a block is judged among.
struct Around<'a, V, N> {
    count: usize,
    marks: &'a Marks,
    spacing_m: f64,
    value: &'a V,
    neighbours: &'a N,
}

impl<V: Fn(usize) -> f64, N: Fn(usize, &mut dyn FnMut(usize))> Around<'_, V, N> {
    /// Lowest and highest of the values that are so many steps from a block, and no mark; for 2 steps, of those up to there.
    fn ring(&self, block: &[usize], steps: usize) -> Option<(f64, f64)> {
        let mut seen: HashSet<usize> = block.iter().copied().collect();
        let mut front = block.to_vec();
        let mut found = None;
        for step in 1..=steps {
            let mut next = Vec::new();
            for index in front {
                (self.neighbours)(index, &mut |near| {
                    if seen.insert(near) {
                        next.push(near);
                    }
                });
            }
            if step == steps || steps == 2 {
                let values = next.iter().map(|index| (self.value)(*index));
                found = values
                    .filter(|z_m| !z_m.is_nan() && self.marks.find(*z_m).is_none())
                    .fold(found, |range, z_m| Some(wider(range, z_m)));
            }
            front = next;
        }
        found
    }
}

fn wider(range: Option<(f64, f64)>, z_m: f64) -> (f64, f64) {
    range.map_or((z_m, z_m), |(low, high)| (low.min(z_m), high.max(z_m)))
}

/// The neighbours of a post of a raster, diagonals included.
pub(super) fn around((rows, cols): (usize, usize), index: usize, visit: &mut dyn FnMut(usize)) {
    let (row, col) = (index / cols, index % cols);
    for near_row in row.saturating_sub(1)..=(row + 1).min(rows - 1) {
        for near_col in col.saturating_sub(1)..=(col + 1).min(cols - 1) {
            if (near_row, near_col) != (row, col) {
                visit(near_row * cols + near_col);
            }
        }
    }
}

/// A block of vertices of a chain that are a usual mark of missing data and no ground, judged by the vertices beside it.
///
/// `spacing_m` is a typical distance of neighbours.
pub(crate) fn find_void_of_chain(z_m: &[f64], spacing_m: f64) -> Option<Void> {
    let range = z_m.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(*z_m), high.max(*z_m)));
    let marks = Marks::within(range, Scaling::NONE);
    find_void(z_m.len(), &marks, spacing_m, |index| z_m[index], |index, visit| beside(z_m.len(), index, visit))
}

/// The neighbours of a vertex of a chain.
fn beside(count: usize, index: usize, visit: &mut dyn FnMut(usize)) {
    if index > 0 {
        visit(index - 1);
    }
    if index + 1 < count {
        visit(index + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAP: f64 = f64::NAN;

    /// Lines of values, and the block that is not ground. The rule decides by hand: off the border by more than its range, and more
    /// than 1 m.
    #[test]
    fn blocks_are_judged_by_their_border() {
        for (values, void) in [
            (&[100.0, -9999.0, -9999.0, 105.0][..], Some((1, 2))),
            (&[100.0, -32768.0, 105.0], Some((1, 1))),
            (&[100.0, 32767.0], Some((1, 1))),
            (&[100.0, f64::from(-9999.9_f32), 105.0], Some((1, 1))),
            // A trench, a spike within the range of its border, and one step beside a plain at the same height.
            (&[-9990.0, -9999.0, -10005.0], None),
            (&[-9998.0, -9999.0, -10000.0], None),
            (&[-9998.0, -9999.0, -10000.0, -10001.0], None),
            (&[-9998.0, -9998.0, -9999.0, -9998.0], None),
            (&[-9990.0, -9993.0, -9996.0, -9999.0], None),
            (&[-9000.0, -9001.0, -9999.0], Some((2, 1))),
            // A flat floor at the mark, in a plain 9 m above it.
            (&[-9990.0, -9990.4, -9999.0, -9999.0, -9990.2], None),
            // A crater floor: natural relief, as steep as the relief around.
            (&[-997.5, -998.0, -999.0, -997.9], None),
            // A void smeared by resampling: its rim is no ground.
            (&[100.0, 101.0, 103.0, 100.0, -55.0, -4700.0, -9999.0, -9999.0, -4800.0, -60.0, 101.0, 104.0, 100.0], Some((6, 2))),
            // Zeros of a chain are heights; marks in feet and kilometres, converted with their file.
            (&[-2500.0, 0.0, 0.0, -2490.0], None),
            (&[328.0, -3047.6952, 330.0], Some((1, 1))),
            (&[2000.0, -9_999_000.0, 2100.0], Some((1, 1))),
            (&[10.0, -9999.0, -21000.0], None),
            // Two marks side by side are judged together: neither vouches for the other.
            (&[100.0, -9999.0, -10000.0, 105.0], Some((1, 2))),
            (&[100.0, -9999.0, -32768.0, -9999.0, 105.0], Some((2, 1))),
            // Gaps all around: what is valid elsewhere decides; nothing at all does not vouch.
            (&[100.0, GAP, -9999.0, GAP, 105.0], Some((2, 1))),
            (&[-9999.0, -9999.0], Some((0, 2))),
            (&[-9998.5, -9997.0, -9999.5], None),
        ] {
            assert_eq!(find_void_of_chain(values, 1.0).map(|void| (void.first, void.count)), void, "{values:?}");
        }
    }

    #[test]
    fn a_mark_that_was_scaled_is_found_by_its_stored_number() {
        let scaling = Scaling { scale: 0.5, offset_m: 1000.0 };
        let values = [1010.0, scaling.apply(-32768.0), 1012.0];
        let marks = Marks::within((-15384.0, 1012.0), scaling);
        let void = find_void(3, &marks, 1.0, |index| values[index], |index, visit| beside(3, index, visit)).unwrap();
        assert_eq!((void.first, void.stored, void.border_m), (1, -32768.0, Some((1010.0, 1012.0))));
    }

    #[test]
    fn blocks_of_a_raster_join_over_diagonals() {
        let mut posts = [5.0; 25];
        (posts[6], posts[12], posts[18]) = (-9999.0, -9999.0, -9999.0);
        let marks = Marks::within((-9999.0, 5.0), Scaling::NONE);
        let void = find_void(25, &marks, 1.0, |index| posts[index], |index, visit| around((5, 5), index, visit)).unwrap();
        assert_eq!((void.first, void.count), (6, 3));
    }
}
