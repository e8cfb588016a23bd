//! The hops of a path as a table under its pictures.

use super::{
    palette::{AXIS, RIGHT_MM, SMALL_MM},
    picture::{MARGIN_MM, paragraph},
    sheet::{Anchor, Hang, Label, Pen, Sheet},
};
use crate::path::HopPath;

/// The most rows; of a longer path every n-th hop and the last are listed.
const MOST_ROWS: usize = 30;
/// Spacing of rows.
const ROW_MM: f64 = 3.6;

/// The columns: their names, units, and where their numbers end.
const COLUMNS: [(&str, &str, f64); 12] = [
    ("hop", "", 12.0),
    ("x", "m", 27.0),
    ("y", "m", 42.0),
    ("z", "m", 56.0),
    ("distance", "m", 71.0),
    ("heading", "deg", 85.0),
    ("angle", "deg", 98.0),
    ("feasible", "deg", 118.0),
    ("take-off", "m/s", 131.0),
    ("landing", "m/s", 143.0),
    ("time", "s", 154.0),
    ("apex z", "m", RIGHT_MM),
];

/// A coordinate; what rounds to zero has no sign.
fn metres(value_m: f64) -> String {
    let text = format!("{value_m:.2}");
    if text == "-0.00" { "0.00".to_owned() } else { text }
}

/// The height of the table.
pub(super) fn height_mm(path: &HopPath) -> f64 {
    let every = path.hops.len().div_ceil(MOST_ROWS).max(1);
    #[expect(clippy::cast_precision_loss, reason = "at most some thirty rows")]
    let rows = path.hops.len().div_ceil(every) as f64;
    1.4 * SMALL_MM + (2.0 + rows) * ROW_MM + 1.1
}

/// Draws the table below a height of the sheet; returns where it ends.
pub(super) fn draw(sheet: &mut Sheet, name: &str, path: &HopPath, top_mm: f64) -> f64 {
    let every = path.hops.len().div_ceil(MOST_ROWS).max(1);
    let thinned = if every > 1 { format!(", every {every}th and the last") } else { String::new() };
    let of = if name.is_empty() { String::new() } else { format!(" of {name}") };
    let mut y = paragraph(sheet, &format!("Hops{of}{thinned}: the landing, and the command to it"), SMALL_MM, true, top_mm) + 0.5;
    let mut row = |texts: [String; COLUMNS.len()], y: f64| {
        for (text, (.., end_mm)) in texts.into_iter().zip(COLUMNS) {
            sheet.label(Label::new(text, (end_mm, y), SMALL_MM).hung(Anchor::End, Hang::Below));
        }
    };
    row(COLUMNS.map(|(name, ..)| name.to_owned()), y);
    row(COLUMNS.map(|(_, unit, _)| unit.to_owned()), y + ROW_MM);
    y += 2.0 * ROW_MM + 0.6;
    let rule_mm = y - 0.7;
    let last = path.hops.len();
    for (number, hop) in (1..).zip(&path.hops).filter(|(number, _)| number % every == 0 || *number == last) {
        let at = hop.landing.point_m;
        let window = hop.takeoff_angles;
        row(
            [
                number.to_string(),
                metres(at.x),
                metres(at.y),
                metres(at.z),
                format!("{:.2}", hop.run_m()),
                format!("{:.1}", hop.heading_deg),
                format!("{:.2}", hop.takeoff_angle.degrees()),
                format!("{:.1} to {:.1}", window.min.degrees(), window.max.degrees()),
                format!("{:.3}", hop.takeoff_speed_m_s),
                format!("{:.3}", hop.landing_speed_m_s),
                format!("{:.2}", hop.flight_time_s),
                metres(hop.apex_z_m),
            ],
            y,
        );
        y += ROW_MM;
    }
    sheet.line(vec![(MARGIN_MM, rule_mm), (RIGHT_MM, rule_mm)], Pen { colour: AXIS, width_mm: 0.15 });
    y
}
