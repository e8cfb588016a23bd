//! Projections against GDAL: its files are read, its coordinates reproduced.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use chta::quantity::MapPoint;
use chta::terrain::{LonLat, MapProjection, read_dem};

use nalgebra::Vector3;

use crate::installed::has_gdal;

fn run(program: &str, arguments: &[&str], input: &str) -> String {
    let mut child =
        Command::new(program).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{program} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Longitude and planetocentric latitude of map points from GDAL, via Cartesian coordinates, which are free of the definition of
/// latitude.
fn places_of_gdal(srs: &str, points: &[MapPoint]) -> Vec<LonLat> {
    centred_of_gdal(srs, points)
        .into_iter()
        .map(|at| LonLat { lon_deg: at.y.atan2(at.x).to_degrees(), lat_deg: at.z.atan2(at.x.hypot(at.y)).to_degrees() })
        .collect()
}

/// Cartesian coordinates of map points from GDAL, m from the body's centre.
pub(crate) fn centred_of_gdal(srs: &str, points: &[MapPoint]) -> Vec<Vector3<f64>> {
    let lines = points.iter().map(|point| format!("{} {} 0\n", point.x, point.y)).collect::<Vec<_>>().concat();
    let centred = format!("+proj=geocent {} +no_defs", figure_of(srs));
    let text = run("gdaltransform", &["-s_srs", srs, "-t_srs", &centred], &lines);
    let places: Vec<_> =
        text.lines().map(|line| Vector3::from_iterator(line.split_whitespace().map(|word| word.parse::<f64>().unwrap()))).collect();
    assert_eq!(places.len(), points.len());
    places
}

/// Map points of positions from GDAL, with planetocentric latitudes, via Cartesian coordinates on the reference surface.
fn points_of_gdal(srs: &str, places: &[LonLat]) -> Vec<MapPoint> {
    let figure = figure_of(srs);
    let radius = |keys: &[&str]| {
        keys.iter().find_map(|key| Some(figure.split(' ').find_map(|word| word.strip_prefix(key))?.parse::<f64>().unwrap()))
    };
    let (a, b) = match (figure.as_str(), radius(&["+R=", "+a="])) {
        ("+ellps=WGS84", _) => (6_378_137.0, 6_378_137.0 * (1.0 - 1.0 / 298.257_223_563)),
        ("+ellps=GRS80", _) => (6_378_137.0, 6_378_137.0 * (1.0 - 1.0 / 298.257_222_101)),
        (_, Some(a)) => (a, radius(&["+b="]).unwrap_or_else(|| a * (1.0 - radius(&["+rf="]).map_or(0.0, |inverse| 1.0 / inverse)))),
        _ => panic!("{srs}"),
    };
    let line = |place: &LonLat| {
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (place.lat_deg.to_radians().sin_cos(), place.lon_deg.to_radians().sin_cos());
        let distance_m = a * b / (b * cos_lat).hypot(a * sin_lat);
        format!("{:?} {:?} {:?}\n", distance_m * cos_lat * cos_lon, distance_m * cos_lat * sin_lon, distance_m * sin_lat)
    };
    let lines = places.iter().map(line).collect::<Vec<_>>().concat();
    let text = run("gdaltransform", &["-s_srs", &format!("+proj=geocent {figure} +no_defs"), "-t_srs", srs], &lines);
    let number = |word: &str| word.parse::<f64>().unwrap();
    text.lines().map(|line| line.split(' ').map(number).collect::<Vec<_>>()).map(|xyz| MapPoint::new(xyz[0], xyz[1])).collect()
}

fn figure_of(srs: &str) -> String {
    let keys = ["+R=", "+a=", "+b=", "+rf=", "+ellps="];
    srs.split_whitespace().filter(|word| keys.iter().any(|key| word.starts_with(key))).collect::<Vec<_>>().join(" ")
}

/// Both directions, on a grid of points, to 1e-9 degrees and 1e-6 m.
///
/// GDAL's inverse of the equal-area map on an ellipsoid is a truncated series, 1e-7 degrees off its own forward projection on Mars:
/// for that map only the forward projection is compared.
fn agree(name: &str, projection: &MapProjection, srs: &str, (x, y): (f64, f64), reach_m: f64) {
    let grid = [-1.0, -0.62, -0.1, 0.35, 1.0].map(|step| step * reach_m);
    let points: Vec<MapPoint> = grid.iter().flat_map(|dx| grid.map(|dy| MapPoint::new(x + dx, y + dy))).collect();
    let rough = srs.contains("+proj=laea") && !srs.contains("+R=");
    let ours: Vec<LonLat> = points.iter().map(|point| projection.lon_lat(*point).unwrap()).collect();
    for ((point, ours), theirs) in points.iter().zip(&ours).zip(places_of_gdal(srs, &points)) {
        let turn_deg = (ours.lon_deg - theirs.lon_deg + 540.0).rem_euclid(360.0) - 180.0;
        let off_deg = (turn_deg * theirs.lat_deg.to_radians().cos()).hypot(ours.lat_deg - theirs.lat_deg);
        assert!(off_deg < if rough { 1e-6 } else { 1e-9 }, "{name} at {point}: {ours}, GDAL {theirs}, off by {off_deg:e} degrees");
    }
    for ((point, ours), theirs) in points.iter().zip(&ours).zip(points_of_gdal(srs, &ours)) {
        let own = projection.map_point(*ours).unwrap();
        assert!((own - point).norm() < 1e-6, "{name} at {point}: back at {own}");
        assert!(
            (theirs - point).norm() < 1e-6,
            "{name} at {point}: GDAL puts {ours} at {theirs}, off by {:e} m",
            (theirs - point).norm()
        );
    }
}

/// A tiny raster that GDAL placed on a map of this reference system.
fn placed(directory: &Path, srs: &str) -> PathBuf {
    let (grid, out) = (directory.join("in.asc"), directory.join("out.tif"));
    std::fs::write(&grid, "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 4\n").unwrap();
    let (grid, path) = (grid.to_str().unwrap(), out.to_str().unwrap());
    run("gdal_translate", &["-q", "-ot", "Float32", "-a_srs", srs, grid, path], "");
    out
}

const MARS: &str = "+a=3396190 +b=3376200";

/// Reference systems, a point of each map, and the size of the area around it to compare.
pub(crate) fn systems() -> Vec<(String, (f64, f64), f64)> {
    let moon = |text: &str, at, reach| (format!("{text} +R=1737400 +units=m +no_defs"), at, reach);
    let mars = |text: &str, at, reach| (format!("{text} {MARS} +units=m +no_defs"), at, reach);
    vec![
        moon("+proj=eqc +lat_ts=20 +lon_0=10 +x_0=5 +y_0=7", (4.0e4, -3.0e5), 2.0e5),
        moon("+proj=eqc +lat_ts=20 +lat_0=3 +lon_0=170", (9.0e5, 3.0e5), 2.0e5),
        mars("+proj=eqc +lat_ts=20 +lon_0=10", (4.0e4, -3.0e5), 2.0e5),
        moon("+proj=stere +lat_0=-90 +lon_0=30", (7.0e4, 4.0e4), 3.0e5),
        moon("+proj=stere +lat_0=90 +lon_0=-30 +x_0=500 +y_0=900", (7.0e4, 4.0e4), 3.0e5),
        mars("+proj=stere +lat_0=90 +lat_ts=70 +lon_0=30", (7.0e4, 4.0e4), 3.0e5),
        mars("+proj=stere +lat_0=-90 +k_0=0.994 +lon_0=30", (7.0e4, 4.0e4), 3.0e5),
        moon("+proj=stere +lat_0=18.25 +lon_0=77", (7.0e4, 4.0e4), 3.0e5),
        mars("+proj=stere +lat_0=18 +lon_0=77 +k_0=0.9", (7.0e4, 4.0e4), 3.0e5),
        mars("+proj=sterea +lat_0=18 +lon_0=77 +k_0=0.9", (7.0e4, 4.0e4), 3.0e5),
        moon("+proj=sinu +lon_0=20", (4.0e5, 6.0e5), 2.0e5),
        mars("+proj=sinu +lon_0=20", (4.0e5, 6.0e5), 2.0e5),
        moon("+proj=tmerc +lat_0=3 +lon_0=20 +k=0.9996 +x_0=500000", (5.5e5, 3.0e5), 2.0e5),
        mars("+proj=tmerc +lat_0=3 +lon_0=20 +k=0.9996 +x_0=500000", (5.5e5, 3.0e5), 2.0e5),
        moon("+proj=ortho +lat_0=-80 +lon_0=20", (7.0e4, 4.0e4), 3.0e5),
        mars("+proj=ortho +lat_0=40 +lon_0=20", (7.0e4, 4.0e4), 3.0e5),
        moon("+proj=merc +lon_0=20 +k_0=0.99", (4.0e5, 6.0e5), 2.0e5),
        mars("+proj=merc +lat_ts=33 +lon_0=20", (4.0e5, 6.0e5), 2.0e5),
        moon("+proj=lcc +lat_1=30 +lat_2=50 +lat_0=40 +lon_0=10 +x_0=3 +y_0=4", (4.0e5, 1.0e5), 2.0e5),
        mars("+proj=lcc +lat_1=30 +lat_0=30 +lon_0=10 +k_0=0.99", (4.0e5, 1.0e5), 2.0e5),
        moon("+proj=aea +lat_1=20 +lat_2=40 +lat_0=30 +lon_0=10 +x_0=3 +y_0=4", (4.0e5, 1.0e5), 2.0e5),
        mars("+proj=aea +lat_1=-20 +lat_2=-40 +lat_0=-30 +lon_0=10", (4.0e5, 1.0e5), 2.0e5),
        moon("+proj=laea +lat_0=30 +lon_0=10", (4.0e5, 1.0e5), 2.0e5),
        mars("+proj=laea +lat_0=30 +lon_0=10", (4.0e5, 1.0e5), 2.0e5),
        moon("+proj=aeqd +lat_0=30 +lon_0=10", (4.0e5, 1.0e5), 2.0e5),
        mars("+proj=aeqd +lat_0=30 +lon_0=10", (4.0e5, 1.0e5), 2.0e5),
        moon("+proj=stere +lat_0=18 +lon_0=77 +pm=20", (7.0e4, 4.0e4), 3.0e5),
    ]
}

#[test]
fn gdals_files_of_every_projection_give_gdals_coordinates() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    for (srs, at, reach_m) in systems() {
        let dem = read_dem(&placed(directory.path(), &srs)).unwrap();
        let projection = dem.georeference().projection().unwrap();
        agree(&srs, &projection, &srs, at, reach_m);
    }
}

