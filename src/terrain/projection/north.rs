//! Grid north against true north.

use nalgebra::{Matrix2, Vector2};

use super::{Ellipsoid, MapProjection};
use crate::quantity::MapPoint;

/// The steps of the difference quotients, radians: the first at which the map is smooth. At 1e-3 the five-point formula is off by 1e-13
/// and rounding by 1e-13. A smaller one is needed only beside the meridian at which a map is cut.
const STEPS: [f64; 3] = [1.0e-3, 1.0e-5, 1.0e-7];

/// Nearer to the axis of the body than this share of its radius (2 micrometres on the Moon), a place is the pole.
const AT_POLE: f64 = 1.0e-12;

impl MapProjection {
    /// The direction over the body of a direction on the map at a point, clockwise from true north, 0 to 360 degrees.
    ///
    /// ```text
    ///     u = E e + N n,   E = dM/dlon / (r cos),   N = dM/dlat / r'        true heading = atan2(e, n)
    /// ```
    ///
    /// with `u` the unit vector on the map, `M` the projection, `r cos` and `r'` the radii of the parallel and of the meridian. On a
    /// conformal map this is the heading on the map plus the convergence of the meridian, the same for all directions; on other maps
    /// it differs by direction.
    ///
    /// # Returns
    /// `None` at a pole, from which all directions lead south or north, and where the map shows no place.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Definition, Ellipsoid, MapProjection, Method}};
    /// let south = Definition::about(Method::PolarStereographic, -90.0, 0.0, Ellipsoid::sphere(1_737_400.0));
    /// let south = MapProjection::new(south, None).unwrap();
    /// // East of the South Pole on the map is the meridian of 90 degrees: along it, away from the pole, is north.
    /// let heading = south.true_heading_deg(MapPoint::new(1000.0, 0.0), 90.0).unwrap();
    /// assert!(heading < 1e-9 || heading > 360.0 - 1e-9);
    /// assert_eq!(south.true_heading_deg(MapPoint::new(0.0, 0.0), 90.0), None);
    /// ```
    pub fn true_heading_deg(&self, at: MapPoint, heading_deg: f64) -> Option<f64> {
        let (sin, cos) = libm::sincos(heading_deg.to_radians());
        direction_deg(Matrix2::from_columns(&self.axes(at)?).try_inverse()? * Vector2::new(sin, cos))
    }

    /// The direction on the map in which north lies from a point, clockwise from grid north, 0 to 360 degrees.
    ///
    /// # Returns
    /// `None` as for [`true_heading_deg`](Self::true_heading_deg).
    pub fn north_on_map_deg(&self, at: MapPoint) -> Option<f64> {
        let [_, north] = self.axes(at)?;
        direction_deg(north)
    }

    /// A metre east and a metre north of a point, on the map: `E` and `N`.
    fn axes(&self, at: MapPoint) -> Option<[Vector2<f64>; 2]> {
        self.lon_lat(at)?;
        let (lon, lat) = self.inverse(at)?;
        let here = self.position(lon, lat);
        let Ellipsoid { semi_major_m: a, semi_minor_m: b } = self.definition.ellipsoid;
        let parallel_m = libm::hypot(here.x, here.y);
        if parallel_m <= AT_POLE * a {
            return None;
        }
        let (sin_lat, cos_lat) = libm::sincos(lat);
        let squared = libm::hypot(a * cos_lat, b * sin_lat);
        let meridian_m = (a / squared) * (b / squared) * (a * (b / squared));
        let from_pole = std::f64::consts::FRAC_PI_2 - lat.abs();
        Some([
            self.slope(|angle| self.forward(lon + angle, lat), 1.0)? / parallel_m,
            self.slope(|angle| self.forward(lon, lat + angle), (0.2e3 * from_pole).min(1.0))? / meridian_m,
        ])
    }

    /// The change of a map point per radian, by five points. `share` shortens all steps.
    fn slope(&self, on_map: impl Fn(f64) -> Option<MapPoint>, share: f64) -> Option<Vector2<f64>> {
        /// Greatest bend over one step, as a share of the step on the map: smooth maps bend by about the step in radians. A map that is
        /// cut jumps.
        const BEND: f64 = 0.05;
        let here = on_map(0.0)?;
        let size_m = self.definition.ellipsoid.semi_major_m;
        STEPS.into_iter().find_map(|step| {
            let step = step * share;
            let [far_back, back, ahead, far_ahead] = [-2.0, -1.0, 1.0, 2.0].map(|steps| on_map(steps * step));
            let near = ahead? - back?;
            let far = far_ahead? - far_back?;
            let bends = (ahead? - here + (back? - here)).norm().max((far_ahead? - here + (far_back? - here)).norm());
            let is_smooth = bends <= BEND * near.norm() && near.norm() < 0.5 * size_m;
            is_smooth.then(|| (near * 8.0 - far) / (12.0 * step))
        })
    }
}

/// The direction of a vector to east and north, clockwise from north, 0 to 360 degrees.
fn direction_deg(along: Vector2<f64>) -> Option<f64> {
    let degrees = libm::atan2(along.x, along.y).to_degrees();
    degrees.is_finite().then_some(if degrees < 0.0 { degrees + 360.0 } else { degrees })
}
