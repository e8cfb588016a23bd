//! The hop test over a chain: whether a single hop can join two stations, with which take-off slopes, and how many hops a
//! stretch of one segment needs.
//!
//! The equations are in [`crate::ballistics`]; this module applies them to the stations of a
//! [`ConstrainedChain`](crate::chain::ConstrainedChain).

mod conflict;
mod hop_test;
mod margins;
mod reach;
mod reach_along_sight;
mod segment_hops;
mod takeoff_set;
mod terrain;

pub use conflict::{Conflict, Shortfall};
pub use hop_test::HopTest;
pub(crate) use margins::Flown;
pub use margins::{HopMargins, MARGINS, MarginRow};
pub use reach_along_sight::ReachAlongSight;
pub use segment_hops::{SegmentHops, SegmentReach, Split};
pub use takeoff_set::{Binding, LimitInterval, SetWindow, TakeoffSet};
pub(crate) use takeoff_set::{commanded_windows, envelope_limits, joint};
pub use terrain::{TerrainPoint, terrain_limit};
pub(crate) use terrain::{first_ahead, flown_past, ground_slope, slope_beyond};
