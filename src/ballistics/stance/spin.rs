//! The angular momentum that a push leaves, and the pushes that leave none.

use nalgebra::{Vector2, Vector3, Vector6};

use super::{
    Bounds, ConeSum, ContactCone, Foothold, PlaneCut,
    plane_cut::{cross, dot},
    wrench::{Nearest, WrenchCone},
};

/// What is left of a push, as a share of it, where it counts as reached: moment over the longest arm, or force.
const REACHED: f64 = 1e-7;

/// How near a push comes to the velocity that is asked for, as a share of it.
const EXACT: f64 = 1e-9;

/// How much more the force counts than the moment where a velocity is asked for and the least moment with it.
const FORCE_WEIGHT: f64 = 30.0;

/// Steps at most towards a push of exactly the force that is asked for. Each brings it nearer by a factor of some
/// hundred until rounding is left, so two or three are usual.
const CORRECTIONS_MAX: usize = 40;

/// Steps at most from outside to a side of the cut. They are Newton's for a convex function: in the tests at most nine.
const STEPS_MAX: usize = 100;

/// The lower bound of the spin holds for all pushes in which the sizes of the forces add up to at most so many times the push. A stance that
/// has force closure can press itself together as hard as it likes, which only a bound on the forces keeps from adding up rounding.
const FORCES_MAX: f64 = 1e3;

/// The least angular momentum about the centre of mass, for each kg, that a take-off velocity needs, m^2/s.
///
/// ```text
///     least |sum r_i x f_i|   where   sum f_i = v,   f_i in K_i,   r_i = p_i - c
///         >= u.v   for all y, u with |y| <= 1 and y x r_i - u in K_i* for all i
/// ```
///
/// The impulses `f_i` are for each kg of the robot, so times its mass the result is in N m s, and over its moment of inertia for each kg it
/// is a rate of turn. S ignores it. It is proportional to the velocity.
///
/// # Arguments
/// `velocity_m_s`: of take-off. For a landing, the reverse of the velocity.
///
/// # Returns
/// Two bounds: the upper is that of a push that was found, the lower that of a proof by the inequality, for all pushes whose forces add up to
/// at most a thousand times the velocity. They agree to 1e-6 of the velocity times the longest arm, in one
/// stance of some thousand to 1e-5. The upper one is infinite if no push was found that gives the velocity to 1e-7. `None` if no push without sliding
/// gives the velocity.
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ContactCone, Foothold, least_spin_m2_s}, world::FrictionCone};
/// use nalgebra::Vector3;
/// // One foot 0.4 m below and 0.3 m behind the centre of mass. Only a push along (0.3, 0, 0.4) leaves no spin; straight up at 2 m/s leaves
/// // 0.3 m times 2 m/s.
/// let cone = ContactCone::new(Vector3::z(), FrictionCone::new(1.0)?)?;
/// let foot = Foothold { cone, arm_m: Vector3::new(-0.3, 0.0, -0.4) };
/// let up = least_spin_m2_s(&[foot], Vector3::new(0.0, 0.0, 2.0)).unwrap();
/// assert!((up.lower - 0.6).abs() < 1e-6 && (up.upper - 0.6).abs() < 1e-6);
/// assert!(least_spin_m2_s(&[foot], Vector3::new(0.3, 0.0, 0.4)).unwrap().upper < 1e-6);
/// // Flatter than 45 degrees the foot slides.
/// assert!(least_spin_m2_s(&[foot], Vector3::new(0.8, 0.0, 0.6)).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn least_spin_m2_s(footholds: &[Foothold], velocity_m_s: Vector3<f64>) -> Option<Bounds> {
    Some(least_spin(footholds, velocity_m_s)?.0)
}

/// Forces of the contacts that add up to a push and leave the least moment about the centre of mass: one for each contact, in their order and in the
/// unit of the push.
///
/// A stance with several contacts mostly has many such forces, of which these are one choice.
///
/// # Returns
/// `None` if no push without sliding was found that gives the push to 1e-7 of it.
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ContactCone, Foothold, forces_of_least_spin}, world::FrictionCone};
/// use nalgebra::Vector3;
/// // A weight of 30 N on two feet, 0.1 m behind and 0.2 m ahead of the centre of mass: by the lever, two thirds rest on the one behind.
/// let cone = ContactCone::new(Vector3::z(), FrictionCone::new(0.5)?)?;
/// let foot = |x| Foothold { cone, arm_m: Vector3::new(x, 0.0, -0.4) };
/// let forces = forces_of_least_spin(&[foot(-0.1), foot(0.2)], Vector3::new(0.0, 0.0, 30.0)).unwrap();
/// assert!((forces[0].z - 20.0).abs() < 1e-5 && (forces[1].z - 10.0).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn forces_of_least_spin(footholds: &[Foothold], push: Vector3<f64>) -> Option<Vec<Vector3<f64>>> {
    let (bounds, forces) = least_spin(footholds, push)?;
    bounds.upper.is_finite().then_some(forces)
}

