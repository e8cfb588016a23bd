//! Fewest hops over one or two capabilities.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        axes::Panel,
        bands::ramp,
        keys::{self, Swatch, rectangle},
        palette::{BLACK, LEFT_MM, RIGHT_MM, SMALL_MM, TEXT_MM, WHITE},
        picture::paragraph,
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm, wrapped},
        ticks::{one_in, short},
    },
    TradeAxis, TradeCell, TradeFigure,
    profile::fitted,
};

/// Widest cell.
const WIDEST_MM: f64 = 26.0;
/// Highest cell, and the most height of all cells together.
const HIGHEST_MM: (f64, f64) = (11.0, 190.0);
/// The largest size of a number in a cell, and the smallest legible one.
const NUMBER_MM: (f64, f64) = (3.2, 1.1);
/// No path: grey, which is not a colour of any hop count.
const CLOSED: RGBColor = RGBColor(190, 190, 190);
/// Lines between cells.
const EDGE_PEN: Pen = Pen { colour: WHITE, width_mm: 0.2 };
/// The greatest number of hop samples in the legend.
const MOST_SAMPLES: usize = 8;

/// Draws the fewest hops over a grid of two capabilities, or over a row of one, with the number in every cell.
///
/// Few hops are light, many dark, on a logarithmic scale from the fewest to the most; grey with a cross: proved that there is no
/// path; white with a question mark: no path found; with an exclamation mark: no answer. Numbers too small to be read are omitted, and the picture says so.
///
/// # Errors
/// [`FigureError::RasterSize`] if there is not one cell for every pair of values.
pub fn draw_trade(figure: &TradeFigure) -> Result<Picture, FigureError> {
    let (rows, cols) = (figure.y.as_ref().map_or(1, |y| y.values.len()), figure.x.values.len());
    let found = figure.cells.len();
    if rows.checked_mul(cols) != Some(found) {
        return Err(FigureError::RasterSize { what: "trade", found, rows, cols });
    }
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    if found == 0 {
        let end_mm = paragraph(&mut sheet, "There are no cells.", TEXT_MM, false, top_mm);
        return Ok(Picture::page(sheet, end_mm + 2.0));
    }
    let shades = Shades::of(&figure.cells);
    let grid = Grid::new(figure, (rows, cols), top_mm);
    let end_mm = grid.axes(&mut sheet, figure);
    grid.cells(&mut sheet, &figure.cells, &shades);
    let end_mm = keys::draw(&mut sheet, &shades.keys(&figure.cells), end_mm + 2.5);
    let end_mm = if grid.number_mm.is_some() {
        end_mm
    } else {
        let text = format!("{rows} x {cols} cells: too small for a number each; the table of the answer has them.");
        paragraph(&mut sheet, &text, SMALL_MM, false, end_mm + 0.5)
    };
    Ok(Picture::page(sheet, end_mm + 2.0))
}

/// The colours of hop counts.
struct Shades {
    /// The hop counts present, in ascending order.
    hops: Vec<u64>,
}

impl Shades {
    fn of(cells: &[TradeCell]) -> Self {
        let hops = |cell: &TradeCell| if let TradeCell::Hops(hops) = cell { Some(*hops) } else { None };
        let mut hops: Vec<u64> = cells.iter().filter_map(hops).collect();
        hops.sort_unstable();
        hops.dedup();
        Self { hops }
    }

    fn colour(&self, cell: TradeCell) -> RGBColor {
        #[expect(clippy::cast_precision_loss, reason = "a shade")]
        let log = |hops: u64| libm::log1p(hops as f64);
        match (cell, self.hops.first(), self.hops.last()) {
            (TradeCell::Hops(hops), Some(&fewest), Some(&most)) if fewest < most => {
                ramp((log(hops) - log(fewest)) / (log(most) - log(fewest)))
            }
            (TradeCell::Hops(_), ..) => ramp(0.3),
            (TradeCell::Untraversable, ..) => CLOSED,
            (TradeCell::Open | TradeCell::Failed, ..) => WHITE,
        }
    }

    /// Samples of the hop counts present, including the fewest and the most, then the symbols of cells without a path.
    fn keys(&self, cells: &[TradeCell]) -> Vec<(Swatch, String)> {
        let last = self.hops.len().saturating_sub(1);
        let samples = last.min(MOST_SAMPLES - 1);
        let mut picks: Vec<usize> = (0..=samples).map(|i| (i * last).checked_div(samples).unwrap_or(0)).collect();
        picks.dedup();
        let hops = picks.into_iter().filter_map(|i| self.hops.get(i)).map(|&hops| {
            let text = if hops == 1 { "1 hop".to_owned() } else { format!("{hops} hops") };
            (Swatch::Fill(self.colour(TradeCell::Hops(hops))), text)
        });
        let count = |wanted: TradeCell| cells.iter().filter(|cell| **cell == wanted).count();
        let signs = [
            (TradeCell::Untraversable, closed_sample as fn(&mut Sheet, Place), "proved: no path"),
            (TradeCell::Open, open_sample, "open: no path found, none excluded"),
            (TradeCell::Failed, failed_sample, "failed: no answer"),
        ];
        let signs = signs.into_iter().filter(|(cell, ..)| count(*cell) > 0);
        hops.chain(signs.map(|(cell, symbol, text)| (Swatch::Symbol(symbol), format!("{text} ({})", count(cell))))).collect()
    }
}

