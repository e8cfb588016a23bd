//! PDS3: a text label (attached to its image, or in a separate file) and an image of uncompressed samples.
//!
//! `label` reads the text, `image` interprets the IMAGE object, `marks` its special values, `samples` the bytes, `projection` the `IMAGE_MAP_PROJECTION`
//! object
//! (Planetary Data System Standards Reference 3.8, chapters 5, 12 and appendices A to C; data dictionary for the map keywords).

mod image;
mod label;
mod marks;
mod projection;
mod read;
mod samples;

pub(super) use read::Pds3Reader;
pub use read::read_pds3_bytes;
