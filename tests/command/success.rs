//! A budget of success, the least value with enough of it, and derated limits: planted answers, exit statuses, refusals.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use crate::desk::Desk;
use chta::quantity::normal_cdf;
use serde_json::Value;

/// One hop of 20 m over level ground whose ends are far away, with a friction and speeds that no error reaches.
const LEVEL: &str = "[body]\ngravity_m_s2 = 3.711\n[hopper]\ntakeoff_speed_max_m_s = 10\nlanding_speed_max_m_s = 50\n\
    [surface]\nfriction_coefficient = 3\n[terrain]\nchain = \"level.csv\"\nstart_x_m = 0\ngoal_x_m = 20\n\
    [search]\npoints_per_segment = 0\nrisk = \"fewest-hops\"\ntakeoff_angle = \"mid-range\"\n\
    [uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ngoal_tolerance_m = 1\npolicy = \"open-loop\"\ntrials = 50\n";

fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("level.csv", "x_m,z_m\n-60,0\n90,0\n");
    desk.write("level.toml", LEVEL);
    desk.write("rolling.toml", shipped("rolling_surely.toml").replace("../chains/rolling_100.csv", "rolling_100.csv"));
    let chain = std::fs::read(format!("{}/data/chains/rolling_100.csv", env!("CARGO_MANIFEST_DIR"))).unwrap();
    desk.write("rolling_100.csv", chain);
    desk
}

