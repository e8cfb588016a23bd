//! `[contact]` as a user meets it: plans with their times, trials under both policies, refusals.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// Level ground on a body of 2 m/s^2; one hop of 40 m within reach of 50 m, at the least speed: 45 degrees.
const LEVEL: &str = "[body]\ngravity_m_s2 = 2\n[hopper]\ntakeoff_speed_max_m_s = 10\nlanding_speed_max_m_s = 10\n\
    [surface]\nfriction_coefficient = 2\n[terrain]\nchain = \"level.csv\"\nstart_x_m = 100\ngoal_x_m = 140\n";

const TRIALS: &str = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.005\ntakeoff_angle_sigma_deg = 0.2\ngoal_tolerance_m = 3\n\
    trials = 300\n";

const BOUNCY: &str = "[contact]\nrestitution_normal = 0.5\nrestitution_tangential = 0.7\nsettle_speed_m_s = 0.01\n";

fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("level.csv", "x_m,z_m\n0,0\n400,0\n");
    desk.write("still.toml", LEVEL);
    desk.write("bouncy.toml", format!("{LEVEL}{BOUNCY}"));
    desk.write("trials.toml", format!("{LEVEL}{BOUNCY}{TRIALS}"));
    desk
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value}"))
}

/// q = 0.35: 0.35 / 0.65 of 40 m beyond the landing; the time of the flight once more, by `e_n = 0.5`.
#[test]
fn a_plan_states_its_bounces_and_their_time() {
    let desk = desk();
    let plan = desk.json(&["plan", "bouncy.toml", "--verify"]);
    assert!((number(&plan, "/path/0/bounce_distance_m") - 40.0 * 0.35 / 0.65).abs() < 0.01, "{plan}");
    let flight_s = number(&plan, "/totals/flight_time_s");
    let bounces_s = number(&plan, "/totals/bounce_time_s");
    assert!((bounces_s / flight_s - 1.0).abs() < 0.01, "{plan}");
    assert!((number(&plan, "/totals/mission_time_s") - flight_s - bounces_s).abs() < 1e-9);
    let waits = ["--set", "hopper.preparation_time_s=60"];
    let later = desk.json(&[&["plan", "bouncy.toml"][..], &waits].concat());
    assert!((number(&later, "/totals/mission_time_s") - flight_s - bounces_s - 60.0).abs() < 1e-9);
    let ran = desk.run(&["plan", "bouncy.toml", "-o", "path.csv", "--trajectory", "time.csv"]);
    for part in ["by [contact]", "up to 21.5", "54 % of their length", "first contacts", "policy replan"] {
        assert!(ran.stderr.contains(part), "{part} in {}", ran.stderr);
    }
    assert!(desk.read("path.csv").lines().next().unwrap().contains(",bounces,bounce_distance_m,bounce_time_s,margin_"));
    let table = desk.read("time.csv");
    let last = table.lines().last().unwrap();
    let last_s: f64 = last.split(',').next().unwrap().parse().unwrap();
    assert!(last.contains("bouncing") && (last_s - flight_s - bounces_s).abs() < 1e-6, "{last}");
    // Nothing of it without the table, and no bounce with a normal restitution of 0.
    let still = desk.json(&["plan", "still.toml"]);
    assert!(still.pointer("/totals/bounce_time_s").is_none() && still.pointer("/path/0/bounces").is_none(), "{still}");
    let dead = desk.run(&["plan", "bouncy.toml", "--set", "contact.restitution_normal=0"]);
    assert_eq!((dead.status, dead.stderr.contains("by [contact]")), (0, false), "{dead:?}");
}

#[test]
fn a_robot_that_replans_aims_short_and_planned_commands_overshoot() {
    let desk = desk();
    let both = desk.json(&["simulate", "trials.toml", "--compare"]);
    let rate = |i: usize| number(&both, &format!("/compare/{i}/success_rate"));
    assert!(rate(0) < 0.01 && rate(1) > 0.95, "{both}");
    // What a contact returns along the normal decides: without it, the trials are those without the table.
    let outcomes =
        |args: &[&str]| desk.json(&[&["simulate", "trials.toml", "--policy", "open-loop"][..], args].concat())["outcomes"].clone();
    let dead = outcomes(&["--set", "contact.restitution_normal=0"]);
    desk.write("trials.toml", format!("{LEVEL}{TRIALS}"));
    assert_eq!(dead, outcomes(&[]));
}

#[test]
fn trials_over_a_dem_bounce_and_the_estimate_is_theirs() {
    let desk = desk();
    let map = desk.read("map.toml");
    desk.write("map.toml", format!("{map}{BOUNCY}{TRIALS}"));
    for policy in ["open-loop", "replan"] {
        let answer = desk.json(&["simulate", "map.toml", "--policy", policy]);
        let counts = answer["outcomes"].as_object().unwrap().values().filter_map(Value::as_u64).sum::<u64>();
        assert_eq!(counts, 300, "{answer}");
        let plan = desk.json(&["plan", "map.toml", "--set", &format!("uncertainty.policy={policy}")]);
        let flown = desk.json(&["simulate", "map.toml", "--set", &format!("uncertainty.policy={policy}")]);
        let chosen = plan["surest"].as_array().unwrap().last().unwrap();
        let estimated = number(chosen, "/estimated_success");
        assert!((estimated - number(&flown, "/success_rate")).abs() < 0.1, "{chosen} {flown}");
    }
}

#[test]
fn half_a_restitution_and_one_that_never_ends_are_refused() {
    let desk = desk();
    for (set, parts) in [
        ("contact.restitution_normal=0.3", ["contact.restitution_tangential", "both coefficients"]),
        ("contact.restitution_tangential=0.3", ["contact.restitution_normal", "both coefficients"]),
        ("contact.settle_speed_m_s=0.3", ["contact.restitution_normal", "both coefficients"]),
        ("contact.restitution_normal=1", ["contact.restitution_normal is 1", "from 0 to 0.99"]),
        ("contact.settle_speed_m_s=0", ["contact.settle_speed_m_s is 0", "1e-9"]),
    ] {
        desk.refused(&["plan", "still.toml", "--set", set], &parts);
    }
}
