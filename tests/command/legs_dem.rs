//! Robots with legs over elevation rasters: plans, trials, maps, and what is refused.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use chta::terrain::{Dem, Triangles, read_dem};
use serde_json::Value;

use crate::desk::{Desk, FOUR_LEGS, raster};

/// Four legs without the limits on stroke, forces and spin, which take most of the time.
fn light() -> String {
    let heavy = ["stroke_m", "spin_max_rad_s", "force_max_n"];
    FOUR_LEGS.lines().filter(|line| !heavy.iter().any(|key| line.starts_with(key))).collect::<Vec<_>>().join("\n")
}

/// A rolling ground of 40 by 30 posts half a metre apart, without elevations in a block, and a wall across with a gap.
fn ground(gap: bool) -> String {
    let mut text = "ncols 40\nnrows 30\nxllcenter 0\nyllcenter 0\ncellsize 0.5\nNODATA_value -9999\n".to_owned();
    for row in 0..30 {
        let height = |col: u32| {
            let (x, y) = (0.5 * f64::from(col), 0.5 * f64::from(29 - row));
            let z = 0.3 * (0.7 * x).sin() * (0.5 * y).cos();
            let is_gap = gap && (16..=19).contains(&col) && row >= 8;
            if is_gap { "-9999".to_owned() } else { format!("{z:.4}") }
        };
        text.push_str(&(0..40).map(height).collect::<Vec<_>>().join(" "));
        text.push('\n');
    }
    text
}

fn scenario(more: &str) -> String {
    format!(
        "[body]\nname = \"mars\"\n[robot]\nfile = \"legs.toml\"\n[surface]\nfriction_coefficient = 0.8\n[terrain]\ndem = \"ground.asc\"\n\
         route = \"free\"\nstart_m = [4, 4]\ngoal_m = [14, 5]\n[search]\ncontacts_max = 200\nseed = 3\n{more}"
    )
}

const ERRORS: &str = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ntakeoff_angle_sigma_deg = 1\ngoal_tolerance_m = 2\ntrials = 30\nseed = 1\n";

