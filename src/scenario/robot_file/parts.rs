//! The tables of a robot file as typed, with the position of every value.

use std::{collections::BTreeMap, ops::Range};

use toml::de::{DeTable, DeValue};

use super::keys::{ROBOT_KEYS, RobotKey, RobotKeyKind, TABLES};
use crate::scenario::{
    KeyPath, Place, ProblemKind, ScenarioProblem,
    backslashes::{control_character, line_at, unreadable_lines},
    entries::{plain, shortened, value_text},
    values::{count, number, triple},
};

/// One table: `[robot]`, a `[[trunk]]` or a `[[limb]]`.
#[derive(Debug)]
pub(super) struct Part {
    /// Its name.
    pub(super) table: &'static str,
    /// Which of those of this name, from 0.
    pub(super) index: usize,
    span: Range<usize>,
    values: BTreeMap<&'static str, (toml::Value, Range<usize>)>,
    refused: Vec<&'static str>,
}

impl Part {
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.values.get(name).and_then(|(value, _)| number(value))
    }

    pub(super) fn three(&self, name: &str) -> Option<[f64; 3]> {
        self.values.get(name).and_then(|(value, _)| triple(value))
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        self.values.get(name).and_then(|(value, _)| value.as_str())
    }

    pub(super) fn count(&self, name: &str) -> Option<usize> {
        self.values.get(name).and_then(|(value, _)| usize::try_from(count(value)?).ok())
    }

    /// Whether any of its keys begins with this, refused ones included.
    pub(super) fn has(&self, prefix: &str) -> bool {
        self.values.keys().chain(&self.refused).any(|name| name.starts_with(prefix))
    }

    /// Whether a key was given with a value that it does not take.
    pub(super) fn is_refused(&self, name: &str) -> bool {
        self.refused.contains(&name)
    }

    /// Where a key was given, or its table.
    pub(super) fn place(&self, name: &str) -> Place {
        Place::File(self.values.get(name).map_or_else(|| self.span.clone(), |(_, span)| span.clone()))
    }

    /// A key as a message names it: `limb 2: hip_m`.
    pub(super) fn path(&self, name: &str) -> String {
        path(self.table, self.index, name)
    }
}

fn path(table: &str, index: usize, name: &str) -> String {
    match table {
        "robot" => format!("robot.{name}"),
        "trunk" => format!("trunk box {}: {name}", index + 1),
        _ => format!("{table} {}: {name}", index + 1),
    }
}

/// All tables, and what is wrong with them.
#[derive(Debug, Default)]
pub(super) struct Parts {
    pub(super) tables: Vec<Part>,
    pub(super) problems: Vec<ScenarioProblem>,
    /// The text could not be parsed, so that an absent key does not count as missing.
    pub(super) unreadable: bool,
}

impl Parts {
    /// The tables of a TOML text.
    pub(super) fn of(source: &str) -> Self {
        let mut read = Self::default();
        let (backslashed, mended) = unreadable_lines(source);
        for line in &backslashed {
            let message = "a text in double quotes has a backslash, where TOML takes it for the beginning of an escape".to_owned();
            read.problem(Place::File(line.text.clone()), ("", ""), ProblemKind::Value, message, line.help());
        }
        match DeTable::parse(&mended) {
            Ok(document) => {
                for (table, content) in document.get_ref() {
                    read.top(source, table.get_ref(), table.span(), content.get_ref());
                }
            }
            Err(error) => {
                let message = format!("this is not TOML: {}", error.message().replace('\n', ", "));
                let help = "the robot's keys stand below [robot], those of each trunk box below [[trunk]], those of each limb below [[limb]]";
                read.problem(
                    error.span().map_or(Place::Nowhere, Place::File),
                    ("", ""),
                    ProblemKind::Syntax,
                    message,
                    help.to_owned(),
                );
                read.unreadable = true;
            }
        }
        read
    }

    pub(super) fn problem(&mut self, place: Place, (table, name): (&str, &str), kind: ProblemKind, message: String, help: String) {
        self.problems.push(ScenarioProblem { key: KeyPath::new(table, name), kind, place, message, help });
    }

    /// A table or a list of tables outside all others.
    fn top(&mut self, source: &str, name: &str, span: Range<usize>, content: &DeValue<'_>) {
        let Some(table) = TABLES.into_iter().find(|known| *known == name) else {
            let near = TABLES.iter().find(|known| strsim::damerau_levenshtein(name, known) <= 2);
            let help = near.map_or_else(
                || "the tables are [robot], [[trunk]] and [[limb]]".to_owned(),
                |near| format!("the nearest known table is {near}"),
            );
            let found = if matches!(content, DeValue::Table(_) | DeValue::Array(_)) { "table" } else { "key outside all tables," };
            let message = format!("unknown {found} {}", shortened(name));
            return self.problem(Place::File(span), (name, ""), ProblemKind::Unknown, message, help);
        };
        match content {
            DeValue::Table(keys) if table == "robot" => self.part(source, table, 0, span, keys),
            DeValue::Array(list) if table != "robot" => {
                for (index, one) in list.iter().enumerate() {
                    match one.get_ref() {
                        DeValue::Table(keys) => self.part(source, table, index, one.span(), keys),
                        _ => self.no_table(table, one.span()),
                    }
                }
            }
            _ => self.no_table(table, span),
        }
    }

