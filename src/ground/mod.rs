//! The ground under a hop: chains, DEMs with their overlays, and meshes, behind the same traits.
//!
//! ```text
//!   Surface        raw facts: contacts and the facets that rule there, normals, friction, zones
//!     Profiles     ground with one height at every place: the elements under a line of travel
//!     Triangulated ground of triangles that may stand over one another: those in a box
//!   Windows        feasible take-off windows between two contacts, in closed form
//!   FirstContact   where an arc comes down, and whether the ground holds the hopper there
//! ```
//!
//! The independent checker uses [`Surface`] and its two extensions alone; planners use [`Windows`], or a fast equivalent with the same results; trials
//! follow arcs with [`FirstContact`].

mod chain;
mod chain_flight;
mod dem;
mod dem_flight;
mod excluded;
mod first_contact;
mod height_field;
mod hop_reach;
mod landing_share;
mod mesh;
mod posts;
mod rest;
mod stance;
mod surface;
mod sweep;

pub(crate) use chain::heading_of;
pub use chain_flight::{ChainGround, ChainPosition};
pub use dem::{DemGround, MapPosition, SliceProblem};
pub use first_contact::{ContactFailure, FirstContact, Flight, LiftoffVelocity, Realization, TouchdownState};
pub use height_field::HeightField;
pub(crate) use hop_reach::HopReach;
pub(crate) use landing_share::LandingScatter;
pub use mesh::{
    BALL_STAND_OFF, BlockedSpan, MeshBuffers, MeshConflict, MeshContact, MeshContactFacet, MeshCourse, MeshGround, MeshPosition,
    MeshTakeoffSet, MeshWindow, MeshWindowEnd, NoMeshContact, UnknownGroup,
};
pub use posts::{Lofts, MapError, NodeLattice, Post, PostHops, PostHopsSize, PostRefusal};
pub(crate) use posts::{Offset, OverlayTable};
#[cfg(test)]
pub(crate) use posts::{OffsetTable, Spacing};
// A raw fact of a ground: the independent checker reads its cells.
pub(crate) use crate::terrain::{Layer, MapLayers};
pub use stance::{
    FootPush, Foothold, JointReach, LimbOutcome, NoFriction, NoStance, Pose, Stance, StanceBuffers, StanceGround, StanceMap,
    StandsUp, TrunkHit,
};
pub use surface::{
    Around, ContactPoint, Element, ElementVertex, Facet, Frame, Hold, Profiles, Side, Surface, TakeoffWindows, Triangulated,
    Windows,
};
pub use sweep::{LandingTable, Sweep};
