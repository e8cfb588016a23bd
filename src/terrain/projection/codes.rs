//! Codes of authorities: the meaning of EPSG codes, and the IAU codes of projections.

use super::definition::{Definition, Ellipsoid, Method};

/// Codes of `IAU_2015` bodies, and the radii of their spheres, m.
const IAU_SPHERES: [(u32, f64); 4] = [(199, 2_440_530.0), (299, 6_051_800.0), (301, 1_737_400.0), (499, 3_396_190.0)];

/// The code of the IAU (2015) for exactly this projection, such as `IAU_2015:30135`; spheres only.
pub(super) fn iau_code(definition: &Definition) -> Option<String> {
    let Definition { method, latitude_deg, longitude_deg, parallels_deg, scale, false_easting_m, false_northing_m, ellipsoid } =
        *definition;
    let (body, _) = IAU_SPHERES.into_iter().find(|(_, radius_m)| ellipsoid == Ellipsoid::sphere(*radius_m))?;
    if scale != 1.0 || false_easting_m != 0.0 || false_northing_m != 0.0 {
        return None;
    }
    let meridian = match longitude_deg {
        0.0 => 0,
        180.0 | -180.0 => 5,
        _ => return None,
    };
    let plain = parallels_deg == [None; 2] || parallels_deg == [Some(0.0), None];
    let code = match (method, latitude_deg) {
        (Method::Equirectangular, 0.0) if plain => 10 + meridian,
        (Method::Sinusoidal, _) => 20 + meridian,
        (Method::PolarStereographic, 90.0) if meridian == 0 && parallels_deg[0].is_none() => 30,
        (Method::PolarStereographic, -90.0) if meridian == 0 && parallels_deg[0].is_none() => 35,
        (Method::TransverseMercator, 0.0) if meridian == 0 => 60,
        (Method::Orthographic, 0.0) => 65 + meridian,
        (Method::LambertConformalTwoParallels, 40.0) if meridian == 0 && parallels_deg == [Some(20.0), Some(60.0)] => 75,
        (Method::LambertAzimuthalEqualArea, 40.0) if meridian == 0 => 80,
        _ => return None,
    };
    Some(format!("IAU_2015:{}", body * 100 + code))
}

/// The definition of an EPSG code of a projected map: UTM on WGS 84, ETRS89 and NAD83, the usual polar maps, and Europe's
/// equal-area map.
pub(super) fn epsg(code: u16) -> Option<Definition> {
    let polar = |latitude_deg: f64, longitude_deg, parallel_deg| Definition {
        parallels_deg: [Some(parallel_deg), None],
        ..Definition::about(Method::PolarStereographic, latitude_deg, longitude_deg, Ellipsoid::WGS84)
    };
    let universal_polar = |latitude_deg| Definition {
        scale: 0.994,
        false_easting_m: 2_000_000.0,
        false_northing_m: 2_000_000.0,
        ..Definition::about(Method::PolarStereographic, latitude_deg, 0.0, Ellipsoid::WGS84)
    };
    Some(match code {
        32_601..=32_660 => utm(code - 32_600, false, Ellipsoid::WGS84),
        32_701..=32_760 => utm(code - 32_700, true, Ellipsoid::WGS84),
        25_828..=25_838 => utm(code - 25_800, false, Ellipsoid::GRS80),
        26_901..=26_923 => utm(code - 26_900, false, Ellipsoid::GRS80),
        3031 => polar(-90.0, 0.0, -71.0),
        3413 => polar(90.0, -45.0, 70.0),
        3976 => polar(-90.0, 0.0, -70.0),
        3995 => polar(90.0, 0.0, 71.0),
        5041 | 32_661 => universal_polar(90.0),
        5042 | 32_761 => universal_polar(-90.0),
        3035 => Definition {
            false_easting_m: 4_321_000.0,
            false_northing_m: 3_210_000.0,
            ..Definition::about(Method::LambertAzimuthalEqualArea, 52.0, 10.0, Ellipsoid::GRS80)
        },
        _ => return None,
    })
}

/// A zone of Universal Transverse Mercator.
pub(super) fn utm(zone: u16, south: bool, ellipsoid: Ellipsoid) -> Definition {
    Definition {
        scale: 0.9996,
        false_easting_m: 500_000.0,
        false_northing_m: if south { 10_000_000.0 } else { 0.0 },
        ..Definition::about(Method::TransverseMercator, 0.0, f64::from(zone) * 6.0 - 183.0, ellipsoid)
    }
}

/// The ellipsoid of an EPSG code of a geographic map, a datum or an ellipsoid.
pub(super) fn ellipsoid(code: u16) -> Option<Ellipsoid> {
    match code {
        4326 | 6326 | 7030 => Some(Ellipsoid::WGS84),
        4258 | 4269 | 6258 | 6269 | 7019 => Some(Ellipsoid::GRS80),
        _ => None,
    }
}