/// The least spin of a push, and the forces of one that was found.
fn least_spin(footholds: &[Foothold], velocity_m_s: Vector3<f64>) -> Option<(Bounds, Vec<Vector3<f64>>)> {
    let speed_m_s = velocity_m_s.norm();
    if speed_m_s == 0.0 {
        let forces = vec![Vector3::zeros(); footholds.len()];
        return (!footholds.is_empty()).then_some((Bounds { lower: 0.0, upper: 0.0 }, forces));
    }
    let velocity = velocity_m_s / speed_m_s;
    if !sum(footholds).contains(velocity) {
        return None;
    }
    let cone = WrenchCone::new(footholds, FORCE_WEIGHT);
    let weigh = |force: Vector3<f64>| force * FORCE_WEIGHT;
    let mut lower = 0.0f64;
    let mut asked_force = velocity;
    let (mut upper, mut forces) = (f64::INFINITY, Vec::new());
    for _ in 0..CORRECTIONS_MAX {
        let asked = weigh(asked_force);
        let nearest = cone.nearest(Vector6::new(asked.x, asked.y, asked.z, 0.0, 0.0, 0.0));
        let force = nearest.wrench.fixed_rows::<3>(0) / FORCE_WEIGHT;
        let spin = nearest.wrench.fixed_rows::<3>(3).norm();
        lower = lower.max(proved(&nearest, velocity));
        (upper, forces) = (spin, nearest.forces);
        let short = velocity - force;
        if short.norm() > REACHED {
            upper = f64::INFINITY;
        }
        if short.norm() <= EXACT {
            break;
        }
        // The method of multipliers: ask for as much more as was missing.
        asked_force += short;
    }
    // The bounds of one number may pass each other by what the force is missing.
    let scale = speed_m_s * cone.arm_m;
    for force in &mut forces {
        *force *= speed_m_s;
    }
    Some((Bounds { lower: lower.min(upper) * scale, upper: upper * scale }, forces))
}

/// The spin that what is missing to a push proves, for a unit velocity and a unit arm.
///
/// What is missing is at 90 degrees or more from every wrench of the cone, so over the length of its moment it is the `u` and `y` of the
/// inequality, to within the gain, which forces may add up.
fn proved(nearest: &Nearest, velocity: Vector3<f64>) -> f64 {
    let (force, moment) = (nearest.missing.fixed_rows::<3>(0), nearest.missing.fixed_rows::<3>(3).norm());
    if moment <= 0.0 {
        return 0.0;
    }
    let bound = (force.dot(&velocity) * FORCE_WEIGHT - nearest.gain * FORCES_MAX) / moment;
    if bound.is_finite() { bound.max(0.0) } else { 0.0 }
}

