//! A mesh as a ground: caves, overhangs and ceilings, with the exact set of collision-free arcs between two contacts.
//!
//! ```text
//!          ______ ceiling          The vertical plane of the hop cuts the mesh in segments. Through every point of the plane between
//!       . - ^ - .                  the contacts passes exactly one arc, so a segment blocks one interval of lofts, in closed form
//!     .' ~~~~~~~ '.                ([`blocked_lofts`](crate::ballistics::limits::blocked_lofts)). What all other limits allow, less
//!    /  .-'^|^'-.  \               the union of these intervals, are the windows: none is missed, and each end has its facet.
//!   t_.'____|____'._l  ground
//! ```
//!
//! Facets are obstacles on both sides. Their outer side, from the order of their corners, matters where a contact is: a hop leaves and
//! arrives on that side. Where several facets meet at a contact, the strictest rules.
//!
//! Source: Campana and Laumond 2016, *Ballistic motion planning*, who sample angles of the arcs and check them one by one; the windows
//! are the closed form of what they sample.

mod ball;
mod beam;
mod blocked;
mod contact;
mod face_surfaces;
mod flight;
mod hold;
mod room;
mod surface;
mod takeoff_set;

pub use ball::BALL_STAND_OFF;
pub use blocked::BlockedSpan;
pub use contact::{MeshContact, MeshContactFacet, NoMeshContact};
pub use face_surfaces::UnknownGroup;
pub use surface::MeshPosition;
pub use takeoff_set::{MeshConflict, MeshTakeoffSet, MeshWindow, MeshWindowEnd};

use std::{ops::ControlFlow, sync::Arc};

use nalgebra::Vector2;

use crate::{
    ballistics::{
        FlightEnvelope, LineOfSight, PathBounds,
        limits::{blocked_lofts, blocked_lofts_of_ball},
    },
    chain::{ConstraintProblem, FacetGround, facet_constraints},
    quantity::{ChainPoint, FacetId, SlopeInterval},
    terrain::{MeshTree, VerticalPlane},
    world::{Derating, FaceGroups, Gravity, Hopper, SurfaceProperties},
};
pub(super) use blocked::BlockedLofts;
use face_surfaces::{FaceSurface, surfaces};
pub(super) use room::LeastRoom;

/// A mesh with the hopper, gravity and the surface: all that a hop between two of its points depends on. A clone shares the mesh.
#[derive(Clone, Debug)]
pub struct MeshGround {
    tree: Arc<MeshTree>,
    envelope: FlightEnvelope,
    surface: SurfaceProperties,
    /// What the greatest speeds allow.
    speed_bounds: PathBounds,
    /// Added to every coefficient of friction in the flights of a trial.
    friction_error: f64,
    /// How far contacts stand off the surface, m.
    stand_off_m: f64,
    /// Of every kind of face.
    faces: Arc<[FaceSurface]>,
    /// What a scenario names.
    groups: Arc<FaceGroups>,
}

/// The course of a hop between two contacts of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshCourse {
    /// The plane of the hop, with its origin in the take-off.
    pub plane: VerticalPlane,
    /// The line of sight in that plane.
    pub sight: LineOfSight,
}

/// Buffers of the windows of one hop after another.
#[derive(Clone, Debug, Default)]
pub struct MeshBuffers {
    pub(super) blocked: BlockedLofts,
    pub(super) free: Vec<SlopeInterval>,
}

impl MeshGround {
    /// The ground of a mesh for a hopper and gravity, with what its file states of its faces; for groups that a scenario names, see
    /// [`with_groups`](Self::with_groups).
    ///
    /// # Errors
    /// [`ConstraintProblem`], where the surface states no grip, or the hopper no speeds.
    pub fn new(
        tree: impl Into<Arc<MeshTree>>,
        hopper: &Hopper,
        gravity: Gravity,
        surface: &SurfaceProperties,
    ) -> Result<Self, ConstraintProblem> {
        surface.check()?;
        let level = nalgebra::Vector3::z();
        facet_constraints(level, Vector2::x(), FacetGround::default(), hopper, gravity, surface)?;
        let tree: Arc<MeshTree> = tree.into();
        let faces = surfaces(tree.mesh().faces(), surface, &FaceGroups::new(), &Derating::NONE);
        let envelope = FlightEnvelope::new(hopper, gravity);
        let limits = hopper.limits();
        let speed_bounds = PathBounds::new(limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s(), gravity.m_s2());
        let (surface, groups) = (*surface, Arc::default());
        Ok(Self { tree, envelope, surface, speed_bounds, friction_error: 0.0, stand_off_m: 0.0, faces, groups })
    }

