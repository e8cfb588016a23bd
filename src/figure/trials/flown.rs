//! Trajectories of trials over the profile, and below them the positions of the landings.
//!
//! ```text
//!   +-------------------------+   ground, trials (failed ones end in a cross), planned path on top
//!   |   .-.   .-.             |
//!   | _/   \_/   \___         |
//!   +-------------------------+
//!   |1    .:|:.               |   landings hop by hop: a dot each, the planned landing as a stroke
//!   |2           .:.|.:       |
//!   +-------------------------+
//! ```

use super::{
    super::{
        FigureError, Flight,
        axes::{BELOW_MM, Panel, left_room_mm},
        keys::Swatch,
        palette::{BLACK, BLUE, GROUND, LEFT_MM, ORANGE, RIGHT_MM, SKY, SMALL_MM, VERMILION, WHITE},
        scale::{Frame, Scale},
        sheet::{Pen, Place, Sheet, text_width_mm},
        symbols,
        terrain_panel::thinned,
        ticks::Ticks,
    },
    data::{FlownFigure, FlownTrial},
    diagram::{Axis, counted, number},
};
use crate::quantity::ChainPoint;

/// Room above the highest flight and below the lowest ground.
const ABOVE_MM: f64 = 4.0;
const DEPTH_MM: f64 = 5.0;
/// The least height of the panel, set by the name of its axis.
const LOWEST_MM: f64 = 24.0;
/// Room between trajectories and landings.
const GAP_MM: f64 = 2.0;
/// Height of one hop's row of landings, and the greatest height of all rows.
const ROW_MM: f64 = 4.2;
const ROWS_MM: f64 = 46.0;
/// Smallest spacing of the numbers of the height axis.
const TICK_MM: f64 = 6.5;
/// Margin of the view, as a fraction of the flown extent.
const BESIDE: f64 = 0.06;
/// Above this number of flights, or of points of drawn lines, only every n-th trial is drawn.
const MOST_FLIGHTS: usize = 400;
const MOST_POINTS: usize = 5000;
/// The greatest number of points of the planned path, and the greatest number of hops whose take-offs and landings are marked.
const MOST_PLANNED_POINTS: usize = 2500;
const MOST_MARKED_HOPS: usize = 60;
/// Above this number of landings only those of every n-th trial are drawn.
const MOST_LANDINGS: usize = 600;
/// A flight is drawn with so many chords at least, however many there are.
const LEAST_PIECES: f64 = 6.0;
/// Greatest deviation of a drawn flight from the parabola.
const FLATNESS_MM: f64 = 0.025;
/// The fractional part of the golden ratio, which spreads the dots of a row evenly and reproducibly.
const GOLDEN: f64 = 0.618_033_988_749_895;

const REACHED_PEN: Pen = Pen { colour: SKY, width_mm: 0.13 };
const FAILED_PEN: Pen = Pen { colour: ORANGE, width_mm: 0.13 };
const CASING_PEN: Pen = Pen { colour: WHITE, width_mm: 0.9 };
const PLANNED_PEN: Pen = Pen { colour: BLACK, width_mm: 0.4 };
const CROSS_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.25 };

/// Draws both panels below a height; returns where they end, and the legend.
pub(super) fn draw(sheet: &mut Sheet, flown: &FlownFigure, top_mm: f64) -> Result<(f64, Vec<(Swatch, String)>), FigureError> {
    let ground: Vec<ChainPoint> = flown.ground.iter().copied().filter(|p| p.x_m.is_finite() && p.z_m.is_finite()).collect();
    if !ground.windows(2).any(|pair| pair[0].x_m < pair[1].x_m) {
        return Err(FigureError::NoGround { what: "the trials".to_owned(), points: ground.len() });
    }
    let bundle = Bundle::new(flown);
    let view = View::new(&ground, &bundle, top_mm);
    view.axes(sheet);
    view.ground(sheet, &ground);
    view.trials(sheet, &bundle);
    view.planned(sheet, &bundle);
    view.landings(sheet, &bundle);
    view.panel.outline(sheet);
    if let Some(rows) = &view.rows {
        rows.panel.outline(sheet);
    }
    Ok((view.bottom_mm() + BELOW_MM, entries(flown, &bundle, &view)))
}

/// The drawn part of the trials.
struct Bundle<'a> {
    planned: Vec<Flight>,
    /// Every n-th trial.
    shown: Vec<&'a FlownTrial>,
    every: usize,
    trials: &'a [FlownTrial],
    hops: usize,
}

impl<'a> Bundle<'a> {
    fn new(flown: &'a FlownFigure) -> Self {
        let flights: usize = flown.trials.iter().map(|trial| trial.flights.len()).sum();
        let every = flights.div_ceil(MOST_FLIGHTS).max(1);
        let planned: Vec<Flight> = flown.planned.iter().copied().filter(is_finite).collect();
        let hops = flown.trials.iter().map(|trial| trial.flights.len()).max().unwrap_or(0).max(planned.len());
        Self { planned, shown: flown.trials.iter().step_by(every).collect(), every, trials: &flown.trials, hops }
    }