#[test]
fn epsg_and_iau_codes_state_the_maps_of_gdal_and_are_found_again() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let of_earth = [
        ("EPSG:32633", (5.0e5, 5.0e6), 2.0e5),
        ("EPSG:32733", (5.0e5, 8.0e6), 2.0e5),
        ("EPSG:25832", (5.0e5, 5.0e6), 2.0e5),
        ("EPSG:26913", (5.0e5, 4.0e6), 2.0e5),
        ("EPSG:3031", (4.0e5, 1.0e5), 3.0e5),
        ("EPSG:3413", (4.0e5, 1.0e5), 3.0e5),
        ("EPSG:3976", (4.0e5, 1.0e5), 3.0e5),
        ("EPSG:3995", (4.0e5, 1.0e5), 3.0e5),
        ("EPSG:3035", (4.3e6, 2.8e6), 2.0e5),
        ("EPSG:5070", (4.0e5, 1.6e6), 2.0e5),
        ("EPSG:3577", (4.0e5, -3.0e6), 2.0e5),
        ("EPSG:3338", (4.0e5, 1.1e6), 2.0e5),
        ("EPSG:3005", (1.2e6, 7.0e5), 2.0e5),
        ("EPSG:32661", (2.3e6, 2.1e6), 2.0e5),
        ("EPSG:32761", (2.3e6, 2.1e6), 2.0e5),
    ];
    for (code, at, reach_m) in of_earth {
        let projection = read_dem(&placed(directory.path(), code)).unwrap().georeference().projection().unwrap();
        assert_eq!(projection.code(), Some(code));
        // The axes of a code in GDAL may be north first; its proj string is east first.
        let srs = run("gdalsrsinfo", &["-o", "proj4", code], "");
        let srs: Vec<&str> =
            srs.split_whitespace().filter(|word| !word.starts_with("+towgs84") && !word.starts_with("+datum")).collect();
        let of_grs80 = ["EPSG:2", "EPSG:3035", "EPSG:5070", "EPSG:3577", "EPSG:3338", "EPSG:3005"];
        let figure = if of_grs80.iter().any(|start| code.starts_with(start)) { "+ellps=GRS80" } else { "+ellps=WGS84" };
        let plain: Vec<&str> = srs.into_iter().filter(|word| !word.starts_with("+ellps")).chain([figure]).collect();
        agree(code, &projection, &plain.join(" "), at, reach_m);
    }
    let all = ["10", "15", "20", "25", "30", "35", "60", "65", "70", "75", "80"];
    for (body, suffixes) in [("301", &all[..]), ("199", &["10"]), ("299", &["25"]), ("499", &["35"])] {
        for suffix in suffixes {
            let code = format!("IAU_2015:{body}{suffix}");
            let projection = read_dem(&placed(directory.path(), &code)).unwrap().georeference().projection().unwrap();
            assert_eq!(projection.code(), Some(code.as_str()), "{projection:?}");
        }
    }
}

