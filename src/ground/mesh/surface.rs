//! A mesh as a ground among others: the facts that the checker and trials ask for.

use std::sync::Arc;

use nalgebra::{Point3, Vector2, Vector3};

use super::{BALL_STAND_OFF, MeshContact, MeshGround};
use crate::{
    chain::{ConstraintProblem, SegmentConstraints},
    ground::{ContactPoint, Facet, Frame, Hold, Side, Surface, TakeoffWindows, Triangulated, Windows, rest::rest_slope},
    quantity::FacetId,
    world::{Contact, Direction, FrictionCone, Gravity, Hopper, SurfaceProperties},
};

/// A point of the surface of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPosition {
    /// The point, m.
    pub point_m: Point3<f64>,
}

impl From<&MeshContact> for MeshPosition {
    fn from(contact: &MeshContact) -> Self {
        Self { point_m: contact.point_m() }
    }
}

impl MeshContact {
    /// The contact as a point of a journey, at a distance along it.
    pub fn at_m(&self, along_m: f64) -> ContactPoint {
        ContactPoint::on_map(along_m, self.point_m().xy(), self.point_m().z)
    }
}

/// Rounding error of a coordinate on a facet (from the shares of its corners and a sum), in units in the last place of the coordinate that
/// is farthest from 0.
const COORDINATE_ULPS: f64 = 16.0;

impl MeshGround {
    /// The same ground, whose contacts stand off the surface by a distance along the normal, m.
    #[must_use]
    pub fn standing_off(self, stand_off_m: f64) -> Self {
        Self { stand_off_m, ..self }
    }

    /// The same mesh under other limits, with the whole friction of its groups.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn under(&self, hopper: &Hopper, gravity: Gravity, surface: &SurfaceProperties) -> Result<Self, ConstraintProblem> {
        let bare = Self::new(Arc::clone(&self.tree), hopper, gravity, surface)?;
        Ok(bare.with_groups_of(self).standing_off(self.stand_off_m))
    }

    /// The facets that rule a position: those that meet there, or at the point of the surface that it stands off.
    pub(super) fn facets_at(&self, position: &MeshPosition) -> Vec<FacetId> {
        let met = self.tree.touching(position.point_m);
        if met.is_empty() { self.tree.touching(self.tree.nearest(position.point_m).point) } else { met }
    }

    /// The contact nearest to a point; `None` where it is covered, or has no room to stand off.
    pub(crate) fn contact_near(&self, point_m: Point3<f64>) -> Option<MeshContact> {
        self.stood_off(&self.contact(point_m).ok()?, self.stand_off_m)
    }

    /// The friction of a facet; `None` where angles are stated instead.
    pub(in crate::ground) fn friction_of(&self, facet: FacetId) -> Option<FrictionCone> {
        let face = self.face_surface(facet);
        face.ground.friction.or_else(|| face.surface.constant_friction())
    }

    /// The constraints of a facet for a direction of travel.
    pub(super) fn constraints_of(&self, facet: FacetId, heading: Vector2<f64>) -> Option<SegmentConstraints> {
        self.constraints(facet, self.tree.normal(facet).into_inner(), heading)
    }

    /// How far contacts stand off the surface at most, m: a ball farther than it would lie on it.
    fn standing_off_m(&self) -> f64 {
        self.stand_off_m.max(BALL_STAND_OFF * self.radius_m())
    }

    /// The greatest rounding error of a coordinate of a point on a facet, m.
    fn coordinate_rounding_m(&self) -> f64 {
        let [low, high] = self.bounds();
        COORDINATE_ULPS * f64::EPSILON * low.coords.amax().max(high.coords.amax())
    }
}

impl Surface for MeshGround {
    type Contact = MeshPosition;

    fn hopper(&self) -> &Hopper {
        self.envelope.hopper()
    }

    fn gravity(&self) -> Gravity {
        self.envelope.gravity()
    }

    /// A point of a mesh has no distance along a journey: the distance is 0.
    fn contact_point(&self, position: &MeshPosition) -> ContactPoint {
        ContactPoint::on_map(0.0, position.point_m.xy(), position.point_m.z)
    }