fn desk(gap: bool) -> (Desk, Dem) {
    let desk = Desk::new();
    desk.write_legs("legs.toml", &light());
    desk.write("ground.asc", ground(gap));
    desk.write("plan.toml", scenario(ERRORS));
    let dem = read_dem(&desk.path().join("ground.asc")).unwrap();
    (desk, dem)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// Every foot of an answer that stands.
fn feet(document: &Value) -> Vec<Vec<f64>> {
    let stances = document["stances"].as_array().unwrap();
    let contacts = stances.iter().flat_map(|stance| stance["contacts"].as_array().unwrap());
    contacts.filter(|foot| foot["outcome"] == "stands").map(|foot| numbers(&foot["position_m"])).collect()
}

#[test]
fn a_plan_over_a_raster_stands_on_its_facets_and_flies_over_known_ground_alone() {
    let (desk, dem) = desk(true);
    let document = desk.json(&["plan", "plan.toml", "--plot", "route.svg"]);
    assert_eq!((&document["verdict"], &document["verified"]), (&"traversable".into(), &true.into()), "{}", document["gap"]);
    assert_eq!((&document["ground"]["kind"], &document["ground"]["no_data_posts"]), (&"dem".into(), &(4 * 22).into()));
    let triangles = Triangles::of(&dem);
    for foot in feet(&document) {
        let (z_m, _) = triangles.at([foot[0], foot[1]].into(), triangles.nominal()).unwrap();
        assert!((z_m - foot[2]).abs() < 1e-9, "{foot:?} stands at {z_m} m");
    }
    // The gap is 2.5 m wide for the trunk, and 11 m long: the path goes around it in the north.
    let stances = document["stances"].as_array().unwrap();
    let roots: Vec<Vec<f64>> = stances.iter().map(|stance| numbers(&stance["pose"]["root_m"])).collect();
    for pair in roots.windows(2) {
        for step in 0..=400 {
            let share = f64::from(step) / 400.0;
            let at = [pair[0][0] + share * (pair[1][0] - pair[0][0]), pair[0][1] + share * (pair[1][1] - pair[0][1])];
            assert!(triangles.at(at.into(), triangles.nominal()).is_some(), "{pair:?} flies over the gap at {at:?}");
        }
    }
    assert!(roots.iter().any(|root| root[1] > 10.5), "{roots:?}");
    assert!(desk.read("route.svg").contains("Route of a robot with legs"));
    let text = desk.run(&["plan", "plan.toml", "--quiet"]).stdout;
    assert!(text.contains("facets between the posts of a DEM, 0.5 m apart; 88 posts without elevation are no ground"), "{text}");
    // The same for any number of threads.
    let one = desk.json(&["plan", "plan.toml", "--threads", "1"]);
    assert_eq!(one["path"], document["path"]);
    let tried = desk.json(&["simulate", "plan.toml", "--quiet"]);
    let ended: u64 = tried["simulation"]["outcomes"].as_array().unwrap().iter().map(|row| row["trials"].as_u64().unwrap()).sum();
    assert_eq!(ended, 30, "{}", tried["simulation"]);
    let exact = ["takeoff_speed_sigma_fraction=0", "takeoff_angle_sigma_deg=0"].map(|key| format!("uncertainty.{key}"));
    let plain = desk.json(&["simulate", "plan.toml", "--set", &exact[0], "--set", &exact[1], "--trials", "5", "--quiet"]);
    assert_eq!(plain["simulation"]["success_rate"], 1.0, "{}", plain["simulation"]);
}

#[test]
fn zones_layers_and_friction_of_the_map_count_where_feet_stand() {
    let (desk, _) = desk(false);
    // Columns of the raster from x = 6.75 m on to 8.25 m are kept out, or out of the sun.
    let strip = |inside: &str, outside: &str| {
        let row: Vec<&str> = (0..40).map(|col| if (14..=16).contains(&col) { inside } else { outside }).collect();
        let rows = format!("{}\n", row.join(" ")).repeat(30);
        format!("ncols 40\nnrows 30\nxllcenter 0\nyllcenter 0\ncellsize 0.5\nNODATA_value -9999\n{rows}")
    };
    desk.write("mask.asc", strip("1", "0"));
    desk.write("sun.asc", strip("0", "1"));
    desk.write("slippery.asc", strip("0.2", "0.7"));
    let is_in = |foot: &[f64]| (6.75..=8.25).contains(&foot[0]);
    let plain = desk.json(&["plan", "plan.toml"]);
    assert_eq!(plain["verdict"], "traversable");
    for key in ["surface.keep_out=mask.asc", "layer.sun={ raster = \"sun.asc\", min = 0.5, applies_to = [\"contact\"] }"] {
        let document = desk.json(&["plan", "plan.toml", "--set", key]);
        assert_eq!(document["verdict"], "traversable", "{key}: {}", document["gap"]);
        assert!(feet(&document).iter().all(|foot| !is_in(foot)), "{key}");
        let stance = desk.json(&["stance", "ground.asc", "--at", "7.5,5", "--scenario", "plan.toml", "--set", key]);
        assert_eq!(stance["stands"], false, "{key}");
        assert!(stance["refusal"].as_str().unwrap().contains("kept out"), "{stance}");
    }
    // A flight that asks for the sun does not cross the strip.
    let flight = "layer.sun={ raster = \"sun.asc\", min = 0.5, applies_to = [\"contact\", \"flight\"] }";
    let shaded = desk.json(&["plan", "plan.toml", "--set", flight]);
    assert_eq!(shaded["verdict"], "no-path-found");
    let refusals = shaded["gap"]["refusals"].to_string();
    assert!(refusals.contains("layer"), "{refusals}");
    let slippery = desk.json(&["plan", "plan.toml", "--set", "surface.friction_raster=slippery.asc"]);
    let stances = slippery["stances"].as_array().unwrap();
    for foot in stances.iter().flat_map(|stance| stance["contacts"].as_array().unwrap()).filter(|foot| foot["outcome"] == "stands")
    {
        let expected = if is_in(&numbers(&foot["position_m"])) { 0.2 } else { 0.7 };
        assert!((foot["friction_coefficient"].as_f64().unwrap() - expected).abs() < 1e-6, "{foot}");
    }
}

#[test]
fn maps_of_stances_count_what_stances_and_plans_find() {
    let (desk, dem) = desk(true);
    let map = [
        "map",
        "plan.toml",
        "--stride",
        "2",
        "--set",
        "robot.headings=4",
        "-o",
        "hops.tif",
        "--mobility",
        "stances.tif",
        "--plot",
        "map.svg",
    ];
    let document = desk.json(&map);
    let nodes = 20 * 15;
    assert_eq!(document["nodes"].as_u64().unwrap() + document["no_data_nodes"].as_u64().unwrap(), nodes);
    let hops = raster(&desk.path().join("hops.tif"));
    let histogram = numbers(&document["reach"]["hops_histogram"]);
    let mut counted = vec![0.0; histogram.len()];
    for hops in hops.elevations().flatten().filter(|hops| *hops >= 0.0) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of hops")]
        let hops = hops as usize;
        counted[hops] += 1.0;
    }
    assert_eq!(counted, histogram);
    // No more nodes without ground than the DEM has, and the path to the goal has been flown again.
    let gaps = (0..15)
        .flat_map(|row| (0..20).map(move |col| (row, col)))
        .filter(|(row, col)| dem.elevation(2 * row, 2 * col).is_none())
        .count();
    assert_eq!(hops.elevations().filter(Option::is_none).count(), gaps);
    let goal = &document["goals"][0];
    assert!(goal["hops"].as_u64().unwrap() >= 2 && goal["verified"] == true, "{goal}");
    // Every node has its count of legs, and no limb finds ground at fewer nodes than all of them together.
    let by_legs = numbers(&document["nodes_by_legs"]);
    assert_eq!(by_legs.iter().sum::<f64>(), document["nodes"].as_f64().unwrap());
    let by_limb = document["nodes_by_limb"].as_array().unwrap();
    assert!(by_limb.len() == 4 && by_limb.iter().all(|row| row["nodes"].as_f64().unwrap() >= by_legs[4]), "{document}");
    let bands = std::fs::read(desk.path().join("stances.tif")).unwrap();
    let names = String::from_utf8_lossy(&bands).into_owned();
    for name in ["most legs that find ground", "widest beam", "share of 36 directions", "share of the headings"] {
        assert!(names.contains(name), "{name}");
    }
    // The same bytes for any number of threads.
    let (before, one) =
        (std::fs::read(desk.path().join("hops.tif")).unwrap(), desk.json(&[&map[..], &["--threads", "1"]].concat()));
    assert_eq!(one["reach"], document["reach"]);
    assert_eq!(std::fs::read(desk.path().join("hops.tif")).unwrap(), before);
    assert!(desk.read("map.svg").contains("most legs that find ground"));
    // Stances alone need no start, and a map without hops says nothing of them.
    desk.write("bare.toml", scenario("").split("[terrain]").next().unwrap());
    let alone = desk.json(&["map", "ground.asc", "--scenario", "bare.toml", "--stride", "4", "--mobility", "alone.tif"]);
    assert!(alone.get("reach").is_none() && alone["headings"] == 8, "{alone}");
    let size = desk.json(&[&map[..4], &["--dry-run"]].concat());
    assert_eq!((size["nodes"].as_u64(), size["posts"].as_u64()), (Some(nodes), Some(1200)));
}

