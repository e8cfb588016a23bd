//! What is reached over a mesh, and runs, comparisons and checks of results over meshes, as a user sees them.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::{desk::Desk, mesh_plan::room};

/// The shipped scenarios over meshes, by their paths.
fn shipped(name: &str) -> String {
    format!("{}/data/mesh_scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// The rows of a table, each as cells by the names of their columns.
fn rows(text: &str) -> Vec<impl Fn(&str) -> String> {
    let mut lines = text.lines();
    let columns: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let row = |line: &str| {
        let cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let columns = columns.clone();
        move |name: &str| cells[columns.iter().position(|column| column == name).unwrap()].clone()
    };
    lines.map(row).collect()
}

fn count(document: &Value, key: &str) -> u64 {
    document[key].as_u64().unwrap_or_else(|| panic!("{key}: {}", document[key]))
}

#[test]
fn the_contacts_of_the_shipped_meshes_are_reached_hop_by_hop() {
    for name in ["cave", "overhang", "rubble"] {
        let (desk, scenario) = (Desk::new(), shipped(name));
        let few = ["--set", "search.contacts_max=500", "--format", "json", "--return", "-o", "contacts.csv"];
        let document: Value = {
            let ran = desk.run(&[&["map", &scenario], &few[..]].concat());
            assert_eq!(ran.status, 0, "{name}: {ran:?}");
            serde_json::from_str(&ran.stdout).unwrap()
        };
        assert_eq!(document["schema"], "chta/map-mesh/1");
        let (contacts, reached) = (count(&document["contacts"], "count"), count(&document, "reached_contacts"));
        assert_eq!(contacts, 500);
        let by_hops = document["by_hops"].as_array().unwrap();
        assert_eq!(by_hops.iter().map(|row| count(row, "contacts")).sum::<u64>(), reached);
        assert_eq!(count(&by_hops[0], "contacts"), 1, "the start alone takes no hop");
        let last = by_hops.last().unwrap();
        assert_eq!(count(last, "hops"), count(&document, "farthest_hops"));
        assert_eq!(last["area_share_within"], document["reached_area_share"]);
        for pair in by_hops.windows(2) {
            assert!(pair[0]["share_within"].as_f64() < pair[1]["share_within"].as_f64(), "{name}: {pair:?}");
        }
        let history = document["contacts"]["history"].as_array().unwrap();
        assert_eq!(history.iter().map(|round| count(round, "contacts")).collect::<Vec<_>>(), [256, 500]);

        let table = desk.read("contacts.csv");
        let table = rows(&table);
        assert_eq!(table.len() as u64, contacts);
        let hops = |row: &dyn Fn(&str) -> String| row("hops").parse::<u64>().ok();
        assert_eq!(table.iter().filter(|row| hops(row).is_some()).count() as u64, reached);
        let area_m2: f64 = table.iter().filter(|row| hops(row).is_some()).map(|row| row("area_m2").parse::<f64>().unwrap()).sum();
        assert!((area_m2 - document["reached_area_m2"].as_f64().unwrap()).abs() < 1e-9 * area_m2);
        assert_eq!(table[1]("hops").parse::<u64>().ok(), document["goal"]["hops"].as_u64());
        // Each contact is one hop from the one before it, by the test of single hops.
        let place = |row: &dyn Fn(&str) -> String| [row("x_m"), row("y_m"), row("z_m")].join(",");
        let mut alone = 0;
        for row in table.iter().filter(|row| !row("from_contact").is_empty()).step_by(23) {
            let from = &table[row("from_contact").parse::<usize>().unwrap() - 1];
            assert_eq!(hops(row), hops(from).map(|hops| hops + 1));
            let hop = desk.json(&["hop", &scenario, &format!("--from={}", place(from)), &format!("--to={}", place(row))]);
            assert_eq!(hop["feasible"], true, "{name}: {} to {}", place(from), place(row));
            alone += 1;
        }
        assert!(alone >= 3, "{name}: {alone}");
        // A goal is one hop away for a plan if and only if it is here: that pair is tested by both.
        let mut one = 0;
        for row in table.iter().skip(2).step_by(97) {
            let goal = place(row);
            let ran =
                desk.run(&["plan", &scenario, "--goal", &goal, "--set", "search.contacts_max=60", "--format", "json", "--quiet"]);
            assert!(ran.status < 2, "{name}: {ran:?}");
            let planned: Value = serde_json::from_str(&ran.stdout).unwrap();
            assert_eq!(planned["hops"].as_u64() == Some(1), hops(row) == Some(1), "{name}: {goal}");
            assert!(hops(row).is_none_or(|hops| count(&planned, "hops_lower_bound") <= hops), "{name}: {goal}");
            one += usize::from(hops(row) == Some(1));
        }
        assert!(one < 5, "{name}: not all goals are one hop away");
        let text = desk.run(&["map", &scenario, "--set", "search.contacts_max=500", "--quiet"]).stdout;
        for part in ["contacts reached from", "not reached over these contacts is not unreachable", "hold no landing", "within (%)"]
        {
            assert!(text.contains(part), "{name}: {part}: {text}");
        }
    }
}

#[test]
fn one_hop_leaves_the_others_open_and_threads_change_nothing() {
    let (desk, scenario) = (Desk::new(), shipped("rubble"));
    let base = ["map", &scenario, "--set", "search.contacts_max=300", "--format", "json", "--quiet"];
    let whole: Value = serde_json::from_str(&desk.run(&base).stdout).unwrap();
    let ran = desk.run(&[&base[..], &["--hops-max", "1", "--return"]].concat());
    assert_eq!(ran.status, 1, "the goal is farther than one hop");
    let one: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(one["by_hops"].as_array().unwrap()[..], whole["by_hops"].as_array().unwrap()[..2]);
    assert_eq!(count(&one, "not_searched_contacts"), 300 - count(&one, "reached_contacts"));
    assert_eq!((&one["goal"]["searched"], &one["goal"]["hops"]), (&false.into(), &Value::Null));
    assert_eq!((&whole["goal"]["searched"], whole.get("not_searched_contacts")), (&true.into(), None));
    assert!(count(&one["return"], "round_trip_contacts") > 1, "{}", one["return"]);
    let text = desk.run(&["map", &scenario, "--set", "search.contacts_max=300", "--hops-max", "1", "--quiet"]).stdout;
    for part in ["were not searched", "not within 1 hop, and not searched beyond"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let with = |threads: &str, seed: &str| {
        let more = ["--threads", threads, "--set", seed, "--plot", "map.svg", "-o", "-"];
        let ran = desk.run(&[&base[..4], &more, &["--quiet"]].concat());
        (ran.stdout, desk.read("map.svg"))
    };
    let (seed, other) = ("search.seed=3", "search.seed=4");
    assert!(with("1", seed) == with("2", seed));
    assert!(with("1", seed) != with("1", other));
    // The picture from elsewhere is another one; other terrain has none to turn.
    let plotted = |more: &[&str]| {
        desk.run(&[&base[..4], &["--quiet", "--plot", "seen.svg"], more].concat());
        desk.read("seen.svg")
    };
    let (usual, turned) = (plotted(&[]), plotted(&["--seen-from", "100,60"]));
    assert!(usual.contains("azimuth 215 deg") && turned.contains("azimuth 100 deg") && usual != turned);
    assert_eq!(usual, plotted(&["--seen-from", "215,35"]));
    for (words, part) in [("100", "expected azimuth"), ("100,95", "expected azimuth"), ("1,2,3", "expected azimuth")] {
        desk.refused(&[&base[..4], &["--plot", "no.svg", "--seen-from", words]].concat(), &[part]);
    }
}

#[test]
fn a_wall_without_a_window_ends_what_is_reached() {
    let of = |desk: &Desk| {
        let ran = desk.run(&["map", "room.toml", "--format", "json", "--quiet", "-o", "contacts.csv"]);
        let document: Value = serde_json::from_str(&ran.stdout).unwrap();
        let table = desk.read("contacts.csv");
        let beyond = rows(&table).iter().filter(|row| !row("hops").is_empty() && row("x_m").parse::<f64>().unwrap() > 4.01).count();
        (ran.status, document["goal"]["hops"].as_u64(), beyond)
    };
    let (open, shut) = (of(&room(0.8, 1.2)), of(&room(1.0, 1.0)));
    assert!(open.0 == 0 && open.1.is_some() && open.2 > 3, "{open:?}");
    assert_eq!(shut, (1, None, 0));
    // A start that is the goal is reached without a hop, and a goal no speed reaches has no bound.
    let desk = room(0.8, 1.2);
    let there = desk.json(&["map", "room.toml", "--set", "terrain.goal_m=[1, 1, 0.1]"]);
    assert_eq!((&there["goal"]["hops"], &there["goal"]["hops_lower_bound"]), (&0.into(), &0.into()));
}

#[test]
fn what_only_a_dem_answers_is_refused_by_name() {
    let desk = room(0.8, 1.2);
    let refused: [&[&str]; 21] = [
        &["--start", "1,1"],
        &["--start-lonlat", "1,1"],
        &["--starts", "chain.csv"],
        &["--goal", "1,1"],
        &["--goal-lonlat", "1,1"],
        &["--stride", "2"],
        &["--node-spacing-max-m", "0.5"],
        &["--effort", "energy"],
        &["--objective", "energy"],
        &["--effort-output", "a.tif", "--effort"],
        &["--amount-output", "energy=a.tif"],
        &["--return-output", "a.tif", "--return"],
        &["--nearest-output", "a.tif"],
        &["--predecessor-output", "a.tif"],
        &["--mobility", "a.tif"],
        &["--qml"],
        &["--simulate"],
        &["--paths", "a.csv"],
        &["--geojson", "a.geojson"],
        &["--profiles", "a.svg"],
        &["--dry-run"],
    ];
    for options in refused {
        // Of a table with an option of its own, either may be named.
        let name = if options[0] == "--effort-output" { "--effort" } else { options[0] };
        if options[0] == "--starts" {
            let ran = desk.run(&["map", "room.toml", "--starts", "chain.csv"]);
            assert!(ran.status == 2 && ran.stderr.contains("--starts"), "{ran:?}");
            continue;
        }
        desk.refused(&[&["map", "room.toml", "--quiet"], options].concat(), &[name, "this terrain is a mesh"]);
    }
    desk.refused(&["map", "room.toml", "--quiet", "--memory-max-mib", "9"], &["--memory-max-mib", "this terrain is a mesh"]);
    // What it counts is hops alone.
    let ran = desk.run(&["map", "room.toml"]);
    assert!(ran.stderr.contains("search.objective is not kept by this answer of chta map"), "{ran:?}");
    desk.refused(
        &["map", "map.toml", "--plot", "map.svg", "--seen-from", "1,1"],
        &["--seen-from", "turns the picture of a mesh", "leave the option out"],
    );
}

#[test]
fn a_run_is_flown_again_and_an_altered_result_fails_by_name() {
    let desk = room(0.8, 1.2);
    let errors = ["--set", "uncertainty.takeoff_speed_sigma_fraction=0.01", "--set", "uncertainty.goal_tolerance_m=0.5"];
    let trials = ["--set", "uncertainty.trials=100", "--quiet"];
    let ran = desk.run(&[&["run", "room.toml", "-o", "out"][..], &errors, &trials].concat());
    assert!(ran.status == 0 && ran.stdout.contains("of 100 trials reach the goal"), "{ran:?}");
    let line = "written to out: path.csv, result.json, path.svg, simulation.json, trials.svg";
    assert!(ran.stdout.contains(line), "{}", ran.stdout);
    let result: Value = serde_json::from_str(&desk.read("out/result.json")).unwrap();
    let trials: Value = serde_json::from_str(&desk.read("out/simulation.json")).unwrap();
    assert_eq!((&result["schema"], &trials["schema"]), (&"chta/run-mesh/1".into(), &"chta/simulate-mesh/1".into()));
    let planned = desk.json(&[&["plan", "room.toml"][..], &errors, &["--set", "uncertainty.trials=100"]].concat());
    assert!(result["path"] == planned["path"] && trials["path"] == planned["path"]);
    assert_eq!(desk.read("out/path.csv").lines().count(), 1 + result["path"].as_array().unwrap().len());
    // Without trials, those of the run before are gone.
    desk.run(&["run", "room.toml", "-o", "out", "--quiet"]);
    assert!(!desk.path().join("out/simulation.json").exists() && !desk.path().join("out/trials.svg").exists());
    desk.refused(&["run", "room.toml", "-o", "x", "--trajectory", "t.csv"], &["--trajectory", "this terrain is a mesh"]);

    let check = |document: &Value, more: &[&str]| {
        desk.write("altered.json", document.to_string());
        let ran = desk.run(&[&["check", "altered.json", "--format", "json", "--quiet"], more].concat());
        let answer: Value = serde_json::from_str(&ran.stdout).unwrap_or_default();
        let violations = answer["violations"].as_array().cloned().unwrap_or_default();
        let limits: Vec<(u64, String)> =
            violations.iter().map(|one| (count(one, "hop"), one["limit"].as_str().unwrap().to_owned())).collect();
        (ran, limits)
    };
    for document in [&result, &trials, &planned] {
        let (ran, limits) = check(document, &[]);
        assert!(ran.status == 0 && limits.is_empty(), "{ran:?}");
        assert!(ran.stdout.contains("\"holds\": true") && ran.stdout.contains("chta/check-mesh/1"));
    }
    let altered = |hop: usize, key: &str, by: f64| {
        let mut document = result.clone();
        let number = document["path"][hop][key].as_f64().unwrap();
        document["path"][hop][key] = (number + by).into();
        let (ran, limits) = check(&document, &[]);
        assert_eq!(ran.status, 1, "{key}: {ran:?}");
        let names: Vec<String> =
            limits.iter().filter(|(number, _)| *number == hop as u64 + 1).map(|(_, limit)| limit.clone()).collect();
        assert!(!names.is_empty(), "{key}: {limits:?}");
        names
    };
    let has = |names: &[String], name: &str| assert!(names.iter().any(|one| one == name), "no {name} in {names:?}");
    has(&altered(0, "takeoff_speed_m_s", 3.0), "takeoff-speed");
    has(&altered(0, "takeoff_speed_m_s", 0.02), "landing-point");
    // The shortest arc has the least angle that its lower limit allows.
    let binding = result["path"][0]["binding"].as_str().unwrap();
    has(&altered(0, "takeoff_angle_deg", -0.5), binding.split('/').next().unwrap());
    assert_eq!(altered(0, "apex_z_m", 0.01), ["stated apex"]);
    assert_eq!(altered(0, "flight_time_s", 0.01), ["stated flight time"]);
    has(&altered(0, "takeoff_map_x_m", 0.01), "continuity");
    // The same path under other limits.
    let (ran, limits) = check(&result, &["--set", "surface.friction_coefficient=0.3"]);
    assert!(ran.status == 1 && limits.iter().any(|(_, limit)| limit == "takeoff-cone"), "{ran:?}");
    let (ran, limits) = check(&result, &["--set", "hopper.clearance_m=0.6"]);
    assert!(ran.status == 1 && limits.iter().any(|(_, limit)| limit == "terrain"), "{ran:?}");
    assert!(ran.stdout.contains(" at facet "), "{ran:?}");
    // What is no such result is refused.
    let mut other = result.clone();
    other["hops"] = 77.into();
    assert!(check(&other, &[]).0.stderr.contains("the result states 77 hops, but its path has"));
    other["hops"] = Value::Null;
    assert!(check(&other, &[]).0.stderr.contains("found a result without a path"));
    other = result.clone();
    other["inputs"][0]["sha256"] = "0".repeat(64).into();
    assert!(check(&other, &[]).0.stderr.contains("no file of the scenario has that content"));
    desk.write("map.json", desk.run(&["map", "room.toml", "--format", "json", "--quiet"]).stdout);
    desk.refused(&["check", "map.json", "--quiet"], &["chta/map-mesh/1", "with the path to fly"]);
    desk.refused(&["check", "altered.json", "--prove", "--quiet"], &["--prove", "this terrain is a mesh"]);
}

#[test]
fn weak_and_strong_constraints_are_compared_over_one_mesh() {
    let desk = room(0.8, 1.2);
    let weak =
        desk.read("room.toml").replace("friction_coefficient = 1.0", "friction_coefficient = 1.5") + "[report]\ntitle = \"weak\"\n";
    desk.write("weak.toml", weak);
    desk.write("strong.toml", desk.read("room.toml") + "[report]\ntitle = \"strong\"\n");
    let words = ["compare", "weak.toml", "strong.toml", "--quiet", "--plot", "both.svg"];
    let document = desk.json(&words);
    assert_eq!(document["schema"], "chta/compare/1");
    for (row, file) in document["compared"].as_array().unwrap().iter().zip(["weak.toml", "strong.toml"]) {
        let planned = desk.json(&["plan", file, "--quiet"]);
        assert_eq!((&row["hops"], &row["totals"]), (&planned["hops"], &planned["totals"]), "{file}");
        assert_eq!((&row["lower_bound"], &row["start_m"]), (&planned["hops_lower_bound"], &planned["start"]["point_m"]));
        assert_eq!(row["start_x_m"], Value::Null);
    }
    let svg = desk.read("both.svg");
    for part in ["weak and strong", "Hops of weak: the landing", "Hops of strong: the landing", "azimuth 215 deg"] {
        assert!(svg.contains(part), "{part}");
    }
    let table = desk.run(&[&words[..4], &["-o", "-"]].concat()).stdout;
    assert_eq!(rows(&table).iter().map(|row| row("verdict")).collect::<Vec<_>>(), ["traversable"; 2]);
    // Paths over different meshes are not drawn over one another, and other terrain has a row with the reason.
    let other = room(0.9, 1.2);
    desk.write("other.obj", other.read("room.obj"));
    desk.write("other.toml", desk.read("room.toml").replace("room.obj", "other.obj"));
    desk.refused(&["compare", "room.toml", "other.toml", "--quiet", "--plot", "no.svg"], &["--plot", "another mesh in other.toml"]);
    assert_eq!(desk.run(&["compare", "room.toml", "other.toml", "--quiet"]).status, 0);
    let mixed = desk.run(&["compare", "room.toml", "scenario.toml", "--quiet", "--require-all"]);
    assert!(mixed.status == 1 && mixed.stdout.contains("found no free route over a mesh"), "{mixed:?}");
    desk.refused(&["compare", "room.toml", "weak.toml", "--prove", "--quiet"], &["--prove", "this terrain is a mesh"]);
    let shut = room(1.0, 1.0);
    shut.write("weak.toml", shut.read("room.toml"));
    let no = shut.run(&["compare", "room.toml", "weak.toml", "--quiet", "--require-all", "--plot", "no.svg"]);
    assert!(no.status == 1 && no.stdout.contains("no-path-found") && shut.read("no.svg").contains("goal, not reached"), "{no:?}");
}
