//! The sum of the friction cones of a stance, prepared to be cut by many vertical planes.

use nalgebra::{Vector2, Vector3};

use super::{
    ContactCone, PlaneCut,
    plane_cut::{cross, dot},
};
use crate::{quantity::SlopeInterval, world::PreparedCone};

/// How far outside the dual cone, as a sine, a normal of a supporting plane may be by rounding. Normals are computed to about 1e-15. A
/// larger value keeps planes that do not touch the sum: the rays in them lie in the sum all the same, so nothing false is added, but a
/// set whose cones reach around by less than this counts as a half-space instead of all of space.
const DUAL_TOLERANCE: f64 = 1e-12;

/// How far a product of unit vectors is off by rounding, a few times over: two cones whose edges are opposite to within this are those of a
/// half-space. An angle that differs by 1e-7 degrees is beyond it.
const OPPOSITE_TOLERANCE: f64 = 1e-15;

/// Sines below this make no half-space: the cones are as good as rays, and two opposite rays are a line.
const LEAST_SINE: f64 = 1e-6;

/// The cone of the directions in which several contacts together can push: the sum of their friction cones.
///
/// ```text
///     K = K_1 + ... + K_h,   K_i = {f : f.n_i >= |f| cos phi_i},   tan phi_i = mu_i                               (S eq. 1)
///     v in K  iff  u.v >= 0 for all u of the dual cone  K* = {u : u.n_i >= s_i |u| for all i},   s_i = sin phi_i
/// ```
///
/// An extreme ray of the cut of K by a plane through the origin lies in a face of K of at most two dimensions: in an edge of one cone,
/// or in the flat part between two cones that a plane touches. Such planes have the inner normals
///
/// ```text
///     u = a n_i + b n_j +- c w,   w = n_i x n_j,   k = n_i.n_j,   d = w.w
///     a = (s_i - k s_j) / d,   b = (s_j - k s_i) / d,   c^2 = (cos(phi_i - phi_j) - k) (cos(phi_i + phi_j) + k) / d^2
/// ```
///
/// and touch the cones along `n_i - s_i u` and `n_j - s_j u`. No such plane exists where one cone holds the other (first factor), or
/// where both together push every way (second factor). In the vertical plane of a heading, the rays of all cones that it cuts and of all
/// pairs of edges on either side of it are those between which the cut lies.
///
/// K is all of space, *force closure*, if and only if no `n_i` and no `u` lies in K*. Pairs alone do not show it.
///
/// # Degenerate cases
/// No contact: no direction. Equal normals, or one cone inside another: the wider cone rules. Opposite normals: every direction. Normals
/// at exactly `pi - phi_i - phi_j`: a closed half-space. A plane that touches K: a single ray, kept.
///
/// # Cost
/// Preparing takes `O(h^3)`, a cut `O(h)` and no trigonometry, allocation or sorting.
///
/// # Examples
/// ```
/// use chta::{ballistics::stance::{ConeSum, ContactCone}, world::FrictionCone};
/// use nalgebra::{Vector2, Vector3};
/// let friction = FrictionCone::new(0.5)?;
/// // The floor and a wall behind the robot, whose normal points ahead: the floor alone allows slopes of 2 or more. Against the wall
/// // it pushes ahead as well, down to a slope of -0.5.
/// let floor = ContactCone::new(Vector3::z(), friction)?;
/// let wall = ContactCone::new(Vector3::x(), friction)?;
/// assert!((ConeSum::new(&[floor]).takeoff_slopes(Vector2::x()).lower - 2.0).abs() < 1e-15);
/// let both = ConeSum::new(&[floor, wall]);
/// let slopes = both.takeoff_slopes(Vector2::x());
/// assert!((slopes.lower + 0.5).abs() < 1e-15 && slopes.upper == f64::INFINITY);
/// // Between two opposite walls every force is possible, with any friction.
/// let other = ContactCone::new(-Vector3::x(), friction)?;
/// assert!(ConeSum::new(&[wall, other]).is_everything());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConeSum {
    cones: Vec<Cone>,
    /// The pairs of edges that a plane joins which touches K.
    faces: Vec<[Vector3<f64>; 2]>,
    extent: Extent,
}

/// One cone: its axis, and its half-angle prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cone {
    axis: Vector3<f64>,
    prepared: PreparedCone,
}

/// How much of space a sum of cones fills.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Extent {
    Nothing,
    /// On the side of this inner normal, which is well inside K*.
    Within(Vector3<f64>),
    /// All on the side of this normal.
    HalfSpace(Vector3<f64>),
    Everything,
}

