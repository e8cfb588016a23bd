//! `uncertainty.errors`: a file of measured errors beside its scenario.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

use std::fmt::Write as _;

use crate::desk::Desk;

const SCENARIO: &str = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 8\nlanding_speed_max_m_s = 8\n[surface]\n\
    friction_coefficient = 1.2\n[terrain]\nchain = \"../flat.csv\"\nstart_x_m = 20\ngoal_x_m = 60\n[uncertainty]\n\
    goal_tolerance_m = 2\ntrials = 200\npolicy = \"open-loop\"\n";

/// A scenario in a folder of its own, its measured errors beside it, and the chain above.
fn desk(errors: &str) -> Desk {
    let desk = Desk::new();
    desk.write("flat.csv", "x_m,z_m\n-50,0\n150,0\n");
    std::fs::create_dir(desk.path().join("sub")).unwrap();
    desk.write("sub/measured.csv", errors);
    desk.write("sub/measured.toml", format!("{SCENARIO}errors = \"measured.csv\"\n"));
    desk
}

/// Rows of a test stand.
fn rows(count: u32) -> String {
    (0..count).fold("run,takeoff_speed_error_fraction,takeoff_angle_error_deg\n".to_owned(), |mut text, i| {
        let _ = writeln!(text, "{i},{},{}", f64::from(i * 37 % 101) * 2e-4 - 0.01, f64::from(i * 53 % 97) * 0.01 - 0.48);
        text
    })
}

#[test]
fn measured_errors_are_flown_recorded_and_read_back() {
    let desk = desk(&rows(150));
    let answer = desk.json(&["simulate", "sub/measured.toml"]);
    let rate = answer["success_rate"].as_f64().unwrap();
    assert!(rate > 0.3 && rate <= 1.0, "{answer}");
    let errors = answer["landings"][0]["mean_m"].as_f64().unwrap();
    assert!(errors > 0.0, "{answer}");
    let inputs: Vec<&str> = answer["inputs"].as_array().unwrap().iter().filter_map(|input| input["name"].as_str()).collect();
    assert!(inputs.contains(&"sub/measured.csv"), "{inputs:?}");
    assert_eq!(answer["scenario"]["uncertainty"]["errors"], "sub/measured.csv");
    let warnings = answer["warnings"].to_string();
    assert!(warnings.contains("unknown column `run` is ignored") && !warnings.contains("rows, which"), "{warnings}");
    // The result reads back as a scenario, and a chain beside the scenario finds the same file.
    desk.write("again.json", answer.to_string());
    let again = desk.json(&["simulate", "again.json"]);
    assert_eq!(again["outcomes"], answer["outcomes"]);
    // The commands are those of the result as written: equal but for the last digit of an angle.
    let means = |answer: &serde_json::Value| -> Vec<f64> {
        answer["landings"].as_array().unwrap().iter().map(|landing| landing["mean_m"].as_f64().unwrap()).collect()
    };
    let (one, other) = (means(&again), means(&answer));
    assert!(one.len() == other.len() && one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-9), "{one:?} {other:?}");
    let ends = ["--start", "20", "--goal", "60"];
    let beside = desk.json(&[&["simulate", "flat.csv", "--scenario", "sub/measured.toml"][..], &ends].concat());
    assert_eq!(beside["outcomes"], answer["outcomes"]);
    // The plan is estimated with them: least speed is not what it chooses.
    let planned = desk.json(&["plan", "sub/measured.toml"]);
    assert_eq!(planned["scenario"]["search"]["takeoff_angle"], "most-reliable");
}

#[test]
fn bad_files_and_contradictions_end_with_the_place_and_the_way_out() {
    let cases: [(&str, &str, &[&str]); 7] = [
        ("drift_along_m\n0.1\nfar\n,\n", "", &["measured.csv", "line 3", "far", "line 4", "2 fields"]),
        ("drift_along_m\n", "", &["measured.csv", "no row below the header", "expected at least 1 hop"]),
        (
            "takeoff_angle_error_deg,drift_along_m\n1,1\n",
            "takeoff_angle_sigma_deg = 1\ndrift_along_sigma_m = 0.5\n",
            &[
                "measured.csv: uncertainty.takeoff_angle_sigma_deg is 1 deg",
                "column takeoff_angle_error_deg",
                "measured.csv: uncertainty.drift_along_sigma_m is 0.5 m",
                "column drift_along_m",
                "remove the key, or the column",
            ],
        ),
        ("takeoff_speed_error_km_h\n1\n", "", &["in km/h", "column takeoff_speed_error_m_s"]),
        ("a,b\n1,2\n", "", &["a header without an error", "takeoff_speed_error_fraction"]),
        ("start_x_m,goal_x_m\n1,2\n", "", &["this is a CSV of pairs", "as uncertainty.errors"]),
        ("takeoff_angle_error_deg\n1\n", "distribution = \"even\"\n", &["uncertainty.distribution", "normal, uniform"]),
    ];
    for (errors, keys, parts) in cases {
        let desk = desk(errors);
        desk.write("sub/measured.toml", format!("{SCENARIO}errors = \"measured.csv\"\n{keys}"));
        for command in ["simulate", "plan"] {
            desk.refused(&[command, "sub/measured.toml"], parts);
        }
    }
}

#[test]
fn few_rows_and_errors_beyond_sense_are_warned_of() {
    let warned = |errors: &str, keys: &str| {
        let desk = desk(errors);
        desk.write("sub/measured.toml", format!("{SCENARIO}errors = \"measured.csv\"\n{keys}"));
        desk.json(&["simulate", "sub/measured.toml"])["warnings"].to_string()
    };
    let cases: [(&str, &str, &str); 5] = [
        ("takeoff_angle_error_deg\n1\n-1\n", "", "errors has 2 rows, which trials and estimates fly over and over"),
        ("takeoff_speed_error_fraction\n2\n-0.1\n", "", "takeoff_speed_error_fraction of 2 in size"),
        ("takeoff_angle_error_deg,heading_error_deg\n1,1\n", "", "have no effect along a chain"),
        ("drift_along_m\n0.1\n", "takeoff_speed_bias_sigma_fraction = 2\n", "takeoff_speed_bias_sigma_fraction is 2, over 0.5"),
        ("drift_along_m\n0.1\n", "takeoff_angle_bias_sigma_deg = 60\n", "takeoff_angle_bias_sigma_deg is 60, over 45 deg"),
    ];
    for (errors, keys, part) in cases {
        let warnings = warned(errors, keys);
        assert!(warnings.contains(part), "{part}: {warnings}");
    }
    assert!(!warned(&rows(100), "").contains("rows, which"));
}