    fn flights(&self) -> impl Iterator<Item = Flight> {
        let of_trials = self.shown.iter().flat_map(|trial| &trial.flights).copied().filter(is_finite);
        self.planned.iter().copied().chain(of_trials)
    }
}

/// The positions of the panels and their scale.
struct View {
    panel: Panel,
    frame: Frame,
    /// The range of x shown, m.
    x_m: (f64, f64),
    rows: Option<Rows>,
}

/// The landings hop by hop.
struct Rows {
    panel: Panel,
    up: Axis,
    row_mm: f64,
}

impl View {
    fn new(ground: &[ChainPoint], bundle: &Bundle<'_>, top_mm: f64) -> Self {
        let x_m = view(ground, bundle);
        let (low_m, high_m) = heights(ground, bundle, x_m);
        let length_m = x_m.1 - x_m.0;
        let guess = Scale::new(length_m, high_m - low_m, RIGHT_MM - LEFT_MM);
        let per_mm = 1.0 / (guess.mm_per_m * guess.exaggeration);
        let (from_m, to_m) = (low_m - DEPTH_MM * per_mm, high_m + ABOVE_MM * per_mm);
        let left = LEFT_MM.max(1.0 + left_room_mm(&Ticks::round(from_m, to_m, (to_m - from_m) / per_mm / TICK_MM)));
        let scale = Scale::new(length_m, high_m - low_m, RIGHT_MM - left);
        let high_mm = (ABOVE_MM + scale.height_mm + DEPTH_MM).max(LOWEST_MM);
        let panel = Panel { left, top: top_mm, right: RIGHT_MM, bottom: top_mm + high_mm };
        let frame = Frame {
            scale,
            origin: ChainPoint::new(0.5 * (x_m.0 + x_m.1), low_m),
            place: (0.5 * (panel.left + panel.right), panel.bottom - DEPTH_MM),
        };
        let rows = (bundle.hops > 0).then(|| Rows::new(panel, bundle.hops));
        Self { panel, frame, x_m, rows }
    }

    fn bottom_mm(&self) -> f64 {
        self.rows.as_ref().map_or(self.panel.bottom, |rows| rows.panel.bottom)
    }

    fn axes(&self, sheet: &mut Sheet) {
        let (panel, frame) = (&self.panel, &self.frame);
        let both = Panel { bottom: self.bottom_mm(), ..*panel };
        let (from, to) = (frame.x_m(panel.left), frame.x_m(panel.right));
        let guess = Ticks::round(from, to, panel.width() / 16.0);
        let widest_mm = text_width_mm(&guess.longest(), SMALL_MM) + 3.0;
        let along = Ticks::round(from, to, panel.width() / widest_mm.max(16.0));
        let at = |x_m: f64| frame.place(ChainPoint::new(x_m, frame.origin.z_m)).0;
        let ticks: Vec<_> = along.values.iter().map(|&x_m| (at(x_m), along.text(x_m))).collect();
        both.x_axis(sheet, &ticks, &format!("distance along the chain, x (m); {}", frame.scale.text()), true);
        let up = Ticks::round(frame.z_m(panel.bottom), frame.z_m(panel.top), panel.height() / TICK_MM);
        let y = |z_m: f64| frame.place(ChainPoint::new(frame.origin.x_m, z_m)).1;
        let ticks: Vec<_> = up.values.iter().map(|&z_m| (y(z_m), up.text(z_m))).collect();
        panel.y_axis(sheet, &ticks, "height, z (m)", true);
        if let Some(rows) = &self.rows {
            let whole = |(_, text): &(f64, String)| !text.contains('.');
            let ticks: Vec<_> = rows.up.ticks(rows.panel.height() / 3.4).into_iter().filter(whole).collect();
            rows.panel.y_axis(sheet, &ticks, "landing", false);
        }
    }

    fn ground(&self, sheet: &mut Sheet, ground: &[ChainPoint]) {
        let seen: Vec<Place> = within(ground, self.x_m).into_iter().map(|point| self.frame.place(point)).collect();
        let surface = thinned(&seen);
        if let (Some(&first), Some(&last)) = (surface.first(), surface.last()) {
            let base = [(last.0, self.panel.bottom), (first.0, self.panel.bottom)];
            sheet.area(surface.iter().copied().chain(base).collect(), GROUND, 1.0);
        }
        sheet.line(surface, symbols::SURFACE_PEN);
    }

