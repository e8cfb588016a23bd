//! How far one gets from one place of a map.

mod fan;

pub use fan::{Cut, FanError, FanRay, FanRequest, HopBand, fan, heading_vector};
