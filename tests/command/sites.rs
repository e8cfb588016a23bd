//! Landing sites against single maps.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small counts of hops and posts"
)]

use std::path::Path;

use serde_json::Value;

use crate::desk::{Desk, chta};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// A row of `sites` against the map from that place: shares, means and ways back.
fn compare(site: &Value, map: &Value, targets: &[usize]) {
    let reached = number(&map["reachable_posts"]);
    let nodes = number(&map["posts"]) - number(&map["no_data_posts"]);
    assert_eq!(number(&site["reachable_nodes"]), reached, "{site}");
    assert!((number(&site["reachable_share"]) - reached / nodes).abs() < 1e-12);
    assert!(
        (number(&site["return_share"]) - number(&map["return"]["round_trip_posts"]) / reached).abs() < 1e-12,
        "{site} {}",
        map["return"]
    );
    let goals: Vec<Option<i64>> = map["goals"].as_array().unwrap().iter().map(|goal| goal["hops"].as_i64()).collect();
    let hops: Vec<Option<i64>> = site["target_hops"].as_array().unwrap().iter().map(Value::as_i64).collect();
    assert_eq!(hops, goals, "{site}");
    let counted: Vec<f64> = if targets.is_empty() {
        let histogram = map["hops_histogram"].as_array().unwrap();
        let of_layer = |(hops, count): (usize, &Value)| std::iter::repeat_n(hops as f64, number(count) as usize);
        histogram.iter().enumerate().skip(1).flat_map(of_layer).collect()
    } else {
        goals.iter().flatten().map(|hops| *hops as f64).collect()
    };
    let mean = (!counted.is_empty()).then(|| counted.iter().sum::<f64>() / counted.len() as f64);
    assert!(
        mean.zip(site["mean_hops"].as_f64()).map_or(mean.is_none() && site["mean_hops"].is_null(), |(a, b)| (a - b).abs() < 1e-9)
    );
    assert_eq!(site["greatest_hops"].as_f64(), counted.iter().copied().reduce(f64::max), "{site}");
}

#[test]
fn sites_equal_single_maps() {
    let desk = Desk::with_dem();
    // A ditch that slow hoppers enter and do not leave.
    let height =
        |row: usize, col: usize| if (8..11).contains(&col) && row > 3 { -4.0 } else { 0.3 * ((row * 7 + col * 5) % 4) as f64 };
    let rows: Vec<String> =
        (0..16).map(|row| (0..20).map(|col| height(row, col).to_string()).collect::<Vec<_>>().join(" ")).collect();
    desk.write("ditch.asc", format!("ncols 20\nnrows 16\nxllcenter 0\nyllcenter 0\ncellsize 1\n{}\n", rows.join("\n")));
    let hopper = "[body]\ngravity_m_s2 = 1.62\n[hopper]\ntakeoff_speed_max_m_s = 2.2\nlanding_speed_max_m_s = 5\n[surface]\nfriction_coefficient = 0.9\n";
    desk.write("hopper.toml", hopper);
    for (dem, scenario, targets) in [
        ("ground.tif", "map.toml", &["9,9", "15,3"][..]),
        ("ground.tif", "map.toml", &[]),
        ("ditch.asc", "hopper.toml", &[]),
        ("ditch.asc", "hopper.toml", &["9,2", "18,8", "2,2"]),
    ] {
        let asked: Vec<&str> = targets.iter().flat_map(|target| ["--target", *target]).collect();
        let answer = desk.json(&[&["sites", dem, "--every", "4", "--scenario", scenario][..], &asked].concat());
        let sites = answer["sites"].as_array().unwrap();
        assert!(sites.len() > 12, "{answer}");
        for site in sites {
            let start = format!("{},{}", site["x_m"], site["y_m"]);
            let goals: Vec<&str> = targets.iter().flat_map(|target| ["--goal", *target]).collect();
            let words =
                [&["map", dem, "--start", &start, "--scenario", scenario, "--return", "--format", "json", "--quiet"][..], &goals]
                    .concat();
            let ran = desk.run(&words);
            let map: Value = serde_json::from_str(&ran.stdout).unwrap_or_else(|_| panic!("{words:?}: {ran:?}"));
            compare(site, &map, &targets.iter().map(|target| target.len()).collect::<Vec<_>>());
        }
        // Best first.
        let better = |pair: &[Value]| {
            let of = |site: &Value| (number(&site["targets_reached"]), number(&site["reachable_share"]));
            let (first, second) = (of(&pair[0]), of(&pair[1]));
            first.0 > second.0 || (first.0 == second.0 && (!targets.is_empty() || first.1 >= second.1))
        };
        assert!(sites.windows(2).all(better), "{answer}");
        let parts = answer["parts"].as_u64().unwrap();
        assert_eq!(answer["searches"].as_u64(), Some(sites.len() as u64 + parts));
        if dem == "ditch.asc" {
            assert!(parts > 1 && sites.iter().any(|site| number(&site["return_share"]) < 0.95), "{answer}");
        }
    }
}

