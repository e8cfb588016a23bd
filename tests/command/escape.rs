//! No hop reaches the escape speed of a body of known radius, in any command; contradictions of body, terrain and limits are said.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::fs;

use crate::desk::Desk;
use serde_json::Value;

/// Escape speed of Bennu, sqrt(2 GM / R) with GM = 4.892 m^3/s^2 and R = 245.03 m (OSIRIS-REx): 0.19982 m/s.
fn escape_m_s() -> f64 {
    (2.0_f64 * 4.892 / 245.03).sqrt()
}

/// Hops on Bennu: flat ground of 500 m. One hop over all of it needs sqrt(g X / sin 2 a), at 59 degrees 0.2149 m/s.
const ON_BENNU: &str = "[body]\nname = \"bennu\"\n[hopper]\ntakeoff_speed_max_m_s = 0.25\nlanding_speed_max_m_s = 0.25\n\
    [surface]\nfriction_coefficient = 0.6\n[terrain]\nchain = \"flat.csv\"\nstart_x_m = 0\ngoal_x_m = 500\n";

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("flat.csv", "x_m,z_m\n0,0\n400,0\n500,0\n");
    // The same ground with speeds of its own, above escape.
    let own = "0,0,5,85,5,-85,-5,5\n400,0,5,85,5,-85,-5,5\n500,0,,,,,,\n";
    let head =
        "x_m,z_m,takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,landing_speed_max_m_s\n";
    desk.write("own.csv", format!("{head}{own}"));
    // A cliff of 150 m: a take-off of 0.15 m/s lands with sqrt(v^2 + 2 g H) = 0.216 m/s.
    desk.write("cliff.csv", "x_m,z_m\n0,150\n100,150\n101,0\n400,0\n");
    desk.write("bennu.toml", ON_BENNU);
    desk
}

/// Every number under a name anywhere in a document.
fn numbers(document: &Value, name: &str, found: &mut Vec<f64>) {
    match document {
        Value::Object(keys) => {
            for (key, value) in keys {
                if key == name {
                    found.extend(value.as_f64());
                }
                // The scenario repeats the limits as typed.
                if key != "scenario" {
                    numbers(value, name, found);
                }
            }
        }
        Value::Array(items) => items.iter().for_each(|item| numbers(item, name, found)),
        _ => {}
    }
}

