//! What each error costs: a bar for each, with its interval.

use super::{
    super::{
        axes::{BELOW_MM, Panel},
        keys::{Swatch, rectangle},
        palette::{BLACK, RIGHT_MM, SMALL_MM},
        sheet::{Anchor, Hang, Label, Pen, Sheet, text_width_mm},
    },
    boxes::nothing,
    data::{SensitivityBar, Success},
    diagram::{Axis, OUTLINE_PEN, Style, number},
};

/// Thickness of a bar.
const BAR_MM: f64 = 3.4;
/// Spacing of the bars.
const NEXT_MM: f64 = 6.0;
/// The pen of intervals, and of the line at zero.
const INTERVAL_PEN: Pen = Pen { colour: BLACK, width_mm: 0.25 };

/// Draws the panel below a height; returns where it ends, and the legend.
pub(super) fn draw(sheet: &mut Sheet, bars: &[SensitivityBar], top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let is_finite = |bar: &&SensitivityBar| [bar.cost.rate, bar.cost.low, bar.cost.high].into_iter().all(f64::is_finite);
    let bars: Vec<&SensitivityBar> = bars.iter().filter(is_finite).collect();
    let narrowest = bars.iter().map(|bar| bar.cost.high - bar.cost.low).fold(f64::INFINITY, f64::min);
    let decimals = if narrowest >= 0.01 { 1 } else { 2 };
    let texts: Vec<String> = bars.iter().map(|bar| points(&bar.cost, decimals)).collect();
    let wide = |texts: &mut dyn Iterator<Item = &str>| texts.map(|text| text_width_mm(text, SMALL_MM)).fold(0.0, f64::max);
    let names_mm = wide(&mut bars.iter().map(|bar| bar.name.as_str()));
    let numbers_mm = wide(&mut texts.iter().map(String::as_str));
    let panel = Panel {
        left: (7.5 + names_mm).min(80.0),
        top: top_mm,
        right: RIGHT_MM - numbers_mm - 2.5,
        bottom: top_mm + NEXT_MM * number(bars.len().max(1) as u64) + 1.0,
    };
    let lowest = bars.iter().map(|bar| bar.cost.low).fold(0.0, f64::min);
    let highest = bars.iter().map(|bar| bar.cost.high).fold(0.0, f64::max);
    // A round range, so that an interval does not end at the frame.
    let beside = 0.04 * (highest - lowest).max(0.01);
    let low = if lowest < 0.0 { lowest - beside } else { 0.0 };
    let axis = Axis::new((100.0 * low, 100.0 * (highest + beside)), panel.left, panel.right);
    let name = "success gained without the error (percentage points)";
    panel.x_axis(sheet, &axis.ticks(panel.width() / 12.0), name, true);
    for (i, (bar, text)) in bars.iter().zip(&texts).enumerate() {
        let y = panel.top + 0.5 + (number(i as u64) + 0.5) * NEXT_MM;
        sheet.label(Label::new(bar.name.as_str(), (panel.left - 1.8, y), SMALL_MM).hung(Anchor::End, Hang::Through));
        let x = |share: f64| axis.place(100.0 * share);
        if bar.cost.rate != 0.0 {
            let (from, to) = ((x(0.0), y - 0.5 * BAR_MM), (x(bar.cost.rate), y + 0.5 * BAR_MM));
            Style::of(0).fill(sheet, from, to);
            sheet.line(rectangle(from, to).into_iter().chain([from]).collect(), OUTLINE_PEN);
        }
        let (low, high) = (x(bar.cost.low), x(bar.cost.high));
        sheet.line(vec![(low, y - 1.1), (low, y + 1.1), (low, y), (high, y), (high, y - 1.1), (high, y + 1.1)], INTERVAL_PEN);
        sheet.label(Label::new(text.as_str(), (RIGHT_MM, y), SMALL_MM).hung(Anchor::End, Hang::Through));
    }
    if bars.is_empty() {
        nothing(sheet, &panel, "no errors");
    } else {
        let zero = axis.place(0.0);
        sheet.line(vec![(zero, panel.top), (zero, panel.bottom)], INTERVAL_PEN);
    }
    panel.outline(sheet);
    let key = "gain of the success rate, on the same draws; the line across its end is its 95 % interval".to_owned();
    (panel.bottom + BELOW_MM, if bars.is_empty() { Vec::new() } else { vec![(Style::of(0).swatch(), key)] })
}

/// A difference with its interval, in percentage points.
fn points(cost: &Success, decimals: usize) -> String {
    // No negative zero.
    let [rate, low, high] = [cost.rate, cost.low, cost.high].map(|share| 100.0 * share + 0.0);
    format!("{rate:.decimals$} ({low:.decimals$} to {high:.decimals$})")
}
