//! Codes of authorities: what a code of EPSG or of the IAU means, and which IAU code means a projection.

use super::definition::{Definition, Ellipsoid, Method};

/// Codes of `IAU_2015` bodies, and the radii of their spheres, m.
const IAU_SPHERES: [(u32, f64); 4] = [(199, 2_440_530.0), (299, 6_051_800.0), (301, 1_737_400.0), (499, 3_396_190.0)];

/// The codes that are known, for a sentence.
pub(super) const KNOWN_CODES: &str = "EPSG:32601 to 32660 and 32701 to 32760 (UTM on WGS 84), 25828 to 25838, 26901 to 26923, 3031, 3413, 3976, 3995, \
     5041, 5042, 32661, 32761, 3035, 3857, Albers maps 3005, 3338, 3577, 5070, 6350, 9473 and ESRI:102001, 102003, 102008, or the spherical maps IAU_2015:BB10, BB15, BB20, BB25, BB30, BB35, BB60, BB65, BB70, BB75, BB80 where BB is \
     199 (Mercury), 299 (Venus), 301 (Moon) or 499 (Mars)";

/// The radius of the sphere of a body of the IAU, m, by its number.
pub(in crate::terrain) fn iau_radius_m(body: u32) -> Option<f64> {
    IAU_SPHERES.into_iter().find(|(known, _)| *known == body).map(|(_, radius_m)| radius_m)
}

/// What a code of the IAU (2015) means: the maps on spheres, with latitudes that are planetocentric and planetographic at once.
///
/// The code is 100 times the body's NAIF number, plus the map's number (<https://github.com/USGS-Astrogeology/GDAL_scripts>, `IAU_2015` in
/// PROJ since version 9.0).
pub(super) fn iau(code: u32) -> Option<Definition> {
    let (_, radius_m) = (code / 100, iau_radius_m(code / 100)?);
    let about =
        |method, latitude_deg, longitude_deg| Definition::about(method, latitude_deg, longitude_deg, Ellipsoid::sphere(radius_m));
    let number = code % 100;
    let longitude_deg = if matches!(number, 15 | 25 | 70) { 180.0 } else { 0.0 };
    Some(match number {
        10 | 15 => Definition { parallels_deg: [Some(0.0), None], ..about(Method::Equirectangular, 0.0, longitude_deg) },
        20 | 25 => about(Method::Sinusoidal, 0.0, longitude_deg),
        30 => about(Method::PolarStereographic, 90.0, 0.0),
        35 => about(Method::PolarStereographic, -90.0, 0.0),
        60 => about(Method::TransverseMercator, 0.0, 0.0),
        65 | 70 => about(Method::Orthographic, 0.0, longitude_deg),
        75 => Definition { parallels_deg: [Some(20.0), Some(60.0)], ..about(Method::LambertConformalTwoParallels, 40.0, 0.0) },
        80 => about(Method::LambertAzimuthalEqualArea, 40.0, 0.0),
        _ => return None,
    })
}

/// The code that exactly this projection has by its numbers alone: of the IAU, or EPSG:3857.
pub(super) fn own_code(definition: &Definition) -> Option<String> {
    match definition.method {
        Method::PseudoMercator => Some("EPSG:3857".to_owned()),
        _ => iau_code(definition),
    }
}

/// The code of the IAU (2015) for exactly this projection, such as `IAU_2015:30135`; spheres only.
fn iau_code(definition: &Definition) -> Option<String> {
    let mut usual = *definition;
    if usual.longitude_deg == -180.0 {
        usual.longitude_deg = 180.0;
    }
    match usual.method {
        Method::Sinusoidal => usual.latitude_deg = 0.0,
        Method::Equirectangular => usual.parallels_deg[0] = Some(usual.parallels_deg[0].unwrap_or(0.0)),
        _ => {}
    }
    let (body, _) = IAU_SPHERES.into_iter().find(|(_, radius_m)| usual.ellipsoid == Ellipsoid::sphere(*radius_m))?;
    let code = (body * 100..body * 100 + 100).find(|code| iau(*code) == Some(usual))?;
    Some(format!("IAU_2015:{code}"))
}

