//! What pushing a robot off, or stopping it, asks of its feet beside a direction within their cone: a stroke, forces, and spin.
//!
//! ```text
//!     stroke s    the force of a straight push from rest, v^2 / (2 s) along v and g up, lies in the cone
//!     force       each foot bears at most F_i of it
//!     spin        some forces within the cones leave no more angular momentum than the robot may have
//! ```
//!
//! A landing is a take-off backwards: its push is the reverse of its velocity.
//!
//! The set of velocities that a limit on spin allows is convex and holds 0, and the velocities of the arcs between two places lie on a branch of
//! a hyperbola that is nearer to 0 than its chords. So between two arcs that the spin allows it allows all. For the stroke and the forces
//! this is not proved, and the arcs of a window are looked at in steps; the one that is flown is judged itself.

use nalgebra::{Vector2, Vector3};

use super::{Foothold, Stance, StanceGround};
use crate::{
    ballistics::{
        Arc, LineOfSight, loft_at_share,
        stance::{self, Limb, greatest_push_speed_m_s, least_spin_m2_s, push_force_n},
    },
    quantity::SlopeInterval,
    world::Limit,
};

/// Steps in which the arcs of a window are looked at.
const ARCS: u32 = 7;

/// Halvings of the step between an arc that is allowed and one that is not.
const HALVINGS: u32 = 14;

/// The same for the spin, of which one arc takes a hundred microseconds: what it allows is one interval, and its ends need not be found closely, since
/// each is on the side that is allowed.
const ARCS_OF_SPIN: u32 = 2;
const HALVINGS_OF_SPIN: u32 = 6;

/// A spin this share of a limit above it is the limit, by the rounding of its least value.
const ROUNDED: f64 = 1.0e-6;

impl StanceGround {
    /// Whether the robot states limits of a push.
    pub fn limits_pushes(&self) -> bool {
        !self.is_point() && (self.robot().stroke_m().is_some() || self.spin_max_m2_s().is_some())
    }

    /// The greatest angular momentum that a take-off may leave, for each kg, m^2/s; `None` without a limit.
    ///
    /// ```text
    ///     I w / m       I the least of the moments of inertia: the rate about any axis is then at most w
    /// ```
    pub fn spin_max_m2_s(&self) -> Option<f64> {
        let robot = self.robot();
        let most = robot.spin_max_rad_s()?;
        let inertia = robot.inertia_kg_m2().map_or(0.0, |moments| moments.iter().copied().fold(f64::INFINITY, f64::min));
        // A robot without a mass may turn only at rate 0, for which the mass does not matter.
        Some(most * inertia / self.mass_kg().unwrap_or(1.0))
    }

    pub(super) fn mass_kg(&self) -> Option<f64> {
        self.mesh().envelope().hopper().limits().mass_kg.or(self.robot().mass_kg())
    }

    /// The limit that refuses a push of a stance, if one does: `velocity_m_s` of the take-off, or the reverse of that of the landing.
    pub fn refuses_push(&self, stance: &Stance, velocity_m_s: Vector3<f64>) -> Option<Limit> {
        self.refuses_strength(stance, velocity_m_s).or_else(|| self.refuses_spin(stance, velocity_m_s))
    }

    /// The stroke or the forces, if they refuse a push.
    fn refuses_strength(&self, stance: &Stance, velocity_m_s: Vector3<f64>) -> Option<Limit> {
        let (cone, stroke_m, speed_m_s) = (stance.cone()?, self.robot().stroke_m()?, velocity_m_s.norm());
        if speed_m_s == 0.0 {
            return None;
        }
        let g = self.mesh().envelope().gravity_m_s2();
        if !cone.contains(self.force_of_push_n(velocity_m_s, stroke_m)) {
            return Some(Limit::Stroke);
        }
        let (limbs, mass_kg) = (self.limbs(stance)?, self.mass_kg()?);
        let most = greatest_push_speed_m_s(&limbs, velocity_m_s / speed_m_s, stroke_m, mass_kg, g);
        most.is_none_or(|most| most.lower < speed_m_s).then_some(Limit::Force)
    }