#[test]
fn what_a_raster_does_not_give_legs_is_refused() {
    let (desk, _) = desk(true);
    let with = |key: &str| ["plan".to_owned(), "plan.toml".to_owned(), "--set".to_owned(), key.to_owned()];
    for (key, parts) in [
        ("terrain.start_m=[9,4]", &["the start at (9, 4) m has no elevation", "no-data is no ground"][..]),
        ("terrain.goal_m=[90,4]", &["the goal at (90, 4) m is off the map"]),
        ("terrain.route=transect", &["robot.file is", "need terrain.route = \"free\""]),
        ("search.bounds_m=[[0,0,-9],[3,14,9]]", &["expected it within search.bounds_m"]),
    ] {
        let words = with(key);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        desk.refused(&words, parts);
    }
    desk.refused(&["plan", "plan.toml", "--dry-run"], &["--dry-run: found this option", "robot with legs"]);
    desk.refused(&["map", "plan.toml", "--return"], &["--return: found this option", "robot with legs"]);
    desk.refused(&["map", "plan.toml", "--memory-max-mib", "1"], &["needs", "MiB"]);
    desk.refused(&["check", "plan.toml"], &["robot.file is", "answers for a point alone"]);
    desk.write("point.toml", "[robot]\nname = \"point\"\n[[limb]]\nname = \"foot\"\nhip_m = [0, 0, 0]\nshell = { radius_max_m = 0, half_angle_deg = 90 }\n");
    let point = [
        "map",
        "plan.toml",
        "--set",
        "robot.file=point.toml",
        "--set",
        "hopper.takeoff_speed_max_m_s=3",
        "--set",
        "hopper.landing_speed_max_m_s=3",
    ];
    desk.refused(&point, &["the robot is a point without a trunk"]);
}

