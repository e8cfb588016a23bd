//! The proof along a chain: reachable, proved unreachable and open stretches.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        keys::{self, Swatch},
        palette::{BLACK, BLUE, GROUND, ORANGE, SMALL_MM, TEXT_MM, VERMILION},
        picture::paragraph,
        sheet::{Pen, Place, Sheet, steps_along},
        stop_panel, symbols, terrain_panel,
        ticks::short,
    },
    ProofClass, ProofFigure, ProofGap, ProofStretch,
    profile::{self, Profile},
};

/// The smallest length of a stretch on the sheet; a point is drawn with this length.
const LEAST_MM: f64 = 0.5;
/// Above this number of stretches the chain is drawn in columns of [`LEAST_MM`], each in the class of its longest part.
const MOST_STRETCHES: usize = 300;
/// Smallest mean distance at which cell boundaries are drawn.
const BOUNDARY_MM: f64 = 0.4;
/// The greatest number of limits listed one by one.
const MOST_LIMITS: usize = 10;
/// Line of cell boundaries.
const BOUNDARY_PEN: Pen = Pen { colour: BLACK, width_mm: 0.1 };

/// The three classes in the order of the legend.
const CLASSES: [ProofClass; 3] = [ProofClass::Reachable, ProofClass::Unreachable, ProofClass::Open];

/// Draws a chain by what is proved of it: reachable (a solid line over light ground), proved unreachable (a line with strokes into
/// the ground), open (a dotted line over dots). Below: the gap that stops the journey, with the refusals counted by limit.
///
/// Stretches too short to be seen are drawn half a millimetre long. More than 300 stretches are merged into columns, and cell
/// boundaries closer than 0.4 mm are omitted. The legend states the length of each class.
///
/// # Errors
/// [`FigureError::NoGround`] if the ground has fewer than two points.
pub fn draw_proof(figure: &ProofFigure) -> Result<Picture, FigureError> {
    profile::check_ground("the proof", &figure.ground)?;
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet) - 1.5;
    let top_mm = paragraph(&mut sheet, &bounds(figure), TEXT_MM, true, top_mm) + 1.5;
    let (flights, every) = profile::shown(&figure.path);
    let ends = [figure.start, figure.goal];
    let profile = Profile::new(figure.ground.iter().copied().chain(ends), flights.iter().copied(), top_mm);
    let drawing = Drawing { figure, profile, stretches: joined(figure) };
    drawing.ground(&mut sheet);
    for flight in &flights {
        sheet.line(drawing.profile.flight(flight), FLIGHT_PEN);
    }
    drawing.ends(&mut sheet);
    let end_mm = keys::draw(&mut sheet, &drawing.keys(every), drawing.profile.end_mm() + 2.5);
    let end_mm = figure.gap.as_ref().map_or(end_mm, |gap| draw_gap_text(&mut sheet, gap, end_mm + 1.5));
    Ok(Picture::page(sheet, end_mm + 2.5))
}

/// Flights of the best path.
const FLIGHT_PEN: Pen = Pen { colour: BLACK, width_mm: 0.3 };

/// The meaning of the two bounds, in a sentence.
fn bounds(figure: &ProofFigure) -> String {
    let hops = |count: u64| if count == 1 { "1 hop".to_owned() } else { format!("{count} hops") };
    let said = match (figure.lower_bound, figure.upper_bound) {
        (Some(lower), Some(upper)) if lower == upper => format!("proved: {} and no fewer", hops(upper)),
        (Some(lower), Some(upper)) => format!("fewest hops: at least {lower}, at most {upper}"),
        (None, Some(upper)) => format!("a path of {} is known", hops(upper)),
        (Some(lower), None) => format!("open: no path is known, and one would need at least {}", hops(lower)),
        (None, None) => "proved: no path, at any resolution".to_owned(),
    };
    let cells = if figure.cells == 1 { "1 cell".to_owned() } else { format!("{} cells", figure.cells) };
    format!("{said} ({cells})")
}

