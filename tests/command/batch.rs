//! `chta batch`: rows do not depend on threads, and a kill costs the open part alone.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use crate::desk::Desk;

/// So many speeds, one of them refused.
fn cases(count: usize) -> String {
    let mut text = "hopper.takeoff_speed_max_m_s,search.points_per_segment\n".to_owned();
    for i in 0..count {
        let speed = 4.0 + 8.0 * f64::from(u32::try_from(i).unwrap()) / f64::from(u32::try_from(count).unwrap());
        let row = if i == 3 { "-1,3\n".to_owned() } else { format!("{speed},{}\n", 3 + i % 4) };
        text.push_str(&row);
    }
    text
}

fn parts(folder: &Path) -> Vec<PathBuf> {
    let Ok(listed) = fs::read_dir(folder) else { return Vec::new() };
    let mut parts: Vec<_> = listed.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some()).collect();
    parts.retain(|path| path.file_name().unwrap().to_string_lossy().starts_with("part-"));
    parts.sort();
    parts
}

/// The rows below the comments and the header.
fn rows(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).unwrap();
    assert!(text.ends_with('\n'), "{} is not whole", file.display());
    text.lines().filter(|line| !line.starts_with('#')).skip(1).map(str::to_owned).collect()
}

fn batch(desk: &Desk, words: &[&str]) -> (i32, String, String) {
    let ran = desk.run(&[&["batch", "cases.csv", "--scenario", "scenario.toml"], words].concat());
    (ran.status, ran.stdout, ran.stderr)
}

#[test]
fn rows_are_plans_and_do_not_depend_on_threads() {
    let desk = Desk::new();
    desk.write("cases.csv", cases(120));
    let (status, said, errors) = batch(&desk, &["-o", "one", "--threads", "1", "--collect", "one.csv"]);
    assert_eq!((status, errors.as_str()), (0, ""));
    assert!(said.contains("cases: 120\n") && said.contains("refused: 1\n") && said.contains("kept from earlier: 0\n"), "{said}");
    assert_eq!(batch(&desk, &["-o", "two", "--threads", "2", "--collect", "two.csv"]).0, 0);
    assert!(desk.read("one.csv") == desk.read("two.csv"), "the rows depend on the threads");
    let all = rows(&desk.path().join("one.csv"));
    assert_eq!(all.len(), 120);
    let of_parts: Vec<_> = parts(&desk.path().join("one")).iter().flat_map(|part| rows(part)).collect();
    assert_eq!(of_parts, all);
    assert!(parts(&desk.path().join("one")).iter().all(|part| rows(part).len() <= 50 + 4));
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(desk.path().join("one.csv")).unwrap();
    let columns = reader.headers().unwrap().clone();
    for (i, record) in reader.records().map(Result::unwrap).enumerate().step_by(7) {
        let value = |name: &str| &record[columns.iter().position(|column| column == name).unwrap()];
        let speed = format!("hopper.takeoff_speed_max_m_s={}", value("hopper.takeoff_speed_max_m_s"));
        let points = format!("search.points_per_segment={}", value("search.points_per_segment"));
        let plan = desk.json(&["plan", "scenario.toml", "--set", &speed, "--set", &points]);
        assert_eq!(plan["verdict"], value("verdict"), "case {i}");
        assert_eq!(plan["hops"].as_u64().map(|hops| hops.to_string()).unwrap_or_default(), value("hops"), "case {i}");
        assert_eq!(value("key").len(), 64);
    }
    let refused: Vec<_> = all.iter().filter(|row| row.contains("line 5")).collect();
    assert!(refused.len() == 1 && refused[0].contains("takeoff_speed_max_m_s is -1"), "{refused:?}");
}

#[test]
fn an_earlier_batch_is_refused_or_goes_on_and_another_scenario_is_answered_anew() {
    let desk = Desk::new();
    desk.write("cases.csv", cases(20));
    assert_eq!(batch(&desk, &["-o", "parts", "--collect", "first.csv"]).0, 0);
    let (status, said, errors) = batch(&desk, &["-o", "parts"]);
    assert!((status, said.as_str()) == (2, "") && errors.contains("go on with it by --resume"), "{errors}");
    let (_, said, _) = batch(&desk, &["-o", "parts", "--resume", "--collect", "second.csv"]);
    // A refused case has no key, and is asked again.
    assert!(said.contains("kept from earlier: 19\n") && said.contains("parts written: 1\n"), "{said}");
    assert!(desk.read("first.csv") == desk.read("second.csv"));
    let (_, said, _) = batch(&desk, &["-o", "parts", "--resume", "--set", "body.name=moon", "--collect", "moon.csv"]);
    assert!(said.contains("kept from earlier: 0\n"), "{said}");
    assert!(desk.read("first.csv") != desk.read("moon.csv"));
    desk.write("cases.csv", "hopper.mass_kg\n3\n");
    let (status, _, errors) = batch(&desk, &["-o", "parts", "--resume"]);
    assert!(status == 2 && errors.contains("found other columns"), "{errors}");
    desk.write("cases.csv", "hopper.mas_kg\n3\n");
    let (status, _, errors) = batch(&desk, &["-o", "new"]);
    assert!(status == 2 && errors.contains("the nearest known key is hopper.mass_kg"), "{errors}");
}

#[cfg(unix)]
#[test]
fn a_killed_batch_loses_the_open_part_alone_and_goes_on_to_the_same_bytes() {
    const COUNT: usize = 6000;
    let desk = Desk::new();
    desk.write("cases.csv", cases(COUNT));
    let folder = desk.path().join("parts");
    let words = ["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts", "--threads", "1"];
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_chta")).current_dir(desk.path()).args(words).stdout(Stdio::null()).spawn().unwrap();
    while parts(&folder).len() < 3 {
        assert!(child.try_wait().unwrap().is_none(), "the batch ended before it was killed");
        thread::sleep(Duration::from_millis(1));
    }
    // SIGKILL: nothing is cleaned up.
    child.kill().unwrap();
    child.wait().unwrap();
    let left = parts(&folder);
    let kept: usize = left.iter().map(|part| rows(part).len()).sum();
    assert!(left.len() >= 3 && kept < COUNT, "{} parts, {kept} rows", left.len());
    let (status, said, _) = batch(&desk, &["-o", "parts", "--resume", "--collect", "killed.csv"]);
    assert_eq!(status, 0);
    // All rows of the parts but the refused one are kept.
    assert!(said.contains(&format!("kept from earlier: {}\n", kept - 1)), "{said}");
    assert_eq!(batch(&desk, &["-o", "whole", "--collect", "whole.csv"]).0, 0);
    assert!(desk.read("killed.csv") == desk.read("whole.csv"), "the rows differ after a kill");
}
