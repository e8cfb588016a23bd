//! What can be reached from one position of a map.

mod fan;
pub mod map;

pub use fan::{FanError, FanRay, FanRequest, HopBand, SliceEnd, fan, heading_vector};