/// The planes that touch two cones from the same side.
enum Tangents {
    /// One cone holds the other.
    None,
    /// The inner normals of both planes.
    Two([Vector3<f64>; 2]),
    /// Both planes are one, and the sum is its side.
    HalfSpace(Vector3<f64>),
    /// Both cones together push every way.
    Everything,
}

impl ConeSum {
    /// Of the contacts of a stance.
    pub fn new(contacts: &[ContactCone]) -> Self {
        let cone = |contact: &ContactCone| Cone { axis: contact.normal(), prepared: PreparedCone::new(contact.friction()) };
        Self::of_cones(contacts.iter().map(cone))
    }

    /// The sum of rays, cones without an angle: a polyhedral cone.
    pub(super) fn of_rays(rays: impl Iterator<Item = Vector3<f64>>) -> Self {
        Self::of_cones(rays.map(|axis| Cone { axis, prepared: PreparedCone::RAY }))
    }

    /// No direction at all.
    pub(super) const fn nothing() -> Self {
        Self { cones: Vec::new(), faces: Vec::new(), extent: Extent::Nothing }
    }

    /// All of space.
    pub(super) const fn everything() -> Self {
        Self { cones: Vec::new(), faces: Vec::new(), extent: Extent::Everything }
    }

    fn of_cones(all: impl Iterator<Item = Cone>) -> Self {
        let mut cones: Vec<Cone> = Vec::new();
        for cone in all {
            if !cones.iter().any(|other| other.holds(&cone)) {
                cones.retain(|other| !cone.holds(other));
                cones.push(cone);
            }
        }
        let mut faces = Vec::new();
        let extent = match cones.as_slice() {
            [] => Extent::Nothing,
            [only] => Extent::Within(only.axis),
            cones => joined(cones, &mut faces),
        };
        Self { cones, faces, extent }
    }

    /// Whether every direction lies inside: force closure.
    pub const fn is_everything(&self) -> bool {
        matches!(self.extent, Extent::Everything)
    }

    /// Whether no direction lies inside.
    pub const fn is_nothing(&self) -> bool {
        matches!(self.extent, Extent::Nothing)
    }

    /// What the vertical plane of a heading cuts out of the cone.
    ///
    /// # Arguments
    /// `heading`: the horizontal direction of travel, of length 1.
    ///
    /// # Returns
    /// Both sides as (ahead, up). Only the directions count: the sides are of any length.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::stance::{ConeSum, ContactCone}, world::FrictionCone};
    /// use nalgebra::{Vector2, Vector3};
    /// // Level ground with friction 1, and a wall across the heading with friction 1: 45 degrees beyond the vertical to 45 degrees below
    /// // the horizontal.
    /// let contacts = [Vector3::z(), Vector3::x()].map(|normal| ContactCone::new(normal, FrictionCone::new(1.0).unwrap()).unwrap());
    /// let cut = ConeSum::new(&contacts).cut(Vector2::x());
    /// assert!((cut.opening().unwrap().degrees() - 180.0).abs() < 1e-6);
    /// assert!(cut.contains([1.0, -0.99]) && !cut.contains([1.0, -1.01]) && cut.contains([-0.99, 1.0]));
    /// ```
    pub fn cut(&self, heading: Vector2<f64>) -> PlaneCut {
        let in_plane = |v: &Vector3<f64>| [v.x * heading.x + v.y * heading.y, v.z];
        match &self.extent {
            Extent::Nothing => PlaneCut::Nothing,
            Extent::Everything => PlaneCut::Everything,
            Extent::HalfSpace(inward) => {
                let axis = in_plane(inward);
                if dot(axis, axis) <= DUAL_TOLERANCE * DUAL_TOLERANCE {
                    return PlaneCut::Everything;
                }
                PlaneCut::Between { lower: [axis[1], -axis[0]], upper: [-axis[1], axis[0]] }
            }
            Extent::Within(inward) => {
                let across = |v: &Vector3<f64>| v.y * heading.x - v.x * heading.y;
                let mut fan = Fan::about(in_plane(inward));
                for cone in &self.cones {
                    if let Some([lower, upper]) = cone.prepared.sides(cone.axis, heading) {
                        fan.add(lower);
                        fan.add(upper);
                    }
                }
                for [one, other] in &self.faces {
                    let (left, right) = (across(one), across(other));
                    if left * right <= 0.0 {
                        let (share, rest) = (right.abs(), left.abs());
                        let (one, other) = (in_plane(one), in_plane(other));
                        let ray = [share * one[0] + rest * other[0], share * one[1] + rest * other[1]];
                        // Of opposite edges only rounding is left.
                        let least = DUAL_TOLERANCE * (share + rest);
                        if dot(ray, ray) > least * least {
                            fan.add(ray);
                        }
                    }
                }
                fan.cut()
            }
        }
    }

