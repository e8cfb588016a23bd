//! Conversion between map coordinates and longitude and latitude, on spheres and ellipsoids.
//!
//! The projection of a DEM comes from its `GeoKeys` ([`MapProjection::of`]). The projection equations are those of the crate
//! `proj4rs`, which only this module uses. The public latitudes are planetocentric, as missions to other bodies state them;
//! projections take planetographic ones internally. On a sphere both are equal. With equatorial radius a and polar radius b
//!
//! ```text
//! tan(planetographic) = (a / b)^2 tan(planetocentric)
//! ```
//!
//! The difference is up to 0.34 degrees (20 km) on Mars, and 0.19 degrees on the Earth.

mod codes;
mod crs;
mod crs_error;
mod definition;
mod epsg_units;
mod geokeys;
mod north;
mod proj_text;
mod scale;
mod stated;
mod wkt;
mod wkt_read;
mod wkt_tree;

use std::fmt;

use nalgebra::{Matrix2, Vector2, Vector3};
use proj4rs::{Proj, transform::transform};

pub(super) use self::codes::iau_radius_m;
pub use self::crs_error::CrsError;
pub use self::definition::{Definition, Ellipsoid, Method};
pub(super) use self::epsg_units::{Vertical, is_compound, is_geodetic, is_map_in_metres, length_unit, unit_of_depths, vertical};
use self::geokeys::Reading;
pub use self::scale::{ScaleExtreme, ScaleMend, TransectScale, check_map_scale, check_scale};
pub(super) use self::stated::{contradiction, doubts};
use super::geotiff::short_key;
use super::{CoordinateSystem, MapBounds, TerrainError};
use crate::quantity::MapPoint;

/// A position on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LonLat {
    /// Longitude, degrees, east positive.
    pub lon_deg: f64,
    /// Planetocentric latitude, degrees.
    pub lat_deg: f64,
}

impl fmt::Display for LonLat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "longitude {}, latitude {}", self.lon_deg, self.lat_deg)
    }
}

/// A position as the user gives it: on the map or on the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapPlace {
    /// Map coordinates, m.
    Metres(MapPoint),
    /// Longitude and latitude.
    LonLat(LonLat),
}

impl MapPlace {
    /// The point in metres, if it was given in metres.
    pub fn metres(&self) -> Option<MapPoint> {
        match self {
            Self::Metres(point) => Some(*point),
            Self::LonLat(_) => None,
        }
    }

    /// The position on the map.
    ///
    /// `which` names the point in errors; `bounds` are those of the DEM.
    ///
    /// # Errors
    /// For longitude and latitude: [`TerrainError::NoProjection`] without a projection, [`TerrainError::LonLatOffTheMap`] if
    /// the DEM does not cover the point. Map coordinates are returned unchecked: the slice checks them.
    pub fn on_map(
        &self,
        which: &'static str,
        projection: Result<&MapProjection, &NoProjection>,
        bounds: MapBounds,
    ) -> Result<MapPoint, TerrainError> {
        let place = match self {
            Self::Metres(point) => return Ok(*point),
            Self::LonLat(place) => *place,
        };
        let projection = projection.map_err(|reason| TerrainError::NoProjection { which, reason: reason.clone() })?;
        let at = projection.map_point(place);
        // Rounding may put a point on the border slightly outside.
        let onto_border = |at: MapPoint| {
            let inside = MapPoint::new(at.x.clamp(bounds.min.x, bounds.max.x), at.y.clamp(bounds.min.y, bounds.max.y));
            ((inside - at).norm() <= ROUNDING_M).then_some(inside)
        };
        at.and_then(onto_border).ok_or(TerrainError::LonLatOffTheMap { which, place, at, bounds })
    }
}

/// Why map coordinates cannot be converted to longitude and latitude.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoProjection {
    /// The file states no projection.
    Local,
    /// The file states an unsupported projection.
    Unknown(String),
}

impl fmt::Display for NoProjection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Local => f.write_str("the terrain states no map projection"),
            Self::Unknown(reason) => write!(f, "the terrain's map projection is not supported ({reason})"),
        }
    }
}

/// The key of the code of longitudes and latitudes.
const GEOGRAPHIC_CRS: u16 = 2048;

/// How far beyond the border of a map rounding may put a point on it, m.
const ROUNDING_M: f64 = 1.0e-6;

