//! Counts of refused hops by the limit that refuses them.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{
    graph::RefusalCounts,
    world::{LayerName, Limit},
};

/// The number of refusals by limit, in the order of the limits' names; a limit that refuses nothing is absent. In JSON an object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LimitCounts(Vec<(Limit, u64)>);

impl LimitCounts {
    /// Every limit that refuses, with its count.
    pub fn iter(&self) -> impl Iterator<Item = (Limit, u64)> + '_ {
        self.0.iter().copied()
    }

    /// Whether no limit refuses.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// From the greatest count to the least; equal counts in the order of the names.
    pub fn ranked(&self) -> Vec<(Limit, u64)> {
        let mut ranked = self.0.clone();
        ranked.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        ranked
    }
}

impl FromIterator<(Limit, u64)> for LimitCounts {
    fn from_iter<I: IntoIterator<Item = (Limit, u64)>>(counts: I) -> Self {
        let mut counts: Vec<_> = counts.into_iter().collect();
        counts.sort_by_key(|(limit, _)| limit.name());
        Self(counts)
    }
}

impl From<&RefusalCounts> for LimitCounts {
    fn from(refusals: &RefusalCounts) -> Self {
        refusals.ranked().into_iter().collect()
    }
}

impl Serialize for LimitCounts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.iter())
    }
}

/// A limit as the key of a map, in the order of names.
#[derive(Deserialize, PartialEq, Eq)]
struct ByName(Limit);

impl Ord for ByName {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.name().cmp(other.0.name())
    }
}

impl PartialOrd for ByName {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<'de> Deserialize<'de> for LimitCounts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let counts = BTreeMap::<ByName, u64>::deserialize(deserializer)?;
        Ok(Self(counts.into_iter().map(|(ByName(limit), count)| (limit, count)).collect()))
    }
}

impl JsonSchema for LimitCounts {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "LimitCounts".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let count = generator.subschema_for::<u64>();
        let property = |limit: Limit| {
            let mut count = count.clone();
            count.insert("description".to_owned(), format!("Refusals by the limit {limit}; absent if it refuses nothing.").into());
            (limit.name().to_owned(), count.to_value())
        };
        let properties: serde_json::Map<String, serde_json::Value> = Limit::ALL.into_iter().map(property).collect();
        let mut of_layer = count.clone();
        of_layer.insert("description".to_owned(), "Refusals by a layer of the scenario; absent if it refuses nothing.".into());
        let layers = serde_json::Map::from_iter([(LayerName::LIMIT_PATTERN.to_owned(), of_layer.to_value())]);
        json_schema!({ "type": "object", "properties": properties, "patternProperties": layers, "additionalProperties": false })
    }
}
