//! Maps of several starts, their rasters and styles, bounded searches, and what a map or a fan needs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rows, columns and starts of a small map"
)]
#![allow(clippy::print_stderr, reason = "a test that is skipped says why")]

use serde_json::{Value, json};

use crate::{
    desk::{self, Desk, shell},
    installed::has_gdal,
};

/// The numbers of a raster, row after row; `None` for no-data.
fn raster(desk: &Desk, name: &str) -> Vec<Option<f64>> {
    desk::raster(&desk.path().join(name)).elevations().collect()
}

/// The predecessors of a raster, `None` for no-data; as elevations they would look like those of a map in degrees.
fn predecessors(desk: &Desk, name: &str) -> Vec<Option<i32>> {
    let file = tiff_reader::TiffFile::open(desk.path().join(name)).unwrap();
    let posts = file.read_image::<i32>(0).unwrap();
    posts.iter().map(|&post| (post != i32::MIN).then_some(post)).collect()
}

/// Slow hopping over `ground.tif` of 20 x 20 posts.
fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write(
        "slow.toml",
        desk.read("map.toml").replace("= 6.0", "= 3.0").replace("[search]", "[report]\ntitle = \"Slow <&> far\"\n[search]"),
    );
    desk.write("starts.csv", "x_m,y_m\n2,3\n16,4\n9,17\n");
    desk
}

const STARTS: [&str; 6] = ["--start", "2,3", "--start", "16,4", "--start", "9,17"];

#[test]
fn starts_of_options_and_of_a_file_give_the_least_of_their_maps() {
    let desk = desk();
    let map = ["map", "ground.tif", "--scenario", "slow.toml", "--goal", "10,10", "--goal", "18,18"];
    let rasters = ["-o", "hops.tif", "--nearest-output", "nearest.tif", "--predecessor-output", "previous.tif"];
    let by_options = desk.json(&[&map[..], &STARTS, &rasters].concat());
    let hops = raster(&desk, "hops.tif");
    let (nearest, previous) = (raster(&desk, "nearest.tif"), predecessors(&desk, "previous.tif"));
    let mut by_file = desk.json(&[&map[..], &["--starts", "starts.csv"], &rasters].concat());
    assert_eq!(by_options, by_file);
    assert!(hops == raster(&desk, "hops.tif") && nearest == raster(&desk, "nearest.tif"));
    let mut alone = Vec::new();
    for start in ["2,3", "16,4", "9,17"] {
        desk.json(&[&map[..], &["--start", start, "-o", "one.tif"]].concat());
        alone.push(raster(&desk, "one.tif"));
    }
    let mut counts = [0; 3];
    for (post, &found) in hops.iter().enumerate() {
        let reached = |map: &Vec<Option<f64>>| map[post].filter(|hops| *hops >= 0.0);
        let least = alone.iter().filter_map(reached).reduce(f64::min);
        assert_eq!(found, least.or(alone[0][post]), "post {post}");
        let first = alone.iter().position(|map| least.is_some() && reached(map) == least);
        assert_eq!(nearest[post], first.map(|number| number as f64 + 1.0).or(alone[0][post]), "post {post}");
        if let Some(number) = first {
            counts[number] += 1;
        }
        // The post that the last hop comes from has a hop less and the same start.
        match (previous[post], found.filter(|hops| *hops >= 0.0)) {
            (None, None) | (Some(-1), Some(0.0)) => {}
            (Some(before), Some(hops_here)) => {
                let before = usize::try_from(before).unwrap();
                assert_eq!((hops[before], nearest[before]), (Some(hops_here - 1.0), nearest[post]), "post {post} from {before}");
            }
            other => panic!("post {post}: {other:?}"),
        }
    }
    let starts = by_file["starts"].take();
    assert_eq!(
        starts.as_array().unwrap().iter().map(|start| start["nearest_posts"].clone()).collect::<Vec<_>>(),
        counts.map(Value::from)
    );
    assert_eq!((&starts[2]["x_m"], &starts[2]["y_m"], &starts[2]["offset_m"]), (&json!(9.0), &json!(17.0), &json!(0.0)));
    assert_eq!(by_file["start_m"], json!([2.0, 3.0]), "the first start keeps its own key");
    for goal in by_file["goals"].as_array().unwrap() {
        let (x, y) = (goal["x_m"].as_f64().unwrap() as usize, goal["y_m"].as_f64().unwrap() as usize);
        assert_eq!(goal["start"].as_f64(), nearest[(19 - y) * 20 + x], "{goal}");
        assert_eq!(goal["verified"], json!(true));
    }
    // A start on the post of another one is told.
    let twice = desk.run(&["map", "ground.tif", "--scenario", "slow.toml", "--start", "2,3", "--start", "2.1,3.2"]);
    assert!(twice.stderr.contains("start 2 has the same nearest post as start 1, (2.000, 3.000) m"), "{}", twice.stderr);
}

