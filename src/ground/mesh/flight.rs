//! Flights in three dimensions, to the first triangle of a mesh that they meet.
//!
//! ```text
//!     n . (p + v t - g t^2 / 2 z - a) = 0          a quadratic in t for the plane of every triangle, its point a and normal n
//! ```
//!
//! A root counts where the point lies in the triangle. The tree of boxes leaves out parts of the mesh that the arc does not pass before
//! the first root found.

use std::cell::Cell;

use nalgebra::{Point3, Vector2, Vector3};

use super::{MeshGround, MeshPosition};
use crate::{
    ballistics::plane_times_s,
    chain::contains_straight_down,
    ground::{
        FirstContact, Flight, LiftoffVelocity, Realization, Surface, TouchdownState, Triangulated,
        dem_flight::holds_on,
        first_contact::{ANGLE_TOLERANCE_RAD, ContactFailure, PLACE_TOLERANCE, check_landing, holds},
        rest::rest_slope,
    },
    quantity::{ChainPoint, FacetId},
    terrain::VerticalPlane,
    world::{Contact, Direction},
};

/// An arc of a flight.
#[derive(Clone, Copy, Debug)]
struct Arc {
    from: Point3<f64>,
    velocity_m_s: Vector3<f64>,
    gravity_m_s2: f64,
}

impl Arc {
    fn at(&self, time_s: f64) -> Point3<f64> {
        let fall_m = 0.5 * self.gravity_m_s2 * time_s * time_s;
        self.from + self.velocity_m_s * time_s - Vector3::new(0.0, 0.0, fall_m)
    }

    /// The times within others at which it is between two values of a horizontal coordinate.
    fn within(&self, axis: usize, (low, high): (f64, f64), (from_s, to_s): (f64, f64)) -> Option<(f64, f64)> {
        let (begin, speed) = (self.from[axis], self.velocity_m_s[axis]);
        if speed == 0.0 {
            return (low <= begin && begin <= high).then_some((from_s, to_s));
        }
        let [a, b] = [low, high].map(|end| (end - begin) / speed);
        let (from_s, to_s) = (from_s.max(a.min(b)), to_s.min(a.max(b)));
        (from_s <= to_s).then_some((from_s, to_s))
    }

    /// Whether it may meet a box before a time.
    fn may_meet(&self, low: Point3<f64>, high: Point3<f64>, margin_m: f64, before_s: f64) -> bool {
        let wide = |axis: usize| (low[axis] - margin_m, high[axis] + margin_m);
        let times = self.within(0, wide(0), (0.0, before_s)).and_then(|times| self.within(1, wide(1), times));
        let Some((from_s, to_s)) = times else { return false };
        let (begin_m, end_m) = (self.at(from_s).z, self.at(to_s).z);
        let top_s = self.velocity_m_s.z / self.gravity_m_s2;
        let top_m = if from_s < top_s && top_s < to_s { self.at(top_s).z } else { begin_m.max(end_m) };
        top_m >= low.z - margin_m && begin_m.min(end_m) <= high.z + margin_m
    }
}

impl MeshGround {
    /// The coefficient of friction of a facet in this trial; `None` where angles are stated instead.
    fn friction_now(&self, facet: FacetId) -> Option<f64> {
        self.friction_of(facet).map(|cone| (cone.coefficient() + self.friction_error).max(0.0))
    }

    /// Whether the hopper rests on a facet.
    fn rests(&self, facet: FacetId) -> Result<(), ContactFailure> {
        let normal = self.outer_normal(facet);
        let holds = rest_slope(self.face_surface(facet).surface.rest, self.friction_now(facet))
            .is_none_or(|max| normal.z > 0.0 && normal.xy().norm() <= normal.z * (max + ANGLE_TOLERANCE_RAD * (1.0 + max * max)));
        if holds { Ok(()) } else { Err(ContactFailure::Slides) }
    }

    fn is_kept_out(&self, facet: FacetId) -> bool {
        self.face_surface(facet).ground.keep_out
    }