#[test]
fn candidates_of_a_file_keep_their_rows_and_the_files_are_written() {
    let desk = Desk::with_dem();
    desk.write("candidates.csv", "x_m,y_m\n3,3\n9.4,9\n500,3\n");
    let words = ["sites", "ground.tif", "--candidates", "candidates.csv", "--scenario", "map.toml", "--target", "15,3"];
    let answer = desk.json(&[&words[..], &["-o", "sites.csv", "--plot", "sites.svg"]].concat());
    let sites = answer["sites"].as_array().unwrap();
    assert_eq!(sites.len(), 3);
    let last = &sites[2];
    assert!(last["candidate"] == 3 && last["refusal"].as_str().is_some_and(|why| why.contains("off the map")), "{last}");
    assert!(sites[..2].iter().all(|site| site["refusal"].is_null() && site["targets_reached"] == 1), "{answer}");
    let table = desk.read("sites.csv");
    assert!(
        table.starts_with("rank,candidate,x_m,y_m,")
            && table.lines().next().unwrap().ends_with("hops_to_target_1")
            && table.lines().count() == 4
    );
    assert!(desk.read("sites.svg").contains("target 1"));
    assert_eq!(desk.run(&["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "-o", "sites.tif"]).status, 0);
    assert!(desk.path().join("sites.tif").is_file());
    // A bound of hops: less is reached, and nothing is shared.
    let bounded = desk.json(&[&words[..], &["--set", "budget.hops_max=1"]].concat());
    assert!(number(&bounded["sites"][0]["reachable_nodes"]) < number(&sites[0]["reachable_nodes"]), "{bounded}");
    // Another amount than hops has its mean and its greatest beside them.
    let energy = desk.json(&[&words[..], &["--objective", "energy"]].concat());
    assert!(energy["amount"] == "energy" && number(&energy["sites"][0]["mean_total"]) > 0.0, "{energy}");
    // The targets of a mission, and the goal of a scenario.
    let own = desk.json(&["sites", "map.toml", "--every", "6"]);
    assert_eq!(own["targets_m"].as_array().unwrap().len(), 1, "{own}");
    for (words, part) in [
        (&["sites", "ground.tif", "--scenario", "map.toml"][..], "--every"),
        (&["sites", "ground.tif", "--every", "0", "--scenario", "map.toml"], "at least 1"),
        (&["sites", "ground.tif", "--every", "4", "--scenario", "map.toml", "-o", "sites.txt"], "ends in .csv"),
    ] {
        let ran = desk.run(words);
        assert!(ran.status == 2 && ran.stderr.contains(part), "{words:?}: {ran:?}");
    }
}

/// Single hops need no start, and are no rank of sites: on a floor that no hop leaves they are many, and lead nowhere.
#[test]
fn mobility_needs_no_start_and_is_no_rank_of_sites() {
    let desk = Desk::new();
    // A smooth floor at the bottom of a pit, on rough ground.
    let height = |row: usize, col: usize| {
        let in_pit = (4..12).contains(&row) && (4..12).contains(&col);
        if in_pit { -6.0 } else { 0.35 * ((row * 7 + col * 5) % 3) as f64 }
    };
    let rows: Vec<String> =
        (0..24).map(|row| (0..24).map(|col| height(row, col).to_string()).collect::<Vec<_>>().join(" ")).collect();
    desk.write("pit.asc", format!("ncols 24\nnrows 24\nxllcenter 0\nyllcenter 0\ncellsize 1\n{}\n", rows.join("\n")));
    let hopper = "[body]\ngravity_m_s2 = 1.62\n[hopper]\ntakeoff_speed_max_m_s = 2.2\nlanding_speed_max_m_s = 9\n[surface]\nfriction_coefficient = 0.9\n";
    desk.write("hopper.toml", hopper);
    let words = ["map", "pit.asc", "--scenario", "hopper.toml", "--mobility", "m.tif", "--plot", "m.svg"];
    let ran = desk.run(&words);
    assert!(ran.status == 0 && ran.stdout.contains("no start") && ran.stdout.contains("mobility: one hop reaches"), "{ran:?}");
    assert!(desk.read("m.svg").contains("that one hop reaches (%)") && desk.path().join("m.tif").is_file());
    assert_eq!(desk.run(&[&words[..], &["--return"]].concat()).status, 2);
    let map = desk.json(&words[..6]);
    let best = &map["mobility"]["best_m"];
    let [x, y] = [&best[0], &best[1]].map(number);
    assert!((4.0..12.0).contains(&x) && (12.0..20.0).contains(&y), "{map}");
    desk.write("two.csv", format!("x_m,y_m\n{x},{y}\n20,4\n"));
    let sites = desk.json(&["sites", "pit.asc", "--candidates", "two.csv", "--scenario", "hopper.toml"]);
    assert_eq!(sites["sites"][0]["candidate"], 2, "{sites}");
    assert!(number(&sites["sites"][1]["reachable_share"]) < 0.2, "{sites}");
}

#[test]
fn targets_may_be_given_on_the_body() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let dem = "../shared/dem/lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif";
    if !root.join(dem).is_file() {
        eprintln!("skipped: {dem} is not here");
        return;
    }
    let words = [
        "sites",
        dem,
        "--every",
        "64",
        "--stride",
        "4",
        "--target-lonlat",
        "62.8,-87.18",
        "--scenario",
        "data/scenarios/lunar_rille.toml",
    ];
    let (status, stdout, stderr) = chta(root, &[&words[..], &["--format", "json", "--quiet"]].concat());
    let answer: Value = serde_json::from_str(&stdout).unwrap_or_else(|_| panic!("{stderr}"));
    let target = &answer["targets_m"][0];
    assert!(
        status == 0 && (75_360.0..76_640.0).contains(&number(&target[0])) && (38_360.0..39_640.0).contains(&number(&target[1])),
        "{answer}"
    );
}

#[test]
fn trials_of_the_paths_to_targets_are_those_of_single_maps() {
    let desk = Desk::with_dem();
    let errors = [
        "--scenario",
        "map.toml",
        "--set",
        "uncertainty.takeoff_speed_sigma_fraction=0.03",
        "--set",
        "uncertainty.goal_tolerance_m=1",
        "--set",
        "uncertainty.seed=5",
    ];
    desk.write("two.csv", "x_m,y_m\n3,3\n9,9\n500,3\n");
    for (policy, expected) in [("open-loop", true), ("replan", false)] {
        let policy = format!("uncertainty.policy={policy}");
        let ends = ["--target", "9,9", "--target", "15,3", "--trials", "60", "--set", &policy];
        let words = [&["sites", "ground.tif", "--candidates", "two.csv", "-o", "sites.csv"][..], &errors, &ends].concat();
        let answer = desk.json(&words);
        assert_eq!(answer["trials"], 60, "{answer}");
        let sites = answer["sites"].as_array().unwrap();
        let mut some_fail = false;
        for site in sites.iter().filter(|site| site["refusal"].is_null()) {
            let start = format!("{},{}", site["x_m"], site["y_m"]);
            for (goal, success) in ["9,9", "15,3"].iter().zip(site["target_success"].as_array().unwrap()) {
                if start.replace(".0", "") == *goal {
                    assert_eq!(*success, 1.0, "{site}");
                    continue;
                }
                let of_map = ["--simulate", "--set", "uncertainty.trials=60", "--set", &policy];
                let map = [&["map", "ground.tif", "--start", &start, "--goal", goal][..], &errors, &of_map].concat();
                let map = desk.json(&map);
                assert_eq!(map["goals"][0]["simulation"]["success_rate"], *success, "{site}: {goal}");
                some_fail |= number(success) < 1.0;
            }
            let least = site["target_success"].as_array().unwrap().iter().map(number).fold(1.0, f64::min);
            assert_eq!(number(&site["success"]), least, "{site}");
        }
        assert!(some_fail || !expected, "{answer}");
        assert!(sites[2]["success"].is_null(), "{answer}");
        assert!(desk.read("sites.csv").lines().next().unwrap().ends_with("success_to_target_1,success_to_target_2"));
    }
    // A target that no hop reaches has no share, and the reason.
    let slow = ["--target", "9,9", "--trials", "5", "--set", "hopper.takeoff_speed_max_m_s=0.1"];
    let answer = desk.json(&[&["sites", "ground.tif", "--every", "19", "--scenario", "map.toml"][..], &slow].concat());
    let why = answer["sites"][0]["success_missing"].as_str().unwrap_or_default();
    assert!(why.contains("no path to fly") && answer["sites"][0]["success"].is_null(), "{answer}");
    // Without a target nothing is flown.
    let ran = desk.run(&["sites", "ground.tif", "--every", "9", "--scenario", "map.toml", "--trials", "5"]);
    assert!(ran.status == 2 && ran.stderr.contains("found trials of landing sites and no target"), "{ran:?}");
    let size = desk.json(&["sites", "map.toml", "--every", "6", "--trials", "5", "--dry-run"]);
    assert_eq!(size["trials_max"].as_u64().map(|trials| trials % 5), Some(0), "{size}");
    assert!(size["searches_max"].as_u64().is_some_and(|searches| searches > 8), "{size}");
}