    /// The mesh.
    pub fn tree(&self) -> &MeshTree {
        &self.tree
    }

    /// The flight envelope of the hopper under its gravity.
    pub const fn envelope(&self) -> &FlightEnvelope {
        &self.envelope
    }

    /// The surface.
    pub const fn surface(&self) -> &SurfaceProperties {
        &self.surface
    }

    /// Whether two contacts are one place, within the resolution of the mesh: from the one to the other no hop is needed.
    pub fn are_one_place(&self, [a, b]: [&MeshContact; 2]) -> bool {
        (b.point_m() - a.point_m()).norm() <= self.tree.resolution_m()
    }

    /// Lower bounds on paths from the greatest speeds alone.
    pub const fn speed_bounds(&self) -> PathBounds {
        self.speed_bounds
    }

    /// The course from one contact to another; `None` where one is right over the other: a vertical hop has no plane.
    pub fn course(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<MeshCourse> {
        let away = landing.point_m() - takeoff.point_m();
        // Coordinates are far from where a square overflows, and shorter runs than a square resolves are no hops.
        let run_m = (away.x * away.x + away.y * away.y).sqrt();
        if run_m <= self.tree.resolution_m() {
            return None;
        }
        let heading = away.xy() / run_m;
        // The slope of a facet has more digits than the difference of two heights on it.
        // (Places that stand off edges, or not equally far, are not over one facet.)
        let is_alike = takeoff.stand_off_m() == landing.stand_off_m();
        let is_on_one = takeoff.stand_off_m() == 0.0 || (takeoff.facets().len() == 1 && landing.facets().len() == 1);
        let over = |facet: &&MeshContactFacet| is_alike && is_on_one && facet.normal.z > 0.0 && landing.touches(facet.id);
        let shared = takeoff.facets().iter().find(over);
        let sight = match shared {
            Some(facet) => LineOfSight::along(run_m, (-facet.normal.xy() / facet.normal.z).dot(&heading)),
            None => LineOfSight::new(run_m, away.z),
        };
        Some(MeshCourse { plane: VerticalPlane { origin: takeoff.point_m(), heading }, sight })
    }

    /// The feasible windows of one hop, as lofts over its line of sight, ascending and disjoint; none if no arc is feasible, and `None`
    /// for a vertical hop.
    ///
    /// The limits that need no terrain are tested first, the greatest speeds before all others; the cut ends as soon as nothing is left. Without
    /// windows the line of sight may differ from that of the [`course`](Self::course) in its last bits.
    pub fn windows<'a>(
        &self,
        takeoff: &MeshContact,
        landing: &MeshContact,
        buffers: &'a mut MeshBuffers,
    ) -> Option<(LineOfSight, &'a [SlopeInterval])> {
        let MeshBuffers { blocked, free } = buffers;
        free.clear();
        // Most pairs of a roadmap end here.
        let away = landing.point_m() - takeoff.point_m();
        if !self.speed_bounds.span(away.norm(), away.z) {
            let run_m = away.xy().norm();
            return (run_m > self.tree.resolution_m()).then(|| (LineOfSight::new(run_m, away.z), &[][..]));
        }
        let (course, within) = self.beam(takeoff, landing)?;
        if within.is_empty() {
            return Some((course.sight, &[]));
        }
        self.block(&course, [takeoff, landing], within, blocked);
        let (speeds, gravity) = (self.envelope.takeoff_speeds(), self.envelope.gravity_m_s2());
        for part in blocked.free_in(within) {
            free.extend(speeds.windows(course.sight, part.lofts, gravity).map(|window| window.lofts));
        }
        Some((course.sight, free))
    }

