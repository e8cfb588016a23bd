//! Every limit of one hop, held against what was flown.

use std::f64::consts::FRAC_PI_2;

use super::{Flight, Measure, StatedValue, ViolatedLimit, Violation};
use crate::{
    chain::{ConstrainedChain, GroundRefusal, Station},
    path::Hop,
    quantity::{Angle, AngleInterval, MapPoint},
    world::{Contact, Direction, Limit, tolerant_speed_m_s},
};

/// How far an angle may lie over its limit, rad: what the speeds' tolerance is in directions. A tangent and its arc tangent on the
/// way from a limit to a command leave some 1e-15; a nanoradian is a millimetre in 1000 km.
const ANGLE_TOLERANCE_RAD: f64 = 1e-9;

/// How far a time may lie over its limit, as a share: as the speeds' own tolerance.
const TIME_TOLERANCE: f64 = 1e-9;

/// How far a speed may lie over its limit beyond the program's tolerance, as a share: the rounding of the formulas that gave it.
const SPEED_ROUNDING: f64 = 1e-12;

/// How far a point on the map may lie from its place, as a share of the coordinates' size.
const MAP_TOLERANCE: f64 = 1e-12;

/// Holds one hop against its limits and notes what it offends.
pub(super) struct Checker<'a> {
    pub(super) number: usize,
    pub(super) chain: &'a ConstrainedChain,
    pub(super) hop: &'a Hop,
    pub(super) direction: Direction,
    pub(super) height_rounding_m: f64,
    pub(super) violations: &'a mut Vec<Violation>,
}

/// Direction and speed at one end of a hop, and how uncertain rounding leaves them.
#[derive(Clone, Copy)]
struct Meeting {
    contact: Contact,
    angle_rad: f64,
    angle_tolerance_rad: f64,
    speed_m_s: f64,
    speed_rounding_m_s: f64,
}

