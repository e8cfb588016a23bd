//! Missions that drive, hop, or do both over a DEM: plans, what hopping buys, and fronts.

mod compare;
mod map;
#[cfg(feature = "plot")]
mod picture;
mod plan;
mod records;
mod search;
mod size;
mod trials;
mod walk;

pub use map::{ReachedBy, TravelMap, TravelMapOptions, travel_map, travel_map_size};
pub use plan::{TravelOptions, TravelPlanned, travel_plan};
pub(super) use records::{drive_leg, hop_leg, sums_record};
pub use size::travel_size;
pub use trials::{TravelSimulated, travel_simulate};
pub use walk::DriveDefect;
pub(super) use walk::{Driven, agreed, driven_again};
