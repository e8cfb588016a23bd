//! Numbers with a meaning: angles, slopes, points, ids, the roots of quadratics, and intervals that round outwards.
//!
//! Inside the program a direction is its slope `m = tan(theta)`; [`Angle`] is for the edges, where degrees come in and go out.

mod angle;
mod format;
mod ids;
mod interval;
mod normal;
mod points;
mod quadratic;
mod slope;

pub use angle::{Angle, AngleInterval};
pub use format::{format_number, unit_of};
pub use ids::{NodeId, SegmentId, VertexId};
#[cfg(test)]
pub(crate) use interval::Inwards;
pub use interval::{Interval, Outwards, Rounding};
pub use normal::standard_normals;
pub use points::{ChainPoint, MapPoint};
pub use quadratic::{MonicQuadratic, Roots};
pub use slope::SlopeInterval;
