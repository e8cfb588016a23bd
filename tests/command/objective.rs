//! Plans by an objective and within budgets, in every command that plans along a transect: exit statuses, what is said, refusals.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use crate::desk::Desk;
use serde_json::Value;

/// Level ground of 60 m, on which a hop of X m at 45 degrees takes g X / 2 of energy per unit mass, and so does a journey of 60 m: 60 J/kg.
const LEVEL: &str = "[body]\ngravity_m_s2 = 2\n[hopper]\ntakeoff_speed_max_m_s = 5\nlanding_speed_max_m_s = 5\nmass_kg = 2\n\
    settling_time_s = 10\n[surface]\nfriction_coefficient = 1\n[terrain]\nchain = \"level.csv\"\nstart_x_m = 0\ngoal_x_m = 60\n\
    [search]\npoints_per_segment = 0\n";

const ERRORS: &str = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.01\ngoal_tolerance_m = 3\ntrials = 40\n";

fn desk() -> Desk {
    let desk = Desk::new();
    let vertices: Vec<String> = (0..=12).map(|i| format!("{},0", 5 * i)).collect();
    desk.write("level.csv", format!("x_m,z_m\n{}\n", vertices.join("\n")));
    desk.write("level.toml", LEVEL);
    desk.write("errors.toml", format!("{LEVEL}{ERRORS}"));
    desk
}