#[test]
fn wider_cones_are_never_worse_over_the_same_poses() {
    let (desk, _) = desk(false);
    let words = [
        "trade",
        "plan.toml",
        "--set",
        "search.contacts_max=80",
        "--vary",
        "robot.cone=kc,kc-plus,pyramid-4,pyramid-8,pyramid-16,exact",
    ];
    let document = desk.json(&words);
    let rows = document["rows"].as_array().unwrap();
    let row = |cone: &str| rows.iter().find(|row| row["cone"] == cone).unwrap();
    for [narrow, wide] in
        [["kc", "kc-plus"], ["kc-plus", "exact"], ["pyramid-4", "pyramid-8"], ["pyramid-8", "pyramid-16"], ["pyramid-16", "exact"]]
    {
        for key in ["stances", "beam_mean_deg", "directions_mean", "joined_pairs"] {
            let [less, more] = [narrow, wide].map(|cone| row(cone)[key].as_f64().unwrap());
            assert!(less <= more * (1.0 + 1e-12), "{key}: {narrow} {less}, {wide} {more}");
        }
        if let (Some(more), Some(less)) = (row(narrow)["hops"].as_u64(), row(wide)["hops"].as_u64()) {
            assert!(less <= more, "{narrow} {more} hops, {wide} {less}");
        }
    }
    let [kc, exact] = ["kc", "exact"].map(|cone| row(cone)["joined_pairs"].as_u64().unwrap());
    assert!(kc < exact, "feet on a rolling ground have different normals: {kc} {exact}");
    // Limb sets: without one of its legs it has fewer feet, and stands with those that it needs.
    let all = light();
    let blocks: Vec<&str> = all.split("[[limb]]").collect();
    desk.write("three.toml", blocks[..4].join("[[limb]]").replace("four legs", "three legs"));
    let limbs = desk.json(&[
        "trade",
        "plan.toml",
        "--set",
        "search.contacts_max=60",
        "--vary",
        "robot.file=legs.toml,three.toml",
        "-o",
        "rows.csv",
    ]);
    let rows = limbs["rows"].as_array().unwrap();
    assert_eq!(rows.iter().map(|row| row["limbs"].as_u64().unwrap()).collect::<Vec<_>>(), [4, 3]);
    assert!(rows[0]["beam_mean_deg"].as_f64() > rows[1]["beam_mean_deg"].as_f64(), "{limbs}");
    assert_eq!(desk.read("rows.csv").lines().count(), 3);
    for (vary, parts) in [
        ("robot.cone=cone", ["found the cone `cone`", "expected one of"]),
        ("hopper.takeoff_speed_max_m_s=1:2:3", ["expected robot.cone=", "robot.file=FILE"]),
    ] {
        desk.refused(&["trade", "plan.toml", "--vary", vary], &parts);
    }
}

