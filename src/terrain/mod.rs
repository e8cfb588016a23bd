//! Elevation rasters and what is cut from them.

use crate::quantity::{Angle, MapPoint};

/// A slice of terrain by a vertical plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Vertices along the slice.
    pub points: Vec<ProfilePoint>,
    /// The facet under each segment.
    pub facets: Vec<ProfileFacet>,
}
/// A vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// Along.
    pub x_m: f64,
    /// Up.
    pub z_m: f64,
    /// On the map.
    pub map: MapPoint,
}
/// A facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileFacet {
    /// Cross-slope.
    pub cross_slope: Angle,
}
