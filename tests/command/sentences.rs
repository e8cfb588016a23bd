//! Messages of the library name keys and facts, never options of the command; and no code decides by the text of a message.
//!
//! Both are checked in the sources without their tests: options and commands in the text and documentation of everything outside
//! `src/cli`, decisions in all code of `src`.

#![allow(clippy::unwrap_used, reason = "a test that cannot read the sources should stop")]

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use chta::scenario::{Entries, ProblemKind, Scenario};

/// The sources of this crate.
fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// A parsed Rust source. Each part keeps its line, from 1.
#[derive(Debug, Default)]
struct Source {
    /// String literals; lines continued by a backslash are joined.
    literals: Vec<(usize, String)>,
    /// Lines of documentation.
    docs: Vec<(usize, String)>,
    /// The code with empty literals and without comments, line by line.
    code: String,
}

impl Source {
    /// Parses a source.
    fn parse(text: &str) -> Self {
        let chars: Vec<char> = text.chars().collect();
        let (mut source, mut at, mut line) = (Self::default(), 0, 1);
        let starts = |at: usize, word: &str| word.chars().enumerate().all(|(i, c)| chars.get(at + i) == Some(&c));
        while at < chars.len() {
            let begin = at;
            if starts(at, "//") {
                at += chars[at..].iter().take_while(|&&c| c != '\n').count();
                let comment: String = chars[begin..at].iter().collect();
                if let Some(doc) = comment.strip_prefix("///").or(comment.strip_prefix("//!")) {
                    source.docs.push((line, doc.to_owned()));
                }
                continue;
            }
            if starts(at, "/*") {
                while at < chars.len() && !starts(at, "*/") {
                    at += 1;
                }
                at += 2;
            } else if let Some((literal, end)) = string_at(&chars, at) {
                source.literals.push((line, literal));
                source.code.push_str("\"\"");
                at = end;
            } else if chars[at] == '\'' && (chars.get(at + 1) == Some(&'\\') || chars.get(at + 2) == Some(&'\'')) {
                // A character literal, not a lifetime: it ends at the next quote after its first character.
                at += 2 + usize::from(chars[at + 1] == '\\');
                at += chars[at..].iter().take_while(|&&c| c != '\'').count() + 1;
                source.code.push_str("' '");
            } else {
                source.code.push(chars[at]);
                at += 1;
                line += usize::from(chars[begin] == '\n');
                continue;
            }
            let lines = chars[begin..at.min(chars.len())].iter().filter(|&&c| c == '\n').count();
            source.code.extend(std::iter::repeat_n('\n', lines));
            line += lines;
        }
        source
    }

    /// The same without modules for tests.
    fn without_tests(mut self) -> Self {
        loop {
            let next = for_tests(&self.code).next().map(|(begin, _)| begin);
            let Some(begin) = next else { return self };
            let open = self.code[begin..].find(['{', ';']).map_or(self.code.len(), |length| begin + length);
            let mut depth = 0_usize;
            let body = self.code[open..].char_indices().find_map(|(i, c)| {
                depth = if c == '{' { depth + 1 } else { depth - usize::from(c == '}') };
                (depth == 0).then_some(open + i + 1)
            });
            let end = body.unwrap_or(self.code.len());
            let lines = line_of(&self.code, begin)..=line_of(&self.code, end);
            self.literals.retain(|(line, _)| !lines.contains(line));
            self.docs.retain(|(line, _)| !lines.contains(line));
            let newlines = "\n".repeat(self.code[begin..end].matches('\n').count());
            self.code.replace_range(begin..end, &newlines);
        }
    }
}

/// The test modules of a code: for each, where it begins, including its attributes, and the text from its name on.
fn for_tests(code: &str) -> impl Iterator<Item = (usize, &str)> {
    const ATTRIBUTE: &str = "#[cfg(test)]";
    code.match_indices(ATTRIBUTE).filter_map(|(begin, _)| {
        let mut rest = code[begin + ATTRIBUTE.len()..].trim_start();
        while rest.starts_with("#[") {
            rest = rest.split_once("]\n")?.1.trim_start();
        }
        Some((begin, rest.strip_prefix("mod ")?))
    })
}

