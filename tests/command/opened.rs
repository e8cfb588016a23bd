//! Scenarios opened in the library (`study::open`) give the documents of the command, for every shipped scenario.

#![allow(clippy::unwrap_used, reason = "a test that cannot run the program should stop")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use chta::{
    quantity::MapPoint,
    study::{
        Requirement, SimulateOptions, SweptKey,
        open::{AskError, Draft, HopAsked, MapAsked, PlanAsked, Reply, SitesAsked, Wording},
    },
};

use crate::desk::chta;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The shipped scenarios, by their paths from the root.
fn shipped() -> Vec<String> {
    let folders = ["scenarios", "mesh_scenarios", "drive", "missions"].map(|folder| root().join("data").join(folder));
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = files
        .filter(|file| file.extension().is_some_and(|ending| ending == "toml"))
        .map(|file| file.strip_prefix(root()).unwrap().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert!(names.len() >= 20, "{names:?}");
    names
}

/// A scenario, opened as the command opens it.
fn opened(name: &str) -> Draft {
    let of_map = "--goal, --effort, --amount-output or --simulate";
    Draft { wording: Wording { question: "command", of_map, ..Wording::default() }, ..Draft::read(Path::new(name)).unwrap() }
}

/// Compares a reply with what the command says.
fn same(words: &[&str], reply: Result<Reply, AskError>) {
    let (status, said, errors) = chta(root(), &[words, &["--format", "json", "--quiet"]].concat());
    match reply {
        Ok(reply) => {
            assert!(said == reply.json, "{words:?}: the documents differ; {errors}");
            assert_eq!(status, i32::from(!reply.holds), "{words:?}");
        }
        Err(error) => assert_eq!(status, 2, "{words:?}: {error}; {errors}"),
    }
}

/// Roadmaps over meshes take seconds with the contacts that scenarios ask for, and tenths of one with these, which still find paths.
const FEW_CONTACTS: &str = "search.contacts_max=100";

/// A scenario, opened, with the words that give the command the same; over meshes with [`FEW_CONTACTS`].
fn quick(name: &str) -> (Draft, Vec<&str>) {
    let mut draft = opened(name);
    if !name.contains("mesh_scenarios") {
        return (draft, vec![name]);
    }
    draft.entries.set("--set", FEW_CONTACTS);
    (draft, vec![name, "--set", FEW_CONTACTS])
}

#[test]
fn plans_and_trials_of_every_shipped_scenario_are_those_of_the_command() {
    for name in shipped() {
        let (mut draft, words) = quick(&name);
        same(&[&["plan"], &words[..]].concat(), draft.plan(&PlanAsked::default(), &()));
        draft.entries.set_by_option("--trials", "uncertainty", "trials", 20.into());
        same(&[&["simulate"], &words[..], &["--trials", "20"]].concat(), draft.simulate(&SimulateOptions::default(), &()));
    }
}

#[test]
fn checks_and_hops_of_every_shipped_scenario_are_those_of_the_command() {
    for name in shipped().into_iter().filter(|name| !name.contains("mesh_scenarios")) {
        let draft = opened(&name);
        same(&["check", &name], draft.check(None, &()));
        same(&["hop", &name], draft.hop(&HopAsked::default()));
    }
}

#[test]
fn maps_sites_and_varied_keys_are_those_of_the_command() {
    let rille = "data/scenarios/lunar_rille.toml";
    let asked = MapAsked { stride: 8, returns: true, ..MapAsked::default() };
    same(&["map", rille, "--stride", "8", "--return"], opened(rille).map_hops(&asked, &()).map(|map| map.reply));
    let dem = "data/terrain/lunar_rille.tif";
    let asked =
        MapAsked { dem: Some(PathBuf::from(dem)), starts_m: vec![MapPoint::new(60.0, 60.0)], stride: 8, ..MapAsked::default() };
    let words = ["map", dem, "--scenario", rille, "--start", "60,60", "--stride", "8"];
    same(&words, opened(rille).map_hops(&asked, &()).map(|map| map.reply));
    let asked = SitesAsked { stride: 16, every: 4, ..SitesAsked::default() };
    same(&["sites", rille, "--stride", "16", "--every", "4", "--require-all"], opened(rille).sites(&asked, &()));
    let (simple, key) = ("data/scenarios/simple_reduced.toml", "hopper.takeoff_speed_max_m_s");
    let requirement = Requirement::new(key, [None, None], 0.001, 4000, "vary").unwrap();
    let cells = ["require", simple, "--vary", key, "--prove-cells-max", "4000"];
    same(&cells, opened(simple).require(&requirement, &()));
    let swept = [SweptKey::parse(&format!("{key}=2:6:5")).unwrap()];
    same(&["trade", simple, "--vary", &format!("{key}=2:6:5"), "--require-all"], opened(simple).trade(&swept, None, &()));
}

#[test]
fn runs_are_those_of_the_command() {
    for name in ["data/scenarios/rolling_surely.toml", "data/scenarios/wall.toml", "data/mesh_scenarios/cave.toml"] {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().to_string_lossy().into_owned();
        let (draft, words) = quick(name);
        let ran = draft.run(&()).unwrap();
        same(&[&["run"], &words[..], &["-o", &output]].concat(), Ok(ran.plan));
        let trials = fs::read_to_string(folder.path().join("simulation.json")).ok();
        assert_eq!(ran.trials.map(|trials| trials.json), trials, "{name}");
    }
}

#[test]
fn what_has_no_meaning_is_refused_and_not_left_out() {
    let front = chta::study::Front::all().find(|front| front.name() == "hops,energy");
    let targets = opened("data/missions/lunar_rille_targets.toml").plan(&PlanAsked { front, ..PlanAsked::default() }, &());
    assert!(targets.unwrap_err().to_string().starts_with("found a front"));
    let alone = opened("data/scenarios/simple.toml").plan(&PlanAsked { alternatives: true, ..PlanAsked::default() }, &());
    assert!(alone.unwrap_err().to_string().contains("this scenario does not drive"));
    let asked = MapAsked { mobility: true, ..MapAsked::default() };
    let mesh = opened("data/mesh_scenarios/cave.toml").map_hops(&asked, &());
    assert!(mesh.unwrap_err().to_string().starts_with("found a mobility"));
}
