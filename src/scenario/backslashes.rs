//! Windows paths in a scenario: a TOML text in double quotes takes a backslash for the beginning of an escape.
//!
//! `dem = "C:\Users\crater.tif"` is no TOML, and `dem = "terrain\new.tif"` is a name with a line break in it. Both are reported with
//! the line as it should be: single quotes keep backslashes as they are. The mended text has the same length, so that the positions
//! of all other keys stay valid.

use std::ops::Range;

use toml::de::DeTable;

/// A line whose texts in double quotes have backslashes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Backslashed {
    /// Its bytes in the source, without its end.
    pub(super) line: Range<usize>,
    /// The bytes of its first text with a backslash, with its quotes.
    pub(super) text: Range<usize>,
    /// The line in single quotes.
    pub(super) mended: String,
}

impl Backslashed {
    /// The line that begins at a byte, if texts in double quotes with backslashes stand in it and it is TOML once they are mended.
    fn of(source: &str, begin: usize) -> Option<Self> {
        let line = source.get(begin..)?.split('\n').next()?.trim_end_matches('\r');
        let (mut mended, mut first, mut at) = (String::new(), None, 0);
        while let Some(open) = line[at..].find('"').map(|found| at + found) {
            // Read as its writer meant it: a backslash is a plain letter, so the text ends at the next quote.
            let Some(close) = line[open + 1..].find('"').map(|found| open + 1 + found) else { break };
            mended.push_str(&line[at..open]);
            let text = &line[open + 1..close];
            if text.contains('\\') {
                first.get_or_insert(begin + open..begin + close + 1);
                mended.push_str(&in_single_quotes(text));
            } else {
                mended.push_str(&line[open..=close]);
            }
            at = close + 1;
        }
        mended.push_str(&line[at..]);
        let text = first.filter(|_| DeTable::parse(&mended).is_ok())?;
        Some(Self { line: begin..begin + line.len(), text, mended })
    }

    /// How to write it instead.
    pub(super) fn help(&self) -> String {
        format!("write / instead of each, or put the text in single quotes: {}", self.mended.trim())
    }
}

/// A text with backslashes as a TOML value that keeps them; with `/` in their place where the text has a single quote.
fn in_single_quotes(text: &str) -> String {
    if text.contains('\'') { format!("\"{}\"", text.replace('\\', "/")) } else { format!("'{text}'") }
}

/// The line of a byte as [`Backslashed`].
pub(super) fn line_at(source: &str, byte: usize) -> Option<Backslashed> {
    let begin = source.get(..byte)?.rfind('\n').map_or(0, |newline| newline + 1);
    Backslashed::of(source, begin)
}

/// The lines that are no TOML because of their backslashes, and the text with these lines mended.
pub(super) fn unreadable_lines(source: &str) -> (Vec<Backslashed>, String) {
    let (mut found, mut mended, mut begin) = (Vec::new(), String::with_capacity(source.len()), 0);
    for line in source.split_inclusive('\n') {
        let plain = line.trim_end_matches(['\r', '\n']);
        let refused = || plain.contains('\\') && DeTable::parse(plain).is_err();
        match refused().then(|| Backslashed::of(source, begin)).flatten() {
            Some(backslashed) => {
                mended.push_str(&backslashed.mended);
                mended.push_str(&line[plain.len()..]);
                found.push(backslashed);
            }
            None => mended.push_str(line),
        }
        begin += line.len();
    }
    (found, mended)
}

/// The name of a character that no file's name has, if the text has one.
pub(super) fn control_character(text: &str) -> Option<String> {
    text.chars().find(|letter| letter.is_control()).map(|letter| match letter {
        '\n' => "a line break".to_owned(),
        '\t' => "a tab".to_owned(),
        '\r' => "a carriage return".to_owned(),
        '\u{8}' => "a backspace".to_owned(),
        '\u{c}' => "a form feed".to_owned(),
        other => format!("the control character U+{:04X}", u32::from(other)),
    })
}

#[cfg(test)]
mod tests {
    use crate::scenario::{Entries, ProblemKind};