#[test]
fn results_of_legs_are_flown_again_as_they_stand() {
    let (desk, _) = desk(true);
    let document = desk.json(&["plan", "plan.toml", "--quiet"]);
    let check = |document: &Value| {
        desk.write("result.json", document.to_string());
        let ran = desk.run(&["check", "result.json", "--format", "json", "--quiet"]);
        (ran.status, serde_json::from_str::<Value>(&ran.stdout).unwrap_or_else(|_| panic!("{ran:?}")))
    };
    let (status, sound) = check(&document);
    assert_eq!((status, &sound["holds"], &sound["violations"]), (0, &true.into(), &Value::Array(Vec::new())), "{sound}");
    let spoiled = |spoil: &dyn Fn(&mut Value), limits: &[&str]| {
        let mut document = document.clone();
        spoil(&mut document);
        let (status, answer) = check(&document);
        let found = answer["violations"].as_array().unwrap();
        assert!(status == 1 && found.iter().any(|one| limits.contains(&one["limit"].as_str().unwrap())), "{limits:?} {answer}");
    };
    spoiled(&|result| result["path"][1]["takeoff_speed_m_s"] = 9.0.into(), &["takeoff-speed"]);
    spoiled(&|result| result["path"][1]["takeoff_angle_deg"] = 5.0.into(), &["direction", "landing-point"]);
    spoiled(&|result| result["stances"][1]["pose"]["root_m"][2] = 9.0.into(), &["stance"]);
    spoiled(&|result| result["stances"][0]["pose"]["root_m"] = serde_json::json!([2, 12, 0.3]), &["stance"]);
}