    fn no_table(&mut self, table: &str, span: Range<usize>) {
        let header = if table == "robot" {
            "[robot]"
        } else if table == "trunk" {
            "[[trunk]]"
        } else {
            "[[limb]]"
        };
        let message = format!("{table} is given in another form than {header}");
        let help = format!("write {header} on a line of its own, and its keys below");
        self.problem(Place::File(span), (table, ""), ProblemKind::Value, message, help);
    }

    fn part(&mut self, source: &str, table: &'static str, index: usize, span: Range<usize>, keys: &DeTable<'_>) {
        let mut part = Part { table, index, span, values: BTreeMap::new(), refused: Vec::new() };
        self.keys(source, &mut part, "", keys);
        self.tables.push(part);
    }

    /// The keys of a table, and of the tables in it with their names in front.
    fn keys(&mut self, source: &str, part: &mut Part, prefix: &str, keys: &DeTable<'_>) {
        for (name, value) in keys {
            let full = format!("{prefix}{}", name.get_ref());
            let inner = format!("{full}.");
            let has_inner = ROBOT_KEYS.iter().any(|key| key.table == part.table && key.name.starts_with(&inner));
            match (RobotKey::find(part.table, &full), value.get_ref()) {
                (None, DeValue::Table(keys)) if has_inner => self.keys(source, part, &inner, keys),
                (None, _) if has_inner => {
                    let message = format!("{} is no table", part.path(&full));
                    let names = names(part.table, &inner).join(", ");
                    self.problem(
                        Place::File(value.span()),
                        (part.table, &full),
                        ProblemKind::Value,
                        message,
                        format!("give it as {full} = {{ {names} }}"),
                    );
                }
                (None, _) => self.unknown(part, &full, name.span()),
                (Some(key), typed) => self.value(source, part, key, plain(typed), value.span()),
            }
        }
    }

    /// Checks a value against its key's kind and stores it.
    fn value(&mut self, source: &str, part: &mut Part, key: &'static RobotKey, value: Option<toml::Value>, span: Range<usize>) {
        let place = Place::File(span.clone());
        let control = |value: &toml::Value| control_character(value.as_str()?);
        match value {
            Some(value) if key.kind == RobotKeyKind::File && control(&value).is_some() => {
                let message = format!("{} is a path with {} in it", part.path(key.name), control(&value).unwrap_or_default());
                let help = line_at(source, span.start)
                    .map_or_else(|| "write the path on one line, with / between folders".to_owned(), |line| line.help());
                part.refused.push(key.name);
                self.problem(place, (key.table, key.name), ProblemKind::Value, message, help);
            }
            Some(value) if fits(&value, key.kind) => {
                part.values.insert(key.name, (value, span));
            }
            other => {
                let found = other.as_ref().map_or_else(|| "a date".to_owned(), value_text);
                let message = format!("{} is {}, expected {}", part.path(key.name), shortened(&found), key.kind.expected());
                part.refused.push(key.name);
                self.problem(place, (key.table, key.name), ProblemKind::Value, message, format!("it means: {}", key.help));
            }
        }
    }

    fn unknown(&mut self, part: &Part, name: &str, span: Range<usize>) {
        let names = names(part.table, "");
        let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(name, known));
        let near = near.filter(|known| strsim::damerau_levenshtein(name, known) <= name.chars().count() / 3 + 1);
        // A key without its unit, or with another one.
        let begins = |known: &&&str| {
            name.len() > 2
                && (known.starts_with(name)
                    || name.split('_').next().is_some_and(|first| first.len() > 2 && known.starts_with(first)))
        };
        let help = match near.or_else(|| names.iter().find(begins)) {
            Some(near) => format!("the nearest known key is {near}"),
            None => format!("the keys of {} are {}", part.table, names.join(", ")),
        };
        let message = format!("unknown key {}", shortened(&part.path(name)));
        self.problem(Place::File(span), (part.table, name), ProblemKind::Unknown, message, help);
    }
}

/// The names of a table's keys that begin with this, without it.
fn names(table: &str, prefix: &str) -> Vec<&'static str> {
    ROBOT_KEYS.iter().filter(|key| key.table == table).filter_map(|key| key.name.strip_prefix(prefix)).collect()
}

/// Whether a value is of a kind.
fn fits(value: &toml::Value, kind: RobotKeyKind) -> bool {
    let finite = |holds: fn(f64) -> bool| number(value).is_some_and(|number| number.is_finite() && holds(number));
    let three = |holds: fn(f64) -> bool| {
        triple(value).is_some_and(|numbers| numbers.iter().all(|number| number.is_finite() && holds(*number)))
    };
    match kind {
        RobotKeyKind::Text | RobotKeyKind::File => value.as_str().is_some_and(|text| !text.trim().is_empty()),
        RobotKeyKind::Positive => finite(|number| number > 0.0),
        RobotKeyKind::NotNegative => finite(|number| number >= 0.0),
        RobotKeyKind::Number => finite(|_| true),
        RobotKeyKind::Count => count(value).is_some_and(|count| count >= 1),
        RobotKeyKind::Three => three(|_| true),
        RobotKeyKind::ThreePositive => three(|number| number > 0.0),
    }
}
