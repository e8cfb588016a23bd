//! Completions and manual pages, tried in bash and with `man` where they are installed.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::{collections::BTreeSet, path::Path, process::Command};

use crate::{
    desk::{Desk, chta},
    installed::installed,
};

/// The commands in the program's help.
fn commands(desk: &Desk) -> BTreeSet<String> {
    let help = desk.run(&["--help"]).stdout;
    let list = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let names = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help").map(str::to_owned).collect()
}

#[test]
fn every_shell_gets_a_script_that_knows_every_command() {
    let desk = Desk::new();
    let commands = commands(&desk);
    assert!(commands.len() >= 15 && commands.contains("simulate"), "{commands:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = desk.run(&["completions", shell]);
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{shell}");
        for word in commands.iter().map(String::as_str).chain(["points-per-segment", "verbose"]) {
            assert!(ran.stdout.contains(word), "{shell} does not know {word}");
        }
    }
    let ran = desk.run(&["completions", "tcsh"]);
    assert_eq!((ran.status, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("bash, elvish, fish, powershell, zsh"), "{}", ran.stderr);
}

#[test]
fn bash_completes_commands_options_and_values() {
    if !installed("bash") {
        return;
    }
    let program = Path::new(env!("CARGO_BIN_EXE_chta"));
    for (words, expected) in [
        (&["chta", "che"][..], "check"),
        (&["chta", "pl"], "plan"),
        (&["chta", "check", "--points"], "--points-per-segment"),
        (&["chta", "check", "x.toml", "--format", "j"], "json"),
        (&["chta", "completions", "po"], "powershell"),
        (&["chta", "map", "--effort-"], "--effort-output"),
    ] {
        let last = words.len() - 1;
        let line = format!(
            "source <('{}' completions bash); COMP_WORDS=({}); COMP_CWORD={last}; _chta chta '{}' '{}'; echo \"${{COMPREPLY[*]}}\"",
            program.display(),
            words.join(" "),
            words[last],
            words[last - 1],
        );
        let output = Command::new("bash").args(["--norc", "-c", &line]).output().unwrap();
        assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), expected, "{words:?}");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let desk = Desk::new();
    let ran = desk.run(&["man", "-o", "share/man1"]);
    assert_eq!((ran.status, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    let written = |name: String| name.strip_prefix("share/man1/").filter(|page| !page.is_empty()).map(str::to_owned);
    let pages: BTreeSet<_> = desk.files().into_keys().filter_map(written).collect();
    let of_commands = commands(&desk).into_iter().map(|command| format!("chta-{command}.1"));
    assert_eq!(pages, of_commands.chain(["chta.1".to_owned()]).collect());
    // A page is written over by the same one, whole.
    let before = desk.files();
    assert_eq!(desk.run(&["man", "-o", "share/man1"]).status, 0);
    assert!(desk.files().keys().eq(before.keys()));
    let check = desk.read("share/man1/chta-check.1");
    assert!(check.contains("chta check") && check.contains("points\\-per\\-segment"), "{check}");
    if !installed("man") {
        return;
    }
    for page in &pages {
        let output =
            Command::new("man").current_dir(desk.path().join("share/man1")).args(["-l", page]).env("MANPAGER", "cat").output();
        let output = output.unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success() && text.contains("SYNOPSIS"), "{page}: {text}{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn pages_that_cannot_be_written_are_refused() {
    let desk = Desk::new();
    for (folder, said) in [("chain.csv", "chain.csv: cannot be made"), ("chain.csv/man", "cannot be made")] {
        let before = desk.files();
        let (status, stdout, stderr) = chta(desk.path(), &["man", "-o", folder]);
        assert_eq!((status, stdout.as_str()), (2, ""), "{folder}");
        assert!(stderr.contains(said), "{folder}: {stderr}");
        assert!(desk.files() == before, "{folder}: a file was left");
    }
    assert_eq!(desk.run(&["man"]).status, 2);
}
