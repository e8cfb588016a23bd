//! The JSON schemas of docs/schema: current, complete, and that of a scenario as strict as the reader.
//!
//! `CHTA_UPDATE_DOCS=1 cargo test --test library schemas` writes them again.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use chta::{
    scenario::{CATALOGUE, Kind},
    study::SchemaKind,
};
use serde_json::{Value, json};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schema")
}

#[test]
fn the_checked_in_schemas_are_current() {
    let update = std::env::var_os("CHTA_UPDATE_DOCS").is_some();
    if update {
        fs::create_dir_all(folder()).unwrap();
    }
    let mut names = BTreeSet::new();
    for kind in SchemaKind::all() {
        let name = format!("{}.json", kind.name());
        let text = serde_json::to_string_pretty(&kind.schema()).unwrap() + "\n";
        let file = folder().join(&name);
        if update {
            fs::write(&file, &text).unwrap();
        }
        assert!(
            fs::read_to_string(&file).unwrap_or_default() == text,
            "docs/schema/{name} is out of date: run with CHTA_UPDATE_DOCS=1"
        );
        names.insert(name);
    }
    let found: BTreeSet<_> =
        fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(found, names, "docs/schema has a file of no kind");
}

/// The places of a schema where anything goes: `true`, a description alone, or an object without stated keys.
fn vague(schema: &Value, at: &str, found: &mut Vec<String>) {
    let Some(keys) = schema.as_object() else {
        found.push(at.to_owned());
        return;
    };
    let composed = ["anyOf", "oneOf", "allOf"].into_iter().filter_map(|key| Some((key, keys.get(key)?.as_array()?)));
    let says = ["type", "$ref", "enum", "const", "pattern"].iter().any(|key| keys.contains_key(*key));
    let mut has_parts = false;
    for (key, parts) in composed {
        has_parts = true;
        parts.iter().enumerate().for_each(|(i, part)| vague(part, &format!("{at}/{key}/{i}"), found));
    }
    if !says && !has_parts {
        found.push(at.to_owned());
    }
    let is_a = |name: &str| match keys.get("type") {
        Some(Value::Array(types)) => types.iter().any(|one| one == name),
        Some(one) => one == name,
        None => false,
    };
    if is_a("object") && !has_parts && !["properties", "patternProperties"].iter().any(|key| keys.contains_key(*key)) {
        match keys.get("additionalProperties") {
            Some(of) if of.is_object() => vague(of, &format!("{at}/additionalProperties"), found),
            _ => found.push(at.to_owned()),
        }
    }
    if is_a("array") && !["items", "prefixItems"].iter().any(|key| keys.contains_key(*key)) {
        found.push(at.to_owned());
    }
    if let Some(items) = keys.get("items") {
        vague(items, &format!("{at}/items"), found);
    }
    for group in ["properties", "$defs"] {
        for (name, of) in keys.get(group).and_then(Value::as_object).into_iter().flatten() {
            vague(of, &format!("{at}/{group}/{name}"), found);
        }
    }
}

#[test]
fn no_schema_leaves_a_key_open() {
    for kind in SchemaKind::all() {
        let mut found = Vec::new();
        vague(&kind.schema(), "", &mut found);
        assert_eq!(found, Vec::<String>::new(), "{}", kind.name());
    }
    // Planted.
    for open in
        [json!(true), json!({ "description": "anything" }), json!({ "type": "object" }), json!({ "type": ["array", "null"] })]
    {
        let mut found = Vec::new();
        vague(&json!({ "type": "object", "properties": { "planted": open } }), "", &mut found);
        assert_eq!(found, ["/properties/planted"], "{open}");
    }
}

/// TOML as JSON; JSON has no infinity, for which a scenario may say `"inf"`.
fn as_json(value: &toml::Value) -> Value {
    match value {
        toml::Value::Float(number) if number.is_infinite() => json!("inf"),
        toml::Value::Array(items) => items.iter().map(as_json).collect(),
        toml::Value::Table(keys) => keys.iter().map(|(key, value)| (key.clone(), as_json(value))).collect(),
        other => serde_json::to_value(other).unwrap(),
    }
}

#[test]
fn the_schema_of_a_scenario_holds_for_all_shipped_ones() {
    let validator = jsonschema::validator_for(&SchemaKind::Scenario.schema()).unwrap();
    let mut count = 0;
    for entry in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenarios")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let scenario: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
            let problems: Vec<_> = validator.iter_errors(&as_json(&scenario.into())).map(|error| error.to_string()).collect();
            assert_eq!(problems, Vec::<String>::new(), "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 15, "only {count}");
}

/// A value that a key takes, and one that it does not.
fn value_and_mistake(kind: Kind) -> (Value, Value) {
    match kind {
        Kind::Number { min, max } => (json!(0.5 * (min + max)), json!(max * 1.5 + 1.0)),
        Kind::AngleOrUnlimited => (json!("inf"), json!("steep")),
        Kind::AngleRange => (json!([10.0, 80.0]), json!([10.0])),
        Kind::MapPoint => (json!([1.0, -2.0]), json!([1.0, 2.0, 3.0])),
        Kind::MapOrSpacePoint => (json!([1.0, -2.0, 3.0]), json!([1.0])),
        Kind::SpaceBounds => (json!([[0.0, -1.0, 2.0], [1.0, 2.0, 3.0]]), json!([[0.0, -1.0], [1.0, 2.0]])),
        Kind::LonLat => (json!([200.0, -80.0]), json!([20.0, 91.0])),
        Kind::Flag => (json!(true), json!("yes")),
        Kind::MapPoints => (json!([[1.0, 2.0], [3.0, 4.0]]), json!([1.0, 2.0])),
        Kind::LonLats => (json!([[1.0, 2.0]]), json!([[1.0, 200.0]])),
        Kind::CountOrAuto => (json!("auto"), json!("automatic")),
        Kind::Count { min, .. } => (json!(min), json!(2.5)),
        Kind::NumberOrNone => (json!("none"), json!("nothing")),
        Kind::Word(words) => (json!(words[0]), json!("other")),
        Kind::Speeds => (json!([1.0, 2.5]), json!([])),
        Kind::FaceGroups => (json!({ "ice": { "keep_out": true } }), json!({ "ice": {} })),
        Kind::Layer => (json!({ "raster": "sun.tif", "min": 0.3 }), json!({ "raster": "sun.tif", "least": 0.3 })),
        Kind::SlipCurve => (json!([[0.0, 0.0], [20.0, 0.4]]), json!([[0.0, 1.5]])),
        Kind::Amounts => (json!(["hops", "energy"]), json!(["fuel"])),
        Kind::Text => (json!("mars"), json!(" ")),
    }
}

#[test]
fn the_schema_of_a_scenario_knows_every_key_and_no_other() {
    let validator = jsonschema::validator_for(&SchemaKind::Scenario.schema()).unwrap();
    for key in &CATALOGUE {
        let (value, mistake) = value_and_mistake(key.kind);
        let with = |name: &str, value: &Value| json!({ key.table: { name: value } });
        assert!(validator.is_valid(&with(key.name, &value)), "{} = {value}", key.path());
        assert!(!validator.is_valid(&with(key.name, &mistake)), "{} = {mistake}", key.path());
        // Layers have names of their own.
        let other = validator.is_valid(&with(&format!("{}x", key.name), &value));
        assert_eq!(other, key.kind == Kind::Layer, "{}x", key.path());
    }
    assert!(!validator.is_valid(&json!({ "machine": {} })));
}
