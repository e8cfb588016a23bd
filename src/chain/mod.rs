//! The polygonal chain: terrain in the vertical plane of travel, with the constraints of each segment in each direction.
//!
//! ```text
//!  z                        v3
//!  |        v1___          /          segment i joins vertices i and i+1;
//!  |       /     \___v2___/           at a vertex a forward take-off obeys the segment ahead,
//!  |   v0_/                           a forward landing the one just flown over
//!  +--------------------------- x     (reverse travel: the mirror image)
//! ```

mod constrained;
mod constraints;
pub mod csv;
mod facet;
mod footing;
mod ground;
mod layers;
mod polygonal;
mod quick_cones;
mod station;
mod touchdown;

pub(crate) use constrained::resolve_constraints;
pub use constrained::{ConstrainedChain, ConstraintProblem, ConstraintProblems};
pub use constraints::{ContactRule, GroundRefusal, LineConstraints, SegmentConstraints};
pub(crate) use facet::{FacetGround, facet_constraints};
pub use footing::FootprintRefusal;
pub(crate) use footing::{Footing, Footprint, contacts_stand, rest_slope};
pub use ground::{GroundForm, SegmentGround};
pub(crate) use layers::ChainLayers;
pub use polygonal::{ChainProblem, InvalidChain, PolygonalChain};
pub use quick_cones::{QuickCone, QuickGrip, Turn};
pub use station::{OffChain, Site, Station};
pub(crate) use touchdown::contains_straight_down;
