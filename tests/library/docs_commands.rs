//! README, CONTRIBUTING and CI name the same commands.

#![allow(clippy::unwrap_used, reason = "a test that cannot read the documents should stop")]

use std::{fs, path::Path};

fn read(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

#[test]
fn contributing_lists_what_ci_runs() {
    let readme = read("README.md");
    let marked = readme.split("<!-- test command -->").nth(1).unwrap().split("<!-- end of test command -->").next().unwrap();
    let test_command: Vec<_> = marked.lines().filter(|line| line.starts_with("cargo ")).collect();
    assert_eq!(test_command.len(), 1, "README marks one test command");

    let ci = read(".ci/run");
    let steps = ci.lines().filter_map(|line| {
        let (settings, command) = line.split_once("step ")?;
        let runs = !line.trim_start().starts_with('#') && !line.contains("step()");
        runs.then(|| {
            let line = format!("{}{command}", settings.trim_start());
            line.replace("$test_command", test_command[0]).replace("$features", "gdal,parquet")
        })
    });
    let contributing = read("CONTRIBUTING.md");
    let listed: Vec<_> = contributing.split("```").nth(1).unwrap().lines().skip(1).map(str::to_owned).collect();
    assert_eq!(listed, steps.collect::<Vec<_>>());
}

#[test]
fn every_test_that_the_documents_name_is_there() {
    let mut named = 0;
    for document in [
        "CONTRIBUTING.md",
        "README.md",
        "data/README.md",
        "docs/command_line.md",
        "docs/formats.md",
        "docs/gis.md",
        "docs/performance.md",
        "docs/proof.md",
        "docs/validation.md",
        "fuzz/README.md",
        "plots/README.md",
        "src/lib.rs",
    ] {
        for path in read(document).split(|c: char| !c.is_alphanumeric() && !"/_.".contains(c)) {
            let path = Path::new(path.trim_end_matches('.'));
            if path.starts_with("tests") && path.extension().is_some_and(|extension| extension == "rs") {
                let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
                assert!(file.is_file(), "{document} names {}", path.display());
                named += 1;
            }
        }
    }
    assert!(named >= 15, "only {named} names found");
}

#[test]
fn the_manifest_and_the_readme_agree_on_the_rust_version() {
    let manifest = read("Cargo.toml");
    let version = manifest.lines().find_map(|line| line.strip_prefix("rust-version = \"")).unwrap().trim_end_matches('"');
    assert!(read("README.md").contains(&format!("Rust {version} or newer")), "README speaks of another Rust than {version}");
}

/// The documents about the subject; the glossary is of use for these words alone.
const DOCUMENTS: [&str; 9] = [
    "README.md",
    "docs/clearance.md",
    "docs/footprint.md",
    "docs/formats.md",
    "docs/performance.md",
    "docs/proof.md",
    "docs/propulsion.md",
    "docs/takeoff_speeds.md",
    "docs/validation.md",
];

#[test]
fn the_glossary_has_the_words_that_the_documents_use() {
    let one_line = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
    let used = one_line(DOCUMENTS.map(read).concat());
    let glossary = read("docs/glossary.md");
    let terms: Vec<&str> = glossary.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next()).skip(1).collect();
    assert!(terms.len() > 30, "{terms:?}");
    for term in &terms {
        assert!(used.contains(&term.to_lowercase()), "the glossary explains \"{term}\", which no document uses");
    }
    assert!(terms.is_sorted_by_key(|term| term.to_lowercase()), "the glossary is not in alphabetical order: {terms:?}");
    assert!(read("README.md").contains("docs/glossary.md"), "README.md does not name the glossary");
}
