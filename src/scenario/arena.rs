//! An arena from TOML, with the position of every problem.

use std::{collections::BTreeMap, ops::Range};

use toml::de::{DeTable, DeValue};

use super::{
    KeyPath, Place, ProblemKind, ScenarioProblem, ScenarioProblems,
    entries::{plain, shortened, value_text},
    values::number,
};
use crate::arena::{Arena, ArenaKeys, ArenaProblem};

/// The keys of an arena: table, name, whether it is two numbers, whether it is needed.
const KEYS: [(&str, &str, bool, bool); 25] = [
    ("arena", "size_m", true, true),
    ("arena", "start_m", true, true),
    ("arena", "goal_m", true, true),
    ("arena", "start_heading_deg", false, false),
    ("arena", "inflation_m", false, false),
    ("jumper", "speed_m_s", false, true),
    ("jumper", "wheelbase_m", false, false),
    ("jumper", "turn_s_per_rad", false, false),
    ("jumper", "jump_time_s", false, true),
    ("jumper", "rise_max_m", false, true),
    ("jumper", "ring_m", false, false),
    ("jumper", "jump_edge_max_m", false, false),
    ("jumper", "speed_factor_per_jump", false, false),
    ("jumper", "drive_j_per_m", false, false),
    ("jumper", "jump_j", false, false),
    ("jumper", "power_w", false, false),
    ("jumper", "battery_j", false, false),
    ("flight", "takeoff_speed_m_s", false, true),
    ("flight", "takeoff_angle_deg", false, true),
    ("flight", "gravity_m_s2", false, false),
    ("grid", "spacing_m", false, false),
    ("grid", "jump_length_m", false, false),
    (BOX, "centre_m", true, true),
    (BOX, "size_m", true, true),
    (BOX, "height_m", false, true),
];

/// The table of which there may be several.
const BOX: &str = "box";

/// The tables, in the order of the file.
const TABLES: [&str; 5] = ["arena", "jumper", "flight", "grid", BOX];

/// Reads an arena from TOML and applies settings to it, each as `table.key=value` beside the caller's name for it.
///
/// # Errors
/// Every problem with its position: wrong syntax, unknown and missing keys, values of another kind, and whatever [`Arena::new`] finds.
pub fn read_arena(name: &str, source: &str, settings: &[(String, String)]) -> Result<Arena, ScenarioProblems> {
    let mut reader = Reader::default();
    reader.read(source);
    for (place, assignment) in settings {
        reader.set(place, assignment);
    }
    let arena = reader.arena();
    arena.map_err(|mut problems| {
        problems.sort_by_key(|problem| match &problem.place {
            Place::File(span) => (0, span.start),
            Place::Option(_) => (1, 0),
            Place::Nowhere => (2, 0),
        });
        ScenarioProblems { name: name.to_owned(), source: source.to_owned(), problems }
    })
}

/// An arena as TOML, which [`read_arena`] reads.
///
/// # Errors
/// An error of the serialiser; plain data causes none.
pub fn arena_toml(keys: &ArenaKeys) -> Result<String, toml::ser::Error> {
    toml::to_string(keys)
}

/// A key by its table, the number of the table where there are several, and its name.
type Key = (String, usize, String);

#[derive(Default)]
struct Reader {
    values: BTreeMap<Key, (toml::Value, Place)>,
    boxes: usize,
    problems: Vec<ScenarioProblem>,
}

impl Reader {
    fn read(&mut self, source: &str) {
        let document = match DeTable::parse(source) {
            Ok(document) => document,
            Err(error) => {
                let message = format!("this is not TOML: {}", error.message().replace('\n', ", "));
                let help = "tables stand in [brackets], each box in [[box]]".to_owned();
                return self.problem(
                    error.span().map_or(Place::Nowhere, Place::File),
                    ("", ""),
                    ProblemKind::Syntax,
                    message,
                    help,
                );
            }
        };
        for (table, content) in document.get_ref() {
            let name = table.get_ref();
            match content.get_ref() {
                DeValue::Table(keys) if name != BOX => self.table(name, 0, table.span(), keys),
                DeValue::Array(boxes) if name == BOX => {
                    for one in boxes {
                        match one.get_ref() {
                            DeValue::Table(keys) => self.table(BOX, self.boxes, one.span(), keys),
                            _ => self.no_table(name, one.span()),
                        }
                        self.boxes += 1;
                    }
                }
                _ => self.no_table(name, table.span()),
            }
        }
    }

