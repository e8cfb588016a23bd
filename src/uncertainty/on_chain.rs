//! Flights in the chain's vertical plane.

use nalgebra::{Point3, Vector2};

use super::{
    LiftoffVelocity, TrialOutcome,
    ground::{Command, Flight, Ground, PLACE_TOLERANCE, Realization, TouchdownState, failure, holds},
};
use crate::{
    ballistics::Arc,
    chain::{GroundForm, GroundRefusal, SegmentConstraints, SegmentGround, Site, Station, resolve_constraints},
    graph::{CostToGo, Edge},
    hop::HopTest,
    quantity::{ChainPoint, SegmentId, VertexId},
    world::{Contact, Direction, FrictionCone, Grip, SurfaceProperties},
};

/// The chain as the ground of a trial.
///
/// To the sides the ground is taken to go on as it is: displacement to the side moves the robot out of the plane and no more.
#[derive(Clone, Debug)]
pub(super) struct ChainGround<'a> {
    test: &'a HopTest,
    surface: &'a SurfaceProperties,
    to_go: Option<&'a CostToGo>,
    /// How much a height of the chain may be rounded, m.
    height_rounding_m: f64,
    friction: f64,
    /// The vertices as this trial finds them; none where they are as planned.
    found: Vec<ChainPoint>,
}

/// A position: a station of the chain, and the distance to the left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChainPosition {
    pub(super) station: Station,
    pub(super) left_m: f64,
}

impl ChainPosition {
    pub(super) const fn on_chain(station: Station) -> Self {
        Self { station, left_m: 0.0 }
    }
}

/// Units in the last place of the greatest height that a height inside a segment may be off, as in `path::execute`.
const HEIGHT_ULPS: f64 = 4.0;

/// An arc from its take-off, and how far rounding may carry it.
#[derive(Clone, Copy)]
struct Course {
    takeoff: ChainPoint,
    direction: Direction,
    /// Slope at the take-off.
    slope: f64,
    /// Half the curvature, 1/m: `g / (2 v_x^2)`.
    curvature: f64,
}

impl Course {
    /// Distance ahead and height above the take-off. Close doubles subtract without error.
    #[inline]
    fn seen(&self, point: ChainPoint) -> (f64, f64) {
        (self.direction.sign() * (point.x_m - self.takeoff.x_m), point.z_m - self.takeoff.z_m)
    }

    /// How far the arc passes over a point.
    #[inline]
    fn over_m(&self, (distance_m, height_m): (f64, f64)) -> f64 {
        distance_m * (self.slope - self.curvature * distance_m) - height_m
    }

    #[inline]
    fn slope_at(&self, distance_m: f64) -> f64 {
        self.slope - 2.0 * self.curvature * distance_m
    }
}

/// Where an arc that is `over_m >= 0` above straight ground of a slope comes down on it, m further on.
///
/// ```text
///     over + (m - s) e - c e^2 = 0
/// ```
///
/// The positive root, in the form that does not cancel; exact where the arc begins on the ground (`over = 0`): `(m - s) / c`, or there
/// and then where it does not leave the ground at all.
#[inline]
pub(super) fn comes_down_m(over_m: f64, climb: f64, curvature: f64) -> f64 {
    if over_m <= 0.0 {
        return (climb / curvature).max(0.0);
    }
    let root = (climb * climb + 4.0 * curvature * over_m).sqrt();
    if climb >= 0.0 { (climb + root) / (2.0 * curvature) } else { 2.0 * over_m / (root - climb) }
}

/// The vertices ahead of a place, one after the other.
#[derive(Clone, Copy)]
struct Ahead {
    next: usize,
    /// The last one before the plane turns or the chain ends.
    last: usize,
    direction: Direction,
}

impl Ahead {
    /// The segment that ends at the next vertex.
    const fn segment(self) -> usize {
        match self.direction {
            Direction::Forward => self.next - 1,
            Direction::Reverse => self.next,
        }
    }

    /// Goes on; `false` where there is nothing further.
    const fn advance(&mut self) -> bool {
        if self.next == self.last {
            return false;
        }
        match self.direction {
            Direction::Forward => self.next += 1,
            Direction::Reverse => self.next -= 1,
        }
        true
    }
}

impl<'a> ChainGround<'a> {
    pub(super) fn new(test: &'a HopTest, surface: &'a SurfaceProperties, to_go: Option<&'a CostToGo>) -> Self {
        let highest_m = test.chain().geometry().vertices().iter().map(|v| v.z_m.abs()).fold(0.0, f64::max);
        let height_rounding_m = HEIGHT_ULPS * f64::EPSILON * highest_m;
        Self { test, surface, to_go, height_rounding_m, friction: 0.0, found: Vec::new() }
    }

