//! `chta arena`: answers, what is refused, and with which sentence.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use crate::desk::{ACROSS, Desk, Ran, chta};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("arena.toml", ACROSS);
    desk
}

#[test]
fn the_answer_says_what_it_is_and_how_far_from_the_bound() {
    let text = |arguments: &[&str]| {
        let (status, stdout, stderr) = chta(root(), &[&["arena"], arguments, &["--quiet"]].concat());
        assert_eq!((status, stderr.as_str()), (0, ""), "{arguments:?}");
        stdout
    };
    let exact = text(&["data/arenas/sumo_2.toml"]);
    assert!(exact.starts_with("optimal over the boxes as drawn: 12.3092 s with 1 jump\nwithout jumps: 13.3510 s"), "{exact}");
    let grid = text(&["data/arenas/sumo_2.toml", "--planner", "grid"]);
    assert!(
        grid.starts_with("found over this grid, reading R1: 12.5179 s with 1 jump\nno path takes less than: 12.0114 s"),
        "{grid}"
    );
    assert!(!grid.contains("optimal"), "{grid}");
    let plain = text(&["data/arenas/sumo_3.toml", "--planner", "grid", "--reading", "R0"]);
    assert!(plain.contains("the optimum at these prices: 12.6482 s; this path takes 4.39 % more"), "{plain}");
    let tree = text(&["data/arenas/sumo_3.toml", "--planner", "rrt-star", "--nodes", "400"]);
    assert!(tree.starts_with("found by RRT* with 400 nodes: ") && !tree.contains("optimal"), "{tree}");
}

/// The table has what each planner answers by itself, over the same random boxes.
#[test]
fn all_planners_over_the_same_boxes_in_a_table() {
    let document = |more: &[&str]| {
        let words = ["arena", "data/arenas/sumo_2.toml", "--random", "15", "--seed", "3", "--quiet", "--format", "json"];
        let (status, stdout, stderr) = chta(root(), &[&words[..], more].concat());
        assert_eq!((status, stderr.as_str()), (0, ""), "{more:?}");
        serde_json::from_str::<serde_json::Value>(&stdout).unwrap()
    };
    let all = document(&["--compare", "--nodes", "400"]);
    let rows = all["compared"].as_array().unwrap();
    let alone: [&[&str]; 4] = [
        &["--planner", "any-angle"],
        &["--planner", "grid", "--reading", "R1"],
        &["--planner", "grid", "--reading", "R0"],
        &["--planner", "rrt-star", "--nodes", "400"],
    ];
    assert_eq!(rows.len(), alone.len());
    let mut paths = 0;
    for (row, words) in rows.iter().zip(alone) {
        let own = document(words);
        for key in ["planner", "reading", "path_time_s", "jumps", "length_m", "without_jumps_s", "lower_bound_s", "gap_share"] {
            assert_eq!(row[key], own[key], "{words:?}: {key}");
        }
        if let (Some(time_s), Some(without_s)) = (row["path_time_s"].as_f64(), row["without_jumps_s"].as_f64()) {
            assert_eq!(row["saved_s"].as_f64(), Some(without_s - time_s));
            paths += 1;
        }
    }
    assert!(paths >= 3, "{all}");
    // A planner that does not plan there says why, and the others do.
    let flying =
        ["--set", "flight.takeoff_speed_m_s=4.2", "--set", "flight.takeoff_angle_deg=75", "--planner", "grid", "--compare"];
    let flying = document(&flying);
    assert!(flying["compared"][0]["refused"].is_string() && flying["compared"][1]["refused"].is_null(), "{flying}");
}

#[test]
fn the_document_has_path_bound_and_gap_and_is_the_same_each_time() {
    let desk = desk();
    for planner in ["grid", "any-angle", "rrt-star"] {
        let words = ["arena", "arena.toml", "--planner", planner];
        let document = desk.json(&words);
        let (time_s, bound_s) = (document["path_time_s"].as_f64().unwrap(), document["lower_bound_s"].as_f64().unwrap());
        assert!(time_s >= bound_s - 1e-12, "{planner}");
        assert!((document["gap_share"].as_f64().unwrap() - (time_s / bound_s - 1.0)).abs() < 1e-12, "{planner}");
        let path = document["path"].as_array().unwrap();
        assert!(path[0]["move"].is_null() && path[1..].iter().all(|point| point["move"].is_string()), "{planner}");
        assert_eq!((&path[0]["x_m"], &path[path.len() - 1]["y_m"]), (&1.0.into(), &4.0.into()), "{planner}");
        assert_eq!(document["jumps"], 1, "{planner}");
        assert_eq!(document["without_jumps_s"], serde_json::Value::Null, "{planner}: a box across the floor");
        assert_eq!(desk.json(&words), document, "{planner}");
        assert_eq!(document["history"].as_array().unwrap().is_empty(), planner != "rrt-star");
    }
    let ran = desk.run(&["arena", "arena.toml"]);
    assert!(ran.stderr.starts_with("process_s: ") && !ran.stdout.contains("process_s"), "{ran:?}");
}

