use super::*;

const MOON: Ellipsoid = Ellipsoid::sphere(1_737_400.0);
const MARS: Ellipsoid = Ellipsoid { semi_major_m: 3_396_190.0, semi_minor_m: 3_376_200.0 };

/// One projection of every method, with no parameter at its default.
fn one_of_each() -> Vec<Definition> {
    Method::ALL
        .into_iter()
        .filter(|method| *method != Method::PseudoMercator)
        .map(|method| {
            let latitude_deg = match method {
                Method::PolarStereographic => -90.0,
                Method::Sinusoidal | Method::Mercator => 0.0,
                _ => 12.5,
            };
            let parallels_deg = match method {
                Method::Equirectangular => [Some(20.0), None],
                Method::LambertConformalTwoParallels | Method::AlbersEqualArea => [Some(5.0), Some(31.0)],
                _ => [None; 2],
            };
            Definition {
                parallels_deg,
                scale: if method.has_scale() { 0.9875 } else { 1.0 },
                false_easting_m: 1000.5,
                false_northing_m: -250.25,
                ..Definition::about(method, latitude_deg, -77.25, MARS)
            }
        })
        .collect()
}

#[test]
fn every_projection_survives_keys_and_proj_string() {
    let on_parallel = [
        Definition { parallels_deg: [Some(-71.0), None], ..Definition::about(Method::PolarStereographic, -90.0, 3.0, MOON) },
        Definition { parallels_deg: [Some(33.0), None], ..Definition::about(Method::Mercator, 0.0, 3.0, MARS) },
    ];
    for definition in one_of_each().into_iter().chain(on_parallel) {
        let projection = MapProjection::new(definition, Some("a map | of mine".to_owned())).unwrap();
        let keys = projection.coordinate_system();
        let again = MapProjection::of(&keys).unwrap();
        assert_eq!(again.definition(), &definition);
        assert_eq!(again.name(), "a map _ of mine");
        let text = definition.proj_string();
        assert_eq!(MapProjection::from_proj_string(&text, None, None).unwrap().definition(), &definition, "{text}");
    }
}

#[test]
fn a_round_trip_gives_the_same_position_also_across_the_date_line() {
    for definition in one_of_each() {
        let projection = MapProjection::new(definition, None).unwrap();
        let lat_deg = if definition.latitude_deg == -90.0 { -84.0 } else { 7.0 };
        for lon_deg in [-77.25, -70.0, 283.0, -100.0] {
            let at = projection.map_point(LonLat { lon_deg, lat_deg }).unwrap();
            let place = projection.lon_lat(at).unwrap();
            let turn = (place.lon_deg - lon_deg) / 360.0;
            assert!((turn - turn.round()).abs() < 1e-13 && (place.lat_deg - lat_deg).abs() < 1e-11, "{definition:?} {place}");
        }
    }
}

#[test]
fn positions_off_the_map_have_no_point_and_points_off_the_body_no_position() {
    let ortho = MapProjection::new(Definition::about(Method::Orthographic, 0.0, 0.0, MOON), None).unwrap();
    assert_eq!(ortho.map_point(LonLat { lon_deg: 120.0, lat_deg: 0.0 }), None);
    assert_eq!(ortho.lon_lat(MapPoint::new(1.8e6, 0.0)), None);
    let sinusoidal = MapProjection::new(Definition::about(Method::Sinusoidal, 0.0, 0.0, MOON), None).unwrap();
    assert_eq!(sinusoidal.lon_lat(MapPoint::new(5.0e6, 1.5e6)), None, "beyond the map's edge");
    assert_eq!(sinusoidal.map_point(LonLat { lon_deg: 0.0, lat_deg: 90.5 }), None);
    assert_eq!(sinusoidal.map_point(LonLat { lon_deg: f64::NAN, lat_deg: 0.0 }), None);
}

