//! The scale of a map along a transect.

use std::fmt;

use nalgebra::Vector2;

use super::{Definition, LonLat, MapProjection, Method, NoProjection, projected_code};
use crate::quantity::MapPoint;
use crate::terrain::{DemFile, GeoReference, MapBounds, TerrainError, shell_word};

/// The largest error of a map's scale along a transect for which a slice is made.
const SCALE_TOLERANCE: f64 = 0.01;
/// Steps along a transect: the scale of a projection varies much more slowly than over a 256th of any transect on a body.
const STEPS: u32 = 256;
/// Half the step of the difference quotient, as a fraction of the body's radius: errors from rounding (1e-16 R) and curvature
/// (1e-10) both stay small.
const HALF_BASE: f64 = 1.0e-5;
/// The longest transect that one stereographic map shows within the tolerance, as a fraction of the radius: 4 acos(1.01^-1/2)
/// = 0.3987.
const LONGEST_LOCAL: f64 = 0.39;

/// The point of a transect where the map's scale has its largest error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleExtreme {
    /// Scale factor: length on the map over length on the ground, in the direction of travel.
    pub factor: f64,
    /// Position on the map.
    pub at: MapPoint,
    /// Position on the body.
    pub place: LonLat,
    /// Distance along the transect, m on the map.
    pub distance_m: f64,
}

impl ScaleExtreme {
    /// Whether the error exceeds the tolerance.
    pub fn is_off(&self) -> bool {
        (self.factor - 1.0).abs() > SCALE_TOLERANCE
    }

    /// A phrase with the factor along a line and its position.
    fn described(&self, line: &str) -> String {
        let Self { factor, at, place, distance_m } = self;
        format!(
            "the map's scale along {line} is {factor:.5} at {:.6}, {:.6} (longitude, latitude; map point ({:.3} m, {:.3} m), {distance_m:.3} m \
             from the start): a metre of ground is {factor:.5} m on the map",
            place.lon_deg, place.lat_deg, at.x, at.y
        )
    }
}

/// The result of a scale check.
#[derive(Clone, Debug, PartialEq)]
pub enum TransectScale {
    /// A local map, which is assumed to be true to scale.
    Local,
    /// True to scale within 1 %.
    True(ScaleExtreme),
    /// The error is larger, and accepted; with the name of the line.
    Accepted(ScaleExtreme, &'static str),
    /// The projection is not known, so the scale cannot be checked.
    Unknown(String),
}

impl TransectScale {
    /// The error of the factor, its distance from 1; negative if no factor was computed.
    fn error(&self) -> f64 {
        match self {
            Self::Local => -1.0,
            Self::Unknown(_) => -0.5,
            Self::True(extreme) | Self::Accepted(extreme, _) => (extreme.factor - 1.0).abs(),
        }
    }

    /// The warning for the user, if any.
    pub fn warning(&self) -> Option<String> {
        match self {
            Self::Local | Self::True(_) => None,
            Self::Accepted(extreme, line) => {
                Some(format!("{}, which was accepted; distances along it and slopes are off by as much", extreme.described(line)))
            }
            Self::Unknown(reason) => Some(format!(
                "{reason}, so its scale was not checked; distances are assumed to be true to scale: check that they are"
            )),
        }
    }
}

impl MapProjection {
    /// Length on the map over length on the ground at a point, in the direction `heading` (of length 1) of the map.
    ///
    /// Computed as a central difference over 2e-5 of the body's radius, with an error of some 1e-9. The ground is the sphere
    /// or ellipsoid itself: a height above it would change a length by height over radius (a kilometre on the Moon: 0.06 %),
    /// which is neglected. `None` off the map.
    ///
    /// ```
    /// use chta::quantity::MapPoint;
    /// use chta::terrain::{Definition, Ellipsoid, MapProjection, Method};
    /// use nalgebra::Vector2;
    /// // Equirectangular with true scale at the equator: at 60 degrees latitude, a degree of longitude is drawn twice as long.
    /// let moon = Ellipsoid::sphere(1_737_400.0);
    /// let map = MapProjection::new(Definition::about(Method::Equirectangular, 0.0, 0.0, moon), None).unwrap();
    /// let at = MapPoint::new(0.0, 60_f64.to_radians() * 1_737_400.0);
    /// assert!((map.scale(at, Vector2::new(1.0, 0.0)).unwrap() - 2.0).abs() < 1e-8);
    /// assert!((map.scale(at, Vector2::new(0.0, 1.0)).unwrap() - 1.0).abs() < 1e-8);
    /// ```
    pub fn scale(&self, at: MapPoint, heading: Vector2<f64>) -> Option<f64> {
        let half_m = HALF_BASE * self.definition.ellipsoid.semi_major_m;
        let ends = [at - heading * half_m, at + heading * half_m];
        let [Some(begin), Some(end)] = ends.map(|end| self.inverse(end)) else { return None };
        let ground_m = (self.position(end.0, end.1) - self.position(begin.0, begin.1)).norm();
        (ground_m > 0.0).then(|| 2.0 * half_m / ground_m)
    }