#[test]
fn no_command_answers_with_a_hop_at_escape_speed() {
    let desk = desk();
    desk.run(&["synth", "--rows", "30", "--cols", "30", "--spacing-m", "20", "--no-ground", "-o", "flat.tif"]);
    let set = ["--set", "hopper.takeoff_speed_max_m_s=0.25", "--set", "hopper.landing_speed_max_m_s=0.25"];
    let own = ["--body", "bennu", "--set", "surface.rest_slope_max_deg=inf"];
    let cliff: &[&str] = &["plan", "cliff.csv", "--scenario", "bennu.toml", "--start", "0", "--goal", "300"];
    let of_map = ["--scenario", "bennu.toml"];
    // Command and status: 1 where the one hop asked for would need 0.2149 m/s.
    let rows: [(Vec<&str>, i32); 9] = [
        (vec!["hop", "bennu.toml"], 1),
        (vec!["check", "bennu.toml"], 0),
        (vec!["check", "bennu.toml", "--prove"], 0),
        (vec!["plan", "bennu.toml", "--verify"], 0),
        ([&["plan", "own.csv", "--start", "0", "--goal", "500", "--verify"], &own[..]].concat(), 0),
        ([&["hop", "own.csv", "--from", "0", "--to", "500"], &own[..]].concat(), 1),
        ([cliff, &set].concat(), 0),
        ([&["fan", "flat.tif", "--from", "290,290", "--headings", "4", "--length", "280"], &of_map[..]].concat(), 0),
        ([&["map", "flat.tif", "--start", "0,0", "--goal", "560,560"], &of_map[..]].concat(), 0),
    ];
    for (command, status) in rows {
        let ran = desk.run(&[&command[..], &["--format", "json"]].concat());
        assert_eq!(ran.status, status, "{command:?}: {ran:?}");
        assert!(ran.stderr.contains("escape speed of bennu, 0.199824 m/s"), "{command:?} says nothing of escape: {}", ran.stderr);
        let document: Value = serde_json::from_str(&ran.stdout).unwrap();
        let said =
            document["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains("at or above the escape speed"));
        assert!(said, "{command:?}: {}", document["warnings"]);
        let mut speeds = Vec::new();
        for name in ["takeoff_speed_m_s", "landing_speed_m_s", "peak_takeoff_speed_m_s"] {
            numbers(&document, name, &mut speeds);
        }
        assert!(speeds.iter().all(|speed| *speed < escape_m_s()), "{command:?}: {speeds:?}");
    }
    // 500 m are two hops, not one: a hop below escape covers at most 2 R = 490 m on flat ground.
    assert_eq!(desk.json(&["check", "bennu.toml"])["hops"], 2);
    let proved = desk.json(&["check", "bennu.toml", "--prove"]);
    assert_eq!((&proved["lower_bound"], &proved["proved"]), (&2.into(), &true.into()));
}

#[test]
fn a_body_of_unknown_radius_and_limits_below_escape_are_left_alone() {
    let desk = desk();
    // Bennu's gravity alone, and Bennu with limits below escape: no word of escape, and the same hops as before.
    for (options, hops) in [
        (vec!["--set", "body.gravity_m_s2=8.148e-5"], None),
        (vec!["--set", "hopper.takeoff_speed_max_m_s=0.195", "--set", "hopper.landing_speed_max_m_s=0.195"], Some(2)),
    ] {
        if hops.is_none() {
            desk.write("bennu.toml", ON_BENNU.replace("name = \"bennu\"", "gravity_m_s2 = 8.148e-5"));
        } else {
            desk.write("bennu.toml", ON_BENNU);
        }
        let ran = desk.run(&[&["check", "bennu.toml", "--format", "json"], &options[..]].concat());
        assert_eq!(ran.status, 0, "{ran:?}");
        assert!(!ran.stderr.contains("at or above"), "{}", ran.stderr);
        let document: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_eq!(document["hops"], hops.unwrap_or(1), "{options:?}");
    }
}

#[test]
fn varied_limits_beyond_escape_have_the_answer_of_the_cap_and_say_so() {
    let desk = desk();
    desk.write("own.toml", ON_BENNU.replace("flat.csv", "cliff.csv").replace("goal_x_m = 500", "goal_x_m = 300"));
    let landing = ["--vary", "hopper.takeoff_speed_max_m_s=0.1:0.4:4"];
    let ran = desk.run(&[&["trade", "bennu.toml", "--format", "json"], &landing[..]].concat());
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    let rows = document["rows"].as_array().unwrap();
    // 0.1 m/s is below escape, 0.2 to 0.4 are not, though the landing limit of 0.25 m/s is in all of them.
    assert_eq!(rows.iter().map(|row| row["above_escape"] == true).collect::<Vec<_>>(), [true; 4]);
    assert!(rows.windows(2).skip(1).all(|pair| pair[0]["hops"] == pair[1]["hops"]), "{rows:?}");
    assert!(ran.stderr.contains("4 of 4 cells, the first with hopper.takeoff_speed_max_m_s = 0.1, have a speed limit at or above"));
    let both = [&landing[..], &["--set", "hopper.landing_speed_max_m_s=0.19"]].concat();
    let ran = desk.run(&[&["trade", "bennu.toml", "--format", "json"], &both[..]].concat());
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    let rows = document["rows"].as_array().unwrap();
    assert_eq!(rows.iter().map(|row| row["above_escape"] == true).collect::<Vec<_>>(), [false, true, true, true]);
    assert!(document["warnings"].to_string().contains("3 of 4 cells, the first with hopper.takeoff_speed_max_m_s = 0.2"));
    // The whole range of `require` up to 100 m/s: the answer is below escape, and the cap is said.
    let ran = desk.run(&["require", "bennu.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--format", "json"]);
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert!(document["reachable_at"].as_f64().unwrap() < escape_m_s(), "{document}");
    assert_eq!(document["resolution_met"], true);
    assert!(document["warnings"].to_string().contains("hopper.takeoff_speed_max_m_s is 100 m/s, at or above the escape speed"));
    // A range beyond escape changes nothing, which is said.
    let beyond = ["require", "bennu.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "0.5", "--to", "5"];
    let ran = desk.run(&beyond);
    assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{ran:?}");
    assert!(ran.stderr.contains("no value from 0.5 to 5 changes anything here") && ran.stderr.contains("the escape speed decide"));
}

#[test]
fn the_limit_is_repeated_as_typed_and_gives_the_same_bytes() {
    let desk = desk();
    assert_eq!(desk.run(&["run", "bennu.toml", "-o", "out"]).status, 0);
    let first = desk.read("out/result.json");
    let document: Value = serde_json::from_str(&first).unwrap();
    assert_eq!(document["scenario"]["hopper"]["takeoff_speed_max_m_s"], 0.25);
    assert_eq!(desk.run(&["run", "out/result.json", "-o", "again"]).status, 0);
    assert_eq!(first, desk.read("again/result.json"));
    assert!(desk.read("out/path.svg").contains("0.19"), "the picture states the limit that counts");
}

#[test]
fn an_error_that_lifts_a_take_off_to_escape_loses_the_hopper() {
    let desk = desk();
    // The plan's hops take some 0.19 m/s of 0.1998: an error of 50 % lifts many over escape, none of which lands.
    let errors = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.4\ngoal_tolerance_m = 1000\npolicy = \"open-loop\"\n[search]\nrisk = \"ignored\"\n";
    desk.write("errors.toml", format!("{ON_BENNU}{errors}"));
    let ran = desk.run(&["simulate", "errors.toml", "--trials", "400", "-o", "rows.csv", "--format", "json"]);
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert!(document["outcomes"]["lost"].as_u64().unwrap() > 50, "{}", document["outcomes"]);
    let rows = desk.read("rows.csv");
    let header: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|one| *one == name).unwrap();
    let speed = column("takeoff_speed_m_s");
    let fastest = rows.lines().skip(1).map(|row| row.split(',').nth(speed).unwrap().parse::<f64>().unwrap()).fold(0.0, f64::max);
    assert!(fastest < escape_m_s(), "a hop of {fastest} m/s landed");
}

#[test]
fn a_body_that_contradicts_gravity_radius_or_terrain_is_said() {
    let desk = Desk::with_dem();
    // A box of 100 by 80 by 60 m, and the same a thousandth of it.
    let box_of = |size: f64| {
        let at = |x: f64, y: f64, z: f64| format!("v {} {} {}\n", x * size, y * size, z * size);
        let corners: String = [(0.0, 0.0), (100.0, 0.0), (100.0, 80.0), (0.0, 80.0)]
            .into_iter()
            .flat_map(|(x, y)| [at(x, y, 0.0), at(x, y, 60.0)])
            .collect();
        format!("{corners}f 2 4 6\nf 2 6 8\nf 1 3 5\nf 1 5 7\n")
    };
    desk.write("box.obj", box_of(1.0));
    let mesh = |body: &str, scale: &str, size: f64| {
        format!(
            "[body]\n{body}\n[hopper]\ntakeoff_speed_max_m_s = 0.05\nlanding_speed_max_m_s = 0.05\n[surface]\nfriction_coefficient = 0.6\n\
             [terrain]\nmesh = \"box.obj\"\n{scale}\nstart_m = [{}, {}]\ngoal_m = [{}, {}]\n",
            20.0 * size,
            30.0 * size,
            21.0 * size,
            30.0 * size
        )
    };
    let chain = |body: &str| {
        format!(
            "[body]\n{body}\n[hopper]\ntakeoff_speed_max_m_s = 9\nlanding_speed_max_m_s = 9\n[surface]\nfriction_coefficient = 0.6\n\
             [terrain]\nchain = \"chain.csv\"\nstart_x_m = 0\ngoal_x_m = 1\n"
        )
    };
    // What is given, whether it is refused, and the two values that must be said; nothing where all is well.
    let rows: [(String, bool, &[&str]); 14] = [
        (chain("name = \"mars\""), false, &[]),
        (chain("name = \"mars\"\ngravity_m_s2 = 3.72"), false, &[]),
        (
            chain("name = \"mars\"\ngravity_m_s2 = 1.62"),
            false,
            &["body.gravity_m_s2 is 1.62 m/s^2, 56 % below the 3.711 m/s^2 of mars"],
        ),
        (chain("name = \"mars\"\ngravity_m_s2 = 9.81"), false, &["9.81 m/s^2, 164 % above the 3.711 m/s^2 of mars"]),
        (chain("name = \"moon\"\nradius_m = 1838000"), false, &["body.radius_m is 1838000 m, 6 % above the 1737400 m of moon"]),
        (chain("name = \"moon\"\nradius_m = 1737.4"), true, &["body.radius_m is 1737.4 m", "1737400 m", "give it in metres"]),
        (chain("gravity_m_s2 = 1.62\nradius_m = 1737400"), false, &[]),
        (chain("gravity_m_s2 = 1.62\nradius_m = 1737.4"), false, &["1.62 m/s^2 and body.radius_m of 1737.4 m", "kg/m^3", "metres"]),
        // The box is 100 m wide: Bennu has room for it, not for one of 1000 m, of which it says the way to mend it.
        (mesh("name = \"bennu\"", "", 1.0), false, &[]),
        (mesh("name = \"bennu\"", "mesh_scale = 10", 10.0), true, &["1000 m wide", "245.03 m", "mesh_scale"]),
        (mesh("name = \"ryugu\"", "mesh_scale = 1000", 1000.0), true, &["box.obj", "100000 m wide", "448 m", "mesh_scale"]),
        // A radius alone leaves the shape open: over the diameter is likely wrong, far over it certainly.
        (mesh("gravity_m_s2 = 1e-5\nradius_m = 30", "", 1.0), false, &["100 m wide", "60 m"]),
        (mesh("gravity_m_s2 = 1e-5\nradius_m = 15", "", 1.0), true, &["100 m wide", "15 m", "mesh_scale"]),
        // A whole body in kilometres, read as metres: a tenth of a metre against the 900 m of Ryugu.
        (mesh("name = \"bennu\"", "mesh_scale = 0.005", 0.005), false, &["0.5 m wide", "490.06 m", "mesh_scale = 1000"]),
    ];
    for (scenario, refused, parts) in rows {
        desk.write("body.toml", &scenario);
        let ran = desk.run(&["check", "body.toml"]);
        assert_eq!(ran.status == 2, refused, "{scenario}: {ran:?}");
        for part in parts {
            assert!(ran.stderr.contains(part), "{part:?} is not in {} of {scenario}", ran.stderr);
        }
        assert!(!parts.is_empty() || !ran.stderr.contains("body"), "{scenario}: {}", ran.stderr);
    }
    // A raster of 19 km on Bennu, in every command that reads one.
    assert_eq!(desk.run(&["synth", "--rows", "20", "--cols", "20", "--spacing-m", "1000", "-o", "wide.tif"]).status, 0);
    desk.write(
        "wide.toml",
        fs::read_to_string(desk.path().join("map.toml")).unwrap().replace("mars", "bennu").replace("ground", "wide"),
    );
    for command in [
        vec!["check", "wide.toml"],
        vec!["map", "wide.tif", "--start", "1,2", "--scenario", "wide.toml"],
        vec!["fan", "wide.tif", "--from", "1,2", "--length", "5", "--scenario", "wide.toml"],
        vec!["slice", "wide.tif", "--from", "1,2", "--to", "9,9", "--scenario", "wide.toml"],
    ] {
        desk.refused(&command, &["wide.tif", "19000 m wide", "bennu", "245.03 m"]);
    }
}
