//! The profiles of all hops of paths over a map: a grid of small panels, each with its numbers, on as many pages as they need.

use super::{
    super::{
        Caption, FigureError, Picture,
        axes::{Panel, left_room_mm},
        clearance,
        keys::{self, Swatch},
        palette::{BLUE, GREEN, GROUND, SMALL_MM, TEXT_MM, VERMILION},
        picture::{PAGE_HEIGHT_MM, PageBreak, paragraph},
        scale::{Frame, Scale},
        sheet::{Label, Pen, Place, Sheet},
        symbols,
        terrain_panel::named_axes,
        ticks::{Ticks, short},
    },
    Flight,
    profile::{Profile, at_x, check_ground, fitted, part},
};
use crate::{ballistics::limits::ClearanceProfile, path::Hop, quantity::ChainPoint};

/// One hop of the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct HopProfile {
    /// The title, such as `goal 1, hop 3 of 26`.
    pub name: String,
    /// The ground from take-off to landing, and beyond as far as it is known.
    pub ground: Vec<ChainPoint>,
    /// The hop; its map coordinates are printed if it has them.
    pub hop: Hop,
    /// The heading from true north at the take-off, degrees; `None` where the projection is not known, and at a pole.
    pub heading_true_deg: Option<f64>,
    /// The least clearance of the flight over a vertex: x and height above it, m; `None` if there is no vertex between the ends.
    pub least_clearance_m: Option<(f64, f64)>,
}

/// The sheet of all hops.
#[derive(Clone, Debug, PartialEq)]
pub struct HopProfilesFigure {
    /// The caption.
    pub caption: Caption,
    /// The height to keep over the ground; 0: the flight must only not touch it.
    pub clearance: ClearanceProfile,
    /// The hops, row by row.
    pub hops: Vec<HopProfile>,
}

/// Width and height of a hop's cell, with text, panel and the space around: four rows to a page, with the caption or the page's number.
const CELL_MM: (f64, f64) = (82.0, 56.5);
/// Columns of a page.
const COLUMNS: usize = 2;
/// Space right of a cell.
const GAP_MM: f64 = 5.0;
/// Height of the panel.
const PANEL_MM: f64 = 27.5;
/// Space above the drawing, below it and at its sides.
const ABOVE_MM: f64 = 4.0;
const BELOW_MM: f64 = 5.0;
const BESIDE_MM: f64 = 3.0;
/// Drawn heights below this are exaggerated.
const FLAT_MM: f64 = 6.0;
/// Spacing of the text lines.
const LINE_MM: f64 = 3.6;
/// Space above the first line of a page.
const TOP_MM: f64 = 3.0;
/// Margin around the grid.
const MARGIN_MM: f64 = 4.0;

const FLIGHT_PEN: Pen = Pen { colour: BLUE, width_mm: 0.35 };
const REQUIRED_PEN: Pen = Pen { colour: GREEN, width_mm: 0.25 };
const LEAST_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.35 };
/// Dash and gap of the line of the required clearance.
const DASHES_MM: (f64, f64) = (1.2, 0.7);

/// Draws the profiles of hops as a grid: for each its number, its ends on the map, distance and heading, speeds and angles at both
/// ends, and the flight over the ground with the point of least clearance.
///
/// Two columns; what does not fit on a page of A4 goes on the next, eight hops or fewer to a page.
///
/// # Errors
/// [`FigureError::NoGround`] if the ground of a hop has fewer than two points.
pub fn draw_hop_profiles(figure: &HopProfilesFigure) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let mut row_mm = keys::draw(&mut sheet, &entries(figure), head_mm + 2.0) + 3.0;
    let pages = pages(figure.hops.len(), row_mm);
    let (mut breaks, mut page_mm) = (Vec::new(), 0.0);
    for row in figure.hops.chunks(COLUMNS) {
        if row_mm + CELL_MM.1 > page_mm + PAGE_HEIGHT_MM {
            // All pages but the last have the height of a page.
            page_mm += PAGE_HEIGHT_MM;
            breaks.push(PageBreak::at(&sheet, page_mm));
            let text = format!("{} (page {} of {pages})", figure.caption.title, breaks.len() + 1);
            row_mm = paragraph(&mut sheet, &fitted(&text, TEXT_MM, 140.0), TEXT_MM, true, page_mm + TOP_MM) + 3.0;
        }
        for (hop, column) in row.iter().zip([0.0, 1.0]) {
            check_ground(&hop.name, &hop.ground)?;
            cell(&mut sheet, hop, figure.clearance, (MARGIN_MM + column * CELL_MM.0, row_mm));
        }
        row_mm += CELL_MM.1;
    }
    Ok(Picture { breaks, ..Picture::page(sheet, (row_mm + 1.0).ceil()) })
}

