//! Free routes over a mesh, as a user sees them.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::fmt::Write as _;

use serde_json::Value;

use crate::desk::Desk;

/// A room with a wall across it, and a window in the wall; start and goal on either side.
const SCENARIO: &str = "[body]\ngravity_m_s2 = 9.81\n[hopper]\ntakeoff_speed_max_m_s = 6\nlanding_speed_max_m_s = 6\n\
    [surface]\nfriction_coefficient = 1.0\n[terrain]\nmesh = \"room.obj\"\nroute = \"free\"\nstart_m = [1, 1, 0.2]\ngoal_m = [7, 3, 0.1]\n\
    [search]\ncontacts_max = 120\nobjective = [\"hops\", \"arc-length\"]\n";

fn quad(text: &mut String, corners: [[f64; 3]; 4]) {
    for [x, y, z] in corners {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    text.push_str("f -4 -3 -2 -1\n");
}

/// A floor and a ceiling of 8 m by 4 m, 3 m apart; a wall half-way, open from `low` to `high`; and a closed box on the floor.
pub(crate) fn room(low: f64, high: f64) -> Desk {
    let mut text = String::new();
    quad(&mut text, [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 4.0, 0.0], [0.0, 4.0, 0.0]]);
    quad(&mut text, [[0.0, 0.0, 3.0], [0.0, 4.0, 3.0], [8.0, 4.0, 3.0], [8.0, 0.0, 3.0]]);
    quad(&mut text, [[4.0, -9.0, -1.0], [4.0, 9.0, -1.0], [4.0, 9.0, low], [4.0, -9.0, low]]);
    quad(&mut text, [[4.0, -9.0, high], [4.0, 9.0, high], [4.0, 9.0, 4.0], [4.0, -9.0, 4.0]]);
    let [a, b, c, d] = [[5.0, 0.5], [6.0, 0.5], [6.0, 1.5], [5.0, 1.5]].map(|[x, y]| move |z: f64| [x, y, z]);
    quad(&mut text, [a(1.0), b(1.0), c(1.0), d(1.0)]);
    quad(&mut text, [a(-0.5), d(-0.5), c(-0.5), b(-0.5)]);
    quad(&mut text, [a(-0.5), b(-0.5), b(1.0), a(1.0)]);
    quad(&mut text, [b(-0.5), c(-0.5), c(1.0), b(1.0)]);
    quad(&mut text, [c(-0.5), d(-0.5), d(1.0), c(1.0)]);
    quad(&mut text, [d(-0.5), a(-0.5), a(1.0), d(1.0)]);
    let desk = Desk::with_dem();
    desk.write("room.obj", text);
    desk.write("room.toml", SCENARIO);
    desk
}

