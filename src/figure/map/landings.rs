//! The scattered landings of a path's hops, on a map.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        keys::{self, Swatch},
        palette::{BLACK, BLUE, SMALL_MM, VERMILION, WHITE},
        picture::paragraph,
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet},
        ticks::{one_in, short},
    },
    data::{LandingCloud, LandingEllipse, LandingMapFigure, MapPosts},
    hops::{about_raster, no_data_symbol},
    inset,
    names::{Bounds, Candidate, Taken},
    panel::{MARKER_MM, MapPanel, goal_symbol, path_symbol, start_symbol},
    raster::{self, Pattern, Window},
};
use crate::quantity::MapPoint;

/// The ground, a single class here.
pub(super) const GROUND: RGBColor = RGBColor(205, 202, 196);
/// The greatest number of landings drawn; more are thinned to every n-th of each hop.
const MOST_DOTS: usize = 2500;
/// Corners of a drawn ellipse: on the largest map the error is below 0.1 mm.
const CORNERS: u8 = 72;
/// Above this number of hops the legend states only the range of their ellipses.
const MOST_LISTED: usize = 12;
pub(super) const ELLIPSE_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.45 };
const CASING_PEN: Pen = Pen { colour: WHITE, width_mm: 0.95 };
/// The greatest height of the map, which shares a page of A4 with its insets.
const TALL_MM: f64 = 134.0;

/// Draws the scattered landings of a path's hops and their 95 % ellipses around the planned path, over a hillshade.
///
/// The map shows the area of path, landings and ellipses; where these are small on it, insets below it show the widest of them and the last
/// at a larger scale. More than 2 500 landings are thinned to every n-th of each hop, and the
/// legend says so. The number of landings beyond the DEM is stated. An ellipse contains 95 % of a Gaussian with the landings' mean
/// and covariance; its cross marks that mean.
///
/// # Errors
/// None today: absent data is not drawn.
pub fn draw_landing_map(figure: &LandingMapFigure<'_>) -> Result<Picture, FigureError> {
    let window = Window::around(figure.dem, places(figure));
    let pixels = raster::draw(figure.dem, &window, &[GROUND], |_, _| Some((0, Pattern::Plain)));
    let has_gaps = window.has_gaps(figure.dem);
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let map = MapPanel::at_most(figure.dem, &window, top_mm, TALL_MM);
    let end_mm = map.draw(&mut sheet, pixels);
    // The path lies under the landings, which it would hide.
    let path: Vec<MapPoint> = figure.path.iter().copied().filter(|&at| map.shows(at)).collect();
    map.paths(&mut sheet, &[path]);
    let shown: Vec<_> = figure.clouds.iter().map(|cloud| cloud.landings.iter().filter(|&&at| map.shows(at)).collect()).collect();
    let every = shown.iter().map(Vec::len).sum::<usize>().div_ceil(MOST_DOTS).max(1);
    for &at in shown.iter().flat_map(|landings: &Vec<&MapPoint>| landings.iter().step_by(every)) {
        landing_dot(&mut sheet, map.place(*at));
    }
    for ellipse in figure.clouds.iter().filter_map(|cloud| cloud.ellipse) {
        map.ellipse(&mut sheet, &ellipse);
    }
    map.names_of_landings(&mut sheet, figure);
    let end_mm = inset::draw(&mut sheet, figure, map.layout().0, end_mm + 1.0);
    let drawn = shown.iter().map(|landings| landings.len().div_ceil(every)).sum();
    let mut y = keys::draw(&mut sheet, &entries(figure, drawn, has_gaps), end_mm + 3.0) + 0.8;
    for text in words(figure, &map, &window) {
        y = paragraph(&mut sheet, &text, SMALL_MM, false, y);
    }
    Ok(Picture::page(sheet, y + 2.0))
}

/// Where the planned path ends, if it has a hop.
fn goal(figure: &LandingMapFigure<'_>) -> Option<MapPoint> {
    figure.path.last().copied().filter(|_| figure.path.len() > 1)
}

#[expect(clippy::cast_precision_loss, reason = "some hundreds of hops")]
fn ratio(count: usize, of: usize) -> f64 {
    count as f64 / of as f64
}

/// All points that the map must contain.
fn places<'a>(figure: &'a LandingMapFigure<'_>) -> impl Iterator<Item = MapPoint> + 'a {
    let rims = figure.clouds.iter().filter_map(|cloud| cloud.ellipse).flat_map(|ellipse| rim(&ellipse));
    let clouds = figure.clouds.iter().flat_map(|cloud| cloud.landings.iter().copied().chain([cloud.planned]));
    let inside = figure.dem.bounds();
    // Points beyond the DEM cannot be drawn and must not enlarge the window.
    figure.path.iter().copied().chain(clouds).chain(rims).filter(move |&at| inside.contains(at))
}

