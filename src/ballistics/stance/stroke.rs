//! A push from rest along a straight stroke, with the weight of the robot on its feet.

use nalgebra::{Vector2, Vector3};

use super::{Bounds, Limb, force::farthest};
use crate::ballistics::LineOfSight;

/// The slope of the force that pushes a robot from rest along a straight stroke to the take-off of a hop.
///
/// ```text
///     f / m = a v + g z,   a = v_t^2 / (2 s)          a constant force over the stroke s, along the unit take-off direction v
///     slope of f = m + (4 s / X) (m - b) / sqrt(1 + m^2)
/// ```
///
/// The take-off speed of an arc with the slope m is `v_t^2 = g X (1 + m^2) / (2 (m - b))` (model section 2), so gravity cancels. For
/// X much larger than s the force points along the take-off velocity, which is the impulse model of S. The force, too, must lie in the cone of
/// the stance.
///
/// # Arguments
/// `takeoff_slope`: m; `sight`: X and b; `stroke_m`: s.
///
/// # Returns
/// A slope of at least m; infinite for an infinite m.
///
/// # Examples
/// ```
/// use chta::ballistics::{LineOfSight, stance::push_slope};
/// // 45 degrees over 10 m of level ground with a stroke of 0.25 m: 1 + (4 * 0.25 / 10) * 1 / sqrt 2.
/// assert!((push_slope(1.0, LineOfSight::new(10.0, 0.0), 0.25) - 1.070_710_678_118_654_8).abs() < 1e-15);
/// ```
pub fn push_slope(takeoff_slope: f64, sight: LineOfSight, stroke_m: f64) -> f64 {
    if takeoff_slope.is_infinite() {
        return takeoff_slope;
    }
    takeoff_slope + 4.0 * stroke_m / sight.run_m() * (takeoff_slope - sight.slope()) / libm::hypot(1.0, takeoff_slope)
}

/// The net force of the feet in a straight push from rest, N for each kg of the robot: ahead, and up.
///
/// ```text
///     f / m = v_t^2 / (2 s) (1, m) / sqrt(1 + m^2) + (0, g)
/// ```
///
/// # Arguments
/// `takeoff_slope`: m, finite; `speed_m_s`: of take-off; `stroke_m`: s, more than 0.
///
/// # Examples
/// ```
/// use chta::ballistics::stance::push_force_n;
/// // To 2 m/s along a slope of 3/4 within 0.25 m: 8 m/s^2 along (0.8, 0.6), and 1.5 m/s^2 of weight.
/// let force = push_force_n(0.75, 2.0, 0.25, 1.5);
/// assert!((force.x - 6.4).abs() < 1e-12 && (force.y - 6.3).abs() < 1e-12);
/// ```
pub fn push_force_n(takeoff_slope: f64, speed_m_s: f64, stroke_m: f64, gravity_m_s2: f64) -> Vector2<f64> {
    let along_m_s2 = 0.5 * speed_m_s * speed_m_s / stroke_m / libm::hypot(1.0, takeoff_slope);
    Vector2::new(along_m_s2, along_m_s2 * takeoff_slope + gravity_m_s2)
}

/// The greatest take-off speed, m/s, of a straight push from rest by limbs of limited strength.
///
/// ```text
///     v = sqrt(2 s a),   the largest a with m (a v + g z) = sum f_i,   f_i in K_i,   |f_i| <= F_i
/// ```
///
/// # Arguments
/// `takeoff`: the direction of take-off, of length 1; `stroke_m`: s; `mass_kg`: m, more than 0.
///
/// # Returns
/// Two bounds. The lower is 0 where no push was found that proves more. `None` if no push along this line is possible: the limbs are too
/// weak for the weight, or slide.
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ContactCone, Limb, greatest_push_speed_m_s}, world::FrictionCone};
/// use nalgebra::Vector3;
/// // One limb of 60 N lifts 5 kg straight up against 2 m/s^2: 10 m/s^2 are left, over 0.2 m: 2 m/s.
/// let limb = Limb::new(ContactCone::new(Vector3::z(), FrictionCone::new(0.5)?)?, 60.0)?;
/// let speed = greatest_push_speed_m_s(&[limb], Vector3::z(), 0.2, 5.0, 2.0).unwrap();
/// assert!((speed.lower - 2.0).abs() < 1e-6 && (speed.upper - 2.0).abs() < 1e-6);
/// assert!(greatest_push_speed_m_s(&[limb], Vector3::z(), 0.2, 50.0, 2.0).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn greatest_push_speed_m_s(
    limbs: &[Limb],
    takeoff: Vector3<f64>,
    stroke_m: f64,
    mass_kg: f64,
    gravity_m_s2: f64,
) -> Option<Bounds> {
    let weight_n = Vector3::z() * (mass_kg * gravity_m_s2);
    let force_n = farthest(limbs, weight_n, takeoff);
    let speed_m_s = |force_n: f64| (2.0 * stroke_m * force_n.max(0.0) / mass_kg).sqrt();
    (force_n.upper >= 0.0).then(|| Bounds { lower: speed_m_s(force_n.lower), upper: speed_m_s(force_n.upper) })
}