    fn no_table(&mut self, name: &str, span: Range<usize>) {
        let (message, help) = if name == BOX {
            ("box is no list of tables".to_owned(), "write [[box]] on a line of its own before the keys of each box".to_owned())
        } else {
            (format!("unknown key {}", shortened(name)), format!("the tables are {}", TABLES.join(", ")))
        };
        self.problem(Place::File(span), ("", name), ProblemKind::Unknown, message, help);
    }

    fn table(&mut self, table: &str, number: usize, span: Range<usize>, keys: &DeTable<'_>) {
        if !TABLES.contains(&table) {
            let near = TABLES.iter().find(|known| strsim::damerau_levenshtein(table, known) <= 2);
            let help = near.map_or_else(
                || format!("the tables of an arena are {}", TABLES.join(", ")),
                |near| format!("the nearest known table is [{near}]"),
            );
            let message = format!("unknown table [{}]", shortened(table));
            return self.problem(Place::File(span), (table, ""), ProblemKind::Unknown, message, help);
        }
        for (name, value) in keys {
            match plain(value.get_ref()) {
                Some(plain) => self.add(table, number, name.get_ref(), plain, Place::File(value.span())),
                None => self.unknown(table, name.get_ref(), Place::File(name.span())),
            }
        }
        // A missing key is reported at its table.
        for (_, name, ..) in KEYS.iter().filter(|key| key.0 == table && key.3) {
            if !keys.keys().any(|known| known.get_ref() == name) {
                self.missing(table, number, name, Place::File(span.clone()));
            }
        }
    }

    fn add(&mut self, table: &str, number: usize, name: &str, value: toml::Value, place: Place) {
        let Some((_, _, is_pair, _)) = KEYS.iter().find(|key| key.0 == table && key.1 == name) else {
            return self.unknown(table, name, place);
        };
        let numbers = value.as_array().map(|items| items.iter().filter_map(self::number).count());
        let fits = if *is_pair {
            numbers == Some(2) && value.as_array().is_some_and(|items| items.len() == 2)
        } else {
            self::number(&value).is_some()
        };
        if !fits {
            let expected = if *is_pair { "two numbers in brackets, such as [2, 2]" } else { "a number" };
            let message = format!("{} is {}, expected {expected}", path(table, number, name), shortened(&value_text(&value)));
            return self.problem(place, (table, name), ProblemKind::Value, message, "write it without a unit".to_owned());
        }
        self.values.insert((table.to_owned(), number, name.to_owned()), (value, place));
    }

