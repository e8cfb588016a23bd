//! The chain with the constraints of every segment resolved: the input of all analyses.

use std::sync::Arc;

use super::{
    ContactRule, Footing, Footprint, FootprintRefusal, GroundForm, GroundRefusal, LineConstraints, PolygonalChain,
    SegmentConstraints, SegmentGround, Station, rest_slope, touchdown::touchdown_rule,
};
use crate::{
    ballistics::PathBounds,
    quantity::{Angle, SegmentId},
    terrain::{FootprintFit, Surroundings},
    world::{Contact, Direction, Gravity, Grip, Hopper, InvalidSurface, SurfaceProperties},
};

/// A chain with the resolved constraints of every segment, for one hopper and one gravity.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstrainedChain {
    geometry: PolygonalChain,
    hopper: Hopper,
    gravity: Gravity,
    surface: SurfaceProperties,
    segments: Vec<SegmentConstraints>,
    /// Greatest take-off and landing speed over all segments, m/s; they bound the reach of any hop.
    speed_bounds_m_s: (f64, f64),
    /// The greatest height above or below 0, m; it bounds the rounding error of heights.
    height_bound_m: f64,
    /// The footprint of the hopper, if it has one, and what is known of the ground under it.
    footprint: Option<Footprint>,
    footing: Footing,
}

/// Why a chain cannot be analysed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintProblem {
    /// Neither the chain nor the scenario states constraints for this segment.
    #[error(
        "segment {} has no constraints: give the chain a column friction_coefficient or the six explicit columns, \
         or the scenario a [surface] with friction_coefficient or takeoff_from_slope_deg and landing_from_slope_deg",
        .0.index() + 1
    )]
    NoGrip(SegmentId),
    /// No speed limit is given for this segment.
    #[error(
        "segment {} has no speed limits: give the scenario a [hopper] with takeoff_speed_max_m_s and landing_speed_max_m_s",
        .0.index() + 1
    )]
    NoSpeed(SegmentId),
    /// A property of the surface that has no meaning.
    #[error(transparent)]
    Surface(#[from] InvalidSurface),
    /// A footprint for which no contact of the terrain has room.
    #[error(
        "hopper.footprint_m is {footprint_m} m, expected less than {} of {extent_m} m: no contact has room for it; check its unit, or \
         leave it out",
        if *on_a_dem { "the shorter side of the DEM," } else { "the length of the chain," }
    )]
    Footprint {
        /// Its diameter, m.
        footprint_m: f64,
        /// The shorter side of the DEM, or the length of the chain, m.
        extent_m: f64,
        /// Whether the chain is a slice of a DEM.
        on_a_dem: bool,
    },
}

/// All reasons why a chain cannot be analysed: the first segment with each problem, and how many more segments have it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", .0.iter().map(|(problem, others)| if *others == 0 { problem.to_string() } else { format!("{problem} (and {others} more segments)") }).collect::<Vec<_>>().join("; "))]
pub struct ConstraintProblems(pub Vec<(ConstraintProblem, usize)>);

impl ConstrainedChain {
    /// Resolves the constraints of every segment from the chain, the hopper and the scenario's surface.
    ///
    /// The chain's own friction, angles or explicit limits have priority, and the surface supplies what the chain leaves
    /// open; of two speed limits the smaller applies, and none reaches the escape speed of a body of known radius
    /// ([`Gravity::speed_cap_m_s`]). The rest slope is compared with the full inclination of the surface,
    /// `n_z = cos chi cos alpha`; a rest slope left to friction is the friction angle of the segment's own coefficient.
    ///
    /// # Errors
    /// [`ConstraintProblems`] where a segment is left without constraints, or the surface has a property without meaning.
    ///
    /// # Examples
    /// ```
    /// use chta::{chain::*, quantity::ChainPoint, world::*};
    /// let chain = PolygonalChain::bare(vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(1.0, 1.0)]).unwrap();
    /// let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.6).unwrap())), rest: RestSlope::AsFrictionHolds };
    /// let chain = ConstrainedChain::new(chain, &Hopper::with_speeds(10.0, 10.0).unwrap(), Gravity::new(3.711).unwrap(), &surface).unwrap();
    /// // 45 degrees is steeper than atan 0.6 = 31 degrees, so nothing rests there.
    /// let refusal = chain.segments()[0].check_contact(Contact::Landing, Direction::Forward).unwrap_err();
    /// assert!((refusal.excess_deg().unwrap() - (45.0 - 30.963_756_532_073_52)).abs() < 1e-9);
    /// ```
    pub fn new(
        geometry: PolygonalChain,
        hopper: &Hopper,
        gravity: Gravity,
        surface: &SurfaceProperties,
    ) -> Result<Self, ConstraintProblems> {
        Self::on(Footing::Profile, geometry, hopper, gravity, surface)
    }

