//! The commands of the guide, run as they stand.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use crate::desk::shell;

/// The commands of a document: the lines of its console blocks that begin with a prompt.
fn commands(document: &str) -> Vec<String> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(document)).unwrap();
    text.lines().filter_map(|line| line.strip_prefix("$ ")).map(str::to_owned).collect()
}

fn run(folder: &Path, command: &str) -> String {
    let program = format!("chta() {{ '{}' \"$@\"; }}", env!("CARGO_BIN_EXE_chta"));
    shell(folder, &format!("{program}; {command}"))
}

/// The costs of assumptions are those that the commands beside them give, and the table has the same numbers.
#[test]
fn the_stated_costs_of_assumptions_are_measured() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/assumptions.md")).unwrap();
    let table: String = text.lines().filter(|line| line.starts_with('|')).collect();
    let mut checked = 0;
    let (mut command, mut answer) = ("", String::new());
    for line in text.split("```console\n").skip(1).flat_map(|block| block.split("```").next().unwrap_or("").lines()) {
        if let Some(next) = line.strip_prefix("$ ") {
            (command, answer) = (
                next,
                run(Path::new(env!("CARGO_MANIFEST_DIR")), &format!("{next} --quiet").replace("|| true --quiet", "|| true")),
            );
        } else {
            assert!(answer.contains(line), "{command}: expected \"{line}\" in\n{answer}");
            let number: Vec<&str> = line.split_whitespace().collect();
            if command.contains("lunar_rille.toml") && line.starts_with("at most") {
                assert!(table.contains(&format!("| {} |", number[2])), "no row has the {} hops of {command}", number[2]);
            } else if let Some(energy) = line.strip_prefix("sum of energies per unit mass: ") {
                let energy: f64 = energy.trim_end_matches(" J/kg").parse().unwrap();
                assert!(table.contains(&format!("| {energy:.1} |")), "no row has the {energy} J/kg of {command}");
            }
            checked += 1;
        }
    }
    assert!(checked >= 20, "only {checked} lines");
}

#[test]
fn the_commands_of_the_guide_run() {
    for (document, least, page) in [("docs/guide/site_survey.md", 9, "out/decision.html"), ("docs/report.md", 4, "out/all.html")] {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(Path::new(env!("CARGO_MANIFEST_DIR")).join("data"), folder.path().join("data")).unwrap();
        let commands = commands(document);
        assert!(commands.len() >= least, "{document}: {commands:?}");
        for command in commands {
            run(folder.path(), &command);
        }
        assert!(folder.path().join(page).is_file(), "{document} writes no {page}");
    }
}
