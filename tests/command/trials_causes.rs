//! What stands on the edge of a limit, what fails most often, which key helps, and what each error costs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// One hop of 20 m over level ground on Mars: 8.62 m/s at 45 degrees, the same at the landing.
fn level(surface: &str, hopper: &str, errors: &str) -> Desk {
    let desk = Desk::new();
    desk.write("level.csv", "x_m,z_m\n-40,0\n60,0\n");
    desk.write(
        "level.toml",
        format!(
            "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 12.0\n{hopper}\n[surface]\n{surface}\n[terrain]\nchain = \
             \"level.csv\"\nstart_x_m = 0\ngoal_x_m = 20\n[search]\nrisk = \"ignored\"\n[uncertainty]\n{errors}\ngoal_tolerance_m = 50.0\n\
             policy = \"open-loop\"\ntrials = 4000\nseed = 3\n"
        ),
    );
    desk
}

/// The normal distribution function, by Simpson's rule.
fn normal_cdf(x: f64) -> f64 {
    let n = 2000;
    let step = (x + 12.0) / f64::from(n);
    let density = |t: f64| (-0.5 * t * t).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let weight = |i: i32| {
        if i == 0 || i == n {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    (0..=n).map(|i| weight(i) * density(-12.0 + f64::from(i) * step)).sum::<f64>() * step / 3.0
}

/// The share of flights that break one limit is that of a normal beyond the margin in sigmas.
#[test]
fn margins_in_sigmas_are_those_of_counted_flights() {
    let wide = "landing_speed_max_m_s = 12.0";
    let cases = [
        // The cone of 1.05 begins at 43.60 degrees.
        ("friction_coefficient = 1.05", wide, "takeoff_angle_sigma_deg = 1.0", "takeoff_cone_min_sigma", "slid_at_takeoff"),
        ("friction_coefficient = 1.05", wide, "takeoff_angle_sigma_deg = 2.5", "takeoff_cone_min_sigma", "slid_at_takeoff"),
        (
            "friction_coefficient = 1.05\nrest_slope_max_deg = inf",
            wide,
            "takeoff_angle_sigma_deg = 1.0\nfriction_sigma = 0.04",
            "takeoff_cone_min_sigma",
            "slid_at_takeoff",
        ),
        (
            "takeoff_from_slope_deg = [0, 90]\nlanding_from_slope_deg = [-90, -44]",
            wide,
            "takeoff_angle_sigma_deg = 1.0",
            "landing_cone_max_sigma",
            "slid_at_landing",
        ),
        (
            "friction_coefficient = 5.0",
            "landing_speed_max_m_s = 8.7",
            "takeoff_speed_sigma_fraction = 0.01",
            "landing_speed_sigma",
            "damaged",
        ),
        (
            "friction_coefficient = 5.0",
            "landing_speed_max_m_s = 8.7",
            "takeoff_speed_sigma_m_s = 0.2",
            "landing_speed_sigma",
            "damaged",
        ),
    ];
    for (surface, hopper, errors, margin, outcome) in cases {
        let desk = level(surface, hopper, errors);
        let planned = desk.json(&["plan", "level.toml"]);
        let sigmas = number(&planned["path"][0]["margins_sigma"][margin]);
        let flown = desk.json(&["simulate", "level.toml"]);
        let counted = number(&flown["outcomes"][outcome]) / 4000.0;
        let expected = 1.0 - normal_cdf(sigmas);
        // 4000 trials scatter by 0.008; 512 draws know a sigma within 9 %, which moves the share by at most 0.024.
        assert!((counted - expected).abs() < 0.03, "{errors}: {margin} {sigmas}, {outcome} {counted} beside {expected}");
        assert!(counted > 0.03, "{errors}: the test needs failures, not {counted}");
        // The text names the nearest limit.
        let all = planned["path"][0]["margins_sigma"].as_object().unwrap();
        let (name, least) = all.iter().min_by(|a, b| number(a.1).total_cmp(&number(b.1))).unwrap();
        let (does, limit) = match name.split_once('_').unwrap() {
            ("takeoff", _) => ("takes off", "its take-off cone"),
            (_, "speed_sigma") => ("lands", "its greatest landing speed"),
            _ => ("lands", "its landing cone"),
        };
        let text = desk.run(&["plan", "level.toml"]).stdout;
        let sentence = format!("hop 1 {does} {:.1} sigma from {limit}\n", number(least));
        assert_eq!(text.contains(&sentence), number(least) < 1.0, "{name}: {text}");
    }
    // Without an error there is no such margin.
    let plain = level("friction_coefficient = 1.05", wide, "drift_along_sigma_m = 0.1").json(&["plan", "level.toml"]);
    assert_eq!(plain["path"][0]["margins_sigma"], serde_json::json!({}));
}

/// A planted case: where, settings, the key that is to be advised first or among others, and how it is applied.
struct Planted {
    scenario: &'static str,
    settings: &'static [&'static str],
    key: &'static str,
    applied: &'static [&'static str],
}