fn set(keys: &[&str]) -> Vec<String> {
    keys.iter().flat_map(|key| ["--set".to_owned(), (*key).to_owned()]).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// A command, keys, its exit status, and what it says on either stream. A hop of at most 12.5 m reaches two vertices: six hops.
#[test]
fn budgets_decide_in_every_command_along_a_transect() {
    let desk = desk();
    let vary = ["--vary", "hopper.takeoff_speed_max_m_s=5:8:2"];
    let speeds = ["--vary", "hopper.takeoff_speed_max_m_s", "--from", "4", "--to", "9", "--resolution", "0.05"];
    let [plan, check, simulate] = ["plan", "check", "simulate"].map(|command| vec![command, "level.toml"]);
    let trade = [&["trade", "level.toml", "--require-all"], &vary[..]].concat();
    let require = [&["require", "level.toml", "--set", "hopper.landing_speed_max_m_s=9"], &speeds[..]].concat();
    let rows: [(Vec<&str>, &[&str], i32, &str); 19] = [
        (check.clone(), &["budget.hops_max=6"], 0, "within its budget: number of hops 6, at most 6 (budget.hops_max)"),
        (check.clone(), &["budget.hops_max=5"], 1, "any path over these nodes is 6"),
        (
            check.clone(),
            &["budget.energy_max_j_kg=59.9"],
            1,
            "expected at most 59.9000 J/kg (budget.energy_max_j_kg); the least of",
        ),
        (
            check.clone(),
            &["budget.energy_max_j=120.1"],
            0,
            "energy per unit mass 60.0000 J/kg, at most 60.0500 J/kg (budget.energy_max_j)",
        ),
        (check.clone(), &["budget.mission_time_max_s=68"], 1, "(budget.mission_time_max_s)"),
        (check.clone(), &["budget.mission_time_max_s=70"], 0, "(budget.mission_time_max_s)"),
        (check.clone(), &["budget.delta_v_max_m_s=1"], 1, "(budget.delta_v_max_m_s)"),
        (check.clone(), &["budget.flight_time_total_max_s=1"], 1, "(budget.flight_time_total_max_s)"),
        (
            check.clone(),
            &["budget.hops_max=6", "hopper.isp_s=200", "hopper.propellant_max_kg=0.0001"],
            1,
            "(hopper.propellant_max_kg); the least of",
        ),
        (check.clone(), &["search.objective=[\"takeoff-speed\"]"], 0, "planned for the least takeoff-speed"),
        (plan.clone(), &["budget.hops_max=5"], 1, "no-path-found"),
        (plan.clone(), &["search.objective=[\"energy\", \"hops\"]"], 0, "planned for the least energy, then hops"),
        (simulate.clone(), &["budget.hops_max=5"], 1, "no-path-found"),
        (vec!["run", "level.toml", "-o", "out"], &["budget.hops_max=6"], 0, "within its budget"),
        (vec!["run", "level.toml", "-o", "out"], &["budget.hops_max=5"], 1, "not within its budget"),
        (trade.clone(), &["budget.hops_max=6"], 0, ""),
        (trade, &["budget.hops_max=5"], 1, ""),
        (require.clone(), &["budget.hops_max=4"], 0, "a path within the budgets at"),
        (require, &["budget.hops_max=1"], 1, "a path within the budgets at no value tried"),
    ];
    for (words, keys, status, part) in rows {
        let keys = set(keys);
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        let ran = desk.run(&[&words[..], &keys].concat());
        assert_eq!(ran.status, status, "{words:?} {keys:?}: {ran:?}");
        assert!(ran.stdout.contains(part), "{words:?} {keys:?}: {part:?} is not in {}", ran.stdout);
    }
    let compared = |most: &str| desk.run(&["compare", "level.toml", "level.toml", "--require-all", "--set", most]).status;
    assert_eq!((compared("budget.hops_max=6"), compared("budget.hops_max=5")), (0, 1));
}

/// Keys that exclude each other or lack another, and parts of the refusal.
#[test]
fn what_cannot_be_planned_is_refused_with_a_remedy() {
    let desk = desk();
    let rows: [(&str, &[&str], &[&str]); 12] = [
        ("level.toml", &["search.objective=[\"energy\"]", "search.effort=energy"], &["both objective and effort", "remove effort"]),
        ("level.toml", &["search.objective=[\"fuel\"]"], &["search.objective is [\"fuel\"]", "hops, takeoff-speed"]),
        ("level.toml", &["search.objective=[]"], &["a list of 1 to 4"]),
        ("level.toml", &["search.objective=[\"hops\", \"hops\"]"], &["each once"]),
        ("level.toml", &["search.objective=[\"peak-speed\", \"hops\"]"], &["peak-speed last only"]),
        ("level.toml", &["search.objective=[\"risk\"]"], &["risk without [uncertainty]", "add [uncertainty]"]),
        (
            "errors.toml",
            &["search.objective=[\"risk\"]", "uncertainty.policy=open-loop"],
            &["\"open-loop\"", "policy = \"replan\""],
        ),
        ("level.toml", &["budget.hops_max=3", "search.risk=traded"], &["search.risk = \"traded\"", "remove risk"]),
        ("errors.toml", &["budget.hops_max=9", "budget.estimated_success_min=0.5"], &["estimated_success_min is 0.5", "remove"]),
        ("level.toml", &["budget.energy_max_j=9", "hopper.mass_kg=1e-20"], &["hopper.mass_kg"]),
        (
            "level.toml",
            &["budget.mission_time_max_s=9", "contact.restitution_normal=0.3", "contact.restitution_tangential=0.3"],
            &["budget.mission_time_max_s", "[contact]", "flight-time"],
        ),
        ("level.toml", &["budget.hops_max=0"], &["budget.hops_max is 0", "from 1 to 1000000"]),
    ];
    for (file, keys, parts) in rows {
        let keys = set(keys);
        let words: Vec<&str> = ["check", file].into_iter().chain(keys.iter().map(String::as_str)).collect();
        desk.refused(&words, parts);
    }
    desk.write("massless.toml", LEVEL.replace("mass_kg = 2\n", ""));
    desk.refused(&["check", "massless.toml", "--set", "budget.energy_max_j=9"], &["without hopper.mass_kg", "energy_max_j_kg"]);
}

/// What is to be known about a plan: by errors that it does not weigh, and by hops as short as the nodes allow.
#[test]
fn a_plan_by_objective_says_what_it_does_not_weigh() {
    let desk = desk();
    let rows = [
        ("errors.toml", "search.objective=[\"hops\", \"energy\"]", Some("by the objective hops, energy, not by reliability")),
        ("errors.toml", "search.objective=[\"hops\", \"risk\"]", None),
        ("errors.toml", "budget.hops_max=9", Some("not by reliability")),
        ("level.toml", "search.objective=[\"hops\", \"energy\"]", None),
        ("level.toml", "search.objective=[\"energy\"]", Some("nodes on average, expected at least 3")),
    ];
    for (file, key, part) in rows {
        let ran = desk.run(&["plan", file, "--set", key, "--verify"]);
        assert_eq!(ran.status, 0, "{file} {key}: {ran:?}");
        match part {
            Some(part) => assert!(ran.stderr.contains(part), "{file} {key}: {}", ran.stderr),
            None => assert_eq!(ran.stderr, "", "{file} {key}"),
        }
    }
    // Commands that do not plan along a transect do not keep it.
    let ran = desk.run(&["hop", "level.toml", "--from", "0", "--to", "5", "--set", "budget.hops_max=3"]);
    assert!(ran.status == 0 && ran.stderr.contains("budget.hops_max has no effect"), "{ran:?}");
}

#[test]
fn a_front_has_the_totals_of_its_paths_and_the_plan_among_them() {
    let desk = desk();
    let rows = [
        ("energy", "energy_j_kg"),
        ("flight-time", "flight_time_s"),
        ("mission-time", "mission_time_s"),
        ("delta-v", "delta_v_m_s"),
        ("takeoff-speed", "takeoff_speed_sum_m_s"),
        ("distance", "ground_distance_m"),
        ("arc-length", "arc_length_m"),
        ("peak-speed", "peak_takeoff_speed_m_s"),
    ];
    for (amount, key) in rows {
        let amounts = format!("hops,{amount}");
        let objective = format!("search.objective=[\"hops\", \"{amount}\"]");
        let words = ["plan", "level.toml", "--front", &amounts, "--set", &objective, "--plot-front", "front.svg"];
        let document = desk.json(&words);
        let front = document["front"].as_array().unwrap();
        let points: Vec<(f64, f64)> = front.iter().map(|row| (number(&row["hops"]), number(&row[key]))).collect();
        assert!(points.is_sorted_by(|a, b| a.0 < b.0 && a.1 > b.1), "{amount}: {points:?}");
        assert_eq!((points[0].0, &document["front_hops_max"], &document["front_amount"]), (6.0, &16.into(), &amount.into()));
        // The plan has the fewest hops, then the least of the amount: it is the first path of the front.
        assert_eq!(document["hops"], 6);
        let totals = document["objective_totals"][1]["total"].as_f64().unwrap();
        assert!((totals - points[0].1).abs() <= 1e-9 * totals, "{amount}: {totals}, {points:?}");
        assert_eq!(front.iter().filter(|row| row["planned"] == true).count(), 1, "{amount}: {front:?}");
        assert!(desk.read("front.svg").contains("path of so many hops with the least") || points.len() == 1, "{amount}");
    }
    desk.refused(&["plan", "level.toml", "--front", "hops,hops"], &["--front: found 'hops,hops'", "hops,energy"]);
    let bounces = ["--set", "contact.restitution_normal=0.3", "--set", "contact.restitution_tangential=0.3"];
    desk.refused(&[&["plan", "level.toml", "--front", "hops,mission-time"], &bounces[..]].concat(), &["--front", "[contact]"]);
}
