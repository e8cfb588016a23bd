//! Trials, requirements and trades of routes over a DEM in any direction, as a user sees them.

use std::{fs, path::Path};

use serde_json::Value;

use crate::desk::Desk;

/// Level ground of 30 x 20 posts of 1 m; `height` of every post.
fn ground(desk: &Desk, name: &str, height: impl Fn(usize, usize) -> f64) {
    let mut grid = "ncols 30\nnrows 20\nxllcorner 99.5\nyllcorner 199.5\ncellsize 1\n".to_owned();
    for row in 0..20 {
        grid.push_str(&(0..30).map(|col| height(row, col).to_string()).collect::<Vec<_>>().join(" "));
        grid.push('\n');
    }
    desk.write(name, grid);
}

/// A hopper on the Moon between two places of a DEM, by any way; further tables follow.
fn scenario(dem: &str, [start, goal]: [[f64; 2]; 2], more: &str) -> String {
    format!(
        "[body]\ngravity_m_s2 = 1.0\n[hopper]\ntakeoff_speed_max_m_s = 2.0\nlanding_speed_max_m_s = 3.0\n\
         [surface]\nfriction_coefficient = 5.0\n\
         [terrain]\ndem = \"{dem}\"\nstart_m = {start:?}\ngoal_m = {goal:?}\nroute = \"free\"\n{more}"
    )
}

/// Errors of the speed alone.
const ERRORS: &str = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ngoal_tolerance_m = 0.2\ntrials = 4000\n";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// What an answer says of its trials.
fn trials(answer: &Value) -> Vec<Value> {
    ["trials", "policy", "success_rate", "outcomes", "failures", "hops_flown", "landings", "convergence"]
        .map(|key| answer[key].clone())
        .into()
}

/// The totals without the estimate of success.
fn totals(of: &Value) -> Value {
    let mut totals = of["totals"].clone();
    if let Some(totals) = totals.as_object_mut() {
        totals.retain(|key, _| !key.starts_with("success"));
    }
    totals
}

/// A level hop of D metres with a speed of standard deviation s lands within 2 D s of its aim in 68.27 of 100 trials: the length of an arc at 45
/// degrees goes with the square of its speed.
#[test]
fn one_hop_over_level_ground_succeeds_as_often_as_the_normal_distribution_says() {
    let desk = Desk::new();
    ground(&desk, "flat.asc", |_, _| 3.0);
    // 2.5 m in a direction of no grid line, by the least speed.
    let hop = [[110.0, 210.0], [111.5, 212.0]];
    desk.write(
        "hop.toml",
        scenario("flat.asc", hop, &format!("[search]\nrisk = \"ignored\"\n{}", ERRORS.replace("0.2\n", "0.1\n"))),
    );
    for policy in ["open-loop", "replan"] {
        let answer = desk.json(&["simulate", "hop.toml", "--policy", policy]);
        assert_eq!((&answer["hops"], &answer["trials"]), (&1.into(), &4000.into()));
        let rate = number(&answer["success_rate"]);
        // A robot that replans and is off the goal tries again.
        let is_expected = if policy == "replan" { rate > 0.95 } else { (rate - 0.6827).abs() < 0.03 };
        assert!(is_expected, "{policy}: {rate}");
    }
    // The least speed error with which 90 of 100 arrive: 0.1 = 1.645 (2 x 2.5 s).
    desk.write("risky.toml", scenario("flat.asc", hop, &ERRORS.replace("0.2\n", "0.1\npolicy = \"open-loop\"\n")));
    let key = "uncertainty.takeoff_speed_sigma_fraction";
    let required = desk.json(&["require", "risky.toml", "--vary", key, "--from", "0.001", "--to", "0.1", "--success-min", "0.9"]);
    let sigma = number(&required["reachable_at"]);
    assert!((sigma / 0.012_16 - 1.0).abs() < 0.12, "{sigma}");
    assert_eq!((&required["hops"], &required["route"]["kind"]), (&1.into(), &"free".into()));
    let at = |sigma: f64| {
        desk.run(&["check", "risky.toml", "--set", "budget.estimated_success_min=0.9", "--set", &format!("{key}={sigma}")]).status
    };
    assert_eq!((at(sigma), at(sigma * 1.05)), (0, 1), "the success budget of a free route is kept");
}

