//! The XYZ grid: a text with one post per line, in any order; the lattice is found from the numbers.
//!
//! `rows` reads the lines, `axis` finds the spacing of one coordinate, `read` puts the posts in their places.

mod axis;
mod read;
mod rows;

pub(super) use read::XyzReader;
pub use read::read_xyz_bytes;
