//! `chta simulate` in ranges, with draws, along the path of a result, and against a success to be shown.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::cast_precision_loss, reason = "small counts")]

use std::process::Command;

use chta::{
    terrain::{DemOptions, read_dem},
    uncertainty::{Tally, TrialOutcome},
};
use serde_json::{Value, json};

use crate::{desk::Desk, installed::has_gdal};

const ERRORS: &str = "\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.01\ntakeoff_angle_sigma_deg = 0.3\nposition_sigma_m = 0.05\n\
    drift_along_sigma_m = 0.1\nfriction_sigma = 0.02\ngoal_tolerance_m = 2.0\ntrials = 900\nseed = 4\n";

/// The rows of a CSV by their columns.
fn rows(text: &str) -> Vec<std::collections::HashMap<String, String>> {
    let mut lines = text.lines();
    let heads: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
    lines.map(|line| heads.iter().cloned().zip(line.split(',').map(str::to_owned)).collect()).collect()
}

#[test]
fn the_density_of_rests_is_that_of_the_landings() {
    let desk = desk();
    desk.write("area.geojson", r#"{ "type": "Polygon", "coordinates": [[[15, 0], [20, 0], [20, 20], [15, 20], [15, 0]]] }"#);
    let map =
        ["simulate", "dem.toml", "--trials", "400", "--policy", "open-loop", "--density", "rests.tif", "--within", "area.geojson"];
    let answer = desk.json(&[&map[..], &["-o", "landings.csv", "--plot-density", "rests.svg"]].concat());
    let rows = rows(&desk.read("landings.csv"));
    let number = |row: &std::collections::HashMap<String, String>, key: &str| row[key].parse::<f64>().unwrap();
    // The last landing of a trial is where it ends, unless it left the known ground in a later flight: that one has no row.
    let ends: Vec<[f64; 2]> = rows
        .iter()
        .filter(|row| !row["outcome"].is_empty())
        .map(|row| [number(row, "rest_map_x_m"), number(row, "rest_map_y_m")])
        .collect();
    let stays = answer["outcomes"]["slid_at_takeoff"].as_u64().unwrap() == 0;
    let density = &answer["density"];
    let share = |key: &str| density[key].as_f64().unwrap();
    let trials = answer["trials"].as_f64().unwrap();
    let inside = ends.iter().filter(|at| (15.0..=20.0).contains(&at[0]) && (0.0..=20.0).contains(&at[1])).count();
    assert!(stays && inside > 0 && inside < ends.len(), "{inside} of {}", ends.len());
    assert!((share("inside_share") - inside as f64 / trials).abs() < 1e-12, "{density}");
    assert!((share("on_ground_share") - ends.len() as f64 / trials).abs() < 1e-12, "{density}");
    // Posts of the map are a metre apart: the nearest one is that of the cell.
    let count = |of: &[[f64; 2]], at: [f64; 2]| of.iter().filter(|end| (0..2).all(|i| (end[i] - at[i]).abs() < 0.5)).count();
    let at = [density["greatest_m"][0].as_f64().unwrap(), density["greatest_m"][1].as_f64().unwrap()];
    let most = ends.iter().map(|end| count(&ends, [end[0].round(), end[1].round()])).max().unwrap();
    assert_eq!((count(&ends, at), share("greatest_share")), (most, most as f64 / trials), "{density}");
    // The raster: a band of all ends, and one for each planned hop.
    let hops = usize::try_from(answer["hops"].as_u64().unwrap()).unwrap();
    assert_eq!(density["hops_counted"].as_u64(), Some(hops as u64));
    let bytes = std::fs::read(desk.path().join("rests.tif")).unwrap();
    let names = String::from_utf8_lossy(&bytes).into_owned();
    assert!(names.contains("share of ends") && names.contains(&format!("share after hop {hops}")));
    // Every cell of every band, counted from the landings. Rests within rounding of the border of two cells may belong to either.
    let of_hop = |hop: usize| -> Vec<[f64; 2]> {
        let place = |row: &std::collections::HashMap<String, String>| [number(row, "rest_map_x_m"), number(row, "rest_map_y_m")];
        rows.iter().filter(|row| row["hop"] == hop.to_string()).map(place).collect()
    };
    let ground = read_dem(&desk.path().join("ground.tif")).unwrap();
    let posts: Vec<_> =
        (0..ground.rows() * ground.cols()).map(|at| ground.georeference().post(at / ground.cols(), at % ground.cols())).collect();
    let shares_of =
        |rests: &[[f64; 2]]| -> Vec<f64> { posts.iter().map(|post| count(rests, [post.x, post.y]) as f64 / trials).collect() };
    let of_ends = shares_of(&ends);
    for band in (0..=hops).filter(|_| has_gdal()) {
        let rests = if band == 0 { ends.clone() } else { of_hop(band) };
        let (number, file) = ((band + 1).to_string(), desk.path().join("band.tif"));
        let status =
            Command::new("gdal_translate").args(["-q", "-b", &number, "rests.tif", "band.tif"]).current_dir(desk.path()).status();
        assert!(status.unwrap().success());
        let raster = DemOptions::default().of_any_unit().read(&file).unwrap();
        let found: Vec<f64> = raster.elevations().map(|share| share.unwrap()).collect();
        let expected = shares_of(&rests);
        for (at, post) in posts.iter().enumerate() {
            assert!((found[at] - expected[at]).abs() < 1e-7, "band {band}, {post:?}: {}, expected {}", found[at], expected[at]);
        }
        assert!((found.iter().sum::<f64>() - rests.len() as f64 / trials).abs() < 1e-5, "band {band} does not add up");
    }
    // The picture's legend counts the cells of each of its bands.
    let picture = desk.read("rests.svg");
    let mut counted = 0;
    let (mut from, mut bands) = (0.0, 0);
    for line in picture.lines().filter(|line| line.contains(" cell") && line.contains("%: ")) {
        let text = line.replace("</text>", "");
        let text = text.rsplit('>').next().unwrap().trim();
        let (range, cells) = text.split_once(" %: ").unwrap();
        let to = range.rsplit(' ').next().unwrap().parse::<f64>().unwrap() / 100.0;
        let held = of_ends.iter().filter(|share| **share > from + 1e-9 && **share <= to + 1e-9).count();
        assert_eq!(cells.split(' ').next().unwrap(), held.to_string(), "{text}");
        (from, bands, counted) = (to, bands + 1, counted + held);
    }
    assert!(
        (1..=7).contains(&bands) && counted == of_ends.iter().filter(|share| **share > 0.0).count(),
        "{bands} bands, {counted}"
    );
    assert!(picture.contains("the area") && picture.contains(&format!("inside the area: {:.4}", share("inside_share"))));
    let picture = desk.run(&["simulate", "chain.toml", "--plot-density", "rests.svg"]);
    assert!(picture.status == 2 && picture.stderr.contains("--plot-density: the landings lie on no DEM"), "{}", picture.stderr);
    let refused = desk.run(&["simulate", "chain.toml", "--density", "rests.tif"]);
    assert!(refused.status == 2 && refused.stderr.contains("lie on no DEM"), "{}", refused.stderr);
    let text = desk.run(&[&map[..], &["--density", "rests.txt"]].concat());
    assert_eq!(text.status, 2, "{}", text.stderr);
}

/// A scenario along a chain and one on a map, with errors.
fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("chain.toml", desk.read("scenario.toml") + ERRORS);
    desk.write("dem.toml", format!("{}{ERRORS}heading_sigma_deg = 1.0\ndrift_across_sigma_m = 0.05\n", desk.read("map.toml")));
    desk
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn halves_merge_to_the_whole() {
    for scenario in ["chain.toml", "dem.toml"] {
        for policy in ["open-loop", "replan"] {
            let desk = desk();
            let flown = |name: &str, first: &str, trials: &str| {
                let (tally, rows) = (format!("{name}.json"), format!("{name}.csv"));
                let words = ["simulate", scenario, "--policy", policy, "--first-trial", first, "--trials", trials];
                let document = desk.json(&[&words[..], &["--tally", &tally, "-o", &rows, "--draws"]].concat());
                let tally: Tally = serde_json::from_str(&desk.read(&tally)).unwrap();
                (tally, desk.read(&rows), document)
            };
            let (whole, all_rows, document) = flown("whole", "0", "900");
            let (first, first_rows, _) = flown("first", "0", "350");
            let (mut merged, last_rows, part) = flown("last", "350", "550");
            assert!(document.get("first_trial").is_none() && part["first_trial"] == 350, "{scenario}, {policy}");
            merged.merge(&first).unwrap();
            let bytes = |tally: &Tally| serde_json::to_string(tally).unwrap();
            assert_eq!(bytes(&merged), bytes(&whole), "{scenario}, {policy}");
            assert_eq!(merged.summary().outcomes.of(TrialOutcome::Reached), document["outcomes"]["reached"].as_u64().unwrap());
            let without_header = last_rows.split_once('\n').unwrap().1;
            assert_eq!(first_rows + without_header, all_rows, "{scenario}, {policy}");
            assert!(merged.merge(&first).is_err(), "no trial counts twice");
        }
    }
}

#[test]
fn merged_parts_are_the_bytes_of_the_single_run() {
    let desk = desk();
    let part = |scenario: &str, name: &str, first: &str, trials: &str| {
        let ran = desk.run(&["simulate", scenario, "--first-trial", first, "--trials", trials, "--tally", name]);
        assert!(ran.status < 2, "{}", ran.stderr);
    };
    for scenario in ["chain.toml", "dem.toml"] {
        part(scenario, "a.json", "0", "300");
        part(scenario, "b.json", "300", "100");
        part(scenario, "c.json", "400", "500");
        let json = ["simulate", scenario, "--format", "json", "--success-min", "0.5"];
        let whole = desk.run(&json);
        // In any order, whatever the number of trials that the scenario of a part stated.
        let merged = desk.run(&[&json[..], &["--merge", "c.json", "a.json", "b.json", "--tally", "all.json"]].concat());
        assert_eq!((merged.status, &merged.stdout), (whole.status, &whole.stdout), "{scenario}: {}", merged.stderr);
        assert_eq!(desk.run(&["simulate", scenario, "--success-min", "0.5", "--tally", "whole.json"]).status, whole.status);
        assert!(desk.read("all.json") == desk.read("whole.json"), "{scenario}");
        let refused = |words: &[&str], said: &str| {
            let ran = desk.run(&[&["simulate", scenario, "--merge"], words].concat());
            assert!(ran.status == 2 && ran.stderr.contains(said), "{words:?}: {}", ran.stderr);
        };
        refused(&["a.json", "c.json"], "the trials 0 to 299, 400 to 899, expected those from 0 to 899");
        refused(&["a.json", "b.json", "c.json", "b.json"], "both tallies have the trials from 300 to 399");
        refused(&["a.json", "b.json", "c.json", "--seed", "5"], "another scenario");
        refused(&["a.json", "b.json", "c.json", "--set", "hopper.clearance_m=0.2"], "another scenario");
        refused(&["scenario.toml"], "this is no tally");
        refused(&["a.json", "--compare"], "--compare");
    }
}

/// Open loop the first hop's command is that of the plan, and what was drawn is what differs from it.
#[test]
fn the_draws_beside_a_landing_are_its_errors() {
    let desk = desk();
    for (scenario, [rest, landing]) in
        [("chain.toml", ["rest_x_m", "landing_x_m"]), ("dem.toml", ["rest_map_x_m", "landing_map_x_m"])]
    {
        let set = "uncertainty.policy=open-loop";
        let hop = desk.json(&["plan", scenario, "--set", set])["path"][0].clone();
        let ran = desk.run(&["simulate", scenario, "--set", set, "-o", "rows.csv", "--draws"]);
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let table = desk.read("rows.csv");
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let headers = reader.headers().unwrap().clone();
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        let of = |row: &csv::StringRecord, name: &str| -> f64 {
            let place = headers.iter().position(|header| header == name).unwrap_or_else(|| panic!("no column {name}"));
            row[place].parse().unwrap()
        };
        let first: Vec<_> = rows.iter().filter(|row| of(row, "hop") == 1.0).collect();
        assert!(first.len() > 100, "{scenario}: {}", first.len());
        let mut frictions = Vec::new();
        for row in first {
            let speed = number(&hop["takeoff_speed_m_s"]) + of(row, "drawn_takeoff_speed_m_s");
            assert!((speed - of(row, "takeoff_speed_m_s")).abs() < 1e-9, "{scenario}: {row:?}");
            let angle = number(&hop["takeoff_angle_deg"]) + of(row, "drawn_takeoff_angle_deg");
            assert!((angle - of(row, "takeoff_angle_deg")).abs() < 1e-9, "{scenario}: {row:?}");
            if scenario == "dem.toml" {
                let heading = number(&hop["heading_deg"]) + of(row, "drawn_heading_deg");
                assert!((heading - of(row, "heading_deg")).abs() < 1e-9, "{row:?}");
            }
            let moved =
                (of(row, rest) - of(row, landing)).hypot(of(row, &rest.replace('x', "y")) - of(row, &landing.replace('x', "y")));
            let drawn = of(row, "drawn_drift_along_m").hypot(of(row, "drawn_drift_across_m"));
            // A landing that ends its trial does not move; elsewhere the ground may be sloped.
            assert!(moved == 0.0 || (moved - drawn).abs() < 0.1 * drawn + 1e-9, "{scenario}: {moved} beside {drawn}");
            assert_eq!([of(row, "drawn_position_x_m"), of(row, "drawn_position_y_m")], [0.0; 2], "open loop asks for no position");
            frictions.push(of(row, "drawn_friction_coefficient"));
        }
        let spread = (frictions.iter().map(|friction| friction * friction).sum::<f64>()
            / f64::from(u32::try_from(frictions.len()).unwrap()))
        .sqrt();
        assert!((spread - 0.02).abs() < 0.003, "{spread}");
    }
}

#[test]
fn a_success_that_is_not_shown_is_the_answer_no() {
    let desk = desk();
    let words = |share: &'static str| ["simulate", "chain.toml", "--trials", "300", "--success-min", share];
    let document = desk.json(&words("0.5"));
    let [low, rate] = [number(&document["success_rate_ci95"][0]), number(&document["success_rate"])];
    // Just below the lower end, between it and the rate, above the rate; with trials that are too few for certainty.
    let beside = |share: f64| format!("{share:.6}");
    for (share, status, sentence) in [
        (beside(low - 1e-4), 0, "is shown: the lower end of the 95 % interval is"),
        (beside(low + 1e-4), 1, "more trials narrow the interval"),
        ("1".to_owned(), 1, "is not shown: the lower end of the 95 % interval is"),
    ] {
        let words = ["simulate", "chain.toml", "--trials", "300", "--success-min", &share];
        let ran = desk.run(&words);
        assert_eq!(ran.status, status, "{share} beside {low} and {rate}: {}", ran.stdout);
        assert!(ran.stdout.contains(&format!("a success of {share} ")) && ran.stdout.contains(sentence), "{share}: {}", ran.stdout);
        let document = desk.json(&words);
        assert_eq!(document["success_min_shown"], json!(status == 0), "{share}");
    }
    assert_eq!(
        desk.run(&["simulate", "chain.toml", "--set", "surface.friction_coefficient=0.05", "--success-min", "0.1"]).status,
        1
    );
    for bad in ["0", "-0.1", "1.01", "nan", "most"] {
        desk.refused(&["simulate", "chain.toml", "--success-min", bad], &["--success-min", "above 0 and at most 1"]);
    }
}

/// What is flown is the path of the result, whatever a search would find.
#[test]
fn a_result_is_flown_as_it_stands() {
    let desk = desk();
    for scenario in ["chain.toml", "dem.toml"] {
        // Another path than that of the scenario, whose search weighs risk.
        let (ignored, traded) = ("search.risk=ignored", "search.risk=traded");
        let written = |name: &str, document: &Value| desk.write(name, serde_json::to_string(document).unwrap());
        let plain = desk.json(&["plan", scenario, "--set", ignored]);
        written("plain.json", &plain);
        assert_eq!(desk.run(&["run", scenario, "--set", ignored, "-o", "out"]).status, 0);
        let flown = desk.json(&["simulate", scenario, "--set", ignored]);
        written("flown.json", &flown);
        let path = |document: &Value| -> Vec<[f64; 3]> {
            let hops = document["path"].as_array().unwrap();
            hops.iter().map(|hop| ["landing_x_m", "takeoff_angle_deg", "takeoff_speed_m_s"].map(|key| number(&hop[key]))).collect()
        };
        assert_ne!(path(&plain), path(&desk.json(&["plan", scenario])), "{scenario}: the test needs two paths");
        for result in ["plain.json", "out/result.json", "flown.json"] {
            // A degree converted to radians and back loses its last digit; outcomes do not hang on that.
            let of_result = desk.json(&["simulate", result]);
            assert_eq!((&of_result["outcomes"], path(&of_result)), (&flown["outcomes"], path(&plain)), "{scenario}: {result}");
            // Keys of the search do not plan anew.
            let other = desk.json(&["simulate", result, "--set", traded, "--set", "uncertainty.policy=open-loop"]);
            assert_eq!(path(&other), path(&plain), "{scenario}: {result}");
        }
        let anew = desk.json(&["simulate", "plain.json", "--set", traded, "--plan-anew"]);
        assert_eq!(path(&anew), path(&desk.json(&["plan", "plain.json", "--set", traded])), "{scenario}");
        let mut spoiled = plain.clone();
        spoiled["path"][0]["takeoff_speed_m_s"] = json!(number(&plain["path"][0]["takeoff_speed_m_s"]) * 1.01);
        written("spoiled.json", &spoiled);
        let mut short = plain.clone();
        short["path"].as_array_mut().unwrap().pop();
        written("short.json", &short);
        written("check.json", &desk.json(&["check", scenario]));
        let mut broken = plain.clone();
        broken["path"][0]["landing_x_m"] = json!("far");
        written("broken.json", &broken);
        let mut off = plain.clone();
        off["path"][0]["takeoff_x_m"] = json!(-500.0);
        written("off.json", &off);
        let anew = "--plan-anew plans its scenario anew";
        for (words, parts) in [
            (&["simulate", "spoiled.json"][..], &["spoiled.json: the path of the result does not hold", "hop 1", anew][..]),
            (&["simulate", "plain.json", "--set", "hopper.takeoff_speed_max_m_s=1"], &["does not hold", "hop 1", anew]),
            (&["simulate", "plain.json", "--goal", "9"], &["does not hold", anew]),
            (&["simulate", "short.json"], &["hops, but its path has", anew]),
            (&["simulate", "check.json"], &["found a document of chta/check/1, expected one of plan, run or simulate", anew]),
            (&["simulate", "broken.json"], &["path is not as results have it", anew]),
            (&["simulate", "off.json"], &["hop 1 of the result: x = -500 m is off the chain", anew]),
            (&["simulate", scenario, "--plan-anew"], &["--plan-anew", "is no result", "omit it"]),
        ] {
            if words.contains(&"--goal") && scenario == "dem.toml" {
                continue;
            }
            desk.refused(words, parts);
        }
        // A file that has changed since.
        let ground = if scenario == "chain.toml" { "chain.csv" } else { "ground.tif" };
        if scenario == "chain.toml" {
            desk.write(ground, desk.read(ground).replace("10,2\n", "10,2.001\n"));
        } else {
            assert_eq!(desk.run(&["synth", "--rows", "20", "--cols", "20", "--seed", "9", "-o", ground]).status, 0);
        }
        desk.refused(
            &["simulate", "plain.json"],
            &[&format!("the result was made with {ground} of SHA-256 "), "that name now has", anew],
        );
    }
}

/// A machine whose headings come in steps flies beside the line: such a path is read back as well.
#[test]
fn a_result_beside_the_line_or_in_steps_is_flown_as_it_stands() {
    let desk = desk();
    for steps in [&["hopper.takeoff_speed_step_m_s=0.05", "hopper.takeoff_angle_step_deg=1"][..], &["hopper.heading_step_deg=3"]] {
        let set: Vec<&str> = steps.iter().flat_map(|key| ["--set", key]).collect();
        let flown = desk.json(&[&["simulate", "dem.toml", "--policy", "open-loop"], &set[..]].concat());
        assert_eq!(flown["verdict"], "traversable", "{steps:?}");
        assert!(flown["path"][0].get("aim_x_m").is_some(), "{steps:?}: {}", flown["path"][0]);
        desk.write("steps.json", serde_json::to_string(&flown).unwrap());
        let again = desk.json(&["simulate", "steps.json"]);
        assert_eq!((&again["outcomes"], &again["path"]), (&flown["outcomes"], &flown["path"]), "{steps:?}");
    }
}

#[test]
fn a_result_without_a_path_is_the_answer_no() {
    let desk = desk();
    let none = desk.json(&["plan", "chain.toml", "--set", "surface.friction_coefficient=0.05"]);
    desk.write("none.json", serde_json::to_string(&none).unwrap());
    let ran = desk.run(&["simulate", "none.json"]);
    assert!(ran.status == 1 && ran.stdout.contains("nothing to simulate: there is no nominal path"), "{ran:?}");
}
