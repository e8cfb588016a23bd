//! `chta simulate` where the heading is not controlled, through the command.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// Level ground of 61 by 61 posts, 1 m apart, and a start at its middle: one hop of `v^2 / g` is 10 m.
const DRIFT: &str = "[body]\ngravity_m_s2 = 0.01\n[hopper]\ntakeoff_speed_max_m_s = 1\nlanding_speed_max_m_s = 1\n\
    [surface]\nfriction_coefficient = 1.2\n[terrain]\ndem = \"level.asc\"\nstart_m = [30, 30]\n\
    [uncertainty]\nheading = \"uncontrolled\"\ntakeoff_speed_m_s = 0.316227766\ntakeoff_angle_deg = 45\nhop_limit = 2\ntrials = 900\n";

fn desk() -> Desk {
    let desk = Desk::new();
    let row = ["0"; 61].join(" ");
    desk.write("level.asc", format!("ncols 61\nnrows 61\nxllcenter 0\nyllcenter 0\ncellsize 1\n{}", format!("{row}\n").repeat(61)));
    desk.write("drift.toml", DRIFT);
    let square = "{\"type\": \"Polygon\", \"coordinates\": [[[20, 20], [40, 20], [40, 40], [20, 40], [20, 20]]]}";
    desk.write("area.geojson", square);
    desk
}

fn of(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} in {value}"))
}

#[test]
fn the_answer_has_the_circle_the_share_inside_an_area_and_repeats_itself() {
    let desk = desk();
    let words = ["simulate", "drift.toml", "--density", "rests.tif", "--within", "area.geojson", "--plot-density", "rests.svg"];
    let text = desk.run(&words);
    assert_eq!(text.status, 0, "{}", text.stderr);
    assert!(text.stdout.contains("900 of 900 trials fly all hops") && text.stdout.contains("inside the area: "), "{}", text.stdout);
    let json = desk.run(&[&words[..], &["--format", "json"]].concat());
    desk.write("result.json", &json.stdout);
    let answer: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!((&answer["schema"], &answer["outcomes"]["reached"]), (&"chta/simulate-drift/1".into(), &900.into()));
    let first = &answer["landings"][0];
    // Quantiles are those of bins.
    assert!(
        (of(first, "q05_m") - 10.0).abs() < 0.03
            && (of(first, "mean_m") - 10.0).abs() < 1e-6
            && (of(first, "max_m") - 10.0).abs() < 1e-6,
        "{first}"
    );
    // Twice the same step in any two directions: E d^2 = 2 R^2, of which the mean is 4 R / pi.
    assert!((of(&answer["landings"][1], "mean_m") - 40.0 / std::f64::consts::PI).abs() < 0.8, "{answer}");
    let density = &answer["density"];
    assert_eq!((of(density, "on_ground_share"), &density["hops_counted"]), (1.0, &2.into()));
    assert!(
        (of(density, "inside_share") - 0.42).abs() < 0.1 && desk.read("rests.svg").contains("2 hops in any direction"),
        "{density}"
    );
    assert!(answer["scenario"]["terrain"].get("goal_m").is_none() && answer["scenario"]["uncertainty"].get("policy").is_none());
    // The document is a scenario, whose answer it is.
    let again = desk.run(&[&["simulate", "result.json"], &words[2..], &["--format", "json"]].concat());
    assert_eq!(again.status, 0, "{}", again.stderr);
    let again: Value = serde_json::from_str(&again.stdout).unwrap();
    assert!(again["landings"] == answer["landings"] && again["scenario"] == answer["scenario"]);
    // A friction that does not hold 45 degrees lets none take off.
    let slides = desk.run(&["simulate", "drift.toml", "--set", "surface.friction_coefficient=0.9", "--success-min", "0.5"]);
    assert!(
        slides.status == 1
            && slides.stdout.contains("slid-at-takeoff at hop 1: 900") | slides.stdout.contains("slid_at_takeoff at hop 1: 900"),
        "{}",
        slides.stdout
    );
}

#[test]
fn what_does_not_go_with_it_is_refused_and_mended_as_the_message_says() {
    let desk = desk();
    let refused = |words: &[&str], said: &[&str]| {
        let ran = desk.run(words);
        assert!(ran.status == 2 && said.iter().all(|said| ran.stderr.contains(said)), "{words:?}: {}", ran.stderr);
    };
    for option in [
        &["--compare"][..],
        &["--plot", "a.svg"],
        &["--plot-map", "a.svg"],
        &["--output", "a.csv"],
        &["--tally", "a.json"],
        &["--merge", "a.json"],
        &["--experiment", "sensitivity"],
        &["--trajectory", "a.csv"],
    ] {
        refused(&[&["simulate", "drift.toml"], option].concat(), &[option[0], "there is no path: leave the option out"]);
    }
    for question in ["plan", "check", "run"] {
        let mut words = vec![question, "drift.toml"];
        if question == "run" {
            words.extend(["-o", "out"]);
        }
        refused(&words, &["uncertainty.heading = \"uncontrolled\"", "expected it for trials alone"]);
    }
    refused(&["require", "drift.toml", "--vary", "hopper.takeoff_speed_max_m_s"], &["expected it for trials alone"]);
    refused(&["trade", "drift.toml", "--vary", "hopper.takeoff_speed_max_m_s=0.5:1:2"], &["expected it for trials alone"]);
    for key in [
        "terrain.goal_m=[40, 30]",
        "uncertainty.policy=replan",
        "uncertainty.heading_sigma_deg=1",
        "uncertainty.goal_tolerance_m=1",
    ] {
        refused(
            &["simulate", "drift.toml", "--set", key],
            &["has no meaning beside uncertainty.heading", key.split('=').next().unwrap()],
        );
    }
    // All that is missing at once, and what the messages say mends it.
    desk.write(
        "bare.toml",
        DRIFT
            .lines()
            .filter(|line| !line.contains("takeoff_speed_m_s =") && !line.contains("angle") && !line.contains("hop_limit"))
            .collect::<Vec<_>>()
            .join("\n"),
    );
    let missing = ["add takeoff_speed_m_s = 1.0", "add takeoff_angle_deg = 45.0", "add hop_limit = 5"];
    refused(&["simulate", "bare.toml"], &missing);
    let mended: Vec<String> =
        missing.iter().map(|said| format!("uncertainty.{}", said.trim_start_matches("add ").replace(' ', ""))).collect();
    let sets: Vec<&str> = mended.iter().flat_map(|set| ["--set", set]).collect();
    assert_eq!(desk.run(&[&["simulate", "bare.toml"], &sets[..]].concat()).status, 0);
    let controlled = ["simulate", "drift.toml", "--set", "uncertainty.heading=controlled", "--set", "terrain.goal_m=[40, 30]"];
    refused(&controlled, &["uncertainty.takeoff_speed_m_s is the command of a robot whose heading is not controlled"]);
    refused(&["simulate", "drift.toml", "--set", "terrain.start_m=[99, 0]"], &["(99", "give a place on it"]);
    // What is about plans alone says so; without any such key there is nothing to say.
    for key in ["search.risk=ignored", "budget.hops_max=3", "hopper.apex_height_max_m=0.1", "derating.friction=0.5"] {
        let ran = desk.run(&["simulate", "drift.toml", "--set", key]);
        let said = format!("{} has no effect where uncertainty.heading", key.split('=').next().unwrap());
        assert!(ran.status == 0 && ran.stderr.contains(&said), "{key}: {}", ran.stderr);
    }
    assert_eq!(desk.run(&["simulate", "drift.toml"]).stderr, "");
}
