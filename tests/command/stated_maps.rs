//! What a file states of its map, its units and its body: refused where it is not known or contradicted, with commands that are run here
//! and whose results are compared with the truth.
#![expect(clippy::unwrap_used, reason = "a test may panic, and says why it skips")]

use std::path::Path;

use chta::quantity::MapPoint;
use chta::terrain::{CoordinateSystem, Dem, GeoReference, MapProjection, geotiff_bytes, read_dem};

use crate::desk::{chta, raster, shell};
use crate::installed::has_gdal;

const MOON_M: f64 = 1_737_400.0;

/// The command of a message, up to one of the words that end it.
fn remedy<'a>(message: &'a str, ends: &[&str]) -> &'a str {
    let (_, rest) = message.split_once("mend it with: ").unwrap_or_else(|| panic!("{message}"));
    ends.iter().filter_map(|end| rest.find(end)).min().map_or(rest, |end| &rest[..end]).trim()
}

/// A plane that rises by a tenth of a metre for every metre (or unit) eastward, 41 by 41 posts.
fn plane(folder: &Path, north_west: MapPoint, step: f64, rise_per_post: f64, system: CoordinateSystem) {
    let mut map = GeoReference::local(north_west, step, step).unwrap();
    map.coordinate_system = system;
    let posts: Vec<f64> = (0..41 * 41_u32).map(|post| 100.0 + rise_per_post * f64::from(post % 41)).collect();
    std::fs::write(folder.join("in.tif"), geotiff_bytes(&Dem::new(41, 41, posts, map).unwrap()).unwrap()).unwrap();
}

fn keys(numbers: &[(u16, u16)], citation: &str) -> CoordinateSystem {
    let mut entries: Vec<[u16; 4]> = numbers.iter().map(|(key, value)| [*key, 0, 1, *value]).collect();
    if !citation.is_empty() {
        entries.push([1026, 34737, u16::try_from(citation.len() + 1).unwrap(), 0]);
    }
    entries.sort_unstable();
    let mut key_directory = vec![1, 1, 0, u16::try_from(entries.len()).unwrap()];
    key_directory.extend(entries.into_iter().flatten());
    CoordinateSystem { key_directory, ascii_parameters: format!("{citation}|"), ..CoordinateSystem::default() }
}

/// First and last row of a chain: x and z, m.
fn ends(csv: &str) -> [[f64; 2]; 2] {
    let rows: Vec<[f64; 2]> = csv
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            let mut fields = line.split(',').map(|field| field.parse().unwrap());
            [fields.next().unwrap(), fields.next().unwrap()]
        })
        .collect();
    [rows[0], *rows.last().unwrap()]
}

const HOPPER: &str = "[hopper]\ntakeoff_speed_max_m_s = 8\nlanding_speed_max_m_s = 8\n[surface]\nfriction_coefficient = 0.7\n[search]\n\
                      node_spacing_max_m = 5\n";

fn scenario(folder: &Path, body: &str, more: &str) {
    std::fs::write(folder.join("s.toml"), format!("[body]\n{body}\n{HOPPER}{more}")).unwrap();
}

/// Each row: keys and citation that mean feet, and the size of one. The command in the message gives the elevations in metres.
#[test]
fn elevations_in_feet_are_refused_with_a_command_that_converts_them() {
    let us = 12.0 / 39.37;
    let convert = has_gdal();
    for (numbers, citation, foot_m) in [
        (&[(1024, 1), (3072, 32614), (4096, 6360)][..], "", us),
        (&[(1024, 1), (3072, 32614), (4096, 8228)], "site grid", 0.3048),
        (&[(1024, 1), (3072, 32614), (4096, 6360)], "WGS 84 / UTM zone 14N + NAVD88 height (ftUS)", us),
        (&[(1024, 1), (3072, 32614), (3076, 9001), (4099, 9002)], "", 0.3048),
        (&[(1024, 1), (3072, 32614)], "WGS 84 / UTM zone 14N + NAVD88 height (ftUS)", us),
        (&[(1024, 1), (3074, 16014), (2056, 7030), (3076, 9001), (4099, 9003)], "", us),
    ] {
        let folder = tempfile::tempdir().unwrap();
        plane(folder.path(), MapPoint::new(500_000.0, 3_500_000.0), 10.0, 1.0, keys(numbers, citation));
        let slice = |file: &str| chta(folder.path(), &["slice", file, "--from", "500010,3499800", "--to", "500390,3499800"]);
        let (status, _, message) = slice("in.tif");
        assert!(status == 2 && message.contains("elevations in ") && message.contains("feet"), "{numbers:?} {citation}: {message}");
        if !convert {
            continue;
        }
        shell(folder.path(), remedy(&message, &["\n"]));
        let (status, chain, message) = slice("out.tif");
        assert_eq!((status, message.as_str()), (0, ""), "{numbers:?} {citation}");
        let [first, last] = ends(&chain);
        assert!((first[1] - 101.0 * foot_m).abs() < 1e-4 && (last[1] - 139.0 * foot_m).abs() < 1e-4, "{first:?} {last:?}");
        assert!((last[0] - 380.0).abs() < 1e-9);
    }
}

