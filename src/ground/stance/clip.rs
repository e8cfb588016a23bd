//! The part of a triangle that the foot of a limb reaches, in the trunk frame.
//!
//! A convex workspace clips a triangle to one polygon, exactly (I. E. Sutherland and G. W. Hodgman 1974). A sector of a shell does not: its
//! bounding box clips the triangle, and the rest is divided into cells that are small against the shell; those whose middle is in the sector
//! count.

use nalgebra::{Point3, Vector3};

use crate::world::{HalfSpace, Limb, Shell, TrunkBounds, Workspace};

/// The greatest side of a cell, as a share of the greater radius of a shell.
const CELL: f64 = 0.125;

/// How far the corners of a triangle are from its middle at most, as a share of its longest side: two thirds of a median, rounded up.
const FROM_THE_MIDDLE: f64 = 0.666_666_67;

/// The room of a ball for rounding, as a share of the coordinates that it holds.
const ROUNDING: f64 = 1e-12;

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
    /// The half-space that left nothing of the last triangle, which is likely to do so again.
    emptied_by: usize,
}

impl Clipper {
    /// Visits the parts of a triangle, in the trunk frame, that the foot of a limb reaches.
    ///
    /// `bounds`: those of the limb.
    pub(super) fn pieces(
        &mut self,
        (limb, bounds): (&Limb, TrunkBounds),
        triangle: &[Point3<f64>; 3],
        mut visit: impl FnMut(Piece),
    ) {
        let [a, b, c] = triangle;
        let around = [a.inf(b).inf(c), a.sup(b).sup(c)];
        if !meet(around, bounds) {
            return;
        }
        match &limb.workspace {
            Workspace::Convex(convex) => {
                self.start(triangle);
                if self.clip(convex.half_spaces(), around)
                    && let Some(piece) = middle_of(&self.polygon)
                {
                    visit(piece);
                }
            }
            Workspace::Shell(shell) if shell.radius_max_m() > 0.0 => {
                self.start(triangle);
                if self.clip(&sides_of(bounds), around) {
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

    /// Clips the polygon, which lies within bounds, to an intersection of half-spaces; whether anything is left.
    ///
    /// A ball about the bounds decides about most half-spaces, of which the workspace of a file has some two hundred.
    fn clip(&mut self, sides: &[HalfSpace], [low, high]: [Point3<f64>; 2]) -> bool {
        let middle = nalgebra::center(&low, &high);
        let radius_m = 0.5 * (high - low).norm() + ROUNDING * (low.coords.amax() + high.coords.amax());
        if sides.get(self.emptied_by).is_some_and(|side| self.polygon.iter().all(|corner| side.outside_m(corner) > 0.0)) {
            return false;
        }
        for (number, side) in sides.iter().enumerate() {
            let middle_out_m = side.outside_m(&middle);
            if middle_out_m < -radius_m {
                continue;
            }
            let outside = self.polygon.iter().map(|corner| side.outside_m(corner));
            let (mut any_in, mut any_out) = (false, false);
            outside.for_each(|out_m| if out_m <= 0.0 { any_in = true } else { any_out = true });
            if !any_in {
                self.emptied_by = number;
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

/// Whether two boxes meet.
fn meet([low, high]: [Point3<f64>; 2], [other_low, other_high]: [Point3<f64>; 2]) -> bool {
    (0..3).all(|axis| low[axis] <= other_high[axis] && other_low[axis] <= high[axis])
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
    let away_m = (middle - hip).norm();
    let reach_m = side * FROM_THE_MIDDLE;
    if away_m > shell.radius_max_m() + reach_m || away_m + reach_m < shell.radius_min_m() {
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot prepare its workspaces should stop")]

    use super::*;
    use crate::{draw::Draw, world::ConvexWorkspace};

    /// The corners of a triangle that lie in all half-spaces, one half-space after another.
    fn plainly(triangle: &[Point3<f64>; 3], sides: &[HalfSpace]) -> Vec<Point3<f64>> {
        sides.iter().fold(triangle.to_vec(), |polygon, side| {
            let mut left = Vec::new();
            for (i, from) in polygon.iter().enumerate() {
                let to = &polygon[(i + 1) % polygon.len()];
                let (here, there) = (side.outside_m(from), side.outside_m(to));
                left.extend((here <= 0.0).then_some(*from));
                if (here <= 0.0) != (there <= 0.0) {
                    left.push(from + (to - from) * (here / (here - there)));
                }
            }
            left
        })
    }

    #[test]
    fn shortcuts_leave_the_same_part_of_every_triangle() {
        let draw = &mut Draw::seeded(21);
        let mut clipper = Clipper::default();
        let (mut parts, mut wholes, mut nothings) = (0, 0, 0);
        for case in 0..400 {
            let points: Vec<Point3<f64>> =
                (0..4 + draw.below(120)).map(|_| Point3::from(Vector3::from_fn(|_, _| draw.uniform(-0.5, 0.5)))).collect();
            let Ok(convex) = ConvexWorkspace::hull_of(&points) else { continue };
            let limb = Limb::new("leg", Point3::origin(), Workspace::Convex(convex.clone()));
            for _ in 0..50 {
                let middle = Point3::from(Vector3::from_fn(|_, _| draw.uniform(-0.8, 0.8)));
                let size_m = [1e-3, 0.1, 1.0, 20.0][draw.below(4)];
                let triangle = [(); 3].map(|()| middle + Vector3::from_fn(|_, _| draw.uniform(-size_m, size_m)));
                let mut found = None;
                clipper.pieces((&limb, limb.bounds()), &triangle, |piece| found = Some(piece));
                let plain = plainly(&triangle, convex.half_spaces());
                let expected = if plain.len() > 2 { middle_of(&plain) } else { None };
                let area_m2 = |piece: Option<Piece>| piece.map_or(0.0, |piece| piece.area_m2);
                let whole_m2 = 0.5 * (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0])).norm();
                assert!((area_m2(found) - area_m2(expected)).abs() <= 1e-9 * whole_m2, "case {case}: {found:?} {expected:?}");
                if let (Some(found), Some(expected)) = (found, expected)
                    && expected.area_m2 > 1e-6 * whole_m2
                {
                    assert!((found.middle - expected.middle).norm() <= 1e-9 * size_m.max(1.0), "case {case}");
                }
                match found {
                    None => nothings += 1,
                    Some(piece) if piece.area_m2 >= whole_m2 * (1.0 - 1e-9) => wholes += 1,
                    Some(_) => parts += 1,
                }
            }
        }
        assert!(parts > 1_000 && wholes > 500 && nothings > 1_000, "{parts} {wholes} {nothings}");
    }
}