#[test]
fn mars_latitudes_are_planetocentric() {
    // At 45 degrees planetographic: tan(planetocentric) = (b/a)^2.
    let map = MapProjection::new(Definition::about(Method::ObliqueStereographic, 45.0, 10.0, MARS), None).unwrap();
    let place = map.lon_lat(MapPoint::new(0.0, 0.0)).unwrap();
    let expected = (3_376_200.0_f64 / 3_396_190.0).powi(2).atan().to_degrees();
    assert!((place.lat_deg - expected).abs() < 1e-12 && (expected - 44.662).abs() < 1e-3, "{place}");
}

#[test]
fn an_unsupported_projection_has_a_reason() {
    let keys = |entries: &[[u16; 4]], double_parameters: Vec<f64>| CoordinateSystem {
        key_directory: [&[1, 1, 0, u16::try_from(entries.len()).unwrap()][..], &entries.concat()].concat(),
        double_parameters,
        ..CoordinateSystem::default()
    };
    assert_eq!(MapProjection::of(&CoordinateSystem::default()), Err(NoProjection::Local));
    let reason = |entries: &[[u16; 4]], doubles| match MapProjection::of(&keys(entries, doubles)) {
        Err(NoProjection::Unknown(reason)) => reason,
        other => panic!("{other:?}"),
    };
    let user = [[1024, 0, 1, 1], [3072, 0, 1, 32767]];
    assert!(reason(&[[1024, 0, 1, 1], [3072, 0, 1, 2278]], vec![]).contains("2278"));
    assert!(reason(&[user[0], user[1], [3075, 0, 1, 17]], vec![]).contains("no radius"));
    let sized = |more: &[[u16; 4]]| [&user[..], &[[2057, 34736, 1, 0], [2058, 34736, 1, 0]], more].concat();
    assert!(reason(&sized(&[[3075, 0, 1, 3]]), vec![1000.0]).contains("number 3"));
    assert!(reason(&sized(&[[2054, 0, 1, 9101], [3075, 0, 1, 17]]), vec![1000.0]).contains("9101"));
    assert!(
        reason(&sized(&[[3075, 0, 1, 17], [3080, 34736, 1, 1], [3088, 34736, 1, 2]]), vec![1.0, 3.0, 4.0]).contains("longitudes")
    );
    assert!(reason(&sized(&[[3075, 0, 1, 15]]), vec![1000.0]).contains("pole"));
    assert!(reason(&sized(&[[3075, 0, 1, 17]]), vec![f64::NAN]).contains("radii"));
}

#[test]
fn a_prime_meridian_moves_the_origin() {
    let plain = MapProjection::new(Definition::about(Method::ObliqueStereographic, 18.0, 77.0, MOON), None).unwrap();
    let mut keys = plain.coordinate_system();
    let offset = u16::try_from(keys.double_parameters.len()).unwrap();
    keys.key_directory.extend([2061, 34736, 1, offset]);
    keys.key_directory[3] += 1;
    keys.double_parameters.push(20.0);
    assert_eq!(MapProjection::of(&keys).unwrap().definition().longitude_deg, 97.0);
}

#[test]
fn maps_with_a_code_have_a_urn_and_others_have_none() {
    let urn = |definition| MapProjection::new(definition, None).unwrap().urn();
    assert_eq!(urn(Definition::about(Method::PolarStereographic, -90.0, 0.0, MOON)).unwrap(), "urn:ogc:def:crs:IAU:2015:30135");
    assert_eq!(urn(Definition::about(Method::PolarStereographic, -90.0, 1.0, MOON)), None);
    assert_eq!(
        urn(Definition::about(Method::Sinusoidal, 0.0, 180.0, Ellipsoid::sphere(3_396_190.0))).unwrap(),
        "urn:ogc:def:crs:IAU:2015:49925"
    );
    assert_eq!(urn(Definition::about(Method::Sinusoidal, 0.0, 180.0, MARS)), None);
    let utm = codes::epsg(32_633).unwrap();
    let code = |text: &str| MapProjection::from_proj_string(&utm.proj_string(), None, Some(text.to_owned())).unwrap().urn();
    assert_eq!(code("EPSG:32633").unwrap(), "urn:ogc:def:crs:EPSG::32633");
    assert_eq!(code("EPSG:32634"), None, "a code of another map");
}

