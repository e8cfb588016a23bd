//! Every key of the catalogue, in every command: it changes the answer, or a warning or refusal says that it does not.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use crate::desk::Desk;
use chta::scenario::{CATALOGUE, Key};
use serde_json::Value;

/// A value of each key that matters where the key does. A title is only a label.
const TELLING: [(&str, &str); 130] = [
    ("body.name", "moon"),
    ("body.gravity_m_s2", "0.05"),
    ("body.radius_m", "1000"),
    ("hopper.takeoff_speed_max_m_s", "1.2"),
    ("hopper.landing_speed_max_m_s", "1.2"),
    ("hopper.clearance_m", "30"),
    ("hopper.clearance_rule", "vertex"),
    ("hopper.clearance_taper", "3"),
    ("hopper.takeoff_angle_min_deg", "85"),
    ("hopper.takeoff_angle_max_deg", "50"),
    ("hopper.apex_height_max_m", "0.5"),
    ("hopper.flight_time_max_s", "1.5"),
    ("hopper.takeoff_speed_min_m_s", "2.4"),
    ("hopper.takeoff_speed_levels_m_s", "[1.1]"),
    ("hopper.takeoff_angle_step_deg", "7"),
    ("hopper.takeoff_speed_step_m_s", "0.8"),
    ("hopper.heading_step_deg", "20"),
    ("hopper.radius_m", "0.1"),
    ("hopper.footprint_m", "25"),
    ("hopper.roughness_max_m", "0.01"),
    ("hopper.mass_kg", "7"),
    ("hopper.rest_time_s", "100"),
    ("hopper.landing", "braked"),
    ("hopper.touchdown_speed_m_s", "0.5"),
    ("hopper.hop_delta_v_overhead_m_s", "2"),
    ("hopper.isp_s", "200"),
    ("hopper.propellant_max_kg", "1"),
    ("hopper.preparation_time_s", "60"),
    ("hopper.settling_time_s", "60"),
    ("hopper.preparation_energy_j", "60"),
    ("hopper.efficiency", "0.5"),
    ("robot.file", "none.toml"),
    ("robot.cone", "kc"),
    ("robot.up", "vertical"),
    ("robot.headings", "4"),
    ("surface.friction_coefficient", "0.3"),
    ("surface.rest_slope_max_deg", "1"),
    ("surface.keep_out", "none.tif"),
    ("surface.keep_in", "none.tif"),
    ("surface.group", "{ ice = { friction_coefficient = 0.1 } }"),
    ("surface.friction_raster", "none.tif"),
    ("surface.takeoff_from_slope_deg", "[60, 90]"),
    ("surface.landing_from_slope_deg", "[-90, -60]"),
    ("layer.NAME", "{ raster = \"none.tif\", min = 1 }"),
    ("contact.restitution_normal", "0.7"),
    ("contact.restitution_tangential", "0.9"),
    ("contact.settle_speed_m_s", "0.4"),
    ("terrain.dem", "none.csv"),
    ("terrain.mesh", "none.csv"),
    ("terrain.chain", "none.csv"),
    ("terrain.mesh_scale", "2"),
    ("terrain.no_data", "none"),
    ("terrain.start_m", "[3, 3]"),
    ("terrain.goal_m", "[3, 3]"),
    ("terrain.start_lonlat_deg", "[3, 3]"),
    ("terrain.goal_lonlat_deg", "[3, 3]"),
    ("terrain.via_m", "[[3, 3]]"),
    ("terrain.via_lonlat_deg", "[[3, 3]]"),
    ("terrain.accept_map_scale", "true"),
    ("terrain.route", "free"),
    ("terrain.start_x_m", "12"),
    ("terrain.goal_x_m", "28"),
    ("search.points_per_segment", "3"),
    ("search.node_spacing_max_m", "0.7"),
    ("search.planner", "prm"),
    ("search.contacts_max", "20"),
    ("search.stand_off_m", "0.1"),
    ("search.bounds_m", "[[0, 0, 0], [1, 1, 1]]"),
    ("search.seed", "7"),
    ("search.time_max_s", "9"),
    ("search.effort", "energy"),
    ("search.takeoff_angle", "least-time"),
    ("search.split", "equal"),
    ("search.risk", "fewest-hops"),
    ("search.risk_extra_hops_max", "2"),
    ("search.objective", "[\"distance\", \"energy\"]"),
    ("budget.hops_max", "2"),
    ("budget.mission_time_max_s", "3"),
    ("budget.flight_time_total_max_s", "3"),
    ("budget.energy_max_j_kg", "2"),
    ("budget.energy_max_j", "2"),
    ("budget.delta_v_max_m_s", "2"),
    ("budget.estimated_success_min", "1"),
    ("derating.takeoff_speed", "0.5"),
    ("derating.landing_speed", "0.5"),
    ("derating.friction", "0.5"),
    ("uncertainty.takeoff_speed_sigma_m_s", "0.3"),
    ("uncertainty.takeoff_speed_sigma_fraction", "0.2"),
    ("uncertainty.takeoff_angle_sigma_deg", "9"),
    ("uncertainty.heading_sigma_deg", "9"),
    ("uncertainty.position_sigma_m", "2"),
    ("uncertainty.drift_along_sigma_m", "3"),
    ("uncertainty.drift_across_sigma_m", "3"),
    ("uncertainty.friction_sigma", "0.4"),
    ("uncertainty.height_sigma_m", "1"),
    ("uncertainty.height_correlation_m", "7"),
    ("uncertainty.takeoff_speed_bias_sigma_fraction", "0.2"),
    ("uncertainty.takeoff_angle_bias_sigma_deg", "9"),
    ("uncertainty.heading_bias_sigma_deg", "9"),
    ("uncertainty.distribution", "uniform"),
    ("uncertainty.errors", "none.csv"),
    ("uncertainty.goal_tolerance_m", "0.01"),
    ("uncertainty.hop_limit", "1"),
    ("uncertainty.policy", "open-loop"),
    ("uncertainty.trials", "77"),
    ("uncertainty.seed", "5"),
    ("uncertainty.heading", "uncontrolled"),
    ("uncertainty.takeoff_speed_m_s", "2"),
    ("uncertainty.takeoff_angle_deg", "40"),
    ("drive.travel", "drive"),
    ("drive.speed_m_s", "0.5"),
    ("drive.slope_up_max_deg", "30"),
    ("drive.slope_down_max_deg", "30"),
    ("drive.cross_slope_max_deg", "30"),
    ("drive.step_max_m", "0.1"),
    ("drive.roughness_max_m", "0.1"),
    ("drive.wheelbase_m", "0.4"),
    ("drive.neighbours", "8"),
    ("drive.turn_s_per_deg", "1"),
    ("drive.slip", "[[0, 0], [20, 0.5]]"),
    ("drive.rolling_resistance", "0.2"),
    ("drive.drive_efficiency", "0.5"),
    ("drive.idle_power_w", "5"),
    ("drive.failure_per_m", "0.01"),
    ("drive.heading_sigma_deg", "3"),
    ("drive.length_sigma_fraction", "0.1"),
    ("mission.targets_m", "[[3, 3]]"),
    ("mission.targets_lonlat_deg", "[[3, 3]]"),
    ("mission.order", "given"),
    ("mission.return_to_start", "true"),
];

