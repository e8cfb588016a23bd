//! A workspace that is a sector of a spherical shell about the hip.

use nalgebra::{Point3, Unit, Vector3};

use super::TrunkBounds;
use crate::quantity::Angle;

/// The points at a distance between two radii from the hip, and within an angle of an axis, as stated, not yet checked:
/// [`Robot::new`](super::Robot::new) does that.
///
/// ```text
///           hip
///           /|\
///          / | \
///         /__|__\     radius_min
///        /   |   \
///       /    | axis
///      '-----+-----'  radius_max
/// ```
///
/// With both radii 0, the contact is the hip itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    radius_min_m: f64,
    radius_max_m: f64,
    axis: Unit<Vector3<f64>>,
    half_angle: Angle,
    cos: f64,
    sin: f64,
}

impl Shell {
    /// The contact is the hip: what makes a robot a point.
    pub fn at_hip() -> Self {
        Self::new(0.0, 0.0, -Vector3::z_axis(), Angle::from_degrees(180.0))
    }

    /// A sector between two radii, m, within a half-angle of an axis.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::Shell};
    /// use nalgebra::{Point3, Vector3};
    /// let hip = Point3::new(0.0, 0.0, 1.0);
    /// let shell = Shell::new(0.5, 2.0, -Vector3::z_axis(), Angle::from_degrees(30.0));
    /// assert!(shell.contains(&hip, &Point3::new(0.0, 0.0, 0.0)));
    /// assert!(!shell.contains(&hip, &Point3::new(0.0, 0.0, 0.6)), "too near");
    /// assert!(!shell.contains(&hip, &Point3::new(1.0, 0.0, 0.0)), "45 degrees aside");
    /// ```
    pub fn new(radius_min_m: f64, radius_max_m: f64, axis: Unit<Vector3<f64>>, half_angle: Angle) -> Self {
        // Half a turn reaches every direction, also where rounding puts it beyond the opposite one.
        let (sin, cos) = if half_angle.degrees() >= 180.0 { (0.0, f64::NEG_INFINITY) } else { libm::sincos(half_angle.radians()) };
        Self { radius_min_m, radius_max_m, axis, half_angle, cos, sin }
    }

    /// The least distance from the hip, m.
    pub const fn radius_min_m(&self) -> f64 {
        self.radius_min_m
    }

    /// The greatest distance from the hip, m.
    pub const fn radius_max_m(&self) -> f64 {
        self.radius_max_m
    }

    /// The middle of its directions.
    pub const fn axis(&self) -> Unit<Vector3<f64>> {
        self.axis
    }

    /// The greatest angle from the axis, up to 180 degrees.
    pub const fn half_angle(&self) -> Angle {
        self.half_angle
    }

    /// The cosine of the half-angle; minus infinity of half a turn, so that `cos(angle from the axis) >= cos_half_angle()` holds within.
    #[inline]
    pub const fn cos_half_angle(&self) -> f64 {
        self.cos
    }

    /// Whether a point lies in the sector about a hip, its surface included.
    #[inline]
    pub fn contains(&self, hip_m: &Point3<f64>, point: &Point3<f64>) -> bool {
        let arm = point - hip_m;
        let square = arm.norm_squared();
        square >= self.radius_min_m * self.radius_min_m
            && square <= self.radius_max_m * self.radius_max_m
            && (square == 0.0 || self.axis.dot(&arm) >= self.cos * square.sqrt())
    }

    /// The greatest cosine between a unit direction and those of the sector: 1 within it, `cos(theta - half-angle)` beside it.
    fn greatest_cosine(&self, direction: &Vector3<f64>) -> f64 {
        let cosine = self.axis.dot(direction);
        if cosine >= self.cos { 1.0 } else { cosine * self.cos + self.axis.cross(direction).norm() * self.sin }
    }

    /// How far the sector extends from the hip along a unit direction, m.
    fn support_m(&self, direction: &Vector3<f64>) -> f64 {
        let cosine = self.greatest_cosine(direction);
        cosine * if cosine >= 0.0 { self.radius_max_m } else { self.radius_min_m }
    }

    /// The smallest axis-parallel box around it, about a hip.
    pub fn bounds(&self, hip_m: &Point3<f64>) -> TrunkBounds {
        let along = |sign: f64| {
            let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
            Vector3::from(axes.map(|axis| sign * self.support_m(&(sign * axis))))
        };
        [hip_m + along(-1.0), hip_m + along(1.0)]
    }

