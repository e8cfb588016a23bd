//! Box plots of distance errors, with the number of landings below each.
//!
//! ```text
//!      x      the largest; beyond the axis an arrow with its number
//!      |  _   95 %
//!     +-+     75 %
//!     |o|     mean
//!     |-|     median
//!     +-+     25 %
//!      |  _   5 %
//! ```

use super::{
    super::{
        axes::Panel,
        keys::{Swatch, rectangle},
        palette::{BLACK, SMALL_MM},
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm},
        ticks::{one_in, short},
    },
    data::{ErrorQuantiles, LandingBoxes},
    diagram::{OUTLINE_PEN, Plot, Style, counted, named},
};

/// Height of the panel.
pub(super) const HIGH_MM: f64 = 58.0;
/// Above this number of boxes only every n-th landing is drawn.
const MOST_BOXES: usize = 80;
/// The greatest half-width of a box.
const HALF_MM: f64 = 3.2;
/// The largest errors are drawn to scale up to this multiple of the whiskers.
const FAR: f64 = 3.0;
const WHISKER_PEN: Pen = Pen { colour: BLACK, width_mm: 0.2 };
const MEDIAN_PEN: Pen = Pen { colour: BLACK, width_mm: 0.5 };

/// Whether there are data to draw.
pub(super) fn is_drawable(errors: &ErrorQuantiles) -> bool {
    let ErrorQuantiles { count, mean_m, q05_m, q25_m, q50_m, q75_m, q95_m, max_m } = *errors;
    count > 0 && [mean_m, q05_m, q25_m, q50_m, q75_m, q95_m, max_m].into_iter().all(f64::is_finite)
}

