//! The cells of a raster along a straight line, and the test whether two rasters have the same map.

use nalgebra::Vector2;

use super::line::{Line, Stretch};
use crate::{
    quantity::MapPoint,
    terrain::{CoordinateSystem, Dem, MapBounds},
};

/// The values of the cells that contain part of a line: one, or both sides' if it runs along a border.
pub(super) type CellValues = Vec<Option<f64>>;

/// Divides a line at the cell borders; each part has the values of its cells. A pixel's value applies to its cell, half a
/// spacing in every direction from its post; beyond the outermost cells there are no values.
///
/// A border within the line's tolerance of the middle of a part counts as a border along the part.
pub(super) fn cells_on(line: &Line, raster: &Dem) -> Vec<Stretch<CellValues>> {
    let map = raster.georeference();
    let steps = [map.dx_m(), map.dy_m()];
    let place = |along_m: f64| {
        let at = line.map_point(along_m);
        [(at.x - map.north_west().x) / steps[0] + 0.5, (map.north_west().y - at.y) / steps[1] + 0.5]
    };
    let counts = [raster.cols(), raster.rows()];
    let (begin, end) = (place(0.0), place(line.length_m));
    let mut cuts = vec![0.0, line.length_m];
    for axis in 0..2 {
        cuts.extend(border_shares(begin[axis], end[axis], counts[axis]).map(|share| share * line.length_m));
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|next, kept| *next - *kept <= line.tolerance_m);
    if let Some(last) = cuts.last_mut() {
        *last = line.length_m;
    }
    cuts.windows(2)
        .map(|pair| {
            let middle = place(0.5 * (pair[0] + pair[1]));
            let of_axis = |axis: usize| indices(middle[axis], line.tolerance_m / steps[axis], counts[axis]);
            let cols = of_axis(0);
            let values = of_axis(1).iter().flat_map(|&row| cols.iter().map(move |&col| raster.elevation(row, col))).collect();
            Stretch { from_m: pair[0], to_m: pair[1], value: values }
        })
        .collect()
}

/// The values of the cells that contain a position: one, or those on both sides of a border (within 1e-9 of a cell); none off
/// the raster.
pub(super) fn cells_at(at: MapPoint, raster: &Dem) -> impl Iterator<Item = Option<f64>> + '_ {
    let map = raster.georeference();
    let place = [(at.x - map.north_west().x) / map.dx_m() + 0.5, (map.north_west().y - at.y) / map.dy_m() + 0.5];
    let [cols, rows] = place.map(|value| [(value - NEAR_A_BORDER).floor(), (value + NEAR_A_BORDER).floor()]);
    let both = |[low, high]: [f64; 2]| [Some(low), (high != low).then_some(high)].into_iter().flatten().filter_map(as_index);
    both(rows).flat_map(move |row| both(cols).map(move |col| (row, col))).filter_map(|(row, col)| {
        let inside = row < raster.rows() && col < raster.cols();
        inside.then(|| raster.elevation(row, col))
    })
}

/// A position within this fraction of a cell of its border is on the border.
const NEAR_A_BORDER: f64 = 1e-9;

/// A non-negative integer as an index.
pub(super) fn as_index(whole: f64) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
    (whole >= 0.0).then_some(whole as usize)
}

/// The fractions of the way from `begin` to `end` at which a coordinate crosses the borders 0, 1, .. `count` of cells.
fn border_shares(begin: f64, end: f64, count: usize) -> impl Iterator<Item = f64> {
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    let last = count as f64;
    let (low, high) = (begin.min(end).max(0.0).ceil(), begin.max(end).min(last).floor());
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the count of rows or columns")]
    let borders = if low <= high && begin != end { low as u64..high as u64 + 1 } else { 0..0 };
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    borders.map(move |border| ((border as f64 - begin) / (end - begin)).clamp(0.0, 1.0))
}

/// The indices below `count` of the cells that contain a coordinate: two on a border, none outside.
fn indices(place: f64, near: f64, count: usize) -> Vec<usize> {
    let border = place.round();
    let candidates = if (place - border).abs() <= near { vec![border - 1.0, border] } else { vec![place.floor()] };
    candidates.into_iter().filter_map(as_index).filter(|cell| *cell < count).collect()
}