    /// The distance of its farthest point from the root, m.
    ///
    /// ```text
    ///     |h + r u|^2 = |h|^2 + 2 r h.u + r^2
    /// ```
    ///
    /// is greatest for the direction `u` nearest to the hip's `h`, and then at one of the two radii, since it is convex in `r`.
    pub fn reach_m(&self, hip_m: &Point3<f64>) -> f64 {
        let hip = hip_m.coords;
        let distance = hip.norm();
        if distance == 0.0 {
            return self.radius_max_m;
        }
        let along = distance * self.greatest_cosine(&(hip / distance));
        let reach = |radius_m: f64| (distance * distance + 2.0 * radius_m * along + radius_m * radius_m).max(0.0).sqrt();
        reach(self.radius_min_m).max(reach(self.radius_max_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    fn vector(draw: &mut Draw) -> Vector3<f64> {
        Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0))
    }

    /// Points that random angles and radii give are inside the shell and its box, and come near to each side of the box and to the reach.
    #[test]
    fn bounds_and_reach_are_those_of_sampled_points() {
        let mut draw = Draw::seeded(21);
        for case in 0..60 {
            let hip = Point3::from(vector(&mut draw) * if case % 4 == 0 { 0.0 } else { 1.0 });
            let axis = Unit::new_normalize(vector(&mut draw));
            let half = Angle::from_degrees([5.0, 60.0, 90.0, 120.0, 180.0][case % 5]);
            let radius_max = draw.uniform(0.2, 2.0);
            let shell = Shell::new(draw.uniform(0.0, 0.9) * radius_max, radius_max, axis, half);
            let side = Unit::new_normalize(axis.cross(&vector(&mut draw)));
            let other = axis.cross(&side);
            let [low, high] = shell.bounds(&hip);
            let reach = shell.reach_m(&hip);
            let (mut least, mut greatest, mut farthest) = (high, low, 0.0_f64);
            for turn in 0..180 {
                for tilt in 0..=60 {
                    let (sin, cos) = (half.radians() * f64::from(tilt) / 60.0).sin_cos();
                    let (y, x) = (f64::from(turn) * 2.0_f64.to_radians()).sin_cos();
                    let direction = axis.into_inner() * cos + (side.into_inner() * x + other * y) * sin;
                    for radius in [shell.radius_min_m, shell.radius_max_m] {
                        let point = hip + direction * radius;
                        let inwards = hip + direction * (0.5 * (shell.radius_min_m + shell.radius_max_m));
                        assert!(tilt == 60 || shell.contains(&hip, &inwards), "case {case}");
                        least = least.inf(&point);
                        greatest = greatest.sup(&point);
                        farthest = farthest.max(point.coords.norm());
                    }
                }
            }
            let coarse = 4e-3 * radius_max;
            for axis in 0..3 {
                assert!(low[axis] <= least[axis] + 1e-12 && least[axis] <= low[axis] + coarse, "case {case}: {low} {least}");
                assert!(
                    high[axis] >= greatest[axis] - 1e-12 && greatest[axis] >= high[axis] - coarse,
                    "case {case}: {high} {greatest}"
                );
            }
            assert!(farthest <= reach + 1e-12 && reach <= farthest + coarse, "case {case}: {reach} {farthest}");
        }
    }

    #[test]
    fn random_points_are_inside_by_their_angle() {
        let mut draw = Draw::seeded(22);
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..20_000 {
            let hip = Point3::from(vector(&mut draw));
            let axis = Unit::new_normalize(vector(&mut draw));
            let shell = Shell::new(0.3, 1.1, axis, Angle::from_degrees(draw.uniform(1.0, 179.0)));
            let point = Point3::from(vector(&mut draw));
            let arm = point - hip;
            let angle = axis.cross(&arm).norm().atan2(axis.dot(&arm));
            let near_the_rim = (angle - shell.half_angle.radians()).abs() < 1e-9;
            let expected = (0.3..=1.1).contains(&arm.norm()) && angle <= shell.half_angle.radians();
            assert!(near_the_rim || shell.contains(&hip, &point) == expected);
            if expected { inside += 1 } else { outside += 1 }
        }
        assert!(inside > 3000 && outside > 3000, "{inside} {outside}");
    }

    #[test]
    fn a_shell_at_the_hip_is_the_hip() {
        let hip = Point3::new(0.1, -0.2, 0.3);
        let shell = Shell::at_hip();
        assert!(shell.contains(&hip, &hip) && !shell.contains(&hip, &(hip + Vector3::x() * 1e-9)));
        assert_eq!((shell.bounds(&hip), shell.reach_m(&hip)), ([hip; 2], hip.coords.norm()));
    }
}
