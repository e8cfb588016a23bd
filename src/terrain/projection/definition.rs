//! A map projection as numbers (method, parameters, ellipsoid), and its proj string.

use std::fmt::Write;

/// The method of a map projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Equidistant cylindrical: `eqc`.
    Equirectangular,
    /// Stereographic about a pole: `stere` with a latitude of origin of 90 or -90.
    PolarStereographic,
    /// Stereographic around any other point: `stere`.
    ObliqueStereographic,
    /// Stereographic of the conformal sphere (EPSG 9809): `sterea`.
    DoubleStereographic,
    /// Sinusoidal: `sinu`.
    Sinusoidal,
    /// Transverse Mercator, UTM among them: `tmerc`.
    TransverseMercator,
    /// Orthographic: `ortho`.
    Orthographic,
    /// Mercator: `merc`.
    Mercator,
    /// Lambert conformal conic with one standard parallel: `lcc`.
    LambertConformalOneParallel,
    /// Lambert conformal conic with two standard parallels: `lcc`.
    LambertConformalTwoParallels,
    /// Lambert azimuthal equal area: `laea`.
    LambertAzimuthalEqualArea,
    /// Azimuthal equidistant: `aeqd`.
    AzimuthalEquidistant,
    /// Albers equal-area conic: `aea`.
    AlbersEqualArea,
    /// Mercator's equations for a sphere of the equatorial radius, of the latitudes of an ellipsoid (EPSG 1024): `webmerc`. No
    /// conformal map: EPSG:3857 alone is made with it.
    PseudoMercator,
}

impl Method {
    /// All methods.
    pub(super) const ALL: [Self; 14] = [
        Self::Equirectangular,
        Self::PolarStereographic,
        Self::ObliqueStereographic,
        Self::DoubleStereographic,
        Self::Sinusoidal,
        Self::TransverseMercator,
        Self::Orthographic,
        Self::Mercator,
        Self::LambertConformalOneParallel,
        Self::LambertConformalTwoParallels,
        Self::LambertAzimuthalEqualArea,
        Self::AzimuthalEquidistant,
        Self::AlbersEqualArea,
        Self::PseudoMercator,
    ];

    /// The name of the method.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Equirectangular => "equirectangular",
            Self::PolarStereographic => "polar stereographic",
            Self::ObliqueStereographic => "oblique stereographic",
            Self::DoubleStereographic => "double stereographic",
            Self::Sinusoidal => "sinusoidal",
            Self::TransverseMercator => "transverse Mercator",
            Self::Orthographic => "orthographic",
            Self::Mercator => "Mercator",
            Self::LambertConformalOneParallel | Self::LambertConformalTwoParallels => "Lambert conformal conic",
            Self::LambertAzimuthalEqualArea => "Lambert azimuthal equal-area",
            Self::AzimuthalEquidistant => "azimuthal equidistant",
            Self::AlbersEqualArea => "Albers equal-area conic",
            Self::PseudoMercator => "pseudo-Mercator",
        }
    }

    /// The names of all of them, for a sentence.
    pub(super) fn names() -> String {
        let mut names: Vec<&str> = Self::ALL.iter().map(|method| method.name()).collect();
        names.dedup();
        names.join(", ")
    }

    /// The value of `+proj=`.
    pub(super) const fn proj(self) -> &'static str {
        match self {
            Self::Equirectangular => "eqc",
            Self::PolarStereographic | Self::ObliqueStereographic => "stere",
            Self::DoubleStereographic => "sterea",
            Self::Sinusoidal => "sinu",
            Self::TransverseMercator => "tmerc",
            Self::Orthographic => "ortho",
            Self::Mercator => "merc",
            Self::LambertConformalOneParallel | Self::LambertConformalTwoParallels => "lcc",
            Self::LambertAzimuthalEqualArea => "laea",
            Self::AzimuthalEquidistant => "aeqd",
            Self::AlbersEqualArea => "aea",
            Self::PseudoMercator => "webmerc",
        }
    }

    /// Whether the method has a scale factor at the origin, which may differ from 1.
    pub(super) const fn has_scale(self) -> bool {
        matches!(
            self,
            Self::PolarStereographic
                | Self::ObliqueStereographic
                | Self::DoubleStereographic
                | Self::TransverseMercator
                | Self::Mercator
                | Self::LambertConformalOneParallel
        )
    }

    /// Whether the latitude of its origin is a parameter.
    pub(super) const fn has_latitude(self) -> bool {
        !matches!(self, Self::Sinusoidal | Self::Mercator | Self::PseudoMercator)
    }

    /// The names of its standard parallels in a proj string.
    pub(super) const fn parallels(self) -> &'static [&'static str] {
        match self {
            Self::Equirectangular | Self::PolarStereographic | Self::Mercator => &["lat_ts"],
            Self::LambertConformalTwoParallels | Self::AlbersEqualArea => &["lat_1", "lat_2"],
            _ => &[],
        }
    }
}

