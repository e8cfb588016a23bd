//! Flights in three dimensions, over the triangles of a DEM.

use std::sync::Arc;

use nalgebra::{Point3, Vector2};

use super::{
    LiftoffVelocity, MapGround, TrialOutcome,
    ground::{ANGLE_TOLERANCE_RAD, Command, Flight, Ground, PLACE_TOLERANCE, Realization, TouchdownState, failure, holds},
    on_chain::comes_down_m,
};
use crate::{
    ballistics::{self, LineOfSight, limits},
    chain::{ContactRule, GroundForm, LineConstraints, SegmentGround, resolve_constraints},
    graph::{Cost, CostToGo},
    hop::HopTest,
    quantity::{ChainPoint, MapPoint, NodeId, SegmentId},
    terrain::{FacetSpan, ProfileFacet, Triangles},
    world::{Contact, Direction, FrictionCone, Grip, RestSlope, SPEED_TOLERANCE, SurfaceProperties, tolerant_speed_m_s},
};

/// How far before a landing, or beyond a take-off, friction and keep-out zones are asked for, m: a landing obeys the ground just flown
/// over and a take-off the ground ahead, also where a border runs through the very place.
const BESIDE_M: f64 = 1e-6;

/// Units in the last place that a height or a coordinate may be off.
const ULPS: f64 = 4.0;

/// A DEM as the ground of a trial.
#[derive(Clone, Debug)]
pub(super) struct DemGround<'a> {
    test: &'a HopTest,
    surface: &'a SurfaceProperties,
    map: MapGround<'a>,
    triangles: Triangles<'a>,
    to_go: Option<&'a CostToGo>,
    /// The nodes of the costs-to-go on the map.
    nodes: Arc<[MapPosition]>,
    height_rounding_m: f64,
    place_rounding_m: f64,
    /// What the rest slope is where friction does not say it.
    rest_slope: Option<f64>,
    realization: Realization,
}

/// A position on the map, and its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MapPosition {
    pub(super) at: MapPoint,
    pub(super) z_m: f64,
}

/// The facet of a landing: its slope towards east and north.
pub(super) type Gradient = Vector2<f64>;

