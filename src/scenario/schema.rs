//! The JSON schema of a scenario, from the catalogue of its keys.

use serde_json::{Map, Value, json};

use super::{
    CATALOGUE, Kind,
    kind::{MOST, SPEED_LEAST, SPEED_MOST},
    layers::{APPLIES_TO, LAYER_KEYS},
};
use crate::{
    planner::{Amount, Objective},
    world::{LayerName, SpeedLevels},
};

/// The JSON schema (draft 2020-12) of a scenario as a document: its tables with the keys of [`CATALOGUE`], their kinds, bounds and
/// meanings. It holds for a TOML scenario as well.
///
/// What several keys mean together is no part of it: [`Scenario::new`](super::Scenario::new) checks that.
pub fn scenario_schema() -> Value {
    let mut tables = Map::new();
    for key in &CATALOGUE {
        let table =
            tables.entry(key.table).or_insert_with(|| json!({ "type": "object", "properties": {}, "additionalProperties": false }));
        let mut value = of_kind(key.kind);
        value["description"] = key.help.into();
        if key.kind == Kind::Layer {
            // Layers have names of their own.
            table["additionalProperties"] = value;
            continue;
        }
        table["properties"][key.name] = value;
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "chta scenario",
        "description": "A scenario of constrained hopping traversability analysis: body, hopper, surface, terrain, search and errors.",
        "type": "object",
        "properties": tables,
        "additionalProperties": false,
    })
}

/// The values of a kind.
fn of_kind(kind: Kind) -> Value {
    let number = |min: f64, max: f64| json!({ "type": "number", "minimum": min, "maximum": max });
    let list = |of: Value, least: usize| json!({ "type": "array", "items": of, "minItems": least });
    match kind {
        Kind::Number { min, max } => number(min, max),
        Kind::AngleOrUnlimited => json!({ "anyOf": [number(0.0, 90.0), { "const": "inf" }] }),
        Kind::AngleRange => pair(&[number(-360.0, 360.0), number(-360.0, 360.0)]),
        Kind::MapPoint => pair(&[number(-1e12, 1e12), number(-1e12, 1e12)]),
        Kind::MapOrSpacePoint => json!({ "anyOf": [of_kind(Kind::MapPoint), space_point()] }),
        Kind::SpaceBounds => pair(&[space_point(), space_point()]),
        Kind::LonLat => pair(&[number(-180.0, 360.0), number(-90.0, 90.0)]),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::MapPoints => list(of_kind(Kind::MapPoint), 0),
        Kind::SlipCurve => list(pair(&[number(-89.0, 89.0), number(0.0, 1.0)]), 0),
        Kind::LonLats => list(of_kind(Kind::LonLat), 0),
        Kind::CountOrAuto => json!({ "anyOf": [{ "type": "integer", "minimum": 0, "maximum": 100_000 }, { "const": "auto" }] }),
        Kind::Count { min, max: MOST } => json!({ "type": "integer", "minimum": min }),
        Kind::Count { min, max } => json!({ "type": "integer", "minimum": min, "maximum": max }),
        // A number that JSON does not have, such as NaN, or a long one, is a text.
        Kind::NumberOrNone => {
            json!({ "anyOf": [{ "type": "number" }, { "type": "string", "pattern": "^ *([Nn][Oo][Nn][Ee]|[-+]?[0-9.]+([eE][-+]?[0-9]+)?|[-+]?[Nn][Aa][Nn]|[-+]?[Ii][Nn][Ff]([Ii][Nn][Ii][Tt][Yy])?) *$" }] })
        }
        Kind::Word(words) => json!({ "enum": words }),
        Kind::Speeds => {
            json!({ "type": "array", "items": number(SPEED_LEAST, SPEED_MOST), "minItems": 1, "maxItems": SpeedLevels::MOST })
        }
        Kind::Amounts => {
            let names = Amount::ALL.map(Amount::name);
            let items = json!({ "anyOf": [{ "enum": names }, { "pattern": LayerName::LIMIT_PATTERN }] });
            json!({ "type": "array", "items": items, "minItems": 1, "maxItems": Objective::MOST, "uniqueItems": true })
        }
        Kind::FaceGroups => {
            let of_group = json!({
                "friction_coefficient": number(0.0, 1e6), "rest_slope_max_deg": of_kind(Kind::AngleOrUnlimited), "keep_out": of_kind(Kind::Flag),
            });
            let group = json!({ "type": "object", "properties": of_group, "additionalProperties": false, "minProperties": 1 });
            json!({ "type": "object", "additionalProperties": group, "minProperties": 1 })
        }
        Kind::Layer => {
            let of_key = |(name, meaning): (&str, &str)| {
                let mut value = match name {
                    "raster" => of_kind(Kind::Text),
                    "applies_to" => {
                        let word = json!({ "enum": APPLIES_TO });
                        json!({ "anyOf": [word, { "type": "array", "items": word, "minItems": 1 }] })
                    }
                    "outage_max_s" | "cost_per_contact" | "cost_per_m" | "total_max" => json!({ "type": "number", "minimum": 0 }),
                    "outage_hops_max" => json!({ "type": "integer", "minimum": 0 }),
                    "exempt_targets" => of_kind(Kind::Flag),
                    _ => json!({ "type": "number" }),
                };
                value["description"] = meaning.into();
                (name.to_owned(), value)
            };
            let keys: Map<_, _> = LAYER_KEYS.into_iter().map(of_key).collect();
            json!({ "type": "object", "properties": keys, "additionalProperties": false, "required": ["raster"] })
        }
        Kind::Text => json!({ "type": "string", "pattern": "\\S" }),
    }
}

/// Three numbers in metres.
fn space_point() -> Value {
    json!({ "type": "array", "items": { "type": "number", "minimum": -1e12, "maximum": 1e12 }, "minItems": 3, "maxItems": 3 })
}

/// Two values.
fn pair(numbers: &[Value; 2]) -> Value {
    json!({ "type": "array", "prefixItems": numbers, "minItems": 2, "maxItems": 2 })
}