/// What authority and code mean: `EPSG:32633`, `IAU_2015:30135`, or the same as a uniform resource name of the OGC.
pub(super) fn by_code(text: &str) -> Option<(String, Definition)> {
    let parts: Vec<&str> = text.split(':').collect();
    let (authority, code) = match parts.as_slice() {
        [authority, code] => (authority.to_ascii_uppercase(), *code),
        [urn, ogc, def, crs, authority, version, code]
            if [*urn, *ogc, *def, *crs]
                .iter()
                .zip(["urn", "ogc", "def", "crs"])
                .all(|(found, word)| found.eq_ignore_ascii_case(word)) =>
        {
            let authority = authority.to_ascii_uppercase();
            (if authority == "IAU" { format!("IAU_{version}") } else { authority }, *code)
        }
        _ => return None,
    };
    match authority.as_str() {
        "EPSG" => code.parse().ok().and_then(|code| Some((format!("EPSG:{code}"), epsg(code)?))),
        "ESRI" => code.parse().ok().and_then(|code| Some((format!("ESRI:{code}"), esri(code)?))),
        "IAU_2015" => code.parse().ok().and_then(|code| Some((format!("IAU_2015:{code}"), iau(code)?))),
        _ => None,
    }
}

/// The number of a code of EPSG, `EPSG:32633`.
pub(super) fn epsg_number(code: &str) -> Option<u16> {
    code.strip_prefix("EPSG:")?.parse().ok()
}

/// The definition of an EPSG code of a projected map: UTM on WGS 84, ETRS89 and NAD83, the usual polar maps, the usual
/// equal-area maps, and the web map.
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
        3857 => Definition::about(Method::PseudoMercator, 0.0, 0.0, Ellipsoid::WGS84),
        3005 => Definition { false_easting_m: 1_000_000.0, ..albers([50.0, 58.5], 45.0, -126.0) },
        3338 => albers([55.0, 65.0], 50.0, -154.0),
        3577 | 9473 => albers([-18.0, -36.0], 0.0, 132.0),
        5070 | 6350 => albers([29.5, 45.5], 23.0, -96.0),
        _ => return None,
    })
}

/// The definition of a code of ESRI: the Albers maps of North America, and the web map.
fn esri(code: u32) -> Option<Definition> {
    Some(match code {
        102_001 => albers([50.0, 70.0], 40.0, -96.0),
        102_003 => albers([29.5, 45.5], 37.5, -96.0),
        102_008 => albers([20.0, 60.0], 40.0, -96.0),
        102_100 => Definition::about(Method::PseudoMercator, 0.0, 0.0, Ellipsoid::WGS84),
        _ => return None,
    })
}