/// Maps whose coordinates are in other units: the command in the message gives metres, so that a slope of 0.1 is one of 0.1.
#[test]
fn map_coordinates_in_other_units_are_refused_with_a_command_that_converts_them() {
    if !has_gdal() {
        return;
    }
    for (srs, unit_m, word, (x, y)) in [
        ("EPSG:2278", 12.0 / 39.37, "US survey feet", (2_000_000.0, 13_200_000.0)),
        ("+proj=stere +lat_0=-85 +lon_0=10 +R=1737400 +units=km", 1000.0, "kilometres", (1.0, 2.0)),
        ("+proj=utm +zone=33 +datum=WGS84 +units=ft", 0.3048, "feet", (1_640_419.0, 13_123_359.0)),
    ] {
        let folder = tempfile::tempdir().unwrap();
        // 30 m between posts.
        let step = 30.0 / unit_m;
        plane(folder.path(), MapPoint::new(x, y), step, 3.0, CoordinateSystem::default());
        shell(folder.path(), &format!("mv in.tif plain.tif && gdal_translate -q -a_srs '{srs}' plain.tif in.tif"));
        let at = format!("{},{}", x + step, y - step);
        let (status, _, message) = chta(folder.path(), &["slice", "in.tif", "--from", &at, "--to", "0,0"]);
        assert!(status == 2 && message.contains(&format!("map coordinates in {word}")), "{srs}: {message}");
        shell(folder.path(), remedy(&message, &["\n"]));
        let dem = read_dem(&folder.path().join("out.tif")).unwrap();
        let row = |x_m: f64| format!("{x_m},{}", (y - 20.0 * step) * unit_m);
        let (status, chain, message) = chta(
            folder.path(),
            &["slice", "out.tif", "--from", &row((x + 5.0 * step) * unit_m), "--to", &row((x + 35.0 * step) * unit_m)],
        );
        assert_eq!((status, message.as_str()), (0, ""), "{srs} {:?}", dem.bounds());
        let [first, last] = ends(&chain);
        assert!(((last[1] - first[1]) / (last[0] - first[0]) - 0.1).abs() < 1e-3, "{srs}: {first:?} {last:?}");
    }
}