#[test]
fn proj_strings_with_unsupported_parameters_are_refused() {
    for (text, word) in [
        ("+proj=ob_tran +R=1000", "ob_tran"),
        ("+proj=sinu +R=1000 +units=km", "units"),
        ("+proj=sinu +R=abc", "R is not a number"),
        ("+proj=sinu", "+R or +a"),
        ("+proj=sinu +R=5 +R=6", "twice"),
        ("+proj=tmerc +R=5 +lat_ts=3", "lat_ts"),
        ("+R=5", "+proj"),
        ("+proj=stere +lat_0=90 +lat_ts=70 +k_0=0.9 +R=5", "both"),
    ] {
        let reason = MapProjection::from_proj_string(text, None, None).unwrap_err().to_string();
        assert!(reason.contains(word), "{text}: {reason}");
    }
}

#[test]
fn the_scale_agrees_with_textbook_formulas() {
    let east = nalgebra::Vector2::new(1.0, 0.0);
    let north = nalgebra::Vector2::new(0.0, 1.0);
    let map = |definition| MapProjection::new(definition, None).unwrap();
    let at = |map: &MapProjection, lon_deg, lat_deg| map.map_point(LonLat { lon_deg, lat_deg }).unwrap();
    let near = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-8, "{found:?} {expected}");
    // Stereographic, around a pole and around any point: 2 / (1 + cos c), c from the centre, in every direction.
    for (latitude_deg, lat_deg) in [(-90.0, -70.0), (35.0, 55.0)] {
        let stereographic = map(Definition::about(Method::ObliqueStereographic, latitude_deg, 10.0, MOON));
        let place = at(&stereographic, 10.0, lat_deg);
        for heading in [east, north, nalgebra::Vector2::new(0.6, -0.8)] {
            near(stereographic.scale(place, heading), 2.0 / (1.0 + 20.0_f64.to_radians().cos()));
        }
    }
    // Orthographic: cos c away from the centre, 1 across.
    let orthographic = map(Definition::about(Method::Orthographic, 0.0, 0.0, MOON));
    let place = at(&orthographic, 0.0, 30.0);
    near(orthographic.scale(place, north), 30.0_f64.to_radians().cos());
    near(orthographic.scale(place, east), 1.0);
    // Equirectangular: cos(parallel) / cos(latitude) along a parallel.
    let mut definition = Definition::about(Method::Equirectangular, 0.0, 0.0, MOON);
    definition.parallels_deg[0] = Some(40.0);
    let equirectangular = map(definition);
    let place = at(&equirectangular, 20.0, -60.0);
    near(equirectangular.scale(place, east), 2.0 * 40.0_f64.to_radians().cos());
    near(equirectangular.scale(place, north), 1.0);
    // A conformal map of an ellipsoid has its scale factor at the origin.
    let mars = map(Definition { scale: 0.9, ..Definition::about(Method::TransverseMercator, 20.0, 5.0, MARS) });
    near(mars.scale(at(&mars, 5.0, 20.0), nalgebra::Vector2::new(0.8, 0.6)), 0.9);
}

#[test]
fn the_largest_scale_error_of_a_transect_is_found() {
    let polar = MapProjection::new(Definition::about(Method::PolarStereographic, 90.0, 0.0, MOON), None).unwrap();
    let extreme = polar.extreme_scale(MapPoint::new(-1.0e5, 0.0), MapPoint::new(4.0e5, 0.0)).unwrap();
    assert_eq!((extreme.at, extreme.distance_m), (MapPoint::new(4.0e5, 0.0), 5.0e5));
    // k = 1 + (rho / 2R)^2.
    assert!((extreme.factor - 1.0 - (4.0e5_f64 / (2.0 * 1_737_400.0)).powi(2)).abs() < 1e-8, "{extreme:?}");
    assert!(extreme.is_off());
    assert!(!polar.extreme_scale(MapPoint::new(-1.0e5, 0.0), MapPoint::new(3.0e5, 0.0)).unwrap().is_off());
}