/// The stretches from left to right within the ground, neighbours of one class joined.
fn joined(figure: &ProofFigure) -> Vec<ProofStretch> {
    let [first, .., last] = figure.ground.as_slice() else { return Vec::new() };
    let mut sorted: Vec<ProofStretch> = figure
        .stretches
        .iter()
        .filter(|stretch| stretch.from_x_m <= last.x_m && stretch.to_x_m >= first.x_m)
        .map(|s| ProofStretch { from_x_m: s.from_x_m.max(first.x_m), to_x_m: s.to_x_m.min(last.x_m), class: s.class })
        .collect();
    sorted.sort_by(|a, b| a.from_x_m.total_cmp(&b.from_x_m).then(a.to_x_m.total_cmp(&b.to_x_m)));
    let mut found: Vec<ProofStretch> = Vec::new();
    for stretch in sorted {
        match found.last_mut() {
            Some(last) if last.class == stretch.class && stretch.from_x_m <= last.to_x_m => {
                last.to_x_m = last.to_x_m.max(stretch.to_x_m);
            }
            _ => found.push(stretch),
        }
    }
    found
}

/// The stretches resolved into columns of a width: each column has the class of its longest part.
pub(super) fn in_columns(stretches: &[ProofStretch], column_m: f64) -> Vec<ProofStretch> {
    let mut found: Vec<ProofStretch> = Vec::new();
    let (Some(first), Some(last)) = (stretches.first(), stretches.last()) else { return found };
    let (mut next, mut left) = (0, first.from_x_m);
    while left < last.to_x_m {
        let right = (left + column_m).min(last.to_x_m);
        while stretches.get(next).is_some_and(|s| s.to_x_m <= left) {
            next += 1;
        }
        let mut lengths = [0.0; CLASSES.len()];
        for stretch in stretches[next..].iter().take_while(|s| s.from_x_m < right) {
            lengths[index(stretch.class)] += (stretch.to_x_m.min(right) - stretch.from_x_m.max(left)).max(0.0);
        }
        let longest = CLASSES.into_iter().max_by(|a, b| lengths[index(*a)].total_cmp(&lengths[index(*b)]));
        if let Some(class) = longest.filter(|class| lengths[index(*class)] > 0.0) {
            match found.last_mut() {
                Some(last) if last.class == class && last.to_x_m == left => last.to_x_m = right,
                _ => found.push(ProofStretch { from_x_m: left, to_x_m: right, class }),
            }
        }
        if right <= left {
            // A column narrower than the spacing of floating-point numbers.
            break;
        }
        left = right;
    }
    found
}

const fn index(class: ProofClass) -> usize {
    match class {
        ProofClass::Reachable => 0,
        ProofClass::Unreachable => 1,
        ProofClass::Open => 2,
    }
}

const fn name(class: ProofClass) -> &'static str {
    match class {
        ProofClass::Reachable => "reachable",
        ProofClass::Unreachable => "proved unreachable",
        ProofClass::Open => "open",
    }
}

const fn colour(class: ProofClass) -> RGBColor {
    match class {
        ProofClass::Reachable => BLUE,
        ProofClass::Unreachable => VERMILION,
        ProofClass::Open => ORANGE,
    }
}

/// One stretch along a line of the sheet; `spread` multiplies the spacing of its strokes and dots.
fn stretch(sheet: &mut Sheet, points: &[Place], class: ProofClass, spread: f64) {
    let colour = colour(class);
    match class {
        ProofClass::Reachable => sheet.line(points.to_vec(), Pen { colour, width_mm: 1.0 }),
        ProofClass::Unreachable => {
            sheet.line(points.to_vec(), Pen { colour, width_mm: 0.5 });
            for ((x, y), (ax, ay)) in steps_along(points, 1.1 * spread) {
                // Strokes into the ground, slanting to the left.
                let (dx, dy) = (-ay - ax, ax - ay);
                let length = libm::hypot(dx, dy) / 2.2;
                sheet.line(vec![(x, y), (x + dx / length, y + dy / length)], Pen { colour, width_mm: 0.2 });
            }
        }
        ProofClass::Open => {
            sheet.dashed(points, 0.6 * spread, 0.6 * spread, Pen { colour, width_mm: 0.9 });
            for ((x, y), (ax, ay)) in steps_along(points, 1.8 * spread) {
                sheet.dot((x - 1.5 * ay, y + 1.5 * ax), 0.28, colour);
            }
        }
    }
}

