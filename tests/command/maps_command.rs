//! Maps at the command line: positions as longitude and latitude, the scale of the map, reference systems read back by OGR.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]

use std::path::Path;

use chta::quantity::MapPoint;
use chta::terrain::{
    Definition, Dem, Ellipsoid, GeoReference, LonLat, MapProjection, Method, SyntheticTerrain, geotiff_bytes, read_dem, synthesise,
};

use crate::desk::{chta, shell};
use crate::installed::has_gdal;

const MOON: Ellipsoid = Ellipsoid::sphere(1_737_400.0);

/// Gentle ground on a map of this projection, with its middle at a position.
fn placed(folder: &Path, definition: Definition, middle: LonLat, spacing_m: f64) -> MapProjection {
    let projection = MapProjection::new(definition, None).unwrap();
    let ground = synthesise(&SyntheticTerrain { rows: 81, cols: 81, ..SyntheticTerrain::default() }).unwrap();
    let elevations = ground.elevations().map(Option::unwrap).collect();
    let half_m = 40.0 * spacing_m;
    let at = projection.map_point(middle).unwrap();
    let mut map = GeoReference::local(MapPoint::new(at.x - half_m, at.y + half_m), spacing_m, spacing_m).unwrap();
    map.coordinate_system = projection.coordinate_system();
    std::fs::write(folder.join("in.tif"), geotiff_bytes(&Dem::new(81, 81, elevations, map).unwrap()).unwrap()).unwrap();
    projection
}

/// Equirectangular with true scale at the equator, at latitude 40.
fn stretched(folder: &Path) -> MapProjection {
    placed(folder, Definition::about(Method::Equirectangular, 0.0, 0.0, MOON), LonLat { lon_deg: 30.0, lat_deg: 40.0 }, 20.0)
}

/// A local stereographic map: true to scale, without a code.
fn local(folder: &Path) -> MapProjection {
    let middle = LonLat { lon_deg: 77.25, lat_deg: 18.5 };
    placed(folder, Definition::about(Method::ObliqueStereographic, 18.5, 77.25, Ellipsoid::sphere(3_396_190.0)), middle, 1.0)
}

const HOPPER: &str = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 8\nlanding_speed_max_m_s = 8\n[surface]\n\
                      friction_coefficient = 0.7\n[search]\nnode_spacing_max_m = 5\n";

/// The rows of a chain, without comments.
fn rows(csv: &str) -> Vec<Vec<f64>> {
    let lines = csv.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(|field| field.parse().unwrap_or(0.0)).collect()).collect()
}

#[test]
fn longitude_and_latitude_are_the_same_slice_as_map_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let projection = local(folder.path());
    let degrees =
        |x, y| projection.lon_lat(MapPoint::new(x, y)).map(|place| format!("{:?},{:?}", place.lon_deg, place.lat_deg)).unwrap();
    let (from, to) = (degrees(-20.3, 11.7), degrees(31.25, -17.5));
    let (status, by_map, _) = chta(folder.path(), &["slice", "in.tif", "--from", "-20.3,11.7", "--to", "31.25,-17.5"]);
    assert_eq!(status, 0);
    let (status, by_degrees, text) = chta(folder.path(), &["slice", "in.tif", "--from-lonlat", &from, "--to-lonlat", &to]);
    assert_eq!((status, text.as_str()), (0, ""));
    // The corners of the map themselves are accepted, for any rounding of the last digit.
    let (from, to) = (degrees(-40.0, 40.0), degrees(40.0, -40.0));
    assert_eq!(chta(folder.path(), &["slice", "in.tif", "--from-lonlat", &from, "--to-lonlat", &to]).0, 0);
    let (by_map, by_degrees) = (rows(&by_map), rows(&by_degrees));
    assert_eq!(by_map.len(), by_degrees.len());
    for (a, b) in by_map.iter().flatten().zip(by_degrees.iter().flatten()) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn positions_without_a_projection_off_the_map_or_given_twice_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    local(folder.path());
    let refused = |arguments: &[&str], words: &[&str]| {
        let (status, _, text) = chta(folder.path(), arguments);
        assert_eq!(status, 2, "{arguments:?}: {text}");
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    };
    refused(&["slice", "in.tif", "--from-lonlat", "78,18.5", "--to", "0,0"], &["longitude 78", "off the map", "outermost posts"]);
    refused(&["slice", "in.tif", "--from-lonlat", "77.25,98", "--to", "0,0"], &["latitude (-90 to 90)"]);
    refused(&["slice", "in.tif", "--from-lonlat", "77.25,18.5", "--from", "0,0", "--to", "1,1"], &["cannot be used with"]);
    refused(&["slice", "in.tif", "--to", "1,1"], &["--from"]);
    std::fs::write(folder.path().join("local.asc"), "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n").unwrap();
    refused(&["slice", "local.asc", "--from-lonlat", "1,1", "--to", "1,1"], &["states no map projection", "gdal_translate -a_srs"]);
    let scenario = |terrain: &str| {
        std::fs::write(folder.path().join("s.toml"), format!("{HOPPER}[terrain]\ndem = \"in.tif\"\n{terrain}")).unwrap();
    };
    scenario("start_m = [0, 0]\nstart_lonlat_deg = [77.25, 18.5]\ngoal_m = [10, 0]\n");
    refused(&["check", "s.toml"], &["both start_m and start_lonlat_deg"]);
    scenario("start_m = [0, 0]\ngoal_lonlat_deg = [77.25, 118.5]\n");
    refused(&["check", "s.toml"], &["goal_lonlat_deg", "east positive"]);
    scenario("start_m = [0, 0]\n");
    refused(&["check", "s.toml"], &["goal_m = [x, y]", "goal_lonlat_deg"]);
}

