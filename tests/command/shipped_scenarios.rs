//! The shipped scenarios: their answers, their terrain from its own command, and the figures that plots/ holds.

#![allow(clippy::unwrap_used, reason = "a test that cannot run the program should stop")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use assert_cmd::Command;
use serde_json::Value;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn chta(arguments: &[&str]) -> std::process::Output {
    Command::cargo_bin("chta").unwrap().current_dir(root()).args(arguments).output().unwrap()
}

/// Scenario, exit status, hops.
const ANSWERS: [(&str, i32, Option<u64>); 16] = [
    ("mars_crater_field", 0, Some(9)),
    ("lunar_rille", 0, Some(27)),
    ("lunar_rille_free", 0, Some(25)),
    ("lunar_rille_too_steep", 1, None),
    ("mars_crater_field_surely", 0, Some(8)),
    ("paper_76m", 0, Some(4)),
    ("rolling_surely", 0, Some(8)),
    ("simple", 0, Some(1)),
    ("simple_mesh", 0, Some(1)),
    ("simple_reduced", 0, Some(5)),
    ("wall", 1, None),
    ("cliff", 1, None),
    ("vertices", 1, None),
    ("lunar_hopper", 0, Some(5)),
    ("mars_frogbot", 0, Some(11)),
    ("ryugu_hopper", 0, Some(7)),
];

/// Scenario, bounds on its fewest hops; all of them are equal.
const PROVED: [(&str, Option<u64>); 13] = [
    ("mars_crater_field", Some(8)),
    ("lunar_rille", Some(26)),
    ("lunar_rille_too_steep", None),
    ("paper_76m", Some(4)),
    ("simple", Some(1)),
    ("simple_mesh", Some(1)),
    ("simple_reduced", Some(3)),
    ("wall", None),
    ("cliff", None),
    ("vertices", None),
    ("lunar_hopper", Some(5)),
    ("mars_frogbot", Some(10)),
    ("ryugu_hopper", Some(7)),
];

/// Editors look the schema up beside the file; to the reader of scenarios the line is a comment.
#[test]
fn every_shipped_scenario_names_its_schema() {
    for (name, ..) in ANSWERS {
        let text = fs::read_to_string(root().join(format!("data/scenarios/{name}.toml"))).unwrap();
        let schema = text.lines().next().unwrap().strip_prefix("#:schema ").unwrap_or_else(|| panic!("{name} names no schema"));
        assert_eq!(schema, "../../docs/schema/scenario.json", "{name}");
    }
    assert_eq!(ANSWERS.len(), fs::read_dir(root().join("data/scenarios")).unwrap().count(), "a scenario is not listed");
}

#[test]
fn every_shipped_scenario_is_proved() {
    for (name, hops) in PROVED {
        let output = chta(&["check", &format!("data/scenarios/{name}.toml"), "--prove", "--format", "json"]);
        let result: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(i32::from(hops.is_none())), "{name}");
        assert_eq!(result["proved"], true, "{name}");
        assert_eq!((result["lower_bound"].as_u64(), result["upper_bound"].as_u64()), (hops, hops), "{name}");
        let verdict = if hops.is_some() { "traversable" } else { "untraversable" };
        assert_eq!(result["verdict"], verdict, "{name}");
    }
}

/// For each of three journeys proved impossible, the one limit without which there is a path, and how to remove it.
#[test]
fn one_limit_alone_stops_each_of_three_journeys() {
    let without = [
        ("wall", "hopper.clearance_m=0", "data/chains/wall.csv", "8.0", "7.0"),
        ("cliff", "hopper.landing_speed_max_m_s=12", "", "", ""),
        ("vertices", "hopper.clearance_m=0", "data/chains/vertices.csv", "70.0,85.0", "30.0,85.0"),
        ("vertices", "hopper.clearance_m=0", "data/chains/vertices.csv", "-40.0,-5.0", "-85.0,-5.0"),
    ];
    for (name, set, chain, found, instead) in without {
        let folder = tempfile::tempdir().unwrap();
        let scenario = root().join(format!("data/scenarios/{name}.toml"));
        let mut text = fs::read_to_string(&scenario).unwrap();
        let changed = folder.path().join("chain.csv");
        fs::write(&changed, fs::read_to_string(root().join(format!("data/chains/{name}.csv"))).unwrap()).unwrap();
        if !chain.is_empty() {
            fs::write(&changed, fs::read_to_string(root().join(chain)).unwrap().replace(found, instead)).unwrap();
        }
        text = text.replace(&format!("../chains/{name}.csv"), "chain.csv");
        let scenario = folder.path().join("scenario.toml");
        fs::write(&scenario, text).unwrap();
        let scenario = scenario.to_str().unwrap();
        assert_eq!(chta(&["check", scenario, "--prove", "--set", set]).status.code(), Some(0), "{name} without its limit");
    }
}