    /// The slopes of the take-off velocities ahead that lie inside.
    ///
    /// For one contact these are [`PreparedCone::slopes`] to the last bit.
    ///
    /// # Arguments
    /// `heading`: the horizontal direction of travel, of length 1.
    ///
    /// # Returns
    /// Up to infinity where straight up lies inside, from minus infinity where straight down does; empty where the plane misses the cone
    /// or no direction in it points ahead.
    #[inline]
    pub fn takeoff_slopes(&self, heading: Vector2<f64>) -> SlopeInterval {
        match self.cones.as_slice() {
            [only] => only.prepared.slopes(only.axis, heading),
            _ => self.cut(heading).takeoff_slopes(),
        }
    }

    /// The slopes of the landing velocities ahead whose reverse lies inside: `-v` in K (S eq. 3).
    ///
    /// For one contact these are the [`PreparedCone::slopes`] of the reversed normal to the last bit.
    ///
    /// # Arguments
    /// `heading`: the horizontal direction of travel, of length 1.
    ///
    /// # Returns
    /// From minus infinity where straight up lies inside; empty where no direction of K points against the heading.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::stance::{ConeSum, ContactCone}, world::FrictionCone};
    /// use nalgebra::{Vector2, Vector3};
    /// // Level ground with friction 0.5: a landing at a slope of -2 or steeper. A wall ahead, whose normal points back, stops any up to 0.5.
    /// let cone = |normal| ContactCone::new(normal, FrictionCone::new(0.5).unwrap()).unwrap();
    /// let [ground, wall] = [cone(Vector3::z()), cone(-Vector3::x())];
    /// assert!((ConeSum::new(&[ground]).landing_slopes(Vector2::x()).upper + 2.0).abs() < 1e-15);
    /// let both = ConeSum::new(&[ground, wall]).landing_slopes(Vector2::x());
    /// assert!((both.upper - 0.5).abs() < 1e-15 && both.lower == f64::NEG_INFINITY);
    /// ```
    #[inline]
    pub fn landing_slopes(&self, heading: Vector2<f64>) -> SlopeInterval {
        match self.cones.as_slice() {
            [only] => only.prepared.slopes(-only.axis, heading),
            _ => self.cut(heading).landing_slopes(),
        }
    }

    /// Whether a direction of any length lies inside, to rounding.
    ///
    /// ```
    /// use chta::{ballistics::stance::{ConeSum, ContactCone}, world::FrictionCone};
    /// use nalgebra::Vector3;
    /// // A slope of 0.6 / 0.8 holds a foot that stands still if the friction is 0.75 or more.
    /// let on_slope = |mu| ConeSum::new(&[ContactCone::new(Vector3::new(0.6, 0.0, 0.8), FrictionCone::new(mu).unwrap()).unwrap()]);
    /// assert!(on_slope(0.76).contains(Vector3::z()) && !on_slope(0.74).contains(Vector3::z()));
    /// ```
    pub fn contains(&self, direction: Vector3<f64>) -> bool {
        let heading = direction.xy().try_normalize(0.0).unwrap_or_else(Vector2::x);
        self.cut(heading).contains([direction.xy().norm(), direction.z])
    }

    /// Whether the vertical lies inside: whether the contacts can hold the weight without sliding.
    pub fn holds_weight(&self) -> bool {
        self.contains(Vector3::z())
    }
}

impl Cone {
    /// Whether the other cone lies inside this one.
    fn holds(&self, other: &Self) -> bool {
        self.prepared.sine() >= other.prepared.sine() && Pair::of(self, other).apart <= 0.0
    }
}

/// Two cones, each number in a form that keeps its digits where normals are nearly equal or nearly opposite.
struct Pair {
    /// `1 - k`.
    less: f64,
    /// `1 + k`.
    more: f64,
    /// `cos(phi_i - phi_j) - k`: positive if neither cone holds the other.
    apart: f64,
    /// `cos(phi_i + phi_j) + k`: negative if both together push every way.
    short: f64,
}

