//! `chta stance` and plans of robots with legs: answers, what is refused, and with which sentence; and the console blocks of docs/legs.md.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use crate::desk::{Desk, FOUR_LEGS, chta};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_rose_has_three_cones_each_inside_the_next() {
    let desk = Desk::new();
    desk.write("contacts.csv", "normal_x,normal_y,normal_z,friction_coefficient\n# a floor and a wall\n0,0,1,0.75\n1,0,0,0.75\n");
    let document = desk.json(&["stance", "--contacts", "contacts.csv", "--headings", "8"]);
    assert_eq!((&document["stands"], &document["force_closure"]), (&true.into(), &false.into()));
    let rose = document["rose"].as_array().unwrap();
    assert_eq!(rose.len(), 8);
    let ends = |row: &serde_json::Value, cone: &str| {
        let angles = row[cone].as_object()?;
        Some([angles["takeoff_angle_min_deg"].as_f64().unwrap(), angles["takeoff_angle_max_deg"].as_f64().unwrap()])
    };
    for row in rose {
        for pair in [["kc", "kc_plus"], ["kc_plus", "k"]] {
            let Some([low, high]) = ends(row, pair[0]) else { continue };
            let [wide_low, wide_high] = ends(row, pair[1]).unwrap();
            assert!(wide_low <= low + 1e-9 && high <= wide_high + 1e-9, "{pair:?} {row}");
        }
    }
    // East, away from the wall: about the diagonal, whose directions are 36.87 and 58.05 degrees beside it; and 36.87 beyond the wall.
    let east = rose.iter().find(|row| row["heading_deg"] == 90.0).unwrap();
    assert!((ends(east, "kc").unwrap()[0] - 8.130_102_354_2).abs() < 1e-9, "{east}");
    assert!(
        (ends(east, "kc_plus").unwrap()[0] + 13.051_940_569).abs() < 1e-8
            && (ends(east, "k").unwrap()[0] + 36.869_897_645_8).abs() < 1e-9
    );
    assert_eq!(ends(east, "k").unwrap()[1], 90.0);
}

#[test]
fn tables_of_contacts_that_are_wrong_name_line_found_and_expected() {
    let desk = Desk::new();
    let header = "normal_x,normal_y,normal_z,friction_coefficient\n";
    for (text, parts) in [
        ("x,y\n".to_owned(), ["contacts.csv:1", "found the header x,y"]),
        (format!("{header}0,0,1,steep\n"), ["contacts.csv:2", "friction_coefficient is \"steep\", expected a finite number"]),
        (format!("{header}0,0,1,0.5\n0,0,0,0.5\n"), ["contacts.csv:3", "expected a direction out of the ground"]),
        (format!("{header}0,0,1,0\n"), ["contacts.csv:2", "friction coefficient 0 leaves a single direction of force"]),
        (header.to_owned(), ["contacts.csv:1", "found no contact, expected at least one row"]),
    ] {
        desk.write("contacts.csv", text);
        desk.refused(&["stance", "--contacts", "contacts.csv"], &parts);
    }
}

