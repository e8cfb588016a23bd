//! Layers with a cost, through the commands.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use serde_json::Value;

use crate::desk::Desk;

/// A level map of 41 by 21 posts, 1 m apart, hops of at most 3.9 m over it, and a band across it, 3 m wide, that costs 4 a metre and 5 a
/// landing but for a gap at its northern end.
fn desk() -> Desk {
    let desk = Desk::new();
    let grid = |value: &dyn Fn(usize, usize) -> &'static str| {
        let row = |row: usize| (0..41).map(|col| value(row, col)).collect::<Vec<_>>().join(" ");
        let rows: Vec<String> = (0..21).map(row).collect();
        format!("ncols 41\nnrows 21\nxllcenter 0\nyllcenter 0\ncellsize 1\n{}\n", rows.join("\n"))
    };
    desk.write("level.asc", grid(&|_, _| "0"));
    desk.write("hazard.asc", grid(&|row, col| if is_costly(col, 20 - row) { "2" } else { "0" }));
    let scenario = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\n[surface]\n\
                    friction_coefficient = 1.0\n[terrain]\ndem = \"level.asc\"\nstart_m = [5, 10]\nroute = \"free\"\n[search]\n\
                    node_spacing_max_m = 1.0\n";
    desk.write("goal.toml", scenario.replace("route", "goal_m = [35, 10]\nroute"));
    desk.write("targets.toml", format!("{scenario}[mission]\ntargets_m = [[35, 10], [5, 16]]\nreturn_to_start = true\n"));
    desk
}

fn is_costly(col: usize, y: usize) -> bool {
    (19..=21).contains(&col) && y < 17
}

/// What a path costs, from its rows alone: in steps of a thousandth of each flight, and exactly at landings.
fn cost(path: &Value) -> f64 {
    let value = |at: [f64; 2]| if (18.5..=21.5).contains(&at[0]) && at[1] <= 16.5 { 2.0 } else { 0.0 };
    let of_hop = |hop: &Value| {
        let of = |key: &str| hop[key].as_f64().unwrap();
        let [from, to] = ["takeoff", "landing"].map(|end| [of(&format!("{end}_map_x_m")), of(&format!("{end}_map_y_m"))]);
        let run_m = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |share: f64| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let mean: f64 = (0..1000).map(|step| value(at((f64::from(step) + 0.5) / 1000.0))).sum::<f64>() / 1000.0;
        2.5 * value(to) + 2.0 * run_m * mean
    };
    path.as_array().unwrap().iter().map(of_hop).sum()
}

const LAYER: &str = "layer.hazard={ raster = \"hazard.asc\", cost_per_contact = 2.5, cost_per_m = 2";

fn set(more: &str) -> String {
    format!("{LAYER}{more} }}")
}

fn stated(answer: &Value) -> f64 {
    assert_eq!(answer["layer_costs"][0]["amount"], "layer:hazard", "{answer}");
    answer["layer_costs"][0]["total"].as_f64().unwrap()
}

fn ask(desk: &Desk, words: &[&str]) -> (i32, Value, String) {
    let text = desk.run(words);
    let json = desk.run(&[words, &["--format", "json"]].concat());
    assert_eq!(text.status, json.status, "{}", text.stderr);
    (json.status, serde_json::from_str(&json.stdout).unwrap(), format!("{}{}", text.stdout, text.stderr))
}

#[test]
fn a_route_states_its_costs_keeps_a_budget_of_them_and_is_planned_by_them() {
    let desk = desk();
    let (status, straight, text) = ask(&desk, &["plan", "goal.toml", "--set", &set("")]);
    assert_eq!((status, &straight["verified"]), (0, &true.into()), "{text}");
    let across = stated(&straight);
    // From the rows of the path alone.
    assert!((across - cost(&straight["path"])).abs() < 0.05 && across > 11.0, "{across}: {text}");
    assert!(text.contains(&format!("costs of layers: layer:hazard {across:.4}")), "{text}");

    let (status, around, text) = ask(&desk, &["plan", "goal.toml", "--set", &set(", total_max = 3")]);
    assert_eq!((status, stated(&around)), (0, 0.0), "{text}");
    assert!(around["hops"].as_u64() >= straight["hops"].as_u64() && cost(&around["path"]) < 1e-9, "{text}");
    let budget = &around["budgets"][0];
    assert_eq!((&budget["key"], &budget["amount"]), (&"layer.hazard.total_max".into(), &"layer:hazard".into()));

    let objective = "search.objective=['layer:hazard', 'hops']";
    let (status, least, text) = ask(&desk, &["plan", "goal.toml", "--set", &set(""), "--set", objective]);
    assert_eq!((status, stated(&least), least["hops"].as_u64()), (0, 0.0, around["hops"].as_u64()), "{text}");
    assert_eq!(least["objective_totals"][0]["amount"], "layer:hazard");

    let (status, front, text) = ask(&desk, &["plan", "goal.toml", "--set", &set(""), "--front", "hops,layer:hazard"]);
    let rows: Vec<(u64, f64)> = front["front"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| (row["hops"].as_u64().unwrap(), row["layer_total"].as_f64().unwrap()))
        .collect();
    assert_eq!(status, 0, "{text}");
    assert_eq!(rows[0].0, straight["hops"].as_u64().unwrap(), "{text}");
    assert!(rows[0].1 <= across && rows.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1), "{text}");
    assert_eq!(rows.last(), Some(&(around["hops"].as_u64().unwrap(), 0.0)), "{text}");
}

