//! The picture of what is reached over a mesh: an oblique view and a plan view in the colours of the hops.

use std::fmt::Write as _;

use nalgebra::{Point3, Vector3};
use plotters::style::RGBColor;

use super::{
    Caption, FigureError, Picture, SeenFrom,
    bands::HopClasses,
    keys::{self, Swatch},
    map::{MeshPlan, draw_mesh_plan, goal_symbol, missed_symbol, start_symbol},
    mesh_oblique::{Oblique, named},
    mesh_paint::{Paint, PaintedContact},
    palette::WHITE,
    sheet::{Pen, Place, Sheet},
    ticks::short,
};
use crate::{
    quantity::MapPoint,
    terrain::{MapBounds, Mesh},
};

/// Contacts that are not reached: grey, which is not a colour of any band.
const NOT_REACHED: RGBColor = RGBColor(196, 196, 196);

/// What the colours mean.
const COLOURS: &str = " Each place has the colour of the nearest contact, where that is near and its facet faces a similar way.";

/// A contact of a picture of hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachedContact {
    /// Where it is.
    pub point: Point3<f64>,
    /// The normal of the surface.
    pub normal: Vector3<f64>,
    /// The fewest hops to it; `None`: not reached.
    pub hops: Option<u64>,
    /// Whether the start is reached from it, where that was asked for.
    pub returns: Option<bool>,
}

/// What is reached over a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshReachFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// From where the oblique view is.
    pub seen_from: SeenFrom,
    /// The plan view leaves out what lies higher, m; `None`: just over the highest contact that is reached.
    pub cut_z_m: Option<f64>,
    /// The start.
    pub start: Point3<f64>,
    /// The goal, and the fewest hops to it; `None`: not reached.
    pub goal: (Point3<f64>, Option<u64>),
    /// The contacts, the start among them.
    pub contacts: &'a [ReachedContact],
    /// The mean distance of contacts, m: the root of the area for each.
    pub spacing_m: f64,
    /// The greatest number of hops, if the search ended there with contacts left.
    pub searched_to: Option<u64>,
}

/// Draws the hops to contacts all over a mesh: each place has the colour of the contact nearest to it on ground that faces a similar way, at
/// most six bands of hops; grey: not reached over these contacts, with stripes if it was not searched so far; stripes over a band: reached,
/// but no way back was found; white: no contact nearby.
///
/// # Errors
/// [`FigureError::NoGround`] without contacts.
pub fn draw_mesh_reach(figure: &MeshReachFigure<'_>) -> Result<Picture, FigureError> {
    let mut points = figure.contacts.iter().map(|contact| contact.point.coords);
    let Some(first) = points.next() else {
        return Err(FigureError::NoGround { what: "the contacts".to_owned(), points: 0 });
    };
    let (low, high) = points.fold((first, first), |(low, high), point| (low.inf(&point), high.sup(&point)));
    let most = figure.contacts.iter().filter_map(|contact| contact.hops).max().unwrap_or(0);
    let classes = HopClasses::up_to(most.max(1));
    let mut colours: Vec<RGBColor> = (0..classes.0.len()).map(|class| classes.colour(class)).collect();
    colours.push(NOT_REACHED);
    let paint = Paint::new(figure.painted(&classes), figure.spacing_m, (&colours, WHITE));

    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let top_mm = keys::draw(&mut sheet, &figure.entries(&classes, &colours), head_mm + 2.0) + 7.0;
    let corners = [low, high].into_iter().flat_map(|a| [low, high].map(|b| Point3::new(a.x, b.y, a.z)));
    let shown: Vec<Point3<f64>> = figure.contacts.iter().map(|contact| contact.point).chain(corners).collect();
    let seen = |cut_z_m| Oblique::around(figure.mesh, figure.seen_from, (shown.iter(), (high - low).amax()), cut_z_m, top_mm);
    let cut_z_m = figure.cut_z_m(high - low);
    let (mut oblique, mut text) = (seen(None), COLOURS.to_owned());
    if figure.hides_most(&oblique) {
        oblique = seen(Some(cut_z_m));
        let _ = write!(text, " What lies higher than {} m hides most of what is reached, and is left out.", short(cut_z_m));
    }
    oblique.seen.paint(figure.mesh, &oblique.view, &paint);
    let ends = [(figure.start, start_symbol as fn(&mut Sheet, _), "start"), (figure.goal.0, figure.goal_symbol(), "goal")];
    for (at, symbol, _) in &ends {
        symbol(&mut sheet, oblique.place(at));
    }
    for (at, _, name) in &ends {
        named(&mut sheet, oblique.place(at), name);
    }
    let end_mm = oblique.finish(&mut sheet, &text);
    let end_mm = figure.plan(&mut sheet, (low, high), (&paint, cut_z_m), end_mm + 2.0);
    Ok(Picture::page(sheet, end_mm + 2.5))
}

/// White, in a thin frame.
fn no_contact_symbol(sheet: &mut Sheet, (x, y): Place) {
    let corners = keys::rectangle((x - 3.0, y - 1.5), (x + 3.0, y + 1.5));
    sheet.line(corners.iter().copied().chain([corners[0]]).collect(), Pen { colour: NOT_REACHED, width_mm: 0.15 });
}

