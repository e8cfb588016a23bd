//! The exit status of every command, as `docs/command_line.md` has it.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{fs, path::Path};

use crate::desk::{ACROSS, Desk, FOUR_LEGS};

/// A command that ends with 0, and one that ends with 1.
type Case = (&'static str, &'static [&'static str], Option<&'static [&'static str]>);

const CASES: [Case; 21] = [
    ("run", &["run", "scenario.toml", "-o", "out"], Some(&["run", "slippery.toml", "-o", "out"])),
    ("slice", &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"], None),
    ("fan", &["fan", "ground.tif", "--from", "9,9", "--headings", "4", "--length", "5", "--scenario", "map.toml"], None),
    (
        "map",
        &["map", "ground.tif", "--start", "5,5", "--goal", "9,9", "--scenario", "map.toml"],
        Some(&["map", "ground.tif", "--start", "5,5", "--goal", "15,15", "--scenario", "weak_map.toml"]),
    ),
    (
        "sites",
        &["sites", "ground.tif", "--every", "6", "--target", "9,9", "--scenario", "map.toml"],
        Some(&["sites", "ground.tif", "--every", "19", "--target", "9,9", "--scenario", "weak_map.toml", "--require-all"]),
    ),
    ("hop", &["hop", "scenario.toml", "--to", "10"], Some(&["hop", "slippery.toml"])),
    ("check", &["check", "scenario.toml"], Some(&["check", "slippery.toml", "--pairs", "pairs.csv"])),
    ("plan", &["plan", "scenario.toml"], Some(&["plan", "slippery.toml"])),
    (
        "require",
        &["require", "scenario.toml", "--vary", "surface.friction_coefficient"],
        Some(&["require", "slippery.toml", "--vary", "hopper.takeoff_speed_max_m_s"]),
    ),
    (
        "trade",
        &["trade", "slippery.toml", "--vary", "surface.friction_coefficient=0.05:0.06:2"],
        Some(&["trade", "slippery.toml", "--vary", "surface.friction_coefficient=0.05:0.6:2", "--require-all"]),
    ),
    (
        "compare",
        &["compare", "scenario.toml", "slippery.toml"],
        Some(&["compare", "scenario.toml", "slippery.toml", "--require-all"]),
    ),
    ("report", &["report", "result.json", "-o", "page.html"], None),
    ("simulate", &["simulate", "trials.toml"], Some(&["simulate", "slippery.toml"])),
    ("batch", &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts"], None),
    (
        "stance",
        &["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--scenario", "map.toml"],
        Some(&["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--scenario", "map.toml", "--height-m", "9"]),
    ),
    ("arena", &["arena", "arena.toml"], Some(&["arena", "arena.toml", "--no-jump"])),
    ("synth", &["synth", "--rows", "9", "--cols", "9", "-o", "new.tif"], None),
    ("bodies", &["bodies"], None),
    ("completions", &["completions", "zsh"], None),
    ("man", &["man", "-o", "pages"], None),
    ("schema", &["schema", "plan"], None),
];

#[test]
fn every_command_ends_with_the_status_of_the_documents() {
    let document = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/command_line.md")).unwrap();
    let rows = document.lines().filter_map(|line| line.strip_prefix("| `")).map(|row| {
        let (command, cells) = row.split_once("` | ").unwrap();
        (command, !cells.ends_with("| - |"))
    });
    assert_eq!(rows.collect::<Vec<_>>(), CASES.map(|(command, _, no)| (command, no.is_some())), "the table has other rows");
    let trials = "\n[uncertainty]\ntakeoff_angle_sigma_deg = 0.5\ntrials = 20\n";
    for (command, yes, no) in CASES {
        let desk = Desk::with_dem();
        desk.write("trials.toml", desk.read("scenario.toml") + trials);
        desk.write("slippery.toml", desk.read("scenario.toml").replace("= 0.6", "= 0.05") + trials);
        desk.write("weak_map.toml", desk.read("map.toml").replace("= 6.0", "= 0.3"));
        desk.write("arena.toml", ACROSS);
        desk.write_legs("four_legs.toml", FOUR_LEGS);
        desk.write("cases.csv", "hopper.takeoff_speed_max_m_s\n6\n-1\n");
        desk.write("pairs.csv", "start_x_m,goal_x_m\n10,40\n40,0\n");
        desk.write("result.json", desk.json(&["plan", "scenario.toml"]).to_string());
        for (status, words) in [(0, Some(yes)), (1, no)] {
            let Some(words) = words else { continue };
            let ran = desk.run(words);
            assert_eq!((ran.status, ran.stderr.contains("error: ")), (status, false), "{words:?}: {}", ran.stderr);
        }
        // Bad input: an option that no command has, and where there is an input, one that is absent.
        let mut bad = vec![[yes, &["--no-such-option"]].concat()];
        if let Some(at) =
            yes.iter().position(|word| [".toml", ".tif", ".json"].iter().any(|end| word.ends_with(end)) && *word != "new.tif")
        {
            let mut absent = yes.to_vec();
            absent[at] = "absent.toml";
            bad.push(absent);
        }
        for words in bad {
            let ran = desk.run(&words);
            assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{command}: {words:?}");
            assert!(ran.stderr.starts_with("error: "), "{words:?}: {ran:?}");
        }
    }
}
