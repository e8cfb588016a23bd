//! The lofts that an obstacle blocks for a box that keeps its orientation: the trunk of a legged robot.
//!
//! ```text
//!        .-----------.             The box meets a triangle where its reference point lies in the sum of the triangle and the mirrored
//!       /  triangle   \            box, a convex polytope. The plane in which the reference point flies cuts it in a convex polygon,
//!      |   + mirrored  |           which blocks one interval of lofts, as any connected set of that plane does
//!       \     box     /            ([`blocked_lofts`](super::blocked_lofts)).
//!        '-----------'
//! ```
//!
//! So the arcs that a box of fixed orientation can fly are found in closed form, where Campana and others (2016, *Planning jumping
//! motions*, seed of the planner) sample arcs and test the box in steps.

use nalgebra::Vector3;

use super::{
    ClearanceProfile,
    convex_hull::{HULL_POINTS, blocked_by_hull, convex_hull},
};
use crate::{
    ballistics::LineOfSight,
    quantity::{ChainPoint, SlopeInterval},
};

/// The edges of a box, by the numbers of its corners: two corners whose numbers differ in one bit.
const EDGES: [[usize; 2]; 12] = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// A box in flight, in the frame of the plane of travel: ahead along the heading, to the left of the plane, and up.
///
/// Its corners are given from the reference point that flies the arc, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlownBox {
    corners: [Vector3<f64>; 8],
    /// The least and the greatest coordinates of its corners, m.
    bounds_m: [Vector3<f64>; 2],
}

impl FlownBox {
    /// A box by its middle and its three half edges, from the reference point, m.
    pub fn new(middle: Vector3<f64>, half_edges: [Vector3<f64>; 3]) -> Self {
        let signed = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { -half_edges[axis] } else { half_edges[axis] };
        let corners = std::array::from_fn(|corner| middle + signed(corner, 0) + signed(corner, 1) + signed(corner, 2));
        let around = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
        let bounds_m = corners
            .iter()
            .fold(around, |[low, high]: [Vector3<f64>; 2], corner: &Vector3<f64>| [low.inf(corner), high.sup(corner)]);
        Self { corners, bounds_m }
    }

    /// Its corners.
    pub const fn corners(&self) -> &[Vector3<f64>; 8] {
        &self.corners
    }

    /// The least and the greatest coordinates of its corners, m.
    pub const fn bounds_m(&self) -> [Vector3<f64>; 2] {
        self.bounds_m
    }
}

/// The lofts of the arcs on which a box of fixed orientation meets a triangle, or comes nearer to it than the clearance over or under it,
/// while its reference point is between two distances from the take-off.
///
/// # Arguments
/// `triangle`: its corners in the frame of the plane of travel (ahead, left, up) from the reference point at take-off, m. `between_m`: of the
/// reference point, horizontal, within the line of sight, m.
///
/// # Returns
/// The interval from the flattest to the steepest arc that meets it; empty if none does. Where the box meets the triangle at the take-off
/// itself, all lofts.
///
/// # Complexity
/// 60 crossings of the plane, and a hull of at most as many points; no allocation.
///
/// # Examples
/// ```
/// use chta::{ballistics::{LineOfSight, limits::{ClearanceProfile, FlownBox, blocked_lofts_of_box}}};
/// use nalgebra::Vector3;
/// // A cube of 1 m, and a triangle that holds all places 2 m over the middle of a hop of 8 m: the centre is kept from heights of 1.5 m to
/// // 2.5 m, and n = h X / (d e) = h 8 / 16 there, less nowhere beside it.
/// let cube = FlownBox::new(Vector3::zeros(), [Vector3::x() * 0.5, Vector3::y() * 0.5, Vector3::z() * 0.5]);
/// let triangle = [Vector3::new(3.9, -9.0, 2.0), Vector3::new(4.1, -9.0, 2.0), Vector3::new(4.0, 9.0, 2.0)];
/// let sight = LineOfSight::new(8.0, 0.0);
/// let blocked = blocked_lofts_of_box(sight, &triangle, &cube, [0.0, 8.0], ClearanceProfile::NONE);
/// assert!((blocked.lower - 0.75).abs() < 1e-12 && blocked.upper > 1.25 && blocked.upper < 1.3);
/// ```
pub fn blocked_lofts_of_box(
    sight: LineOfSight,
    triangle: &[Vector3<f64>; 3],
    flown: &FlownBox,
    between_m: [f64; 2],
    clearance: ClearanceProfile,
) -> SlopeInterval {
    let mut points = [ChainPoint::new(0.0, 0.0); HULL_POINTS];
    let count = crossings(triangle, flown, |[x_m, z_m], count| {
        // Over the line of sight straight lines stay straight.
        points[count] = ChainPoint::new(x_m, z_m - sight.slope() * x_m);
    });
    if count == 0 {
        return SlopeInterval::EMPTY;
    }
    blocked_by_hull(sight.run_m(), between_m, &mut points[..count], clearance)
}