    /// The scale with the largest error along a straight line of the map; `None` if part of the line is off the body.
    pub fn extreme_scale(&self, from: MapPoint, to: MapPoint) -> Option<ScaleExtreme> {
        let along = to - from;
        let length_m = libm::hypot(along.x, along.y);
        let heading = along / length_m;
        let mut worst: Option<ScaleExtreme> = None;
        for step in 0..=STEPS {
            let fraction = f64::from(step) / f64::from(STEPS);
            let at = from + along * fraction;
            let factor = self.scale(at, heading)?;
            if worst.is_none_or(|worst| (factor - 1.0).abs() > (worst.factor - 1.0).abs()) {
                worst = Some(ScaleExtreme { factor, at, place: self.lon_lat(at)?, distance_m: fraction * length_m });
            }
        }
        worst
    }

    /// A stereographic map of scale 1 around a point of this one.
    fn about(&self, middle: MapPoint) -> Option<Self> {
        let (lon, lat) = self.inverse(middle)?;
        let rounded = |radians: f64| libm::rint(radians.to_degrees() * 1.0e6) / 1.0e6;
        let ellipsoid = self.definition.ellipsoid;
        let definition = Definition::about(Method::ObliqueStereographic, rounded(lat), rounded(lon), ellipsoid);
        Self::new(definition, None).ok()
    }
}

/// Checks that a slice of a DEM between two map points is true to scale.
///
/// `accepted`: whether the user accepts any scale. `file`: the file of the DEM, for the command in the error message.
///
/// # Errors
/// [`TerrainError::MapScale`] if the scale is off by more than 1 % and this was not accepted, with a `gdalwarp` command for a
/// map that is true to scale along this transect; [`TerrainError::UnknownScale`] if the file states a projection that is not
/// supported and this was not accepted; [`TerrainError::OffTheBody`] if the line leaves the map of the body.
pub fn check_scale(
    dem: &dyn DemFile,
    projection: Result<&MapProjection, &NoProjection>,
    [from, to]: [MapPoint; 2],
    accepted: bool,
    file: &std::path::Path,
) -> Result<TransectScale, TerrainError> {
    let projection = match projection {
        Ok(projection) => projection,
        Err(reason) => return without_scale(dem, reason, accepted, file),
    };
    check_line(dem, projection, [from, to], accepted, "the transect", &|| mend(dem, projection, [from, to], file))
}

/// Checks that a DEM is true to scale from a point to the corners of its map, so that hops in all directions are; returns the
/// line with the largest error.
///
/// # Errors
/// As [`check_scale`], with a `gdalwarp` command for a map around the point that is true to scale everywhere.
pub fn check_map_scale(
    dem: &dyn DemFile,
    projection: Result<&MapProjection, &NoProjection>,
    from: MapPoint,
    accepted: bool,
    file: &std::path::Path,
) -> Result<TransectScale, TerrainError> {
    let projection = match projection {
        Ok(projection) => projection,
        Err(reason) => return without_scale(dem, reason, accepted, file),
    };
    let mut worst = TransectScale::Local;
    for corner in corners(dem) {
        let line = "the line from the start to a corner of the map";
        let scale = check_line(dem, projection, [from, corner], accepted, line, &|| mend_map(dem, projection, from, file))?;
        if scale.error() > worst.error() {
            worst = scale;
        }
    }
    Ok(worst)
}

/// The scale of a map without a supported projection: a local map is true to scale, another is taken only if the user accepts it.
fn without_scale(
    dem: &dyn DemFile,
    reason: &NoProjection,
    accepted: bool,
    file: &std::path::Path,
) -> Result<TransectScale, TerrainError> {
    match reason {
        NoProjection::Local => Ok(TransectScale::Local),
        unknown @ NoProjection::Unknown(_) if accepted => Ok(TransectScale::Unknown(unknown.to_string())),
        unknown @ NoProjection::Unknown(_) => {
            let map = dem.lattice().georeference();
            let mend = mend_unknown(map, &shell_word(file));
            Err(TerrainError::UnknownScale { reason: unknown.clone(), mend })
        }
    }
}

/// The command for a map of a supported projection.
fn mend_unknown(map: &GeoReference, file: &str) -> String {
    let stereographic = |figure: &str, from: &str| {
        format!(
            "gdalwarp -r bilinear -ot Float64 -dstnodata nan {from}-t_srs '+proj=stere +lat_0=LATITUDE +lon_0=LONGITUDE {figure} +units=m +no_defs' {file} out.tif, where \
             LATITUDE and LONGITUDE are the middle of the journey (gdalinfo {file} prints those of the map's corners); then give its places as \
             longitude and latitude"
        )
    };
    match (map.ellipsoid(), projected_code(&map.coordinate_system)) {
        (_, Some(_)) => stereographic("+datum=WGS84", ""),
        (Some(figure), None) => stereographic(&figure.proj(), ""),
        (None, None) => stereographic("+R=RADIUS_M", "-s_srs 'PROJ STRING OF THE MAP' "),
    }
}

/// The corners of a DEM's outermost posts.
fn corners(dem: &dyn DemFile) -> [MapPoint; 4] {
    let MapBounds { min, max } = dem.lattice().bounds();
    [min, MapPoint::new(max.x, min.y), max, MapPoint::new(min.x, max.y)]
}

/// Checks the scale along a line with the name `line`; `mend` gives the remedy if it is off.
fn check_line(
    dem: &dyn DemFile,
    projection: &MapProjection,
    [from, to]: [MapPoint; 2],
    accepted: bool,
    line: &'static str,
    mend: &dyn Fn() -> Option<ScaleMend>,
) -> Result<TransectScale, TerrainError> {
    // A line without direction, or off the map, is refused later by the slice.
    if from == to || ![from, to].iter().all(|end| dem.lattice().bounds().contains(*end)) {
        return Ok(TransectScale::Local);
    }
    let extreme = projection.extreme_scale(from, to).ok_or(TerrainError::OffTheBody { from, to })?;
    match (extreme.is_off(), accepted) {
        (false, _) => Ok(TransectScale::True(extreme)),
        (true, true) => Ok(TransectScale::Accepted(extreme, line)),
        (true, false) => {
            let mend = mend().ok_or(TerrainError::OffTheBody { from, to })?;
            Err(TerrainError::MapScale { found: extreme.described(line), mend })
        }
    }
}

/// What to do about a map whose scale along a line is off.
#[derive(Clone, Debug, PartialEq)]
pub enum ScaleMend {
    /// Make a map which is true to scale along the transect.
    AlongTransect {
        /// The command that makes it.
        command: String,
        /// Where the transect begins and ends.
        ends: [LonLat; 2],
    },
    /// Make a map about the start.
    AboutStart {
        /// The command that makes it.
        command: String,
        /// The start.
        start: LonLat,
        /// How far to every side it holds true at most, m.
        true_within_m: f64,
    },
    /// Take shorter transects.
    Shorter {
        /// The longest over which a map is true to scale, m.
        longest_m: f64,
    },
}

impl fmt::Display for ScaleMend {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AlongTransect { command, ends: [from, to] } => write!(
                formatter,
                "{command}, then slice out.tif from longitude and latitude {:.9},{:.9} to {:.9},{:.9}",
                from.lon_deg, from.lat_deg, to.lon_deg, to.lat_deg
            ),
            Self::AboutStart { command, start, true_within_m } => write!(
                formatter,
                "{command}, then start on out.tif at longitude and latitude {:.9},{:.9} (a map about the start, which holds true \
                 {true_within_m} m to every side at most)",
                start.lon_deg, start.lat_deg
            ),
            Self::Shorter { longest_m } => {
                write!(formatter, "shorter transects, each of {longest_m:.0} m at most: no map is true to scale over a longer one")
            }
        }
    }
}

