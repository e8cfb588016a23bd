//! Commands in steps at the command line: the multiples, the misses, the refusals.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// Level ground of 60 m with vertices every 10 m, lunar gravity.
fn level() -> Desk {
    let desk = Desk::new();
    desk.write("level.csv", "x_m,z_m\n0,0\n10,0\n20,0\n30,0\n40,0\n50,0\n60,0\n");
    desk.write(
        "level.toml",
        "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 5\nlanding_speed_max_m_s = 6\n[surface]\nfriction_coefficient = 1.2\n\
         [terrain]\nchain = \"level.csv\"\nstart_x_m = 0\ngoal_x_m = 60\n",
    );
    desk
}

fn multiple(number: &Value, step: f64) -> bool {
    let number = number.as_f64().unwrap();
    ((number / step).round() * step - number).abs() < 1e-9
}

#[test]
fn every_command_is_a_multiple_and_every_miss_is_stated() {
    let desk = level();
    for (angle, speed) in [(Some(2.5), None), (None, Some(0.25)), (Some(2.5), Some(0.25))] {
        let mut args = vec!["plan".to_owned(), "level.toml".to_owned(), "--verify".to_owned()];
        for (key, step) in [("takeoff_angle_step_deg", angle), ("takeoff_speed_step_m_s", speed)] {
            args.extend(step.map(|step: f64| ["--set".to_owned(), format!("hopper.{key}={step}")]).into_iter().flatten());
        }
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let plan = desk.json(&args);
        let hops = plan["path"].as_array().unwrap();
        assert!(hops.len() >= 4, "{plan}");
        let mut greatest_m = 0.0_f64;
        for pair in hops.windows(2) {
            assert_eq!(pair[0]["landing_x_m"], pair[1]["takeoff_x_m"], "a hop starts where the one before landed");
        }
        for hop in hops {
            assert!(angle.is_none_or(|step| multiple(&hop["takeoff_angle_deg"], step)), "{hop}");
            assert!(speed.is_none_or(|step| multiple(&hop["takeoff_speed_m_s"], step)), "{hop}");
            let miss_m = hop["landing_miss_m"].as_f64().unwrap();
            let found = hop["landing_x_m"].as_f64().unwrap() - hop["aim_x_m"].as_f64().unwrap();
            assert!((miss_m - found).abs() < 1e-9, "{hop}");
            // R = v^2 sin(2 theta) / g over level ground.
            let (v, theta) = (hop["takeoff_speed_m_s"].as_f64().unwrap(), hop["takeoff_angle_deg"].as_f64().unwrap().to_radians());
            let range_m = v * v * (2.0 * theta).sin() / plan["scenario"]["body"]["gravity_m_s2"].as_f64().unwrap();
            assert!(
                (range_m - (hop["landing_x_m"].as_f64().unwrap() - hop["takeoff_x_m"].as_f64().unwrap())).abs() < 1e-6,
                "{hop}"
            );
            greatest_m = greatest_m.max(miss_m.abs());
        }
        let stated_m = plan["landing_miss_max_m"].as_f64().unwrap();
        assert!((stated_m - greatest_m).abs() < 1e-12);
        assert_eq!(angle.is_some() && speed.is_some(), greatest_m > 1e-6, "only both steps together miss: {greatest_m}");
        let text = desk.run(&args).stdout;
        assert!(text.contains("commands in steps: every landing is within"), "{text}");
        let csv = desk.run(&[&args[..], &["-o", "-"]].concat()).stdout;
        assert!(csv.lines().next().unwrap().contains(",aim_x_m,landing_miss_m,margin_"), "{csv}");
    }
    let exact = desk.json(&["plan", "level.toml"]);
    assert!(exact.get("landing_miss_max_m").is_none() && exact["path"][0].get("aim_x_m").is_none(), "{exact}");
}

#[test]
fn no_commands_is_an_answer_and_a_bad_step_is_one_sentence() {
    let desk = level();
    for command in ["check", "plan"] {
        let refused = desk.run(&[command, "level.toml", "--set", "hopper.takeoff_angle_step_deg=90", "--format", "json"]);
        let answer: Value = serde_json::from_str(&refused.stdout).unwrap();
        assert_eq!((refused.status, answer["verdict"].as_str()), (1, Some("no-path-found")), "{refused:?}");
        let reason = answer["commands_refusal"].as_str().unwrap();
        assert!(reason.contains("none flies hop 1") && reason.contains("90 degrees"), "{reason}");
    }
    for (set, expected) in [
        ("hopper.takeoff_angle_step_deg=0", "hopper.takeoff_angle_step_deg is 0, expected a number from"),
        ("hopper.takeoff_speed_step_m_s=9", "hopper.takeoff_speed_step_m_s is 9, expected no more than takeoff_speed_max_m_s"),
        ("hopper.heading_step_deg=-5", "hopper.heading_step_deg is -5, expected a number from"),
    ] {
        let refused = desk.run(&["plan", "level.toml", "--set", set]);
        assert!(refused.status == 2 && refused.stderr.contains(expected), "{set}: {refused:?}");
    }
    let both = ["--set", "hopper.takeoff_speed_step_m_s=1", "--set", "hopper.takeoff_speed_levels_m_s=[2, 4]"];
    let refused = desk.run(&[&["plan", "level.toml"][..], &both].concat());
    assert!(refused.status == 2 && refused.stderr.contains("not to stand beside takeoff_speed_levels_m_s"), "{refused:?}");
    let without_map = desk.run(&["plan", "level.toml", "--set", "hopper.heading_step_deg=5"]);
    assert!(without_map.status == 0 && without_map.stderr.contains("hopper.heading_step_deg has no effect"), "{without_map:?}");
}