#[test]
fn a_map_that_is_not_true_to_scale_is_refused_with_a_command_that_corrects_it() {
    let folder = tempfile::tempdir().unwrap();
    let projection = stretched(folder.path());
    let at = projection.map_point(LonLat { lon_deg: 30.0, lat_deg: 40.0 }).unwrap();
    let ends = [format!("{},{}", at.x - 700.0, at.y - 30.0), format!("{},{}", at.x + 700.0, at.y + 50.0)];
    let slice = ["slice", "in.tif", "--from", &ends[0], "--to", &ends[1]];
    let (status, _, text) = chta(folder.path(), &slice);
    assert_eq!(status, 2);
    // Eastward scale 1 / cos 40 = 1.3054.
    assert!(text.contains("scale along the transect is 1.30") && text.contains("--accept-map-scale"), "{text}");
    let (_, remedy) = text.split_once("mend it with: ").unwrap();
    let (remedy, _) = remedy.split_once("; or accept").unwrap();
    let (warp, again) = remedy.split_once(", then slice ").unwrap();
    assert!(warp.starts_with("gdalwarp ") && warp.contains(" in.tif out.tif"), "{warp}");
    let (status, stretched_chain, warned) = chta(folder.path(), &[&slice[..], &["--accept-map-scale"]].concat());
    assert!(status == 0 && warned.contains("accepted") && stretched_chain.contains("# warning: the map's scale"), "{warned}");
    if !has_gdal() {
        return;
    }
    shell(folder.path(), warp);
    let arguments: Vec<&str> = ["slice"].into_iter().chain(again.split_whitespace()).collect();
    let (status, chain, text) = chta(folder.path(), &arguments);
    assert_eq!((status, text.as_str()), (0, ""), "{arguments:?}");
    let length_m = |chain: &str| rows(chain).last().unwrap()[0];
    // On the ground, eastward components are shorter than on the stretched map by cos 40.
    let true_m = (1400.0 * 40.0_f64.to_radians().cos()).hypot(80.0);
    assert!(
        (length_m(&chain) - true_m).abs() < 1e-3 * true_m && (length_m(&stretched_chain) - 1400.0_f64.hypot(80.0)).abs() < 1e-6
    );
    assert!((rows(&chain)[0][1] - rows(&stretched_chain)[0][1]).abs() < 1.0);
}

