//! The picture of one hop over a mesh: the cut of its vertical plane, the family of arcs, and the arcs that facets block.

use super::{
    Caption, FigureError, Picture,
    axes::{BELOW_MM, Panel},
    keys::{self, Swatch},
    palette::{BLUE, ORANGE, SKY, VERMILION},
    scale::Frame,
    sheet::{Pen, Place, Sheet},
    symbols,
    terrain_panel::{axes, laid_out, parabola},
};
use crate::{
    ballistics::LineOfSight,
    quantity::{ChainPoint, SlopeInterval},
};

/// The picture of one hop over a mesh. Points are horizontal distance from the take-off and height, m.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshHopFigure {
    /// The caption.
    pub caption: Caption,
    /// The segments in which facets meet the plane.
    pub cut: Vec<[ChainPoint; 2]>,
    /// Those of them that bound the windows.
    pub bounds: Vec<[ChainPoint; 2]>,
    /// The height of the take-off, m.
    pub takeoff_z_m: f64,
    /// The line of sight.
    pub sight: LineOfSight,
    /// The lofts that all limits but the terrain between the contacts leave; `None` if they leave none.
    pub allowed: Option<SlopeInterval>,
    /// The lofts that facets block.
    pub blocked: Vec<SlopeInterval>,
    /// The windows.
    pub windows: Vec<SlopeInterval>,
    /// The loft to fly.
    pub best: Option<f64>,
}

/// The part of the plane beyond either contact that is shown, as a share of the hop's length.
const BEYOND: f64 = 0.15;
/// Arcs drawn in a window and in a blocked interval, ends included.
const ARCS: u32 = 6;
/// The steepest arc that is drawn where no limit ends the steep ones: its loft over that of least speed.
const STEEPEST: f64 = 3.0;
/// Heights below and above the hop that are shown, as a share of its length.
const MARGIN: f64 = 0.25;

const FREE_PEN: Pen = Pen { colour: BLUE, width_mm: 0.15 };
const BEST_PEN: Pen = Pen { colour: BLUE, width_mm: 0.55 };
const BLOCKED_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.15 };
const DASHES_MM: (f64, f64) = (1.0, 0.8);
const BOUND_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.8 };

/// Draws one hop over a mesh.
///
/// # Errors
/// [`FigureError::NoGround`] if the plane meets no facet.
pub fn draw_mesh_hop(figure: &MeshHopFigure) -> Result<Picture, FigureError> {
    if figure.cut.is_empty() {
        return Err(FigureError::NoGround { what: "the hop".to_owned(), points: 0 });
    }
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let top_mm = keys::draw(&mut sheet, &entries(figure), head_mm + 2.0) + 3.0;
    let drawn = Drawn::new(figure, top_mm);
    axes(&mut sheet, &drawn.panel, &drawn.frame, "distance from the take-off (m)", "height, z (m)");
    drawn.family(&mut sheet);
    for segment in &figure.cut {
        drawn.segment(&mut sheet, *segment, symbols::SURFACE_PEN);
    }
    for segment in &figure.bounds {
        drawn.segment(&mut sheet, *segment, BOUND_PEN);
    }
    if let Some(loft) = figure.best {
        sheet.line(drawn.arc(loft), BEST_PEN);
    }
    symbols::takeoff(&mut sheet, drawn.frame.place(figure.at(0.0, 0.0)));
    symbols::landing(&mut sheet, drawn.frame.place(figure.at(1.0, 0.0)));
    drawn.panel.outline(&mut sheet);
    Ok(Picture::page(sheet, drawn.panel.bottom + BELOW_MM + 2.5))
}

