//! Which contacts of a mesh are reached from one of them, and in how few hops.
//!
//! ```text
//!      .   2   .            S  the start: 0 hops         .  not reached over these contacts
//!     1  1   2    .         each contact is tested from those of the layer before, until one hop reaches it
//!      S   1     .
//! ```
//!
//! The hops are those of a [`Roadmap`](crate::planner::roadmap::Roadmap) of the same contacts, whose exact windows leave out none; of its
//! pairs only those are tested that can matter, and no window is kept. A contact that is reached can be reached. One that is not may
//! still be, over other contacts.

mod layers;
mod spread;

pub use layers::{ContactHops, Way, contact_hops};
pub use spread::{Spread, SpreadQuestion, SpreadRound, spread};

#[cfg(test)]
mod tests;
