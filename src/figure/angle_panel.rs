//! The second panel of a path: each hop's feasible take-off angles, the chosen one, and the limits that set the two ends.

use super::{
    axes::Panel,
    data::{HopFigure, Thinned},
    limits::words,
    palette::{BLACK, BLUE, LEFT_MM, RIGHT_MM, SKY, SMALL_MM, TEXT_MM},
    picture::paragraph,
    sheet::{Anchor, Hang, Label, Pen, Sheet, text_width_mm, wrapped},
    ticks::{Ticks, one_in},
};
use crate::world::Limit;

/// Height of the panel.
const HIGH_MM: f64 = 40.0;
/// Room above the highest and below the lowest bar, up to 90 degrees.
const SPARE_MM: f64 = 3.0;
/// Room left and right of the bars.
const SIDE_MM: f64 = 2.0;
/// Smallest range of angles shown.
const LEAST_RANGE_DEG: f64 = 8.0;
/// Spacing of the lines of a limit's name.
const LINE_MM: f64 = 2.9;
/// A limit's name has at most so many lines below one another.
const MOST_LINES: usize = 3;
/// Room for the numbers of hops below the panel.
const NUMBERS_MM: f64 = 4.6;

/// Draws the panel below a height; returns where it ends.
pub(super) fn draw(sheet: &mut Sheet, hops: &Thinned<HopFigure>, top_mm: f64) -> f64 {
    let layout = Layout::new(hops, top_mm);
    layout.axes(sheet, hops);
    for (i, hop) in hops.shown.iter().enumerate() {
        layout.bar(sheet, i, hop);
    }
    layout.panel.outline(sheet);
    layout.names(sheet, hops)
}

/// How the limits at the ends of the bars are named.
enum Naming {
    /// In words, in so many lines.
    Words(usize),
    /// By a letter, which a list below the panel explains.
    Letters(Vec<String>),
}

/// The layout of the panel.
struct Layout {
    panel: Panel,
    /// Width for one hop.
    slot_mm: f64,
    naming: Naming,
    /// Names and numbers are written for every n-th hop.
    every: usize,
    /// Lowest and highest angle of the panel.
    range_deg: (f64, f64),
}

/// The name of the limit that refuses the angles between a hop's two bars, if it has two.
fn between(hop: &HopFigure) -> Option<String> {
    hop.windows.between.filter(|_| hop.windows.angles.len() == 2).map(words)
}

/// The least and the greatest angle of a hop's bars, degrees.
fn extent_deg(hop: &HopFigure) -> (f64, f64) {
    hop.windows
        .angles
        .iter()
        .fold((90.0f64, -90.0f64), |(low, high), window| (low.min(window.min.degrees()), high.max(window.max.degrees())))
}

impl Naming {
    /// In words if they fit side by side, else by letters, in the order in which the limits occur.
    fn of(hops: &[HopFigure], slot_mm: f64) -> Self {
        let ends = || hops.iter().flat_map(|hop| &hop.windows.ends);
        let lines = |name: &String| wrapped(name, SMALL_MM, slot_mm - 0.8);
        let fits = |name: &String| {
            let lines = lines(name);
            lines.len() <= MOST_LINES && lines.iter().all(|line| text_width_mm(line, SMALL_MM) <= slot_mm - 0.8)
        };
        if ends().all(fits) {
            return Self::Words(ends().map(|name| lines(name).len()).max().unwrap_or(1));
        }
        let mut names: Vec<String> = Vec::new();
        for name in ends() {
            // The vertices of a terrain limit would be a letter each.
            let name = without_vertex(name);
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        Self::Letters(names)
    }

    /// The lines of a name.
    fn lines(&self, name: &str, slot_mm: f64) -> Vec<String> {
        match self {
            Self::Words(_) => wrapped(name, SMALL_MM, slot_mm - 0.8),
            Self::Letters(names) => {
                let at = names.iter().position(|known| known == without_vertex(name)).unwrap_or(0);
                vec![letter(at)]
            }
        }
    }

    /// The height of a row of names.
    #[expect(clippy::cast_precision_loss, reason = "at most three lines")]
    fn row_mm(&self) -> f64 {
        match self {
            Self::Words(lines) => *lines as f64 * LINE_MM + 1.4,
            Self::Letters(_) => LINE_MM + 1.4,
        }
    }
}

/// A terrain limit without its vertex.
fn without_vertex(name: &str) -> &str {
    name.split(" v").next().unwrap_or(name)
}

/// The letter of the n-th limit.
fn letter(at: usize) -> String {
    (b'A'..=b'Z').nth(at).map_or_else(|| (at + 1).to_string(), |letter| char::from(letter).to_string())
}

impl Layout {
    #[expect(clippy::cast_precision_loss, reason = "at most a few hundred hops are drawn")]
    fn new(hops: &Thinned<HopFigure>, top_mm: f64) -> Self {
        let slot_mm = (RIGHT_MM - LEFT_MM - 2.0 * SIDE_MM) / hops.shown.len().max(1) as f64;
        let naming = Naming::of(&hops.shown, slot_mm);
        let number_mm = text_width_mm(&hops.of.to_string(), SMALL_MM) + 1.0;
        let every = one_in(number_mm.max(2.2) / slot_mm);
        let (low, high) = hops.shown.iter().fold((90.0f64, -90.0f64), |(low, high), hop| {
            let (least, greatest) = extent_deg(hop);
            (low.min(least), high.max(greatest))
        });
        let spare = (0.5 * (LEAST_RANGE_DEG - (high - low))).max(0.0);
        let (low, high) = (low - spare, high + spare);
        let beyond = SPARE_MM * (high - low) / (HIGH_MM - 2.0 * SPARE_MM);
        // Take-off angles end at 90 degrees.
        let range_deg = ((low - beyond).max(-90.0), (high + beyond).min(90.0));
        let top = top_mm + naming.row_mm();
        let panel = Panel { left: LEFT_MM, top, right: RIGHT_MM, bottom: top + HIGH_MM };
        Self { panel, slot_mm, naming, every, range_deg }
    }

