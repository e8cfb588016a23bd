//! A chain as the ground of flights: windows in closed form, and the first contact of an arc in the chain's vertical plane.

use std::ops::ControlFlow;

use nalgebra::{Point3, Vector2, Vector3};

use super::{
    Around, ContactPoint, Element, Facet, FirstContact, Flight, HeightField, LiftoffVelocity, Profiles, Side, Surface,
    TakeoffWindows, TouchdownState, Windows,
    chain::{direction_of, next_vertex},
    first_contact::{ContactFailure, PLACE_TOLERANCE, Realization, check_landing, failure_of, holds},
};
use crate::{
    chain::{
        ContactRule, FootprintRefusal, GroundForm, GroundRefusal, SegmentConstraints, SegmentGround, Site, Station,
        resolve_constraints, rest_slope,
    },
    hop::HopTest,
    quantity::{ChainPoint, MapPoint, SegmentId, VertexId},
    world::{Contact, Direction, FrictionCone, Gravity, Hopper},
};

/// The chain as the ground of a trial.
///
/// The ground is taken to extend unchanged to both sides: a displacement to the side moves the robot out of the plane, nothing
/// else.
#[derive(Clone, Debug)]
pub struct ChainGround {
    test: HopTest,
    friction: f64,
    /// The vertices of this trial; empty if they are as planned.
    found: Vec<ChainPoint>,
    /// The field by which they are higher, where the hopper has a footprint.
    field: Option<Box<HeightField>>,
}

/// A position: a station of the chain, and the distance to the left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainPosition {
    /// The station.
    pub station: Station,
    /// Distance to the left of the chain's plane, m.
    pub left_m: f64,
}

impl ChainPosition {
    /// The position of a station, in the plane of the chain.
    pub const fn on_chain(station: Station) -> Self {
        Self { station, left_m: 0.0 }
    }
}

/// An arc, given by its take-off, slope and curvature.
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

    /// Height of the arc above a point, m; negative below it.
    #[inline]
    fn over_m(&self, (distance_m, height_m): (f64, f64)) -> f64 {
        distance_m * (self.slope - self.curvature * distance_m) - height_m
    }

    #[inline]
    fn slope_at(&self, distance_m: f64) -> f64 {
        self.slope - 2.0 * self.curvature * distance_m
    }
}

/// Distance at which an arc that is `over_m >= 0` above straight ground meets that ground, m.
///
/// ```text
///     over + (m - s) e - c e^2 = 0
/// ```
///
/// The positive root, in the form without cancellation. If the arc begins on the ground (`over = 0`) it is exactly `(m - s) / c`,
/// or 0 if the arc does not leave the ground.
#[inline]
pub(super) fn comes_down_m(over_m: f64, climb: f64, curvature: f64) -> f64 {
    if over_m <= 0.0 {
        return (climb / curvature).max(0.0);
    }
    let root = (climb * climb + 4.0 * curvature * over_m).sqrt();
    if climb >= 0.0 { (climb + root) / (2.0 * curvature) } else { 2.0 * over_m / (root - climb) }
}

/// The vertices ahead of a position, in the order of travel.
#[derive(Clone, Copy)]
struct Ahead {
    next: usize,
    /// The last vertex before a bend or the end of the chain.
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

    /// Moves to the next vertex; `false` at the last one.
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

impl ChainGround {
    /// The nominal ground of a hop test's chain.
    pub fn new(test: HopTest) -> Self {
        Self { test, friction: 0.0, found: Vec::new(), field: None }
    }

    /// The hop test of the chain.
    pub const fn test(&self) -> &HopTest {
        &self.test
    }

    #[inline]
    fn vertices(&self) -> &[ChainPoint] {
        if self.found.is_empty() { self.test.chain().geometry().vertices() } else { &self.found }
    }

    fn is_nominal(&self) -> bool {
        self.found.is_empty() && self.friction == 0.0
    }

    /// The constraints of a segment in this trial.
    fn resolved(&self, segment: usize) -> Option<SegmentConstraints> {
        let chain = self.test.chain();
        if self.is_nominal() {
            return chain.segments().get(segment).copied();
        }
        let ground = self.ground_of(segment)?;
        let (a, b) = (self.vertices()[segment], self.vertices()[segment + 1]);
        let slope = (b.z_m - a.z_m) / (b.x_m - a.x_m);
        resolve_constraints(SegmentId(segment), slope, &ground, self.test.hopper(), chain.gravity(), chain.surface()).ok()
    }