    /// A line with a Windows path, the path meant, and the key it belongs to.
    const LINES: [(&str, &str, &str); 12] = [
        (r#"dem = "C:\Users\me\crater.tif""#, r"C:\Users\me\crater.tif", "dem"),
        (r#"dem = "terrain\new.tif""#, r"terrain\new.tif", "dem"),
        (r#"dem = "C:\temp\dem.tif"  # on the other machine"#, r"C:\temp\dem.tif", "dem"),
        (r#"dem="\\server\share\dem.tif""#, r"\\server\share\dem.tif", "dem"),
        (r#"mesh = "meshes\bennu.obj""#, r"meshes\bennu.obj", "mesh"),
        (r#"mesh = "D:\rock.obj""#, r"D:\rock.obj", "mesh"),
        (r#"chain = "out\chain.csv""#, r"out\chain.csv", "chain"),
        (r#"chain = "runs\u1\chain.csv""#, r"runs\u1\chain.csv", "chain"),
        (r#"chain = "out\files\chain.csv""#, r"out\files\chain.csv", "chain"),
        (r#"dem = "C:\""#, r"C:\", "dem"),
        (r#"dem = "D:\o'hara\dem.tif""#, "D:/o'hara/dem.tif", "dem"),
        (r#""dem" = "C:\maps\x.tif""#, r"C:\maps\x.tif", "dem"),
    ];

    #[test]
    fn every_mended_line_is_toml_that_means_the_path() {
        for (line, path, key) in LINES {
            let source = format!("[body]\nname = \"mars\"\n[terrain]\n{line}\nstart_m = [1, 2]\n[search]\neffort = \"fun\"\n");
            for source in [source.clone(), source.replace('\n', "\r\n")] {
                let entries = Entries::from_toml(&source);
                // Every other problem of the file is reported as well, at its place.
                let [effort, path_problem] = ["effort", key].map(|name| {
                    entries.problems().iter().find(|problem| problem.key.name == name).unwrap_or_else(|| panic!("{line}: {name}"))
                });
                assert_eq!((entries.problems().len(), path_problem.kind), (2, ProblemKind::Value), "{line}");
                let place = |problem: &crate::scenario::ScenarioProblem| match &problem.place {
                    crate::scenario::Place::File(span) => source[span.clone()].to_owned(),
                    other => panic!("{line}: {other:?}"),
                };
                assert_eq!(place(effort), "\"fun\"");
                assert!(
                    place(path_problem).starts_with('"') && line.contains(&place(path_problem)),
                    "{line}: {}",
                    place(path_problem)
                );
                // The line that the message gives is put in place of the wrong one.
                let (_, mended) = path_problem.help.split_once("single quotes: ").unwrap();
                let table: toml::Table = mended.parse().unwrap_or_else(|error| panic!("{mended}: {error}"));
                assert_eq!(table.get(key).and_then(toml::Value::as_str), Some(path), "{mended}");
                let again = Entries::from_toml(&source.replace(line, mended));
                assert_eq!(again.problems().len(), 1, "{mended}: {:?}", again.problems());
                assert_eq!(again.text("terrain", key), Some(path));
            }
        }
    }

    #[test]
    fn texts_that_are_meant_as_they_stand_are_left_alone() {
        for line in [r"dem = 'C:\Users\x.tif'", r#"dem = "C:\\Users\\x.tif""#, r#"dem = "d\u00e9.tif""#, r#"dem = "a/b.tif""#] {
            let entries = Entries::from_toml(&format!("[terrain]\n{line}\n"));
            assert!(entries.problems().is_empty(), "{line}: {:?}", entries.problems());
        }
        let title = Entries::from_toml("[report]\ntitle = \"say \\\"hi\\\"\\tthere\"\n");
        assert!(title.problems().is_empty(), "{:?}", title.problems());
        // Not TOML for another reason.
        let broken = Entries::from_toml("[terrain]\ndem = \"C:\\\\a.tif\nstart_m = [1\n");
        assert_eq!(broken.problems()[0].kind, ProblemKind::Syntax);
        let unknown = Entries::from_toml("[terrain]\nden = \"C:\\Users\\a.tif\"\n");
        assert_eq!(unknown.problems().len(), 2, "{:?}", unknown.problems());
    }

    #[test]
    fn an_assignment_on_the_command_line_names_its_backslashes() {
        for (assignment, path) in
            [(r"terrain.dem=C:\Users\x.tif", Some(r"C:\Users\x.tif")), (r"terrain.dem='a\new.tif'", Some(r"a\new.tif"))]
        {
            let mut entries = Entries::default();
            entries.set("--set", assignment);
            assert_eq!((entries.text("terrain", "dem"), entries.problems().len()), (path, 0), "{assignment}");
        }
        for assignment in [r#"terrain.dem="a\new.tif""#, r#"terrain.dem="C:\Users\x.tif""#] {
            let mut entries = Entries::default();
            entries.set("--set", assignment);
            let problem = &entries.problems()[0];
            let (_, mended) = problem.help.split_once("single quotes: ").unwrap();
            let mut again = Entries::default();
            again.set("--set", mended);
            let meant = assignment.split_once('=').unwrap().1.trim_matches('"');
            assert_eq!((again.text("terrain", "dem"), again.problems().len()), (Some(meant), 0), "{mended}");
        }
    }
}
