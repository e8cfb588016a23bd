//! The legend: one entry for each kind of symbol in the picture.

use super::{
    clearance,
    data::{FigureData, Subject, Thinned},
    palette::{LEFT_MM, RIGHT_MM, SMALL_MM},
    sheet::{Label, Place, Sheet, text_width_mm},
    spans::{Closure, GroundUse},
    symbols,
    terrain_panel::DrawnMarks,
    touchdown,
};
use crate::world::{Contact, Direction};

/// Width of a sample.
const SAMPLE_MM: f64 = 6.5;
/// Spacing of rows.
const ROW_MM: f64 = 4.2;

/// A kind of symbol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Key {
    Flight(Direction),
    Cone(Contact),
    Contact(Contact),
    Clearance,
    Touchdown,
    Node,
    Ground(GroundUse),
    Reached,
    LeadsToGoal,
    NearestMiss,
    Refusing,
    Usable,
}

/// The entries that a picture needs, for the marks that its panel has.
pub(super) fn entries(data: &FigureData, drawn: DrawnMarks) -> Vec<(Key, String)> {
    let mut found: Vec<(Key, String)> = Vec::new();
    match &data.subject {
        Subject::Path { hops, .. } => {
            for direction in Direction::BOTH {
                if hops.shown.iter().any(|h| h.hop.direction == direction) {
                    found.push((Key::Flight(direction), thinned_text(&format!("hop, {}", direction.name()), hops)));
                }
            }
            if !hops.shown.is_empty() {
                found.push((Key::Contact(Contact::Takeoff), "take-off".to_owned()));
                if drawn.landings {
                    found.push((Key::Contact(Contact::Landing), "landing".to_owned()));
                }
                // Of hops beside the line, neither cones nor clearance are drawn: they belong to other ground.
                let on_line = hops.shown.iter().any(|hop| !hop.hop.is_beside_line());
                let has_cone = |end: usize| drawn.cones && hops.shown.iter().any(|hop| hop.cones[end].is_some());
                if has_cone(0) {
                    found.push((Key::Cone(Contact::Takeoff), "take-off cone".to_owned()));
                }
                match hops.shown.iter().find_map(|hop| hop.touchdown_m_s) {
                    None if has_cone(1) => found.push((Key::Cone(Contact::Landing), "landing cone".to_owned())),
                    None => {}
                    Some(speed_m_s) => found.push((Key::Touchdown, touchdown::words(speed_m_s))),
                }
                if data.clearance.has_kinks() && on_line {
                    found.push((Key::Clearance, "clearance".to_owned()));
                }
            }
        }
        Subject::Stopped(stop) => {
            if !stop.reached_x_m.is_empty() {
                found.push((Key::Reached, "reached from the start".to_owned()));
            }
            if !stop.leads_to_goal_x_m.is_empty() {
                found.push((Key::LeadsToGoal, "leads to the goal".to_owned()));
            }
            if stop.nearest_miss.is_some() {
                found.push((Key::NearestMiss, "nearest miss".to_owned()));
            }
        }
        Subject::NoCommands(..) | Subject::RouteNotFound => {}
        Subject::EndpointsRefuse(refusals) => {
            found.push((Key::Refusing, "refuses whatever the hop".to_owned()));
            if refusals.iter().any(|refusal| refusal.nearest.is_some()) {
                found.push((Key::Usable, "nearest usable point".to_owned()));
            }
        }
    }
    if data.nodes.of > 0 {
        found.push((Key::Node, thinned_text("node", &data.nodes)));
    }
    let uses = Closure::ALL.map(GroundUse::Closed).into_iter().chain([GroundUse::LandingOnly, GroundUse::TakeoffOnly]);
    for allows in uses.filter(|allows| data.spans.iter().any(|span| span.allows == *allows)) {
        let text = match allows {
            GroundUse::Closed(closure) => closure.text(),
            GroundUse::LandingOnly => "landing only",
            GroundUse::TakeoffOnly => "take-off only",
            GroundUse::Both => continue,
        };
        found.push((Key::Ground(allows), text.to_owned()));
    }
    found
}

/// A name, with the thinning if not all items are shown.
fn thinned_text<T>(name: &str, thinned: &Thinned<T>) -> String {
    if thinned.every == 1 { name.to_owned() } else { format!("{name} (1 in {} of {} shown)", thinned.every, thinned.of) }
}

/// Draws entries in rows from a height downwards; returns where they end.
pub(super) fn draw(sheet: &mut Sheet, entries: &[(Key, String)], top_mm: f64) -> f64 {
    let mut at = (LEFT_MM, top_mm + 0.5 * ROW_MM);
    for (key, text) in entries {
        let width = SAMPLE_MM + 1.2 + text_width_mm(text, SMALL_MM);
        if at.0 > LEFT_MM && at.0 + width > RIGHT_MM {
            at = (LEFT_MM, at.1 + ROW_MM);
        }
        sample(sheet, *key, at);
        sheet.label(Label::new(text.as_str(), (at.0 + SAMPLE_MM + 1.2, at.1), SMALL_MM));
        at.0 += width + 3.0;
    }
    at.1 + 0.5 * ROW_MM
}

/// A symbol in a box of the legend.
fn sample(sheet: &mut Sheet, key: Key, (x, y): Place) {
    let middle = (x + 0.5 * SAMPLE_MM, y);
    let across = [(x, y), (x + SAMPLE_MM, y)];
    match key {
        Key::Flight(direction) => {
            let bow = (0..=12).map(|i| {
                let share = f64::from(i) / 12.0;
                (x + SAMPLE_MM * share, y + 1.3 - 10.4 * share * (1.0 - share))
            });
            symbols::flight(sheet, bow.collect(), direction);
        }
        Key::Cone(contact) => {
            symbols::wedge(sheet, vec![(middle.0, y + 1.4), (middle.0 - 1.4, y - 1.2), (middle.0 + 1.4, y - 1.2)], contact);
        }
        Key::Contact(Contact::Takeoff) => symbols::takeoff(sheet, middle),
        Key::Contact(Contact::Landing) => symbols::landing(sheet, middle),
        Key::Clearance => clearance::band(sheet, &across.map(|(x, y)| (x, y - 1.0)), &across.map(|(x, y)| (x, y + 1.0))),
        Key::Touchdown => touchdown::arrow(sheet, (middle.0, middle.1 + 1.6)),
        Key::Node => {
            sheet.line(across.to_vec(), symbols::SURFACE_PEN);
            symbols::node(sheet, middle);
        }
        Key::Ground(allows) => symbols::ground(sheet, &[(x, y - 0.6), (x + SAMPLE_MM, y - 0.6)], allows),
        Key::Reached | Key::LeadsToGoal => symbols::band(sheet, &[(x, y + 1.1), (x + SAMPLE_MM, y + 1.1)], key == Key::Reached),
        Key::NearestMiss => symbols::nearest_miss(sheet, &across),
        Key::Refusing => symbols::cross(sheet, middle),
        Key::Usable => symbols::usable(sheet, middle),
    }
}
