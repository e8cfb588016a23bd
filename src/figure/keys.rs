//! Legends of maps and diagrams: rows of entries, each a sample with a text.

use plotters::style::RGBColor;

use super::{
    palette::{BLACK, RIGHT_MM, SMALL_MM},
    sheet::{Label, Mark, Pen, Place, Sheet, text_width_mm},
};

/// Left end of the rows.
const LEFT_MM: f64 = 6.0;
/// Width of a sample.
const SAMPLE_MM: f64 = 6.0;
/// Spacing of rows.
const ROW_MM: f64 = 4.6;
/// Half the height of a filled sample.
const HALF_MM: f64 = 1.5;

/// Thin lines over a filled sample.
const THIN_PEN: Pen = Pen { colour: BLACK, width_mm: 0.15 };

/// A sample of a legend.
#[derive(Clone, Copy, Debug)]
pub(super) enum Swatch {
    /// A colour.
    Fill(RGBColor),
    /// A colour under stripes.
    Striped(RGBColor),
    /// A colour under crossed stripes.
    Crossed(RGBColor),
    /// A colour under dots.
    Dotted(RGBColor),
    /// A colour under thin stripes that fall to the right.
    Falling(RGBColor),
    /// A colour under level lines.
    Level(RGBColor),
    /// A colour under upright lines.
    Upright(RGBColor),
    /// A colour under level and upright lines.
    Grid(RGBColor),
    /// A colour under level lines with gaps.
    DashedOver(RGBColor),
    /// A line.
    Line(Pen),
    /// A dashed line, with its dashes and gaps.
    Dashed(Pen, f64, f64),
    /// A symbol, around a position.
    Symbol(fn(&mut Sheet, Place)),
}

/// Draws entries in rows, the first centred on a height; returns where they end.
pub(super) fn draw(sheet: &mut Sheet, entries: &[(Swatch, String)], top_mm: f64) -> f64 {
    let mut at = (LEFT_MM, top_mm);
    for (swatch, text) in entries {
        let width_mm = SAMPLE_MM + 1.0 + text_width_mm(text, SMALL_MM) + 3.0;
        if at.0 > LEFT_MM && at.0 + width_mm > RIGHT_MM {
            at = (LEFT_MM, at.1 + ROW_MM);
        }
        sample(sheet, *swatch, at);
        sheet.label(Label::new(text.as_str(), (at.0 + SAMPLE_MM + 1.0, at.1), SMALL_MM));
        at.0 += width_mm;
    }
    at.1 + 0.5 * ROW_MM
}

/// A rectangle from two corners.
pub(super) fn rectangle((left, top): Place, (right, bottom): Place) -> Vec<Place> {
    vec![(left, top), (right, top), (right, bottom), (left, bottom)]
}

fn sample(sheet: &mut Sheet, swatch: Swatch, (x, y): Place) {
    let (end, top, bottom) = (x + SAMPLE_MM, y - HALF_MM, y + HALF_MM);
    match swatch {
        Swatch::Fill(colour)
        | Swatch::Striped(colour)
        | Swatch::Crossed(colour)
        | Swatch::Dotted(colour)
        | Swatch::Falling(colour)
        | Swatch::Level(colour)
        | Swatch::Upright(colour)
        | Swatch::Grid(colour)
        | Swatch::DashedOver(colour) => {
            sheet.area(rectangle((x, top), (end, bottom)), colour, 1.0);
        }
        Swatch::Line(pen) => sheet.line(vec![(x, y), (end, y)], pen),
        Swatch::Dashed(pen, dash_mm, gap_mm) => sheet.dashed(&[(x, y), (end, y)], dash_mm, gap_mm, pen),
        Swatch::Symbol(symbol) => symbol(sheet, (x + 0.5 * SAMPLE_MM, y)),
    }
    let pen = Pen { colour: BLACK, width_mm: 0.25 };
    if matches!(swatch, Swatch::Striped(_) | Swatch::Crossed(_)) {
        stripes(sheet, (x, top), (end, bottom), 1.2, pen);
    }
    if matches!(swatch, Swatch::Crossed(_) | Swatch::Falling(_)) {
        // Mirrored vertically, the same stripes fall to the right.
        let from = sheet.marks.len();
        let pen = if matches!(swatch, Swatch::Falling(_)) { THIN_PEN } else { pen };
        stripes(sheet, (x, top), (end, bottom), 1.2, pen);
        for mark in &mut sheet.marks[from..] {
            if let Mark::Line { points, .. } = mark {
                for point in points {
                    point.1 = top + bottom - point.1;
                }
            }
        }
    }
    lines(sheet, swatch, (x, top), (end, bottom));
    if matches!(swatch, Swatch::Dotted(_)) {
        for i in 0..4 {
            sheet.dot((x + 0.9 + 1.4 * f64::from(i), y + if i % 2 == 0 { -0.6 } else { 0.6 }), 0.28, BLACK);
        }
    }
}

/// The lines of a sample that are level, upright or both.
fn lines(sheet: &mut Sheet, swatch: Swatch, (left, top): Place, (right, bottom): Place) {
    const STEP_MM: f64 = 1.0;
    let places = |from: f64, to: f64| {
        std::iter::successors(Some(from + 0.5 * STEP_MM), |at| Some(at + STEP_MM)).take_while(move |at| *at < to)
    };
    if matches!(swatch, Swatch::Level(_) | Swatch::Grid(_)) {
        for y in places(top, bottom) {
            sheet.line(vec![(left, y), (right, y)], THIN_PEN);
        }
    }
    if matches!(swatch, Swatch::Upright(_) | Swatch::Grid(_)) {
        for x in places(left, right) {
            sheet.line(vec![(x, top), (x, bottom)], THIN_PEN);
        }
    }
    if matches!(swatch, Swatch::DashedOver(_)) {
        for (row, y) in places(top, bottom).enumerate() {
            let from = if row % 2 == 0 { left } else { left + STEP_MM };
            sheet.dashed(&[(from, y), (right, y)], STEP_MM, STEP_MM, THIN_PEN);
        }
    }
}

/// Stripes that rise to the right, within a rectangle.
pub(super) fn stripes(sheet: &mut Sheet, (left, top): Place, (right, bottom): Place, step_mm: f64, pen: Pen) {
    let high = bottom - top;
    let mut foot = left - high + 0.5 * step_mm;
    while foot < right {
        let (from, to) = (foot.max(left), (foot + high).min(right));
        if to > from {
            sheet.line(vec![(from, bottom - (from - foot)), (to, bottom - (to - foot))], pen);
        }
        foot += step_mm;
    }
}
