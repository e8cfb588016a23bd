//! The rose: how far, and in how few hops, one gets in each direction of a fan.

use plotters::style::RGBColor;

use super::{
    Picture,
    bands::HopClasses,
    keys::{self, Swatch},
    palette::{AXIS, BLACK, BLUE, PAGE_WIDTH_MM, RIGHT_MM, SMALL_MM, TEXT_MM, TITLE_MM, VERMILION, WHITE},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm, wrapped},
    ticks::Ticks,
};
use crate::report::FanAnswer;

/// Colour of ground that is not reached.
const BLOCKED: RGBColor = RGBColor(200, 200, 200);

/// The line towards true north.
const TRUE_NORTH_PEN: Pen = Pen { colour: BLUE, width_mm: 0.5 };

/// Radius of the rose.
const RADIUS_MM: f64 = 62.0;

/// The largest angle of an arc drawn as one straight piece, degrees: the error is below 0.01 mm.
const ARC_STEP_DEG: f64 = 2.0;

/// Draws the rose of a fan, 170 mm wide, north up, below `title` and `subtitle`.
pub fn draw_rose(answer: &FanAnswer, title: &str, subtitle: &str) -> Picture {
    let mut sheet = Sheet::default();
    let mut top_mm = 4.0;
    let mut line = |text: String, size_mm: f64, bold: bool| {
        sheet.label(Label { bold, ..Label::new(text, (6.0, top_mm), size_mm).hung(Anchor::Start, Hang::Below) });
        top_mm += size_mm + 1.4;
    };
    for text in wrapped(title, TITLE_MM, RIGHT_MM - 6.0) {
        line(text, TITLE_MM, true);
    }
    for text in wrapped(subtitle, TEXT_MM, RIGHT_MM - 6.0) {
        line(text, TEXT_MM, false);
    }
    let rose = Rose::new(answer, (0.5 * PAGE_WIDTH_MM, top_mm + 9.0 + RADIUS_MM));
    rose.wedges(&mut sheet);
    rose.rings(&mut sheet);
    let end_mm = rose.legend(&mut sheet, rose.centre.1 + RADIUS_MM + 9.0);
    Picture::page(sheet, end_mm + 3.0)
}

/// The fan on the page.
struct Rose<'a> {
    answer: &'a FanAnswer,
    centre: Place,
    mm_per_m: f64,
    classes: HopClasses,
}

impl<'a> Rose<'a> {
    fn new(answer: &'a FanAnswer, centre: Place) -> Self {
        let longest_m = answer.rays.iter().map(|ray| ray.length_m).fold(0.0, f64::max);
        let most = answer.rays.iter().flat_map(|ray| &ray.bands).filter_map(|band| band.hops).max().unwrap_or(0);
        let longest_m = if longest_m > 0.0 { longest_m } else { answer.length_m };
        Self { answer, centre, mm_per_m: RADIUS_MM / longest_m, classes: HopClasses::up_to(most) }
    }

    /// A position on the page from a distance and a heading.
    fn place(&self, distance_m: f64, heading_deg: f64) -> Place {
        let (angle, radius_mm) = (heading_deg.to_radians(), distance_m * self.mm_per_m);
        (self.centre.0 + radius_mm * libm::sin(angle), self.centre.1 - radius_mm * libm::cos(angle))
    }