impl<'a> DemGround<'a> {
    pub(super) fn new(
        test: &'a HopTest,
        surface: &'a SurfaceProperties,
        map: MapGround<'a>,
        to_go: Option<&'a CostToGo>,
        nodes: Arc<[MapPosition]>,
    ) -> Self {
        let (low_m, high_m) = map.dem.elevation_range_m();
        let bounds = map.dem.bounds();
        let farthest_m = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y].into_iter().map(f64::abs).fold(0.0, f64::max);
        Self {
            test,
            surface,
            map,
            triangles: Triangles::of(map.dem),
            to_go,
            nodes,
            height_rounding_m: ULPS * f64::EPSILON * low_m.abs().max(high_m.abs()),
            place_rounding_m: ULPS * f64::EPSILON * farthest_m,
            rest_slope: match surface.rest {
                RestSlope::AtMost(angle) => Some(angle.slope()),
                RestSlope::AsFrictionHolds | RestSlope::Unlimited => None,
            },
            realization: Realization::default(),
        }
    }

    /// A place of the nominal ground; `None` where there is none.
    pub(super) fn nominal(&self, at: MapPoint) -> Option<MapPosition> {
        self.triangles.at(at, self.triangles.nominal()).map(|(z_m, _)| MapPosition { at, z_m })
    }

    /// Height of a post as this trial finds it.
    #[inline]
    fn heights(&self) -> impl Fn(usize, usize) -> f64 + '_ {
        let nominal = self.triangles.nominal();
        let origin = self.map.dem.georeference().north_west();
        move |row, col| match &self.realization.heights {
            None => nominal(row, col),
            Some(field) => {
                let away = self.triangles.post(row, col) - origin;
                nominal(row, col) + field.at(away.x, away.y)
            }
        }
    }

    /// The facet that a take-off leaves from: the one ahead. `None` where the known ground ends.
    fn facet_ahead(&self, at: MapPoint, heading: Vector2<f64>) -> Option<Gradient> {
        self.triangles.walk(at, heading, self.heights()).next().map(|span| span.gradient)
    }

    /// The friction that a place is thought to have; `None` where angles are stated instead.
    fn nominal_friction(&self, at: MapPoint) -> Option<FrictionCone> {
        let constant = match self.surface.grip {
            Some(Grip::Friction(cone)) => Some(cone),
            Some(Grip::FromSlope { .. }) | None => None,
        };
        self.map.friction.and_then(|raster| raster.at(at)).or(constant)
    }

    /// The friction that a place has in this trial.
    fn friction(&self, at: MapPoint) -> Option<f64> {
        self.nominal_friction(at).map(|cone| (cone.coefficient() + self.realization.friction).max(0.0))
    }

    fn is_kept_out(&self, at: MapPoint) -> bool {
        self.map.keep_out.is_some_and(|zones| zones.keeps_out(at))
    }

    /// Whether the robot rests on a facet with such friction.
    fn rests(&self, gradient: Gradient, friction: Option<f64>) -> bool {
        let max = match self.surface.rest {
            RestSlope::AsFrictionHolds => friction,
            RestSlope::AtMost(_) => self.rest_slope,
            RestSlope::Unlimited => None,
        };
        max.is_none_or(|max| gradient.norm() <= max + ANGLE_TOLERANCE_RAD * (1.0 + max * max))
    }

    /// The stated angles of a facet met along a heading, where they are stated.
    fn stated(&self, gradient: Gradient, heading: Vector2<f64>) -> Option<LineConstraints> {
        let Some(Grip::FromSlope { takeoff, landing }) = self.surface.grip else { return None };
        let hopper = self.test.hopper();
        let slope = gradient.dot(&heading);
        Some(LineConstraints::from_offsets(
            slope,
            takeoff,
            landing,
            hopper.limits().takeoff_speed_max_m_s,
            hopper.limits().landing_speed_max_m_s,
        ))
    }

    /// What the nominal ground allows a contact on a facet met along a heading: as a slice along that heading has it.
    fn allowed(&self, gradient: Gradient, heading: Vector2<f64>, beside: MapPoint, contact: Contact) -> Option<ContactRule> {
        let friction = self.nominal_friction(beside);
        let cross_slope = ProfileFacet::from_gradient(gradient, heading).cross_slope;
        let ground = SegmentGround { form: GroundForm::Surface { friction, cross_slope }, keep_out: self.is_kept_out(beside) };
        let resolved = resolve_constraints(SegmentId(0), gradient.dot(&heading), &ground, self.test.hopper(), self.surface).ok()?;
        resolved.allowed(contact, Direction::Forward).copied()
    }

    /// The best hop to a node, and what the journey then costs, where it could be better than the best known.
    fn tried(&self, to_go: &CostToGo, from: &MapPosition, node: usize, best: Option<Cost>) -> Option<(Command<MapPosition>, Cost)> {
        let target = self.nodes[node];
        let rest = to_go.of_node(NodeId(node))?;
        let away = target.at - from.at;
        let run_m = away.norm();
        let (hopper, g) = (self.test.hopper(), self.test.gravity_m_s2());
        if run_m <= self.place_rounding_m {
            return None;
        }
        let sight = LineOfSight::new(run_m, target.z_m - from.z_m);
        let squared = |speed_m_s: f64| tolerant_speed_m_s(speed_m_s) * tolerant_speed_m_s(speed_m_s) * (1.0 + SPEED_TOLERANCE);
        let too_far = g * run_m * sight.min_speed_ratio() > squared(hopper.limits().takeoff_speed_max_m_s)
            || g * run_m * sight.min_speed_ratio_reversed() > squared(hopper.limits().landing_speed_max_m_s);
        if too_far || best.is_some_and(|best| to_go.least_cost(sight, g) + rest >= best) {
            return None;
        }
        let heading = away / run_m;
        let arc = self.arc(to_go, from, &target, sight, heading)?;
        let cost = to_go.options().effort.cost(&arc, 1) + rest;
        if best.is_some_and(|best| cost >= best) {
            return None;
        }
        let across = arc.horizontal_speed_m_s();
        let liftoff = LiftoffVelocity { heading, horizontal_m_s: across, vertical_m_s: across * arc.takeoff_slope() };
        Some((Command::new(liftoff, target), cost))
    }

    /// Where reliability weighs: of the node nearest to a position, the most reliable successor that a hop from the position itself reaches.
    fn reliable_successor(&self, to_go: &CostToGo, from: &MapPosition) -> Option<Command<MapPosition>> {
        if !to_go.weighs_reliability() {
            return None;
        }
        let away2 = |node: &MapPosition| (node.at - from.at).norm_squared();
        let nearest = (0..self.nodes.len()).min_by(|&a, &b| away2(&self.nodes[a]).total_cmp(&away2(&self.nodes[b])))?;
        let mut successors = to_go.reliable_successors(NodeId(nearest)).iter();
        successors.find_map(|node| self.tried(to_go, from, node.index(), None)).map(|(command, _)| command)
    }

    /// The arc to fly to a place, by every limit along the slice to it, the ground in between last; `None` where there is none.
    fn arc(
        &self,
        to_go: &CostToGo,
        from: &MapPosition,
        to: &MapPosition,
        sight: LineOfSight,
        heading: Vector2<f64>,
    ) -> Option<ballistics::Arc> {
        let nominal = self.triangles.nominal();
        let (ahead, before) = (from.at + heading * BESIDE_M, to.at - heading * BESIDE_M);
        let takeoff = self.allowed(self.triangles.at(ahead, nominal)?.1, heading, ahead, Contact::Takeoff)?;
        let landing = self.allowed(self.triangles.at(before, nominal)?.1, heading, before, Contact::Landing)?;
        let mut lofts = self.test.lofts_in_envelope(sight, &takeoff, &landing).ok()?;
        let end_m = sight.run_m() - self.place_rounding_m - BESIDE_M;
        let clearance_m = self.test.hopper().limits().clearance_m;
        let ends = (ChainPoint::new(0.0, from.z_m), ChainPoint::new(sight.run_m(), to.z_m));
        let mut reached_m = 0.0;
        for span in self.triangles.walk(from.at, heading, nominal) {
            reached_m = span.to_m;
            if reached_m >= end_m {
                break;
            }
            if reached_m > BESIDE_M {
                let crossing = ChainPoint::new(span.to_m, span.to_z_m);
                lofts.lower = lofts.lower.max(limits::clearing_loft(ends.0, ends.1, crossing, clearance_m));
                if lofts.is_empty() {
                    return None;
                }
            }
        }
        // A walk that ends before has met no-data.
        (reached_m >= end_m)
            .then(|| ballistics::Arc::new(sight, to_go.options().takeoff.loft(sight, lofts), self.test.gravity_m_s2()))
    }

    /// How far off its aim, ahead and across, an arc may pass and still land on it.
    fn aimed_at(
        &self,
        from: &MapPosition,
        liftoff: &LiftoffVelocity,
        aim: &MapPosition,
        slope: f64,
        curvature: f64,
    ) -> Option<Aimed> {
        let away = aim.at - from.at;
        let run_m = away.dot(&liftoff.heading);
        let rise_m = aim.z_m - from.z_m;
        let top_m = liftoff.vertical_m_s * liftoff.vertical_m_s / (2.0 * self.test.gravity_m_s2());
        let slack_m = PLACE_TOLERANCE * (run_m + top_m + rise_m.abs()) + self.place_rounding_m;
        let across_m = liftoff.heading.perp(&away).abs();
        let steepness = 1.0 + (slope - 2.0 * curvature * run_m).abs();
        let over_m = run_m * (slope - curvature * run_m) - rise_m;
        let height_slack_m = slack_m * steepness + self.height_rounding_m;
        let hits = run_m > 0.0 && across_m <= slack_m && over_m.abs() <= height_slack_m && self.realization.heights.is_none();
        hits.then_some(Aimed { run: run_m, slack: slack_m, height_slack: height_slack_m })
    }
}

