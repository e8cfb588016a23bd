//! The check of the layers of the map under one flown hop, cell by cell.

use super::{
    ViolatedLimit,
    checker::{Checker, MAP_TOLERANCE},
};
use crate::{
    ground::{Layer, Surface},
    quantity::MapPoint,
    world::{LayerName, Limit},
};

/// The greatest distance between places under a flight at which layers are looked up, as a share of the flight.
const LAYER_STEP: f64 = 1.0 / 64.0;

/// The same in cells of the layer.
const LAYER_STEP_CELLS: f64 = 0.05;

/// A place within this fraction of a cell of its border may lie on either side of it.
const LAYER_BORDER: f64 = 2e-9;

/// Whether the cell of a layer that holds a place allows it, or one within rounding of the place does.
pub(in crate::path) fn holds_near(layer: &Layer, place: MapPoint) -> bool {
    let (raster, condition) = (layer.raster(), layer.rule().condition);
    let map = raster.georeference();
    let rounding = MAP_TOLERANCE * (place.x.abs() + place.y.abs()) / map.dx_m().min(map.dy_m()) + LAYER_BORDER;
    let [col, row] = [(place.x - map.north_west().x) / map.dx_m(), (map.north_west().y - place.y) / map.dy_m()];
    let both = |at: f64| [(at - rounding).round(), (at + rounding).round()];
    let holds = |row: f64, col: f64| {
        let within = |at: f64, count: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
            (at >= 0.0).then_some(at as usize).filter(|at| *at < count)
        };
        let value = within(row, raster.rows()).zip(within(col, raster.cols())).and_then(|(row, col)| raster.elevation(row, col));
        value.is_some_and(|value| condition.holds(value))
    };
    both(row).into_iter().any(|row| both(col).into_iter().any(|col| holds(row, col)))
}

impl<S: Surface> Checker<'_, S> {
    /// Layers of the map hold at both contacts, and at every place under the flight that small steps look at. Cells are read here by
    /// themselves, in steps, so that a corner of a cell that the flight cuts by less than a step is not noticed; a place within rounding
    /// of a border may lie on either side of it.
    pub(super) fn layers(&mut self) {
        let (takeoff, landing) = (self.hop.takeoff, self.hop.landing);
        let (Some(layers), Some(from), Some(to)) = (self.surface.layers(), takeoff.map(), landing.map()) else { return };
        let place = |share: f64| from + (to - from) * share;
        let mut refused: Vec<(LayerName, f64)> = Vec::new();
        for layer in layers.iter().filter(|layer| layer.rule().outage.is_none()) {
            let rule = layer.rule();
            let map = layer.raster().georeference();
            let cells = ((to.x - from.x) / map.dx_m()).abs() + ((to.y - from.y) / map.dy_m()).abs();
            let step = (LAYER_STEP_CELLS / cells).min(LAYER_STEP);
            let flown = (1..).map(|number| f64::from(number) * step).take_while(|share| rule.on_flight && *share < 1.0);
            let first = [0.0, 1.0].into_iter().chain(flown).find(|share| !holds_near(layer, place(*share)));
            refused.extend(first.map(|share| (rule.name, takeoff.along_m + share * (landing.along_m - takeoff.along_m))));
        }
        for (name, x_m) in refused {
            self.note(ViolatedLimit::Limit(Limit::Layer(name)), None, x_m);
        }
    }
}
