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

/// A point of the map, easting then northing, m.
pub type MapPoint = nalgebra::Point2<f64>;
