//! The profile of a terrain along a vertical plane.

use nalgebra::{Vector2, Vector3};

use super::TerrainError;
use crate::{
    quantity::{Angle, MapPoint},
    world::FrictionCone,
};

/// By how much the length of a direction of length 1 may differ from it.
const UNIT_ROUNDING: f64 = 1.0e-6;

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
    /// A profile from its points, the facet under each segment and the direction of travel, for ground that is not cut from a DEM or a mesh
    /// here.
    ///
    /// # Errors
    /// [`TerrainError::InvalidProfile`] with the first fault: fewer than 2 points, not one facet per segment, a number that is not finite, x
    /// that does not begin at 0 or does not increase, a heading or a normal whose length is not 1 (within a millionth), a normal that points
    /// down, a cross-slope outside 0 to 90 degrees.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Profile, ProfileFacet, ProfilePoint}};
    /// use nalgebra::Vector2;
    /// let east = Vector2::new(1.0, 0.0);
    /// let point = |x_m, z_m| ProfilePoint { x_m, z_m, map: MapPoint::new(x_m, 0.0) };
    /// let slope = ProfileFacet::from_gradient(Vector2::new(0.5, 0.0), east);
    /// assert!(Profile::new(vec![point(0.0, 0.0), point(2.0, 1.0)], vec![slope], east).is_ok());
    /// assert!(Profile::new(vec![point(0.0, 0.0), point(0.0, 1.0)], vec![slope], east).is_err());
    /// ```
    pub fn new(points: Vec<ProfilePoint>, facets: Vec<ProfileFacet>, heading: Vector2<f64>) -> Result<Self, TerrainError> {
        let profile = Self { points, facets, heading };
        profile.fault().map_or(Ok(profile), |fault| Err(TerrainError::InvalidProfile(fault)))
    }

    /// What makes it no profile, if anything does.
    fn fault(&self) -> Option<String> {
        let Self { points, facets, heading } = self;
        let unit = |length: f64| (length - 1.0).abs() <= UNIT_ROUNDING;
        if points.len() < 2 || facets.len() + 1 != points.len() {
            return Some(format!(
                "the profile has {} points and {} facets, expected at least 2 points and one facet for each segment between them",
                points.len(),
                facets.len()
            ));
        }
        if !unit(heading.norm()) {
            return Some(format!("the heading of the profile is ({}, {}), expected a direction of length 1", heading.x, heading.y));
        }
        let numbers = |point: &ProfilePoint| [point.x_m, point.z_m, point.map.x, point.map.y];
        if let Some(index) = points.iter().position(|point| !numbers(point).iter().all(|number| number.is_finite())) {
            return Some(format!("point {index} (from 0) of the profile is {:?}, expected finite numbers", points[index]));
        }
        if points[0].x_m != 0.0 {
            return Some(format!("the profile begins at x = {} m, expected 0 m", points[0].x_m));
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].x_m <= pair[0].x_m) {
            return Some(format!("x = {} m follows x = {} m in the profile, expected a larger x", pair[1].x_m, pair[0].x_m));
        }
        let sound = |facet: &ProfileFacet| {
            let quarter = 0.0..=std::f64::consts::FRAC_PI_2 * (1.0 + UNIT_ROUNDING);
            unit(facet.normal.norm()) && facet.normal.z >= 0.0 && quarter.contains(&facet.cross_slope.radians())
        };
        facets.iter().position(|facet| !sound(facet)).map(|index| {
            format!(
                "facet {index} (from 0) of the profile has the normal {:?} and a cross-slope of {} degrees, expected an upward normal of \
                 length 1 and 0 to 90 degrees",
                facets[index].normal.as_slice(),
                facets[index].cross_slope.degrees()
            )
        })
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_that_are_no_ground_are_refused_with_what_is_wrong() {
        let east = Vector2::new(1.0, 0.0);
        let point = |x_m: f64, z_m: f64| ProfilePoint { x_m, z_m, map: MapPoint::new(x_m, 0.0) };
        let flat = ProfileFacet::from_gradient(Vector2::zeros(), east);
        let two = || vec![point(0.0, 0.0), point(2.0, 1.0)];
        let refused = |points, facets, heading, word: &str| {
            let message = Profile::new(points, facets, heading).unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
        };
        assert!(Profile::new(two(), vec![flat], east).is_ok());
        refused(vec![point(0.0, 0.0)], vec![], east, "1 points");
        refused(two(), vec![flat, flat], east, "2 facets");
        refused(two(), vec![flat], Vector2::new(1.0, 1.0), "length 1");
        refused(two(), vec![flat], Vector2::new(f64::NAN, 1.0), "length 1");
        refused(vec![point(0.0, 0.0), point(2.0, f64::NAN)], vec![flat], east, "point 1");
        refused(vec![point(1.0, 0.0), point(2.0, 0.0)], vec![flat], east, "x = 1 m");
        refused(vec![point(0.0, 0.0), point(0.0, 1.0)], vec![flat], east, "larger x");
        let down = ProfileFacet { normal: Vector3::new(0.0, 0.0, -1.0), ..flat };
        refused(two(), vec![down], east, "facet 0");
        let steep = ProfileFacet { cross_slope: Angle::from_degrees(91.0), ..flat };
        refused(two(), vec![steep], east, "91");
        // The facet of a normal without length has no direction.
        refused(two(), vec![ProfileFacet::from_normal(Vector3::zeros(), east)], east, "NaN");
    }
}
