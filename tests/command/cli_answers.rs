//! The results of the command: exit status, documents, files, warnings; identical bytes for identical runs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use crate::desk::{Desk, FORWARD_ONLY, SCENARIO};
use serde_json::Value;

const PATH_COLUMNS: [&str; 17] = [
    "hop",
    "direction",
    "takeoff_x_m",
    "takeoff_z_m",
    "landing_x_m",
    "landing_z_m",
    "takeoff_angle_deg",
    "takeoff_speed_m_s",
    "landing_angle_deg",
    "landing_speed_m_s",
    "flight_time_s",
    "apex_z_m",
    "takeoff_angle_min_deg",
    "takeoff_angle_max_deg",
    "speed_margin_m_s",
    "binding",
    "delta_v_m_s",
];
const MARGIN_COLUMNS: [&str; 17] = [
    "margin_takeoff_speed_m_s",
    "margin_landing_speed_m_s",
    "margin_takeoff_cone_min_deg",
    "margin_takeoff_cone_max_deg",
    "margin_landing_cone_min_deg",
    "margin_landing_cone_max_deg",
    "margin_line_of_sight_deg",
    "margin_terrain_m",
    "margin_mechanical_angle_min_deg",
    "margin_mechanical_angle_max_deg",
    "margin_apex_height_m",
    "margin_flight_time_s",
    "margin_takeoff_rest_slope_deg",
    "margin_landing_rest_slope_deg",
    "margin_takeoff_roughness_m",
    "margin_landing_roughness_m",
    "margin_terrain_from_takeoff_m",
];
const MAP_COLUMNS: [&str; 5] = ["heading_deg", "takeoff_map_x_m", "takeoff_map_y_m", "landing_map_x_m", "landing_map_y_m"];

/// Flat ground with two points too far apart for the speed.
const TOO_SLOW: [&str; 2] = ["--set", "hopper.takeoff_speed_max_m_s=0.01"];
/// No landing is allowed on a slope of more than a degree.
const TOO_STEEP: [&str; 2] = ["--set", "surface.rest_slope_max_deg=1"];

/// The keys of an object in a pretty-printed document, in order: those indented by `indent` after `from`, up to the object's end.
fn keys_in_order(document: &str, from: &str, indent: usize) -> Vec<String> {
    let after = &document[document.find(from).unwrap() + from.len()..];
    let pad = " ".repeat(indent);
    let mut keys = Vec::new();
    for line in after.lines() {
        if let Some(key) = line.strip_prefix(&format!("{pad}\"")).and_then(|rest| rest.split_once("\":")) {
            keys.push(key.0.to_owned());
        } else if line.trim_start().starts_with('}') && line.len() - line.trim_start().len() < indent && !keys.is_empty() {
            break;
        }
    }
    keys
}

/// Every document begins with its kind, the program and version, and its scenario and input files.
fn assert_framed(document: &str, kind: &str, folder: &Path) {
    let keys = keys_in_order(document, "{\n", 2);
    assert_eq!(keys[..5], ["schema", "chta_version", "scenario", "inputs", "warnings"], "{document}");
    assert!(!document.contains(folder.to_str().unwrap()), "an absolute path in {document}");
    assert!(!document.contains(": \"/"), "an absolute path in {document}");
    let value: Value = serde_json::from_str(document).unwrap();
    assert_eq!(value["schema"], format!("chta/{kind}/1"));
    assert_eq!(value["chta_version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(value["scenario"]["body"]["gravity_m_s2"], 3.711);
    assert_eq!(value["inputs"][0]["sha256"].as_str().unwrap().len(), 64);
}

fn assert_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "no {key} in {value:#}");
    }
}

