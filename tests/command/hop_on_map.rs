//! One hop between two positions of a map: the answer of a slice and a hop along it, and what is refused.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::{Desk, ON_MAP};

/// A folder with a raster, zones on it, and scenarios: plain, with zones and further limits, and with ends on a transect that bends.
fn desk() -> Desk {
    let desk = Desk::with_dem();
    let zone = r#"{"type":"Polygon","coordinates":[[[8,8],[9,8],[9,11],[8,11],[8,8]]]}"#;
    desk.write("zones.geojson", zone);
    let limits = "friction_coefficient = 0.8\nkeep_out = \"zones.geojson\"\nrest_slope_max_deg = 35";
    let kept =
        ON_MAP.replace("friction_coefficient = 0.8", limits).replace("landing_speed_max_m_s = 6.0", "landing_speed_max_m_s = 5.0");
    desk.write("kept.toml", kept.replace("[hopper]", "[hopper]\nclearance_m = 0.1\napex_height_max_m = 4.0"));
    desk.write("bent.toml", ON_MAP.replace("goal_m", "via_m = [[9, 3]]\ngoal_m"));
    desk
}

/// The answer without what names its question.
fn answer(mut document: Value) -> Value {
    let keys = document.as_object_mut().unwrap();
    for key in ["scenario", "inputs", "warnings", "crs"] {
        keys.remove(key);
    }
    document
}

#[test]
fn a_hop_on_a_map_is_the_hop_along_its_slice() {
    let desk = desk();
    let (mut feasible, mut refused) = (0, 0);
    for scenario in ["map.toml", "kept.toml"] {
        for (from, to) in [
            ("3,4", "9,11"),
            ("9,11", "3,4"),
            ("5,5", "9,5"),
            ("5.25,5.5", "5.25,11"),
            ("2,2", "7,7"),
            ("11.3,4.7", "6.1,3.2"),
            ("8.5,9", "4,9"),
            ("4,9", "8.5,9"),
            ("1,1", "18,18"),
        ] {
            let found = desk.json(&["hop", "ground.tif", "--from", from, "--to", to, "--scenario", scenario]);
            let sliced = desk.run(&["slice", "ground.tif", "--from", from, "--to", to, "--scenario", scenario, "-o", "edge.csv"]);
            assert_eq!(sliced.status, 0, "{}", sliced.stderr);
            let end = desk.read("edge.csv").lines().last().unwrap().split(',').next().unwrap().to_owned();
            let along = desk.json(&["hop", "edge.csv", "--from", "0", "--to", &end, "--scenario", scenario]);
            let number = |text: &str| text.split(',').map(|part| part.parse::<f64>().unwrap()).collect::<Vec<_>>();
            for (key, text) in [("takeoff_m", from), ("landing_m", to)] {
                let at: Vec<f64> = serde_json::from_value(found[key].clone()).unwrap();
                assert_eq!((at.len(), &at[..2]), (3, &number(text)[..]), "{from} to {to}");
            }
            let (start, goal) = (number(from), number(to));
            let heading_deg = (goal[0] - start[0]).atan2(goal[1] - start[1]).to_degrees().rem_euclid(360.0);
            assert!((found["heading_deg"].as_f64().unwrap() - heading_deg).abs() < 1e-9, "{from} to {to}");
            if found["feasible"] == true {
                feasible += 1;
            } else {
                refused += 1;
            }
            assert_eq!(answer(found), answer(along), "{scenario}: {from} to {to}");
        }
    }
    assert!(feasible >= 5 && refused >= 5, "{feasible} feasible, {refused} refused");
}