    #[inline]
    fn vertices(&self) -> &[ChainPoint] {
        if self.found.is_empty() { self.test.chain().geometry().vertices() } else { &self.found }
    }

    fn is_nominal(&self) -> bool {
        self.found.is_empty() && self.friction == 0.0
    }

    /// A segment as this trial finds it.
    fn resolved(&self, segment: usize) -> Option<SegmentConstraints> {
        let chain = self.test.chain();
        if self.is_nominal() {
            return chain.segments().get(segment).copied();
        }
        let mut ground: SegmentGround = *chain.geometry().grounds().get(segment)?;
        if let GroundForm::Surface { friction, .. } = &mut ground.form
            && let Some(cone) = friction.or(match self.surface.grip {
                Some(Grip::Friction(cone)) => Some(cone),
                Some(Grip::FromSlope { .. }) | None => None,
            })
        {
            *friction = FrictionCone::new((cone.coefficient() + self.friction).max(0.0)).ok();
        }
        let (a, b) = (self.vertices()[segment], self.vertices()[segment + 1]);
        let slope = (b.z_m - a.z_m) / (b.x_m - a.x_m);
        resolve_constraints(SegmentId(segment), slope, &ground, self.test.hopper(), self.surface).ok()
    }

    /// What refuses any contact on a segment.
    fn refusal(&self, segment: usize) -> Option<GroundRefusal> {
        if self.is_nominal() {
            return self.test.chain().segments().get(segment)?.refusal();
        }
        self.resolved(segment)?.refusal()
    }

    /// What the ground says of a contact on a segment.
    fn check_contact(
        &self,
        segment: Option<SegmentId>,
        contact: Contact,
        direction: Direction,
    ) -> Result<crate::chain::ContactRule, GroundRefusal> {
        let segment = segment.ok_or(GroundRefusal::NoGround)?.index();
        if self.is_nominal()
            && let Some(rule) = self.test.chain().segments().get(segment).and_then(|s| s.allowed(contact, direction))
        {
            return Ok(*rule);
        }
        self.resolved(segment).ok_or(GroundRefusal::NoGround)?.check_contact(contact, direction)
    }

    /// The point of a segment's ground at an x, counted from the nearer vertex, and its site.
    fn station_on(&self, segment: usize, x_m: f64) -> Station {
        let (a, b) = (self.vertices()[segment], self.vertices()[segment + 1]);
        let x_m = x_m.clamp(a.x_m, b.x_m);
        if x_m == a.x_m {
            return Station { point: a, site: Site::Vertex(VertexId(segment)) };
        }
        if x_m == b.x_m {
            return Station { point: b, site: Site::Vertex(VertexId(segment + 1)) };
        }
        let slope = (b.z_m - a.z_m) / (b.x_m - a.x_m);
        let z_m = if x_m - a.x_m <= b.x_m - x_m { a.z_m + slope * (x_m - a.x_m) } else { b.z_m - slope * (b.x_m - x_m) };
        Station { point: ChainPoint::new(x_m, z_m), site: Site::Inside(SegmentId(segment)) }
    }

    /// The vertices ahead of a station; `None` at the chain's end.
    fn ahead(&self, from: &Station, direction: Direction) -> Option<Ahead> {
        let geometry = self.test.chain().geometry();
        let end = geometry.segment_count();
        let next = match (from.site, direction) {
            (Site::Vertex(v), Direction::Forward) if v.index() < end => v.index() + 1,
            (Site::Inside(s), Direction::Forward) => s.index() + 1,
            (Site::Vertex(v), Direction::Reverse) if v.index() > 0 => v.index() - 1,
            (Site::Inside(s), Direction::Reverse) => s.index(),
            (Site::Vertex(_), _) => return None,
        };
        let bends = geometry.bends();
        let last = match direction {
            Direction::Forward => bends.get(bends.partition_point(|v| v.index() < next)).map_or(end, |v| v.index()),
            Direction::Reverse => bends.partition_point(|v| v.index() <= next).checked_sub(1).map_or(0, |i| bends[i].index()),
        };
        Some(Ahead { next, last, direction })
    }

