//! What can be reached from one position of a map or a mesh.

pub mod contacts;
mod fan;
pub mod map;
pub mod stances;

pub use fan::{FanError, FanRay, FanRequest, FanSize, HopBand, SliceEnd, fan, fan_size, heading_vector};