    /// What this trial's ground states of a segment: its friction.
    fn ground_of(&self, segment: usize) -> Option<SegmentGround> {
        let chain = self.test.chain();
        let mut ground: SegmentGround = *chain.geometry().grounds().get(segment)?;
        if let GroundForm::Surface { friction, .. } = &mut ground.form
            && let Some(cone) = friction.or(chain.surface().constant_friction())
        {
            *friction = FrictionCone::new((cone.coefficient() + self.friction).max(0.0)).ok();
        }
        Some(ground)
    }

    /// Why a segment refuses any contact; `None` if it does not.
    fn refusal(&self, segment: usize) -> Option<GroundRefusal> {
        if self.is_nominal() {
            return self.test.chain().segments().get(segment)?.refusal();
        }
        self.resolved(segment)?.refusal()
    }

    /// Why the ground of this trial under the footprint refuses every contact at a station that a segment rules.
    fn footprint_refusal(&self, at: &Station, segment: SegmentId) -> Option<FootprintRefusal> {
        let chain = self.test.chain();
        let footprint = chain.footprint()?;
        if self.is_nominal() {
            return chain.footprint_refusal(at, segment);
        }
        let geometry = chain.geometry();
        let ground = self.ground_of(segment.index())?;
        // On the map of a slice, the heights change along the slice alone, as those of its vertices.
        let along = geometry.map_points().zip(geometry.map_point(at)).and_then(|(map, here)| {
            let heading = (map.get(segment.index() + 1)? - map.get(segment.index())?).try_normalize(0.0)?;
            let from_m = at.point.x_m - geometry.extent_m().0;
            Some(move |post: MapPoint| from_m + (post - here).dot(&heading))
        });
        let raised = self.field.as_deref().zip(along).map(|(field, along)| move |post| field.at(along(post), 0.0));
        let raised = raised.as_ref().map(|raised| raised as &dyn Fn(MapPoint) -> f64);
        let fit = chain.footing().fit(geometry, self.vertices(), at, footprint.diameter_m, raised);
        footprint.judge(fit, rest_slope(&ground, chain.surface()), chain.height_bound_m())
    }

    /// The rule of a contact at a station on a segment, or why the ground refuses it.
    fn check_contact(
        &self,
        at: &Station,
        segment: Option<SegmentId>,
        contact: Contact,
        direction: Direction,
    ) -> Result<ContactRule, GroundRefusal> {
        let checked = self.check_segment(segment, contact, direction);
        // A hopper that stands where a layer does not hold may leave, as at a start.
        let layer = self.test.chain().geometry().layer_refusing_contact(at.point.x_m).filter(|_| contact == Contact::Landing);
        if let (Ok(_), Some(layer)) = (checked, layer) {
            return Err(GroundRefusal::Layer(layer));
        }
        match (checked, segment) {
            (Err(GroundRefusal::NoGround | GroundRefusal::KeepOut | GroundRefusal::TooSteep { .. }), _) | (_, None) => checked,
            (_, Some(id)) => self.footprint_refusal(at, id).map_or(checked, |refusal| Err(GroundRefusal::Footprint(refusal))),
        }
    }

    /// The same for the segment alone, without a footprint.
    fn check_segment(
        &self,
        segment: Option<SegmentId>,
        contact: Contact,
        direction: Direction,
    ) -> Result<ContactRule, GroundRefusal> {
        let segment = segment.ok_or(GroundRefusal::NoGround)?.index();
        if self.is_nominal()
            && let Some(rule) = self.test.chain().segments().get(segment).and_then(|s| s.allowed(contact, direction))
        {
            return Ok(*rule);
        }
        self.resolved(segment).ok_or(GroundRefusal::NoGround)?.check_contact(contact, direction)
    }

    /// The station on a segment at an x; its height is interpolated from the nearer vertex.
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
        let next = next_vertex(from.site, direction, end)?;
        let bends = geometry.bends();
        let last = match direction {
            Direction::Forward => bends.get(bends.partition_point(|v| v.index() < next)).map_or(end, |v| v.index()),
            Direction::Reverse => bends.partition_point(|v| v.index() <= next).checked_sub(1).map_or(0, |i| bends[i].index()),
        };
        Some(Ahead { next, last, direction })
    }

