//! What a map lays over the facets of a DEM: zones, layers, a friction raster, and where no elevation is known.
//!
//! ```text
//!     root o- - - - - - - -o root      the strip under a flight, as wide as the trunk: lines no farther apart than the posts are, so that a
//!          |===============|           post without an elevation voids the triangles around it, a convex hexagon that does not fit between two
//!                                      lines; and a line across each end
//! ```

use nalgebra::Vector2;

use crate::{
    quantity::MapPoint,
    terrain::{OverlaidDem, Triangles},
    world::{FrictionCone, Limit},
};

/// A DEM whose facets are the ground of a robot with legs, with its overlays.
#[derive(Clone, Debug)]
pub struct StanceMap {
    terrain: OverlaidDem,
    has_gaps: bool,
}

impl StanceMap {
    /// The map of a DEM with its overlays.
    pub fn new(terrain: OverlaidDem) -> Self {
        let has_gaps = terrain.dem().elevations().any(|z_m| z_m.is_none());
        Self { terrain, has_gaps }
    }

    /// The DEM and its overlays.
    pub const fn terrain(&self) -> &OverlaidDem {
        &self.terrain
    }

    /// Whether no foot may stand at a position: it is kept out, or a layer does not hold.
    pub fn keeps_feet_off(&self, at: MapPoint) -> bool {
        let overlays = self.terrain.overlays();
        overlays.keeps_out(at) || overlays.layers().refusing_contact(at).is_some()
    }

    /// The friction of the raster at a position; `None` where it has no data.
    pub fn friction_at(&self, at: MapPoint) -> Option<FrictionCone> {
        self.terrain.overlays().friction_at(at)
    }

    /// The limit that refuses every flight between two positions, if one does: a layer that does not hold under the root, or, under the trunk, ground
    /// that is not known. `beside_m`: how far the trunk reaches from the root.
    pub fn refuses_flight(&self, [from, to]: [MapPoint; 2], beside_m: f64) -> Option<Limit> {
        if let Some(layer) = self.terrain.overlays().layers().refusing_flight(from, to) {
            return Some(Limit::Layer(layer));
        }
        (self.has_gaps && !self.is_known([from, to], beside_m)).then_some(Limit::Terrain)
    }

    /// Whether the elevations under a strip are known, as far as it lies on the map.
    fn is_known(&self, [from, to]: [MapPoint; 2], beside_m: f64) -> bool {
        let dem = self.terrain.dem();
        let (map, bounds, ground) = (dem.georeference(), dem.bounds(), Triangles::of(dem));
        let ahead = (to - from).try_normalize(0.0).unwrap_or_else(Vector2::x);
        let left = Vector2::new(-ahead.y, ahead.x);
        let onto_map = |at: MapPoint| MapPoint::new(at.x.clamp(bounds.min.x, bounds.max.x), at.y.clamp(bounds.min.y, bounds.max.y));
        let near_m = 1.0e-6 * map.dx_m().min(map.dy_m());
        let is_known = |begin: MapPoint, end: MapPoint| {
            let [begin, end] = [begin, end].map(onto_map);
            let Some(heading) = (end - begin).try_normalize(0.0) else { return ground.at(begin, ground.nominal()).is_some() };
            // A walk ends on the border of the map, but for rounding.
            ground.walk(begin, heading, ground.nominal()).any(|span| span.to_m >= (end - begin).norm() - near_m)
        };
        let (begin, end, aside) = (from - ahead * beside_m, to + ahead * beside_m, left * beside_m);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a trunk is some posts wide, at most the map")]
        let lines = (2.0 * beside_m / map.dx_m().min(map.dy_m())).ceil() as u32;
        let along = (0..=lines).all(|line| {
            let share = if lines == 0 { 0.0 } else { 2.0 * f64::from(line) / f64::from(lines) - 1.0 };
            is_known(begin + aside * share, end + aside * share)
        });
        // What reaches into the strip between two lines does so over an end of it.
        along && is_known(begin - aside, begin + aside) && is_known(end - aside, end + aside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        terrain::{Dem, GeoReference, Overlays},
    };

    /// Against every triangle without an elevation, by its distance from the strip, on DEMs with gaps.
    #[test]
    fn a_strip_over_a_gap_is_found_however_it_lies() {
        let mut draw = Draw::seeded(2);
        let (mut refused, mut free) = (0, 0);
        for _ in 0..60 {
            let (rows, cols) = (9, 12);
            let gaps: Vec<bool> = (0..rows * cols).map(|_| draw.chance(0.04)).collect();
            if gaps.iter().all(|gap| *gap) {
                continue;
            }
            let heights = gaps.iter().map(|gap| if *gap { f64::NAN } else { 0.0 }).collect();
            let (dx, dy) = (1.0, 1.5);
            let dem = Dem::new(rows, cols, heights, GeoReference::local(MapPoint::new(0.0, 0.0), dx, dy).unwrap()).unwrap();
            let map = StanceMap::new(OverlaidDem::new(dem.clone(), Overlays::default()));
            for _ in 0..40 {
                let mut place = || MapPoint::new(draw.uniform(2.0, 9.0), draw.uniform(-10.0, -2.0));
                let (ends, beside_m) = ([place(), place()], 0.8);
                // The nearest gap to the strip, by points all over it.
                let ahead = (ends[1] - ends[0]).normalize();
                let left = Vector2::new(-ahead.y, ahead.x);
                let length_m = (ends[1] - ends[0]).norm();
                let ground = Triangles::of(&dem);
                let mut over_gap = false;
                for i in 0..=200 {
                    for j in 0..=40 {
                        let along_m = -beside_m + (length_m + 2.0 * beside_m) * f64::from(i) / 200.0;
                        let aside_m = beside_m * (f64::from(j) / 20.0 - 1.0);
                        over_gap |= ground.at(ends[0] + ahead * along_m + left * aside_m, ground.nominal()).is_none();
                    }
                }
                let found = map.refuses_flight(ends, beside_m);
                if over_gap {
                    assert_eq!(found, Some(Limit::Terrain), "{ends:?}");
                    refused += 1;
                } else if found.is_none() {
                    free += 1;
                }
            }
        }
        assert!(refused > 500 && free > 100, "{refused} {free}");
    }
}
