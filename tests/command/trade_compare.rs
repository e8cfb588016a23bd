//! `chta trade` and `chta compare`: every cell against a separate run, files, threads, bad input.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use crate::desk::{Desk, FORWARD_ONLY, Ran};
use serde_json::Value;

fn json(desk: &Desk, args: &[&str]) -> Value {
    let ran = desk.run(args);
    assert!(ran.status < 2, "{args:?}: {ran:?}");
    serde_json::from_str(&ran.stdout).unwrap()
}

/// The result of `check` with the keys of a row set one by one.
fn checked(desk: &Desk, target: &[&str], row: &Value, keys: &[&str], more: &[&str]) -> Value {
    let settings: Vec<String> = keys.iter().map(|key| format!("{key}={}", row[*key].as_f64().unwrap())).collect();
    let mut args = vec!["check", "--format", "json"];
    args.extend(target);
    args.extend(more);
    for setting in &settings {
        args.extend(["--set", setting]);
    }
    json(desk, &args)
}

/// Runs a trade whose rows must all agree with `check`; returns the verdicts.
fn agrees(desk: &Desk, target: &[&str], vary: &[(&str, &str)], more: &[&str]) -> Vec<String> {
    let ranges: Vec<String> = vary.iter().map(|(key, range)| format!("{key}={range}")).collect();
    let mut args = vec!["trade", "--format", "json", "--quiet"];
    args.extend(target);
    args.extend(more);
    for range in &ranges {
        args.extend(["--vary", range]);
    }
    let trade = json(desk, &args);
    assert_eq!(trade["schema"], "chta/trade/1");
    let keys: Vec<&str> = vary.iter().map(|(key, _)| *key).collect();
    let rows = trade["rows"].as_array().unwrap();
    let count = |range: &str| range.rsplit(':').next().unwrap().parse::<usize>().unwrap();
    assert_eq!(rows.len(), vary.iter().map(|(_, range)| count(range)).product::<usize>());
    for row in rows {
        let check = checked(desk, target, row, &keys, more);
        assert_eq!((&row["verdict"], &row["hops"]), (&check["verdict"], &check["hops"]), "{row}");
        assert_eq!(row.get("lower_bound"), check.get("lower_bound"), "{row}");
        assert_eq!(row["effort"], check["effort"], "{row}");
        assert_eq!((row.get("error"), row["totals"].is_object()), (None, row["hops"].is_u64()), "{row}");
    }
    rows.iter().map(|row| row["verdict"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn every_cell_agrees_with_check_for_its_values() {
    let desk = Desk::with_dem();
    let speeds = ("hopper.takeoff_speed_max_m_s", "3:9:3");
    let grid = agrees(&desk, &["scenario.toml"], &[speeds, ("surface.friction_coefficient", "0.1:0.7:3")], &[]);
    assert!(grid.iter().any(|verdict| verdict == "traversable") && grid.iter().any(|verdict| verdict != "traversable"), "{grid:?}");
    // The chain of a slice carries its friction, which each value must replace.
    let sliced = agrees(&desk, &["map.toml"], &[("surface.friction_coefficient", "0.2:0.8:3")], &[]);
    assert!(sliced.iter().any(|verdict| verdict == "traversable") && sliced.iter().any(|verdict| verdict != "traversable"));
    for vary in [
        ("body.gravity_m_s2", "1:9:3"),
        ("hopper.clearance_m", "0:8:3"),
        ("hopper.takeoff_angle_min_deg", "45:85:3"),
        ("hopper.apex_height_max_m", "0.5:4:3"),
        ("surface.rest_slope_max_deg", "5:20:3"),
        ("search.points_per_segment", "0:2:3"),
        ("terrain.goal_x_m", "10:40:4"),
    ] {
        agrees(&desk, &["scenario.toml"], &[vary], &[]);
    }
}

#[test]
fn with_a_proof_every_cell_agrees_with_check() {
    let desk = Desk::new();
    let verdicts = agrees(&desk, &["scenario.toml"], &[("surface.friction_coefficient", "0.1:0.7:3")], &["--prove"]);
    assert_eq!(verdicts.first().map(String::as_str), Some("untraversable"));
    assert_eq!(verdicts.last().map(String::as_str), Some("traversable"));
}

#[test]
fn of_explicit_limits_and_varied_ones_the_smaller_counts() {
    let desk = Desk::new();
    desk.write("forward.csv", FORWARD_ONLY);
    let target = ["forward.csv", "--body", "mars", "--start", "0", "--goal", "10", "--set", "hopper.landing_speed_max_m_s=60"];
    agrees(&desk, &target, &[("hopper.takeoff_speed_max_m_s", "1:41:5")], &[]);
    let mut args = vec!["trade"];
    args.extend(target);
    let ran = desk.run(&[&args[..], &["--vary", "hopper.takeoff_speed_max_m_s=40:80:3"]].concat());
    assert_eq!(ran.status, 2, "the chain allows 30 m/s at most");
    assert!(ran.stderr.contains("no value from 40 to 80 changes anything"), "{}", ran.stderr);
}

#[test]
fn threads_and_files_change_no_byte() {
    let grid = ["--vary", "hopper.takeoff_speed_max_m_s=3:9:4", "--vary", "surface.friction_coefficient=0.3:0.9:3"];
    let trade = |more: &[&str]| {
        let desk = Desk::new();
        let ran = desk.run(&[&["trade", "scenario.toml"][..], &grid, more].concat());
        assert_eq!(ran.status, 0, "{ran:?}");
        (ran.stdout, desk)
    };
    for format in ["text", "json"] {
        let (one, _) = trade(&["--format", format, "--threads", "1"]);
        for threads in ["2", "5"] {
            assert_eq!(trade(&["--format", format, "--threads", threads]).0, one);
        }
    }
    let (document, _) = trade(&["--format", "json"]);
    let (csv, _) = trade(&["-o", "-"]);
    let (_, desk) = trade(&["-o", "trade.JSON"]);
    assert_eq!(desk.read("trade.JSON"), document);
    let (_, desk) = trade(&["-o", "trade.csv", "--plot", "trade.svg"]);
    assert_eq!(desk.read("trade.csv"), csv);
    let (_, again) = trade(&["--plot", "trade.svg", "--threads", "1"]);
    assert_eq!(desk.read("trade.svg"), again.read("trade.svg"));
    assert!(desk.read("trade.svg").starts_with("<svg"));

    // CSV and JSON agree.
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some(
            "hopper.takeoff_speed_max_m_s,surface.friction_coefficient,verdict,hops,flight_time_s,energy_j_kg,peak_takeoff_speed_m_s,\
             ground_distance_m,energy_j,mission_time_s,delta_v_m_s,propellant_kg,mass_end_kg,speed_margin_least_m_s,\
             angle_margin_least_deg,angle_span_least_deg,effort,error"
        )
    );
    let rows: Value = serde_json::from_str(&document).unwrap();
    for (line, row) in lines.zip(rows["rows"].as_array().unwrap()) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |key: &str| row[key].as_f64().unwrap().to_string();
        assert_eq!(fields[0], number("hopper.takeoff_speed_max_m_s"));
        assert_eq!(fields[1], number("surface.friction_coefficient"));
        assert_eq!(fields[2], row["verdict"]);
        assert_eq!(fields[3], row["hops"].as_u64().map(|hops| hops.to_string()).unwrap_or_default());
    }
}

#[test]
fn what_cannot_be_varied_is_refused_in_one_sentence() {
    let desk = Desk::with_dem();
    let speed = "hopper.takeoff_speed_max_m_s";
    for (vary, said) in [
        (vec!["hopper.takeoff_speed_max_m_s=4:10:1"], "STEPS is 1, expected how many values to try, a whole number from 2 to 1000"),
        (vec!["hopper.takeoff_speed_max_m_s=4:10:0"], "STEPS is 0"),
        (vec!["hopper.takeoff_speed_max_m_s=4:10:-3"], "STEPS is -3"),
        (vec!["hopper.takeoff_speed_max_m_s=4:10:2.5"], "STEPS is 2.5"),
        (vec!["hopper.takeoff_speed_max_m_s=4:10:1001"], "STEPS is 1001"),
        (vec!["hopper.takeoff_speed_max_m_s=10:4:3"], "found FROM 10 and TO 4, expected FROM below TO"),
        (vec!["hopper.takeoff_speed_max_m_s=4:4:3"], "found FROM 4 and TO 4"),
        (vec!["hopper.takeoff_speed_max_m_s=4:inf:3"], "expected FROM below TO, both finite"),
        (vec!["hopper.takeoff_speed_max_m_s=nan:4:3"], "expected FROM below TO, both finite"),
        (vec!["hopper.takeoff_speed_max_m_s=-4:4:3"], "a value is -4, expected a number from 1e-9 to 1e5"),
        (vec!["hopper.takeoff_speed_max_m_s"], "found ``, expected FROM:TO:STEPS"),
        (vec!["hopper.takeoff_speed_max_m_s=fast"], "found `fast`, expected FROM:TO:STEPS"),
        (vec!["hopper.takeoff_speed_max_m_s=4:10"], "found `4:10`, expected FROM:TO:STEPS"),
        (vec!["hopper.takeof_speed_max_m_s=4:10:3"], "the nearest known key is hopper.takeoff_speed_max_m_s"),
        (vec!["takeoff_speed_max_m_s=4:10:3"], "the nearest known key is hopper.takeoff_speed_max_m_s"),
        (vec!["=4:10:3"], "unknown key"),
        (vec!["search.effort=1:2:2"], "takes one of takeoff-speed, energy, time, peak-speed, which cannot be varied"),
        (vec!["body.name=1:2:2"], "takes a text in quotes, not empty, which cannot be varied"),
        (vec!["surface.takeoff_from_slope_deg=1:2:2"], "which cannot be varied"),
        (vec!["search.points_per_segment=0:3:3"], "a value is 1.5, expected a whole number"),
        (vec!["surface.rest_slope_max_deg=0:100:3"], "expected an angle from 0 to 90 degrees"),
        (vec!["hopper.mass_kg=1:2:2"], "no value from 1 to 2 changes anything here"),
        (vec![&*format!("{speed}=4:10:3"), &*format!("{speed}=5:9:3")], "hopper.takeoff_speed_max_m_s is varied twice"),
        (
            vec![&*format!("{speed}=4:10:3"), "hopper.clearance_m=0:1:2", "body.gravity_m_s2=1:2:2"],
            "found 3 keys to vary, expected one, or two for a grid",
        ),
        (
            vec![&*format!("{speed}=4:10:1000"), "hopper.clearance_m=0:1:1000"],
            "the grid has 1000000 cells, expected at most 100000",
        ),
    ] {
        let mut args = vec!["trade", "scenario.toml"];
        for one in &vary {
            args.extend(["--vary", one]);
        }
        let Ran { status, stdout, stderr } = desk.run(&args);
        let sentence = stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!((status, stdout.as_str()), (2, ""), "{vary:?}: {stderr}");
        assert!(sentence.starts_with("error: --vary") && sentence.contains(said), "{vary:?}: {stderr}");
        assert_eq!(sentence.matches("error").count(), 1, "{stderr}");
    }
    let vary = "hopper.takeoff_speed_max_m_s=4:10:3";
    for (more, said) in [
        (["-o", "trade.xlsx"], "-o trade.xlsx: expected a file that ends in .csv or .json, or -"),
        (["--plot", "trade.pdf"], "'trade.pdf' does not end in .svg or .png"),
        (["-o", "no/such/folder.csv"], "no/such/folder.csv: cannot be written"),
    ] {
        let ran = desk.run(&[&["trade", "scenario.toml", "--vary", vary][..], &more].concat());
        assert_eq!(ran.status, 2);
        assert!(ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ").contains(said), "{}", ran.stderr);
    }
    assert_eq!(desk.run(&["trade", "scenario.toml"]).status, 2, "nothing to vary");
}

#[test]
fn compared_scenarios_agree_with_plan() {
    let desk = Desk::with_dem();
    // Slopes of 0.2 on ground with friction 0.1.
    desk.write("ice.toml", crate::desk::SCENARIO.replace("friction_coefficient = 0.6", "friction_coefficient = 0.1"));
    let files = ["scenario.toml", "map.toml", "ice.toml"];
    let all = json(&desk, &["compare", files[0], files[1], files[2], "--format", "json", "-o", "all.csv", "--plot", "all.svg"]);
    assert_eq!(all["schema"], "chta/compare/1");
    let rows = all["compared"].as_array().unwrap();
    assert_eq!(rows.len(), files.len());
    let mut speeds = Vec::new();
    for (file, row) in files.into_iter().zip(rows) {
        let plan = json(&desk, &["plan", file, "--format", "json"]);
        for key in ["verdict", "hops", "start_x_m", "goal_x_m", "totals"] {
            assert_eq!(row[key], plan[key], "{file}: {key}");
        }
        let hops = plan["path"].as_array().unwrap();
        let least = |of: &dyn Fn(&Value) -> f64| hops.iter().map(of).reduce(f64::min);
        let margin = least(&|hop| hop["speed_margin_m_s"].as_f64().unwrap());
        assert_eq!(row["margins"]["speed_margin_least_m_s"].as_f64(), margin, "{file}");
        let number = |hop: &Value, key: &str| hop[key].as_f64().unwrap();
        let span = least(&|hop| number(hop, "takeoff_angle_max_deg") - number(hop, "takeoff_angle_min_deg"));
        assert_eq!(row["margins"]["angle_span_least_deg"].as_f64(), span, "{file}");
        speeds.push(row["totals"]["peak_takeoff_speed_m_s"].as_f64());
    }
    assert!(speeds[0].is_some() && speeds[2].is_none(), "{speeds:?}");
    let table = desk.read("all.csv");
    assert!(table.starts_with("file,name,start_x_m,goal_x_m,verdict,hops,flight_time_s,"), "{table}");
    assert!(table.lines().nth(3).unwrap().starts_with("ice.toml,ice,0,40,no-path-found,,"), "{table}");
    assert!(desk.read("all.svg").contains("traversable"));
    let one_thread = json(&desk, &["compare", files[0], files[1], files[2], "--format", "json", "--threads", "1"]);
    assert_eq!(one_thread, all);
    let text = desk.run(&["compare", files[0], files[2]]);
    assert_eq!((text.status, text.stderr.as_str()), (0, ""), "a scenario without a path must not fail the comparison");
    assert!(text.stdout.contains("(2) ice.toml: ice") && text.stdout.contains("no-path-found"), "{}", text.stdout);
    assert_eq!(desk.run(&["compare", files[0]]).status, 2, "a single scenario cannot be compared");
    let chain = desk.run(&["compare", "scenario.toml", "chain.csv"]);
    assert!(chain.status == 2 && chain.stderr.contains("chain.csv: this is a chain CSV; expected a scenario"), "{chain:?}");
}

/// A case that fails is a row with the sentence of the command alone, and the others are answered.
#[test]
fn a_case_that_fails_does_not_end_the_others() {
    let desk = Desk::new();
    let scenario = crate::desk::SCENARIO;
    desk.write("no_key.toml", scenario.replace("friction_coefficient", "friktion_coefficient"));
    desk.write("no_terrain.toml", scenario.split("[terrain]").next().unwrap());
    let alone = |args: &[&str]| {
        let ran = desk.run(args);
        assert_eq!(ran.status, 2, "{args:?}: {ran:?}");
        ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let plain = |row: &Value| row["error"].as_str().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    for file in ["no_key.toml", "no_terrain.toml"] {
        let words = ["compare", file, "scenario.toml"];
        let all = json(&desk, &[&words[..], &["--format", "json", "-o", "all.csv", "--plot", "all.svg"]].concat());
        let rows = all["compared"].as_array().unwrap();
        assert_eq!((rows.len(), all["scenario"].as_array().unwrap().len()), (2, 1), "{file}");
        assert!(rows[0]["verdict"].is_null() && rows[1]["verdict"] == "traversable" && rows[1].get("error").is_none(), "{rows:?}");
        let error = plain(&rows[0]);
        assert!(alone(&["plan", file]).starts_with(&format!("error: {error}")), "{file}: {error}");
        assert!(desk.read("all.csv").lines().nth(1).unwrap().contains(&error[..20]), "{file}");
        assert!(desk.read("all.svg").contains("failed"), "{file}");
        let text = desk.run(&words);
        assert!(text.status == 0 && text.stdout.contains("(1) failed: "), "{text:?}");
        assert_eq!(desk.run(&[&words[..], &["--require-all"]].concat()).status, 1, "{file}");
        alone(&["compare", file, file]);
        alone(&["compare", file, "scenario.toml", "--set", "hopper.no_such_key=1"]);
    }

    // The chain ends at 40 m, and the least take-off angle must be below the greatest.
    let settings: [(&str, &[&str], &[bool]); 3] = [
        ("terrain.goal_x_m=30:50:3", &[], &[true, true, false]),
        ("terrain.goal_x_m=-10:10:3", &[], &[false, true, true]),
        ("hopper.takeoff_angle_min_deg=20:80:3", &["--set", "hopper.takeoff_angle_max_deg=70"], &[true, true, false]),
    ];
    for (vary, more, answered) in settings {
        let words = [&["trade", "scenario.toml", "--vary", vary], more].concat();
        let trade = json(&desk, &[&words[..], &["--format", "json", "-o", "rows.csv", "--plot", "rows.svg"]].concat());
        let (key, _) = vary.split_once('=').unwrap();
        for (row, is_answered) in trade["rows"].as_array().unwrap().iter().zip(answered) {
            assert_eq!((row["verdict"].is_string(), row.get("error").is_none()), (*is_answered, *is_answered), "{vary}: {row}");
            if key == "terrain.goal_x_m" && row.get("error").is_some() {
                let setting = format!("{key}={}", row[key]);
                assert_eq!(format!("error: {}", plain(row)), alone(&["check", "scenario.toml", "--set", &setting]));
            }
        }
        assert_eq!(desk.read("rows.csv").lines().count(), 4, "{vary}");
        assert!(desk.read("rows.svg").contains("failed: no answer"), "{vary}");
        let text = desk.run(&words);
        assert!(text.status == 0 && text.stdout.contains("!: failed, first with"), "{text:?}");
        assert_eq!(desk.run(&[&words[..], &["--require-all"]].concat()).status, 1, "{vary}");
    }
}

/// A tapered clearance that no hop of the path is long enough to keep asks for the same at every greater value: there is no bound to find.
#[test]
fn a_clearance_that_its_taper_keeps_from_binding_has_no_bound() {
    let desk = Desk::new();
    for (set, never_binds) in [("hopper.clearance_rule=\"tapered\"", true), ("hopper.clearance_rule=\"vertex\"", false)] {
        let args = ["require", "scenario.toml", "--vary", "hopper.clearance_m", "--set", set];
        let answer = desk.json(&args);
        assert_eq!(answer["never_binds"].as_bool(), never_binds.then_some(true), "{set}: {answer}");
        let text = desk.run(&args).stdout;
        assert_eq!(text.contains("does not bind at any value"), never_binds, "{text}");
        assert_eq!(text.contains("unreachable"), !never_binds, "{text}");
    }
}