#[test]
fn a_no_is_proved_or_says_that_it_is_none() {
    let desk = desk();
    let Ran { status, stdout, .. } = desk.run(&["arena", "arena.toml", "--no-jump"]);
    assert_eq!((status, stdout.as_str()), (1, "no path without jumps, proved over the boxes as drawn\n"));
    let high = desk.run(&["arena", "arena.toml", "--set", "jumper.rise_max_m=0.4"]);
    assert_eq!(high.status, 1);
    assert!(high.stdout.contains("no path, proved") && high.stdout.contains("stopped by jumper.rise_max_m"), "{}", high.stdout);
    let few = desk.run(&["arena", "arena.toml", "--planner", "rrt-star", "--nodes", "5"]);
    assert_eq!(few.status, 1);
    assert!(few.stdout.contains("this does not prove that no path exists"), "{}", few.stdout);
    let empty = ["--set", "jumper.drive_j_per_m=1", "--set", "jumper.battery_j=3"];
    let flat = desk.run(&[&["arena", "arena.toml"], &empty[..]].concat());
    assert!(flat.stdout.contains("stopped by jumper.battery_j"), "{}", flat.stdout);
}

#[test]
fn every_problem_of_a_file_is_told_at_once_with_its_line() {
    let desk = desk();
    desk.write(
        "bad.toml",
        "[arena]\nsize_m = [9, 6]\nstart_m = [10, 3]\ngoal_m = [8, nan]\n\n[jumper]\nspeed_m_s = 0\njump_time_s = -1\nrise_max_m = 0.6\n\n\
         [[box]]\ncentre_m = [4, 3]\nsize_m = [0, 6]\nheight_m = 0.5\n",
    );
    desk.refused(
        &["arena", "bad.toml"],
        &[
            "bad.toml:3:11: arena.start_m is 10, 3, expected a place on the floor",
            "bad.toml:4:10: arena.goal_m is 8, NaN",
            "bad.toml:7:13: jumper.speed_m_s is 0, expected a speed above 0",
            "bad.toml:8:15: jumper.jump_time_s is -1",
            "bad.toml:13:10: box 1: size_m is 0, 6, expected two lengths above 0",
        ],
    );
    desk.write("odd.toml", ACROSS.replace("speed_m_s = 1.5", "speed_ms = 1.5").replace("height_m = 0.5", "height_m = \"high\""));
    desk.refused(
        &["arena", "odd.toml"],
        &[
            "unknown key jumper.speed_ms; the nearest known key is jumper.speed_m_s",
            "jumper.speed_m_s is missing",
            "box 1: height_m is \"high\", expected a number",
        ],
    );
    for (change, sentence) in [
        (("start_m = [1, 3]", "start_m = [4, 3]"), "a place outside of all boxes: it is in box 1"),
        (("goal_m = [8, 4]", "goal_m = [1, 3]"), "a place other than arena.start_m"),
        (("centre_m = [4, 3]", "centre_m = [40, 3]"), "at least in part on the floor"),
        (("[[box]]", "[boxes]"), "unknown table [boxes]"),
        (("[arena]", "[arena"), "this is not TOML"),
        (("rise_max_m = 0.6", "rise_max_m = 0.6\nbattery_j = 5"), "bounds an energy that nothing takes"),
    ] {
        desk.write("bad.toml", ACROSS.replace(change.0, change.1));
        desk.refused(&["arena", "bad.toml"], &["bad.toml", sentence]);
    }
}

#[test]
fn what_a_planner_does_not_do_is_refused_by_name() {
    let desk = desk();
    let set = |key: &'static str| ["arena", "arena.toml", "--planner", "grid", "--set", key];
    desk.refused(&set("arena.start_m=[1.05,3]"), &["arena.start_m is 1.05, 3, between the nodes", "take 1, 3"]);
    desk.refused(&set("grid.spacing_m=0.3"), &["grid.jump_length_m is 0.4, expected a multiple"]);
    desk.refused(&set("grid.spacing_m=0.001"), &["nodes, expected at most 1000000"]);
    desk.refused(&set("speed=1"), &["--set speed=1: found no table.key=value of an arena"]);
    desk.refused(&set("jumper.rise_max_m=high"), &["--set jumper.rise_max_m=high: jumper.rise_max_m is"]);
    desk.write("thin.toml", ACROSS.replace("size_m = [2, 6]", "size_m = [0.3, 6]"));
    desk.refused(&["arena", "thin.toml", "--planner", "grid"], &["box 1 is 0.3", "two spacings of the grid (0.4 m)"]);
    desk.refused(
        &["arena", "arena.toml", "--set", "jumper.speed_factor_per_jump=0.9"],
        &["jumper.speed_factor_per_jump is 0.9, and any-angle planning takes 1 alone"],
    );
    desk.refused(
        &["arena", "arena.toml", "--planner", "rrt-star", "--set", "arena.start_m=[2.9,3]"],
        &["arena.start_m is closer than jumper.ring_m (0.2 m)"],
    );
    for (option, planner) in [("--reading", "R0"), ("--nodes", "50"), ("--seed", "4")] {
        desk.refused(&["arena", "arena.toml", option, planner], &[option, "leave it out"]);
    }
    desk.refused(&["arena", "absent.toml"], &["absent.toml: cannot be read", "expected an arena (TOML)"]);
    desk.refused(&["arena", "chain.csv"], &["chain.csv: this is a chain CSV", "as ARENA"]);
    desk.refused(&["arena", "scenario.toml"], &["unknown table [body]"]);
}

