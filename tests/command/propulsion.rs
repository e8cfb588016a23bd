//! Brakes, propellant, times and energies of hops as a user meets them.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// Level ground of 100 m on a body of 2 m/s^2; hops of 45 degrees.
const LEVEL: &str = "[body]\ngravity_m_s2 = 2\n[hopper]\ntakeoff_speed_max_m_s = 10\nlanding_speed_max_m_s = 10\n\
    [surface]\nfriction_coefficient = 1\n[terrain]\nchain = \"level.csv\"\nstart_x_m = 0\ngoal_x_m = 100\n";

fn desk(hopper: &str) -> Desk {
    let desk = Desk::new();
    desk.write("level.csv", "x_m,z_m\n0,0\n50,0\n100,0\n");
    desk.write("level.toml", LEVEL.replace("[surface]", &format!("{hopper}\n[surface]")));
    desk
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value}"))
}

/// Two hops of 50 m at 10 m/s each (v^2 = g X), 7.0711 s long, by the keys given: the totals are known by hand.
#[test]
fn totals_are_those_worked_out_by_hand() {
    let speed = 10.0;
    let time = 2.0 * 10.0 / 2.0f64.sqrt() / 2.0;
    // Brakes from (7.0711, -7.0711) to (0, -1) m/s.
    let braking = (50.0 + (50f64.sqrt() - 1.0).powi(2)).sqrt();
    let used = |delta_v: f64| 50.0 * (1.0 - (-delta_v / (200.0 * 9.80665)).exp());
    let braked = "landing = \"braked\"\ntouchdown_speed_m_s = 1";
    let rows: [(&str, &[(&str, f64)]); 9] = [
        ("", &[("delta_v_m_s", 2.0 * speed), ("energy_j_kg", 100.0), ("flight_time_s", 2.0 * time)]),
        (braked, &[("delta_v_m_s", 2.0 * (speed + braking)), ("energy_j_kg", 100.0)]),
        ("hop_delta_v_overhead_m_s = 3", &[("delta_v_m_s", 2.0 * (speed + 3.0))]),
        ("mass_kg = 50\nisp_s = 200", &[("propellant_kg", used(20.0)), ("mass_end_kg", 50.0 - used(20.0)), ("energy_j", 5000.0)]),
        ("rest_time_s = 30", &[("mission_time_s", 2.0 * time + 30.0)]),
        ("settling_time_s = 30", &[("mission_time_s", 2.0 * time + 30.0)]),
        ("preparation_time_s = 60\nsettling_time_s = 30", &[("mission_time_s", 2.0 * time + 150.0)]),
        ("efficiency = 0.5", &[("energy_j_kg", 200.0)]),
        ("efficiency = 0.5\nmass_kg = 50\npreparation_energy_j = 1000", &[("energy_j_kg", 240.0), ("energy_j", 12_000.0)]),
    ];
    for (hopper, expected) in rows {
        let desk = desk(hopper);
        let plan = desk.json(&["plan", "level.toml", "--verify"]);
        assert_eq!(number(&plan, "/hops"), 2.0, "{hopper}: {plan}");
        for (key, expected) in expected {
            let found = number(&plan, &format!("/totals/{key}"));
            assert!((found - expected).abs() < 1e-6 * expected, "{hopper}: {key} is {found}, expected {expected}");
        }
        let energies = plan.pointer("/totals/energy_basis").and_then(Value::as_str);
        assert_eq!(energies, hopper.contains("efficiency").then_some("store"), "{hopper}");
        let csv = desk.run(&["plan", "level.toml", "-o", "-"]).stdout;
        let header = csv.lines().next().unwrap();
        let propellant = if hopper.contains("isp_s") { ",propellant_kg,mass_end_kg" } else { "" };
        assert!(header.contains(&format!(",binding,delta_v_m_s{propellant},margin_")), "{header}");
        let per_hop = number(&plan, "/path/1/delta_v_m_s");
        assert!((2.0 * per_hop - number(&plan, "/totals/delta_v_m_s")).abs() < 1e-6, "{hopper}");
        assert_eq!(plan.pointer("/path/1/mass_end_kg").is_some(), hopper.contains("isp_s"), "{hopper}");
    }
}

/// An old rest time and the settling time of the same length give the same answer.
#[test]
fn the_old_rest_time_is_the_settling_time() {
    let answer = |hopper| {
        let mut plan = desk(hopper).json(&["plan", "level.toml"]);
        plan.as_object_mut().unwrap().retain(|key, _| !["scenario", "inputs"].contains(&key.as_str()));
        plan
    };
    assert_eq!(answer("rest_time_s = 12"), answer("settling_time_s = 12"));
    assert_eq!(answer("rest_time_s = 12"), answer("settling_time_s = 12\npreparation_time_s = 0"));
}

