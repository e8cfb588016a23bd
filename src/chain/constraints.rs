//! The constraints of one segment, for both directions of travel.

use std::{
    f64::consts::{FRAC_PI_2, PI},
    fmt,
};

use crate::{
    ballistics::ContactLimits,
    quantity::{Angle, AngleInterval, SlopeInterval},
    world::{Contact, Derating, Direction, FrictionCone, LayerName, Limit},
};

/// The limits of one contact: directions of travel and a greatest speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRule {
    angles: AngleInterval,
    slopes: SlopeInterval,
    speed_max_m_s: f64,
}

impl ContactRule {
    /// A rule from angles, restricted here to (-90, 90) degrees, and a speed limit in m/s.
    pub fn new(angles: AngleInterval, speed_max_m_s: f64) -> Self {
        Self { angles, slopes: angles.slopes(), speed_max_m_s }
    }

    /// The angles as given.
    pub const fn angles(&self) -> AngleInterval {
        self.angles
    }

    /// The allowed slopes.
    #[inline]
    pub const fn slopes(&self) -> SlopeInterval {
        self.slopes
    }

    /// The greatest speed, m/s; 0 means that the contact is not allowed.
    #[inline]
    pub const fn speed_max_m_s(&self) -> f64 {
        self.speed_max_m_s
    }

    /// The slopes and the speed, without the angles as stated.
    #[inline]
    pub const fn contact_limits(&self) -> ContactLimits {
        ContactLimits { slopes: self.slopes, speed_max_m_s: self.speed_max_m_s }
    }

    /// The same angles with the smaller of two speed limits.
    #[must_use]
    fn capped(self, speed_max_m_s: f64) -> Self {
        Self { speed_max_m_s: self.speed_max_m_s.min(speed_max_m_s), ..self }
    }
}

/// The line constraints of a segment for one direction of travel, with angles seen along that direction (CHTA paper,
/// Definition 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineConstraints {
    /// Take-off angles and speed.
    pub takeoff: ContactRule,
    /// Landing angles and speed.
    pub landing: ContactRule,
}

impl LineConstraints {
    /// The constraints from a friction cone, intersected by the plane of travel, on a segment of a given slope.
    ///
    /// ```text
    ///     take-off: alpha + pi/2 -+ delta,   landing: alpha - pi/2 -+ delta
    /// ```
    ///
    /// Source: Campana and Laumond 2016, section IV-A; model section 1.
    ///
    /// # Arguments
    /// `slope`: the segment's slope along the direction of travel; `cone_half_angle`: delta of [`FrictionCone::cut`]; the two
    /// speeds in m/s.
    ///
    /// # Examples
    /// ```
    /// use chta::{chain::LineConstraints, quantity::Angle};
    /// // Flat ground, friction angle 30 degrees: take-off between 60 and 120 degrees, of which 60 to 90 point forward.
    /// let c = LineConstraints::from_cone(0.0, Angle::from_degrees(30.0), 10.0, 8.0);
    /// assert!((c.takeoff.angles().min.degrees() - 60.0).abs() < 1e-12);
    /// assert_eq!(c.takeoff.slopes().upper, f64::INFINITY);
    /// assert!((c.landing.angles().max.degrees() + 60.0).abs() < 1e-12);
    /// ```
    pub fn from_cone(slope: f64, cone_half_angle: Angle, takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64) -> Self {
        let alpha = Angle::from_slope(slope).radians();
        let axes = [alpha + FRAC_PI_2, alpha - FRAC_PI_2].map(Angle::from_radians);
        Self::about(axes, cone_half_angle, takeoff_speed_max_m_s, landing_speed_max_m_s)
    }

    /// The constraints from a friction cone about any normal, intersected by the plane of travel: walls and overhangs as well.
    ///
    /// ```text
    ///     take-off: gamma -+ delta,   landing: gamma + pi -+ delta,   gamma in (-pi, pi] the elevation of the normal, seen in the plane
    /// ```
    ///
    /// With delta below pi/2 either has at most one interval inside (-pi/2, pi/2): a landing lies in the opposite half of the cone.
    ///
    /// Source: Campana and Laumond 2016, section IV-A, whose Algorithm 1 lists the cases of the landing one by one.
    ///
    /// # Arguments
    /// `normal_elevation`: gamma; the rest as in [`from_cone`](Self::from_cone).
    ///
    /// # Examples
    /// ```
    /// use chta::{chain::LineConstraints, quantity::Angle};
    /// // A wall that faces the traveller's way, friction angle 30 degrees: take-off between -30 and 30 degrees, no landing.
    /// let wall = LineConstraints::about_normal(Angle::from_degrees(0.0), Angle::from_degrees(30.0), 10.0, 8.0);
    /// assert!((wall.takeoff.angles().max.degrees() - 30.0).abs() < 1e-12 && wall.landing.slopes().is_empty());
    /// // A ceiling: take-off steeper down than -60 degrees, landing steeper up than 60.
    /// let ceiling = LineConstraints::about_normal(Angle::from_degrees(-90.0), Angle::from_degrees(30.0), 10.0, 8.0);
    /// assert!((ceiling.landing.angles().min.degrees() - 60.0).abs() < 1e-12);
    /// ```
    pub fn about_normal(
        normal_elevation: Angle,
        cone_half_angle: Angle,
        takeoff_speed_max_m_s: f64,
        landing_speed_max_m_s: f64,
    ) -> Self {
        let gamma = normal_elevation.radians();
        let opposite = if gamma > 0.0 { gamma - PI } else { gamma + PI };
        let axes = [gamma, opposite].map(Angle::from_radians);
        Self::about(axes, cone_half_angle, takeoff_speed_max_m_s, landing_speed_max_m_s)
    }