/// Transects of a DEM are flown beside their line, in the headings of the machine.
#[test]
fn a_transect_of_a_dem_is_flown_beside_its_line() {
    let desk = Desk::with_dem();
    let exact = desk.json(&["plan", "map.toml"]);
    let line_deg = exact["path"][0]["heading_deg"].as_f64().unwrap();
    for (step, more) in [(7.0, &[][..]), (10.0, &["--set", "hopper.takeoff_speed_step_m_s=0.1"][..])] {
        let set = format!("hopper.heading_step_deg={step}");
        let args = [&["plan", "map.toml", "--verify", "--set", &set][..], more].concat();
        let plan = desk.json(&args);
        assert_eq!((plan["verdict"].as_str(), plan["verified"].as_bool()), (Some("traversable"), Some(true)), "{plan}");
        let mut greatest_m = 0.0_f64;
        let hops = plan["path"].as_array().unwrap();
        for hop in hops {
            let number = |key: &str| hop[key].as_f64().unwrap_or_else(|| panic!("{key} in {hop}"));
            assert!(multiple(&hop["heading_deg"], step), "{hop}");
            // Along and across, against the positions on the map.
            let along = line_deg.to_radians().sin_cos();
            let away = (number("landing_map_x_m") - number("aim_map_x_m"), number("landing_map_y_m") - number("aim_map_y_m"));
            let (beyond_m, left_m) = (away.0 * along.0 + away.1 * along.1, along.0 * away.1 - along.1 * away.0);
            assert!(
                (number("landing_miss_m") - beyond_m).abs() < 1e-6 && (number("landing_miss_across_m") - left_m).abs() < 1e-6,
                "{hop}"
            );
            assert!((number("landing_x_m") - number("aim_x_m") - beyond_m).abs() < 1e-6, "a projection on the line: {hop}");
            greatest_m = greatest_m.max(away.0.hypot(away.1));
        }
        assert!((plan["landing_miss_max_m"].as_f64().unwrap() - greatest_m).abs() < 1e-9 && greatest_m > 1e-3);
        let proved = desk.run(&["check", "map.toml", "--prove", "--set", &set, "--plot", "proof.svg"]);
        assert!(proved.stdout.contains("the proof is about hops on the line, and this path flies beside it"), "{proved:?}");
        assert!(desk.read("proof.svg").contains("drawn projected on it") && plan["beside_line"] == true);
        let text = desk.run(&args).stdout;
        assert!(text.contains("the hops fly beside the line") && text.contains("the goal along the line and"), "{text}");
        let csv = desk.run(&[&args[..], &["-o", "-"]].concat()).stdout;
        assert!(csv.contains(",aim_x_m,landing_miss_m,landing_miss_across_m,aim_map_x_m,aim_map_y_m,margin_"), "{csv}");
        let files = ["--plot", "beside.svg", "--geojson", "beside.geojson", "--trajectory", "beside.csv"];
        assert_eq!(desk.run(&[&args[..], &files].concat()).status, 0);
        let picture = desk.read("beside.svg");
        assert!(picture.contains("drawn projected") && !picture.contains("opacity=\"0.35\""), "a cone: {picture}");
        // The flight in time ends on the map where the path does.
        let rows = desk.read("beside.csv");
        let header: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
        let last: Vec<f64> = rows.lines().last().unwrap().split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect();
        for (column, key) in [("map_x_m", "landing_map_x_m"), ("x_m", "landing_x_m"), ("z_m", "landing_z_m")] {
            let at = header.iter().position(|name| *name == column).unwrap();
            assert_eq!(Some(last[at]), hops[hops.len() - 1][key].as_f64(), "{column}");
        }
        desk.write(
            "trials.toml",
            desk.read("map.toml").replace("[surface]", &format!("heading_step_deg = {step}\n[surface]"))
                + "[uncertainty]\ngoal_tolerance_m = 2\ntrials = 20\n",
        );
        for policy in ["open-loop", "replan"] {
            let trials = desk.json(&[&["simulate", "trials.toml", "--policy", policy][..], more].concat());
            assert_eq!(trials["outcomes"]["reached"].as_u64(), Some(20), "{policy}: {trials}");
        }
        assert_eq!(desk.run(&[&["run", "trials.toml", "-o", "out"][..], more].concat()).status, 0);
    }
    // A heading of the machine, here a divisor of the transect's own, is flown along the line.
    let whole = desk.json(&["plan", "map.toml", "--set", &format!("hopper.heading_step_deg={}", line_deg / 3.0)]);
    assert!(
        whole.get("beside_line").is_none()
            && whole["path"][0].get("landing_miss_across_m").is_none()
            && whole["path"][0].get("aim_x_m").is_some(),
        "{whole}"
    );
}