/// A landing point that a flight passes as closely as rounding allows, all in m.
#[derive(Clone, Copy)]
struct Aimed {
    run: f64,
    slack: f64,
    height_slack: f64,
}

impl Ground for DemGround<'_> {
    type Position = MapPosition;
    type SupportFacet = Gradient;

    fn realize(&mut self, realization: Realization) {
        self.realization = realization;
    }

    fn real(&self, planned: MapPosition) -> MapPosition {
        if self.realization.heights.is_none() {
            return planned;
        }
        self.triangles.at(planned.at, self.heights()).map_or(planned, |(z_m, _)| MapPosition { z_m, ..planned })
    }

    fn point(&self, position: &MapPosition) -> Point3<f64> {
        Point3::new(position.at.x, position.at.y, position.z_m)
    }

    fn holds_takeoff(&self, from: &MapPosition, liftoff: &LiftoffVelocity) -> bool {
        let Some(gradient) = self.facet_ahead(from.at, liftoff.heading) else {
            // Beyond the edge of the known ground: nothing is known against it.
            return true;
        };
        let ahead = from.at + liftoff.heading * BESIDE_M;
        if self.is_kept_out(ahead) {
            return false;
        }
        let friction = self.friction(ahead);
        if !self.rests(gradient, friction) {
            return false;
        }
        match (friction, self.stated(gradient, liftoff.heading)) {
            (Some(friction), _) => holds_on(gradient, friction, velocity(liftoff), ANGLE_TOLERANCE_RAD),
            (None, Some(stated)) => holds(Ok(stated.takeoff), liftoff),
            (None, None) => false,
        }
    }

    fn fly(&self, from: &MapPosition, liftoff: &LiftoffVelocity, aim: &MapPosition) -> Flight<MapPosition, Gradient> {
        let g = self.test.gravity_m_s2();
        let across = liftoff.horizontal_m_s;
        let (slope, curvature) = (liftoff.vertical_m_s / across, g / (2.0 * across * across));
        let mut last = FacetSpan { from_m: 0.0, to_m: 0.0, from_z_m: from.z_m, to_z_m: from.z_m, gradient: Gradient::zeros() };
        if !(curvature.is_finite() && slope.is_finite()) {
            // Straight up, and down where it began.
            let time_s = (2.0 * liftoff.vertical_m_s / g).max(0.0);
            return Flight { end: *from, support_facet: self.facet_ahead(from.at, liftoff.heading), time_s };
        }
        let aimed = self.aimed_at(from, liftoff, aim, slope, curvature);
        let mut over_m = 0.0;
        for span in self.triangles.walk(from.at, liftoff.heading, self.heights()) {
            if let Some(aimed) = aimed
                && span.to_m >= aimed.run - aimed.slack
            {
                return Flight { end: *aim, support_facet: Some(span.gradient), time_s: aimed.run / across };
            }
            if span.to_m == span.from_m {
                continue;
            }
            let ground = span.gradient.dot(&liftoff.heading);
            // The first facet passes through the take-off itself, whatever the rounding of its posts' plane.
            let over_next_m = if last.to_m == 0.0 {
                span.to_m * ((slope - ground) - curvature * span.to_m)
            } else {
                (from.z_m - span.to_z_m) + span.to_m * (slope - curvature * span.to_m)
            };
            if over_next_m <= 0.0 && aimed.is_none_or(|aimed| over_next_m < -aimed.height_slack) {
                let climb = slope - 2.0 * curvature * span.from_m - ground;
                let further_m = comes_down_m(over_m, climb, curvature).min(span.to_m - span.from_m);
                let distance_m = span.from_m + further_m;
                let end = if distance_m == 0.0 {
                    *from
                } else {
                    let share = further_m / (span.to_m - span.from_m);
                    let z_m = span.from_z_m + (span.to_z_m - span.from_z_m) * share;
                    MapPosition { at: from.at + liftoff.heading * distance_m, z_m }
                };
                return Flight { end, support_facet: Some(span.gradient), time_s: distance_m / across };
            }
            over_m = over_next_m.max(0.0);
            last = span;
        }
        let end = MapPosition { at: from.at + liftoff.heading * last.to_m, z_m: last.to_z_m };
        Flight { end, support_facet: None, time_s: last.to_m / across }
    }

    fn landing_failure(&self, end: &MapPosition, support_facet: &Gradient, touchdown: &TouchdownState) -> Option<TrialOutcome> {
        let flown_over = end.at - touchdown.heading * BESIDE_M;
        if self.is_kept_out(flown_over) {
            return Some(TrialOutcome::Lost);
        }
        if touchdown.is_over(self.test.hopper().limits().landing_speed_max_m_s) {
            return Some(TrialOutcome::Damaged);
        }
        let friction = self.friction(flown_over);
        if !self.rests(*support_facet, friction) {
            return Some(TrialOutcome::SlidAtLanding);
        }
        match (friction, self.stated(*support_facet, touchdown.heading)) {
            (Some(friction), _) => {
                let back = -nalgebra::Vector3::new(
                    touchdown.heading.x * touchdown.horizontal_m_s,
                    touchdown.heading.y * touchdown.horizontal_m_s,
                    touchdown.vertical_m_s,
                );
                (!holds_on(*support_facet, friction, back, touchdown.angle_tolerance_rad)).then_some(TrialOutcome::SlidAtLanding)
            }
            (None, Some(stated)) => failure(Ok(stated.landing), self.test.hopper().limits().landing_speed_max_m_s, touchdown),
            (None, None) => Some(TrialOutcome::SlidAtLanding),
        }
    }

    fn displaced(&self, from: &MapPosition, heading: Vector2<f64>, along_m: f64, left_m: f64) -> Result<MapPosition, TrialOutcome> {
        if along_m == 0.0 && left_m == 0.0 {
            return Ok(*from);
        }
        let left = Vector2::new(-heading.y, heading.x);
        let at = from.at + heading * along_m + left * left_m;
        let (z_m, gradient) = self.triangles.at(at, self.heights()).ok_or(TrialOutcome::Lost)?;
        if self.is_kept_out(at) {
            return Err(TrialOutcome::Lost);
        }
        if self.rests(gradient, self.friction(at)) { Ok(MapPosition { at, z_m }) } else { Err(TrialOutcome::SlidAtLanding) }
    }

    fn believed(&self, position: &MapPosition, along_m: f64, across_m: f64) -> Option<MapPosition> {
        if along_m == 0.0 && across_m == 0.0 && self.realization.heights.is_none() {
            return Some(*position);
        }
        self.nominal(position.at + Vector2::new(along_m, across_m))
    }

    fn replanned(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        let to_go = self.to_go?;
        if let Some(reliable) = self.reliable_successor(to_go, believed) {
            return Some(reliable);
        }
        let mut best: Option<(Command<MapPosition>, Cost)> = None;
        for node in to_go.in_order() {
            let known = best.as_ref().map(|(_, cost)| *cost);
            let rest = to_go.of_node(*node)?;
            if known.is_some_and(|known| Cost::of_hops(1) + rest >= known) {
                // The nodes that follow have no less to go.
                break;
            }
            if let Some(better) = self.tried(to_go, believed, node.index(), known) {
                best = Some(better);
            }
        }
        best.map(|(command, _)| command)
    }
}

fn velocity(liftoff: &LiftoffVelocity) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::new(
        liftoff.heading.x * liftoff.horizontal_m_s,
        liftoff.heading.y * liftoff.horizontal_m_s,
        liftoff.vertical_m_s,
    )
}

/// Whether a facet of a gradient, with such friction, holds a direction away from it.
///
/// ```text
///     |v - (n . v) n| <= mu (n . v)
/// ```
///
/// The friction cone itself, where a slice has its cut by the plane of travel.
fn holds_on(gradient: Gradient, friction: f64, away: nalgebra::Vector3<f64>, tolerance_rad: f64) -> bool {
    let normal = nalgebra::Vector3::new(-gradient.x, -gradient.y, 1.0);
    let upward = normal.dot(&away);
    // |n x v| is the length of n times the part of v along the facet.
    let along2 = normal.cross(&away).norm_squared();
    let friction = friction + tolerance_rad * (1.0 + friction * friction);
    upward > 0.0 && along2 <= (friction * upward) * (friction * upward)
}