/// The command for a map around a point that is true to scale everywhere, covering as much of this map as possible.
fn mend_map(dem: &dyn DemFile, projection: &MapProjection, from: MapPoint, file: &std::path::Path) -> Option<ScaleMend> {
    let local = projection.about(from)?;
    let start = projection.lon_lat(from)?;
    // The corners of such a map may be half as far away as the longest transect through its centre.
    let most_m = libm::floor(0.5 * LONGEST_LOCAL * std::f64::consts::FRAC_1_SQRT_2 * projection.definition.ellipsoid.semi_major_m);
    let ends = corners(dem).map(|corner| projection.lon_lat(corner).and_then(|place| local.map_point(place)));
    let reach = |of: &dyn Fn(MapPoint) -> f64| {
        // If a corner shows no point of the body, as far as the new map may extend.
        let along = ends.iter().flatten().map(|end| of(*end));
        let known = ends.iter().all(Option::is_some);
        rounded_m(if known { along.fold(0.0, f64::max).min(most_m) } else { most_m })
    };
    let (west, south, east, north) = (-reach(&|at| -at.x), -reach(&|at| -at.y), reach(&|at| at.x), reach(&|at| at.y));
    let map = dem.lattice().georeference();
    let spacing = |heading: Vector2<f64>, step_m: f64| projection.scale(from, heading).map(|scale| step_m / scale);
    let spacing_m =
        rounded_m(spacing(Vector2::new(1.0, 0.0), map.dx_m())?.min(spacing(Vector2::new(0.0, 1.0), map.dy_m())?)).max(1.0e-4);
    let Definition { latitude_deg, longitude_deg, ellipsoid, .. } = local.definition;
    let command = format!(
        "gdalwarp -r bilinear -t_srs '+proj=stere +lat_0={latitude_deg} +lon_0={longitude_deg} {} +units=m +no_defs' \
         -te {west} {south} {east} {north} -tr {spacing_m} {spacing_m} -ot Float64 -dstnodata nan {} out.tif",
        ellipsoid.proj(),
        shell_word(file),
    );
    Some(ScaleMend::AboutStart { command, start, true_within_m: most_m })
}

