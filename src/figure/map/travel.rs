//! A mission that drives and hops: from above over a hillshade, and as a profile over the distance travelled.

use super::{
    super::{
        FigureError,
        axes::{BELOW_MM, Panel, left_room_mm},
        keys::{self, Swatch},
        palette::{BLACK, BLUE, LEFT_MM, ORANGE, RIGHT_MM, SMALL_MM, WHITE},
        picture::{Caption, Picture, paragraph},
        sheet::{Pen, Place, Sheet},
        ticks::Ticks,
    },
    data::{GoalMark, MapPosts},
    hops::{about_raster, no_data_symbol},
    names::{Bounds, Taken},
    panel::{MARKER_MM, MapPanel, end_keys},
    plan_view::{GROUND, nearest_symbol},
    raster::{self, Pattern, Window},
};
use crate::{
    quantity::{ChainPoint, MapPoint},
    terrain::Dem,
};

/// The greatest height of the map.
const TALL_MM: f64 = 130.0;
/// The height of the profile.
const PROFILE_MM: f64 = 42.0;
/// Drive legs: a solid line. Hops: dashes, which differ from it without colour.
const DRIVE_PEN: Pen = Pen { colour: BLUE, width_mm: 0.7 };
const HOP_PEN: Pen = Pen { colour: BLACK, width_mm: 0.4 };
const CASING_PEN: Pen = Pen { colour: WHITE, width_mm: 1.2 };
const GROUND_PEN: Pen = Pen { colour: BLACK, width_mm: 0.15 };
/// Dashes of hops and the gaps between them, mm.
const DASH_MM: [f64; 2] = [1.6, 1.0];

/// A leg as it is drawn.
#[derive(Clone, Debug)]
pub struct TravelLine {
    /// Whether it is driven; a hop otherwise.
    pub drives: bool,
    /// Its places on the map, in order.
    pub plan: Vec<MapPoint>,
    /// Its places over the horizontal distance travelled: a hop's along its arc.
    pub profile: Vec<ChainPoint>,
    /// Of a hop: the ground under it, over the same distance.
    pub ground: Vec<ChainPoint>,
}

/// The picture of a mission.
#[derive(Clone, Debug)]
pub struct TravelFigure<'a> {
    /// Title and lines above.
    pub caption: Caption,
    /// The terrain.
    pub dem: &'a Dem,
    /// Where the mission begins.
    pub start: MapPoint,
    /// Where it should end.
    pub goal: MapPoint,
    /// The legs, in the order of travel; empty without a path.
    pub legs: Vec<TravelLine>,
    /// Without a path: the reached place nearest to the goal.
    pub nearest: Option<MapPoint>,
}

/// Draws a mission.
///
/// # Errors
/// [`FigureError`].
pub fn draw_travel(figure: &TravelFigure<'_>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let end_mm = figure.map(&mut sheet, head_mm + 1.0);
    let end_mm = if figure.legs.is_empty() { end_mm } else { figure.profile(&mut sheet, end_mm + 4.0) };
    Ok(Picture::page(sheet, end_mm + 2.5))
}

