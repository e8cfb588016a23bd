//! The position of a raster's posts on the map.

use std::fmt;

use super::TerrainError;
use super::projection::{Ellipsoid, MapProjection, NoProjection, citing_the_code, doubts, stated_ellipsoid};
use crate::quantity::{MapPoint, format_number};

/// The position of a raster on the map: north up, posts on a rectangular lattice.
///
/// ```text
///   north_west o-----o-----o   north
///              |     |     |     ^
///            dy_m    |     |     |
///              o-dx_m-o----o     +--> east
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GeoReference {
    north_west: MapPoint,
    dx_m: f64,
    dy_m: f64,
    /// The map projection as given by the file; empty for a local map.
    pub coordinate_system: CoordinateSystem,
    /// The tags that gave the transform, kept so that they can be written back byte for byte.
    pub transform_tags: TransformTags,
}

/// The map projection of a GeoTIFF: its key directory and description, verbatim.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoordinateSystem {
    /// Tag 34735; empty if absent.
    pub key_directory: Vec<u16>,
    /// Tag 34736.
    pub double_parameters: Vec<f64>,
    /// Tag 34737.
    pub ascii_parameters: String,
    /// The citation, or the EPSG code, in readable form.
    pub description: Option<String>,
}

/// The tags with the position of a GeoTIFF on the map, and its no-data text, verbatim.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransformTags {
    /// Tag 33550.
    pub pixel_scale: Vec<f64>,
    /// Tag 33922.
    pub tie_points: Vec<f64>,
    /// Tag 34264.
    pub transformation: Vec<f64>,
    /// Tag 42113, as read. Not used for writing: posts without elevation are written as NaN.
    pub no_data: Option<String>,
}

/// The rectangle of the outermost posts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapBounds {
    /// South-west corner.
    pub min: MapPoint,
    /// North-east corner.
    pub max: MapPoint,
}

impl MapBounds {
    /// Whether a point lies in the rectangle, including its border.
    pub fn contains(&self, at: MapPoint) -> bool {
        (self.min.x..=self.max.x).contains(&at.x) && (self.min.y..=self.max.y).contains(&at.y)
    }

    /// Whether two rectangles have a point in common.
    pub(crate) fn meets(&self, other: Self) -> bool {
        self.min.x <= other.max.x && other.min.x <= self.max.x && self.min.y <= other.max.y && other.min.y <= self.max.y
    }

    /// Whether the coordinates could be degrees.
    pub(in crate::terrain) fn may_be_degrees(&self) -> bool {
        let Self { min, max } = self;
        min.x >= -180.0 && max.x <= 360.0 && min.y >= -90.0 && max.y <= 90.0
    }
}

impl fmt::Display for MapBounds {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [west, south, east, north] = [self.min.x, self.min.y, self.max.x, self.max.y].map(format_number);
        write!(formatter, "x from {west} to {east} m and y from {south} to {north} m")
    }
}

impl GeoReference {
    /// A local map without projection, from the north-west post and the spacings to the east and north, m.
    ///
    /// # Errors
    /// [`TerrainError::InvalidDem`] if a coordinate is not finite or a spacing is not above zero.
    pub fn local(north_west: MapPoint, dx_m: f64, dy_m: f64) -> Result<Self, TerrainError> {
        if !(north_west.x.is_finite() && north_west.y.is_finite()) {
            return Err(TerrainError::InvalidDem(format!(
                "the north-west post lies at ({} m, {} m), expected finite map coordinates",
                north_west.x, north_west.y
            )));
        }
        for (name, spacing_m) in [("eastward", dx_m), ("northward", dy_m)] {
            if !(spacing_m.is_finite() && spacing_m >= f64::MIN_POSITIVE) {
                return Err(TerrainError::InvalidDem(format!(
                    "the {name} post spacing is {spacing_m} m, expected a finite number above 0 m"
                )));
            }
        }
        Ok(Self {
            north_west,
            dx_m,
            dy_m,
            coordinate_system: CoordinateSystem::default(),
            transform_tags: TransformTags::default(),
        })
    }