fn closed_sample(sheet: &mut Sheet, (x, y): Place) {
    sheet.area(rectangle((x - 3.0, y - 1.5), (x + 3.0, y + 1.5)), CLOSED, 1.0);
    cross(sheet, (x, y), 0.9);
}

fn open_sample(sheet: &mut Sheet, at: Place) {
    lettered_sample(sheet, at, sign(TradeCell::Open));
}

fn failed_sample(sheet: &mut Sheet, at: Place) {
    lettered_sample(sheet, at, sign(TradeCell::Failed));
}

fn lettered_sample(sheet: &mut Sheet, (x, y): Place, letter: String) {
    let corners = rectangle((x - 3.0, y - 1.5), (x + 3.0, y + 1.5));
    sheet.line(corners.iter().copied().chain([corners[0]]).collect(), Pen { colour: BLACK, width_mm: 0.12 });
    sheet.label(Label::new(letter, (x, y), SMALL_MM).hung(Anchor::Middle, Hang::Through));
}

fn cross(sheet: &mut Sheet, (x, y): Place, r: f64) {
    let pen = Pen { colour: BLACK, width_mm: 0.3 * r.min(1.0) };
    sheet.line(vec![(x - r, y - r), (x + r, y + r)], pen);
    sheet.line(vec![(x - r, y + r), (x + r, y - r)], pen);
}

/// Black or white, whichever has more contrast on a colour: by the relative luminance of WCAG 2.
fn ink(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let linear = |part: u8| {
        let share = f64::from(part) / 255.0;
        if share <= 0.04045 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) }
    };
    let luminance = 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
    if (luminance + 0.05) * (luminance + 0.05) > 0.05 * 1.05 { BLACK } else { WHITE }
}

/// The labels of an axis: four digits, or all digits if four do not distinguish neighbours.
fn numbers(axis: &TradeAxis) -> Vec<String> {
    let four: Vec<String> = axis.values.iter().map(|&value| short(value)).collect();
    let same = four.windows(2).any(|pair| pair[0] == pair[1]);
    if same { axis.values.iter().map(|value| (value + 0.0).to_string()).collect() } else { four }
}

/// The layout of the cells.
struct Grid {
    panel: Panel,
    rows: usize,
    cols: usize,
    /// Size of the numbers; `None` if they would be too small to read.
    number_mm: Option<f64>,
}

impl Grid {
    #[expect(clippy::cast_precision_loss, reason = "counts of rows and columns")]
    fn new(figure: &TradeFigure, (rows, cols): (usize, usize), top_mm: f64) -> Self {
        let widest = |texts: &[String], size_mm: f64| texts.iter().map(|text| text_width_mm(text, size_mm)).fold(0.0, f64::max);
        let numbers_mm = figure.y.as_ref().map_or(0.0, |y| widest(&numbers(y), SMALL_MM)).min(40.0);
        let left = LEFT_MM.max(numbers_mm + TEXT_MM + 5.5);
        let wide = ((RIGHT_MM - left) / cols as f64).min(WIDEST_MM);
        let high = (HIGHEST_MM.1 / rows as f64).min(HIGHEST_MM.0).min(if rows == 1 { HIGHEST_MM.0 } else { 1.2 * wide });
        // A name longer than the axis is placed above the panel.
        let above = figure.y.as_ref().map_or(0.0, |y| if fits(&y.name, high * rows as f64) { 0.0 } else { 1.6 * TEXT_MM });
        let top = top_mm + 0.5 + above;
        let panel = Panel { left, top, right: left + wide * cols as f64, bottom: top + high * rows as f64 };
        let signs: Vec<String> = figure.cells.iter().map(|cell| sign(*cell)).collect();
        let number_mm = (0.9 * wide / widest(&signs, 1.0).max(0.6)).min(0.65 * high).min(NUMBER_MM.0);
        Self { panel, rows, cols, number_mm: (number_mm >= NUMBER_MM.1).then_some(number_mm) }
    }

    /// Left, top, right and bottom of a cell; rows count upwards.
    #[expect(clippy::cast_precision_loss, reason = "counts of rows and columns")]
    fn cell(&self, row: usize, col: usize) -> (Place, Place) {
        let (wide, high) = (self.panel.width() / self.cols as f64, self.panel.height() / self.rows as f64);
        let (left, bottom) = (self.panel.left + wide * col as f64, self.panel.bottom - high * row as f64);
        ((left, bottom - high), (left + wide, bottom))
    }

