//! The check of what layers of the map cost a path: every cell under a flight by itself.

use super::{Measure, StatedValue, ViolatedLimit, Violation};
use crate::{
    ground::{Layer, MapLayers},
    path::{Hop, HopPath},
    quantity::MapPoint,
};

/// A place within this fraction of a cell of a border lies on it, and the greater value counts.
const BORDER: f64 = 1e-9;

/// Relative tolerance of a total: sums in another order.
const TOLERANCE: f64 = 1e-9;

/// Checks what a path states of every layer that has a cost.
///
/// Each flight is cut here at all borders of cells that it crosses, found one by one and sorted, and every piece is looked up at its middle.
pub(super) fn check(layers: &MapLayers, path: &HopPath, violations: &mut Vec<Violation>) {
    for layer in layers.iter().filter(|layer| layer.rule().cost.is_some()) {
        let flown: f64 = path.hops.iter().filter_map(Hop::map_ends).map(|(from, to)| of_hop(layer, from, to)).sum();
        let stated = path.totals.layers.of(layer.rule().name).unwrap_or(0.0);
        // Written so that NaN and infinite fail.
        let agrees = (stated - flown).abs() <= TOLERANCE * (1.0 + flown);
        if !agrees {
            let measure = Some(Measure { found: stated, allowed: flown, unit: "in the unit of the layer" });
            let limit = ViolatedLimit::StatedValue(StatedValue::LayerCost);
            let at_x_m = path.hops.last().map_or(0.0, |hop| hop.landing.along_m);
            violations.push(Violation { measure, ..Violation::at(path.hops.len(), limit, at_x_m) });
        }
    }
}

fn of_hop(layer: &Layer, from: MapPoint, to: MapPoint) -> f64 {
    let Some(cost) = layer.rule().cost else { return 0.0 };
    let [begin, end] = [from, to].map(|at| cells(layer, at));
    let length_m = libm::hypot(to.x - from.x, to.y - from.y);
    let mut total = if cost.per_contact > 0.0 { cost.per_contact * value(layer, end) } else { 0.0 };
    if cost.per_m > 0.0 {
        let mut cuts = vec![0.0, 1.0];
        for axis in 0..2 {
            let (low, high) = (begin[axis].min(end[axis]), begin[axis].max(end[axis]));
            let borders = std::iter::successors(Some(low.ceil()), |border| Some(border + 1.0)).take_while(|border| *border < high);
            cuts.extend(borders.map(|border| (border - begin[axis]) / (end[axis] - begin[axis])));
        }
        cuts.sort_by(f64::total_cmp);
        for piece in cuts.windows(2) {
            let share = 0.5 * (piece[0] + piece[1]);
            let middle = [0, 1].map(|axis| begin[axis] + share * (end[axis] - begin[axis]));
            if piece[1] > piece[0] {
                total += cost.per_m * length_m * (piece[1] - piece[0]) * value(layer, middle);
            }
        }
    }
    total
}

/// A place in columns and rows of cells, each from one whole number to the next.
fn cells(layer: &Layer, at: MapPoint) -> [f64; 2] {
    let map = layer.raster().georeference();
    [(at.x - map.north_west().x) / map.dx_m() + 0.5, (map.north_west().y - at.y) / map.dy_m() + 0.5]
}

/// The greatest value of the cells that a place touches; NaN where one is not known.
fn value(layer: &Layer, [col, row]: [f64; 2]) -> f64 {
    let raster = layer.raster();
    let both = |at: f64, count: usize| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and the border belongs to it"
        )]
        [at - BORDER, at + BORDER].map(|at| (at.max(0.0) as usize).min(count - 1))
    };
    let (rows, cols) = (both(row, raster.rows()), both(col, raster.cols()));
    let cells = rows.into_iter().flat_map(|row| cols.map(|col| raster.elevation(row, col)));
    cells.fold(0.0, |greatest: f64, value| {
        value.map_or(f64::NAN, |value| if greatest.is_nan() { greatest } else { greatest.max(value) })
    })
}
