//! The boxes of a trunk.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use crate::quantity::Angle;

/// A box of the trunk, in the trunk frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrunkBox {
    /// Its middle, m.
    pub centre_m: Point3<f64>,
    /// Half of its size along each of its axes, m.
    pub half_m: Vector3<f64>,
    /// The directions of its axes, as columns.
    pub axes: Rotation3<f64>,
}

impl TrunkBox {
    /// A box along the axes of the trunk frame.
    ///
    /// # Examples
    /// ```
    /// use chta::world::TrunkBox;
    /// use nalgebra::{Point3, Vector3};
    /// let body = TrunkBox::upright(Point3::new(0.0, 0.0, 1.0), Vector3::new(0.5, 0.25, 0.125));
    /// assert_eq!(body.corners_m()[7], Point3::new(0.5, 0.25, 1.125));
    /// ```
    pub fn upright(centre_m: Point3<f64>, half_m: Vector3<f64>) -> Self {
        Self { centre_m, half_m, axes: Rotation3::identity() }
    }

    /// Its eight corners, m.
    pub fn corners_m(&self) -> [Point3<f64>; 8] {
        std::array::from_fn(|corner| {
            let sign = |bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            self.centre_m + self.axes * self.half_m.component_mul(&Vector3::new(sign(0), sign(1), sign(2)))
        })
    }

    /// The distance of its farthest corner from the root, m.
    pub fn radius_m(&self) -> f64 {
        self.corners_m().iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max)
    }
}

/// The rotation by roll about x, then pitch about y, then yaw about z, all about axes that stay.
pub fn roll_pitch_yaw(angles: [Angle; 3]) -> Rotation3<f64> {
    let [(sr, cr), (sp, cp), (sy, cy)] = angles.map(|angle| libm::sincos(angle.radians()));
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
        -sp,     cp * sr,                cp * cr,
    );
    Rotation3::from_matrix_unchecked(matrix)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roll_pitch_and_yaw_are_those_of_nalgebra() {
        for [roll, pitch, yaw] in [[0.0, 0.0, 0.0], [0.3, -0.4, 1.2], [-2.0, 1.5, 3.0]] {
            let expected = Rotation3::from_euler_angles(roll, pitch, yaw);
            let found = roll_pitch_yaw([roll, pitch, yaw].map(Angle::from_radians));
            assert!((found.matrix() - expected.matrix()).amax() < 1e-15);
        }
    }
}
