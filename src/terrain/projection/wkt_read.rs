//! What well-known text says of a map: WKT 1 of OGC and GDAL, WKT 1 of ESRI (`.prj` files), WKT 2 of 2015 and 2019.
//!
//! Methods and parameters have other names in each dialect; what they are is the table of GDAL's documentation of map projections and of
//! EPSG guidance note 7-2. Whatever is not known is refused: a parameter passed over would be another map.

use super::crs_error::CrsError;
use super::definition::{Definition, Ellipsoid, Method};
use super::wkt_tree::{Node, Value};

/// A map as well-known text states it.
#[derive(Debug)]
pub(super) struct WktMap {
    pub(super) definition: Definition,
    pub(super) name: Option<String>,
    /// Authority and code of the map, unchecked.
    pub(super) code: Option<String>,
}

/// Keywords of the systems that contain a projected map's longitudes and latitudes.
const GEOGRAPHIC: [&str; 9] = [
    "GEOGCS",
    "GEOGCRS",
    "GEOGRAPHICCRS",
    "GEODCRS",
    "GEODETICCRS",
    "BASEGEOGCRS",
    "BASEGEODCRS",
    "BASEGEOGRAPHICCRS",
    "BASEGEODETICCRS",
];
const PROJECTED: [&str; 3] = ["PROJCS", "PROJCRS", "PROJECTEDCRS"];
const VERTICAL: [&str; 3] = ["VERT_CS", "VERTCRS", "VERTICALCRS"];
const LOCAL: [&str; 4] = ["LOCAL_CS", "ENGCRS", "ENGINEERINGCRS", "FITTED_CS"];
const UNITS: [&str; 4] = ["UNIT", "LENGTHUNIT", "ANGLEUNIT", "SCALEUNIT"];

/// Texts round a degree to 9 digits or more.
const UNIT_ROUNDING: f64 = 1.0e-8;

/// A name without the letters in which dialects differ.
fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|letter| letter.to_ascii_lowercase()).collect()
}

/// What a text states.
pub(super) enum Stated {
    /// A map by its numbers.
    Map(WktMap),
    /// A map that GDAL can only say as a PROJ string, kept in an `EXTENSION`.
    Proj(String),
}

/// Reads well-known text.
pub(super) fn read(text: &str) -> Result<Stated, CrsError> {
    let root = Node::parse(text)?;
    let map = projected(&root, &root)?;
    let extension = map.children().find(|node| node.is(&["EXTENSION"]) && node.name() == Some("PROJ4"));
    if let Some(Value::Text(proj)) = extension.and_then(|node| node.values.get(1)) {
        return Ok(Stated::Proj(proj.clone()));
    }
    let base = map
        .child(&GEOGRAPHIC)
        .ok_or(CrsError::Missing { item: "GEOGCS or BASEGEOGCRS", expected: "the body's ellipsoid in it" })?;
    let ellipsoid = ellipsoid(base)?;
    check_axes(map)?;
    check_map_unit(map)?;
    let conversion = map.child(&["CONVERSION"]).unwrap_or(map);
    let method = conversion
        .child(&["PROJECTION", "METHOD"])
        .and_then(Node::name)
        .ok_or(CrsError::Missing { item: "PROJECTION or METHOD", expected: "the name of the projection method" })?;
    let mut definition = Parameters::of(conversion, base)?.definition(method, ellipsoid)?;
    definition.longitude_deg += prime_meridian_deg(base)?;
    Ok(Stated::Map(WktMap { definition, name: map.name().map(str::to_owned), code: code(map) }))
}

/// The projected map of a text, alone or within a compound or bound system.
fn projected<'a, 'b>(node: &'a Node<'b>, root: &Node<'_>) -> Result<&'a Node<'b>, CrsError> {
    let not = |found: &str| Err(CrsError::NotProjected { found: found.to_owned() });
    let inside = |node: &'a Node<'b>| match node.children().find(|child| !child.is(&VERTICAL)) {
        Some(child) => projected(child, root),
        None => not("a system without a map"),
    };
    if node.is(&PROJECTED) {
        return Ok(node);
    }
    if node.is(&["COMPD_CS", "COMPOUNDCRS"]) {
        let units = node.children().filter(|child| child.is(&VERTICAL)).filter_map(|vertical| vertical.find(&UNITS));
        for unit in units {
            check_unit(unit, "elevations", 1.0, "metres")?;
        }
        let axes = node.children().filter(|child| child.is(&VERTICAL)).filter_map(|vertical| vertical.find(&["AXIS"]));
        if axes.filter_map(Node::word).any(|direction| direction.eq_ignore_ascii_case("DOWN")) {
            return Err(CrsError::Contradiction {
                found: "depths, which are counted downwards".to_owned(),
                expected: "heights counted upwards",
            });
        }
        return inside(node);
    }
    if node.is(&["BOUNDCRS", "SOURCECRS"]) {
        return inside(node);
    }
    if node.is(&GEOGRAPHIC) {
        return not("a map in degrees of longitude and latitude");
    }
    if node.is(&VERTICAL) {
        return not("heights without a map");
    }
    if node.is(&LOCAL) {
        return not("a local system without a projection (a local map needs no coordinate reference system)");
    }
    match node.keyword.to_ascii_uppercase().as_str() {
        "GEOCCS" => not("geocentric coordinates"),
        _ => Err(CrsError::NotRecognised { found: CrsError::excerpt(root.keyword) }),
    }
}

