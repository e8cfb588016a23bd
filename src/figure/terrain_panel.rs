//! The first panel: the ground with the hops over it, or with the obstacle of the journey.

use super::{
    axes::{BELOW_MM, Panel, left_room_mm},
    clearance,
    data::{FigureData, HopFigure, StoppedFigure, Subject},
    palette::{AXIS, BLACK, GROUND, LEFT_MM, PURPLE, RIGHT_MM, SMALL_MM, VERMILION},
    scale::{DRAWN_MM, Frame, Scale},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm},
    spans::{GroundUse, stretch},
    symbols,
    ticks::{Ticks, one_in, short},
    touchdown,
};
use crate::{chain::ConstrainedChain, quantity::ChainPoint};

/// Room above the highest point, for hop numbers and cones.
const ABOVE_MM: f64 = 8.0;
/// Ground drawn below the lowest point, for start, goal and hatching.
const DEPTH_MM: f64 = 9.5;
/// Room beside an end of the chain.
pub(super) const BESIDE_MM: f64 = 3.0;
/// Smallest spacing of the numbers of the height axis.
const TICK_MM: f64 = 6.5;
/// Width of the columns in which only the lowest and the highest ground are drawn.
const COLUMN_MM: f64 = 0.08;
/// The least length of a stretch of ground on the sheet.
const LEAST_MM: f64 = 1.0;
/// Bends of the line.
const BEND_PEN: Pen = Pen { colour: PURPLE, width_mm: 0.25 };
/// Hops of a smaller median width have neither cones nor rings at their landings.
const NARROW_MM: f64 = 2.6;
/// Greatest deviation of a drawn flight from the parabola.
const FLATNESS_MM: f64 = 0.008;

/// The panel: its position on the sheet and its scale.
pub(super) struct TerrainPanel<'a> {
    data: &'a FigureData,
    chain: &'a ConstrainedChain,
    panel: Panel,
    frame: Frame,
}

/// The marks of hops that a panel has; those of very narrow hops would cover each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DrawnMarks {
    /// Cones at take-offs and landings.
    pub(super) cones: bool,
    /// Rings at landings.
    pub(super) landings: bool,
}

impl<'a> TerrainPanel<'a> {
    /// Lays out the panel below a height of the sheet.
    pub(super) fn new(data: &'a FigureData, chain: &'a ConstrainedChain, top_mm: f64) -> Self {
        // A margin beyond the ends of the chain leaves room for markers at the ends.
        let beside = |seen: f64, end: f64| if seen == end { BESIDE_MM } else { 0.0 };
        let sides_mm = (beside(data.view_x_m.0, data.chain_x_m.0), beside(data.view_x_m.1, data.chain_x_m.1));
        let (panel, frame) = laid_out(data.view_x_m, heights(data, chain), sides_mm, top_mm);
        Self { data, chain, panel, frame }
    }

    /// Draws it; returns where it ends, including the axis.
    pub(super) fn draw(&self, sheet: &mut Sheet) -> f64 {
        self.axes(sheet);
        self.ground(sheet);
        match &self.data.subject {
            Subject::Path { hops, .. } => self.hops(sheet, &hops.shown),
            Subject::Stopped(stop) => self.stop(sheet, stop),
            Subject::NoCommands(..) | Subject::RouteNotFound => {}
            Subject::EndpointsRefuse(refusals) => {
                for refusal in refusals {
                    symbols::cross(sheet, self.frame.place(refusal.station.point));
                    if let Some(nearest) = refusal.nearest {
                        symbols::usable(sheet, self.frame.place(nearest.point));
                    }
                }
            }
        }
        self.bends(sheet);
        self.end(sheet, self.data.start, "start");
        self.end(sheet, self.data.goal, "goal");
        self.panel.outline(sheet);
        self.panel.bottom + BELOW_MM
    }

    /// Axes with the statement of the scale.
    fn axes(&self, sheet: &mut Sheet) {
        let (from, to) = self.data.chain_x_m;
        let cut =
            if self.data.is_cut() { format!("; part of a chain from {} to {} m", short(from), short(to)) } else { String::new() };
        let along = format!("distance along the {}, x (m){cut}", self.data.along);
        axes(sheet, &self.panel, &self.frame, &along, "height, z (m)");
    }

