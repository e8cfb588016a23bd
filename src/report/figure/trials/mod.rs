//! Pictures of many trials: trajectories, box plots of the landing error, outcomes, convergence, and drift against cone width.

mod data;

pub use data::{
    ConeWidthFigure, ConeWidthPoint, ConvergencePoint, ErrorQuantiles, FlownFigure, FlownTrial, LandingBoxes, LandingErrorFigure,
    OutcomeBars, SimulationFigure, Success,
};

use super::{Caption, FigureError, Picture, todo_picture};

/// Draws everything of a simulation on one sheet, as far as it is there: trajectories, box plots, outcomes, convergence.
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_simulation(figure: &SimulationFigure) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

/// Draws the trajectories of trials over the terrain, with the planned path on top and the landings on the ground.
///
/// # Errors
/// [`FigureError::NoGround`] where the ground has fewer than two points.
pub fn draw_flown(caption: &Caption, flown: &FlownFigure) -> Result<Picture, FigureError> {
    let _ = flown;
    todo_picture(caption)
}

/// Draws box plots of the distance error per landing, one group of boxes for each series (the paper's Fig. 6b).
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_landing_errors(figure: &LandingErrorFigure) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

/// Draws how trials ended, one group of bars for each policy, with the success rate and its 95 % interval.
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_outcomes(caption: &Caption, bars: &[OutcomeBars]) -> Result<Picture, FigureError> {
    let _ = bars;
    todo_picture(caption)
}

/// Draws the success rate with its 95 % band over the number of trials.
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_convergence(caption: &Caption, bars: &[OutcomeBars]) -> Result<Picture, FigureError> {
    let _ = bars;
    todo_picture(caption)
}

/// Draws the landing error against the width of the cones, with the hops of the planned path at each width.
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_cone_width(figure: &ConeWidthFigure) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}
