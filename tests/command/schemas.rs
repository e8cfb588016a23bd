//! The answers of all commands against the schemas that `chta schema` prints.

#![allow(clippy::unwrap_used, reason = "a test that cannot run the program should stop")]

use std::{collections::BTreeMap, path::Path};

use chta::study::SchemaKind;
use serde_json::{Value, json};

use crate::{
    desk::{Desk, chta},
    documents::{documents, kind_of},
};

#[test]
fn every_answer_is_as_its_schema_states() {
    let mut validators = BTreeMap::new();
    for (command, text) in documents() {
        let kind = kind_of(text);
        let validator = validators.entry(kind.name()).or_insert_with(|| {
            let (status, schema, _) = chta(Path::new(env!("CARGO_MANIFEST_DIR")), &["schema", kind.name()]);
            assert_eq!(status, 0);
            jsonschema::validator_for(&serde_json::from_str(&schema).unwrap()).unwrap()
        });
        let mut document: Value = serde_json::from_str(text).unwrap();
        let problems: Vec<_> =
            validator.iter_errors(&document).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert_eq!(problems, Vec::<String>::new(), "{command}");
        // A key beside those stated, or one less, is found.
        document["planted"] = json!(1);
        assert!(!validator.is_valid(&document), "{command}: a planted key");
        let keys = document.as_object_mut().unwrap();
        keys.remove("planted");
        keys.remove("inputs");
        assert!(!validator.is_valid(&document), "{command}: a key that is missing");
    }
}

#[test]
fn schemas_are_listed_and_printed_and_an_unknown_one_is_refused() {
    let desk = Desk::new();
    let names = SchemaKind::all().map(SchemaKind::name).collect::<Vec<_>>().join("\n") + "\n";
    assert_eq!(desk.run(&["schema"]).stdout, names);
    for kind in SchemaKind::all() {
        let ran = desk.run(&["schema", kind.name()]);
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schema").join(format!("{}.json", kind.name()));
        assert!(ran.status == 0 && ran.stdout == std::fs::read_to_string(file).unwrap(), "{}", kind.name());
    }
    desk.refused(
        &["schema", "plam"],
        &["KIND: 'plam' is unknown, expected one of scenario, robot, hop, hop-mesh, check", "the nearest is plan"],
    );
}
