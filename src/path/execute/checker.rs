//! The check of every limit of one flown hop.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Vector2, Vector3};

use super::{
    Flight, Measure, StatedValue, ViolatedLimit, Violation,
    flight::TooLow,
    footprint::{Fitted, Footing, FootprintFit, RAY_TOLERANCE},
};
use crate::{
    chain::{ContactRule, GroundRefusal},
    ground::{ContactPoint, ElementVertex, Facet, Frame, Hold, Side, Surface},
    path::Hop,
    quantity::{Angle, AngleInterval, MapPoint},
    world::{Contact, FrictionCone, Limit, SPEED_TOLERANCE, tolerant_speed_m_s},
};

/// Tolerance of an angle over its limit, rad: it corresponds to the tolerance of speeds. A tangent and an arc tangent between limit
/// and command leave an error of some 1e-15; a nanoradian is a millimetre in 1000 km.
pub(super) const ANGLE_TOLERANCE_RAD: f64 = 1e-9;

/// Relative tolerance of a time over its limit: the same as for speeds.
const TIME_TOLERANCE: f64 = 1e-9;

/// Relative rounding error of a speed from the formulas that gave it, allowed beyond the crate's tolerance.
pub(super) const SPEED_ROUNDING: f64 = 1e-12;

/// Rounding error of a position along the profile, in units in the last place of its x: of each end of a hop when hops are laid end to
/// end along a segment (a product and a sum).
const STATION_ULPS: f64 = 4.0;

/// Tolerance of a command against a multiple of its step, in degrees or m/s: that of directions.
const STEP_TOLERANCE: f64 = 1e-9;

/// Rounding error of a multiple of a step, in units in the last place.
const STEP_ULPS: f64 = 8.0;

/// Tolerance of a map position, as a fraction of the size of its coordinates.
pub(super) const MAP_TOLERANCE: f64 = 1e-12;

/// Relative rounding of the horizontal speed of a hop: near the vertical, the last digit of the angle is a part of its cosine.
pub(super) fn angle_rounding(hop: &Hop) -> f64 {
    2.0 * f64::EPSILON * libm::fabs(libm::tan(hop.takeoff_angle.radians()))
}

/// Checks one hop against its limits and collects the violations.
pub(super) struct Checker<'a, S: Surface> {
    pub(super) number: usize,
    pub(super) surface: &'a S,
    /// The surface's own contacts at take-off and landing.
    pub(super) contacts: [Option<S::Contact>; 2],
    pub(super) hop: &'a Hop,
    /// The horizontal direction of flight; `None` if the ends are not two positions of the ground.
    pub(super) heading: Option<Vector2<f64>>,
    /// Horizontal distance from take-off to landing, m.
    pub(super) run_m: Option<f64>,
    /// The bends of the ground strictly below the flight.
    pub(super) bends: Vec<ElementVertex>,
    /// Fits the ground under a footprint.
    pub(super) fitted: FootprintFit<S>,
    pub(super) violations: &'a mut Vec<Violation>,
}

/// Direction and speed at one end of a hop, with their rounding errors.
#[derive(Clone, Copy)]
struct Meeting {
    contact: Contact,
    angle_rad: f64,
    angle_tolerance_rad: f64,
    speed_m_s: f64,
    speed_rounding_m_s: f64,
}

