//! The map on the sheet: raster, coordinates, scale bar, north arrow, markers and paths.

use plotters::style::RGBColor;

use super::{
    super::{
        axes::{BELOW_MM, Panel, left_room_mm},
        bitmap::Pixels,
        keys::{Swatch, rectangle},
        palette::{BLACK, LEFT_MM, RIGHT_MM, SMALL_MM, TEXT_MM, WHITE},
        picture::MARGIN_MM,
        sheet::{Anchor, Hang, Label, Mark, Pen, Place, Sheet, SheetImage, between, text_width_mm},
        ticks::Ticks,
    },
    data::GoalMark,
    names::{Bounds, Candidate, Taken, candidates, choose, width_mm},
    raster::Window,
};
use crate::{
    quantity::MapPoint,
    terrain::{Dem, MapBounds},
};

/// The greatest height of a map on the page.
const TALL_MM: f64 = 165.0;
/// Room above the map for scale bar and north arrow.
const STRIP_MM: f64 = 8.0;
/// A scale bar may always be this long, even on a narrow map.
const SHORT_MM: f64 = 15.0;
/// Smallest spacing of the numbers of the y axis.
const TICK_MM: f64 = 9.0;
/// Above this number of starts or goals the markers have no labels.
const MOST_NAMED: usize = 12;
/// Half the size of the markers of start and goals.
pub(super) const MARKER_MM: f64 = 2.0;
/// Paths: black in a white casing, visible on every band.
const CORE_PEN: Pen = Pen { colour: BLACK, width_mm: 0.35 };
const CASING_PEN: Pen = Pen { colour: WHITE, width_mm: 0.9 };
/// Line from a distant label to its marker.
const LEADER_PEN: Pen = Pen { colour: BLACK, width_mm: 0.2 };

/// The position of the map on the sheet; both axes have the same scale.
pub(super) struct MapPanel {
    panel: Panel,
    bounds: MapBounds,
    mm_per_m: f64,
    /// Where true north lies from the middle of the map, clockwise from grid north, degrees; `None` if it is not known, or differs
    /// from grid north by less than an arrow shows.
    true_north_deg: Option<f64>,
}

/// An arrow turned by less than this looks straight, degrees.
const LEAST_TURN_DEG: f64 = 0.5;

impl MapPanel {
    /// Lays out a window of a DEM below a height of the sheet, with the same scale on both axes.
    pub(super) fn new(dem: &Dem, window: &Window, top_mm: f64) -> Self {
        Self::at_most(dem, window, top_mm, TALL_MM)
    }

    /// The same with another greatest height.
    pub(super) fn at_most(dem: &Dem, window: &Window, top_mm: f64, tall_mm: f64) -> Self {
        let map = dem.georeference();
        let first = map.post(window.rows.start, window.cols.start);
        let last = map.post(window.rows.end.saturating_sub(1), window.cols.end.saturating_sub(1));
        // A post's pixel extends half a spacing beyond the post.
        let (x, y) = (0.5 * map.dx_m(), 0.5 * map.dy_m());
        let bounds = MapBounds { min: MapPoint::new(first.x - x, last.y - y), max: MapPoint::new(last.x + x, first.y + y) };
        let middle = MapPoint::new(0.5 * (bounds.min.x + bounds.max.x), 0.5 * (bounds.min.y + bounds.max.y));
        let true_north_deg = map
            .projection()
            .ok()
            .and_then(|projection| projection.north_on_map_deg(middle))
            .filter(|north_deg| (LEAST_TURN_DEG..360.0 - LEAST_TURN_DEG).contains(north_deg));
        Self { true_north_deg, ..Self::over(bounds, top_mm, tall_mm) }
    }

    /// Lays out a rectangle of a map whose true north is not known.
    pub(super) fn over(bounds: MapBounds, top_mm: f64, tall_mm: f64) -> Self {
        let (wide_m, high_m) = (bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y);
        let left = LEFT_MM.max(1.0 + left_room_mm(&Ticks::round(bounds.min.y, bounds.max.y, tall_mm / TICK_MM)));
        let mm_per_m = ((RIGHT_MM - left) / wide_m).min(tall_mm / high_m);
        let left = left + 0.5 * (RIGHT_MM - left - wide_m * mm_per_m);
        let top = top_mm + STRIP_MM;
        let panel = Panel { left, top, right: left + wide_m * mm_per_m, bottom: top + high_m * mm_per_m };
        Self { panel, bounds, mm_per_m, true_north_deg: None }
    }

