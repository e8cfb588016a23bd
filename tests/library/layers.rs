//! The order of modules (docs in `src/lib.rs`): a module imports only modules listed above it. The test reads the sources and
//! reports a wrong import with file and line.

#![allow(clippy::unwrap_used, reason = "a test that cannot read the sources should stop")]

use std::{fs, path::Path};

/// The layers of modules, from the top. The last two are the binary's own modules, below all of the library.
const LADDER: [&str; 22] = [
    "progress",
    "quantity",
    "world",
    "robot_model",
    "ballistics",
    "arena",
    "terrain",
    "chain",
    "hop",
    "ground",
    "drive",
    "flight",
    "graph",
    "planner",
    "path",
    "uncertainty",
    "reach",
    "report",
    "figure",
    "scenario",
    "study",
    "cli",
];

/// One import that violates the order.
#[derive(Debug, PartialEq, Eq)]
struct WrongImport {
    line: usize,
    from: String,
    to: String,
}

fn layer_of(module: &str) -> Option<usize> {
    LADDER.iter().position(|known| *known == module)
}

/// The modules that a line of source names after `crate::` or `chta::`, including `use crate::{a::b, c}` over several lines.
fn named_modules(source: &str) -> Vec<(usize, String)> {
    let mut named = Vec::new();
    for prefix in ["crate::", "chta::"] {
        for (start, _) in source.match_indices(prefix) {
            let line = source[..start].matches('\n').count() + 1;
            let line_start = source[..start].rfind('\n').map_or(0, |i| i + 1);
            // Documentation may name any module.
            if source[line_start..start].trim_start().starts_with("//") {
                continue;
            }
            let rest = &source[start + prefix.len()..];
            let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
            let Some(group) = rest.strip_prefix('{') else {
                named.push((line, word(rest)));
                continue;
            };
            // The first names of a group at its own depth.
            let (mut depth, mut head) = (1, true);
            let mut newlines = 0;
            for (i, c) in group.char_indices() {
                match c {
                    '{' => depth += 1,
                    '}' => depth -= 1,
                    ',' if depth == 1 => head = true,
                    '\n' => newlines += 1,
                    c if head && depth == 1 && c.is_alphanumeric() => {
                        named.push((line + newlines, word(&group[i..])));
                        head = false;
                    }
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
        }
    }
    named
}

fn wrong_imports(module: &str, source: &str) -> Vec<WrongImport> {
    let Some(own) = layer_of(module) else { return Vec::new() };
    named_modules(source)
        .into_iter()
        .filter(|(_, to)| layer_of(to).is_some_and(|to| to > own))
        .map(|(line, to)| WrongImport { line, from: module.to_owned(), to })
        .collect()
}

fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_module_uses_only_those_above_it() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    assert!(files.len() > 50, "only {} sources found", files.len());
    let mut wrong = Vec::new();
    for file in files {
        let inside = file.strip_prefix(&src).unwrap();
        let module = inside.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned();
        assert!(
            layer_of(&module).is_some() || ["lib", "main"].contains(&module.as_str()),
            "{} belongs to no layer",
            inside.display()
        );
        for WrongImport { line, from, to } in wrong_imports(&module, &fs::read_to_string(&file).unwrap()) {
            wrong.push(format!("src/{}:{line}: {from} uses {to}, which is listed below it", inside.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_planted_wrong_import_is_found() {
    let planted = "//! crate::report is only spoken of here\nuse crate::{\n    chain::Station,\n    graph::{search, Answer},\n    world::Limit,\n};\n";
    let found = wrong_imports("hop", planted);
    assert_eq!(found, [WrongImport { line: 4, from: "hop".to_owned(), to: "graph".to_owned() }]);
    assert_eq!(wrong_imports("ballistics", "fn f() { crate::chain::x() }").len(), 1, "a path in an expression is an import too");
    assert_eq!(wrong_imports("report", planted), [], "imports of modules listed above are allowed");
}

/// Modules that the independent checker must not use: otherwise it would share the physics with the plan.
const CLOSED_TO_THE_CHECKER: [&str; 5] = ["ballistics", "hop", "flight", "graph", "terrain"];

/// Items of `ground` that the checker must not use: it may use [`Surface`](chta::ground::Surface) and its two extensions only.
const CLOSED_ITEMS: [&str; 9] = [
    "Windows",
    "TakeoffWindows",
    "FirstContact",
    "ChainGround",
    "DemGround",
    "MeshGround",
    "PostHops",
    "LiftoffVelocity",
    "TouchdownState",
];

/// The forbidden names in the checker's source.
fn forbidden_to_the_checker(source: &str) -> Vec<String> {
    let modules = named_modules(source).into_iter().filter(|(_, module)| CLOSED_TO_THE_CHECKER.contains(&module.as_str()));
    let mut found: Vec<String> = modules.map(|(line, module)| format!("{line}: {module}")).collect();
    for (number, line) in source.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
        let words = line.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        found.extend(words.filter(|word| CLOSED_ITEMS.contains(word)).map(|word| format!("{}: {word}", number + 1)));
    }
    found
}

#[test]
fn the_checker_uses_surface_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/path/execute");
    let mut files = Vec::new();
    sources(&folder, &mut files);
    assert!(!files.is_empty(), "the checker's sources are not at this path");
    for file in files {
        let forbidden = forbidden_to_the_checker(&fs::read_to_string(&file).unwrap());
        assert!(forbidden.is_empty(), "{}: {forbidden:?}", file.display());
    }
}

#[test]
fn a_planted_import_into_the_checker_is_found() {
    let planted =
        "//! Windows and ballistics may be spoken of\nuse crate::{\n    ballistics::Arc,\n    ground::{Surface, Windows},\n};\n";
    assert_eq!(forbidden_to_the_checker(planted), ["3: ballistics", "4: Windows"]);
    assert_eq!(forbidden_to_the_checker("fn f(g: &crate::ground::DemGround) {}"), ["1: DemGround"]);
    assert_eq!(forbidden_to_the_checker("use crate::ground::{ContactPoint, Element, Surface};"), Vec::<String>::new());
}

#[test]
fn the_limits_name_no_trigonometric_function() {
    let limits = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/ballistics/limits");
    let mut read = 0;
    for entry in fs::read_dir(limits).unwrap() {
        let path = entry.unwrap().path();
        let source = fs::read_to_string(&path).unwrap();
        let code: String = source.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        for function in ["sin(", "cos(", "tan(", "atan", "libm", "Angle", "Vec<", "Vec::"] {
            assert!(!code.contains(function), "{} calls {function}", path.display());
        }
        read += 1;
    }
    assert!(read >= 5, "only {read} limits found");
}

/// The most lines of a file of a command, with all that it does beside parsing, asking a study and writing.
const COMMAND_LINES: usize = 60;

/// Commands that are longer: the file, the most lines that it may have, and why.
const LONGER_COMMANDS: [(&str, usize, &str); 4] = [
    ("fan.rs", 66, "two answers: the size before the computation, and the rays"),
    (
        "plan.rs",
        70,
        "two answers: the size before the search, and the path; meshes, wheels and targets go on to files of their own",
    ),
    ("run.rs", 65, "meshes, wheels and targets go on to files of their own"),
    (
        "simulate/mod.rs",
        81,
        "experiments, meshes, wheels, legs and targets go on to files of their own; a raster of rests beside landings",
    ),
];

/// A file of a command that has more lines than it may, or fewer than its exception grants by far.
fn misfit(name: &str, lines: usize) -> Option<String> {
    let longer = LONGER_COMMANDS.iter().find(|(file, ..)| *file == name);
    let most = longer.map_or(COMMAND_LINES, |(_, most, _)| *most);
    if lines > most {
        return Some(format!(
            "{name} has {lines} lines, at most {most} are allowed: what it does beside parsing and writing is a study"
        ));
    }
    longer.filter(|_| lines <= COMMAND_LINES).map(|_| format!("{name} has {lines} lines and needs no exception"))
}

#[test]
fn commands_parse_ask_a_study_and_write() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli/commands");
    let mut files = Vec::new();
    sources(&folder, &mut files);
    assert!(files.len() > 10, "only {} commands found", files.len());
    let name = |file: &Path| file.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
    let found: Vec<_> =
        files.iter().filter_map(|file| misfit(&name(file), fs::read_to_string(file).unwrap().lines().count())).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
    for (file, ..) in LONGER_COMMANDS {
        assert!(folder.join(file).exists(), "{file} has an exception and does not exist");
    }
}

#[test]
fn a_command_that_is_too_long_is_found() {
    assert_eq!(misfit("check.rs", COMMAND_LINES), None);
    assert!(misfit("check.rs", COMMAND_LINES + 1).is_some());
    let (file, most, _) = LONGER_COMMANDS[0];
    assert_eq!(misfit(file, most), None);
    assert!(misfit(file, most + 1).is_some() && misfit(file, COMMAND_LINES).is_some());
}