#[test]
fn a_mission_keeps_a_budget_of_costs() {
    let desk = desk();
    let (status, free, text) = ask(&desk, &["plan", "targets.toml", "--set", &set("")]);
    let whole = stated(&free);
    assert!(status == 0 && whole > 22.0 && (cost(&free["path"]) - whole).abs() < 0.1, "{whole}: {text}");
    // Once across the band, or not at all: there is a way round it.
    for most in [18.0, 13.0] {
        let (status, bounded, text) = ask(&desk, &["plan", "targets.toml", "--set", &set(&format!(", total_max = {most}"))]);
        let total = stated(&bounded);
        assert!(status == 0 && total <= most && (cost(&bounded["path"]) - total).abs() < 0.1, "{total}: {text}");
        assert_eq!((&bounded["verified"], &bounded["targets_visited"]), (&true.into(), &2.into()));
        assert!(bounded["hops"].as_u64() >= free["hops"].as_u64());
    }
}

#[test]
fn costs_are_refused_by_name_where_nothing_counts_them() {
    let desk = desk();
    let layer = set("");
    let plan = |more: &[&str]| desk.run(&[&["plan", "goal.toml", "--set", &layer], more].concat());
    let maps: [(&[&str], &str); 5] = [
        (&["map", "level.asc", "--start", "5,10", "--scenario", "goal.toml", "--set", &layer], "layer.hazard has a cost"),
        (&["sites", "level.asc", "--every", "8", "--scenario", "goal.toml", "--set", &layer], "layer.hazard has a cost"),
        (&["plan", "goal.toml", "--set", &layer, "--set", "terrain.route=transect"], "free routes of hops alone"),
        (&["plan", "goal.toml", "--set", "search.objective=['layer:cold']"], "no layer of that name has a cost"),
        (&["plan", "goal.toml", "--set", &layer, "--front", "hops,layer:cold"], "layer.cold with a cost_per_contact"),
    ];
    for (words, sentence) in maps {
        let ran = desk.run(words);
        assert!(ran.status == 2 && ran.stderr.contains(sentence), "{words:?}: {}", ran.stderr);
    }
    assert!(plan(&["--front", "hops,cold"]).stderr.contains("hops,layer:NAME"));
    let hop = desk.run(&["hop", "level.asc", "--from", "18,10", "--to", "20,10", "--scenario", "goal.toml", "--set", &layer]);
    assert_eq!(hop.status, 0, "{}", hop.stderr);
    assert!(hop.stderr.contains("it is not stated of a hop by itself"), "{}", hop.stderr);
    // What costs an unknown amount is refused under the layer's name; a negative value when the raster is read.
    desk.write("gap.asc", "ncols 2\nnrows 2\nxllcorner -1\nyllcorner -1\ncellsize 10\n1 1\n1 1\n");
    let gap = desk.run(&["plan", "goal.toml", "--set", "layer.hazard={ raster = \"gap.asc\", cost_per_contact = 1 }"]);
    assert!(gap.status == 1 && gap.stderr.contains("layer hazard does not hold at the goal"), "{}{}", gap.stdout, gap.stderr);
    desk.write("less.asc", "ncols 2\nnrows 2\nxllcorner -1\nyllcorner -1\ncellsize 25\n-1 1\n1 1\n");
    let less = desk.run(&["plan", "goal.toml", "--set", "layer.hazard={ raster = \"less.asc\", cost_per_contact = 1 }"]);
    assert!(less.status == 2 && less.stderr.contains("row 1, column 1 has -1"), "{}", less.stderr);
}

/// A row of a trade is the plan of its value, whatever the first value was.
#[test]
fn rows_of_a_trade_over_keys_of_a_layer_are_the_plans_of_their_values() {
    let desk = desk();
    for (vary, keys) in [
        ("layer.hazard.total_max=0:24:5", "cost_per_contact = 2.5, cost_per_m = 2, total_max = 1"),
        ("layer.hazard.cost_per_m=0.5:8.5:5", "cost_per_m = 2, total_max = 13"),
        ("layer.hazard.max=0:3:4", "max = 9"),
        ("layer.hazard.outage_hops_max=0:4:5", "max = 1, outage_hops_max = 1"),
        ("layer.hazard.outage_max_s=0:12:4", "max = 1, outage_max_s = 1"),
    ] {
        let layer = format!("layer.hazard={{ raster = \"hazard.asc\", {keys} }}");
        // Where the way around takes more hops than the way across.
        let scene = ["goal.toml", "--set", "terrain.start_m=[15, 3]", "--set", "terrain.goal_m=[25, 3]", "--set", &layer];
        let trade = desk.json(&[&["trade"], &scene[..], &["--vary", vary]].concat());
        let (path, _) = vary.split_once('=').unwrap();
        let rows = trade["rows"].as_array().unwrap();
        let mut found = Vec::new();
        for row in rows {
            let value = &row[path];
            let text = if path.ends_with("hops_max") { format!("{}", value.as_f64().unwrap()) } else { value.to_string() };
            let plan = desk.run(&[&["plan"], &scene[..], &["--set", &format!("{path}={text}"), "--format", "json"]].concat());
            assert!(plan.status < 2, "{path} = {text}: {}", plan.stderr);
            let plan: Value = serde_json::from_str(&plan.stdout).unwrap();
            assert_eq!(row["hops"], plan["hops"], "{path} = {text}: {row}");
            found.push(plan["hops"].clone());
        }
        assert!(found.iter().any(|hops| *hops != found[0]), "{vary} changes nothing: {found:?}");
    }
    let refused = desk.run(&["trade", "goal.toml", "--set", &set(""), "--vary", "layer.hazard.raster=0:1:2"]);
    assert!(refused.status == 2 && refused.stderr.contains("layer.hazard.raster: takes"), "{}", refused.stderr);
}