impl Pair {
    fn of(one: &Cone, other: &Cone) -> Self {
        let squared = |x: f64| x * x;
        let (less, more) = (0.5 * (other.axis - one.axis).norm_squared(), 0.5 * (other.axis + one.axis).norm_squared());
        let (one, other) = (&one.prepared, &other.prepared);
        let cosines = squared(one.cosine() - other.cosine());
        Self {
            less,
            more,
            apart: less - 0.5 * (cosines + squared(one.sine() - other.sine())),
            short: more - 0.5 * (cosines + squared(one.sine() + other.sine())),
        }
    }

    fn tangents(one: &Cone, other: &Cone) -> Tangents {
        let pair = Self::of(one, other);
        let (s, t) = (one.prepared.sine(), other.prepared.sine());
        let difference = other.axis - one.axis;
        // The part of the difference along the normal is left out, so the product keeps its digits.
        let normal = one.axis.cross(&difference);
        let square = normal.norm_squared();
        if pair.short < -OPPOSITE_TOLERANCE {
            return Tangents::Everything;
        }
        if pair.apart <= 0.0 || square <= f64::EPSILON * f64::EPSILON {
            return Tangents::None;
        }
        // a n_i + b n_j = (a + b) n_i + b (n_j - n_i)
        let middle = one.axis * ((s + t) / pair.more) + difference * ((t - s + pair.less * s) / square);
        if pair.short <= OPPOSITE_TOLERANCE && s + t > LEAST_SINE {
            return Tangents::HalfSpace(middle);
        }
        let aside = normal * ((pair.apart * pair.short.max(0.0)).sqrt() / square);
        Tangents::Two([middle + aside, middle - aside])
    }
}

/// How far several cones, none inside another, reach together; the faces between them go to the list.
fn joined(cones: &[Cone], faces: &mut Vec<[Vector3<f64>; 2]>) -> Extent {
    let in_dual = |u: &Vector3<f64>| cones.iter().all(|cone| u.dot(&cone.axis) >= cone.prepared.sine() - DUAL_TOLERANCE);
    // All extreme points of the dual cone, and the axes inside it, are on the same side of its middle.
    let mut inward = Vector3::zeros();
    let mut found = false;
    for cone in cones {
        if in_dual(&cone.axis) {
            inward += cone.axis;
            found = true;
        }
    }
    for (at, one) in cones.iter().enumerate() {
        for other in &cones[at + 1..] {
            match Pair::tangents(one, other) {
                Tangents::None => {}
                Tangents::Everything => return Extent::Everything,
                Tangents::HalfSpace(u) => {
                    return if in_dual(&u) { Extent::HalfSpace(u) } else { Extent::Everything };
                }
                Tangents::Two(normals) => {
                    for u in normals.into_iter().filter(in_dual) {
                        inward += u;
                        found = true;
                        faces.push([one.axis - u * one.prepared.sine(), other.axis - u * other.prepared.sine()]);
                    }
                }
            }
        }
    }
    if found { Extent::Within(inward) } else { Extent::Everything }
}

/// The rays of a cut in the order of their angles about an axis from which none is more than a right angle away.
struct Fan {
    axis: [f64; 2],
    /// The tangents of the angles of both sides from the axis.
    least: f64,
    greatest: f64,
    lower: [f64; 2],
    upper: [f64; 2],
}

impl Fan {
    const fn about(axis: [f64; 2]) -> Self {
        Self { axis, least: f64::INFINITY, greatest: f64::NEG_INFINITY, lower: [0.0; 2], upper: [0.0; 2] }
    }

    #[inline]
    fn add(&mut self, ray: [f64; 2]) {
        let (along, side) = (dot(self.axis, ray), cross(self.axis, ray));
        // By rounding a ray may be a little more than a right angle away. One of length 0 has no direction: its
        // tangent is NaN, with which no comparison holds.
        let tangent = if along > 0.0 { side / along } else { side * f64::INFINITY };
        if tangent <= self.least {
            (self.least, self.lower) = (tangent, ray);
        }
        if tangent >= self.greatest {
            (self.greatest, self.upper) = (tangent, ray);
        }
    }

    fn cut(self) -> PlaneCut {
        if self.lower == [0.0; 2] || self.upper == [0.0; 2] {
            return PlaneCut::Nothing;
        }
        if dot(self.axis, self.axis) <= DUAL_TOLERANCE * DUAL_TOLERANCE {
            return PlaneCut::Everything;
        }
        PlaneCut::Between { lower: self.lower, upper: self.upper }
    }
}