#[test]
fn the_exit_status_is_the_answer() {
    let desk = Desk::with_dem();
    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,40\n40,0\n");
    desk.write("some.csv", "start_x_m,goal_x_m\n0,0\n0,40\n");
    let cases: [(&[&str], i32); 16] = [
        (&["bodies"], 0),
        (&["schema"], 0),
        (&["schema", "plan"], 0),
        (&["--help"], 0),
        (&["synth", "--rows", "5", "--cols", "5", "-o", "small.asc"], 0),
        (&["slice", "ground.tif", "--from", "1,1", "--to", "9,9"], 0),
        (&["hop", "scenario.toml", "--from", "0", "--to", "10"], 0),
        (&["hop", "scenario.toml", "--from", "0", "--to", "40"], 1),
        (&["check", "scenario.toml"], 0),
        (&["check", "scenario.toml", "--pairs", "pairs.csv"], 0),
        (&["plan", "scenario.toml"], 0),
        (&["run", "scenario.toml", "-o", "out"], 0),
        (&["run", "map.toml", "-o", "out_map"], 0),
        (&["run"], 2),
        (&[], 2),
        (&["fly", "chain.csv"], 2),
    ];
    for (args, status) in cases {
        let ran = desk.run(args);
        assert_eq!(ran.status, status, "{args:?}: {ran:?}");
        assert_eq!(ran.stdout.is_empty(), status == 2 || args[0] == "synth", "{args:?}: {ran:?}");
    }
    let no: [&[&str]; 4] = [
        &["check", "scenario.toml"],
        &["plan", "scenario.toml"],
        &["run", "scenario.toml", "-o", "out"],
        &["check", "scenario.toml", "--pairs", "some.csv"],
    ];
    for args in no {
        let ran = desk.run(&[args, &TOO_STEEP].concat());
        assert_eq!((ran.status, ran.stderr.as_str()), (1, ""), "{args:?}: {ran:?}");
        assert!(ran.stdout.contains("no-path-found"), "{args:?}: {ran:?}");
    }
}

#[test]
fn hop_has_every_key_of_the_contract() {
    let desk = Desk::new();
    let keys = [
        "feasible",
        "takeoff_angle_min_deg",
        "takeoff_angle_max_deg",
        "line_of_sight_m",
        "line_of_sight_angle_deg",
        "limits",
        "binding",
        "best",
    ];
    let yes = desk.json(&["hop", "scenario.toml", "--from", "0", "--to", "12"]);
    assert_keys(&yes, &keys);
    assert_eq!(yes["feasible"], true);
    let best =
        ["takeoff_angle_deg", "takeoff_speed_m_s", "landing_angle_deg", "landing_speed_m_s", "flight_time_s", "apex_height_m"];
    assert_keys(&yes["best"], &best);
    assert_keys(&yes["binding"], &["lower", "upper"]);
    for limit in yes["limits"].as_array().unwrap() {
        assert_keys(limit, &["name", "min_deg", "max_deg"]);
    }
    let terrain = yes["limits"].as_array().unwrap().iter().find(|limit| limit["name"] == "terrain").unwrap();
    assert_eq!(terrain["vertex"]["x_m"], 10.0, "the bump at x = 10 m stands in the way");

    let no = desk.json(&[&["hop", "scenario.toml", "--from", "0", "--to", "12"][..], &TOO_SLOW].concat());
    assert_keys(&no, &keys);
    assert_eq!((&no["feasible"], &no["takeoff_angle_min_deg"], &no["best"]), (&Value::Bool(false), &Value::Null, &Value::Null));
    assert_keys(&no["binding"], &["conflict", "gap_deg", "sentence"]);
    // The greatest reach is stated for a hop that is too far as well; it has no margins.
    let reach =
        ["reach_line_of_sight_m", "reach_horizontal_m", "takeoff_angle_deg", "limit", "by_takeoff_speed_m", "by_landing_speed_m"];
    for document in [&yes, &no] {
        assert_keys(&document["greatest_reach"], &reach);
        assert_keys(&document["greatest_reach_within_cones"], &reach);
    }
    assert_keys(&yes["margins"], &["takeoff_speed_m_s", "landing_cone_max_deg", "terrain_m", "terrain_from_takeoff_m"]);
    assert!(no["margins"].is_null() && yes["margins"].get("apex_height_m").is_none(), "no such limit, no margin");
    let far = desk.run(&[&["hop", "scenario.toml", "--from", "0", "--to", "12"][..], &TOO_SLOW].concat()).stdout;
    assert!(
        far.contains("\ngreatest reach of one hop along this line of sight\nby speeds alone") && !far.contains("margins"),
        "{far}"
    );
    assert_framed(&desk.run(&["hop", "scenario.toml", "--to", "12", "--format", "json"]).stdout, "hop", desk.path());
}

