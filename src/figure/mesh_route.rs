//! The picture of paths over a mesh: an oblique view, a plan view with contour lines, and the table of the hops.

use nalgebra::{Point3, Vector3};

use super::{
    Caption, FigureError, Picture,
    bands::mixed,
    keys::{self, Swatch},
    map::{MeshPlan, draw_mesh_plan, goal_symbol, missed_symbol, nearest_symbol, start_symbol},
    mesh_oblique::{Oblique, named},
    mesh_table,
    palette::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, WHITE},
    picture::{PAGE_HEIGHT_MM, PageBreak},
    sheet::{Pen, Place, Sheet},
};
use crate::{
    path::{Hop, HopPath},
    quantity::MapPoint,
    terrain::{MapBounds, Mesh},
};

/// The direction from which a mesh is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenFrom {
    /// Where the viewer stands, clockwise from north (+y), degrees.
    pub azimuth_deg: f64,
    /// How high, degrees above the horizontal.
    pub elevation_deg: f64,
}

impl Default for SeenFrom {
    /// From the south-west, from above.
    fn default() -> Self {
        Self { azimuth_deg: 215.0, elevation_deg: 35.0 }
    }
}

/// One path of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshRouteLine<'a> {
    /// Its name in the legend; empty for a path alone.
    pub name: &'a str,
    /// Its hops.
    pub path: &'a HopPath,
    /// Gravity, m/s^2.
    pub gravity_m_s2: f64,
}

/// Paths over a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshRouteFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// From where the oblique view is.
    pub seen_from: SeenFrom,
    /// The plan view leaves out what lies higher, m; `None`: just over the highest flight.
    pub cut_z_m: Option<f64>,
    /// Where the journey begins.
    pub start: Point3<f64>,
    /// Where it should end.
    pub goal: Point3<f64>,
    /// The paths, the first one in front; none where the goal is not reached.
    pub routes: Vec<MeshRouteLine<'a>>,
    /// What is walked between the hops of the path, along the ground; empty for a machine that hops alone.
    pub walks: Vec<Vec<Point3<f64>>>,
    /// Without a path: the contact nearest to the goal that was reached.
    pub nearest: Option<Point3<f64>>,
}

/// Pieces of a flight.
const PIECES: u32 = 64;
/// What is shown around the paths, as a share of their greatest extent.
const MARGIN: f64 = 0.3;
/// Above this number of hops only some of the landings have their number.
const MOST_NUMBERED: usize = 12;
/// The colours of paths.
const COLOURS: [plotters::style::RGBColor; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];
/// The pen of what is walked.
const WALKED: Pen = Pen { colour: VERMILION, width_mm: 0.6 };
const WIDTH_MM: f64 = 0.4;
const CASING_MM: f64 = 1.0;
const DASHES_MM: (f64, f64) = (1.1, 0.9);
/// How much paler a flight is behind a facet.
const PALER: f64 = 0.35;

/// A box in space.
#[derive(Clone, Copy, Debug)]
struct Around {
    low: Vector3<f64>,
    high: Vector3<f64>,
}

/// Draws paths over a mesh: an oblique view, a plan view, and the hops as tables.
///
/// The mesh is a raster in the picture, whatever its number of facets; paths, symbols and texts are drawn as lines over it. Facets that are
/// seen from behind, as the ceiling of a cave is from above, are a veil of dots. Parts of flights behind facets are dashed and paler.
///
/// # Errors
/// [`FigureError::NoGround`] where no part of the mesh is near the paths.
pub fn draw_mesh_route(figure: &MeshRouteFigure<'_>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let flights: Vec<Vec<Vec<Point3<f64>>>> =
        figure.routes.iter().map(|route| route.path.hops.iter().map(|hop| flight(hop, route.gravity_m_s2)).collect()).collect();
    let around = figure.around(&flights)?;
    let top_mm = keys::draw(&mut sheet, &figure.entries(), head_mm + 2.0) + 7.0;
    let end_mm = figure.oblique(&mut sheet, &around, &flights, top_mm);
    let end_mm = figure.plan(&mut sheet, &around, end_mm + 2.0) + 1.5;
    let (mut end_mm, mut page_mm, mut breaks) = (end_mm, 0.0, Vec::new());
    for route in &figure.routes {
        // A table that does not fit below the pictures begins a page.
        if end_mm + mesh_table::height_mm(route.path) > page_mm + PAGE_HEIGHT_MM {
            page_mm = end_mm.ceil();
            breaks.push(PageBreak::at(&sheet, page_mm));
            end_mm = page_mm + 3.0;
        }
        end_mm = mesh_table::draw(&mut sheet, route.name, route.path, end_mm) + 1.5;
    }
    Ok(Picture { breaks, ..Picture::page(sheet, end_mm + 2.5) })
}