    /// The force of the feet in sum at the end of a straight push over a stroke, N for each kg.
    pub(super) fn force_of_push_n(&self, velocity_m_s: Vector3<f64>, stroke_m: f64) -> Vector3<f64> {
        let g = self.mesh().envelope().gravity_m_s2();
        let ahead = velocity_m_s.xy().norm();
        let along = velocity_m_s.xy().try_normalize(0.0).unwrap_or_else(Vector2::x);
        let force = push_force_n(velocity_m_s.z / ahead.max(f64::MIN_POSITIVE), velocity_m_s.norm(), stroke_m, g);
        Vector3::new(along.x * force.x, along.y * force.x, force.y)
    }

    /// The spin, if it refuses a push.
    fn refuses_spin(&self, stance: &Stance, velocity_m_s: Vector3<f64>) -> Option<Limit> {
        stance.cone()?;
        let (most, speed_m_s) = (self.spin_max_m2_s()?, velocity_m_s.norm());
        let least = least_spin_m2_s(&self.arms(stance), velocity_m_s);
        let tolerance = ROUNDED * (most + speed_m_s * self.robot().reach_m());
        least.is_none_or(|least| least.upper > most + tolerance).then_some(Limit::Spin)
    }

    /// The limit that refuses the push or the stop of an arc; `heading`: the horizontal direction of travel.
    pub fn refuses_arc(&self, ends: [&Stance; 2], heading: Vector2<f64>, arc: &Arc) -> Option<Limit> {
        let [(takeoff, push), (landing, stop)] = pushes(ends, heading, arc);
        self.refuses_push(takeoff, push).or_else(|| self.refuses_push(landing, stop))
    }

    /// The part of a window whose arcs the limits of a push allow: the longest of those found in steps, each end on the side that is allowed,
    /// and the limit beyond each end that was moved; or the limit that allows none.
    pub(super) fn pushable(
        &self,
        ends: [&Stance; 2],
        (heading, sight): (Vector2<f64>, LineOfSight),
        window: SlopeInterval,
    ) -> Result<(SlopeInterval, [Option<Limit>; 2]), Limit> {
        let g = self.mesh().envelope().gravity_m_s2();
        let refusal = |loft: f64, of: &dyn Fn(&Stance, Vector3<f64>) -> Option<Limit>| {
            let [takeoff, landing] = pushes(ends, heading, &Arc::new(sight, loft, g));
            of(takeoff.0, takeoff.1).or_else(|| of(landing.0, landing.1))
        };
        let (mut found, mut by) = (window, [None; 2]);
        if self.robot().stroke_m().is_some() {
            let strength = |stance: &Stance, velocity| self.refuses_strength(stance, velocity);
            (found, by) = narrowed(sight, found, (ARCS, HALVINGS), |loft| refusal(loft, &strength))?;
        }
        if self.spin_max_m2_s().is_some() {
            let spin = |stance: &Stance, velocity| self.refuses_spin(stance, velocity);
            let moved;
            (found, moved) = narrowed(sight, found, (ARCS_OF_SPIN, HALVINGS_OF_SPIN), |loft| refusal(loft, &spin))?;
            by = [moved[0].or(by[0]), moved[1].or(by[1])];
        }
        Ok((found, by))
    }

    /// The standing feet with their strengths; `None` if one states none.
    pub(crate) fn limbs(&self, stance: &Stance) -> Option<Vec<Limb>> {
        let limb = |foot: &Foothold| Limb::new(foot.cone()?, self.robot().limbs()[foot.limb].force_max_n?).ok();
        stance.footholds().iter().map(limb).collect()
    }