/// The pages of so many hops, whose first row on the first page begins at a height.
fn pages(hops: usize, first_mm: f64) -> usize {
    let rows = hops.div_ceil(COLUMNS);
    let fit = |from_mm: f64| (1..1000).take_while(|row| from_mm + f64::from(*row) * CELL_MM.1 <= PAGE_HEIGHT_MM).count();
    let next_mm = TOP_MM + 1.4 * TEXT_MM + 3.0;
    1 + rows.saturating_sub(fit(first_mm)).div_ceil(fit(next_mm).max(1))
}

/// The legend, with the symbols that occur on the sheet.
fn entries(figure: &HopProfilesFigure) -> Vec<(Swatch, String)> {
    let mut found = vec![
        (Swatch::Line(FLIGHT_PEN), "flight".to_owned()),
        (Swatch::Symbol(symbols::takeoff), "take-off".to_owned()),
        (Swatch::Symbol(symbols::landing), "landing".to_owned()),
    ];
    if figure.hops.iter().any(|hop| hop.least_clearance_m.is_some()) {
        found.push((Swatch::Line(LEAST_PEN), "least clearance over a vertex".to_owned()));
    }
    if figure.clearance.height_m() > 0.0 {
        let text = format!("clearance asked for: {} m", short(figure.clearance.height_m()));
        found.push(if figure.clearance.has_kinks() {
            (Swatch::Line(clearance::EDGE_PEN), text)
        } else {
            (Swatch::Dashed(REQUIRED_PEN, DASHES_MM.0, DASHES_MM.1), text)
        });
    }
    found
}

/// The numbers of a hop, as text lines.
fn words(profile: &HopProfile) -> Vec<String> {
    let hop = &profile.hop;
    let run_m = short(hop.run_m());
    let mut found = Vec::new();
    if let Some((from, to)) = hop.map_ends() {
        found.push(format!("({:.1}, {:.1}) m to ({:.1}, {:.1}) m", from.x, from.y, to.x, to.y));
        let from_true_north = profile.heading_true_deg.map(|heading| format!(", {heading:.1}° true")).unwrap_or_default();
        let time_s = short(hop.flight_time_s);
        found.push(format!("run {run_m} m in {time_s} s, heading {:.1}° grid{from_true_north}", hop.heading_deg));
    } else {
        found.push(format!("run {run_m} m; flight {} s", short(hop.flight_time_s)));
    }
    let angles = hop.takeoff_angles;
    found.push(format!(
        "take-off {} m/s at {:.1} deg ({:.1} to {:.1} feasible)",
        short(hop.takeoff_speed_m_s),
        hop.takeoff_angle.degrees(),
        angles.min.degrees(),
        angles.max.degrees()
    ));
    let clearance = profile.least_clearance_m.map(|(_, height_m)| format!("; least clearance {} m", short(height_m)));
    let landing = format!("landing {} m/s at {:.1} deg", short(hop.landing_speed_m_s), hop.landing_angle.degrees());
    found.push(landing + &clearance.unwrap_or_default());
    found
}

/// One hop, with the given upper left corner.
fn cell(sheet: &mut Sheet, profile: &HopProfile, clearance: ClearanceProfile, (left_mm, top_mm): Place) {
    let width_mm = CELL_MM.0 - GAP_MM;
    let title = fitted(&profile.name, TEXT_MM, 0.9 * width_mm);
    sheet.label(Label { bold: true, ..Label::new(title, (left_mm, top_mm + 0.5 * LINE_MM), TEXT_MM) });
    let mut y = top_mm + 1.5 * LINE_MM + 0.3;
    for line in words(profile) {
        sheet.label(Label::new(fitted(&line, SMALL_MM, width_mm), (left_mm, y), SMALL_MM));
        y += LINE_MM;
    }
    let end_mm = left_mm + width_mm;
    panel(sheet, profile, clearance, (left_mm, end_mm), y - 0.2 * LINE_MM);
}