#[test]
fn a_scenario_on_a_map_takes_both_forms_and_keeps_its_other_end() {
    let desk = desk();
    let ends = |args: &[&str]| {
        let document = desk.json(&[&["hop"], args].concat());
        ["takeoff_m", "landing_m"].map(|key| {
            let at: Vec<f64> = serde_json::from_value(document[key].clone()).unwrap();
            (at[0], at[1])
        })
    };
    assert_eq!(ends(&["map.toml", "--from", "3,4", "--to", "5,6"]), [(3.0, 4.0), (5.0, 6.0)]);
    assert_eq!(ends(&["map.toml", "--from", "3,4"]), [(3.0, 4.0), (15.0, 12.0)]);
    assert_eq!(ends(&["map.toml", "--to", "3,4"]), [(1.0, 2.0), (3.0, 4.0)]);
    // Along the transect from (1, 2) to (15, 12).
    let [(x_m, y_m), goal] = ends(&["map.toml", "--from", "5"]);
    assert!((x_m - 1.0 - 5.0 * 14.0 / 296f64.sqrt()).abs() < 1e-9 && (y_m - 2.0 - 5.0 * 10.0 / 296f64.sqrt()).abs() < 1e-9);
    assert_eq!(goal, (15.0, 12.0));
    // Between two positions of a map no transect bends.
    let straight = desk.json(&["hop", "bent.toml", "--from", "3,4", "--to", "5,6"]);
    assert_eq!(straight["to_x_m"].as_f64(), Some(8f64.sqrt()));
    assert_eq!(straight["scenario"]["terrain"].get("via_m"), None);
    // The answer names the hop that it is for, so that its scenario repeats it.
    desk.write("again.json", straight.to_string());
    assert_eq!(answer(desk.json(&["hop", "again.json"])), answer(straight));
}

#[test]
fn what_is_no_hop_on_a_map_is_refused_with_what_is_expected() {
    let desk = desk();
    let hole = "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 5\nNODATA_value -9\n0 0 0 0\n0 0 -9 0\n0 0 0 0\n";
    desk.write("hole.asc", hole);
    let on = |terrain: &'static str, from: &'static str, to: &'static str| {
        ["hop", terrain, "--from", from, "--to", to, "--scenario", "map.toml"]
    };
    let counts = "a position is X along a chain, X,Y on a map and X,Y,Z on a mesh";
    for (args, said) in [
        (
            &on("ground.tif", "3,4", "30,4")[..],
            &["ground.tif", "the goal point (30 m, 4 m) is off the map", "expected x from 0 to 19 m"][..],
        ),
        (&on("ground.tif", "-3,4", "3,4"), &["the start point (-3 m, 4 m) is off the map"]),
        (&on("ground.tif", "3,4", "3,4"), &["starts and ends at the same point (3 m, 4 m)", "expected two different points"]),
        (&on("hole.asc", "3,7", "17,7"), &["hole.asc", "no-data"]),
        (&on("hole.asc", "12.5,7.5", "17,7"), &["hole.asc", "no-data"]),
        (
            &on("ground.tif", "3", "3,4"),
            &["--from: found `3` (1 number), expected two finite numbers", counts, "ground.tif is an elevation raster"],
        ),
        (&on("ground.tif", "3,4", "-3"), &["--to: found `-3` (1 number), expected two finite numbers", counts]),
        (&on("chain.csv", "3,4", "5"), &["--from: found `3,4` (2 numbers), expected one number", counts, "chain.csv is a chain"]),
        (
            &["hop", "scenario.toml", "--to", "3,4"],
            &["--to: found `3,4` (2 numbers), expected one number", "scenario.toml is a chain"],
        ),
        (
            &["hop", "map.toml", "--from", "3,4", "--to", "5"],
            &["--from: found `3,4` (2 numbers), --to: found `5` (1 number)", "expected both in one form"],
        ),
        (&["hop", "ground.tif", "--from", "3,4", "--scenario", "map.toml"], &["ground.tif: found no goal, expected --to X,Y"]),
        (&["hop", "ground.tif", "--scenario", "map.toml"], &["ground.tif: found no start, expected --from X,Y"]),
        (
            &["hop", "ground.tif", "--from", "3,4", "--to", "5,6", "--body", "mars"],
            &["found no hopper.takeoff_speed_max_m_s", "--set"],
        ),
        (&["hop", "map.toml", "--from", "3,4,5"], &["(3 numbers), expected two finite numbers in metres", counts]),
        (
            &["hop", "plate.obj", "--from", "3,4", "--to", "5,6"],
            &["--from: found `3,4` (2 numbers), expected three finite numbers in metres, X,Y,Z", counts, "plate.obj is a mesh"],
        ),
    ] {
        let ran = desk.run(args);
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{args:?}");
        let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in said {
            assert!(sentence.contains(part), "{args:?}: {sentence}");
        }
    }
}