    /// The same for a slice of a DEM: the footprint of a contact lies on the DEM, not along the slice alone.
    ///
    /// # Errors
    /// [`ConstraintProblems`], as [`new`](Self::new).
    pub fn on_dem(
        surroundings: Arc<Surroundings>,
        geometry: PolygonalChain,
        hopper: &Hopper,
        gravity: Gravity,
        surface: &SurfaceProperties,
    ) -> Result<Self, ConstraintProblems> {
        Self::on(Footing::Map(surroundings), geometry, hopper, gravity, surface)
    }

    fn on(
        footing: Footing,
        geometry: PolygonalChain,
        hopper: &Hopper,
        gravity: Gravity,
        surface: &SurfaceProperties,
    ) -> Result<Self, ConstraintProblems> {
        let footprint = Footprint::of(hopper);
        if let Some(problem) = footprint.and_then(|footprint| without_room(footprint.diameter_m, &footing, &geometry)) {
            return Err(ConstraintProblems(vec![(problem, 0)]));
        }
        surface.check().map_err(|problem| ConstraintProblems(vec![(problem.into(), 0)]))?;
        let mut problems: Vec<(ConstraintProblem, usize)> = Vec::new();
        let mut segments = Vec::with_capacity(geometry.segment_count());
        for (i, (&slope, ground)) in geometry.slopes().iter().zip(geometry.grounds()).enumerate() {
            match resolve_constraints(SegmentId(i), slope, ground, hopper, gravity, surface) {
                Ok(segment) => segments.push(segment),
                Err(problem) => {
                    let same =
                        |p: &&mut (ConstraintProblem, usize)| std::mem::discriminant(&p.0) == std::mem::discriminant(&problem);
                    match problems.iter_mut().find(same) {
                        Some(known) => known.1 += 1,
                        None => problems.push((problem, 0)),
                    }
                }
            }
        }
        if !problems.is_empty() {
            return Err(ConstraintProblems(problems));
        }
        let bound = |contact: Contact| {
            let rules = segments.iter().flat_map(|s| Direction::BOTH.map(|d| s.allowed(contact, d))).flatten();
            rules.map(ContactRule::speed_max_m_s).fold(0.0, f64::max)
        };
        let speed_bounds_m_s = (bound(Contact::Takeoff), bound(Contact::Landing));
        let height_bound_m = geometry.vertices().iter().map(|v| v.z_m.abs()).fold(0.0, f64::max);
        let hopper = hopper.below_escape(gravity);
        Ok(Self { geometry, hopper, gravity, surface: *surface, segments, speed_bounds_m_s, height_bound_m, footprint, footing })
    }

    /// The same geometry and surface for another hopper and gravity.
    ///
    /// # Errors
    /// [`ConstraintProblems`], as [`new`](Self::new).
    pub fn with_hopper(&self, hopper: &Hopper, gravity: Gravity) -> Result<Self, ConstraintProblems> {
        Self::on(self.footing.clone(), self.geometry.clone(), hopper, gravity, &self.surface)
    }

    /// The greatest height of a vertex above or below 0, m.
    pub(crate) const fn height_bound_m(&self) -> f64 {
        self.height_bound_m
    }

