//! The front of hops against estimated success.

use super::{
    super::{
        keys::Swatch,
        palette::{BLACK, BLUE, ORANGE, SMALL_MM, VERMILION},
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm},
    },
    boxes::nothing,
    data::{FrontFigure, FrontPoint},
    diagram::{Axis, Plot, number},
};

/// Height of the panel.
const HIGH_MM: f64 = 68.0;
/// Room beside the first and the last path.
const BESIDE_MM: f64 = 8.0;
/// The smallest range of success on the axis, percent.
const LEAST: f64 = 5.0;
/// Half the width of the ends of an interval.
const END_MM: f64 = 1.0;
const INTERVAL_PEN: Pen = Pen { colour: BLACK, width_mm: 0.25 };
const FRONT_PEN: Pen = Pen { colour: BLUE, width_mm: 0.25 };
const WANTED_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.35 };

/// Draws the panel below a height; returns where it ends, and the legend.
pub(super) fn draw(sheet: &mut Sheet, figure: &FrontFigure, top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let is_drawable =
        |point: &&FrontPoint| [point.success.low, point.success.rate, point.success.high].iter().all(|r| r.is_finite());
    let points: Vec<FrontPoint> = figure.points.iter().filter(is_drawable).copied().collect();
    let wanted = figure.success_min.map(|success| 100.0 * success);
    let plot = Plot::new(range(&points, wanted), top_mm, HIGH_MM);
    let (first, last) = (points.first().map_or(0, |point| point.hops), points.last().map_or(1, |point| point.hops));
    let along = Axis::new((number(first), number(last)), plot.panel.left + BESIDE_MM, plot.panel.right - BESIDE_MM);
    let ticks: Vec<_> = whole_ticks(first, last).map(|hops| (along.place(number(hops)), hops.to_string())).collect();
    plot.axes(sheet, (&ticks, "hops"), "estimated success (%)", true);
    let place = |point: &FrontPoint| -> Place { (along.place(number(point.hops)), plot.up.place(100.0 * point.success.rate)) };
    if let Some(wanted) = wanted {
        let y = plot.up.place(wanted);
        sheet.dashed(&[(plot.panel.left, y), (plot.panel.right, y)], 2.2, 1.0, WANTED_PEN);
    }
    if points.len() > 1 {
        sheet.dashed(&points.iter().map(place).collect::<Vec<_>>(), 1.6, 0.8, FRONT_PEN);
    }
    for point in &points {
        let (x, y) = place(point);
        let (low, high) = (plot.up.place(100.0 * point.success.low), plot.up.place(100.0 * point.success.high));
        for end in [low, high] {
            sheet.line(vec![(x - END_MM, end), (x + END_MM, end)], INTERVAL_PEN);
        }
        sheet.line(vec![(x, low), (x, high)], INTERVAL_PEN);
        if point.planned {
            planned_symbol(sheet, (x, y));
        } else {
            path_symbol(sheet, (x, y));
        }
        let text = format!("{:.1} %", 100.0 * point.success.rate);
        let beyond = x + 3.0 + text_width_mm(&text, SMALL_MM) > plot.panel.right;
        let (side_mm, anchor) = if beyond { (-2.4, Anchor::End) } else { (2.4, Anchor::Start) };
        let label = Label::new(text, (x + side_mm, y + 1.2), SMALL_MM).hung(anchor, Hang::Below);
        if !sheet.is_taken(&label) {
            sheet.label(label);
        }
    }
    if points.is_empty() {
        nothing(sheet, &plot.panel, "no path");
    }
    plot.panel.outline(sheet);
    (plot.end_mm(), entries(&points, figure.success_min))
}

/// Whole numbers of hops for the axis, at most about a dozen.
fn whole_ticks(first: u64, last: u64) -> impl Iterator<Item = u64> {
    const MOST: u64 = 12;
    let step = last.saturating_sub(first).div_ceil(MOST).max(1);
    (first..=last).step_by(usize::try_from(step).unwrap_or(usize::MAX))
}

/// The range of success, percent.
fn range(points: &[FrontPoint], wanted: Option<f64>) -> (f64, f64) {
    let ends = points.iter().flat_map(|point| [100.0 * point.success.low, 100.0 * point.success.high]).chain(wanted);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| (low.min(end), high.max(end)));
    if low > high {
        return (0.0, 100.0);
    }
    let beside = (0.06 * (high - low)).max(0.5 * (LEAST - (high - low)));
    ((low - beside).max(0.0), (high + beside).min(100.0 + 0.5 * beside))
}

fn path_symbol(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 0.9, BLUE);
}

/// The path of the plan: a ring about its dot, so that it is not told by its colour alone.
fn planned_symbol(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 1.1, ORANGE);
    sheet.ring(at, 1.9, Pen { colour: BLACK, width_mm: 0.35 });
}

/// The legend.
fn entries(points: &[FrontPoint], success_min: Option<f64>) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    if points.iter().any(|point| point.planned) {
        found.push((Swatch::Symbol(planned_symbol), "path of the plan".to_owned()));
    }
    if points.iter().any(|point| !point.planned) {
        found.push((Swatch::Symbol(path_symbol), "most reliable path of so many hops".to_owned()));
    }
    if !points.is_empty() {
        found.push((Swatch::Line(INTERVAL_PEN), "95 % interval of the estimate".to_owned()));
    }
    if let Some(success) = success_min {
        found.push((
            Swatch::Dashed(WANTED_PEN, 2.2, 1.0),
            format!("least success wanted: {}", crate::quantity::format_number(success)),
        ));
    }
    found
}