fn reachable_sample(sheet: &mut Sheet, at: Place) {
    stretch(sheet, &sample_line(at), ProofClass::Reachable, 1.0);
}

fn unreachable_sample(sheet: &mut Sheet, at: Place) {
    stretch(sheet, &sample_line(at), ProofClass::Unreachable, 1.0);
}

fn open_sample(sheet: &mut Sheet, at: Place) {
    stretch(sheet, &sample_line(at), ProofClass::Open, 1.0);
}

fn sample_line((x, y): Place) -> [Place; 2] {
    [(x - 3.0, y - 0.6), (x + 3.0, y - 0.6)]
}

fn boundary_sample(sheet: &mut Sheet, (x, y): Place) {
    for dx in [-2.0, -0.5, 2.0] {
        sheet.line(vec![(x + dx, y - 0.7), (x + dx, y + 0.7)], BOUNDARY_PEN);
    }
}

/// The panel with its data.
struct Drawing<'a> {
    figure: &'a ProofFigure,
    profile: Profile,
    stretches: Vec<ProofStretch>,
}

impl Drawing<'_> {
    /// Axes, ground, boundaries and stretches.
    fn ground(&self, sheet: &mut Sheet) {
        let (profile, ground) = (&self.profile, &self.figure.ground);
        profile.axes(sheet, "distance along the chain, x (m)", "height, z (m)");
        let surface = profile.line(ground);
        if let (Some(&first), Some(&last)) = (surface.first(), surface.last()) {
            let base = [(last.0, profile.panel.bottom), (first.0, profile.panel.bottom)];
            sheet.area(surface.iter().copied().chain(base).collect(), GROUND, 1.0);
        }
        // On a surface far longer than its horizontal extent, strokes at the usual spacing would merge.
        let length_mm: f64 = surface.windows(2).map(|p| libm::hypot(p[1].0 - p[0].0, p[1].1 - p[0].1)).sum();
        let spread = (length_mm / (4.0 * profile.panel.width())).max(1.0);
        sheet.line(surface, symbols::SURFACE_PEN);
        for x_mm in self.boundaries_mm() {
            sheet.line(vec![(x_mm, profile.panel.bottom - 1.4), (x_mm, profile.panel.bottom)], BOUNDARY_PEN);
        }
        let mm_per_m = profile.frame.scale.mm_per_m;
        let columns;
        let drawn = if self.stretches.len() > MOST_STRETCHES {
            columns = in_columns(&self.stretches, LEAST_MM / mm_per_m);
            &columns
        } else {
            &self.stretches
        };
        // Stretches drawn longer than they are come last, over their neighbours.
        let is_short = |s: &&ProofStretch| (s.to_x_m - s.from_x_m) * mm_per_m < LEAST_MM;
        for s in drawn.iter().filter(|s| !is_short(s)).chain(drawn.iter().filter(is_short)) {
            let spare_m = (0.5 * (LEAST_MM / mm_per_m - (s.to_x_m - s.from_x_m))).max(0.0);
            let points = profile.line(&profile::part(ground, s.from_x_m - spare_m, s.to_x_m + spare_m));
            stretch(sheet, &points, s.class, spread);
        }
    }

    /// The ends of cells, if far enough apart to be distinguished.
    fn boundaries_mm(&self) -> Vec<f64> {
        let (profile, ground) = (&self.profile, &self.figure.ground);
        let place = |x_m: f64| profile.frame.place(profile::at_x(ground, x_m)).0;
        let inside = |x_mm: &f64| *x_mm >= profile.panel.left && *x_mm <= profile.panel.right;
        let found: Vec<f64> = self.figure.cell_boundaries_x_m.iter().map(|&x_m| place(x_m)).filter(inside).collect();
        #[expect(clippy::cast_precision_loss, reason = "a count of marks")]
        let needed_mm = found.len() as f64 * BOUNDARY_MM;
        if needed_mm > profile.panel.width() { Vec::new() } else { found }
    }

    /// The gap, start, goal and the panel's outline.
    fn ends(&self, sheet: &mut Sheet) {
        let (profile, figure) = (&self.profile, self.figure);
        if let Some(gap) = &figure.gap {
            let towards = (figure.goal.x_m - figure.start.x_m).signum();
            let gap_m = (gap.leads_to_goal_x_m - gap.reached_x_m) * towards;
            if gap_m > 0.0 {
                let ends = [gap.reached_x_m, gap.leads_to_goal_x_m];
                let places = ends.map(|x_m| profile.frame.place(profile::at_x(&figure.ground, x_m)));
                terrain_panel::gap(sheet, &profile.panel, places, gap_m);
            }
        }
        profile.pin(sheet, &figure.ground, figure.start, "start");
        profile.pin(sheet, &figure.ground, figure.goal, "goal");
        profile.panel.outline(sheet);
    }

    /// The legend: the classes present with their lengths, then the other symbols.
    fn keys(&self, every: usize) -> Vec<(Swatch, String)> {
        let samples: [fn(&mut Sheet, Place); 3] = [reachable_sample, unreachable_sample, open_sample];
        let mut found = Vec::new();
        for (class, sample) in CLASSES.into_iter().zip(samples) {
            let of_class = || self.stretches.iter().filter(|s| s.class == class);
            if of_class().next().is_some() {
                let length_m: f64 = of_class().map(|s| s.to_x_m - s.from_x_m).sum();
                let length = if length_m > 0.0 { format!("{} m", short(length_m)) } else { "single points".to_owned() };
                found.push((Swatch::Symbol(sample), format!("{}: {length}", name(class))));
            }
        }
        if !self.figure.path.is_empty() {
            let (of, said) = (self.figure.path.len(), "best path known");
            let text = if every > 1 { format!("{said} (1 hop in {every} of {of} shown)") } else { said.to_owned() };
            found.push((Swatch::Line(FLIGHT_PEN), text));
        }
        if !self.boundaries_mm().is_empty() {
            found.push((Swatch::Symbol(boundary_sample), "ends of cells".to_owned()));
        }
        found
    }
}

