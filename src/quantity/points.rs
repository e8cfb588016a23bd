//! Points of the vertical plane and of the map.

/// A point of the chain's vertical plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainPoint {
    /// Distance along the transect, m.
    pub x_m: f64,
    /// Elevation, m.
    pub z_m: f64,
}

impl ChainPoint {
    /// The point (x, z), both in m.
    pub const fn new(x_m: f64, z_m: f64) -> Self {
        Self { x_m, z_m }
    }
}

/// The part of a segment between two distances along the transect; `None` where it has none but an end.
pub(crate) fn part_between([first_m, last_m]: [f64; 2], ends: [ChainPoint; 2]) -> Option<[ChainPoint; 2]> {
    let [from, to] = if ends[0].x_m <= ends[1].x_m { ends } else { [ends[1], ends[0]] };
    if to.x_m <= first_m || from.x_m >= last_m {
        return None;
    }
    let at = |x_m: f64| ChainPoint::new(x_m, from.z_m + (to.z_m - from.z_m) * ((x_m - from.x_m) / (to.x_m - from.x_m)));
    Some([if from.x_m < first_m { at(first_m) } else { from }, if to.x_m > last_m { at(last_m) } else { to }])
}

/// A point of the map, easting then northing, m.
pub type MapPoint = nalgebra::Point2<f64>;
