//! Layers that may be left for a while, through the commands.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// A level map of 41 by 21 posts, 1 m apart, hops of at most 3.9 m over it, and a crater of shade, 15 m by 13 m, about its middle.
fn desk() -> Desk {
    let desk = Desk::new();
    let grid = |value: &dyn Fn(usize, usize) -> &'static str| {
        let row = |row: usize| (0..41).map(|col| value(row, col)).collect::<Vec<_>>().join(" ");
        let rows: Vec<String> = (0..21).map(row).collect();
        format!("ncols 41\nnrows 21\nxllcenter 0\nyllcenter 0\ncellsize 1\n{}\n", rows.join("\n"))
    };
    desk.write("level.asc", grid(&|_, _| "0"));
    desk.write("sun.asc", grid(&|row, col| if is_shaded(col, 20 - row) { "0" } else { "1" }));
    let scenario = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\npreparation_time_s = 60\n\
                    settling_time_s = 10\n[surface]\nfriction_coefficient = 1.0\n[terrain]\ndem = \"level.asc\"\nstart_m = [5, 10]\n\
                    route = \"free\"\n[search]\nnode_spacing_max_m = 1.0\n";
    desk.write("goal.toml", scenario.replace("route", "goal_m = [20, 10]\nroute"));
    desk.write("targets.toml", format!("{scenario}[mission]\ntargets_m = [[20, 10], [35, 10]]\nreturn_to_start = true\n"));
    desk
}

fn is_shaded(col: usize, y: usize) -> bool {
    (13..=27).contains(&col) && (4..=16).contains(&y)
}

fn in_shade(at: [f64; 2]) -> bool {
    (12.5..=27.5).contains(&at[0]) && (3.5..=16.5).contains(&at[1])
}

/// The longest time and the most hops of a stretch in the shade, from the rows of a path alone.
fn longest(path: &Value, is_exempt: &dyn Fn([f64; 2]) -> bool) -> (f64, u64) {
    let (mut longest, mut clock) = ((0.0_f64, 0_u64), (0.0, 0));
    for (number, hop) in path.as_array().unwrap().iter().enumerate() {
        let of = |key: &str| hop[key].as_f64().unwrap();
        let outside = |end: &str| {
            let at = [of(&format!("{end}_map_x_m")), of(&format!("{end}_map_y_m"))];
            in_shade(at) && !is_exempt(at)
        };
        let (takeoff, landing) = (outside("takeoff"), outside("landing"));
        if takeoff {
            clock.0 += if number == 0 { 60.0 } else { 70.0 };
        }
        if takeoff || landing {
            clock = (clock.0 + of("flight_time_s"), clock.1 + 1);
        }
        longest = (longest.0.max(clock.0), longest.1.max(clock.1));
        if !landing {
            clock = (0.0, 0);
        }
    }
    longest
}

fn nowhere(_: [f64; 2]) -> bool {
    false
}

fn set(more: &str) -> String {
    format!("layer.sun={{ raster = \"sun.asc\", min = 0.5{more} }}")
}

/// Runs a command that answers yes or no: its status, its document and its text.
fn ask(desk: &Desk, words: &[&str]) -> (i32, Value, String) {
    let text = desk.run(words);
    let json = desk.run(&[words, &["--format", "json"]].concat());
    assert_eq!(text.status, json.status, "{}", text.stderr);
    (json.status, serde_json::from_str(&json.stdout).unwrap(), format!("{}{}", text.stdout, text.stderr))
}

#[test]
fn a_goal_in_the_shade_is_reached_within_an_outage_and_not_without_one() {
    let desk = desk();
    let (status, _, text) = ask(&desk, &["plan", "goal.toml", "--set", &set("")]);
    assert_eq!(status, 1);
    assert!(text.contains("layer sun does not hold at the goal, so that no hop begins or ends there"), "{text}");

    let (status, answer, text) = ask(&desk, &["plan", "goal.toml", "--set", &set(", outage_max_s = 600")]);
    assert_eq!((status, &answer["verified"]), (0, &true.into()), "{text}");
    let outage = &answer["outages"][0];
    let (time_s, hops) = longest(&answer["path"], &nowhere);
    assert!(hops >= 2 && (outage["longest_s"].as_f64().unwrap() - time_s).abs() < 1e-9, "{outage}, {time_s}");
    assert_eq!((outage["most_hops"].as_u64(), &outage["met"], &outage["layer"]), (Some(hops), &true.into(), &"sun".into()));
    assert!(text.contains(&format!("longest outage of layer sun {time_s:.1} s, at most 600 s, {hops} hops")), "{text}");

    // A hair less than the fewest hops in the shade take: the hop that is the longest there is replaced, or the answer is no.
    let tight = set(&format!(", outage_max_s = {}", time_s - 75.0));
    let (status, answer, text) = ask(&desk, &["plan", "goal.toml", "--set", &tight]);
    assert_eq!((status, &answer["outages"][0]["met"], &answer["verdict"]), (1, &false.into(), &"no-path-found".into()), "{text}");
    assert!(text.contains("not within an outage: longest outage of layer sun"), "{text}");
    assert_eq!(ask(&desk, &["plan", "goal.toml", "--set", &set(", outage_hops_max = 1")]).0, 1);
    // The goal alone is exempt, and it is more than one hop into the shade.
    assert_eq!(ask(&desk, &["plan", "goal.toml", "--set", &set(", exempt_targets = true")]).0, 1);
}

