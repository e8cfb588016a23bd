//! Routes over a DEM in any direction, as a user sees them.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{fs, path::Path};

use serde_json::Value;

use crate::desk::Desk;

const HOPPER: &str = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\n\
    [surface]\nfriction_coefficient = 0.6\n[terrain]\ndem = \"walled.asc\"\nstart_m = [102.3, 204.6]\ngoal_m = [125.2, 205.4]\n";

/// Level ground of 30 x 20 posts of 1 m with a wall of steep posts across it and a gap in the wall in the north.
fn walled() -> Desk {
    let desk = Desk::with_dem();
    let mut grid = "ncols 30\nnrows 20\nxllcorner 99.5\nyllcorner 199.5\ncellsize 1\n".to_owned();
    for row in 0..20 {
        let post = |col: usize| if row >= 3 && col == 14 { "30" } else { "0" };
        grid.push_str(&(0..30).map(post).collect::<Vec<_>>().join(" "));
        grid.push('\n');
    }
    desk.write("walled.asc", grid);
    desk.write("straight.toml", HOPPER);
    desk.write("free.toml", format!("{HOPPER}route = \"free\"\n"));
    desk
}

#[test]
fn a_free_route_goes_round_a_wall_that_stops_a_transect() {
    let desk = walled();
    assert_eq!(desk.run(&["check", "straight.toml"]).status, 1);
    let files = ["-o", "path.csv", "--geojson", "path.geojson", "--plot", "path.svg", "--trajectory", "time.csv"];
    let document = desk.json(&[&["plan", "free.toml"][..], &files].concat());
    let (path, hops) = (document["path"].as_array().unwrap(), document["hops"].as_u64().unwrap());
    assert_eq!((path.len() as u64, &document["verdict"], &document["verified"]), (hops, &"traversable".into(), &true.into()));
    let lower = document["hops_lower_bound"].as_u64().unwrap();
    assert!(lower > 1 && lower < hops, "{lower} of {hops} hops");
    assert_eq!(document["scenario"]["terrain"]["route"], "free");
    let route = &document["route"];
    // A hop of v^2 / g = 3.9 m spans 8 nodes or more at three a post spacing.
    assert_eq!((&route["kind"], &route["nodes_per_post"]), (&"free".into(), &3.into()));
    let mut along_m = 0.0;
    for hop in path {
        let number = |key: &str| hop[key].as_f64().unwrap();
        let place = |end: &str| format!("{},{}", hop[format!("{end}_map_x_m")], hop[format!("{end}_map_y_m")]);
        assert!((number("takeoff_x_m") - along_m).abs() < 1e-9);
        let (dx, dy) =
            (number("landing_map_x_m") - number("takeoff_map_x_m"), number("landing_map_y_m") - number("takeoff_map_y_m"));
        along_m += dx.hypot(dy);
        assert!((number("landing_x_m") - along_m).abs() < 1e-9, "x is the distance along the path");
        // Every hop by itself, over the raster.
        let alone = desk.json(&[
            "hop",
            "walled.asc",
            "--from",
            &place("takeoff"),
            "--to",
            &place("landing"),
            "--scenario",
            "straight.toml",
        ]);
        assert_eq!(alone["feasible"], true);
        for (ours, theirs) in [("takeoff_speed_m_s", &alone["best"]["takeoff_speed_m_s"]), ("heading_deg", &alone["heading_deg"])] {
            assert!((number(ours) - theirs.as_f64().unwrap()).abs() < 1e-7, "{ours}: {} against {theirs}", hop[ours]);
        }
    }
    let ends = [&path[0]["takeoff_map_x_m"], &path[0]["takeoff_map_y_m"], &path[path.len() - 1]["landing_map_x_m"]];
    assert_eq!(ends.map(Value::as_f64), [Some(102.3), Some(204.6), Some(125.2)], "exactly where they were asked for");
    let north = path.iter().map(|hop| hop["landing_map_y_m"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!(north > 215.0, "through the gap in the north, {north} m");
    assert_eq!(desk.read("path.csv").lines().count(), 1 + path.len());
    assert!(desk.read("path.svg").contains("<svg") && desk.read("time.csv").lines().count() > 20);
    // The run writes the unrolled chain, and repeats.
    assert_eq!(desk.run(&["run", "free.toml", "-o", "first"]).status, 0);
    assert_eq!(desk.run(&["run", "first/result.json", "-o", "again"]).status, 0);
    for file in ["chain.csv", "path.csv", "path.svg", "path.geojson", "result.json"] {
        let read = |folder: &str| fs::read(desk.path().join(folder).join(file)).unwrap();
        assert!(read("first") == read("again"), "{file}");
    }
    let end_m: f64 = desk.read("first/chain.csv").lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!((end_m - along_m).abs() < 1e-9);
}

#[test]
fn a_free_route_that_is_not_found_says_how_near_it_came() {
    let desk = walled();
    let grid = desk.read("walled.asc");
    let closed: Vec<String> = grid
        .lines()
        .enumerate()
        .map(|(i, line)| {
            if i < 5 {
                line.to_owned()
            } else {
                line.split(' ').enumerate().map(|(col, z)| if col == 14 { "30" } else { z }).collect::<Vec<_>>().join(" ")
            }
        })
        .collect();
    desk.write("walled.asc", closed.join("\n") + "\n");
    let ran = desk.run(&["check", "free.toml"]);
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    for part in
        ["no-path-found", "not reached over these nodes; no path takes fewer than", "the reached place nearest to the goal is (11"]
    {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
    let document = desk.json(&["plan", "free.toml"]);
    assert_eq!((&document["hops"], &document["path"]), (&Value::Null, &serde_json::json!([])));
    let east = document["route"]["nearest_m"][0].as_f64().unwrap();
    assert!((110.0..114.0).contains(&east), "west of the wall, {east} m");
}

/// What a no says of the wall: both sides of it, and the limits of the hops across.
#[test]
fn a_no_names_the_limits_that_refuse_the_hops_across_the_gap() {
    let desk = walled();
    // A hop over 30 m of height takes more than these speeds, and one round the wall needs the gap in the north.
    let ran = desk.run(&["check", "free.toml", "--set", "surface.keep_out=zone.geojson"]);
    assert_eq!(ran.status, 2, "a file that is not there");
    let zone = r#"{"type": "Polygon", "coordinates": [[[110, 215], [118, 215], [118, 220], [110, 220], [110, 215]]]}"#;
    desk.write("zone.geojson", zone);
    let args = ["check", "free.toml", "--set", "surface.keep_out=zone.geojson"];
    let ran = desk.run(&args);
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    for part in ["the goal can be reached from", "is nearest to the start", "hops across it", "refused by"] {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
    let gap = &desk.json(&args)["route"]["gap"];
    let number = |key: &str| gap[key].as_f64().unwrap();
    let east = gap["leads_to_goal_from_m"][0].as_f64().unwrap();
    assert!(east > 113.0 && number("leads_to_goal_nodes") > 10.0, "{gap}");
    assert!(number("width_m") > 0.0 && number("judged_pairs") <= number("pairs"), "{gap}");
    let refusals: f64 = gap["refusals"].as_object().unwrap().values().map(|count| count.as_f64().unwrap()).sum();
    assert!(refusals > 0.0 && refusals + number("without_ground") <= number("judged_pairs"), "{gap}");
    // The keys that are named can be varied, and where the take-off speed alone is in the way, the named command finds the one that closes.
    let key = gap["keys"][0].as_str().unwrap();
    assert!(ran.stdout.contains(&format!("chta require SCENARIO --vary {key}")), "{}", ran.stdout);
    let sturdy = ["--set", "surface.keep_out=zone.geojson", "--set", "hopper.landing_speed_max_m_s=40"];
    let keys = desk.json(&[&["check", "free.toml"][..], &sturdy].concat())["route"]["gap"]["keys"].clone();
    let key = "hopper.takeoff_speed_max_m_s";
    assert!(keys.as_array().unwrap().contains(&key.into()), "{keys}");
    let range = ["--from", "2", "--to", "40", "--resolution", "0.5", "--node-spacing-max-m", "1"];
    let required = desk.json(&[&["require", "free.toml", "--vary", key][..], &range, &sturdy].concat());
    let closes = required["reachable_at"].as_f64().expect("a value that closes the gap");
    let set = format!("{key}={closes}");
    assert_eq!(desk.run(&[&["check", "free.toml", "--set", set.as_str()][..], &sturdy].concat()).status, 0, "{required}");
}

/// The size of a search is stated before it is made, and a limit of memory is kept or refused.
#[test]
fn the_memory_of_a_free_plan_is_stated_and_limited() {
    let desk = walled();
    let size = desk.json(&["plan", "free.toml", "--dry-run"]);
    assert_eq!((size["schema"].as_str(), size["dry_run"].as_bool()), (Some("chta/size/1"), Some(true)));
    let number = |key: &str| size[key].as_u64().unwrap();
    assert_eq!(number("posts"), 600);
    let planned = desk.json(&["plan", "free.toml"]);
    assert_eq!(number("nodes"), planned["nodes"].as_u64().unwrap());
    assert!(planned["pairs_tested"].as_u64().unwrap() <= number("pairs_max"), "{size}");
    // Within enough memory the answer stays; within less it says what it left out, and has as few hops.
    let by_energy =
        |mib: &str| desk.json(&["plan", "free.toml", "--set", "search.objective=[\"energy\", \"hops\"]", "--memory-max-mib", mib]);
    let (within, tight) = (by_energy("64"), by_energy("1"));
    assert_eq!((&within["labels_capped"], &tight["labels_capped"]), (&false.into(), &true.into()), "{tight}");
    assert!(tight["hops"].as_u64() >= planned["hops"].as_u64() && tight["verified"] == true, "{}", tight["hops"]);
    assert_eq!(desk.json(&["plan", "free.toml", "--memory-max-mib", "1"])["path"], planned["path"], "a label a node is enough");
    let fine = ["plan", "free.toml", "--node-spacing-max-m", "0.02"];
    let tight = [&fine[..], &["--memory-max-mib", "1", "--quiet"]].concat();
    desk.refused(
        &tight,
        &["free route needs at least", "expected at most 1 MiB", "a larger spacing of nodes", "--node-spacing-max-m"],
    );
    let refused = desk.run(&tight).stderr;
    let enough = refused.rsplit_once("--memory-max-mib ").unwrap().1.trim();
    assert_eq!(desk.run(&[&fine[..], &["--memory-max-mib", enough, "--dry-run"]].concat()).status, 0, "{refused}");
    for option in [&["--dry-run"][..], &["--memory-max-mib", "1"]] {
        desk.refused(
            &[&["plan", "free.toml", "--quiet", "--set", "terrain.route=transect"][..], option].concat(),
            &["only for a free route", "terrain.route = \"free\""],
        );
    }
}

#[test]
fn objectives_and_budgets_hold_in_any_direction() {
    let desk = walled();
    let at_least = |keys: &[&str]| {
        let args: Vec<&str> = ["plan", "free.toml"].into_iter().chain(keys.iter().flat_map(|key| ["--set", key])).collect();
        desk.json(&args)
    };
    let total = |document: &Value, amount: &str| {
        let totals = document["objective_totals"].as_array().unwrap();
        totals.iter().find(|row| row["amount"] == amount).unwrap()["total"].as_f64().unwrap()
    };
    let by_hops = at_least(&["search.objective=[\"hops\", \"energy\"]"]);
    let by_time = at_least(&["search.objective=[\"flight-time\", \"hops\"]"]);
    let (hops, energy) = (total(&by_hops, "hops"), total(&by_hops, "energy"));
    assert_eq!((by_hops["hops"].as_f64(), &by_hops["verified"]), (Some(hops), &true.into()));
    let flown = by_hops["totals"]["energy_j_kg"].as_f64().unwrap();
    assert!((flown - energy).abs() < 1e-6 * energy, "{flown} against {energy}");
    let (fast, of_fewest) = (total(&by_time, "flight-time"), by_hops["totals"]["flight_time_s"].as_f64().unwrap());
    assert!(fast < of_fewest && total(&by_time, "hops") >= hops, "{fast} s against {of_fewest} s");
    // A budget of just that is kept, one below is not, and the least says so.
    let most = format!("budget.flight_time_total_max_s={}", fast * 1.000_001);
    let within = at_least(&[&most]);
    assert_eq!((&within["verdict"], &within["budgets"][0]["met"]), (&"traversable".into(), &true.into()));
    let short = format!("budget.flight_time_total_max_s={}", fast * 0.99);
    let ran = desk.run(&["check", "free.toml", "--set", &short]);
    assert!(ran.status == 1 && ran.stdout.contains("the least of any path over these nodes is"), "{}", ran.stdout);
    assert_eq!(desk.run(&["check", "free.toml", "--set", &format!("budget.hops_max={}", hops - 1.0)]).status, 1);
    assert_eq!(desk.run(&["check", "free.toml", "--set", &format!("budget.hops_max={hops}")]).status, 0);
    // Risk counts, and is said to be of the plan alone.
    let errors = [
        "uncertainty.takeoff_speed_sigma_fraction=0.01",
        "uncertainty.goal_tolerance_m=1",
        "search.objective=[\"hops\", \"risk\"]",
    ];
    let by_risk = at_least(&errors);
    assert!(total(&by_risk, "risk") > 0.0 && total(&by_risk, "hops") == hops, "{by_risk}");
}

#[test]
fn a_front_of_free_routes_improves_row_by_row() {
    let desk = walled();
    let coarse = ["--node-spacing-max-m", "1", "--goal", "113,208"];
    let args = [&["plan", "free.toml", "--front", "hops,flight-time", "--plot-front", "front.svg"][..], &coarse].concat();
    let document = desk.json(&args);
    let rows = document["front"].as_array().unwrap();
    let of = |row: &Value| (row["hops"].as_u64().unwrap(), row["flight_time_s"].as_f64().unwrap());
    assert_eq!((of(&rows[0]).0, &document["front_amount"]), (document["hops"].as_u64().unwrap(), &"flight-time".into()));
    assert!(rows.windows(2).all(|pair| of(&pair[0]).0 < of(&pair[1]).0 && of(&pair[0]).1 > of(&pair[1]).1), "{rows:?}");
    assert!(desk.read("front.svg").contains("<svg"));
}

#[test]
fn start_and_goal_are_positions_on_the_map_or_along_the_slice() {
    let desk = walled();
    let ends = |args: &[&str]| {
        let document = desk.json(&[&["plan", "free.toml"], args].concat());
        let path = document["path"].as_array().unwrap();
        let at = |hop: &Value, end: &str| ["x", "y"].map(|axis| hop[format!("{end}_map_{axis}_m")].as_f64().unwrap());
        [at(&path[0], "takeoff"), at(&path[path.len() - 1], "landing")]
    };
    assert_eq!(ends(&["--start", "103,202", "--goal", "110.5,208.25"]), [[103.0, 202.0], [110.5, 208.25]]);
    assert_eq!(ends(&["--goal", "110.5,208.25"]), [[102.3, 204.6], [110.5, 208.25]]);
    let [start, _] = ends(&["--start", "2"]);
    assert!((start[0] - 104.3).abs() < 0.01 && (start[1] - 204.67).abs() < 0.01, "{start:?}");
}

#[test]
fn what_a_free_route_cannot_is_refused_with_what_can() {
    let desk = walled();
    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,4\n");
    let transect = "only along a transect, and terrain.route is \"free\": set terrain.route = \"transect\"";
    let trials = ["--set", "uncertainty.takeoff_speed_sigma_fraction=0.01", "--set", "uncertainty.goal_tolerance_m=1"];
    for (args, said) in [
        (&["check", "free.toml", "--prove"][..], transect),
        (&["plan", "free.toml", "--prove"], transect),
        (&["check", "free.toml", "--pairs", "pairs.csv", "--prove"], transect),
        (&[&["plan", "free.toml", "--front", "hops,risk"][..], &trials].concat(), transect),
        (&["trade", "free.toml", "--vary", "hopper.takeoff_speed_max_m_s=2:3:2", "--prove"], transect),
        (&["check", "scenario.toml", "--set", "terrain.route=free"], "terrain is a chain, expected a dem or a mesh"),
        (&["check", "free.toml", "--set", "terrain.via_m=[[103, 204]]"], "terrain.via_m has no meaning beside terrain.route"),
        (&["check", "free.toml", "--set", "search.points_per_segment=3"], "give node_spacing_max_m"),
        (&["check", "free.toml", "--set", "terrain.route=any"], "transect, free"),
        (&["check", "free.toml", "--node-spacing-max-m", "1e-5"], "make the spacing of nodes larger"),
        (&["check", "free.toml", "--goal", "1,1"], "the goal point (1 m, 1 m) is off the map"),
    ] {
        let ran = desk.run(args);
        let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(ran.status == 2 && sentence.contains(said), "{args:?}: {ran:?}");
    }
}

#[test]
fn what_a_free_route_leaves_out_is_warned_of() {
    let desk = walled();
    for (sets, said) in
        [(&["hopper.takeoff_speed_step_m_s=0.1"][..], "exact commands"), (&["search.node_spacing_max_m=1"], "fewer than 8")]
    {
        let args: Vec<&str> = ["plan", "free.toml"].into_iter().chain(sets.iter().flat_map(|set| ["--set", set])).collect();
        let ran = desk.run(&args);
        assert!(ran.status == 0 && ran.stderr.contains(said), "{sets:?}: {ran:?}");
    }
}

/// Beginnings of the commands of the document, each with what it prints.
const ANSWERS: [(&str, &str); 12] = [
    ("map data/terrain/lunar_rille.tif --start 380,90 --goal", "65999 of 66049 posts"),
    ("map data/terrain/lunar_rille.tif --start 380,90 --goal", ", in at most 36 hops"),
    ("map data/terrain/lunar_rille.tif --start 380,90 --goal", "25 hops"),
    ("map data/terrain/lunar_rille.tif --start 380,90 --scenario", "23688 of 66049 posts"),
    ("plan data/scenarios/lunar_rille_free.toml", "359.890 m over ground, 142.970 s in flight, 360.3396 J/kg"),
    ("plan data/scenarios/lunar_rille_free.toml --front", "    37                4.6747"),
    ("plan data/scenarios/lunar_rille.toml", "27 hops"),
    ("require data/scenarios/lunar_rille_free.toml --vary hopper.takeoff_speed_max_m_s --from 2", "at 4.493458799 m/s, in 40 hops"),
    (
        "simulate data/scenarios/lunar_rille_free.toml --set uncertainty.takeoff_speed_sigma_fraction=0.005",
        "open-loop: 0 of 300 trials",
    ),
    (
        "simulate data/scenarios/lunar_rille_free.toml --set uncertainty.takeoff_speed_sigma_fraction=0.005",
        "replan: 300 of 300 trials",
    ),
    ("simulate data/scenarios/lunar_rille_free.toml --goal 350,200", "traversable, 14 hops"),
    ("simulate data/scenarios/lunar_rille_free.toml --goal 350,200", "replan: 491 of 500 trials"),
];

/// The commands of the document, one after another in an empty folder beside the data.
#[test]
fn the_commands_of_the_document_run() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let desk = Desk::new();
    let document = fs::read_to_string(root.join("docs/missions.md")).unwrap();
    let commands: Vec<&str> = document.lines().filter_map(|line| line.trim_start().strip_prefix("chta ")).collect();
    assert!(commands.len() >= 7, "{commands:?}");
    for command in commands {
        let words: Vec<String> = command
            .split_whitespace()
            .map(|word| if word.starts_with("data/") { root.join(word).display().to_string() } else { word.to_owned() })
            .collect();
        let ran = desk.run(&words.iter().map(String::as_str).collect::<Vec<_>>());
        let is_chosen = |line: &&str| line.starts_with("warning: this path is the most reliable one over places beside the route");
        let (chosen, warned): (Vec<_>, Vec<_>) = ran.stderr.lines().partition(is_chosen);
        assert_eq!(chosen.len(), usize::from(command.ends_with("--trials 500")), "{command}: {chosen:?}");
        // The least capable values have short hops.
        let (coarse, others): (Vec<_>, Vec<_>) =
            warned.into_iter().partition(|line| line.contains(" nodes of the free route, 2 m apart, fewer than 8"));
        // Fewer hops than all targets take: some are left out.
        assert_eq!((ran.status, others), (i32::from(command.ends_with("budget.hops_max=60")), Vec::new()), "{command}");
        assert_eq!(coarse.len(), usize::from(command.starts_with("require")), "{command}: {coarse:?}");
        // What the document says of them.
        if command.ends_with("--dry-run") {
            assert!(ran.stdout.starts_with("dry run: nothing was computed"), "{}", ran.stdout);
            continue;
        }
        for (_, text) in ANSWERS.iter().filter(|(of, _)| command.starts_with(of)) {
            assert!(ran.stdout.contains(text), "{command}: {text:?} is missing in {}", ran.stdout);
        }
    }
    for words in
        ["25 hops over 360 m", "27 over 349 m", "300 of 300 trials", "All but 50 of the 66 049 posts", "4.49 m/s", "1.2 m/s"]
    {
        assert!(document.contains(words), "{words}");
    }
}