/// Calls `visit` with the border of every two neighbouring cells with different values of `of`; beyond the raster there is no
/// value.
pub(super) fn borders_of<T: PartialEq>(raster: &Dem, of: &dyn Fn(Option<f64>) -> T, visit: &mut dyn FnMut(MapBounds)) {
    let map = raster.georeference();
    let cell = Vector2::new(map.dx_m(), map.dy_m());
    let (rows, cols) = (raster.rows(), raster.cols());
    // The cell before the first of a row or column, and the one after its last, have no value.
    let value = |row: usize, col: usize| match (row.checked_sub(1), col.checked_sub(1)) {
        (Some(row), Some(col)) => of(raster.elevation(row, col)),
        _ => of(None),
    };
    for row in 0..=rows {
        for col in 0..=cols {
            let here = value(row, col);
            // The corner shared by this cell and those to the east, south and south-east.
            let corner = map.north_west() + Vector2::new(as_f64(col) * cell.x - 0.5 * cell.x, 0.5 * cell.y - as_f64(row) * cell.y);
            if here != value(row, col + 1) {
                visit(MapBounds { min: corner, max: corner + Vector2::new(0.0, cell.y) });
            }
            if here != value(row + 1, col) {
                visit(MapBounds { min: corner - Vector2::new(cell.x, 0.0), max: corner });
            }
        }
    }
}

#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
fn as_f64(index: usize) -> f64 {
    index as f64
}

/// Whether part of a line lies on a raster.
pub(super) fn is_on(stretches: &[Stretch<CellValues>]) -> bool {
    stretches.iter().any(|stretch| !stretch.value.is_empty())
}

/// Whether some cell with data of a kind lies in a rectangle of the map.
pub(super) fn has_cell(raster: &Dem, bounds: MapBounds, kind: &dyn Fn(f64) -> bool) -> bool {
    let map = raster.georeference();
    let half = Vector2::new(0.5 * map.dx_m(), 0.5 * map.dy_m());
    cell_bounds(raster).meets(bounds)
        && raster.elevations().enumerate().any(|(index, value)| {
            let post = || map.post(index / raster.cols(), index % raster.cols());
            value.is_some_and(kind) && MapBounds { min: post() - half, max: post() + half }.meets(bounds)
        })
}

/// The rectangle of a raster's cells.
pub(super) fn cell_bounds(raster: &Dem) -> MapBounds {
    let MapBounds { min, max } = raster.bounds();
    let half = Vector2::new(0.5 * raster.georeference().dx_m(), 0.5 * raster.georeference().dy_m());
    MapBounds { min: min - half, max: max + half }
}

/// Keys of a GeoTIFF that must agree for two files with the same map: kind of coordinates, code of the projection, ellipsoid,
/// method, unit and parameters of the projection (OGC GeoTIFF 1.1).
const KEYS_OF_A_MAP: [u16; 26] = [
    1024, 3072, 2057, 2058, 2059, 3075, 3076, 3077, 3078, 3079, 3080, 3081, 3082, 3083, 3084, 3085, 3086, 3087, 3088, 3089, 3090,
    3091, 3092, 3093, 3094, 3095,
];

/// "User-defined", which carries no information.
const USER_DEFINED: f64 = 32767.0;

/// The first difference between two maps, as a phrase; `None` if they agree in all keys that both state.
pub(super) fn disagreement(of_zones: &CoordinateSystem, of_terrain: &CoordinateSystem) -> Option<String> {
    KEYS_OF_A_MAP.into_iter().find_map(|key| {
        let (found, expected) = (value_of(of_zones, key)?, value_of(of_terrain, key)?);
        let same = (found - expected).abs() <= 1e-9 * found.abs().max(expected.abs());
        (!same).then(|| format!("GeoTIFF key {key} is {found} in it and {expected} in the terrain"))
    })
}

/// The number of a `GeoKey`; `None` if it is absent, not a number or user-defined.
fn value_of(system: &CoordinateSystem, wanted: u16) -> Option<f64> {
    let entry = system.key_directory.chunks_exact(4).skip(1).find(|entry| entry[0] == wanted)?;
    let value = match entry[1] {
        0 => Some(f64::from(entry[3])),
        34736 => system.double_parameters.get(usize::from(entry[3])).copied(),
        _ => None,
    };
    value.filter(|value| *value != USER_DEFINED)
}