/// The remedy for a hop map is a map around its start: the command in the message gives hops over true distances.
#[test]
fn a_hop_map_that_is_not_true_to_scale_is_refused_with_a_command_that_corrects_it() {
    let folder = tempfile::tempdir().unwrap();
    let projection = stretched(folder.path());
    std::fs::write(folder.path().join("hopper.toml"), HOPPER).unwrap();
    let at = projection.map_point(LonLat { lon_deg: 30.0, lat_deg: 40.0 }).unwrap();
    let start = format!("{},{}", at.x, at.y);
    let map = ["map", "in.tif", "--start", &start, "--scenario", "hopper.toml"];
    let (status, _, text) = chta(folder.path(), &map);
    assert_eq!(status, 2);
    assert!(
        text.contains("scale along the line from the start to a corner of the map is 1.") && !text.contains("transect"),
        "{text}"
    );
    let (_, remedy) = text.split_once("mend it with: ").unwrap();
    let (warp, again) = remedy.split_once(", then map ").unwrap();
    let (again, _) = again.split_once(" (a map about the start").unwrap();
    let (status, accepted, warned) = chta(folder.path(), &[&map[..], &["--accept-map-scale"]].concat());
    assert!(status == 0 && warned.matches("which was accepted").count() == 1, "{warned}");
    assert!(accepted.contains("of 103041 nodes"), "{accepted}");
    if !has_gdal() {
        return;
    }
    shell(folder.path(), warp);
    let arguments: Vec<&str> = ["map"].into_iter().chain(again.split_whitespace()).chain(["--scenario", "hopper.toml"]).collect();
    let (status, answer, text) = chta(folder.path(), &arguments);
    assert!(status == 0 && text.lines().all(|line| line.contains("nodes of the map")), "{text}");
    assert!(answer.starts_with(|first: char| first.is_ascii_digit()), "{answer}");
    // Square posts as fine as the finer spacing of the old ones on the ground: 20 m x cos 40 eastward.
    let dem = read_dem(&folder.path().join("out.tif")).unwrap();
    assert!((dem.georeference().dx_m() - 20.0 * 40.0_f64.to_radians().cos()).abs() < 0.01);
    assert!(
        (dem.georeference().dx_m() * (f64::from(u32::try_from(dem.cols()).unwrap()) - 1.0) - 1600.0 * 40.0_f64.to_radians().cos())
            .abs()
            < 40.0
    );
}

#[test]
fn an_accepted_scale_is_recorded_in_the_result_which_repeats_it() {
    let folder = tempfile::tempdir().unwrap();
    stretched(folder.path());
    let scenario =
        format!("{HOPPER}[terrain]\ndem = \"in.tif\"\nstart_lonlat_deg = [29.9990, 40.0]\ngoal_lonlat_deg = [30.0005, 40.0]\n");
    std::fs::write(folder.path().join("s.toml"), scenario).unwrap();
    let (status, _, text) = chta(folder.path(), &["run", "s.toml", "-o", "out"]);
    assert!(status == 2 && text.contains("gdalwarp"), "{text}");
    let (status, _, text) = chta(folder.path(), &["run", "s.toml", "-o", "out", "--accept-map-scale"]);
    assert!(status == 0, "{text}");
    let result: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("out/result.json")).unwrap()).unwrap();
    assert_eq!(result["scenario"]["terrain"]["accept_map_scale"], true);
    assert_eq!(result["scenario"]["terrain"]["start_lonlat_deg"], serde_json::json!([29.999, 40.0]));
    assert!(result["warnings"][0].as_str().unwrap().contains("which was accepted"));
    assert_eq!(result["crs"]["code"], "IAU_2015:30110");
    let first = &result["path"][0];
    assert!(
        (first["takeoff_lon_deg"].as_f64().unwrap() - 29.999).abs() < 1e-9
            && (first["takeoff_lat_deg"].as_f64().unwrap() - 40.0).abs() < 1e-9
    );
    let (status, _, text) = chta(folder.path(), &["run", "out/result.json", "-o", "again"]);
    assert!(status == 0, "{text}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("out/path.geojson"), read("again/path.geojson"));
    assert_eq!(read("out/result.json"), read("again/result.json"));
    assert!(
        read("out/path.csv")
            .lines()
            .next()
            .unwrap()
            .contains(",landing_lon_deg,landing_lat_deg,heading_true_deg,margin_takeoff_speed_m_s,")
    );
    assert!(read("out/chain.csv").contains("# crs_code: IAU_2015:30110"));
}

