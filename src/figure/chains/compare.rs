//! The paths of several scenarios: overlaid on a common ground, else each in a panel of its own.

use plotters::style::RGBColor;

use super::{
    super::{
        Caption, FigureError, Picture,
        palette::{BLACK, BLUE, GREEN, GROUND, ORANGE, PURPLE, RIGHT_MM, SKY, SMALL_MM, VERMILION},
        picture::{PAGE_HEIGHT_MM, PageBreak},
        sheet::{Label, Pen, Place, Sheet},
        symbols,
    },
    CompareFigure, ComparedScenario, Flight,
    profile::{self, Profile, fitted},
};
use crate::quantity::ChainPoint;

/// Colours, with the dash and gap of each, mm; further scenarios repeat the colours with the next marker shapes.
const LINES: [(RGBColor, Option<(f64, f64)>); 7] = [
    (BLUE, None),
    (VERMILION, Some((2.4, 0.8))),
    (GREEN, Some((0.7, 0.6))),
    (PURPLE, None),
    (ORANGE, Some((1.4, 0.5))),
    (SKY, Some((3.5, 1.2))),
    (BLACK, Some((0.4, 0.8))),
];
/// Length of a sample in the legend.
const SAMPLE_MM: f64 = 10.0;
/// Spacing of the legend's rows.
const ROW_MM: f64 = 4.6;

/// Draws the paths of several scenarios, each with its own colour, dashes and landing marker.
///
/// On a common ground they are overlaid at their positions. On different grounds each has a panel with its own scale, below the one before;
/// what does not fit on a page of A4 goes on the next.
///
/// # Errors
/// [`FigureError::NoGround`] if there is no scenario, or one whose ground has fewer than two points.
pub fn draw_compare(figure: &CompareFigure) -> Result<Picture, FigureError> {
    let Some(first) = figure.scenarios.first() else {
        return Err(FigureError::NoGround { what: "the comparison, which has no scenario,".to_owned(), points: 0 });
    };
    for scenario in &figure.scenarios {
        profile::check_ground(&scenario.name, &scenario.ground)?;
    }
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let drawn: Vec<Drawn<'_>> = figure.scenarios.iter().enumerate().map(|(i, s)| Drawn::new(s, i)).collect();
    if figure.scenarios.iter().any(|scenario| scenario.ground != first.ground) {
        return Ok(multiples(sheet, figure, &drawn, top_mm));
    }
    let points = drawn.iter().flat_map(|one| one.scenario.ground.iter().copied().chain([one.scenario.start, one.scenario.goal]));
    let profile = Profile::new(points, drawn.iter().flat_map(|one| one.flights.iter().copied()), top_mm);
    profile.axes(&mut sheet, X_NAME, Z_NAME);
    ground(&mut sheet, &profile, &first.ground);
    for one in &drawn {
        one.draw(&mut sheet, &profile);
    }
    ends(&mut sheet, &profile, &drawn);
    profile.panel.outline(&mut sheet);
    let end_mm = legend(&mut sheet, &drawn, profile.end_mm() + 2.5);
    Ok(Picture::page(sheet, end_mm + 2.0))
}

const X_NAME: &str = "distance along the chain, x (m)";
const Z_NAME: &str = "height, z (m)";
/// The least and the greatest drawn height of one panel among several.
const MULTIPLE_MM: (f64, f64) = (12.0, 38.0);

/// A panel for each scenario, with its line of the legend above it.
fn multiples(mut sheet: Sheet, figure: &CompareFigure, drawn: &[Drawn<'_>], top_mm: f64) -> Picture {
    let (mut breaks, mut page_mm, mut y) = (Vec::new(), 0.0, top_mm);
    for one in drawn {
        let ComparedScenario { ground: line, start, goal, .. } = one.scenario;
        let laid_out = |y: f64| {
            let points = line.iter().copied().chain([*start, *goal]);
            Profile::within(points, one.flights.iter().copied(), y + ROW_MM, MULTIPLE_MM)
        };
        if laid_out(y).end_mm() + 2.0 > page_mm + PAGE_HEIGHT_MM && y > page_mm + top_mm {
            page_mm = y.ceil();
            breaks.push(PageBreak::at(&sheet, page_mm));
            y = Caption { title: figure.caption.title.clone(), lines: Vec::new() }.draw_from(&mut sheet, page_mm);
        }
        let profile = laid_out(y);
        legend(&mut sheet, std::slice::from_ref(one), y + 0.5 * ROW_MM - 0.6);
        profile.axes(&mut sheet, X_NAME, Z_NAME);
        ground(&mut sheet, &profile, line);
        one.draw(&mut sheet, &profile);
        for (at, name) in [(*start, "start"), (*goal, "goal")] {
            profile.pin(&mut sheet, line, at, name);
        }
        profile.panel.outline(&mut sheet);
        y = profile.end_mm() + 2.0;
    }
    Picture { breaks, ..Picture::page(sheet, y) }
}

/// The ground below a panel's surface.
fn ground(sheet: &mut Sheet, profile: &Profile, ground: &[ChainPoint]) {
    let surface = profile.line(ground);
    if let (Some(&first), Some(&last)) = (surface.first(), surface.last()) {
        let base = [(last.0, profile.panel.bottom), (first.0, profile.panel.bottom)];
        sheet.area(surface.iter().copied().chain(base).collect(), GROUND, 1.0);
    }
    sheet.line(surface, symbols::SURFACE_PEN);
}

/// One scenario as it is drawn.
struct Drawn<'a> {
    scenario: &'a ComparedScenario,
    index: usize,
    flights: Vec<Flight>,
    /// Every n-th flight is shown.
    every: usize,
}

