//! A contact on a mesh: a point of its surface with the facets that meet there.

use nalgebra::{Point3, Vector3};

use super::{MeshGround, hold::Hold};
use crate::{quantity::FacetId, world::Contact};

/// A facet at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshContactFacet {
    /// Which.
    pub id: FacetId,
    /// Its normal, of length 1.
    pub normal: Vector3<f64>,
    /// What holds a take-off and a landing on it.
    pub(super) holds: [Hold; 2],
}

/// A point of the surface of a mesh where a hop takes off or lands.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshContact {
    point_m: Point3<f64>,
    /// The point of the surface.
    surface_m: Point3<f64>,
    moved_m: f64,
    /// How far the point stands off the surface.
    stand_off_m: f64,
    /// All facets that meet at the point of the surface.
    facets: Vec<MeshContactFacet>,
}

/// Why a point gives no contact.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoMeshContact {
    /// It lies inside a closed body.
    #[error(
        "({}, {}, {}) m lies inside a closed body of the mesh, expected a point on its surface or in the open; the nearest point of the \
         surface is ({}, {}, {}) m, {distance_m} m away",
        point_m.x, point_m.y, point_m.z, nearest_m.x, nearest_m.y, nearest_m.z
    )]
    InsideRock {
        /// The point.
        point_m: Point3<f64>,
        /// The nearest point of the surface.
        nearest_m: Point3<f64>,
        /// How far away that is, m.
        distance_m: f64,
    },
    /// The nearest surface lies inside a closed body.
    #[error(
        "the surface nearest to ({}, {}, {}) m, at ({}, {}, {}) m, lies inside another closed body of the mesh, expected open surface",
        point_m.x, point_m.y, point_m.z, nearest_m.x, nearest_m.y, nearest_m.z
    )]
    Covered {
        /// The point.
        point_m: Point3<f64>,
        /// The nearest point of the surface.
        nearest_m: Point3<f64>,
    },
    /// The ball of the hopper has no room there.
    #[error(
        "a ball of radius {radius_m} m on the surface at ({}, {}, {}) m touches facet {}, {distance_m:.6} m from its centre, expected room \
         for it: choose a place farther away from walls and edges, or a smaller hopper.radius_m",
        point_m.x, point_m.y, point_m.z, facet.index() + 1
    )]
    NoRoom {
        /// The point of the surface.
        point_m: Point3<f64>,
        /// The radius of the ball, m.
        radius_m: f64,
        /// What it touches.
        facet: FacetId,
        /// How far that is from the centre of the ball, m.
        distance_m: f64,
    },
    /// Not three finite numbers.
    #[error("({}, {}, {}) is no point, expected three finite numbers", point_m.x, point_m.y, point_m.z)]
    NoPoint {
        /// What was given.
        point_m: Point3<f64>,
    },
}

/// A point this share of the size of the mesh below the surface was meant to lie on it: coordinates are typed with few digits.
const TYPED: f64 = 1.0e-4;

impl MeshContact {
    /// Where flights begin and end, m: the point of the surface, the centre of a ball that stands there
    /// ([`BALL_STAND_OFF`](super::BALL_STAND_OFF) radii off it, along the mean of the normals), or a place that stands off otherwise.
    pub const fn point_m(&self) -> Point3<f64> {
        self.point_m
    }

    /// The point of the surface, m.
    pub const fn surface_m(&self) -> Point3<f64> {
        self.surface_m
    }

    /// How far the point was moved to the surface, m.
    pub const fn moved_m(&self) -> f64 {
        self.moved_m
    }

    /// How far the point stands off the surface, m.
    pub const fn stand_off_m(&self) -> f64 {
        self.stand_off_m
    }

    /// The facets that meet at the point.
    pub fn facets(&self) -> &[MeshContactFacet] {
        &self.facets
    }

    /// One of the facets that meet at the point.
    #[inline]
    pub(super) fn facet(&self, id: FacetId) -> Option<&MeshContactFacet> {
        self.facets.iter().find(|facet| facet.id == id)
    }

    /// Whether every take-off, or every landing, is refused there, whatever the hop: a facet is too steep to rest on, or kept out.
    pub fn refuses(&self, kind: Contact) -> bool {
        self.facets.iter().any(|facet| facet.holds[kind as usize] == Hold::Refused)
    }

