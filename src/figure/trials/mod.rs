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
    picture::{PageBreak, paragraph},
    sheet::Sheet,
};

/// Room below a panel's legend.
const BELOW_MM: f64 = 3.0;

/// A panel: where it ends, and its legend.
type Drawn = (f64, Vec<(Swatch, String)>);

/// Draws all available data of a simulation, each figure on a page of its own: trajectories, box plots, outcomes with convergence.
///
/// A figure without data is left out. Every page has the title, and the first page all of the caption.
///
/// # Errors
/// [`FigureError::NoGround`] if there are trajectories over a ground of fewer than two points.
pub fn draw_simulation(figure: &SimulationFigure) -> Result<Picture, FigureError> {
    let mut pages = Pages::new(&figure.caption);
    if let Some(flown) = &figure.flown {
        pages.begin();
        let heading = match &figure.outcomes[..] {
            [first, _, ..] => format!("Trajectories and landings, {}", first.policy),
            _ => "Trajectories and landings".to_owned(),
        };
        pages.panel(&heading, |sheet, top| flown::draw(sheet, flown, top))?;
    }
    if figure.errors.iter().flat_map(|boxes| &boxes.landings).any(boxes::is_drawable) {
        pages.begin();
        pages.panel("Distance error, landing by landing", |sheet, top| Ok(boxes::draw(sheet, &figure.errors, top)))?;
    }
    if figure.outcomes.iter().flat_map(|bars| &bars.counts).any(|(_, count)| *count > 0) {
        pages.begin();
        pages.panel("How the trials ended", |sheet, top| Ok(outcomes::draw(sheet, &figure.outcomes, top)))?;
        if figure.outcomes.iter().any(|bars| bars.convergence.len() > 1) {
            let text = "Success rate after so many trials, with its 95 % band";
            pages.panel(text, |sheet, top| Ok(convergence::draw(sheet, &figure.outcomes, top)))?;
        } else if figure.outcomes.iter().any(|bars| !bars.convergence.is_empty()) {
            let text = "The success rate over the number of trials is not drawn: it is noted after 10 trials for the first time.";
            pages.end_mm = paragraph(&mut pages.sheet, text, SMALL_MM, false, pages.end_mm + 1.0) + BELOW_MM;
        }
    }
    Ok(Picture { breaks: pages.breaks, ..Picture::page(pages.sheet, pages.end_mm) })
}

/// The pages of a simulation as they are drawn, one below the other.
struct Pages<'a> {
    sheet: Sheet,
    end_mm: f64,
    breaks: Vec<PageBreak>,
    title: &'a str,
    /// Whether there is a figure below the caption.
    is_begun: bool,
}

impl<'a> Pages<'a> {
    fn new(caption: &'a Caption) -> Self {
        let mut sheet = Sheet::default();
        let end_mm = caption.draw(&mut sheet);
        Self { sheet, end_mm, breaks: Vec::new(), title: &caption.title, is_begun: false }
    }

    /// Begins a figure: the first below the caption, every further one on a page of its own.
    fn begin(&mut self) {
        if std::mem::replace(&mut self.is_begun, true) {
            // Whole millimetres, since a page is as high as that.
            self.end_mm = self.end_mm.ceil();
            self.breaks.push(PageBreak::at(&self.sheet, self.end_mm));
            self.end_mm = Caption { title: self.title.to_owned(), lines: Vec::new() }.draw_from(&mut self.sheet, self.end_mm);
        }
    }

    /// Draws a panel with its heading and its legend.
    fn panel(
        &mut self,
        heading: &str,
        draw: impl FnOnce(&mut Sheet, f64) -> Result<Drawn, FigureError>,
    ) -> Result<(), FigureError> {
        let top_mm = diagram::heading(&mut self.sheet, heading, self.end_mm + 1.0);
        self.end_mm = with_legend(&mut self.sheet, top_mm, draw)?;
        Ok(())
    }
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