/// The legend, with what occurs.
fn entries(figure: &MeshHopFigure) -> Vec<(Swatch, String)> {
    let mut found = vec![(Swatch::Line(symbols::SURFACE_PEN), "facets in the plane of the hop".to_owned())];
    if !figure.windows.is_empty() {
        found.push((Swatch::Line(FREE_PEN), "feasible arcs".to_owned()));
    }
    if figure.best.is_some() {
        found.push((Swatch::Line(BEST_PEN), "the arc to fly".to_owned()));
    }
    if figure.blocked_and_allowed().next().is_some() {
        found.push((Swatch::Dashed(BLOCKED_PEN, DASHES_MM.0, DASHES_MM.1), "arcs that facets block".to_owned()));
    }
    if !figure.bounds.is_empty() {
        found.push((Swatch::Line(BOUND_PEN), "facets that bound the windows".to_owned()));
    }
    found.push((Swatch::Symbol(symbols::takeoff), "take-off".to_owned()));
    found.push((Swatch::Symbol(symbols::landing), "landing".to_owned()));
    found
}

impl MeshHopFigure {
    /// A point of the arc of a loft, at a share of the hop's length.
    fn at(&self, share: f64, loft: f64) -> ChainPoint {
        let d_m = share * self.sight.run_m();
        ChainPoint::new(d_m, self.takeoff_z_m + d_m * (self.sight.slope() + loft * (1.0 - share)))
    }

    /// The steepest loft that is drawn.
    fn steepest(&self) -> f64 {
        let of_limits = self.allowed.map_or(0.0, |allowed| allowed.upper);
        let most = STEEPEST * self.sight.secant();
        let best = self.best.unwrap_or(0.0);
        if of_limits.is_finite() && of_limits > 0.0 { of_limits.min(most.max(best)) } else { most.max(best) }
    }

    /// The parts of the blocked lofts that the other limits allow.
    fn blocked_and_allowed(&self) -> impl Iterator<Item = SlopeInterval> + '_ {
        let within = self.allowed.unwrap_or(SlopeInterval { lower: 0.0, upper: f64::INFINITY });
        let shown = SlopeInterval { lower: within.lower.max(0.0), upper: within.upper.min(self.steepest()) };
        self.blocked.iter().map(move |blocked| blocked.intersect(shown)).filter(|part| part.lower < part.upper)
    }
}

/// The panel of a figure.
struct Drawn<'a> {
    figure: &'a MeshHopFigure,
    panel: Panel,
    frame: Frame,
}

impl<'a> Drawn<'a> {
    fn new(figure: &'a MeshHopFigure, top_mm: f64) -> Self {
        let run_m = figure.sight.run_m();
        let view_m = (-BEYOND * run_m, (1.0 + BEYOND) * run_m);
        let arcs = (0..=32).map(|i| figure.at(f64::from(i) / 32.0, figure.steepest()).z_m);
        let (low_m, high_m) = arcs
            .chain([figure.at(0.0, 0.0).z_m, figure.at(1.0, 0.0).z_m])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)));
        let (low_m, high_m) = (low_m - MARGIN * run_m, high_m + MARGIN * run_m);
        let (panel, frame) = laid_out(view_m, (low_m, high_m), (0.0, 0.0), top_mm);
        Self { figure, panel, frame }
    }

    /// An arc on the sheet.
    fn arc(&self, loft: f64) -> Vec<Place> {
        parabola(&self.frame, loft * self.figure.sight.run_m(), |share| self.figure.at(share, loft))
    }

    /// The bands of windows and of blocked arcs, with some arcs of each.
    fn family(&self, sheet: &mut Sheet) {
        let steepest = self.figure.steepest();
        for blocked in self.figure.blocked_and_allowed() {
            self.band(sheet, blocked, ORANGE);
            self.members(blocked, |arc| sheet.dashed(&arc, DASHES_MM.0, DASHES_MM.1, BLOCKED_PEN));
        }
        for window in &self.figure.windows {
            let shown = SlopeInterval { lower: window.lower.max(0.0), upper: window.upper.min(steepest.max(window.lower)) };
            self.band(sheet, shown, SKY);
            self.members(shown, |arc| sheet.line(arc, FREE_PEN));
        }
    }

    /// The region between two arcs.
    fn band(&self, sheet: &mut Sheet, lofts: SlopeInterval, colour: plotters::style::RGBColor) {
        let mut outline = self.arc(lofts.lower);
        outline.extend(self.arc(lofts.upper).into_iter().rev());
        sheet.area(outline, colour, 0.22);
    }

    /// Arcs of an interval, evenly by loft.
    fn members(&self, lofts: SlopeInterval, mut draw: impl FnMut(Vec<Place>)) {
        for i in 0..ARCS {
            let share = f64::from(i) / f64::from(ARCS - 1);
            draw(self.arc(lofts.lower + share * (lofts.upper - lofts.lower)));
        }
    }

    /// The part of a segment inside the panel.
    fn segment(&self, sheet: &mut Sheet, ends: [ChainPoint; 2], pen: Pen) {
        let [from, to] = ends.map(|end| self.frame.place(end));
        if let Some(part) = inside(&self.panel, from, to) {
            sheet.line(part.to_vec(), pen);
        }
    }
}

