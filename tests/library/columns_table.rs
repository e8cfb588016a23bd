//! docs/columns.md: every key of every JSON document and every column of every CSV that is written, with unit and meaning, from the
//! schemas and the writers.
//!
//! `CHTA_UPDATE_DOCS=1 cargo test --test library columns_table` writes it again.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{collections::BTreeMap, fmt::Write, path::Path};

use chta::{
    chain::csv::{CHAIN_COLUMNS, MEASURED_COLUMNS, PAIRS_COLUMNS},
    quantity::unit_of,
    report::{
        CompareAnswer, FanAnswer, HopRecord, MapKnowledge, SitesAnswer, TargetHopRecord, TradeAnswer,
        landings::{CsvLandings, LandingColumns},
        trajectory_columns, write_map_contacts_csv, write_paths_csv, write_target_hops_csv,
    },
    scenario::CATALOGUE,
    study::SchemaKind,
};
use serde_json::{Map, Value, json};

const HEAD: &str = "# Keys and columns\n\nWhat every JSON document and every CSV holds, with units. `tests/library/columns_table.rs` writes \
     this file from the schemas ([schema](schema), also printed by `chta schema KIND`) and from the writers. Names end in their unit; \
     angles are above the horizontal as the traveller sees them, headings clockwise from north. \"May be absent\": the key is there only \
     where it has a meaning; \"or null\": it is always there, without a value.\n";

/// Columns that are no key of a JSON document: table, column, meaning.
const ALONE: [(&str, &str, &str); 54] = [
    ("contacts", "contact", "number of the contact, from 1: the start has 1, a goal elsewhere 2"),
    ("contacts", "x_m", "x of the point of the surface"),
    ("contacts", "y_m", "y of the point of the surface"),
    ("contacts", "z_m", "height of the point of the surface"),
    ("contacts", "facet", "the facet it lies on, by its number from 1; on an edge one of them"),
    ("contacts", "area_m2", "the area it stands for: that of its facet, divided evenly among the contacts on it"),
    ("contacts", "hops", "fewest hops from the start; blank if it is not reached over these contacts, or not within `--hops-max`"),
    ("contacts", "from_contact", "the contact that the last hop comes from; blank for the start and where none leads"),
    ("contacts", "return_hops", "fewest hops back to the start; with `--return`, blank where no way was found"),
    ("contacts", "return_to_contact", "the contact that the first hop back goes to; with `--return`"),
    ("path", "goal", "number of the goal, from 1; in the paths of `map` alone"),
    ("trajectory", "time_s", "time since the start"),
    ("trajectory", "hop", "number of the hop, from 1"),
    ("trajectory", "phase", "`preparation`, `flight`, `settling` or `rest`"),
    ("trajectory", "x_m", "position along the chain"),
    ("trajectory", "z_m", "height"),
    ("trajectory", "vx_m_s", "velocity along the chain"),
    ("trajectory", "vz_m_s", "velocity upwards"),
    ("trajectory", "map_x_m", "easting; on a map"),
    ("trajectory", "map_y_m", "northing; on a map"),
    ("trajectory", "v_map_x_m_s", "velocity along the map's x; on a map"),
    ("trajectory", "v_map_y_m_s", "velocity along the map's y; on a map"),
    ("trajectory", "lon_deg", "longitude, east positive; on a map of a known projection"),
    ("trajectory", "lat_deg", "planetocentric latitude; on a map of a known projection"),
    ("trajectory", "v_east_m_s", "velocity to true east; on a map of a known projection, blank at a pole"),
    ("trajectory", "v_north_m_s", "velocity to true north; on a map of a known projection, blank at a pole"),
    ("landings", "trial", "number of the trial, from 0"),
    ("landings", "hop", "number of the hop in its trial, from 1"),
    ("landings", "policy", "policy flown"),
    ("landings", "outcome", "outcome of the trial, at the landing of its last hop; else blank"),
    ("landings", "direction", "1 towards +x, -1 towards -x; along a chain"),
    ("landings", "heading_deg", "direction of flight, clockwise from grid north; on a map"),
    ("landings", "heading_true_deg", "the same from true north at the take-off; on a map of a known projection, blank at a pole"),
    ("landings", "takeoff_speed_m_s", "actual take-off speed"),
    ("landings", "takeoff_angle_deg", "actual take-off angle"),
    ("landings", "landing_speed_m_s", "actual landing speed"),
    ("landings", "landing_angle_deg", "actual landing angle, negative on the way down"),
    ("landings", "error_m", "horizontal distance from the planned landing to the position of rest"),
    ("landings", "takeoff", "actual take-off"),
    ("landings", "planned", "planned landing"),
    ("landings", "landing", "first contact with the ground"),
    ("landings", "rest", "position of rest, after bounce and roll"),
    ("landings", "drawn_takeoff_speed_m_s", "actual minus commanded take-off speed, as drawn; with `--draws`"),
    ("landings", "drawn_takeoff_angle_deg", "actual minus commanded take-off angle, as drawn; with `--draws`"),
    ("landings", "drawn_heading_deg", "actual minus commanded heading, clockwise, as drawn; with `--draws`"),
    ("landings", "drawn_drift_along_m", "displacement after the landing along the heading, as drawn; with `--draws`"),
    ("landings", "drawn_drift_across_m", "displacement after the landing to the left of the heading, as drawn; with `--draws`"),
    (
        "landings",
        "drawn_position_x_m",
        "believed minus actual position before the hop, along the chain or east on a map, as drawn; with `--draws`",
    ),
    (
        "landings",
        "drawn_position_y_m",
        "believed minus actual position before the hop, to the left or north on a map, as drawn; with `--draws`",
    ),
    ("landings", "drawn_friction_coefficient", "added to the friction coefficient in this trial, as drawn; with `--draws`"),
    ("trade", "KEY", "value of the varied key, one column for each"),
    ("landings", "x", "along the chain, or easting on a map"),
    ("landings", "y", "to the left of the plane of travel, or northing on a map"),
    ("landings", "z", "height"),
];