/// Methods and codes that are stated and not supported: refused by every command, with a command that makes a map true to scale, and
/// taken by every command if the user accepts the scale.
#[test]
fn a_projection_that_is_not_supported_is_refused_by_every_command_unless_accepted() {
    if !has_gdal() {
        return;
    }
    let body = |srs: &str| if srs.contains("1737400") { ("name = \"moon\"", MOON_M) } else { ("name = \"earth\"", 6_371_008.4) };
    for (srs, lon_deg, lat_deg) in [
        ("+proj=robin +R=1737400", 30.0, 40.0),
        ("+proj=eqdc +lat_1=20 +lat_2=40 +R=1737400", 30.0, 60.0),
        ("+proj=cea +lat_ts=30 +R=1737400", 30.0, 40.0),
        ("+proj=poly +lat_0=10 +R=1737400", 30.0, 40.0),
        ("+proj=mill +R=1737400", 30.0, 40.0),
        ("+proj=vandg +R=1737400", 30.0, 40.0),
        ("+proj=omerc +lat_0=10 +lonc=20 +alpha=30 +R=1737400", 30.0, 20.0),
        ("EPSG:27700", -2.0, 52.0),
        ("EPSG:4087", 10.0, 50.0),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (body, radius_m) = body(srs);
        let degrees = if srs.contains("1737400") { "+proj=longlat +R=1737400" } else { "+proj=longlat +datum=WGS84" };
        let proj = shell(folder.path(), &format!("gdalsrsinfo -o proj4 '{srs}'"));
        let text =
            shell(folder.path(), &format!("echo {lon_deg} {lat_deg} | gdaltransform -s_srs '{degrees}' -t_srs '{}'", proj.trim()));
        let at: Vec<f64> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
        plane(folder.path(), MapPoint::new(at[0] - 400.0, at[1] + 400.0), 20.0, 2.0, CoordinateSystem::default());
        shell(folder.path(), &format!("mv in.tif plain.tif && gdal_translate -q -a_srs '{srs}' plain.tif in.tif"));
        let point = |dx: f64| format!("{},{}", at[0] + dx, at[1]);
        let (from, to) = (point(-30.0), point(50.0));
        let terrain = format!("[terrain]\ndem = \"in.tif\"\nstart_m = [{from}]\ngoal_m = [{to}]\n");
        scenario(folder.path(), body, &terrain);
        std::fs::write(folder.path().join("bare.toml"), format!("[body]\n{body}\n{HOPPER}")).unwrap();
        let commands: [&[&str]; 6] = [
            &["slice", "in.tif", "--from", &from, "--to", &to],
            &["check", "s.toml"],
            &["plan", "s.toml"],
            &["run", "s.toml", "-o", "out"],
            &["map", "in.tif", "--start", &from, "--scenario", "bare.toml"],
            &["fan", "in.tif", "--from", &from, "--headings", "4", "--length", "60", "--scenario", "bare.toml"],
        ];
        let mut message = String::new();
        for command in commands {
            let (status, answer, refusal) = chta(folder.path(), command);
            assert!(status == 2 && answer.is_empty() && refusal.contains("not supported"), "{srs} {command:?}: {refusal}");
            assert!(refusal.contains("--accept-map-scale") && refusal.contains("in.tif"), "{srs} {command:?}: {refusal}");
            let (status, _, warned) = chta(folder.path(), &[command, &["--accept-map-scale"]].concat());
            assert!(status < 2 && warned.contains("scale was not checked"), "{srs} {command:?}: {warned}");
            message = refusal;
        }
        // Two places a thousandth of a degree of latitude apart.
        let warp = remedy(&message, &[", where LATITUDE"]);
        let warp = warp.replace("LATITUDE", &lat_deg.to_string()).replace("LONGITUDE", &lon_deg.to_string());
        shell(folder.path(), &warp);
        let places = [format!("{lon_deg},{}", lat_deg - 0.001), format!("{lon_deg},{}", lat_deg + 0.001)];
        let planetocentric = chta(folder.path(), &["slice", "out.tif", "--from-lonlat", &places[0], "--to-lonlat", &places[1]]);
        // Latitudes of the Earth are planetocentric here: 0.19 degrees aside, off this small map.
        if radius_m == MOON_M {
            assert_eq!(planetocentric.0, 0, "{srs}: {}", planetocentric.2);
            let length_m = ends(&planetocentric.1)[1][0];
            assert!((length_m / (0.002_f64.to_radians() * radius_m) - 1.0).abs() < 1e-3, "{srs}: {length_m}");
        } else {
            let (status, chain, refusal) = chta(folder.path(), &["slice", "out.tif", "--from", "-50,0", "--to", "50,0"]);
            assert_eq!((status, refusal.as_str()), (0, ""), "{srs}");
            assert!((ends(&chain)[1][0] - 100.0).abs() < 1e-9);
        }
    }
}