impl MeshReachFigure<'_> {
    /// The contacts with their classes: bands of hops, and one for those that are not reached.
    fn painted(&self, classes: &HopClasses) -> Vec<PaintedContact> {
        let class = |hops: Option<u64>| u8::try_from(hops.map_or(classes.0.len(), |hops| classes.of(hops))).unwrap_or(u8::MAX);
        let of = |contact: &ReachedContact| PaintedContact {
            point: contact.point,
            normal: contact.normal,
            class: class(contact.hops),
            striped: self.is_striped(contact),
        };
        self.contacts.iter().map(of).collect()
    }

    fn is_striped(&self, contact: &ReachedContact) -> bool {
        match contact.hops {
            Some(_) => contact.returns == Some(false),
            None => self.searched_to.is_some(),
        }
    }

    fn goal_symbol(&self) -> fn(&mut Sheet, (f64, f64)) {
        if self.goal.1.is_some() { goal_symbol } else { missed_symbol }
    }

    fn entries(&self, classes: &HopClasses, colours: &[RGBColor]) -> Vec<(Swatch, String)> {
        let goal = if self.goal.1.is_some() { "goal" } else { "goal, not reached" };
        let mut found = vec![
            (Swatch::Symbol(start_symbol as fn(&mut Sheet, _)), "start".to_owned()),
            (Swatch::Symbol(self.goal_symbol()), goal.to_owned()),
        ];
        let counted = |count: usize| format!("{count} contact{}", if count == 1 { "" } else { "s" });
        // The start has its symbol.
        let is_in = |hops: u64, class: usize| hops > 0 && classes.of(hops) == class;
        let of = |class: usize| self.contacts.iter().filter(|one| one.hops.is_some_and(|hops| is_in(hops, class))).count();
        for (class, (text, colour)) in classes.texts().iter().zip(colours).enumerate() {
            let count = of(class);
            if count > 0 {
                found.push((Swatch::Fill(*colour), format!("{text}: {}", counted(count))));
            }
        }
        let left = self.contacts.iter().filter(|contact| contact.hops.is_none()).count();
        if left > 0 {
            found.push(match self.searched_to {
                None => (Swatch::Fill(NOT_REACHED), format!("not reached over these contacts: {}", counted(left))),
                Some(most) => {
                    let hops = if most == 1 { "hop" } else { "hops" };
                    (Swatch::Striped(NOT_REACHED), format!("not within {most} {hops}, not searched beyond: {}", counted(left)))
                }
            });
        }
        let one_way = self.contacts.iter().filter(|contact| contact.hops.is_some() && self.is_striped(contact)).count();
        if self.contacts.iter().any(|contact| contact.returns.is_some()) {
            found.push((Swatch::Striped(colours[0]), format!("reached, no way back found: {}", counted(one_way))));
        }
        found.push((Swatch::Symbol(no_contact_symbol), "no contact nearby".to_owned()));
        found
    }

    /// What lies higher is left out, m: just over the highest contact that is reached.
    fn cut_z_m(&self, size: Vector3<f64>) -> f64 {
        let reached = self.contacts.iter().filter(|contact| contact.hops.is_some()).map(|contact| contact.point.z);
        let highest_m = reached.chain([self.start.z]).fold(f64::NEG_INFINITY, f64::max);
        self.cut_z_m.unwrap_or(highest_m + beside_m(size))
    }

    /// Whether most of the contacts that are reached are behind other facets.
    fn hides_most(&self, oblique: &Oblique) -> bool {
        let reached = || self.contacts.iter().filter(|contact| contact.hops.is_some());
        let hidden = reached().filter(|contact| oblique.seen.hides(oblique.view.of(&contact.point))).count();
        2 * hidden > reached().count()
    }

    /// The plan view; returns where it ends.
    fn plan(
        &self,
        sheet: &mut Sheet,
        (low, high): (Vector3<f64>, Vector3<f64>),
        (paint, cut_z_m): (&Paint, f64),
        top_mm: f64,
    ) -> f64 {
        let beside_m = beside_m(high - low);
        let corner = |at: Vector3<f64>, by_m: f64| MapPoint::new(at.x + by_m, at.y + by_m);
        let plan = MeshPlan {
            mesh: self.mesh,
            bounds: MapBounds { min: corner(low, -beside_m), max: corner(high, beside_m) },
            cut_z_m,
            low_z_m: low.z,
            paths: Vec::new(),
            start: self.start.xy(),
            goal: self.goal.0.xy(),
            goal_hops: self.goal.1,
            paint: Some(paint),
        };
        draw_mesh_plan(sheet, &plan, top_mm)
    }
}

/// Room beside what is shown: a level plate has no height, and a straight line of contacts no width.
fn beside_m(size: Vector3<f64>) -> f64 {
    let size_m = size.amax();
    0.02 * if size_m > 0.0 { size_m } else { 1.0 }
}
