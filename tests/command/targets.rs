//! Missions over several targets, from the command.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// A floor of 60 m by 6 m with a wall-less middle, a cliff 5 m down at its east end, and an island behind missing elevations in its west.
fn desk() -> Desk {
    let desk = Desk::new();
    let height = |col: usize| match col {
        3..12 => "-9999",
        0..60 => "0",
        _ => "-5",
    };
    let rows: Vec<String> = (0..7).map(|_| (0..66).map(height).collect::<Vec<_>>().join(" ")).collect();
    let head = "ncols 66\nnrows 7\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n";
    desk.write("floor.asc", format!("{head}{}\n", rows.join("\n")));
    desk.write("mission.toml", MISSION);
    desk
}

/// To the nearest target first, and on to the ends, is the longest way: from 24 m to 27 m, back to 16 m, on to 50 m.
const MISSION: &str = "[body]\ngravity_m_s2 = 1.62\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 5.5\nmass_kg = 5\n\
    preparation_time_s = 10\nsettling_time_s = 2\n[surface]\nfriction_coefficient = 0.8\n[terrain]\ndem = \"floor.asc\"\nstart_m = [24, 3]\n\
    route = \"free\"\n[search]\nnode_spacing_max_m = 1\n[mission]\ntargets_m = [[27, 3], [16, 3], [50, 3]]\n";

fn order(answer: &Value) -> Vec<Option<u64>> {
    answer["visits"].as_array().unwrap().iter().map(|visit| visit["target"].as_u64()).collect()
}

#[test]
fn the_best_order_is_planned_with_every_leg_and_flown_as_a_whole() {
    let desk = desk();
    let answer = desk.json(&["plan", "mission.toml", "-o", "path.csv", "--plot", "path.svg", "--geojson", "path.geojson"]);
    assert_eq!((answer["schema"].as_str(), answer["verdict"].as_str()), (Some("chta/plan-targets/1"), Some("traversable")));
    assert_eq!(order(&answer), [Some(2), Some(1), Some(3)]);
    // 8 + 11 + 23 m, at most 3.858 m a hop.
    assert!(answer["hops"].as_u64().unwrap() >= 12 && answer["hops_lower_bound"].as_u64().unwrap() >= 11, "{answer}");
    let given = desk.json(&["plan", "mission.toml", "--set", "mission.order=given"]);
    assert_eq!(order(&given), [Some(1), Some(2), Some(3)]);
    assert!(given["hops"].as_u64() > answer["hops"].as_u64());
    // The legs add up, and every hop says where it leads.
    let visits = answer["visits"].as_array().unwrap();
    let path = answer["path"].as_array().unwrap();
    let sum = |of: &str| visits.iter().map(|visit| visit["leg"][of].as_f64().unwrap()).sum::<f64>();
    for (name, total) in [("mission_time_s", "mission_time_s"), ("energy_j_kg", "energy_j_kg"), ("distance_m", "ground_distance_m")]
    {
        let total = answer["totals"][total].as_f64().unwrap();
        assert!((sum(name) - total).abs() < 1e-9 * total, "{name}: {} and {total}", sum(name));
        assert_eq!(visits.last().unwrap()["arrival"][name].as_f64().map(|last| (last - total).abs() < 1e-9 * total), Some(true));
    }
    assert_eq!(sum("hops"), f64::from(u32::try_from(path.len()).unwrap()));
    for visit in visits {
        let hops: Vec<&Value> = path.iter().filter(|hop| hop["visit"] == visit["visit"]).collect();
        assert_eq!(Some(hops.len() as u64), visit["leg"]["hops"].as_u64());
        let last = hops.last().unwrap();
        let at = [&last["landing_map_x_m"], &last["landing_map_y_m"]];
        assert_eq!(at, [&visit["at_m"][0], &visit["at_m"][1]]);
    }
    let csv = desk.read("path.csv");
    assert!(csv.starts_with("visit,target,hop,") && csv.lines().count() == path.len() + 1, "{csv}");
    assert!(desk.read("path.svg").contains("target 3: visit 3") && desk.read("path.geojson").contains("FeatureCollection"));
    // Without errors every trial flies the whole mission.
    let flown =
        desk.json(&["simulate", "mission.toml", "--trials", "20", "--set", "uncertainty.goal_tolerance_m=0.01", "--compare"]);
    let reached: Vec<Option<u64>> = flown["visited"].as_array().unwrap().iter().map(|row| row["trials"].as_u64()).collect();
    assert_eq!(reached, [Some(20); 3]);
    for policy in flown["compare"].as_array().unwrap() {
        assert_eq!(policy["success_rate"].as_f64(), Some(1.0), "{policy}");
    }
}