#[test]
fn check_has_every_key_of_the_contract() {
    let desk = Desk::new();
    let keys = ["verdict", "hops", "points_per_segment", "nodes", "pairs_tested"];
    let yes = desk.json(&["check", "scenario.toml"]);
    assert_keys(&yes, &keys);
    assert_eq!((&yes["verdict"], &yes["hops"]), (&Value::from("traversable"), &Value::from(3)));
    let no = desk.json(&[&["check", "scenario.toml"][..], &TOO_STEEP].concat());
    assert_keys(&no, &keys);
    assert_eq!((&no["verdict"], &no["hops"]), (&Value::from("no-path-found"), &Value::Null));
    assert_keys(&no["endpoint_refusals"][0], &["endpoint", "x_m", "limit", "reason", "nearest_usable_x_m"]);

    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,40\n40,0\n20,20\n");
    let many = desk.json(&["check", "scenario.toml", "--pairs", "pairs.csv"]);
    let pairs = many["pairs"].as_array().unwrap();
    let ends: Vec<_> = pairs.iter().map(|pair| (pair["start_x_m"].as_f64().unwrap(), pair["goal_x_m"].as_f64().unwrap())).collect();
    assert_eq!(ends, [(0.0, 40.0), (40.0, 0.0), (20.0, 20.0)]);
    for pair in pairs {
        assert_keys(pair, &keys);
    }
    assert_eq!((&pairs[0]["hops"], &pairs[2]["hops"]), (&yes["hops"], &Value::from(0)));
    assert_framed(&desk.run(&["check", "scenario.toml", "--format", "json"]).stdout, "check", desk.path());
}

#[test]
fn a_proof_adds_its_bounds_and_says_untraversable_only_where_it_is_proved() {
    let desk = Desk::new();
    let proof_keys = ["lower_bound", "upper_bound", "proved", "proof", "stretches", "gap"];
    let checked = |args: &[&str]| {
        let ran = desk.run(&[&["check", "scenario.toml", "--prove", "--format", "json"], args].concat());
        (ran.status, serde_json::from_str::<Value>(&ran.stdout).unwrap())
    };
    let (status, result) = checked(&[]);
    assert_eq!((status, &result["verdict"], &result["proved"]), (0, &Value::from("traversable"), &Value::from(true)));
    assert_eq!((&result["lower_bound"], &result["upper_bound"]), (&result["hops"], &result["hops"]));
    assert!(proof_keys.iter().all(|key| result.get(key).is_some()), "{result}");
    assert!(result["proof"]["cells"].as_u64() <= result["proof"]["budget_cells"].as_u64());
    let (status, result) = checked(&TOO_STEEP);
    assert_eq!((status, &result["verdict"], &result["proved"]), (1, &Value::from("untraversable"), &Value::from(true)));
    assert!(result["lower_bound"].is_null() && result["upper_bound"].is_null() && result["gap"]["refusals"].is_object());
    let plain = desk.run(&[&["check", "scenario.toml", "--format", "json"][..], &TOO_STEEP].concat());
    let plain: Value = serde_json::from_str(&plain.stdout).unwrap();
    assert_eq!(plain["verdict"], "no-path-found");
    assert!(proof_keys.iter().all(|key| plain.get(key).is_none()), "{plain}");
}

