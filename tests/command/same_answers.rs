//! `.ci/same_answers`: its commands use every subcommand with every option, and it finds a planted change of one byte.
//!
//! It needs python3 and a Unix shell; without python3 the tests print why they are skipped.

#![cfg(all(feature = "cli", unix))]
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program should stop")]
#![allow(clippy::print_stdout, reason = "it says why it skips")]

use std::process::Command;

use crate::installed::installed;

const BINARY: &str = env!("CARGO_BIN_EXE_chta");

/// The output of the script; `None` without python3.
fn same_answers(arguments: &[&str]) -> Option<String> {
    if !installed("python3") {
        return None;
    }
    let output = Command::new("python3").arg(".ci/same_answers").args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

fn help(arguments: &[&str]) -> String {
    let output = Command::new(BINARY).args(arguments).arg("--help").output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The subcommands that `chta --help` lists.
fn subcommands() -> Vec<String> {
    let text = help(&[]);
    let listed = text.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    listed
        .lines()
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect()
}

/// The options of a subcommand, each with its names: `-o` and `--output`.
fn options(subcommand: &str) -> Vec<Vec<String>> {
    let text = help(&[subcommand]);
    let names = |line: &str| {
        let names = line.trim_start().split(", ").filter_map(|word| word.split([' ', '[', '=']).next());
        names.filter(|name| name.starts_with('-')).map(str::to_owned).collect()
    };
    text.lines().filter(|line| line.starts_with("      --") || line.starts_with("  -")).map(names).collect()
}

#[test]
fn its_commands_use_every_subcommand_with_every_option() {
    let Some(list) = same_answers(&["--list"]) else { return };
    let commands: Vec<Vec<&str>> = list
        .lines()
        .flat_map(|line| line.split("&&").flat_map(|part| part.split("; ")))
        .map(|part| part.split_whitespace().collect())
        .collect();
    let uses = |subcommand: &str, names: &[String]| {
        commands.iter().any(|words| {
            let called = words.windows(2).any(|pair| pair[0] == "chta" && pair[1] == subcommand);
            called && (names.is_empty() || words.iter().any(|word| names.iter().any(|name| name == word)))
        })
    };
    let subcommands = subcommands();
    assert!(subcommands.len() > 10, "{subcommands:?}");
    for subcommand in &subcommands {
        assert!(uses(subcommand, &[]), "no command of .ci/same_answers runs `chta {subcommand}`");
        if subcommand == "help" {
            continue;
        }
        let options = options(subcommand);
        assert!(!options.is_empty(), "`chta {subcommand} --help` lists no options");
        // The option of every command says times, which no command can repeat.
        let is_compared = |name: &String| name != "--help" && name != "--verbose";
        for names in options.iter().filter(|names| names.iter().all(is_compared)) {
            assert!(uses(subcommand, names), "no command of .ci/same_answers runs `chta {subcommand}` with {names:?}");
        }
    }
}

#[test]
fn it_finds_a_planted_change_of_one_byte() {
    if let Some(said) = same_answers(&["--self-test", BINARY]) {
        assert!(said.ends_with("self-test passed\n"), "{said}");
    }
}
