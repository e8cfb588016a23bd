//! How far one gets from one place of a map.

mod fan;
pub mod map;

pub use fan::{Cut, FanError, FanRay, FanRequest, HopBand, fan, heading_vector};