/// The range of errors on the axis: all of them, or up to somewhat above the whiskers if the largest are far beyond.
pub(super) fn range<'a>(errors: impl Iterator<Item = &'a ErrorQuantiles>) -> (f64, f64) {
    let (mut low, mut body, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for e in errors.filter(|e| is_drawable(e)) {
        (low, body, most) = (low.min(e.q05_m), body.max(e.q95_m).max(e.mean_m), most.max(e.max_m));
    }
    let top = if body > 0.0 && most > FAR * body { 1.35 * body } else { most.max(body) * 1.06 };
    (low, if top > low { top } else { low + 1.0 })
}

/// Draws box plots landing by landing below a height; returns where the numbers of landings end, and the legend.
pub(super) fn draw(sheet: &mut Sheet, series: &[LandingBoxes], top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let plot = Plot::new(range(series.iter().flat_map(|s| &s.landings)), top_mm, HIGH_MM);
    let landings = series.iter().map(|s| s.landings.len()).max().unwrap_or(0);
    let every = one_of(landings * series.len());
    let shown: Vec<usize> = (0..landings).filter(|i| (i + 1) % every == 0 || landings <= 1).collect();
    let slot_mm = plot.panel.width() / counts_as_number(shown.len().max(1));
    let centre = |at: usize| plot.panel.left + (counts_as_number(at) + 0.5) * slot_mm;
    let widest_mm = text_width_mm(&landings.to_string(), SMALL_MM) + 1.2;
    let numbered = one_in(widest_mm / slot_mm);
    let ticks: Vec<_> = shown
        .iter()
        .enumerate()
        .filter(|(at, _)| (at + 1) % numbered == 0 || *at == 0 && numbered > shown.len())
        .map(|(at, i)| (centre(at), (i + 1).to_string()))
        .collect();
    let thinned = if every > 1 { format!(" (1 in {every} of {landings} shown)") } else { String::new() };
    plot.axes(sheet, (&ticks, &format!("landing{thinned}")), "distance error (m)", false);
    let share_mm = slot_mm / (counts_as_number(series.len().max(1)) + 0.6);
    let half_mm = (0.42 * share_mm).min(HALF_MM);
    let mut end_mm = plot.end_mm();
    for (s, boxes) in series.iter().enumerate() {
        let style = Style::of(s);
        let beside = (counts_as_number(s) - 0.5 * (counts_as_number(series.len()) - 1.0)) * (2.4 * half_mm);
        let mut counts = Vec::new();
        for (at, &landing) in shown.iter().enumerate() {
            let Some(errors) = boxes.landings.get(landing) else { continue };
            draw_box(sheet, &plot, (centre(at) + beside, half_mm), errors, style);
            counts.push((centre(at), errors.count));
        }
        end_mm = counts_row(sheet, &plot.panel, (style, series.len() > 1), &counts, slot_mm, end_mm);
    }
    if !series.iter().flat_map(|s| &s.landings).any(is_drawable) {
        nothing(sheet, &plot.panel, "no landings");
    }
    plot.panel.outline(sheet);
    (end_mm, entries(series, &plot))
}

/// The legend: series with their numbers of landings, and the parts of a box.
fn entries(series: &[LandingBoxes], plot: &Plot) -> Vec<(Swatch, String)> {
    let of = |(s, boxes): (usize, &LandingBoxes)| {
        let landings = boxes.landings.iter().fold(0_u64, |sum, landing| sum.saturating_add(landing.count));
        let count = counted(landings, "landing");
        let unnamed = boxes.name.is_empty() && series.len() == 1;
        (Style::of(s).swatch(), if unnamed { count } else { format!("{}: {count}", named(&boxes.name, s)) })
    };
    series.iter().enumerate().map(of).chain(box_keys(plot, series.iter().flat_map(|s| &s.landings))).collect()
}

/// The legend of the parts of a box.
pub(super) fn box_keys<'a>(plot: &Plot, errors: impl Iterator<Item = &'a ErrorQuantiles>) -> Vec<(Swatch, String)> {
    let mut keys = vec![
        (Swatch::Symbol(box_symbol), "median, 25 % to 75 %".to_owned()),
        (Swatch::Symbol(whisker_symbol), "5 % to 95 %".to_owned()),
        (Swatch::Symbol(mean_symbol), "mean".to_owned()),
    ];
    let (beyond, within): (Vec<&ErrorQuantiles>, Vec<&ErrorQuantiles>) =
        errors.filter(|e| is_drawable(e)).partition(|e| e.max_m > plot.up.to);
    if !within.is_empty() {
        keys.push((Swatch::Symbol(largest_symbol), "largest".to_owned()));
    }
    if !beyond.is_empty() {
        keys.push((Swatch::Symbol(beyond_symbol), "largest, beyond the axis (m)".to_owned()));
    }
    keys
}

/// One box.
pub(super) fn draw_box(sheet: &mut Sheet, plot: &Plot, (x, half_mm): (f64, f64), errors: &ErrorQuantiles, style: Style) {
    if !is_drawable(errors) {
        return;
    }
    let y = |value_m: f64| plot.up.place(value_m);
    let (q25, q75) = (y(errors.q25_m), y(errors.q75_m));
    for (end, box_end) in [(y(errors.q05_m), q25), (y(errors.q95_m), q75)] {
        let cap = 0.6 * half_mm;
        sheet.line(vec![(x, box_end), (x, end), (x - cap, end), (x + cap, end)], WHISKER_PEN);
    }
    style.fill(sheet, (x - half_mm, q25), (x + half_mm, q75));
    outline(sheet, (x - half_mm, q75), (x + half_mm, q25));
    sheet.line(vec![(x - half_mm, y(errors.q50_m)), (x + half_mm, y(errors.q50_m))], MEDIAN_PEN);
    mean_symbol(sheet, (x, y(errors.mean_m)));
    if errors.max_m <= plot.up.to {
        largest_symbol(sheet, (x, y(errors.max_m)));
    } else {
        beyond(sheet, plot, x, errors.max_m);
    }
}

