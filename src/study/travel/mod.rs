//! Missions that drive, hop, or do both over a DEM: plans, what hopping buys, and fronts.

mod compare;
mod map;
#[cfg(feature = "plot")]
mod picture;
mod plan;
mod search;
mod size;
mod trials;
mod walk;

pub use map::{ReachedBy, TravelMap, TravelMapOptions, travel_map, travel_map_size};
pub use plan::{TravelOptions, TravelPlanned, travel_plan};
pub use size::travel_size;
pub use trials::{TravelSimulated, travel_simulate};
pub use walk::DriveDefect;
