//! `chta report` and `run --report`: the documents stand in the page unchanged, and what does not belong together is refused.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use serde_json::Value;

use crate::desk::{Desk, FOUR_LEGS, chta};

/// Errors for trials.
const ERRORS: &str = "\n[uncertainty]\ntakeoff_angle_sigma_deg = 0.5\ntrials = 20\n";

/// The texts of the scripts of a page that begin like this.
fn scripts<'a>(page: &'a str, open: &str) -> Vec<&'a str> {
    let parts = page.split(open).skip(1);
    parts.map(|part| part.split_once('>').unwrap().1.split("</script>").next().unwrap()).collect()
}

/// The documents of a page, by the names under which it saves them.
fn documents(page: &str) -> Vec<(String, Value)> {
    let open = "<script type=\"application/json\" class=\"answer\" data-name=\"";
    let names = page.split(open).skip(1).map(|part| part.split('"').next().unwrap().to_owned());
    names.zip(scripts(page, open)).map(|(name, text)| (name, serde_json::from_str(text).unwrap())).collect()
}

fn ground(page: &str) -> Value {
    serde_json::from_str(scripts(page, "<script type=\"application/json\" id=\"ground\"")[0]).unwrap()
}

fn value(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_run_and_its_documents_make_the_same_page() {
    let desk = Desk::with_dem();
    let title = "[report]\ntitle = \"a </script> & <b>\"\n\n";
    desk.write("errors.toml", title.to_owned() + &desk.read("map.toml") + ERRORS);
    let ran = desk.run(&["run", "errors.toml", "-o", "out", "--report", "out/page.html"]);
    assert_eq!((ran.status, ran.stderr.contains("error: ")), (0, false), "{ran:?}");
    let ran = desk.run(&["report", "out/simulation.json", "out/result.json", "-o", "again.html"]);
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{ran:?}");
    let page = desk.read("out/page.html");
    assert_eq!(ran.stdout, format!("written to again.html: a page of {} bytes\n", page.len()));
    assert!(page == desk.read("again.html"), "the order of the documents changes the page");
    let expected = ["result.json", "simulation.json"].map(|name| (name.to_owned(), value(&desk.read(&format!("out/{name}")))));
    assert_eq!(documents(&page), expected);
    let ground = ground(&page);
    let posts = &ground["posts"];
    assert_eq!((&posts["rows"], &posts["columns"], &posts["stride"]), (&20.into(), &20.into(), &1.into()));
    // The profile is that of the chain.
    let rows: Vec<Vec<f64>> = desk
        .read("out/chain.csv")
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit() || c == '-'))
        .map(|line| line.split(',').take(2).map(|number| number.parse().unwrap()).collect())
        .collect();
    for (key, column) in [("x_m", 0), ("z_m", 1)] {
        let drawn: Vec<f64> = ground["pieces"][0][key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        assert_eq!(drawn.len(), rows.len());
        assert!(drawn.iter().zip(&rows).all(|(drawn, row)| (drawn - row[column]).abs() <= 0.51e-4), "{key}");
    }
    let to_stdout = desk.run(&["report", "out/result.json", "out/simulation.json", "-o", "-"]);
    assert!(to_stdout.stdout == page);
}

#[test]
fn every_kind_of_answer_with_a_path_has_a_page() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [plan, page] = ["plan.json", "page.html"].map(file);
    for (words, has) in [
        (&["data/scenarios/paper_76m.toml"][..], "pieces"),
        (&["data/scenarios/wall.toml"], "pieces"),
        (&["data/scenarios/simple_mesh.toml"], "pieces"),
        (&["data/scenarios/lunar_rille_free.toml"], "posts"),
        (&["data/missions/lunar_rille_targets.toml"], "posts"),
        (&["data/drive/mars_rover.toml"], "posts"),
        (&["data/mesh_scenarios/overhang.toml", "--set", "search.contacts_max=300"], "facets"),
        (&["data/mesh_scenarios/three_legs.toml", "--set", "search.contacts_max=60"], "facets"),
        (&["data/mesh_scenarios/mars_four_legs.toml", "--set", "search.contacts_max=20"], "posts"),
    ] {
        let (status, text, stderr) = chta(root, &[&["plan"], words, &["--quiet", "--format", "json"]].concat());
        assert!(status < 2, "{words:?}: {stderr}");
        std::fs::write(&plan, &text).unwrap();
        let (status, _, stderr) = chta(root, &["report", &plan, "-o", &page]);
        assert_eq!((status, stderr.as_str()), (0, ""), "{words:?}");
        let written = std::fs::read_to_string(&page).unwrap();
        assert_eq!(documents(&written), [("result.json".to_owned(), value(&text))], "{words:?}");
        let ground = ground(&written);
        assert!(!ground[has].is_null(), "{words:?} has no {has}");
        // A hop over a map or a mesh has its ground; of drives the pieces follow the waypoints.
        let legs = value(&text)["path"].as_array().unwrap().len();
        let under = ground["pieces"].as_array().or_else(|| ground["cuts"].as_array()).map_or(0, Vec::len);
        assert!(under >= 1.min(legs), "{words:?}: {under} pieces of ground for {legs} legs");
        assert!(written.len() < 1_500_000, "{words:?}: {} bytes", written.len());
    }
}