    /// The height on the sheet of an angle.
    fn y(&self, angle_deg: f64) -> f64 {
        let (low, high) = self.range_deg;
        self.panel.bottom - (angle_deg - low) / (high - low) * HIGH_MM
    }

    /// The middle of a hop's slot.
    #[expect(clippy::cast_precision_loss, reason = "at most a few hundred hops are drawn")]
    fn x(&self, i: usize) -> f64 {
        self.panel.left + SIDE_MM + (i as f64 + 0.5) * self.slot_mm
    }

    fn axes(&self, sheet: &mut Sheet, hops: &Thinned<HopFigure>) {
        let numbers: Vec<_> =
            hops.shown.iter().enumerate().step_by(self.every).map(|(i, hop)| (self.x(i), hop.number.to_string())).collect();
        self.panel.x_axis(sheet, &numbers, "", false);
        let (from, to) = self.range_deg;
        let ticks = Ticks::round(from, to, HIGH_MM / 8.0);
        let angles: Vec<_> = ticks.values.iter().map(|&deg| (self.y(deg), ticks.text(deg))).collect();
        self.panel.y_axis(sheet, &angles, "take-off angle (deg)", true);
    }

    /// One hop: its bars and the chosen angle.
    fn bar(&self, sheet: &mut Sheet, i: usize, hop: &HopFigure) {
        let x = self.x(i);
        let half = (0.3 * self.slot_mm).min(2.2);
        for window in &hop.windows.angles {
            let (bottom, top) = (self.y(window.min.degrees()), self.y(window.max.degrees()));
            let corners = [(x - half, bottom), (x + half, bottom), (x + half, top), (x - half, top)];
            sheet.area(corners.to_vec(), SKY, 0.45);
            sheet.line(corners.into_iter().chain([corners[0]]).collect(), Pen { colour: BLUE, width_mm: 0.2 });
        }
        chosen(sheet, (x, self.y(hop.hop.takeoff_angle.degrees())), half);
        if let (Some(name), [flat, steep]) = (between(hop), &hop.windows.angles[..]) {
            let (from, to) = (self.y(flat.max.degrees()), self.y(steep.min.degrees()));
            if from - to > SMALL_MM + 2.5 && text_width_mm(&name, SMALL_MM) < self.slot_mm {
                sheet.label(Label::new(name, (x, 0.5 * (from + to)), SMALL_MM).hung(Anchor::Middle, Hang::Through));
            }
        }
    }

    /// The limits at the upper ends in a row above the panel, those at the lower ends below it; returns where the list of letters ends.
    fn names(&self, sheet: &mut Sheet, hops: &Thinned<HopFigure>) -> f64 {
        let row_mm = self.naming.row_mm();
        let below_mm = self.panel.bottom + NUMBERS_MM;
        for (of_upper, top_mm) in [(true, self.panel.top - row_mm), (false, below_mm)] {
            let (text, end) = (if of_upper { "upper limit" } else { "lower limit" }, usize::from(of_upper));
            let middle_mm = top_mm + 0.5 * (row_mm - 1.4);
            sheet.label(Label::new(text, (LEFT_MM - 0.5, middle_mm), SMALL_MM).hung(Anchor::End, Hang::Through));
            for (i, hop) in hops.shown.iter().enumerate().step_by(self.every) {
                let lines = self.naming.lines(&hop.windows.ends[end], self.slot_mm);
                #[expect(clippy::cast_precision_loss, reason = "at most three lines")]
                let mut y = middle_mm - 0.5 * LINE_MM * (lines.len() as f64 - 1.0);
                for line in lines {
                    sheet.label(Label::new(line, (self.x(i), y), SMALL_MM).hung(Anchor::Middle, Hang::Through));
                    y += LINE_MM;
                }
            }
        }
        let end_mm = below_mm + row_mm + 0.6;
        let middle = 0.5 * (self.panel.left + self.panel.right);
        sheet.label(Label::new("hop number", (middle, end_mm), TEXT_MM).hung(Anchor::Middle, Hang::Below));
        let end_mm = end_mm + TEXT_MM + 1.4;
        let Naming::Letters(names) = &self.naming else { return end_mm };
        let list: Vec<String> = names.iter().enumerate().map(|(at, name)| format!("{} {name}", letter(at))).collect();
        paragraph(sheet, &format!("Limits: {}.", list.join(", ")), SMALL_MM, false, end_mm)
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
        Limit::TakeoffSpeedLevels => "Lines: the angles of the machine's take-off speeds; it has none between them.".to_owned(),
        _ => format!("Two bars of one hop: the {} refuses the angles between them, whose arcs are slower.", words(limit)),
    }));
    lines
}