/// The line of a byte, from 1.
fn line_of(text: &str, byte: usize) -> usize {
    text[..byte].matches('\n').count() + 1
}

/// The string literal that begins at a character, and its end.
fn string_at(chars: &[char], at: usize) -> Option<(String, usize)> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let prefix = chars[at..].iter().take_while(|c| matches!(c, 'r' | 'b' | 'c')).count();
    if prefix > 0 && at > 0 && is_name(chars[at - 1]) {
        return None;
    }
    let raw = chars[at..at + prefix].contains(&'r');
    let hashes = if raw { chars[at + prefix..].iter().take_while(|&&c| c == '#').count() } else { 0 };
    let begin = at + prefix + hashes + 1;
    if chars.get(begin - 1) != Some(&'"') {
        return None;
    }
    let (mut literal, mut i) = (String::new(), begin);
    loop {
        match *chars.get(i)? {
            '"' if chars[i + 1..].iter().take(hashes).filter(|&&c| c == '#').count() == hashes => {
                return Some((literal, i + 1 + hashes));
            }
            '\\' if !raw && chars.get(i + 1) == Some(&'\n') => {
                i += 1 + chars[i + 1..].iter().take_while(|c| c.is_whitespace()).count();
            }
            '\\' if !raw => {
                literal.extend(chars.get(i..i + 2)?);
                i += 2;
            }
            c => {
                literal.push(c);
                i += 1;
            }
        }
    }
}

/// All sources below a folder except those for tests, by their path from there.
fn all_sources(folder: &Path) -> Vec<(PathBuf, Source)> {
    fn add(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                add(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let mut files = Vec::new();
    add(folder, &mut files);
    files.sort();
    let texts: Vec<_> = files.iter().map(|file| fs::read_to_string(file).unwrap()).collect();
    let parsed: Vec<_> = texts.iter().map(|text| Source::parse(text)).collect();
    // Test modules that another file declares.
    let mut left_out = BTreeSet::new();
    for (file, source) in files.iter().zip(&parsed) {
        let is_root = file.file_stem().is_some_and(|stem| stem == "mod" || stem == "lib");
        let own = if is_root { file.parent().unwrap().to_path_buf() } else { file.with_extension("") };
        for (_, module) in for_tests(&source.code) {
            let name = &module[..module.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap()];
            left_out.extend([own.join(name).with_extension("rs"), own.join(name).join("mod.rs")]);
        }
    }
    let kept = files.into_iter().zip(parsed).filter(|(file, _)| !left_out.contains(file));
    kept.map(|(file, source)| (file.strip_prefix(folder).unwrap().to_path_buf(), source.without_tests())).collect()
}

/// The names of the commands, as `enum Command` of the command line lists them.
fn commands() -> Vec<String> {
    let text = fs::read_to_string(sources().join("cli/args/mod.rs")).unwrap();
    let (_, list) = text.split_once("enum Command {\n").unwrap();
    let (list, _) = list.split_once("\n}").unwrap();
    let names = list.lines().map(str::trim).filter(|line| line.starts_with(|c: char| c.is_ascii_uppercase()));
    names.map(|name| name.split(['(', ',', ' ']).next().unwrap().to_lowercase()).collect()
}

/// Options of other programs, which a message may recommend.
const FOREIGN: [(&str, &str); 2] = [("gdal_translate", "--config"), ("cargo install", "--features")];

/// The options in a text, except those of other programs named before them.
fn options(text: &str) -> Vec<String> {
    let word = |c: char| c.is_ascii_lowercase() || c == '-' || c.is_ascii_digit();
    let named = text.match_indices("--").filter_map(|(at, _)| {
        let before = text[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || matches!(c, '-' | '/' | '>')) {
            return None;
        }
        let rest = &text[at + 2..];
        // The name may be a format argument.
        let name = &rest[..rest.find(|c| !word(c)).unwrap_or(rest.len())];
        let is_name = name.len() > 1 && !name.starts_with('-') && !name.contains("--") || rest.starts_with('{');
        let foreign = |(program, option): &(&str, &str)| text[..at].contains(program) && text[at..].starts_with(option);
        (is_name && !FOREIGN.iter().any(foreign)).then(|| format!("--{name}"))
    });
    named.collect()
}

/// The commands that a text recommends.
fn commands_in<'a>(text: &str, commands: &'a [String]) -> impl Iterator<Item = &'a String> {
    let words: Vec<String> = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).map(str::to_owned).collect();
    commands.iter().filter(move |name| words.windows(2).any(|pair| pair[0] == "chta" && pair[1] == **name))
}