/// On level ground along a line of posts both routes have the same hops: their trials are the same, and so is what they replan by.
#[test]
fn trials_of_a_free_route_that_is_straight_are_those_of_the_transect() {
    let desk = Desk::new();
    ground(&desk, "flat.asc", |_, _| 3.0);
    // Nine metres in hops of at most four: 3, 3 and 3 have the least peak.
    let more = format!("[search]\nnode_spacing_max_m = 1.0\neffort = \"peak-speed\"\nrisk = \"ignored\"\n{ERRORS}");
    desk.write("line.toml", scenario("flat.asc", [[105.0, 210.0], [114.0, 210.0]], &more));
    for policy in ["open-loop", "replan"] {
        let [free, transect] = ["free", "transect"].map(|route| {
            let route = format!("terrain.route={route}");
            desk.json(&["simulate", "line.toml", "--policy", policy, "--set", &route, "--set", "uncertainty.trials=600"])
        });
        assert_eq!((&free["hops"], &free["route"]["kind"], &transect["route"]), (&3.into(), &"free".into(), &Value::Null));
        assert_eq!(trials(&free), trials(&transect), "{policy}");
        let rate = number(&free["success_rate"]);
        assert!(rate > 0.05 && (rate < 1.0 || policy == "replan"), "{policy}: {rate}");
    }
}

/// A wall of steep posts with a gap: the route goes round it, and so do its trials.
fn walled(desk: &Desk) {
    ground(desk, "walled.asc", |row, col| if row >= 3 && col == 14 { 30.0 } else { 0.0 });
    let hopper = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.7\n\
        [surface]\nfriction_coefficient = 0.6\n[terrain]\ndem = \"walled.asc\"\nstart_m = [102.3, 204.6]\ngoal_m = [125.2, 205.4]\n\
        route = \"free\"\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.01\ntakeoff_angle_sigma_deg = 0.5\ngoal_tolerance_m = 0.5\ntrials = 300\n";
    desk.write("free.toml", hopper);
}

#[test]
fn a_robot_that_replans_goes_round_a_wall_more_surely_than_open_loop() {
    let desk = Desk::new();
    walled(&desk);
    let ran = desk.run(&["run", "free.toml", "-o", "out"]);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    for file in ["simulation.json", "trials.svg", "landings.svg", "path.svg"] {
        assert!(desk.path().join("out").join(file).exists(), "{file}");
    }
    let result: Value = serde_json::from_str(&desk.read("out/result.json")).expect("JSON");
    let estimated = number(&result["totals"]["success_estimated"]);
    assert!(result["path"].as_array().is_some_and(|hops| hops.iter().all(|hop| hop["success_estimated"].is_number())));
    // The result's path as it stands: its trials are those of the run, and of the scenario.
    let again = desk.json(&["simulate", "out/result.json"]);
    let anew = desk.json(&["simulate", "free.toml"]);
    let of_run: Value = serde_json::from_str(&desk.read("out/simulation.json")).expect("JSON");
    assert_eq!((trials(&again), &again["path"]), (trials(&anew), &anew["path"]));
    let rate = number(&anew["success_rate"]);
    assert_eq!(number(&of_run["success_rate"]), rate);
    assert!((estimated - rate).abs() < 0.1, "estimated {estimated}, flown {rate}");
    let both = desk.json(&["simulate", "free.toml", "--compare", "-o", "landings.csv", "--plot", "t.svg", "--plot-map", "m.svg"]);
    let rates: Vec<f64> = both["compare"].as_array().expect("both").iter().map(|one| number(&one["success_rate"])).collect();
    assert!(rates[1] >= rates[0] && rates[1] == rate && rate > 0.95, "{rates:?}");
    assert!(desk.read("landings.csv").lines().count() > 1000 && desk.read("m.svg").contains("<svg"));
    // Another start is another journey.
    let other = desk.run(&["simulate", "out/result.json", "--start", "103,205"]);
    assert!(other.status == 2 && other.stderr.contains("the scenario asks for (103, 205) m"), "{other:?}");
    // The experiment that flies trials, and those of one plane.
    let sensitivity = desk.json(&["simulate", "free.toml", "--experiment", "sensitivity"]);
    assert_eq!(sensitivity["errors"].as_array().map(Vec::len), Some(2));
    assert_eq!(number(&sensitivity["success_rate"]), rate);
    for (experiment, why) in [("worst-drift", "turns where it lands"), ("cone-width", "planned over the whole dem")] {
        let ran = desk.run(&["simulate", "free.toml", "--experiment", experiment]);
        let is_said = [experiment, why, "set terrain.route = \"transect\""].iter().all(|part| ran.stderr.contains(part));
        assert!(ran.status == 2 && is_said, "{ran:?}");
    }
}

