//! Distance errors against the width of the cones, with the hops of the planned path at each width. If a width is given twice, the
//! first is drawn.

use super::{
    super::{
        keys::Swatch,
        palette::{BLACK, BLUE, SMALL_MM, VERMILION},
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet},
    },
    boxes::{box_keys, counts_row, draw_box, is_drawable, nothing, range},
    data::ConeWidthPoint,
    diagram::{Axis, Plot, Style},
};

/// Height of the panel.
const HIGH_MM: f64 = 68.0;
/// The strip with the hops, at the top of the panel.
const STRIP_MM: f64 = 5.0;
/// The greatest half-width of a box.
const HALF_MM: f64 = 4.0;
/// Room beside the first and the last width.
const BESIDE_MM: f64 = 12.0;
/// Style of the line through the medians.
const MEDIANS_PEN: Pen = Pen { colour: BLUE, width_mm: 0.25 };

/// Draws the panel below a height; returns where the numbers of landings end, and the legend.
pub(super) fn draw(sheet: &mut Sheet, points: &[ConeWidthPoint], top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let mut points: Vec<ConeWidthPoint> = points.iter().filter(|point| point.width_deg.is_finite()).copied().collect();
    points.sort_by(|a, b| a.width_deg.total_cmp(&b.width_deg));
    points.dedup_by_key(|point| point.width_deg.to_bits());
    let flown = || points.iter().filter(|point| point.hops.is_some()).map(|point| &point.errors);
    let plot = Plot::new(range(flown()), top_mm + STRIP_MM, HIGH_MM - STRIP_MM);
    let ends = (points.first().map_or(0.0, |p| p.width_deg), points.last().map_or(1.0, |p| p.width_deg));
    let along = Axis::new(ends, plot.panel.left + BESIDE_MM, plot.panel.right - BESIDE_MM);
    let places: Vec<f64> = points.iter().map(|point| along.place(point.width_deg)).collect();
    let nearest_mm = places.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0).fold(4.0 * HALF_MM, f64::min);
    let ticks = along.ticks((plot.panel.width() - 2.0 * BESIDE_MM) / 14.0);
    plot.axes(sheet, (&ticks, "width of the cones (deg)"), "distance error over all landings (m)", true);
    let medians = points.iter().zip(&places).filter(|(point, _)| point.hops.is_some() && is_drawable(&point.errors));
    let medians: Vec<Place> = medians.map(|(point, &x)| (x, plot.up.place(point.errors.q50_m))).collect();
    if medians.len() > 1 {
        sheet.dashed(&medians, 1.6, 0.8, MEDIANS_PEN);
    }
    let mut counts = Vec::new();
    for (point, &x) in points.iter().zip(&places) {
        if point.hops.is_some() {
            draw_box(sheet, &plot, (x, (0.35 * nearest_mm).min(HALF_MM)), &point.errors, Style::of(0));
            counts.push((x, point.errors.count));
        } else {
            no_path_symbol(sheet, (x, plot.panel.bottom - 3.0));
        }
        hops(sheet, point.hops, (x, top_mm + 0.5 * STRIP_MM));
    }
    sheet
        .label(Label::new("planned:", (plot.panel.left - 1.8, top_mm + 0.5 * STRIP_MM), SMALL_MM).hung(Anchor::End, Hang::Through));
    if points.is_empty() {
        nothing(sheet, &plot.panel, "no widths");
    }
    plot.panel.outline(sheet);
    let end_mm = counts_row(sheet, &plot.panel, (Style::of(0), false), &counts, nearest_mm, plot.end_mm());
    let mut keys = box_keys(&plot, flown());
    if medians.len() > 1 {
        keys.push((Swatch::Dashed(MEDIANS_PEN, 1.6, 0.8), "from median to median".to_owned()));
    }
    if points.iter().any(|point| point.hops.is_none()) {
        keys.push((Swatch::Symbol(no_path_symbol), "no path at this width".to_owned()));
    }
    (end_mm, keys)
}

/// The hops of the planned path above a width, if there is room.
fn hops(sheet: &mut Sheet, hops: Option<u64>, at: Place) {
    let text = match hops {
        Some(1) => "1 hop".to_owned(),
        Some(hops) => format!("{hops} hops"),
        None => "no path".to_owned(),
    };
    let label = Label { bold: true, ..Label::new(text, at, SMALL_MM).hung(Anchor::Middle, Hang::Through) };
    if !sheet.is_taken(&label) {
        sheet.label(label);
    }
}

fn no_path_symbol(sheet: &mut Sheet, (x, y): Place) {
    let pen = Pen { colour: VERMILION, width_mm: 0.5 };
    sheet.line(vec![(x - 1.2, y - 1.2), (x + 1.2, y + 1.2)], pen);
    sheet.line(vec![(x - 1.2, y + 1.2), (x + 1.2, y - 1.2)], pen);
    sheet.ring((x, y), 1.7, Pen { colour: BLACK, width_mm: 0.15 });
}