#[test]
fn what_does_not_belong_together_is_refused_and_nothing_is_written() {
    let desk = Desk::with_dem();
    desk.write("errors.toml", desk.read("scenario.toml") + ERRORS);
    desk.write("four_legs.toml", FOUR_LEGS);
    let save = |name: &str, words: &[&str]| desk.write(name, desk.json(words).to_string());
    save("plan.json", &["plan", "errors.toml"]);
    save("other.json", &["simulate", "errors.toml", "--set", "body.name=moon"]);
    save("trials.json", &["simulate", "errors.toml", "--trials", "7"]);
    save("trade.json", &["trade", "errors.toml", "--vary", "surface.friction_coefficient=0.3:0.9:3"]);
    save("sensitivity.json", &["simulate", "errors.toml", "--experiment", "sensitivity", "--trials", "5"]);
    save("drift.json", &["simulate", "errors.toml", "--experiment", "worst-drift"]);
    save("on_map.json", &["plan", "map.toml"]);
    save("hop.json", &["hop", "scenario.toml"]);
    let together = ["report", "trade.json", "plan.json", "sensitivity.json", "trials.json", "-o", "page.html"];
    assert_eq!(desk.run(&together).status, 0);
    let names: Vec<String> = documents(&desk.read("page.html")).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["result.json", "simulation.json", "sensitivity.json", "trade.json"]);
    std::fs::remove_file(desk.path().join("page.html")).unwrap();
    for (words, parts) in [
        (&["plan.json", "other.json"][..], &["other.json", "body.", "expected one scenario"][..]),
        (&["plan.json", "on_map.json"], &["on_map.json", "second document", "result.json"]),
        (&["trials.json", "plan.json", "hop.json"], &["hop.json", "chta/hop/1", "expected one with a path"]),
        (&["drift.json", "plan.json"], &["drift.json", "chta/simulate-experiment/1"]),
        (&["trade.json"], &["no document with a path"]),
        (&["on_map.json", "trade.json"], &["trade.json", "inputs"]),
        (&["scenario.toml"], &["scenario (TOML)", "expected a result (JSON)", "chta run scenario.toml -o out"]),
        (&["absent.json"], &["absent.json"]),
    ] {
        desk.refused(&[&["report"], words, &["-o", "page.html"]].concat(), parts);
    }
    desk.refused(&["report", "plan.json", "-o", "page.pdf"], &["-o page.pdf", "ends in .html"]);
    desk.refused(&["run", "scenario.toml", "-o", "out", "--report", "page.svg"], &["--report page.svg", "ends in .html"]);
    desk.refused(&["report", "plan.json", "-o", "no/such/page.html"], &["cannot be written"]);
    // Another path under the same scenario.
    let (mut other, plan) = (value(&desk.read("trials.json")), value(&desk.read("plan.json")));
    assert!(plan["path"].as_array().is_some_and(|path| !path.is_empty()));
    other["path"][0]["takeoff_speed_m_s"] = 1.0.into();
    desk.write("bent.json", other.to_string());
    desk.refused(&["report", "plan.json", "bent.json", "-o", "page.html"], &["bent.json", "not that of the plan"]);
    // The chain is another one than that of the answer.
    desk.write("chain.csv", desk.read("chain.csv").replace("10,2", "10,2.5"));
    desk.refused(&["report", "plan.json", "-o", "page.html"], &["chain.csv", "SHA-256", "give that file"]);
    assert!(!desk.path().join("page.html").exists());
}

/// The example of README is the page of its command, byte by byte.
#[test]
fn the_example_page_is_that_of_its_command() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let command = "chta run data/scenarios/lunar_rille_free.toml -o out --report docs/lunar_rille_free.html";
    assert!(readme.contains(command) && readme.contains("](docs/lunar_rille_free.html)"), "README does not state the command");
    let folder = tempfile::tempdir().unwrap();
    let (out, page) = (folder.path().join("out"), folder.path().join("page.html"));
    let words: Vec<&str> = command.split(' ').skip(1).collect();
    let place = |word: &str| match word {
        "out" => out.to_str().unwrap().to_owned(),
        "docs/lunar_rille_free.html" => page.to_str().unwrap().to_owned(),
        word => word.to_owned(),
    };
    let words: Vec<String> = words.into_iter().map(place).collect();
    let (status, _, stderr) = chta(root, &words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(status, 0, "{stderr}");
    let [made, kept] = [&page, &root.join("docs/lunar_rille_free.html")].map(|file| std::fs::read(file).unwrap());
    assert!(made.len() < 1_000_000, "{} bytes", made.len());
    assert!(made == kept, "docs/lunar_rille_free.html is not what its command writes: run it again");
}
