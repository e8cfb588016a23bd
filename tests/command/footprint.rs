//! Footprints from the command line: bad input, warnings, names of limits in answers and pictures.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use crate::desk::Desk;

/// A table of 60 m with a pit of 1 m at x = 30, and a ramp after 60.
const GROUND: &str = "x_m,z_m\n0,0\n25,0\n30,-1\n35,0\n60,0\n66,2.4\n90,2.4\n120,2.4\n";

fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("table.csv", GROUND);
    let scenario = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 5\nlanding_speed_max_m_s = 5\n[surface]\n\
                    friction_coefficient = 1.5\nrest_slope_max_deg = 15\n[terrain]\nchain = \"table.csv\"\nstart_x_m = 5\ngoal_x_m = 100\n\
                    [search]\nnode_spacing_max_m = 1\n";
    desk.write("table.toml", scenario);
    desk
}

/// Each row: the keys, and what the sentence has to say: the value found, what is expected, and the remedy.
#[test]
fn a_footprint_without_meaning_is_refused_in_one_sentence() {
    let desk = desk();
    let table: [(&[&str], &[&str]); 7] = [
        (&["hopper.footprint_m=-1"], &["hopper.footprint_m is -1", "expected a number from 0 to"]),
        (&["hopper.footprint_m=nan"], &["hopper.footprint_m"]),
        (&["hopper.footprint_m=2", "hopper.roughness_max_m=-0.1"], &["hopper.roughness_max_m is -0.1", "expected a number from 0"]),
        (&["hopper.roughness_max_m=0.1"], &["hopper.roughness_max_m is 0.1, expected a footprint_m above 0 beside it", "remove"]),
        (&["hopper.footprint_m=0", "hopper.roughness_max_m=0.1"], &["expected a footprint_m above 0 beside it"]),
        (
            &["hopper.footprint_m=500"],
            &["hopper.footprint_m is 500 m, expected less than the length of the chain, of 120 m", "unit"],
        ),
        (&["hopper.footprint_m=wide"], &["hopper.footprint_m"]),
    ];
    for (keys, parts) in table {
        let args: Vec<&str> = ["check", "table.toml"].into_iter().chain(keys.iter().flat_map(|key| ["--set", key])).collect();
        desk.refused(&args, parts);
    }
    let wide = ["--set", "hopper.footprint_m=500"];
    let on_dem = ["hopper.footprint_m is 500 m", "shorter side"];
    desk.refused(&[&["plan", "map.toml"], &wide[..]].concat(), &on_dem);
    desk.refused(&[&["map", "ground.tif", "--start", "3,3", "--scenario", "map.toml", "-o", "m.tif"], &wide[..]].concat(), &on_dem);
    desk.refused(
        &[&["fan", "ground.tif", "--from", "9,9", "--length", "5", "--scenario", "map.toml"], &wide[..]].concat(),
        &on_dem,
    );
}

/// Each row: the command on the DEM of 1 m posts, and whether a footprint of half a metre gives the warning.
#[test]
fn a_dem_coarser_than_the_footprint_is_warned_of() {
    let desk = desk();
    let start = ["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"];
    let fan = ["fan", "ground.tif", "--from", "9,9", "--length", "5", "--scenario", "map.toml"];
    let table: [(&[&str], bool); 5] = [
        (&["plan", "map.toml"], true),
        (&["check", "map.toml"], true),
        (&start, true),
        (&fan, true),
        (&["plan", "table.toml"], false),
    ];
    for (command, warns) in table {
        for (footprint, coarse) in [("hopper.footprint_m=0.5", true), ("hopper.footprint_m=1.5", false)] {
            let ran = desk.run(&[command, &["--set", footprint]].concat());
            assert!(ran.status < 2, "{command:?}: {}", ran.stderr);
            let warned = ran.stderr.contains("the posts of the DEM lie 1 m apart, farther than hopper.footprint_m of 0.5 m");
            assert_eq!(warned, warns && coarse, "{command:?} {footprint}: {}", ran.stderr);
        }
    }
}

