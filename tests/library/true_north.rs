//! Headings from true north: closed forms of convergence, great circles, and GDAL's places of nearby points.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use chta::{
    quantity::MapPoint,
    terrain::{LonLat, MapProjection},
};
use nalgebra::Vector3;

use crate::{
    installed::has_gdal,
    map_projection::{centred_of_gdal, systems},
};

fn projection(text: &str) -> MapProjection {
    text.parse().unwrap()
}

/// The difference of two directions, degrees.
fn turn_deg(a: f64, b: f64) -> f64 {
    (a - b + 540.0).rem_euclid(360.0) - 180.0
}

/// Convergence in closed form: on a conformal map all directions turn by it.
#[test]
fn conformal_maps_turn_all_headings_by_the_convergence_of_the_books() {
    let place = |lon_deg, lat_deg| LonLat { lon_deg, lat_deg };
    let tm = |lon: f64, lat: f64| (lon.to_radians().tan() * lat.to_radians().sin()).atan().to_degrees();
    let moon = "+R=1737400 +units=m +no_defs";
    #[rustfmt::skip]
    let cases = [
        // A meridian of a north polar map runs towards the pole: lon - lon_0 from grid north; of a south polar one, the other way.
        (format!("+proj=stere +lat_0=90 +lon_0=-30 {moon}"), place(40.0, 85.0), 70.0),
        (format!("+proj=stere +lat_0=-90 +lon_0=0 {moon}"), place(62.8, -87.18), -62.8),
        (format!("+proj=stere +lat_0=-90 +lon_0=30 {moon}"), place(-170.0, -89.999), 200.0),
        ("+proj=stere +lat_0=90 +lat_ts=70 +lon_0=30 +a=3396190 +b=3376200 +units=m +no_defs".to_owned(), place(10.0, 80.0), -20.0),
        // Snyder (1987) p. 51: tan(convergence) = tan(lon) sin(lat) of the transverse Mercator map of a sphere.
        (format!("+proj=tmerc +lat_0=0 +lon_0=20 +k=0.9996 {moon}"), place(25.0, 60.0), tm(5.0, 60.0)),
        (format!("+proj=tmerc +lat_0=3 +lon_0=20 {moon}"), place(17.0, -35.0), tm(-3.0, -35.0)),
        // Lambert's cone: n (lon - lon_0), n = sin(lat_1) with one standard parallel.
        (format!("+proj=lcc +lat_1=30 +lat_0=30 +lon_0=10 {moon}"), place(16.0, 40.0), 3.0),
        (format!("+proj=merc +lon_0=20 {moon}"), place(16.0, 40.0), 0.0),
    ];
    for (text, at, convergence_deg) in cases {
        let map = projection(&text);
        let point = map.map_point(at).unwrap();
        for heading_deg in [0.0, 17.3, 90.0, 200.0, 359.0] {
            let found = map.true_heading_deg(point, heading_deg).unwrap();
            assert!((0.0..360.0 + 1e-9).contains(&found), "{text}: {found}");
            let off = turn_deg(found, heading_deg + convergence_deg);
            assert!(off.abs() < 1e-7, "{text} at {at}, {heading_deg} deg: {found}, off by {off:e} deg");
        }
    }
}

/// On a sphere the heading is the azimuth at which the great circle to a nearby point of the map leaves, on conformal maps and others.
#[test]
fn headings_on_a_sphere_are_azimuths_of_great_circles() {
    for (text, (x, y), _) in systems().into_iter().filter(|(text, ..)| text.contains("+R=")) {
        let map = projection(&text);
        let at = MapPoint::new(x, y);
        let from = map.lon_lat(at).unwrap();
        for heading_deg in [3.0, 100.0, 250.0_f64] {
            let azimuth = |length_m: f64| {
                let (sin, cos) = heading_deg.to_radians().sin_cos();
                let to = map.lon_lat(MapPoint::new(x + length_m * sin, y + length_m * cos)).unwrap();
                let (lon, lat, away_lon) = (to.lon_deg - from.lon_deg, to.lat_deg.to_radians(), from.lat_deg.to_radians());
                let lon = lon.to_radians();
                let east = lon.sin() * lat.cos();
                let north = away_lon.cos() * lat.sin() - away_lon.sin() * lat.cos() * lon.cos();
                east.atan2(north).to_degrees()
            };
            // The mean of both ways removes the bend of the map's line against the great circle.
            let back = azimuth(-50.0);
            let ahead = azimuth(50.0);
            let mean = ahead + 0.5 * turn_deg(back + 180.0, ahead);
            let found = map.true_heading_deg(at, heading_deg).unwrap();
            assert!(turn_deg(found, mean).abs() < 1e-5, "{text}: {found}, {mean}");
        }
    }
}