    /// The constraints of two cones of this half-angle about the axes of take-off and landing.
    fn about(
        [takeoff, landing]: [Angle; 2],
        cone_half_angle: Angle,
        takeoff_speed_max_m_s: f64,
        landing_speed_max_m_s: f64,
    ) -> Self {
        Self {
            takeoff: ContactRule::new(AngleInterval::about(takeoff, cone_half_angle), takeoff_speed_max_m_s),
            landing: ContactRule::new(AngleInterval::about(landing, cone_half_angle), landing_speed_max_m_s),
        }
    }

    /// The constraints from angles relative to the slope.
    ///
    /// ```text
    ///     take-off: alpha + [t1, t2],   landing: alpha + [l1, l2],   tan alpha = slope
    /// ```
    ///
    /// Source: CHTA paper, section V-B.
    ///
    /// # Arguments
    /// `slope`: the segment's slope along the direction of travel; the intervals `[t1, t2]` and `[l1, l2]`; the two speeds in m/s.
    ///
    /// # Examples
    /// ```
    /// use chta::{chain::LineConstraints, quantity::AngleInterval};
    /// // Take-off 60 to 90 degrees above a slope of 45 degrees: 105 degrees and more, so no take-off towards +x.
    /// let (takeoff, landing) = (AngleInterval::from_degrees(60.0, 90.0), AngleInterval::from_degrees(-90.0, -60.0));
    /// let c = LineConstraints::from_offsets(1.0, takeoff, landing, 10.0, 8.0);
    /// assert!((c.takeoff.angles().min.degrees() - 105.0).abs() < 1e-12 && c.takeoff.slopes().is_empty());
    /// assert!((c.landing.angles().max.degrees() + 15.0).abs() < 1e-12);
    /// ```
    pub fn from_offsets(
        slope: f64,
        takeoff: AngleInterval,
        landing: AngleInterval,
        takeoff_speed_max_m_s: f64,
        landing_speed_max_m_s: f64,
    ) -> Self {
        let alpha = Angle::from_slope(slope).radians();
        let raised = |offsets: AngleInterval| AngleInterval {
            min: Angle::from_radians(alpha + offsets.min.radians()),
            max: Angle::from_radians(alpha + offsets.max.radians()),
        };
        Self {
            takeoff: ContactRule::new(raised(takeoff), takeoff_speed_max_m_s),
            landing: ContactRule::new(raised(landing), landing_speed_max_m_s),
        }
    }

    /// The same angles, with speeds of at most those given.
    #[must_use]
    pub fn capped(self, takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64) -> Self {
        Self { takeoff: self.takeoff.capped(takeoff_speed_max_m_s), landing: self.landing.capped(landing_speed_max_m_s) }
    }

    /// The same angles, with shares of the speeds.
    #[must_use]
    pub fn derated(self, derating: &Derating) -> Self {
        let share = |rule: ContactRule, share: f64| ContactRule { speed_max_m_s: share * rule.speed_max_m_s, ..rule };
        Self { takeoff: share(self.takeoff, derating.takeoff_speed), landing: share(self.landing, derating.landing_speed) }
    }

    /// The rule of one contact.
    pub const fn contact(&self, contact: Contact) -> ContactRule {
        match contact {
            Contact::Takeoff => self.takeoff,
            Contact::Landing => self.landing,
        }
    }
}

