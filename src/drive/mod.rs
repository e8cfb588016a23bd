//! Driving over a DEM: what a straight leg of a rover is and takes, and why one is refused.
//!
//! ```text
//!   DriveGround    a DEM with its zones and a rover: judges and prices one straight leg, piece by piece of the exact slice
//!   DriveLeg       what a leg takes: lengths, climb, time, energy, and how near it comes to each limit
//!   DriveRefusal   the first limit that a leg exceeds, with the value found and the place
//!   DriveEdges     the legs from every node of a lattice to its neighbours, judged for many nodes at once
//!   DriveMap       the least time, energy or length from some nodes to all, or from all to some, with the ways
//! ```

mod edges;
mod extras;
mod leg;
mod map;
mod price;
mod queue;
mod refusal;
mod search;
mod slopes;
mod template;
mod wheels;

pub use edges::{DriveEdges, DriveError};
pub use leg::{DriveGround, DriveLeg, Extreme};
pub use map::{DriveMap, DriveSense, DriveWay, drive_path};
pub use price::DriveAmount;
pub use refusal::{DriveLimit, DriveRefusal, DriveRefusalCounts};

#[cfg(test)]
mod tests;