impl<'a> Drawn<'a> {
    fn new(scenario: &'a ComparedScenario, index: usize) -> Self {
        let (flights, every) = profile::shown(&scenario.flights);
        Self { scenario, index, flights, every }
    }

    fn colour(&self) -> RGBColor {
        LINES[self.index % LINES.len()].0
    }

    /// A line in the scenario's colour and dashes.
    fn line(&self, sheet: &mut Sheet, points: Vec<Place>, width_mm: f64) {
        let (colour, dashes) = LINES[self.index % LINES.len()];
        let pen = Pen { colour, width_mm };
        match dashes {
            None => sheet.line(points, pen),
            Some((dash_mm, gap_mm)) => sheet.dashed(&points, dash_mm, gap_mm, pen),
        }
    }

    /// The scenario's landing marker: its number of corners identifies it without colour.
    fn mark(&self, sheet: &mut Sheet, (x, y): Place) {
        let (colour, r) = (self.colour(), 0.75);
        match (self.index + self.index / LINES.len()) % LINES.len() {
            0 => sheet.dot((x, y), r, colour),
            1 => sheet.area(vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)], colour, 1.0),
            2 => sheet.area(vec![(x, y - 1.3 * r), (x + 1.2 * r, y + r), (x - 1.2 * r, y + r)], colour, 1.0),
            3 => sheet.area(vec![(x, y - 1.4 * r), (x + 1.4 * r, y), (x, y + 1.4 * r), (x - 1.4 * r, y)], colour, 1.0),
            4 => sheet.ring((x, y), r, Pen { colour, width_mm: 0.3 }),
            5 => sheet.area(vec![(x, y + 1.3 * r), (x + 1.2 * r, y - r), (x - 1.2 * r, y - r)], colour, 1.0),
            _ => {
                for (dx, dy) in [(r, r), (r, -r)] {
                    sheet.line(vec![(x - dx, y - dy), (x + dx, y + dy)], Pen { colour, width_mm: 0.35 });
                }
            }
        }
    }

    /// Its flights with their landings.
    fn draw(&self, sheet: &mut Sheet, profile: &Profile) {
        for flight in &self.flights {
            self.line(sheet, profile.flight(flight), 0.4);
        }
        for flight in &self.flights {
            self.mark(sheet, profile.frame.place(flight.to));
        }
    }

    /// The legend text.
    fn text(&self) -> String {
        let hops = match self.scenario.hops {
            Some(1) => ", 1 hop".to_owned(),
            Some(hops) => format!(", {hops} hops"),
            None => String::new(),
        };
        let of = self.scenario.flights.len();
        let thinned = if self.every > 1 { format!(" (1 hop in {} of {of} shown)", self.every) } else { String::new() };
        let said = format!(": {}{hops}{thinned}", self.scenario.verdict);
        let name_mm = RIGHT_MM - TEXT_LEFT_MM - super::super::sheet::text_width_mm(&said, SMALL_MM);
        fitted(&(fitted(&self.scenario.name, SMALL_MM, name_mm.max(30.0)) + &said), SMALL_MM, RIGHT_MM - TEXT_LEFT_MM)
    }
}

/// Left ends of the legend's samples and texts.
const LEFT_MM: f64 = 6.0;
const TEXT_LEFT_MM: f64 = LEFT_MM + SAMPLE_MM + 1.5;

/// Start and goal: common ones by name, others with the number of their scenario.
fn ends(sheet: &mut Sheet, profile: &Profile, drawn: &[Drawn<'_>]) {
    let Some(first) = drawn.first() else { return };
    let mut pinned: Vec<ChainPoint> = Vec::new();
    for (name, of) in
        [("start", (|one: &Drawn<'_>| one.scenario.start) as fn(&Drawn<'_>) -> ChainPoint), ("goal", |one| one.scenario.goal)]
    {
        let shared = drawn.iter().all(|one| of(one) == of(first));
        for one in drawn.iter().take(if shared { 1 } else { MOST_NAMED }) {
            if pinned.contains(&of(one)) {
                continue;
            }
            pinned.push(of(one));
            let same: Vec<String> =
                drawn.iter().filter(|other| of(other) == of(one)).map(|other| (other.index + 1).to_string()).collect();
            let text = if shared { name.to_owned() } else { fitted(&format!("{name} {}", same.join(", ")), SMALL_MM, 30.0) };
            profile.pin(sheet, &one.scenario.ground, of(one), &text);
        }
    }
}

/// The greatest number of ends that are named one by one.
const MOST_NAMED: usize = 8;

/// A legend row for each scenario; returns where they end.
fn legend(sheet: &mut Sheet, drawn: &[Drawn<'_>], top_mm: f64) -> f64 {
    let mut y = top_mm;
    for one in drawn {
        if !one.flights.is_empty() {
            one.line(sheet, vec![(LEFT_MM, y), (LEFT_MM + SAMPLE_MM, y)], 0.5);
            one.mark(sheet, (LEFT_MM + 0.5 * SAMPLE_MM, y));
        }
        let number = format!("{}. ", one.index + 1);
        sheet.label(Label::new(
            fitted(&(number + &one.text()), SMALL_MM, RIGHT_MM - TEXT_LEFT_MM + 4.0),
            (TEXT_LEFT_MM, y),
            SMALL_MM,
        ));
        y += ROW_MM;
    }
    y - 0.5 * ROW_MM
}
