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

#[test]
fn a_file_that_changes_has_its_cases_answered_anew() {
    let desk = Desk::new();
    desk.write("cases.csv", cases(10));
    assert_eq!(batch(&desk, &["-o", "parts", "--collect", "first.csv"]).0, 0);
    let text = desk.read("scenario.toml");
    let chain = text.lines().find_map(|line| line.strip_prefix("chain = ")).expect("a chain").trim_matches('"').to_owned();
    // The same chain with a comment: another content, and the same answers under other keys.
    desk.write(&chain, format!("# measured again\n{}", desk.read(&chain)));
    let (_, said, _) = batch(&desk, &["-o", "parts", "--resume", "--collect", "second.csv"]);
    assert!(said.contains("kept from earlier: 0\n"), "{said}");
    assert!(desk.read("first.csv") != desk.read("second.csv"));
    let (_, said, _) = batch(&desk, &["-o", "parts", "--resume"]);
    assert!(said.contains("kept from earlier: 9\n"), "{said}");
}

#[cfg(not(feature = "parquet"))]
#[test]
fn parquet_is_refused_in_a_build_without_it() {
    let desk = Desk::new();
    desk.write("cases.csv", cases(4));
    for words in [&["-o", "parts", "--parts", "parquet"][..], &["-o", "parts", "--collect", "all.parquet"]] {
        let (status, _, errors) = batch(&desk, words);
        assert!(status == 2 && errors.contains("--features parquet"), "{errors}");
    }
    desk.write("cases.csv", "PAR1 and more");
    let (status, _, errors) = batch(&desk, &["-o", "parts"]);
    assert!(status == 2 && errors.contains("give the cases as CSV"), "{errors}");
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_has_the_rows_of_the_table() {
    use chta::report::read_parquet;
    let desk = Desk::new();
    desk.write("cases.csv", cases(60));
    let collect = ["--collect", "all.parquet"];
    let (status, said, errors) = batch(&desk, &[&["-o", "parquet", "--parts", "parquet"][..], &collect].concat());
    assert_eq!((status, errors.as_str()), (0, ""), "{said}");
    assert_eq!(batch(&desk, &["-o", "csv", "--collect", "all.csv"]).0, 0);
    let read = |name: &str| read_parquet(fs::File::open(desk.path().join(name)).unwrap()).unwrap();
    let (columns, all) = read("all.parquet");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(desk.path().join("all.csv")).unwrap();
    assert!(reader.headers().unwrap().iter().eq(columns.iter().map(String::as_str)));
    let place = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let speed = place("hopper.takeoff_speed_max_m_s");
    for (row, record) in all.iter().zip(reader.records().map(Result::unwrap)) {
        for (number, cell) in row.iter().enumerate() {
            // A number of a key is written as numbers are.
            let same = if number == speed { cell.parse::<f64>() == record[number].parse() } else { *cell == record[number] };
            assert!(same, "{}: {cell} {}", columns[number], &record[number]);
        }
    }
    assert_eq!(all.len(), 60);
    let of_parts: Vec<_> = parts(&desk.path().join("parquet")).iter().flat_map(|part| read(part.to_str().unwrap()).1).collect();
    assert_eq!(of_parts, all);
    // Parquet of cases has the answers of its CSV, and parts of either format are gone on with.
    fs::rename(desk.path().join("all.csv"), desk.path().join("kept.csv")).unwrap();
    let more = ["--resume", "--collect", "again.csv"];
    let (_, said, _) = batch(&desk, &[&["-o", "parquet"][..], &more].concat());
    assert!(said.contains("kept from earlier: 59\n"), "{said}");
    assert!(desk.read("again.csv") == desk.read("kept.csv"));
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_states_version_and_units_and_is_taken_as_cases() {
    use chta::report::{CellKind, TableColumn, write_parquet};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let desk = Desk::new();
    let columns = [("hopper.takeoff_speed_max_m_s", CellKind::Number), ("search.points_per_segment", CellKind::Count)];
    let columns = columns.map(|(name, kind)| TableColumn { name: name.to_owned(), kind });
    let rows = [["6.0", "3"], ["8.0", ""]].map(|row| row.map(str::to_owned).to_vec());
    write_parquet(fs::File::create(desk.path().join("cases.parquet")).unwrap(), &columns, &[], &rows).unwrap();
    desk.write("cases.csv", "hopper.takeoff_speed_max_m_s,search.points_per_segment\n6.0,3\n8.0,\n");
    let words = ["batch", "cases.parquet", "--scenario", "scenario.toml", "-o", "of_parquet", "--collect", "one.parquet"];
    assert_eq!(desk.run(&words).status, 0);
    assert_eq!(batch(&desk, &["-o", "of_csv", "--collect", "two.parquet"]).0, 0);
    let bytes = |name: &str| fs::read(desk.path().join(name)).unwrap();
    assert!(bytes("one.parquet") == bytes("two.parquet"));
    let reader = SerializedFileReader::new(fs::File::open(desk.path().join("one.parquet")).unwrap()).unwrap();
    let words = reader.metadata().file_metadata().key_value_metadata().unwrap().clone();
    let stated = |key: &str| words.iter().find(|word| word.key == key).and_then(|word| word.value.clone()).unwrap_or_default();
    assert_eq!(stated("chta_version"), env!("CARGO_PKG_VERSION"));
    assert!(stated("flight_time_s").ends_with(", s") && stated("hopper.takeoff_speed_max_m_s").contains("m/s"), "{words:?}");
}

#[cfg(unix)]
#[test]
fn a_killed_batch_loses_the_open_part_alone_and_goes_on_to_the_same_bytes() {
    killed_and_resumed("csv");
}

#[cfg(all(unix, feature = "parquet"))]
#[test]
fn a_killed_batch_of_parquet_goes_on_to_the_same_bytes() {
    killed_and_resumed("parquet");
}

/// The rows of a part of either format.
#[cfg(unix)]
fn count_of(part: &Path) -> usize {
    #[cfg(feature = "parquet")]
    if part.extension().is_some_and(|ending| ending == "parquet") {
        return chta::report::read_parquet(fs::File::open(part).unwrap()).unwrap().1.len();
    }
    rows(part).len()
}

#[cfg(unix)]
fn killed_and_resumed(format: &str) {
    const COUNT: usize = 6000;
    let desk = Desk::new();
    desk.write("cases.csv", cases(COUNT));
    let folder = desk.path().join("parts");
    let words = ["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts", "--parts", format, "--threads", "1"];
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
    let kept: usize = left.iter().map(|part| count_of(part)).sum();
    assert!(left.len() >= 3 && kept < COUNT, "{} parts, {kept} rows", left.len());
    let [killed, whole] = ["killed", "whole"].map(|name| format!("{name}.{format}"));
    let (status, said, _) = batch(&desk, &["-o", "parts", "--parts", format, "--resume", "--collect", &killed]);
    assert_eq!(status, 0);
    // All rows of the parts but the refused one are kept.
    assert!(said.contains(&format!("kept from earlier: {}\n", kept - 1)), "{said}");
    assert_eq!(batch(&desk, &["-o", "whole", "--parts", format, "--collect", &whole]).0, 0);
    let bytes = |name: &str| fs::read(desk.path().join(name)).unwrap();
    assert!(bytes(&killed) == bytes(&whole), "the rows differ after a kill");
}