fn ellipsoid(base: &Node<'_>) -> Result<Ellipsoid, CrsError> {
    let missing = CrsError::Missing {
        item: "SPHEROID or ELLIPSOID",
        expected: "its semi-major axis and its inverse flattening (0 for a sphere)",
    };
    let node = base.find(&["SPHEROID", "ELLIPSOID"]).ok_or_else(|| missing.clone())?;
    let (Some(semi_major), Some(inverse_flattening)) = (node.number(1), node.number(2)) else { return Err(missing) };
    let metres = node.child(&UNITS).and_then(|unit| unit.number(1)).unwrap_or(1.0);
    Ok(Ellipsoid::with_inverse_flattening(semi_major * metres, inverse_flattening))
}

/// How far east of the body's reference meridian longitudes are counted from.
fn prime_meridian_deg(base: &Node<'_>) -> Result<f64, CrsError> {
    let Some(meridian) = base.child(&["PRIMEM", "PRIMEMERIDIAN"]) else { return Ok(0.0) };
    let longitude = meridian.number(1).unwrap_or(0.0);
    if longitude != 0.0
        && let Some(unit) = meridian.child(&UNITS).or_else(|| base.child(&UNITS))
    {
        check_unit(unit, "the longitude of the prime meridian", 1.0_f64.to_radians(), "degrees")?;
    }
    Ok(longitude)
}

/// Refuses a unit of another size, in metres, radians or 1.
fn check_unit(unit: &Node<'_>, what: &'static str, size: f64, expected: &'static str) -> Result<(), CrsError> {
    match unit.number(1) {
        Some(found) if (found / size - 1.0).abs() <= UNIT_ROUNDING => Ok(()),
        found => {
            let name = unit.name().unwrap_or("a unit without a name");
            let size = found.map_or_else(String::new, |size| format!(" of {size}"));
            Err(CrsError::Unit { what, found: format!("{name}{size}"), expected })
        }
    }
}

/// The unit of the map, which WKT 1 and WKT 2 put beside the axes, or WKT 2 into each of them.
fn check_map_unit(map: &Node<'_>) -> Result<(), CrsError> {
    let axes = map.children().filter(|node| node.is(&["AXIS"]));
    let units: Vec<_> =
        map.children().chain(axes.flat_map(Node::children)).filter(|node| node.is(&["UNIT", "LENGTHUNIT"])).collect();
    if units.is_empty() {
        return Err(CrsError::Missing {
            item: "UNIT or LENGTHUNIT",
            expected: "the unit of the map coordinates, UNIT[\"metre\",1]",
        });
    }
    units.into_iter().try_for_each(|unit| check_unit(unit, "map coordinates", 1.0, "metres"))
}

/// Refuses maps whose x runs west or whose y runs south. On polar maps both run north or south, so only west is refused there.
fn check_axes(map: &Node<'_>) -> Result<(), CrsError> {
    let directions: Vec<&str> = map.children().filter(|node| node.is(&["AXIS"])).filter_map(Node::word).collect();
    let is = |direction: &&&str, wanted: &str| direction.eq_ignore_ascii_case(wanted);
    let polar = directions.len() == 2 && directions[0].eq_ignore_ascii_case(directions[1]);
    let turned = directions.iter().find(|direction| is(direction, "WEST") || (!polar && is(direction, "SOUTH")));
    turned.map_or(Ok(()), |direction| {
        Err(CrsError::Contradiction {
            found: format!("an axis that runs {}", direction.to_ascii_lowercase()),
            expected: "x to the east and y to the north",
        })
    })
}

/// Authority and code of a node, as `EPSG:32633`.
fn code(node: &Node<'_>) -> Option<String> {
    let id = node.child(&["ID", "AUTHORITY"])?;
    let code = match id.values.get(1)? {
        Value::Text(code) => code.clone(),
        Value::Number(number) => number.to_string(),
        _ => return None,
    };
    Some(format!("{}:{code}", id.name()?.to_ascii_uppercase()))
}

