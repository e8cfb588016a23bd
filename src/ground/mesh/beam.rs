//! The beam of arcs between two contacts, and a ball along one of them: what a search that samples arcs asks for.

use nalgebra::{Vector2, Vector3};

use super::{MeshContact, MeshContactFacet, MeshCourse, MeshGround};
use crate::{
    ballistics::Arc,
    quantity::SlopeInterval,
    world::{Contact, FrictionCone},
};

impl MeshGround {
    /// The course of a hop and its beam: the lofts that all limits leave, before the mesh is cut and but for speeds that the machine can
    /// only take off with; empty if they leave none, and `None` for a vertical hop.
    #[inline]
    pub fn beam(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<(MeshCourse, SlopeInterval)> {
        let course = self.course(takeoff, landing)?;
        let heading = course.plane.heading;
        let from = self.limits(takeoff, heading, Contact::Takeoff);
        let Some((from, to)) = from.and_then(|from| Some((from, self.limits(landing, heading, Contact::Landing)?))) else {
            return Some((course, SlopeInterval::EMPTY));
        };
        let lofts = self.envelope().lofts(course.sight, from, to);
        if lofts.is_empty() || lofts.upper <= 0.0 {
            return Some((course, SlopeInterval::EMPTY));
        }
        Some((course, SlopeInterval { lower: lofts.lower.max(0.0), upper: lofts.upper }))
    }

    /// The least of the cuts of the friction cones at a contact by the vertical plane of a heading, as the square of the tangent of half the
    /// angle of the cut; infinite where angles are stated instead, and negative where the plane misses a cone.
    ///
    /// ```text
    ///     tan^2 delta = (1 + mu^2) ((n . e)^2 + nz^2) - 1
    /// ```
    pub fn cone_cut(&self, contact: &MeshContact, heading: Vector2<f64>) -> f64 {
        let cut = |facet: &MeshContactFacet| {
            let along = facet.normal.x * heading.x + facet.normal.y * heading.y;
            let friction = self.friction_of(facet.id).map(FrictionCone::coefficient);
            friction.map_or(f64::INFINITY, |mu| (1.0 + mu * mu) * (along * along + facet.normal.z * facet.normal.z) - 1.0)
        };
        contact.facets().iter().map(cut).fold(f64::INFINITY, f64::min)
    }

    /// Whether a ball of a radius meets the mesh at one of the points of an arc that are evenly spaced in horizontal distance, as many as
    /// its length has steps, take-off and landing included.
    ///
    /// Between two points the ball is not looked at: where an arc is steep they are farther apart than a step, and it may pass through an
    /// edge unseen.
    pub fn ball_meets(&self, course: &MeshCourse, arc: &Arc, radius_m: f64, step_m: f64) -> bool {
        let steps = (arc.length_m() / step_m).ceil().max(1.0);
        let (origin, heading) = (course.plane.origin, course.plane.heading);
        let mut number = 0.0;
        while number <= steps {
            let along_m = course.sight.run_m() * (number / steps);
            let away = Vector3::new(heading.x * along_m, heading.y * along_m, arc.height_at_m(along_m));
            if self.tree().meets_ball(origin + away, radius_m) {
                return true;
            }
            number += 1.0;
        }
        false
    }
}