impl<S: Surface> Checker<'_, S> {
    pub(super) fn note(&mut self, limit: ViolatedLimit, measure: Option<Measure>, at_x_m: f64) {
        self.violations.push(Violation { measure, ..Violation::at(self.number, limit, at_x_m) });
    }

    pub(super) fn note_limit(&mut self, limit: Limit, found: f64, allowed: f64, unit: &'static str, at_x_m: f64) {
        self.note(ViolatedLimit::Limit(limit), Some(Measure { found, allowed, unit }), at_x_m);
    }

    /// A stated number must equal the flown one, within a tolerance.
    fn stated(&mut self, value: StatedValue, stated: f64, flown: f64, tolerance: f64, unit: &'static str) {
        // Written so that NaN fails.
        let agrees = (stated - flown).abs() <= tolerance;
        if !agrees {
            let measure = Measure { found: stated, allowed: flown, unit };
            self.note(ViolatedLimit::StatedValue(value), Some(measure), self.hop.takeoff.along_m);
        }
    }

    /// The violations of a command that does not leave the ground forwards: it has no landing.
    pub(super) fn no_flight(&mut self) {
        let (takeoff, landing) = (self.hop.takeoff.in_profile(), self.hop.landing.in_profile());
        self.takeoff(self.hop);
        self.mechanical_angle();
        self.steps();
        self.speeds();
        let found = libm::hypot(landing.x_m - takeoff.x_m, landing.z_m - takeoff.z_m);
        let measure = Measure { found, allowed: self.surface.height_rounding_m(), unit: "m" };
        self.note(ViolatedLimit::LandingPoint, Some(measure), takeoff.x_m);
    }

    /// All checks of a flight.
    pub(super) fn flight(&mut self, flight: &Flight) {
        self.takeoff(self.hop);
        self.landing(flight);
        self.bends();
        self.layers();
        self.mechanical_angle();
        self.steps();
        self.speeds();
        self.terrain(flight);
        self.landing_point(flight);
        self.machine(flight);
        self.stated_values(flight);
    }

    /// A flight stays in one vertical plane, so every bend strictly below it is a violation.
    fn bends(&mut self) {
        for vertex in &self.bends {
            let limit = ViolatedLimit::Limit(Limit::Bend);
            let at = Violation { vertex: Some(vertex.id), ..Violation::at(self.number, limit, vertex.x_m) };
            self.violations.push(at);
        }
    }

    /// Checks of the take-off: the flown direction and speed are the commanded ones.
    fn takeoff(&mut self, hop: &Hop) {
        let meeting = Meeting {
            contact: Contact::Takeoff,
            angle_rad: hop.takeoff_angle.radians(),
            angle_tolerance_rad: ANGLE_TOLERANCE_RAD,
            speed_m_s: hop.takeoff_speed_m_s,
            speed_rounding_m_s: 0.0,
        };
        self.contact(&hop.takeoff, StatedValue::TakeoffStation, Contact::Takeoff);
        self.ground(&hop.takeoff, meeting);
    }

    /// Uncertainty of the landing's direction: an error `e` of the position turns the direction of flight by `e` times the
    /// curvature there, `g v_x / v^3`.
    fn landing_angle_tolerance_rad(&self, flight: &Flight) -> f64 {
        let v = flight.landing_speed_m_s;
        ANGLE_TOLERANCE_RAD + flight.rounding_m * (self.surface.gravity_m_s2() / v) * (flight.across_m_s / v) / v
    }

    /// Uncertainty of the landing's speed: it changes by `g v_z / v^2` per metre flown.
    fn landing_speed_rounding_m_s(&self, flight: &Flight) -> f64 {
        let v = flight.landing_speed_m_s;
        let of_place = flight.rounding_m * (self.surface.gravity_m_s2() / v) * (flight.landing_climb_m_s.abs() / v);
        // The horizontal speed, and with it the time of the landing, is as exact as the cosine of the angle.
        of_place + self.surface.gravity_m_s2() * flight.flight_time_s * angle_rounding(self.hop)
    }

    /// Checks of the landing.
    fn landing(&mut self, flight: &Flight) {
        let meeting = Meeting {
            contact: Contact::Landing,
            angle_rad: flight.landing_angle.radians(),
            angle_tolerance_rad: self.landing_angle_tolerance_rad(flight),
            speed_m_s: flight.landing_speed_m_s,
            speed_rounding_m_s: self.landing_speed_rounding_m_s(flight),
        };
        self.contact(&self.hop.landing, StatedValue::LandingStation, Contact::Landing);
        self.ground(&self.hop.landing, meeting);
    }

    /// The surface's own contact at one end of the hop.
    fn own(&self, contact: Contact) -> Option<S::Contact> {
        self.contacts[usize::from(contact == Contact::Landing)]
    }

    /// A stated contact must be the surface's own contact at the same horizontal position.
    fn contact(&mut self, stated: &ContactPoint, value: StatedValue, contact: Contact) {
        let own = self.own(contact).map(|own| self.surface.contact_point(&own));
        match own {
            Some(own) if own.station.map(|s| s.site) == stated.station.map(|s| s.site) => {
                let miss_m = (stated.point_m.z - own.point_m.z).abs();
                if miss_m > self.surface.height_rounding_m() + self.surface.position_rounding_m() {
                    let measure = Measure { found: stated.point_m.z, allowed: own.point_m.z, unit: "m" };
                    self.note(ViolatedLimit::StatedValue(value), Some(measure), stated.along_m);
                }
            }
            Some(_) | None => self.note(ViolatedLimit::StatedValue(value), None, stated.along_m),
        }
    }

    /// The facets that a contact obeys: those ahead of a take-off, those just flown over before a landing.
    fn ruling(&self, contact: Contact) -> impl Iterator<Item = Facet> + use<S> {
        let side = match contact {
            Contact::Takeoff => Side::Ahead,
            Contact::Landing => Side::Behind,
        };
        let facets = match (self.own(contact), self.heading) {
            (Some(own), Some(heading)) => self.surface.facets(&own, heading, side),
            _ => Vec::new(),
        };
        facets.into_iter()
    }

    /// The ground's refusals, cone and speed limit; on an edge or a corner, those of all facets that meet there.
    fn ground(&mut self, stated: &ContactPoint, meeting: Meeting) {
        let x_m = stated.along_m;
        let mut known = false;
        let footing = self.footing(meeting.contact);
        let first = self.violations.len();
        for facet in self.ruling(meeting.contact) {
            let before = self.violations.len();
            self.footprint(footing, facet.rest_slope, x_m);
            self.facet(&facet, meeting, x_m);
            known = true;
            // What violates one facet is not reported again for its neighbour.
            let repeated = |at: usize| (first..before).any(|known| self.violations[known].limit == self.violations[at].limit);
            let kept: Vec<Violation> =
                (before..self.violations.len()).filter(|at| !repeated(*at)).map(|at| self.violations[at]).collect();
            self.violations.truncate(before);
            self.violations.extend(kept);
        }
        if !known {
            self.note(ViolatedLimit::Limit(Limit::Direction), None, x_m);
        }
    }

    /// What is found under the footprint of a contact.
    fn footing(&self, contact: Contact) -> Footing {
        let footprint_m = self.surface.hopper().limits().footprint_m.filter(|footprint_m| *footprint_m > 0.0);
        let (Some(footprint_m), Some(own)) = (footprint_m, self.own(contact)) else { return Footing::NotAsked };
        (self.fitted)(self.surface, &own, footprint_m).map_or(Footing::Unknown, Footing::Fitted)
    }

    /// The plane fitted over the footprint, against the rest slope of the facet under the contact and the roughness.
    fn footprint(&mut self, footing: Footing, rest_slope: Option<f64>, x_m: f64) {
        let limits = *self.surface.hopper().limits();
        let footprint_m = limits.footprint_m.unwrap_or(f64::INFINITY);
        let Fitted { tilt_rad, residual_m } = match footing {
            Footing::NotAsked => return,
            Footing::Unknown => return self.note(ViolatedLimit::Limit(Limit::FootprintSlope), None, x_m),
            Footing::Fitted(fit) => fit,
        };
        let max_rad = rest_slope.map_or(FRAC_PI_2, libm::atan);
        let height_rounding_m = self.surface.height_rounding_m();
        let tolerance_rad = 2.0 * ANGLE_TOLERANCE_RAD
            + self.surface.slope_rounding()
            + 2.0 * (RAY_TOLERANCE * residual_m + 4.0 * height_rounding_m) / footprint_m;
        if tilt_rad > max_rad + tolerance_rad {
            self.note_limit(Limit::FootprintSlope, tilt_rad.to_degrees(), max_rad.to_degrees(), "deg", x_m);
        }
        if let Some(max_m) = limits.roughness_max_m {
            let tolerance_m = RAY_TOLERANCE * residual_m + 2.0 * ANGLE_TOLERANCE_RAD * footprint_m + 4.0 * height_rounding_m;
            if residual_m > max_m + tolerance_m {
                self.note_limit(Limit::Roughness, residual_m, max_m, "m", x_m);
            }
        }
    }

    /// Checks of one facet under a contact.
    fn facet(&mut self, facet: &Facet, meeting: Meeting, x_m: f64) {
        let before = self.violations.len();
        if let Some(refusal) = facet.refusal.filter(|refusal| !self.is_rounding(*refusal)) {
            self.note(ViolatedLimit::Limit(refusal.limit(meeting.contact)), refusal_measure(refusal), x_m);
        }
        let brakes = self.surface.hopper().limits().landing.touchdown_speed_m_s().filter(|_| meeting.contact == Contact::Landing);
        match (facet.hold, brakes) {
            (hold, Some(touchdown_m_s)) => self.touchdown(&hold, touchdown_m_s, x_m),
            (Hold::Friction { normal, cone }, None) => {
                self.friction(normal, cone, meeting, x_m);
                let limits = self.surface.hopper().limits();
                self.speed(
                    meeting,
                    speed_max_m_s(limits.takeoff_speed_max_m_s, limits.landing_speed_max_m_s, meeting.contact),
                    x_m,
                );
            }
            (Hold::Stated { line, .. }, None) => {
                if let Some(line) = line {
                    let rule = line.contact(meeting.contact);
                    self.cone(rule.angles(), meeting, x_m);
                    self.speed(meeting, rule.speed_max_m_s(), x_m);
                }
            }
        }
        if self.violations.len() == before
            && let Some(Err(refusal)) = facet.hold.stated(meeting.contact)
            && !self.is_rounding(refusal)
        {
            self.note(ViolatedLimit::Limit(refusal.limit(meeting.contact)), refusal_measure(refusal), x_m);
        }
    }

    /// Whether a refusal is within rounding: a facet exactly at the rest slope or the friction angle.
    fn is_rounding(&self, refusal: GroundRefusal) -> bool {
        let tolerance_rad = ANGLE_TOLERANCE_RAD + self.surface.slope_rounding();
        match refusal {
            GroundRefusal::TooSteep { tilt, max } => tilt.radians() - max.radians() <= tolerance_rad,
            GroundRefusal::TouchdownSlope { tilt, friction } => tilt.radians() - friction.half_angle().radians() <= tolerance_rad,
            _ => false,
        }
    }

    /// Rounding error of the hop's length, as a share of it: far from x = 0, the last digit of the two ends is a part of a short hop. At
    /// a given angle the height of a flight is proportional to its length, and speed and time to its square root, so that this share
    /// is also that of those.
    fn run_rounding(&self) -> f64 {
        let farthest_m = self.hop.takeoff.along_m.abs().max(self.hop.landing.along_m.abs());
        self.run_m.filter(|run_m| *run_m > 0.0).map_or(0.0, |run_m| STATION_ULPS * f64::EPSILON * farthest_m / run_m)
    }

    /// The speed limit of a contact.
    fn speed(&mut self, meeting: Meeting, speed_max_m_s: f64, x_m: f64) {
        let allowed_m_s =
            tolerant_speed_m_s(speed_max_m_s) * (1.0 + SPEED_ROUNDING + self.run_rounding()) + meeting.speed_rounding_m_s;
        let within = meeting.speed_m_s <= allowed_m_s && speed_max_m_s > 0.0;
        if !within {
            let limit = if meeting.contact == Contact::Takeoff { Limit::TakeoffSpeed } else { Limit::LandingSpeed };
            self.note_limit(limit, meeting.speed_m_s, speed_max_m_s, "m/s", x_m);
        }
    }

    /// The friction cone itself: the force along the direction of flight must lie within `atan mu` of the facet's normal.
    fn friction(&mut self, normal: Vector3<f64>, cone: FrictionCone, meeting: Meeting, x_m: f64) {
        let Some(heading) = self.heading else { return };
        let across = heading * libm::cos(meeting.angle_rad);
        let flight = Vector3::new(across.x, across.y, libm::sin(meeting.angle_rad));
        // The ground pushes along the flight at a take-off and against it at a landing.
        let push = if meeting.contact == Contact::Takeoff { flight } else { -flight };
        let off_rad = libm::atan2(normal.cross(&push).norm(), normal.dot(&push));
        let tolerance_rad = meeting.angle_tolerance_rad + self.surface.slope_rounding();
        let held = off_rad <= cone.half_angle().radians() + tolerance_rad;
        if !held {
            let limit = if meeting.contact == Contact::Takeoff { Limit::TakeoffCone } else { Limit::LandingCone };
            self.note_limit(limit, off_rad.to_degrees(), cone.half_angle().degrees(), "deg", x_m);
        }
    }

    /// The cone of the ground, and that the hop goes forwards.
    fn cone(&mut self, angles: AngleInterval, meeting: Meeting, x_m: f64) {
        let limit = if meeting.contact == Contact::Takeoff { Limit::TakeoffCone } else { Limit::LandingCone };
        let (min, max) = (angles.min.radians().max(-FRAC_PI_2), angles.max.radians().min(FRAC_PI_2));
        let tolerance_rad = meeting.angle_tolerance_rad + self.surface.slope_rounding();
        self.angle_between(limit, meeting.angle_rad, (min, max), tolerance_rad, x_m);
    }

    /// An angle must lie between two others, both included.
    fn angle_between(&mut self, limit: Limit, angle_rad: f64, (min, max): (f64, f64), tolerance_rad: f64, x_m: f64) {
        let reached = angle_rad >= min - tolerance_rad;
        let kept = angle_rad <= max + tolerance_rad;
        if !reached {
            self.note_limit(limit, angle_rad.to_degrees(), min.to_degrees(), "deg", x_m);
        }
        if !kept {
            self.note_limit(limit, angle_rad.to_degrees(), max.to_degrees(), "deg", x_m);
        }
    }

    /// The take-off angles of the mechanism.
    fn mechanical_angle(&mut self) {
        let limits = self.surface.hopper().limits();
        let (min, max) = (limits.takeoff_angle_min, limits.takeoff_angle_max);
        if min.is_some() || max.is_some() {
            let ends = (min.map_or(-FRAC_PI_2, Angle::radians), max.map_or(FRAC_PI_2, Angle::radians));
            let (angle_rad, x_m) = (self.hop.takeoff_angle.radians(), self.hop.takeoff.along_m);
            self.angle_between(Limit::MechanicalAngle, angle_rad, ends, ANGLE_TOLERANCE_RAD, x_m);
        }
    }

    /// The command is a whole number of the machine's steps.
    fn steps(&mut self) {
        let steps = self.surface.hopper().limits().steps;
        let hop = self.hop;
        let heading_deg = hop.takeoff.map().map(|_| hop.heading_deg);
        for (limit, found, step, unit) in [
            (Limit::TakeoffAngleStep, Some(hop.takeoff_angle.degrees()), steps.takeoff_angle.map(Angle::degrees), "deg"),
            (Limit::TakeoffSpeedStep, Some(hop.takeoff_speed_m_s), steps.takeoff_speed_m_s, "m/s"),
            (Limit::HeadingStep, heading_deg, steps.heading.map(Angle::degrees), "deg"),
        ] {
            let Some((found, step)) = found.zip(step) else { continue };
            let whole = (found / step).round();
            // Written so that NaN fails.
            let on_step = (found - whole * step).abs() <= STEP_TOLERANCE * step.min(1.0) + STEP_ULPS * f64::EPSILON * found.abs();
            if !on_step {
                self.note_limit(limit, found, whole * step, unit, hop.takeoff.along_m);
            }
        }
    }

    /// The take-off speeds of the machine: at least its least one, and one of its levels.
    fn speeds(&mut self) {
        let limits = self.surface.hopper().limits();
        let (speed_m_s, x_m) = (self.hop.takeoff_speed_m_s, self.hop.takeoff.along_m);
        let tolerance = SPEED_TOLERANCE + SPEED_ROUNDING + self.run_rounding();
        if let Some(least_m_s) = limits.takeoff_speed_min_m_s {
            let within = speed_m_s >= least_m_s * (1.0 - tolerance);
            if !within {
                self.note_limit(Limit::TakeoffSpeedMin, speed_m_s, least_m_s, "m/s", x_m);
            }
        }
        if let Some(levels) = limits.takeoff_speed_levels {
            let off_m_s = |level_m_s: &f64| (speed_m_s - level_m_s).abs();
            let nearest = levels.as_slice().iter().min_by(|a, b| off_m_s(a).total_cmp(&off_m_s(b)));
            let nearest_m_s = nearest.copied().unwrap_or_default();
            let within = off_m_s(&nearest_m_s) <= nearest_m_s * tolerance;
            if !within {
                self.note_limit(Limit::TakeoffSpeedLevels, speed_m_s, nearest_m_s, "m/s", x_m);
            }
        }
    }

    /// Clearance over the vertices and over the ground between them.
    fn terrain(&mut self, flight: &Flight) {
        let limit = ViolatedLimit::Limit(Limit::Terrain);
        if let (Some(known_m), Some(run_m)) = (flight.unknown_from_m, self.run_m) {
            let measure = Measure { found: known_m, allowed: run_m, unit: "m" };
            self.note(ViolatedLimit::UnknownGround, Some(measure), self.hop.takeoff.along_m + known_m);
        }
        for TooLow { over, required_m } in &flight.too_low {
            let measure = Some(Measure { found: over.height_m, allowed: *required_m, unit: "m" });
            let at = Violation::at(self.number, limit, over.x_m);
            self.violations.push(Violation { measure, vertex: over.vertex, facet: over.facet, ..at });
        }
        if flight.too_low.is_empty()
            && let Some((x_m, depth_m)) = flight.underground
        {
            self.note(limit, Some(Measure { found: depth_m, allowed: 0.0, unit: "m" }), x_m);
        }
    }

    /// The actual landing point must be the planned one.
    fn landing_point(&mut self, flight: &Flight) {
        if flight.hits {
            return;
        }
        let planned = self.hop.landing.in_profile();
        let (found, at_x_m) = if let Some(contact) = flight.contact {
            (libm::hypot(contact.x_m - planned.x_m, contact.z_m - planned.z_m), contact.x_m)
        } else {
            // It leaves the known ground, so it misses by at least the distance to its end.
            let end_x_m = flight.left_at_x_m.unwrap_or(planned.x_m);
            ((end_x_m - planned.x_m).abs(), end_x_m)
        };
        let measure = Measure { found, allowed: flight.place_tolerance_m, unit: "m" };
        self.note(ViolatedLimit::LandingPoint, Some(measure), at_x_m);
    }

    /// The greatest height and the longest flight.
    fn machine(&mut self, flight: &Flight) {
        let x_m = self.hop.takeoff.along_m;
        if let Some(height_m) = self.surface.hopper().limits().apex_height_max_m {
            let within = flight.apex_height_m <= height_m * (1.0 + self.run_rounding()) + flight.place_tolerance_m;
            if !within {
                self.note_limit(Limit::ApexHeight, flight.apex_height_m, height_m, "m", x_m);
            }
        }
        if let Some(time_s) = self.surface.hopper().limits().flight_time_max_s {
            let within = flight.flight_time_s
                <= time_s * (1.0 + TIME_TOLERANCE + self.run_rounding() + angle_rounding(self.hop)) + time_rounding_s(flight);
            if !within {
                self.note_limit(Limit::FlightTime, flight.flight_time_s, time_s, "s", x_m);
            }
        }
    }

    /// The stated numbers must equal those flown.
    fn stated_values(&mut self, flight: &Flight) {
        let hop = self.hop;
        let angle_tolerance_deg = self.landing_angle_tolerance_rad(flight).to_degrees();
        self.stated(
            StatedValue::LandingAngle,
            hop.landing_angle.degrees(),
            flight.landing_angle.degrees(),
            angle_tolerance_deg,
            "deg",
        );
        let speed_tolerance_m_s = flight.landing_speed_m_s * TIME_TOLERANCE + self.landing_speed_rounding_m_s(flight);
        self.stated(StatedValue::LandingSpeed, hop.landing_speed_m_s, flight.landing_speed_m_s, speed_tolerance_m_s, "m/s");
        let time_tolerance_s = flight.flight_time_s * (TIME_TOLERANCE + angle_rounding(self.hop)) + time_rounding_s(flight);
        self.stated(StatedValue::FlightTime, hop.flight_time_s, flight.flight_time_s, time_tolerance_s, "s");
        self.stated(StatedValue::Apex, hop.apex_z_m, flight.apex_z_m, flight.place_tolerance_m, "m");
        if let Some(margin_m_s) = self.margin_m_s(flight) {
            let tolerance_m_s = speed_tolerance_m_s + hop.takeoff_speed_m_s * TIME_TOLERANCE;
            self.stated(StatedValue::SpeedMargin, hop.speed_margin_m_s, margin_m_s, tolerance_m_s, "m/s");
        }
        self.map_ends();
    }

    /// The smaller margin of the two speeds to their limits; `None` if the ground refuses a contact.
    fn margin_m_s(&self, flight: &Flight) -> Option<f64> {
        let takeoff = self.speed_limit_m_s(Contact::Takeoff)? - self.hop.takeoff_speed_m_s;
        let landing = self.speed_limit_m_s(Contact::Landing)? - flight.landing_speed_m_s;
        Some(takeoff.min(landing))
    }

    /// The greatest speed that the ground allows a contact; `None` if it refuses the contact.
    fn speed_limit_m_s(&self, contact: Contact) -> Option<f64> {
        let limits = self.surface.hopper().limits();
        let of = |facet: Facet| match facet.hold.stated(contact) {
            Some(rule) => rule.ok().map(|rule: ContactRule| rule.speed_max_m_s()),
            None => Some(speed_max_m_s(limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s(), contact)),
        };
        self.ruling(contact).map(of).reduce(|a, b| Some(a?.min(b?)))?
    }

    /// The two ends on the map, if the ground lies on one, and the distance between them.
    fn map_ends(&mut self) {
        let own = self.contacts.map(|own| own.map(|own| self.surface.contact_point(&own)));
        let [Some(takeoff), Some(landing)] = own else { return };
        let stated = [self.hop.takeoff, self.hop.landing];
        let x_m = self.hop.takeoff.along_m;
        if stated.iter().zip([takeoff, landing]).any(|(stated, own)| stated.frame != own.frame) {
            self.note(ViolatedLimit::StatedValue(StatedValue::MapEnds), None, x_m);
            return;
        }
        if takeoff.frame == Frame::Map {
            let [takeoff, landing] = [takeoff, landing].map(|own| own.point_m.xy());
            let scale_m = [takeoff, landing].iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(1.0, f64::max);
            let miss_m = (stated[0].point_m.xy() - takeoff).norm().max((stated[1].point_m.xy() - landing).norm());
            let agrees = miss_m <= MAP_TOLERANCE * scale_m;
            if !agrees {
                let measure = Measure { found: miss_m, allowed: MAP_TOLERANCE * scale_m, unit: "m" };
                self.note(ViolatedLimit::StatedValue(StatedValue::MapEnds), Some(measure), x_m);
            }
            self.heading(self.hop.heading_deg, takeoff, landing, MAP_TOLERANCE * scale_m);
        }
        if let Some(run_m) = self.run_m {
            let tolerance_m = MAP_TOLERANCE * (stated[1].along_m.abs() + run_m) + self.surface.position_rounding_m();
            self.stated(StatedValue::Distance, self.hop.run_m(), run_m, tolerance_m, "m");
        }
    }

    /// The heading: a step along it from take-off must lead to the landing.
    fn heading(&mut self, heading_deg: f64, takeoff: MapPoint, landing: MapPoint, tolerance_m: f64) {
        let along = landing - takeoff;
        let length_m = along.norm();
        let (east, north) = (libm::sin(heading_deg.to_radians()) * length_m, libm::cos(heading_deg.to_radians()) * length_m);
        let miss_m = libm::hypot(east - along.x, north - along.y);
        let agrees = miss_m <= tolerance_m + ANGLE_TOLERANCE_RAD * length_m && (0.0..=360.0).contains(&heading_deg);
        if !agrees {
            let flown_deg = libm::atan2(along.x, along.y).to_degrees().rem_euclid(360.0);
            let measure = Measure { found: heading_deg, allowed: flown_deg, unit: "deg" };
            self.note(ViolatedLimit::StatedValue(StatedValue::Heading), Some(measure), self.hop.takeoff.along_m);
        }
    }
}