/// Why the ground refuses a contact for every hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroundRefusal {
    /// The chain states no limits for this direction, or it ends here.
    NoGround,
    /// The segment lies in a keep-out zone.
    KeepOut,
    /// A layer of the map does not hold there.
    Layer(LayerName),
    /// The surface is too steep to rest on.
    TooSteep {
        /// Inclination of the surface from the horizontal.
        tilt: Angle,
        /// The steepest allowed.
        max: Angle,
    },
    /// The plane of travel misses the friction cone.
    CrossSlope {
        /// Angle between the surface normal and the plane of travel.
        cross_slope: Angle,
        /// Half-angle of the cone.
        friction: FrictionCone,
    },
    /// The surface faces down, where angles relative to a slope mean nothing.
    FacesDown {
        /// Inclination of the surface from the horizontal, 90 degrees or more.
        tilt: Angle,
    },
    /// The facets that meet at the point leave no direction in common.
    FacetsDisagree {
        /// From the greatest lower end to the least upper end of their cones.
        angles: AngleInterval,
    },
    /// The ground under the hopper's footprint is too steep, too rough or not known.
    Footprint(super::FootprintRefusal),
    /// A speed limit of zero.
    SpeedZero,
    /// The cone contains no direction inside (-90, 90) degrees.
    NothingAhead {
        /// The cone.
        angles: AngleInterval,
    },
    /// With brakes: the surface is too steep for its friction to hold a touchdown straight down.
    TouchdownSlope {
        /// Inclination of the surface from the horizontal.
        tilt: Angle,
        /// The cone about the surface normal.
        friction: FrictionCone,
    },
    /// With brakes: the stated landing angles do not contain straight down.
    TouchdownCone {
        /// The landing angles.
        angles: AngleInterval,
    },
    /// With brakes: the touchdown is faster than a landing may be.
    TouchdownSpeed {
        /// The touchdown speed, m/s.
        touchdown_m_s: f64,
        /// The landing speed limit, m/s.
        max_m_s: f64,
    },
}

impl GroundRefusal {
    /// The limit under which this refusal is counted.
    pub const fn limit(&self, contact: Contact) -> Limit {
        match (self, contact) {
            (Self::NoGround, _) => Limit::Direction,
            (Self::KeepOut, _) => Limit::KeepOut,
            (Self::Layer(layer), _) => Limit::Layer(*layer),
            (Self::TooSteep { .. }, _) => Limit::RestSlope,
            (Self::Footprint(refusal), _) => refusal.limit(),
            (
                Self::CrossSlope { .. } | Self::NothingAhead { .. } | Self::FacesDown { .. } | Self::FacetsDisagree { .. },
                Contact::Takeoff,
            ) => Limit::TakeoffCone,
            (
                Self::CrossSlope { .. } | Self::NothingAhead { .. } | Self::FacesDown { .. } | Self::FacetsDisagree { .. },
                Contact::Landing,
            ) => Limit::LandingCone,
            (Self::TouchdownSlope { .. } | Self::TouchdownCone { .. } | Self::TouchdownSpeed { .. }, _) => Limit::Touchdown,
            (Self::SpeedZero, Contact::Takeoff) => Limit::TakeoffSpeed,
            (Self::SpeedZero, Contact::Landing) => Limit::LandingSpeed,
        }
    }

    /// By how many degrees the limit is exceeded, if it is a limit of angles.
    pub fn excess_deg(&self) -> Option<f64> {
        match self {
            Self::TooSteep { tilt, max } => Some(tilt.degrees() - max.degrees()),
            Self::CrossSlope { cross_slope, friction } => Some(cross_slope.degrees() - friction.half_angle().degrees()),
            Self::NothingAhead { angles } => {
                let (min, max) = (angles.min.degrees(), angles.max.degrees());
                Some(if min > max { min - max } else { (min - 90.0).max(-90.0 - max) })
            }
            Self::FacetsDisagree { angles } => Some(angles.min.degrees() - angles.max.degrees()),
            Self::TouchdownSlope { tilt, friction } => Some(tilt.degrees() - friction.half_angle().degrees()),
            Self::TouchdownCone { angles } => Some((angles.min.degrees() + 90.0).max(-90.0 - angles.max.degrees())),
            Self::Footprint(refusal) => refusal.excess_deg(),
            Self::NoGround
            | Self::KeepOut
            | Self::Layer(_)
            | Self::SpeedZero
            | Self::TouchdownSpeed { .. }
            | Self::FacesDown { .. } => None,
        }
    }
}

