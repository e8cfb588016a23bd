//! CITATION.cff has the keys that readers of the format need, agrees with Cargo.toml, and cites only what other documents name.

#![allow(clippy::unwrap_used, reason = "a test that cannot read the documents should stop")]

use std::{fs, path::Path};

fn read(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// The value of a line `key: value` with this indentation.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    text.lines().find_map(|line| Some(line.strip_prefix(key)?.strip_prefix(':')?.trim())).filter(|value| !value.is_empty())
}

#[test]
fn the_citation_agrees_with_the_manifest() {
    let (citation, manifest) = (read("CITATION.cff"), read("Cargo.toml"));
    let of_manifest = |key: &str| {
        let line = manifest.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = \"")).unwrap();
        line.trim_end_matches('"').to_owned()
    };
    for (key, expected) in [
        ("cff-version", "1.2.0".to_owned()),
        ("type", "software".to_owned()),
        ("title", of_manifest("name")),
        ("version", of_manifest("version")),
    ] {
        assert_eq!(value(&citation, key), Some(expected.as_str()), "{key}");
    }
    assert!(value(&citation, "message").is_some());
    for key in ["authors:", "references:", "license:", "abstract: >-"] {
        assert!(citation.lines().any(|line| line == key), "no {key}");
    }
    let licences = citation.split("license:\n").nth(1).unwrap().lines().map_while(|line| line.strip_prefix("  - "));
    assert_eq!(licences.collect::<Vec<_>>().join(" OR "), of_manifest("license"));
    assert!(citation.contains(&of_manifest("description")), "another abstract than the manifest's description");
    // What YAML would not read: tabs, and a colon or comment sign within a plain value.
    for line in citation.lines().filter(|line| !line.starts_with('#')) {
        assert!(!line.contains('\t') && !line.contains(" #"), "{line}");
        let plain = line.trim_start().trim_start_matches("- ");
        let text = plain.split_once(": ").map_or("", |(_, text)| text);
        assert!(!text.contains(": "), "{line}");
    }
}

#[test]
fn references_are_whole_and_named_elsewhere_in_the_repository() {
    let citation = read("CITATION.cff");
    let references: Vec<_> = citation.split("references:\n").nth(1).unwrap().split("  - type: ").skip(1).collect();
    assert!(references.len() >= 3);
    let elsewhere = ["README.md", "src/terrain/synth/fractal.rs", "src/ballistics/choice.rs", "data/scenarios/mars_frogbot.toml"]
        .map(read)
        .concat();
    for reference in references {
        let title = value(reference, "    title").unwrap();
        assert!(elsewhere.to_lowercase().contains(&title.to_lowercase()), "no document names \"{title}\"");
        assert!(reference.contains("    authors:\n") && value(reference, "    year").is_some(), "{title}");
        for name in reference.lines().filter_map(|line| line.split_once("family-names: ")) {
            assert!(elsewhere.contains(name.1), "{title}: no document names {}", name.1);
        }
    }
}