/// The speed limit of a contact, m/s.
const fn speed_max_m_s(takeoff_m_s: f64, landing_m_s: f64, contact: Contact) -> f64 {
    match contact {
        Contact::Takeoff => takeoff_m_s,
        Contact::Landing => landing_m_s,
    }
}

/// Uncertainty of the landing time: that of the position over the speed.
fn time_rounding_s(flight: &Flight) -> f64 {
    flight.rounding_m / flight.landing_speed_m_s
}

/// The numbers of a refusal, if it has some.
fn refusal_measure(refusal: GroundRefusal) -> Option<Measure> {
    let degrees = |found: f64, allowed: f64| Some(Measure { found, allowed, unit: "deg" });
    match refusal {
        GroundRefusal::TooSteep { tilt, max } => degrees(tilt.degrees(), max.degrees()),
        GroundRefusal::CrossSlope { cross_slope, friction } => degrees(cross_slope.degrees(), friction.half_angle().degrees()),
        GroundRefusal::TouchdownSlope { tilt, friction } => degrees(tilt.degrees(), friction.half_angle().degrees()),
        GroundRefusal::TouchdownSpeed { touchdown_m_s, max_m_s } => {
            Some(Measure { found: touchdown_m_s, allowed: max_m_s, unit: "m/s" })
        }
        GroundRefusal::TouchdownCone { .. }
        | GroundRefusal::NoGround
        | GroundRefusal::KeepOut
        | GroundRefusal::Layer(_)
        | GroundRefusal::SpeedZero
        | GroundRefusal::NothingAhead { .. }
        | GroundRefusal::FacesDown { .. }
        | GroundRefusal::FacetsDisagree { .. }
        // The checker fits the ground under a footprint itself.
        | GroundRefusal::Footprint(_) => None,
    }
}