impl TravelFigure<'_> {
    fn map(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let plan = self.legs.iter().flat_map(|leg| leg.plan.iter().copied());
        let window = Window::around(self.dem, plan.chain([self.start, self.goal]).chain(self.nearest));
        let pixels = raster::draw(self.dem, &window, &[GROUND], |_, _| Some((0, Pattern::Plain)));
        let map = MapPanel::at_most(self.dem, &window, top_mm, TALL_MM);
        let end_mm = map.draw(sheet, pixels);
        let lines: Vec<(bool, Vec<Place>)> =
            self.legs.iter().map(|leg| (leg.drives, leg.plan.iter().map(|at| map.place(*at)).collect())).collect();
        for (_, line) in &lines {
            sheet.line(line.clone(), CASING_PEN);
        }
        for (drives, line) in &lines {
            draw_line(sheet, *drives, line);
        }
        for (_, line) in lines.iter().filter(|(drives, _)| !drives) {
            landing_symbol(sheet, line[line.len() - 1]);
        }
        let nearest = self.nearest.filter(|at| *at != self.start && map.shows(*at));
        if let Some(at) = nearest {
            nearest_symbol(sheet, map.place(at));
        }
        let places: Vec<Vec<MapPoint>> = self.legs.iter().map(|leg| leg.plan.clone()).collect();
        let hops = self.legs.iter().filter(|leg| !leg.drives).count() as u64;
        let goals = [GoalMark { at: self.goal, hops: (!self.legs.is_empty()).then_some(hops) }];
        let mut taken: Taken = map.ends(sheet, &[self.start], &goals, &places);
        taken.kept.extend(nearest.map(|at| Bounds::around(map.place(at), MARKER_MM)));
        let mut entries = end_keys(&[self.start], &goals, &[]);
        entries.extend(self.entries());
        if nearest.is_some() {
            entries.push((Swatch::Symbol(nearest_symbol), "reached place nearest to the goal".to_owned()));
        }
        if window.has_gaps(self.dem) {
            entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
        }
        let end_mm = keys::draw(sheet, &entries, end_mm + 3.0) + 0.8;
        paragraph(sheet, &about_raster(&MapPosts { dem: self.dem, stride: 1, per_post: 1 }, &window), SMALL_MM, false, end_mm)
    }

    fn entries(&self) -> Vec<(Swatch, String)> {
        let mut entries = Vec::new();
        if self.legs.iter().any(|leg| leg.drives) {
            entries.push((Swatch::Line(DRIVE_PEN), "driven".to_owned()));
        }
        if self.legs.iter().any(|leg| !leg.drives) {
            entries.push((Swatch::Dashed(HOP_PEN, DASH_MM[0], DASH_MM[1]), "hop".to_owned()));
            entries.push((Swatch::Symbol(landing_symbol), "landing".to_owned()));
        }
        entries
    }

    fn profile(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let points = || self.legs.iter().flat_map(|leg| leg.profile.iter().chain(&leg.ground));
        let end_m = points().map(|point| point.x_m).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let (low, high) =
            points().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| (low.min(point.z_m), high.max(point.z_m)));
        let room_m = (0.06 * (high - low)).max(1e-9 * (1.0 + high.abs()));
        let (low, high) = (low - room_m, high + room_m);
        let up = Ticks::round(low, high, PROFILE_MM / 9.0);
        let left = LEFT_MM.max(1.0 + left_room_mm(&up));
        let panel = Panel { left, top: top_mm, right: RIGHT_MM, bottom: top_mm + PROFILE_MM };
        let place = |point: &ChainPoint| {
            let (x, y) = (point.x_m / end_m, (point.z_m - low) / (high - low));
            (panel.left + x * panel.width(), panel.bottom - y * panel.height())
        };
        let along = Ticks::round(0.0, end_m, panel.width() / 20.0);
        let ticks: Vec<_> = along.values.iter().map(|&x| (place(&ChainPoint::new(x, low)).0, along.text(x))).collect();
        panel.x_axis(sheet, &ticks, "horizontal distance travelled (m)", true);
        let ticks: Vec<_> = up.values.iter().map(|&z| (place(&ChainPoint::new(0.0, z)).1, up.text(z))).collect();
        panel.y_axis(sheet, &ticks, "height (m)", true);
        for leg in &self.legs {
            sheet.line(leg.ground.iter().map(place).collect(), GROUND_PEN);
            let line: Vec<Place> = leg.profile.iter().map(place).collect();
            draw_line(sheet, leg.drives, &line);
            if !leg.drives {
                landing_symbol(sheet, line[line.len() - 1]);
            }
        }
        panel.outline(sheet);
        let scale = (panel.height() / (high - low)) / (panel.width() / end_m);
        let text = format!("heights are drawn {scale:.1} times as large as distances; thin lines: the ground under hops");
        paragraph(sheet, &text, SMALL_MM, false, panel.bottom + BELOW_MM)
    }
}

fn draw_line(sheet: &mut Sheet, drives: bool, line: &[Place]) {
    if drives {
        sheet.line(line.to_vec(), DRIVE_PEN);
    } else {
        sheet.dashed(line, DASH_MM[0], DASH_MM[1], HOP_PEN);
    }
}

/// A ring: a landing.
fn landing_symbol(sheet: &mut Sheet, at: Place) {
    for (r, colour) in [(0.95, WHITE), (0.75, BLACK), (0.4, ORANGE)] {
        sheet.dot(at, r, colour);
    }
}