#[test]
fn a_mission_comes_home_and_its_text_has_every_leg() {
    let desk = desk();
    let ran = desk.run(&["plan", "mission.toml", "--set", "mission.return_to_start=true"]);
    assert_eq!(ran.status, 0, "{ran:?}");
    for part in ["3 of 3 targets visited and back to the start", "to start", "in the best order", "verified", "  all"] {
        assert!(ran.stdout.contains(part), "{part:?} is not in {}", ran.stdout);
    }
    let home = desk.json(&["plan", "mission.toml", "--set", "mission.return_to_start=true"]);
    assert_eq!(order(&home).last(), Some(&None));
    // Checked: the same without hops.
    let checked = desk.json(&["check", "mission.toml", "--set", "mission.return_to_start=true"]);
    assert_eq!(checked["visits"], home["visits"]);
    assert_eq!(checked["path"].as_array().map(Vec::len), Some(0));
}

/// What is left out, and why: an island, a place below a cliff that cannot be climbed, a budget that is too small.
#[test]
fn the_largest_set_is_visited_and_the_others_are_said_with_their_reason() {
    let desk = desk();
    let set = |more: &[&str]| {
        let words: Vec<&str> = ["plan", "mission.toml"].into_iter().chain(more.iter().flat_map(|key| ["--set", key])).collect();
        let ran = desk.run(&words);
        assert_eq!(ran.status, 1, "{ran:?}");
        (ran.stdout, desk.run(&[&words[..], &["--format", "json"]].concat()).stdout)
    };
    let why = |json: &str, target: usize| {
        let answer: Value = serde_json::from_str(json).unwrap();
        let left_out = answer["targets"][target - 1]["left_out"].clone();
        (left_out["why"].as_str().map(str::to_owned), left_out, answer["targets_visited"].as_u64())
    };
    let (text, json) = set(&["mission.targets_m=[[27,3],[1,3],[50,3]]"]);
    let (reason, left_out, visited) = why(&json, 2);
    assert_eq!((reason.as_deref(), visited), (Some("not-reached"), Some(2)));
    assert!(
        left_out["gap"]["leads_to_goal_nodes"].as_u64() > Some(1) && left_out["nearest_m"][0].as_f64() == Some(12.0),
        "{left_out}"
    );
    assert!(text.contains("target 2 is left out: it is not reached over these nodes"), "{text}");

    // Below the cliff it may end, but not come back.
    let (_, json) = set(&["mission.targets_m=[[27,3],[63,3]]", "mission.return_to_start=true"]);
    assert_eq!((why(&json, 2).0.as_deref(), why(&json, 2).2), (Some("no-way-back"), Some(1)));
    // In a given order it cannot stand before another one above.
    let (_, json) = set(&["mission.targets_m=[[63,3],[27,3],[30,3]]", "mission.order=given"]);
    assert_eq!((why(&json, 1).0.as_deref(), why(&json, 1).2), (Some("not-together"), Some(2)));

    let (text, json) = set(&["budget.hops_max=7"]);
    let (reason, left_out, visited) = why(&json, 3);
    assert_eq!((reason.as_deref(), visited), (Some("budgets"), Some(2)), "{json}");
    assert!(left_out["over"][0]["total"].as_f64() > Some(7.0) && left_out["over"][0]["amount"] == "hops", "{left_out}");
    assert!(text.contains("beyond the budgets: number of hops"), "{text}");
    // Another amount than that of the objective.
    let (_, json) = set(&["budget.mission_time_max_s=120", "search.objective=[\"energy\"]"]);
    let answer: Value = serde_json::from_str(&json).unwrap();
    assert!(answer["totals"]["mission_time_s"].as_f64() < Some(120.0) && answer["best_over_nodes"] == true, "{json}");
    assert_eq!(why(&json, 3).0.as_deref(), Some("budgets"));
}

#[test]
fn require_and_trade_ask_for_all_targets() {
    let desk = desk();
    let key = "hopper.takeoff_speed_max_m_s";
    let required = desk.json(&[
        "require",
        "mission.toml",
        "--vary",
        key,
        "--from",
        "1",
        "--to",
        "3",
        "--resolution",
        "0.05",
        "--hops-max",
        "20",
    ]);
    let least = required["reachable_at"].as_f64().unwrap();
    let at = |speed: f64| {
        let set = format!("{key}={speed}");
        let words = ["plan", "mission.toml", "--set", &set, "--set", "budget.hops_max=20", "--set", "search.node_spacing_max_m=1"];
        desk.run(&words).status
    };
    assert_eq!((at(least), at(0.9 * least)), (0, 1), "{required}");
    // Without a budget the least speed takes as many hops as it likes.
    let any = desk.json(&["require", "mission.toml", "--vary", key, "--from", "1", "--to", "3", "--resolution", "0.05"]);
    assert!(any["reachable_at"].as_f64().unwrap() < least, "{any}");
    let traded = desk.json(&["trade", "mission.toml", "--vary", "hopper.takeoff_speed_max_m_s=0.5:2.5:3"]);
    let hops: Vec<Option<u64>> = traded["rows"].as_array().unwrap().iter().map(|row| row["hops"].as_u64()).collect();
    assert!(hops[0].is_none() && hops[1] > hops[2] && hops[2].is_some(), "{traded}");
}