/// An arrow at the top of the panel with the value beyond the axis, if there is room.
fn beyond(sheet: &mut Sheet, plot: &Plot, x: f64, value_m: f64) {
    beyond_symbol(sheet, (x, plot.panel.top + 1.6));
    let label = Label::new(short(value_m), (x, plot.panel.top + 3.2), SMALL_MM).hung(Anchor::Middle, Hang::Below);
    let (left, _, right, _) = label.bounds_mm();
    if left > plot.panel.left && right < plot.panel.right && !sheet.is_taken(&label) {
        sheet.label(label);
    }
}

/// The number of landings below each box, upright if there is no room side by side; returns where the row ends.
pub(super) fn counts_row(
    sheet: &mut Sheet,
    panel: &Panel,
    (style, is_marked): (Style, bool),
    counts: &[(f64, u64)],
    slot_mm: f64,
    top_mm: f64,
) -> f64 {
    let widest_mm = counts.iter().map(|(_, count)| text_width_mm(&count.to_string(), SMALL_MM)).fold(0.0, f64::max);
    let is_turned = widest_mm + 1.0 > slot_mm;
    let high_mm = if is_turned { widest_mm } else { SMALL_MM };
    let every = if is_turned { one_in((SMALL_MM + 0.4) / slot_mm) } else { 1 };
    let y = top_mm + 0.5 * high_mm;
    for &(x, count) in counts.iter().step_by(every) {
        let label = Label::new(count.to_string(), (x, y), SMALL_MM).hung(Anchor::Middle, Hang::Through);
        sheet.label(if is_turned { label.turned() } else { label });
    }
    let name = if every > 1 { format!("n, 1 in {every}") } else { "n".to_owned() };
    let name = Label::new(name, (panel.left - 1.8, y), SMALL_MM).hung(Anchor::End, Hang::Through);
    let (left, ..) = name.bounds_mm();
    if is_marked {
        style.fill(sheet, (left - 4.0, y - 1.0), (left - 1.0, y + 1.0));
        outline(sheet, (left - 4.0, y - 1.0), (left - 1.0, y + 1.0));
    }
    sheet.label(name);
    top_mm + high_mm + 1.3
}

/// Draws the statement that a panel is empty.
pub(super) fn nothing(sheet: &mut Sheet, panel: &Panel, text: &str) {
    let middle = (0.5 * (panel.left + panel.right), 0.5 * (panel.top + panel.bottom));
    sheet.label(Label::new(text, middle, SMALL_MM).hung(Anchor::Middle, Hang::Through));
}

/// Every n-th landing is drawn; returns n.
fn one_of(boxes: usize) -> usize {
    boxes.div_ceil(MOST_BOXES).max(1)
}

#[expect(clippy::cast_precision_loss, reason = "some dozens of boxes")]
const fn counts_as_number(count: usize) -> f64 {
    count as f64
}

fn outline(sheet: &mut Sheet, a: Place, b: Place) {
    sheet.line(rectangle(a, b).into_iter().chain([a]).collect(), OUTLINE_PEN);
}

fn box_symbol(sheet: &mut Sheet, (x, y): Place) {
    outline(sheet, (x - 1.6, y - 1.4), (x + 1.6, y + 1.4));
    sheet.line(vec![(x - 1.6, y), (x + 1.6, y)], MEDIAN_PEN);
}

fn whisker_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.line(
        vec![(x - 1.0, y - 1.6), (x + 1.0, y - 1.6), (x, y - 1.6), (x, y + 1.6), (x - 1.0, y + 1.6), (x + 1.0, y + 1.6)],
        WHISKER_PEN,
    );
}

fn mean_symbol(sheet: &mut Sheet, at: Place) {
    sheet.ring(at, 0.6, Pen { colour: BLACK, width_mm: 0.25 });
}

fn largest_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.line(vec![(x - 0.6, y - 0.6), (x + 0.6, y + 0.6)], WHISKER_PEN);
    sheet.line(vec![(x - 0.6, y + 0.6), (x + 0.6, y - 0.6)], WHISKER_PEN);
}

fn beyond_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.area(vec![(x, y - 1.2), (x - 0.8, y + 0.6), (x + 0.8, y + 0.6)], BLACK, 1.0);
}
