//! The questions: each opens its scenario and gives the document of its answer.

mod arena;
mod chain;
mod check;
mod compare;
mod fan;
mod hop;
mod map;
mod plan;
mod simulate;
mod sites;
mod stance;
mod tally;
mod vary;

pub use arena::{ArenaAsked, arena};
pub use chain::ChainAsked;
pub use compare::compare;
pub use fan::FanAsked;
pub use hop::HopAsked;
pub use map::{MapAsked, MapReply};
pub use plan::PlanAsked;
pub use simulate::Ran;
pub use sites::SitesAsked;
pub use stance::{StanceAsked, stance_of_contacts};

use super::AskError;

/// Refuses what has no meaning for a scenario: the first of what is wanted.
fn refuse(wanted: &[(bool, &'static str)], why: &'static str) -> Result<(), AskError> {
    match wanted.iter().find(|(is_wanted, _)| *is_wanted) {
        Some((_, what)) => Err(AskError::NotHere { what, why }),
        None => Ok(()),
    }
}

/// Why the paths of legs and over meshes have no such thing.
const OVER_FACETS: &str = "this is a free route over facets, of a mesh or for legs";

/// The same of missions.
const OF_TARGETS: &str = "this scenario visits targets";

/// The same of drives.
const OF_DRIVES: &str = "this scenario drives";
