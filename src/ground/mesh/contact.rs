//! A contact on a mesh: a point of its surface with the facets that meet there.

use nalgebra::{Point3, Vector3};

use super::MeshGround;
use crate::quantity::FacetId;

/// A facet at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshContactFacet {
    /// Which.
    pub id: FacetId,
    /// Its normal, of length 1.
    pub normal: Vector3<f64>,
}

/// A point of the surface of a mesh where a hop takes off or lands.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshContact {
    point_m: Point3<f64>,
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
    /// The point, m.
    pub const fn point_m(&self) -> Point3<f64> {
        self.point_m
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

    /// Whether a facet meets the point.
    pub fn touches(&self, id: FacetId) -> bool {
        self.facet(id).is_some()
    }
}

impl MeshGround {
    /// The contact at the point of the surface that is nearest to a given one.
    ///
    /// # Errors
    /// [`NoMeshContact`] for a point inside rock, and for surface that is.
    pub fn contact(&self, at: Point3<f64>) -> Result<MeshContact, NoMeshContact> {
        if !at.coords.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(NoMeshContact::NoPoint { point_m: at });
        }
        let tree = self.tree();
        let nearest = tree.nearest(at);
        let bounds = tree.mesh().bounds();
        let size_m = (bounds.map.max - bounds.map.min).amax().max(bounds.high_m - bounds.low_m);
        if nearest.distance_m > TYPED * size_m && tree.is_buried(at) {
            let (nearest_m, distance_m) = (nearest.point, nearest.distance_m);
            return Err(NoMeshContact::InsideRock { point_m: at, nearest_m, distance_m });
        }
        let facets: Vec<MeshContactFacet> = tree
            .touching(nearest.point)
            .into_iter()
            .map(|id| MeshContactFacet { id, normal: tree.normal(id).into_inner() })
            .collect();
        let mean: Vector3<f64> = facets.iter().map(|facet| facet.normal).sum();
        if let Some(outwards) = mean.try_normalize(1.0e-6)
            && tree.is_buried(nearest.point + outwards * (16.0 * tree.resolution_m()))
        {
            return Err(NoMeshContact::Covered { point_m: at, nearest_m: nearest.point });
        }
        Ok(MeshContact { point_m: nearest.point, moved_m: nearest.distance_m, stand_off_m: 0.0, facets })
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
        let lies = facets.iter().all(lies_on) && tree.nearest(point_m).distance_m <= near_m;
        let of_facet = |id: &FacetId| MeshContactFacet { id: *id, normal: tree.normal(*id).into_inner() };
        lies.then(|| MeshContact { point_m, moved_m, stand_off_m, facets: facets.iter().map(of_facet).collect() })
    }

    /// A contact moved off its surface along the mean normal of its facets, whose limits it keeps; `None` where it would then lie inside
    /// a body, or nearer to the mesh than that.
    pub fn stood_off(&self, contact: &MeshContact, stand_off_m: f64) -> Option<MeshContact> {
        if stand_off_m == 0.0 {
            return Some(contact.clone());
        }
        let mean: Vector3<f64> = contact.facets.iter().map(|facet| facet.normal).sum();
        let point_m = contact.point_m + mean.try_normalize(1.0e-6)? * stand_off_m;
        let tree = self.tree();
        let clear_m = stand_off_m * (1.0 - 1.0e-6) - tree.resolution_m();
        let stands = tree.nearest(point_m).distance_m >= clear_m && !tree.is_buried(point_m);
        stands.then(|| MeshContact { point_m, stand_off_m, ..contact.clone() })
    }
}
