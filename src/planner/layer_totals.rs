//! What a path takes of a few layers.

use crate::world::LayerName;

/// A number for each of a few layers, in the order of their names: what a path costs by them, or how much it may.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct LayerTotals([Option<(LayerName, f64)>; Self::MOST]);

impl LayerTotals {
    /// The most layers with a cost: labels of a search carry a number for each.
    pub const MOST: usize = 4;

    /// Of no layer.
    pub const NONE: Self = Self([None; Self::MOST]);

    /// The number of a layer; `None` if it has none.
    #[inline]
    pub fn of(&self, layer: LayerName) -> Option<f64> {
        self.iter().find(|(known, _)| *known == layer).map(|(_, total)| total)
    }

    /// The layers with their numbers.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (LayerName, f64)> + '_ {
        self.0.iter().map_while(|known| *known)
    }

    /// The same with another number of a layer. Beyond [`MOST`](Self::MOST) layers the last by name is left out; no scenario has more.
    ///
    /// ```
    /// use chta::{planner::LayerTotals, world::LayerName};
    /// let [cold, hazard] = ["cold", "hazard"].map(|name| LayerName::new(name).unwrap());
    /// let totals = LayerTotals::NONE.with(hazard, 2.0).with(cold, 1.0).with(hazard, 3.0);
    /// assert_eq!(totals.iter().collect::<Vec<_>>(), [(cold, 1.0), (hazard, 3.0)]);
    /// ```
    #[must_use]
    pub fn with(mut self, layer: LayerName, total: f64) -> Self {
        let mut placed = Some((layer, total));
        for known in &mut self.0 {
            match (*known, placed) {
                (Some((name, _)), Some((new, _))) if name < new => {}
                (Some((name, _)), Some((new, _))) if name == new => {
                    *known = placed;
                    return self;
                }
                (Some(_), Some(_)) => std::mem::swap(known, &mut placed),
                (None, _) => {
                    *known = placed;
                    return self;
                }
                (Some(_), None) => return self,
            }
        }
        self
    }

    /// The sums with those of what follows.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        next.iter().fold(*self, |sums, (layer, total)| sums.with(layer, sums.of(layer).unwrap_or(0.0) + total))
    }

    /// Those of so many alike.
    #[must_use]
    pub fn times(&self, count: f64) -> Self {
        Self(self.0.map(|known| known.map(|(layer, total)| (layer, total * count))))
    }
}