fn shipped(name: &str) -> String {
    let text = std::fs::read_to_string(format!("{}/data/scenarios/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    text.replace("trials = 4000", "trials = 50")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Of a hop of 20 m whose speed is off by z sigmas the range is 20 (1 + sigma z)^2, whatever its angle and gravity.
fn success(sigma: f64, tolerance_m: f64) -> f64 {
    let z = |range_m: f64| ((range_m / 20.0).sqrt() - 1.0) / sigma;
    normal_cdf(z(20.0 + tolerance_m)) - normal_cdf(z(20.0 - tolerance_m))
}

/// Where a growing function is 0, by bisection.
fn root(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if of(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn the_least_value_with_enough_success_is_that_of_the_closed_form() {
    let desk = desk();
    for wanted in [0.7, 0.9, 0.97] {
        let of_sigma = root(|sigma| wanted - success(sigma, 1.0), 1e-4, 0.2);
        let of_tolerance = root(|tolerance_m| success(0.02, tolerance_m) - wanted, 1e-3, 10.0);
        for (key, to, planted) in
            [("uncertainty.takeoff_speed_sigma_fraction", "0.2", of_sigma), ("uncertainty.goal_tolerance_m", "5", of_tolerance)]
        {
            let least = wanted.to_string();
            let words = ["require", "level.toml", "--vary", key, "--from", "0.001", "--to", to, "--success-min", &least];
            let document = desk.json(&words);
            let found = &document["success"];
            let (from, to) = (number(&found["uncertain_from"]), number(&found["uncertain_to"]));
            assert!(from.min(to) <= planted && planted <= from.max(to), "{key} for {wanted}: {planted} in {found}");
            let at = number(&document["reachable_at"]);
            assert!((at / planted - 1.0).abs() < 0.1, "{key} for {wanted}: {at} beside {planted}");
            let [low, high] = [0, 1].map(|i| number(&found["at"]["success_estimated_ci95"][i]));
            assert!(low <= wanted && wanted <= high && number(&found["at"]["success_estimated"]) >= wanted, "{found}");
            assert_eq!(
                (&document["unreachable_at"], &document["resolution_met"], &found["monotone"]),
                (&Value::Null, &true.into(), &true.into())
            );
            // The value is that of the scenario in the document, whose plan meets the budget.
            desk.write("again.json", document.to_string());
            let again = desk.json(&["check", "again.json"]);
            assert_eq!((&again["success_budget"]["met"], &again["verdict"]), (&true.into(), &"traversable".into()), "{again}");
            let text = desk.run(&words).stdout;
            assert!(text.contains("512 fixed trials, with the same draws at every value") && text.contains("contains"), "{text}");
        }
    }
}

#[test]
fn statuses_and_sentences_of_success() {
    let desk = desk();
    // A command with its budget, the status, and what standard output has.
    let met = "of budget.estimated_success_min";
    let unmet = "the best estimated success over these paths is 0.";
    let vary = "hopper.takeoff_speed_max_m_s=7:8:2";
    let rows: [(&[&str], &str, i32, &str); 14] = [
        (&["check", "rolling.toml"], "0.9", 0, met),
        (&["check", "rolling.toml"], "1", 1, unmet),
        (&["check", "rolling.toml", "--pairs", "pairs.csv"], "1", 1, unmet),
        (&["check", "rolling.toml", "--prove"], "1", 1, unmet),
        (&["plan", "rolling.toml", "--verify"], "0.5", 0, met),
        (&["plan", "rolling.toml"], "1", 1, unmet),
        (&["plan", "level.toml", "--goal", "0"], "1", 0, "estimated success 1.0000"),
        (&["run", "rolling.toml", "-o", "out"], "0.5", 0, met),
        (&["run", "rolling.toml", "-o", "out"], "1", 1, unmet),
        (&["simulate", "rolling.toml"], "1", 1, "no-path-found"),
        (&["trade", "rolling.toml", "--vary", vary], "1", 0, "none with an estimated success of at least 1"),
        (&["trade", "rolling.toml", "--vary", vary, "--require-all"], "1", 1, "0 of 2 cells have a path"),
        (&["require", "level.toml", "--vary", "uncertainty.goal_tolerance_m", "--to", "0.5"], "0.9", 1, "at no value tried"),
        (&["require", "level.toml", "--vary", "uncertainty.goal_tolerance_m", "--to", "5"], "0.9", 0, "of at least 0.9 at"),
    ];
    desk.write("pairs.csv", "start_x_m,goal_x_m\n3,3\n3,95\n");
    for (words, least, status, part) in rows {
        let set = format!("budget.estimated_success_min={least}");
        let ran = desk.run(&[words, &["--set", &set]].concat());
        assert_eq!(ran.status, status, "{words:?} at {least}: {ran:?}");
        assert!(ran.stdout.contains(part), "{words:?} at {least}: {part:?} is not in {}", ran.stdout);
    }
    let compared = |least: &str| {
        let set = format!("budget.estimated_success_min={least}");
        desk.run(&["compare", "rolling.toml", "level.toml", "--require-all", "--set", &set]).status
    };
    assert_eq!((compared("0.4"), compared("1")), (0, 1));
}

/// The fewest hops of the front with enough success: each row's own success is met by that row.
#[test]
fn a_budget_takes_the_fewest_hops_of_the_front_that_meet_it() {
    let desk = desk();
    let front = desk.json(&["plan", "rolling.toml", "--front", "hops,risk"])["front"].clone();
    let rows = front.as_array().unwrap();
    assert!(rows.len() > 1, "{front}");
    for row in rows {
        let set = format!("budget.estimated_success_min={}", number(&row["success_estimated"]));
        let planned = desk.json(&["plan", "rolling.toml", "--front", "hops,risk", "--set", &set]);
        assert_eq!((&planned["hops"], &planned["success_budget"]["met"]), (&row["hops"], &true.into()), "{row}");
        assert_eq!(planned["success_budget"]["success_estimated"], row["success_estimated"]);
        let chosen: Vec<_> = planned["front"].as_array().unwrap().iter().filter(|row| row["planned"] == true).cloned().collect();
        assert_eq!(chosen.iter().map(|row| &row["hops"]).collect::<Vec<_>>(), [&row["hops"]]);
    }
    // Without enough, the best that was found.
    let best = rows.last().unwrap();
    let planned = desk.json(&["plan", "rolling.toml", "--set", "budget.estimated_success_min=1"]);
    let found = &planned["success_budget"];
    assert_eq!(
        (&found["met"], &found["hops"], &found["success_estimated"]),
        (&false.into(), &best["hops"], &best["success_estimated"])
    );
    assert_eq!(planned["verdict"], "no-path-found");
}

#[test]
fn a_trade_with_a_budget_agrees_with_check() {
    let desk = desk();
    let words = ["--set", "budget.estimated_success_min=0.9", "--quiet", "--format", "json"];
    let vary = "uncertainty.takeoff_speed_sigma_fraction=0.005:0.035:4";
    let trade = desk.json(&[&["trade", "level.toml", "--vary", vary][..], &words[..3]].concat());
    let rows = trade["rows"].as_array().unwrap();
    let verdicts: Vec<_> = rows.iter().map(|row| row["verdict"].as_str().unwrap()).collect();
    // The closed form has 0.9 at a deviation of 0.0152.
    assert_eq!(verdicts, ["traversable", "traversable", "no-path-found", "no-path-found"].map(|verdict| verdict), "{rows:?}");
    for row in rows {
        let sigma = format!("uncertainty.takeoff_speed_sigma_fraction={}", row["uncertainty.takeoff_speed_sigma_fraction"]);
        let check = desk.json(&[&["check", "level.toml", "--set", &sigma][..], &words[..3]].concat());
        assert_eq!((&row["verdict"], &row["success_budget"]), (&check["verdict"], &check["success_budget"]), "{row}");
    }
}

#[test]
fn contradictions_of_success_and_derating_are_refused() {
    let desk = desk();
    desk.write(
        "angles.toml",
        LEVEL.replace("friction_coefficient = 3", "takeoff_from_slope_deg = [20, 90]\nlanding_from_slope_deg = [-90, -20]"),
    );
    let plain = desk.read("scenario.toml");
    assert!(!plain.contains("[uncertainty]"), "{plain}");
    // The command, and what standard error has.
    let rows: [(&[&str], &[&str]); 14] = [
        (&["check", "scenario.toml", "--set", "budget.estimated_success_min=0.9"], &["without [uncertainty]", "add [uncertainty]"]),
        (
            &["plan", "level.toml", "--set", "search.risk=ignored", "--set", "budget.estimated_success_min=0.9"],
            &["search.risk = \"ignored\"", "set risk = \"traded\""],
        ),
        (&["plan", "level.toml", "--set", "budget.estimated_success_min=1.5"], &["estimated_success_min is 1.5", "from 0 to 1"]),
        (&["plan", "level.toml", "--set", "budget.hops_max=3"], &["search.risk = \"fewest-hops\"", "remove risk"]),
        (&["plan", "scenario.toml", "--front", "hops,risk"], &["--front", "found no [uncertainty]", "goal_tolerance_m"]),
        (&["plan", "level.toml", "--front", "hops,fuel"], &["--front", "found 'hops,fuel'", "or hops,risk or"]),
        (&["plan", "level.toml", "--plot-front", "front.svg"], &["--front"]),
        (
            &["require", "level.toml", "--quiet", "--vary", "uncertainty.goal_tolerance_m"],
            &["no success that is wanted", "--success-min"],
        ),
        (
            &["require", "level.toml", "--vary", "search.effort", "--success-min", "0.9"],
            &["search.effort", "uncertainty.goal_tolerance_m"],
        ),
        (&["plan", "angles.toml", "--set", "derating.friction=0.9"], &["derating.friction is 0.9", "angles from the slope"]),
        (&["plan", "level.toml", "--set", "derating.friction=0"], &["derating.friction is 0", "from 0.01 to 1"]),
        (&["plan", "level.toml", "--set", "derating.takeoff_speed=1.1"], &["derating.takeoff_speed is 1.1", "from 0.01 to 1"]),
        (
            &["plan", "level.toml", "--set", "derating.takeoff_speed=0.5", "--set", "hopper.takeoff_speed_levels_m_s=[9.0]"],
            &["derating.takeoff_speed of 0.5 leaves too little", "takeoff_speed_levels_m_s is 9"],
        ),
        (
            &["plan", "level.toml", "--set", "derating.takeoff_speed=0.5", "--set", "hopper.takeoff_speed_min_m_s=6"],
            &["derating.takeoff_speed of 0.5 leaves too little", "takeoff_speed_min_m_s"],
        ),
    ];
    for (words, parts) in rows {
        desk.refused(words, parts);
    }
}

/// A scenario with its limits, one of smaller limits with those, and more words for both.
type DeratedCase<'a> = (&'a str, &'a [&'a str], &'a str, &'a [&'a str], &'a [&'a str]);

/// Planning under shares of the limits is planning under limits that much smaller, hop by hop, and the plan passes the checker. The products
/// are exact, so the bytes are equal.
#[test]
fn a_derated_plan_is_that_of_smaller_limits() {
    let desk = desk();
    desk.write("explicit.csv", EXPLICIT);
    desk.write(
        "smaller.csv",
        EXPLICIT.replace(",5,", ",3.75,").replace(",5\n", ",3.75\n").replace(",6,", ",5.25,").replace(",6\n", ",5.25\n"),
    );
    let explicit = "[body]\nname = \"moon\"\n[terrain]\nchain = \"explicit.csv\"\nstart_x_m = 0\ngoal_x_m = 40\n";
    desk.write("explicit.toml", explicit);
    desk.write("smaller.toml", explicit.replace("explicit.csv", "smaller.csv"));
    let derating: &[&str] = &["derating.takeoff_speed=0.75", "derating.landing_speed=0.875", "derating.friction=0.5"];
    let of_scenario: &[&str] =
        &["hopper.takeoff_speed_max_m_s=6", "hopper.landing_speed_max_m_s=7", "surface.friction_coefficient=0.4"];
    let whole: &[&str] = &["hopper.takeoff_speed_max_m_s=8", "hopper.landing_speed_max_m_s=8", "surface.friction_coefficient=0.8"];
    let cases: [DeratedCase<'_>; 4] = [
        ("scenario.toml", whole, "scenario.toml", of_scenario, &["--prove", "--prove-cells-max", "300"]),
        ("map.toml", whole, "map.toml", of_scenario, &[]),
        ("explicit.toml", &[], "smaller.toml", &[], &[]),
        ("scenario.toml", whole, "scenario.toml", of_scenario, &["--set", "hopper.takeoff_speed_step_m_s=0.25"]),
    ];
    for (derated, limits, smaller, small_limits, more) in cases {
        let planned = |scenario: &str, settings: &[&[&str]]| {
            let settings: Vec<&str> = settings.concat().into_iter().flat_map(|setting| ["--set", setting]).collect();
            desk.json(&[&["plan", scenario, "--verify"][..], more, &settings].concat())
        };
        let mut shares = planned(derated, &[limits, derating]);
        let mut scaled = planned(smaller, &[small_limits]);
        let whole = planned(derated, &[limits]);
        assert_eq!(shares["derating"]["takeoff_speed"], 0.75, "{shares}");
        assert_ne!(
            (&whole["path"], &whole["hops"]),
            (&scaled["path"], &scaled["hops"]),
            "{derated}: the shares change nothing here"
        );
        for document in [&mut shares, &mut scaled] {
            for key in ["derating", "scenario", "inputs", "warnings"] {
                document.as_object_mut().unwrap().remove(key);
            }
        }
        assert_eq!(shares, scaled, "{derated}");
        // Shares of 1 are the whole limits, to the byte.
        let of_one = ["derating.takeoff_speed=1", "derating.landing_speed=1.0", "derating.friction=1"];
        assert_eq!(planned(derated, &[limits, &of_one]), whole);
    }
}

const EXPLICIT: &str = "x_m,z_m,takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,landing_speed_max_m_s\n\
    0,0,20,80,5,-80,-20,6\n10,0.5,20,80,5,-80,-20,6\n20,0,20,80,5,-80,-20,6\n40,1,,,,,,\n";

#[test]
fn an_answer_for_derated_limits_says_so() {
    let desk = desk();
    let wall = ["--set", "hopper.takeoff_speed_max_m_s=3", "--set", "derating.takeoff_speed=0.5"];
    let words = "planned with derated limits ([derating]: 0.5 of the take-off speed)";
    let map = ["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"];
    let fan = ["fan", "ground.tif", "--from", "5,5", "--length", "9", "--scenario", "map.toml"];
    let rows: [(&[&str], &str); 8] = [
        (&["check", "scenario.toml", "--prove", "--prove-cells-max", "200"], "the proof is for the derated limits"),
        (&["plan", "scenario.toml"], words),
        (&["check", "scenario.toml"], words),
        (&["require", "scenario.toml", "--vary", "surface.friction_coefficient", "--resolution", "0.2"], words),
        (&["hop", "scenario.toml", "--to", "5"], words),
        (&["trade", "scenario.toml", "--vary", "surface.friction_coefficient=0.5:0.7:2"], words),
        (&map, words),
        (&fan, words),
    ];
    for (command, part) in rows {
        let ran = desk.run(&[command, &wall].concat());
        assert!(ran.status < 2 && (ran.stdout + &ran.stderr).contains(part), "{command:?}: {part}");
    }
}

/// A hop of 13.8 m needs 7.16 m/s at least, near nine tenths of 8 m/s. Planned under that share it never breaks the whole limit; under a
/// limit of 7.2 m/s the errors of its speed break it often.
#[test]
fn trials_fly_the_whole_limits() {
    let desk = desk();
    let flown = |limits: &[&str], policy: &str| {
        let policy = format!("uncertainty.policy={policy}");
        let common = [
            "search.takeoff_angle=least-speed",
            "uncertainty.takeoff_speed_sigma_fraction=0.01",
            "uncertainty.goal_tolerance_m=3",
            &policy,
            "terrain.goal_x_m=13.8",
            "hopper.takeoff_speed_max_m_s=20",
        ];
        let settings: Vec<&str> = common.iter().chain(limits).flat_map(|setting| ["--set", setting]).collect();
        let planned = desk.json(&[&["plan", "level.toml", "--front", "hops,risk"][..], &settings].concat());
        let rate = desk.json(&[&["simulate", "level.toml", "--trials", "500"][..], &settings].concat());
        assert_eq!(planned["hops"], 1);
        (number(&planned["front"][0]["success_estimated"]), number(&rate["success_rate"]))
    };
    for policy in ["open-loop", "replan"] {
        let derated = flown(&["hopper.landing_speed_max_m_s=8", "derating.landing_speed=0.9"], policy);
        let limited = flown(&["hopper.landing_speed_max_m_s=7.2"], policy);
        assert_eq!(derated, (1.0, 1.0), "{policy}");
        assert!(limited.0 < 0.8 && limited.1 < 0.8, "{policy}: {limited:?}");
    }
}

/// A friction raster over the raster of the desk, coarser than it, with these coefficients.
fn friction_raster(coefficients: [f64; 4]) -> String {
    let [a, b, c, d] = coefficients;
    format!("ncols 2\nnrows 2\nxllcorner -10\nyllcorner -10\ncellsize 20\n{a} {b}\n{c} {d}\n")
}

/// The same for maps, whose rasters are equal to the byte: hops, effort, return paths, mobility and the path to a goal.
#[test]
fn a_derated_map_is_that_of_smaller_limits() {
    let desk = desk();
    let coefficients = [0.9, 1.2, 0.7, 1.1];
    desk.write("whole.asc", friction_raster(coefficients));
    desk.write("half.asc", friction_raster(coefficients.map(|coefficient| 0.5 * coefficient)));
    let map = ["map", "ground.tif", "--start", "5,5", "--goal", "15,12", "--scenario", "map.toml", "--effort", "--return"];
    let files = ["-o", "hops.tif", "--effort-output", "effort.tif", "--mobility", "mobility.tif"];
    let speeds = ["hopper.takeoff_speed_max_m_s=4", "hopper.landing_speed_max_m_s=4"];
    let shares = ["derating.takeoff_speed=0.75", "derating.landing_speed=0.875", "derating.friction=0.5"];
    let smaller = ["hopper.takeoff_speed_max_m_s=3", "hopper.landing_speed_max_m_s=3.5"];
    let levels = ["hopper.takeoff_speed_levels_m_s=[2,3,4]", "hopper.takeoff_speed_levels_m_s=[2,3]"];
    let cases: [(&[&str], &[&str]); 4] = [
        (&["surface.friction_coefficient=1.5"], &["surface.friction_coefficient=0.75"]),
        (
            &["surface.friction_coefficient=1.5", "surface.friction_raster=\"whole.asc\""],
            &["surface.friction_coefficient=0.75", "surface.friction_raster=\"half.asc\""],
        ),
        (
            &["surface.friction_coefficient=1.5", "hopper.footprint_m=1.5"],
            &["surface.friction_coefficient=0.75", "hopper.footprint_m=1.5"],
        ),
        (&["surface.friction_coefficient=1.5", levels[0]], &["surface.friction_coefficient=0.75", levels[1]]),
    ];
    for (whole, small) in cases {
        let answer = |settings: &[&[&str]]| {
            let settings: Vec<&str> = settings.concat().into_iter().flat_map(|setting| ["--set", setting]).collect();
            let document = desk.json(&[&map[..], &files, &settings].concat());
            let rasters = ["hops.tif", "effort.tif", "mobility.tif"].map(|file| std::fs::read(desk.path().join(file)).unwrap());
            (document, rasters)
        };
        let (mut derated, of_derated) = answer(&[&speeds, whole, &shares]);
        let (mut scaled, of_scaled) = answer(&[&smaller, small]);
        let (undiminished, of_whole) = answer(&[&speeds, whole]);
        assert_eq!(derated["derating"]["landing_speed"], 0.875, "{whole:?}");
        assert_eq!(undiminished["derating"], Value::Null);
        assert!(of_derated == of_scaled, "{whole:?}: the rasters differ");
        assert!(of_derated.iter().zip(&of_whole).all(|(a, b)| a != b), "{whole:?}: the shares change nothing here");
        for document in [&mut derated, &mut scaled] {
            for key in ["derating", "scenario", "inputs", "warnings"] {
                document.as_object_mut().unwrap().remove(key);
            }
        }
        assert_eq!(derated, scaled, "{whole:?}");
        let of_one = ["derating.takeoff_speed=1", "derating.landing_speed=1", "derating.friction=1"];
        assert!(answer(&[&speeds, whole, &of_one]) == (undiminished, of_whole), "{whole:?}");
    }
}

/// On a map as along a chain: a hop of 13.8 m to the goal, planned under nine tenths of the landing speed. A robot that replans by risk weighs
/// it by the whole limits too: it takes the one hop, and two short ones where the limit itself is that low.
#[test]
fn trials_over_a_map_fly_the_whole_limits() {
    let desk = desk();
    let level = format!("ncols 21\nnrows 21\nxllcorner -3.45\nyllcorner -3.45\ncellsize 6.9\n{}", "0 ".repeat(441));
    desk.write("level.asc", level);
    let flown = |limits: &[&str], policy: &str, risk: &str| {
        let (policy, risk) = (format!("uncertainty.policy={policy}"), format!("search.risk={risk}"));
        let common = [
            "search.takeoff_angle=least-speed",
            "uncertainty.takeoff_speed_sigma_fraction=0.01",
            "uncertainty.goal_tolerance_m=3",
            &policy,
            &risk,
            "hopper.takeoff_speed_max_m_s=20",
        ];
        let settings: Vec<&str> = common.iter().chain(limits).flat_map(|setting| ["--set", setting]).collect();
        let map = ["map", "level.asc", "--start", "62.1,69", "--goal", "75.9,69", "--scenario", "level.toml", "--simulate"];
        let goal = desk.json(&[&map[..], &["--set", "uncertainty.trials=500"], &settings].concat())["goals"][0].clone();
        assert_eq!(goal["hops"], 1, "{goal}");
        (number(&goal["simulation"]["success_rate"]), number(&goal["simulation"]["hops_flown"]) / 500.0)
    };
    for (policy, risk) in [("open-loop", "ignored"), ("replan", "ignored"), ("replan", "fewest-hops")] {
        let derated = flown(&["hopper.landing_speed_max_m_s=8", "derating.landing_speed=0.9"], policy, risk);
        let (rate, hops) = flown(&["hopper.landing_speed_max_m_s=7.2"], policy, risk);
        assert_eq!(derated, (1.0, 1.0), "{policy}, {risk}");
        let by_risk = risk != "ignored";
        assert!(if by_risk { hops > 1.5 } else { rate < 0.8 }, "{policy}, {risk}: {rate}, {hops} hops");
    }
}