    /// The profile with its nodes and the uses of its stretches.
    fn ground(&self, sheet: &mut Sheet) {
        let surface = self.surface(self.data.view_x_m.0, self.data.view_x_m.1);
        if let (Some(&first), Some(&last)) = (surface.first(), surface.last()) {
            let base = [(last.0, self.panel.bottom), (first.0, self.panel.bottom)];
            sheet.area(surface.iter().copied().chain(base).collect(), GROUND, 1.0);
        }
        sheet.line(surface, symbols::SURFACE_PEN);
        for span in self.data.spans.iter().filter(|span| span.allows != GroundUse::Both) {
            // A stretch too short to be seen is drawn longer than it is: the legend has only what is drawn.
            let spare_m = (0.5 * (LEAST_MM / self.frame.scale.mm_per_m - (span.to_x_m - span.from_x_m))).max(0.0);
            let (from, to) = self.data.view_x_m;
            symbols::ground(
                sheet,
                &self.surface((span.from_x_m - spare_m).max(from), (span.to_x_m + spare_m).min(to)),
                span.allows,
            );
        }
        for &node in &self.data.nodes.shown {
            symbols::node(sheet, self.frame.place(node));
        }
    }

    /// The ground between two x on the sheet, thinned to the drawing resolution.
    fn surface(&self, from_x_m: f64, to_x_m: f64) -> Vec<Place> {
        thinned(&stretch(self.chain, from_x_m, to_x_m).into_iter().map(|point| self.frame.place(point)).collect::<Vec<_>>())
    }

    /// Cones, flights, contacts and numbers, in this order from back to front.
    fn hops(&self, sheet: &mut Sheet, hops: &[HopFigure]) {
        let (frame, median_mm, marks) = (&self.frame, self.median_mm(hops), self.marks());
        let length_mm = (0.3 * median_mm.unwrap_or(0.0)).clamp(1.6, 7.5);
        if self.data.clearance.has_kinks() {
            for hop in hops.iter().filter(|hop| !hop.hop.is_beside_line()) {
                self.clearance(sheet, hop);
            }
        }
        for cone in hops.iter().filter(|_| marks.cones).flat_map(|hop| hop.cones.iter().flatten()) {
            symbols::cone(sheet, frame, cone, length_mm);
        }
        for hop in hops {
            symbols::flight(sheet, flight(frame, hop), hop.hop.direction);
        }
        for hop in hops {
            symbols::takeoff(sheet, frame.place(hop.hop.takeoff.in_profile()));
            if marks.landings {
                symbols::landing(sheet, frame.place(hop.hop.landing.in_profile()));
            }
            if hop.touchdown_m_s.is_some() {
                touchdown::arrow(sheet, frame.place(hop.hop.landing.in_profile()));
            }
        }
        let widest = hops.last().map_or(0.0, |hop| text_width_mm(&hop.number.to_string(), SMALL_MM));
        let every = one_in((widest + 1.2) / median_mm.unwrap_or(1.0));
        for hop in hops.iter().step_by(every) {
            self.number(sheet, hop);
        }
        // After the numbers, which it would take the place of.
        if let Some((speed_m_s, hop)) = hops.first().and_then(|hop| hop.touchdown_m_s.zip(Some(hop))) {
            touchdown::speed(sheet, frame.place(hop.hop.landing.in_profile()), speed_m_s);
        }
    }

    /// The median width of hops on the sheet; `None` without hops.
    fn median_mm(&self, hops: &[HopFigure]) -> Option<f64> {
        let mut lengths: Vec<f64> = hops.iter().map(|hop| hop.arc.line_of_sight().run_m() * self.frame.scale.mm_per_m).collect();
        lengths.sort_by(f64::total_cmp);
        lengths.get(lengths.len() / 2).copied()
    }

    /// The marks of hops for which there is room.
    pub(super) fn marks(&self) -> DrawnMarks {
        let Subject::Path { hops, .. } = &self.data.subject else { return DrawnMarks { cones: false, landings: false } };
        let is_wide = self.median_mm(&hops.shown).is_none_or(|median_mm| median_mm >= NARROW_MM);
        DrawnMarks { cones: is_wide, landings: is_wide }
    }

