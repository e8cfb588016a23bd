//! The part of a triangle within a distance beside a vertical plane, seen along the normal of the plane.

use nalgebra::Point3;

use super::VerticalPlane;
use crate::quantity::ChainPoint;

/// A convex polygon of at most five corners: a triangle clipped to a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabPolygon {
    corners: [ChainPoint; 5],
    count: usize,
}

impl SlabPolygon {
    /// The part of a triangle within a distance beside a plane; `None` where it has none.
    pub(super) fn of(plane: &VerticalPlane, triangle: &[Point3<f64>; 3], within_m: f64) -> Option<Self> {
        // Along the plane, up, and to the left of it.
        let mut kept = [[0.0; 3]; 5];
        for (kept, corner) in kept.iter_mut().zip(triangle) {
            let along = plane.along(*corner);
            *kept = [along.x_m, along.z_m, plane.left_m(*corner)];
        }
        let mut count = 3;
        for sign in [1.0, -1.0] {
            let before = kept;
            let room = |corner: [f64; 3]| within_m - sign * corner[2];
            let mut next = 0;
            for i in 0..count {
                let (from, to) = (before[i], before[(i + 1) % count]);
                let (here, there) = (room(from), room(to));
                if here >= 0.0 {
                    kept[next] = from;
                    next += 1;
                }
                if (here >= 0.0) != (there >= 0.0) {
                    let share = here / (here - there);
                    kept[next] = [0, 1, 2].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
                    next += 1;
                }
            }
            count = next;
            if count == 0 {
                return None;
            }
        }
        Some(Self { corners: kept.map(|corner| ChainPoint::new(corner[0], corner[1])), count })
    }

    /// The corners.
    pub fn corners(&self) -> &[ChainPoint] {
        &self.corners[..self.count]
    }
}