#[test]
fn require_brackets_what_a_fine_scan_finds() {
    let desk = Desk::new();
    let key = "surface.friction_coefficient";
    let ran = desk.run(&["require", "scenario.toml", "--vary", key, "--from", "0.05", "--to", "1", "--format", "json"]);
    let result: Value = serde_json::from_str(&ran.stdout).unwrap();
    let (low, high) = (result["unreachable_at"].as_f64().unwrap(), result["reachable_at"].as_f64().unwrap());
    assert_eq!(ran.status, 0);
    assert!(low < high && high - low < 0.01 * high, "{low} to {high}");
    assert_eq!(result["path"].as_array().unwrap().len() as u64, result["hops"].as_u64().unwrap());
    for i in 1..40 {
        let value = 0.05 * f64::from(i) / 4.0;
        let set = format!("{key}={value}");
        let status = desk.run(&["check", "scenario.toml", "--set", &set, "--points-per-segment", "7"]).status;
        assert!(value > low || status == 1, "a path at {value}, proved unreachable at {low}");
        assert!(value < high || status == 0, "no path at {value}, one at {high}");
    }
    let too_little = desk.run(&["require", "scenario.toml", "--vary", key, "--from", "0.05", "--to", "0.1"]);
    assert_eq!(too_little.status, 1, "{too_little:?}");
    for (vary, expected) in [("hopper.mass_kg", "expected one of"), ("friction", "expected one of")] {
        let refused = desk.run(&["require", "scenario.toml", "--vary", vary]);
        assert!(refused.status == 2 && refused.stderr.contains(expected), "{refused:?}");
    }
    desk.write("forward.csv", FORWARD_ONLY);
    let ends = ["--body", "mars", "--start", "0", "--goal", "10"];
    let no_effect = desk.run(&[&["require", "forward.csv", "--vary", key][..], &ends].concat());
    assert!(no_effect.status == 2 && no_effect.stderr.contains("changes anything"), "{no_effect:?}");
}

#[test]
fn plan_has_every_key_of_the_contract_in_json_and_the_same_columns_in_csv() {
    let desk = Desk::with_dem();
    let totals = ["flight_time_s", "energy_j_kg", "peak_takeoff_speed_m_s", "ground_distance_m"];
    for (scenario, columns) in [("scenario.toml", PATH_COLUMNS.to_vec()), ("map.toml", [&PATH_COLUMNS[..], &MAP_COLUMNS].concat())]
    {
        let ran = desk.run(&["plan", scenario, "--format", "json", "-o", "path.csv"]);
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
        assert_framed(&ran.stdout, "plan", desk.path());
        let keys = [&columns[..], &["margins"]].concat();
        assert_eq!(keys_in_order(&ran.stdout, "\"path\": [", 6), keys, "{scenario}: keys of the first hop");
        let columns = [&columns[..], &MARGIN_COLUMNS].concat();
        let document: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_keys(&document, &["verdict", "hops", "points_per_segment", "nodes", "pairs_tested", "path", "totals"]);
        assert_keys(&document["totals"], &totals);
        assert_eq!(document["path"].as_array().unwrap().len() as u64, document["hops"].as_u64().unwrap());

        let csv = desk.read("path.csv");
        let mut rows = csv.lines();
        assert_eq!(rows.next().unwrap(), columns.join(","));
        for (row, hop) in rows.zip(document["path"].as_array().unwrap()) {
            for (cell, column) in row.split(',').zip(&columns) {
                let margin = column.strip_prefix("margin_").map(|key| hop["margins"].get(key).unwrap_or(&Value::Null));
                match margin.unwrap_or(&hop[*column]) {
                    Value::Null => assert_eq!(cell, "", "{column}: no such limit"),
                    Value::String(text) => assert_eq!(cell, text),
                    number => assert_eq!(cell.parse::<f64>().unwrap(), number.as_f64().unwrap(), "{column}"),
                }
            }
        }
        assert_eq!(csv.lines().count() as u64, 1 + document["hops"].as_u64().unwrap());
    }
    let set = ["--set", "hopper.mass_kg=2", "--set", "hopper.rest_time_s=60"];
    let heavy = desk.json(&[&["plan", "scenario.toml"][..], &set].concat());
    let of = |key: &str| heavy["totals"][key].as_f64().unwrap();
    assert!((of("energy_j") - 2.0 * of("energy_j_kg")).abs() < 1e-9);
    assert!(of("mission_time_s") > of("flight_time_s") + 60.0);
}