#[test]
fn what_makes_no_stance_is_named() {
    let (desk, _) = desk(false);
    let plan = |key: &str, parts: &[&str]| desk.refused(&["plan", "plan.toml", "--set", key], parts);
    plan("surface.friction_coefficient=0", &["found surface.friction_coefficient of 0", "expected a number above 0"]);
    // A limb that points up finds no ground anywhere.
    desk.write(
        "up.toml",
        light().replacen("axis = [0.1, 0.2, -1]", "axis = [0, 0, 1]", 1).replace("contacts_min = 3", "contacts_min = 4"),
    );
    plan(
        "robot.file=up.toml",
        &["cannot stand at the start", "3 of 4 feet stand, expected at least 4: front left reaches no ground"],
    );
    desk.refused(
        &["map", "plan.toml", "--stride", "5", "--set", "robot.file=up.toml"],
        &["terrain.start_m", "front left reaches no ground"],
    );
    desk.write("bare.toml", scenario("").split("[terrain]").next().unwrap().replace("legs.toml", "up.toml"));
    let map = desk.run(&["map", "ground.asc", "--scenario", "bare.toml", "--stride", "5", "--mobility", "up.tif"]);
    assert!(map.status == 0 && map.stderr.contains("front left finds ground at none of 48 nodes"), "{map:?}");
    assert!(map.stdout.contains("stands on 4 feet or more at 0 nodes"), "{map:?}");
    desk.write("none.toml", "[robot]\nname = \"none\"\n[[trunk]]\nsize_m = [0.1, 0.1, 0.1]\n");
    plan("robot.file=none.toml", &["none.toml:1:2", "limb is absent, expected at least one limb"]);
    desk.write("inside_out.toml", light().replace("size_m = [0.46, 0.2, 0.12]", "size_m = [-0.46, 0.2, 0.12]"));
    plan("robot.file=inside_out.toml", &["trunk box 1: size_m is [-0.46, 0.2, 0.12], expected three finite numbers above 0"]);
    // What a robot with legs does not do is refused with the scenario, not left out.
    plan("drive.travel=both", &["[drive] is given without drive.speed_m_s"]);
    let refused = |keys: &[&str], parts: &[&str]| {
        let words: Vec<&str> = ["plan", "plan.toml"].into_iter().chain(keys.iter().flat_map(|key| ["--set", key])).collect();
        desk.refused(&words, parts);
    };
    refused(
        &["drive.speed_m_s=0.1", "drive.slope_up_max_deg=20", "drive.turn_s_per_deg=1"],
        &[
            "robot.file names a robot with legs, which goes from stance to stance, beside drive.turn_s_per_deg",
            "remove drive.turn_s_per_deg",
        ],
    );
    refused(&["mission.targets_m=[[6, 6], [9, 9]]"], &["beside [mission], the targets of a hopper", "remove [mission]"]);
    desk.write("sun.asc", "ncols 2\nnrows 2\nxllcenter -1\nyllcenter -1\ncellsize 22\n1 1\n1 1\n");
    refused(
        &["layer.sun.raster=\"sun.asc\"", "layer.sun.min=1", "layer.sun.outage_hops_max=2"],
        &["beside layer.sun, which may be left for a while", "remove the keys of the outage"],
    );
    // Its search counts no costs: a plan of the least would be any plan, and a budget always kept.
    for cost in ["layer.sun.cost_per_contact=1", "layer.sun.cost_per_m=1"] {
        refused(&["layer.sun.raster=\"sun.asc\"", cost], &["beside layer.sun, which has a cost", "remove cost_per_contact"]);
    }
    // A mesh whose corners go round the other way: its outer side is below.
    desk.write("inverted.obj", "v -3 -3 0\nv 3 -3 0\nv 3 3 0\nv -3 3 0\nf 1 4 3\nf 1 3 2\n");
    let inverted = desk.run(&["stance", "inverted.obj", "--at=0,0,0.1", "--scenario", "plan.toml"]);
    assert!(inverted.status == 1 && inverted.stderr.contains("the facets at the place face down"), "{inverted:?}");
    // In the air each limb is named; inside a closed body the root is.
    let air = desk.run(&["stance", "ground.asc", "--at=4,4", "--height-m", "3", "--scenario", "plan.toml"]);
    assert!(air.status == 1 && air.stdout.contains("front left reaches no ground, front right reaches no ground"), "{air:?}");
    desk.write(
        "rock.obj",
        "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 0 0 9\nv 9 0 9\nv 9 9 9\nv 0 9 9\nf 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n\
         f 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n",
    );
    let rock = desk.run(&["stance", "rock.obj", "--at=4,4,9", "--height-m=-3", "--scenario", "plan.toml"]);
    assert!(rock.status == 1 && rock.stdout.contains("the root of the robot lies inside a closed body of the mesh"), "{rock:?}");
}