#[test]
fn a_path_goes_through_the_window_and_every_hop_stands_alone() {
    let desk = room(0.8, 1.2);
    let document = desk.json(&["plan", "room.toml"]);
    assert_eq!((&document["schema"], &document["verdict"]), (&"chta/plan-mesh/1".into(), &"traversable".into()));
    assert_eq!(document["verified"], true);
    let (path, hops) = (document["path"].as_array().unwrap(), document["hops"].as_u64().unwrap());
    assert_eq!(path.len() as u64, hops);
    assert!(document["hops_lower_bound"].as_u64().unwrap() <= hops);
    assert!((document["start"]["moved_m"].as_f64().unwrap() - 0.2).abs() < 1e-12);
    let mut through = 0;
    let mut length_m = 0.0;
    for hop in path {
        let number = |key: &str| hop[key].as_f64().unwrap();
        let place = |end: &str| {
            format!("{},{},{}", hop[format!("{end}_map_x_m")], hop[format!("{end}_map_y_m")], hop[format!("{end}_z_m")])
        };
        let alone = desk.json(&["hop", "room.toml", "--from", &place("takeoff"), "--to", &place("landing")]);
        assert_eq!(alone["feasible"], true, "{hop}");
        let angle = number("takeoff_angle_deg");
        let inside = alone["windows"].as_array().unwrap().iter().any(|window| {
            let [low, high] = ["takeoff_angle_min_deg", "takeoff_angle_max_deg"].map(|key| window[key].as_f64().unwrap());
            low - 1e-7 <= angle && angle <= high + 1e-7
        });
        assert!(inside, "{angle} deg of {}", alone["windows"]);
        assert!((number("heading_deg") - alone["heading_deg"].as_f64().unwrap()).abs() < 1e-9);
        let (from, to) = (number("takeoff_map_x_m"), number("landing_map_x_m"));
        if (from < 4.0) != (to < 4.0) {
            through += 1;
            // The height over the wall, from the stated command alone.
            let run = number("landing_x_m") - number("takeoff_x_m");
            let d = run * (4.0 - from) / (to - from);
            let (sine, cosine) = angle.to_radians().sin_cos();
            let time = d / (number("takeoff_speed_m_s") * cosine);
            let height = number("takeoff_z_m") + number("takeoff_speed_m_s") * sine * time - 0.5 * 9.81 * time * time;
            assert!((0.8 - 1e-9..=1.2 + 1e-9).contains(&height), "{height} m at the wall");
        }
        for (margin, value) in hop["margins"].as_object().unwrap() {
            assert!(value.as_f64().is_none_or(|value| value > -1e-6), "{margin}: {value}");
        }
        length_m += number("landing_x_m") - number("takeoff_x_m");
    }
    assert_eq!(through, 1);
    assert!((document["totals"]["ground_distance_m"].as_f64().unwrap() - length_m).abs() < 1e-9);
    let roadmap = &document["roadmap"];
    assert!(roadmap["contacts"].as_u64().unwrap() <= 120 && roadmap["left_out_buried"].as_u64().unwrap() > 0, "{roadmap}");
    let history = roadmap["history"].as_array().unwrap();
    assert_eq!(history.last().unwrap()["hops"], hops);
    // The front has the path of the plan, and more hops for less.
    let fronts = desk.json(&["plan", "room.toml", "--front", "hops,arc-length"]);
    let front = fronts["front"].as_array().unwrap();
    assert!(front[0]["planned"] == true && front[0]["hops"] == hops && fronts["front_amount"] == "arc-length", "{front:?}");
    for pair in front.windows(2) {
        let [fewer, more] = [0, 1].map(|i| (pair[i]["hops"].as_u64().unwrap(), pair[i]["arc_length_m"].as_f64().unwrap()));
        assert!(fewer.0 < more.0 && fewer.1 > more.1, "{front:?}");
    }
    // The same bytes for one thread and two, and a result repeats itself.
    let with = |threads: &str| desk.run(&["plan", "room.toml", "--format", "json", "--threads", threads]).stdout;
    let once = with("1");
    assert!(once == with("2"));
    desk.write("result.json", &once);
    assert!(desk.run(&["plan", "result.json", "--format", "json"]).stdout == once);
    let text = desk.run(&["plan", "room.toml", "-o", "path.csv"]).stdout;
    for part in ["over these contacts", "verified: every hop was flown again", "roadmap:", "moved 0.200000 m", "heading"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(desk.read("path.csv").lines().count(), 1 + path.len());
}

/// Trials over the mesh: without errors all arrive; with errors the rate is that of the outcomes, a floor of success ends with status 1, and
/// what is of profiles alone is refused.
#[test]
fn trials_fly_the_path_over_the_mesh() {
    let desk = room(0.8, 1.2);
    let errors = ["--set", "uncertainty.takeoff_speed_sigma_fraction=0.02", "--set", "uncertainty.goal_tolerance_m=0.5"];
    let exact = ["simulate", "room.toml", "--trials", "200", "--set", "uncertainty.goal_tolerance_m=0.01"];
    let number = |document: &Value, key: &str| document[key].as_f64().unwrap();
    let document = desk.json(&exact);
    assert_eq!((&document["schema"], &document["verdict"]), (&"chta/simulate-mesh/1".into(), &"traversable".into()));
    assert_eq!(number(&document, "success_rate"), 1.0, "without errors");
    let args = [&["simulate", "room.toml", "--trials", "400", "--seed", "5", "--compare"][..], &errors].concat();
    let document = desk.json(&args);
    let both = document["compare"].as_array().unwrap();
    assert_eq!(both.len(), 2);
    for of_policy in both {
        let outcomes = of_policy["outcomes"].as_object().unwrap();
        assert_eq!(outcomes.values().map(|count| count.as_u64().unwrap()).sum::<u64>(), 400, "{outcomes:?}");
        let rate = number(of_policy, "success_rate");
        assert!((rate - outcomes["reached"].as_f64().unwrap() / 400.0).abs() < 1e-12 && rate < 1.0, "{outcomes:?}");
    }
    // Ranges of trials are tallied as over other ground.
    let ranged =
        [&["simulate", "room.toml", "--trials", "100", "--first-trial", "100", "--tally", "tally.json"][..], &errors].concat();
    assert_eq!((desk.json(&ranged)["first_trial"].as_u64(), desk.read("tally.json").is_empty()), (Some(100), false));
    assert_eq!(document["path"], desk.json(&[&["plan", "room.toml"][..], &errors].concat())["path"]);
    let floor = desk.run(&[&args[..6], &errors, &["--success-min", "0.999"]].concat());
    assert!(floor.status == 1 && floor.stdout.contains("is not shown"), "{floor:?}");
    desk.run(&[&["simulate", "room.toml", "--trials", "50", "--plot", "trials.svg"][..], &errors].concat());
    assert!(desk.read("trials-2.svg").contains("How the trials ended"));
    desk.refused(
        &["simulate", "room.toml", "--plot-map", "trials.svg"],
        &["--plot-map", "this terrain is a mesh", "leave the option out"],
    );
    desk.refused(
        &[&["simulate", "room.toml", "--set", "hopper.radius_m=0.01"][..], &errors].concat(),
        &["hopper.radius_m", "set hopper.radius_m = 0"],
    );
    let point = [&["simulate", "room.toml", "--trials", "10", "--set", "hopper.radius_m=0"][..], &errors].concat();
    assert!(desk.run(&point).status < 2, "the mending line");
}

#[test]
fn without_a_window_the_answer_is_no_and_says_what_refuses() {
    let desk = room(1.0, 1.0);
    let ran = desk.run(&["plan", "room.toml"]);
    assert_eq!(ran.status, 1, "{ran:?}");
    for part in
        ["no-path-found", "this does not prove that no path exists", "the gap is", "terrain", "the goal can be reached from"]
    {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
    let document: Value = serde_json::from_str(&desk.run(&["plan", "room.toml", "--format", "json"]).stdout).unwrap();
    let gap = &document["gap"];
    assert!(gap["refusals"]["terrain"].as_u64().unwrap() > 0, "{gap}");
    assert!(gap["nearest_m"][0].as_f64().unwrap() <= 4.0 && gap["leads_to_goal_from_m"][0].as_f64().unwrap() >= 4.0, "{gap}");
    // A budget that no path keeps is a no as well.
    let desk = room(0.8, 1.2);
    let ran = desk.run(&["plan", "room.toml", "--set", "budget.hops_max=1"]);
    assert!(ran.status == 1 && ran.stdout.contains("not within its budget"), "{ran:?}");
}

#[test]
fn what_has_no_meaning_on_a_mesh_is_refused_by_name() {
    let desk = room(0.8, 1.2);
    let rows: [(&[&str], &str); 15] = [
        (&["--set", "terrain.start_m=[5.5, 1, 0.5]"], "inside a closed body"),
        (&["--set", "search.bounds_m=[[50, 0, 0], [60, 1, 1]]"], "expected it within search.bounds_m"),
        (&["--set", "search.bounds_m=[[1, 0, 0], [0, 1, 1]]"], "search.bounds_m is"),
        (&["--set", "search.stand_off_m=5"], "cannot stand off"),
        (&["--set", "search.contacts_max=1"], "expected a whole number from 2"),
        (&["--set", "terrain.start_m=[1, 1]"], "has two numbers, expected three"),
        (&["--start", "1,1"], "has two numbers, expected three"),
        (&["--start", "3"], "terrain.start_x_m"),
        (&["--set", "search.node_spacing_max_m=1"], "search.node_spacing_max_m"),
        (&["--set", "hopper.footprint_m=0.3"], "hopper.footprint_m"),
        (&["--set", "surface.keep_out=zones.geojson"], "keep_out"),
        (&["--set", "search.objective=[\"risk\"]"], "risk"),
        (&["--set", "terrain.route=transect"], "has three numbers, expected two"),
        (&["--front", "hops,risk"], "risk"),
        (&["--prove"], "--prove"),
    ];
    for (options, part) in rows {
        let ran = desk.run(&[&["plan", "room.toml"][..], options].concat());
        assert!(ran.status == 2 && ran.stderr.contains(part) && ran.stdout.is_empty(), "{options:?}: {ran:?}");
    }
    for words in [&["check", "room.toml"][..], &["require", "room.toml", "--vary", "hopper.takeoff_speed_max_m_s"]] {
        let ran = desk.run(words);
        assert!(ran.status == 2 && ran.stderr.contains("where plans, runs, trials, maps, comparisons"), "{words:?}: {ran:?}");
    }
    let ran = desk.run(&["plan", "chain.csv", "--set", "search.contacts_max=9", "--body", "moon"]);
    assert!(ran.status == 2 && ran.stderr.contains("search.contacts_max is for free routes over a mesh"), "{ran:?}");
    // A point far away is moved to the mesh, and that is more than a line of the answer.
    let ran = desk.run(&["plan", "room.toml", "--start", "1,1,-40"]);
    assert!(ran.status == 1 && ran.stderr.contains("the start was moved 39.1152"), "{ran:?}");
    // The keys of the search have their effect on trials too.
    let ran = desk.run(&["simulate", "room.toml", "--trials", "10", "--set", "search.contacts_max=90"]);
    assert!(ran.status == 0 && !ran.stderr.contains("has no effect"), "{ran:?}");
    // The command line gives positions in space, and a start on the goal needs no hop.
    let ran = desk.run(&["plan", "room.toml", "--start", "7,3,0.3", "--goal", "7,3,0"]);
    assert!(ran.status == 0 && ran.stdout.contains("traversable, 0 hops"), "{ran:?}");
}

/// A roadmap is written once and asked often: the same journey finds the same path over it, another one its own, and files that are no roadmap
/// of this mesh are refused.
#[test]
fn a_roadmap_is_read_back_for_other_ends() {
    let desk = room(0.8, 1.2);
    let built = desk.json(&["plan", "room.toml", "--roadmap-output", "roadmap.json"]);
    let again = desk.json(&["plan", "room.toml", "--roadmap", "roadmap.json"]);
    assert_eq!((&again["roadmap"]["ended_by"], &again["verified"]), (&"given".into(), &true.into()));
    assert_eq!(again["roadmap"]["contacts"].as_u64(), built["roadmap"]["contacts"].as_u64().map(|contacts| contacts + 2));
    assert_eq!((&again["hops"], &again["totals"]), (&built["hops"], &built["totals"]));
    let back = ["--start", "7,3,0.1", "--goal", "1,1,0.2"];
    let other = desk.json(&[&["plan", "room.toml", "--roadmap", "roadmap.json", "--quiet"][..], &back].concat());
    assert!(other["hops"].as_u64() > Some(0) && other["verified"] == true, "{}", other["hops"]);
    let text = desk.run(&["plan", "room.toml", "--roadmap", "roadmap.json"]);
    assert!(text.stdout.contains("start and goal added to those read"), "{}", text.stdout);
    assert!(text.stderr.contains("search.contacts_max: without effect"), "{}", text.stderr);
    assert!(text.stderr.contains("does not hold the roadmap that was read"), "{}", text.stderr);
    let refused = |args: &[&str], parts: &[&str]| {
        desk.refused(&[&["plan", "room.toml", "--quiet", "--roadmap"][..], args].concat(), parts);
    };
    refused(&["absent.json"], &["absent.json", "cannot open the roadmap", "expected a readable JSON file"]);
    refused(&["room.obj"], &["room.obj", "this is no roadmap", "expected the JSON file of a plan over this mesh"]);
    let faster = ["roadmap.json", "--set", "hopper.takeoff_speed_max_m_s=7"];
    refused(&faster, &["roadmap.json", "built for another mesh, hopper, gravity or surface", "build it again"]);
    // A file cut short, and one whose windows let arcs through the wall.
    let written = desk.read("roadmap.json");
    desk.write("cut.json", &written[..written.len() / 2]);
    refused(&["cut.json"], &["cut.json", "this is no roadmap", "expected the JSON file of a plan over this mesh"]);
    let mut spoiled: Value = serde_json::from_str(&written).unwrap();
    for window in spoiled["windows"].as_array_mut().unwrap() {
        (window[2], window[3]) = (0.001.into(), 0.002.into());
    }
    desk.write("spoiled.json", spoiled.to_string());
    refused(&["spoiled.json"], &["spoiled.json", "a hop of this roadmap is not feasible over the mesh", "build it again"]);
    desk.write("chain.csv", "x_m,z_m\n0,0\n10,0\n");
    for option in ["--roadmap", "--roadmap-output"] {
        let on_chain =
            ["plan", "chain.csv", "--set", "body.name=moon", "--set", "hopper.takeoff_speed_max_m_s=3", option, "x.json"];
        desk.refused(&on_chain, &[option, "for free routes over a mesh", "leave the option out"]);
    }
    assert!(!desk.path().join("x.json").exists());
}

const PRM: [&str; 6] = ["plan", "room.toml", "--set", "search.planner=prm", "--set", "search.objective=[\"arc-length\"]"];

#[test]
fn the_planner_of_the_paper_says_so_and_its_path_is_flown_again() {
    let desk = room(0.8, 1.2);
    let words = [&PRM[..], &["--set", "search.contacts_max=3000"]].concat();
    let document = desk.json(&words);
    let roadmap = &document["roadmap"];
    assert_eq!((&document["verdict"], &document["verified"]), (&"traversable".into(), &true.into()));
    assert_eq!((&roadmap["planner"], &roadmap["ended_by"]), (&"prm".into(), &"joined".into()));
    let count = |key: &str| roadmap["sampled_hops"][key].as_u64().unwrap();
    let (tried, first, refused) = (count("tried"), count("first_arcs_refused"), count("refused"));
    assert!(tried > first && first >= refused, "{roadmap}");
    // One greatest speed: every free hop is flown either way.
    assert_eq!(roadmap["windows"].as_u64().unwrap(), 2 * (tried - refused - count("grazes")));
    let ran = desk.run(&words);
    let all = format!("{}{}", ran.stdout, ran.stderr);
    for part in ["planner: prm, the method of Campana and Laumond", "refused by collision", "misses no hop between its contacts"] {
        assert!(all.contains(part), "{part}: {all}");
    }
    let exact = desk.json(&["plan", "room.toml"]);
    assert!(exact["roadmap"]["planner"] == "exact" && exact["roadmap"].get("sampled_hops").is_none());
    // A slot narrower than the ball: no angle passes, and the answer says that there are hops all the same.
    let desk = room(1.0, 1.03);
    let solved = desk.json(&["plan", "room.toml", "--set", "search.contacts_max=400"]);
    assert_eq!(solved["verdict"], "traversable");
    let words = [&PRM[..], &["--set", "search.contacts_max=150"]].concat();
    let ran = desk.run(&words);
    assert!(ran.status == 1 && ran.stdout.contains("missed by the sampled angles"), "{ran:?}");
    let missed: Value = serde_json::from_str(&desk.run(&[&words[..], &["--format", "json"]].concat()).stdout).unwrap();
    assert!(missed["gap"]["missed_by_sampling"].as_u64().unwrap() > 0);
    let sampled = &missed["roadmap"]["sampled_hops"];
    assert!(sampled["refused"].as_u64().unwrap() > 0 && sampled["tried"].as_u64() > sampled["refused"].as_u64(), "{sampled}");
}

#[test]
fn what_the_planner_of_the_paper_does_not_obey_is_refused_by_name() {
    let desk = room(0.8, 1.2);
    let rows: [(&[&str], &str); 9] = [
        (&["--set", "search.objective=[\"hops\"]"], "search.objective is another than [\"arc-length\"]"),
        (&["--set", "search.takeoff_angle=least-time"], "search.takeoff_angle chooses the angle"),
        (&["--set", "budget.hops_max=9"], "budget.hops_max limits the search"),
        (&["--set", "hopper.radius_m=0.05"], "hopper.radius_m is the ball that flies"),
        (&["--set", "hopper.clearance_m=0.05"], "hopper.clearance_m is kept by exact windows"),
        (&["--set", "hopper.takeoff_speed_levels_m_s=[2, 4]"], "hopper.takeoff_speed_levels_m_s leaves several intervals"),
        (&["--set", "search.stand_off_m=0.02"], "expected more than 0.02 m, the radius of the ball"),
        (&["--set", "search.planner=rrt"], "search.planner"),
        (&["--front", "hops,energy"], "expected planner = \"exact\" for a front"),
    ];
    for (options, part) in rows {
        let ran = desk.run(&[&PRM[..], options].concat());
        assert!(ran.status == 2 && ran.stderr.contains(part) && ran.stdout.is_empty(), "{options:?}: {ran:?}");
    }
}

/// Trials of a result fly its path: another one than its scenario plans, or another mesh, is refused, and planned anew only where that is asked for.
#[test]
fn trials_of_a_result_fly_its_path_or_refuse_it() {
    let desk = room(0.8, 1.2);
    let planned = desk.json(&["plan", "room.toml"]);
    desk.write("result.json", planned.to_string());
    let trials = ["--trials", "50", "--quiet", "--set", "uncertainty.goal_tolerance_m=0.1"];
    let flown = desk.json(&[&["simulate", "result.json"][..], &trials].concat());
    assert_eq!(flown["path"], planned["path"]);
    for (key, factor) in [("takeoff_speed_m_s", 1.05), ("takeoff_angle_deg", 1.01), ("landing_map_x_m", 1.001)] {
        let mut spoiled = planned.clone();
        let changed = spoiled["path"][0][key].as_f64().unwrap() * factor;
        spoiled["path"][0][key] = changed.into();
        desk.write("spoiled.json", spoiled.to_string());
        let args = [&["simulate", "spoiled.json"][..], &trials].concat();
        desk.refused(
            &args,
            &["spoiled.json", "is not the one that its scenario plans here", "--plan-anew plans its scenario anew"],
        );
        assert_eq!(desk.json(&[&args[..], &["--plan-anew"]].concat())["path"], planned["path"], "{key}");
    }
    let faster = [&["simulate", "result.json", "--set", "search.seed=5", "--set", "search.contacts_max=60"][..], &trials].concat();
    desk.refused(&faster, &["is not the one that its scenario plans here"]);
    desk.write("room.obj", format!("# another file\n{}", desk.read("room.obj")));
    desk.refused(&[&["simulate", "result.json"][..], &trials].concat(), &["result.json", "room.obj", "--plan-anew"]);
    desk.refused(&[&["simulate", "room.toml", "--plan-anew"][..], &trials].concat(), &["--plan-anew", "is no result", "omit it"]);
}