    /// The hopper whose limits the constraints hold.
    #[inline]
    pub const fn hopper(&self) -> &Hopper {
        &self.hopper
    }

    /// The gravity it hops under.
    #[inline]
    pub const fn gravity(&self) -> Gravity {
        self.gravity
    }

    /// What holds where the chain itself says nothing of its ground.
    pub const fn surface(&self) -> &SurfaceProperties {
        &self.surface
    }

    /// The chain's geometry.
    pub const fn geometry(&self) -> &PolygonalChain {
        &self.geometry
    }

    /// The constraints of every segment.
    pub fn segments(&self) -> &[SegmentConstraints] {
        &self.segments
    }

    /// The greatest take-off and landing speed that any segment allows, m/s.
    pub const fn speed_bounds_m_s(&self) -> (f64, f64) {
        self.speed_bounds_m_s
    }

    /// The fewest hops that any path between two of its stations takes, whatever nodes it has; `None` where no hop has the speeds that the
    /// segments allow.
    pub fn hops_lower_bound(&self, start: &Station, goal: &Station) -> Option<u64> {
        let (takeoff_m_s, landing_m_s) = self.speed_bounds_m_s;
        let (from, to) = (start.point, goal.point);
        PathBounds::new(takeoff_m_s, landing_m_s, self.gravity.m_s2()).hops((to.x_m - from.x_m).abs(), to.z_m - from.z_m)
    }

    /// The constraints of the segment that rules a contact at a station; `None` beyond the chain's ends.
    #[inline]
    pub fn ruling(&self, station: &Station, contact: Contact, direction: Direction) -> Option<&SegmentConstraints> {
        let segment = station.ruling_segment(contact, direction, self.segments.len())?;
        self.segments.get(segment.index())
    }

    /// The rule of a contact at a station, or the reason why the ground refuses the contact for every hop.
    ///
    /// # Errors
    /// The refusal by the ground.
    pub fn check_contact(&self, station: &Station, contact: Contact, direction: Direction) -> Result<ContactRule, GroundRefusal> {
        let id = station.ruling_segment(contact, direction, self.segments.len()).ok_or(GroundRefusal::NoGround)?;
        let checked = self.segments.get(id.index()).ok_or(GroundRefusal::NoGround)?.check_contact(contact, direction);
        match checked {
            Err(refusal @ (GroundRefusal::NoGround | GroundRefusal::KeepOut | GroundRefusal::TooSteep { .. })) => Err(refusal),
            other => self.refusal_at(station, id).map_or(other, Err),
        }
    }

    /// The inclination of the surface that rules a contact at a station, or of the plane fitted over the footprint there, and the
    /// greatest on which the hopper rests; `None` without a rest slope, and where no ground is known.
    pub(crate) fn rest_slope(
        &self,
        station: &Station,
        contact: Contact,
        direction: Direction,
        fit: Option<FootprintFit>,
    ) -> Option<(Angle, Angle)> {
        let segment = station.ruling_segment(contact, direction, self.segments.len())?.index();
        let ground = &self.geometry.grounds()[segment];
        let max = rest_slope(ground, &self.surface)?;
        let tilt = match self.footprint {
            Some(_) => fit?.tilt_slope,
            None => tilt_slope(self.geometry.slopes()[segment], ground.cross_slope().slope()),
        };
        Some((Angle::from_slope(tilt), Angle::from_slope(max)))
    }

    /// The plane fitted over the footprint at a station; `None` without a footprint, and where no ground is known.
    pub(crate) fn footprint_fit(&self, station: &Station) -> Option<FootprintFit> {
        let footprint = self.footprint?;
        self.footing.fit(&self.geometry, self.geometry.vertices(), station, footprint.diameter_m, None).ok()
    }

    /// The rule of a contact at a station if the ground allows it. This is the version for inner loops.
    #[inline]
    pub(crate) fn allowed(&self, station: &Station, contact: Contact, direction: Direction) -> Option<&ContactRule> {
        let id = station.ruling_segment(contact, direction, self.segments.len())?;
        let rule = self.segments.get(id.index())?.allowed(contact, direction)?;
        (self.is_uniform() || self.refusal_at(station, id).is_none()).then_some(rule)
    }