#[test]
fn a_robot_that_walks_and_hops_states_both_and_is_checked_again() {
    let (desk, dem) = desk(true);
    desk.write("walk.toml", scenario("[hopper]\npreparation_time_s = 20\n[drive]\nspeed_m_s = 0.4\nslope_up_max_deg = 25\n"));
    let document =
        desk.json(&["plan", "walk.toml", "--set", "search.contacts_max=60", "--plot", "walk.svg", "--geojson", "walk.geojson"]);
    assert_eq!((&document["verdict"], &document["verified"]), (&"traversable".into(), &true.into()), "{}", document["walk"]);
    let (walk, stances) = (&document["walk"], document["stances"].as_array().unwrap());
    let legs = walk["legs"].as_array().unwrap();
    assert_eq!(legs.len() + 1, stances.len(), "a move from each stance to the next");
    let walked: Vec<&Value> = legs.iter().filter(|leg| leg["kind"] == "drive").collect();
    assert!(!walked.is_empty(), "hops that take long to prepare are replaced by walks: {walk}");
    let number = |value: &Value| value.as_f64().unwrap();
    // Times add up to those of the mission, and to the objective of the search.
    let sum: f64 = legs.iter().map(|leg| number(&leg["time_s"])).sum();
    assert!((sum - number(&walk["totals"]["mission_time_s"])).abs() < 1e-9 * sum);
    assert_eq!(document["objective"][0], "mission-time");
    let triangles = Triangles::of(&dem);
    for (number_of, leg) in legs.iter().enumerate().filter(|(_, leg)| leg["kind"] == "drive") {
        let [from, to] = ["takeoff_m", "landing_m"].map(|key| numbers(&leg[key]));
        for (end, stance) in [(&from, number_of), (&to, number_of + 1)] {
            let root_m = numbers(&stances[stance]["pose"]["root_m"]);
            assert!((root_m[0] - end[0]).abs() + (root_m[1] - end[1]).abs() < 1e-9, "it walks under its roots");
        }
        // The same line in small steps: its length, its slopes, and no step over the gap.
        let at = |step: u32| {
            let share = f64::from(step) / 4_000.0;
            let place = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
            let (z_m, _) = triangles.at(place.into(), triangles.nominal()).expect("known ground");
            [place[0], place[1], z_m]
        };
        let mut length_m = 0.0;
        for step in 0..4_000 {
            let (a, b) = (at(step), at(step + 1));
            let run_m = (b[0] - a[0]).hypot(b[1] - a[1]);
            length_m += run_m.hypot(b[2] - a[2]);
            assert!((b[2] - a[2]) / run_m <= 25f64.to_radians().tan() + 1e-6);
        }
        assert!((length_m - number(&leg["length_m"])).abs() < 1e-4 * length_m.max(0.1), "{length_m} m, {leg}");
        assert!((number(&leg["time_s"]) - number(&leg["length_m"]) / 0.4).abs() < 1e-9 * number(&leg["time_s"]).max(1.0));
    }
    let geojson: Value = serde_json::from_str(&std::fs::read_to_string(desk.path().join("walk.geojson")).unwrap()).unwrap();
    let lines = geojson["features"].as_array().unwrap().iter().filter(|feature| feature["properties"]["kind"] == "drive").count();
    assert_eq!(lines, walked.len());
    assert!(std::fs::read_to_string(desk.path().join("walk.svg")).unwrap().contains("walked"));
    // By hops alone it takes longer, or as long, over the same stances.
    let hops = desk.json(&["plan", "walk.toml", "--set", "search.contacts_max=60", "--set", "drive.travel=hop"]);
    assert!(hops.get("walk").is_none());
    let by_walking = desk.run(&["plan", "walk.toml", "--set", "search.contacts_max=40", "--set", "drive.travel=drive"]);
    assert!(by_walking.stdout.contains("and 0 hops") || by_walking.status == 1, "{by_walking:?}");
    // Sums of nothing, of hops or of walks, are 0 and not -0.
    let short = ["plan", "walk.toml", "--set", "hopper.preparation_time_s=0", "--set", "search.contacts_max=60"];
    for words in [&["plan", "walk.toml", "--set", "search.contacts_max=40", "--set", "drive.travel=drive"][..], &short] {
        assert!(!desk.run(words).stdout.contains("-0.000"), "{words:?}");
        let document = desk.run(&[words, &["--format", "json"]].concat()).stdout;
        assert!(document.contains("\"totals\"") && !document.contains(" -0.0,") && !document.contains(" -0.0\n"), "{words:?}");
    }
    // What is not answered says so.
    desk.write("result.json", document.to_string());
    for (words, what) in [
        (&["map", "ground.asc", "--scenario", "walk.toml", "--mobility", "m.tif"][..], "maps"),
        (&["trade", "walk.toml", "--vary", "robot.cone=kc,exact"], "trades"),
        (&["check", "result.json"], "checks of results"),
        (&["report", "result.json", "-o", "page.html"], "pages"),
    ] {
        desk.refused(words, &["the robot walks, by [drive]", &format!("{what} of robots that walk are not made"), "drive.travel"]);
    }
    for file in ["m.tif", "page.html"] {
        assert!(!desk.path().join(file).exists(), "{file}");
    }
}

/// The share of trials that reached the goal, its 95 % interval, and how many ended in each other way.
fn trials(document: &Value) -> (f64, [f64; 2], Vec<(String, u64)>) {
    let record = &document["simulation"];
    let interval = numbers(&record["success_ci95"]);
    let outcomes = record["outcomes"].as_array().unwrap().iter();
    let outcomes = outcomes.map(|row| (row["outcome"].as_str().unwrap().to_owned(), row["trials"].as_u64().unwrap()));
    (record["success_rate"].as_f64().unwrap(), [interval[0], interval[1]], outcomes.collect())
}