/// The command for a map that is true to scale along a transect, or another remedy.
fn mend(dem: &dyn DemFile, projection: &MapProjection, [from, to]: [MapPoint; 2], file: &std::path::Path) -> Option<ScaleMend> {
    let local = projection.about(nalgebra::center(&from, &to))?;
    let place = |at| projection.lon_lat(at);
    let (begin, end) = (place(from)?, place(to)?);
    let ends = [local.map_point(begin)?, local.map_point(end)?];
    if local.extreme_scale(ends[0], ends[1]).is_none_or(|extreme| extreme.is_off()) {
        let longest_m = LONGEST_LOCAL * projection.definition.ellipsoid.semi_major_m;
        return Some(ScaleMend::Shorter { longest_m });
    }
    let (ground_m, map_m) = ((ends[1] - ends[0]).norm(), (to - from).norm());
    let map = dem.lattice().georeference();
    // The finer of the two spacings, converted to the same length of ground on the new map.
    let spacing_m = rounded_m(map.step_m() * ground_m / map_m);
    let margin_m = 10.0 * spacing_m;
    let low = |a: f64, b: f64| rounded_m(a.min(b) - margin_m);
    let high = |a: f64, b: f64| rounded_m(a.max(b) + margin_m);
    let Definition { latitude_deg, longitude_deg, ellipsoid, .. } = local.definition;
    let command = format!(
        "gdalwarp -r bilinear -t_srs '+proj=stere +lat_0={latitude_deg} +lon_0={longitude_deg} {} +units=m +no_defs' -te {} {} {} {} \
         -tr {spacing_m} {spacing_m} -ot Float64 -dstnodata nan {} out.tif",
        ellipsoid.proj(),
        low(ends[0].x, ends[1].x),
        low(ends[0].y, ends[1].y),
        high(ends[0].x, ends[1].x),
        high(ends[0].y, ends[1].y),
        shell_word(file),
    );
    Some(ScaleMend::AlongTransect { command, ends: [begin, end] })
}

/// Rounds to a ten-thousandth of a metre.
fn rounded_m(length_m: f64) -> f64 {
    libm::rint(length_m * 1.0e4) / 1.0e4
}
