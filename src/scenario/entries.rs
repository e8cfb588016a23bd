//! Keys and values as typed, each with its source, from a file, a result or the command line.

use std::{collections::BTreeMap, ops::Range};

use toml::de::{DeTable, DeValue};

use super::{
    CATALOGUE, Key, KeyPath, Kind, ProblemKind, ScenarioProblem,
    backslashes::{Backslashed, control_character, line_at, unreadable_lines},
    face_groups::face_groups,
    values::{corners, count, fits, no_data, number, objective, pair, slip, speeds, triple},
};
use crate::{
    planner::Objective,
    terrain::NoDataRule,
    world::{FaceGroups, SlipCurve, SpeedLevels},
};

/// The source of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// These bytes of the scenario file.
    File(Range<usize>),
    /// Outside the file, under this name, such as an option.
    Option(String),
    /// No particular position.
    Nowhere,
}

/// A value and its source.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    value: toml::Value,
    place: Place,
}

/// All keys given; later ones replace earlier ones.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Entries {
    given: BTreeMap<(String, String), Entry>,
    problems: Vec<ScenarioProblem>,
    /// The text could not be parsed, so an absent key does not count as missing.
    unreadable: bool,
    /// Keys that one setting outside the file gave and another replaced by another value, with the sources of both.
    replaced: Vec<(&'static Key, (String, String))>,
}

impl Entries {
    /// The keys of a TOML text. Unknown keys and wrong syntax become problems, listed by [`problems`](Self::problems).
    pub fn from_toml(source: &str) -> Self {
        let mut entries = Self::default();
        // Positions stay the same: TOML knows no line ends of carriage returns alone, as older editors of the Macintosh write.
        let returns_alone = source.contains('\r') && !source.contains('\n');
        let with_feeds = if returns_alone { source.replace('\r', "\n").into() } else { std::borrow::Cow::Borrowed(source) };
        let (backslashed, mended) = unreadable_lines(&with_feeds);
        // Lines with Windows paths are reported; the others are read as if these were right, so that all problems are found at once.
        let parsed = DeTable::parse(&with_feeds);
        let parsed = if backslashed.is_empty() || parsed.is_ok() { parsed } else { DeTable::parse(&mended).or(parsed) };
        let document = match parsed {
            Ok(document) => document,
            Err(error) => {
                entries.problems.push(ScenarioProblem {
                    key: KeyPath::default(),
                    kind: ProblemKind::Syntax,
                    place: error.span().map_or(Place::Nowhere, Place::File),
                    message: format!("this is not TOML: {}", error.message().replace('\n', ", ")),
                    help: "see the example in README.md; texts stand in quotes, tables in [brackets]".to_owned(),
                });
                entries.unreadable = true;
                return entries;
            }
        };
        for (table, content) in document.get_ref() {
            let place = Place::File(table.span());
            match content.get_ref() {
                DeValue::Table(keys) => {
                    for (name, value) in keys {
                        match plain(value.get_ref()) {
                            Some(plain) => {
                                let places = (value.span(), name.span());
                                entries.add_from_file((table.get_ref(), name.get_ref()), plain, places, (source, &backslashed));
                            }
                            None => entries.unknown(table.get_ref(), name.get_ref(), Place::File(name.span())),
                        }
                    }
                    if keys.is_empty() && !tables().any(|known| known == table.get_ref()) {
                        entries.unknown(table.get_ref(), "", place);
                    }
                }
                _ => entries.unknown("", table.get_ref(), place),
            }
        }
        entries
    }

