//! The recipes of docs/gis.md, each run and its result checked, where GDAL's programs are installed.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "a skipped recipe says why")]

use std::{fs, path::Path};

use serde_json::Value;

use crate::{
    desk::{Desk, raster, shell},
    installed::has_gdal,
};

const SITE: &str = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 6\nlanding_speed_max_m_s = 6\n[surface]\n\
                    friction_coefficient = 0.8\n[terrain]\ndem = \"site.tif\"\nstart_m = [75010, 39910]\ngoal_m = [75090, 39960]\n\
                    [search]\nnode_spacing_max_m = 1\n";

/// A site near the Moon's south pole with the files that the recipes start from. `None`, with a printed reason, without GDAL.
fn site() -> Option<Desk> {
    if !has_gdal() {
        return None;
    }
    let desk = Desk::new();
    desk.write("site.toml", SITE);
    let corner = ["--spacing-m", "2", "--south-west-m", "75000,39880", "-o", "ground.tif"];
    assert_eq!(desk.run(&[&["synth", "--rows", "60", "--cols", "60"][..], &corner].concat()).status, 0);
    // The code of the IAU needs PROJ 9.0.
    let placed = std::process::Command::new("gdal_translate")
        .current_dir(desk.path())
        .args(["-q", "-a_srs", "IAU_2015:30135", "ground.tif", "site.tif"])
        .output()
        .unwrap();
    if !placed.status.success() {
        eprintln!("skipped: this GDAL does not know IAU_2015:30135: {}", String::from_utf8_lossy(&placed.stderr));
        return None;
    }
    for line in commands("console").iter().filter_map(|line| line.strip_prefix("$ chta ")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let ran = desk.run(&words);
        assert_eq!(ran.status, 0, "{words:?}: {ran:?}");
    }
    Some(desk)
}

fn document() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/gis.md")).unwrap()
}

/// The lines of the document's blocks of a language.
fn commands(language: &str) -> Vec<String> {
    let document = document();
    let fence = format!("```{language}\n");
    let blocks = document.split(fence.as_str()).skip(1);
    blocks.flat_map(|rest| rest.split("\n```").next().unwrap().lines()).map(str::to_owned).collect()
}

/// The recipes: the driver, the file written and the command.
fn recipes() -> Vec<[String; 3]> {
    let document = document();
    let marked = document.split("<!-- recipe ").skip(1);
    let recipe = |part: &str| {
        let (mark, rest) = part.split_once(" -->\n```sh\n").unwrap();
        let (driver, file) = mark.split_once(": ").unwrap();
        [driver, file, rest.lines().next().unwrap()].map(str::to_owned)
    };
    marked.map(recipe).collect()
}

/// Whether GDAL can write with a driver; says so if not.
fn has_driver(desk: &Desk, driver: &str) -> bool {
    let list = shell(desk.path(), "ogrinfo --formats; gdalinfo --formats");
    let known = list.lines().any(|line| line.trim_start().starts_with(&format!("{driver} -")));
    if !known {
        eprintln!("skipped: the recipe for {driver}, since this GDAL has no such driver");
    }
    known
}

/// The number of features of a file and their extent: west, south, east, north.
fn features(desk: &Desk, file: &str) -> (usize, [f64; 4]) {
    let text = shell(desk.path(), &format!("ogrinfo -al -so {file}"));
    let field = |name: &str| text.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_else(|| panic!("{file}: {text}"));
    let numbers = field("Extent: ").split(['(', ')', ',', ' ']).filter_map(|number| number.parse().ok());
    let extent = numbers.collect::<Vec<f64>>().try_into().unwrap();
    (field("Feature Count: ").parse().unwrap(), extent)
}

/// The smallest box around points.
fn around(points: impl Iterator<Item = [f64; 2]>) -> [f64; 4] {
    let start = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    points.fold(start, |[w, s, e, n], [x, y]| [w.min(x), s.min(y), e.max(x), n.max(y)])
}

#[test]
fn the_recipes_of_the_documents_give_what_they_say() {
    let Some(desk) = site() else { return };
    let geojson: Value = serde_json::from_str(&desk.read("path.geojson")).unwrap();
    let count = geojson["features"].as_array().unwrap().len();
    // The columns of path.csv, which the program itself converted.
    let mut table = csv::Reader::from_path(desk.path().join("path.csv")).unwrap();
    let columns = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let points = |ends: &'static [&'static str], x: &'static str, y: &'static str| {
        let number = |row: &csv::StringRecord, name: String| {
            row[columns.iter().position(|column| *column == *name).unwrap()].parse::<f64>().unwrap()
        };
        let all = rows
            .iter()
            .flat_map(|row| ends.iter().map(move |end| [number(row, format!("{end}_{x}")), number(row, format!("{end}_{y}"))]));
        around(all.collect::<Vec<_>>().into_iter())
    };
    let both: &[&str] = &["takeoff", "landing"];
    let in_metres = (count, points(both, "map_x_m", "map_y_m"));
    let in_degrees = (count, points(both, "lon_deg", "lat_deg"));
    let landings = (rows.len(), points(&["landing"], "lon_deg", "lat_deg"));
    let mut run = 0;
    for [driver, file, command] in recipes() {
        if !has_driver(&desk, &driver) {
            continue;
        }
        shell(desk.path(), &command);
        let file = file.as_str();
        let (found, expected, tolerance) = match file {
            "path.gpkg" | "path.parquet" => (features(&desk, file), in_metres, 1e-6),
            "degrees.geojson" | "arcs.kml" => (features(&desk, file), in_degrees, 2e-6),
            "landings.kml" => (features(&desk, file), landings, 2e-6),
            "hops_cog.tif" => {
                let [before, after] = ["hops.tif", file].map(|name| raster(&desk.path().join(name)));
                assert!(before.elevations().eq(after.elevations()), "{file}: other values");
                assert_eq!(before.georeference().projection(), after.georeference().projection(), "{file}");
                assert!(shell(desk.path(), &format!("gdalinfo {file}")).contains("LAYOUT=COG"));
                run += 1;
                continue;
            }
            other => panic!("`{command}` writes {other}, which this test does not check"),
        };
        assert_eq!(found.0, expected.0, "{file}: features");
        for (a, b) in found.1.iter().zip(expected.1) {
            assert!((a - b).abs() <= tolerance, "{file}: {:?}, expected {:?}", found.1, expected.1);
        }
        run += 1;
    }
    assert!(run >= 5, "only {run} recipes were run");
    let package = shell(desk.path(), "ogrinfo -al -so path.gpkg");
    assert!(package.contains("30135"), "the GeoPackage has no code: {package}");
}

/// What the documents warn of: were it right one day, they should say so.
#[test]
fn kml_of_map_metres_is_no_place_on_the_body() {
    let Some(desk) = site() else { return };
    shell(desk.path(), "ogr2ogr -f KML naive.kml path.geojson 2> warnings.txt");
    let (_, [_, south, _, north]) = features(&desk, "naive.kml");
    assert!(south < -90.0 || north > 90.0, "latitudes {south} to {north}");
    assert!(!desk.read("warnings.txt").is_empty(), "GDAL gives no warning");
}