    /// Whether a facet meets the point.
    pub fn touches(&self, id: FacetId) -> bool {
        self.facet(id).is_some()
    }
}

impl MeshGround {
    /// The contact at the point of the surface that is nearest to a given one.
    ///
    /// # Errors
    /// [`NoMeshContact`] for a point inside rock, for surface that is, and where a ball has no room.
    pub fn contact(&self, at: Point3<f64>) -> Result<MeshContact, NoMeshContact> {
        if !at.coords.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(NoMeshContact::NoPoint { point_m: at });
        }
        let tree = self.tree();
        let nearest = tree.nearest(at);
        let size_m = tree.mesh().bounds().size_m();
        if nearest.distance_m > TYPED * size_m && tree.is_buried(at) {
            let (nearest_m, distance_m) = (nearest.point, nearest.distance_m);
            return Err(NoMeshContact::InsideRock { point_m: at, nearest_m, distance_m });
        }
        let facets: Vec<MeshContactFacet> = tree.touching(nearest.point).into_iter().map(|id| self.contact_facet(id)).collect();
        let mean: Vector3<f64> = facets.iter().map(|facet| facet.normal).sum();
        if let Some(outwards) = mean.try_normalize(1.0e-6)
            && tree.is_buried(nearest.point + outwards * (16.0 * tree.resolution_m()))
        {
            return Err(NoMeshContact::Covered { point_m: at, nearest_m: nearest.point });
        }
        let point_m = self.centre(nearest.point, mean, &facets)?;
        let stand_off_m = (point_m - nearest.point).norm();
        Ok(MeshContact { point_m, surface_m: nearest.point, moved_m: nearest.distance_m, stand_off_m, facets })
    }

    /// A contact as [`contact`](Self::contact) and [`stood_off`](Self::stood_off) gave it, by its point, how far it was moved to the surface
    /// and stands off it, and its facets; `None` where it does not lie on these.
    pub fn known_contact(
        &self,
        point_m: Point3<f64>,
        (moved_m, stand_off_m): (f64, f64),
        facets: &[FacetId],
    ) -> Option<MeshContact> {
        let tree = self.tree();
        let count = tree.mesh().triangle_count();
        if facets.is_empty() || facets.iter().any(|facet| facet.index() >= count) || !(moved_m >= 0.0 && stand_off_m >= 0.0) {
            return None;
        }
        let near_m = 2.0 * tree.resolution_m() + stand_off_m;
        let lies_on = |id: &FacetId| (point_m - tree.corners(*id)[0]).dot(&tree.normal(*id)).abs() <= near_m;
        let nearest = tree.nearest(point_m);
        let lies = facets.iter().all(lies_on) && nearest.distance_m <= near_m;
        let surface_m = if stand_off_m == 0.0 { point_m } else { nearest.point };
        let facets = facets.iter().map(|id| self.contact_facet(*id)).collect();
        lies.then_some(MeshContact { point_m, surface_m, moved_m, stand_off_m, facets })
    }

    /// A facet at a contact, and what holds there.
    fn contact_facet(&self, id: FacetId) -> MeshContactFacet {
        let normal = self.tree().normal(id).into_inner();
        MeshContactFacet { id, normal, holds: self.holds(id, normal) }
    }

    /// A contact moved off its surface along the mean normal of its facets, whose limits it keeps, unless a ball stands farther off already;
    /// `None` where it would then lie inside a body, or nearer to the mesh than that.
    pub fn stood_off(&self, contact: &MeshContact, stand_off_m: f64) -> Option<MeshContact> {
        if stand_off_m <= contact.stand_off_m {
            return Some(contact.clone());
        }
        let mean: Vector3<f64> = contact.facets.iter().map(|facet| facet.normal).sum();
        let point_m = contact.surface_m + mean.try_normalize(1.0e-6)? * stand_off_m;
        let tree = self.tree();
        let clear_m = stand_off_m * (1.0 - 1.0e-6) - tree.resolution_m();
        let stands = tree.nearest(point_m).distance_m >= clear_m && !tree.is_buried(point_m);
        stands.then(|| MeshContact { point_m, stand_off_m, ..contact.clone() })
    }
}