#[test]
fn each_hop_has_its_most_reliable_command() {
    let desk = Desk::new();
    walled(&desk);
    let planned = |choice: &str| {
        let answer = desk.json(&["plan", "free.toml", "--set", &format!("search.takeoff_angle={choice}")]);
        let of_hop = |hop: &Value| number(&hop["success_estimated"]);
        let of_hops: Vec<f64> = answer["path"].as_array().expect("a path").iter().map(of_hop).collect();
        (of_hops, number(&answer["totals"]["success_estimated"]))
    };
    let ((least, on_the_edge), (reliable, surely)) = (planned("least-speed"), planned("most-reliable"));
    // A least speed over level ground stands on the edge of the take-off cone: half of the draws fail.
    assert!(least.iter().all(|success| *success < 0.6) && reliable.iter().all(|success| *success > 0.7), "{least:?} {reliable:?}");
    assert!(surely > on_the_edge + 0.3, "{on_the_edge} and {surely}");
}

/// Parts of a campaign give the answer of the whole.
#[test]
fn trials_of_a_free_route_can_be_flown_in_parts() {
    let desk = Desk::new();
    walled(&desk);
    let part = |first: &str, trials: &str, file: &str| {
        let set = format!("uncertainty.trials={trials}");
        let args = ["simulate", "free.toml", "--policy", "open-loop", "--first-trial", first, "--set", &set, "--tally", file];
        assert_eq!(desk.run(&args).status, 0);
        serde_json::from_str::<chta::uncertainty::Tally>(&desk.read(file)).expect("a tally")
    };
    let whole = part("0", "300", "whole.json");
    let mut merged = part("100", "200", "second.json");
    merged.merge(&part("0", "100", "first.json")).expect("the same mission");
    assert_eq!(merged, whole);
}

