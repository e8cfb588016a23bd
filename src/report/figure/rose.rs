//! The rose: how far, and in how few hops, one gets in each direction of a fan.

use plotters::style::RGBColor;

use super::{
    FigureError,
    palette::{AXIS, BLACK, PAGE_WIDTH_MM, RIGHT_MM, SMALL_MM, TEXT_MM, TITLE_MM, VERMILION},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm, wrapped},
    ticks::Ticks,
};
use crate::report::FanAnswer;

/// Few hops light, many dark (viridis, which colour-blind readers and grey printers tell apart).
const BANDS: [RGBColor; 6] = [
    RGBColor(253, 231, 37),
    RGBColor(122, 209, 81),
    RGBColor(34, 168, 132),
    RGBColor(42, 120, 142),
    RGBColor(65, 68, 135),
    RGBColor(68, 1, 84),
];

/// Ground that is not reached.
const BLOCKED: RGBColor = RGBColor(200, 200, 200);

/// Radius of the rose.
const RADIUS_MM: f64 = 62.0;

/// The widest piece of an arc that is drawn straight, degrees: under 0.01 mm off.
const ARC_STEP_DEG: f64 = 2.0;

/// Draws the rose of a fan as SVG, 170 mm wide, north up; `title` and `subtitle` stand above it.
///
/// # Errors
/// [`FigureError::Drawing`].
pub fn draw_rose(answer: &FanAnswer, title: &str, subtitle: &str) -> Result<String, FigureError> {
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
    sheet.to_svg(PAGE_WIDTH_MM, end_mm + 3.0)
}

/// The fan on the page.
struct Rose<'a> {
    answer: &'a FanAnswer,
    centre: Place,
    mm_per_m: f64,
    /// The most hops of each class, rising.
    classes: Vec<u64>,
}

impl<'a> Rose<'a> {
    fn new(answer: &'a FanAnswer, centre: Place) -> Self {
        let longest_m = answer.rays.iter().map(|ray| ray.length_m).fold(0.0, f64::max);
        let most = answer.rays.iter().flat_map(|ray| &ray.bands).filter_map(|band| band.hops).max().unwrap_or(0);
        let longest_m = if longest_m > 0.0 { longest_m } else { answer.length_m };
        Self { answer, centre, mm_per_m: RADIUS_MM / longest_m, classes: classes(most) }
    }

    /// A place on the page from a distance and a heading.
    fn place(&self, distance_m: f64, heading_deg: f64) -> Place {
        let (angle, radius_mm) = (heading_deg.to_radians(), distance_m * self.mm_per_m);
        (self.centre.0 + radius_mm * libm::sin(angle), self.centre.1 - radius_mm * libm::cos(angle))
    }

    /// Places along an arc about the start.
    fn arc(&self, distance_m: f64, from_deg: f64, to_deg: f64) -> Vec<Place> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 180 steps")]
        let steps = ((to_deg - from_deg).abs() / ARC_STEP_DEG).ceil().max(1.0) as u32;
        let at = |i: u32| from_deg + (to_deg - from_deg) * f64::from(i) / f64::from(steps);
        (0..=steps).map(|i| self.place(distance_m, at(i))).collect()
    }

    /// The class of a number of hops.
    fn class(&self, hops: u64) -> usize {
        self.classes.iter().position(|&most| hops <= most).unwrap_or(self.classes.len().saturating_sub(1))
    }

    /// The colour of a class: the classes there are, spread over all colours.
    fn colour(&self, class: usize) -> RGBColor {
        let steps = self.classes.len().max(2) - 1;
        BANDS[(class * (BANDS.len() - 1) / steps).min(BANDS.len() - 1)]
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
                let colour = class.map_or(BLOCKED, |class| self.colour(class));
                sheet.area(outline, colour, 1.0);
            }
            if ray.cut.is_some() {
                let outside_m = ray.length_m + 0.6 / self.mm_per_m;
                sheet.line(self.arc(outside_m, from_deg, to_deg), Pen { colour: VERMILION, width_mm: 0.5 });
            }
            sheet.line(self.arc(ray.farthest_m, from_deg, to_deg), Pen { colour: BLACK, width_mm: 0.35 });
        }
    }

    /// Neighbouring bands of one class made one: (from, to, class).
    fn drawn_bands(&self, bands: &[crate::report::BandRecord]) -> Vec<(f64, f64, Option<usize>)> {
        let mut found: Vec<(f64, f64, Option<usize>)> = Vec::new();
        for band in bands {
            let class = band.hops.map(|hops| self.class(hops));
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
            sheet.area(vec![(left, top), (right, top), (right, bottom), (left, bottom)], RGBColor(255, 255, 255), 0.8);
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
        sheet.dot(self.centre, 0.8, BLACK);
    }

    /// What the colours and lines mean; returns where it ends.
    fn legend(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let mut least = 1;
        let mut entries: Vec<(Option<RGBColor>, Option<Pen>, String)> = Vec::new();
        for (class, &most) in self.classes.iter().enumerate() {
            let text = if least >= most { most.to_string() } else { format!("{least} to {most}") };
            entries.push((Some(self.colour(class)), None, format!("{text} hop{}", if most == 1 { "" } else { "s" })));
            least = most + 1;
        }
        entries.push((Some(BLOCKED), None, "not reached".to_owned()));
        entries.push((None, Some(Pen { colour: BLACK, width_mm: 0.35 }), "farthest reached".to_owned()));
        if self.answer.rays.iter().any(|ray| ray.cut.is_some()) {
            entries.push((None, Some(Pen { colour: VERMILION, width_mm: 0.5 }), "cut by the map's border or no-data".to_owned()));
        }
        let mut at = (6.0, top_mm);
        for (colour, pen, text) in entries {
            let width_mm = 7.0 + text_width_mm(&text, SMALL_MM) + 3.0;
            if at.0 + width_mm > RIGHT_MM {
                at = (6.0, at.1 + 4.6);
            }
            if let Some(colour) = colour {
                let (left, right, top, bottom) = (at.0, at.0 + 6.0, at.1 - 1.5, at.1 + 1.5);
                sheet.area(vec![(left, top), (right, top), (right, bottom), (left, bottom)], colour, 1.0);
            }
            if let Some(pen) = pen {
                sheet.line(vec![(at.0, at.1), (at.0 + 6.0, at.1)], pen);
            }
            sheet.label(Label::new(text, (at.0 + 7.0, at.1), SMALL_MM));
            at.0 += width_mm;
        }
        at.1 + 2.3
    }
}

/// The most hops of each class: one class for each count up to six, else classes whose ends rise by a common factor.
fn classes(most: u64) -> Vec<u64> {
    let count = BANDS.len() as u64;
    if most <= count {
        return (1..=most).collect();
    }
    #[expect(clippy::cast_precision_loss, reason = "a count of hops for a legend")]
    let whole = most as f64;
    let mut ends: Vec<u64> = Vec::new();
    for i in 1..=count {
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and most"
        )]
        let end = libm::pow(whole, i as f64 / count as f64).round() as u64;
        let after_last = ends.last().map_or(1, |last| last + 1);
        ends.push(end.max(after_last));
    }
    if let Some(last) = ends.last_mut() {
        *last = most;
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_rise_and_end_with_the_most() {
        assert!(classes(0).is_empty());
        assert_eq!(classes(4), [1, 2, 3, 4]);
        for most in 7..2000 {
            let ends = classes(most);
            assert!(ends.windows(2).all(|pair| pair[0] < pair[1]), "{ends:?}");
            assert_eq!((ends.len(), ends.last()), (6, Some(&most)));
        }
    }
}