/// An inverse projection with a larger error, as a fraction of the radius, has found another point rather than an inaccurate
/// one.
const ROUGH_SHARE: f64 = 1.0e-6;

/// The projection of a map in metres.
#[derive(Clone)]
pub struct MapProjection {
    name: String,
    code: Option<String>,
    definition: Definition,
    projected: Proj,
    geographic: Proj,
}

impl MapProjection {
    /// The projection that a file's `GeoKeys` define.
    ///
    /// # Errors
    /// [`NoProjection`] if they define none, or an unsupported one.
    pub fn of(system: &CoordinateSystem) -> Result<Self, NoProjection> {
        let (definition, epsg) = match geokeys::read(system) {
            Reading::Known { definition, epsg } => (definition, epsg),
            Reading::Local => return Err(NoProjection::Local),
            Reading::Unknown(reason) => return Err(NoProjection::Unknown(reason)),
        };
        let mut projection = Self::new(definition, named(system))?;
        if let Some(epsg) = epsg {
            projection.code = Some(format!("EPSG:{epsg}"));
        }
        Ok(projection)
    }

    /// A projection from its parameters; without a name it gets a descriptive one. The IAU code is looked up.
    ///
    /// # Errors
    /// [`NoProjection::Unknown`] if the parameters do not define a projection.
    ///
    /// # Examples
    /// ```
    /// use chta::quantity::MapPoint;
    /// use chta::terrain::{Definition, Ellipsoid, MapProjection, Method};
    /// let moon = Ellipsoid::sphere(1_737_400.0);
    /// let south = MapProjection::new(Definition::about(Method::PolarStereographic, -90.0, 0.0, moon), None).unwrap();
    /// assert_eq!(south.code(), Some("IAU_2015:30135"));
    /// // From the pole along the map's x: longitude 90.
    /// let place = south.lon_lat(MapPoint::new(1000.0, 0.0)).unwrap();
    /// assert!((place.lon_deg - 90.0).abs() < 1e-12 && (place.lat_deg + 89.967).abs() < 1e-3);
    /// ```
    pub fn new(definition: Definition, name: Option<String>) -> Result<Self, NoProjection> {
        Self::made(definition, name).map_err(|fault| NoProjection::Unknown(format!("it has {fault}")))
    }

    /// The same, or what is wrong with the parameters.
    fn made(definition: Definition, name: Option<String>) -> Result<Self, String> {
        if let Some(fault) = definition.fault() {
            return Err(fault);
        }
        let refused = |error: proj4rs::errors::Error| format!("parameters without a map, {}: {error}", definition.proj_string());
        let [projected, geographic] = definition.equations().map(|text| Proj::from_proj_string(&text).map_err(refused));
        let name = name.unwrap_or_else(|| spoken(&definition));
        Ok(Self { name, code: codes::own_code(&definition), definition, projected: projected?, geographic: geographic? })
    }

    /// Its name, for people.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its parameters.
    pub fn definition(&self) -> &Definition {
        &self.definition
    }

    /// The proj string.
    pub fn proj_string(&self) -> String {
        self.definition.proj_string()
    }

    /// Authority and code, such as `EPSG:32633` or `IAU_2015:30135`, if known.
    pub fn code(&self) -> Option<&str> {
        self.code.as_deref()
    }

    /// The code as a uniform resource name of the OGC, such as `urn:ogc:def:crs:IAU:2015:30135`.
    pub fn urn(&self) -> Option<String> {
        let (authority, code) = self.code()?.split_once(':')?;
        let authority = authority.replace('_', ":");
        let version = if authority.contains(':') { "" } else { ":" };
        Some(format!("urn:ogc:def:crs:{authority}{version}:{code}"))
    }

    /// Well-known text for a `.prj` file.
    pub fn wkt(&self) -> String {
        wkt::esri_wkt(&self.definition, &self.name)
    }

    /// The `GeoKeys` that state it: its EPSG code where it has one, else every number of it. [`MapProjection::of`] reads them back.
    pub fn coordinate_system(&self) -> CoordinateSystem {
        let epsg = self.code().and_then(codes::epsg_number);
        match epsg {
            Some(code) => geokeys::write_epsg(code, &self.name),
            None => geokeys::write(&self.definition, &self.name),
        }
    }

