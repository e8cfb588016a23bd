//! Numbers with a physical meaning: angles, slopes, points, indices, roots of quadratics, and intervals with outward
//! rounding.
//!
//! Inside the program a direction is its slope `m = tan(theta)`; [`Angle`] is used for input and output, where degrees
//! appear.

mod angle;
mod format;
mod ids;
mod interval;
mod names;
mod normal;
mod number_text;
mod points;
mod quadratic;
mod slope;
mod total;
mod unit;

pub use angle::{Angle, AngleInterval};
pub(crate) use format::excerpt;
pub use format::{format_number, unit_of};
pub use ids::{FacetId, NodeId, SegmentId, VertexId};
#[cfg(test)]
pub(crate) use interval::Inwards;
pub use interval::{Interval, Outwards, Rounding};
pub(crate) use names::{by_name, variant_by_name};
pub use normal::{normal_cdf, normal_quantile, standard_normals};
pub(crate) use number_text::{decimal_comma, number_help};
pub(crate) use points::part_between;
pub use points::{ChainPoint, MapPoint};
pub use quadratic::{MonicQuadratic, Roots};
pub use slope::SlopeInterval;
pub(crate) use total::total;
pub(crate) use unit::{Measure, is_metre, metres_or_kilometres, metres_per, split_unit, unit_named};