/// The gap and the limits that refuse there; returns where it ends.
fn draw_gap_text(sheet: &mut Sheet, gap: &ProofGap, top_mm: f64) -> f64 {
    let text = format!(
        "Proved: no path from the start comes nearer to the goal than x = {} m; no place nearer to the start than x = {} m leads to \
         the goal.",
        short(gap.reached_x_m),
        short(gap.leads_to_goal_x_m)
    );
    let top_mm = paragraph(sheet, &text, SMALL_MM, false, top_mm) + 1.5;
    let counted: Vec<_> = gap.refusals.iter().filter(|(_, count)| *count > 0).collect();
    if counted.is_empty() {
        return paragraph(sheet, "No other cell was within reach of those that may be reached.", SMALL_MM, false, top_mm);
    }
    let width_mm = 0.35 * profile::TEXT_WIDTH_MM;
    let names: Vec<_> = counted.iter().map(|(limit, _)| profile::fitted(limit, SMALL_MM, width_mm)).collect();
    let mut counts: Vec<(&str, u64)> = names.iter().zip(&counted).map(|(name, (_, count))| (name.as_str(), *count)).collect();
    if counts.len() > MOST_LIMITS {
        let rest = counts[MOST_LIMITS..].iter().fold(0u64, |sum, (_, count)| sum.saturating_add(*count));
        counts.truncate(MOST_LIMITS);
        counts.push(("all others", rest));
    }
    let axis = "pairs of cells refused, by the first limit that left nothing";
    stop_panel::bars(sheet, &counts, axis, top_mm)
}