/// The outline of an ellipse on the map, its first point not repeated.
///
/// With s and c the sine and cosine of the major axis's heading, its points are centre + a cos(t) (s, c) + b sin(t) (c, -s).
pub(super) fn rim(ellipse: &LandingEllipse) -> Vec<MapPoint> {
    let heading = ellipse.heading_deg.to_radians();
    let (s, c) = (libm::sin(heading), libm::cos(heading));
    let point = |corner: u8| {
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
        let (along, across) = (ellipse.semi_major_m * libm::cos(angle), ellipse.semi_minor_m * libm::sin(angle));
        MapPoint::new(ellipse.centre.x + along * s + across * c, ellipse.centre.y + along * c - across * s)
    };
    (0..CORNERS).map(point).collect()
}

impl MapPanel {
    /// An ellipse with a cross at its centre, clipped to the map.
    fn ellipse(&self, sheet: &mut Sheet, ellipse: &LandingEllipse) {
        let rim = rim(ellipse);
        let mut pieces: Vec<Vec<Place>> = vec![Vec::new()];
        for &at in rim.iter().chain(rim.first()) {
            match pieces.last_mut() {
                Some(piece) if self.shows(at) => piece.push(self.place(at)),
                Some(piece) if !piece.is_empty() => pieces.push(Vec::new()),
                _ => {}
            }
        }
        for pen in [CASING_PEN, ELLIPSE_PEN] {
            for piece in pieces.iter().filter(|piece| piece.len() > 1) {
                sheet.line(piece.clone(), pen);
            }
        }
        if self.shows(ellipse.centre) {
            plus(sheet, self.place(ellipse.centre));
        }
    }
}

impl MapPanel {
    /// Start and planned landings, with their names on top.
    fn names_of_landings(&self, sheet: &mut Sheet, figure: &LandingMapFigure<'_>) {
        let planned = || figure.clouds.iter().filter(|cloud| self.shows(cloud.planned));
        let mut taken = Taken { kept: Vec::new(), spared: planned().map(|cloud| self.place(cloud.planned)).collect() };
        let start = figure.path.first().filter(|&&at| self.shows(at));
        if let Some(&at) = start {
            start_symbol(sheet, self.place(at));
            taken.kept.push(Bounds::around(self.place(at), MARKER_MM));
        }
        for cloud in planned() {
            planned_symbol(sheet, self.place(cloud.planned));
        }
        let goal = goal(figure).filter(|&at| self.shows(at));
        if let Some(at) = goal {
            goal_symbol(sheet, self.place(at));
            taken.kept.push(Bounds::around(self.place(at), MARKER_MM));
        }
        if let Some(&at) = start {
            self.name(sheet, at, "start", &mut taken);
        }
        if let Some(at) = goal {
            self.name(sheet, at, "goal", &mut taken);
        }
        // Of many hops every n-th has its number, and the last.
        let every = one_in(ratio(figure.clouds.len(), MOST_LISTED));
        let last = figure.clouds.last().map(|cloud| cloud.hop);
        for cloud in planned().filter(|cloud| cloud.hop.is_multiple_of(every) || Some(cloud.hop) == last) {
            self.number(sheet, cloud, &mut taken);
        }
    }

    /// A hop's number outside its ellipse, so that it hides no landings; beside the planned landing if there is no ellipse.
    fn number(&self, sheet: &mut Sheet, cloud: &LandingCloud, taken: &mut Taken) {
        let text = cloud.hop.to_string();
        let Some(ellipse) = cloud.ellipse else { return self.name(sheet, cloud.planned, &text, taken) };
        let rim: Vec<Place> = rim(&ellipse).into_iter().map(|at| self.place(at)).collect();
        let end = |before: fn(&Place, &Place) -> bool| rim.iter().copied().reduce(|a, b| if before(&b, &a) { b } else { a });
        let place = |at: Option<Place>, (dx, dy): Place, anchor| {
            let label = |(x, y)| Label::new(text.as_str(), (x + dx, y + dy), SMALL_MM).hung(anchor, Hang::Through);
            at.map(|at| Candidate { label: label(at), ring: 0 })
        };
        let places = [
            place(end(|a, b| a.1 < b.1), (0.0, -2.2), Anchor::Middle),
            place(end(|a, b| a.1 > b.1), (0.0, 2.2), Anchor::Middle),
            place(end(|a, b| a.0 > b.0), (1.2, 0.0), Anchor::Start),
            place(end(|a, b| a.0 < b.0), (-1.2, 0.0), Anchor::End),
        ];
        self.name_on_one(sheet, &places.into_iter().flatten().collect::<Vec<_>>(), None, taken);
    }
}

