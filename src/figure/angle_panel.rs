//! The second panel of a path: each hop's feasible take-off angles, the chosen one, and the limits that set the two ends.

use super::{
    axes::{BELOW_MM, Panel},
    data::{HopFigure, Thinned},
    palette::{BLACK, BLUE, LEFT_MM, RIGHT_MM, SKY, SMALL_MM},
    sheet::{Anchor, Hang, Label, Pen, Sheet, text_width_mm},
    ticks::{Ticks, one_in},
};
use crate::world::Limit;

/// Height of the area with the bars.
const BARS_MM: f64 = 30.0;
/// Room left and right of the bars.
const SIDE_MM: f64 = 2.0;
/// Smallest range of angles shown.
const LEAST_RANGE_DEG: f64 = 8.0;

/// Draws the panel below a height; returns where it ends.
pub(super) fn draw(sheet: &mut Sheet, hops: &Thinned<HopFigure>, top_mm: f64) -> f64 {
    let layout = Layout::new(hops, top_mm);
    layout.axes(sheet, hops);
    for (i, hop) in hops.shown.iter().enumerate() {
        layout.bar(sheet, i, hop);
    }
    layout.panel.outline(sheet);
    layout.panel.bottom + BELOW_MM
}

/// The layout of the panel.
struct Layout {
    panel: Panel,
    /// Width for one hop.
    slot_mm: f64,
    /// Whether limit names are written horizontally or upright.
    upright: bool,
    /// Names and numbers are written for every n-th hop.
    every: usize,
    /// Room for names above and below the bars.
    names_mm: f64,
    /// Lowest and highest angle of any bar, at least the smallest range apart.
    range_deg: (f64, f64),
}

/// The names of the limits at the lower and the upper end of a hop's bars.
fn names(hop: &HopFigure) -> [String; 2] {
    hop.windows.ends.clone()
}

/// The name of the limit that refuses the angles between a hop's two bars, if it has two.
fn between(hop: &HopFigure) -> Option<String> {
    hop.windows.between.filter(|_| hop.windows.angles.len() == 2).map(|limit| limit.to_string())
}

/// The least and the greatest angle of a hop's bars, degrees.
fn extent_deg(hop: &HopFigure) -> (f64, f64) {
    hop.windows
        .angles
        .iter()
        .fold((90.0f64, -90.0f64), |(low, high), window| (low.min(window.min.degrees()), high.max(window.max.degrees())))
}

impl Layout {
    #[expect(clippy::cast_precision_loss, reason = "at most a few hundred hops are drawn")]
    fn new(hops: &Thinned<HopFigure>, top_mm: f64) -> Self {
        let widest = hops.shown.iter().flat_map(|hop| names(hop).into_iter().chain(between(hop)));
        let widest = widest.map(|name| text_width_mm(&name, SMALL_MM)).fold(0.0, f64::max);
        let slot_mm = (RIGHT_MM - LEFT_MM - 2.0 * SIDE_MM) / hops.shown.len().max(1) as f64;
        let upright = slot_mm < widest + 1.5;
        let number_mm = text_width_mm(&hops.of.to_string(), SMALL_MM);
        let needed_mm = if upright { (SMALL_MM + 0.8).max(number_mm + 1.0) } else { 0.0 };
        let every = one_in(needed_mm / slot_mm);
        let names_mm = 2.4 + if upright { widest } else { SMALL_MM };
        let (low, high) = hops.shown.iter().fold((90.0f64, -90.0f64), |(low, high), hop| {
            let (least, greatest) = extent_deg(hop);
            (low.min(least), high.max(greatest))
        });
        let spare = (0.5 * (LEAST_RANGE_DEG - (high - low))).max(0.0);
        let panel = Panel { left: LEFT_MM, top: top_mm, right: RIGHT_MM, bottom: top_mm + BARS_MM + 2.0 * names_mm };
        Self { panel, slot_mm, upright, every, names_mm, range_deg: (low - spare, high + spare) }
    }

    /// The height on the sheet of an angle.
    fn y(&self, angle_deg: f64) -> f64 {
        let (low, high) = self.range_deg;
        self.panel.bottom - self.names_mm - (angle_deg - low) / (high - low) * BARS_MM
    }

    /// The middle of a hop's slot.
    #[expect(clippy::cast_precision_loss, reason = "at most a few hundred hops are drawn")]
    fn x(&self, i: usize) -> f64 {
        self.panel.left + SIDE_MM + (i as f64 + 0.5) * self.slot_mm
    }