    /// The scale, and the upper left corner on the sheet.
    pub(super) const fn layout(&self) -> (f64, Place) {
        (self.mm_per_m, (self.panel.left, self.panel.top))
    }

    /// Where a point of the map is drawn.
    pub(super) fn place(&self, at: MapPoint) -> Place {
        (self.panel.left + (at.x - self.bounds.min.x) * self.mm_per_m, self.panel.top + (self.bounds.max.y - at.y) * self.mm_per_m)
    }

    /// Whether a point lies on the drawn map.
    pub(super) fn shows(&self, at: MapPoint) -> bool {
        self.bounds.contains(at)
    }

    /// Raster, axes, scale bar and north arrow; returns where the panel ends.
    pub(super) fn draw(&self, sheet: &mut Sheet, pixels: Pixels) -> f64 {
        let panel = &self.panel;
        let (left_mm, top_mm, width_mm, height_mm) = (panel.left, panel.top, panel.width(), panel.height());
        sheet.images.push(SheetImage { left_mm, top_mm, width_mm, height_mm, pixels });
        let (min, max) = (self.bounds.min, self.bounds.max);
        let guess = Ticks::round(min.x, max.x, panel.width() / 16.0);
        let widest_mm = text_width_mm(&guess.longest(), SMALL_MM) + 4.0;
        // A narrow map still gets two numbers if they fit.
        let least = if panel.width() > 2.5 * widest_mm { 2.5 } else { 1.0 };
        let along = Ticks::round(min.x, max.x, (panel.width() / widest_mm.max(16.0)).max(least));
        let ticks: Vec<_> = along.values.iter().map(|&x| (self.place(MapPoint::new(x, min.y)).0, along.text(x))).collect();
        panel.x_axis(sheet, &ticks, "map x, east (m)", false);
        let up = Ticks::round(min.y, max.y, panel.height() / TICK_MM);
        let ticks: Vec<_> = up.values.iter().map(|&y| (self.place(MapPoint::new(min.x, y)).1, up.text(y))).collect();
        panel.y_axis(sheet, &ticks, "map y, north (m)", false);
        panel.outline(sheet);
        let bar_end_mm = self.scale_bar(sheet);
        self.north(sheet, bar_end_mm);
        panel.bottom + BELOW_MM
    }

    /// A scale bar of a round length above the map's left end; returns where its label ends, mm.
    fn scale_bar(&self, sheet: &mut Sheet) -> f64 {
        let most_mm = (0.3 * self.panel.width()).max(SHORT_MM);
        scale_bar(sheet, (self.panel.left, self.panel.top - 2.6), self.mm_per_m, most_mm)
    }

    /// An arrow to grid north above the map's right end, left of it one to true north if that differs; on a narrow map right of the
    /// scale bar.
    fn north(&self, sheet: &mut Sheet, bar_end_mm: f64) {
        const NAME: &str = "N (grid)";
        const TRUE_NAME: &str = "N (true, at the middle)";
        const ARROW_MM: f64 = 6.0;
        let true_mm = self.true_north_deg.map_or(0.0, |_| text_width_mm(TRUE_NAME, TEXT_MM) + ARROW_MM + 3.0);
        let after_bar = bar_end_mm + 4.0 + true_mm + text_width_mm(NAME, TEXT_MM) + 2.4;
        let (x, y) = ((self.panel.right - 1.8).max(after_bar), self.panel.top - 1.4);
        sheet.area(vec![(x, y - 5.0), (x + 1.3, y), (x, y - 1.0), (x - 1.3, y)], BLACK, 1.0);
        let name = Label::new(NAME, (x - 2.4, y - 2.4), TEXT_MM).hung(Anchor::End, Hang::Through);
        let (left_mm, ..) = name.bounds_mm();
        sheet.label(Label { bold: true, ..name });
        let Some(north_deg) = self.true_north_deg else { return };
        let centre = (left_mm - 3.0 - 0.5 * ARROW_MM, self.panel.top - 3.9);
        let (sin, cos) = libm::sincos(north_deg.to_radians());
        let turned = [(0.0, -2.5), (1.3, 2.5), (0.0, 1.5), (-1.3, 2.5), (0.0, -2.5)]
            .map(|(x, y): Place| (centre.0 + x * cos - y * sin, centre.1 + x * sin + y * cos));
        sheet.line(turned.to_vec(), CORE_PEN);
        let at = (centre.0 - 0.5 * ARROW_MM - 0.6, self.panel.top - 2.4 - 1.4);
        sheet.label(Label::new(TRUE_NAME, at, TEXT_MM).hung(Anchor::End, Hang::Through));
    }