#[test]
fn trials_of_a_robot_that_walks_have_the_errors_of_its_walks() {
    let (desk, _) = desk(false);
    let walks = "[drive]\nspeed_m_s = 0.4\nslope_up_max_deg = 25\ntravel = \"drive\"\n[uncertainty]\ngoal_tolerance_m = 0.5\n";
    desk.write("walk.toml", scenario(walks));
    let of = |file: &str, more: &[&str]| {
        let words = [&["simulate", file, "--set", "search.contacts_max=60"][..], more].concat();
        desk.json(&words)
    };
    // Without errors every trial is the plan, by either policy.
    for policy in ["open-loop", "replan"] {
        let document = of("walk.toml", &["--policy", policy, "--trials", "5"]);
        assert_eq!(trials(&document).0, 1.0, "{policy}: {}", document["simulation"]);
    }
    // A walk fails once in so many metres: e^(-length / distance) of the trials get through.
    let length_m = of("walk.toml", &["--trials", "1"])["walk"]["totals"]["drive_length_m"].as_f64().unwrap();
    let failing = of("walk.toml", &["--policy", "open-loop", "--trials", "1000", "--set", "drive.failure_per_m=0.05"]);
    let (_, [low, high], outcomes) = trials(&failing);
    let expected = (-0.05 * length_m).exp();
    assert!(low < expected && expected < high && high - low < 0.07, "{expected} of {length_m} m: {low} to {high}");
    assert!(outcomes.len() == 2 && outcomes[1].0 == "walk_failed", "{outcomes:?}");
    // Errors of walks are errors; without any, the trials say that they show nothing.
    let shows_nothing = |document: &Value| document["warnings"].to_string().contains("every trial is the plan itself");
    assert!(!shows_nothing(&failing) && shows_nothing(&of("walk.toml", &["--trials", "1"])));
    // Walks that are too long or too short by 5 % miss a goal within 0.1 m far away; a robot that replans goes on until it is there.
    let long = ["--trials", "60", "--set", "drive.length_sigma_fraction=0.05", "--set", "uncertainty.goal_tolerance_m=0.1"];
    let by = |policy: &str| trials(&of("walk.toml", &[&["--policy", policy][..], &long].concat()));
    let (missing, _, ways) = by("open-loop");
    assert!(missing < 0.6 && ways.iter().any(|(way, _)| way == "missed" || way == "fell"), "{missing} {ways:?}");
    let (replanned, _, ways) = by("replan");
    assert!(replanned > missing + 0.2, "{replanned} {missing}: {ways:?}");
    // The same for any number of threads, and in a mission that also hops.
    let both = scenario(&format!("[hopper]\npreparation_time_s = 20\n{}\n", walks.replace("travel = \"drive\"\n", "")));
    desk.write("both.toml", both.replace("contacts_max = 200", "contacts_max = 60"));
    let both = ["--trials", "40", "--set", "uncertainty.takeoff_speed_sigma_fraction=0.02", "--set", "drive.heading_sigma_deg=2"];
    let one = of("both.toml", &[&both[..], &["--threads", "1", "--compare"]].concat());
    let two = of("both.toml", &[&both[..], &["--threads", "2", "--compare"]].concat());
    assert_eq!(one["compare"], two["compare"]);
    let rates: Vec<f64> =
        one["compare"].as_array().unwrap().iter().map(|record| record["success_rate"].as_f64().unwrap()).collect();
    assert!(rates.len() == 2 && rates[1] >= rates[0], "{rates:?}");
    let stated = one["warnings"].to_string();
    assert!(stated.contains("at the end of a walk in the planned orientation"), "{stated}");
    // A result as a whole has both: its path and its trials.
    let ran = desk.run(&["run", "both.toml", "--output", "folder"]);
    assert!(ran.status <= 1 && ran.stdout.contains("stand at the goal"), "{ran:?}");
}