#[test]
fn a_mission_into_the_shade_and_out_again_keeps_its_outage() {
    let desk = desk();
    let (status, answer, text) = ask(&desk, &["plan", "targets.toml", "--set", &set("")]);
    assert_eq!((status, answer["targets_visited"].as_u64()), (1, Some(1)));
    assert!(text.contains("layer sun does not hold at target 1"), "{text}");

    let plan = |more: &str| ask(&desk, &["plan", "targets.toml", "--set", &set(more)]);
    let (status, free, _) = plan(", outage_max_s = 10000");
    assert_eq!(status, 0);
    let (time_s, hops) = longest(&free["path"], &nowhere);
    assert_eq!(free["outages"][0]["most_hops"].as_u64(), Some(hops));
    // In and out by the shorter sides: the mission takes more hops in all.
    let (status, tight, text) = plan(&format!(", outage_max_s = {}", time_s - 1.0));
    assert_eq!(status, 0, "{text}");
    let (tight_s, _) = longest(&tight["path"], &nowhere);
    assert!(tight_s < time_s && tight["hops"].as_u64() >= free["hops"].as_u64(), "{text}");
    assert!((tight["outages"][0]["longest_s"].as_f64().unwrap() - tight_s).abs() < 1e-9);
    // The target in the shade is left out where no mission over it is short enough.
    let (status, without, text) = plan(", outage_max_s = 120");
    assert_eq!((status, without["targets_visited"].as_u64()), (1, Some(1)), "{text}");
    assert_eq!(without["targets"][0]["left_out"]["why"], "outages");
    assert!(text.contains("outside the condition of a layer for too long"), "{text}");
    // Where the target itself counts as lit, the way in and the way out are two stretches.
    let (status, exempt, text) = plan(&format!(", outage_max_s = {}, exempt_targets = true", 0.6 * time_s));
    assert_eq!(status, 0, "{text}");
    let (exempt_s, _) = longest(&exempt["path"], &|at| at == [20.0, 10.0]);
    assert!((exempt["outages"][0]["longest_s"].as_f64().unwrap() - exempt_s).abs() < 1e-9, "{text}");
}

#[test]
fn the_least_speed_with_so_much_time_in_the_shade_is_found() {
    let desk = desk();
    let words = ["--from", "1.5", "--to", "3.5", "--resolution", "0.25"];
    let required = |more: &str| {
        let sun = set(more);
        let ran = ["require", "targets.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--set", &sun];
        desk.json(&[&ran[..], &["--set", "hopper.landing_speed_max_m_s=4"], &words].concat())["reachable_at"].as_f64().unwrap()
    };
    let (short, long) = (required(", outage_max_s = 450"), required(", outage_max_s = 900"));
    assert!(short > long, "{short}, {long}");
}

#[test]
fn questions_of_single_hops_say_that_they_count_no_outage() {
    let desk = desk();
    let layer = set(", outage_max_s = 600");
    let refused = desk.run(&["map", "level.asc", "--start", "5,10", "--scenario", "goal.toml", "--set", &layer]);
    assert_eq!(refused.status, 2);
    assert!(refused.stderr.contains("layer.sun may be left for a while"), "{}", refused.stderr);
    let front = desk.run(&["plan", "goal.toml", "--set", &layer, "--front", "hops,energy"]);
    assert_eq!(front.status, 2, "{}", front.stderr);
    let hop = desk.run(&["hop", "level.asc", "--from", "20,10", "--to", "22,10", "--scenario", "goal.toml", "--set", &layer]);
    assert_eq!(hop.status, 0, "{}", hop.stderr);
    assert!(hop.stderr.contains("it refuses no hop by itself"), "{}", hop.stderr);
    let trials = ["--set", "uncertainty.takeoff_speed_sigma_fraction=0.001", "--trials", "20"];
    let flown = desk.run(&[&["simulate", "goal.toml", "--set", &layer][..], &trials].concat());
    assert_eq!(flown.status, 0, "{}", flown.stderr);
    assert!(flown.stderr.contains("trials do not count how long the condition of layer.sun is unmet"), "{}", flown.stderr);
    let straight = desk.run(&["plan", "goal.toml", "--set", &layer, "--set", "terrain.route=transect"]);
    assert_eq!(straight.status, 2);
    assert!(straight.stderr.contains("free routes of hops alone"), "{}", straight.stderr);
}