/// A scenario over a chain on which every limit can bind and trials fail now and then.
const RICH: &str = "[body]\nname = \"ceres\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\n\
    clearance_m = 0.02\nclearance_taper = 2\n[surface]\nfriction_coefficient = 0.7\n[terrain]\nchain = \"chain.csv\"\nstart_x_m = 0\ngoal_x_m = 40\n";

/// Its trials.
const ERRORS: &str = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ntakeoff_angle_sigma_deg = 0.2\nheight_sigma_m = 0.005\n\
    height_correlation_m = 3\ngoal_tolerance_m = 3\ntrials = 60\n\
    [search]\ntakeoff_angle = \"mid-range\"\n";

/// The answer without what repeats the input.
fn answer(stdout: &str) -> Option<Value> {
    let mut document: Value = serde_json::from_str(stdout).ok()?;
    let keys = document.as_object_mut()?;
    for echo in ["scenario", "inputs", "warnings"] {
        keys.remove(echo);
    }
    Some(document)
}

#[test]
fn every_key_changes_the_answer_or_is_said_to_have_no_effect() {
    let desk = Desk::with_dem();
    desk.write("rich.toml", RICH);
    desk.write(
        "near.toml",
        RICH.replace("max_m_s = 2.5", "max_m_s = 3.5")
            .replace("start_x_m = 0", "start_x_m = 10")
            .replace("goal_x_m = 40", "goal_x_m = 30"),
    );
    desk.write("errors.toml", format!("{RICH}{ERRORS}"));
    desk.write("risk.toml", format!("{RICH}{ERRORS}risk = \"traded\"\n"));
    let on_dem = RICH
        .replace("chain = \"chain.csv\"\nstart_x_m = 0\ngoal_x_m = 40", "dem = \"ground.tif\"\nstart_m = [1, 2]\ngoal_m = [8, 7]");
    desk.write("slow.toml", format!("{RICH}{ERRORS}").replace("max_m_s = 2.5", "max_m_s = 1.5"));
    desk.write("dem.toml", format!("{on_dem}{ERRORS}").replace("max_m_s = 2.5", "max_m_s = 1.5"));
    let vary = "hopper.takeoff_speed_max_m_s=1:3:3";
    let map = ["map", "ground.tif", "--start", "1,2", "--scenario", "slow.toml"];
    let commands: [Vec<&str>; 12] = [
        vec!["hop", "near.toml"],
        vec!["check", "rich.toml"],
        vec!["plan", "risk.toml"],
        vec!["plan", "rich.toml"],
        vec!["plan", "dem.toml"],
        vec!["simulate", "errors.toml"],
        vec!["simulate", "dem.toml", "--policy", "replan"],
        vec!["trade", "rich.toml", "--vary", vary],
        vec!["fan", "ground.tif", "--from", "9,9", "--headings", "8", "--length", "9", "--scenario", "slow.toml"],
        map.to_vec(),
        [&map[..], &["--goal", "15,12", "--effort"]].concat(),
        [&map[..], &["--goal", "15,12", "--simulate"]].concat(),
    ];
    // Limits that do not bind and choices that happen to agree on this ground: the key is used, and changes other answers.
    let agrees = |command: &[&str], key: &str| {
        match key {
            // A permission, a budget that no better path uses up, a choice among equals, a criterion after others.
            "terrain.accept_map_scale"
            | "terrain.no_data"
            | "search.risk_extra_hops_max"
            | "search.effort"
            | "search.split"
            | "search.risk"
            | "search.points_per_segment" => true,
            // The value that the command's own option has.
            "uncertainty.policy" => command.contains(&"--policy"),
            "search.takeoff_angle" => !matches!(command[0], "simulate" | "hop"),
            _ => false,
        }
    };
    for path in CATALOGUE.iter().map(Key::path).filter(|path| path != "report.title") {
        assert!(TELLING.iter().any(|(name, _)| *name == path), "{path} needs a value that matters in TELLING");
    }
    let mut silent = Vec::new();
    for command in &commands {
        let base = desk.run(&[&command[..], &["--format", "json", "--threads", "1"]].concat());
        // `hop` has no threads.
        let threads: &[&str] = if command[0] == "hop" { &[] } else { &["--threads", "1"] };
        let base = if command[0] == "hop" { desk.run(&[&command[..], &["--format", "json"]].concat()) } else { base };
        let before = answer(&base.stdout).unwrap_or_else(|| panic!("{command:?}: {base:?}"));
        for (path, value) in TELLING {
            let set = format!("{path}={value}");
            let ran = desk.run(&[&command[..], &["--format", "json", "--set", &set], threads].concat());
            let said = ran.status == 2 && !ran.stderr.is_empty() || ran.stderr.contains(path) && ran.stderr != base.stderr;
            let changed = answer(&ran.stdout).is_some_and(|after| after != before);
            if !(said || changed || agrees(command, path)) {
                silent.push(format!("{command:?} --set {set}: {}", ran.stderr));
            }
        }
    }
    assert!(silent.is_empty(), "without effect and without a word:\n{}", silent.join("\n"));
}

