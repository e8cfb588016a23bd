//! A mission over several targets: its legs from above over a hillshade, and the visits as a table.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError,
        keys::{self, Swatch},
        palette::{AXIS, BLACK, BLUE, ORANGE, RIGHT_MM, SMALL_MM, WHITE},
        picture::{Caption, MARGIN_MM, Picture, paragraph},
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet},
    },
    data::MapPosts,
    hops::{about_raster, no_data_symbol},
    names::{Bounds, Taken},
    panel::{MARKER_MM, MapPanel, goal_symbol, missed_symbol, start_symbol},
    plan_view::GROUND,
    raster::{self, Pattern, Window},
};
use crate::{quantity::MapPoint, terrain::Dem};

/// The greatest height of the map.
const TALL_MM: f64 = 150.0;
/// Legs in turn: odd ones solid, even ones dashed in another colour, so that they differ without colour too.
const ODD_PEN: Pen = Pen { colour: BLUE, width_mm: 0.45 };
const EVEN_PEN: Pen = Pen { colour: BLACK, width_mm: 0.45 };
const CASING_PEN: Pen = Pen { colour: WHITE, width_mm: 1.1 };
/// Dashes of even legs and the gaps between them, mm.
const DASH_MM: [f64; 2] = [1.8, 1.0];
/// Spacing of the rows of the table.
const ROW_MM: f64 = 3.6;

/// A target as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetMark {
    /// Its place.
    pub at: MapPoint,
    /// What is written beside it.
    pub name: String,
    /// Whether it is visited.
    pub is_visited: bool,
}

/// A row of the table of visits.
#[derive(Clone, Debug, PartialEq)]
pub struct VisitRow {
    /// From where to where.
    pub leg: String,
    /// The numbers of the columns of [`TargetsFigure::columns`].
    pub numbers: Vec<String>,
}

/// The picture of a mission over targets.
#[derive(Clone, Debug)]
pub struct TargetsFigure<'a> {
    /// Title and lines above.
    pub caption: Caption,
    /// The terrain.
    pub dem: &'a Dem,
    /// Where the mission begins.
    pub start: MapPoint,
    /// The targets.
    pub targets: Vec<TargetMark>,
    /// The places of each leg in order, the first and the last included.
    pub legs: Vec<Vec<MapPoint>>,
    /// The columns of the table: name and unit.
    pub columns: Vec<(String, String)>,
    /// Its rows.
    pub visits: Vec<VisitRow>,
}

/// Draws a mission over targets.
///
/// # Errors
/// [`FigureError`].
pub fn draw_targets(figure: &TargetsFigure<'_>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let end_mm = figure.map(&mut sheet, head_mm + 1.0);
    let end_mm = if figure.visits.is_empty() { end_mm } else { figure.table(&mut sheet, end_mm + 3.0) };
    Ok(Picture::page(sheet, end_mm + 2.5))
}