#[test]
fn a_robot_stands_on_a_raster_or_the_answer_names_its_limbs() {
    let desk = Desk::with_dem();
    desk.write_legs("four_legs.toml", FOUR_LEGS);
    let words = ["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--scenario", "map.toml", "--quiet"];
    let document = desk.json(&words);
    assert_eq!(document["stands"], true, "{document}");
    let contacts = document["contacts"].as_array().unwrap();
    assert!(contacts.len() == 4 && contacts.iter().filter(|foot| foot["outcome"] == "stands").count() >= 3, "{document}");
    assert!(document["poses"]["tried"].as_u64().unwrap() == 36 * 11 && document["upright"].is_boolean());
    let (status, text) = {
        let ran = desk.run(&[&words[..], &["--height-m", "2"]].concat());
        (ran.status, ran.stdout)
    };
    assert_eq!(status, 1);
    assert!(
        text.contains("four legs: does not stand: 0 of 4 feet stand, expected at least 3: front left reaches no ground"),
        "{text}"
    );
    let buried = desk.run(&[&words[..], &["--height-m", "0"]].concat());
    assert!(buried.status == 1 && buried.stdout.contains("of the trunk") && buried.stdout.contains("meets facet"), "{buried:?}");
    desk.refused(&["stance", "ground.tif", "--at", "9,9", "--scenario", "map.toml"], &["found no robot", "--robot FILE"]);
    desk.refused(
        &["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "900,9", "--scenario", "map.toml"],
        &["is off the map", "x 0"],
    );
    let angles = ["--set", "surface.takeoff_from_slope_deg=[20, 90]", "--set", "surface.landing_from_slope_deg=[-90, -20]"];
    let by_angles = [&words[..6], &["--body", "mars", "--quiet"], &angles].concat();
    desk.refused(&by_angles, &["expected a friction coefficient", "surface.friction_coefficient"]);
}

#[test]
fn a_robot_with_legs_is_planned_from_stance_to_stance_and_tried() {
    let scenario = "data/mesh_scenarios/three_legs.toml";
    let json = |words: &[&str]| {
        let (status, stdout, stderr) = chta(root(), &[words, &["--format", "json", "--quiet"]].concat());
        assert!(status < 2, "{stderr}");
        serde_json::from_str::<serde_json::Value>(&stdout).unwrap()
    };
    let document = json(&["plan", scenario, "--set", "search.contacts_max=60"]);
    assert_eq!((&document["verdict"], &document["verified"]), (&"traversable".into(), &true.into()), "{}", document["gap"]);
    let (stances, hops) = (document["stances"].as_array().unwrap(), document["hops"].as_u64().unwrap());
    assert_eq!(stances.len() as u64, hops + 1);
    for stance in stances {
        let feet = stance["contacts"].as_array().unwrap();
        assert!(feet.iter().all(|foot| foot["outcome"] == "stands"), "three feet are needed: {stance}");
    }
    let tried = json(&["simulate", scenario, "--set", "search.contacts_max=60", "--trials", "40", "--compare"]);
    let records = tried["compare"].as_array().unwrap();
    assert_eq!(records.len(), 2);
    for record in records {
        let ended: u64 = record["outcomes"].as_array().unwrap().iter().map(|row| row["trials"].as_u64().unwrap()).sum();
        assert_eq!(ended, 40, "{record}");
    }
    // Without errors every trial is the plan.
    let exact =
        ["takeoff_speed_sigma_fraction", "takeoff_angle_sigma_deg", "heading_sigma_deg"].map(|key| format!("uncertainty.{key}=0"));
    let exact: Vec<&str> = exact.iter().flat_map(|key| ["--set", key.as_str()]).collect();
    let plain = json(&[&["simulate", scenario, "--set", "search.contacts_max=60", "--trials", "10"][..], &exact].concat());
    assert_eq!(plain["simulation"]["success_rate"], 1.0, "{}", plain["simulation"]);
}

#[test]
fn what_is_not_answered_for_legs_is_refused() {
    let scenario = "data/mesh_scenarios/three_legs.toml";
    for command in [&["check", scenario][..], &["map", scenario]] {
        let (status, stdout, stderr) = chta(root(), command);
        assert_eq!((status, stdout.as_str()), (2, ""), "{command:?}");
        assert!(stderr.contains("robot.file is") && stderr.contains("answers for a point alone"), "{command:?}: {stderr}");
    }
    let (status, _, stderr) = chta(root(), &["plan", scenario, "--front", "hops,energy"]);
    assert!(status == 2 && stderr.contains("--front: found this option") && stderr.contains("robot with legs"), "{stderr}");
}

/// Every console block of docs/legs.md before the robot file.
#[test]
fn the_commands_of_the_document_run() {
    let document = std::fs::read_to_string(root().join("docs/legs.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let commands: Vec<String> = document
        .split("```console\n")
        .skip(1)
        .filter_map(|block| block.split("```").next())
        .flat_map(|block| block.replace(" \\\n", " ").lines().map(str::to_owned).collect::<Vec<_>>())
        .filter_map(|line| line.strip_prefix("$ chta ").map(str::to_owned))
        .collect();
    assert!(commands.len() >= 4, "{commands:?}");
    for command in commands {
        let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
        for option in ["--plot", "--plot-postures", "--mobility", "-o"] {
            if let Some(at) = words.iter().position(|word| word == option) {
                let file = folder.path().join(&words[at + 1]);
                words[at + 1] = file.display().to_string();
            }
        }
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let (status, _, stderr) = chta(root(), &[&words[..], &["--quiet"]].concat());
        assert_eq!((status, stderr.as_str()), (0, ""), "{words:?}");
    }
}

#[test]
fn a_run_of_a_robot_with_joints_has_its_postures_and_what_the_hops_ask_of_them() {
    let desk = Desk::new();
    let scenario = "data/mesh_scenarios/mars_four_legs.toml";
    let words = ["--set", "search.contacts_max=20", "--set", "uncertainty.trials=10", "--quiet"];
    let out = desk.path().join("out");
    let run = [&["run", scenario, "-o", out.to_str().unwrap(), "--format", "json"], &words[..]].concat();
    let (status, stdout, stderr) = chta(root(), &run);
    assert_eq!(status, 0, "{stderr}");
    let document: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    let stances = document["stances"].as_array().unwrap();
    let hops = document["path"].as_array().unwrap().len();
    assert!(hops >= 2 && stances.len() == hops + 1 && document["joint_reach"]["feet"].as_u64().unwrap() >= 60, "{document}");
    for (number, stance) in stances.iter().enumerate() {
        assert_eq!((stance.get("landing").is_none(), stance.get("takeoff").is_none()), (number == 0, number == hops), "{stance}");
        for foot in stance["contacts"].as_array().unwrap() {
            assert_eq!(foot["joints"]["joints"].as_array().map(Vec::len), Some(3), "{foot}");
        }
        for push in ["landing", "takeoff"].iter().filter_map(|key| stance.get(*key)) {
            for foot in push["feet"].as_array().unwrap() {
                assert!(foot["effort_share"].as_f64().unwrap() >= 0.0 && foot["contact_s"].as_f64().unwrap() >= 0.0, "{foot}");
            }
        }
    }
    for name in ["path.csv", "path.svg", "path.geojson", "postures.svg", "simulation.json"] {
        assert!(out.join(name).is_file(), "{name}");
    }
    let svg = std::fs::read_to_string(out.join("postures.svg")).unwrap();
    assert!(svg.contains("last contact") && svg.contains("Hop 1 of") && svg.contains("limbs by their joints"), "{}", svg.len());
    let late = [&["plan", scenario, "--plot-postures", "p.svg", "--postures-from", "99"], &words[..]].concat();
    let (status, _, stderr) = chta(root(), &late);
    assert!(status == 2 && stderr.contains("--postures-from: found 99, expected a hop of the path, 1 to"), "{status} {stderr}");
    let point = ["plan", "data/scenarios/simple.toml", "--plot-postures", "p.svg"];
    let (status, _, stderr) = chta(root(), &point);
    assert!(status == 2 && stderr.contains("the scenario names none, expected robot.file on a free route"), "{status} {stderr}");
    assert!(!root().join("p.svg").exists());
}
