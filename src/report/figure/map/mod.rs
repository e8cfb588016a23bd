//! Maps: hop bands, continuous values and landing ellipses over a hillshade of the DEM.

mod data;

pub use data::{
    GoalMark, HOPS_NO_DATA, HOPS_UNREACHABLE, HopMapFigure, LandingCloud, LandingEllipse, LandingMapFigure, MapPosts,
    ValueMapFigure,
};

use super::{FigureError, Picture};

/// Draws a hop map: where the hopper gets, in how few hops, over a hillshade.
///
/// # Errors
/// [`FigureError::RasterSize`] where a raster does not have one number for every post.
pub fn draw_hop_map(figure: &HopMapFigure<'_>) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

/// Draws a map of a continuous value, such as the least effort or the mobility, over a hillshade.
///
/// # Errors
/// [`FigureError::RasterSize`] where the raster does not have one number for every post.
pub fn draw_value_map(figure: &ValueMapFigure<'_>) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

/// Draws where the hops of a path really landed, with 95 % ellipses, over a hillshade.
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_landing_map(figure: &LandingMapFigure<'_>) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

use super::todo_picture;