#[test]
fn settings_that_others_replace_or_trials_do_not_feel_are_said() {
    let desk = Desk::with_dem();
    let own = "x_m,z_m,friction_coefficient\n0,0,0.7\n20,0,0.7\n40,0,\n";
    desk.write("own.csv", own);
    desk.write("bare.csv", "x_m,z_m\n0,0\n20,0\n40,0\n");
    let angles = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 9\nlanding_speed_max_m_s = 9\n[surface]\n\
        takeoff_from_slope_deg = [20, 90]\nlanding_from_slope_deg = [-90, -20]\n[terrain]\nchain = \"bare.csv\"\nstart_x_m = 0\ngoal_x_m = 40\n";
    desk.write("angles.toml", angles);
    let plain = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 9\nlanding_speed_max_m_s = 9\n[surface]\n\
        friction_coefficient = 0.8\n[terrain]\nchain = \"bare.csv\"\nstart_x_m = 0\ngoal_x_m = 40\n";
    desk.write("plain.toml", plain);
    desk.write("own.toml", plain.replace("bare.csv", "own.csv"));
    let grid = |value: &str, cols: usize| {
        let row = format!("{value} ").repeat(cols);
        format!(
            "ncols {cols}\nnrows 20\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n{}",
            format!("{row}\n").repeat(20)
        )
    };
    desk.write("full.asc", grid("0.7", 20));
    desk.write("nothing.asc", grid("-9999", 20));
    let trials = |key: &str| ["--set".to_owned(), format!("uncertainty.{key}")];
    let of = |target: &str, keys: &[&str]| {
        let mut args: Vec<String> = ["simulate", target, "--trials", "20"].map(str::to_owned).to_vec();
        args.extend(keys.iter().flat_map(|key| trials(key)));
        args
    };
    let with = |mut args: Vec<String>, more: &[&str]| {
        args.extend(more.iter().map(|one| (*one).to_owned()));
        args
    };
    let plan = |more: &[&str]| with(vec!["plan".to_owned()], more);
    // A command, and what standard error must contain, or with "!" must not.
    let rows: [(Vec<String>, &[&str]); 27] = [
        (
            with(of("plain.toml", &["position_sigma_m=1"]), &["--policy", "open-loop"]),
            &["uncertainty.position_sigma_m = 1 has no effect", "\"replan\"", "no meaning"],
        ),
        (with(of("plain.toml", &["position_sigma_m=1"]), &["--policy", "replan"]), &["!position_sigma_m"]),
        (with(of("plain.toml", &["position_sigma_m=1"]), &["--compare"]), &["!position_sigma_m"]),
        (
            with(of("map.toml", &["position_sigma_m=1", "heading_sigma_deg=1"]), &["--policy", "open-loop"]),
            &["position_sigma_m = 1 has no effect", "!no meaning"],
        ),
        (of("angles.toml", &["friction_sigma=0.1"]), &["uncertainty.friction_sigma = 0.1 has no effect"]),
        (of("plain.toml", &["friction_sigma=0.1"]), &["!friction_sigma"]),
        (of("plain.toml", &["friction_sigma=0.9"]), &["uncertainty.friction_sigma is 0.9, over 0.8"]),
        (of("plain.toml", &["takeoff_speed_sigma_m_s=20"]), &["takeoff_speed_sigma_m_s is 20, over 9 m/s"]),
        (of("plain.toml", &["takeoff_speed_sigma_fraction=2"]), &["takeoff_speed_sigma_fraction is 2, over 0.5", "0.02 is 2 %"]),
        (of("plain.toml", &["takeoff_speed_sigma_fraction=100"]), &["takeoff_speed_sigma_fraction is 100, over 0.5"]),
        (of("plain.toml", &["takeoff_speed_sigma_fraction=0.1"]), &["!sigma_fraction"]),
        (of("plain.toml", &["takeoff_angle_sigma_deg=90"]), &["takeoff_angle_sigma_deg is 90, over 45 deg"]),
        (of("map.toml", &["heading_sigma_deg=180"]), &["heading_sigma_deg is 180, over 45 deg"]),
        (with(of("plain.toml", &["position_sigma_m=1000"]), &["--policy", "replan"]), &["position_sigma_m is 1000, over 40 m"]),
        (of("plain.toml", &["drift_along_sigma_m=41"]), &["drift_along_sigma_m is 41, over 40 m"]),
        (of("plain.toml", &["drift_across_sigma_m=41"]), &["drift_across_sigma_m is 41, over 40 m"]),
        (of("plain.toml", &["height_sigma_m=5", "height_correlation_m=1"]), &["slope errors with a deviation of 79 deg"]),
        (of("plain.toml", &["drift_along_sigma_m=1", "goal_tolerance_m=50"]), &["goal_tolerance_m is 50 m, no less than the 40 m"]),
        (of("plain.toml", &["drift_along_sigma_m=1", "hop_limit=1"]), &["hop_limit is 1, below the 2 hops"]),
        (plan(&["own.toml"]), &["surface.friction_coefficient has no effect", "states its own"]),
        (plan(&["plain.toml"]), &["!no effect"]),
        (
            plan(&["plain.toml", "--set", "search.risk=traded", "--set", "uncertainty.trials=9"]),
            &["search.risk = \"traded\" has no effect"],
        ),
        (plan(&["plain.toml", "--set", "search.risk=traded"]), &["!no effect"]),
        (
            plan(&["map.toml", "--set", "surface.friction_raster=full.asc"]),
            &["surface.friction_coefficient has no effect", "raster"],
        ),
        (plan(&["plain.toml", "--set", "terrain.accept_map_scale=true"]), &["terrain.accept_map_scale has no effect"]),
        (
            with(vec!["trade".to_owned()], &["plain.toml", "--vary", "hopper.clearance_m=0:1:2", "--set", "search.risk=traded"]),
            &["search.risk has no effect", "used by check, plan, run, simulate, compare"],
        ),
        (
            with(
                vec!["fan".to_owned()],
                &["ground.tif", "--from", "9,9", "--length", "5", "--scenario", "plain.toml", "--effort", "energy"],
            ),
            &["--effort: search.effort has no effect on this answer of chta fan"],
        ),
    ];
    for (args, parts) in rows {
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let ran = desk.run(&args);
        assert!(ran.status < 2, "{args:?}: {ran:?}");
        for part in parts {
            match part.strip_prefix('!') {
                Some(absent) => assert!(!ran.stderr.contains(absent), "{absent:?} is in {} of {args:?}", ran.stderr),
                None => assert!(ran.stderr.contains(part), "{part:?} is not in {} of {args:?}", ran.stderr),
            }
        }
    }
}