/// The parameters of a projection under the one name that each has here.
#[derive(Debug, Default)]
struct Parameters {
    latitude_deg: Option<f64>,
    longitude_deg: Option<f64>,
    easting_m: Option<f64>,
    northing_m: Option<f64>,
    scale: Option<f64>,
    parallel_1_deg: Option<f64>,
    parallel_2_deg: Option<f64>,
}

impl Parameters {
    fn of(conversion: &Node<'_>, base: &Node<'_>) -> Result<Self, CrsError> {
        const DEGREE: f64 = std::f64::consts::PI / 180.0;
        let mut parameters = Self::default();
        for node in conversion.children().filter(|node| node.is(&["PARAMETER"])) {
            let name = node.name().unwrap_or_default();
            let value = node.number(1).ok_or_else(|| CrsError::NotANumber {
                item: format!("the parameter '{}'", CrsError::excerpt(name)),
                found: String::new(),
            })?;
            let angles = "angles of the projection";
            let (place, what, size, unit) = match plain(name).as_str() {
                "latitudeoforigin"
                | "latitudeofcenter"
                | "latitudeofnaturalorigin"
                | "latitudeoffalseorigin"
                | "latitudeofprojectioncentre" => (&mut parameters.latitude_deg, angles, DEGREE, "degrees"),
                "centralmeridian"
                | "longitudeoforigin"
                | "longitudeofcenter"
                | "longitudeofnaturalorigin"
                | "longitudeoffalseorigin"
                | "longitudeofprojectioncentre"
                | "straightverticallongitudefrompole" => (&mut parameters.longitude_deg, angles, DEGREE, "degrees"),
                "standardparallel1" | "latitudeof1ststandardparallel" | "latitudeofstandardparallel" => {
                    (&mut parameters.parallel_1_deg, angles, DEGREE, "degrees")
                }
                "standardparallel2" | "latitudeof2ndstandardparallel" => {
                    (&mut parameters.parallel_2_deg, angles, DEGREE, "degrees")
                }
                "falseeasting" | "eastingatfalseorigin" | "eastingatprojectioncentre" => {
                    (&mut parameters.easting_m, "the false easting", 1.0, "metres")
                }
                "falsenorthing" | "northingatfalseorigin" | "northingatprojectioncentre" => {
                    (&mut parameters.northing_m, "the false northing", 1.0, "metres")
                }
                // 0 is the sphere of the equatorial radius.
                "auxiliaryspheretype" if value == 0.0 => continue,
                "scalefactor" | "scalefactoratnaturalorigin" | "scalefactoratprojectioncentre" => {
                    (&mut parameters.scale, "the scale factor", 1.0, "unity")
                }
                _ => {
                    return Err(CrsError::UnknownParameter {
                        item: format!("the parameter '{}' of the well-known text", CrsError::excerpt(name)),
                        expected: "latitude and longitude of the origin, standard parallels, scale factor, false easting and northing",
                    });
                }
            };
            let inherited = || if size == DEGREE { base.child(&UNITS) } else { None };
            if let Some(found) = node.child(&UNITS).or_else(inherited) {
                check_unit(found, what, size, unit)?;
            }
            if place.replace(value).is_some() {
                return Err(CrsError::Repeated { item: format!("the parameter '{}'", CrsError::excerpt(name)) });
            }
        }
        Ok(parameters)
    }

    fn definition(&self, name: &str, ellipsoid: Ellipsoid) -> Result<Definition, CrsError> {
        let (method, pole_deg) = method(name, ellipsoid.is_sphere(), self.parallel_2_deg.is_some())
            .ok_or_else(|| CrsError::UnknownMethod { found: CrsError::excerpt(name), expected: Method::names() })?;
        let latitude_deg = pole_deg.or(self.latitude_deg).unwrap_or(0.0);
        let mut definition = Definition {
            parallels_deg: [self.parallel_1_deg, self.parallel_2_deg],
            scale: self.scale.unwrap_or(1.0),
            false_easting_m: self.easting_m.unwrap_or(0.0),
            false_northing_m: self.northing_m.unwrap_or(0.0),
            ..Definition::about(method, latitude_deg, self.longitude_deg.unwrap_or(0.0), ellipsoid)
        };
        match method {
            Method::Equirectangular => definition.parallels_deg[0] = Some(self.parallel_1_deg.unwrap_or(0.0)),
            // ESRI states the equator, and EPSG's method the latitude of its origin, which is 0.
            Method::PseudoMercator => {
                definition.parallels_deg[0] = definition.parallels_deg[0].filter(|parallel_deg| *parallel_deg != 0.0);
            }
            Method::PolarStereographic => self.settle_pole(&mut definition, pole_deg)?,
            Method::ObliqueStereographic if latitude_deg.abs() == 90.0 => definition.method = Method::PolarStereographic,
            // ESRI states the one parallel beside the latitude of the origin, which is the same.
            Method::LambertConformalOneParallel => {
                if self.parallel_1_deg.is_some_and(|parallel_deg| parallel_deg != latitude_deg) {
                    return Err(CrsError::Contradiction {
                        found: "a conic map with one standard parallel that is not the latitude of its origin".to_owned(),
                        expected: "the same latitude for both",
                    });
                }
                definition.parallels_deg[0] = None;
            }
            _ => {}
        }
        Ok(definition)
    }

