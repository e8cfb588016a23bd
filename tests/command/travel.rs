//! Missions that drive and hop, from the command.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use serde_json::Value;

use crate::desk::{Desk, chta};

const SHIPPED: &str = "data/drive/mars_rover.toml";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn json(arguments: &[&str]) -> (i32, Value) {
    let words: Vec<&str> = arguments.iter().copied().chain(["--format", "json", "--quiet"]).collect();
    let (status, stdout, stderr) = chta(root(), &words);
    (status, serde_json::from_str(&stdout).unwrap_or_else(|_| panic!("{arguments:?}: {stderr}")))
}

/// A step of 1.5 m across a floor, 12 posts each way: only hops pass it, and only wheels are cheap on the floor.
fn desk() -> Desk {
    let desk = Desk::new();
    let rows: Vec<String> =
        (0..12).map(|_| (0..24).map(|col| if col < 12 { "0" } else { "1.5" }).collect::<Vec<_>>().join(" ")).collect();
    desk.write("step.asc", format!("ncols 24\nnrows 12\nxllcenter 0\nyllcenter 0\ncellsize 1\n{}\n", rows.join("\n")));
    desk.write("step.toml", STEP);
    desk
}

const STEP: &str = "[body]\ngravity_m_s2 = 1.62\n[hopper]\ntakeoff_speed_max_m_s = 3\nlanding_speed_max_m_s = 3\nmass_kg = 5\n\
    preparation_time_s = 100\nsettling_time_s = 7\n[surface]\nfriction_coefficient = 0.8\n[terrain]\ndem = \"step.asc\"\nstart_m = [1, 5]\n\
    goal_m = [22, 5]\nroute = \"free\"\n[search]\nnode_spacing_max_m = 1\n[drive]\nspeed_m_s = 0.5\nslope_up_max_deg = 20\nidle_power_w = 10\n\
    rolling_resistance = 0.1\n";