    /// Each trial as one line; failed trials over successful ones, each with a cross at the end of its last flight.
    fn trials(&self, sheet: &mut Sheet, bundle: &Bundle<'_>) {
        let most = MOST_POINTS / bundle.shown.len().max(1);
        for reached in [true, false] {
            for trial in bundle.shown.iter().filter(|trial| trial.reached == reached) {
                let points = self.line(&trial.flights, most);
                if points.len() > 1 {
                    sheet.line(points, if reached { REACHED_PEN } else { FAILED_PEN });
                }
            }
        }
        for trial in bundle.shown.iter().filter(|trial| !trial.reached) {
            if let Some(flight) = trial.flights.iter().rev().find(|flight| is_finite(flight)) {
                failed_symbol(sheet, self.frame.place(flight.to));
            }
        }
    }

    /// The planned hops, in a white casing.
    fn planned(&self, sheet: &mut Sheet, bundle: &Bundle<'_>) {
        let points = self.line(&bundle.planned, MOST_PLANNED_POINTS);
        if points.is_empty() {
            return;
        }
        sheet.line(points.clone(), CASING_PEN);
        sheet.line(points, PLANNED_PEN);
        if bundle.planned.len() <= MOST_MARKED_HOPS {
            for flight in &bundle.planned {
                symbols::takeoff(sheet, self.frame.place(flight.from));
                symbols::landing(sheet, self.frame.place(flight.to));
            }
        }
    }

    /// Consecutive flights as one line through all their ends, coarser if the budget of points is small.
    fn line(&self, flights: &[Flight], most: usize) -> Vec<Place> {
        let mut points = Vec::new();
        let finest = (number(most as u64) / number(flights.len().max(1) as u64)).floor().clamp(LEAST_PIECES, 60.0);
        for flight in flights.iter().filter(|flight| is_finite(flight)) {
            let bow_mm = 0.25 * bow_m(flight).abs() * self.frame.scale.mm_per_m * self.frame.scale.exaggeration;
            let pieces = (bow_mm / FLATNESS_MM).sqrt().ceil().clamp(2.0, finest);
            let mut i = 0.0;
            while i <= pieces {
                points.push(self.frame.place(point_at(flight, i / pieces)));
                i += 1.0;
            }
        }
        thinned(&points)
    }

    /// A dot for each landing in its hop's row.
    fn landings(&self, sheet: &mut Sheet, bundle: &Bundle<'_>) {
        let Some(rows) = &self.rows else { return };
        let every = landings_every(bundle);
        for (i, trial) in bundle.trials.iter().enumerate().step_by(every) {
            let spread = (number(i as u64) * GOLDEN).fract() - 0.5;
            let last = trial.flights.len();
            for (hop, flight) in trial.flights.iter().enumerate().filter(|(_, flight)| is_finite(flight)) {
                let x = self.frame.place(flight.to).0;
                if x < self.panel.left || x > self.panel.right {
                    continue;
                }
                let at = (x, rows.up.place(number(hop as u64 + 1)) + 0.75 * rows.row_mm * spread);
                if !trial.reached && hop + 1 == last { failed_symbol(sheet, at) } else { sheet.dot(at, 0.22, BLUE) }
            }
        }
        let half_mm = (0.5 * rows.row_mm).max(0.3);
        for (hop, flight) in bundle.planned.iter().enumerate().take(MOST_FLIGHTS) {
            let (x, y) = (self.frame.place(flight.to).0, rows.up.place(number(hop as u64 + 1)));
            sheet.line(vec![(x, y - half_mm), (x, y + half_mm)], PLANNED_PEN);
        }
    }
}

impl Rows {
    fn new(above: Panel, hops: usize) -> Self {
        let hops = number(hops as u64);
        let row_mm = ROW_MM.min(ROWS_MM / hops);
        let top = above.bottom + GAP_MM;
        let panel = Panel { top, bottom: top + (hops * row_mm).max(9.0), ..above };
        // Row 1 on top.
        Self { panel, up: Axis::new((0.5, hops + 0.5), panel.top, panel.bottom), row_mm: panel.height() / hops }
    }
}

/// The landings of every n-th trial are drawn; returns n.
fn landings_every(bundle: &Bundle<'_>) -> usize {
    let landings: usize = bundle.trials.iter().map(|trial| trial.flights.len()).sum();
    landings.div_ceil(MOST_LANDINGS).max(1)
}

/// The stretch of chain flown over, m; the whole chain without flights.
fn view(ground: &[ChainPoint], bundle: &Bundle<'_>) -> (f64, f64) {
    let whole = extent(ground.iter().map(|point| point.x_m));
    let (from, to) = extent(bundle.flights().flat_map(|flight| [flight.from.x_m, flight.to.x_m]));
    if from >= to {
        return whole;
    }
    let beside = BESIDE * (to - from);
    // Beyond the ends of the chain only if a trial flew there.
    ((from - beside).max(whole.0.min(from)), (to + beside).min(whole.1.max(to)))
}