/// Missions side by side: each row is the plan of its scenario, and one that leaves targets out has no path.
#[test]
fn missions_are_compared_as_they_are_planned() {
    let desk = desk();
    let text = desk.read("mission.toml");
    desk.write("slower.toml", text.replace("mass_kg = 5", "mass_kg = 9"));
    desk.write(
        "weak.toml",
        text.lines()
            .map(|line| if line.starts_with("takeoff_speed_max") { "takeoff_speed_max_m_s = 0.4" } else { line })
            .collect::<Vec<_>>()
            .join("\n"),
    );
    let files = ["mission.toml", "slower.toml", "weak.toml"];
    let compared = desk.json(&[&["compare"], &files[..]].concat());
    for (row, file) in compared["compared"].as_array().unwrap().iter().zip(files) {
        let plan: Value = serde_json::from_str(&desk.run(&["plan", file, "--format", "json"]).stdout).unwrap();
        for key in ["hops", "verdict"] {
            assert_eq!(row[key], plan[key], "{file}: {row}");
        }
        assert_eq!(row["totals"]["flight_time_s"], plan["totals"]["flight_time_s"], "{file}: {row}");
        assert_eq!(row["start_m"], plan["start_m"], "{file}");
    }
    assert_eq!(compared["compared"][2]["verdict"], "no-path-found");
    assert_eq!(desk.run(&[&["compare", "--require-all"], &files[..]].concat()).status, 1);
}

/// Errors: a trial that misses a target does not go on, so that shares fall from visit to visit.
#[test]
fn trials_fly_the_whole_mission() {
    let desk = desk();
    let errors =
        ["--set", "uncertainty.takeoff_speed_sigma_fraction=0.02", "--set", "uncertainty.goal_tolerance_m=0.4", "--trials", "300"];
    let shares = |more: &[&str]| {
        let answer = desk.json(&[&["simulate", "mission.toml"][..], &errors, more].concat());
        let rows = answer["visited"].as_array().unwrap().clone();
        let last = rows.last().unwrap()["reached_share"].as_f64().unwrap();
        assert_eq!(Some(last), answer["simulation"]["success_rate"].as_f64());
        assert!(rows.windows(2).all(|pair| pair[0]["trials"].as_u64() >= pair[1]["trials"].as_u64()), "{rows:?}");
        rows.iter().map(|row| row["reached_share"].as_f64().unwrap()).collect::<Vec<_>>()
    };
    let (open, replanned) = (shares(&["--policy", "open-loop"]), shares(&["--policy", "replan"]));
    assert!(open[0] > open[2] && replanned[2] > 0.8 && replanned[2] > open[2], "{open:?}, {replanned:?}");
    let ran = desk.run(&[&["simulate", "mission.toml", "--success-min", "1"][..], &errors].concat());
    assert!(ran.status == 1 && ran.stdout.contains("is not shown"), "{ran:?}");
}

#[test]
fn what_does_not_go_with_targets_is_refused_in_one_sentence() {
    let desk = desk();
    let rows: [(&[&str], &str); 12] = [
        (&["plan", "mission.toml", "--goal", "40,3"], "a mission ends at its last target"),
        (&["plan", "mission.toml", "--front", "hops,energy"], "--front"),
        (&["plan", "mission.toml", "--set", "terrain.route=transect"], "[mission] is for free routes over a dem"),
        (&["plan", "mission.toml", "--set", "mission.targets_m=[]"], "has 0 targets, expected 1 to 12"),
        (&["plan", "mission.toml", "--set", "mission.targets_m=[[27,3],[27,3]]"], "target 2 twice"),
        (&["plan", "mission.toml", "--set", "mission.targets_m=[[27,3],[24,3]]"], "target 2 is at the same place as the start"),
        (&["plan", "mission.toml", "--set", "mission.targets_m=[[27,3],[5,3]]"], "there is no ground at (5 m, 3 m)"),
        (&["plan", "mission.toml", "--set", "mission.targets_lonlat_deg=[[1,3]]"], "has no meaning beside mission.targets_m"),
        (&["plan", "mission.toml", "--set", "drive.speed_m_s=1", "--set", "drive.slope_up_max_deg=20"], "by hops alone"),
        (&["compare", "mission.toml", "mission.toml", "--prove"], "--prove"),
        (&["compare", "mission.toml", "mission.toml", "--plot", "c.svg"], "--plot"),
        (&["simulate", "mission.toml", "--tally", "t.json"], "--tally"),
    ];
    for (words, part) in rows {
        let ran = desk.run(words);
        assert_eq!(ran.status, 2, "{words:?}: {ran:?}");
        assert!(ran.stderr.contains(part) || ran.stdout.contains(part), "{part:?}: {words:?}: {ran:?}");
    }
}