/// The pit and the foot of the ramp refuse contacts by their names, in JSON, text, hop test and picture.
#[test]
fn answers_name_the_limits_of_a_footprint() {
    let desk = desk();
    let keys = ["--set", "hopper.footprint_m=4", "--set", "hopper.roughness_max_m=0.05"];
    let plan = desk.json(&[&["plan", "table.toml", "--verify", "--plot", "p.svg"], &keys[..]].concat());
    assert_eq!(plan["verdict"], "traversable", "{plan}");
    let counts = plan["refusals"].as_object().unwrap();
    assert!(counts["footprint-slope"].as_u64() > Some(0) && counts["roughness"].as_u64() > Some(0), "{counts:?}");
    assert_eq!(plan["scenario"]["hopper"]["footprint_m"], 4.0);
    let picture = desk.read("p.svg");
    for words in ["no contact: too steep under the footprint", "no contact: too rough", "footprint 4 m", "roughness ≤ 0.05 m"] {
        assert!(picture.contains(words), "the picture does not say {words}");
    }
    // Every contact of the plan stands clear of the kinks by half a footprint, or has ground plane enough.
    for hop in plan["path"].as_array().unwrap() {
        let x_m = hop["landing_x_m"].as_f64().unwrap();
        assert!(!(28.0..32.0).contains(&x_m), "a contact in the pit, at {x_m}");
    }
    let hop = desk.json(&[&["hop", "table.toml", "--from", "10", "--to", "30"], &keys[..]].concat());
    assert!(hop.to_string().contains("roughness"), "{hop}");
    let start = desk.run(&[&["check", "table.toml", "--start", "30"], &keys[..]].concat());
    assert_eq!(start.status, 1, "{start:?}");
    for words in ["footprint of 4 m", "off the fitted plane, more than the roughness of 0.05 m", "deg"] {
        assert!(start.stdout.contains(words), "{}", start.stdout);
    }
}

/// A proof says that it leaves the footprint out inside segments; without a footprint its bytes are as before.
#[test]
fn a_proof_says_what_it_does_of_the_footprint() {
    let desk = desk();
    let proof = |keys: &[&str]| desk.json(&[&["check", "table.toml", "--prove", "--prove-cells-max", "200"], keys].concat());
    assert!(proof(&["--set", "hopper.footprint_m=4"]).to_string().contains("\"footprint_at_vertices_alone\":true"));
    assert!(!proof(&[]).to_string().contains("footprint_at_vertices_alone"));
}

/// Every command of trials and sweeps runs with a footprint; a trade over it reads what each of its values needs.
#[test]
fn trials_and_trades_judge_the_footprint() {
    let desk = desk();
    let errors = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.05\ngoal_tolerance_m = 3\ntrials = 300\nfriction_sigma = 0.01\n\
                  height_sigma_m = 0.01\nheight_correlation_m = 5\n";
    desk.write("errors.toml", format!("{}{errors}", desk.read("table.toml")));
    desk.write("on_map.toml", format!("{}{errors}", desk.read("map.toml")));
    let keys = ["--set", "hopper.footprint_m=1.5", "--set", "hopper.roughness_max_m=0.02"];
    let slid = |keys: &[&str]| {
        let answer = desk.json(&[&["simulate", "errors.toml", "--policy", "open-loop"], keys].concat());
        let outcomes = &answer["outcomes"];
        let of = |name: &str| {
            outcomes.get(name).and_then(|one| one.get("count").or(Some(one))).and_then(serde_json::Value::as_f64).unwrap_or(-1.0)
        };
        of("slid_at_landing") + of("slid_at_takeoff")
    };
    assert!(slid(&keys) > slid(&[]), "the footprint refuses no landing of a trial");
    for policy in ["open-loop", "replan"] {
        let ran = desk.run(&["simulate", "on_map.toml", "--policy", policy, "--set", "hopper.footprint_m=1.5"]);
        assert!(ran.status < 2, "{policy}: {}", ran.stderr);
    }
    let trade = desk.json(&["trade", "map.toml", "--vary", "hopper.footprint_m=0.5:6:3"]);
    assert!(trade.to_string().contains("traversable"), "{trade}");
    let risky = desk.run(&[&["plan", "errors.toml", "--set", "search.risk=traded"], &keys[..]].concat());
    assert!(risky.status < 2, "{}", risky.stderr);
}
