//! The plan view of a route over a DEM, below its unrolled profile.

use plotters::style::RGBColor;

use super::{
    super::{
        keys::{self, Swatch},
        palette::{BLACK, ORANGE, SKY, SMALL_MM, WHITE},
        picture::paragraph,
        sheet::{Place, Sheet},
    },
    data::{GoalMark, MapPosts},
    hops::{about_raster, no_data_symbol},
    names::{Bounds, Taken},
    panel::{MARKER_MM, MapPanel, end_keys},
    raster::{self, Pattern, Window},
};
use crate::{quantity::MapPoint, terrain::Dem};

/// The ground, a single class here.
pub(super) const GROUND: RGBColor = RGBColor(205, 202, 196);
/// The greatest height of a plan view, which shares its page with the profile.
const TALL_MM: f64 = 105.0;
/// Above this number of hops only some of the landings have their number.
const MOST_NUMBERED: usize = 12;

/// A route over a DEM from above.
#[derive(Clone, Debug)]
pub struct PlanView<'a> {
    /// The terrain.
    pub dem: &'a Dem,
    /// Where the journey begins.
    pub start: MapPoint,
    /// Where it should end.
    pub goal: MapPoint,
    /// The start and every landing, in order; empty without a path.
    pub path: Vec<MapPoint>,
    /// Without a path: the place nearest to the goal that was reached.
    pub nearest: Option<MapPoint>,
    /// Without a path: the place nearest to the start from which the goal can be reached.
    pub leads_to_goal: Option<MapPoint>,
}

/// Draws a plan view below a height of a sheet: the path over a hillshade of the ground around it. Returns where it ends.
pub(in super::super) fn draw_plan_view(sheet: &mut Sheet, view: &PlanView<'_>, top_mm: f64) -> f64 {
    let places = view.path.iter().copied().chain([view.start, view.goal]).chain(view.nearest).chain(view.leads_to_goal);
    let window = Window::around(view.dem, places);
    let pixels = raster::draw(view.dem, &window, &[GROUND], |_, _| Some((0, Pattern::Plain)));
    let map = MapPanel::at_most(view.dem, &window, top_mm, TALL_MM);
    let end_mm = map.draw(sheet, pixels);
    let paths = [view.path.clone()];
    map.paths(sheet, &paths);
    let nearest = view.nearest.filter(|at| *at != view.start);
    let leading = view.leads_to_goal.filter(|at| *at != view.goal);
    let marks = [
        (nearest, nearest_symbol as fn(&mut Sheet, Place), "reached place nearest to the goal"),
        (leading, leading_symbol, "place nearest to the start that leads to the goal"),
    ];
    let marks: Vec<_> =
        marks.into_iter().filter_map(|(at, symbol, text)| Some((at.filter(|at| map.shows(*at))?, symbol, text))).collect();
    for (at, symbol, _) in &marks {
        symbol(sheet, map.place(*at));
    }
    let goals = [GoalMark { at: view.goal, hops: view.path.len().checked_sub(1).map(|hops| hops as u64) }];
    let mut taken = map.ends(sheet, &[view.start], &goals, &paths);
    taken.kept.extend(marks.iter().map(|(at, ..)| Bounds::around(map.place(*at), MARKER_MM)));
    numbers(sheet, &map, view, &mut taken);
    let mut entries = end_keys(&[view.start], &goals, &paths);
    entries.extend(marks.into_iter().map(|(_, symbol, text)| (Swatch::Symbol(symbol), text.to_owned())));
    if window.has_gaps(view.dem) {
        entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
    }
    let end_mm = keys::draw(sheet, &entries, end_mm + 3.0) + 0.8;
    paragraph(sheet, &about_raster(&MapPosts { dem: view.dem, stride: 1, per_post: 1 }, &window), SMALL_MM, false, end_mm)
}

/// The number of every hop, or of every n-th, beside its landing; the goal has its own name.
fn numbers(sheet: &mut Sheet, map: &MapPanel, view: &PlanView<'_>, taken: &mut Taken) {
    let landings = view.path.get(1..view.path.len().saturating_sub(1)).unwrap_or_default();
    let every = landings.len().div_ceil(MOST_NUMBERED).max(1);
    for (number, at) in (1usize..).zip(landings).filter(|(number, _)| number.is_multiple_of(every)) {
        map.name(sheet, *at, &number.to_string(), taken);
    }
}

/// A triangle that points up: the reached place nearest to the goal.
pub(in super::super) fn nearest_symbol(sheet: &mut Sheet, at: Place) {
    triangle(sheet, at, 1.0, ORANGE);
}

/// A triangle that points down: the place nearest to the start that leads to the goal.
fn leading_symbol(sheet: &mut Sheet, at: Place) {
    triangle(sheet, at, -1.0, SKY);
}

/// `up`: 1 if it points up, -1 if it points down.
fn triangle(sheet: &mut Sheet, (x, y): Place, up: f64, inside: RGBColor) {
    for (r, colour) in [(2.3, WHITE), (1.8, BLACK), (1.1, inside)] {
        let foot = y + 0.5 * r * up;
        sheet.area(vec![(x, y - r * up), (x + 0.87 * r, foot), (x - 0.87 * r, foot)], colour, 1.0);
    }
}