/// How far two statements of a radius may differ, as a fraction: conventions for one body differ by 0.3 % (Mars), bodies by far more.
pub(super) const RADIUS_TOLERANCE: f64 = 0.01;

/// The figure of a body: a sphere, or a sphere flattened at its poles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Equatorial radius, m.
    pub semi_major_m: f64,
    /// Polar radius, m.
    pub semi_minor_m: f64,
}

impl Ellipsoid {
    /// WGS 84.
    pub(in crate::terrain) const WGS84: Self =
        Self { semi_major_m: 6_378_137.0, semi_minor_m: 6_378_137.0 * (1.0 - 1.0 / 298.257_223_563) };
    /// GRS 1980.
    pub(super) const GRS80: Self = Self { semi_major_m: 6_378_137.0, semi_minor_m: 6_378_137.0 * (1.0 - 1.0 / 298.257_222_101) };

    /// A sphere of this radius, m.
    pub const fn sphere(radius_m: f64) -> Self {
        Self { semi_major_m: radius_m, semi_minor_m: radius_m }
    }

    /// An ellipsoid from its equatorial radius, m, and inverse flattening, where 0 means a sphere.
    pub fn with_inverse_flattening(semi_major_m: f64, inverse_flattening: f64) -> Self {
        let flattening = if inverse_flattening == 0.0 { 0.0 } else { 1.0 / inverse_flattening };
        Self { semi_major_m, semi_minor_m: semi_major_m * (1.0 - flattening) }
    }

    /// Whether a radius lies between its axes, or beyond them by at most this fraction.
    pub(crate) fn is_within(&self, radius_m: f64, tolerance: f64) -> bool {
        (self.semi_minor_m * (1.0 - tolerance)..=self.semi_major_m * (1.0 + tolerance)).contains(&radius_m)
    }

    /// Whether a map of this figure may be one of a body with this name and mean radius, m: to 1 % of the radius, or of the longest and
    /// shortest axis of a known body that is far from a sphere (IAU WGCCRE 2015; Bennu: Lauretta et al. 2019, Ryugu: Watanabe et al. 2019,
    /// 67P: Jorda et al. 2016).
    pub fn may_be_of(&self, name: Option<&str>, radius_m: f64) -> bool {
        const AXES_M: [(&str, f64, f64); 10] = [
            ("phobos", 9_100.0, 13_000.0),
            ("deimos", 5_100.0, 7_800.0),
            ("ceres", 446_000.0, 487_300.0),
            ("vesta", 223_200.0, 289_000.0),
            ("enceladus", 248_300.0, 256_600.0),
            ("bennu", 228.0, 283.0),
            ("ryugu", 438.0, 502.0),
            ("eros", 5_500.0, 17_000.0),
            ("67p", 1_200.0, 2_500.0),
            ("mars", 3_376_200.0, 3_396_190.0),
        ];
        let known = AXES_M.into_iter().find(|(body, low_m, high_m)| Some(*body) == name && (low_m..=high_m).contains(&&radius_m));
        let (low_m, high_m) = known.map_or((radius_m, radius_m), |(_, low_m, high_m)| (low_m, high_m));
        self.semi_major_m >= low_m * (1.0 - RADIUS_TOLERANCE) && self.semi_minor_m <= high_m * (1.0 + RADIUS_TOLERANCE)
    }