    /// The same with an EPSG code, which is kept where it means just this projection: the code of another map is no code of this one.
    fn with_epsg(mut self, code: Option<String>) -> Self {
        let meaning = |code: &String| codes::epsg_number(code).and_then(codes::epsg);
        self.code = code.filter(|code| meaning(code) == Some(self.definition)).or(self.code);
        self
    }

    /// Whether another projection gives every place the same map coordinates, to a tenth of a metre around the origin. Numbers may
    /// differ: longitudes by a turn, a scale and a parallel of true scale, ellipsoids by a hair.
    pub(crate) fn is_same_map(&self, other: &Self) -> bool {
        const TOLERANCE_M: f64 = 0.1;
        let Definition { latitude_deg, longitude_deg, .. } = self.definition;
        let at_pole = latitude_deg.abs() == 90.0;
        [-5.0, 2.0, 7.0].into_iter().all(|north_deg: f64| {
            [-2.0, 1.0, 3.0].into_iter().all(|east_deg| {
                let lat_deg =
                    if at_pole { (latitude_deg.abs() - north_deg.abs()).copysign(latitude_deg) } else { latitude_deg + north_deg };
                let place = LonLat { lon_deg: longitude_deg + east_deg, lat_deg: lat_deg.clamp(-89.0, 89.0) };
                match (self.map_point(place), other.map_point(place)) {
                    (Some(own), Some(others)) => (own - others).norm() <= TOLERANCE_M,
                    (own, others) => own.is_none() && others.is_none(),
                }
            })
        })
    }

    /// Longitude and latitude of a map point; `None` if it corresponds to no point of the body.
    pub fn lon_lat(&self, at: MapPoint) -> Option<LonLat> {
        let (lon, lat) = self.inverse(at)?;
        let back = self.forward(lon, lat)?;
        // A sinusoidal map, for example, ends at the opposite meridian; a point beyond would show the same position twice.
        let same = (back - at).norm() <= 1.0e-9 * self.definition.ellipsoid.semi_major_m;
        same.then(|| LonLat { lon_deg: lon.to_degrees(), lat_deg: self.planetocentric(lat).to_degrees() })
    }

    /// The map coordinates of a position, m; `None` if the map does not show it.
    pub fn map_point(&self, place: LonLat) -> Option<MapPoint> {
        let LonLat { lon_deg, lat_deg } = place;
        if !(lon_deg.abs() <= 540.0 && lat_deg.abs() <= 90.0) {
            return None;
        }
        let lon = (lon_deg - 360.0 * libm::rint(lon_deg / 360.0)).to_radians();
        let lat = self.planetographic(lat_deg.to_radians());
        let at = self.forward(lon, lat)?;
        let (back_lon, back_lat) = self.inverse(at)?;
        let gap = self.position(back_lon, back_lat) - self.position(lon, lat);
        (gap.norm() <= 1.0e-9 * self.definition.ellipsoid.semi_major_m).then_some(at)
    }

    /// Longitude and planetographic latitude, radians.
    ///
    /// Some inverse projections are truncated series or iterations that stop early (errors of some 1e-9 degrees), while the
    /// forward projections are exact. The error of the forward projection of the result is therefore added to the point, and
    /// the inverse is computed again.
    fn inverse(&self, at: MapPoint) -> Option<(f64, f64)> {
        let converged_m = 1.0e-14 * self.definition.ellipsoid.semi_major_m;
        let (mut target, mut place) = (at, self.rough_inverse(at)?);
        for _ in 0..3 {
            let Some(back) = self.forward(place.0, place.1) else { break };
            let miss = at - back;
            if !(converged_m..ROUGH_SHARE * self.definition.ellipsoid.semi_major_m).contains(&miss.norm()) {
                break;
            }
            target += miss;
            let Some(better) = self.rough_inverse(target) else { break };
            place = better;
        }
        Some(self.near_a_pole(at, place))
    }

