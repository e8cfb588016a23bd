//! One function per question: from a validated scenario to its answer.

mod alike;
mod footprint;
mod on_body;
mod physics;
mod pipeline;
mod schema;
mod sense;
mod trade;

pub use alike::ask_the_same;
pub use footprint::coarse_dem_warning;
pub use on_body::{OfBody, dem_on_body, on_body};
pub use physics::{Extent, Extremes, TooLarge, constant_gravity_warnings};
pub use pipeline::{DemReading, JourneyEnd, Overlays, PipelineError, Prepared, Survey, Transect, friction, prepare, sha256_of};
pub use schema::SchemaKind;
pub use sense::TrialGround;
pub use trade::{SweptKey, Trade, TradeError, Varied, verdict};