impl TargetsFigure<'_> {
    fn map(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let places = self.legs.iter().flatten().copied().chain([self.start]).chain(self.targets.iter().map(|target| target.at));
        let window = Window::around(self.dem, places);
        let pixels = raster::draw(self.dem, &window, &[GROUND], |_, _| Some((0, Pattern::Plain)));
        let map = MapPanel::at_most(self.dem, &window, top_mm, TALL_MM);
        let end_mm = map.draw(sheet, pixels);
        let lines: Vec<Vec<Place>> = self.legs.iter().map(|leg| leg.iter().map(|at| map.place(*at)).collect()).collect();
        for line in &lines {
            sheet.line(line.clone(), CASING_PEN);
        }
        for (number, line) in lines.iter().enumerate() {
            if number % 2 == 0 {
                sheet.line(line.clone(), ODD_PEN);
            } else {
                sheet.dashed(line, DASH_MM[0], DASH_MM[1], EVEN_PEN);
            }
            let landings = line.iter().skip(1).take(line.len().saturating_sub(2));
            landings.for_each(|at| landing_symbol(sheet, *at));
        }
        let mut taken = Taken::default();
        taken.spared.extend(lines.iter().flatten());
        start_symbol(sheet, map.place(self.start));
        taken.kept.push(Bounds::around(map.place(self.start), MARKER_MM));
        for target in &self.targets {
            let symbol = if target.is_visited { goal_symbol } else { missed_symbol };
            symbol(sheet, map.place(target.at));
            taken.kept.push(Bounds::around(map.place(target.at), MARKER_MM));
        }
        map.name(sheet, self.start, "start", &mut taken);
        for target in &self.targets {
            map.name(sheet, target.at, &target.name, &mut taken);
        }
        let mut entries = self.entries();
        if window.has_gaps(self.dem) {
            entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
        }
        let end_mm = keys::draw(sheet, &entries, end_mm + 3.0) + 0.8;
        paragraph(sheet, &about_raster(&MapPosts { dem: self.dem, stride: 1, per_post: 1 }, &window), SMALL_MM, false, end_mm)
    }

    fn entries(&self) -> Vec<(Swatch, String)> {
        let mut entries = vec![(Swatch::Symbol(start_symbol), "start".to_owned())];
        if self.targets.iter().any(|target| target.is_visited) {
            entries.push((Swatch::Symbol(goal_symbol), "target, with its visit".to_owned()));
        }
        if self.targets.iter().any(|target| !target.is_visited) {
            entries.push((Swatch::Symbol(missed_symbol), "target that is left out".to_owned()));
        }
        if !self.legs.is_empty() {
            entries.push((Swatch::Line(ODD_PEN), "leg of an odd visit".to_owned()));
            entries.push((Swatch::Symbol(landing_symbol), "landing".to_owned()));
        }
        if self.legs.len() > 1 {
            entries.push((Swatch::Dashed(EVEN_PEN, DASH_MM[0], DASH_MM[1]), "leg of an even visit".to_owned()));
        }
        entries
    }

    /// The visits; returns where the table ends.
    #[expect(clippy::cast_precision_loss, reason = "a few columns")]
    fn table(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        /// Where the numbers begin.
        const FIRST_MM: f64 = 40.0;
        let mut y = paragraph(sheet, "Visits in their order", SMALL_MM, true, top_mm) + 0.5;
        let step_mm = (RIGHT_MM - FIRST_MM) / self.columns.len().max(1) as f64;
        let mut row = |name: String, texts: Vec<String>, y: f64| {
            sheet.label(Label::new(name, (MARGIN_MM, y), SMALL_MM).hung(Anchor::Start, Hang::Below));
            for (number, text) in texts.into_iter().enumerate() {
                let end_mm = FIRST_MM + step_mm * (number + 1) as f64;
                sheet.label(Label::new(text, (end_mm, y), SMALL_MM).hung(Anchor::End, Hang::Below));
            }
        };
        row("visit".to_owned(), self.columns.iter().map(|(name, _)| name.clone()).collect(), y);
        row(String::new(), self.columns.iter().map(|(_, unit)| unit.clone()).collect(), y + ROW_MM);
        y += 2.0 * ROW_MM + 0.6;
        let rule_mm = y - 0.7;
        for (number, visit) in (1..).zip(&self.visits) {
            row(format!("{number}  {}", visit.leg), visit.numbers.clone(), y);
            y += ROW_MM;
        }
        sheet.line(vec![(MARGIN_MM, rule_mm), (RIGHT_MM, rule_mm)], Pen { colour: AXIS, width_mm: 0.15 });
        y
    }
}

/// A small ring: a landing.
fn landing_symbol(sheet: &mut Sheet, at: Place) {
    const RINGS: [(f64, RGBColor); 3] = [(0.8, WHITE), (0.62, BLACK), (0.34, ORANGE)];
    for (r, colour) in RINGS {
        sheet.dot(at, r, colour);
    }
}
