//! What layers cost: their values at landings, and along the ground under flights.

use super::{Layer, MapLayers, Track, cells_in};
use crate::{quantity::MapPoint, terrain::Dem, world::LayerName};

/// The first cell with a negative value, by rows: row, column and value.
pub(super) fn first_negative(raster: &Dem) -> Option<(usize, usize, f64)> {
    let cells = (0..raster.rows()).flat_map(|row| (0..raster.cols()).map(move |col| (row, col)));
    cells.filter_map(|(row, col)| Some((row, col, raster.elevation(row, col)?))).find(|(.., value)| *value < 0.0)
}

/// The borders of cells that one coordinate of a line crosses, one after the other, as shares of the way.
struct Crossings {
    from: f64,
    by: f64,
    /// The next border; infinite if the coordinate never changes.
    next: f64,
}

impl Crossings {
    fn of(track: &Track, axis: usize) -> Self {
        let (from, by) = (track.from[axis], track.by[axis]);
        let next = if by > 0.0 { from.floor() + 1.0 } else { from.ceil() - 1.0 };
        Self { from, by, next: if by == 0.0 { f64::INFINITY } else { next } }
    }

    fn share(&self) -> f64 {
        if self.next.is_finite() { (self.next - self.from) / self.by } else { f64::INFINITY }
    }

    /// Goes on beyond all borders up to a share of the way.
    fn pass(&mut self, share: f64) {
        while self.share() <= share {
            self.next += self.by.signum();
        }
    }
}

impl Layer {
    /// What a hop costs from a take-off to a landing: the value at the landing, and the integral of the values along the straight line
    /// under the flight, each times its factor. The greatest value counts on a border of cells. 0 for a layer without a cost, and infinite
    /// where a value is not known.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{LayerCondition, LayerCost, LayerRule, read_layer}, world::LayerName};
    /// let folder = tempfile::tempdir()?;
    /// let file = folder.path().join("hazard.asc");
    /// std::fs::write(&file, "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n0 4 1\n0 0 0\n")?;
    /// let cost = Some(LayerCost { per_contact: 10.0, per_m: 0.5, total_max: None });
    /// let (name, condition) = (LayerName::new("hazard").unwrap(), LayerCondition::default());
    /// let hazard = read_layer(&file, LayerRule { name, condition, on_contact: false, on_flight: false, outage: None, cost }, None)?;
    /// // 10 m over 4, then 5 m over 1, and a landing on 1.
    /// assert_eq!(hazard.cost_of_hop(MapPoint::new(5.0, 15.0), MapPoint::new(25.0, 15.0)), 0.5 * 45.0 + 10.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn cost_of_hop(&self, from: MapPoint, to: MapPoint) -> f64 {
        let Some(cost) = self.rule.cost else { return 0.0 };
        let landing = if cost.per_contact > 0.0 { cost.per_contact * self.greatest_at(self.track(to, to).from) } else { 0.0 };
        let flight = if cost.per_m > 0.0 { cost.per_m * self.integral(from, to) } else { 0.0 };
        landing + flight
    }

    /// The greatest value of the cells that a place of columns and rows touches; infinite where one is not known.
    fn greatest_at(&self, [col, row]: [f64; 2]) -> f64 {
        let counts = (self.raster.cols(), self.raster.rows());
        let (Some(cols), Some(rows)) = (cells_in([col, col], counts.0), cells_in([row, row], counts.1)) else {
            return f64::INFINITY;
        };
        let cells = rows.flat_map(|row| cols.clone().map(move |col| (row, col)));
        cells.map(|(row, col)| self.raster.elevation(row, col).unwrap_or(f64::INFINITY)).fold(0.0, f64::max)
    }

    /// The integral of the values along a straight line on the map, by the metre.
    fn integral(&self, from: MapPoint, to: MapPoint) -> f64 {
        let track = self.track(from, to);
        let mut borders = [0, 1].map(|axis| Crossings::of(&track, axis));
        let (mut begin, mut mean) = (0.0, 0.0);
        while begin < 1.0 {
            let end = borders[0].share().min(borders[1].share()).min(1.0);
            if end > begin {
                let middle = 0.5 * (begin + end);
                mean += (end - begin) * self.greatest_at([0, 1].map(|axis| track.from[axis] + middle * track.by[axis]));
                begin = end;
            }
            for border in &mut borders {
                border.pass(begin);
            }
        }
        mean * (to - from).norm()
    }
}

impl MapLayers {
    /// Whether a layer has a cost.
    pub(crate) fn have_costs(&self) -> bool {
        self.iter().any(|layer| layer.rule.cost.is_some())
    }

    /// What a hop costs by each layer that has a cost.
    pub(crate) fn costs_of_hop(&self, from: MapPoint, to: MapPoint) -> impl Iterator<Item = (LayerName, f64)> {
        let with_cost = self.iter().filter(|layer| layer.rule.cost.is_some());
        with_cost.map(move |layer| (layer.rule.name, layer.cost_of_hop(from, to)))
    }
}