#[test]
fn the_outcome_of_a_trial_stands_in_the_row_of_its_last_hop() {
    let desk = Desk::new();
    desk.write("bare.csv", "x_m,z_m\n-40,0\n0,0\n20,0\n40,0\n90,0\n");
    let plain = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 9\nlanding_speed_max_m_s = 9\n[surface]\n\
        friction_coefficient = 0.8\n[terrain]\nchain = \"bare.csv\"\nstart_x_m = 0\ngoal_x_m = 40\n[uncertainty]\n\
        takeoff_speed_sigma_fraction = 0.02\nfriction_sigma = 0.05\ngoal_tolerance_m = 1\ntrials = 300\n";
    desk.write("plain.toml", plain);
    for policy in ["open-loop", "replan"] {
        let document = desk.json(&["simulate", "plain.toml", "--policy", policy, "-o", "rows.csv"]);
        let rows = desk.read("rows.csv");
        let outcomes: Vec<&str> = rows.lines().skip(1).map(|row| row.split(',').nth(3).unwrap()).collect();
        for outcome in ["reached", "missed", "slid_at_landing", "damaged", "stuck", "hop_limit"] {
            let rows = outcomes.iter().filter(|one| **one == outcome).count();
            assert_eq!(document["outcomes"][outcome], rows, "{policy} {outcome}");
        }
        assert!(outcomes.contains(&"reached"), "{policy}");
    }
}