    /// Whether every segment allows the same contacts all over it: no layer refuses any, and the hopper has no footprint.
    #[inline]
    pub(crate) fn is_uniform(&self) -> bool {
        self.footprint.is_none() && self.geometry.layers().is_none_or(|layers| !layers.restrict_contacts())
    }

    /// Why a layer or the ground under the footprint refuses every contact at a station that a segment rules; `None` if they do not.
    pub(crate) fn refusal_at(&self, station: &Station, segment: SegmentId) -> Option<GroundRefusal> {
        let layer = self.geometry.layer_refusing_contact(station.point.x_m).map(GroundRefusal::Layer);
        layer.or_else(|| self.footprint_refusal(station, segment).map(GroundRefusal::Footprint))
    }

    /// Why the ground under the footprint refuses every contact at a station that a segment rules; `None` if it does not, or if the
    /// hopper has no footprint.
    pub(crate) fn footprint_refusal(&self, station: &Station, segment: SegmentId) -> Option<FootprintRefusal> {
        let footprint = self.footprint?;
        let rest = self.geometry.grounds().get(segment.index()).and_then(|ground| rest_slope(ground, &self.surface));
        let fit = self.footing.fit(&self.geometry, self.geometry.vertices(), station, footprint.diameter_m, None);
        footprint.judge(fit, rest, self.height_bound_m)
    }

    /// The footprint of the hopper, if it has one.
    pub(crate) const fn footprint(&self) -> Option<Footprint> {
        self.footprint
    }

    /// What is known of the ground under a footprint.
    pub(crate) const fn footing(&self) -> &Footing {
        &self.footing
    }
}

/// The problem of a footprint that is larger than the terrain.
fn without_room(footprint_m: f64, footing: &Footing, geometry: &PolygonalChain) -> Option<ConstraintProblem> {
    let (extent_m, on_a_dem) = match footing {
        Footing::Profile => {
            let (first_m, last_m) = geometry.extent_m();
            (last_m - first_m, false)
        }
        Footing::Map(surroundings) => {
            let bounds = surroundings.lattice().bounds();
            ((bounds.max.x - bounds.min.x).min(bounds.max.y - bounds.min.y), true)
        }
    };
    (footprint_m > extent_m).then_some(ConstraintProblem::Footprint { footprint_m, extent_m, on_a_dem })
}

/// Resolves the constraints of one segment: what its ground, given by its slope along the plane of travel, allows this
/// hopper under this gravity.
pub(crate) fn resolve_constraints(
    id: SegmentId,
    slope: f64,
    ground: &SegmentGround,
    hopper: &Hopper,
    gravity: Gravity,
    surface: &SurfaceProperties,
) -> Result<SegmentConstraints, ConstraintProblem> {
    let (takeoff_speed, landing_speed) = (hopper.limits().takeoff_speed_max_m_s, hopper.limits().landing_speed_max_m_s);
    let (forward, reverse) = match ground.form {
        GroundForm::Explicit { forward, reverse } => {
            let capped =
                |c: Option<LineConstraints>| c.map(|c| c.capped(takeoff_speed, landing_speed)).ok_or(GroundRefusal::NoGround);
            (capped(forward), capped(reverse))
        }
        GroundForm::Surface { friction, cross_slope } => {
            let grip = friction.map(Grip::Friction).or(surface.grip).ok_or(ConstraintProblem::NoGrip(id))?;
            let on = |slope: f64| match grip {
                Grip::Friction(cone) => cone
                    .cut(cross_slope)
                    .map(|delta| LineConstraints::from_cone(slope, delta, takeoff_speed, landing_speed))
                    .ok_or(GroundRefusal::CrossSlope { cross_slope, friction: cone }),
                Grip::FromSlope { takeoff, landing } => {
                    Ok(LineConstraints::from_offsets(slope, takeoff, landing, takeoff_speed, landing_speed))
                }
            };
            (on(slope), on(-slope))
        }
    };
    let tilt = tilt_slope(slope, ground.cross_slope().slope());
    let friction = ground.friction_under(surface);
    let touchdown =
        hopper.limits().landing.touchdown_speed_m_s().map(|speed_m_s| {
            [forward, reverse].map(|line| touchdown_rule(line, friction.map(|friction| (tilt, friction)), speed_m_s))
        });
    // With a footprint, the plane fitted over it is held against the rest slope, contact by contact.
    let too_steep = rest_slope(ground, surface)
        .filter(|&max| tilt > max && Footprint::of(hopper).is_none())
        .map(|max| GroundRefusal::TooSteep { tilt: Angle::from_slope(tilt), max: Angle::from_slope(max) });
    let refusal = if ground.keep_out { Some(GroundRefusal::KeepOut) } else { too_steep };
    commanded(id, [forward, reverse], (refusal, touchdown), hopper, gravity)
}

