//! The margins of one hop as plain data: one set of names for JSON, CSV and text.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use serde_json::json;

use crate::{
    hop::{HopMargins, MARGINS},
    quantity::unit_of,
};

/// The name of the place of the least height over the ground.
const TERRAIN_AT: &str = "terrain_from_takeoff_m";

/// The margins of a hop to its limits. In JSON an object with one number for every limit that the hop has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopMarginsRecord(pub HopMargins);

impl HopMarginsRecord {
    /// Every margin with its name; `None` where there is no such limit.
    fn each(&self) -> impl Iterator<Item = (&'static str, Option<f64>)> + '_ {
        let terrain = std::iter::once((TERRAIN_AT, self.0.terrain_from_takeoff_m()));
        self.0.rows().map(|(row, value)| (row.key, value)).chain(terrain)
    }

    /// The names of the columns in a CSV.
    pub(super) fn columns() -> impl Iterator<Item = String> {
        MARGINS.iter().map(|row| row.key).chain([TERRAIN_AT]).map(|key| format!("margin_{key}"))
    }

    /// The fields of a row of a CSV, empty where there is no such limit.
    pub(super) fn fields(&self) -> impl Iterator<Item = String> + '_ {
        self.each().map(|(_, value)| value.map(|value| value.to_string()).unwrap_or_default())
    }

    /// Lines for reading: limit, margin and unit.
    pub(super) fn lines(&self) -> Vec<String> {
        let at = self.0.terrain_from_takeoff_m();
        let line = |(key, value): (&'static str, f64)| {
            let unit = unit_of(key);
            let ending = if unit == "m/s" { "_m_s".len() } else { unit.len() + 1 };
            let name = key[..key.len() - ending].replace('_', "-");
            let place = at.filter(|_| key == "terrain_m").map(|at_m| format!("  {at_m:.3} m from the take-off"));
            format!("{name:<22}{value:>14.6} {unit}{}", place.unwrap_or_default())
        };
        self.0.rows().filter_map(|(row, value)| Some((row.key, value?))).map(line).collect()
    }
}

impl Serialize for HopMarginsRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.each().filter_map(|(key, value)| Some((key, value?))))
    }
}

impl<'de> Deserialize<'de> for HopMarginsRecord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut values = BTreeMap::<String, f64>::deserialize(deserializer)?;
        let terrain_from_takeoff_m = values.remove(TERRAIN_AT);
        let margins = HopMargins::from_rows(|row| values.remove(row.key), terrain_from_takeoff_m);
        match values.keys().next() {
            Some(key) => Err(D::Error::custom(format!("\"{key}\" is no margin of a hop"))),
            None => Ok(Self(margins)),
        }
    }
}

impl JsonSchema for HopMarginsRecord {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "HopMarginsRecord".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let property = |(key, meaning): (&str, String)| (key.to_owned(), json!({ "type": "number", "description": meaning }));
        let rows = MARGINS.iter().map(|row| {
            let side = if row.key.contains("_min_") {
                " its least value"
            } else if row.key.contains("_max_") {
                " its greatest value"
            } else {
                ""
            };
            let to = if side.is_empty() { String::new() } else { format!(" to{side}") };
            (row.key, format!("Margin{to} of the limit {}; absent without such a limit.", row.limit))
        });
        let place =
            "Where the margin of the terrain is least, horizontally from the take-off; absent if the terrain sets no limit.";
        let properties: serde_json::Map<_, _> = rows.chain([(TERRAIN_AT, place.to_owned())]).map(property).collect();
        json_schema!({
            "description": "The margins of a hop to its limits, one number for every limit that the hop has.",
            "type": "object",
            "properties": properties,
            "additionalProperties": false,
        })
    }
}