    fn unknown(&mut self, table: &str, name: &str, place: Place) {
        let names: Vec<&str> = KEYS.iter().filter(|key| key.0 == table).map(|key| key.1).collect();
        let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(name, known));
        let near = near.filter(|known| strsim::damerau_levenshtein(name, known) <= name.len() / 3 + 1);
        let help = near.map_or_else(
            || format!("the keys of [{table}] are {}", names.join(", ")),
            |near| format!("the nearest known key is {table}.{near}"),
        );
        let message = format!("unknown key {}", shortened(&format!("{table}.{name}")));
        self.problem(place, (table, name), ProblemKind::Unknown, message, help);
    }

    fn missing(&mut self, table: &str, number: usize, name: &str, place: Place) {
        let message = format!("{} is missing", path(table, number, name));
        let help = format!("add {name} below [{table}]");
        self.problem(place, (table, name), ProblemKind::Missing, message, help);
    }

    fn set(&mut self, place: &str, assignment: &str) {
        let place = Place::Option(place.to_owned());
        let parsed = assignment.split_once('=').and_then(|(key, value)| Some((key.trim().split_once('.')?, value.trim())));
        match parsed {
            Some(((BOX, _), _)) => {
                let message = "the keys of boxes cannot be set one by one".to_owned();
                self.problem(place, (BOX, ""), ProblemKind::Misplaced, message, "change the file".to_owned());
            }
            Some(((table, name), value)) if TABLES.contains(&table) => {
                let typed = format!("v = {value}").parse::<toml::Table>().ok().and_then(|mut table| table.remove("v"));
                let value = typed.unwrap_or_else(|| toml::Value::String(value.to_owned()));
                self.problems.retain(|problem| problem.kind != ProblemKind::Missing || !problem.key.is_one_of(table, &[name]));
                self.add(table, 0, name, value, place);
            }
            _ => {
                let help = format!("write it as jumper.speed_m_s=1.9; the tables are {}", TABLES[..4].join(", "));
                self.problem(place, ("", ""), ProblemKind::Syntax, "found no table.key=value of an arena".to_owned(), help);
            }
        }
    }

    fn problem(&mut self, place: Place, (table, name): (&str, &str), kind: ProblemKind, message: String, help: String) {
        self.problems.push(ScenarioProblem { key: KeyPath::new(table, name), kind, place, message, help });
    }

    /// The arena, or all problems.
    fn arena(mut self) -> Result<Arena, Vec<ScenarioProblem>> {
        let is_readable = self.problems.iter().all(|problem| problem.kind != ProblemKind::Syntax);
        for (table, name, ..) in KEYS.iter().filter(|key| key.3 && key.0 != BOX && is_readable) {
            let is_wanted = *table != "flight" || self.values.keys().any(|key| key.0 == *table);
            let key = ((*table).to_owned(), 0, (*name).to_owned());
            let is_told = self.problems.iter().any(|problem| problem.key.is_one_of(table, &[*name]));
            if is_wanted && !self.values.contains_key(&key) && !is_told {
                self.missing(table, 0, name, Place::Nowhere);
            }
        }
        if !self.problems.is_empty() {
            return Err(self.problems);
        }
        let mut document = toml::Table::new();
        let mut boxes = vec![toml::Table::new(); self.boxes];
        for ((table, number, name), (value, _)) in &self.values {
            // Whole numbers are lengths too.
            let value = match value {
                toml::Value::Array(items) => {
                    items.iter().filter_map(self::number).map(toml::Value::Float).collect::<Vec<_>>().into()
                }
                other => self::number(other).map_or_else(|| other.clone(), toml::Value::Float),
            };
            if table == BOX {
                boxes[*number].insert(name.clone(), value);
            } else if let Some(table) = document.entry(table).or_insert_with(|| toml::Table::new().into()).as_table_mut() {
                table.insert(name.clone(), value);
            }
        }
        document.insert(BOX.to_owned(), boxes.into_iter().map(toml::Value::Table).collect::<Vec<_>>().into());
        let keys: ArenaKeys = document.try_into().map_err(|error: toml::de::Error| {
            let message = format!("these are no keys of an arena: {}", error.message());
            let help = format!("the tables are {}", TABLES.join(", "));
            let place = Place::Nowhere;
            vec![ScenarioProblem { key: KeyPath::default(), kind: ProblemKind::Syntax, place, message, help }]
        })?;
        Arena::new(keys).map_err(|problems| problems.into_iter().map(|problem| self.placed(problem)).collect())
    }

    /// A problem of the arena at the position of its key.
    fn placed(&self, problem: ArenaProblem) -> ScenarioProblem {
        let ArenaProblem { table, number, name, message, help } = problem;
        let key = (table.to_owned(), number.unwrap_or(0), name.to_owned());
        let place = self.values.get(&key).map_or(Place::Nowhere, |(_, place)| place.clone());
        ScenarioProblem { key: KeyPath::new(table, name), kind: ProblemKind::Value, place, message, help }
    }
}

/// A key as a reader finds it.
fn path(table: &str, number: usize, name: &str) -> String {
    if table == BOX { format!("box {}: {name}", number + 1) } else { format!("{table}.{name}") }
}
