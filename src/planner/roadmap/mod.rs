//! Roadmaps on meshes: contacts, every window of every hop between two of them, and the best path, from a roadmap that grows about it.
//!
//! ```text
//!      o            o       contacts: by area, and on every facet
//!     / \  .--.    /        edges: the windows of collision-free arcs, exactly; none is missed between two contacts
//!    S   o'    '--o---G     the best path by an objective, within budgets; then more contacts about it
//! ```
//!
//! A path of a roadmap exists. Where a roadmap has no path, or no better one, nothing is proved: more contacts may give one.
//!
//! Source: Campana and Laumond 2016, *Ballistic motion planning*, whose roadmaps sample the arcs as well; the exact windows make their
//! convergence property true.

mod anytime;
mod file;
mod graph;
mod ground;
mod join;
mod kind;
mod left;
mod legs;
mod one_by_one;
mod route;
mod sample;
mod walks;

pub use anytime::{GAIN_MIN, GrownRoadmap, RoadmapEnd, RoadmapLimits, RoadmapRound, grow_roadmap, grow_until_joined, over_roadmap};
pub use file::RoadmapFileError;
pub use graph::{Roadmap, RoadmapHop};
pub use ground::{RoadmapGround, RoadmapSampler};
pub use join::{JoinCounts, JoinTest, PROBE_RADIUS_M, PROBE_STAND_OFF_M, PROBE_STEP_M, SAMPLED_SHARES};
pub use kind::RoadmapPlanner;
pub use left::Left;
pub use legs::RoadmapLegs;
pub use one_by_one::{OneByOne, grow_one_by_one};
pub use route::{RoadmapGap, RoadmapMove, RoadmapPath, RoadmapQuestion, RoadmapRoute};
pub use sample::{BY_AREA, ContactSampler, DrawnContacts, NothingWithin, SpaceBounds};
pub use walks::RoadmapWalks;

#[cfg(test)]
pub(crate) mod tests;
#[cfg(test)]
mod walk_tests;