/// References to the command line in a source outside `cli/`, with their lines.
fn of_the_command_line(source: &Source, commands: &[String]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (line, text) in &source.literals {
        found.extend(options(text).into_iter().map(|option| (*line, option)));
        found.extend(commands_in(text, commands).map(|name| (*line, format!("chta {name}"))));
    }
    for (line, text) in &source.docs {
        // Documentation may refer to the command by its name.
        if !text.contains("`chta ") {
            found.extend(options(text).into_iter().map(|option| (*line, option)));
        }
    }
    found.sort();
    found
}

/// Names of variables that hold a message.
const SENTENCES: [&str; 13] =
    ["message", "sentence", "reason", "help", "hint", "warning", "doubt", "problem", "error", "err", "e", "refusal", "told"];

/// Functions that decide by the content of a text.
const DECISIONS: [&str; 9] = [
    ".contains(",
    ".starts_with(",
    ".ends_with(",
    ".split_once(",
    ".rsplit_once(",
    ".strip_prefix(",
    ".strip_suffix(",
    ".find(",
    ".eq_ignore_ascii_case(",
];

/// The lines that decide by the text of a message: a result of `to_string` or `format!`, anything named as a message or a problem,
/// and variables that hold the text of one.
fn decisions(source: &Source) -> Vec<usize> {
    let code = &source.code;
    let mut names: BTreeSet<&str> = SENTENCES.into_iter().collect();
    for (at, _) in code.match_indices(".to_string();") {
        let statement = &code[code[..at].rfind([';', '{', '}']).map_or(0, |end| end + 1)..at];
        if let Some((name, value)) = statement.trim().strip_prefix("let ").and_then(|binding| binding.split_once(" = "))
            && SENTENCES.contains(&value.trim())
        {
            names.insert(name.trim());
        }
    }
    let mut found = BTreeSet::new();
    for decision in DECISIONS {
        for (at, _) in code.match_indices(decision) {
            if is_sentence(code[..at].trim_end(), &names) {
                found.insert(line_of(code, at));
            }
        }
    }
    for comparison in ["==", "!="] {
        for (at, _) in code.match_indices(comparison) {
            let right = code[at + 2..].trim_start();
            let compared = &right[..right.find([';', '{', '}', '&', '|', ',', '=']).unwrap_or(right.len())];
            if is_made_text(code[..at].trim_end()) || is_made_text(compared.trim_end()) {
                found.insert(line_of(code, at));
            }
        }
    }
    found.into_iter().collect()
}

/// Whether code ends in an expression that is a message, by its name or because it is created there.
fn is_sentence(code: &str, names: &BTreeSet<&str>) -> bool {
    let name = code.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default();
    names.contains(name) || is_made_text(code)
}

/// Whether code ends in a call of `to_string` or `format!`.
fn is_made_text(code: &str) -> bool {
    let Some(inside) = code.strip_suffix(')') else { return false };
    let mut depth = 1_usize;
    let open = inside.char_indices().rev().find_map(|(i, c)| {
        depth = if c == ')' { depth + 1 } else { depth - usize::from(c == '(') };
        (depth == 0).then_some(i)
    });
    let called = open.map(|open| &inside[..open]).unwrap_or_default();
    called.ends_with(".to_string") || called.ends_with("format!")
}