    /// The clearance that a hop keeps over the ground.
    fn clearance(&self, sheet: &mut Sheet, hop: &HopFigure) {
        let (a, b) = (hop.hop.takeoff.along_m, hop.hop.landing.along_m);
        let ground = stretch(self.chain, a.min(b), a.max(b));
        let place = |points: &[ChainPoint]| thinned(&points.iter().map(|&point| self.frame.place(point)).collect::<Vec<_>>());
        clearance::band(sheet, &place(&clearance::raised(&ground, self.data.clearance)), &place(&ground));
    }

    /// The number of a hop above its highest point, or beside it if that position is taken; omitted without room.
    fn number(&self, sheet: &mut Sheet, hop: &HopFigure) {
        let apex = (0.5 * hop.arc.takeoff_slope() / hop.arc.loft()).clamp(0.1, 0.9);
        let free = [apex, apex - 0.12, apex + 0.12, apex - 0.25, apex + 0.25].into_iter().find_map(|share| {
            let (x, y) = self.frame.place(hop.point_at(share.clamp(0.05, 0.95)));
            let label = Label::new(hop.number.to_string(), (x, y - 0.8), SMALL_MM).hung(Anchor::Middle, Hang::Above);
            (!sheet.is_taken(&label)).then_some(label)
        });
        if let Some(label) = free {
            sheet.label(label);
        }
    }

    /// The stretches reachable from the start or leading to the goal, the gap and the nearest miss.
    fn stop(&self, sheet: &mut Sheet, stop: &StoppedFigure) {
        for (runs, from_start) in [(&stop.leads_to_goal_x_m, false), (&stop.reached_x_m, true)] {
            for &(from_x_m, to_x_m) in runs {
                let half_m = 0.6 / self.frame.scale.mm_per_m;
                let (from, to) = if to_x_m - from_x_m < 2.0 * half_m {
                    let middle = 0.5 * (from_x_m + to_x_m);
                    ((middle - half_m).max(self.data.view_x_m.0), (middle + half_m).min(self.data.view_x_m.1))
                } else {
                    (from_x_m, to_x_m)
                };
                symbols::band(sheet, &self.surface(from, to), from_start);
            }
        }
        if let Some((from, to, _)) = &stop.nearest_miss {
            symbols::nearest_miss(sheet, &[self.frame.place(*from), self.frame.place(*to)]);
        }
        let (reached, leads) = stop.gap;
        let towards = (self.data.goal.x_m - self.data.start.x_m).signum();
        let gap_m = (leads.x_m - reached.x_m) * towards;
        if gap_m > 0.0 {
            gap(sheet, &self.panel, [self.frame.place(reached), self.frame.place(leads)], gap_m);
        }
    }

    /// The bends of the line, with their numbers where there is room.
    fn bends(&self, sheet: &mut Sheet) {
        for (number, point) in (1..).zip(&self.data.bends) {
            let (x, y) = self.frame.place(*point);
            sheet.dashed(&[(x, self.panel.top), (x, y)], 1.2, 0.8, BEND_PEN);
            let text = if self.data.bends.len() > 1 { format!("bend {number}") } else { "bend".to_owned() };
            let label = Label::new(text, (x + 0.8, self.panel.top + 1.8), SMALL_MM);
            let (.., right, _) = label.bounds_mm();
            if right < self.panel.right && !sheet.is_taken(&label) {
                sheet.label(label);
            }
        }
    }

    /// Start or goal.
    fn end(&self, sheet: &mut Sheet, point: ChainPoint, name: &str) {
        pin(sheet, &self.panel, self.frame.place(point), name, |label| self.is_buried(label));
    }

    /// Whether a text lies in the drawn ground.
    fn is_buried(&self, label: &Label) -> bool {
        let (left, top, right, _) = label.bounds_mm();
        let (first, last) = self.data.view_x_m;
        left >= self.panel.left
            && right <= self.panel.right
            && [left, right].into_iter().all(|x_mm| {
                let ground = self.chain.geometry().station(self.frame.x_m(x_mm).clamp(first, last));
                ground.is_ok_and(|station| self.frame.place(station.point).1 <= top)
            })
    }
}

/// Panel and scale for a range of x, a range of heights and margins at the two sides, below a height of the sheet.
pub(super) fn laid_out(view_x_m: (f64, f64), heights_m: (f64, f64), sides_mm: (f64, f64), top_mm: f64) -> (Panel, Frame) {
    laid_out_within(view_x_m, heights_m, sides_mm, top_mm, DRAWN_MM)
}

