//! What would help, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A key of the scenario that would raise the success of its trials.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct AdviceRecord {
    /// The key, such as `uncertainty.policy`.
    pub key: String,
    /// Its value now, as in a scenario.
    pub found: String,
    /// The value to try; null where any greater or smaller one helps, as `reason` says.
    pub value: Option<String>,
    /// Why, and what it takes.
    pub reason: String,
}

impl AdviceRecord {
    /// The advice as a sentence without its full stop.
    pub fn sentence(&self) -> String {
        let Self { key, found, value, reason } = self;
        match value {
            Some(value) => format!("set {key} = {value} (now {found}): {reason}"),
            None => format!("{key} (now {found}): {reason}"),
        }
    }
}