    /// Cuts the mesh between two contacts: which lofts of an interval its facets block. The cut ends where they block all.
    fn block(&self, course: &MeshCourse, ends: [&MeshContact; 2], within: SlopeInterval, blocked: &mut BlockedLofts) {
        blocked.clear();
        let shared = std::cell::RefCell::new(blocked);
        let enters = |rectangle| self.may_block(course, rectangle, within, &shared.borrow());
        let insert = |facet, lofts| {
            let mut blocked = shared.borrow_mut();
            blocked.insert(lofts, facet);
            if blocked.covers(within) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let _ = match self.radius_m() {
            0.0 => {
                self.tree.cut(&course.plane, enters, |facet, segment| insert(facet, self.blocked_by(course, ends, facet, segment)))
            }
            radius_m => self.tree.slab(&course.plane, radius_m, enters, |facet, part| {
                let clearance = self.envelope.clearance();
                insert(facet, blocked_lofts_of_ball(course.sight, part.corners(), radius_m, clearance))
            }),
        };
    }

    /// The lofts that the part of a facet in the plane of a hop blocks.
    fn blocked_by(
        &self,
        course: &MeshCourse,
        [takeoff, landing]: [&MeshContact; 2],
        facet: FacetId,
        segment: [ChainPoint; 2],
    ) -> SlopeInterval {
        let (run_m, near_m) = (course.sight.run_m(), self.tree.resolution_m());
        let over_sight = |point: ChainPoint| ChainPoint::new(point.x_m, point.z_m - course.sight.slope() * point.x_m);
        let [mut from, mut to] = segment.map(over_sight);
        if from.x_m > to.x_m {
            std::mem::swap(&mut from, &mut to);
        }
        if to.x_m <= near_m || from.x_m >= run_m - near_m {
            return SlopeInterval::EMPTY;
        }
        let at = |x_m: f64| ChainPoint::new(x_m, from.z_m + (to.z_m - from.z_m) * ((x_m - from.x_m) / (to.x_m - from.x_m)));
        let [mut begin, mut end] = [from, to];
        if from.x_m < near_m {
            begin = if from.x_m < 0.0 { at(0.0) } else { ChainPoint::new(0.0, from.z_m) };
        }
        if to.x_m > run_m - near_m {
            end = if to.x_m > run_m { at(run_m) } else { ChainPoint::new(run_m, to.z_m) };
        }
        // A facet that one stands on passes through the contact itself, not beside it by the rounding of a crossing. (The border of one
        // that lies in the plane as a whole may pass elsewhere.)
        let steepness = 1.0 + ((to.z_m - from.z_m) / (to.x_m - from.x_m)).abs();
        let on_contact = |point: ChainPoint| point.z_m.abs() <= near_m * steepness;
        let left = takeoff.facet(facet).filter(|_| begin.x_m == 0.0 && on_contact(begin));
        let right = landing.facet(facet).filter(|_| end.x_m == run_m && on_contact(end));
        if left.is_some() {
            begin.z_m = 0.0;
        }
        if right.is_some() {
            end.z_m = 0.0;
        }
        let mut lofts = blocked_lofts(run_m, [begin, end], self.envelope.clearance());
        // What starts or ends behind a facet that one stands on flies through the ground.
        for facet in [left, right].into_iter().flatten() {
            if facet.normal.z > 0.0 {
                lofts.lower = f64::NEG_INFINITY;
            } else if facet.normal.z < 0.0 {
                lofts.upper = f64::INFINITY;
            }
        }
        lofts
    }

    /// Whether a part of the mesh within a rectangle of the plane of a hop may block lofts of an interval that are not blocked yet.
    pub(super) fn may_block(
        &self,
        course: &MeshCourse,
        [low, high]: [ChainPoint; 2],
        within: SlopeInterval,
        blocked: &BlockedLofts,
    ) -> bool {
        let run_m = course.sight.run_m();
        let (from_m, to_m) = (low.x_m.max(0.0), high.x_m.min(run_m));
        if from_m > to_m {
            return false;
        }
        let eps_m = self.envelope.clearance().height_m();
        let edge = |z_m: f64| [from_m, to_m].map(|x_m| ChainPoint::new(x_m, z_m - course.sight.slope() * x_m));
        let none = crate::ballistics::limits::ClearanceProfile::NONE;
        let upper = blocked_lofts(run_m, edge(high.z_m + eps_m), none).upper;
        if upper < within.lower {
            return false;
        }
        let lower = blocked_lofts(run_m, edge(low.z_m - eps_m), none).lower;
        lower <= within.upper && !blocked.covers(SlopeInterval { lower: lower.max(within.lower), upper: upper.min(within.upper) })
    }
}