/// The border of the places of the plane of travel at which a box of fixed orientation meets a triangle: a convex polygon, by its corners in
/// order, as horizontal distance from the take-off and height over it, m. Empty if the box never meets it. `border`: where they are written.
pub fn border_of_box<'a>(triangle: &[Vector3<f64>; 3], flown: &FlownBox, border: &'a mut BoxBorder) -> &'a [ChainPoint] {
    let mut points = [ChainPoint::new(0.0, 0.0); HULL_POINTS];
    let count = crossings(triangle, flown, |[x_m, z_m], count| points[count] = ChainPoint::new(x_m, z_m));
    if count == 0 { &[] } else { convex_hull(&mut points[..count], border) }
}

/// The border of what a box meets, with room for the most corners.
pub type BoxBorder = [ChainPoint; HULL_POINTS + 1];

/// Visits places of the plane of travel whose convex hull holds all places at which a box meets a triangle, with their numbers; how many there
/// are, at most [`HULL_POINTS`].
fn crossings(triangle: &[Vector3<f64>; 3], flown: &FlownBox, mut visit: impl FnMut([f64; 2], usize)) -> usize {
    let left = triangle.map(|corner| corner.y);
    let [rightmost, leftmost] = [left[0].min(left[1]).min(left[2]), left[0].max(left[1]).max(left[2])];
    let [low, high] = flown.bounds_m;
    if rightmost > high.y || leftmost < low.y {
        return 0;
    }
    let mut count = 0;
    // The edges of the polytope are among those of the box at corners of the triangle, and those of the triangle at corners of the box.
    let mut cross = |from: Vector3<f64>, to: Vector3<f64>| {
        if (from.y < 0.0 && to.y < 0.0) || (from.y > 0.0 && to.y > 0.0) {
            return;
        }
        let apart = from.y - to.y;
        let share = if apart == 0.0 { 0.0 } else { from.y / apart };
        let mut add = |share: f64| {
            visit([from.x + (to.x - from.x) * share, from.z + (to.z - from.z) * share], count);
            count += 1;
        };
        add(share);
        if apart == 0.0 {
            add(1.0);
        }
    };
    for corner in triangle {
        for [a, b] in EDGES {
            cross(corner - flown.corners[a], corner - flown.corners[b]);
        }
    }
    for corner in &flown.corners {
        for i in 0..3 {
            cross(triangle[i] - corner, triangle[(i + 1) % 3] - corner);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ballistics::Arc, draw::Draw};

    fn drawn(draw: &mut Draw, size_m: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| draw.uniform(-size_m, size_m))
    }

    /// Whether a box meets a triangle: no plane of the thirteen directions separates them by more than `gap_m`.
    fn meets(flown: &FlownBox, at: Vector3<f64>, triangle: &[Vector3<f64>; 3], gap_m: f64) -> bool {
        let c = flown.corners;
        let edges = [c[1] - c[0], c[2] - c[0], c[4] - c[0]];
        let sides = [triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]];
        let mut axes = vec![sides[0].cross(&sides[1])];
        for (i, edge) in edges.iter().enumerate() {
            axes.push(edge.cross(&edges[(i + 1) % 3]));
            axes.extend(sides.iter().map(|side| side.cross(edge)));
        }
        let span = |points: &[Vector3<f64>], axis: &Vector3<f64>, by: f64| {
            points
                .iter()
                .map(|point| point.dot(axis) + by)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        };
        axes.iter().filter_map(|axis| axis.try_normalize(1e-12)).all(|axis| {
            let (body, side) = (span(&c, &axis, at.dot(&axis)), span(triangle, &axis, 0.0));
            body[0] <= side[1] + gap_m && side[0] <= body[1] + gap_m
        })
    }

    /// Arcs flown in small steps with a separating-axis test: none of the free ones meets the triangle, and those just inside the blocked
    /// ends do.
    #[test]
    fn blocked_lofts_are_those_on_which_the_box_meets_the_triangle() {
        let draw = &mut Draw::seeded(2016);
        let (mut free, mut hit, mut ends, mut all) = (0, 0, 0, 0);
        for round in 0..3_000 {
            let run_m = draw.uniform(0.5, 4.0);
            let sight = LineOfSight::new(run_m, draw.uniform(-3.0, 3.0));
            let axes =
                nalgebra::Rotation3::from_euler_angles(draw.uniform(-3.0, 3.0), draw.uniform(-1.5, 1.5), draw.uniform(-3.0, 3.0));
            let half = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axes * axis * draw.uniform(0.02, 0.4));
            let flown = FlownBox::new(drawn(draw, 0.3), half);
            let middle = Vector3::new(draw.uniform(-0.2, run_m + 0.2), draw.uniform(-0.6, 0.6), draw.uniform(-2.0, 3.0));
            let mut triangle = [0; 3].map(|_| middle + drawn(draw, 1.0));
            match round % 6 {
                // A point, a segment, and one in the plane of flight.
                0 => triangle[1] = triangle[0],
                1 => triangle = [triangle[0]; 3],
                2 => triangle.iter_mut().for_each(|corner| corner.y = 0.0),
                _ => {}
            }
            let blocked = blocked_lofts_of_box(sight, &triangle, &flown, [0.0, run_m], ClearanceProfile::NONE);
            let flies_into = |loft: f64, steps: u32, gap_m: f64| {
                let arc = Arc::new(sight, loft, 1.0);
                (0..=steps).any(|step| {
                    let x_m = run_m * f64::from(step) / f64::from(steps);
                    meets(&flown, Vector3::new(x_m, 0.0, arc.height_at_m(x_m)), &triangle, gap_m)
                })
            };
            for _ in 0..8 {
                let loft = draw.log_uniform(1e-3, 30.0);
                if blocked.contains(loft) {
                    hit += 1;
                } else {
                    free += 1;
                    assert!(!flies_into(loft, 200, -1e-9), "round {round}: loft {loft} meets the triangle, blocked {blocked:?}");
                }
            }
            if blocked == SlopeInterval::ALL {
                all += 1;
                for loft in [0.01, 0.3, 1.0, 4.0] {
                    assert!(flies_into(loft, 4_000, 0.03), "round {round}: loft {loft} passes by an obstacle that blocks all");
                }
            }
            for loft in [blocked.lower, blocked.upper] {
                if loft.is_finite() && loft > 0.0 && loft < 30.0 && !blocked.is_empty() && ends < 300 {
                    ends += 1;
                    assert!(flies_into(loft, 4_000, 0.03), "round {round}: loft {loft} at an end passes by, blocked {blocked:?}");
                }
            }
        }
        assert!(free > 5_000 && hit > 500 && ends == 300 && all > 20, "{free} free, {hit} hit, {ends} ends, {all} all");
    }
}
