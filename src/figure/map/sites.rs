//! Landing sites: the candidates over a hillshade, coloured by what ranks them.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError,
        keys::{self, Swatch},
        palette::{BLACK, SMALL_MM, TEXT_MM, WHITE},
        picture::{Caption, Picture, paragraph},
        sheet::{Pen, Place, Sheet},
    },
    data::MapPosts,
    hops::{about_raster, no_data_symbol},
    names::{Bounds, Taken},
    panel::{MARKER_MM, MapPanel, goal_symbol},
    plan_view::GROUND,
    raster::{self, Pattern, Window},
    values::Steps,
};
use crate::{quantity::MapPoint, terrain::Dem};

/// The best sites that have their rank beside them.
const NAMED: usize = 5;
/// Radii of a site and of its rim, mm; smaller where there are many.
const RADIUS_MM: f64 = 1.3;
const MANY: usize = 400;

/// A candidate as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteMark {
    /// Its place.
    pub at: MapPoint,
    /// The value that it is coloured by; `None` where no hop begins.
    pub value: Option<f64>,
    /// What is written beside it, if it is one of the best.
    pub name: String,
}

/// The picture of landing sites.
#[derive(Clone, Debug)]
pub struct SitesFigure<'a> {
    /// Title and lines above.
    pub caption: Caption,
    /// The terrain.
    pub dem: &'a Dem,
    /// The candidates, best first.
    pub sites: Vec<SiteMark>,
    /// What they are coloured by, with its unit.
    pub value_name: String,
    /// The targets.
    pub targets: Vec<MapPoint>,
}

/// Draws landing sites.
///
/// # Errors
/// [`FigureError`].
pub fn draw_sites(figure: &SitesFigure<'_>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let bounds = figure.dem.bounds();
    let places = figure.sites.iter().map(|site| site.at).chain(figure.targets.iter().copied());
    let window = Window::around_most(figure.dem, 0, places.filter(|at| bounds.contains(*at)));
    let pixels = raster::draw(figure.dem, &window, &[GROUND], |_, _| Some((0, Pattern::Plain)));
    let map = MapPanel::new(figure.dem, &window, top_mm);
    let end_mm = map.draw(&mut sheet, pixels);
    let steps = Steps::of(figure.sites.iter().filter_map(|site| site.value));
    let tones = steps.tones();
    let shown: Vec<&SiteMark> = figure.sites.iter().filter(|site| map.shows(site.at)).collect();
    let radius_mm = if shown.len() > MANY { 0.55 * RADIUS_MM } else { RADIUS_MM };
    // The best are drawn last, over the others.
    for (number, site) in shown.iter().enumerate().rev() {
        let larger = if number < NAMED && site.value.is_some() { 1.5 } else { 1.0 };
        match site.value.and_then(|value| steps.class(value)) {
            Some(class) => dot(&mut sheet, map.place(site.at), larger * radius_mm, tones[class]),
            None => refused(&mut sheet, map.place(site.at), radius_mm),
        }
    }
    let mut taken = Taken::default();
    taken.spared.extend(shown.iter().map(|site| map.place(site.at)));
    for target in figure.targets.iter().filter(|at| map.shows(**at)) {
        goal_symbol(&mut sheet, map.place(*target));
        taken.kept.push(Bounds::around(map.place(*target), MARKER_MM));
    }
    for (number, target) in (1..).zip(&figure.targets).filter(|(_, at)| map.shows(**at)) {
        map.name(&mut sheet, *target, &format!("target {number}"), &mut taken);
    }
    for site in shown.iter().filter(|site| site.value.is_some()).take(NAMED) {
        map.name(&mut sheet, site.at, &site.name, &mut taken);
    }
    let legend = format!("{}; numbers: ranks of the best candidates, which are larger", steps.described(&figure.value_name));
    let end_mm = paragraph(&mut sheet, &legend, TEXT_MM, false, end_mm + 0.5);
    let mut entries = steps.keys(&tones);
    if figure.sites.iter().any(|site| site.value.is_none()) {
        entries.push((Swatch::Symbol(refused_symbol), "no hop begins there, or none leads to a target".to_owned()));
    }
    if !figure.targets.is_empty() {
        entries.push((Swatch::Symbol(goal_symbol), "target".to_owned()));
    }
    if window.has_gaps(figure.dem) {
        entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
    }
    let end_mm = keys::draw(&mut sheet, &entries, end_mm + 2.5) + 0.8;
    let about = about_raster(&MapPosts { dem: figure.dem, stride: 1, per_post: 1 }, &window);
    let end_mm = paragraph(&mut sheet, &about, SMALL_MM, false, end_mm);
    Ok(Picture::page(sheet, end_mm + 2.5))
}

/// A site without a value: a small cross, which no colour is needed to tell from a disc.
fn refused(sheet: &mut Sheet, (x, y): Place, radius_mm: f64) {
    let r = 0.6 * radius_mm;
    for (colour, width_mm) in [(WHITE, 0.7), (BLACK, 0.3)] {
        let pen = Pen { colour, width_mm };
        sheet.line(vec![(x - r, y - r), (x + r, y + r)], pen);
        sheet.line(vec![(x - r, y + r), (x + r, y - r)], pen);
    }
}

fn refused_symbol(sheet: &mut Sheet, at: Place) {
    refused(sheet, at, RADIUS_MM);
}

/// A disc in a dark rim in a white one.
fn dot(sheet: &mut Sheet, at: Place, radius_mm: f64, tone: RGBColor) {
    for (r, colour) in [(radius_mm, WHITE), (0.82 * radius_mm, BLACK), (0.66 * radius_mm, tone)] {
        sheet.dot(at, r, colour);
    }
}