#[test]
fn real_files_have_the_coordinates_of_gdal_and_of_their_readme() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem");
    for (name, code) in
        [("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", "IAU_2015:30135"), ("lola_dem_north.tif", "IAU_2015:30130")]
    {
        let path = folder.join(name);
        if !path.exists() {
            eprintln!("skipped: {} is absent", path.display());
            continue;
        }
        let dem = read_dem(&path).unwrap();
        let projection = dem.georeference().projection().unwrap();
        assert_eq!(projection.code(), Some(code));
        let bounds = dem.bounds();
        let middle = nalgebra::center(&bounds.min, &bounds.max);
        if name.starts_with("lola5m") {
            let place = projection.lon_lat(middle).unwrap();
            assert!((place.lat_deg + 87.18).abs() < 0.01 && (place.lon_deg - 62.8).abs() < 0.05, "{place}");
        }
        if has_gdal() {
            let srs = run("gdalsrsinfo", &["-o", "proj4", path.to_str().unwrap()], "");
            agree(name, &projection, srs.trim(), (middle.x + 1.0, middle.y), 0.5 * (bounds.max.x - bounds.min.x));
        }
    }
}

#[test]
fn the_written_prj_text_and_keys_state_the_same_map_to_gdal() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    for (srs, at, reach_m) in systems() {
        if srs.contains("+pm=") {
            continue;
        }
        let dem = read_dem(&placed(directory.path(), &srs)).unwrap();
        let projection = dem.georeference().projection().unwrap();
        let prj = directory.path().join("map.prj");
        std::fs::write(&prj, projection.wkt()).unwrap();
        let read = run("gdalsrsinfo", &["-o", "proj4", &format!("ESRI::{}", prj.display())], "");
        agree(&projection.wkt(), &projection, read.trim(), at, reach_m);
        let mut map = dem.georeference().clone();
        map.coordinate_system = projection.coordinate_system();
        let ours = chta::terrain::Dem::new(2, 2, vec![1.0, 2.0, 3.0, 4.0], map).unwrap();
        let out = directory.path().join("ours.tif");
        std::fs::write(&out, chta::terrain::geotiff_bytes(&ours).unwrap()).unwrap();
        let read = run("gdalsrsinfo", &["-o", "proj4", out.to_str().unwrap()], "");
        agree(&srs, &projection, read.trim(), at, reach_m);
    }
}