/// Each row: the scenario's body, the map, and whether both may be one body.
#[test]
fn a_map_of_another_body_than_the_scenarios_is_refused_by_every_command() {
    let moon = "IAU_2015:30135";
    for (body, map, same) in [
        ("name = \"moon\"", "EPSG:32614", false),
        ("name = \"moon\"", "+proj=stere +lat_0=20 +lon_0=10 +a=6378137 +b=6356752.3", false),
        ("name = \"moon\"", "IAU_2015:49935", false),
        ("name = \"moon\"", moon, true),
        ("name = \"moon\"", "+proj=stere +lat_0=-90 +R=1738000", true),
        ("name = \"mars\"", moon, false),
        ("name = \"mars\"", "IAU_2015:49935", true),
        ("name = \"earth\"", "EPSG:32614", true),
        ("name = \"earth\"", moon, false),
        ("name = \"phobos\"", "+proj=stere +lat_0=0 +R=13000", true),
        ("gravity_m_s2 = 1.62", "EPSG:32614", true),
        ("gravity_m_s2 = 1.62\nradius_m = 1737400.0", "EPSG:32614", false),
        ("gravity_m_s2 = 1.62\nradius_m = 1737400.0", moon, true),
        ("name = \"moon\"", "", true),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let system =
            if map.is_empty() { CoordinateSystem::default() } else { map.parse::<MapProjection>().unwrap().coordinate_system() };
        let middle = if map.starts_with("EPSG:32") { MapPoint::new(500_000.0, 3_500_000.0) } else { MapPoint::new(1000.0, 2000.0) };
        plane(folder.path(), middle, 2.0, 0.2, system);
        let point = |dx: f64| format!("{},{}", middle.x + dx, middle.y - 40.0);
        let (from, to) = (point(10.0), point(50.0));
        scenario(folder.path(), body, &format!("[terrain]\ndem = \"in.tif\"\nstart_m = [{from}]\ngoal_m = [{to}]\n"));
        std::fs::write(folder.path().join("bare.toml"), format!("[body]\n{body}\n{HOPPER}")).unwrap();
        let commands: [&[&str]; 6] = [
            &["slice", "in.tif", "--from", &from, "--to", &to, "--scenario", "bare.toml"],
            &["check", "s.toml"],
            &["run", "s.toml", "-o", "out"],
            &["map", "in.tif", "--start", &from, "--scenario", "bare.toml"],
            &["fan", "in.tif", "--from", &from, "--headings", "4", "--length", "20", "--scenario", "bare.toml"],
            // A chain keeps its map.
            &["check", "chain.csv", "--scenario", "bare.toml", "--start", "0", "--goal", "40"],
        ];
        assert_eq!(chta(folder.path(), &["slice", "in.tif", "--from", &from, "--to", &to, "-o", "chain.csv"]).0, 0);
        for command in commands {
            let (status, _, message) = chta(folder.path(), command);
            if same {
                assert!(status < 2, "{body} {map} {command:?}: {message}");
            } else {
                let words = ["is of a body with", "expected one body", "body.gravity_m_s2"];
                assert!(status == 2 && words.iter().all(|word| message.contains(word)), "{body} {map} {command:?}: {message}");
            }
        }
    }
}