#[test]
fn start_and_goal_come_from_the_scenario_where_no_start_is_given() {
    let desk = desk();
    let of_scenario = desk.json(&["map", "slow.toml"]);
    let of_options = desk.json(&["map", "ground.tif", "--scenario", "slow.toml", "--start", "1,2", "--goal", "15,12"]);
    for (name, args) in [
        ("the scenario alone", &["map", "slow.toml"][..]),
        ("its DEM beside it", &["map", "ground.tif", "--scenario", "slow.toml"]),
        ("the goal again", &["map", "slow.toml", "--goal", "15,12"]),
        ("the start again", &["map", "slow.toml", "--start", "1,2"]),
        ("keys of the command line", &["map", "slow.toml", "--set", "terrain.start_m=[1,2]"]),
    ] {
        assert_eq!(desk.json(args), of_options, "{name}");
    }
    assert_eq!(of_scenario, of_options);
    let moved = desk.json(&["map", "slow.toml", "--set", "terrain.start_m=[4,5]"]);
    assert_eq!((&moved["start_m"], &moved["warnings"]), (&json!([4.0, 5.0]), &of_scenario["warnings"]));
    let bare = desk.json(&["map", "ground.tif", "--scenario", "slow.toml", "--start", "1,2"]);
    assert_eq!(bare["goals"], json!([]), "with DEM and a start, the scenario's goal is left out");
    // The title of its report stands in the pictures.
    desk.run(&["map", "slow.toml", "--plot", "map.svg", "--profiles", "profiles.svg"]);
    desk.run(&["fan", "ground.tif", "--scenario", "slow.toml", "--from", "5,5", "--length", "6", "--plot", "fan.svg"]);
    for picture in ["map.svg", "profiles.svg", "fan.svg"] {
        assert!(desk.read(picture).contains("Slow &lt;&amp;&gt; far"), "{picture} has no title of the scenario");
    }
}

#[test]
fn a_bounded_search_says_what_it_did_not_search() {
    let desk = desk();
    let map = ["map", "ground.tif", "--scenario", "slow.toml", "--start", "1,2", "--goal", "18,18", "--goal", "2,3"];
    let whole = desk.json(&[&map[..], &["-o", "whole.tif"]].concat());
    let bounded =
        [&map[..], &["--hops-max", "1", "-o", "hops.tif", "--nearest-output", "n.tif", "--plot", "m.svg", "--return"]].concat();
    let found = desk.json(&bounded);
    let (hops, all) = (raster(&desk, "hops.tif"), raster(&desk, "whole.tif"));
    assert!(hops.iter().zip(&all).all(|(&found, &known)| if known > Some(1.0) {
        found == Some(-2.0)
    } else {
        found == known || found == Some(-2.0)
    }));
    let left = hops.iter().filter(|hops| **hops == Some(-2.0)).count();
    assert!(left > 100 && raster(&desk, "n.tif").iter().filter(|nearest| **nearest == Some(-2.0)).count() == left);
    assert_eq!((&found["hops_max"], &found["not_searched_posts"]), (&json!(1), &json!(left)));
    assert_eq!(found["goals"][0]["searched"], json!(false));
    assert_eq!((&found["goals"][1]["searched"], &whole["goals"][0]["searched"]), (&json!(true), &json!(true)));
    let text = desk.run(&bounded);
    assert_eq!(text.status, 1, "a goal that was not found is no yes");
    for part in
        [&format!("searched up to 1 hop: {left} other posts may be farther")[..], "not within 1 hop, and not searched beyond"]
    {
        assert!(text.stdout.contains(part), "no `{part}` in {}", text.stdout);
    }
    assert!(desk.read("m.svg").contains(&format!("not searched: {left} posts")));
    let far = desk.json(&[&map[..], &["--hops-max", "1000"]].concat());
    assert_eq!((&far["not_searched_posts"], &far["hops_histogram"]), (&json!(0), &whole["hops_histogram"]));
}

