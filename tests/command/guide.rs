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

#[test]
fn the_commands_of_the_guide_run() {
    for (document, least, page) in [("docs/guide/site_survey.md", 9, "out/decision.html"), ("docs/report.md", 4, "out/all.html")] {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(Path::new(env!("CARGO_MANIFEST_DIR")).join("data"), folder.path().join("data")).unwrap();
        let commands = commands(document);
        assert!(commands.len() >= least, "{document}: {commands:?}");
        for command in commands {
            let program = format!("chta() {{ '{}' \"$@\"; }}", env!("CARGO_BIN_EXE_chta"));
            shell(folder.path(), &format!("{program}; {command}"));
        }
        assert!(folder.path().join(page).is_file(), "{document} writes no {page}");
    }
}