    /// Where the latitude of a polar map is not a pole it is the parallel of true scale, as in GDAL's WKT 1 and in variant B; the pole is
    /// the one on its side.
    fn settle_pole(&self, definition: &mut Definition, pole_deg: Option<f64>) -> Result<(), CrsError> {
        let stated_pole_deg = pole_deg.or(self.latitude_deg.filter(|latitude_deg| latitude_deg.abs() == 90.0));
        let true_scale_deg = match (stated_pole_deg, self.parallel_1_deg, self.latitude_deg) {
            (Some(_), parallel_deg, _) => parallel_deg,
            (None, Some(parallel_deg), None) => Some(parallel_deg),
            (None, None, Some(latitude_deg)) => Some(latitude_deg),
            (None, Some(parallel_deg), Some(latitude_deg)) => {
                return Err(CrsError::Contradiction {
                    found: format!("a polar map about latitude {latitude_deg} with a standard parallel at {parallel_deg}"),
                    expected: "an origin at latitude 90 or -90",
                });
            }
            (None, None, None) => None,
        };
        let pole_deg =
            stated_pole_deg.or_else(|| Some(90.0_f64.copysign(true_scale_deg.filter(|latitude_deg| *latitude_deg != 0.0)?)));
        definition.latitude_deg = pole_deg
            .ok_or(CrsError::Missing { item: "the pole of the polar map", expected: "a latitude of the origin of 90 or -90" })?;
        definition.parallels_deg = [true_scale_deg.filter(|latitude_deg| latitude_deg.abs() != 90.0), None];
        Ok(())
    }
}

/// The method of a name of any dialect, and the pole where the name says which.
fn method(name: &str, sphere: bool, two_parallels: bool) -> Option<(Method, Option<f64>)> {
    let method = match plain(name).as_str() {
        "equirectangular" | "equidistantcylindrical" | "equidistantcylindricalspherical" | "platecarree" => Method::Equirectangular,
        "polarstereographic" | "polarstereographicvarianta" | "polarstereographicvariantb" => Method::PolarStereographic,
        "stereographicnorthpole" => return Some((Method::PolarStereographic, Some(90.0))),
        "stereographicsouthpole" => return Some((Method::PolarStereographic, Some(-90.0))),
        "stereographic" => Method::ObliqueStereographic,
        "obliquestereographic" | "doublestereographic" => Method::DoubleStereographic,
        "sinusoidal" => Method::Sinusoidal,
        "transversemercator" | "gausskruger" => Method::TransverseMercator,
        "orthographic" => Method::Orthographic,
        "mercator" | "mercator1sp" | "mercator2sp" | "mercatorvarianta" | "mercatorvariantb" => Method::Mercator,
        "lambertconformalconic" if two_parallels => Method::LambertConformalTwoParallels,
        "lambertconformalconic" | "lambertconformalconic1sp" | "lambertconicconformal1sp" => Method::LambertConformalOneParallel,
        "lambertconformalconic2sp" | "lambertconicconformal2sp" => Method::LambertConformalTwoParallels,
        "lambertazimuthalequalarea" => Method::LambertAzimuthalEqualArea,
        "lambertazimuthalequalareaspherical" if sphere => Method::LambertAzimuthalEqualArea,
        "albers" | "albersconicequalarea" | "albersequalarea" => Method::AlbersEqualArea,
        "mercatorauxiliarysphere" | "popularvisualisationpseudomercator" => Method::PseudoMercator,
        // PROJ before 9.2 states its azimuthal equidistant map as the "modified" one of EPSG (9832).
        "azimuthalequidistant" | "modifiedazimuthalequidistant" => Method::AzimuthalEquidistant,
        _ => return None,
    };
    Some((method, None))
}
