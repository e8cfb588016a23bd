//! Driving over a DEM: what a straight leg of a rover is and takes, and why one is refused.
//!
//! ```text
//!   DriveGround    a DEM with its zones and a rover: judges and prices one straight leg, piece by piece of the exact slice
//!   DriveLeg       what a leg takes: lengths, climb, time, energy, and how near it comes to each limit
//!   DriveRefusal   the first limit that a leg exceeds, with the value found and the place
//! ```

mod leg;
mod refusal;
mod wheels;

pub use leg::{DriveGround, DriveLeg, Extreme};
pub use refusal::{DriveLimit, DriveRefusal, DriveRefusalCounts};
