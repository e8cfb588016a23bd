//! Missions that drive, hop, or do both over a DEM: plans, what hopping buys, and fronts.

#[cfg(feature = "plot")]
mod picture;
mod plan;
mod search;
mod walk;

pub use plan::{TravelOptions, TravelPlanned, travel_plan};
pub use walk::DriveDefect;