    /// A better place for a point near a pole, else the same place.
    ///
    /// On a sphere the inverse projections take latitudes from their sines, whose rounding is an angle of 1e-8 at a pole (3 cm on the
    /// Moon). Newton's method finds the place anew in coordinates that are smooth there: the angle from the pole as a vector. Maps that
    /// show the pole as a line keep their place: the method does not bring it nearer.
    fn near_a_pole(&self, at: MapPoint, place: (f64, f64)) -> (f64, f64) {
        /// The angle from a pole, radians, at which sines still give latitudes to 1e-14.
        const NEAR: f64 = 0.01;
        /// The step of the difference quotients, radians: the errors from rounding and from curvature stay below a millionth.
        const STEP: f64 = 1.0e-6;
        let from_pole = std::f64::consts::FRAC_PI_2 - place.1.abs();
        if from_pole > NEAR {
            return place;
        }
        let (sin_lon, cos_lon) = libm::sincos(place.0);
        let lon_lat = |angle: Vector2<f64>| {
            let lat = std::f64::consts::FRAC_PI_2 - libm::hypot(angle.x, angle.y);
            (libm::atan2(angle.y, angle.x), lat.copysign(place.1))
        };
        let on_map = |angle: Vector2<f64>| {
            let (lon, lat) = lon_lat(angle);
            self.forward(lon, lat)
        };
        let mut angle = Vector2::new(cos_lon, sin_lon) * from_pole;
        let miss_m = |back: Option<MapPoint>| back.map_or(f64::INFINITY, |back| (at - back).norm());
        let (mut best, mut best_m) = (place, miss_m(self.forward(place.0, place.1)));
        for _ in 0..4 {
            let (Some(here), Some(beside), Some(above)) =
                (on_map(angle), on_map(angle + Vector2::new(STEP, 0.0)), on_map(angle + Vector2::new(0.0, STEP)))
            else {
                break;
            };
            let slopes = Matrix2::from_columns(&[(beside - here) / STEP, (above - here) / STEP]);
            let Some(inverse) = slopes.try_inverse() else { break };
            angle += inverse * (at - here);
            let found_m = miss_m(on_map(angle));
            if found_m.is_nan() || found_m >= best_m {
                break;
            }
            (best, best_m) = (lon_lat(angle), found_m);
        }
        best
    }

    fn rough_inverse(&self, at: MapPoint) -> Option<(f64, f64)> {
        let mut point = (at.x, at.y, 0.0);
        transform(&self.projected, &self.geographic, &mut point).ok()?;
        (point.0.is_finite() && point.1.is_finite()).then_some((point.0, point.1))
    }

    /// The map point of a place, radians.
    ///
    /// The equations move places within 1e-10 of a pole onto it (0.2 mm on the Moon); those of the equal-area map of an ellipsoid lose the
    /// last 1e-8. Nearer than that a straight line through the pole to places on both sides stands for them, which deviates by the square of
    /// the angle to these. A pole that the map shows as a line or as the apex of a cone has no such line.
    fn forward(&self, lon: f64, lat: f64) -> Option<MapPoint> {
        let loses_small_angles =
            self.definition.method == Method::LambertAzimuthalEqualArea && !self.definition.ellipsoid.is_sphere();
        let (near, side) = if loses_small_angles { (1.0e-4, 1.0e-4) } else { (1.0e-9, 1.0e-6) };
        let from_pole = std::f64::consts::FRAC_PI_2 - lat.abs();
        if !(from_pole > 0.0 && from_pole < near) {
            return self.equation(lon, lat);
        }
        let beside = (std::f64::consts::FRAC_PI_2 - side).copysign(lat);
        let opposite = if lon > 0.0 { lon - std::f64::consts::PI } else { lon + std::f64::consts::PI };
        let pole = self.equation(lon, std::f64::consts::FRAC_PI_2.copysign(lat));
        match (pole, self.equation(lon, beside), self.equation(opposite, beside)) {
            (Some(pole), Some(here), Some(there)) if (here - pole + (there - pole)).norm() < 1.0e-3 * (here - there).norm() => {
                Some(pole + (here - there) * (0.5 * from_pole / side))
            }
            _ => self.equation(lon, lat),
        }
    }

    fn equation(&self, lon: f64, lat: f64) -> Option<MapPoint> {
        let mut point = (lon, lat, 0.0);
        transform(&self.geographic, &self.projected, &mut point).ok()?;
        (point.0.is_finite() && point.1.is_finite()).then(|| MapPoint::new(point.0, point.1))
    }

    /// `(a / b)^2`.
    fn squared_axis_ratio(&self) -> f64 {
        let ratio = self.definition.ellipsoid.semi_major_m / self.definition.ellipsoid.semi_minor_m;
        ratio * ratio
    }