#[test]
fn the_commands_of_the_document_run() {
    let document = std::fs::read_to_string(root().join("docs/drive.md")).unwrap();
    let block = document.split("```sh\n").nth(1).unwrap().split("```").next().unwrap();
    let desk = Desk::new();
    let commands: Vec<&str> = block.lines().filter(|line| line.starts_with("chta ")).collect();
    assert!(commands.len() >= 5, "{commands:?}");
    for command in commands {
        let in_folder = |word: &str| match word {
            "mission.svg" | "where.svg" | "time.tif" => desk.path().join(word).display().to_string(),
            "mission-time=time.tif" => format!("mission-time={}", desk.path().join("time.tif").display()),
            other => other.to_owned(),
        };
        let words: Vec<String> = command.split_whitespace().skip(1).map(in_folder).chain(["--quiet".to_owned()]).collect();
        let (status, stdout, stderr) = chta(root(), &words.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(status == 0 && stderr.is_empty() && !stdout.is_empty(), "{command}: {stderr}");
    }
    for file in ["mission.svg", "where.svg", "time.tif"] {
        assert!(desk.path().join(file).is_file(), "{file}");
    }
}

/// Start, step and goal are planted: what is driven, what is hopped, and what it takes can be checked by hand.
#[test]
fn wheels_on_the_floor_and_one_hop_over_the_step() {
    let desk = desk();
    let ran = desk.run(&["plan", "step.toml", "--format", "json", "--quiet", "--alternatives"]);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let answer: Value = serde_json::from_str(&ran.stdout).unwrap();
    let kinds: Vec<&str> = answer["path"].as_array().unwrap().iter().map(|leg| leg["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["drive", "hop", "drive"], "{}", ran.stdout);
    let totals = &answer["totals"];
    let number = |value: &Value| value.as_f64().unwrap();
    let hop = &answer["path"][1];
    let driven_m: f64 = [0, 2].iter().map(|leg| number(&answer["path"][*leg]["length_m"])).sum();
    let time_s = driven_m / 0.5 + 100.0 + number(&hop["flight_time_s"]) + 7.0;
    assert!((number(&totals["mission_time_s"]) - time_s).abs() < 1e-6, "{totals} {time_s}");
    // The wheels take g c_rr per metre, and 10 W over 5 kg.
    let speed_m_s = number(&hop["takeoff_speed_m_s"]);
    let energy_j_kg = driven_m * (0.162 + 2.0 / 0.5) + 0.5 * speed_m_s * speed_m_s;
    assert!((number(&totals["energy_j_kg"]) - energy_j_kg).abs() < 1e-6, "{totals} {energy_j_kg}");
    assert_eq!((answer["hops_lower_bound"].as_u64(), answer["verified"].as_bool()), (Some(0), Some(true)));
    let by = |travel: &str| answer["alternatives"].as_array().unwrap().iter().find(|row| row["travel"] == travel).unwrap().clone();
    assert!(by("drive")["totals"].is_null() && by("hop")["totals"]["hops"].as_u64().unwrap() > 1);
    // The same over 8 neighbours is no shorter.
    let eight = desk.run(&["plan", "step.toml", "--format", "json", "--quiet", "--set", "drive.neighbours=8"]);
    let eight: Value = serde_json::from_str(&eight.stdout).unwrap();
    assert!(number(&eight["totals"]["mission_time_s"]) >= time_s - 1e-9);
}

/// Lines of drive legs, arcs of hops and their contacts, each with the numbers of its leg.
#[test]
fn a_mission_is_written_as_geojson() {
    let desk = desk();
    let ran = desk.run(&["plan", "step.toml", "--quiet", "--format", "json", "--geojson", "mission.geojson"]);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let answer: Value = serde_json::from_str(&ran.stdout).unwrap();
    let written: Value = serde_json::from_str(&desk.read("mission.geojson")).unwrap();
    let features = written["features"].as_array().unwrap();
    let kinds: Vec<&str> = features.iter().map(|feature| feature["properties"]["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["drive", "hop", "contact", "contact", "drive"], "{written}");
    for (feature, leg) in [(0, 0), (1, 1), (4, 2)] {
        let (feature, leg) = (&features[feature], &answer["path"][leg]);
        assert_eq!(feature["properties"]["time_s"], leg["time_s"]);
        assert!(feature["properties"].as_object().unwrap().values().all(|value| !value.is_object() && !value.is_array()));
        let line = feature["geometry"]["coordinates"].as_array().unwrap();
        for (end, key) in [(&line[0], "takeoff_m"), (&line[line.len() - 1], "landing_m")] {
            for axis in 0..3 {
                let [drawn, stated] = [end, &leg[key]].map(|place| place[axis].as_f64().unwrap());
                assert!((drawn - stated).abs() < 1e-9, "{end} {key}");
            }
        }
    }
    assert!(features[0]["properties"]["margin_slope_up_deg"].is_number());
}

/// The memory is stated before the search, is never exceeded by what is allowed, and too little is refused.
#[test]
fn the_memory_of_a_mission_is_stated_and_limited() {
    let desk = desk();
    let sized = |more: &[&str]| desk.run(&[&["plan", "step.toml", "--quiet", "--format", "json", "--dry-run"], more].concat());
    let bytes = |text: &str| {
        let size: Value = serde_json::from_str(text).unwrap();
        let parts = size["memory"].as_array().unwrap();
        parts.iter().map(|part| part["bytes_max"].as_u64().unwrap()).sum::<u64>()
    };
    let free = sized(&[]);
    assert_eq!(free.status, 0, "{}", free.stderr);
    let within = sized(&["--memory-max-mib", "3"]);
    assert!(bytes(&within.stdout) <= 3 << 20 && bytes(&free.stdout) > 3 << 20, "{} {}", within.stdout, free.stdout);
    // What fits into less has the same answer.
    let times = [&["--memory-max-mib", "3"][..], &[]].map(|more| {
        let ran = desk.run(&[&["plan", "step.toml", "--quiet", "--format", "json"], more].concat());
        serde_json::from_str::<Value>(&ran.stdout).unwrap()["totals"]["mission_time_s"].as_f64().unwrap()
    });
    assert!((times[0] - times[1]).abs() < 1e-9, "{times:?}");
    // A map keeps the totals of every node for each means, and one more for the way back.
    let of_map = |more: &[&str]| {
        let ran = desk.run(&[&["map", "step.toml", "--quiet", "--format", "json", "--dry-run"], more].concat());
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        ran.stdout
    };
    assert!(
        of_map(&["--return"]).contains("totals of all nodes, 4 times") && bytes(&of_map(&["--memory-max-mib", "3"])) <= 3 << 20
    );
    let hops = [&["--memory-max-mib", "3"][..], &[]].map(|more| {
        let ran = desk.run(&[&["map", "step.toml", "--quiet", "--format", "json"], more].concat());
        serde_json::from_str::<Value>(&ran.stdout).unwrap()["reached"].clone()
    });
    assert_eq!(hops[0], hops[1]);
    for command in ["plan", "map"] {
        let (status, _, stderr) = chta(root(), &[command, SHIPPED, "--quiet", "--memory-max-mib", "1"]);
        assert!(status == 2 && stderr.contains("expected at most 1 MiB"), "{command}: {stderr}");
        // The remedy helps.
        let enough = stderr.rsplit("--memory-max-mib ").next().unwrap().trim();
        let (status, _, stderr) = chta(root(), &[command, SHIPPED, "--quiet", "--memory-max-mib", enough]);
        assert_ne!(status, 2, "{command} --memory-max-mib {enough}: {stderr}");
    }
}

/// Row by row more hops take less time, and the last row is the plan.
#[test]
fn a_front_of_missions_ends_with_the_plan() {
    let (status, answer) = json(&["plan", SHIPPED, "--front", "hops,mission-time"]);
    assert_eq!(status, 0);
    let rows: Vec<(u64, f64)> = answer["front"]["paths"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| (row["hops"].as_u64().unwrap(), row["mission_time_s"].as_f64().unwrap()))
        .collect();
    assert!(rows.len() > 5 && rows.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1), "{rows:?}");
    let plan = answer["totals"]["mission_time_s"].as_f64().unwrap();
    assert!((rows[rows.len() - 1].1 - plan).abs() < 1e-9 * plan, "{rows:?} {plan}");
}

#[test]
fn a_no_says_where_it_stopped_and_by_which_limits() {
    let desk = desk();
    let ran = desk.run(&["plan", "step.toml", "--set", "drive.travel=drive", "--quiet"]);
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    for words in ["no-path-found", "does not prove that no path exists", "refused by slope-up"] {
        assert!(ran.stdout.contains(words), "{words}: {}", ran.stdout);
    }
}

#[test]
fn maps_state_what_each_means_reaches() {
    let desk = desk();
    let map = ["map", "step.toml", "--format", "json", "--quiet", "--return", "-o", "hops.tif", "--plot", "where.svg"];
    let ran = desk.run(&map);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let answer: Value = serde_json::from_str(&ran.stdout).unwrap();
    let reached = |travel: &str| {
        let rows = answer["reached"].as_array().unwrap();
        rows.iter().find(|row| row["travel"] == travel).unwrap()["reached_nodes"].as_u64().unwrap()
    };
    // The lower floor, up to the foot of the step.
    assert_eq!((reached("drive"), reached("both")), (144, 288), "{answer}");
    assert_eq!(answer["there_and_back_nodes"].as_u64(), Some(288));
    assert_eq!(answer["goals"][0]["totals"]["hops"].as_u64(), Some(1));
    assert!(desk.read("where.svg").contains("not by driving alone"));
}

#[test]
fn trials_of_wheels_without_errors_arrive_and_failures_end_them() {
    let (status, exact) = json(&[
        "simulate",
        SHIPPED,
        "--set",
        "drive.travel=drive",
        "--trials",
        "40",
        "--set",
        "drive.heading_sigma_deg=0",
        "--set",
        "drive.length_sigma_fraction=0",
        "--set",
        "drive.failure_per_m=0",
        "--policy",
        "open-loop",
    ]);
    assert_eq!((status, exact["simulation"]["success_rate"].as_f64()), (0, Some(1.0)), "{}", exact["simulation"]);
    let (_, failing) = json(&[
        "simulate",
        SHIPPED,
        "--set",
        "drive.travel=drive",
        "--trials",
        "400",
        "--set",
        "drive.heading_sigma_deg=0",
        "--set",
        "drive.length_sigma_fraction=0",
        "--set",
        "drive.failure_per_m=0.01",
        "--policy",
        "open-loop",
    ]);
    let stated = failing["totals"]["drive_success"].as_f64().unwrap();
    let [low, high] = [0, 1].map(|end| failing["simulation"]["success_ci95"][end].as_f64().unwrap());
    assert!(low <= stated && stated <= high, "{stated} is stated, {low} to {high} shown");
}

#[test]
fn wrong_wheels_are_refused_with_a_remedy() {
    let desk = desk();
    let rows = [
        ("drive.slope_up_max_deg = 20\n", "", "add slope_up_max_deg"),
        ("slope_up_max_deg = 20", "slope_up_max_deg = 120", "expected an angle from 0 to 90 degrees, or inf"),
        ("speed_m_s = 0.5", "speed_m_s = 0", "drive.speed_m_s"),
        ("mass_kg = 5\n", "", "add hopper.mass_kg, or remove idle_power_w"),
        ("slope_up_max_deg = 20", "slope_up_max_deg = 20\nstep_max_m = 0.1", "add wheelbase_m, or remove step_max_m"),
        ("slope_up_max_deg = 20", "slope_up_max_deg = 20\nneighbours = 12", "expected 8, 16 or 32"),
        ("slope_up_max_deg = 20", "slope_up_max_deg = 20\nslip = [[0.0, 1.0]]", "drive.slip"),
        ("route = \"free\"\n", "", "add route = \"free\" to [terrain], or remove [drive]"),
        ("[search]\n", "[search]\nrisk = \"traded\"\n", "set drive.travel = \"hop\""),
    ];
    for (found, planted, sentence) in rows {
        let text =
            if found.starts_with("drive.") { STEP.replace("slope_up_max_deg = 20\n", "") } else { STEP.replace(found, planted) };
        assert_ne!(text, STEP, "{found}");
        desk.write("wrong.toml", text);
        let ran = desk.run(&["plan", "wrong.toml", "--quiet"]);
        assert!(ran.status == 2 && ran.stderr.contains(sentence), "{planted}: {}", ran.stderr);
    }
    for (words, sentence) in [
        (&["check", "step.toml"][..], "set drive.travel = \"hop\""),
        (&["plan", "step.toml", "--prove"], "--prove: found this option"),
        (&["map", "step.toml", "--mobility", "m.tif"], "--mobility: found this option"),
        (&["simulate", "step.toml", "--tally", "t.json"], "--tally: found this option"),
        (&["plan", "step.toml", "--set", "drive.travel=hop", "--alternatives"], "set drive.travel"),
    ] {
        let ran = desk.run(&[words, &["--quiet"]].concat());
        assert!(ran.status == 2 && ran.stderr.contains(sentence), "{words:?}: {}", ran.stderr);
    }
}
