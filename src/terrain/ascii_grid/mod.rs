//! The ESRI ASCII grid: a header of keys and values, then one number per post, starting in the north-west.

mod header;
mod read;
mod tokens;
mod write;

pub use read::read_ascii_grid_bytes;
pub(super) use read::{AsciiGridReader, Problems};
pub use write::write_ascii_grid;