/// The objects of a schema that stand under a name, and that of the document itself.
struct Records {
    by_name: BTreeMap<String, Value>,
}

/// The stated keys of an object, through its parts.
fn keys_of(schema: &Value) -> Vec<(String, Value, bool)> {
    let mut found: Vec<(String, Value, bool)> = Vec::new();
    let required = |name: &str| schema["required"].as_array().is_some_and(|names| names.iter().any(|one| one == name));
    for (name, key) in schema["properties"].as_object().into_iter().flatten() {
        found.push((name.clone(), key.clone(), required(name)));
    }
    // Keys with a name of one's own, after what they begin with.
    for (pattern, key) in schema["patternProperties"].as_object().into_iter().flatten() {
        let begins = pattern.trim_start_matches('^').split('[').next().unwrap_or_default();
        found.push((format!("{begins}NAME"), key.clone(), false));
    }
    for part in ["anyOf", "oneOf", "allOf"].iter().filter_map(|group| schema[*group].as_array()).flatten() {
        for (name, key, _) in keys_of(part) {
            // What some form of the object has may be absent.
            if found.iter().all(|(known, ..)| *known != name) {
                found.push((name, key, false));
            }
        }
    }
    found
}

/// The kind of a value in words.
fn kind_of(schema: &Value) -> String {
    let of_reference = |reference: &str| reference.rsplit('/').next().unwrap_or_default().to_owned();
    if let Some(reference) = schema["$ref"].as_str() {
        let name = of_reference(reference);
        return format!("[{name}](#{})", name.to_lowercase());
    }
    if let Some(constant) = schema.get("const") {
        return format!("`{}`", constant.as_str().unwrap_or_default());
    }
    if let Some(parts) = schema["anyOf"].as_array() {
        return parts.iter().map(kind_of).collect::<Vec<_>>().join(" or ");
    }
    let types = match &schema["type"] {
        Value::Array(types) => types.iter().filter_map(Value::as_str).collect(),
        Value::String(one) => vec![one.as_str()],
        _ => Vec::new(),
    };
    let words = types.into_iter().map(|one| match one {
        "array" => {
            let count = schema["minItems"].as_u64().filter(|count| schema["maxItems"].as_u64() == Some(*count));
            let of = if schema["items"].is_object() { kind_of(&schema["items"]) } else { "numbers".to_owned() };
            count.map_or(format!("list of {of}"), |count| format!("{count} times {of}"))
        }
        "integer" => "whole number".to_owned(),
        "string" => "text".to_owned(),
        "boolean" => "true or false".to_owned(),
        other => other.to_owned(),
    });
    words.collect::<Vec<_>>().join(" or ")
}