    /// Paths with their landings.
    pub(super) fn paths(&self, sheet: &mut Sheet, paths: &[Vec<MapPoint>]) {
        let drawn: Vec<Vec<Place>> =
            paths.iter().filter(|path| !path.is_empty()).map(|path| path.iter().map(|&at| self.place(at)).collect()).collect();
        for points in &drawn {
            sheet.line(points.clone(), CASING_PEN);
        }
        for points in drawn {
            for &at in &points {
                sheet.dot(at, 0.55, BLACK);
            }
            sheet.line(points, CORE_PEN);
        }
    }

    /// Starts and goals over the paths, and their labels over everything but markers; returns what further labels have to spare.
    pub(super) fn ends(&self, sheet: &mut Sheet, starts: &[MapPoint], goals: &[GoalMark], paths: &[Vec<MapPoint>]) -> Taken {
        let seen_starts: Vec<_> = (1..).zip(starts.iter().copied()).filter(|&(_, at)| self.shows(at)).collect();
        let seen: Vec<_> = goals.iter().enumerate().filter(|(_, goal)| self.shows(goal.at)).collect();
        let mut taken = Taken::default();
        taken.spared.extend(paths.iter().flatten().map(|&at| self.place(at)));
        for &(_, at) in &seen_starts {
            start_symbol(sheet, self.place(at));
            taken.kept.push(Bounds::around(self.place(at), MARKER_MM));
        }
        for (_, goal) in &seen {
            let symbol = if goal.hops.is_some() { goal_symbol } else { missed_symbol };
            symbol(sheet, self.place(goal.at));
            taken.kept.push(Bounds::around(self.place(goal.at), MARKER_MM));
        }
        for (number, at) in seen_starts.into_iter().take(MOST_NAMED) {
            let text = if starts.len() > 1 { format!("start {number}") } else { "start".to_owned() };
            self.name(sheet, at, &text, &mut taken);
        }
        for (i, goal) in seen.into_iter().take(MOST_NAMED) {
            let number = if goals.len() > 1 { format!(" {}", i + 1) } else { String::new() };
            let text = match goal.hops {
                Some(1) => format!("goal{number}: 1 hop"),
                Some(hops) => format!("goal{number}: {hops} hops"),
                None => format!("goal{number}: not reached"),
            };
            self.name(sheet, goal.at, &text, &mut taken);
        }
        taken
    }

    /// A label for the marker at a position, if there is room.
    pub(super) fn name(&self, sheet: &mut Sheet, at: MapPoint, text: &str, taken: &mut Taken) {
        let at = self.place(at);
        let places = candidates(text, at, MARKER_MM, &self.room(&[text]));
        self.name_on_one(sheet, &places, Some(at), taken);
    }

    /// The area for labels: the map, or the full width of the page if one of them is wider than the map.
    fn room(&self, texts: &[&str]) -> Bounds {
        let Panel { left, top, right, bottom } = self.panel;
        let is_narrow = texts.iter().any(|text| 2.0 * width_mm(text) > self.panel.width());
        let (left, right) = if is_narrow { (MARGIN_MM, RIGHT_MM) } else { (left, right) };
        Bounds { left, top, right, bottom }
    }

