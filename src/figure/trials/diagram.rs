//! Shared by the diagrams of trials: the transformation of values to the sheet, and the styles of series.

use plotters::style::RGBColor;

use super::super::{
    axes::{BELOW_MM, Panel},
    keys::{Swatch, rectangle, stripes},
    palette::{BLACK, GREEN, LEFT_MM, ORANGE, PURPLE, RIGHT_MM, SKY, SMALL_MM, TEXT_MM},
    sheet::{Label, Pen, Place, Sheet, text_width_mm},
    ticks::{Ticks, short},
};

/// Axis numbers longer than this are shortened.
const LONGEST: usize = 8;
/// Smallest spacing of the numbers of a vertical axis.
const TICK_MM: f64 = 7.0;
/// Room for the heading of a panel.
const HEADING_MM: f64 = 5.5;
/// Outlines of boxes and bars.
pub(super) const OUTLINE_PEN: Pen = Pen { colour: BLACK, width_mm: 0.18 };

/// A count as a number to draw.
#[expect(clippy::cast_precision_loss, reason = "drawn to a hundredth of a millimetre")]
pub(super) const fn number(count: u64) -> f64 {
    count as f64
}

/// A range of values along one side of a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) from: f64,
    pub(super) to: f64,
    start_mm: f64,
    end_mm: f64,
}

impl Axis {
    /// A range of values between two positions of the sheet; a range of zero width is widened.
    pub(super) fn new((from, to): (f64, f64), start_mm: f64, end_mm: f64) -> Self {
        let (from, to) = if from < to { (from, to) } else { (from - 0.5, from + 0.5) };
        Self { from, to, start_mm, end_mm }
    }

    /// Where a value is drawn.
    pub(super) fn place(&self, value: f64) -> f64 {
        self.start_mm + (value - self.from) / (self.to - self.from) * (self.end_mm - self.start_mm)
    }

    /// Round values with their positions, at most the given number.
    pub(super) fn ticks(&self, most: f64) -> Vec<(f64, String)> {
        let ticks = Ticks::round(self.from, self.to, most);
        let long = ticks.longest().len() > LONGEST;
        ticks.values.iter().map(|&value| (self.place(value), if long { short(value) } else { ticks.text(value) })).collect()
    }
}

/// A panel with a range of values up its left side.
pub(super) struct Plot {
    pub(super) panel: Panel,
    pub(super) up: Axis,
    ticks: Vec<(f64, String)>,
}

impl Plot {
    /// Lays it out below a height of the sheet.
    pub(super) fn new(range: (f64, f64), top_mm: f64, height_mm: f64) -> Self {
        let up = Axis::new(range, top_mm + height_mm, top_mm);
        let ticks = up.ticks(height_mm / TICK_MM);
        let widest_mm = ticks.iter().map(|(_, text)| text_width_mm(text, SMALL_MM)).fold(0.0, f64::max);
        let left = LEFT_MM.max(widest_mm + TEXT_MM + 5.5);
        Self { panel: Panel { left, top: top_mm, right: RIGHT_MM, bottom: top_mm + height_mm }, up, ticks }
    }

    /// Both axes with their grid; the ticks of the horizontal axis are given.
    pub(super) fn axes(&self, sheet: &mut Sheet, (along, name): (&[(f64, String)], &str), up: &str, grid_along: bool) {
        self.panel.y_axis(sheet, &self.ticks, up, true);
        self.panel.x_axis(sheet, along, name, grid_along);
    }

    /// The lower end, including numbers and name of the horizontal axis.
    pub(super) fn end_mm(&self) -> f64 {
        self.panel.bottom + BELOW_MM
    }
}

/// The style of a series.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) colour: RGBColor,
    pattern: Pattern,
}

#[derive(Clone, Copy, Debug)]
enum Pattern {
    Plain,
    Striped,
    Dotted,
}

impl Style {
    /// The style of a series by its index: any twelve consecutive series differ in colour or hatching.
    pub(super) fn of(series: usize) -> Self {
        let colour = [SKY, ORANGE, GREEN, PURPLE][series % 4];
        Self { colour, pattern: [Pattern::Plain, Pattern::Striped, Pattern::Dotted][series % 3] }
    }

    /// Its sample in a legend.
    pub(super) const fn swatch(self) -> Swatch {
        match self.pattern {
            Pattern::Plain => Swatch::Fill(self.colour),
            Pattern::Striped => Swatch::Striped(self.colour),
            Pattern::Dotted => Swatch::Dotted(self.colour),
        }
    }

    /// Dashes and gaps of its lines; `None` for a solid one.
    pub(super) const fn dashes(self) -> Option<(f64, f64)> {
        match self.pattern {
            Pattern::Plain => None,
            Pattern::Striped => Some((2.2, 1.0)),
            Pattern::Dotted => Some((0.7, 0.7)),
        }
    }

    /// A filled and hatched rectangle between two corners.
    pub(super) fn fill(self, sheet: &mut Sheet, a: Place, b: Place) {
        let (left, top, right, bottom) = (a.0.min(b.0), a.1.min(b.1), a.0.max(b.0), a.1.max(b.1));
        sheet.area(rectangle((left, top), (right, bottom)), self.colour, 0.8);
        match self.pattern {
            Pattern::Plain => {}
            Pattern::Striped => stripes(sheet, (left, top), (right, bottom), 1.6, Pen { width_mm: 0.15, ..OUTLINE_PEN }),
            Pattern::Dotted => {
                let mut x = left + 0.8;
                while x < right - 0.2 {
                    sheet.dot((x, 0.5 * (top + bottom)), 0.2, BLACK);
                    x += 1.6;
                }
            }
        }
    }

    /// A line as the series draws it.
    pub(super) fn line(self, sheet: &mut Sheet, points: Vec<Place>, pen: Pen) {
        match self.dashes() {
            Some((dash_mm, gap_mm)) => sheet.dashed(&points, dash_mm, gap_mm, pen),
            None => sheet.line(points, pen),
        }
    }
}

/// The heading of one panel among several; returns where the panel begins.
pub(super) fn heading(sheet: &mut Sheet, text: &str, top_mm: f64) -> f64 {
    sheet.label(Label { bold: true, ..Label::new(text, (6.0, top_mm + 0.5 * TEXT_MM), TEXT_MM) });
    top_mm + HEADING_MM
}

/// A series' name, or a numbered substitute.
pub(super) fn named(name: &str, series: usize) -> String {
    if name.is_empty() { format!("series {}", series + 1) } else { name.to_owned() }
}

/// A counted noun, such as `1 trial` or `12 trials`.
pub(super) fn counted(count: u64, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}