    /// Checks a value of a file for backslashes, then adds it.
    fn add_from_file(
        &mut self,
        (table, name): (&str, &str),
        value: toml::Value,
        (span, name_span): (Range<usize>, Range<usize>),
        (source, unreadable): (&str, &[Backslashed]),
    ) {
        let key = Key::find(table, name);
        if let Some(line) = unreadable.iter().find(|line| line.line.contains(&span.start)) {
            let named = key.map_or_else(|| format!("{table}.{name}"), Key::path);
            let message = format!("{named} has a backslash in double quotes, where TOML takes it for the beginning of an escape");
            self.problem_at(Place::File(line.text.clone()), (table, name), ProblemKind::Value, message, line.help());
            if key.is_some() {
                return;
            }
        }
        let control = key.filter(|key| key.names_a_file()).and_then(|_| control_character(value.as_str()?));
        match (key, control) {
            (Some(key), Some(control)) => {
                let message = format!("{} is a path with {control} in it", key.path());
                let help = line_at(source, span.start).map_or_else(
                    || "write the path on one line, with / between folders".to_owned(),
                    |line| format!("a backslash in double quotes begins an escape: {}", line.help()),
                );
                self.problem_at(Place::File(span), (table, name), ProblemKind::Value, message, help);
            }
            _ => self.add(table, name, value, Place::File(span), Place::File(name_span)),
        }
    }

    /// The keys of the `scenario` of a result that the program wrote.
    pub fn from_json(scenario: &serde_json::Value) -> Self {
        let mut entries = Self::default();
        let Some(tables) = scenario.as_object() else {
            let message = format!("scenario is {}, expected an object of tables", shortened(&scenario.to_string()));
            entries.problem(("", ""), ProblemKind::Syntax, message, "give a result.json that chta wrote");
            entries.unreadable = true;
            return entries;
        };
        for (table, keys) in tables {
            let Some(keys) = keys.as_object() else {
                entries.unknown("", table, Place::Nowhere);
                continue;
            };
            for (name, value) in keys {
                match from_json(value) {
                    Some(value) => entries.add(table, name, value, Place::Nowhere, Place::Nowhere),
                    None => match Key::find(table, name) {
                        Some(key) => entries.misfit(key, &value.to_string(), Place::Nowhere),
                        None => entries.unknown(table, name, Place::Nowhere),
                    },
                }
            }
        }
        entries
    }

    /// Sets `table.key=value`. Problems with it begin with `place`, the caller's name for the source, such as an option. A value
    /// that is not valid TOML is taken as a text.
    pub fn set(&mut self, place: &str, assignment: &str) {
        let option = Place::Option(place.to_owned());
        let parsed = assignment.split_once('=').and_then(|(path, value)| Some((path.trim().split_once('.')?, value.trim())));
        match parsed {
            Some(((table, name), value)) => {
                let text = || toml::Value::String(value.to_owned());
                let parsed = format!("v = {value}").parse::<toml::Table>().ok().filter(|table| table.len() == 1);
                let typed = parsed.and_then(|mut table| table.remove("v")).unwrap_or_else(text);
                // A title that consists of digits needs no quotes.
                let takes_text = Key::find(table, name).is_some_and(|key| key.kind == Kind::Text);
                let value = if takes_text && !typed.is_str() { text() } else { typed };
                let file = Key::find(table, name).filter(|key| key.names_a_file());
                if let Some(key) = file.filter(|_| value.as_str().is_some_and(|path| mistaken_path(path).is_some())) {
                    let mended = line_at(assignment, 0).map_or_else(|| assignment.to_owned(), |line| line.mended);
                    let what = value.as_str().and_then(mistaken_path).unwrap_or_default();
                    let message = format!("{} is a path with {what}", key.path());
                    let help = format!("write / instead of each backslash, or put the text in single quotes: {mended}");
                    return self.problem_at(option, (table, name), ProblemKind::Value, message, help);
                }
                self.add(table, name, value, option.clone(), option);
            }
            None => self.problem_at(
                option,
                ("", ""),
                ProblemKind::Syntax,
                "found no table.key=value".to_owned(),
                "write it as hopper.takeoff_speed_max_m_s=8",
            ),
        }
    }

    /// Sets a key by its own option.
    pub fn set_by_option(&mut self, option: &str, table: &str, name: &str, value: toml::Value) {
        let place = Place::Option(option.to_owned());
        self.add(table, name, value, place.clone(), place);
    }

    /// Removes a key that an option replaces by another one. Returns whether it was there.
    pub fn forget(&mut self, table: &str, name: &str) -> bool {
        self.given.remove(&(table.to_owned(), name.to_owned())).is_some()
    }