/// The same with other bounds of the drawn height: the least and the greatest, mm.
pub(super) fn laid_out_within(
    view_x_m: (f64, f64),
    heights_m: (f64, f64),
    sides_mm: (f64, f64),
    top_mm: f64,
    drawn_mm: (f64, f64),
) -> (Panel, Frame) {
    let ((low_m, high_m), (before, after)) = (heights_m, sides_mm);
    let length_m = view_x_m.1 - view_x_m.0;
    // The width of the axis numbers sets the panel's left edge, and depends on the panel's scale: one estimate of it is enough.
    let guess = Scale::within(length_m, high_m - low_m, RIGHT_MM - LEFT_MM, drawn_mm);
    let left = LEFT_MM.max(1.0 + left_room_mm(&height_ticks(&guess, low_m, high_m)));
    let scale = Scale::within(length_m, high_m - low_m, RIGHT_MM - left - before - after, drawn_mm);
    let panel = Panel { left, top: top_mm, right: RIGHT_MM, bottom: top_mm + ABOVE_MM + scale.height_mm + DEPTH_MM };
    let frame = Frame {
        scale,
        origin: ChainPoint::new(0.5 * (view_x_m.0 + view_x_m.1), low_m),
        place: (0.5 * (panel.left + before + panel.right - after), panel.bottom - DEPTH_MM),
    };
    (panel, frame)
}

/// Both axes with round numbers; the lower one states the scale.
pub(super) fn axes(sheet: &mut Sheet, panel: &Panel, frame: &Frame, x_name: &str, y_name: &str) {
    named_axes(sheet, panel, frame, &format!("{x_name}; {}", frame.scale.text()), y_name);
}

/// Both axes with round numbers and names.
pub(super) fn named_axes(sheet: &mut Sheet, panel: &Panel, frame: &Frame, x_name: &str, y_name: &str) {
    let along = Ticks::round(frame.x_m(panel.left), frame.x_m(panel.right), panel.width() / 16.0);
    let along_widest = text_width_mm(&along.longest(), SMALL_MM) + 3.0;
    let along = Ticks::round(frame.x_m(panel.left), frame.x_m(panel.right), panel.width() / along_widest.max(16.0));
    let at = |x_m: f64| frame.place(ChainPoint::new(x_m, frame.origin.z_m)).0;
    let ticks: Vec<_> = along.values.iter().map(|&x_m| (at(x_m), along.text(x_m))).collect();
    panel.x_axis(sheet, &ticks, x_name, true);
    let up = Ticks::round(frame.z_m(panel.bottom), frame.z_m(panel.top), panel.height() / TICK_MM);
    let ticks: Vec<_> =
        up.values.iter().map(|&z_m| (frame.place(ChainPoint::new(frame.origin.x_m, z_m)).1, up.text(z_m))).collect();
    panel.y_axis(sheet, &ticks, y_name, true);
}

/// A measured distance at the top of a panel.
pub(super) fn gap(sheet: &mut Sheet, panel: &Panel, [a, b]: [Place; 2], gap_m: f64) {
    let pen = Pen { colour: BLACK, width_mm: 0.2 };
    let y = panel.top + 5.0;
    sheet.area(vec![(a.0, panel.top), (b.0, panel.top), (b.0, panel.bottom), (a.0, panel.bottom)], VERMILION, 0.1);
    for (x, down) in [a, b] {
        sheet.dashed(&[(x, y - 1.0), (x, down)], 0.7, 0.7, Pen { colour: AXIS, width_mm: 0.15 });
    }
    sheet.line(vec![(a.0, y), (b.0, y)], pen);
    let text = format!("gap {} m", short(gap_m));
    let half = 0.5 * text_width_mm(&text, SMALL_MM);
    let x = (0.5 * (a.0 + b.0)).min(panel.right - half - 1.0).max(panel.left + half + 1.0);
    sheet.label(Label::new(text, (x, y - 1.2), SMALL_MM).hung(Anchor::Middle, Hang::Above));
}