/// GDAL's Cartesian coordinates of points beside, seen in the plane that touches the ellipsoid.
#[test]
fn headings_on_every_map_agree_with_places_of_gdal() {
    if !has_gdal() {
        return;
    }
    for (srs, (x, y), _) in systems() {
        let map = projection(&srs);
        let (a, b) = (map.definition().ellipsoid.semi_major_m, map.definition().ellipsoid.semi_minor_m);
        let step_m = 300.0;
        for heading_deg in [0.0, 45.0, 133.0, 271.0_f64] {
            let (sin, cos) = heading_deg.to_radians().sin_cos();
            let beside = |steps: f64| MapPoint::new(x + steps * step_m * sin, y + steps * step_m * cos);
            let points = centred_of_gdal(&srs, &[beside(0.0), beside(-1.0), beside(1.0)]);
            let along = points[2] - points[1];
            let up = Vector3::new(points[0].x / (a * a), points[0].y / (a * a), points[0].z / (b * b)).normalize();
            let east = Vector3::z().cross(&up).normalize();
            let expected = along.dot(&east).atan2(along.dot(&up.cross(&east))).to_degrees();
            let found = map.true_heading_deg(MapPoint::new(x, y), heading_deg).unwrap();
            // GDAL's inverse of the equal-area map on an ellipsoid is a truncated series.
            let tolerance = if srs.contains("+proj=laea") && !srs.contains("+R=") { 1e-4 } else { 3e-6 };
            assert!(turn_deg(found, expected).abs() < tolerance, "{srs}, {heading_deg}: {found}, GDAL {expected}");
        }
    }
}

#[test]
fn at_a_pole_and_off_the_body_there_is_no_true_heading() {
    let south = projection("+proj=stere +lat_0=-90 +lon_0=0 +x_0=500 +y_0=900 +R=1737400 +units=m +no_defs");
    assert_eq!(south.true_heading_deg(MapPoint::new(500.0, 900.0), 30.0), None);
    // A millimetre away north is known again: north-east of the pole on the map is the meridian of 45 degrees.
    for away_m in [1e-3, 1.0, 1e3] {
        let heading = south.true_heading_deg(MapPoint::new(500.0 + away_m, 900.0 + away_m), 45.0).unwrap();
        assert!(turn_deg(heading, 0.0).abs() < 1e-4, "{away_m} m: {heading}");
    }
    let level = projection("+proj=eqc +lon_0=0 +R=1737400 +units=m +no_defs");
    let pole_y_m = std::f64::consts::FRAC_PI_2 * 1_737_400.0;
    assert_eq!(level.true_heading_deg(MapPoint::new(0.0, pole_y_m), 30.0), None);
    let disc = projection("+proj=ortho +lat_0=0 +lon_0=0 +R=1737400 +units=m +no_defs");
    assert_eq!(disc.true_heading_deg(MapPoint::new(2.0e6, 0.0), 30.0), None);
}

/// Where a map is cut, at the meridian opposite its middle, the heading is that of both sides.
#[test]
fn beside_the_cut_of_a_map_the_heading_stays() {
    for text in ["+proj=sinu +lon_0=20 +R=1737400 +units=m +no_defs", "+proj=eqc +lon_0=20 +R=1737400 +units=m +no_defs"] {
        let map = projection(text);
        let heading = |east_deg: f64| {
            let at = map.map_point(LonLat { lon_deg: 20.0 + east_deg, lat_deg: 30.0 }).unwrap();
            map.true_heading_deg(at, 40.0).unwrap()
        };
        let [near, nearer] = [179.0, 179.999].map(heading);
        assert!(turn_deg(near, nearer).abs() < 0.6, "{text}: {near}, {nearer}");
        assert!(turn_deg(heading(179.99), nearer).abs() < 0.01, "{text}");
    }
}
