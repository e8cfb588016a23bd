//! The profile of a terrain along a vertical plane.

use nalgebra::{Vector2, Vector3};

use crate::{
    quantity::{Angle, MapPoint},
    world::FrictionCone,
};

/// The ground along a straight line on the map: a polygonal line, and the facet under each segment.
///
/// ```text
///   points:   0-----1---2--------3      x_m strictly increasing from 0
///   facets:      0    1      2          one fewer than points
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The points where the plane crosses an edge of the triangulated terrain, and the two ends.
    pub points: Vec<ProfilePoint>,
    /// The facet of the segment that begins at the point with the same index.
    pub facets: Vec<ProfileFacet>,
    /// Direction of travel on the map, a unit vector.
    pub heading: Vector2<f64>,
}

/// A point of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// Horizontal distance from the first point, m.
    pub x_m: f64,
    /// Elevation, m.
    pub z_m: f64,
    /// Position on the map.
    pub map: MapPoint,
}

/// The facet under a segment, and the overlays on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileFacet {
    /// Upward unit normal: east, north, up.
    pub normal: Vector3<f64>,
    /// Angle between the normal and the vertical plane of travel, 0 to 90 degrees.
    pub cross_slope: Angle,
    /// Whether the segment lies in a keep-out zone: no take-off and no landing.
    pub keep_out: bool,
    /// Friction of the segment, if a raster gives it.
    pub friction: Option<FrictionCone>,
}

impl Profile {
    /// Horizontal distance from the first point to the last, m.
    pub fn length_m(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.x_m)
    }
}

impl ProfileFacet {
    /// The facet with a gradient (east, north), for a direction of travel `heading`.
    ///
    /// ```text
    /// n = (-p, -q, 1) / sqrt(1 + p^2 + q^2),   cross-slope = asin |n . s|,   s the horizontal unit vector across the heading
    /// ```
    ///
    /// computed as atan2 of the components of n across and along the plane, which keeps its digits near 0 and near 90
    /// degrees.
    ///
    /// ```
    /// use chta::terrain::ProfileFacet;
    /// use nalgebra::Vector2;
    /// // A slope of 45 degrees, traversed along its contour.
    /// let facet = ProfileFacet::from_gradient(Vector2::new(0.0, 1.0), Vector2::new(1.0, 0.0));
    /// assert!((facet.cross_slope.degrees() - 45.0).abs() < 1e-12);
    /// ```
    pub fn from_gradient(gradient: Vector2<f64>, heading: Vector2<f64>) -> Self {
        let upward = Vector3::new(-gradient.x, -gradient.y, 1.0);
        let across = gradient.x * heading.y - gradient.y * heading.x;
        let along = gradient.dot(&heading);
        Self {
            normal: upward / upward.norm(),
            cross_slope: Angle::from_radians(libm::atan2(across.abs(), libm::sqrt(along * along + 1.0))),
            keep_out: false,
            friction: None,
        }
    }

    /// The facet with a normal (east, north, up; of any length above 0, up or down), for a direction of travel `heading`:
    /// like [`from_gradient`](Self::from_gradient), but for upright facets too.
    ///
    /// ```
    /// use chta::terrain::ProfileFacet;
    /// use nalgebra::{Vector2, Vector3};
    /// // A wall, traversed along its foot.
    /// let facet = ProfileFacet::from_normal(Vector3::new(0.0, 2.0, 0.0), Vector2::new(1.0, 0.0));
    /// assert_eq!(facet.cross_slope.degrees(), 90.0);
    /// ```
    pub fn from_normal(normal: Vector3<f64>, heading: Vector2<f64>) -> Self {
        let upward = if normal.z < 0.0 { -normal } else { normal };
        let across = heading.perp(&upward.xy());
        let along = heading.dot(&upward.xy());
        Self {
            normal: upward / upward.norm(),
            cross_slope: Angle::from_radians(libm::atan2(across.abs(), libm::hypot(along, upward.z))),
            keep_out: false,
            friction: None,
        }
    }

    /// The inclination of the facet in its steepest direction, 0 to 90 degrees.
    pub fn tilt(&self) -> Angle {
        Angle::from_radians(libm::atan2(libm::hypot(self.normal.x, self.normal.y), self.normal.z))
    }
}