    /// Whether a facet holds a take-off.
    fn holds_on_facet(&self, facet: FacetId, liftoff: &LiftoffVelocity) -> bool {
        if self.is_kept_out(facet) || self.rests(facet).is_err() {
            return false;
        }
        match self.friction_now(facet) {
            Some(friction) => holds_on(self.outer_normal(facet), friction, velocity(liftoff), ANGLE_TOLERANCE_RAD),
            None => self
                .constraints_of(facet, liftoff.heading)
                .is_some_and(|stated| holds(stated.check_contact(Contact::Takeoff, Direction::Forward), liftoff)),
        }
    }

    /// Whether a facet holds a landing.
    fn check_facet(&self, facet: FacetId, touchdown: &TouchdownState) -> Result<(), ContactFailure> {
        let limits = self.hopper().limits();
        if self.is_kept_out(facet) {
            return Err(ContactFailure::OffLimits);
        }
        if touchdown.is_over(limits.arc_landing_speed_max_m_s()) {
            return Err(ContactFailure::TooFast);
        }
        self.rests(facet)?;
        let Some(friction) = self.friction_now(facet) else {
            let stated = self.constraints_of(facet, touchdown.heading).ok_or(ContactFailure::Slides)?;
            if limits.landing.brakes() {
                let line = stated.stated(Direction::Forward).filter(|line| contains_straight_down(line.landing.angles()));
                return line.map(|_| ()).ok_or(ContactFailure::Slides);
            }
            let rule = stated.check_contact(Contact::Landing, Direction::Forward);
            return check_landing(rule, limits.arc_landing_speed_max_m_s(), touchdown);
        };
        let across = touchdown.heading * touchdown.horizontal_m_s;
        let push = if limits.landing.brakes() { Vector3::z() } else { -Vector3::new(across.x, across.y, touchdown.vertical_m_s) };
        let held = holds_on(self.outer_normal(facet), friction, push, touchdown.angle_tolerance_rad);
        if held { Ok(()) } else { Err(ContactFailure::Slides) }
    }

    /// The time at which an arc first meets a facet, before another time. `stands_on`: whether it takes off from the facet.
    fn meets_s(&self, arc: &Arc, facet: FacetId, corners: &[Point3<f64>; 3], stands_on: bool, before_s: f64) -> Option<f64> {
        let normal = self.outer_normal(facet);
        let climb = normal.dot(&arc.velocity_m_s);
        let pull = -0.5 * arc.gravity_m_s2 * normal.z;
        if stands_on {
            // It leaves the facet, and comes down on it again where the facet faces up.
            let again_s = if climb < 0.0 { 0.0 } else { -climb / pull };
            return (again_s >= 0.0 && again_s < before_s && (climb < 0.0 || self.is_in(arc.at(again_s), corners, normal)))
                .then_some(again_s);
        }
        let over_m = (arc.from - corners[0]).dot(&normal);
        let meets = |time_s: &f64| *time_s > 0.0 && *time_s < before_s && self.is_in(arc.at(*time_s), corners, normal);
        plane_times_s(over_m, climb, pull).into_iter().filter(meets).reduce(f64::min)
    }

    /// Whether a point of the plane of a facet lies in it, within the resolution of the mesh: so no arc slips through the edge of two.
    fn is_in(&self, point: Point3<f64>, corners: &[Point3<f64>; 3], normal: Vector3<f64>) -> bool {
        (0..3).all(|i| {
            let side = corners[(i + 1) % 3] - corners[i];
            normal.cross(&side).dot(&(point - corners[i])) >= -self.tree.resolution_m() * side.norm()
        })
    }