#[test]
fn boxes_of_different_heights_that_overlap_are_warned_of() {
    let desk = desk();
    desk.write("arena.toml", format!("{ACROSS}\n[[box]]\ncentre_m = [5, 5]\nsize_m = [2, 2]\nheight_m = 0.3\n"));
    let ran = desk.run(&["arena", "arena.toml"]);
    assert!(ran.stderr.contains("warning: boxes 1 and 2 overlap and are 0.5 m and 0.3 m high: the higher one counts"), "{ran:?}");
    assert_eq!(desk.json(&["arena", "arena.toml"])["warnings"].as_array().unwrap().len(), 1);
}

#[test]
fn random_boxes_are_those_of_the_seed_and_can_be_written() {
    let desk = desk();
    let base = ["arena", "arena.toml", "--random", "6", "--random-sizes-m", "0.6,1", "--quiet", "-o", "map.toml"];
    let map = |seed: &str| {
        assert!(desk.run(&[&base[..], &["--seed", seed]].concat()).status < 2);
        desk.read("map.toml")
    };
    let first = map("1");
    assert_eq!((first.matches("[[box]]").count(), first == map("1"), first == map("2")), (6, true, false));
    let again = desk.json(&["arena", "map.toml", "--planner", "grid"]);
    assert_eq!(again["scenario"]["box"].as_array().unwrap().len(), 6);
    desk.refused(&["arena", "arena.toml", "--random", "3", "--random-sizes-m", "1,0"], &["--random-sizes-m: found a length"]);
}

#[test]
fn the_picture_shows_both_paths_and_is_the_same_each_time() {
    let desk = desk();
    let draw = |words: &[&str], name: &str| {
        let ran = desk.run(&[&["arena"], words, &["--quiet", "--plot", name]].concat());
        assert!(ran.status < 2, "{ran:?}");
        desk.read(name)
    };
    let exact = draw(&["arena.toml"], "exact.svg");
    for part in ["with jumps: ", "without jumps: no path", "goal, no path", "x (m)", "y (m)", "jump, to where it lands", "drop"] {
        assert!(exact.contains(part), "no {part}");
    }
    assert_eq!(draw(&["arena.toml"], "again.svg"), exact);
    let tree = draw(&["arena.toml", "--planner", "rrt-star", "--nodes", "400"], "tree.svg");
    assert!(tree.contains("rewired: ") && tree.contains("time of the path (s)") && tree.contains("nodes"));
    let driven = draw(&["arena.toml", "--random", "0"], "empty.svg");
    assert!(
        !driven.contains("jump, to") && !driven.contains("box with its height") && !driven.contains("without jumps"),
        "a legend of nothing"
    );
    assert!(
        desk.run(&["arena", "arena.toml", "--plot", "picture.png", "--quiet"]).status == 0
            && desk.path().join("picture.png").exists()
    );
}

/// The commands of the document, which also states their first lines.
#[test]
fn the_commands_of_the_document_answer_as_it_says() {
    let document = std::fs::read_to_string(root().join("docs/drive.md")).unwrap();
    let part = document.split("## Boxes on a flat floor").nth(1).unwrap();
    let mut run = 0;
    for block in part.split("```console\n").skip(1) {
        let mut lines = block.split("```").next().unwrap().lines();
        let command = lines.next().unwrap().strip_prefix("$ chta ").unwrap();
        let words: Vec<&str> = command.split_whitespace().collect();
        let desk = Desk::new();
        #[cfg(unix)]
        std::os::unix::fs::symlink(root().join("data"), desk.path().join("data")).unwrap();
        let ran = desk.run(&words);
        assert!(ran.status < 2, "{command}: {ran:?}");
        for line in lines {
            assert!(ran.stdout.lines().any(|found| found == line), "{command} does not print `{line}`:\n{}", ran.stdout);
        }
        run += 1;
    }
    assert!(run >= 4, "only {run} commands");
}
