//! Pictures of many trials: trajectories, box plots of the landing error, outcomes, convergence, and landing error against cone
//! width.

mod boxes;
mod cone_width;
mod convergence;
mod data;
mod diagram;
mod flown;
mod front;
mod outcomes;
mod sensitivity;

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "counts of trials in made-up figures are small")]
mod tests;

pub use data::{
    ConeWidthFigure, ConeWidthPoint, ConvergencePoint, ErrorQuantiles, FlownFigure, FlownTrial, FrontAgainst, FrontFigure,
    FrontPoint, FrontValue, LandingBoxes, LandingErrorFigure, OutcomeBars, SensitivityBar, SensitivityFigure, SimulationFigure,
    Success,
};

use super::{
    Caption, FigureError, Picture,
    keys::{self, Swatch},
    palette::SMALL_MM,
    picture::paragraph,
    sheet::Sheet,
};

/// Room below a panel's legend.
const BELOW_MM: f64 = 3.0;

/// A panel: where it ends, and its legend.
type Drawn = (f64, Vec<(Swatch, String)>);

/// Draws all available data of a simulation on one sheet: trajectories, box plots, outcomes, convergence.
///
/// # Errors
/// [`FigureError::NoGround`] if there are trajectories over a ground of fewer than two points.
pub fn draw_simulation(figure: &SimulationFigure) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let mut end_mm = figure.caption.draw(&mut sheet);
    if let Some(flown) = &figure.flown {
        end_mm = panel(&mut sheet, "Trajectories and landings", end_mm, |sheet, top| flown::draw(sheet, flown, top))?;
    }
    if figure.errors.iter().any(|boxes| !boxes.landings.is_empty()) {
        end_mm = panel(&mut sheet, "Distance error, landing by landing", end_mm, |sheet, top| {
            Ok(boxes::draw(sheet, &figure.errors, top))
        })?;
    }
    if !figure.outcomes.is_empty() {
        end_mm = panel(&mut sheet, "How the trials ended", end_mm, |sheet, top| Ok(outcomes::draw(sheet, &figure.outcomes, top)))?;
    }
    if figure.outcomes.iter().any(|bars| bars.convergence.len() > 1) {
        let text = "Success rate after so many trials, with its 95 % band";
        end_mm = panel(&mut sheet, text, end_mm, |sheet, top| Ok(convergence::draw(sheet, &figure.outcomes, top)))?;
    } else if figure.outcomes.iter().any(|bars| !bars.convergence.is_empty()) {
        let text = "The success rate over the number of trials is not drawn: it is noted after 10 trials for the first time.";
        end_mm = paragraph(&mut sheet, text, SMALL_MM, false, end_mm + 1.0) + BELOW_MM;
    }
    Ok(Picture::page(sheet, end_mm))
}

/// Draws the trajectories of trials over the terrain, with the planned path on top, and below them the landings hop by hop.
///
/// The view is the stretch flown over. Many trials are thinned to every n-th, which the legend says.
///
/// # Errors
/// [`FigureError::NoGround`] if the ground has fewer than two points.
pub fn draw_flown(caption: &Caption, flown: &FlownFigure) -> Result<Picture, FigureError> {
    alone(caption, |sheet, top| flown::draw(sheet, flown, top))
}

/// Draws box plots of the distance error per landing, one group of boxes for each series (the paper's Fig. 6b).
///
/// Boxes extend from the lower to the upper quartile, whiskers from 5 % to 95 %. Largest errors far beyond the whiskers are written
/// as numbers, so that the boxes stay readable. More than eighty boxes are thinned to every n-th landing, which the axis says.
///
/// # Errors
/// None today; [`FigureError`] as for the other pictures.
pub fn draw_landing_errors(figure: &LandingErrorFigure) -> Result<Picture, FigureError> {
    alone(&figure.caption, |sheet, top| Ok(boxes::draw(sheet, &figure.series, top)))
}