/// The constraints of lines of both directions, with the speeds of the machine's commands below the escape speed.
pub(super) fn commanded(
    id: SegmentId,
    lines: [Result<LineConstraints, GroundRefusal>; 2],
    (refusal, touchdown): (Option<GroundRefusal>, Option<[Result<ContactRule, GroundRefusal>; 2]>),
    hopper: &Hopper,
    gravity: Gravity,
) -> Result<SegmentConstraints, ConstraintProblem> {
    let unbounded = |c: &Result<LineConstraints, GroundRefusal>| {
        c.is_ok_and(|c| !(c.takeoff.speed_max_m_s().is_finite() && c.landing.speed_max_m_s().is_finite()))
    };
    if lines.iter().any(unbounded) {
        return Err(ConstraintProblem::NoSpeed(id));
    }
    let cap_m_s = gravity.speed_cap_m_s();
    // A touchdown with brakes is no end of an arc.
    let landing_cap_m_s = if touchdown.is_some() { f64::INFINITY } else { cap_m_s };
    let steps = hopper.limits().steps;
    let commanded = |line: LineConstraints| {
        let takeoff_m_s = steps.speed_not_above_m_s(line.takeoff.speed_max_m_s().min(cap_m_s));
        line.capped(takeoff_m_s, landing_cap_m_s)
    };
    let [forward, reverse] = lines.map(|line| line.map(commanded));
    let constraints = SegmentConstraints::new(forward, reverse, refusal);
    Ok(touchdown.map_or(constraints, |touchdown| constraints.with_touchdown(touchdown)))
}

