//! Where a trunk is and how it is turned.

use nalgebra::{Matrix3, Point3, Rotation3, UnitQuaternion, Vector2, Vector3};

/// A pose of the trunk: where its root is, and how its axes (forward, left, up) are turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The root, m.
    pub root_m: Point3<f64>,
    /// From the trunk frame to the ground's.
    pub turn: UnitQuaternion<f64>,
}

impl Pose {
    /// A pose with its up axis along a direction of length 1, and its forward axis as near as possible to a horizontal heading, of length 1.
    ///
    /// Where up points along the heading itself, forward points down or up: as near as it can.
    ///
    /// # Examples
    /// ```
    /// use chta::ground::Pose;
    /// use nalgebra::{Point3, Vector2, Vector3};
    /// // On a slope of 3 in 4 that rises to the east, facing north: left is down the slope.
    /// let pose = Pose::facing(Point3::origin(), Vector3::new(-0.6, 0.0, 0.8), Vector2::y());
    /// assert!((pose.to_ground(&Point3::new(0.0, 1.0, 0.0)) - Point3::new(-0.8, 0.0, -0.6)).norm() < 1e-15);
    /// ```
    pub fn facing(root_m: Point3<f64>, up: Vector3<f64>, heading: Vector2<f64>) -> Self {
        let ahead = Vector3::new(heading.x, heading.y, 0.0);
        let along = ahead - up * up.dot(&ahead);
        let forward = along.try_normalize(1e-9).unwrap_or_else(|| {
            let other = Vector3::z() * -up.dot(&ahead).signum();
            (other - up * up.dot(&other)).normalize()
        });
        let axes = Matrix3::from_columns(&[forward, up.cross(&forward), up]);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        Self { root_m, turn }
    }

    /// A point of the trunk frame on the ground, m.
    pub fn to_ground(&self, point: &Point3<f64>) -> Point3<f64> {
        self.root_m + self.turn * point.coords
    }

    /// A point of the ground in the trunk frame, m.
    pub fn to_trunk(&self, point: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.turn.inverse_transform_vector(&(point - self.root_m)))
    }

    /// How a trunk is turned that turns evenly, the shorter way around, from this pose to another: after a share of the way, from 0 to 1. Between opposite
    /// directions, where no way is shorter, it is turned as at the nearer end.
    pub fn turned_towards(&self, to: &Self, share: f64) -> UnitQuaternion<f64> {
        self.turn.try_slerp(&to.turn, share, 1e-9).unwrap_or(if share < 0.5 { self.turn } else { to.turn })
    }

    /// The up axis.
    pub fn up(&self) -> Vector3<f64> {
        self.turn * Vector3::z()
    }

    /// The heading of the forward axis, of length 1; east where that axis is vertical.
    pub fn heading(&self) -> Vector2<f64> {
        (self.turn * Vector3::x()).xy().try_normalize(1e-9).unwrap_or_else(Vector2::x)
    }
}