    /// Numbers and names of both axes; returns where they end.
    fn axes(&self, sheet: &mut Sheet, figure: &TradeFigure) -> f64 {
        let along = numbers(&figure.x);
        let (from, to) = self.cell(0, 0);
        let widest_mm = along.iter().map(|text| text_width_mm(text, SMALL_MM)).fold(0.0, f64::max);
        let every = one_in((widest_mm + 1.5) / (to.0 - from.0));
        let middle = |(from, to): (Place, Place)| (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        let ticks: Vec<_> =
            along.into_iter().enumerate().step_by(every).map(|(col, text)| (middle(self.cell(0, col)).0, text)).collect();
        self.panel.x_axis(sheet, &ticks, "", false);
        if let Some(y) = &figure.y {
            let every = one_in((SMALL_MM + 0.6) / (to.1 - from.1));
            let ticks = numbers(y).into_iter().enumerate().step_by(every);
            let ticks: Vec<_> = ticks.map(|(row, text)| (middle(self.cell(row, 0)).1, fitted(&text, SMALL_MM, 40.0))).collect();
            let inside = fits(&y.name, self.panel.height());
            self.panel.y_axis(sheet, &ticks, if inside { &y.name } else { "" }, false);
            if !inside {
                let name = fitted(&format!("upwards: {}", y.name), TEXT_MM, RIGHT_MM - 4.0);
                sheet.label(Label::new(name, (4.0, self.panel.top - 1.2), TEXT_MM).hung(Anchor::Start, Hang::Above));
            }
        }
        // A name wider than a narrow panel begins further left, on several lines if needed.
        let mut y_mm = self.panel.bottom + 5.2;
        for line in wrapped(&figure.x.name, TEXT_MM, RIGHT_MM - 8.0) {
            let line = fitted(&line, TEXT_MM, RIGHT_MM - 8.0);
            let half_mm = 0.5 * text_width_mm(&line, TEXT_MM);
            let x_mm = (0.5 * (self.panel.left + self.panel.right)).min(RIGHT_MM - half_mm).max(4.0 + half_mm);
            sheet.label(Label::new(line, (x_mm, y_mm), TEXT_MM).hung(Anchor::Middle, Hang::Below));
            y_mm += 1.4 * TEXT_MM;
        }
        y_mm + 0.5
    }

    /// Colours (neighbours of the same colour in a row as one area), then the numbers.
    fn cells(&self, sheet: &mut Sheet, cells: &[TradeCell], shades: &Shades) {
        for (row, cells) in cells.chunks(self.cols).enumerate() {
            let mut col = 0;
            for run in cells.chunk_by(|a, b| shades.colour(*a) == shades.colour(*b)) {
                let (from, to) = (self.cell(row, col).0, self.cell(row, col + run.len() - 1).1);
                sheet.area(rectangle(from, to), shades.colour(run[0]), 1.0);
                col += run.len();
            }
        }
        if let Some(size_mm) = self.number_mm {
            for i in 1..self.cols {
                let x_mm = self.cell(0, i).0.0;
                sheet.line(vec![(x_mm, self.panel.top), (x_mm, self.panel.bottom)], EDGE_PEN);
            }
            for i in 1..self.rows {
                let y_mm = self.cell(i, 0).1.1;
                sheet.line(vec![(self.panel.left, y_mm), (self.panel.right, y_mm)], EDGE_PEN);
            }
            for (i, &cell) in cells.iter().enumerate() {
                let (from, to) = self.cell(i / self.cols, i % self.cols);
                let at = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
                if cell == TradeCell::Untraversable {
                    cross(sheet, at, 0.38 * size_mm);
                } else {
                    let label = Label::new(sign(cell), at, size_mm).hung(Anchor::Middle, Hang::Through);
                    sheet.label(Label { colour: ink(shades.colour(cell)), ..label });
                }
            }
        }
        self.panel.outline(sheet);
    }
}

/// The text of a cell.
fn sign(cell: TradeCell) -> String {
    match cell {
        TradeCell::Hops(hops) => hops.to_string(),
        TradeCell::Untraversable => "x".to_owned(),
        TradeCell::Open => "?".to_owned(),
        TradeCell::Failed => "!".to_owned(),
    }
}

/// Whether a name fits along a vertical axis.
fn fits(name: &str, height_mm: f64) -> bool {
    text_width_mm(name, TEXT_MM) <= height_mm + 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_a_cell_has_a_contrast_of_at_least_four_and_a_half_to_its_colour() {
        let luminance = |RGBColor(r, g, b): RGBColor| {
            let linear = [r, g, b].map(|part| (f64::from(part) / 255.0).powf(2.2));
            0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
        };
        for step in 0..=100 {
            let colour = ramp(0.01 * f64::from(step));
            let (under, over) = (luminance(colour), luminance(ink(colour)));
            let ratio = (under.max(over) + 0.05) / (under.min(over) + 0.05);
            assert!(ratio >= 4.4, "{colour:?} under {:?}: {ratio:.2}", ink(colour));
        }
    }
}