/// A path that needs more propellant than there is, by command: the answer is no, says so, and claims nothing about other paths.
#[test]
fn too_little_propellant_is_no_and_is_said() {
    // 0.507 kg for 20 m/s at 200 s.
    let enough = desk("mass_kg = 50\nisp_s = 200\npropellant_max_kg = 0.51");
    let short = desk("mass_kg = 50\nisp_s = 200\npropellant_max_kg = 0.5");
    let commands: [&[&str]; 5] = [
        &["plan", "level.toml"],
        &["plan", "level.toml", "--prove"],
        &["check", "level.toml"],
        &["run", "level.toml", "-o", "out"],
        &["simulate", "level.toml", "--trials", "10"],
    ];
    for command in commands {
        let yes = enough.run(command);
        assert_eq!(yes.status, 0, "{command:?}: {yes:?}");
        let no = short.run(command);
        assert_eq!(no.status, 1, "{command:?}: {no:?}");
        for words in ["no-path-found", "more than the 0.5 kg", "not proved that every path takes too much"] {
            assert!(no.stdout.contains(words), "{command:?} does not say {words}: {}", no.stdout);
        }
        assert!(!no.stdout.contains("traversable,"), "{command:?}: {}", no.stdout);
    }
    let plan = short.json(&["plan", "level.toml", "--prove"]);
    assert_eq!(plan["verdict"], "no-path-found");
    assert_eq!(
        (plan["proved"].as_bool(), plan["upper_bound"].as_u64(), plan["lower_bound"].as_u64()),
        (Some(false), None, Some(2))
    );
    assert!(number(&plan, "/propellant_shortage/short_kg") > 0.005);
    let compare = short.json(&["compare", "level.toml", "level.toml"]);
    assert_eq!(compare["compared"][0]["verdict"], "no-path-found");
    assert!(number(&compare, "/compared/0/totals/propellant_short_kg") > 0.005);
    let compare = short.run(&["compare", "level.toml", "level.toml", "--require-all", "-o", "both.csv"]);
    assert!(compare.status == 1 && compare.stdout.contains("no-path-found (too little propellant)"), "{compare:?}");
    let columns = short.read("both.csv").lines().next().map(|head| head.ends_with(",propellant_short_kg,error"));
    assert_eq!(columns, Some(true));
    // What counts hops alone says that it does not keep the limit.
    let trade = short.run(&["trade", "level.toml", "--vary", "hopper.takeoff_speed_max_m_s=5:10:2"]);
    assert!(trade.stderr.contains("hopper.propellant_max_kg is not kept"), "{trade:?}");
    let picture = short.read("out/path.svg");
    assert!(picture.contains("takes more propellant than the hopper has"), "the picture says so");
}

/// A goal of a map whose path takes more propellant than there is.
#[test]
fn a_goal_beyond_the_propellant_is_no() {
    let desk = Desk::with_dem();
    let scenario = |most: f64| {
        format!(
            "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 4\nlanding_speed_max_m_s = 1\nlanding = \"braked\"\n\
             touchdown_speed_m_s = 0.5\nmass_kg = 10\nisp_s = 200\npropellant_max_kg = {most}\n[surface]\nfriction_coefficient = 0.8\n"
        )
    };
    for (most, status) in [(5.0, 0), (1e-3, 1)] {
        desk.write("lander.toml", scenario(most));
        let ran = desk.run(&["map", "ground.tif", "--start", "1,2", "--goal", "15,12", "--scenario", "lander.toml"]);
        assert_eq!(ran.status, status, "{most}: {ran:?}");
        assert!(ran.stdout.contains("delta-v"), "{ran:?}");
        assert_eq!(ran.stdout.contains("not with its propellant"), status == 1, "{ran:?}");
    }
}

/// One sentence each, with the place.
#[test]
fn keys_that_do_not_fit_are_refused_in_one_sentence() {
    let rows = [
        ("landing = \"braked\"", "hopper.landing is \"braked\" without hopper.touchdown_speed_m_s"),
        ("touchdown_speed_m_s = 1", "hopper.touchdown_speed_m_s is 1, but the landing is ballistic"),
        ("landing = \"ballistic\"\ntouchdown_speed_m_s = 1", "but the landing is ballistic"),
        (
            "landing = \"braked\"\ntouchdown_speed_m_s = 11",
            "hopper.touchdown_speed_m_s is 11, expected no more than landing_speed_max_m_s",
        ),
        ("landing = \"braked\"\ntouchdown_speed_m_s = -1", "hopper.touchdown_speed_m_s"),
        ("landing = \"parachute\"", "expected one of ballistic, braked"),
        ("isp_s = 200", "hopper.isp_s is 200, expected a hopper.mass_kg beside it"),
        ("propellant_max_kg = 3", "hopper.propellant_max_kg is 3, expected a hopper.isp_s beside it"),
        ("mass_kg = 3\nisp_s = 200\npropellant_max_kg = 3", "hopper.propellant_max_kg is 3, expected less than hopper.mass_kg"),
        ("efficiency = 0", "hopper.efficiency"),
        ("efficiency = 1.5", "hopper.efficiency"),
        ("rest_time_s = 3\nsettling_time_s = 4", "hopper.rest_time_s is 3, expected not to stand beside"),
        ("rest_time_s = 3\npreparation_time_s = 4", "hopper.rest_time_s is 3, expected not to stand beside"),
        ("preparation_energy_j = 5", "hopper.preparation_energy_j is 5, expected a hopper.mass_kg beside it"),
    ];
    for (hopper, sentence) in rows {
        let desk = desk(hopper);
        desk.refused(&["plan", "level.toml"], &["level.toml", sentence]);
        let ran = desk.run(&["plan", "level.toml"]);
        assert_eq!(ran.stderr.matches("error: ").count(), 1, "one problem, with its line: {ran:?}");
    }
}

