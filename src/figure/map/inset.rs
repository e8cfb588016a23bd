//! Insets below a map of landings: the landings of single hops at a larger scale.

use super::{
    super::{
        keys::rectangle,
        palette::{BLACK, LEFT_MM, SMALL_MM},
        sheet::{Label, Pen, Place, Sheet},
        ticks::short,
    },
    data::{LandingCloud, LandingMapFigure},
    landings::{ELLIPSE_PEN, GROUND, landing_dot, planned_symbol, plus, rim},
    panel::{goal_symbol, scale_bar},
};
use crate::quantity::MapPoint;

/// Width and height of an inset.
const SIZE_MM: (f64, f64) = (71.0, 40.0);
/// From the left end of one inset to that of the next.
const STEP_MM: f64 = 78.0;
/// Room for the title, and between the outline and what is drawn.
const TITLE_MM: f64 = 5.0;
const INSIDE_MM: f64 = 5.0;
/// A cloud is small on the map, and gets an inset, if half its ellipse's shorter axis is drawn shorter than this.
const SMALL_ON_MAP_MM: f64 = 4.0;
/// The greatest number of landings drawn in an inset.
const MOST_DOTS: usize = 600;
const OUTLINE_PEN: Pen = Pen { colour: BLACK, width_mm: 0.2 };

/// Draws the insets below a height, where a map of this scale needs them; returns where they end.
pub(super) fn draw(sheet: &mut Sheet, figure: &LandingMapFigure<'_>, map_mm_per_m: f64, top_mm: f64) -> f64 {
    let chosen = chosen(figure, map_mm_per_m);
    if chosen.is_empty() {
        return top_mm;
    }
    for ((cloud, what), left_mm) in chosen.into_iter().zip([LEFT_MM, LEFT_MM + STEP_MM]) {
        let frame = Frame::around(cloud, (left_mm, top_mm + TITLE_MM));
        let title = format!("hop {}, {what}: enlarged {} times", cloud.hop, short((frame.mm_per_m / map_mm_per_m).round()));
        sheet.label(Label { bold: true, ..Label::new(title, (left_mm, top_mm + 0.5 * TITLE_MM), SMALL_MM) });
        let is_last = figure.clouds.last().is_some_and(|last| last.hop == cloud.hop);
        frame.draw(sheet, cloud, is_last);
    }
    top_mm + TITLE_MM + SIZE_MM.1 + 1.0
}

/// The clouds with an inset, in words: the one with the longest ellipse, and the last.
fn chosen<'a>(figure: &'a LandingMapFigure<'_>, map_mm_per_m: f64) -> Vec<(&'a LandingCloud, &'static str)> {
    let is_small = |cloud: &&LandingCloud| {
        cloud.ellipse.is_some_and(|ellipse| {
            ellipse.semi_major_m > 0.0 && ellipse.semi_major_m.is_finite() && ellipse.semi_minor_m * map_mm_per_m < SMALL_ON_MAP_MM
        })
    };
    let longest = |cloud: &&LandingCloud| cloud.ellipse.map_or(0.0, |ellipse| ellipse.semi_major_m);
    let small = || figure.clouds.iter().filter(is_small);
    let widest = small().max_by(|a, b| longest(a).total_cmp(&longest(b)));
    let last = small().next_back();
    match (widest, last) {
        (Some(widest), Some(last)) if widest.hop == last.hop => vec![(last, "the last and the widest scatter")],
        _ => widest.map(|cloud| (cloud, "the widest scatter")).into_iter().chain(last.map(|cloud| (cloud, "the last"))).collect(),
    }
}

/// An inset on the sheet, both axes at the same scale.
struct Frame {
    corner_mm: Place,
    centre: MapPoint,
    mm_per_m: f64,
}

impl Frame {
    /// The inset that holds a cloud.
    fn around(cloud: &LandingCloud, corner_mm: Place) -> Self {
        let rim = cloud.ellipse.iter().flat_map(rim);
        let places =
            rim.chain(cloud.landings.iter().copied()).chain([cloud.planned]).filter(|at| at.x.is_finite() && at.y.is_finite());
        let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        for at in places {
            (low, high) = ((low.0.min(at.x), low.1.min(at.y)), (high.0.max(at.x), high.1.max(at.y)));
        }
        let along = |size_mm: f64, length_m: f64| (size_mm - 2.0 * INSIDE_MM) / length_m.max(f64::MIN_POSITIVE);
        let mm_per_m = along(SIZE_MM.0, high.0 - low.0).min(along(SIZE_MM.1, high.1 - low.1));
        Self { corner_mm, centre: MapPoint::new(0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1)), mm_per_m }
    }

    fn place(&self, at: MapPoint) -> Place {
        let middle = (self.corner_mm.0 + 0.5 * SIZE_MM.0, self.corner_mm.1 + 0.5 * SIZE_MM.1);
        (middle.0 + (at.x - self.centre.x) * self.mm_per_m, middle.1 - (at.y - self.centre.y) * self.mm_per_m)
    }

    fn draw(&self, sheet: &mut Sheet, cloud: &LandingCloud, is_last: bool) {
        let (left, top) = self.corner_mm;
        let corners = rectangle((left, top), (left + SIZE_MM.0, top + SIZE_MM.1));
        sheet.area(corners.clone(), GROUND, 0.5);
        sheet.line(corners.into_iter().chain([(left, top)]).collect(), OUTLINE_PEN);
        // The goal's symbol is larger than many a scatter, whose landings lie over it.
        if is_last {
            goal_symbol(sheet, self.place(cloud.planned));
        }
        let every = cloud.landings.len().div_ceil(MOST_DOTS).max(1);
        for &at in cloud.landings.iter().step_by(every) {
            landing_dot(sheet, self.place(at));
        }
        if let Some(ellipse) = cloud.ellipse {
            let rim = rim(&ellipse);
            sheet.line(rim.iter().chain(rim.first()).map(|&at| self.place(at)).collect(), ELLIPSE_PEN);
            plus(sheet, self.place(ellipse.centre));
        }
        if !is_last {
            planned_symbol(sheet, self.place(cloud.planned));
        }
        scale_bar(sheet, (left + 2.0, top + SIZE_MM.1 - 2.2), self.mm_per_m, 18.0);
    }
}