/// The flight over its ground, between two ends and below a height of the sheet.
fn panel(sheet: &mut Sheet, profile: &HopProfile, clearance: ClearanceProfile, ends_mm: (f64, f64), top_mm: f64) {
    let flight = Flight::from(&profile.hop);
    let (from, to) = (flight.from.x_m.min(flight.to.x_m), flight.from.x_m.max(flight.to.x_m));
    let ground = part(&profile.ground, from, to);
    let drawn = laid_out(&ground, &flight, ends_mm, top_mm);
    let x_name = format!("distance (m); {}", brief(&drawn.frame.scale));
    named_axes(sheet, &drawn.panel, &drawn.frame, &x_name, "height (m)");
    let surface = drawn.line(&ground);
    if let (Some(&first), Some(&last)) = (surface.first(), surface.last()) {
        let base = [(last.0, drawn.panel.bottom), (first.0, drawn.panel.bottom)];
        sheet.area(surface.iter().copied().chain(base).collect(), GROUND, 1.0);
    }
    if clearance.has_kinks() {
        clearance::band(sheet, &drawn.line(&clearance::raised(&ground, clearance)), &surface);
    } else if clearance.height_m() > 0.0 {
        let raised = drawn.line(&clearance::raised(&ground, clearance));
        sheet.dashed(&raised, DASHES_MM.0, DASHES_MM.1, REQUIRED_PEN);
    }
    sheet.line(surface, symbols::SURFACE_PEN);
    if let Some((x_m, height_m)) = profile.least_clearance_m {
        let foot = at_x(&ground, x_m);
        sheet.line(vec![drawn.frame.place(foot), drawn.frame.place(ChainPoint::new(x_m, foot.z_m + height_m))], LEAST_PEN);
    }
    sheet.line(drawn.flight(&flight), FLIGHT_PEN);
    symbols::takeoff(sheet, drawn.frame.place(flight.from));
    symbols::landing(sheet, drawn.frame.place(flight.to));
    drawn.panel.outline(sheet);
}

/// The scale, worded briefly for a small panel.
fn brief(scale: &Scale) -> String {
    if scale.exaggeration < 1.0 { format!("heights at 1/{:.0} of its scale", 1.0 / scale.exaggeration) } else { scale.text() }
}

/// A panel of fixed height, with equal scales on both axes or an exaggeration that its axis states.
fn laid_out(ground: &[ChainPoint], flight: &Flight, (left_mm, right_mm): (f64, f64), top_mm: f64) -> Profile {
    let heights = ground.iter().map(|point| point.z_m).chain([flight.apex_z_m()]);
    let (low_m, high_m) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)));
    let (from_m, to_m) = (flight.from.x_m.min(flight.to.x_m), flight.from.x_m.max(flight.to.x_m));
    // A vertical hop still needs a scale.
    let length_m = if to_m > from_m { to_m - from_m } else { 1.0 };
    let tall_mm = PANEL_MM - ABOVE_MM - BELOW_MM;
    let scale = |left_mm: f64| Scale::within(length_m, high_m - low_m, right_mm - left_mm - 2.0 * BESIDE_MM, (FLAT_MM, tall_mm));
    // The width of the axis numbers sets the panel's left edge, and depends on the panel's scale: one estimate of it is enough.
    let guess = scale(left_mm + 12.0);
    let per_mm = 1.0 / (guess.mm_per_m * guess.exaggeration);
    let ticks = Ticks::round(low_m - BELOW_MM * per_mm, high_m + ABOVE_MM * per_mm, PANEL_MM / 6.5);
    let left = left_mm + left_room_mm(&ticks);
    let panel = Panel { left, top: top_mm, right: right_mm, bottom: top_mm + PANEL_MM };
    let origin = ChainPoint::new(0.5 * (from_m + to_m), low_m);
    let frame = Frame { scale: scale(left), origin, place: (0.5 * (left + right_mm), panel.bottom - BELOW_MM) };

    Profile { panel, frame }
}