    /// The time at which an arc is over its aim, if it passes that within rounding, and nothing stands in its way by more than that.
    fn lands_on_aim_s(&self, arc: &Arc, liftoff: &LiftoffVelocity, aim: &MeshPosition) -> Option<f64> {
        let (g, across) = (arc.gravity_m_s2, liftoff.horizontal_m_s);
        let away = aim.point_m - arc.from;
        let run_m = away.xy().dot(&liftoff.heading);
        if !(run_m > 0.0 && across > 0.0) {
            return None;
        }
        let slope = liftoff.vertical_m_s / across;
        let curvature = g / (2.0 * across * across);
        let top_m = liftoff.vertical_m_s * liftoff.vertical_m_s / (2.0 * g);
        let slack_m = PLACE_TOLERANCE * (run_m + top_m + away.z.abs()) + self.position_rounding_m();
        let height_m = |distance_m: f64| distance_m * (slope - curvature * distance_m);
        let steepness = |distance_m: f64| 1.0 + (slope - 2.0 * curvature * distance_m).abs();
        let passes = liftoff.heading.perp(&away.xy()).abs() <= slack_m
            && (height_m(run_m) - away.z).abs() <= slack_m * steepness(run_m) + self.height_rounding_m();
        if !passes {
            return None;
        }
        // A planned arc may graze what bounds its window. It passes over the cut of a facet or under it, within the resolution.
        let near_m = self.tree.resolution_m();
        let plane = VerticalPlane { origin: arc.from, heading: liftoff.heading };
        let stops = |segment: [ChainPoint; 2]| {
            let [from, to] = if segment[1].x_m < segment[0].x_m { [segment[1], segment[0]] } else { segment };
            let (begin_m, end_m) = (from.x_m.max(near_m), to.x_m.min(run_m - near_m));
            if begin_m > end_m {
                return false;
            }
            let ground = (to.z_m - from.z_m) / (to.x_m - from.x_m);
            let level = |x_m: f64| if x_m == to.x_m { to.z_m } else { from.z_m + ground * (x_m - from.x_m) };
            let over = |x_m: f64, z_m: f64| (height_m(x_m) - z_m) / steepness(x_m);
            let parallel_m = ((slope - ground) / (2.0 * curvature)).clamp(begin_m, end_m);
            let ends = [over(begin_m, if begin_m == from.x_m { from.z_m } else { level(begin_m) }), over(end_m, level(end_m))];
            let between = if parallel_m.is_nan() { ends[0] } else { over(parallel_m, level(parallel_m)) };
            let slack_m = slack_m + near_m;
            let [a, b] = ends;
            a.min(b).min(between) < -slack_m && a.max(b).max(between) > slack_m
        };
        let shown = |[low, high]: [ChainPoint; 2]| low.x_m <= run_m && high.x_m >= 0.0;
        let met = self.tree.cut(&plane, shown, |_, segment| {
            if stops(segment) { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) }
        });
        met.is_continue().then_some(run_m / across)
    }

    /// The point of the open surface nearest to a position moved by a vector; `None` where that is covered.
    fn moved(&self, from: &MeshPosition, by: Vector3<f64>) -> Option<MeshPosition> {
        let nearest = self.tree.nearest(from.point_m + by).point;
        self.contact_near(nearest).map(|contact| MeshPosition { point_m: contact.point_m() })
    }
}

impl FirstContact for MeshGround {
    type SupportFacet = FacetId;

    /// Errors of heights are not those of a mesh: a simulation with them is refused.
    fn realize(&mut self, realization: Realization) {
        self.friction_error = realization.friction;
    }

    fn realized(&self, planned: MeshPosition) -> MeshPosition {
        planned
    }

    fn point(&self, position: &MeshPosition) -> Point3<f64> {
        position.point_m
    }

    /// In space: what lies straight under a point of a cave may be far from it.
    fn apart_m(&self, one: &Point3<f64>, other: &Point3<f64>) -> f64 {
        (one - other).norm()
    }

    fn holds_takeoff(&self, from: &MeshPosition, liftoff: &LiftoffVelocity) -> bool {
        self.facets_at(from).into_iter().all(|facet| self.holds_on_facet(facet, liftoff))
    }