    /// A point within the resolution of the surface, or that far from where contacts stand off it, is a contact as it is.
    fn contact_at(&self, stated: &ContactPoint) -> Option<MeshPosition> {
        if stated.frame != Frame::Map || !stated.point_m.iter().all(|coordinate| coordinate.is_finite()) {
            return None;
        }
        let nearest = self.tree.nearest(stated.point_m);
        let is_on_it = nearest.distance_m <= self.standing_off_m() + self.tree.resolution_m();
        Some(MeshPosition { point_m: if is_on_it { stated.point_m } else { nearest.point } })
    }

    fn course(&self, from: &MeshPosition, to: &MeshPosition) -> Option<(f64, Vector2<f64>)> {
        let away = (to.point_m - from.point_m).xy();
        let run_m = libm::hypot(away.x, away.y);
        (run_m > self.tree.resolution_m()).then(|| (run_m, away / run_m))
    }

    fn facets(&self, at: &MeshPosition, heading: Vector2<f64>, _side: Side) -> Vec<Facet> {
        let facet = |id| {
            let constraints = self.constraints_of(id, heading)?;
            let friction = self.friction_of(id);
            let hold = match friction {
                Some(cone) => Hold::Friction { normal: self.tree.normal(id).into_inner(), cone },
                None => Hold::Stated {
                    line: constraints.stated(Direction::Forward),
                    takeoff: constraints.check_contact(Contact::Takeoff, Direction::Forward),
                    landing: constraints.check_contact(Contact::Landing, Direction::Forward),
                },
            };
            let rest_slope = rest_slope(self.face_surface(id).surface.rest, friction.map(FrictionCone::coefficient));
            Some(Facet { refusal: constraints.refusal(), hold, rest_slope })
        };
        self.facets_at(at).into_iter().filter_map(facet).collect()
    }

    fn height_rounding_m(&self) -> f64 {
        self.coordinate_rounding_m()
    }

    fn position_rounding_m(&self) -> f64 {
        self.coordinate_rounding_m()
    }

    fn resolution_m(&self) -> f64 {
        self.tree.resolution_m()
    }

    fn slope_rounding(&self) -> f64 {
        4.0 * self.coordinate_rounding_m() / self.tree.mesh().median_edge_m()
    }
}

impl Triangulated for MeshGround {
    fn bounds(&self) -> [Point3<f64>; 2] {
        let bounds = self.tree.mesh().bounds();
        let corner = |at: crate::quantity::MapPoint, z_m| Point3::new(at.x, at.y, z_m);
        [corner(bounds.map.min, bounds.low_m), corner(bounds.map.max, bounds.high_m)]
    }

    fn visit_triangles(&self, [low, high]: [Point3<f64>; 2], visit: &mut dyn FnMut(FacetId, &[Point3<f64>; 3])) {
        let meets = |box_low: Point3<f64>, box_high: Point3<f64>| {
            (0..3).all(|axis| box_low[axis] <= high[axis] && low[axis] <= box_high[axis])
        };
        self.tree.visit(meets, visit);
    }

    fn nearest_m(&self, to: &Point3<f64>) -> (FacetId, f64) {
        let nearest = self.tree.nearest(*to);
        (nearest.facet, nearest.distance_m)
    }

    fn touching(&self, at: &MeshPosition) -> Vec<FacetId> {
        self.facets_at(at)
    }

    fn outer_normal(&self, facet: FacetId) -> Vector3<f64> {
        self.tree.normal(facet).into_inner()
    }
}

impl Windows for MeshGround {
    /// The windows of [`MeshGround::windows`]; `None` too where a position gives no [contact](MeshGround::contact).
    fn windows(&self, takeoff: &MeshPosition, landing: &MeshPosition) -> Option<TakeoffWindows> {
        let mut buffers = super::MeshBuffers::default();
        let [takeoff, landing] = [takeoff, landing].map(|position| self.contact_near(position.point_m));
        let (sight, lofts) = Self::windows(self, &takeoff?, &landing?, &mut buffers)?;
        Some(TakeoffWindows { sight, lofts: lofts.to_vec() })
    }
}