#[test]
fn a_goal_that_is_not_reachable_has_no_trials_and_the_map_says_so() {
    let desk = Desk::with_dem();
    let slow = ["--set", "hopper.takeoff_speed_max_m_s=0.01", "--set", "uncertainty.takeoff_speed_sigma_fraction=0.01"];
    let map = ["map", "ground.tif", "--start", "1,2", "--goal", "15,12", "--simulate", "--scenario", "map.toml"];
    let ran = desk.run(&[&map[..], &slow].concat());
    assert_eq!(ran.status, 1, "{ran:?}");
    assert!(ran.stderr.contains("no trials were flown to the goal (15.000, 12.000) m: it was not reached"), "{}", ran.stderr);
}

#[test]
fn defaults_of_synth_fit_the_options_that_are_given() {
    let desk = Desk::new();
    for options in [
        &["--craters", "--spacing-m", "10"][..],
        &["--craters", "--spacing-m", "0.01"],
        &["--craters", "--rows", "2", "--cols", "2"],
        &["--craters", "--crater-diameter-max-m", "3"],
        &["--craters", "--crater-diameter-min-m", "100"],
        &["--craters", "--rows", "900", "--cols", "900", "--spacing-m", "400"],
        &["--rille", "--spacing-m", "100"],
        &["--boulders", "--spacing-m", "3"],
        &["--boulders", "--boulder-diameter-min-m", "6"],
        &["--boulders", "--boulder-diameter-max-m", "0.5", "--spacing-m", "0.1"],
    ] {
        let ran = desk.run(&[&["synth", "-o", "new.tif"], options].concat());
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{options:?}");
    }
    // Nothing of the usual boulders is left at this spacing: refused, with what was given and what mends it.
    desk.refused(
        &["synth", "-o", "b.tif", "--boulders", "--spacing-m", "10"],
        &["found a post spacing of 10 m", "at most 4 m", "--spacing-m"],
    );
    // What is typed is still checked.
    desk.refused(
        &["synth", "-o", "b.tif", "--craters", "--crater-diameter-min-m", "0.1"],
        &["diameter_min_m is 0.1", "at least 1 m"],
    );
}