    /// Its radii as a phrase.
    pub(in crate::terrain) fn described(&self) -> String {
        let Self { semi_major_m, semi_minor_m } = self;
        if self.is_sphere() {
            format!("a radius of {semi_major_m} m")
        } else {
            format!("radii of {semi_major_m} m (equator) and {semi_minor_m} m (poles)")
        }
    }

    /// Whether it is a sphere.
    pub fn is_sphere(&self) -> bool {
        self.semi_major_m == self.semi_minor_m
    }

    /// a / (a - b), or 0 for a sphere, as well-known text requires.
    pub(super) fn inverse_flattening(&self) -> f64 {
        if self.is_sphere() { 0.0 } else { self.semi_major_m / (self.semi_major_m - self.semi_minor_m) }
    }

    /// `+R=` or `+a= +b=`.
    pub(in crate::terrain) fn proj(&self) -> String {
        if self.is_sphere() {
            format!("+R={}", self.semi_major_m)
        } else {
            format!("+a={} +b={}", self.semi_major_m, self.semi_minor_m)
        }
    }
}

/// EPSG:3857 as PROJ and GDAL write it: a sphere, and `+nadgrids=@null`, by which latitudes stay those of WGS 84.
pub(super) const WEB_MAP: &str =
    "+proj=merc +a=6378137 +b=6378137 +lat_ts=0 +lon_0=0 +x_0=0 +y_0=0 +k=1 +units=m +nadgrids=@null +wktext +no_defs";

/// The parameters of a map projection. Latitudes are planetographic here, as projections require.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Definition {
    /// The method.
    pub method: Method,
    /// Latitude of the origin, degrees; 0 if the method has none, 90 or -90 for a polar map.
    pub latitude_deg: f64,
    /// Longitude of the origin, degrees.
    pub longitude_deg: f64,
    /// Standard parallels, degrees, if the method has them.
    pub parallels_deg: [Option<f64>; 2],
    /// Scale at the origin; 1 if the method has none.
    pub scale: f64,
    /// Easting of the origin, m.
    pub false_easting_m: f64,
    /// Northing of the origin, m.
    pub false_northing_m: f64,
    /// The body's figure.
    pub ellipsoid: Ellipsoid,
}

impl Definition {
    /// A projection with its origin at a point, scale 1 and no offsets.
    pub const fn about(method: Method, latitude_deg: f64, longitude_deg: f64, ellipsoid: Ellipsoid) -> Self {
        Self {
            method,
            latitude_deg,
            longitude_deg,
            parallels_deg: [None; 2],
            scale: 1.0,
            false_easting_m: 0.0,
            false_northing_m: 0.0,
            ellipsoid,
        }
    }

    /// The proj string.
    ///
    /// ```
    /// use chta::terrain::{Definition, Ellipsoid, Method};
    /// let south = Definition::about(Method::PolarStereographic, -90.0, 0.0, Ellipsoid::sphere(1_737_400.0));
    /// assert_eq!(south.proj_string(), "+proj=stere +lat_0=-90 +lon_0=0 +k_0=1 +x_0=0 +y_0=0 +R=1737400 +units=m +no_defs");
    /// ```
    pub fn proj_string(&self) -> String {
        if self.method == Method::PseudoMercator {
            return WEB_MAP.to_owned();
        }
        let mut text = format!("+proj={}", self.method.proj());
        // Writing to a String cannot fail.
        if self.method.has_latitude() {
            let _ = write!(text, " +lat_0={}", self.latitude_deg);
        }
        let _ = write!(text, " +lon_0={}", self.longitude_deg);
        for (name, degrees) in self.method.parallels().iter().zip(self.parallels_deg) {
            if let Some(degrees) = degrees {
                let _ = write!(text, " +{name}={degrees}");
            }
        }
        if self.method == Method::LambertConformalOneParallel {
            let _ = write!(text, " +lat_1={}", self.latitude_deg);
        }
        if self.method.has_scale() && self.parallels_deg[0].is_none() {
            let _ = write!(text, " +k_0={}", self.scale);
        }
        let (x, y, figure) = (self.false_easting_m, self.false_northing_m, self.ellipsoid.proj());
        let _ = write!(text, " +x_0={x} +y_0={y} {figure} +units=m +no_defs");
        text
    }