const ROLLING: &str = "data/scenarios/rolling_surely.toml";

const PLANTED: [Planted; 9] = [
    Planted {
        scenario: ROLLING,
        settings: &[
            "uncertainty.policy=open-loop",
            "search.risk=fewest-hops",
            "search.takeoff_angle=most-reliable",
            "uncertainty.goal_tolerance_m=0.3",
        ],
        key: "uncertainty.policy",
        applied: &["uncertainty.policy=replan"],
    },
    Planted {
        scenario: ROLLING,
        settings: &["search.risk=ignored", "search.takeoff_angle=least-speed"],
        key: "search.risk",
        applied: &["search.risk=traded"],
    },
    Planted {
        scenario: ROLLING,
        settings: &["uncertainty.policy=open-loop", "search.risk=fewest-hops", "search.takeoff_angle=least-speed"],
        key: "search.takeoff_angle",
        applied: &["search.takeoff_angle=most-reliable"],
    },
    Planted {
        scenario: ROLLING,
        settings: &["uncertainty.policy=replan", "search.takeoff_angle=most-reliable", "uncertainty.goal_tolerance_m=0.03"],
        key: "uncertainty.goal_tolerance_m",
        applied: &["uncertainty.goal_tolerance_m=1.5"],
    },
    Planted {
        scenario: ROLLING,
        settings: &["uncertainty.policy=replan", "uncertainty.hop_limit=7"],
        key: "uncertainty.hop_limit",
        applied: &["uncertainty.hop_limit=40"],
    },
    Planted {
        scenario: "level.toml",
        settings: &[
            "surface.friction_coefficient=1.01",
            "hopper.takeoff_speed_max_m_s=8.62",
            "search.points_per_segment=0",
            "search.risk=fewest-hops",
            "search.takeoff_angle=most-reliable",
            "uncertainty.takeoff_angle_sigma_deg=2.5",
        ],
        key: "surface.friction_coefficient",
        applied: &["surface.friction_coefficient=1.5"],
    },
    Planted {
        scenario: "level.toml",
        settings: &[
            "surface.friction_coefficient=5",
            "hopper.landing_speed_max_m_s=8.62",
            "search.points_per_segment=0",
            "search.risk=traded",
            "search.takeoff_angle=most-reliable",
            "uncertainty.takeoff_speed_sigma_fraction=0.02",
        ],
        key: "hopper.landing_speed_max_m_s",
        applied: &["hopper.landing_speed_max_m_s=10"],
    },
    Planted {
        scenario: "level.toml",
        settings: &[
            "surface.friction_coefficient=5",
            "search.risk=traded",
            "search.takeoff_angle=most-reliable",
            "uncertainty.takeoff_speed_sigma_fraction=0.05",
            "uncertainty.goal_tolerance_m=1",
        ],
        key: "uncertainty.takeoff_speed_sigma_fraction",
        applied: &["uncertainty.takeoff_speed_sigma_fraction=0.01"],
    },
    Planted {
        scenario: "level.toml",
        settings: &[
            "surface.friction_coefficient=5",
            "hopper.mass_kg=10",
            "hopper.isp_s=100",
            "hopper.propellant_max_kg=0.0876",
            "uncertainty.takeoff_speed_sigma_fraction=0.05",
        ],
        key: "hopper.propellant_max_kg",
        applied: &["hopper.propellant_max_kg=0.2"],
    },
];

#[test]
fn advice_that_is_taken_raises_the_rate() {
    for Planted { scenario, settings, key, applied } in PLANTED {
        let desk = level("friction_coefficient = 1.05", "landing_speed_max_m_s = 12.0", "takeoff_angle_sigma_deg = 1.0");
        let file = if scenario == ROLLING { format!("{}/{ROLLING}", env!("CARGO_MANIFEST_DIR")) } else { scenario.to_owned() };
        let words = |more: &'static [&'static str]| -> Vec<&str> {
            let set = settings.iter().chain(more).flat_map(|setting| ["--set", setting]);
            ["simulate", &file, "--trials", "300"].into_iter().chain(set).collect()
        };
        let (before, text) = (desk.json(&words(&[])), desk.run(&words(&[])).stdout);
        let advice = before["advice"].as_array().unwrap_or_else(|| panic!("{settings:?}: no advice in {before}"));
        let of_key = advice.iter().find(|advice| advice["key"] == key).unwrap_or_else(|| panic!("{settings:?}: {advice:?}"));
        if let Some(value) = of_key["value"].as_str() {
            assert_eq!(format!("{key}={}", value.trim_matches('"')), applied[0], "{settings:?}");
        }
        let most = &before["failures"][0];
        let sentence =
            format!("most frequent failure: {} at hop {}, {} of ", most["outcome"].as_str().unwrap(), most["hop"], most["count"]);
        assert!(text.contains(&sentence) && text.contains(&format!("{key} ")), "{settings:?}: {text}");
        let after = desk.json(&words(applied));
        let (low, high) = (number(&after["success_rate_ci95"][0]), number(&before["success_rate_ci95"][1]));
        assert!(low > high, "{settings:?}: {key} from {} to {}", before["success_rate"], after["success_rate"]);
    }
}

