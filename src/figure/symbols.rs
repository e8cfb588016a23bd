//! The symbols of the picture, the same in the panels and in the legend.

use plotters::style::RGBColor;

use super::{
    data::Cone,
    palette::{BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, SURFACE, VERMILION},
    scale::Frame,
    sheet::{Pen, Place, Sheet, steps_along},
    spans::{Closure, GroundUse},
};
use crate::{
    quantity::Angle,
    world::{Contact, Direction},
};

/// The surface of the ground.
pub(super) const SURFACE_PEN: Pen = Pen { colour: SURFACE, width_mm: 0.3 };
/// Flights.
const ARC_PEN: Pen = Pen { colour: BLUE, width_mm: 0.35 };
/// The refused hop with the smallest violation.
const MISS_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.3 };
/// Number of sectors of a drawn cone.
const RAYS: u32 = 16;

/// A flight: a solid line forward, a dashed one in reverse.
pub(super) fn flight(sheet: &mut Sheet, points: Vec<Place>, direction: Direction) {
    match direction {
        Direction::Forward => sheet.line(points, ARC_PEN),
        Direction::Reverse => sheet.dashed(&points, 1.6, 0.7, ARC_PEN),
    }
}

/// A cone as a wedge of a given length, with a solid outline for take-off and a dashed one for landing.
pub(super) fn cone(sheet: &mut Sheet, frame: &Frame, cone: &Cone, length_mm: f64) {
    let apex = frame.place(cone.apex);
    let Some(angles) = cone.slopes.angles() else { return };
    let (min, max) = (angles.min.radians(), angles.max.radians());
    let rim = (0..=RAYS).map(|i| {
        let slope = Angle::from_radians(min + (max - min) * f64::from(i) / f64::from(RAYS)).slope();
        let (x, y) = frame.direction(cone.ray(slope));
        (apex.0 + x * length_mm, apex.1 + y * length_mm)
    });
    wedge(sheet, std::iter::once(apex).chain(rim).collect(), cone.contact);
}

/// A wedge of a cone.
pub(super) fn wedge(sheet: &mut Sheet, points: Vec<Place>, contact: Contact) {
    let closed: Vec<Place> = points.iter().copied().chain(points.first().copied()).collect();
    let colour = if contact == Contact::Takeoff { SKY } else { ORANGE };
    sheet.area(points, colour, 0.35);
    let pen = Pen { colour, width_mm: 0.15 };
    match contact {
        Contact::Takeoff => sheet.line(closed, pen),
        Contact::Landing => sheet.dashed(&closed, 0.6, 0.4, pen),
    }
}

/// A take-off point.
pub(super) fn takeoff(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 0.45, BLACK);
}

/// A landing point.
pub(super) fn landing(sheet: &mut Sheet, at: Place) {
    sheet.ring(at, 0.85, Pen { colour: BLACK, width_mm: 0.2 });
}

/// A node of the search.
pub(super) fn node(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 0.32, SURFACE);
}

/// A start or goal without any feasible hop.
pub(super) fn cross(sheet: &mut Sheet, (x, y): Place) {
    let pen = Pen { colour: VERMILION, width_mm: 0.5 };
    sheet.line(vec![(x - 1.4, y - 1.4), (x + 1.4, y + 1.4)], pen);
    sheet.line(vec![(x - 1.4, y + 1.4), (x + 1.4, y - 1.4)], pen);
}

/// The nearest usable point.
pub(super) fn usable(sheet: &mut Sheet, at: Place) {
    sheet.ring(at, 1.3, Pen { colour: GREEN, width_mm: 0.45 });
}

/// The refused hop with the smallest violation.
pub(super) fn nearest_miss(sheet: &mut Sheet, points: &[Place]) {
    sheet.dashed(points, 1.2, 0.8, MISS_PEN);
}

/// Ground reachable from the start (solid), or from which the goal can be reached (dashed).
pub(super) fn band(sheet: &mut Sheet, points: &[Place], from_start: bool) {
    let raised: Vec<Place> = points.iter().map(|&(x, y)| (x, y - 1.1)).collect();
    if from_start {
        sheet.line(raised, Pen { colour: BLUE, width_mm: 0.9 });
    } else {
        sheet.dashed(&raised, 1.6, 0.8, Pen { colour: GREEN, width_mm: 0.9 });
    }
}

/// The hatching of a closed stretch.
struct Hatch {
    colour: RGBColor,
    /// Slant of the strokes from the surface normal, as tangents.
    leans: &'static [f64],
    step_mm: f64,
    length_mm: f64,
}

const fn hatch(closure: Closure) -> Hatch {
    match closure {
        Closure::KeepOut => Hatch { colour: BLACK, leans: &[1.0, -1.0], step_mm: 1.8, length_mm: 1.8 },
        Closure::Layer => Hatch { colour: SURFACE, leans: &[-1.0], step_mm: 1.8, length_mm: 1.8 },
        Closure::RestSlope => Hatch { colour: VERMILION, leans: &[-1.0], step_mm: 1.1, length_mm: 2.0 },
        Closure::FootprintSlope => Hatch { colour: ORANGE, leans: &[-1.0], step_mm: 1.1, length_mm: 2.0 },
        Closure::Roughness => Hatch { colour: ORANGE, leans: &[1.0, -1.0], step_mm: 1.8, length_mm: 1.8 },
        Closure::Cones => Hatch { colour: PURPLE, leans: &[1.0], step_mm: 1.1, length_mm: 2.0 },
        Closure::SpeedZero => Hatch { colour: BLUE, leans: &[0.0], step_mm: 1.1, length_mm: 1.6 },
        Closure::NoLimits => Hatch { colour: SURFACE, leans: &[0.0], step_mm: 2.4, length_mm: 1.0 },
    }
}

/// A stretch of ground not open for both contacts: strokes into the ground if closed, else a dashed or dotted line.
pub(super) fn ground(sheet: &mut Sheet, points: &[Place], allows: GroundUse) {
    match allows {
        GroundUse::Both => {}
        GroundUse::LandingOnly => sheet.dashed(points, 2.0, 0.8, Pen { colour: ORANGE, width_mm: 0.7 }),
        GroundUse::TakeoffOnly => sheet.dashed(points, 0.6, 0.6, Pen { colour: SKY, width_mm: 0.7 }),
        GroundUse::Closed(closure) => {
            let Hatch { colour, leans, step_mm, length_mm } = hatch(closure);
            sheet.line(points.to_vec(), Pen { colour, width_mm: 0.55 });
            for ((x, y), (ax, ay)) in steps_along(points, step_mm) {
                for lean in leans {
                    // Into the ground: the surface's direction rotated clockwise on the sheet.
                    let (dx, dy) = (-ay + lean * ax, ax + lean * ay);
                    let length = libm::hypot(dx, dy) / length_mm;
                    sheet.line(vec![(x, y), (x + dx / length, y + dy / length)], Pen { colour, width_mm: 0.2 });
                }
            }
        }
    }
}