/// Start or goal: a pin in the ground with its name below or, where the ground falls away, beside it; without a name if there is no
/// room.
pub(super) fn pin(sheet: &mut Sheet, panel: &Panel, (x, y): Place, name: &str, is_buried: impl Fn(&Label) -> bool) {
    sheet.area(vec![(x, y + 0.4), (x - 1.2, y + 3.0), (x + 1.2, y + 3.0)], BLACK, 1.0);
    let half = 0.5 * text_width_mm(name, SMALL_MM) + 0.8;
    let middle = x.min(panel.right - half).max(panel.left + half);
    let hung = |at, anchor| Label { bold: true, ..Label::new(name, at, SMALL_MM).hung(anchor, Hang::Below) };
    let below = hung((middle, y + 3.5), Anchor::Middle);
    let beside = [hung((x + 2.2, y + 2.2), Anchor::Start), hung((x - 2.2, y + 2.2), Anchor::End)];
    let lower = hung((middle, y + 3.8 + SMALL_MM), Anchor::Middle);
    let places = [&below, &beside[0], &beside[1], &lower];
    let buried = places.into_iter().find(|label| is_buried(label) && !sheet.is_taken(label));
    let free = buried.or_else(|| places.into_iter().find(|label| !sheet.is_taken(label)));
    if let Some(label) = free {
        sheet.label(label.clone());
    }
}

/// The lowest and the highest of ground and flights in view, m.
fn heights(data: &FigureData, chain: &ConstrainedChain) -> (f64, f64) {
    let ground = stretch(chain, data.view_x_m.0, data.view_x_m.1).into_iter().map(|point| point.z_m);
    let flights = match &data.subject {
        Subject::Path { hops, .. } => hops.shown.as_slice(),
        Subject::Stopped(_) | Subject::NoCommands(..) | Subject::EndpointsRefuse(_) | Subject::RouteNotFound => &[],
    };
    ground
        .chain(flights.iter().map(|hop| hop.hop.apex_z_m))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)))
}

/// The numbers of the height axis for a scale.
fn height_ticks(scale: &Scale, low_m: f64, high_m: f64) -> Ticks {
    let per_mm = 1.0 / (scale.mm_per_m * scale.exaggeration);
    let (from, to) = (low_m - DEPTH_MM * per_mm, high_m + ABOVE_MM * per_mm);
    Ticks::round(from, to, (to - from) / per_mm / TICK_MM)
}

/// A flight on the sheet.
fn flight(frame: &Frame, hop: &HopFigure) -> Vec<Place> {
    parabola(frame, hop.arc.loft() * hop.arc.line_of_sight().run_m(), |share| hop.point_at(share))
}

/// A parabola on the sheet, with as many points as its curvature needs. Given are its loft times its length, m, and a function for
/// its point at a fraction of the length.
pub(super) fn parabola(frame: &Frame, lift_m: f64, point_at: impl Fn(f64) -> ChainPoint) -> Vec<Place> {
    // The sagitta of one of N pieces of the parabola is n X / (4 N^2).
    let bow_mm = 0.25 * lift_m * frame.scale.mm_per_m * frame.scale.exaggeration;
    let pieces = (bow_mm / FLATNESS_MM).sqrt().ceil().clamp(8.0, 160.0);
    let mut points = Vec::new();
    let mut i = 0.0;
    while i <= pieces {
        points.push(frame.place(point_at(i / pieces)));
        i += 1.0;
    }
    points
}

/// A line from left to right, reduced to the first, lowest, highest and last point in each narrow column.
pub(super) fn thinned(points: &[Place]) -> Vec<Place> {
    let mut kept: Vec<Place> = Vec::new();
    let column = |place: &Place| (place.0 / COLUMN_MM).floor();
    for group in points.chunk_by(|a, b| column(a) == column(b)) {
        if group.len() <= 4 {
            kept.extend(group);
            continue;
        }
        let by_height = |a: &&Place, b: &&Place| a.1.total_cmp(&b.1);
        let (high, low) = (group.iter().min_by(by_height), group.iter().max_by(by_height));
        let mut four: Vec<Place> = [group.first(), high, low, group.last()].into_iter().flatten().copied().collect();
        four.sort_by(|a, b| a.0.total_cmp(&b.0));
        kept.extend(four);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_extremes_and_ends() {
        let points: Vec<Place> = (0..10_000).map(|i| (f64::from(i) * 1e-3, f64::from(i % 7))).collect();
        let kept = thinned(&points);
        assert!(kept.len() < 600, "{}", kept.len());
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
        assert!(kept.is_sorted_by(|a, b| a.0 <= b.0));
        assert!(kept.iter().any(|p| p.1 == 0.0) && kept.iter().any(|p| p.1 == 6.0));
    }
}