/// The part of a line inside a panel; `None` if it misses the panel.
fn inside(panel: &Panel, from: Place, to: Place) -> Option<[Place; 2]> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (run, room) in
        [(-dx, from.0 - panel.left), (dx, panel.right - from.0), (-dy, from.1 - panel.top), (dy, panel.bottom - from.1)]
    {
        if run == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if run < 0.0 {
            first = first.max(room / run);
        } else {
            last = last.min(room / run);
        }
    }
    let at = |share: f64| (from.0 + share * dx, from.1 + share * dy);
    (first <= last).then(|| [at(first), at(last)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_to_the_panel() {
        let panel = Panel { left: 0.0, top: 0.0, right: 10.0, bottom: 4.0 };
        assert_eq!(inside(&panel, (-5.0, 2.0), (15.0, 2.0)), Some([(0.0, 2.0), (10.0, 2.0)]));
        assert_eq!(inside(&panel, (2.0, -4.0), (2.0, 2.0)), Some([(2.0, 0.0), (2.0, 2.0)]));
        assert_eq!(inside(&panel, (3.0, 1.0), (4.0, 2.0)), Some([(3.0, 1.0), (4.0, 2.0)]));
        assert_eq!(inside(&panel, (-5.0, -1.0), (15.0, -1.0)), None);
        assert_eq!(inside(&panel, (-3.0, 2.0), (2.0, -3.0)), None);
    }

    /// A bar over level ground: the picture names what it shows, and the arc to fly goes through the drawn apex.
    #[test]
    fn windows_blocked_arcs_and_the_cut_are_drawn_and_named() {
        let level = [ChainPoint::new(-1.0, 0.0), ChainPoint::new(5.0, 0.0)];
        let bar = [ChainPoint::new(1.5, 1.0), ChainPoint::new(2.5, 1.0)];
        let interval = |lower, upper| SlopeInterval { lower, upper };
        let mut figure = MeshHopFigure {
            caption: Caption::new("A bar", "blocked from 1 to 1.07"),
            cut: vec![level, bar],
            bounds: vec![bar],
            takeoff_z_m: 0.0,
            sight: LineOfSight::new(4.0, 0.0),
            allowed: Some(interval(0.5, 2.0)),
            blocked: vec![interval(1.0, 1.0667)],
            windows: vec![interval(0.5, 1.0), interval(1.0667, 2.0)],
            best: Some(1.0),
        };
        let svg = draw_mesh_hop(&figure).unwrap().to_svg().unwrap();
        for text in ["feasible arcs", "arcs that facets block", "facets that bound the windows", "the arc to fly", "A bar"] {
            assert!(svg.contains(text), "{text}");
        }
        figure.windows.clear();
        figure.bounds.clear();
        figure.best = None;
        let svg = draw_mesh_hop(&figure).unwrap().to_svg().unwrap();
        assert!(!svg.contains("feasible arcs") && !svg.contains("the arc to fly"));
        figure.cut.clear();
        assert!(draw_mesh_hop(&figure).is_err());
    }
}