    /// The same place on a map of this projection, for a raster that is built in memory. What was said of the map before is replaced.
    ///
    /// The projection states how map coordinates become longitude and latitude; posts stay where they are. Map coordinates are metres.
    ///
    /// # Examples
    /// A DEM in memory, cut between two places given by longitude and latitude:
    /// ```
    /// use chta::quantity::MapPoint;
    /// use chta::terrain::{Dem, GeoReference, LonLat, MapPlace, MapProjection, slice};
    ///
    /// // 101 x 101 posts, 5 m apart, around the south pole of the Moon; the ground rises by 0.1 m for every metre eastward.
    /// let crs: MapProjection = "IAU_2015:30135".parse()?;
    /// let map = GeoReference::local(MapPoint::new(-250.0, 250.0), 5.0, 5.0)?.with_projection(&crs);
    /// let elevations_m: Vec<f32> = (0..101 * 101_u16).map(|post| 0.5 * f32::from(post % 101)).collect();
    /// let dem = Dem::from_single(101, 101, elevations_m, map)?;
    ///
    /// let projection = dem.georeference().projection();
    /// let place = |which, lon_deg, lat_deg| {
    ///     MapPlace::LonLat(LonLat { lon_deg, lat_deg }).on_map(which, projection.as_ref(), dem.bounds())
    /// };
    /// // A thousandth of a degree of latitude is 30.3 m on the Moon.
    /// let profile = slice(&dem, place("from", 90.0, -89.999)?, place("to", 90.0, -89.993)?)?;
    /// assert!((profile.length_m() - 0.006_f64.to_radians() * 1_737_400.0).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_projection(self, projection: &MapProjection) -> Self {
        Self { coordinate_system: projection.coordinate_system(), transform_tags: TransformTags::default(), ..self }
    }

    /// The same place on a map that is stated and not understood, with what was found.
    pub(super) fn with_unknown_map(mut self, found: &str) -> Self {
        // Projected, by a code and a method that are user-defined (OGC GeoTIFF 1.1).
        self.coordinate_system = CoordinateSystem {
            key_directory: vec![1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 32767, 3075, 0, 1, 32767],
            description: Some(found.to_owned()),
            ..CoordinateSystem::default()
        };
        self
    }

    /// The map projection, from what the file or the caller said of it.
    ///
    /// # Errors
    /// [`NoProjection`] if the file gives none, or an unsupported one.
    pub fn projection(&self) -> Result<MapProjection, NoProjection> {
        MapProjection::of(&self.coordinate_system)
    }

    /// The figure of the body that the file states, whether or not its projection is known.
    pub fn ellipsoid(&self) -> Option<Ellipsoid> {
        stated_ellipsoid(&self.coordinate_system)
    }

    /// Warnings about statements of the file that are likely to be wrong.
    pub fn doubts(&self) -> Vec<String> {
        doubts(&self.coordinate_system)
    }

    /// Centre of the north-west post.
    pub fn north_west(&self) -> MapPoint {
        self.north_west
    }

    /// Spacing of posts eastward, m.
    pub fn dx_m(&self) -> f64 {
        self.dx_m
    }

    /// Spacing of posts northward, m.
    pub fn dy_m(&self) -> f64 {
        self.dy_m
    }

    /// The lesser of the two spacings, m.
    pub(crate) fn step_m(&self) -> f64 {
        self.dx_m.min(self.dy_m)
    }

    /// Map coordinates of a post, each computed by one product and one sum from the north-west post.
    ///
    /// ```
    /// use chta::quantity::MapPoint;
    /// use chta::terrain::GeoReference;
    /// let map = GeoReference::local(MapPoint::new(100.0, 50.0), 2.0, 5.0)?;
    /// assert_eq!(map.post(3, 4), MapPoint::new(108.0, 35.0));
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn post(&self, row: usize, col: usize) -> MapPoint {
        #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
        let (row, col) = (row as f64, col as f64);
        MapPoint::new(self.north_west.x + col * self.dx_m, self.north_west.y - row * self.dy_m)
    }

    /// The position of every `stride`-th post, counted from the north-west one; of every post for a stride of 1 (and 0).
    #[must_use]
    pub fn every(&self, stride: usize) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
        let step = stride.max(1) as f64;
        Self { dx_m: self.dx_m * step, dy_m: self.dy_m * step, ..self.clone() }
    }

    /// The position of a raster with `n` posts in place of one, on the same north-west post.
    #[must_use]
    pub fn finer(&self, n: usize) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "counts of points stay far below 2^53")]
        let n = n.max(1) as f64;
        Self { dx_m: self.dx_m / n, dy_m: self.dy_m / n, ..self.clone() }
    }

    /// The same with the code of the map in its name, as GDAL shows it, where only the name can hold it: a code of the IAU.
    #[must_use]
    pub fn citing_the_code(self) -> Self {
        Self { coordinate_system: citing_the_code(&self.coordinate_system), ..self }
    }

    /// The rectangle of the outermost posts of a raster with these numbers of rows and columns.
    pub fn bounds(&self, rows: usize, cols: usize) -> MapBounds {
        let south_east = self.post(rows.saturating_sub(1), cols.saturating_sub(1));
        MapBounds { min: MapPoint::new(self.north_west.x, south_east.y), max: MapPoint::new(south_east.x, self.north_west.y) }
    }
}