/// Without errors every trial flies the hops that the propellant lasts for: the greatest k with m (1 - exp(-k dv / c)) within it.
#[test]
fn trials_end_when_the_propellant_does() {
    let braked = 10.0 + (50.0 + (50f64.sqrt() - 1.0).powi(2)).sqrt();
    for (keys, delta_v) in
        [("", 10.0), ("hop_delta_v_overhead_m_s = 3", 13.0), ("landing = \"braked\"\ntouchdown_speed_m_s = 1", braked)]
    {
        let last = |hops: f64| 50.0 * (1.0 - (-hops * delta_v / (200.0 * 9.80665)).exp());
        // Two hops of 50 m: enough for both exactly, for one and a half, for a half.
        for (enough_for, flown) in [(2.0, 2), (1.5, 1), (0.5, 0)] {
            let max_kg = last(enough_for);
            let desk = desk(&format!("isp_s = 200\nmass_kg = 50\npropellant_max_kg = {max_kg:?}\n{keys}"));
            for policy in ["open-loop", "replan"] {
                let args =
                    ["simulate", "level.toml", "--trials", "20", "--policy", policy, "--set", "uncertainty.goal_tolerance_m=1"];
                let ran = desk.run(&args);
                assert!(ran.status == i32::from(flown < 2) && !ran.stderr.contains("propellant"), "{ran:?}");
                assert_eq!(ran.stdout.contains("out_of_propellant"), flown < 2, "{ran:?}");
                let answer = desk.json(&args);
                let outcomes = answer["outcomes"].as_object().unwrap();
                assert_eq!(
                    outcomes["out_of_propellant"].as_u64(),
                    Some(if flown < 2 { 20 } else { 0 }),
                    "{keys} {policy}: {answer}"
                );
                assert_eq!(outcomes.values().filter_map(Value::as_u64).sum::<u64>(), 20);
                assert_eq!(answer["hops_flown"].as_u64(), Some(20 * flown), "{keys} {policy}: {answer}");
            }
        }
    }
    // Without the amount, none is counted.
    let desk = desk("isp_s = 200\nmass_kg = 50");
    let answer = desk.json(&["simulate", "level.toml", "--trials", "20", "--set", "uncertainty.goal_tolerance_m=1"]);
    assert_eq!((answer["outcomes"]["out_of_propellant"].as_u64(), answer["hops_flown"].as_u64()), (Some(0), Some(40)), "{answer}");
}

/// The speeds that are flown are those drawn: what a trial has used is known from its landings.
#[test]
fn trials_burn_what_they_fly() {
    let desk = desk("isp_s = 200\nmass_kg = 50\npropellant_max_kg = 0.46");
    // Two hops of 40 m at 8.944 m/s take 0.454 kg.
    let errors = ["--goal", "80", "--set", "hopper.landing_speed_max_m_s=20", "--set", "uncertainty.takeoff_speed_sigma_m_s=0.5"];
    let args = [
        &["simulate", "level.toml", "--trials", "400", "--policy", "open-loop", "--set", "search.risk=ignored"][..],
        &["--set", "uncertainty.goal_tolerance_m=200"],
        &errors,
    ]
    .concat();
    let answer = desk.json(&args);
    let out = answer["outcomes"]["out_of_propellant"].as_u64().unwrap();
    assert!(out > 50 && out < 350, "{answer}");
    desk.run(&[&args[..], &["-o", "hops.csv"]].concat());
    let text = desk.read("hops.csv");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).unwrap_or_else(|| panic!("{name} in {header:?}"));
    let [trial, speed, outcome] = ["trial", "takeoff_speed_m_s", "outcome"].map(column);
    let mut flown = std::collections::BTreeMap::<String, (f64, String)>::new();
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let entry = flown.entry(fields[trial].to_owned()).or_default();
        entry.0 += fields[speed].parse::<f64>().unwrap();
        entry.1 = fields[outcome].to_owned();
    }
    let used_kg = |delta_v: f64| 50.0 * (1.0 - (-delta_v / (200.0 * 9.80665)).exp());
    for (trial, (delta_v, _)) in &flown {
        assert!(used_kg(*delta_v) <= 0.46 * (1.0 + 1e-9), "{trial}: {delta_v}");
    }
    // Those without a hop are in no row; all others end with their outcome.
    let ended = flown.values().filter(|(_, outcome)| outcome == "out_of_propellant").count();
    assert_eq!(u64::try_from(ended + 400 - flown.len()).unwrap(), out);
}