pub(super) fn plus(sheet: &mut Sheet, (x, y): Place) {
    for pen in [Pen { width_mm: 0.7, ..CASING_PEN }, Pen { width_mm: 0.3, ..ELLIPSE_PEN }] {
        sheet.line(vec![(x - 0.9, y), (x + 0.9, y)], pen);
        sheet.line(vec![(x, y - 0.9), (x, y + 0.9)], pen);
    }
}

pub(super) fn landing_dot(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 0.28, BLUE);
}

/// A few landings in a legend.
fn landings_symbol(sheet: &mut Sheet, (x, y): Place) {
    for (dx, dy) in [(-1.8, 0.4), (-0.7, -0.7), (0.1, 0.6), (1.0, -0.3), (1.9, 0.5)] {
        landing_dot(sheet, (x + dx, y + dy));
    }
}

/// An ellipse in a legend.
fn ellipse_symbol(sheet: &mut Sheet, (x, y): Place) {
    let corner = |i: u8| {
        let angle = std::f64::consts::TAU * f64::from(i) / 24.0;
        (x + 2.8 * libm::cos(angle), y + 1.4 * libm::sin(angle))
    };
    sheet.line((0..=24).map(corner).collect(), ELLIPSE_PEN);
    plus(sheet, (x, y));
}

/// A planned landing in a legend.
pub(super) fn planned_symbol(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 0.55, BLACK);
}

/// The legend. `drawn`: the number of landings drawn; `has_gaps`: whether the map shows posts without data.
fn entries(figure: &LandingMapFigure<'_>, drawn: usize, has_gaps: bool) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    if !figure.path.is_empty() {
        found.push((Swatch::Symbol(start_symbol as fn(&mut Sheet, Place)), "start".to_owned()));
        found.push((Swatch::Symbol(path_symbol), "planned path".to_owned()));
    }
    if goal(figure).is_some() {
        found.push((Swatch::Symbol(goal_symbol), "goal".to_owned()));
    }
    if !figure.clouds.is_empty() {
        found.push((Swatch::Symbol(planned_symbol), "planned landing".to_owned()));
    }
    if drawn > 0 {
        let all: u64 = figure.clouds.iter().map(|cloud| cloud.count).sum();
        let text = if drawn as u64 >= all { format!("landing ({drawn})") } else { format!("landing ({drawn} of {all} drawn)") };
        found.push((Swatch::Symbol(landings_symbol), text));
    }
    if figure.clouds.iter().any(|cloud| cloud.ellipse.is_some()) {
        found.push((Swatch::Symbol(ellipse_symbol), "95 % ellipse with its hop and its middle".to_owned()));
    }
    if has_gaps {
        found.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
    }
    found
}

/// The sizes of the ellipses, hop by hop or as a range, the landings beyond the map, and the description of the raster.
fn words(figure: &LandingMapFigure<'_>, map: &MapPanel, window: &Window) -> Vec<String> {
    let with_ellipse: Vec<(&LandingCloud, LandingEllipse)> =
        figure.clouds.iter().filter_map(|cloud| Some((cloud, cloud.ellipse?))).collect();
    let mut found = Vec::new();
    let sizes = |one: fn(&LandingEllipse) -> f64| {
        let all = with_ellipse.iter().map(|(_, ellipse)| one(ellipse));
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), m| (low.min(m), high.max(m)));
        format!("{} m to {} m", short(low), short(high))
    };
    if (1..=MOST_LISTED).contains(&with_ellipse.len()) {
        found.push(
            "Ellipses, half the longer axis by half the shorter one, and the heading of the longer one from grid north:".to_owned(),
        );
        let one = |&(cloud, ellipse): &(&LandingCloud, LandingEllipse)| {
            let LandingEllipse { semi_major_m, semi_minor_m, heading_deg, .. } = ellipse;
            format!("hop {}: {} m by {} m, {heading_deg:.0}°", cloud.hop, short(semi_major_m), short(semi_minor_m))
        };
        found.push(with_ellipse.iter().map(one).collect::<Vec<_>>().join("; ") + ".");
    } else if !with_ellipse.is_empty() {
        let (major, minor) = (sizes(|ellipse| ellipse.semi_major_m), sizes(|ellipse| ellipse.semi_minor_m));
        found.push(format!("Ellipses: half the longer axis {major}, half the shorter one {minor}."));
    }
    let beyond = figure.clouds.iter().flat_map(|cloud| &cloud.landings).filter(|&&at| !map.shows(at)).count();
    if beyond > 0 {
        found.push(format!("Landings beyond the DEM, not drawn: {beyond}."));
    }
    found.push(about_raster(&MapPosts { dem: figure.dem, stride: 1, per_post: 1 }, window));
    found
}