    /// Points along an arc about the start.
    fn arc(&self, distance_m: f64, from_deg: f64, to_deg: f64) -> Vec<Place> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 180 steps")]
        let steps = ((to_deg - from_deg).abs() / ARC_STEP_DEG).ceil().max(1.0) as u32;
        let at = |i: u32| from_deg + (to_deg - from_deg) * f64::from(i) / f64::from(steps);
        (0..=steps).map(|i| self.place(distance_m, at(i))).collect()
    }

    /// Every direction as a wedge of bands.
    fn wedges(&self, sheet: &mut Sheet) {
        #[expect(clippy::cast_precision_loss, reason = "at most 36000 headings")]
        let half_deg = 180.0 / self.answer.rays.len().max(1) as f64;
        for ray in &self.answer.rays {
            let (from_deg, to_deg) = (ray.heading_deg - half_deg, ray.heading_deg + half_deg);
            for (from_m, to_m, class) in self.drawn_bands(&ray.bands) {
                let mut outline = self.arc(to_m, from_deg, to_deg);
                outline.extend(self.arc(from_m, to_deg, from_deg));
                let colour = class.map_or(BLOCKED, |class| self.classes.colour(class));
                sheet.area(outline, colour, 1.0);
            }
            if ray.cut.is_some() {
                let outside_m = ray.length_m + 0.6 / self.mm_per_m;
                sheet.line(self.arc(outside_m, from_deg, to_deg), Pen { colour: VERMILION, width_mm: 0.5 });
            }
            sheet.line(self.arc(ray.farthest_m, from_deg, to_deg), Pen { colour: BLACK, width_mm: 0.35 });
        }
    }

    /// Neighbouring bands of one class merged: (from, to, class).
    fn drawn_bands(&self, bands: &[crate::report::BandRecord]) -> Vec<(f64, f64, Option<usize>)> {
        let mut found: Vec<(f64, f64, Option<usize>)> = Vec::new();
        for band in bands {
            let class = band.hops.map(|hops| self.classes.of(hops));
            match found.last_mut() {
                Some(last) if last.2 == class => last.1 = band.to_m,
                _ => found.push((band.from_m, band.to_m, class)),
            }
        }
        found
    }

    /// Rings at round distances with their numbers, the four directions, and the start.
    fn rings(&self, sheet: &mut Sheet) {
        let longest_m = RADIUS_MM / self.mm_per_m;
        let ticks = Ticks::round(0.0, longest_m, 6.0);
        let pen = Pen { colour: AXIS, width_mm: 0.12 };
        for &distance_m in ticks.values.iter().filter(|&&distance_m| distance_m > 0.0) {
            sheet.dashed(&self.arc(distance_m, 0.0, 360.0), 0.8, 0.8, pen);
            let at = self.place(distance_m, 45.0);
            let text = format!("{} m", ticks.text(distance_m));
            let (half_mm, tall_mm) = (0.5 * text_width_mm(&text, SMALL_MM) + 0.4, 0.6 * SMALL_MM);
            let (left, right, top, bottom) = (at.0 - half_mm, at.0 + half_mm, at.1 - tall_mm, at.1 + tall_mm);
            sheet.area(vec![(left, top), (right, top), (right, bottom), (left, bottom)], WHITE, 0.8);
            sheet.label(Label::new(text, at, SMALL_MM).hung(Anchor::Middle, Hang::Through));
        }
        for (name, heading_deg) in [("E", 90.0), ("S", 180.0), ("W", 270.0)] {
            let at = self.place(longest_m + 4.0 / self.mm_per_m, heading_deg);
            sheet.label(Label::new(name, at, TEXT_MM).hung(Anchor::Middle, Hang::Through));
        }
        let (x, y) = self.place(longest_m, 0.0);
        sheet.area(vec![(x, y - 5.0), (x + 1.3, y - 1.2), (x, y - 2.1), (x - 1.3, y - 1.2)], BLACK, 1.0);
        let north = Label::new("N (grid)", (x, y - 5.8), TEXT_MM).hung(Anchor::Middle, Hang::Above);
        sheet.label(Label { bold: true, ..north });
        if let Some(north_deg) = self.answer.true_north_deg {
            let outside_m = longest_m + 3.0 / self.mm_per_m;
            sheet.line(vec![self.centre, self.place(outside_m, north_deg)], TRUE_NORTH_PEN);
        }
        sheet.dot(self.centre, 0.8, BLACK);
    }

    /// The legend; returns where it ends.
    fn legend(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let bands = self.classes.texts().into_iter().enumerate();
        let mut entries: Vec<_> = bands.map(|(class, text)| (Swatch::Fill(self.classes.colour(class)), text)).collect();
        if self.answer.rays.iter().flat_map(|ray| &ray.bands).any(|band| band.hops.is_none()) {
            entries.push((Swatch::Fill(BLOCKED), "not reached".to_owned()));
        }
        if self.answer.rays.iter().any(|ray| ray.farthest_m > 0.0) {
            entries.push((Swatch::Line(Pen { colour: BLACK, width_mm: 0.35 }), "farthest reached".to_owned()));
        }
        if let Some(north_deg) = self.answer.true_north_deg {
            entries.push((Swatch::Line(TRUE_NORTH_PEN), format!("true north, {north_deg:.1} deg clockwise from grid north")));
        }
        if self.answer.rays.iter().any(|ray| ray.cut.is_some()) {
            entries.push((Swatch::Line(Pen { colour: VERMILION, width_mm: 0.5 }), "cut by the map's border or no-data".to_owned()));
        }
        keys::draw(sheet, &entries, top_mm)
    }
}
