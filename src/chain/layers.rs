//! Where the layers of a map refuse contacts and flights along a chain.

use std::sync::Arc;

use crate::{
    quantity::{ChainPoint, MapPoint},
    terrain::{Layer, MapLayers, Touch},
    world::LayerName,
};

/// The stretches of a chain where one layer does not hold, ascending and disjoint, m along the chain; both ends belong to them.
#[derive(Clone, Debug, PartialEq)]
struct Refused {
    layer: LayerName,
    stretches: Vec<[f64; 2]>,
}

/// The layers of the map under a chain.
///
/// They add no vertices: a contact is judged at its own place, and a flight from its take-off to its landing.
#[derive(Clone, Debug)]
pub(crate) struct ChainLayers {
    map: MapLayers,
    contacts: Arc<[Refused]>,
    flights: Arc<[Refused]>,
}

/// The layers of one map are the same along one chain.
impl PartialEq for ChainLayers {
    fn eq(&self, other: &Self) -> bool {
        self.contacts == other.contacts && self.flights == other.flights
    }
}

impl ChainLayers {
    /// The layers under a chain of these vertices, of which each has a place on the map.
    pub(crate) fn under(layers: &MapLayers, vertices: &[ChainPoint], map: &[MapPoint]) -> Self {
        let of = |touch: Touch| {
            let stretches = |layer: &Layer| stretches((layer, touch), vertices, map);
            let refused = layers.refusing_any(touch).map(|layer| Refused { layer: layer.rule().name, stretches: stretches(layer) });
            refused.filter(|refused| !refused.stretches.is_empty()).collect()
        };
        Self { map: layers.clone(), contacts: of(Touch::Contact), flights: of(Touch::Flight) }
    }

    /// The layers of the map.
    pub(crate) const fn map(&self) -> &MapLayers {
        &self.map
    }

    /// The layer that refuses a contact at an x, if one does.
    #[inline]
    pub(crate) fn refusing_contact(&self, x_m: f64) -> Option<LayerName> {
        refusing(&self.contacts, x_m, x_m)
    }

    /// The layer that refuses a flight between two x, if one does.
    #[inline]
    pub(crate) fn refusing_flight(&self, a_m: f64, b_m: f64) -> Option<LayerName> {
        refusing(&self.flights, a_m.min(b_m), a_m.max(b_m))
    }

    /// Whether a layer refuses any flight.
    #[inline]
    pub(crate) fn restrict_flights(&self) -> bool {
        !self.flights.is_empty()
    }

    /// Whether a layer refuses any contact.
    #[inline]
    pub(crate) fn restrict_contacts(&self) -> bool {
        !self.contacts.is_empty()
    }

    /// The ends of all stretches where a layer refuses contacts, m, in any order.
    pub(crate) fn contact_ends_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.contacts.iter().flat_map(|refused| &refused.stretches).flatten().copied()
    }
}

/// The first layer with a stretch that meets the interval between two x.
#[inline]
fn refusing(layers: &[Refused], low_m: f64, high_m: f64) -> Option<LayerName> {
    let meets = |refused: &&Refused| {
        let next = refused.stretches.partition_point(|stretch| stretch[1] < low_m);
        refused.stretches.get(next).is_some_and(|stretch| stretch[0] <= high_m)
    };
    layers.iter().find(meets).map(|refused| refused.layer)
}

/// The stretches of a chain where a layer refuses to be touched.
fn stretches((layer, touch): (&Layer, Touch), vertices: &[ChainPoint], map: &[MapPoint]) -> Vec<[f64; 2]> {
    let mut found: Vec<[f64; 2]> = Vec::new();
    for (ends, places) in vertices.windows(2).zip(map.windows(2)) {
        let ([begin, end], [from, to]) = (ends, places) else { continue };
        let run_m = end.x_m - begin.x_m;
        // The ends of a segment are those of the chain itself, without rounding.
        let at = |share: f64| if share == 1.0 { end.x_m } else { begin.x_m + share * run_m };
        found.extend(layer.refused_shares(touch, *from, *to).into_iter().map(|(low, high)| [at(low), at(high)]));
    }
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::with_capacity(found.len());
    for stretch in found {
        match joined.last_mut() {
            Some(last) if stretch[0] <= last[1] => last[1] = last[1].max(stretch[1]),
            _ => joined.push(stretch),
        }
    }
    joined
}