impl fmt::Display for GroundRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoGround => write!(f, "the chain allows no contact in this direction"),
            Self::KeepOut => write!(f, "it lies in a keep-out zone"),
            Self::Layer(layer) => write!(f, "the layer {layer} does not hold there"),
            Self::TooSteep { tilt, max } => {
                write!(f, "its surface slopes {:.3} deg, more than the rest slope of {:.3} deg", tilt.degrees(), max.degrees())
            }
            Self::CrossSlope { cross_slope, friction } => write!(
                f,
                "its cross-slope of {:.3} deg is over the friction angle of {:.3} deg",
                cross_slope.degrees(),
                friction.half_angle().degrees()
            ),
            Self::FacesDown { tilt } => write!(
                f,
                "its surface faces down, {:.3} deg from the horizontal, where angles from the slope mean nothing: give friction instead",
                tilt.degrees()
            ),
            Self::FacetsDisagree { angles } => write!(
                f,
                "the facets that meet at it have no direction in common: one asks for at least {:.3} deg, another for at most {:.3} deg",
                angles.min.degrees(),
                angles.max.degrees()
            ),
            Self::Footprint(refusal) => refusal.fmt(f),
            Self::SpeedZero => write!(f, "its speed limit is 0"),
            Self::TouchdownSlope { tilt, friction } => write!(
                f,
                "its surface slopes {:.3} deg, over the friction angle of {:.3} deg, so a touchdown straight down slides",
                tilt.degrees(),
                friction.half_angle().degrees()
            ),
            Self::TouchdownCone { angles } => write!(
                f,
                "its landing angles, {:.3} to {:.3} deg, do not contain straight down, the direction of a braked touchdown",
                angles.min.degrees(),
                angles.max.degrees()
            ),
            Self::TouchdownSpeed { touchdown_m_s, max_m_s } => {
                write!(f, "its landing speed limit is {max_m_s} m/s, below the touchdown speed of {touchdown_m_s} m/s")
            }
            Self::NothingAhead { angles } => {
                write!(
                    f,
                    "its cone, {:.3} to {:.3} deg, contains no direction of travel",
                    angles.min.degrees(),
                    angles.max.degrees()
                )
            }
        }
    }
}

/// The rules of one direction; `None` for a contact that the ground refuses for every hop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Allowed {
    takeoff: Option<ContactRule>,
    landing: Option<ContactRule>,
}

/// All constraints of one segment: the line constraints of both directions, the rest slope and keep-out zones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentConstraints {
    stated: [Result<LineConstraints, GroundRefusal>; 2],
    /// With brakes: the rule of a landing instead of the stated one.
    touchdown: Option<[Result<ContactRule, GroundRefusal>; 2]>,
    /// The refusal that applies to every contact.
    refusal: Option<GroundRefusal>,
    allowed: [Allowed; 2],
}

impl SegmentConstraints {
    /// From the constraints of the two directions (or the reason for their absence) and a refusal that applies to both.
    pub fn new(
        forward: Result<LineConstraints, GroundRefusal>,
        reverse: Result<LineConstraints, GroundRefusal>,
        refusal: Option<GroundRefusal>,
    ) -> Self {
        let segment = Self { stated: [forward, reverse], touchdown: None, refusal, allowed: [Allowed::default(); 2] };
        segment.resolved()
    }

    /// The same ground for a hopper that brakes: the rule of a touchdown in both directions.
    #[must_use]
    pub(super) fn with_touchdown(self, touchdown: [Result<ContactRule, GroundRefusal>; 2]) -> Self {
        Self { touchdown: Some(touchdown), ..self }.resolved()
    }

    fn resolved(mut self) -> Self {
        for direction in Direction::BOTH {
            self.allowed[direction as usize] = Allowed {
                takeoff: self.check_contact(Contact::Takeoff, direction).ok(),
                landing: self.check_contact(Contact::Landing, direction).ok(),
            };
        }
        self
    }

    /// The rule of a contact, or the reason why the ground refuses it for every hop.
    ///
    /// # Errors
    /// The first refusal, in the order of [`Limit::ALL`].
    pub fn check_contact(&self, contact: Contact, direction: Direction) -> Result<ContactRule, GroundRefusal> {
        let stated = self.stated[direction as usize];
        if let Err(refusal @ GroundRefusal::NoGround) = stated {
            return Err(refusal);
        }
        if let Some(refusal) = self.refusal {
            return Err(refusal);
        }
        if let (Contact::Landing, Some(touchdown)) = (contact, self.touchdown) {
            return touchdown[direction as usize];
        }
        let rule = stated?.contact(contact);
        if rule.slopes().is_empty() {
            return Err(GroundRefusal::NothingAhead { angles: rule.angles() });
        }
        if rule.speed_max_m_s() <= 0.0 {
            return Err(GroundRefusal::SpeedZero);
        }
        Ok(rule)
    }

    /// The rule of a contact if the ground allows it. This is the version for inner loops.
    #[inline]
    pub const fn allowed(&self, contact: Contact, direction: Direction) -> Option<&ContactRule> {
        let allowed = &self.allowed[direction as usize];
        match contact {
            Contact::Takeoff => allowed.takeoff.as_ref(),
            Contact::Landing => allowed.landing.as_ref(),
        }
    }

    /// The line constraints of a direction as given, whether or not the ground refuses contacts.
    pub fn stated(&self, direction: Direction) -> Option<LineConstraints> {
        self.stated[direction as usize].ok()
    }

    /// The refusal that applies to every contact on this segment.
    pub const fn refusal(&self) -> Option<GroundRefusal> {
        self.refusal
    }
}
