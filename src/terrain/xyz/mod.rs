//! The XYZ grid: a text with one post per line, in any order; the lattice is derived from the coordinates.
//!
//! `header` finds the columns, `rows` reads the lines, `axis` finds the spacing of one coordinate, `read` arranges the posts in a raster.

mod axis;
mod header;
mod read;
mod rows;

pub(super) use read::XyzReader;
pub use read::read_xyz_bytes;