#[test]
fn failures_by_hop_add_up_and_a_high_rate_gets_no_advice() {
    let scenario = format!("{}/{ROLLING}", env!("CARGO_MANIFEST_DIR"));
    for policy in ["open-loop", "replan"] {
        let document = Desk::new().json(&["simulate", &scenario, "--policy", policy, "--trials", "800"]);
        let failures = document["failures"].as_array().unwrap();
        for (outcome, count) in document["outcomes"].as_object().unwrap().iter().filter(|(outcome, _)| *outcome != "reached") {
            let sum: u64 = failures.iter().filter(|row| row["outcome"] == *outcome).map(|row| row["count"].as_u64().unwrap()).sum();
            assert_eq!(Some(sum), count.as_u64(), "{policy}: {outcome}");
        }
        assert!(failures.is_sorted_by(|a, b| a["count"].as_u64() >= b["count"].as_u64()), "{failures:?}");
        assert_eq!(document.get("advice").is_some(), number(&document["success_rate"]) < 0.9, "{policy}");
    }
}

/// Each row is the difference of two simulations by themselves, and its interval is narrower than theirs: the draws are common.
#[test]
fn the_cost_of_an_error_is_that_of_trials_without_it() {
    let scenario = format!("{}/{ROLLING}", env!("CARGO_MANIFEST_DIR"));
    let desk = Desk::new();
    for policy in ["open-loop", "replan"] {
        let words = ["simulate", &scenario, "--policy", policy, "--trials", "1000"];
        let document = desk.json(&[&words[..], &["--experiment", "sensitivity"]].concat());
        let with = desk.json(&words);
        assert_eq!(document["success_rate"], with["success_rate"], "{policy}");
        let rows = document["errors"].as_array().unwrap();
        assert!(rows.is_sorted_by(|a, b| number(&a["cost"]) >= number(&b["cost"])), "{policy}: {rows:?}");
        let names: Vec<_> = rows.iter().map(|row| row["error"].as_str().unwrap()).collect();
        for key in
            ["takeoff_speed_sigma_fraction", "takeoff_angle_sigma_deg", "position_sigma_m", "friction_sigma", "height_sigma_m"]
        {
            assert!(names.contains(&key), "{names:?}");
        }
        desk.write("flown.json", serde_json::to_string(&with).unwrap());
        for row in rows {
            let error = row["error"].as_str().unwrap();
            let [low, high] = [0, 1].map(|end| number(&row["cost_ci95"][end]));
            let cost = number(&row["cost"]);
            assert!(low <= cost && cost <= high && high - low < 0.06, "{row}");
            let pairs = number(&row["reached_only_without"]) - number(&row["reached_only_with"]);
            assert!((cost - pairs / 1000.0).abs() < 1e-12, "{row}");
            assert!((cost - (number(&row["success_rate_without"]) - number(&document["success_rate"]))).abs() < 1e-12, "{row}");
            // Open loop the path of the result is all that is flown, so that the same trials can be had by a key.
            if policy == "open-loop" && error != "height_sigma_m" {
                let set = format!("uncertainty.{error}=0");
                let alone = desk.json(&["simulate", "flown.json", "--set", &set]);
                assert_eq!(alone["success_rate"], row["success_rate_without"], "{error}");
            }
        }
        if policy == "open-loop" {
            let position = rows.iter().find(|row| row["error"] == "position_sigma_m").unwrap();
            assert_eq!((number(&position["cost"]), &position["reached_only_with"]), (0.0, &serde_json::json!(0)));
        }
    }
    // One error alone: without it every trial arrives.
    let desk = level("friction_coefficient = 1.05", "landing_speed_max_m_s = 12.0", "takeoff_angle_sigma_deg = 1.0");
    let document = desk.json(&["simulate", "level.toml", "--experiment", "sensitivity"]);
    assert_eq!(document["errors"][0]["success_rate_without"], 1.0);
    let ran = desk.run(&["simulate", "level.toml", "--experiment", "sensitivity", "--plot", "costs.svg"]);
    assert!(
        ran.stdout.contains("\ntakeoff_angle_sigma_deg = 1 ") && desk.read("costs.svg").contains("percentage points"),
        "{}",
        ran.stdout
    );
    let none = ["simulate", "level.toml", "--experiment", "sensitivity", "--set", "uncertainty.takeoff_angle_sigma_deg=0"];
    desk.refused(&none, &["--experiment: sensitivity takes each error away in turn", "no error above 0"]);
}
