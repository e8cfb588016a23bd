//! Maps: hop bands, continuous values and landing ellipses over a hillshade of the DEM.

mod data;
mod density;
mod hillshade;
mod hops;
mod inset;
mod landings;
mod legs_map;
mod mesh_plan;
mod names;
mod panel;
mod plan_view;
mod raster;
mod sites;
mod style;
mod targets;
mod travel;
mod travel_map;
mod unreached;
mod values;

pub use data::{
    GoalMark, HOPS_NO_DATA, HOPS_NOT_SEARCHED, HOPS_UNREACHABLE, HopMapFigure, LandingCloud, LandingEllipse, LandingMapFigure,
    MapPosts, RefusedPosts, ValueMapFigure,
};
pub use density::{DensityFigure, draw_density};
pub use hops::draw_hop_map;
pub use landings::draw_landing_map;
pub use legs_map::{LegsMapFigure, LegsMapLayer, draw_legs_map};
pub(super) use mesh_plan::{MeshPlan, draw_mesh_plan};
pub(super) use panel::{goal_symbol, missed_symbol, scale_bar, start_symbol};
pub use plan_view::PlanView;
pub(super) use plan_view::{draw_plan_view, nearest_symbol};
pub use sites::{SiteMark, SitesFigure, draw_sites};
pub use style::RasterStyle;
pub use targets::{TargetMark, TargetsFigure, VisitRow, draw_targets};
pub use travel::{TravelFigure, TravelLine, draw_travel};
pub use travel_map::{TravelMapFigure, draw_travel_map};
pub use unreached::RefusedBy;
pub use values::draw_value_map;

use super::FigureError;

/// Checks that a raster has one value for each post.
fn check_size(what: &'static str, posts: &MapPosts<'_>, found: usize) -> Result<(), FigureError> {
    let (rows, cols) = posts.size();
    if rows * cols == found { Ok(()) } else { Err(FigureError::RasterSize { what, found, rows, cols }) }
}

#[cfg(test)]
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "small rows, columns and hops of made-up maps"
)]
mod tests;