#[test]
fn a_plan_goes_where_its_options_say() {
    let desk = Desk::with_dem();
    let csv = desk.run(&["plan", "scenario.toml", "-o", "-", "--format", "json"]);
    assert!(csv.stdout.starts_with("hop,direction,takeoff_x_m,") && csv.stdout.lines().count() == 4, "{csv:?}");
    let none = desk.run(&[&["plan", "scenario.toml", "-o", "-"][..], &TOO_STEEP].concat());
    assert_eq!((none.status, none.stdout.trim_end()), (1, [&PATH_COLUMNS[..], &MARGIN_COLUMNS].concat().join(",").as_str()));

    let verified = desk.json(&["plan", "scenario.toml", "--verify"]);
    assert_eq!(verified["verified"], true);
    assert!(desk.json(&["plan", "scenario.toml"]).get("verified").is_none());
    assert!(desk.run(&["plan", "scenario.toml", "--verify"]).stdout.contains("verified: every hop was flown again"));

    for (args, file) in
        [(&["plan", "scenario.toml"][..], "yes.svg"), (&["plan", "scenario.toml", TOO_STEEP[0], TOO_STEEP[1]], "no.svg")]
    {
        desk.run(&[args, &["--plot", file]].concat());
        let svg = desk.read(file);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{file}");
    }
}

