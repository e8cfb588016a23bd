//! The shares of the limits that a plan may use, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::world::Derating;

/// The shares of the limits that the answer was planned with, and a proof holds for; what is planned is flown under the whole limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DeratingRecord {
    /// Of the greatest take-off speed.
    pub takeoff_speed: f64,
    /// Of the greatest landing speed.
    pub landing_speed: f64,
    /// Of the friction coefficient.
    pub friction: f64,
}

impl DeratingRecord {
    /// The record of some shares; `None` if all are 1.
    pub fn of(derating: &Derating) -> Option<Self> {
        let Derating { takeoff_speed, landing_speed, friction } = *derating;
        (!derating.is_none()).then_some(Self { takeoff_speed, landing_speed, friction })
    }

    /// The fact as a sentence.
    pub fn sentence(&self) -> String {
        let Self { takeoff_speed, landing_speed, friction } = *self;
        format!(
            "planned with derated limits ([derating]: {}), to which margins are stated; trials fly the whole limits",
            Derating { takeoff_speed, landing_speed, friction }.shares()
        )
    }
}