    /// Whether a flight over nominal ground comes down on its aim, as closely as rounding allows.
    fn hits(&self, course: &Course, mut ahead: Ahead, aim: &Station, liftoff: &LiftoffVelocity) -> bool {
        let (run_m, rise_m) = course.seen(aim.point);
        if run_m <= 0.0 || !self.found.is_empty() {
            return false;
        }
        let top_m = liftoff.vertical_m_s * liftoff.vertical_m_s / (2.0 * self.test.gravity_m_s2());
        let slack_m = PLACE_TOLERANCE * (run_m + top_m + rise_m.abs()) + self.height_rounding_m;
        let misses = |over_m: f64, at_m: f64| over_m.abs() > slack_m * (1.0 + course.slope_at(at_m).abs());
        if misses(course.over_m((run_m, rise_m)), run_m) {
            return false;
        }
        loop {
            let vertex = course.seen(self.vertices()[ahead.next]);
            if vertex.0 >= run_m {
                return true;
            }
            let over_m = course.over_m(vertex);
            if (over_m < 0.0 && misses(over_m, vertex.0)) || !ahead.advance() {
                return false;
            }
        }
    }
}

impl Ground for ChainGround<'_> {
    type Position = ChainPosition;
    type SupportFacet = SegmentId;

    fn realize(&mut self, realization: Realization) {
        self.friction = realization.friction;
        self.found.clear();
        if let Some(field) = realization.heights {
            let nominal = self.test.chain().geometry().vertices();
            let first_m = nominal[0].x_m;
            self.found.extend(nominal.iter().map(|v| ChainPoint::new(v.x_m, v.z_m + field.at(v.x_m - first_m, 0.0))));
        }
    }

    fn real(&self, planned: ChainPosition) -> ChainPosition {
        if self.found.is_empty() {
            return planned;
        }
        let station = match planned.station.site {
            Site::Vertex(v) => Station { point: self.found[v.index()], ..planned.station },
            Site::Inside(s) => self.station_on(s.index(), planned.station.point.x_m),
        };
        ChainPosition { station, ..planned }
    }

    fn point(&self, position: &ChainPosition) -> Point3<f64> {
        Point3::new(position.station.point.x_m, position.left_m, position.station.point.z_m)
    }

    fn holds_takeoff(&self, from: &ChainPosition, liftoff: &LiftoffVelocity) -> bool {
        let direction = towards(liftoff.heading);
        let segment = from.station.ruling_segment(Contact::Takeoff, direction, self.test.chain().segments().len());
        holds(self.check_contact(segment, Contact::Takeoff, direction), liftoff)
    }

    fn fly(&self, from: &ChainPosition, liftoff: &LiftoffVelocity, aim: &ChainPosition) -> Flight<ChainPosition, SegmentId> {
        let direction = towards(liftoff.heading);
        let g = self.test.gravity_m_s2();
        let segment_under = from.station.ruling_segment(Contact::Takeoff, direction, self.test.chain().segments().len());
        let across = liftoff.horizontal_m_s;
        let course = Course {
            takeoff: from.station.point,
            direction,
            slope: liftoff.vertical_m_s / across,
            curvature: g / (2.0 * across * across),
        };
        let upright = !(course.curvature.is_finite() && course.slope.is_finite());
        let Some(mut ahead) = self.ahead(&from.station, direction) else {
            return Flight { end: *from, support_facet: None, time_s: 0.0 };
        };
        if upright {
            // Straight up, and down where it began.
            return Flight { end: *from, support_facet: segment_under, time_s: (2.0 * liftoff.vertical_m_s / g).max(0.0) };
        }
        let lands = |station: Station, distance_m: f64, segment: Option<SegmentId>| Flight {
            end: ChainPosition { station, left_m: from.left_m },
            support_facet: segment,
            time_s: distance_m / across,
        };
        if self.hits(&course, ahead, &aim.station, liftoff) {
            let under = aim.station.ruling_segment(Contact::Landing, direction, self.test.chain().segments().len());
            return lands(aim.station, course.seen(aim.station.point).0, under);
        }
        let vertices = self.vertices();
        // Distance, height of the ground and height over it.
        let mut before = (0.0, 0.0, 0.0);
        loop {
            let vertex = course.seen(vertices[ahead.next]);
            // The first segment passes through the take-off itself, whatever the rounding of its height.
            let first_slope = (before.0 == 0.0).then(|| self.slope_ahead(ahead));
            let over_m = match first_slope {
                Some(slope) => vertex.0 * ((course.slope - slope) - course.curvature * vertex.0),
                None => course.over_m(vertex),
            };
            if over_m <= 0.0 {
                let slope = first_slope.unwrap_or_else(|| (vertex.1 - before.1) / (vertex.0 - before.0));
                let further_m = comes_down_m(before.2, course.slope_at(before.0) - slope, course.curvature);
                let distance_m = (before.0 + further_m).min(vertex.0);
                let x_m = course.takeoff.x_m + direction.sign() * distance_m;
                let station = if distance_m == 0.0 { from.station } else { self.station_on(ahead.segment(), x_m) };
                return lands(station, distance_m, Some(SegmentId(ahead.segment())));
            }
            before = (vertex.0, vertex.1, over_m);
            let beyond = ahead.next;
            if !ahead.advance() {
                let station = Station { point: vertices[beyond], site: Site::Vertex(VertexId(beyond)) };
                return lands(station, vertex.0, None);
            }
        }
    }

    fn landing_failure(&self, _end: &ChainPosition, support_facet: &SegmentId, touchdown: &TouchdownState) -> Option<TrialOutcome> {
        let rule = self.check_contact(Some(*support_facet), Contact::Landing, towards(touchdown.heading));
        failure(rule, self.test.hopper().limits().landing_speed_max_m_s, touchdown)
    }

    fn displaced(
        &self,
        from: &ChainPosition,
        heading: Vector2<f64>,
        along_m: f64,
        left_m: f64,
    ) -> Result<ChainPosition, TrialOutcome> {
        if along_m == 0.0 && left_m == 0.0 {
            return Ok(*from);
        }
        let sign = towards(heading).sign();
        let x_m = from.station.point.x_m + sign * along_m;
        let geometry = self.test.chain().geometry();
        let nominal = geometry.station(x_m).map_err(|_| TrialOutcome::Lost)?;
        let position = self.real(ChainPosition { station: nominal, left_m: from.left_m + sign * left_m });
        let under = position.station.ruling_segment(Contact::Landing, towards(heading), geometry.segment_count());
        match under.and_then(|segment| self.refusal(segment.index())) {
            None => Ok(position),
            Some(GroundRefusal::KeepOut) => Err(TrialOutcome::Lost),
            Some(_) => Err(TrialOutcome::SlidAtLanding),
        }
    }

    fn believed(&self, position: &ChainPosition, along_m: f64, _across_m: f64) -> Option<ChainPosition> {
        let (first_m, last_m) = self.test.chain().geometry().extent_m();
        let x_m = (position.station.point.x_m + along_m).clamp(first_m, last_m);
        self.test.chain().geometry().station(x_m).ok().map(ChainPosition::on_chain)
    }

    fn replanned(&self, believed: &ChainPosition) -> Option<Command<ChainPosition>> {
        let to_go = self.to_go?;
        let leg = to_go.best_leg(self.test, &believed.station)?;
        let direction = Direction::between(leg.takeoff.point.x_m, leg.landing.point.x_m)?;
        let (arc, landing) = match leg.edge {
            Edge::Hop(lofts) => {
                let sight = self.test.line_of_sight(&leg.takeoff, &leg.landing)?;
                (Arc::new(sight, to_go.options().takeoff.loft(sight, lofts), self.test.gravity_m_s2()), leg.landing)
            }
            Edge::Along(along) => {
                let (each_m, last_m) = along.lengths_m(to_go.options().split);
                let length_m = if along.hops() > 1 { each_m } else { last_m };
                let x_m = leg.takeoff.point.x_m + direction.sign() * length_m;
                let landing = self.test.chain().geometry().station(x_m).unwrap_or(leg.landing);
                (along.arc(self.test, length_m, to_go.options().takeoff), landing)
            }
        };
        let across = arc.horizontal_speed_m_s();
        let heading = Vector2::new(direction.sign(), 0.0);
        let liftoff = LiftoffVelocity { heading, horizontal_m_s: across, vertical_m_s: across * arc.takeoff_slope() };
        Some(Command::new(liftoff, ChainPosition::on_chain(landing)))
    }
}

impl ChainGround<'_> {
    /// The slope of the segment ahead as the traveller sees it: its own, which keeps more digits than two close heights.
    fn slope_ahead(&self, ahead: Ahead) -> f64 {
        let segment = ahead.segment();
        let (a, b) = (self.vertices()[segment], self.vertices()[segment + 1]);
        ahead.direction.sign() * ((b.z_m - a.z_m) / (b.x_m - a.x_m))
    }
}

/// The direction of travel of a heading along the chain.
#[inline]
fn towards(heading: Vector2<f64>) -> Direction {
    if heading.x < 0.0 { Direction::Reverse } else { Direction::Forward }
}