    /// Draws a bold label on a light background at the best candidate; nothing if no candidate fits.
    ///
    /// A label away from its marker has a line to it.
    pub(super) fn name_on_one(&self, sheet: &mut Sheet, places: &[Candidate], marker: Option<Place>, taken: &mut Taken) {
        let texts: Vec<&str> = places.iter().map(|place| place.label.text.as_str()).collect();
        let mut all = taken.clone();
        // Axis numbers and other texts.
        all.kept.extend(
            sheet.marks.iter().filter_map(|mark| if let Mark::Label(label) = mark { Some(Bounds::of(label)) } else { None }),
        );
        let Some(Candidate { label, ring }) = choose(places, &self.room(&texts), &all) else { return };
        let bounds = Bounds::of(label);
        if let Some(at) = marker.filter(|_| *ring > 0) {
            let end = bounds.nearest(at);
            let away_mm = libm::hypot(end.0 - at.0, end.1 - at.1);
            if away_mm > MARKER_MM {
                sheet.line(vec![between(at, end, MARKER_MM / away_mm), end], LEADER_PEN);
            }
        }
        sheet.area(rectangle((bounds.left, bounds.top), (bounds.right, bounds.bottom)), WHITE, 0.75);
        sheet.label(Label { bold: true, ..label.clone() });
        taken.kept.push(bounds);
    }
}

/// A scale bar of a round length from a position on; returns where its label ends, mm.
pub(in super::super) fn scale_bar(sheet: &mut Sheet, (left, y): Place, mm_per_m: f64, most_mm: f64) -> f64 {
    // Round numbers are at most a factor of 2.5 apart, so one of them fits.
    let lengths = Ticks::round(0.0, most_mm / mm_per_m, 2.5);
    let Some(&length_m) = lengths.values.last().filter(|&&length_m| length_m > 0.0) else { return left };
    let (middle, right) = (left + 0.5 * length_m * mm_per_m, left + length_m * mm_per_m);
    sheet.area(rectangle((left, y - 0.6), (middle, y + 0.6)), BLACK, 1.0);
    sheet.line(rectangle((left, y - 0.6), (right, y + 0.6)).into_iter().chain([(left, y - 0.6)]).collect(), CORE_PEN);
    let label = Label::new(format!("{} m", lengths.text(length_m)), (right + 1.5, y), SMALL_MM);
    let (.., end_mm, _) = label.bounds_mm();
    sheet.label(label);
    end_mm
}

/// The symbol of a start: a black disc in a white ring.
pub(in super::super) fn start_symbol(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 1.5, WHITE);
    sheet.dot(at, 1.1, BLACK);
}

/// The symbol of a reached goal: a black diamond in a white one.
pub(in super::super) fn goal_symbol(sheet: &mut Sheet, at: Place) {
    diamond(sheet, at, 2.0, WHITE);
    diamond(sheet, at, 1.5, BLACK);
    diamond(sheet, at, 0.7, WHITE);
}

/// The symbol of an unreached goal: the same, crossed out.
pub(in super::super) fn missed_symbol(sheet: &mut Sheet, at: Place) {
    goal_symbol(sheet, at);
    super::super::symbols::cross(sheet, at);
}

fn diamond(sheet: &mut Sheet, (x, y): Place, r: f64, colour: RGBColor) {
    sheet.area(vec![(x - r, y), (x, y - r), (x + r, y), (x, y + r)], colour, 1.0);
}

/// A path in a legend.
pub(super) fn path_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.line(vec![(x - 3.0, y), (x + 3.0, y)], CORE_PEN);
    for at in [x - 2.4, x + 2.4] {
        sheet.dot((at, y), 0.55, BLACK);
    }
}

/// Legend entries of starts, goals and paths, if present.
pub(super) fn end_keys(starts: &[MapPoint], goals: &[GoalMark], paths: &[Vec<MapPoint>]) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    if !starts.is_empty() {
        found.push((Swatch::Symbol(start_symbol), "start".to_owned()));
    }
    if goals.iter().any(|goal| goal.hops.is_some()) {
        found.push((Swatch::Symbol(goal_symbol), "goal, reached".to_owned()));
    }
    if goals.iter().any(|goal| goal.hops.is_none()) {
        found.push((Swatch::Symbol(missed_symbol), "goal, not reached".to_owned()));
    }
    if paths.iter().any(|path| !path.is_empty()) {
        found.push((Swatch::Symbol(path_symbol), "path and its landings".to_owned()));
    }
    found
}
