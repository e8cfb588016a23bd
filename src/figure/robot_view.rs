//! A robot with legs drawn from one side: its trunk, its limbs, and the ground.

use nalgebra::Vector3;
use plotters::style::RGBColor;

use super::{
    axes::Panel,
    palette::{BLACK, BLUE, GROUND, ORANGE, SURFACE, VERMILION, WHITE},
    sheet::{Pen, Place, Sheet},
    ticks::Ticks,
};
use crate::quantity::ChainPoint;

pub(super) const GROUND_PEN: Pen = Pen { colour: SURFACE, width_mm: 0.45 };
pub(super) const TRUNK_PEN: Pen = Pen { colour: BLACK, width_mm: 0.35 };
pub(super) const LIMB_PEN: Pen = Pen { colour: BLUE, width_mm: 0.6 };
pub(super) const NORMAL_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.5 };
pub(super) const TRUNK: RGBColor = ORANGE;

/// A limb.
#[derive(Clone, Debug, PartialEq)]
pub struct LimbMark {
    /// From its hip over its joints, where they are known, to its foot, m from the root.
    pub points_m: Vec<Vector3<f64>>,
    /// The normal of the ground, of a foot that stands and of which it is drawn.
    pub normal: Option<Vector3<f64>>,
    /// Whether the foot stands.
    pub stands: bool,
}

/// A robot in a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotMark {
    /// The corners of the boxes of its trunk, m from the root.
    pub boxes: Vec<[Vector3<f64>; 8]>,
    /// Its limbs.
    pub limbs: Vec<LimbMark>,
    /// The cut of the ground by the vertical plane through the root along the view from the side, m from the root.
    pub cut: Vec<[ChainPoint; 2]>,
}

impl RobotMark {
    /// The distance of its farthest point from the root, m.
    pub(super) fn size_m(&self) -> f64 {
        let points = self.boxes.iter().flatten().chain(self.limbs.iter().flat_map(|limb| &limb.points_m));
        points.map(Vector3::norm).fold(0.0, f64::max).max(1e-9)
    }
}

/// A view of the robot: ground coordinates to (across, up) of a panel.
pub(super) struct View<'a> {
    pub(super) panel: Panel,
    pub(super) mm_per_m: f64,
    /// The middle of the panel, m.
    pub(super) middle: [f64; 2],
    pub(super) flat: &'a dyn Fn(Vector3<f64>) -> [f64; 2],
}

impl View<'_> {
    pub(super) fn place(&self, at: Vector3<f64>) -> Place {
        self.at((self.flat)(at))
    }

    pub(super) fn at(&self, [across, up]: [f64; 2]) -> Place {
        let (x, y) = (f64::midpoint(self.panel.left, self.panel.right), f64::midpoint(self.panel.top, self.panel.bottom));
        (x + (across - self.middle[0]) * self.mm_per_m, y - (up - self.middle[1]) * self.mm_per_m)
    }

    pub(super) fn axes(&self, sheet: &mut Sheet, [across, up]: [&str; 2]) {
        let half = [0.5 * self.panel.width() / self.mm_per_m, 0.5 * self.panel.height() / self.mm_per_m];
        let ticks = |axis: usize| Ticks::round(self.middle[axis] - half[axis], self.middle[axis] + half[axis], 5.0);
        let (x, y) = (ticks(0), ticks(1));
        let xs: Vec<_> = x.values.iter().map(|value| (self.at([*value, 0.0]).0, x.text(*value))).collect();
        let ys: Vec<_> = y.values.iter().map(|value| (self.at([0.0, *value]).1, y.text(*value))).collect();
        self.panel.x_axis(sheet, &xs, across, true);
        self.panel.y_axis(sheet, &ys, up, true);
    }

    /// Whether a place lies on the panel.
    pub(super) fn shows(&self, (x, y): Place) -> bool {
        (self.panel.left..=self.panel.right).contains(&x) && (self.panel.top..=self.panel.bottom).contains(&y)
    }

    /// The trunk, the limbs, the feet and the normals of the ground.
    pub(super) fn robot(&self, sheet: &mut Sheet, robot: &RobotMark, size_m: f64) {
        for corners in &robot.boxes {
            let mut places: Vec<Place> = corners.iter().map(|corner| self.place(*corner)).collect();
            let outline = hull(&mut places);
            sheet.area(outline.clone(), TRUNK, 0.55);
            sheet.line(outline.iter().copied().chain(outline.first().copied()).collect(), TRUNK_PEN);
        }
        for limb in &robot.limbs {
            let places: Vec<Place> = limb.points_m.iter().map(|point| self.place(*point)).collect();
            // Joints that are known are points of the limb between its ends.
            for joint in places.iter().skip(1).rev().skip(1) {
                sheet.dot(*joint, 0.5, BLUE);
            }
            sheet.line(places, LIMB_PEN);
            let Some(foot_m) = limb.points_m.last() else { continue };
            if let Some(normal) = limb.normal {
                sheet.line(vec![self.place(*foot_m), self.place(*foot_m + normal * (0.25 * size_m))], NORMAL_PEN);
            }
            if limb.stands {
                sheet.dot(self.place(*foot_m), 0.9, BLUE);
            } else {
                sheet.dot(self.place(*foot_m), 0.8, BLUE);
                sheet.dot(self.place(*foot_m), 0.5, WHITE);
            }
        }
        sheet.dot(self.place(Vector3::zeros()), 0.9, WHITE);
        sheet.dot(self.place(Vector3::zeros()), 0.6, BLACK);
    }

    /// The ground in the plane of the view.
    pub(super) fn ground(&self, sheet: &mut Sheet, cut: &[[ChainPoint; 2]]) {
        let Panel { left, right, top, bottom } = self.panel;
        for [from, to] in cut {
            let ends = [self.at([from.x_m, from.z_m]), self.at([to.x_m, to.z_m])];
            if let Some([a, b]) = clipped(ends, [(left, top), (right, bottom)]) {
                if (b.0 - a.0).abs() > 0.01 {
                    sheet.area(vec![a, b, (b.0, bottom), (a.0, bottom)], GROUND, 0.5);
                }
                sheet.line(vec![a, b], GROUND_PEN);
            }
        }
    }
}

/// The part of a segment within a rectangle.
fn clipped([a, b]: [Place; 2], [low, high]: [Place; 2]) -> Option<[Place; 2]> {
    let (mut from, mut to) = (0.0, 1.0);
    for (start, end, least, most) in [(a.0, b.0, low.0, high.0), (a.1, b.1, low.1, high.1)] {
        let step = end - start;
        if step == 0.0 {
            if start < least || start > most {
                return None;
            }
            continue;
        }
        let (enter, leave) = ((least - start) / step, (most - start) / step);
        from = f64::max(from, enter.min(leave));
        to = f64::min(to, enter.max(leave));
    }
    let at = |share: f64| (a.0 + (b.0 - a.0) * share, a.1 + (b.1 - a.1) * share);
    (from <= to).then(|| [at(from), at(to)])
}

/// The convex hull of places, in order around it.
fn hull(places: &mut [Place]) -> Vec<Place> {
    places.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let turns = |a: Place, b: Place, c: Place| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let half = |places: &mut dyn Iterator<Item = Place>| {
        let mut found: Vec<Place> = Vec::new();
        for place in places {
            while found.len() >= 2 && turns(found[found.len() - 2], found[found.len() - 1], place) <= 0.0 {
                found.pop();
            }
            found.push(place);
        }
        found.pop();
        found
    };
    let mut outline = half(&mut places.iter().copied());
    outline.extend(half(&mut places.iter().rev().copied()));
    outline
}