/// The tangent of a surface's inclination, from its slope `s` along the plane of travel and the tangent `t` of its
/// cross-slope: `n_z = cos chi cos alpha` gives `tan^2 = (1 + s^2)(1 + t^2) - 1`. Returns exactly `|s|` for `t = 0`, so that
/// a slope of exactly the limit is allowed.
pub(super) fn tilt_slope(s: f64, t: f64) -> f64 {
    if t == 0.0 { s.abs() } else { libm::hypot(s, t * libm::hypot(1.0, s)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        quantity::{AngleInterval, ChainPoint},
        world::{FrictionCone, RestSlope},
    };

    fn one_segment(rise: f64, form: GroundForm) -> PolygonalChain {
        let vertices = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(10.0, rise)];
        PolygonalChain::new(vertices, vec![SegmentGround { form, keep_out: false }], None).unwrap()
    }

    fn friction(mu: f64) -> SurfaceProperties {
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(mu).unwrap())), rest: RestSlope::AsFrictionHolds }
    }

    fn constrained(
        geometry: PolygonalChain,
        hopper: &Hopper,
        surface: &SurfaceProperties,
    ) -> Result<ConstrainedChain, ConstraintProblems> {
        ConstrainedChain::new(geometry, hopper, Gravity::new(3.711).unwrap(), surface)
    }

    fn ten() -> Hopper {
        Hopper::with_speeds(10.0, 10.0).unwrap()
    }

    #[test]
    fn a_slope_of_exactly_the_friction_angle_still_rests() {
        let chain = |rise| constrained(one_segment(rise, SegmentGround::BARE.form), &ten(), &friction(0.6)).unwrap();
        assert!(chain(6.0).segments()[0].check_contact(Contact::Landing, Direction::Forward).is_ok(), "tan = 0.6 touches 0.6");
        assert!(chain(6.0f64.next_up().next_up()).segments()[0].check_contact(Contact::Landing, Direction::Forward).is_err());
    }

    #[test]
    fn cross_slope_makes_flat_looking_ground_unusable() {
        // mu = 0.6 allows no cross-slope above 31 degrees (model section 1).
        for (chi_deg, allowed) in [(30.9, true), (31.0, false)] {
            let form = GroundForm::Surface { friction: None, cross_slope: Angle::from_degrees(chi_deg) };
            let surface = SurfaceProperties { rest: RestSlope::Unlimited, ..friction(0.6) };
            let chain = constrained(one_segment(0.0, form), &ten(), &surface).unwrap();
            let checked = chain.segments()[0].check_contact(Contact::Takeoff, Direction::Forward);
            assert_eq!(checked.is_ok(), allowed, "cross-slope {chi_deg} deg");
        }
    }

    #[test]
    fn tilt_agrees_with_the_normal_of_the_plane() {
        for (s, t) in [(0.3, 0.4), (-1.0, 0.2), (0.0, 2.0), (5.0, 1e-3)] {
            // The in-plane direction is (1, 0, s); the normal's in-plane component is along (-s, 0, 1), and the tangent of
            // its angle to the plane is t.
            let (s, t): (f64, f64) = (s, t);
            let along = nalgebra::Vector3::new(-s, 0.0, 1.0) / (1.0 + s * s).sqrt();
            let normal = (along + nalgebra::Vector3::y() * t).normalize();
            let expected = (normal.x.hypot(normal.y)) / normal.z;
            assert!((tilt_slope(s, t) - expected).abs() < 1e-12 * (1.0 + expected), "s {s} t {t}");
        }
    }

    #[test]
    fn the_smaller_speed_counts_and_missing_ones_are_named() {
        let line = LineConstraints::from_cone(0.0, Angle::from_degrees(30.0), 6.0, 50.0);
        let form = GroundForm::Explicit { forward: Some(line), reverse: None };
        let chain = constrained(one_segment(0.0, form), &ten(), &friction(0.6)).unwrap();
        let rule = |contact| chain.segments()[0].check_contact(contact, Direction::Forward).unwrap();
        assert_eq!(rule(Contact::Takeoff).speed_max_m_s(), 6.0);
        assert_eq!(rule(Contact::Landing).speed_max_m_s(), 10.0);
        assert_eq!(
            chain.segments()[0].check_contact(Contact::Takeoff, Direction::Reverse).unwrap_err(),
            GroundRefusal::NoGround,
            "no reverse columns, no reverse hop"
        );
        let bare = SurfaceProperties { grip: None, rest: RestSlope::AsFrictionHolds };
        let ConstraintProblems(problems) = constrained(one_segment(0.0, SegmentGround::BARE.form), &ten(), &bare).unwrap_err();
        assert_eq!(problems, [(ConstraintProblem::NoGrip(SegmentId(0)), 0)]);
        let ConstraintProblems(problems) =
            constrained(one_segment(0.0, SegmentGround::BARE.form), &Hopper::UNLIMITED, &friction(0.6)).unwrap_err();
        assert_eq!(problems, [(ConstraintProblem::NoSpeed(SegmentId(0)), 0)]);
    }

    #[test]
    fn reverse_sees_the_mirrored_slope() {
        let surface = SurfaceProperties {
            grip: Some(Grip::FromSlope {
                takeoff: AngleInterval::from_degrees(60.0, 90.0),
                landing: AngleInterval::from_degrees(-90.0, -60.0),
            }),
            rest: RestSlope::AsFrictionHolds,
        };
        let chain = constrained(one_segment(10.0, SegmentGround::BARE.form), &ten(), &surface).unwrap();
        let angles = |d| chain.segments()[0].stated(d).unwrap().takeoff.angles();
        assert!((angles(Direction::Forward).min.degrees() - 105.0).abs() < 1e-9);
        assert!((angles(Direction::Reverse).min.degrees() - 15.0).abs() < 1e-9);
        assert!(matches!(
            chain.segments()[0].check_contact(Contact::Takeoff, Direction::Forward),
            Err(GroundRefusal::NothingAhead { .. })
        ));
    }

    #[test]
    fn a_surface_without_meaning_makes_no_chain() {
        let surface = SurfaceProperties { rest: RestSlope::AtMost(Angle::from_degrees(f64::NAN)), ..friction(0.6) };
        let ConstraintProblems(problems) = constrained(one_segment(0.0, SegmentGround::BARE.form), &ten(), &surface).unwrap_err();
        assert!(matches!(problems.as_slice(), [(ConstraintProblem::Surface(InvalidSurface::RestSlope { .. }), 0)]), "{problems:?}");
    }

    /// Escape from Bennu is sqrt(2 x 4.892 / 245.03) = 0.1998 m/s: above it no speed limit of hopper or chain counts, below it each
    /// does, and a missing limit is still missing.
    #[test]
    fn no_speed_limit_reaches_escape_from_a_body_of_known_radius() {
        let bennu = crate::world::Body::named("bennu").unwrap().gravity;
        let escape_m_s = (2.0_f64 * 4.892 / 245.03).sqrt();
        let line = |speed_m_s| LineConstraints::from_cone(0.0, Angle::from_degrees(30.0), speed_m_s, speed_m_s);
        let explicit = |speed_m_s| GroundForm::Explicit { forward: Some(line(speed_m_s)), reverse: None };
        let surface = SegmentGround::BARE.form;
        let hopper = |speed_m_s| Hopper::with_speeds(speed_m_s, speed_m_s).unwrap();
        for (form, hopper, expected_m_s) in [
            (surface, hopper(0.25), escape_m_s),
            (surface, hopper(1e5), escape_m_s),
            (surface, hopper(0.15), 0.15),
            (explicit(0.3), Hopper::UNLIMITED, escape_m_s),
            (explicit(0.3), hopper(0.25), escape_m_s),
            (explicit(0.3), hopper(0.1), 0.1),
            (explicit(0.12), hopper(0.25), 0.12),
        ] {
            let chain = ConstrainedChain::new(one_segment(0.0, form), &hopper, bennu, &friction(0.6)).unwrap();
            for contact in [Contact::Takeoff, Contact::Landing] {
                let found = chain.segments()[0].check_contact(contact, Direction::Forward).unwrap().speed_max_m_s();
                assert!((found - expected_m_s).abs() < 1e-6 && found < escape_m_s, "{form:?} {hopper:?}: {found}");
            }
            let limits = chain.hopper().limits();
            assert!(limits.takeoff_speed_max_m_s.is_infinite() || limits.takeoff_speed_max_m_s < escape_m_s, "{limits:?}");
        }
        let missing = ConstrainedChain::new(one_segment(0.0, surface), &Hopper::UNLIMITED, bennu, &friction(0.6)).unwrap_err();
        assert_eq!(missing.0, [(ConstraintProblem::NoSpeed(SegmentId(0)), 0)]);
    }

    #[test]
    fn speed_zero_is_refused_before_any_formula() {
        let line = LineConstraints::from_cone(0.0, Angle::from_degrees(30.0), 0.0, 5.0);
        let form = GroundForm::Explicit { forward: Some(line), reverse: Some(line) };
        let chain = constrained(one_segment(0.0, form), &ten(), &friction(0.6)).unwrap();
        assert_eq!(chain.segments()[0].check_contact(Contact::Takeoff, Direction::Forward), Err(GroundRefusal::SpeedZero));
        assert!(chain.segments()[0].check_contact(Contact::Landing, Direction::Forward).is_ok(), "landing keeps its own limit");
    }
}