fn cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// The table of an object's keys.
fn table(text: &mut String, keys: &[(String, Value, bool)], of: &str) {
    text.push_str("| key | value | unit | meaning |\n|---|---|---|---|\n");
    for (name, key, required) in keys {
        let meaning = key["description"].as_str().unwrap_or_else(|| panic!("{of}: {name} has no description"));
        let absent = if *required || meaning.contains("absent") { "" } else { " (may be absent)" };
        writeln!(text, "| `{name}` | {} | {} | {}{absent} |", kind_of(key), unit_of(name), cell(meaning)).unwrap();
    }
}

impl Records {
    fn add(&mut self, schema: &Value) {
        for (name, of) in schema["$defs"].as_object().into_iter().flatten() {
            if name != "Scenario" {
                self.by_name.insert(name.clone(), of.clone());
            }
        }
    }

    /// The meaning of a key of one of these records.
    fn meaning(&self, records: &[&str], name: &str) -> Option<String> {
        records.iter().find_map(|record| {
            let keys = keys_of(self.by_name.get(*record)?);
            keys.into_iter().find(|(key, ..)| key == name).and_then(|(_, key, _)| Some(key["description"].as_str()?.to_owned()))
        })
    }
}

/// A made-up value of a schema, so that a record has all its keys.
fn value_of(schema: &Value, records: &Records) -> Value {
    if let Some(reference) = schema["$ref"].as_str() {
        return value_of(&records.by_name[reference.rsplit('/').next().unwrap()], records);
    }
    if let Some(words) = schema["enum"].as_array() {
        return words[0].clone();
    }
    if let Some(parts) = schema["anyOf"].as_array() {
        return value_of(&parts[0], records);
    }
    let one = schema["type"].as_str().or_else(|| schema["type"][0].as_str()).unwrap();
    match one {
        "integer" => json!(1),
        "number" => json!(1.0),
        "boolean" => json!(true),
        "string" if schema["pattern"].is_string() => json!("terrain/terrain"),
        "string" => json!("text"),
        "array" => {
            let least = schema["minItems"].as_u64().unwrap_or(0);
            let item = || if schema["items"].is_object() { value_of(&schema["items"], records) } else { json!(1.0) };
            (0..least).map(|_| item()).collect::<Vec<_>>().into()
        }
        _ => keys_of(schema).into_iter().map(|(name, key, _)| (name, value_of(&key, records))).collect::<Map<_, _>>().into(),
    }
}

/// The columns of a written CSV.
fn header(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<String> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap().lines().next().unwrap().split(',').map(str::to_owned).collect()
}