#[test]
fn what_a_map_or_a_fan_needs_is_printed_or_refused_before_it_is_computed() {
    let desk = desk();
    let map = &["map", "slow.toml", "--effort", "--return", "--mobility", "m.tif"][..];
    let fan =
        &["fan", "ground.tif", "--scenario", "slow.toml", "--from", "5,5", "--length", "9", "--points-per-segment", "2000"][..];
    for command in [map, fan] {
        let dry = desk.run(&[command, &["--dry-run", "--quiet"]].concat());
        assert_eq!((dry.status, dry.stderr.as_str()), (0, ""), "{command:?}");
        let size = desk.json(&[command, &["--dry-run"]].concat());
        let number = |key: &str| size[key].as_u64().unwrap();
        assert_eq!((size["schema"].as_str(), size["dry_run"].as_bool()), (Some("chta/size/1"), Some(true)));
        assert_eq!(number("posts"), 400);
        assert!(dry.stdout.contains(&format!("nodes: {}\n", number("nodes"))), "{}", dry.stdout);
        let parts: u64 = size["memory"].as_array().unwrap().iter().map(|part| part["bytes_max"].as_u64().unwrap()).sum();
        assert!(parts == number("bytes_max") && number("pairs_max") > number("nodes"), "{size}");
        assert!(!desk.path().join("m.tif").exists(), "a dry run writes no file");
        let enough = number("bytes_max").div_ceil(1 << 20);
        assert!(desk.run(&[command, &["--memory-max-mib", &enough.to_string()]].concat()).status < 2, "{command:?}");
        let _ = std::fs::remove_file(desk.path().join("m.tif"));
        if enough > 1 {
            let expected = format!("or --memory-max-mib {enough}");
            let parts = ["--memory-max-mib: ", "expected at most 1 MiB", &expected];
            desk.refused(&[command, &["--memory-max-mib", "1"]].concat(), &parts);
        }
    }
    // A DEM that is too large by itself is refused before it is read.
    desk.run(&["synth", "--rows", "700", "--cols", "700", "-o", "large.tif"]);
    let large = ["map", "large.tif", "--scenario", "slow.toml", "--start", "9,9", "--memory-max-mib", "5"];
    desk.refused(&large, &["490000 posts of the DEM", "expected at most 5 MiB", "--stride N"]);
}