/// An Albers map on the ellipsoid of NAD83 and GDA94.
fn albers(parallels_deg: [f64; 2], latitude_deg: f64, longitude_deg: f64) -> Definition {
    Definition {
        parallels_deg: parallels_deg.map(Some),
        ..Definition::about(Method::AlbersEqualArea, latitude_deg, longitude_deg, Ellipsoid::GRS80)
    }
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

/// The ellipsoid that PROJ means by the name of a datum or ellipsoid.
pub(super) fn named_ellipsoid(name: &str) -> Option<Ellipsoid> {
    match name {
        "WGS84" => Some(Ellipsoid::WGS84),
        "NAD83" | "GRS80" => Some(Ellipsoid::GRS80),
        _ => None,
    }
}

/// The ellipsoid of an EPSG code of a geographic map, a datum or an ellipsoid.
pub(super) fn ellipsoid(code: u16) -> Option<Ellipsoid> {
    match code {
        4326 | 6326 | 7030 => Some(Ellipsoid::WGS84),
        // ETRS89, NAD83, GDA94, NZGD2000, NAD83(CSRS), NAD83(2011).
        4258 | 4269 | 6258 | 6269 | 7019 | 4283 | 6283 | 4167 | 6167 | 4617 | 6140 | 6318 | 1116 => Some(Ellipsoid::GRS80),
        // NAD27 on Clarke 1866; ED50 on International 1924; OSGB36 on Airy 1830.
        4267 | 6267 | 7008 => Some(Ellipsoid { semi_major_m: 6_378_206.4, semi_minor_m: 6_356_583.8 }),
        4230 | 6230 | 7022 => Some(Ellipsoid::with_inverse_flattening(6_378_388.0, 297.0)),
        4277 | 6277 | 7001 => Some(Ellipsoid::with_inverse_flattening(6_377_563.396, 299.324_964_6)),
        _ => None,
    }
}

/// The prime meridians of EPSG, by number: degrees, minutes and seconds, and whether they lie west of Greenwich. Paris (8903) is defined in
/// grads: 2.5969213.
const MERIDIANS: [(u16, [f64; 3], bool); 14] = [
    (8901, [0.0, 0.0, 0.0], false),
    (8902, [9.0, 7.0, 54.862], true),
    (8903, [2.0, 20.0, 14.025_012], false),
    (8904, [74.0, 4.0, 51.3], true),
    (8905, [3.0, 41.0, 14.55], true),
    (8906, [12.0, 27.0, 8.4], false),
    (8907, [7.0, 26.0, 22.5], false),
    (8908, [106.0, 48.0, 27.79], false),
    (8909, [17.0, 40.0, 0.0], true),
    (8910, [4.0, 22.0, 4.71], false),
    (8911, [18.0, 3.0, 29.8], false),
    (8912, [23.0, 42.0, 58.815], false),
    (8913, [10.0, 43.0, 22.5], false),
    (8914, [2.0, 20.0, 13.95], false),
];

/// Geographic codes of EPSG that count longitudes from another meridian than Greenwich, and the meridian (EPSG v10.076).
const BASES: [(u16, u16); 27] = [
    (4801, 8907),
    (4802, 8904),
    (4803, 8902),
    (4804, 8908),
    (4805, 8909),
    (4806, 8906),
    (4807, 8903),
    (4808, 8908),
    (4809, 8910),
    (4810, 8903),
    (4811, 8903),
    (4813, 8908),
    (4814, 8911),
    (4815, 8912),
    (4816, 8903),
    (4817, 8913),
    (4818, 8909),
    (4819, 8903),
    (4820, 8908),
    (4821, 8903),
    (4901, 8914),
    (4902, 8903),
    (4903, 8905),
    (4904, 8902),
    (5229, 8909),
    (8042, 8909),
    (8043, 8909),
];

/// The longitude of a prime meridian of EPSG, degrees.
pub(super) fn meridian_deg(code: u16) -> Option<f64> {
    let (_, [degrees, minutes, seconds], west) = MERIDIANS.into_iter().find(|(known, ..)| *known == code)?;
    let longitude_deg = degrees + minutes / 60.0 + seconds / 3600.0;
    Some(if west { -longitude_deg } else { longitude_deg })
}

/// The geographic code of a datum of EPSG that counts from another meridian, or the code itself.
fn base_of(code: u16) -> u16 {
    match code {
        6801..=6821 | 6901..=6904 => code - 2000,
        1055 => 5229,
        1188 => 8042,
        1189 => 8043,
        _ => code,
    }
}

/// The longitude that a geographic code or datum of EPSG counts from, degrees, if it is not Greenwich.
pub(super) fn base_meridian_deg(code: u16) -> Option<f64> {
    let (_, meridian) = BASES.into_iter().find(|(known, _)| *known == base_of(code))?;
    meridian_deg(meridian)
}

/// Whether a geographic code or datum of EPSG counts angles in grads: those of a meridian of Paris.
pub(super) fn counts_in_grads(code: u16) -> bool {
    matches!(base_of(code), 4807 | 4810 | 4811 | 4816 | 4819 | 4821 | 4901 | 4902)
}