    /// Whether a flight over nominal ground lands at its aim, within rounding.
    fn hits(&self, course: &Course, mut ahead: Ahead, aim: &Station, liftoff: &LiftoffVelocity) -> bool {
        let (run_m, rise_m) = course.seen(aim.point);
        if run_m <= 0.0 || !self.found.is_empty() {
            return false;
        }
        let top_m = liftoff.vertical_m_s * liftoff.vertical_m_s / (2.0 * self.test.gravity_m_s2());
        let slack_m = PLACE_TOLERANCE * (run_m + top_m + rise_m.abs()) + self.height_rounding_m();
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

impl Surface for ChainGround {
    type Contact = ChainPosition;

    fn hopper(&self) -> &Hopper {
        self.test.hopper()
    }

    fn gravity(&self) -> Gravity {
        self.test.chain().gravity()
    }

    fn contact_point(&self, position: &ChainPosition) -> ContactPoint {
        self.test.chain().contact_point(&position.station)
    }

    fn contact_at(&self, stated: &ContactPoint) -> Option<ChainPosition> {
        self.test.chain().contact_at(stated).map(ChainPosition::on_chain)
    }

    fn course(&self, from: &ChainPosition, to: &ChainPosition) -> Option<(f64, Vector2<f64>)> {
        self.test.chain().course(&from.station, &to.station)
    }

    fn facets(&self, at: &ChainPosition, heading: Vector2<f64>, side: Side) -> Vec<Facet> {
        self.test.chain().facets(&at.station, heading, side)
    }

    fn height_rounding_m(&self) -> f64 {
        self.test.chain().height_rounding_m()
    }

    fn position_rounding_m(&self) -> f64 {
        self.test.chain().position_rounding_m()
    }

    fn resolution_m(&self) -> f64 {
        self.test.chain().resolution_m()
    }

    fn slope_rounding(&self) -> f64 {
        self.test.chain().slope_rounding()
    }
}

impl Profiles for ChainGround {
    fn walk(&self, from: &ChainPosition, heading: Vector2<f64>, visit: &mut dyn FnMut(&Element) -> ControlFlow<()>) {
        self.test.chain().walk(&from.station, heading, visit);
    }

    fn around(&self, at: &ChainPosition, distance_m: f64) -> Around {
        self.test.chain().around(&at.station, distance_m)
    }

    fn rays(
        &self,
        at: &ChainPosition,
        distance_m: f64,
        headings: &[Vector2<f64>],
        visit: &mut dyn FnMut(usize, &Element) -> ControlFlow<()>,
    ) {
        self.test.chain().rays(&at.station, distance_m, headings, visit);
    }
}

impl Windows for ChainGround {
    /// The windows of [`HopTest::windows`].
    fn windows(&self, takeoff: &ChainPosition, landing: &ChainPosition) -> Option<TakeoffWindows> {
        let sight = self.test.line_of_sight(&takeoff.station, &landing.station)?;
        let lofts = self.test.lofts(&takeoff.station, &landing.station).ok();
        Some(TakeoffWindows::of(self.test.takeoff_speeds(), sight, lofts, self.test.gravity_m_s2()))
    }
}

impl FirstContact for ChainGround {
    type SupportFacet = SegmentId;

    fn realize(&mut self, realization: Realization) {
        self.friction = realization.friction;
        self.found.clear();
        self.field = None;
        if let Some(field) = realization.heights {
            let nominal = self.test.chain().geometry().vertices();
            let first_m = nominal[0].x_m;
            self.found.extend(nominal.iter().map(|v| ChainPoint::new(v.x_m, v.z_m + field.at(v.x_m - first_m, 0.0))));
            self.field = self.test.chain().footprint().map(|_| field);
        }
    }

    fn realized(&self, planned: ChainPosition) -> ChainPosition {
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
        let direction = direction_of(liftoff.heading);
        let segment = from.station.ruling_segment(Contact::Takeoff, direction, self.test.chain().segments().len());
        holds(self.check_contact(&from.station, segment, Contact::Takeoff, direction), liftoff)
    }

    fn first_contact(
        &self,
        from: &ChainPosition,
        liftoff: &LiftoffVelocity,
        aim: &ChainPosition,
    ) -> Flight<ChainPosition, SegmentId> {
        let direction = direction_of(liftoff.heading);
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
            // Straight up: it lands where it took off.
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
        // Distance, height of the ground, and height of the arc above it.
        let mut before = (0.0, 0.0, 0.0);
        loop {
            let vertex = course.seen(vertices[ahead.next]);
            // The first segment contains the take-off, so the height above it is 0 there, without rounding.
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

    fn check_landing(
        &self,
        end: &ChainPosition,
        support_facet: &SegmentId,
        touchdown: &TouchdownState,
    ) -> Result<(), ContactFailure> {
        let rule = self.check_contact(&end.station, Some(*support_facet), Contact::Landing, direction_of(touchdown.heading));
        check_landing(rule, self.test.hopper().limits().arc_landing_speed_max_m_s(), touchdown)
    }

    fn check_track(&self, from: &ChainPosition, end: &ChainPosition) -> Result<(), ContactFailure> {
        let geometry = self.test.chain().geometry();
        let refusing = geometry.layer_refusing_flight(from.station.point.x_m, end.station.point.x_m);
        if refusing.is_some() { Err(ContactFailure::OffLimits) } else { Ok(()) }
    }

    fn normal(&self, facet: &SegmentId) -> Vector3<f64> {
        let (a, b) = (self.vertices()[facet.index()], self.vertices()[facet.index() + 1]);
        Vector3::new(-(b.z_m - a.z_m) / (b.x_m - a.x_m), -0.0, 1.0)
    }

    fn check_bounce(&self, end: &ChainPosition, facet: &SegmentId, touchdown: &TouchdownState) -> Result<(), ContactFailure> {
        let rule = self.check_contact(&end.station, Some(*facet), Contact::Landing, direction_of(touchdown.heading));
        let stated_m_s = match rule {
            Err(GroundRefusal::KeepOut | GroundRefusal::Layer(_)) => return Err(ContactFailure::OffLimits),
            Err(_) => f64::INFINITY,
            Ok(rule) => rule.speed_max_m_s(),
        };
        let most_m_s = stated_m_s.min(self.test.hopper().limits().landing_speed_max_m_s);
        if touchdown.is_over(most_m_s) { Err(ContactFailure::TooFast) } else { Ok(()) }
    }

    fn check_rest(&self, position: &ChainPosition, facet: &SegmentId, _heading: Vector2<f64>) -> Result<(), ContactFailure> {
        self.rests(&position.station, *facet)
    }

    fn displaced(
        &self,
        from: &ChainPosition,
        heading: Vector2<f64>,
        along_m: f64,
        left_m: f64,
    ) -> Result<ChainPosition, ContactFailure> {
        if along_m == 0.0 && left_m == 0.0 {
            return Ok(*from);
        }
        let sign = direction_of(heading).sign();
        let x_m = from.station.point.x_m + sign * along_m;
        let geometry = self.test.chain().geometry();
        let nominal = geometry.station(x_m).map_err(|_| ContactFailure::OffLimits)?;
        let position = self.realized(ChainPosition { station: nominal, left_m: from.left_m + sign * left_m });
        let under = position.station.ruling_segment(Contact::Landing, direction_of(heading), geometry.segment_count());
        under.map_or(Ok(()), |segment| self.rests(&position.station, segment)).map(|()| position)
    }

    fn believed(&self, position: &ChainPosition, along_m: f64, _across_m: f64) -> Option<ChainPosition> {
        let (first_m, last_m) = self.test.chain().geometry().extent_m();
        let x_m = (position.station.point.x_m + along_m).clamp(first_m, last_m);
        self.test.chain().geometry().station(x_m).ok().map(ChainPosition::on_chain)
    }
}

impl ChainGround {
    /// Whether the hopper rests at a station that a segment rules.
    fn rests(&self, at: &Station, segment: SegmentId) -> Result<(), ContactFailure> {
        let footprint = || self.footprint_refusal(at, segment).map(GroundRefusal::Footprint);
        let layer = || self.test.chain().geometry().layer_refusing_contact(at.point.x_m).map(GroundRefusal::Layer);
        match self.refusal(segment.index()).or_else(layer).or_else(footprint) {
            None => Ok(()),
            Some(GroundRefusal::Footprint(refusal)) => Err(failure_of(&refusal)),
            Some(GroundRefusal::KeepOut | GroundRefusal::Layer(_)) => Err(ContactFailure::OffLimits),
            Some(_) => Err(ContactFailure::Slides),
        }
    }

    /// The slope of the segment ahead in the direction of travel: its stored slope has more digits than a difference of two close
    /// heights.
    fn slope_ahead(&self, ahead: Ahead) -> f64 {
        let segment = ahead.segment();
        let (a, b) = (self.vertices()[segment], self.vertices()[segment + 1]);
        ahead.direction.sign() * ((b.z_m - a.z_m) / (b.x_m - a.x_m))
    }
}