/// Title, table of [`ALONE`], columns, and the records whose keys they are.
fn tables(records: &Records) -> Vec<(&'static str, &'static str, Vec<String>, Vec<&'static str>)> {
    let made_up = |name: &str| value_of(&records.by_name[name], records);
    let hop: HopRecord = serde_json::from_value(made_up("HopRecord")).unwrap();
    let target_hops = [TargetHopRecord { visit: 1, target: Some(1), hop: hop.clone() }];
    let hops = [hop];
    let sites = json!({
        "stride": 1, "nodes_per_post": 1, "nodes": 1, "amount": "hops", "targets_m": [], "searches": 1, "parts": 1,
        "sites": [made_up("SiteRecord")]
    });
    let sites: SitesAnswer = serde_json::from_value(sites).unwrap();
    let compare: CompareAnswer = serde_json::from_value(json!({ "compared": [made_up("CompareRow")] })).unwrap();
    let mut row = made_up("TradeRow");
    row["KEY"] = json!(1.0);
    let trade: TradeAnswer = serde_json::from_value(json!({ "vary": [{ "key": "KEY", "values": [1.0] }], "rows": [row] })).unwrap();
    let fan = json!({ "from_m": [0.0, 0.0], "headings": 1, "length_m": 1.0, "rays": [made_up("FanRecord")] });
    let fan: FanAnswer = serde_json::from_value(fan).unwrap();
    let columns = |known| header(|out| CsvLandings::begin(out, LandingColumns { known, drawn: true }).map(drop));
    let mut landings = columns(MapKnowledge::Nothing);
    for column in columns(MapKnowledge::Projection) {
        if !landings.contains(&column) {
            landings.push(column);
        }
    }
    let trajectory = trajectory_columns(MapKnowledge::Projection).into_iter().map(str::to_owned).collect();
    vec![
        (
            "`path.csv`, and the paths of `map --paths`",
            "path",
            header(|out| write_paths_csv([&hops[..]], MapKnowledge::Projection, out)),
            vec!["HopRecord"],
        ),
        (
            "`path.csv` of a mission over targets",
            "visits",
            header(|out| write_target_hops_csv(&target_hops, MapKnowledge::Projection, out)),
            vec!["TargetHopRecord", "HopRecord"],
        ),
        ("A path in time (`--trajectory`)", "trajectory", trajectory, vec![]),
        ("Landings of trials (`simulate --output`), CSV and Parquet", "landings", landings, vec![]),
        ("Contacts of a mesh (`map --output`)", "contacts", header(|out| write_map_contacts_csv(&[], true, out)), vec![]),
        (
            "`sites --output` (beside columns for each target: hops, and the share of trials that arrives)",
            "sites",
            header(|out| sites.write_csv(out)),
            vec!["SiteRecord"],
        ),
        ("`fan --output`", "fan", header(|out| fan.write_csv(out)), vec!["FanRecord"]),
        (
            "`trade --output`",
            "trade",
            header(|out| trade.write_csv(out)),
            vec!["TradeRow", "TotalsRecord", "MarginsRecord", "SuccessBudgetRecord"],
        ),
        (
            "`compare --output`",
            "compare",
            header(|out| compare.write_csv(out)),
            vec!["CompareRow", "TotalsRecord", "MarginsRecord"],
        ),
    ]
}

/// The meaning of a column: that of the JSON key with its name, or its own.
fn meaning(records: &Records, table: &str, column: &str, of: &[&str]) -> String {
    let alone = |name: &str| {
        ALONE.iter().find(|(place, known, _)| *place == table && *known == name).map(|(.., meaning)| (*meaning).to_owned())
    };
    let margin = column.strip_prefix("margin_").and_then(|key| records.meaning(&["HopMarginsRecord"], key));
    // Positions of landings: which point, and along which axis.
    let position = || {
        let (point, rest) = column.split_once('_')?;
        let axis = rest.strip_prefix("map_").unwrap_or(rest).strip_suffix("_m")?;
        Some(format!("{}: {}", alone(point)?, alone(axis)?))
    };
    margin
        .or_else(|| records.meaning(of, column))
        .or_else(|| alone(column))
        .or_else(position)
        .unwrap_or_else(|| panic!("the column {column} of {table} has no meaning: add it to ALONE"))
}

