//! The largest force that limbs of limited strength produce together.

use nalgebra::{Vector2, Vector3};

use super::{Bounds, ContactCone};

/// Both bounds are brought this close, as a share of the sum of all forces.
const GAP: f64 = 1e-9;

/// Support points at most. In the tests half of the searches took 27, 99 of 100 at most 44; on the border of the cone of the stance, where the best
/// plane is ever steeper, all of them may be taken.
const ROUNDS_MAX: usize = 300;

/// How far below everything the three points lie from which the search starts, in sums of all forces: so far that any real point
/// is better. It is also the steepest supporting plane that is tried.
const DEPTH: f64 = 1e4;

/// One contact and the strength of its limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limb {
    cone: ContactCone,
    force_max_n: f64,
}

/// A greatest force that is not a finite number above 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("greatest force of a limb {0} N is not a finite number above 0")]
pub struct InvalidForce(pub f64);

impl Limb {
    /// Of its contact and its greatest force, N, in any direction.
    ///
    /// # Errors
    /// [`InvalidForce`] if the force is not a finite number above 0.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::stance::{ContactCone, Limb}, world::FrictionCone};
    /// use nalgebra::Vector3;
    /// let cone = ContactCone::new(Vector3::z(), FrictionCone::new(0.5)?)?;
    /// assert_eq!(Limb::new(cone, 50.0)?.force_max_n(), 50.0);
    /// assert!(Limb::new(cone, 0.0).is_err() && Limb::new(cone, f64::INFINITY).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(cone: ContactCone, force_max_n: f64) -> Result<Self, InvalidForce> {
        if force_max_n.is_finite() && force_max_n > 0.0 { Ok(Self { cone, force_max_n }) } else { Err(InvalidForce(force_max_n)) }
    }

    /// The contact.
    pub const fn cone(&self) -> ContactCone {
        self.cone
    }

    /// The greatest force, N.
    pub const fn force_max_n(&self) -> f64 {
        self.force_max_n
    }
}

/// The largest net force along a direction, N, of limbs that do not slide and are not stronger than they are.
///
/// ```text
///     largest c with c v = sum f_i,   f_i in K_i,   |f_i| <= F_i
///         = least sum F_i g_i(u) over all u with u.v = 1,   g_i(u) = |u| max(0, cos(max(0, angle(u, n_i) - phi_i)))
/// ```
///
/// `g_i` is the most that a unit force of the cone does along u. Force closure tells that every direction is possible; this tells how
/// much of it. The forces of the limbs, each in a convex set, sum to a convex set, and the ray along v leaves it at c. A triangle of
/// points of the set that the ray crosses bounds c from below, the supporting plane parallel to it from above, and the point of that
/// plane replaces a corner of the triangle until both agree: the simplex method, with points found as they are needed.
///
/// # Arguments
/// `direction`: of length 1.
///
/// # Returns
/// Two bounds, N, which agree to 1e-9 of the sum of all forces; less closely on the border of the cone of the stance, where few forces
/// are possible. 0 outside the cone.
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ContactCone, Limb, greatest_force_n}, world::FrictionCone};
/// use nalgebra::Vector3;
/// // Two limbs of 50 N between two walls with friction 0.75: each lifts at most 0.6 times its force, on the edge of its cone.
/// let friction = FrictionCone::new(0.75)?;
/// let limb = |x| Limb::new(ContactCone::new(Vector3::new(x, 0.0, 0.0), friction).unwrap(), 50.0).unwrap();
/// let up = greatest_force_n(&[limb(1.0), limb(-1.0)], Vector3::z());
/// assert!((up.lower - 60.0).abs() < 1e-6 && (up.upper - 60.0).abs() < 1e-6);
/// // Away from a wall one limb does it alone.
/// let along = greatest_force_n(&[limb(1.0), limb(-1.0)], Vector3::x());
/// assert!((along.upper - 50.0).abs() < 1e-6);
/// # Ok::<(), chta::world::InvalidFriction>(())
/// ```
pub fn greatest_force_n(limbs: &[Limb], direction: Vector3<f64>) -> Bounds {
    let bounds = farthest(limbs, Vector3::zeros(), direction);
    // No force at all is one.
    Bounds { lower: bounds.lower.max(0.0), upper: bounds.upper.max(0.0) }
}