/// A code, GDAL's PROJ string of it and three dialects of GDAL's WKT state one map, and GDAL computes the same points on it.
#[test]
fn a_map_by_code_by_proj_string_and_by_every_well_known_text_is_the_map_of_gdal() {
    if !has_gdal() {
        return;
    }
    let codes = ["EPSG:32633", "EPSG:26913", "EPSG:3031", "EPSG:3413", "EPSG:5041", "EPSG:3035"].map(str::to_owned);
    let iau = ["30110", "30120", "30130", "30135", "30160", "30165", "30175", "30180", "49910", "49935", "19935", "29935"];
    for code in codes.into_iter().chain(iau.map(|number| format!("IAU_2015:{number}"))) {
        let by_code = MapProjection::from_code(&code).unwrap();
        for form in ["proj4", "wkt1", "wkt_esri", "wkt2_2015", "wkt2_2019"] {
            let text = run("gdalsrsinfo", &["-o", form, &code], "");
            // ESRI's dialect names the orthographic map differently.
            if form == "wkt_esri" && text.contains("PROJECTION[\"Local\"]") {
                continue;
            }
            same_map(&format!("{code} as {form}"), &text, &by_code);
        }
    }
    for (srs, (x, y), reach_m) in systems() {
        let by_proj: MapProjection = srs.parse().unwrap();
        agree(&srs, &by_proj, &srs, (x, y), reach_m);
        for form in ["wkt1", "wkt_esri", "wkt2_2015", "wkt2_2019"] {
            let text = run("gdalsrsinfo", &["-o", form, &srs], "");
            // GDAL rounds the scale of a Mercator map to a parallel there, and drops the latitude of an equirectangular one.
            let lossy = ["\"Local\"", "\"Mercator\""].iter().any(|name| text.contains(name))
                || srs.starts_with("+proj=eqc +lat_ts=20 +lat_0=3");
            if form == "wkt_esri" && lossy {
                continue;
            }
            let by_wkt: MapProjection = text.parse().unwrap_or_else(|error| panic!("{srs} as {form}: {error}\n{text}"));
            for at in [MapPoint::new(x, y), MapPoint::new(x - 0.4 * reach_m, y + 0.3 * reach_m)] {
                let place = by_proj.lon_lat(at).unwrap();
                let found = by_wkt.map_point(place).unwrap();
                assert!((found - at).norm() < 1e-6, "{srs} as {form}: {found} {at}");
            }
        }
    }
}

/// A projection's numbers from two sources: equal up to the rounding of a text.
fn same_map(what: &str, text: &str, expected: &MapProjection) {
    let found: MapProjection = text.parse().unwrap_or_else(|error| panic!("{what}: {error}\n{text}"));
    let (a, b) = (found.definition(), expected.definition());
    assert_eq!((a.method, a.scale), (b.method, b.scale), "{what}");
    for place in [(10.0, 60.0), (-40.0, 75.0), (170.0, -80.0), (14.0, 35.0)].map(|(lon_deg, lat_deg)| LonLat { lon_deg, lat_deg }) {
        match (found.map_point(place), expected.map_point(place)) {
            (Some(found), Some(expected)) => assert!((found - expected).norm() < 1e-6, "{what}: {found} {expected}"),
            (found, expected) => assert_eq!(found, expected, "{what}"),
        }
    }
}