#[test]
fn sentences_of_the_library_name_no_option_and_no_command() {
    let commands = commands();
    assert!(commands.len() >= 13 && commands.iter().any(|name| name == "check"), "{commands:?}");
    let mut found = Vec::new();
    let mut literals = 0;
    for (path, source) in all_sources(&sources()).iter().filter(|(path, _)| !path.starts_with("cli")) {
        literals += source.literals.len();
        let said = of_the_command_line(source, &commands);
        found.extend(said.into_iter().map(|(line, what)| format!("src/{}:{line}: {what}", path.display())));
    }
    assert!(literals > 1000, "only {literals} literals were read");
    assert!(found.is_empty(), "the library speaks of the command line:\n{}", found.join("\n"));
}

#[test]
fn a_planted_option_in_a_sentence_of_the_library_is_found() {
    let commands = commands();
    let planted = "//! Drawn --o--a--/ here.\n/// As `chta map --stride` does.\n/// Give --stride.\n// not --looked at\n#[error(\"too far: give \\\n        \
                   --stride {stride}\")]\nfn a() -> char {\n    let b = r#\"or \"ask\" `chta check`\"#;\n    let c = '\"';\n    \
                   let d = format!(\"--{d}\");\n    let e = \"gdal_translate --config A, a -- b\";\n}\n\n#[cfg(test)]\nmod tests {\n    \
                   const A: &str = \"{--threads\";\n}\n\nconst Z: &str = \"--last\";\n";
    let found = of_the_command_line(&Source::parse(planted).without_tests(), &commands);
    let found: Vec<(usize, &str)> = found.iter().map(|(line, what)| (*line, what.as_str())).collect();
    assert_eq!(found, [(3, "--stride"), (5, "--stride"), (8, "chta check"), (10, "--"), (19, "--last")]);
}

#[test]
fn no_decision_is_made_on_the_text_of_a_message() {
    let mut found = Vec::new();
    let sources = all_sources(&sources());
    assert!(sources.len() > 200, "only {} files were read", sources.len());
    for (path, source) in &sources {
        found.extend(decisions(source).into_iter().map(|line| format!("src/{}:{line}", path.display())));
    }
    assert!(found.is_empty(), "these lines decide by the text of a message; give it a kind or a key:\n{}", found.join("\n"));
}

#[test]
fn a_planted_decision_on_the_text_of_a_message_is_found() {
    for planted in [
        "problems.iter().any(|problem| problem.message.contains(\"body.\"))",
        "if error.to_string().contains(\"off\") {}",
        "error\n    .to_string()\n    .starts_with(\"off\")",
        "format!(\"{error}\").ends_with(name)",
        "format!(\"{}\", a(b)).contains(name)",
        "fn about(sentence: &str) -> bool { sentence.contains(name) }",
        "if error.to_string() == \"off\" {}",
        "if \"off\" != error.to_string() {}",
        "let text = error.to_string();\nlet (a, b) = text.split_once(\": \").unwrap_or_default();",
    ] {
        assert!(!decisions(&Source::parse(planted).without_tests()).is_empty(), "{planted} is not found");
    }
    for harmless in [
        "// error.to_string().contains(\"off\")",
        "let a = \"error.to_string().contains(name)\";",
        "if warnings.contains(&warning) {}",
        "let text = name.to_string();\nlet parsed = text.split_once('=');",
        "if kind == ProblemKind::Missing { help.push_str(&error.to_string()); }",
        "#[cfg(test)]\nmod tests {\n    fn a() { assert!(error.to_string().contains(\"off\")); }\n}",
    ] {
        assert!(decisions(&Source::parse(harmless).without_tests()).is_empty(), "{harmless} is found");
    }
}

