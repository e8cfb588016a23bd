//! What the trunk of a standing robot touches.

use nalgebra::{Point3, Vector3};

use super::{Pose, StanceGround, TrunkHit, foothold::around};
use crate::world::TrunkBox;

impl StanceGround {
    /// The first facet of the mesh, in its order, that the trunk meets in a pose, box by box.
    pub fn trunk_hit(&self, pose: &Pose) -> Option<TrunkHit> {
        self.robot().trunk().iter().enumerate().find_map(|(number, part)| {
            let corners = part.corners_m();
            let bounds = corners.iter().fold([corners[0]; 2], |[low, high], corner| [low.inf(corner), high.sup(corner)]);
            let [low, high] = around(pose, bounds);
            let mut hit: Option<TrunkHit> = None;
            self.mesh().tree().visit(
                |min, max| (0..3).all(|axis| min[axis] <= high[axis] && low[axis] <= max[axis]),
                |facet, triangle| {
                    let inside = triangle.map(|corner| within(part, &pose.to_trunk(&corner)));
                    if hit.is_none_or(|known| facet < known.facet) && meets(part.half_m, &inside) {
                        let middle_m = pose.to_ground(&part.centre_m);
                        hit = Some(TrunkHit { part: number, facet, middle_m });
                    }
                },
            );
            hit
        })
    }
}

/// A point of the trunk frame in the frame of a box.
fn within(part: &TrunkBox, point: &Point3<f64>) -> Vector3<f64> {
    part.axes.inverse_transform_vector(&(point - part.centre_m))
}

/// Whether a box about the origin, given by its half sizes, meets a triangle: no plane along one of thirteen directions separates them.
///
/// Source: T. Akenine-Moeller 2001, *Fast 3D triangle-box overlap testing*.
fn meets(half: Vector3<f64>, triangle: &[Vector3<f64>; 3]) -> bool {
    let sides = [triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]];
    let meets_along = |axis: Vector3<f64>| {
        let reach = half.x * axis.x.abs() + half.y * axis.y.abs() + half.z * axis.z.abs();
        let at = triangle.map(|corner| axis.dot(&corner));
        at[0].min(at[1]).min(at[2]) <= reach && -reach <= at[0].max(at[1]).max(at[2])
    };
    let faces = [Vector3::x(), Vector3::y(), Vector3::z(), sides[0].cross(&sides[1])];
    faces.into_iter().all(meets_along)
        && sides.iter().all(|side| [Vector3::x(), Vector3::y(), Vector3::z()].iter().all(|axis| meets_along(axis.cross(side))))
}