#[test]
fn a_slice_without_a_code_has_a_prj_file_and_opens_at_its_position() {
    let folder = tempfile::tempdir().unwrap();
    let projection = local(folder.path());
    let slice = ["slice", "in.tif", "--from", "-20,10", "--to", "30,-15", "-o", "chain.csv", "--geojson", "slice.geojson"];
    let (status, _, text) = chta(folder.path(), &slice);
    assert_eq!((status, text.as_str()), (0, ""));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("slice.prj").trim_end(), projection.wkt());
    assert!(read("chain.csv").contains(&format!("# crs_proj: {}", projection.proj_string())));
    let line: serde_json::Value = serde_json::from_str(&read("slice.geojson")).unwrap();
    let chain = rows(&read("chain.csv"));
    let coordinates = line["features"][0]["geometry"]["coordinates"].as_array().unwrap();
    assert_eq!(coordinates.len(), chain.len());
    assert!(coordinates.iter().zip(&chain).all(|(position, row)| position[2] == row[1]));
    // The chain keeps its map, so a plan over it has longitudes and latitudes.
    std::fs::write(folder.path().join("s.toml"), HOPPER.replace("moon", "mars")).unwrap();
    let (status, planned, text) = chta(
        folder.path(),
        &[
            "plan",
            "chain.csv",
            "--scenario",
            "s.toml",
            "--start",
            "0",
            "--goal",
            "20",
            "--geojson",
            "path.geojson",
            "--format",
            "json",
        ],
    );
    assert_eq!((status, text.as_str()), (0, ""));
    let planned: serde_json::Value = serde_json::from_str(&planned).unwrap();
    assert_eq!(
        (&planned["crs"]["code"], planned["crs"]["proj"].as_str().unwrap()),
        (&serde_json::Value::Null, projection.proj_string().as_str())
    );
    let start = projection.lon_lat(MapPoint::new(-20.0, 10.0)).unwrap();
    assert!((planned["path"][0]["takeoff_lon_deg"].as_f64().unwrap() - start.lon_deg).abs() < 1e-9);
    assert_eq!(read("path.prj"), read("slice.prj"));
    if has_gdal() {
        let text = shell(folder.path(), "ogrinfo -al -so slice.geojson");
        for word in [
            "3D Line String",
            "\"Stereographic\"",
            "18.5",
            "77.25",
            "3396190",
            "Extent: (-20.000000, -15.000000) - (30.000000, 10.000000)",
        ] {
            assert!(text.contains(word), "{word}: {text}");
        }
    }
}

#[test]
fn a_path_on_the_lola_dem_opens_near_shoemaker() {
    let dem = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem/lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif");
    if !dem.exists() {
        eprintln!("skipped: {} is absent", dem.display());
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let bounds = read_dem(&dem).unwrap().bounds();
    let (x, y) = (0.5 * (bounds.min.x + bounds.max.x), 0.5 * (bounds.min.y + bounds.max.y));
    let terrain = format!("[terrain]\ndem = \"{}\"\nstart_m = [{x}, {y}]\ngoal_m = [{}, {}]\n", dem.display(), x + 60.0, y + 25.0);
    std::fs::write(folder.path().join("s.toml"), format!("{HOPPER}{terrain}")).unwrap();
    let (status, _, text) = chta(folder.path(), &["run", "s.toml", "-o", "out"]);
    assert_eq!((status, text.as_str()), (0, ""));
    assert!(!folder.path().join("out/path.prj").exists());
    if !has_gdal() {
        return;
    }
    let text = shell(folder.path(), "ogrinfo -al out/path.geojson");
    assert!(text.contains("ID[\"IAU\",30135,2015]") && text.contains("LINESTRING Z"), "{text}");
    let number =
        |name: &str| text.lines().find_map(|line| line.trim().strip_prefix(name)?.split_once("= ")?.1.parse::<f64>().ok()).unwrap();
    let (lon_deg, lat_deg) = (number("takeoff_lon_deg (Real)"), number("takeoff_lat_deg (Real)"));
    assert!((lat_deg + 87.18).abs() < 0.005 && (lon_deg - 62.8).abs() < 0.05, "{lon_deg} {lat_deg}");
    // The same from the coordinates alone: GDAL reads the reference system and converts to degrees.
    shell(folder.path(), "ogr2ogr -t_srs '+proj=longlat +R=1737400 +no_defs' degrees.geojson out/path.geojson");
    let degrees: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("degrees.geojson")).unwrap()).unwrap();
    let start = &degrees["features"][0]["geometry"]["coordinates"][0];
    assert!((start[0].as_f64().unwrap() - lon_deg).abs() < 1e-6 && (start[1].as_f64().unwrap() - lat_deg).abs() < 1e-6, "{start}");
}
