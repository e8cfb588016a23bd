//! Frames of links and joints.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

/// A frame relative to another: turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The directions of its axes, as columns.
    pub axes: Rotation3<f64>,
    /// Its origin, m.
    pub origin_m: Vector3<f64>,
}

impl Frame {
    /// The frame itself.
    pub fn identity() -> Self {
        Self { axes: Rotation3::identity(), origin_m: Vector3::zeros() }
    }

    /// A frame given relative to this one, relative to what this one is given relative to.
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        Self { axes: self.axes * inner.axes, origin_m: self.origin_m + self.axes * inner.origin_m }
    }

    /// A point of this frame.
    pub fn point(&self, point: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.origin_m + self.axes * point.coords)
    }
}

/// The rotation about a unit axis by an angle, rad: `I + sin K + (1 - cos) K^2` (Rodrigues), with `K v = axis x v`.
pub(super) fn about(axis: &Vector3<f64>, angle: f64) -> Rotation3<f64> {
    let (sin, cos) = libm::sincos(angle);
    let cross = axis.cross_matrix();
    Rotation3::from_matrix_unchecked(Matrix3::identity() + cross * sin + cross * cross * (1.0 - cos))
}

#[cfg(test)]
mod tests {
    use nalgebra::Unit;

    use super::*;

    #[test]
    fn the_rotation_about_an_axis_is_that_of_nalgebra() {
        for (axis, angle) in [(Vector3::x(), 0.4), (Vector3::new(1.0, -2.0, 0.5).normalize(), -2.3), (Vector3::z(), 3.1)] {
            let expected = Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle);
            assert!((about(&axis, angle).matrix() - expected.matrix()).amax() < 1e-15);
        }
    }
}