    /// The title of the report, where one was given.
    pub fn title(&self) -> Option<&str> {
        self.text("report", "title")
    }

    /// Gives the report a title, where the scenario has none.
    pub fn set_default_title(&mut self, title: &str) {
        if self.title().is_none() && !title.trim().is_empty() {
            self.add("report", "title", toml::Value::from(title), Place::Nowhere, Place::Nowhere);
        }
    }

    /// The keys that name a file, each with its path.
    pub fn files(&self) -> Vec<(&'static Key, String)> {
        let files = CATALOGUE.iter().filter(|key| key.names_a_file());
        files.filter_map(|key| Some((key, self.text(key.table, key.name)?.to_owned()))).collect()
    }

    /// Gives the raster of every layer the path that `moved` makes of it.
    pub fn redirect_layers(&mut self, moved: impl Fn(&str) -> String) {
        for entry in self.given.iter_mut().filter(|((table, _), _)| table == "layer").map(|(_, entry)| entry) {
            if let Some(toml::Value::String(path)) = entry.value.get_mut("raster") {
                *path = moved(path);
            }
        }
    }

    /// The table of a layer.
    pub(super) fn layer_table_mut(&mut self, name: &str) -> Option<&mut toml::Table> {
        self.given.get_mut(&("layer".to_owned(), name.to_owned()))?.value.as_table_mut()
    }

    /// The names of the keys given of a table, in their order.
    pub fn names_in(&self, table: &str) -> Vec<String> {
        self.given.keys().filter(|(known, _)| known == table).map(|(_, name)| name.clone()).collect()
    }

    /// Gives a key that names a file another path.
    pub fn redirect(&mut self, key: &Key, path: &str) {
        if let Some(entry) = self.given.get_mut(&(key.table.to_owned(), key.name.to_owned())) {
            entry.value = path.into();
        }
    }

    /// The problem of a key whose file cannot be used, at the position where the key was given.
    pub fn file_problem(&self, key: &Key, message: String, help: String) -> ScenarioProblem {
        let place = self.place(key.table, key.name).unwrap_or(Place::Nowhere);
        ScenarioProblem { key: KeyPath::new(key.table, key.name), kind: ProblemKind::Value, place, message, help }
    }

    /// Whether the text could not be parsed.
    pub fn is_unreadable(&self) -> bool {
        self.unreadable
    }

    /// The problems found so far.
    pub fn problems(&self) -> &[ScenarioProblem] {
        &self.problems
    }

    /// Adds a problem of a key, at the position where that key was given, if any.
    pub(super) fn problem(&mut self, key: (&str, &str), kind: ProblemKind, message: String, help: impl Into<String>) {
        let place = self.place(key.0, key.1).unwrap_or(Place::Nowhere);
        self.problem_at(place, key, kind, message, help);
    }

    /// Adds a problem of a key at another position.
    pub(super) fn problem_at(
        &mut self,
        place: Place,
        (table, name): (&str, &str),
        kind: ProblemKind,
        message: String,
        help: impl Into<String>,
    ) {
        self.problems.push(ScenarioProblem { key: KeyPath::new(table, name), kind, place, message, help: help.into() });
    }

    /// Whether one of these keys was given with an invalid value.
    pub(super) fn has_refused(&self, table: &str, names: &[&str]) -> bool {
        self.problems.iter().any(|problem| problem.kind == ProblemKind::Value && problem.key.is_one_of(table, names))
    }

    /// Whether a table has an unknown key, which may be a misspelling of a missing key.
    pub(super) fn has_unknown(&self, table: &str) -> bool {
        self.problems.iter().any(|problem| problem.kind == ProblemKind::Unknown && problem.key.table == table)
    }

    /// The position of a key; `None` if it was not given.
    pub(super) fn place(&self, table: &str, name: &str) -> Option<Place> {
        self.given.get(&(table.to_owned(), name.to_owned())).map(|entry| entry.place.clone())
    }

