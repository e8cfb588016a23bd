//! The second panel if there is no path: the refusals counted by limit, and the nearest miss.

use super::{
    axes::{BELOW_MM, Panel},
    data::StoppedFigure,
    limits::words,
    palette::{LEFT_MM, RIGHT_MM, SMALL_MM, VERMILION},
    sheet::{Anchor, Hang, Label, Pen, Sheet, text_width_mm},
    ticks::Ticks,
};

/// Spacing of the bars.
const ROW_MM: f64 = 5.0;
/// Thickness of a bar.
const BAR_MM: f64 = 2.8;

/// Draws the panel below a height; returns where it ends.
pub(super) fn draw(sheet: &mut Sheet, stop: &StoppedFigure, top_mm: f64) -> f64 {
    if stop.refusals.is_empty() {
        let text = "No other node was within reach of the reached ground.";
        sheet.label(Label::new(text, (LEFT_MM, top_mm + 3.0), SMALL_MM));
        return top_mm + 6.0;
    }
    let names: Vec<_> = stop.refusals.iter().map(|(limit, _)| words(*limit)).collect();
    let refusals: Vec<_> = names.iter().zip(&stop.refusals).map(|(name, (_, count))| (name.as_str(), *count)).collect();
    bars(sheet, &refusals, "hops tried from the reached ground onwards, by the limit that refuses them", top_mm)
}

/// A bar and its number for each name; returns where the panel ends.
#[expect(clippy::cast_precision_loss, reason = "counts of pairs stay far below 2^53")]
pub(super) fn bars(sheet: &mut Sheet, counts: &[(&str, u64)], axis: &str, top_mm: f64) -> f64 {
    let most = counts.iter().map(|(_, count)| *count).max().unwrap_or(0).max(1);
    let names_mm = counts.iter().map(|(name, _)| text_width_mm(name, SMALL_MM)).fold(0.0, f64::max);
    let rows = counts.len() as f64;
    let panel = Panel { left: 6.0 + names_mm, top: top_mm, right: RIGHT_MM, bottom: top_mm + rows * ROW_MM + 1.5 };
    // Space for the number after the longest bar.
    let numbers_mm = text_width_mm(&most.to_string(), SMALL_MM) + 3.0;
    let per_refusal = (panel.width() - numbers_mm) / most as f64;
    let widest_mm = numbers_mm.max(panel.width() / 6.0);
    let ticks = Ticks::round(0.0, panel.width() / per_refusal, panel.width() / widest_mm);
    let numbers: Vec<_> = ticks
        .values
        .iter()
        .filter(|count| count.fract() == 0.0)
        .map(|&count| (panel.left + count * per_refusal, format!("{count:.0}")))
        .collect();
    panel.x_axis(sheet, &numbers, axis, true);
    for (i, (name, count)) in counts.iter().enumerate() {
        let y = panel.top + (i as f64 + 0.5) * ROW_MM + 0.75;
        let end = panel.left + *count as f64 * per_refusal;
        let (top, bottom) = (y - 0.5 * BAR_MM, y + 0.5 * BAR_MM);
        sheet.area(vec![(panel.left, top), (end, top), (end, bottom), (panel.left, bottom)], VERMILION, 0.7);
        sheet.line(vec![(end, top), (end, bottom)], Pen { colour: VERMILION, width_mm: 0.3 });
        sheet.label(Label::new(*name, (panel.left - 1.5, y), SMALL_MM).hung(Anchor::End, Hang::Through));
        sheet.label(Label::new(count.to_string(), (end + 1.0, y), SMALL_MM));
    }
    panel.outline(sheet);
    panel.bottom + BELOW_MM
}