/// Maps in degrees of the Moon under several labels. The command in the message gives true lengths: 0.0015 degrees of longitude at
/// latitude 20 are 42.7 m there.
#[test]
fn a_map_in_degrees_is_mended_with_the_radius_of_the_scenarios_body() {
    let true_m = 0.0015_f64.to_radians() * MOON_M * 20_f64.to_radians().cos();
    for (label, west_deg, body) in [
        ("EPSG:4326", 9.99, "name = \"moon\""),
        ("EPSG:4326", 9.99, "gravity_m_s2 = 1.62\nradius_m = 1737400.0"),
        ("+proj=longlat +R=1737400", 9.99, "name = \"moon\""),
        ("+proj=longlat +R=1737400", 199.99, "name = \"moon\""),
        ("EPSG:4326", 359.99, "name = \"moon\""),
        ("", 9.99, "name = \"moon\""),
        ("", 199.99, "gravity_m_s2 = 1.62"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        plane(folder.path(), MapPoint::new(west_deg, 20.01), 0.0005, 1.0, CoordinateSystem::default());
        let middle_deg = west_deg + 0.01;
        let [from, to] = [middle_deg - 0.00075, middle_deg + 0.00075].map(|lon_deg| format!("{},20", lon_deg % 360.0));
        let terrain = |dem: &str| format!("[terrain]\ndem = \"{dem}\"\nstart_lonlat_deg = [{from}]\ngoal_lonlat_deg = [{to}]\n");
        if !label.is_empty() {
            if !has_gdal() {
                return;
            }
            shell(folder.path(), &format!("mv in.tif plain.tif && gdal_translate -q -a_srs '{label}' plain.tif in.tif"));
        }
        scenario(folder.path(), body, &terrain("in.tif"));
        std::fs::write(folder.path().join("bare.toml"), format!("[body]\n{body}\n{HOPPER}")).unwrap();
        let commands: [&[&str]; 4] = [
            &["check", "s.toml"],
            &["map", "in.tif", "--start-lonlat", &from, "--scenario", "bare.toml"],
            &["fan", "in.tif", "--from-lonlat", &from, "--headings", "4", "--length", "20", "--scenario", "bare.toml"],
            &["slice", "in.tif", "--from-lonlat", &from, "--to-lonlat", &to, "--scenario", "bare.toml"],
        ];
        let radius = if body.contains("gravity") && !body.contains("radius") { "+R=RADIUS_M" } else { "+R=1737400" };
        let mut warp = String::new();
        for command in commands {
            let (status, _, message) = chta(folder.path(), command);
            assert!(status == 2 && message.contains("degrees") && message.contains(radius), "{label} {command:?}: {message}");
            assert!(!message.contains("+a=6378137"), "{label} {command:?}: {message}");
            warp = remedy(&message, &[", where LATITUDE"]).replace("LATITUDE", "20").replace("LONGITUDE", &middle_deg.to_string());
        }
        if !has_gdal() {
            continue;
        }
        shell(folder.path(), &warp.replace("RADIUS_M", "1737400"));
        scenario(folder.path(), body, &terrain("out.tif"));
        let (status, chain, message) = chta(folder.path(), &["slice", "out.tif", "--from-lonlat", &from, "--to-lonlat", &to]);
        assert_eq!((status, message.as_str()), (0, ""), "{label} {west_deg}");
        let [first, last] = ends(&chain);
        assert!((last[0] / true_m - 1.0).abs() < 1e-4, "{label} {west_deg}: {last:?}");
        // 3 posts further east, 1 m each.
        assert!((last[1] - first[1] - 3.0).abs() < 0.1, "{label} {west_deg}: {first:?} {last:?}");
        assert!(chta(folder.path(), &["check", "s.toml"]).0 < 2);
    }
}

/// Zones in degrees, with the Moon's and with the Earth's name for them: the command in the message brings them where they belong.
#[test]
fn zones_in_degrees_are_brought_onto_the_map_by_the_command_of_the_message() {
    let folder = tempfile::tempdir().unwrap();
    let map: MapProjection = "IAU_2015:30135".parse().unwrap();
    plane(folder.path(), MapPoint::new(75_000.0, 40_000.0), 2.0, 0.1, map.coordinate_system());
    let corners = [(20.0, -20.0), (30.0, -20.0), (30.0, -60.0), (20.0, -60.0), (20.0, -20.0)];
    let corners = corners.map(|(x, y)| MapPoint::new(75_000.0 + x, 40_000.0 + y));
    let zones = |crs: &str, degrees: bool| {
        let positions = corners.map(|at| match map.lon_lat(at).filter(|_| degrees) {
            Some(place) => format!("[{:?},{:?}]", place.lon_deg, place.lat_deg),
            None => format!("[{:?},{:?}]", at.x, at.y),
        });
        let crs =
            if crs.is_empty() { String::new() } else { format!(r#""crs":{{"type":"name","properties":{{"name":"{crs}"}}}},"#) };
        format!(
            r#"{{"type":"FeatureCollection",{crs}"features":[{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[[{}]]}}}}]}}"#,
            positions.join(",")
        )
    };
    let check = |file: &str| {
        let terrain = "[terrain]\ndem = \"in.tif\"\nstart_m = [75010, 39960]\ngoal_m = [75060, 39960]\n";
        let keep_out = HOPPER.replace("friction_coefficient", &format!("keep_out = \"{file}\"\nfriction_coefficient"));
        std::fs::write(folder.path().join("s.toml"), format!("[body]\nname = \"moon\"\n{keep_out}{terrain}")).unwrap();
        chta(folder.path(), &["check", "s.toml", "--format", "json"])
    };
    let pairs = |answer: &str| serde_json::from_str::<serde_json::Value>(answer).unwrap()["pairs_tested"].clone();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("metres.geojson", &zones("urn:ogc:def:crs:IAU:2015:30135", false));
    let (status, expected, message) = check("metres.geojson");
    assert_eq!((status, message.as_str()), (0, ""));
    for crs in ["urn:ogc:def:crs:IAU:2015:30100", "urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", ""] {
        write("in.geojson", &zones(crs, true));
        let (status, _, message) = check("in.geojson");
        assert!(status == 2 && message.contains("degrees") && message.contains("ogr2ogr"), "{crs}: {message}");
        if !has_gdal() {
            continue;
        }
        let (_, command) = message.split_once("map with: ").unwrap();
        let _ = std::fs::remove_file(folder.path().join("out.geojson"));
        shell(folder.path(), command.trim());
        let (status, found, message) = check("out.geojson");
        assert_eq!((status, message.as_str()), (0, ""), "{crs}");
        assert_eq!(pairs(&found), pairs(&expected), "{crs}");
    }
    // A system that cannot be compared is said to be so, and the answer stands.
    plane(folder.path(), MapPoint::new(75_000.0, 40_000.0), 2.0, 0.1, CoordinateSystem::default());
    let (status, _, message) = check("metres.geojson");
    assert!(status == 0 && message.contains("IAU_2015:30135") && message.contains("was not checked"), "{message}");
}

/// GDAL shows the same reference system for the rasters of a map as for its DEM, but for a code of the IAU in the name.
#[test]
fn the_rasters_of_a_map_show_the_reference_system_of_their_dem() {
    if !has_gdal() {
        return;
    }
    for (code, body, start) in [
        ("EPSG:32633", "earth", "500020,40"),
        ("EPSG:25832", "earth", "500020,40"),
        ("EPSG:32756", "earth", "500020,40"),
        ("EPSG:32633+5773", "earth", "500020,40"),
        ("IAU_2015:30135", "moon", "20,40"),
        ("IAU_2015:49930", "mars", "20,40"),
        ("IAU_2015:30110", "moon", "20,40"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (x, y) =
            start.split_once(',').map(|(x, y)| (x.parse::<f64>().unwrap() - 20.0, y.parse::<f64>().unwrap() + 20.0)).unwrap();
        plane(folder.path(), MapPoint::new(x, y), 2.0, 0.1, CoordinateSystem::default());
        shell(folder.path(), &format!("gdal_translate -q -a_srs {code} in.tif dem.tif"));
        scenario(folder.path(), &format!("name = \"{body}\""), "");
        let outputs = ["-o", "hops.tif", "--mobility", "mobility.tif"];
        let map = [&["map", "dem.tif", "--start", start, "--scenario", "s.toml"][..], &outputs].concat();
        let (status, _, message) = chta(folder.path(), &map);
        assert_eq!(status, 0, "{code}: {message}");
        let system = |name: &str| {
            let text = shell(folder.path(), &format!("gdalinfo {name}"));
            text.split("Coordinate System is:").nth(1).unwrap().split("Data axis").next().unwrap().to_owned()
        };
        let of_dem = system("dem.tif");
        for name in ["hops.tif", "mobility.tif"] {
            assert_eq!(system(name).replace(&format!(" ({code})"), ""), of_dem, "{code}: {name}");
            let number = code.split([':', '+']).nth(1).unwrap();
            assert!(system(name).contains(number), "{code}: {name} does not show it: {}", system(name));
        }
    }
}

/// The rasters of a map with a code of the IAU show it in GDAL, and are read back as the same map.
#[test]
fn the_rasters_of_a_map_name_the_code_of_the_iau() {
    let folder = tempfile::tempdir().unwrap();
    let mut system = "IAU_2015:30135".parse::<MapProjection>().unwrap().coordinate_system();
    // As GDAL writes it: a citation that says nothing.
    system.ascii_parameters = "unknown|".to_owned();
    for entry in system.key_directory.chunks_exact_mut(4).skip(1).filter(|entry| entry[0] == 1026) {
        entry[2] = 8;
    }
    plane(folder.path(), MapPoint::new(75_000.0, 40_000.0), 2.0, 0.1, system);
    scenario(folder.path(), "name = \"moon\"", "");
    let (status, _, message) =
        chta(folder.path(), &["map", "in.tif", "--start", "75010,39960", "--scenario", "s.toml", "-o", "hops.tif"]);
    assert_eq!((status, message.as_str()), (0, ""));
    let hops = raster(&folder.path().join("hops.tif"));
    let projection = hops.georeference().projection().unwrap();
    assert_eq!((projection.code(), projection.name()), (Some("IAU_2015:30135"), "IAU_2015:30135"));
    if has_gdal() {
        let text = shell(folder.path(), "gdalinfo hops.tif");
        assert!(text.contains("PROJCRS[\"IAU_2015:30135\""), "{text}");
    }
}