/// The largest `c` for which `from + c direction` is a force of the limbs, N. Where no `c` is, the upper bound is far below 0.
///
/// The lower bound is minus infinity where no forces were found that prove one.
pub(super) fn farthest(limbs: &[Limb], from: Vector3<f64>, direction: Vector3<f64>) -> Bounds {
    let mut bounds = Bounds { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    let scale = limbs.iter().map(Limb::force_max_n).sum::<f64>() + from.norm();
    let first = direction.cross(&Vector3::ith(direction.iamin(), 1.0)).normalize();
    let sides = [first, direction.cross(&first)];
    let mut corners = [0.0, 1.0, 2.0].map(|third: f64| {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * third / 3.0);
        Corner { aside: Vector2::new(cosine, sine) * scale, along: -DEPTH * scale, real: false }
    });
    let mut normal = direction;
    for _ in 0..ROUNDS_MAX {
        let force = support(limbs, normal) - from;
        bounds.upper = bounds.upper.min(force.dot(&normal));
        let point =
            Corner { aside: Vector2::new(force.dot(&sides[0]), force.dot(&sides[1])), along: force.dot(&direction), real: true };
        // The ray may leave the set at the point itself, as on the edge of a cone.
        if point.aside.norm() <= GAP * scale {
            bounds.lower = bounds.lower.max(point.along);
        }
        if bounds.upper - bounds.lower <= GAP * scale || !enter(&mut corners, point) {
            break;
        }
        let (Some(shares), Some(slopes)) = (shares(&corners, Vector2::zeros()), slopes(&corners)) else { break };
        if corners.iter().all(|corner| corner.real) {
            bounds.lower = bounds.lower.max(corners.iter().zip(shares).map(|(corner, share)| corner.along * share).sum());
        }
        normal = direction + sides[0] * slopes.x + sides[1] * slopes.y;
    }
    bounds
}

/// The force of all limbs that does most along a vector.
fn support(limbs: &[Limb], along: Vector3<f64>) -> Vector3<f64> {
    let forces = limbs.iter().map(|limb| {
        let force = limb.cone.best(along);
        if force.dot(&along) > 0.0 { force * limb.force_max_n } else { Vector3::zeros() }
    });
    forces.sum()
}

/// Replaces a corner by a point, so that the ray still passes the triangle: the corner whose share in the ray is the first to fall to 0 as
/// that of the point grows. False if the triangle is too thin to tell.
fn enter(corners: &mut [Corner; 3], point: Corner) -> bool {
    let (Some(of_ray), Some(of_point)) = (shares(corners, Vector2::zeros()), shares(corners, point.aside)) else { return false };
    let growing = (0..3).filter(|&at| of_point[at] > f64::EPSILON);
    let leaving = growing.min_by(|&one, &other| (of_ray[one] / of_point[one]).total_cmp(&(of_ray[other] / of_point[other])));
    let Some(leaving) = leaving else { return false };
    corners[leaving] = point;
    true
}

/// A point, as seen along the ray.
#[derive(Clone, Copy)]
struct Corner {
    aside: Vector2<f64>,
    along: f64,
    /// Whether it is a sum of forces, not one of those from which the search starts.
    real: bool,
}

/// The shares of the corners of a triangle in a point, seen along the ray; `None` if they are on a line.
fn shares(corners: &[Corner; 3], at: Vector2<f64>) -> Option<[f64; 3]> {
    let [a, b, c] = corners.each_ref().map(|corner| corner.aside - at);
    let parts = [b.perp(&c), c.perp(&a), a.perp(&b)];
    let whole = parts[0] + parts[1] + parts[2];
    (whole != 0.0).then(|| parts.map(|part| part / whole))
}

/// The slopes by which the plane of a triangle falls to either side of the ray.
fn slopes(corners: &[Corner; 3]) -> Option<Vector2<f64>> {
    let [a, b, c] = corners;
    let (one, other) = (b.aside - a.aside, c.aside - a.aside);
    let whole = one.perp(&other);
    let (rise, other_rise) = (b.along - a.along, c.along - a.along);
    let slopes = Vector2::new(other_rise * one.y - rise * other.y, rise * other.x - other_rise * one.x) / whole;
    (slopes.x.is_finite() && slopes.y.is_finite()).then_some(slopes)
}