/// The directions in the vertical plane of a heading in which a push leaves no spin.
///
/// ```text
///     {v : v = sum f_i,   sum r_i x f_i = 0,   f_i in K_i}   cut by the plane
/// ```
///
/// One foot pushes without spin along the line to the centre of mass alone, two feet in the plane through both and the centre of mass, so
/// for most headings along a single ray. Three or more have a cone.
///
/// # Arguments
/// `heading`: the horizontal direction of travel, of length 1.
///
/// # Returns
/// The sides to 1e-7 or better; what is left of a push along them is less than 1e-7 of it, as force, or as moment over the longest arm.
///
/// # Method
/// From outside, a side moves to the border of the half-plane that the nearest wrench of the stance separates from it, until it is reached.
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ContactCone, Foothold, spin_free_cut}, world::FrictionCone};
/// use nalgebra::{Vector2, Vector3};
/// // Two feet on level ground, 0.4 m below the centre of mass and 0.3 m ahead of it and behind: the friction of 0.5 alone limits a push
/// // in the plane of both feet, and across it only straight up leaves no spin.
/// let cone = ContactCone::new(Vector3::z(), FrictionCone::new(0.5)?)?;
/// let foot = |x| Foothold { cone, arm_m: Vector3::new(x, 0.0, -0.4) };
/// let feet = [foot(0.3), foot(-0.3)];
/// let slopes = spin_free_cut(&feet, Vector2::x()).takeoff_slopes();
/// assert!((slopes.lower - 2.0).abs() < 1e-6 && slopes.upper == f64::INFINITY);
/// assert!(spin_free_cut(&feet, Vector2::y()).opening().unwrap().degrees() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn spin_free_cut(footholds: &[Foothold], heading: Vector2<f64>) -> PlaneCut {
    let cone = WrenchCone::new(footholds, 1.0);
    let separated = |direction: [f64; 2]| separation(&cone, heading, direction);
    let mut cut = sum(footholds).cut(heading);
    if cut == PlaneCut::Everything {
        // Three directions between which there is no half-plane.
        for direction in [[1.0, 0.0], [-1.0, 2.0], [-1.0, -2.0]] {
            if let Some(away) = separated(direction) {
                cut = PlaneCut::Between { lower: [-away[1], away[0]], upper: [away[1], -away[0]] };
                break;
            }
        }
    }
    let PlaneCut::Between { mut lower, mut upper } = cut else { return cut };
    for _ in 0..STEPS_MAX {
        let Some(away) = separated(lower) else { break };
        // The border of the half-plane on the side of the other side.
        let next = [-away[1], away[0]];
        if cross(next, upper) < 0.0 && !nearly(next, upper) {
            return PlaneCut::Nothing;
        }
        lower = next;
    }
    for _ in 0..STEPS_MAX {
        let Some(away) = separated(upper) else { break };
        let next = [away[1], -away[0]];
        if cross(lower, next) < 0.0 {
            // The lower side is reached, so it is a single ray.
            upper = lower;
            break;
        }
        upper = next;
    }
    if separated(lower).is_some() || separated(upper).is_some() {
        return PlaneCut::Nothing;
    }
    PlaneCut::Between { lower, upper }
}

/// Whether two directions differ by rounding alone.
fn nearly(one: [f64; 2], other: [f64; 2]) -> bool {
    let size = (dot(one, one) * dot(other, other)).sqrt();
    dot(one, other) > 0.0 && cross(one, other).abs() <= REACHED * size
}

/// The direction away from all pushes without spin, in the plane of a heading, on whose side a direction is; `None` if it is one of them.
fn separation(cone: &WrenchCone<'_>, heading: Vector2<f64>, direction: [f64; 2]) -> Option<[f64; 2]> {
    let [ahead, up] = direction.map(|part| part / dot(direction, direction).sqrt());
    let nearest = cone.nearest(Vector6::new(heading.x * ahead, heading.y * ahead, up, 0.0, 0.0, 0.0));
    let missing = nearest.missing;
    let away = [missing[0] * heading.x + missing[1] * heading.y, missing[2]];
    (missing.norm() > REACHED).then(|| away.map(|part| part / dot(away, away).sqrt()))
}

/// Whether the contacts can hold the weight without a moment about the centre of mass, so that the robot need not topple: whether the vertical
/// is a push without spin.
///
/// Whether it need not slide is [`ConeSum::holds_weight`].
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ContactCone, Foothold, holds_upright}, world::FrictionCone};
/// use nalgebra::Vector3;
/// let cone = ContactCone::new(Vector3::z(), FrictionCone::new(0.5)?)?;
/// let foot = |x, y| Foothold { cone, arm_m: Vector3::new(x, y, -0.4) };
/// // The centre of mass is above the triangle of the feet, or beside it.
/// assert!(holds_upright(&[foot(0.3, 0.0), foot(-0.3, 0.2), foot(-0.3, -0.2)]));
/// assert!(!holds_upright(&[foot(0.3, 0.0), foot(0.1, 0.2), foot(0.1, -0.2)]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn holds_upright(footholds: &[Foothold]) -> bool {
    separation(&WrenchCone::new(footholds, 1.0), Vector2::x(), [0.0, 1.0]).is_none()
}

/// The cone of a stance without the places of its contacts.
fn sum(footholds: &[Foothold]) -> ConeSum {
    let cones: Vec<ContactCone> = footholds.iter().map(|foot| foot.cone).collect();
    ConeSum::new(&cones)
}