/// The flight of a hop, in small pieces.
fn flight(hop: &Hop, gravity_m_s2: f64) -> Vec<Point3<f64>> {
    let (from, to) = (hop.takeoff.point_m, hop.landing.point_m);
    let points = hop.flight_points(gravity_m_s2, PIECES + 1);
    points
        .into_iter()
        .map(|(share, point)| Point3::new(from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share, point.z_m))
        .collect()
}

impl MeshRouteFigure<'_> {
    /// The pen of a path.
    fn pen(number: usize) -> Pen {
        Pen { colour: COLOURS[number % COLOURS.len()], width_mm: WIDTH_MM }
    }

    fn entries(&self) -> Vec<(Swatch, String)> {
        let mut found = vec![(Swatch::Symbol(start_symbol), "start".to_owned())];
        let (goal, text): (fn(&mut Sheet, Place), _) =
            if self.routes.is_empty() { (missed_symbol, "goal, not reached") } else { (goal_symbol, "goal") };
        found.push((Swatch::Symbol(goal), text.to_owned()));
        for (number, route) in self.routes.iter().enumerate() {
            let name = if route.name.is_empty() { "path" } else { route.name };
            let hops = route.path.hops.len();
            found.push((Swatch::Line(Self::pen(number)), format!("{name}, {hops} hop{}", if hops == 1 { "" } else { "s" })));
        }
        if !self.walks.is_empty() {
            found.push((Swatch::Line(WALKED), "walked".to_owned()));
        }
        if self.nearest.is_some() {
            found.push((Swatch::Symbol(nearest_symbol), "reached contact nearest to the goal".to_owned()));
        }
        found
    }

    /// The part of the mesh around the paths, and the paths.
    fn around(&self, flights: &[Vec<Vec<Point3<f64>>>]) -> Result<Around, FigureError> {
        let mut paths = Around { low: self.start.coords, high: self.start.coords };
        for point in flights.iter().flatten().flatten().chain(self.walks.iter().flatten()).chain([&self.goal]).chain(&self.nearest)
        {
            (paths.low, paths.high) = (paths.low.inf(&point.coords), paths.high.sup(&point.coords));
        }
        let bounds = self.mesh.bounds();
        let low = Vector3::new(bounds.map.min.x, bounds.map.min.y, bounds.low_m);
        let high = Vector3::new(bounds.map.max.x, bounds.map.max.y, bounds.high_m);
        // A start that is the goal has no extent.
        let size_m = (paths.high - paths.low).amax();
        let margin = Vector3::repeat(MARGIN * if size_m > 0.0 { size_m } else { (high - low).amax() });
        let shown = Around { low: low.sup(&(paths.low - margin)), high: high.inf(&(paths.high + margin)) };
        if (0..3).any(|axis| shown.low[axis] > shown.high[axis]) {
            return Err(FigureError::NoGround { what: "the path".to_owned(), points: 0 });
        }
        Ok(Around { low: shown.low.inf(&paths.low), high: shown.high.sup(&paths.high) })
    }

    /// The oblique view; returns where it ends.
    fn oblique(&self, sheet: &mut Sheet, around: &Around, flights: &[Vec<Vec<Point3<f64>>>], top_mm: f64) -> f64 {
        let is_shown = |at: &&Point3<f64>| (0..3).all(|axis| (around.low[axis]..=around.high[axis]).contains(&at[axis]));
        let corners = self.mesh.vertices().iter().filter(is_shown);
        let ends = [&self.start, &self.goal].into_iter().chain(&self.nearest);
        let points = corners.chain(flights.iter().flatten().flatten()).chain(ends);
        let oblique = Oblique::around(self.mesh, self.seen_from, (points, (around.high - around.low).amax()), None, top_mm);
        for walk in &self.walks {
            draw_flight(sheet, &oblique, walk, WALKED);
        }
        for (number, route) in flights.iter().enumerate().rev() {
            let pen = Self::pen(number);
            for hop in route {
                draw_flight(sheet, &oblique, hop, pen);
            }
        }
        self.symbols(sheet, &oblique, flights);
        let points = flights.iter().flatten().flatten().chain(self.walks.iter().flatten());
        let is_hidden = points.into_iter().any(|point| oblique.seen.hides(oblique.view.of(point)));
        oblique.finish(sheet, if is_hidden { " Dashed: a path behind a facet." } else { "" })
    }

    /// Landings with their numbers, start and goal.
    fn symbols(&self, sheet: &mut Sheet, oblique: &Oblique, flights: &[Vec<Vec<Point3<f64>>>]) {
        for (number, route) in flights.iter().enumerate() {
            for landing in route.iter().filter_map(|hop| hop.last()) {
                let pen = Self::pen(number);
                if oblique.seen.hides(oblique.view.of(landing)) {
                    sheet.ring(oblique.place(landing), 0.55, hidden(pen));
                } else {
                    sheet.dot(oblique.place(landing), 0.6, pen.colour);
                }
            }
        }
        if let Some(nearest) = self.nearest {
            nearest_symbol(sheet, oblique.place(&nearest));
        }
        let goal = if self.routes.is_empty() { missed_symbol } else { goal_symbol };
        start_symbol(sheet, oblique.place(&self.start));
        goal(sheet, oblique.place(&self.goal));
        named(sheet, oblique.place(&self.start), "start");
        named(sheet, oblique.place(&self.goal), "goal");
        if let [route] = flights {
            let every = route.len().div_ceil(MOST_NUMBERED).max(1);
            let between = (1usize..).zip(route).take(route.len().saturating_sub(1));
            for (number, hop) in between.filter(|(number, _)| number.is_multiple_of(every)) {
                if let Some(landing) = hop.last() {
                    named(sheet, oblique.place(landing), &number.to_string());
                }
            }
        }
    }

    /// The plan view; returns where it ends.
    fn plan(&self, sheet: &mut Sheet, around: &Around, top_mm: f64) -> f64 {
        let highest_m = self.routes.iter().flat_map(|route| &route.path.hops).map(|hop| hop.apex_z_m);
        let highest_m = highest_m.chain([self.start.z, self.goal.z]).fold(f64::NEG_INFINITY, f64::max);
        let over_m = 0.02 * (around.high.z - around.low.z);
        let mut paths: Vec<(Vec<_>, Pen)> =
            self.walks.iter().map(|walk| (walk.first().into_iter().chain(walk.last()).map(Point3::xy).collect(), WALKED)).collect();
        for (number, route) in self.routes.iter().enumerate() {
            let ends = |hop: &Hop| [hop.takeoff.point_m.xy(), hop.landing.point_m.xy()];
            if self.walks.is_empty() {
                let landings = route.path.hops.iter().map(|hop| ends(hop)[1]);
                paths.push((std::iter::once(self.start.xy()).chain(landings).collect(), Self::pen(number)));
            } else {
                paths.extend(route.path.hops.iter().map(|hop| (ends(hop).into(), Self::pen(number))));
            }
        }
        let corner = |at: Vector3<f64>| MapPoint::new(at.x, at.y);
        let plan = MeshPlan {
            mesh: self.mesh,
            bounds: MapBounds { min: corner(around.low), max: corner(around.high) },
            cut_z_m: self.cut_z_m.unwrap_or(highest_m + over_m),
            low_z_m: around.low.z,
            paths,
            start: self.start.xy(),
            goal: self.goal.xy(),
            goal_hops: self.routes.first().map(|route| route.path.hops.len() as u64),
            paint: None,
        };
        draw_mesh_plan(sheet, &plan, top_mm)
    }
}

/// The pen of a flight behind a facet.
fn hidden(pen: Pen) -> Pen {
    Pen { colour: mixed(pen.colour, WHITE, PALER), width_mm: 0.7 * pen.width_mm }
}

/// A flight, dashed and paler where it is behind a facet.
fn draw_flight(sheet: &mut Sheet, oblique: &Oblique, points: &[Point3<f64>], pen: Pen) {
    let placed: Vec<(Place, bool)> =
        points.iter().map(|point| (oblique.place(point), oblique.seen.hides(oblique.view.of(point)))).collect();
    let mut from = 0;
    while from + 1 < placed.len() {
        let is_hidden = placed[from].1 && placed[from + 1].1;
        let mut to = from + 1;
        while to + 1 < placed.len() && (placed[to].1 && placed[to + 1].1) == is_hidden {
            to += 1;
        }
        let part: Vec<Place> = placed[from..=to].iter().map(|(place, _)| *place).collect();
        if is_hidden {
            sheet.dashed(&part, DASHES_MM.0, DASHES_MM.1, hidden(pen));
        } else {
            sheet.line(part.clone(), Pen { colour: WHITE, width_mm: CASING_MM });
            sheet.line(part, pen);
        }
        from = to;
    }
}