/// Draws the outcomes of trials, one group of bars for each outcome, with the success rate and its 95 % interval.
///
/// Outcomes that never occurred are named below the bars.
///
/// # Errors
/// None today; [`FigureError`] as for the other pictures.
pub fn draw_outcomes(caption: &Caption, bars: &[OutcomeBars]) -> Result<Picture, FigureError> {
    alone(caption, |sheet, top| Ok(outcomes::draw(sheet, bars, top)))
}

/// Draws the success rate with its 95 % band over the number of trials, on a logarithmic axis if their ratio exceeds twenty.
///
/// # Errors
/// None today; [`FigureError`] as for the other pictures.
pub fn draw_convergence(caption: &Caption, bars: &[OutcomeBars]) -> Result<Picture, FigureError> {
    alone(caption, |sheet, top| Ok(convergence::draw(sheet, bars, top)))
}

/// Draws the landing error against the width of the cones, with the hops of the planned path at each width.
///
/// # Errors
/// None today; [`FigureError`] as for the other pictures.
pub fn draw_cone_width(figure: &ConeWidthFigure) -> Result<Picture, FigureError> {
    alone(&figure.caption, |sheet, top| Ok(cone_width::draw(sheet, &figure.points, top)))
}

/// Draws what each error costs: a horizontal bar for each with its 95 % interval, from the top as given.
///
/// # Errors
/// None today; [`FigureError`] as for the other pictures.
pub fn draw_sensitivity(figure: &SensitivityFigure) -> Result<Picture, FigureError> {
    alone(&figure.caption, |sheet, top| Ok(sensitivity::draw(sheet, &figure.bars, top)))
}

/// Draws the estimated success of paths over their hops, with the 95 % intervals of the estimates, the path of the plan and the least
/// success wanted.
///
/// # Errors
/// None today; [`FigureError`] as for the other pictures.
pub fn draw_front(figure: &FrontFigure) -> Result<Picture, FigureError> {
    alone(&figure.caption, |sheet, top| Ok(front::draw(sheet, figure, top)))
}

/// A picture of one panel.
fn alone(caption: &Caption, draw: impl FnOnce(&mut Sheet, f64) -> Result<Drawn, FigureError>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let top_mm = caption.draw(&mut sheet) + 1.0;
    let height_mm = with_legend(&mut sheet, top_mm, draw)?;
    Ok(Picture::page(sheet, height_mm))
}

/// One panel among several; returns where it ends.
fn panel(
    sheet: &mut Sheet,
    heading: &str,
    top_mm: f64,
    draw: impl FnOnce(&mut Sheet, f64) -> Result<Drawn, FigureError>,
) -> Result<f64, FigureError> {
    let top_mm = diagram::heading(sheet, heading, top_mm + 1.0);
    with_legend(sheet, top_mm, draw)
}

/// A panel with its legend below.
fn with_legend(
    sheet: &mut Sheet,
    top_mm: f64,
    draw: impl FnOnce(&mut Sheet, f64) -> Result<Drawn, FigureError>,
) -> Result<f64, FigureError> {
    let (end_mm, entries) = draw(sheet, top_mm)?;
    Ok(if entries.is_empty() { end_mm } else { keys::draw(sheet, &entries, end_mm + 2.5) } + BELOW_MM)
}

/// A share with its interval in percent, with the number of decimals set by the width of the interval.
fn percent(success: &Success) -> String {
    let Success { rate, low, high } = *success;
    if ![rate, low, high].into_iter().all(f64::is_finite) {
        return "unknown".to_owned();
    }
    let decimals = [1e-2, 1e-3, 1e-4].into_iter().position(|width| high - low >= width).unwrap_or(3) + 1;
    format!("{:.decimals$} % ({:.decimals$} to {:.decimals$} %)", 100.0 * rate, 100.0 * low, 100.0 * high)
}