    /// The value of a key; `None` if it was not given.
    pub(super) fn value(&self, table: &str, name: &str) -> Option<&toml::Value> {
        self.given.get(&(table.to_owned(), name.to_owned())).map(|entry| &entry.value)
    }

    /// Metres per unit of the mesh that the keys name: 1 unless they say otherwise.
    pub fn mesh_scale(&self) -> f64 {
        self.number("terrain", "mesh_scale").unwrap_or(1.0)
    }

    /// A number; `None` if it was not given.
    pub(super) fn number(&self, table: &str, name: &str) -> Option<f64> {
        self.value(table, name).and_then(number)
    }

    /// A whole number; `None` if it was not given.
    pub(super) fn count(&self, table: &str, name: &str) -> Option<u64> {
        self.value(table, name).and_then(count)
    }

    /// Every key that was given with a value that it takes, and where, in the order of the keys' names.
    pub fn given(&self) -> impl Iterator<Item = (&'static Key, &Place)> {
        self.given.iter().filter_map(|((table, name), entry)| Some((Key::find(table, name)?, &entry.place)))
    }

    /// Every key that one setting outside the file gave and another replaced by another value, with the sources of both.
    pub fn replaced(&self) -> impl Iterator<Item = (&'static Key, &(String, String))> {
        self.replaced.iter().map(|(key, by)| (*key, by))
    }

    /// Whether any key of a table was given.
    pub(super) fn has_table(&self, table: &str) -> bool {
        self.given.keys().any(|(known, _)| known == table)
    }

    /// A text; `None` if it was not given.
    pub(super) fn text(&self, table: &str, name: &str) -> Option<&str> {
        self.value(table, name).and_then(toml::Value::as_str)
    }

    /// A switch; `false` if it was not given.
    pub(super) fn flag(&self, table: &str, name: &str) -> bool {
        self.value(table, name).and_then(toml::Value::as_bool).unwrap_or(false)
    }

    /// A rule for missing data; as the file states, if none was given.
    pub(super) fn no_data(&self, table: &str, name: &str) -> NoDataRule {
        self.value(table, name).and_then(no_data).unwrap_or_default()
    }

    /// Two numbers; `None` if they were not given.
    pub(super) fn pair(&self, table: &str, name: &str) -> Option<[f64; 2]> {
        self.value(table, name).and_then(pair)
    }

    /// Three numbers; `None` if they were not given.
    pub(super) fn triple(&self, table: &str, name: &str) -> Option<[f64; 3]> {
        self.value(table, name).and_then(triple)
    }

    /// Two corners of a box; `None` if they were not given.
    pub(super) fn corners(&self, table: &str, name: &str) -> Option<[[f64; 3]; 2]> {
        self.value(table, name).and_then(corners)
    }

    /// Whether the keys ask for a free route over a mesh.
    pub fn ask_for_free_mesh(&self) -> bool {
        self.text("terrain", "mesh").is_some() && self.text("terrain", "route") == Some(super::Route::Free.name())
    }

    /// Whether the keys ask for a free route of a robot with legs over a DEM.
    pub fn ask_for_legs_on_dem(&self) -> bool {
        let route = self.text("terrain", "route") == Some(super::Route::Free.name());
        route && self.text("terrain", "dem").is_some() && self.text("robot", "file").is_some()
    }

    /// Whether the keys say that the heading is not controlled, so that trials follow no path.
    pub fn ask_for_drift(&self) -> bool {
        super::drift::is_uncontrolled(self)
    }

    /// Groups of faces; none if they were not given.
    pub(super) fn face_groups(&self, table: &str, name: &str) -> FaceGroups {
        self.value(table, name).and_then(face_groups).unwrap_or_default()
    }

    /// Speeds; `None` if they were not given.
    pub(super) fn speeds(&self, table: &str, name: &str) -> Option<SpeedLevels> {
        self.value(table, name).and_then(speeds)
    }

    /// An objective; `None` if it was not given.
    pub(super) fn objective(&self, table: &str, name: &str) -> Option<Objective> {
        self.value(table, name).and_then(objective)
    }