/// Of a chain and of a mesh the ground is known on the line alone: the answer says so, with the heading and an end that has it.
#[test]
fn a_line_without_ground_beside_it_needs_a_heading_of_the_machine() {
    let desk = Desk::with_dem();
    assert_eq!(desk.run(&["slice", "ground.tif", "--from", "1,2", "--to", "15,12", "-o", "cut.csv"]).status, 0);
    let on_map = desk.read("map.toml");
    let terrain = |keys: &str| on_map.replace("dem = \"ground.tif\"\nstart_m = [1, 2]\ngoal_m = [15, 12]", keys);
    desk.write("cut.toml", terrain("chain = \"cut.csv\"\nstart_x_m = 0\ngoal_x_m = 17"));
    desk.write("mesh.toml", terrain("mesh = \"plate.obj\"\nstart_m = [1, 1]\ngoal_m = [8, 5]"));
    for (scenario, line_deg) in [("cut.toml", 14f64.atan2(10.0).to_degrees()), ("mesh.toml", 7f64.atan2(4.0).to_degrees())] {
        for command in ["plan", "check"] {
            let refused = desk.run(&[command, scenario, "--format", "json", "--set", "hopper.heading_step_deg=7"]);
            let answer: Value = serde_json::from_str(&refused.stdout).unwrap();
            assert_eq!((refused.status, answer["verdict"].as_str()), (1, Some("no-path-found")), "{refused:?}");
            let reason = answer["commands_refusal"].as_str().unwrap();
            let nearest = (line_deg / 7.0).round() * 7.0;
            for words in [&format!("allows is {nearest}:"), "the ground is known on the line alone", "such as (", "terrain.dem"] {
                assert!(reason.contains(words), "{words}: {reason}");
            }
        }
        let whole = desk.run(&["plan", scenario, "--set", &format!("hopper.heading_step_deg={}", line_deg / 3.0)]);
        assert_eq!(whole.status, 0, "{whole:?}");
    }
}

#[test]
fn a_landing_far_from_its_aim_is_another_hop() {
    let desk = level();
    let steps = ["--set", "hopper.takeoff_speed_step_m_s=5", "--set", "hopper.takeoff_angle_step_deg=5"];
    for command in ["check", "plan"] {
        let refused = desk.run(&[&[command, "level.toml", "--goal", "1"][..], &steps].concat());
        assert!(refused.status == 1 && refused.stdout.contains("(takeoff-speed-step)"), "{refused:?}");
    }
    // The picture and the whole run say no as well.
    let refused = desk.run(&[&["plan", "level.toml", "--goal", "1", "--plot", "no.svg"][..], &steps].concat());
    assert!(refused.status == 1 && desk.read("no.svg").contains("no commands in steps found"), "{refused:?}");
    assert!(desk.read("no.svg").contains("none flies hop 1"), "the picture names the hop");
    desk.write(
        "far.toml",
        desk.read("level.toml")
            .replace("goal_x_m = 60", "goal_x_m = 1")
            .replace("[surface]", "takeoff_speed_step_m_s = 5\ntakeoff_angle_step_deg = 5\n[surface]"),
    );
    assert_eq!(desk.run(&["run", "far.toml", "-o", "out"]).status, 1);
}

#[test]
fn the_effort_is_that_of_the_commands() {
    let desk = level();
    let steps = ["--set", "hopper.takeoff_speed_step_m_s=0.25", "--set", "hopper.takeoff_angle_step_deg=2.5"];
    for (effort, total) in [("takeoff-speed", None), ("energy", Some("energy_j_kg")), ("time", Some("flight_time_s"))] {
        let plan = desk.json(&[&["plan", "level.toml", "--effort", effort][..], &steps].concat());
        let speeds = plan["path"].as_array().unwrap().iter().map(|hop| hop["takeoff_speed_m_s"].as_f64().unwrap());
        let expected = total.map_or_else(|| speeds.sum::<f64>(), |total| plan["totals"][total].as_f64().unwrap());
        assert!((plan["effort"]["value"].as_f64().unwrap() - expected).abs() < 1e-9, "{effort}: {plan}");
    }
}

#[test]
fn replanning_flies_commands_in_steps_within_the_limits() {
    let desk = level();
    let text = desk.read("level.toml").replace("[surface]", "takeoff_speed_step_m_s = 0.25\ntakeoff_angle_step_deg = 1\n[surface]");
    desk.write("trials.toml", format!("{text}[uncertainty]\ntakeoff_speed_sigma_m_s = 0.02\ngoal_tolerance_m = 3\ntrials = 200\n"));
    for policy in ["open-loop", "replan"] {
        let answer = desk.json(&["simulate", "trials.toml", "--policy", policy, "--set", "search.risk=ignored"]);
        assert!(answer["success_rate"].as_f64().unwrap() > 0.8, "{policy}: {answer}");
        assert_eq!(answer["outcomes"]["slid_at_takeoff"].as_u64(), Some(0), "{policy}: {answer}");
    }
}