    fn planetographic(&self, planetocentric: f64) -> f64 {
        let (sin, cos) = libm::sincos(planetocentric);
        if self.definition.ellipsoid.is_sphere() { planetocentric } else { libm::atan2(sin * self.squared_axis_ratio(), cos) }
    }

    fn planetocentric(&self, planetographic: f64) -> f64 {
        let (sin, cos) = libm::sincos(planetographic);
        if self.definition.ellipsoid.is_sphere() { planetographic } else { libm::atan2(sin, cos * self.squared_axis_ratio()) }
    }

    /// The position in three dimensions, m from the body's centre, for longitude and planetographic latitude in radians.
    fn position(&self, lon: f64, lat: f64) -> Vector3<f64> {
        let Ellipsoid { semi_major_m: a, semi_minor_m: b } = self.definition.ellipsoid;
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (libm::sincos(lat), libm::sincos(lon));
        let across_m = a * a / libm::hypot(a * cos_lat, b * sin_lat);
        let up_m = b * b / libm::hypot(a * cos_lat, b * sin_lat);
        Vector3::new(across_m * cos_lat * cos_lon, across_m * cos_lat * sin_lon, up_m * sin_lat)
    }
}

/// Prints the definition only: the internal state follows from it.
impl fmt::Debug for MapProjection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MapProjection")
            .field("name", &self.name)
            .field("code", &self.code)
            .field("definition", &self.definition)
            .finish_non_exhaustive()
    }
}

impl PartialEq for MapProjection {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, &self.code, &self.definition) == (&other.name, &other.code, &other.definition)
    }
}

/// The keys of a file with the code of its map in their citation, for a map with a code that keys cannot hold: that of the IAU.
pub(super) fn citing_the_code(system: &CoordinateSystem) -> CoordinateSystem {
    let Ok(map) = MapProjection::of(system) else { return system.clone() };
    let said = system.description.as_deref().unwrap_or_default();
    match map.code() {
        Some(code) if codes::epsg_number(code).is_none() && !said.contains(code) && !said.contains('[') => {
            let name = named(system).map_or_else(|| code.to_owned(), |name| format!("{name} ({code})"));
            geokeys::with_citation(system, &name)
        }
        _ => system.clone(),
    }
}

/// Whether the keys of a file state a projected map.
pub(super) fn states_a_map(system: &CoordinateSystem) -> bool {
    geokeys::states_a_map(system)
}

/// The EPSG code of a file's projected map, known or not.
pub(super) fn projected_code(system: &CoordinateSystem) -> Option<u16> {
    geokeys::projected_code(system)
}

/// Whether a file's well-known text states longitudes and latitudes.
pub(super) fn states_degrees_in_text(system: &CoordinateSystem) -> bool {
    stated::pe_string(system).is_some_and(|text| text.starts_with("GEO"))
}

/// The figure of the body that a file states: by radii, by codes, or by its map. A code of EPSG that is not supported is of the Earth.
pub(super) fn stated_ellipsoid(system: &CoordinateSystem) -> Option<Ellipsoid> {
    let by_map = || MapProjection::of(system).ok().map(|map| map.definition.ellipsoid);
    let of_earth = || {
        let map = geokeys::projected_code(system).is_some_and(is_map_in_metres);
        let places = short_key(system, GEOGRAPHIC_CRS).is_some_and(is_geodetic);
        (map || places).then_some(Ellipsoid::WGS84)
    };
    geokeys::ellipsoid(system).ok().or_else(by_map).or_else(of_earth)
}

/// The file's own name for its map, unless it is "unknown".
fn named(system: &CoordinateSystem) -> Option<String> {
    let plain = |name: &String| {
        !name.eq_ignore_ascii_case("unknown") && !name.starts_with("GCS Name") && !name.starts_with("ESRI PE String")
    };
    system.description.clone().filter(plain)
}

/// A description of a projection.
fn spoken(definition: &Definition) -> String {
    let Ellipsoid { semi_major_m, semi_minor_m } = definition.ellipsoid;
    let figure = if definition.ellipsoid.is_sphere() {
        format!("a sphere of {semi_major_m} m")
    } else {
        format!("an ellipsoid of {semi_major_m} m and {semi_minor_m} m")
    };
    format!("{} on {figure}", definition.method.name())
}

#[cfg(test)]
mod tests;