/// A pit of 6 m across the way, with walls on which nothing stands and no way out of it: the robot has to hop over it.
#[test]
fn the_least_speed_over_a_pit_is_that_of_a_level_hop_over_it() {
    let desk = Desk::new();
    ground(&desk, "pit.asc", |_, col| if (10..15).contains(&col) { -30.0 } else { 0.0 });
    let ends = [[105.3, 209.6], [120.2, 208.4]];
    desk.write("pit.toml", scenario("pit.asc", ends, "").replace("landing_speed_max_m_s = 3.0", "landing_speed_max_m_s = 9.0"));
    let key = "hopper.takeoff_speed_max_m_s";
    let args = ["require", "pit.toml", "--vary", key, "--from", "2", "--to", "4", "--resolution", "0.01"];
    let required = desk.json(&args);
    let (value, not_at) = (number(&required["reachable_at"]), number(&required["not_reached_at"]));
    let spacing_m = number(&required["route"]["node_spacing_m"]);
    // g = 1: a hop of D metres takes the square root of D.
    assert!(
        value > 6.0_f64.sqrt() - 1e-6 && value < (6.0 + 2.0 * spacing_m).sqrt() * 1.011,
        "{value} m/s over nodes {spacing_m} m apart"
    );
    assert!(not_at < value && not_at > value * 0.985 && required["unreachable_at"].is_null());
    // A hop of 4 m, by the slowest, is to span eight nodes.
    assert_eq!((&required["route"]["nodes_per_post"], &required["route"]["shortest_level_hop_m"]), (&2.into(), &4.0.into()));
    let check = |speed: f64| {
        let set = format!("{key}={speed}");
        desk.run(&["check", "pit.toml", "--set", &set, "--node-spacing-max-m", &spacing_m.to_string()]).status
    };
    assert_eq!((check(value), check(not_at), check(value * 0.985)), (0, 1, 1), "over the same nodes");
    // The scenario shown has the value and the nodes: its plan is the path.
    desk.write("required.json", required.to_string());
    let planned = desk.json(&["plan", "required.json"]);
    assert_eq!((&planned["path"], &planned["hops"]), (&required["path"], &required["hops"]));
    let text = desk.run(&args).stdout;
    for part in [
        "over the same nodes for all values: 2 for each post spacing",
        "in at most",
        "without a budget of hops",
        "nothing is proved",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_trade_of_free_routes_has_the_plans_over_the_same_nodes() {
    let desk = Desk::new();
    walled(&desk);
    let args = ["trade", "free.toml", "--vary", "hopper.takeoff_speed_max_m_s=1.5:3:4", "-o", "trade.csv", "--plot", "trade.svg"];
    let traded = desk.json(&args);
    let spacing = traded["route"]["node_spacing_m"].to_string();
    let rows = traded["rows"].as_array().expect("rows");
    let mut before = u64::MAX;
    for row in rows {
        let speed = format!("hopper.takeoff_speed_max_m_s={}", row["hopper.takeoff_speed_max_m_s"]);
        let planned = desk.json(&["plan", "free.toml", "--set", &speed, "--node-spacing-max-m", &spacing]);
        for key in ["verdict", "hops", "effort"] {
            assert_eq!(row[key], planned[key], "{key} at {speed}");
        }
        assert_eq!(totals(row), totals(&planned), "{speed}");
        let hops = row["hops"].as_u64().expect("a path");
        assert!(hops <= before, "more speed takes no more hops");
        before = hops;
    }
    assert!(desk.read("trade.svg").contains("<svg") && desk.read("trade.csv").lines().count() == 5);
    let text = desk.run(&args[..4]).stdout;
    assert!(text.contains("over the same nodes for all values"), "{text}");
    // Hops of the slowest machine span few of the coarsest nodes, which the plan of that cell says too.
    let coarse = [&args[..4], &["--node-spacing-max-m", "1"]].concat();
    let warned = desk.run(&coarse).stderr;
    assert!(
        warned.contains("1.4 nodes of the free route (for the value with the shortest hops), 1 m apart, fewer than 8"),
        "{warned}"
    );
    // A cell that cannot be searched has a row with its error; the others have their answers.
    let spacings = desk.json(&["trade", "free.toml", "--vary", "search.node_spacing_max_m=0.00001:0.5:2"]);
    let rows = spacings["rows"].as_array().expect("rows");
    assert!(rows[0]["error"].as_str().is_some_and(|error| error.contains("make the spacing of nodes larger")), "{rows:?}");
    assert_eq!((&rows[1]["verdict"], &spacings["route"]), (&"traversable".into(), &Value::Null));
    // Friction beside the straight line counts.
    let friction = desk.json(&["trade", "free.toml", "--vary", "surface.friction_coefficient=0.1:0.6:2"]);
    assert_eq!(friction["rows"].as_array().map(Vec::len), Some(2));
}

#[test]
fn a_comparison_and_many_pairs_take_free_routes() {
    let desk = Desk::new();
    walled(&desk);
    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,4\n0,22\n22,3.5\n");
    let pairs = desk.json(&["check", "free.toml", "--pairs", "pairs.csv"]);
    let hops: Vec<u64> = pairs["pairs"].as_array().expect("pairs").iter().filter_map(|pair| pair["hops"].as_u64()).collect();
    assert!(hops.len() == 3 && hops[0] < hops[1] && hops[2] > hops[0], "{hops:?}");
    desk.write("same.toml", desk.read("free.toml"));
    let compared = desk.json(&["compare", "free.toml", "same.toml", "--plot", "c.svg"]);
    let rows = compared["compared"].as_array().expect("rows");
    let planned = desk.json(&["plan", "free.toml"]);
    for row in rows {
        assert_eq!((&row["hops"], totals(row)), (&planned["hops"], totals(&planned)));
    }
    assert!(rows[0]["margins"].is_object());
}

/// Both real terrains: the route is flown in trials, its result is read back, and the least speed has a path.
#[test]
#[allow(clippy::print_stderr, reason = "a skipped test says why")]
fn free_routes_over_real_terrain_are_flown_and_their_least_speed_is_found() {
    let dems = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem");
    let mars = ("hirise_DTEEC_010228_1490_crop_120x70.tif", "mars", [[17.9, 36.6], [30.0, 50.0]], ["4", "1.01"], 1.0);
    let moon = ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", "moon", [[75872.5, 38872.5], [75974.5, 38923.5]], ["2.5", "5"], 5.0);
    for (file, body, [start, goal], [from, spacing], tolerance) in [mars, moon] {
        let dem = dems.join(file);
        if !dem.exists() {
            eprintln!("skipped: {} is absent", dem.display());
            continue;
        }
        let desk = Desk::new();
        let text = format!(
            "[body]\nname = \"{body}\"\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n\
             [surface]\nfriction_coefficient = 0.7\n[terrain]\ndem = {:?}\nstart_m = {start:?}\ngoal_m = {goal:?}\nroute = \"free\"\n\
             accept_map_scale = true\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.005\ntakeoff_angle_sigma_deg = 0.3\n\
             goal_tolerance_m = {tolerance:?}\ntrials = 200\n",
            dem.display().to_string()
        );
        desk.write("free.toml", text);
        let planned = desk.json(&["plan", "free.toml", "--node-spacing-max-m", spacing, "-o", "path.csv"]);
        assert_eq!(planned["verdict"], "traversable", "{file}");
        let ran = desk.run(&["simulate", "free.toml", "--node-spacing-max-m", spacing, "--compare", "--format", "json"]);
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let flown: Value = serde_json::from_str(&ran.stdout).expect("JSON");
        desk.write("flown.json", &ran.stdout);
        let rates: Vec<f64> = flown["compare"].as_array().expect("both").iter().map(|one| number(&one["success_rate"])).collect();
        assert!(rates[1] >= rates[0] && rates[1] > 0.9, "{file}: {rates:?}");
        let again = desk.json(&["simulate", "flown.json"]);
        assert_eq!(trials(&again), trials(&flown), "{file}");
        let key = "hopper.takeoff_speed_max_m_s";
        let nodes = ["--node-spacing-max-m", spacing];
        let range = ["--from", from, "--to", "8", "--resolution", "0.01"];
        let required = desk.json(&[&["require", "free.toml", "--vary", key][..], &range, &nodes].concat());
        let value = number(&required["reachable_at"]);
        let check = |speed: f64| desk.run(&["check", "free.toml", "--set", &format!("{key}={speed}"), nodes[0], nodes[1]]).status;
        assert_eq!(check(value), 0, "{file}: {value}");
        let not_at = number(&required["not_reached_at"]);
        assert_eq!((check(not_at), not_at > 0.985 * value), (1, true), "{file}: {not_at}");
        let written = fs::read_to_string(desk.path().join("path.csv")).expect("path.csv");
        assert_eq!(Some(written.lines().count() as u64 - 1), planned["hops"].as_u64());
    }
}

/// Over rough ground the route is the one that most trials arrive by: never fewer than by the most reliable one of the fewest hops.
#[test]
fn a_route_is_chosen_for_its_reliability() {
    let desk = Desk::new();
    let bump = |row: usize, col: usize| f64::from(u32::try_from((7 * row * row + 13 * col + row * col) % 11).unwrap_or(0)) / 11.0;
    ground(&desk, "rough.asc", |row, col| 0.9 * bump(row, col));
    let errors = "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.03\ntakeoff_angle_sigma_deg = 1.5\ngoal_tolerance_m = 0.8\n";
    let (mut better, mut longer) = (0, 0);
    for ends in [[[103.0, 203.0], [125.0, 214.0]], [[104.0, 215.0], [124.0, 204.0]]] {
        let rough = scenario("rough.asc", ends, errors).replace("friction_coefficient = 5.0", "friction_coefficient = 1.2");
        desk.write("rough.toml", rough);
        let planned = |risk: &str| {
            let risk = format!("search.risk={risk}");
            let answer =
                desk.json(&["plan", "rough.toml", "--set", &risk, "--set", "search.takeoff_angle=most-reliable", "--quiet"]);
            (answer["hops"].as_u64().expect("hops"), number(&answer["totals"]["success_estimated"]), answer["verified"].clone())
        };
        let ((hops, surely, verified), (fewest, success, _)) = (planned("traded"), planned("fewest-hops"));
        assert!(surely >= success && hops >= fewest && verified == true, "{hops} hops, {surely}; {fewest} hops, {success}");
        better += u32::from(surely > success + 0.05);
        longer += u32::from(hops > fewest);
    }
    assert!(better > 0 && longer > 0, "{better} better, {longer} longer");
}