/// The problems of a scenario by key and kind, in order.
fn problems(source: &str) -> Vec<(String, ProblemKind)> {
    let problems = Scenario::new(Entries::from_toml(source)).unwrap_err();
    problems.iter().map(|problem| (format!("{}.{}", problem.key.table, problem.key.name), problem.kind)).collect()
}

#[test]
fn a_value_that_reads_like_another_key_hides_no_problem_of_that_key() {
    use ProblemKind::{Missing, Unknown, Value};
    let body = "[body]\nname = \"mars\"\n";
    for (source, expected) in [
        ("[search]\neffort = \"body.time\"\n".to_owned(), vec![("search.effort", Value), ("body.gravity_m_s2", Missing)]),
        (
            format!("{body}[terrain]\nstart_m = [1, 2]\n[search]\nsplit = \"terrain.dem\"\n"),
            vec![("terrain.dem", Missing), ("search.split", Value)],
        ),
        (
            format!("{body}[terrain]\ndem = \"a.tif\"\n[search]\nrisk = \"start_m\"\n"),
            vec![("terrain.start_m", Missing), ("search.risk", Value)],
        ),
        // An invalid value is reported alone: whether its key counts as given is unknown.
        ("[body]\ngravity_m_s2 = -1\n".to_owned(), vec![("body.gravity_m_s2", Value)]),
        ("[body]\nradius_m = -1\n".to_owned(), vec![("body.radius_m", Value), ("body.gravity_m_s2", Missing)]),
        ("[body]\ngravity = 3.7\n".to_owned(), vec![("body.gravity", Unknown)]),
        (format!("{body}[terrain]\ndem = \"a.tif\"\nstart_m = 3\ngoal_m = [1, 2]\n"), vec![("terrain.start_m", Value)]),
    ] {
        let found = problems(&source);
        let found: Vec<(&str, ProblemKind)> = found.iter().map(|(key, kind)| (key.as_str(), *kind)).collect();
        // Missing keys have no position in the file, so they are last.
        assert_eq!(found.len(), expected.len(), "{source}\n{found:?}");
        assert!(expected.iter().all(|problem| found.contains(problem)), "{source}\n{found:?}");
    }
}

/// The text on standard error of a refusal.
#[cfg(feature = "cli")]
fn refused(args: &[&str]) -> String {
    let ran = std::process::Command::new(env!("CARGO_BIN_EXE_chta"))
        .current_dir(env!("CARGO_TARGET_TMPDIR"))
        .args(args)
        .output()
        .unwrap();
    assert_eq!(ran.status.code(), Some(2), "{args:?}: {ran:?}");
    String::from_utf8(ran.stderr).unwrap()
}

#[cfg(feature = "cli")]
#[test]
fn the_command_adds_the_options_that_it_has() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    fs::write(folder.join("no_gravity.toml"), "[search]\neffort = \"body.time\"\n").unwrap();
    fs::write(folder.join("no_gravity.csv"), "x_m,z_m\n0,0\n10,2\n").unwrap();
    fs::write(folder.join("no_gravity.xyz"), "0 0 0\n1 0 0\n0 1 0\n1 1 0\n").unwrap();
    let effort = "search.effort is \"body.time\", expected one of ";
    let gravity = "found no gravity; add [body] with name = \"mars\" or gravity_m_s2 = 3.711";
    let check = refused(&["check", "no_gravity.csv", "--scenario", "no_gravity.toml"]);
    assert!(check.contains(effort) && check.contains(&format!("{gravity}, or use --body or --gravity-m-s2")), "{check}");
    // A slice has neither option.
    let slice = refused(&["slice", "no_gravity.xyz", "--from", "0,0", "--to", "1,1", "--scenario", "no_gravity.toml"]);
    assert!(slice.contains(effort) && slice.contains(gravity) && !slice.contains("--body"), "{slice}");
    let set = refused(&["check", "no_gravity.csv", "--set", "hopper"]);
    assert!(set.contains("--set hopper: found no table.key=value; write it as hopper.takeoff_speed_max_m_s=8"), "{set}");
}