impl Checker<'_> {
    fn note(&mut self, limit: ViolatedLimit, measure: Option<Measure>, at_x_m: f64) {
        self.violations.push(Violation { hop: self.number, limit, measure, at_x_m, vertex: None });
    }

    fn note_limit(&mut self, limit: Limit, found: f64, allowed: f64, unit: &'static str, at_x_m: f64) {
        self.note(ViolatedLimit::Limit(limit), Some(Measure { found, allowed, unit }), at_x_m);
    }

    /// A number of the plan that must be the flown one, up to a tolerance.
    fn stated(&mut self, value: StatedValue, stated: f64, flown: f64, tolerance: f64, unit: &'static str) {
        // Written so that a number which is none fails.
        let agrees = (stated - flown).abs() <= tolerance;
        if !agrees {
            let measure = Measure { found: stated, allowed: flown, unit };
            self.note(ViolatedLimit::StatedValue(value), Some(measure), self.hop.takeoff.point.x_m);
        }
    }

    /// What is wrong with a command that does not leave forwards at all: it lands nowhere.
    pub(super) fn no_flight(&mut self) {
        let (takeoff, landing) = (self.hop.takeoff.point, self.hop.landing.point);
        self.takeoff(self.hop);
        self.mechanical_angle();
        let found = libm::hypot(landing.x_m - takeoff.x_m, landing.z_m - takeoff.z_m);
        let measure = Measure { found, allowed: self.height_rounding_m, unit: "m" };
        self.note(ViolatedLimit::LandingPoint, Some(measure), takeoff.x_m);
    }

    /// Everything there is to hold against a flight.
    pub(super) fn flight(&mut self, flight: &Flight) {
        self.takeoff(self.hop);
        self.landing(flight);
        self.bends();
        self.mechanical_angle();
        self.terrain(flight);
        self.landing_point(flight);
        self.machine(flight);
        self.stated_values(flight);
    }

    /// A flight stays in one vertical plane: every bend strictly under it is one too many.
    fn bends(&mut self) {
        let ends_m = (self.hop.takeoff.point.x_m, self.hop.landing.point.x_m);
        let geometry = self.chain.geometry();
        for bend in geometry.bends() {
            let x_m = geometry.vertices()[bend.index()].x_m;
            if (x_m > ends_m.0 && x_m < ends_m.1) || (x_m < ends_m.0 && x_m > ends_m.1) {
                let limit = ViolatedLimit::Limit(Limit::Bend);
                self.violations.push(Violation { hop: self.number, limit, measure: None, at_x_m: x_m, vertex: Some(*bend) });
            }
        }
    }

    /// What holds at the take-off: commanded direction and speed are what is flown.
    fn takeoff(&mut self, hop: &Hop) {
        let meeting = Meeting {
            contact: Contact::Takeoff,
            angle_rad: hop.takeoff_angle.radians(),
            angle_tolerance_rad: ANGLE_TOLERANCE_RAD,
            speed_m_s: hop.takeoff_speed_m_s,
            speed_rounding_m_s: 0.0,
        };
        self.station(&hop.takeoff, StatedValue::TakeoffStation);
        self.ground(&hop.takeoff, meeting);
    }

    /// How uncertain the landing's direction is: a place uncertain by `e` turns the direction of flight by `e` times the curvature
    /// there, `g v_x / v^3`.
    fn landing_angle_tolerance_rad(&self, flight: &Flight) -> f64 {
        let v = flight.landing_speed_m_s;
        ANGLE_TOLERANCE_RAD + flight.rounding_m * (self.chain.gravity().m_s2() / v) * (flight.across_m_s / v) / v
    }

    /// How uncertain the landing's speed is: it changes by `g v_z / v^2` per metre flown.
    fn landing_speed_rounding_m_s(&self, flight: &Flight) -> f64 {
        let v = flight.landing_speed_m_s;
        flight.rounding_m * (self.chain.gravity().m_s2() / v) * (flight.landing_climb_m_s.abs() / v)
    }

    /// What holds at the landing.
    fn landing(&mut self, flight: &Flight) {
        let meeting = Meeting {
            contact: Contact::Landing,
            angle_rad: flight.landing_angle.radians(),
            angle_tolerance_rad: self.landing_angle_tolerance_rad(flight),
            speed_m_s: flight.landing_speed_m_s,
            speed_rounding_m_s: self.landing_speed_rounding_m_s(flight),
        };
        self.station(&self.hop.landing, StatedValue::LandingStation);
        self.ground(&self.hop.landing, meeting);
    }

    /// A station must be the chain's own at its x.
    fn station(&mut self, station: &Station, value: StatedValue) {
        match self.chain.geometry().station(station.point.x_m) {
            Ok(own) if own.site == station.site => {
                let miss_m = (station.point.z_m - own.point.z_m).abs();
                if miss_m > self.height_rounding_m {
                    let measure = Measure { found: station.point.z_m, allowed: own.point.z_m, unit: "m" };
                    self.note(ViolatedLimit::StatedValue(value), Some(measure), station.point.x_m);
                }
            }
            Ok(_) | Err(_) => self.note(ViolatedLimit::StatedValue(value), None, station.point.x_m),
        }
    }

    /// The ground's own refusals, its cone and its speed limit.
    fn ground(&mut self, station: &Station, meeting: Meeting) {
        let x_m = station.point.x_m;
        // The chain's own station at this x rules, not what the plan says of its site.
        let own = self.chain.geometry().station(x_m).unwrap_or(*station);
        let Some(segment) = self.chain.ruling(&own, meeting.contact, self.direction) else {
            self.note(ViolatedLimit::Limit(Limit::Direction), None, x_m);
            return;
        };
        let before = self.violations.len();
        if let Some(refusal) = segment.refusal() {
            self.note(ViolatedLimit::Limit(refusal.limit(meeting.contact)), refusal_measure(refusal), x_m);
        }
        if let Some(stated) = segment.stated(self.direction) {
            let rule = stated.contact(meeting.contact);
            self.cone(rule.angles(), meeting, x_m);
            let allowed_m_s = tolerant_speed_m_s(rule.speed_max_m_s()) * (1.0 + SPEED_ROUNDING) + meeting.speed_rounding_m_s;
            let within = meeting.speed_m_s <= allowed_m_s && rule.speed_max_m_s() > 0.0;
            if !within {
                let limit = if meeting.contact == Contact::Takeoff { Limit::TakeoffSpeed } else { Limit::LandingSpeed };
                self.note_limit(limit, meeting.speed_m_s, rule.speed_max_m_s(), "m/s", x_m);
            }
        }
        if self.violations.len() == before
            && let Err(refusal) = segment.check_contact(meeting.contact, self.direction)
        {
            self.note(ViolatedLimit::Limit(refusal.limit(meeting.contact)), refusal_measure(refusal), x_m);
        }
    }

    /// The cone of the ground, and that the hop goes forward at all.
    fn cone(&mut self, angles: AngleInterval, meeting: Meeting, x_m: f64) {
        let limit = if meeting.contact == Contact::Takeoff { Limit::TakeoffCone } else { Limit::LandingCone };
        let (min, max) = (angles.min.radians().max(-FRAC_PI_2), angles.max.radians().min(FRAC_PI_2));
        self.angle_between(limit, meeting.angle_rad, (min, max), meeting.angle_tolerance_rad, x_m);
    }

    /// An angle between two, both ends allowed.
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

    /// The machine's own take-off angles.
    fn mechanical_angle(&mut self) {
        let (min, max) = (self.chain.hopper().limits().takeoff_angle_min, self.chain.hopper().limits().takeoff_angle_max);
        if min.is_some() || max.is_some() {
            let ends = (min.map_or(-FRAC_PI_2, Angle::radians), max.map_or(FRAC_PI_2, Angle::radians));
            let (angle_rad, x_m) = (self.hop.takeoff_angle.radians(), self.hop.takeoff.point.x_m);
            self.angle_between(Limit::MechanicalAngle, angle_rad, ends, ANGLE_TOLERANCE_RAD, x_m);
        }
    }

    /// Clearance over the vertices, and the ground between them.
    fn terrain(&mut self, flight: &Flight) {
        let limit = ViolatedLimit::Limit(Limit::Terrain);
        for low in &flight.too_low {
            let measure = Some(Measure { found: low.height_m, allowed: self.chain.hopper().limits().clearance_m, unit: "m" });
            self.violations.push(Violation { hop: self.number, limit, measure, at_x_m: low.x_m, vertex: Some(low.vertex) });
        }
        if flight.too_low.is_empty()
            && let Some((x_m, depth_m)) = flight.underground
        {
            self.note(limit, Some(Measure { found: depth_m, allowed: 0.0, unit: "m" }), x_m);
        }
    }

    /// Where it really comes down, against where it should.
    fn landing_point(&mut self, flight: &Flight) {
        if flight.hits {
            return;
        }
        let planned = self.hop.landing.point;
        let (first_x_m, last_x_m) = self.chain.geometry().extent_m();
        let (found, at_x_m) = if let Some(contact) = flight.contact {
            (libm::hypot(contact.x_m - planned.x_m, contact.z_m - planned.z_m), contact.x_m)
        } else {
            // It flies off the chain: by at least as much.
            let end_x_m = if self.direction == Direction::Forward { last_x_m } else { first_x_m };
            ((end_x_m - planned.x_m).abs(), end_x_m)
        };
        let measure = Measure { found, allowed: flight.place_tolerance_m, unit: "m" };
        self.note(ViolatedLimit::LandingPoint, Some(measure), at_x_m);
    }

    /// Greatest height and longest flight.
    fn machine(&mut self, flight: &Flight) {
        let x_m = self.hop.takeoff.point.x_m;
        if let Some(height_m) = self.chain.hopper().limits().apex_height_max_m {
            let within = flight.apex_height_m <= height_m + flight.place_tolerance_m;
            if !within {
                self.note_limit(Limit::ApexHeight, flight.apex_height_m, height_m, "m", x_m);
            }
        }
        if let Some(time_s) = self.chain.hopper().limits().flight_time_max_s {
            let within = flight.flight_time_s <= time_s * (1.0 + TIME_TOLERANCE) + time_rounding_s(flight);
            if !within {
                self.note_limit(Limit::FlightTime, flight.flight_time_s, time_s, "s", x_m);
            }
        }
    }

    /// The numbers of the plan, against those flown.
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
        let time_tolerance_s = flight.flight_time_s * TIME_TOLERANCE + time_rounding_s(flight);
        self.stated(StatedValue::FlightTime, hop.flight_time_s, flight.flight_time_s, time_tolerance_s, "s");
        self.stated(StatedValue::Apex, hop.apex_z_m, flight.apex_z_m, flight.place_tolerance_m, "m");
        if let Some(margin_m_s) = self.margin_m_s(flight) {
            let tolerance_m_s = speed_tolerance_m_s + hop.takeoff_speed_m_s * TIME_TOLERANCE;
            self.stated(StatedValue::SpeedMargin, hop.speed_margin_m_s, margin_m_s, tolerance_m_s, "m/s");
        }
        self.map_ends();
    }

    /// What the two speeds leave of their limits; `None` where the ground allows no contact.
    fn margin_m_s(&self, flight: &Flight) -> Option<f64> {
        let limit =
            |station, contact| self.chain.check_contact(station, contact, self.direction).ok().map(|rule| rule.speed_max_m_s());
        let takeoff = limit(&self.hop.takeoff, Contact::Takeoff)? - self.hop.takeoff_speed_m_s;
        let landing = limit(&self.hop.landing, Contact::Landing)? - flight.landing_speed_m_s;
        Some(takeoff.min(landing))
    }

    /// The places on the map, where the chain lies on one.
    fn map_ends(&mut self) {
        let geometry = self.chain.geometry();
        let own = geometry.map_point(&self.hop.takeoff).zip(geometry.map_point(&self.hop.landing));
        let x_m = self.hop.takeoff.point.x_m;
        match (own, self.hop.map) {
            (None, None) => {}
            (Some((takeoff, landing)), Some(map)) => {
                let scale_m = [takeoff, landing].iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(1.0, f64::max);
                let miss_m = (map.takeoff - takeoff).norm().max((map.landing - landing).norm());
                let agrees = miss_m <= MAP_TOLERANCE * scale_m;
                if !agrees {
                    let measure = Measure { found: miss_m, allowed: MAP_TOLERANCE * scale_m, unit: "m" };
                    self.note(ViolatedLimit::StatedValue(StatedValue::MapEnds), Some(measure), x_m);
                }
                self.heading(map.heading_deg, takeoff, landing, MAP_TOLERANCE * scale_m);
            }
            _ => self.note(ViolatedLimit::StatedValue(StatedValue::MapEnds), None, x_m),
        }
    }

    /// The heading: a step along it must lead from one place to the other.
    fn heading(&mut self, heading_deg: f64, takeoff: MapPoint, landing: MapPoint, tolerance_m: f64) {
        let along = landing - takeoff;
        let length_m = along.norm();
        let (east, north) = (libm::sin(heading_deg.to_radians()) * length_m, libm::cos(heading_deg.to_radians()) * length_m);
        let miss_m = libm::hypot(east - along.x, north - along.y);
        let agrees = miss_m <= tolerance_m + ANGLE_TOLERANCE_RAD * length_m && (0.0..=360.0).contains(&heading_deg);
        if !agrees {
            let flown_deg = libm::atan2(along.x, along.y).to_degrees().rem_euclid(360.0);
            let measure = Measure { found: heading_deg, allowed: flown_deg, unit: "deg" };
            self.note(ViolatedLimit::StatedValue(StatedValue::Heading), Some(measure), self.hop.takeoff.point.x_m);
        }
    }
}

/// How uncertain the time of landing is: a place over the speed.
fn time_rounding_s(flight: &Flight) -> f64 {
    flight.rounding_m / flight.landing_speed_m_s
}

/// The numbers of a refusal, where it has some.
fn refusal_measure(refusal: GroundRefusal) -> Option<Measure> {
    let degrees = |found: f64, allowed: f64| Some(Measure { found, allowed, unit: "deg" });
    match refusal {
        GroundRefusal::TooSteep { tilt, max } => degrees(tilt.degrees(), max.degrees()),
        GroundRefusal::CrossSlope { cross_slope, friction } => degrees(cross_slope.degrees(), friction.half_angle().degrees()),
        GroundRefusal::NoGround | GroundRefusal::KeepOut | GroundRefusal::SpeedZero | GroundRefusal::NothingAhead { .. } => None,
    }
}