#[test]
fn a_hop_along_a_segment_far_from_zero_passes_its_own_check() {
    let desk = Desk::new();
    for x_m in [0.0, 1000.0, 3000.0, 1e5, 1e7] {
        desk.write("far.csv", format!("x_m,z_m\n{x_m},0\n{},0\n", x_m + 100.0));
        let ends = [x_m.to_string(), (x_m + 48.0).to_string()];
        // 48 m are 1000 hops of exactly the reach under an apex of 0.02 m at a slope of 1 / 0.6; the other limits bind as well.
        for limit in ["apex_height_max_m=0.02", "flight_time_max_s=0.3", "takeoff_speed_max_m_s=0.3"] {
            for split in ["equal", "full-reach"] {
                let (limit, split) = (format!("hopper.{limit}"), format!("search.split={split}"));
                let mut args =
                    vec!["plan", "far.csv", "--verify", "--gravity-m-s2", "1.62", "--start", &ends[0], "--goal", &ends[1]];
                for set in [
                    "hopper.takeoff_speed_max_m_s=5",
                    "hopper.landing_speed_max_m_s=5",
                    "surface.friction_coefficient=0.6",
                    &limit,
                    &split,
                ] {
                    args.extend(["--set", set]);
                }
                let ran = desk.run(&args);
                assert_eq!(ran.status, 0, "{args:?}: {}", ran.stderr);
            }
        }
    }
}

#[test]
fn require_says_whether_its_resolution_is_met() {
    let desk = Desk::new();
    let scenario = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenarios/simple_reduced.toml");
    let require = ["require", scenario, "--vary", "hopper.takeoff_speed_max_m_s"];
    let coarse = [&require[..], &["--resolution", "0.5"]].concat();
    let met = desk.json(&coarse);
    assert_eq!(met["resolution_met"], true, "{met}");
    // So few cells leave the values near the threshold open.
    let few = [&require[..], &["--prove-cells-max", "200"]].concat();
    let missed = desk.json(&few);
    let [Some(low), Some(high)] = [&missed["unreachable_at"], &missed["reachable_at"]].map(Value::as_f64) else {
        panic!("no bracket: {missed}")
    };
    assert!((high - low) / high > 0.001 && missed["resolution_met"] == false, "{missed}");
    assert!(desk.run(&few).stdout.contains("the resolution of 0.001 is not met: the values between"));
    assert!(!desk.run(&coarse).stdout.contains("resolution"));
}