    /// A curve of slip; `None` if it was not given.
    pub(super) fn slip(&self, table: &str, name: &str) -> Option<SlipCurve> {
        self.value(table, name).and_then(slip)
    }

    /// Points; empty if they were not given.
    pub(super) fn points(&self, table: &str, name: &str) -> Vec<[f64; 2]> {
        self.value(table, name).and_then(toml::Value::as_array).into_iter().flatten().filter_map(pair).collect()
    }

    /// Checks a value against its key's kind and stores it.
    fn add(&mut self, table: &str, name: &str, value: toml::Value, place: Place, key_place: Place) {
        let Some(key) = Key::find(table, name) else { return self.unknown(table, name, key_place) };
        // One key of a layer, `layer.sun.min`, beside those it has.
        if let (Kind::Layer, Some((layer, own))) = (key.kind, name.split_once('.')) {
            let mut keys = self.value(table, layer).and_then(toml::Value::as_table).cloned().unwrap_or_default();
            keys.insert(own.to_owned(), value);
            self.given.insert((table.to_owned(), layer.to_owned()), Entry { value: keys.into(), place });
            return;
        }
        if fits(&value, key.kind) {
            if let (Some(Place::Option(before)), Place::Option(now)) = (self.place(table, name), &place)
                && self.value(table, name) != Some(&value)
            {
                self.replaced.push((key, (before, now.clone())));
            }
            self.given.insert((table.to_owned(), name.to_owned()), Entry { value, place });
        } else {
            self.misfit(key, &value_text(&value), place);
        }
    }

    /// Reports a value of the wrong kind.
    fn misfit(&mut self, key: &Key, value: &str, place: Place) {
        let message = format!("{} is {}, expected {}", key.path(), shortened(value), key.kind.expected());
        self.problem_at(place, (key.table, key.name), ProblemKind::Value, message, format!("it means: {}", key.help));
    }

    /// Reports an unknown key or table, with the nearest known one.
    fn unknown(&mut self, table: &str, name: &str, place: Place) {
        if table.is_empty() && tables().any(|known| known == name) {
            let help = format!("write [{name}] on a line of its own and its keys below");
            return self.problem_at(place, (name, ""), ProblemKind::Value, format!("{name} is a value, expected a table"), help);
        }
        let near_table = tables().find(|known| strsim::damerau_levenshtein(table, known) <= 2);
        let (given, help) = match (table, name, near_table) {
            (table, "", Some(near)) => (format!("table [{table}]"), format!("the nearest known table is [{near}]")),
            (table, "", None) => {
                (format!("table [{table}]"), format!("the tables are {}", tables().collect::<Vec<_>>().join(", ")))
            }
            ("", name, _) => (format!("key {}", shortened(name)), nearest_key("", name)),
            (table, name, _) => (format!("key {}", shortened(&format!("{table}.{name}"))), nearest_key(table, name)),
        };
        self.problem_at(place, (table, name), ProblemKind::Unknown, format!("unknown {given}"), help);
    }
}

/// What shows that backslashes in double quotes were taken for escapes, or that the text is not TOML because of them.
fn mistaken_path(path: &str) -> Option<String> {
    let quoted = path.starts_with('"') && path.ends_with('"') && path.contains('\\');
    if quoted {
        Some("backslashes in double quotes".to_owned())
    } else {
        control_character(path).map(|control| format!("{control} in it"))
    }
}

