//! The slopes that a friction cone leaves in a vertical plane of travel, without trigonometry.

use nalgebra::{Vector2, Vector3};

use super::FrictionCone;
use crate::quantity::SlopeInterval;

/// A friction cone prepared to be cut by many vertical planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreparedCone {
    /// Of its half-angle phi.
    sine: f64,
    cosine: f64,
}

impl PreparedCone {
    /// A cone without an angle: its axis alone.
    pub(crate) const RAY: Self = Self { sine: 0.0, cosine: 1.0 };

    /// Of a cone.
    pub fn new(cone: FrictionCone) -> Self {
        let mu = cone.coefficient();
        let secant = libm::hypot(1.0, mu);
        Self { sine: mu / secant, cosine: 1.0 / secant }
    }

    /// The slopes of the directions forwards that lie inside the cone about a normal of any inclination.
    ///
    /// ```text
    ///     a, u, s   the normal ahead, up, and across the plane of travel: a^2 + u^2 + s^2 = 1
    ///     C = cos phi,   S = sqrt(sin^2 phi - s^2)                                  none where |s| > sin phi
    ///     the sides of the cone in the plane: (a C + u S, u C - a S) and (a C - u S, u C + a S), ahead and up
    /// ```
    ///
    /// These are (a, u) turned by the angles -delta and +delta of [`FrictionCone::cut`], `cos delta = C / sqrt(a^2 + u^2)`. Delta is
    /// below a right angle, so of the directions from the one to the other those that point forwards are one interval.
    ///
    /// Landings come the other way: those of the cone about `-normal`.
    ///
    /// Source: Campana and Laumond 2016, section IV-A, as slopes; they replace the cases of its Algorithm 1.
    ///
    /// # Arguments
    /// `normal` and the horizontal `heading`, both of length 1.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::SlopeInterval, world::{FrictionCone, PreparedCone}};
    /// use nalgebra::{Vector2, Vector3};
    /// let cone = PreparedCone::new(FrictionCone::new(0.5)?);
    /// // Level ground: take-off at a slope of 2 or steeper. A wall that faces the traveller's way: slopes from -0.5 to 0.5.
    /// let level = cone.slopes(Vector3::z(), Vector2::x());
    /// assert!((level.lower - 2.0).abs() < 1e-15 && level.upper == f64::INFINITY);
    /// let wall = cone.slopes(Vector3::x(), Vector2::x());
    /// assert!((wall.lower + 0.5).abs() < 1e-15 && (wall.upper - 0.5).abs() < 1e-15);
    /// assert!(cone.slopes(Vector3::y(), Vector2::x()).is_empty());
    /// # Ok::<(), chta::world::InvalidFriction>(())
    /// ```
    #[inline]
    pub fn slopes(&self, normal: Vector3<f64>, heading: Vector2<f64>) -> SlopeInterval {
        match self.sides(normal, heading) {
            Some([lower, upper]) => SlopeInterval::between_sides(lower, upper),
            None => SlopeInterval::EMPTY,
        }
    }

    /// The sides of the cone in the plane of travel, (ahead, up), the upper one less than half a turn anticlockwise of the lower; `None`
    /// where the plane misses the cone. The equation is that of [`slopes`](Self::slopes).
    #[inline]
    pub(crate) fn sides(&self, normal: Vector3<f64>, heading: Vector2<f64>) -> Option<[[f64; 2]; 2]> {
        let (ahead, up) = (normal.x * heading.x + normal.y * heading.y, normal.z);
        let across = (normal.x * heading.y - normal.y * heading.x).abs();
        let left = (self.sine - across) * (self.sine + across);
        if left < 0.0 {
            return None;
        }
        let side = left.sqrt();
        let lower = [ahead * self.cosine + up * side, up * self.cosine - ahead * side];
        let upper = [ahead * self.cosine - up * side, up * self.cosine + ahead * side];
        Some([lower, upper])
    }

    /// The sine of the half-angle.
    pub(crate) const fn sine(&self) -> f64 {
        self.sine
    }

    /// The cosine of the half-angle.
    pub(crate) const fn cosine(&self) -> f64 {
        self.cosine
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At large friction the half-angle is a right angle to the last bit: the cone is a half-space.
    #[test]
    fn extreme_frictions_give_half_spaces_and_single_rays() {
        let huge = PreparedCone::new(FrictionCone::new(f64::MAX).unwrap());
        let slopes = huge.slopes(Vector3::new(-0.6, 0.0, 0.8), Vector2::x());
        assert!((slopes.lower - 0.75).abs() < 1e-15 && slopes.upper == f64::INFINITY, "{slopes:?}");
        let none = PreparedCone::new(FrictionCone::new(0.0).unwrap());
        let ray = none.slopes(Vector3::new(0.6, 0.0, 0.8), Vector2::x());
        assert!((ray.lower - 0.8 / 0.6).abs() < 1e-15 && ray.lower == ray.upper, "{ray:?}");
        assert!(none.slopes(Vector3::new(0.6, 1e-9, 0.8), Vector2::x()).is_empty());
        // Straight up alone leads nowhere ahead.
        assert!(none.slopes(Vector3::z(), Vector2::x()).is_empty());
    }
}