    fn axes(&self, sheet: &mut Sheet, hops: &Thinned<HopFigure>) {
        let numbers: Vec<_> =
            hops.shown.iter().enumerate().step_by(self.every).map(|(i, hop)| (self.x(i), hop.number.to_string())).collect();
        self.panel.x_axis(sheet, &numbers, "hop number", false);
        let (low, high) = self.range_deg;
        let beyond = self.names_mm * (high - low) / BARS_MM;
        // Take-off angles end at 90 degrees: the room for names above it has no tick marks.
        let (from, to) = ((low - beyond).max(-90.0), (high + beyond).min(90.0));
        let ticks = Ticks::round(from, to, (self.y(from) - self.y(to)) / 8.0);
        let angles: Vec<_> = ticks.values.iter().map(|&deg| (self.y(deg), ticks.text(deg))).collect();
        self.panel.y_axis(sheet, &angles, "take-off angle (deg)", true);
    }

    /// One hop: bar, chosen angle, limit names.
    fn bar(&self, sheet: &mut Sheet, i: usize, hop: &HopFigure) {
        let x = self.x(i);
        let half = (0.3 * self.slot_mm).min(2.2);
        for window in &hop.windows.angles {
            let (bottom, top) = (self.y(window.min.degrees()), self.y(window.max.degrees()));
            let corners = [(x - half, bottom), (x + half, bottom), (x + half, top), (x - half, top)];
            sheet.area(corners.to_vec(), SKY, 0.45);
            sheet.line(corners.into_iter().chain([corners[0]]).collect(), Pen { colour: BLUE, width_mm: 0.2 });
        }
        let (least, greatest) = extent_deg(hop);
        let (bottom, top) = (self.y(least), self.y(greatest));
        chosen(sheet, (x, self.y(hop.hop.takeoff_angle.degrees())), half);
        if !i.is_multiple_of(self.every) {
            return;
        }
        let [lower, upper] = names(hop);
        // With few hops the names are at their bars; with many they are placed clear of the bars in between.
        let (low, high) = self.range_deg;
        let (top, bottom) = if self.every > 1 { (self.y(high), self.y(low)) } else { (top, bottom) };
        let (above, below) = ((x, top - 1.2), (x, bottom + 1.2));
        if self.upright {
            sheet.label(Label::new(upper, above, SMALL_MM).turned());
            sheet.label(Label::new(lower, below, SMALL_MM).hung(Anchor::End, Hang::Through).turned());
        } else {
            sheet.label(Label::new(upper, above, SMALL_MM).hung(Anchor::Middle, Hang::Above));
            sheet.label(Label::new(lower, below, SMALL_MM).hung(Anchor::Middle, Hang::Below));
            if let (Some(name), [flat, steep]) = (between(hop), &hop.windows.angles[..]) {
                let (from, to) = (self.y(flat.max.degrees()), self.y(steep.min.degrees()));
                if from - to > SMALL_MM + 2.5 {
                    sheet.label(Label::new(name, (x, 0.5 * (from + to)), SMALL_MM).hung(Anchor::Middle, Hang::Through));
                }
            }
        }
    }
}

/// The chosen angle: a line across the bar and a diamond.
fn chosen(sheet: &mut Sheet, (x, y): (f64, f64), half: f64) {
    let wide = half + 0.5;
    sheet.line(vec![(x - wide, y), (x + wide, y)], Pen { colour: BLACK, width_mm: 0.3 });
    let r = (0.6 * half).min(0.9);
    sheet.area(vec![(x - r, y), (x, y - r), (x + r, y), (x, y + r)], BLACK, 1.0);
}

/// The caption of the panel.
pub(super) fn caption(hops: &Thinned<HopFigure>) -> Vec<String> {
    let mut lines =
        vec!["Bars: feasible take-off angles above the horizontal and the limits at their ends; diamond: angle chosen.".to_owned()];
    lines.extend(hops.shown.iter().find_map(|hop| hop.windows.between).map(|limit| match limit {
        Limit::TakeoffSpeedLevels => format!("Lines: the angles of the machine's take-off speeds; {limit} refuses those between."),
        _ => format!("Two bars of one hop: {limit} refuses the angles between them, whose arcs are slower."),
    }));
    lines
}