/// The hint for an unknown key: the nearest known key or, where none is near, the keys of the intended table.
///
/// A name is near if it differs from a known one, or from its part before an underscore, in at most a third of its letters (one in
/// short names). An exact name counts in any table; otherwise keys of the given, or nearly given, table alone.
pub(crate) fn nearest_key(table: &str, name: &str) -> String {
    let meant = tables().find(|known| strsim::damerau_levenshtein(table, known) <= 2);
    let near = |key: &&Key| -> Option<(usize, bool)> {
        let letters = name.chars().count();
        let apart = |known: &str| {
            let distance = strsim::damerau_levenshtein(name, known);
            (distance <= (letters.min(known.chars().count()) / 3).max(1)).then_some(distance)
        };
        // The whole name, or its part before an underscore (`friction` for `friction_coefficient`), with a penalty so that a whole
        // name at the same distance comes first.
        let beginnings =
            key.name.match_indices('_').filter_map(|(end, _)| apart(&key.name[..end]).map(|distance| 2 * distance + 1));
        let distance = apart(key.name).map(|distance| 2 * distance).into_iter().chain(beginnings).min()?;
        let own = meant == Some(key.table);
        // In other tables only an exact name counts: of its beginnings, such as `speed`, many tables have some.
        (own || meant.is_none() || distance == 0).then_some((distance, !own))
    };
    let best = CATALOGUE.iter().filter_map(|key| Some((near(&key)?, key))).min_by_key(|((distance, elsewhere), _)| {
        // A wrong table counts like two wrong letters.
        (distance + 4 * usize::from(*elsewhere), *elsewhere)
    });
    match (best, meant) {
        (Some((_, key)), _) => format!("the nearest known key is {}", key.path()),
        (None, Some(table)) => {
            let names: Vec<_> = CATALOGUE.iter().filter(|key| key.table == table).map(|key| key.name).collect();
            format!("the keys of [{table}] are {}", names.join(", "))
        }
        (None, None) => format!("the tables are {}", tables().collect::<Vec<_>>().join(", ")),
    }
}

/// A value in the notation of a user: numbers without rows of zeros.
pub(super) fn value_text(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(number) if number.is_finite() && *number != 0.0 && !(1e-4..1e12).contains(&number.abs()) => {
            format!("{number:e}")
        }
        toml::Value::Array(items) => format!("[{}]", items.iter().map(value_text).collect::<Vec<_>>().join(", ")),
        other => other.to_string(),
    }
}

/// A part of the user's text, short enough for one sentence.
pub(super) fn shortened(text: &str) -> String {
    const LONGEST: usize = 80;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// A JSON value as a TOML value; `None` for kinds that no key takes.
fn from_json(value: &serde_json::Value) -> Option<toml::Value> {
    match value {
        serde_json::Value::String(text) => Some(toml::Value::String(text.clone())),
        serde_json::Value::Number(number) => {
            number.as_i64().map(toml::Value::Integer).or_else(|| number.as_f64().map(toml::Value::Float))
        }
        serde_json::Value::Array(items) => items.iter().map(from_json).collect::<Option<_>>().map(toml::Value::Array),
        serde_json::Value::Bool(boolean) => Some(toml::Value::Boolean(*boolean)),
        serde_json::Value::Object(keys) => {
            keys.iter().map(|(name, value)| Some((name.clone(), from_json(value)?))).collect::<Option<_>>().map(toml::Value::Table)
        }
        serde_json::Value::Null => None,
    }
}

/// The names of all tables.
fn tables() -> impl Iterator<Item = &'static str> {
    let mut last = "";
    CATALOGUE.iter().map(|key| key.table).filter(move |table| std::mem::replace(&mut last, table) != *table)
}

/// A TOML value without its spans; `None` for kinds that no key takes.
pub(super) fn plain(value: &DeValue<'_>) -> Option<toml::Value> {
    Some(match value {
        DeValue::String(text) => toml::Value::String(text.to_string()),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).map_or_else(
            |_| integer.as_str().parse().map(toml::Value::Float).ok(),
            |integer| Some(toml::Value::Integer(integer)),
        )?,
        DeValue::Float(float) => toml::Value::Float(float.as_str().parse().ok()?),
        DeValue::Boolean(boolean) => toml::Value::Boolean(*boolean),
        DeValue::Array(items) => toml::Value::Array(items.iter().map(|item| plain(item.get_ref())).collect::<Option<_>>()?),
        DeValue::Table(keys) => {
            let plain = keys.iter().map(|(name, value)| Some((name.get_ref().to_string(), plain(value.get_ref())?)));
            toml::Value::Table(plain.collect::<Option<_>>()?)
        }
        DeValue::Datetime(_) => return None,
    })
}