    /// The proj strings of the equations: from map coordinates, and to longitude and planetographic latitude.
    pub(super) fn equations(&self) -> [String; 2] {
        let geographic = |figure: Ellipsoid| format!("+proj=longlat {} +no_defs", figure.proj());
        match self.method {
            Method::PseudoMercator => {
                let sphere = Ellipsoid::sphere(self.ellipsoid.semi_major_m);
                [format!("+proj=merc {} +units=m +no_defs", sphere.proj()), geographic(sphere)]
            }
            _ => [self.proj_string(), geographic(self.ellipsoid)],
        }
    }

    /// Why the parameters do not define a projection; `None` if they do.
    pub(super) fn fault(&self) -> Option<String> {
        let Self { latitude_deg, longitude_deg, parallels_deg, scale, false_easting_m, false_northing_m, ellipsoid, method } = self;
        let Ellipsoid { semi_major_m, semi_minor_m } = ellipsoid;
        if !(semi_major_m.is_finite() && *semi_minor_m > 0.0 && semi_minor_m <= semi_major_m) {
            return Some(format!("radii of {semi_major_m} m and {semi_minor_m} m"));
        }
        if !(latitude_deg.abs() <= 90.0 && parallels_deg.iter().flatten().all(|latitude| latitude.abs() <= 90.0)) {
            return Some("a latitude beyond 90 degrees".to_owned());
        }
        if !(longitude_deg.abs() <= 540.0 && false_easting_m.is_finite() && false_northing_m.is_finite()) {
            return Some(format!("an origin at longitude {longitude_deg}, ({false_easting_m}, {false_northing_m}) m"));
        }
        if !(scale.is_finite() && *scale > 0.0) {
            return Some(format!("a scale of {scale}"));
        }
        if parallels_deg[0].is_some() && *scale != 1.0 {
            return Some(format!("a {} projection with both a standard parallel and a scale of {scale}", method.name()));
        }
        self.misplaced()
    }

    /// Whether the numbers of one may stand for the other: GDAL states ESRI's web map by those of a Mercator map.
    pub(super) fn replaces(&self, other: &Self) -> bool {
        matches!(
            (self.method, other.method),
            (Method::Mercator, Method::PseudoMercator) | (Method::PseudoMercator, Method::Mercator)
        )
    }

    /// Whether it is EPSG:3857: a pseudo-Mercator map is defined for its numbers alone.
    fn is_web_map(&self) -> bool {
        *self == Self::about(Method::PseudoMercator, 0.0, 0.0, Ellipsoid::WGS84)
    }

    /// A number that its method does not have, or one that it lacks: the map would not be what the numbers say.
    fn misplaced(&self) -> Option<String> {
        let Self { latitude_deg, parallels_deg, scale, method, .. } = self;
        let name = method.name();
        if !method.has_scale() && *scale != 1.0 {
            return Some(format!("a scale of {scale}, which a {name} projection does not have"));
        }
        let allowed = method.parallels().len();
        if parallels_deg.iter().skip(allowed).any(Option::is_some) {
            return Some(format!("more standard parallels than a {name} projection has ({allowed})"));
        }
        match (method, parallels_deg) {
            (Method::LambertConformalTwoParallels | Method::AlbersEqualArea, [None, _] | [_, None]) => {
                Some(format!("one of the two standard parallels of a {name} projection missing"))
            }
            (Method::AlbersEqualArea, [Some(first_deg), Some(second_deg)]) if first_deg + second_deg == 0.0 => {
                Some(format!("standard parallels at {first_deg} and {second_deg}, between which a conic map has no cone"))
            }
            (Method::PseudoMercator, _) if !self.is_web_map() => {
                Some(format!("a {name} projection with an origin or an ellipsoid of its own, which only EPSG:3857 may have"))
            }
            (Method::PolarStereographic, _) if latitude_deg.abs() != 90.0 => Some(format!("a pole at latitude {latitude_deg}")),
            (Method::PolarStereographic, [Some(parallel_deg), _]) if parallel_deg * latitude_deg <= 0.0 => Some(format!(
                "a standard parallel at latitude {parallel_deg} on a map about the pole at {latitude_deg}, which must lie on the pole's side of the equator"
            )),
            _ => None,
        }
    }
}
