//! The JSON schema of a robot file, from the list of its keys.

use serde_json::{Value, json};

use super::keys::{ROBOT_KEYS, RobotKeyKind};

/// The JSON schema (draft 2020-12) of a robot file as a document.
///
/// What several keys mean together is no part of it: [`read_robot`](super::read_robot) checks that.
pub fn robot_schema() -> Value {
    let table = || json!({ "type": "object", "properties": {}, "additionalProperties": false });
    let (mut robot, mut trunk, mut limb) = (table(), table(), table());
    for key in &ROBOT_KEYS {
        let table = match key.table {
            "robot" => &mut robot,
            "trunk" => &mut trunk,
            _ => &mut limb,
        };
        let mut value = of_kind(key.kind);
        value["description"] = key.help.into();
        match key.name.split_once('.') {
            Some((outer, inner)) => {
                let properties = &mut table["properties"];
                if properties[outer].is_null() {
                    properties[outer] = json!({ "type": "object", "properties": {}, "additionalProperties": false });
                }
                properties[outer]["properties"][inner] = value;
            }
            None => table["properties"][key.name] = value,
        }
    }
    either(&mut trunk, "size_m", "stl");
    limb["required"] = json!(["name", "hip_m"]);
    either(&mut limb, "shell", "workspace_stl");
    limb["properties"]["shell"]["required"] = json!(["radius_max_m"]);
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "chta robot",
        "description": "A robot with legs: its trunk, its limbs, and the limits of its push-off.",
        "type": "object",
        "properties": {
            "robot": robot,
            "trunk": { "type": "array", "items": trunk },
            "limb": { "type": "array", "items": limb, "minItems": 1 },
        },
        "required": ["limb"],
        "additionalProperties": false,
    })
}

/// One of two keys has to be there, and not both.
fn either(table: &mut Value, one: &str, other: &str) {
    table["if"] = json!({ "required": [one] });
    table["then"] = json!({ "not": { "required": [other] } });
    table["else"] = json!({ "required": [other] });
}

/// The values of a kind.
fn of_kind(kind: RobotKeyKind) -> Value {
    let three = |of: Value| json!({ "type": "array", "items": of, "minItems": 3, "maxItems": 3 });
    match kind {
        RobotKeyKind::Text | RobotKeyKind::File => json!({ "type": "string", "pattern": "\\S" }),
        RobotKeyKind::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        RobotKeyKind::NotNegative => json!({ "type": "number", "minimum": 0 }),
        RobotKeyKind::Number => json!({ "type": "number" }),
        RobotKeyKind::Count => json!({ "type": "integer", "minimum": 1 }),
        RobotKeyKind::Three => three(of_kind(RobotKeyKind::Number)),
        RobotKeyKind::ThreePositive => three(of_kind(RobotKeyKind::Positive)),
    }
}