/// A map is taken to be in degrees if its relief exceeds its width by this factor.
///
/// The steepest landscapes rise about once their width; a map in degrees appears some 100 000 times too narrow (Earth, Mars;
/// 30 000 on the Moon). A smaller factor would refuse narrow cut-outs of cliffs, a larger one would accept gentle plains in
/// degrees.
const RELIEF_TO_WIDTH_OF_DEGREES: f64 = 5.0;

/// Refuses a raster without stated units whose numbers are only plausible in degrees.
pub(super) fn refuse_degrees(dem: &super::Dem) -> Result<(), TerrainError> {
    if !dem.bounds().may_be_degrees() {
        return Ok(());
    }
    let MapBounds { min, max } = dem.bounds();
    let width = (max.x - min.x).max(max.y - min.y);
    let (low_m, high_m) = dem.elevation_range_m();
    let relief_m = high_m - low_m;
    if relief_m > RELIEF_TO_WIDTH_OF_DEGREES * width {
        return Err(TerrainError::NotProjected {
            found: format!(
                "the map spans {} by {} units but the elevations {relief_m} m, so its coordinates look like degrees",
                max.x - min.x,
                max.y - min.y
            ),
            mend: mend_degrees(&dem.georeference().coordinate_system),
        });
    }
    Ok(())
}

/// How to convert a map in degrees to metres: a stereographic map centred on the journey, which is true to scale around it.
#[derive(Clone, Debug, PartialEq)]
pub struct DegreesMend {
    /// The figure of the body that the file states.
    figure: Option<Ellipsoid>,
    /// Whether the file states a reference system; if not, GDAL needs one on its command line.
    stated: bool,
    /// The name and the radius, m, of the body that the user gives.
    body: Option<(String, f64)>,
}

impl DegreesMend {
    /// The same for the body that the user names: its radius counts where the file states none, or one of another body.
    #[must_use]
    pub fn for_body(self, name: &str, radius_m: f64) -> Self {
        Self { body: Some((name.to_owned(), radius_m)), ..self }
    }
}

impl fmt::Display for DegreesMend {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { figure, stated, body } = self;
        let (known, source, why) = match (figure, body) {
            (Some(figure), Some((name, radius_m))) if !figure.may_be_of(Some(name.as_str()), *radius_m) => {
                let why = format!("; {radius_m} m is the radius of {name}, while the file claims {}", figure.described());
                (format!("+R={radius_m}"), true, why)
            }
            (Some(figure), _) => (figure.proj(), !stated, String::new()),
            (None, Some((_, radius_m))) => (format!("+R={radius_m}"), true, String::new()),
            (None, None) => ("+R=RADIUS_M".to_owned(), true, ", and RADIUS_M is the radius of the body".to_owned()),
        };
        let source = if source { format!("-s_srs '+proj=longlat {known} +no_defs' ") } else { String::new() };
        write!(
            formatter,
            "gdalwarp -r bilinear -ot Float64 -dstnodata nan {source}-t_srs '+proj=stere +lat_0=LATITUDE +lon_0=LONGITUDE {known} +units=m +no_defs' in.tif out.tif, where \
             LATITUDE and LONGITUDE are the middle of the journey{why} (a map over more than some degrees needs -te -REACH -REACH REACH REACH as \
             well, in metres about that place); then give its places as longitude and latitude (scenario: \
             start_lonlat_deg and goal_lonlat_deg)"
        )
    }
}

/// How to mend a map in degrees of this reference system.
pub(super) fn mend_degrees(system: &CoordinateSystem) -> DegreesMend {
    DegreesMend { figure: stated_ellipsoid(system), stated: !system.key_directory.is_empty(), body: None }
}