#[test]
fn geojson_has_the_path_in_three_dimensions() {
    let desk = Desk::with_dem();
    let document = desk.json(&["plan", "map.toml", "--geojson", "path.geojson"]);
    let parsed: geojson::GeoJson = desk.read("path.geojson").parse().unwrap();
    let collection = geojson::FeatureCollection::try_from(parsed).unwrap();
    let hops = document["path"].as_array().unwrap();
    let mut arcs = 0;
    for feature in collection.features {
        match feature.geometry.unwrap().value {
            geojson::GeometryValue::Point { coordinates } => assert_eq!(coordinates.len(), 3),
            geojson::GeometryValue::LineString { coordinates } => {
                let hop = &hops[arcs];
                arcs += 1;
                for (end, at) in [("takeoff", coordinates.first()), ("landing", coordinates.last())] {
                    let at = at.unwrap();
                    let planned = ["map_x_m", "map_y_m", "z_m"].map(|key| hop[format!("{end}_{key}")].as_f64().unwrap());
                    assert!((0..3).all(|i| (at[i] - planned[i]).abs() < 1e-9), "{end} at {at:?}, planned {planned:?}");
                }
                let highest = coordinates.iter().map(|position| position[2]).fold(f64::NEG_INFINITY, f64::max);
                let apex = hop["apex_z_m"].as_f64().unwrap();
                let rise = apex - coordinates[0][2];
                assert!(highest <= apex + 1e-9 && highest > apex - 0.01 * rise.abs() - 1e-9, "{highest} against {apex}");
            }
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(arcs, hops.len());
}

#[test]
fn a_run_gives_the_same_bytes_again_and_its_result_repeats_it() {
    let desk = Desk::with_dem();
    for (scenario, names) in [
        ("scenario.toml", &["chain.csv", "path.csv", "path.svg", "result.json"][..]),
        ("map.toml", &["chain.csv", "path.csv", "path.geojson", "path.svg", "result.json"]),
    ] {
        let ran = desk.run(&["run", scenario, "-o", "first", "--format", "json"]);
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
        assert_eq!(ran.stdout, desk.read("first/result.json"));
        assert_framed(&ran.stdout, "run", desk.path());
        assert_eq!(desk.json(&["plan", scenario])["path"], serde_json::from_str::<Value>(&ran.stdout).unwrap()["path"]);
        let files = || desk.files().keys().filter_map(|name| Some(name.strip_prefix("first/")?.to_owned())).collect::<Vec<_>>();
        assert_eq!(files().into_iter().filter(|name| !name.is_empty()).collect::<Vec<_>>(), names);

        for (from, to) in [(scenario, "second"), ("first/result.json", "third"), ("third/result.json", "deep/er/fourth")] {
            assert_eq!(desk.run(&["run", from, "-o", to]).status, 0);
            for name in names {
                assert!(
                    desk.read(&format!("first/{name}")) == desk.read(&format!("{to}/{name}")),
                    "{from} -o {to}: {name} differs"
                );
            }
        }
        std::fs::remove_dir_all(desk.path().join("first")).unwrap();
    }
}

#[test]
fn the_path_of_an_earlier_run_is_removed() {
    let desk = Desk::with_dem();
    assert_eq!(desk.run(&["run", "map.toml", "-o", "out"]).status, 0);
    assert!(desk.files().contains_key("out/path.geojson"));
    assert_eq!(desk.run(&["run", "map.toml", "-o", "out", "--set", "surface.rest_slope_max_deg=0.001"]).status, 1);
    assert!(!desk.files().contains_key("out/path.geojson"), "the path of the earlier run");
    assert_eq!(desk.read("out/path.csv").lines().count(), 1, "only the header");
}

#[test]
fn a_result_is_accepted_wherever_a_chain_is() {
    let desk = Desk::new();
    assert_eq!(desk.run(&["run", "scenario.toml", "-o", "out"]).status, 0);
    for args in [&["plan", "-o", "-"][..], &["check"], &["hop", "--from", "0", "--to", "10"]] {
        let with = |chain: &'static str| desk.run(&[&args[..1], &[chain], &args[1..]].concat());
        assert_eq!(with("scenario.toml"), with("out/result.json"), "{args:?}");
        assert_eq!(with("scenario.toml").status, 0);
    }
    let beside = desk.run(&["check", "chain.csv", "--scenario", "scenario.toml"]);
    assert_eq!(beside, desk.run(&["check", "scenario.toml"]), "a chain beside a scenario takes the scenario's start and goal");
    let chain = desk.run(&["plan", "out/chain.csv", "--scenario", "scenario.toml", "-o", "-"]);
    assert_eq!(chain, desk.run(&["plan", "scenario.toml", "-o", "-"]), "the chain of a run is the chain that was run");
}

#[test]
fn paths_in_a_scenario_start_from_its_folder() {
    let desk = Desk::new();
    std::fs::create_dir_all(desk.path().join("deep/er")).unwrap();
    desk.write("deep/er/scenario.toml", SCENARIO.replace("chain.csv", "../../chain.csv"));
    let document = desk.json(&["check", "deep/er/scenario.toml"]);
    assert_eq!((&document["inputs"][0]["name"], &document["hops"]), (&Value::from("chain.csv"), &Value::from(3)));
}

/// Runs a command as text, as JSON and with --quiet: the warning is on standard error and in the document; --quiet removes it from
/// standard error.
fn assert_warned(desk: &Desk, args: &[&str], warnings: &[&str]) {
    let ran = desk.run(args);
    let document = desk.json(args);
    let documented = document["warnings"].as_array().unwrap();
    assert_eq!(documented.len(), warnings.len(), "{args:?}: {documented:?}");
    for (warning, documented) in warnings.iter().zip(documented) {
        let documented = documented.as_str().unwrap();
        assert!(documented.contains(warning), "{args:?}: {documented} does not contain {warning}");
        assert_eq!(ran.stderr.matches(&format!("warning: {documented}\n")).count(), 1, "{args:?}: {}", ran.stderr);
    }
    let quiet = desk.run(&[args, &["--quiet"]].concat());
    assert_eq!((quiet.stderr.as_str(), quiet.status), ("", ran.status), "{args:?}");
    assert_eq!(quiet.stdout, ran.stdout, "{args:?}");
}

#[test]
fn constant_gravity_gives_a_warning_on_small_bodies() {
    let desk = Desk::new();
    desk.write("flat.csv", "x_m,z_m\n0,0\n400,0\n");
    // The limits of 10 m/s are over the escape speed of Bennu (0.1998 m/s), and under that of Phobos (11.3 m/s).
    let capped = ["hopper.takeoff_speed_max_m_s is 10 m/s, at or above", "hopper.landing_speed_max_m_s is 10 m/s, at or above"];
    let of_model = [
        "a hop's range, 400.000 m, is over 1 % of the radius of",
        "a hop's highest point above its take-off,",
        "is over a tenth of the escape speed of",
    ];
    for (body, capped) in [("bennu", &capped[..]), ("phobos", &[])] {
        let expected = [capped, &of_model].concat();
        let scenario = SCENARIO.replace("mars", body).replace("chain.csv", "flat.csv").replace("goal_x_m = 40", "goal_x_m = 400");
        desk.write("small.toml", scenario);
        desk.write("pairs.csv", "start_x_m,goal_x_m\n0,400\n0,400\n");
        let fewest = ["--points-per-segment", "0"];
        assert_warned(&desk, &["hop", "small.toml"], &expected);
        for args in [&["check", "small.toml"][..], &["plan", "small.toml"], &["check", "small.toml", "--pairs", "pairs.csv"]] {
            assert_warned(&desk, &[args, &fewest].concat(), &expected);
        }
        assert_warned(&desk, &["run", "small.toml", "-o", "out"], &expected);
        // `trade` warns of the hop of 400 m for its cells.
        let varied = ["trade", "small.toml", "--vary", "surface.friction_coefficient=0.01:0.6:2"];
        let ran = desk.run(&varied);
        assert!(ran.stderr.contains("have a hop whose range is over 1 % of the body's radius"), "{body}: {}", ran.stderr);
    }
    assert_warned(&desk, &["plan", "scenario.toml"], &[]);
    // The far end of a heading is 6 m away, over 1 % of the radius of Bennu (2.45 m); the robot gets there in one hop or two.
    let desk = Desk::with_dem();
    for (body, warned) in [("bennu", true), ("moon", false)] {
        desk.write(
            "fan.toml",
            format!("[body]\nname = \"{body}\"\n[hopper]\ntakeoff_speed_max_m_s = 0.15\nlanding_speed_max_m_s = 0.15\n[surface]\nfriction_coefficient = 0.9\n"),
        );
        let ran = desk.run(&["fan", "ground.tif", "--scenario", "fan.toml", "--from", "9,9", "--headings", "4", "--length", "6"]);
        assert_eq!(ran.status, 0, "{body}: {}", ran.stderr);
        assert_eq!(ran.stderr.contains("constant gravity is a bad model"), warned, "{body}: {}{}", ran.stderr, ran.stdout);
    }
}

#[test]
fn missing_and_ignored_parts_of_a_chain_give_warnings() {
    let desk = Desk::new();
    desk.write("forward.csv", FORWARD_ONLY);
    let ends = ["--body", "mars", "--start", "0", "--goal", "10"];
    assert_warned(
        &desk,
        &[&["check", "forward.csv"], &ends[..]].concat(),
        &["no hop goes towards -x: the chain has no reverse_ columns"],
    );
    assert_warned(&desk, &[&["plan", "forward.csv"], &ends[..]].concat(), &["no hop goes towards -x"]);
    assert_warned(&desk, &["hop", "forward.csv", "--body", "mars", "--from", "10", "--to", "0"], &["no hop goes towards -x"]);

    desk.write("coloured.csv", "x_m,z_m,colour\n0,0,red\n10,1,\n");
    let args = ["check", "coloured.csv", "--scenario", "scenario.toml", "--start", "0", "--goal", "10"];
    assert_warned(&desk, &args, &["colour"]);
    desk.write("pairs.csv", "start_x_m,goal_x_m,why\n0,10,fun\n");
    assert_warned(&desk, &["check", "scenario.toml", "--pairs", "pairs.csv"], &["pairs.csv: "]);
}

#[test]
fn slice_warns_if_the_scenario_has_no_friction() {
    let desk = Desk::with_dem();
    let slice = ["slice", "ground.tif", "--from", "1,1", "--to", "9,9"];
    let with = desk.run(&[&slice[..], &["--scenario", "scenario.toml"]].concat());
    assert_eq!((with.status, with.stderr.as_str()), (0, ""));
    assert!(with.stdout.contains("x_m,z_m,friction_coefficient,"), "{}", with.stdout);
    desk.write(
        "paper.toml",
        SCENARIO.replace("friction_coefficient = 0.6", "takeoff_from_slope_deg = [60, 90]\nlanding_from_slope_deg = [-90, -60]"),
    );
    let without = desk.run(&[&slice[..], &["--scenario", "paper.toml"]].concat());
    assert!(without.stderr.starts_with("warning: --scenario paper.toml has no friction_coefficient"), "{}", without.stderr);
    assert_eq!(without.stdout, desk.run(&slice).stdout);
}

#[test]
fn a_slice_is_a_chain_that_runs_like_its_dem() {
    let desk = Desk::with_dem();
    let slice = desk.run(&["slice", "ground.tif", "--from", "1,2", "--to", "15,12", "--scenario", "map.toml", "-o", "slice.csv"]);
    assert_eq!((slice.status, slice.stdout.as_str(), slice.stderr.as_str()), (0, "", ""));
    assert!(!desk.read("slice.csv").contains(desk.path().to_str().unwrap()), "an absolute path");
    let goal = desk.json(&["check", "map.toml"])["goal_x_m"].to_string();
    let chain = ["plan", "slice.csv", "--scenario", "map.toml", "--start", "0", "--goal", &goal, "-o", "-"];
    assert_eq!(desk.run(&chain), desk.run(&["plan", "map.toml", "-o", "-"]));
}

/// Over several hops, the text names an effort as a sum or a maximum; the document keeps the names of the efforts.
#[test]
fn texts_name_efforts_as_sums_or_maxima() {
    let desk = Desk::new();
    let said = [
        ("takeoff-speed", "sum of take-off speeds", "m/s"),
        ("energy", "sum of energies per unit mass", "J/kg"),
        ("time", "flight time in all", "s"),
        ("peak-speed", "largest take-off speed", "m/s"),
    ];
    for (effort, words, unit) in said {
        let document = desk.json(&["plan", "scenario.toml", "--effort", effort]);
        assert_eq!((&document["effort"]["name"], &document["effort"]["unit"]), (&effort.into(), &unit.into()));
        assert_eq!(document["effort"].as_object().unwrap().len(), 3, "{}", document["effort"]);
        let line = format!("\n{words}: {:.4} {unit}\n", document["effort"]["value"].as_f64().unwrap());
        for args in [
            &["plan", "scenario.toml"][..],
            &["check", "scenario.toml"],
            &["simulate", "scenario.toml"],
            &["run", "scenario.toml", "-o", "out"],
        ] {
            let ran = desk.run(&[args, &["--set", &format!("search.effort={effort}")]].concat());
            assert!(ran.stdout.contains(&line), "{args:?} does not say {line:?} in:\n{}", ran.stdout);
            assert!(!ran.stdout.contains(&format!("{effort}:")), "{}", ran.stdout);
        }
    }
}

#[test]
fn a_clearance_that_no_hop_keeps_in_full_is_reported() {
    let desk = Desk::new();
    desk.write("flat.csv", "x_m,z_m\n0,0\n60,0\n");
    let base = ["plan", "flat.csv", "--body", "moon", "--start", "0", "--goal", "60", "--set", "surface.friction_coefficient=1.2"];
    let speeds = ["--set", "hopper.takeoff_speed_max_m_s=5", "--set", "hopper.landing_speed_max_m_s=6"];
    // v^2 / g = 15.4 m: no hop is as long as 2 x 4 / 0.5 = 16 m.
    let high = desk.run(&[&base[..], &speeds, &["--clearance-m", "4"]].concat());
    assert!(high.status == 0 && high.stderr.contains("no hop keeps hopper.clearance_m of 4 m in full"), "{high:?}");
    let check = desk.run(&[&["check"], &base[1..], &speeds, &["--clearance-m", "4"]].concat());
    assert!(check.status == 0 && check.stderr.contains("no hop keeps hopper.clearance_m of 4 m in full"), "{check:?}");
    let low = desk.run(&[&base[..], &speeds, &["--clearance-m", "1"]].concat());
    assert_eq!((low.status, low.stderr.as_str()), (0, ""), "{low:?}");
    // The mending line: a steeper taper keeps it.
    let steep = desk.run(&[&base[..], &speeds, &["--clearance-m", "4", "--set", "hopper.clearance_taper=1"]].concat());
    assert!(!steep.stderr.contains("in full"), "{steep:?}");
}