/// The lowest and the highest of ground and flights in view, m.
fn heights(ground: &[ChainPoint], bundle: &Bundle<'_>, x_m: (f64, f64)) -> (f64, f64) {
    let ground = within(ground, x_m).into_iter().map(|point| point.z_m);
    extent(ground.chain(bundle.flights().flat_map(|flight| [flight.from.z_m, flight.to.z_m, apex_z_m(&flight)])))
}

fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// The ground between two x, cut there.
fn within(ground: &[ChainPoint], (from_m, to_m): (f64, f64)) -> Vec<ChainPoint> {
    let mut found = Vec::new();
    for pair in ground.windows(2).filter(|pair| pair[0].x_m < pair[1].x_m && pair[1].x_m >= from_m && pair[0].x_m <= to_m) {
        let (a, b) = (pair[0], pair[1]);
        let at = |x_m: f64| ChainPoint::new(x_m, a.z_m + (b.z_m - a.z_m) * (x_m - a.x_m) / (b.x_m - a.x_m));
        let ends = [if a.x_m < from_m { at(from_m) } else { a }, if b.x_m > to_m { at(to_m) } else { b }];
        found.extend(ends.into_iter().skip(usize::from(found.last() == Some(&ends[0]))));
    }
    found
}

fn is_finite(flight: &Flight) -> bool {
    let Flight { from, to, takeoff_slope } = flight;
    [from.x_m, from.z_m, to.x_m, to.z_m, *takeoff_slope].into_iter().all(f64::is_finite)
}

/// How far the parabola rises over its chord, times four: `t X` of [`Flight`].
fn bow_m(flight: &Flight) -> f64 {
    let (run_m, rise_m) = ((flight.to.x_m - flight.from.x_m).abs(), flight.to.z_m - flight.from.z_m);
    flight.takeoff_slope * run_m - rise_m
}

/// The point at a share of the way.
fn point_at(flight: &Flight, share: f64) -> ChainPoint {
    let (from, to) = (flight.from, flight.to);
    let z_m = from.z_m + (to.z_m - from.z_m) * share + bow_m(flight) * share * (1.0 - share);
    ChainPoint::new(from.x_m + (to.x_m - from.x_m) * share, z_m)
}

/// The highest point of a flight, m.
fn apex_z_m(flight: &Flight) -> f64 {
    let bow_m = bow_m(flight);
    let share = if bow_m > 0.0 { 0.5 + 0.5 * (flight.to.z_m - flight.from.z_m) / bow_m } else { 1.0 };
    point_at(flight, share.clamp(0.0, 1.0)).z_m
}

/// The legend, with how many of the trials are shown.
fn entries(flown: &FlownFigure, bundle: &Bundle<'_>, view: &View) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    if !bundle.planned.is_empty() {
        found.push((Swatch::Symbol(planned_symbol), "planned path".to_owned()));
    }
    let shown = |reached: bool| bundle.shown.iter().any(|trial| trial.reached == reached);
    if shown(true) {
        found.push((Swatch::Line(Pen { width_mm: 0.3, ..REACHED_PEN }), "trial that reached the goal".to_owned()));
    }
    if shown(false) {
        found.push((Swatch::Symbol(failed_line_symbol), "trial that did not, and its last landing".to_owned()));
    }
    if view.rows.is_some() && !bundle.trials.is_empty() {
        found.push((Swatch::Symbol(|sheet, at| sheet.dot(at, 0.4, BLUE)), "landing (spread within its row)".to_owned()));
    }
    let of = |every: usize| flown.trials.len().div_ceil(every);
    let (drawn, landed) = (of(bundle.every), of(landings_every(bundle)));
    let all = flown.trials_in_all.max(flown.trials.len() as u64);
    let text = if number(all) > number(drawn as u64) {
        format!("{drawn} of {all} trials drawn, landings of {landed}")
    } else {
        format!("{} drawn", counted(all, "trial"))
    };
    found.push((Swatch::Symbol(|_, _| {}), text));
    found
}

fn planned_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.line(vec![(x - 2.6, y), (x + 2.6, y)], PLANNED_PEN);
    symbols::takeoff(sheet, (x - 2.6, y));
    symbols::landing(sheet, (x + 2.6, y));
}

fn failed_line_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.line(vec![(x - 2.8, y), (x + 2.0, y)], Pen { width_mm: 0.3, ..FAILED_PEN });
    failed_symbol(sheet, (x + 2.0, y));
}

/// Where a trial that failed landed last.
fn failed_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.line(vec![(x - 0.6, y - 0.6), (x + 0.6, y + 0.6)], CROSS_PEN);
    sheet.line(vec![(x - 0.6, y + 0.6), (x + 0.6, y - 0.6)], CROSS_PEN);
}