    /// The standing feet as seen from the centre of mass.
    pub(crate) fn arms(&self, stance: &Stance) -> Vec<stance::Foothold> {
        let centre = stance.pose().to_ground(&self.robot().centre_of_mass_m());
        let arm = |foot: &Foothold| Some(stance::Foothold { cone: foot.cone()?, arm_m: foot.point_m - centre });
        stance.footholds().iter().filter_map(arm).collect()
    }

    /// Whether a robot that rests on its feet need not topple: its weight is borne without a moment.
    pub fn rests_upright(&self, stance: &Stance) -> bool {
        stance.point().is_some() || stance::holds_upright(&self.arms(stance))
    }

    /// The greatest take-off speed along a direction of length 1 that stroke and forces allow, m/s, by what is proved; `None` unless the robot states
    /// stroke, mass and forces, or if no push is possible along it.
    pub fn push_speed_max_m_s(&self, stance: &Stance, direction: Vector3<f64>) -> Option<f64> {
        let (limbs, stroke_m, mass_kg) = (self.limbs(stance)?, self.robot().stroke_m()?, self.mass_kg()?);
        let g = self.mesh().envelope().gravity_m_s2();
        Some(greatest_push_speed_m_s(&limbs, direction, stroke_m, mass_kg, g)?.lower)
    }

    /// The least angular momentum of a take-off, for each kg, m^2/s, by what was found; `None` if the feet do not push that way.
    pub fn spin_of(&self, stance: &Stance, velocity_m_s: Vector3<f64>) -> Option<f64> {
        Some(least_spin_m2_s(&self.arms(stance), velocity_m_s)?.upper)
    }
}

/// The push at the take-off of an arc and the one that stops its landing, each with its stance.
fn pushes<'a>([takeoff, landing]: [&'a Stance; 2], heading: Vector2<f64>, arc: &Arc) -> [(&'a Stance, Vector3<f64>); 2] {
    let velocity = |slope: f64, speed_m_s: f64| {
        let ahead = speed_m_s / libm::hypot(1.0, slope);
        Vector3::new(heading.x * ahead, heading.y * ahead, slope * ahead)
    };
    let push = velocity(arc.takeoff_slope(), arc.takeoff_speed_m_s());
    [(takeoff, push), (landing, -velocity(arc.landing_slope(), arc.landing_speed_m_s()))]
}

/// The longest part of a window without a refusal at steps of its take-off angle, whose ends are brought near to the refusals beyond them.
fn narrowed(
    sight: LineOfSight,
    window: SlopeInterval,
    (steps, halvings): (u32, u32),
    refusal: impl Fn(f64) -> Option<Limit>,
) -> Result<(SlopeInterval, [Option<Limit>; 2]), Limit> {
    let lofts: Vec<f64> = (0..=steps).map(|step| loft_at_share(sight, window, f64::from(step) / f64::from(steps))).collect();
    let refusals: Vec<Option<Limit>> = lofts.iter().map(|loft| refusal(*loft)).collect();
    let mut best: Option<[usize; 2]> = None;
    let mut from = 0;
    for (at, refused) in refusals.iter().enumerate() {
        if refused.is_some() {
            from = at + 1;
        } else if best.is_none_or(|[first, last]| at - from > last - first) {
            best = Some([from, at]);
        }
    }
    let Some([first, last]) = best else { return Err(refusals.into_iter().flatten().next().unwrap_or(Limit::Stroke)) };
    let between = |mut allowed: f64, mut refused: f64| {
        for _ in 0..halvings {
            let middle = f64::midpoint(allowed, refused);
            if refusal(middle).is_none() { allowed = middle } else { refused = middle }
        }
        allowed
    };
    let (mut found, mut by) = (SlopeInterval { lower: lofts[first], upper: lofts[last] }, [None; 2]);
    if first > 0 {
        (found.lower, by[0]) = (between(lofts[first], lofts[first - 1]), refusals[first - 1]);
    }
    if last + 1 < lofts.len() {
        (found.upper, by[1]) = (between(lofts[last], lofts[last + 1]), refusals[last + 1]);
    }
    Ok((found, by))
}
