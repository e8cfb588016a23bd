//! The part of a triangle that the foot of a limb reaches, in the trunk frame.
//!
//! A convex workspace clips a triangle to one polygon, exactly (I. E. Sutherland and G. W. Hodgman 1974). A sector of a shell does not: its
//! bounding box clips the triangle, and the rest is divided into cells that are small against the shell; those whose middle is in the sector
//! count.

use nalgebra::{Point3, Vector3};

use crate::world::{HalfSpace, Limb, Shell, Workspace};

/// The greatest side of a cell, as a share of the greater radius of a shell.
const CELL: f64 = 0.125;

/// A part of a triangle within reach: where it is, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// Its middle, m.
    pub(super) middle: Point3<f64>,
    /// Its area, m^2.
    pub(super) area_m2: f64,
}

/// Buffers of polygons.
#[derive(Clone, Debug, Default)]
pub(super) struct Clipper {
    polygon: Vec<Point3<f64>>,
    next: Vec<Point3<f64>>,
}

impl Clipper {
    /// Visits the parts of a triangle, in the trunk frame, that the foot of a limb reaches.
    pub(super) fn pieces(&mut self, limb: &Limb, triangle: &[Point3<f64>; 3], mut visit: impl FnMut(Piece)) {
        match &limb.workspace {
            Workspace::Convex(convex) => {
                self.start(triangle);
                if self.clip(convex.half_spaces())
                    && let Some(piece) = middle_of(&self.polygon)
                {
                    visit(piece);
                }
            }
            Workspace::Shell(shell) if shell.radius_max_m() > 0.0 => {
                self.start(triangle);
                if self.clip(&sides_of(limb.bounds())) {
                    let [first, rest @ ..] = &self.polygon[..] else { return };
                    for pair in rest.windows(2) {
                        cells([*first, pair[0], pair[1]], (shell, &limb.hip_m), &mut visit);
                    }
                }
            }
            // The foot is the hip itself.
            Workspace::Shell(_) => {}
        }
    }

    fn start(&mut self, triangle: &[Point3<f64>; 3]) {
        self.polygon.clear();
        self.polygon.extend(triangle);
    }

    /// Clips the polygon to an intersection of half-spaces; whether anything is left.
    fn clip(&mut self, sides: &[HalfSpace]) -> bool {
        for side in sides {
            let outside = self.polygon.iter().map(|corner| side.outside_m(corner));
            let (mut any_in, mut any_out) = (false, false);
            outside.for_each(|out_m| if out_m <= 0.0 { any_in = true } else { any_out = true });
            if !any_in {
                return false;
            }
            if !any_out {
                continue;
            }
            self.next.clear();
            for (i, from) in self.polygon.iter().enumerate() {
                let to = &self.polygon[(i + 1) % self.polygon.len()];
                let (here, there) = (side.outside_m(from), side.outside_m(to));
                if here <= 0.0 {
                    self.next.push(*from);
                }
                if (here <= 0.0) != (there <= 0.0) {
                    self.next.push(from + (to - from) * (here / (here - there)));
                }
            }
            std::mem::swap(&mut self.polygon, &mut self.next);
        }
        self.polygon.len() > 2
    }
}

/// The middle and the area of a plane polygon; `None` for one without area.
fn middle_of(polygon: &[Point3<f64>]) -> Option<Piece> {
    let [first, rest @ ..] = polygon else { return None };
    let (mut area, mut moment) = (0.0, Vector3::zeros());
    for pair in rest.windows(2) {
        let part = 0.5 * (pair[0] - first).cross(&(pair[1] - first)).norm();
        area += part;
        moment += (pair[0] - first + (pair[1] - first)) * (part / 3.0);
    }
    (area > 0.0).then(|| Piece { middle: first + moment / area, area_m2: area })
}

/// Halves a triangle by its longest side until it is a cell, and visits the cells whose middle is in a shell about a hip.
fn cells(triangle: [Point3<f64>; 3], of: (&Shell, &Point3<f64>), visit: &mut impl FnMut(Piece)) {
    let (shell, hip) = of;
    let [a, b, c] = triangle;
    let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0);
    let sides = [(b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared()];
    let longest = (0..3).max_by(|i, j| sides[*i].total_cmp(&sides[*j])).unwrap_or(0);
    let side = sides[longest].sqrt();
    if (middle - hip).norm() > shell.radius_max_m() + side {
        return;
    }
    if side > CELL * shell.radius_max_m() {
        let [a, b, c] = [triangle[longest], triangle[(longest + 1) % 3], triangle[(longest + 2) % 3]];
        let half = nalgebra::center(&a, &b);
        cells([a, half, c], of, visit);
        cells([half, b, c], of, visit);
        return;
    }
    let area_m2 = 0.5 * (b - a).cross(&(c - a)).norm();
    if area_m2 > 0.0 && shell.contains(hip, &middle) {
        visit(Piece { middle, area_m2 });
    }
}

/// The sides of an axis-parallel box.
fn sides_of([low, high]: [Point3<f64>; 2]) -> [HalfSpace; 6] {
    std::array::from_fn(|side| {
        let axis = side / 2;
        let (sign, offset_m) = if side % 2 == 0 { (1.0, high[axis]) } else { (-1.0, -low[axis]) };
        HalfSpace { normal: nalgebra::Unit::new_unchecked(Vector3::ith(axis, sign)), offset_m }
    })
}
