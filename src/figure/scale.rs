//! The transformation from metres to the sheet, with one scale for both axes or a round exaggeration of heights.

use super::sheet::Place;
use crate::quantity::ChainPoint;

/// A drawn height below the first of these is exaggerated; none is above the second, mm.
pub(super) const DRAWN_MM: (f64, f64) = (14.0, 76.0);
/// The smallest fraction of the panel's width that the ground may take if its height sets the scale.
const NARROW: f64 = 0.3;
/// The available exaggerations.
const ROUND: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];

/// The scale of the terrain panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Sheet mm per m along x.
    pub mm_per_m: f64,
    /// Factor of heights; below 1 they are reduced.
    pub exaggeration: f64,
    /// Height of the drawn ground and flights on the sheet, mm.
    pub height_mm: f64,
}

impl Scale {
    /// The scale for ground and flights of a given extent on a panel of a given width.
    ///
    /// True scale if the drawn height is then readable and at most a third of a page; else the least round exaggeration with that
    /// property. For heights far larger than the length the drawing gets narrower, and below a third of the width heights are
    /// reduced.
    pub fn new(length_m: f64, rise_m: f64, width_mm: f64) -> Self {
        Self::within(length_m, rise_m, width_mm, DRAWN_MM)
    }

    /// The same with other bounds of the drawn height: the least and the greatest, mm.
    pub(super) fn within(length_m: f64, rise_m: f64, width_mm: f64, (flat_mm, tall_mm): (f64, f64)) -> Self {
        let wide = width_mm / length_m;
        let true_mm = rise_m * wide;
        if true_mm > tall_mm {
            let share = tall_mm / true_mm;
            let shrunk = ROUND.into_iter().map(|r| 1.0 / r).find(|e| share / e >= NARROW).unwrap_or(0.001);
            let mm_per_m = wide * (share / shrunk).min(1.0);
            return Self { mm_per_m, exaggeration: shrunk, height_mm: rise_m * mm_per_m * shrunk };
        }
        let exaggeration = if true_mm > 0.0 { ROUND.into_iter().find(|e| true_mm * e >= flat_mm).unwrap_or(1000.0) } else { 1.0 };
        Self { mm_per_m: wide, exaggeration, height_mm: true_mm * exaggeration }
    }

    /// The statement on the axis.
    pub fn text(&self) -> String {
        if self.exaggeration == 1.0 {
            "heights at true scale".to_owned()
        } else if self.exaggeration > 1.0 {
            format!("heights exaggerated {:.0} times", self.exaggeration)
        } else {
            format!("heights drawn at 1/{:.0} of the horizontal scale", 1.0 / self.exaggeration)
        }
    }
}

/// A scale with its origin on the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) scale: Scale,
    /// The point of the plane that is drawn at `place`.
    pub(super) origin: ChainPoint,
    pub(super) place: Place,
}

impl Frame {
    /// Where a point is drawn.
    pub(super) fn place(&self, point: ChainPoint) -> Place {
        (
            self.place.0 + (point.x_m - self.origin.x_m) * self.scale.mm_per_m,
            self.place.1 - (point.z_m - self.origin.z_m) * self.scale.mm_per_m * self.scale.exaggeration,
        )
    }

    /// The x at a horizontal position of the sheet, m.
    pub(super) fn x_m(&self, x_mm: f64) -> f64 {
        self.origin.x_m + (x_mm - self.place.0) / self.scale.mm_per_m
    }

    /// The height at a vertical position of the sheet, m.
    pub(super) fn z_m(&self, y_mm: f64) -> f64 {
        self.origin.z_m + (self.place.1 - y_mm) / (self.scale.mm_per_m * self.scale.exaggeration)
    }

    /// A direction of the plane as a unit vector on the sheet.
    pub(super) fn direction(&self, (x, z): (f64, f64)) -> Place {
        let (x, y) = (x, -z * self.scale.exaggeration);
        let length = libm::hypot(x, y);
        (x / length, y / length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readable_heights_stay_true_and_others_get_a_round_factor() {
        let of = |length_m, rise_m| Scale::new(length_m, rise_m, 150.0);
        assert_eq!(of(76.0, 14.0).exaggeration, 1.0, "28 mm high");
        assert_eq!(of(1000.0, 8.0).exaggeration, 20.0, "1.2 mm, 20 times is 24 mm");
        assert_eq!(of(0.01, 0.0).exaggeration, 1.0, "flat ground has no height to exaggerate");
        let tall = of(10.0, 8.0);
        assert!(tall.exaggeration == 1.0 && tall.height_mm <= 76.1, "narrowed, {tall:?}");
        let needle = of(1.0, 50.0);
        assert!(needle.exaggeration < 1.0 && needle.height_mm <= 76.1, "{needle:?}");
        assert!(needle.text().contains("1/50"), "{}", needle.text());
    }
}
