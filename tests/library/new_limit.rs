//! The recipe for a new limit in CONTRIBUTING.md names every file that handles one, found by a sample: the longest flight.

#![allow(clippy::unwrap_used, reason = "a test that cannot read the sources should stop")]

use std::{collections::BTreeSet, fs, path::Path};

/// What code calls the sample limit: its key, its variant, its interval, its name in results, and the question whether a hopper has
/// limits like it.
const SAMPLE: [&str; 7] = [
    "flight_time_max_s",
    "Limit::FlightTime",
    "limits::flight_time",
    "flight_time::flight_time",
    "fn flight_time",
    "\"flight-time\"",
    "has_flight_limits",
];

/// Where files may handle a limit.
const PLACES: [&str; 6] = ["src", "tests", "benches", "examples", "data/validation", ".ci"];

/// This file, which names the sample to look for it.
const OWN: &str = "tests/library/new_limit.rs";

/// Files in which the name of the sample is that of the amount of a path.
const OF_AMOUNT: [&str; 3] = ["src/planner/amount.rs", "tests/command/free_route.rs", "tests/command/objective.rs"];

/// A source file: its path in the repository and its text.
struct Source {
    path: String,
    text: String,
}

impl Source {
    /// Its lines without comments.
    fn code(&self) -> impl Iterator<Item = &str> {
        let mark = if Path::new(&self.path).extension().is_some_and(|extension| extension == "rs") { "//" } else { "#" };
        self.text.lines().map(move |line| {
            let begins = line.match_indices(mark).map(|(at, _)| at).find(|&at| line[..at].trim_end().len() < at || at == 0);
            begins.map_or(line, |at| &line[..at])
        })
    }

    /// Whether its code names the sample limit.
    fn handles_the_sample(&self) -> bool {
        self.code().any(|line| SAMPLE.iter().any(|name| names(line, name)))
    }
}

/// Whether a line has a name that is not part of a longer one.
fn names(line: &str, name: &str) -> bool {
    let in_name = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(name).any(|(at, _)| {
        let (before, after) = (line[..at].chars().next_back(), line[at + name.len()..].chars().next());
        !before.is_some_and(in_name) && !after.is_some_and(in_name)
    })
}

/// The paths that the recipe names in backquotes.
fn named_in(recipe: &str) -> BTreeSet<&str> {
    recipe.split('`').skip(1).step_by(2).filter(|word| word.contains('/') && *word != OWN).collect()
}

/// Where recipe and sources disagree.
fn disagreements(recipe: &str, sources: &[Source]) -> Vec<String> {
    let named = named_in(recipe);
    let handling: BTreeSet<&str> = sources.iter().filter(|s| s.handles_the_sample()).map(|s| s.path.as_str()).collect();
    let missing = handling.difference(&named).map(|path| format!("{path} handles a limit; CONTRIBUTING.md does not name it"));
    let stale = named.difference(&handling).map(|path| format!("CONTRIBUTING.md names {path}, which handles no limit"));
    missing.chain(stale).collect()
}

/// The text files below a folder of the repository.
fn collect(folder: &Path, root: &Path, found: &mut Vec<Source>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, root, found);
        } else if path.extension().is_some_and(|extension| ["rs", "py", "commands"].iter().any(|known| extension == *known)) {
            let inside: Vec<_> = path.strip_prefix(root).unwrap().iter().map(|part| part.to_str().unwrap()).collect();
            found.push(Source { path: inside.join("/"), text: fs::read_to_string(&path).unwrap() });
        }
    }
}

/// The section of CONTRIBUTING.md with the recipe.
fn recipe(contributing: &str) -> &str {
    let section = contributing.split_once("## A new limit").unwrap().1;
    section.split_once("\n## ").map_or(section, |(section, _)| section)
}

#[test]
fn the_recipe_names_every_file_that_handles_a_limit() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = Vec::new();
    for place in PLACES {
        collect(&root.join(place), root, &mut sources);
    }
    sources.retain(|source| source.path != OWN && !OF_AMOUNT.contains(&source.path.as_str()));
    assert!(sources.len() > 100, "only {} sources found", sources.len());
    let contributing = fs::read_to_string(root.join("CONTRIBUTING.md")).unwrap();
    let recipe = recipe(&contributing);
    assert!(named_in(recipe).len() > 20, "the recipe is lost: {recipe}");
    let wrong = disagreements(recipe, &sources);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_recipe_has_one_numbered_line_per_file() {
    let contributing = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("CONTRIBUTING.md")).unwrap();
    let mut before = 0;
    for line in recipe(&contributing).lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())) {
        let (number, rest) = line.split_once(". `").unwrap();
        assert_eq!(number.parse::<usize>().unwrap(), before + 1, "{line}");
        assert!(rest.split_once("` - ").is_some_and(|(path, text)| path.contains('/') && text.len() > 10), "{line}");
        before += 1;
    }
    assert!(before > 20, "only {before} lines");
}

#[test]
fn a_planted_file_is_found_either_way() {
    let source = |path: &str, text: &str| Source { path: path.to_owned(), text: text.to_owned() };
    let recipe = "1. `src/a.rs` - the bound. `Limit::ALL` has no path.\n2. `src/b.rs` - its name.\n";
    let kept = [source("src/a.rs", "let time_s = limits.flight_time_max_s;"), source("src/b.rs", "    Limit::FlightTime,")];
    assert_eq!(disagreements(recipe, &kept), Vec::<String>::new());

    let [a, b] = kept;
    let more = [a, b, source("src/new.rs", "match limit { Limit::FlightTime => 1, _ => 0 }")];
    assert_eq!(disagreements(recipe, &more), ["src/new.rs handles a limit; CONTRIBUTING.md does not name it"]);

    let [a, ..] = more;
    let less = [a, source("src/b.rs", "//! `flight_time_max_s` is not used here\nlet x = 1; // Limit::FlightTime\n")];
    assert_eq!(disagreements(recipe, &less), ["CONTRIBUTING.md names src/b.rs, which handles no limit"]);
    assert_eq!(
        disagreements(recipe, &less[..1]),
        ["CONTRIBUTING.md names src/b.rs, which handles no limit"],
        "a file that is gone"
    );

    let others =
        "StatedValue::FlightTime; arc.flight_time_s(); fn flight_time_s(); ViolatedLimit::FlightTime; old_flight_time_max_s";
    assert!(!source("src/c.rs", others).handles_the_sample(), "longer names and a stated value are something else");
    assert!(!source(".ci/c.commands", "# hopper.flight_time_max_s=7\n").handles_the_sample(), "a comment of a script");
    assert!(source(".ci/c.commands", "chta plan --set hopper.flight_time_max_s=7\n").handles_the_sample());
}
