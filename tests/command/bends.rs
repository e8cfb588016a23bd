//! A path around an obstacle, along a polyline.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{fs, path::Path, process::Output};

use assert_cmd::Command;
use chta::terrain::write_ascii_grid;
use serde_json::Value;

use crate::tower::tower;

fn chta(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("chta").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)))
}

#[test]
fn a_polyline_leads_around_the_tower_and_the_run_repeats() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_ascii_grid(&tower(), fs::File::create(at.join("tower.asc")).unwrap()).unwrap();
    let scenario = |via: &str| {
        format!(
            "[body]\ngravity_m_s2 = 2.0\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n[surface]\n\
             friction_coefficient = 0.8\n[terrain]\ndem = \"tower.asc\"\nstart_m = [5, 30]\ngoal_m = [55, 30]\n{via}\n[search]\n\
             points_per_segment = 1\n"
        )
    };
    fs::write(at.join("through.toml"), scenario("")).unwrap();
    fs::write(at.join("around.toml"), scenario("via_m = [[5, 5], [55, 5]]")).unwrap();
    assert_eq!(chta(at, &["check", "through.toml"]).status.code(), Some(1), "the tower is too high");
    let document = json(&chta(at, &["plan", "around.toml", "--verify", "--format", "json"]));
    assert_eq!(document["verified"], true, "{document}");
    assert!(document["refusals"]["bend"].as_u64().unwrap() > 0);
    let corners = [25.0, 75.0];
    let mut headings = Vec::new();
    for hop in document["path"].as_array().unwrap() {
        let number = |key: &str| hop[key].as_f64().unwrap();
        assert!(!corners.iter().any(|&x| number("takeoff_x_m") < x && x < number("landing_x_m")), "{hop}");
        headings.push(number("heading_deg"));
        let flown = libm::hypot(
            number("landing_map_x_m") - number("takeoff_map_x_m"),
            number("landing_map_y_m") - number("takeoff_map_y_m"),
        );
        assert!((flown - (number("landing_x_m") - number("takeoff_x_m"))).abs() < 1e-9);
    }
    headings.dedup();
    assert_eq!(headings, [180.0, 90.0, 0.0], "south, east, north");
    let hop = json(&chta(at, &["hop", "around.toml", "--from", "20", "--to", "30", "--format", "json"]));
    assert_eq!((&hop["feasible"], &hop["binding"]["conflict"][0]), (&Value::Bool(false), &Value::from("bend")), "{hop}");
    assert_eq!(chta(at, &["run", "around.toml", "-o", "out"]).status.code(), Some(0));
    assert_eq!(chta(at, &["run", "out/result.json", "-o", "again"]).status.code(), Some(0));
    let read = |name: &str| fs::read_to_string(at.join(name)).unwrap();
    assert_eq!(read("out/result.json"), read("again/result.json"));
    assert_eq!(read("out/path.csv"), read("again/path.csv"));
    // Both forms of the bends give the same chain, and the chain file alone stores them.
    let sliced = chta(
        at,
        &["slice", "tower.asc", "--from", "5,30", "--to", "55,30", "--via", "5,5", "--via", "55,5", "--scenario", "around.toml"],
    );
    let rows = |text: &str| text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(rows(&String::from_utf8_lossy(&sliced.stdout)), rows(&read("out/chain.csv")));
    fs::write(at.join("bare.toml"), scenario("").replace("dem = \"tower.asc\"\nstart_m = [5, 30]\ngoal_m = [55, 30]\n", ""))
        .unwrap();
    let by_chain = json(&chta(
        at,
        &["check", "out/chain.csv", "--scenario", "bare.toml", "--start", "0", "--goal", "100", "--format", "json"],
    ));
    assert_eq!(by_chain["hops"], document["hops"]);
}