    fn first_contact(&self, from: &MeshPosition, liftoff: &LiftoffVelocity, aim: &MeshPosition) -> Flight<MeshPosition, FacetId> {
        let stood_on = self.facets_at(from);
        if liftoff.stays() {
            return Flight { end: *from, support_facet: stood_on.first().copied(), time_s: 0.0 };
        }
        let arc = Arc { from: from.point_m, velocity_m_s: velocity(liftoff), gravity_m_s2: self.gravity_m_s2() };
        if let Some(time_s) = self.lands_on_aim_s(&arc, liftoff, aim) {
            return Flight { end: *aim, support_facet: self.facets_at(aim).first().copied(), time_s };
        }
        let near_m = self.tree.resolution_m();
        let [low, high] = Triangulated::bounds(self);
        // It leaves the box around the mesh at a side, or through its bottom.
        let drop_m = (from.point_m.z - low.z + near_m).max(0.0);
        let (up, g) = (arc.velocity_m_s.z, arc.gravity_m_s2);
        let bottom_s = (up + (up * up + 2.0 * g * drop_m).sqrt()) / g;
        let inside = |axis: usize, times| arc.within(axis, (low[axis] - near_m, high[axis] + near_m), times);
        let left_s = inside(0, (0.0, bottom_s)).and_then(|times| inside(1, times)).map_or(0.0, |(_, to_s)| to_s);
        let first = Cell::new((left_s, None));
        self.tree.visit(
            |low, high| arc.may_meet(low, high, near_m, first.get().0),
            |facet, corners| {
                let (before_s, known) = first.get();
                let over_m = (arc.from - corners[0]).dot(&self.outer_normal(facet));
                let stands_on = over_m.abs() <= near_m && stood_on.contains(&facet);
                // Of facets met at the same time, the first of the mesh.
                let until_s = if known.is_none_or(|known| facet < known) { before_s.next_up() } else { before_s };
                if let Some(time_s) = self.meets_s(&arc, facet, corners, stands_on, until_s) {
                    first.set((time_s, Some(facet)));
                }
            },
        );
        let (time_s, support_facet) = first.get();
        let end = if time_s == 0.0 { *from } else { MeshPosition { point_m: arc.at(time_s) } };
        Flight { end, support_facet, time_s }
    }

    /// On an edge or a corner, all facets that meet there have to hold.
    fn check_landing(&self, end: &MeshPosition, support_facet: &FacetId, touchdown: &TouchdownState) -> Result<(), ContactFailure> {
        self.check_facet(*support_facet, touchdown)?;
        let mut others = self.tree.touching(end.point_m).into_iter().filter(|facet| facet != support_facet);
        others.try_for_each(|facet| self.check_facet(facet, touchdown))
    }

    fn normal(&self, facet: &FacetId) -> Vector3<f64> {
        self.outer_normal(*facet)
    }

    fn check_bounce(&self, _end: &MeshPosition, facet: &FacetId, touchdown: &TouchdownState) -> Result<(), ContactFailure> {
        if self.is_kept_out(*facet) {
            return Err(ContactFailure::OffLimits);
        }
        if touchdown.is_over(self.hopper().limits().landing_speed_max_m_s) { Err(ContactFailure::TooFast) } else { Ok(()) }
    }

    fn check_rest(&self, _position: &MeshPosition, facet: &FacetId, _heading: Vector2<f64>) -> Result<(), ContactFailure> {
        self.rests(*facet)
    }

    /// To the point of the surface nearest to the one displaced horizontally.
    fn displaced(
        &self,
        from: &MeshPosition,
        heading: Vector2<f64>,
        along_m: f64,
        left_m: f64,
    ) -> Result<MeshPosition, ContactFailure> {
        if along_m == 0.0 && left_m == 0.0 {
            return Ok(*from);
        }
        let by = heading * along_m + Vector2::new(-heading.y, heading.x) * left_m;
        let position = self.moved(from, Vector3::new(by.x, by.y, 0.0)).ok_or(ContactFailure::OffLimits)?;
        for facet in self.facets_at(&position) {
            if self.is_kept_out(facet) {
                return Err(ContactFailure::OffLimits);
            }
            self.rests(facet)?;
        }
        Ok(position)
    }

    /// The point of the surface nearest to the position with its errors, east and north.
    fn believed(&self, position: &MeshPosition, along_m: f64, across_m: f64) -> Option<MeshPosition> {
        if along_m == 0.0 && across_m == 0.0 {
            return Some(*position);
        }
        self.moved(position, Vector3::new(along_m, across_m, 0.0))
    }
}

fn velocity(liftoff: &LiftoffVelocity) -> Vector3<f64> {
    let across = liftoff.heading * liftoff.horizontal_m_s;
    Vector3::new(across.x, across.y, liftoff.vertical_m_s)
}