fn document() -> String {
    let mut text = HEAD.to_owned();
    let mut records = Records { by_name: BTreeMap::new() };
    let answers: Vec<_> =
        SchemaKind::all().filter(|kind| matches!(kind, SchemaKind::Answer(_))).map(|kind| (kind.name(), kind.schema())).collect();
    for (_, schema) in &answers {
        records.add(schema);
    }
    let envelope = ["schema", "chta_version", "scenario", "inputs", "warnings", "crs"];
    let is_envelope = |name: &str| envelope.contains(&name);
    text.push_str("\n## Documents\n\n### All\n\n");
    let mut keys: Vec<_> = keys_of(&answers[0].1).into_iter().filter(|(name, ..)| is_envelope(name)).collect();
    for (name, key, _) in &mut keys {
        match name.as_str() {
            "schema" => *key = json!({ "type": "string", "description": key["description"] }),
            "scenario" => *key = json!({ "$ref": "#/Scenario", "description": key["description"] }),
            _ => {}
        }
    }
    table(&mut text, &keys, "all documents");
    for (name, schema) in &answers {
        writeln!(text, "\n### `{name}`\n").unwrap();
        let keys: Vec<_> = keys_of(schema).into_iter().filter(|(name, ..)| !is_envelope(name)).collect();
        // An answer of one of several forms.
        match schema["anyOf"].as_array() {
            Some(forms) if keys.is_empty() => {
                writeln!(text, "One of {}.", forms.iter().map(kind_of).collect::<Vec<_>>().join(", ")).unwrap();
            }
            _ => table(&mut text, &keys, name),
        }
    }
    text.push_str("\n## Records\n");
    for (name, schema) in &records.by_name {
        let about = schema["description"].as_str().map(|about| format!("{}\n\n", cell(about))).unwrap_or_default();
        let keys = keys_of(schema);
        writeln!(text, "\n### {name}\n\n{about}").unwrap();
        text.truncate(text.trim_end().len());
        text.push_str("\n\n");
        match schema["enum"].as_array().or_else(|| schema["anyOf"][0]["enum"].as_array()) {
            Some(words) => {
                let words: Vec<_> = words.iter().filter_map(Value::as_str).map(|word| format!("`{word}`")).collect();
                let own = schema["anyOf"][1]["pattern"].as_str().map(|pattern| {
                    let begins = pattern.trim_start_matches('^').split('[').next().unwrap_or_default();
                    format!(", or `{begins}NAME` with a name of the scenario")
                });
                writeln!(text, "One of {}{}.", words.join(", "), own.unwrap_or_default()).unwrap();
            }
            None if keys.is_empty() => writeln!(text, "Text, as in `terrain/landing-speed`.").unwrap(),
            None => table(&mut text, &keys, name),
        }
    }
    text.push_str("\n## Scenario\n\n| key | value | meaning |\n|---|---|---|\n");
    for key in &CATALOGUE {
        writeln!(text, "| `{}` | {} | {} |", key.path(), cell(&key.kind.expected()), cell(key.help)).unwrap();
    }
    text.push_str("\n## CSV\n\nAn absent value is a blank field.\n");
    for (title, place, columns, of) in tables(&records) {
        writeln!(text, "\n### {title}\n\n| column | unit | meaning |\n|---|---|---|").unwrap();
        for column in columns {
            writeln!(text, "| `{column}` | {} | {} |", unit_of(&column), cell(&meaning(&records, place, &column, &of))).unwrap();
        }
    }
    for (title, columns) in [
        ("Chains (read and written)", &CHAIN_COLUMNS[..]),
        ("Pairs of start and goal (read)", &PAIRS_COLUMNS),
        ("Measured errors (read)", &MEASURED_COLUMNS),
    ] {
        writeln!(text, "\n### {title}\n\n| column | unit | meaning |\n|---|---|---|").unwrap();
        for column in columns {
            writeln!(text, "| `{}` | {} | {} |", column.name, unit_of(column.name), cell(column.help)).unwrap();
        }
    }
    text
}

#[test]
fn the_tables_of_keys_and_columns_are_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/columns.md");
    let text = document();
    if std::env::var_os("CHTA_UPDATE_DOCS").is_some() {
        std::fs::write(&file, &text).unwrap();
    }
    let found = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(found == text, "docs/columns.md is out of date: run with CHTA_UPDATE_DOCS=1");
}
