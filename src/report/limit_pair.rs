//! The limits at both ends of an interval as one word.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use crate::world::Limit;

/// The limits that set the least and the greatest feasible angle; in JSON and CSV `lower/upper`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LimitPair {
    /// The limit that sets the least angle.
    pub lower: Limit,
    /// The limit that sets the greatest angle.
    pub upper: Limit,
}

impl fmt::Display for LimitPair {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.lower, self.upper)
    }
}

impl Serialize for LimitPair {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for LimitPair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = std::borrow::Cow::<str>::deserialize(deserializer)?;
        let of = |name: &str| Limit::ALL.into_iter().find(|limit| limit.name() == name);
        let limits = text.split_once('/').and_then(|(lower, upper)| Some(Self { lower: of(lower)?, upper: of(upper)? }));
        limits.ok_or_else(|| D::Error::custom(format!("found \"{text}\", expected the names of two limits, lower/upper")))
    }
}

impl JsonSchema for LimitPair {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "LimitPair".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names = Limit::ALL.map(Limit::name).join("|");
        json_schema!({ "type": "string", "pattern": format!("^({names})/({names})$") })
    }
}