#[test]
fn positions_that_cannot_be_used_are_told_with_what_mends_them() {
    let desk = desk();
    desk.write("bad.csv", "x_m,y_m\n2,3\n16,far\n");
    desk.write("off.csv", "x_m,y_m\n2,3\n160,4\n");
    desk.write("empty.csv", "x_m,y_m\n");
    desk.write("named.csv", "east,north\n1,2\n");
    desk.write("none.toml", desk.read("slow.toml").replace("start_m = [1, 2]\n", ""));
    let counts = "a position is X along a chain, X,Y on a map and X,Y,Z on a mesh";
    let on_map = |with: &[&'static str]| [&["map", "ground.tif", "--scenario", "slow.toml"][..], with].concat();
    let cases: Vec<(Vec<&str>, Vec<&str>)> = vec![
        (on_map(&["--start", "1"]), vec!["`1` (1 number)", "two finite numbers in metres, X,Y", counts]),
        (on_map(&["--start", "1,2,3"]), vec!["`1,2,3` (3 numbers)", counts]),
        (on_map(&["--start", "1,2", "--goal", "4"]), vec!["--goal", "`4` (1 number)", counts]),
        (vec!["plan", "scenario.toml", "--start", "1,2"], vec!["`1,2` (2 numbers)", "one number in metres, X", counts]),
        (vec!["hop", "scenario.toml", "--to", "1,2,3"], vec!["`1,2,3` (3 numbers)", counts]),
        (vec!["slice", "ground.tif", "--from", "1", "--to", "2,3"], vec!["`1` (1 number)", counts]),
        (on_map(&["--starts", "bad.csv"]), vec!["bad.csv: line 3", "(y_m): found `far`, expected a finite number"]),
        (
            on_map(&["--starts", "off.csv"]),
            vec![
                "off.csv, line 3: (160.000, 4.000) m lies off the map, which covers x from 0 to 19 m",
                "; choose a position there",
            ],
        ),
        (on_map(&["--starts", "empty.csv"]), vec!["empty.csv: ", "expected at least 1 position; add a row such as 10,20"]),
        (on_map(&["--starts", "named.csv"]), vec!["named.csv", "x_m"]),
        (
            on_map(&["--starts", "ground.tif"]),
            vec!["this is a GeoTIFF; expected a CSV file of positions with the header x_m,y_m as --starts"],
        ),
        (on_map(&["--starts", "nowhere.csv"]), vec!["nowhere.csv: cannot be read", "expected a CSV file of positions"]),
        (on_map(&["--starts", "starts.csv", "--start", "1,2"]), vec!["--starts", "cannot be used with"]),
        (on_map(&["--start", "1,2", "--hops-max", "0"]), vec!["found `0`, expected a whole number of hops from 1 to 32767"]),
        (on_map(&["--start", "1,2", "--qml"]), vec!["--qml: found no raster to write a style for", "give -o FILE.tif"]),
        (
            on_map(&["--start", "1,2", "--nearest-output", "n.png"]),
            vec!["--nearest-output n.png: expected a file that ends in .tif"],
        ),
        (on_map(&["--start", "1,2", "--memory-max-mib", "0"]), vec!["found `0`, expected a whole number of MiB from 1"]),
        (on_map(&["--start", "1,2", "--paths", "p.csv"]), vec!["--paths: found no goal", "--goal X,Y"]),
        (vec!["map", "slow.toml", "--set", "terrain.start_m=[1,200]"], vec!["terrain.start_m (1.000, 200.000) m lies off the map"]),
        (
            vec!["map", "slow.toml", "--scenario", "map.toml"],
            vec!["found two scenarios, slow.toml and --scenario map.toml", "give a DEM as DEM"],
        ),
        (vec!["map", "scenario.toml"], vec!["scenario.toml: found no terrain.dem, expected one for a map"]),
        (vec!["map", "none.toml"], vec!["start_m"]),
        (vec!["map", "ground.tif", "--body", "mars"], vec!["takeoff_speed_max_m_s"]),
        (
            vec![
                "map",
                "ground.tif",
                "--body",
                "mars",
                "--set",
                "hopper.takeoff_speed_max_m_s=3",
                "--set",
                "hopper.landing_speed_max_m_s=3",
                "--set",
                "surface.friction_coefficient=0.6",
            ],
            vec!["ground.tif: found no start, expected one for a map: give --start X,Y"],
        ),
    ];
    for (args, parts) in cases {
        desk.refused(&args, &parts);
    }
}

#[test]
fn rasters_have_descriptions_and_units_and_a_style_beside_each() {
    let desk = desk();
    let rasters = [
        ("-o", "hops.tif", "fewest hops from the nearest start; -1 unreachable", "hops"),
        ("--return-output", "back.tif", "fewest hops back to the nearest start; -1 no way", "hops"),
        ("--effort-output", "effort.tif", "least flight time in all among fewest hops, s", "s"),
        ("--nearest-output", "nearest.tif", "number of the nearest start, from 1; -1 unreachable", "start"),
        ("--predecessor-output", "previous.tif", "post that the last hop comes from, as row * columns + column", "post"),
        ("--mobility", "mobility.tif", "share of the reach disc that one hop reaches", "1"),
    ];
    let outputs = rasters.iter().flat_map(|raster| [raster.0, raster.1]).collect::<Vec<_>>();
    let args = [&["map", "ground.tif", "--scenario", "slow.toml", "--effort", "time", "--return", "--qml"][..], &STARTS, &outputs]
        .concat();
    let ran = desk.run(&args);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    for (_, name, ..) in rasters {
        let style = desk.read(&name.replace(".tif", ".qml"));
        assert!(style.starts_with("<!DOCTYPE qgis") && style.contains("colorRampType=\"DISCRETE\""), "{name}: {style}");
    }
    // The styles alone are not written without their option.
    let count = desk.files().keys().filter(|name| name.contains(".qml")).count();
    assert_eq!(count, rasters.len());
    if !has_gdal() {
        eprintln!("skipped: gdalinfo is not installed");
        return;
    }
    for (_, name, description, unit) in rasters {
        let info = shell(desk.path(), &format!("gdalinfo {name}"));
        let description = info.lines().find(|line| line.contains("Description = ")).map(|line| line.contains(description));
        assert_eq!(description, Some(true), "{name}: {info}");
        assert!(info.contains(&format!("Unit Type: {unit}\n")), "{name}: {info}");
    }
}
