//! The braked end of a hop: an arrow straight down onto its landing.

use super::{
    palette::{SMALL_MM, VERMILION},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet},
    ticks::short,
};

/// Length of the arrow: longer than the ring of a landing, shorter than most arcs are high.
const LENGTH_MM: f64 = 4.2;
const PEN: Pen = Pen { colour: VERMILION, width_mm: 0.45 };

/// The touchdown speed beside the arrow onto a landing, where there is room.
pub(super) fn speed(sheet: &mut Sheet, (x, y): Place, speed_m_s: f64) {
    let text = format!("{} m/s", short(speed_m_s));
    let beside = |at_x, anchor| Label::new(text.clone(), (at_x, y - LENGTH_MM), SMALL_MM).hung(anchor, Hang::Through);
    let places = [beside(x + 1.0, Anchor::Start), beside(x - 1.0, Anchor::End)];
    if let Some(label) = places.into_iter().find(|label| !sheet.is_taken(label)) {
        sheet.label(label);
    }
}

/// The arrow onto a landing.
pub(super) fn arrow(sheet: &mut Sheet, (x, y): Place) {
    let tip = y - 0.2;
    sheet.line(vec![(x, y - LENGTH_MM), (x, tip - 0.8)], PEN);
    sheet.area(vec![(x, tip), (x - 0.75, tip - 1.5), (x + 0.75, tip - 1.5)], PEN.colour, 1.0);
}

/// The entry of the legend.
pub(super) fn words(speed_m_s: f64) -> String {
    format!("brakes, touches down at {} m/s", short(speed_m_s))
}

/// The limits of a landing with brakes, for the heading.
pub(super) fn conditions(touchdown_m_s: f64, most_m_s: f64) -> String {
    let touchdown = format!("brakes to a touchdown of {} m/s", short(touchdown_m_s));
    if most_m_s.is_finite() { format!("{touchdown} (≤ {} m/s)", short(most_m_s)) } else { touchdown }
}