#[test]
fn every_shipped_scenario_runs_to_its_answer_and_repeats_from_its_result() {
    for (name, status, hops) in ANSWERS {
        let folder = tempfile::tempdir().unwrap();
        let (first, again) = (folder.path().join("first"), folder.path().join("again"));
        let scenario = format!("data/scenarios/{name}.toml");
        let output = chta(&["run", &scenario, "-o", first.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(status), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let result: Value = serde_json::from_slice(&fs::read(first.join("result.json")).unwrap()).unwrap();
        assert_eq!(result["hops"].as_u64(), hops, "{name}");

        let output = chta(&["run", first.join("result.json").to_str().unwrap(), "-o", again.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(status), "{name}, repeated: {}", String::from_utf8_lossy(&output.stderr));
        for file in fs::read_dir(&first).unwrap() {
            let file = file.unwrap().file_name();
            let same = fs::read(first.join(&file)).unwrap() == fs::read(again.join(&file)).unwrap();
            assert!(same, "{name}: {} differs when repeated from the result", file.display());
        }
    }
}

/// The three scenarios after published machines: the warnings that they deserve.
#[test]
fn the_scenarios_of_real_machines_warn_of_what_the_model_does_not_know() {
    for (name, warnings) in [
        ("lunar_hopper", &["farther than hopper.footprint_m of 0.762 m"][..]),
        ("mars_frogbot", &[]),
        ("ryugu_hopper", &["a hop's range", "a hop's highest point", "a hop's speed", "constant gravity is a bad model"]),
    ] {
        let output = chta(&["plan", &format!("data/scenarios/{name}.toml"), "--verify"]);
        assert_eq!(output.status.code(), Some(0), "{name}");
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(stderr.is_empty(), warnings.is_empty(), "{name}: {stderr}");
        for warning in warnings {
            assert!(stderr.contains(warning), "{name} does not warn of {warning:?}: {stderr}");
        }
    }
}

#[test]
fn every_shipped_scenario_has_an_answer_in_this_test() {
    for file in fs::read_dir(root().join("data/scenarios")).unwrap() {
        let path = file.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(ANSWERS.iter().any(|(known, _, _)| *known == name), "{name} has no answer in this test");
    }
}

/// The commands of a document that begin with `chta`, without their continuation marks.
fn commands(document: &str) -> Vec<String> {
    let joined = fs::read_to_string(root().join(document)).unwrap().replace("\\\n", " ");
    joined.lines().filter(|line| line.starts_with("chta ")).map(str::to_owned).collect()
}

#[test]
fn the_shipped_terrain_is_what_its_commands_make() {
    let mut made = 0;
    for command in commands("data/README.md").iter().filter(|command| command.starts_with("chta synth")) {
        let words: Vec<&str> = command.split_whitespace().skip(1).collect();
        let shipped = Path::new(words.last().unwrap());
        let folder = tempfile::tempdir().unwrap();
        let remade = folder.path().join(shipped.file_name().unwrap());
        let mut arguments = words[..words.len() - 1].to_vec();
        arguments.push(remade.to_str().unwrap());
        let output = chta(&arguments);
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(
            fs::read(root().join(shipped)).unwrap() == fs::read(&remade).unwrap(),
            "{} is not what `{command}` makes",
            shipped.display()
        );
        made += 1;
    }
    assert!(made >= 2, "data/README.md has {made} commands");
}

#[test]
fn the_figures_in_plots_are_what_their_commands_draw() {
    let mut drawn = 0;
    for command in commands("plots/README.md") {
        let words: Vec<&str> = command.split_whitespace().skip(1).collect();
        let place = words.iter().position(|word| word.starts_with("--plot")).expect("a command that draws") + 1;
        let shipped = words[place];
        let folder = tempfile::tempdir().unwrap();
        let redrawn = folder.path().join("figure.svg");
        let mut arguments = words.clone();
        arguments[place] = redrawn.to_str().unwrap();
        let output = chta(&arguments);
        assert!(matches!(output.status.code(), Some(0 | 1)), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(fs::read(root().join(shipped)).unwrap() == fs::read(&redrawn).unwrap(), "{shipped} is not what `{command}` draws");
        for number in 2.. {
            let page = shipped.replace(".svg", &format!("-{number}.svg"));
            let (kept, redrawn) =
                (fs::read(root().join(&page)).ok(), fs::read(folder.path().join(format!("figure-{number}.svg"))).ok());
            assert!(kept == redrawn, "{page} is not what `{command}` draws");
            if kept.is_none() {
                break;
            }
        }
        drawn += 1;
    }
    assert!(drawn >= 5, "plots/README.md has {drawn} commands");
}
