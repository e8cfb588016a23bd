//! Missions over a DEM that drive, hop, or do both: one graph over the nodes of free routes, searched by any objective within budgets.
//!
//! ```text
//!   DriveLegs    from a node to its 8, 16 or 32 neighbours in straight lines, and between the lattice and the places beside it
//!   TravelLegs   these and the hops; where turning takes time, a node once for each direction of the last drive leg
//!   travel       the best mission from a start to a goal
//! ```
//!
//! Where driving joins hops, no bound on hops, speeds or times of flights holds, and those on times and energies are for each metre
//! ([`least`]). What the search holds to be faster is in [`kept`].

mod drive_legs;
mod driven;
mod field;
mod kept;
mod kind;
mod least;
mod legs;
mod mission;
#[cfg(test)]
mod tests;

pub(crate) use drive_legs::drive_amounts;
pub use field::{Toward, TravelField, travel_field};
pub use kind::Travel;
pub use mission::{Mission, MissionFront, MissionMove, MissionPath, MissionQuestion, MissionWork, front_of_missions, travel};
